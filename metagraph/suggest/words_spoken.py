"""Names in other languages than English: which ones a batch speaks, and what its words are in English."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

from metagraph.suggest.words_folded import folded, is_run_together, spellings
from metagraph.suggest.words_languages import (
    AFTER_FROM,
    AFTER_TO,
    MARKS,
    MAYBE_FROM,
    MAYBE_TO,
    NOTHING,
    Language,
    languages,
)

_PIECES = re.compile(r"\d+[hH](?![^\W_])|\d+|[^\W\d_]+|[\W_]+")
_ARROW = re.compile("[→⇒➔➜]|[-=]+>")
ARROW: Final = "→"  # as a token, whatever arrow it is: "to"
_ELIDED = frozenset(
    ["l", "d", "n", "m", "t", "s", "j", "c", "qu", "un", "all", "dell", "nell", "sull", "dall", "coll"]
)
_LOANED = frozenset(  # words of English that people say in any language
    [
        "idle",
        "idling",
        "stance",
        "loop",
        "pose",
        "base",
        "stop",
        "ok",
        "gesture",
        "transition",
        "trans",
        "neutral",
        "normal",
        "hold",
        "start",
        "end",
        "default",
        "shrug",
        "facepalm",
        "dab",
        "selfie",
        "walk",
        "run",
        "jump",
        "beat",
        "talk",
        "mocap",
    ]
)
_PARTS_AT_MOST = 4  # tokens of a phrase
_ALONE = 7  # letters of a word that tells its language though no other does
_COMPOUND = range(6, 41)
_NUMERALS = "零一二三四五六七八九十"


class Word(str):
    """A word of English that stands for what a name says in another language. written: what that is, small
    letters; "" for all but the first of several that stand for it together. start, end: where in the name.
    """

    written: str
    start: int
    end: int

    def __new__(cls, text: str, written: str = "", start: int = 0, end: int = 0) -> Word:
        word = super().__new__(cls, text)
        word.written, word.start, word.end = written, start, end
        return word


def written(words: Iterable[str]) -> tuple[str, ...]:
    """Return words as their name has them."""
    said = ((w.written if isinstance(w, Word) else w) for w in words)
    return tuple(w for w in said if w)


@dataclass(frozen=True, slots=True)
class Token:
    """A run of letters of a name, or a number. text: folded, small. shown: as written, small. alone: one
    capital letter. elided: an apostrophe follows.
    """

    text: str
    shown: str
    start: int
    end: int
    alone: bool = False
    elided: bool = False

    @property
    def run(self) -> bool:
        """Whether it is of a writing without blanks between words."""
        return is_run_together(self.text[0])


@dataclass(frozen=True, slots=True)
class Break:
    """What stands between tokens."""

    text: str


def tokens(text: str, offset: int = 0, whole: str | None = None) -> list[Token | Break]:
    """Take a text apart at separators, capitals, digits and where the writing changes. offset: of the text in
    the name.
    """
    name = text if whole is None else whole
    letters, places = folded(text)
    out: list[Token | Break] = []
    for piece in _PIECES.finditer(letters):
        said, at = piece[0], piece.start()
        if not (said[0].isalpha() or said[0].isdecimal()):
            arrow = _ARROW.search(said)
            if arrow is not None and out and piece.end() < len(letters):
                start, stop = (places[at + k] + offset for k in arrow.span())
                out.append(Token(ARROW, letters[slice(*(at + k for k in arrow.span()))], start, stop))
            else:
                out.append(Break(said))
            continue
        for part in _camel(said) if said[0].isalpha() else [said]:
            end = at + len(part)
            start, stop = places[at] + offset, places[end] + offset
            small = part.lower()
            shown = small if text.isascii() else unicodedata.normalize("NFC", name[start:stop]).lower()
            follows = letters[end : end + 1]
            out.append(Token(
                small, shown, start, stop, len(part) == 1 and part.isupper(),
                follows in ("'", "’") and small in _ELIDED,
            ))  # fmt: skip
            at = end
    return out


def _camel(run: str) -> list[str]:
    cuts = [0]
    for i in range(1, len(run)):
        rises = run[i - 1].islower() and run[i].isupper()
        ends = run[i - 1].isupper() and run[i].isupper() and i + 1 < len(run) and run[i + 1].islower()
        if rises or ends or is_run_together(run[i - 1]) != is_run_together(run[i]):
            cuts.append(i)
    return [run[a:b] for a, b in zip(cuts, [*cuts[1:], len(run)], strict=True)]


@dataclass(frozen=True, slots=True)
class _Said:
    """Tokens that mean something: English words or a mark, where it is written, and as what."""

    meaning: str
    written: str
    start: int
    end: int
    known: bool = True
    token: Token | None = None


@dataclass
class Spoken:
    """The languages that a batch speaks, the one most spoken first. leading: more than English. own: letters
    of phrases -> what the user says they mean in English, None for nothing; a phrase with a meaning of its
    own stands for itself.
    """

    tongues: tuple[Language, ...]
    leading: bool
    own: Mapping[str, str | None] = field(default_factory=dict)
    _runs: dict[str, tuple[tuple[str, int, int], ...]] = field(default_factory=dict)
    _compounds: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def find(self, key: str) -> tuple[str, bool] | None:
        """Return what letters mean and whether that is sure in a text of any language."""
        if key in self.own:
            mine = self.own[key]
            return (mine, True) if mine is not None else None
        for tongue in self.tongues:
            if (meaning := tongue.exact.get(key)) is not None:
                return meaning, tongue.sure(key)
        return None

    def stemmed(self, parts: Sequence[str]) -> str | None:
        """Return what words mean whose endings differ from those of a known phrase."""
        for tongue in self.tongues:
            if (
                tongue.endings
                and (found := tongue.stemmed.get(" ".join(map(tongue.stem, parts)))) is not None
            ):
                return found
        return None

    def compound(self, word: str) -> tuple[str, ...]:
        """Return the parts of a word, each of which is known; () where there are none."""
        if word not in self._compounds:
            cut: tuple[str, ...] = ()
            if len(word) in _COMPOUND:
                cut = next((c for t in self.tongues if (c := _compound(word, t))), ())
            self._compounds[word] = cut
        return self._compounds[word]

    def run(self, text: str) -> tuple[tuple[str, int, int], ...]:
        """Cut a run of kana, hanzi or hangul into known phrases, the fewest that leave the least unknown.

        Returns meaning ("" of what is unknown), start, end of each.
        """
        if text not in self._runs:
            self._runs[text] = cut_run(text, self.find, max((t.longest for t in self.tongues), default=1))
        return self._runs[text]

    # -- reading

    def read(
        self, said: Sequence[Token], english: Callable[[str], tuple[str, ...]], meanings: Any
    ) -> list[str]:
        """Return the words of tokens that stand together, in English where a language knows them, else as
        `english` has them.
        """
        bold = self.leading or (self._telling(said) and not any(is_english(t.text, meanings) for t in said))
        items = self._items(said, english, meanings, bold)
        items = _joined(_chosen(items), meanings)
        out: list[str] = []
        kinds = meanings["kinds"]
        alone = False  # whether the word before stands for one of another language by itself
        for item in items:
            if item.token is not None and not item.known:
                out += english_words(item.token, english)
                alone = False
                continue
            words = item.meaning.split()
            made = [
                Word(w, item.written if k == 0 else "", item.start, item.end) for k, w in enumerate(words)
            ]
            single = len(made) == 1
            if single and alone and f"{out[-1]} {made[0]}" not in kinds and f"{made[0]} {out[-1]}" in kinds:
                out[-1:] = [made[0], out[-1]]  # "watch look": objects stand before verbs in some languages
            else:
                out += made
            alone = single
        return out

    def _telling(self, said: Sequence[Token]) -> bool:
        return any((f := self.find(t.text)) is not None and f[1] for t in said)

    def _items(
        self, said: Sequence[Token], english: Callable[[str], tuple[str, ...]], meanings: Any, bold: bool
    ) -> list[_Said]:
        units: list[tuple[Token, str]] = []  # a token or part of a run, and what a part of a run means
        for token in said:
            if not token.run:
                units.append((token, ""))
                continue
            size = max(1, len(token.text))
            for meaning, a, b in self.run(token.text):
                start = token.start + (token.end - token.start) * a // size
                end = token.start + (token.end - token.start) * b // size
                shown = token.shown[a:b] if len(token.shown) == size else token.text[a:b]
                units.append((Token(token.text[a:b], shown, start, end), meaning))
        out: list[_Said] = []
        at = 0
        while at < len(units):
            for n in range(min(_PARTS_AT_MOST, len(units) - at), 0, -1):
                some = [u[0] for u in units[at : at + n]]
                meaning_of = self._meaning(some, english, meanings, bold)
                if meaning_of is not None:
                    shown = (
                        " ".join(t.shown for t in some) if not some[0].run else "".join(t.shown for t in some)
                    )
                    token = some[0] if n == 1 else None
                    out.append(_Said(meaning_of, shown, some[0].start, some[-1].end, token=token))
                    at += n
                    break
            else:
                token = units[at][0]
                parts = () if token.run or token.text in meanings["kinds"] else self._parts(token, english)
                if parts:
                    first = token.shown
                    for part in parts:
                        out.append(_Said(part, first, token.start, token.end))
                        first = ""
                elif not (token.elided and bold):
                    number = _numeral(token.text)
                    out.append(
                        _Said(number, number, token.start, token.end)
                        if number
                        else _Said("", token.shown, token.start, token.end, known=False, token=token)
                    )
                at += 1
        return [s for s in out if s.meaning != NOTHING]

    def _parts(self, token: Token, english: Callable[[str], tuple[str, ...]]) -> tuple[str, ...]:
        if not token.text.isalpha() or len(english(token.text)) > 1:
            return ()
        found = [self.find(part) for part in self.compound(token.text)]
        return tuple(f[0] for f in found if f is not None)

    def _meaning(
        self, some: Sequence[Token], english: Callable[[str], tuple[str, ...]], meanings: Any, bold: bool
    ) -> str | None:
        if any(not t.text.isalpha() and "ー" not in t.text for t in some):
            return None
        found = self.find("".join(t.text for t in some))
        if found is not None and len(some) == 1:
            meaning, sure = found
            if meaning == some[0].text:
                return None  # the same in English
            if (not sure and not bold) or (some[0].alone and meaning in MARKS):
                return None
            if not bold and in_english(some[0].text, meanings):
                return None
            return meaning
        if found is not None:
            if any(t.alone for t in some):
                return None
            return found[0] if found[1] or bold else None
        if len(some) == 1 and (in_english(some[0].text, meanings) or len(some[0].text) < 5):
            return None
        if any(t.run for t in some) or (len(some) > 1 and not bold):
            return None
        got = self.stemmed([t.text for t in some])
        return got if got not in MARKS else None


def in_english(word: str, meanings: Any) -> bool:
    """Whether a word itself means something in English, as the patterns have it."""
    return any(word in meanings[table] for table in ("kinds", "layers", "limbs", "postures", "joins"))


def is_english(word: str, meanings: Any) -> bool:
    """Whether a word tells that a name is in English."""
    return len(word) > 2 and word not in _LOANED and in_english(word, meanings)


def english_words(token: Token, english: Callable[[str], tuple[str, ...]]) -> tuple[str, ...]:
    """Return a token that no other language knows: its letters folded where English knows them so."""
    if token.text == ARROW:
        return (Word("to", token.shown, token.start, token.end),)
    if token.text == token.shown:
        return english(token.text)
    known = english(token.text)
    return (
        known if len(known) > 1 or known != (token.text,) or token.text.isdecimal() else english(token.shown)
    )


def _numeral(text: str) -> str:
    if not text or any(c not in _NUMERALS for c in text) or len(text) > 2:
        return ""
    values = [_NUMERALS.index(c) for c in text]
    if len(values) == 1:
        return str(values[0])
    return str(
        10 + values[1]
        if values[0] == 10
        else 10 * values[0]
        if values[1] == 10
        else values[0] * 10 + values[1]
    )


def cut_run(
    text: str, find: Callable[[str], tuple[str, bool] | None], longest: int
) -> tuple[tuple[str, int, int], ...]:
    """Cut a run of letters into known phrases, see `Spoken.run`."""
    best: list[tuple[tuple[int, int], tuple[tuple[str, int, int], ...]]] = [((0, 0), ())]
    for end in range(1, len(text) + 1):
        before, parts = best[end - 1]
        chosen = ((before[0] + 2, before[1] + 1), (*parts, ("", end - 1, end)))
        for start in range(max(0, end - longest), end):
            found = find(text[start:end])
            if found is None:
                continue
            cost, parts = best[start]
            # A particle in an unknown word is no particle.
            price = (cost[0] + (1 if found[0] in MARKS else 0), cost[1] + 1)
            if price < chosen[0]:
                chosen = price, (*parts, (found[0], start, end))
        best.append(chosen)
    out: list[tuple[str, int, int]] = []
    for meaning, start, end in best[-1][1]:
        if not meaning and out and not out[-1][0]:
            out[-1] = ("", out[-1][1], end)
        else:
            out.append((meaning, start, end))
    return tuple(out)


def _compound(word: str, tongue: Language) -> tuple[str, ...]:
    """Cut a word into parts that a language knows, into as few as possible."""
    best: dict[int, tuple[str, ...]] = {0: ()}
    for end in range(2, len(word) + 1):
        for start in sorted(best):
            for link in ("", *(tongue.links if start else ())):
                if not word.startswith(link, start):
                    continue
                part = word[start + len(link) : end]
                meaning = tongue.exact.get(part)
                if meaning is None or (len(part) < 3 and meaning not in MARKS and tongue.endings):
                    continue
                if end not in best or len(best[start]) + 1 < len(best[end]):
                    best[end] = (*best[start], part)
    parts = best.get(len(word), ())
    return parts if len(parts) > 1 or not parts or parts == (word,) else ()


# --- what joins stances


def _chosen(items: list[_Said]) -> list[_Said]:
    """Choose of two meanings: the first where a name or an end begins, else the second ("sit|left": zuo)."""
    out: list[_Said] = []
    for item in items:
        first, _, second = item.meaning.partition("|")
        begins = not out or out[-1].meaning in (*MARKS, "to", "from") or not out[-1].known
        out.append(replace(item, meaning=first if begins else second) if second else item)
    return out


def _posture(item: _Said, meanings: Any) -> bool:
    if not item.meaning or item.meaning in MARKS:
        word = item.token.text if item.token is not None else ""
        return word in meanings["postures"] or meanings["kinds"].get(word) == "stance"
    words = item.meaning.split()
    return (
        item.meaning in meanings["postures"]
        or any(w in meanings["postures"] for w in words)
        or meanings["kinds"].get(words[0]) == "stance"
    )


def _joined(items: list[_Said], meanings: Any) -> list[_Said]:
    """Tell what joins stances from what only looks like it, and put it before the stance it leads to."""

    def again(item: _Said, meaning: str) -> _Said:
        return _Said(meaning, item.written, item.start, item.end)

    out: list[_Said] = []
    for at, item in enumerate(items):
        after = items[at + 1] if at + 1 < len(items) else None
        if item.meaning == MAYBE_TO:
            if (
                after is not None
                and _posture(after, meanings)
                and (not out or any(_posture(o, meanings) for o in out) or not any(o.known for o in out))
            ):
                out.append(again(item, "to"))
        elif item.meaning == MAYBE_FROM:
            later = any(i.meaning in (MAYBE_TO, "to") for i in items[at + 2 :])
            if (
                after is not None
                and not (out and not _posture(out[-1], meanings))
                and (later or (out and _posture(after, meanings)))
                and _posture(after, meanings)
            ):
                out.append(again(item, "from"))
        elif item.meaning == AFTER_FROM:
            told = [o for o in out if not _number(o)]
            if after is not None and not _number(after) and told:
                out.append(again(item, "to"))
            elif told:
                _before_stance(out, again(item, "from"), meanings)
        elif item.meaning == AFTER_TO:
            if any(o.meaning == "to" for o in out):
                continue
            if out and _posture(out[-1], meanings):
                _before_stance(out, again(item, "to"), meanings)
        else:
            out.append(item)
    return out


def _number(item: _Said) -> bool:
    return item.token is not None and item.token.text.isdecimal()


def _before_stance(out: list[_Said], join: _Said, meanings: Any) -> None:
    out.insert(len(out) - 1, join)


# --- which languages


def own_words(changes: Mapping[Any, Mapping[str, str | None]]) -> dict[str, str | None]:
    """Return what a user says about words: letters -> English, themselves where they mean something of their
    own, None for nothing any more.
    """
    own: dict[str, str | None] = {}
    for name, mine in changes.items():
        for phrase, meaning in mine.items():
            for key in spellings(phrase):
                own[key] = meaning if name == "synonyms" else own.get(key, phrase)
    return own


def spoken(batch: Sequence[Sequence[Token]], patterns: Any) -> Spoken | None:
    """Return what languages a batch of names speaks beside English, None where it is English alone."""
    meanings = patterns.meanings
    own = own_words(patterns.changes)
    distinct = list(dict.fromkeys(tuple(t for t in name if not t.text.isdecimal()) for name in batch))
    found = {tongue: [_told(name, tongue, meanings, own) for name in distinct] for tongue in languages()}
    tongues: list[Language] = []
    spent: list[set[int]] = [set() for _ in distinct]
    while True:
        best, most = None, (0, 0)
        for tongue, told in found.items():
            if tongue in tongues:
                continue
            rest = [
                {at: n for at, n in one.items() if at not in gone}
                for one, gone in zip(told, spent, strict=True)
            ]
            names = sum(1 for one in rest if one)
            weight = sum(sum(one.values()) for one in rest)
            words = {
                name[at].text: n for name, one in zip(distinct, rest, strict=True) for at, n in one.items()
            }
            strong = (
                len(words) > 1 or max(words.values(), default=0) >= _ALONE or 2 * names >= len(distinct) > 0
            )
            if names and strong and (weight, names) > most:
                best, most = tongue, (weight, names)
        if best is None:
            break
        tongues.append(best)
        for one, gone in zip(found[best], spent, strict=True):
            gone.update(one)
    mine = {k: v for k, v in own.items() if v != k}
    if not tongues:
        return Spoken((), False, own) if mine and "synonyms" in patterns.changes else None
    theirs = sum(1 for gone in spent if gone)
    english = sum(
        1
        for name, gone in zip(distinct, spent, strict=True)
        if any(
            at not in gone and is_english(t.text, meanings) and not _shared(t.text, tongues)
            for at, t in enumerate(name)
        )
    )
    return Spoken(tuple(tongues), theirs >= english, own)


def _shared(word: str, tongues: Sequence[Language]) -> bool:
    return any(word in tongue.exact for tongue in tongues)


def _told(
    name: Sequence[Token], tongue: Language, meanings: Any, own: Mapping[str, str | None]
) -> dict[int, int]:
    """Return the tokens of a name that a language knows and English does not, with how many letters of each."""
    out: dict[int, int] = {}

    def find(key: str) -> tuple[str, bool] | None:
        meaning = tongue.exact.get(key) if key not in own else None
        return (meaning, True) if meaning is not None else None

    for at, token in enumerate(name):
        if token.run:
            if tongue.longest:
                known = sum(
                    b - a for m, a, b in cut_run(token.text, find, tongue.longest) if m and m not in MARKS
                )
                if 2 * known >= len(token.text):
                    out[at] = 4 * known
            continue
        for n in range(min(_PARTS_AT_MOST, len(name) - at), 0, -1):
            some = name[at : at + n]
            if any(t.run for t in some):
                continue
            key = "".join(t.text for t in some)
            if key in own or key not in tongue.exact or not tongue.sure(key):
                continue
            if (n == 1 and in_english(key, meanings)) or any(t.alone for t in some):
                continue
            if n > 1 and any(in_english(t.text, meanings) for t in some) and len(key) < 2 * _ALONE:
                continue  # "sit a" is no word of Japanese
            for k in range(at, at + n):
                out[k] = max(out.get(k, 0), len(key) // n)
            break
        else:
            word = token.text
            if len(word) > 5 and at not in out and not in_english(word, meanings) and word not in own:
                stem = tongue.stem(word)
                if len(stem) > 4 and stem in tongue.stemmed and tongue.stemmed[stem] not in MARKS:
                    out[at] = len(stem) - 1
                elif len(word) > 8 and word.isascii() and len(cut := _compound(word, tongue)) > 1:
                    out[at] = max(map(len, cut))
    return out
