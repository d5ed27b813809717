"""Names in other languages than English: what their words are in English."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from metagraph.suggest.words.cut import ARROW, EnglishWord, Token
from metagraph.suggest.words.languages import (
    AFTER_FROM,
    AFTER_TO,
    MARKS,
    MAYBE_FROM,
    MAYBE_TO,
    NOTHING,
    WordLanguage,
)

_LOANED = frozenset((
    "idle", "idling", "stance", "loop", "pose", "base", "stop", "ok", "gesture", "transition",
    "trans", "neutral", "normal", "hold", "start", "end", "default", "shrug", "facepalm", "dab",
    "selfie", "walk", "run", "jump", "beat", "talk", "mocap",
))  # fmt: skip
PARTS = 4  # tokens of a phrase
_COMPOUND = range(6, 41)
_NUMERALS = "零一二三四五六七八九十"


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
class SpokenLanguages:
    """The languages that a batch speaks, the one most spoken first. leading: more than English. own: letters
    of phrases -> what the user says they mean in English, None for nothing; a phrase with a meaning of its
    own stands for itself. sides: letters that names end in -> left or right.
    """

    tongues: tuple[WordLanguage, ...]
    leading: bool
    own: Mapping[str, str | None] = field(default_factory=dict)
    sides: Mapping[str, str] = field(default_factory=dict)
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
        if "".join(parts) in self.own:
            return None
        for tongue in self.tongues:
            if (
                tongue.endings
                and (found := tongue.stemmed.get(" ".join(map(tongue.stem, parts)))) is not None
            ):
                return found
        return None

    def compound(self, word: str) -> tuple[str, ...]:
        """Return the parts of a word, each of which is known; () if there are none."""
        if word not in self._compounds:
            cut: tuple[str, ...] = ()
            if len(word) in _COMPOUND and word not in self.own:
                cut = next((c for t in self.tongues if (c := split_compound(word, t))), ())
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
        if self.sides and bold:
            last = next((k for k in range(len(items) - 1, 0, -1) if not _number(items[k])), 0)
            ends = items[last].token if items else None
            if last and ends is not None and ends.text in self.sides:
                items[last] = _Said(self.sides[ends.text], ends.shown, ends.start, ends.end)
        items = _joined(_chosen(items, meanings), meanings)
        out: list[str] = []
        kinds = meanings["kinds"]
        alone = False  # whether the word before stands for one of another language by itself
        for item in items:
            if item.token is not None and not item.known:
                out += find_english_words(item.token, english)
                alone = False
                continue
            words = item.meaning.split()
            made = [
                EnglishWord(w, item.written if k == 0 else "", item.start, item.end)
                for k, w in enumerate(words)
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
            for n in range(min(PARTS, len(units) - at), 0, -1):
                some = [u[0] for u in units[at : at + n]]
                meaning_of = self._meaning(some, english, meanings, bold)
                if meaning_of is not None:
                    shown = (
                        " ".join(t.shown for t in some) if not some[0].run else "".join(t.shown for t in some)
                    )
                    alone = some[0] if n == 1 else None
                    out.append(_Said(meaning_of, shown, some[0].start, some[-1].end, token=alone))
                    at += n
                    break
            else:
                token = units[at][0]  # known by no phrase
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
            if meaning == NOTHING and some[0].text in meanings["joins"]:
                return None  # "to" among Japanese words in Latin letters
            if not bold and has_english_meaning(some[0].text, meanings):
                return None
            return meaning
        if found is not None:
            if any(t.alone for t in some):
                return None
            return found[0] if found[1] or bold else None
        if len(some) == 1 and (has_english_meaning(some[0].text, meanings) or len(some[0].text) < 5):
            return None
        if any(t.run for t in some) or (len(some) > 1 and not bold):
            return None
        got = self.stemmed([t.text for t in some])
        return got if got not in MARKS else None


def has_english_meaning(word: str, meanings: Any) -> bool:
    """Return whether a word itself means something in English, as the patterns have it."""
    return any(word in meanings[table] for table in ("kinds", "layers", "limbs", "postures", "joins"))


def is_english(word: str, meanings: Any) -> bool:
    """Whether a word tells that a name is in English."""
    return len(word) > 2 and word not in _LOANED and has_english_meaning(word, meanings)


def find_english_words(token: Token, english: Callable[[str], tuple[str, ...]]) -> tuple[str, ...]:
    """Return a token that no other language knows: its letters folded where English knows them so."""
    if token.text == ARROW:
        return (EnglishWord("to", token.shown, token.start, token.end),)
    if token.text == token.shown or unicodedata.normalize("NFKC", token.shown) == token.text:
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


def split_compound(word: str, tongue: WordLanguage) -> tuple[str, ...]:
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


def _chosen(items: list[_Said], meanings: Any) -> list[_Said]:
    """Choose of two meanings ("sit|left": zuo): the second, a side, before a part of the body or where a name
    goes no further; else the first.
    """
    out: list[_Said] = []
    for at, item in enumerate(items):
        first, _, second = item.meaning.partition("|")
        if second:
            begins = not out or out[-1].meaning in (*MARKS, "to", "from")
            after = next((i for i in items[at + 1 :] if not _number(i)), None)
            part = after is not None and after.meaning in ("hand", "arm", "leg", "foot", "shoulder", "side")
            item = replace(item, meaning=second if part or (after is None and not begins) else first)
        out.append(item)
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
    """Report what joins stances from what only looks like it, and put it before the stance it leads to."""

    def again(item: _Said, meaning: str) -> _Said:
        return _Said(meaning, item.written, item.start, item.end)

    out: list[_Said] = []
    for at, item in enumerate(items):
        after = items[at + 1] if at + 1 < len(items) else None
        if item.meaning == MAYBE_TO:
            if (
                after is not None
                and _posture(after, meanings)
                and (any(_posture(o, meanings) for o in out) or (out and not any(o.known for o in out)))
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
