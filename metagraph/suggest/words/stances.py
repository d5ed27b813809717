"""Which stances a batch of names speaks of: idle words, shared prefixes that are clips themselves, words of
posture.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import takewhile

from metagraph.common.wording import phrase
from metagraph.suggest.words.cut import as_written
from metagraph.suggest.words.patterns import Patterns
from metagraph.suggest.words.tokens import (
    TakenName,
    count_variant_words,
    drop_numbers,
    find_phrases,
    find_stem,
    is_designator,
    is_number_word,
)

Words = tuple[str, ...]

_WEAK = {
    "loop",
    "pose",
    "hold",
    "base",
    "rest",
    "neutral",
    "default",
    "relaxed",
}  # also said of gestures: "wave loop"
_BARE = {"body", "fullbody"}  # says the layer and nothing of the stance
_PARTS = {
    "hand",
    "hands",
    "arm",
    "arms",
    "head",
    "hip",
    "hips",
    "chin",
    "side",
    "sides",
    "leg",
    "legs",
    "knee",
    "knees",
    "chest",
    "elbow",
    "elbows",
    "finger",
    "fingers",
    "thumb",
    "thumbs",
    "palm",
    "palms",
    "foot",
    "feet",
    "neck",
    "torso",
    "chair",
    "floor",
    "ground",
    "desk",
    "table",
    "wall",
    "bench",
    "at",
    "on",
    "in",
    "behind",
    "down",
    "up",
    "both",
    "left",
    "right",
    "lf",
    "rt",
    "l",
    "r",
}
_PLACES = {"chair", "floor", "ground", "desk", "table", "wall", "bench"}
COMMON = 0.4  # of all clips that begin with a stance, from which on it is no special one
_STEMS_DOWN = ("sit", "lie", "kneel", "crouch")


@dataclass
class FoundStance:
    """A stance that names speak of. prefixes: how names begin that belong to it. confidence: that it is one.
    why: the words.
    """

    words: Words
    confidence: float
    why: str
    prefixes: set[Words] = field(default_factory=set)

    @property
    def text(self) -> str:
        return label(self.words)


def label(words: Sequence[str]) -> str:
    """Return the stance as people write it: without a leading "body", numbers without zeros."""
    told = as_written(words[1:] if len(words) > 1 and words[0] in _BARE else words)
    return " ".join(str(int(w)) if is_number_word(w) and len(w) < 10 else w for w in told)


class Stances:
    """The stances of a batch, found once, asked for by how a name begins or by the words of an end."""

    def __init__(self, batch: Sequence[TakenName], patterns: Patterns) -> None:
        self._patterns = patterns
        self._kinds = patterns.meanings["kinds"]
        self._joins = patterns.meanings["joins"]
        self.found: dict[Words, FoundStance] = {}
        self._bares: dict[Words, Words] = {}
        distinct = sorted(dict.fromkeys(t for t in batch if t.words), key=lambda t: (t.words, t.splits))
        self._distinct = [t.words for t in distinct]
        followers = _followers(distinct)
        for taken in distinct:
            self._announced(taken.words)
        for taken in distinct:
            self._clip_that_others_continue(taken.words, followers)
        self._heads(distinct)
        self._passed_between(distinct)
        self._designated(distinct)
        self._united()
        self._by_prefix: dict[Words, FoundStance] = {}
        for stance in self.found.values():
            for prefix in stance.prefixes:
                held = self._by_prefix.get(prefix)
                if held is None or (held.confidence, held.words) < (stance.confidence, stance.words):
                    self._by_prefix[prefix] = stance
        self._longest = max(map(len, self._by_prefix), default=0)
        self._count = len(distinct)
        self._begun: dict[Words, int] = {}
        for taken in distinct:
            if (told := self.of(taken.words, taken.split)) is not None:
                self._begun[told[0].words] = self._begun.get(told[0].words, 0) + 1
        self._resolved: dict[tuple[Words, Words], tuple[FoundStance, float] | None] = {}

    # -- finding

    def _add(self, words: Words, confidence: float, why: str, *prefixes: Words) -> None:
        if len(words) > 1 and words[0] in _BARE and words[1:] in self.found:
            words = words[1:]
        held = self.found.get(words)
        if held is None:
            held = self.found[words] = FoundStance(words, confidence, why)
        elif confidence > held.confidence:
            held.confidence, held.why = confidence, why
        held.prefixes.update(p for p in prefixes if p)

    def _acts(self, words: Sequence[str]) -> list[str]:
        return [p.text for p in find_phrases(words, self._kinds) if p.meaning in ("gesture", "fidget")]

    def _other(self, words: Sequence[str]) -> bool:
        return any(p.meaning == "other" for p in find_phrases(words, self._kinds))

    def _announced(self, words: Words) -> None:
        """A clip whose own name says it is a stance: "crossed idle", "idle seated back 01", "arms
        crossed".
        """
        core = words[: len(words) - count_variant_words(words)]
        if not core or any(p.meaning == "transition" for p in find_phrases(core, self._kinds)):
            return
        last = core[-1]
        if self._other(core):
            if (
                self._kinds.get(last) == "stance" and last not in _WEAK and not self._passes_over(core[:-1])
            ):  # "2h melee idle", but also "jump idle"
                self._add(core[:-1], 0.65, last, core)
            return
        if self._kinds.get(last) == "stance":
            rest = core[:-1]
            acts = self._acts(rest)
            weak = last in _WEAK and not any(self._kinds.get(w) == "stance" and w not in _WEAK for w in rest)
            repeats = last in ("loop", "hold", "pose")  # said of gestures as well: "wave loop"
            if self._passes_over(rest) or (acts and (weak or repeats)) or (repeats and not rest):
                return
            trimmed = rest[: len(rest) - count_variant_words(rest)] or core
            while len(trimmed) > 1 and self._kinds.get(trimmed[-1]) == "stance":
                trimmed = trimmed[:-1]  # "sitting idle loop"
            self._add(
                trimmed,
                0.75 if acts else 0.7 if not rest and weak else 0.85 if weak else 0.97,
                last,
                rest or core,
                trimmed,
                core,
                words,
            )
        elif self._kinds.get(core[0]) == "stance" and not self._acts(core) and self.postural(core[1:]):
            self._add(core, 0.95, core[0], core, words)
        elif self.postural(core) and not self._acts(core):
            self._add(core, 0.7, " ".join(as_written(core)), core, words)

    def _passes_over(self, rest: Words) -> bool:
        """Whether words before "idle" tell a transition ("walk to idle") and not a stance ("hand to chin
        idle").
        """
        if any(self._joins.get(w) == "from" for w in rest):
            return True
        at = next((i for i, w in enumerate(rest) if self._joins.get(w) == "to"), None)
        return at is not None and (at == 0 or at == len(rest) - 1 or not all(w in _PARTS for w in rest[:at]))

    def postural(self, words: Sequence[str]) -> bool:
        """Whether words tell a posture and nothing else: "seated back", "hands at sides", "weight left"."""
        if not words or words[-1] in ("in", "out") or (words[-1] in ("down", "up") and is_low(words)):
            return False  # "sit chair down" goes there
        return self._posture_run(words) == len(words)

    def _posture_run(self, words: Sequence[str]) -> int:
        """Return how many words at the beginning tell a posture, at least one of them a word of posture."""
        starts = {p.start: p for p in find_phrases(words, self._kinds) if p.meaning != "stance"}
        postures = {p.start: p for p in find_phrases(words, self._patterns.meanings["postures"])}
        at, told = 0, False
        while at < len(words):
            if at in postures and (at not in starts or postures[at].end >= starts[at].end):
                at, told = postures[at].end, True
            elif at in starts or not (words[at] in _PARTS or (told and is_number_word(words[at]))):
                break
            elif words[at] in self._joins and at + 1 in postures:
                break  # "sit 2 stand"
            else:
                at += 1
        return at if told else 0

    def _clip_that_others_continue(self, words: Words, followers: Mapping[Words, int]) -> None:
        count = followers.get(words, 0)
        core = words[: len(words) - count_variant_words(words)]
        if not core or self._other(core) or core in self.found or any(w in self._joins for w in core):
            return
        if self._acts(core) and not (self._poses(core) and self._goes_on(words)):
            return
        if count >= 2 and not any(p.meaning == "transition" for p in find_phrases(core, self._kinds)):
            self._add(core, 0.85, phrase("{count} names begin with it", count=count), words, core)

    def _poses(self, words: Words) -> bool:
        """Whether words may be a posture, though they may be an act as well: "head tilt left"."""
        return bool(find_phrases(words, self._patterns.meanings["postures"]))

    def _goes_on(self, words: Words) -> bool:
        """Whether other names say after these words what is done: then these say where."""
        count = len(words)
        after = self._distinct[bisect_right(self._distinct, words) :]  # they are sorted
        rests = [name[count:] for name in takewhile(lambda name: name[:count] == words, after)]
        doing = [r for r in rests if self._acts(r) or r[0] in self._joins]
        return len(doing) > 1 and 2 * len(doing) >= len(rests)

    def _heads(self, distinct: Sequence[TakenName]) -> None:
        """Beginnings before a double underscore, and beginnings that tell a posture."""
        heads: dict[Words, int] = {}
        for taken in distinct:
            if taken.split:
                head = taken.words[: taken.split]
                heads[head] = heads.get(head, 0) + 1
        for head, count in heads.items():
            core = head[: len(head) - count_variant_words(head)]
            if (
                core
                and (count >= 2 or self.postural(core))
                and not self._acts(core)
                and not self._other(core)
            ):
                self._add(core, 0.9, phrase("{count} names begin with it", count=count), head, core)
        runs: dict[Words, int] = {}
        for taken in distinct:
            n = 0 if taken.split else self._posture_run(taken.words)
            run = self._trimmed(taken.words[:n])
            if 0 < n < len(taken.words) and not self._only_number(taken.words[n:]):
                runs[run] = runs.get(run, 0) + 1
        for run, count in runs.items():
            if not run or any(run in s.prefixes for s in self.found.values()):
                continue
            if (
                count > 1
                or run[0] == "idle"
                or any(self._bare(run) == self._bare(s.words) for s in self.found.values())
            ):
                bare = run[:-1] if len(run) > 1 and self._kinds.get(run[-1]) == "stance" else run
                self._add(bare, 0.75, " ".join(as_written(run)), run)

    def _trimmed(self, run: Words) -> Words:
        """Leave out what belongs to the act that follows: numbers and body parts, "idle finger" of "idle
        finger nail".
        """
        run = run[: len(run) - count_variant_words(run)]
        told = max((p.end for p in find_phrases(run, self._patterns.meanings["postures"])), default=0)
        while len(run) > told and run[-1] not in _PLACES and run[-1] not in self._patterns.meanings["limbs"]:
            run = run[:-1]
        return run

    def _passed_between(self, distinct: Sequence[TakenName]) -> None:
        """Stances that only transitions name: the other end of one that is known, or both where there is a
        way back.
        """
        pairs: dict[tuple[Words, Words], str] = {}
        for taken in distinct:
            words = taken.words[: len(taken.words) - count_variant_words(taken.words)]
            for at in range(1, len(words) - 1):
                if (
                    self._joins.get(words[at]) == "to"
                    and words[at] != "2"
                    and not any(w in _PARTS for w in words[:at])
                ):
                    pairs[words[:at], words[at + 1 :]] = words[at]
        known = {prefix for stance in self.found.values() for prefix in stance.prefixes}
        for (start, end), joined in sorted(pairs.items()):
            if (
                (start in known or (end, start) in pairs)
                and (not self._acts(end) or self._poses(end))
                and not self._other(end)
                and not self._sister(end)
            ):
                self._add(end, 0.7, " ".join(as_written((joined, *end))), end)

    def _sister(self, end: Words) -> bool:
        """Whether an end is short for a stance that is known: "tilt left" for "head tilt left"."""
        bare = self._bare(end)
        return not bare or any(
            self._bare(s.words)[-len(bare) :] == bare or set(self._bare(s.words)) < set(bare)
            for s in self.found.values()
        )

    def _only_number(self, words: Words) -> bool:
        return count_variant_words(words) == len(words)

    def _designated(self, distinct: Sequence[TakenName]) -> None:
        """Stances called alike except for a number or letter ("idle 1", "idle 2", "sit a") are different ones
        where clips go on from one or pass into it, whether or not they have clips of their own.
        """
        marks: dict[Words, dict[str, bool]] = {}  # core -> designator -> whether anything goes on from it
        ends: set[Words] = set()  # of which one, with its designator, a transition ends in
        for taken in distinct:
            words = taken.words
            for start in (0, *(i + 1 for i, w in enumerate(words) if i and self._joins.get(w) == "to")):
                for at in range(start + 1, len(words)):
                    core = words[start:at]
                    if is_designator(words[at]) and self._stands(core):
                        rest = words[at + 1 :]
                        goes_on = start > 0 or count_variant_words(rest) < len(rest)
                        mine = marks.setdefault(core, {})
                        mine[words[at]] = mine.get(words[at], False) or goes_on
                        if start > 0:
                            ends.add(core)
                        break
        plain = {taken.words for taken in distinct}
        for core, mine in marks.items():
            if not any(mine.values()) or (len(mine) < 2 and not (core in ends and core in plain)):
                continue
            held = self.found.get(core)
            confidence, why = (held.confidence, held.why) if held else (0.75, " ".join(as_written(core)))
            for mark in mine:
                if held is not None:
                    held.prefixes.discard((*core, mark))
                self._add((*core, mark), confidence, why, (*core, mark))
            plainly = any(
                t.words[: len(core)] == core and not (t.words[len(core) :] and t.words[len(core)] in mine)
                for t in distinct
            )
            if held is not None and not plainly:
                del self.found[core]

    def _stands(self, core: Words) -> bool:
        """Whether words may be what a stance is called, a number apart."""
        return core in self.found or (not self._acts(core) and not self._other(core) and self.postural(core))

    def _united(self) -> None:
        """One stance spelled in several ways ("seated", "sitting") is one, called by its surest name."""
        spelled: dict[Words, list[FoundStance]] = {}
        for stance in self.found.values():
            spelled.setdefault(tuple(map(find_stem, stance.words)), []).append(stance)
        for several in spelled.values():
            first, *others = sorted(several, key=lambda s: (-s.confidence, s.words))
            for other in others:
                first.prefixes |= other.prefixes
                del self.found[other.words]

    # -- asking

    def of(self, words: Words, split: int = 0) -> tuple[FoundStance, int] | None:
        """Return the stance whose clips begin as these words do, and how many words that takes."""
        for n in range(min(len(words), self._longest), 0, -1):
            found = self._by_prefix.get(words[:n])
            if found is not None and not (split and n > split and words[:split] in self._by_prefix):
                return found, n
        return None

    def known(self, words: Words) -> FoundStance | None:
        """Return the stance that words, a number after them apart, are the name of."""
        for n in range(count_variant_words(words) + 1):
            if len(words) > n and (found := self._by_prefix.get(words[: len(words) - n])) is not None:
                return found
        return None

    def common(self, stance: FoundStance) -> bool:
        """Whether most clips begin with a stance: then what goes on from it is whatever there is, not a
        fidget.
        """
        return self._begun.get(stance.words, 0) > COMMON * self._count

    def within(self, words: Words) -> tuple[FoundStance, int, int] | None:
        """Return a stance of posture that is reported after what is done ("talk_sitting_01"), and from where
        to where.
        """
        best: tuple[int, int, FoundStance] | None = None
        for start in range(1, len(words)):
            for end in range(min(len(words), start + self._longest), start, -1):
                found = self._by_prefix.get(words[start:end])
                if (
                    found is not None
                    and self.postural(words[start:end])
                    and (best is None or end - start > best[0])
                ):
                    best = end - start, start, found
        return None if best is None else (best[2], best[1], best[1] + best[0])

    def named(self, words: Sequence[str], beside: Words = ()) -> tuple[FoundStance, float] | None:
        """Return the stance that words mean and how surely; `beside`: the stance one comes from, whose
        sisters are likelier.
        """
        key = (tuple(words), beside)
        if key not in self._resolved:
            self._resolved[key] = self._named(*key)
        return self._resolved[key]

    def _named(self, words: Words, beside: Words) -> tuple[FoundStance, float] | None:
        if (exact := self.known(words)) is not None:  # "idle 2" before "idle": the number may tell which
            return exact, 0.98
        asked = self._bare(words)
        marks = _marks(words)
        if not asked:
            whole = [w for w in words if not is_number_word(w)]
            plain = [s for s in self.found.values() if whole and s.words == tuple(whole)]
            return (plain[0], 0.95) if plain else None
        best: tuple[tuple[float, float, int, Words], FoundStance] | None = None
        for stance in self.found.values():
            own = self._bare(stance.words)
            theirs = _marks(stance.words)
            if not own or (theirs and marks and theirs != marks):
                continue
            if own == asked:
                score = 0.96
            elif own[-len(asked) :] == asked:
                score = 0.95 if beside and self._bare(beside)[:1] == own[:1] else 0.9
            elif set(asked) < set(own):
                score = 0.75
            elif set(own) < set(asked):
                score = 0.65
            else:
                continue
            sister = float(bool(beside) and stance.words[:1] == beside[:1])
            rank = (score, sister, -len(own), stance.words)
            if best is None or rank[:3] > best[0][:3] or (rank[:3] == best[0][:3] and rank[3] < best[0][3]):
                best = rank, stance
        return (best[1], best[0][0]) if best else None

    def _bare(self, words: Words) -> Words:
        """Return the words by which stances are compared: stems, without numbers and "idle"."""
        known = self._bares.get(words)
        if known is None:
            kept = [w for w in drop_numbers(words) if self._kinds.get(w) != "stance" and w not in _BARE]
            known = self._bares[words] = tuple(find_stem(w) for w in kept)
        return known

    def standing(self) -> FoundStance | None:
        """Return the stance of standing with nothing more said: "stand", or plain "idle"."""
        upright = [s for s in self.found.values() if "stand" in map(find_stem, s.words)]
        if upright:
            return min(upright, key=lambda s: (len(s.words), s.words))
        return self.found.get(("idle",))

    def low(self, words: Sequence[str] = ()) -> FoundStance | None:
        """Return the stance of sitting or lying that words speak of; without any, the only one there is."""
        there = [s for s in self.found.values() if is_low(s.words)]
        told = {find_stem(w) for w in drop_numbers(words)}
        verb = told & set(_STEMS_DOWN)
        fitting = [s for s in there if not verb or verb & {find_stem(w) for w in s.words}]
        if not fitting or (len(fitting) > 1 and not verb):
            return None
        return min(
            fitting, key=lambda s: (-len(told & {find_stem(w) for w in s.words}), len(s.words), s.words)
        )

    def usual(self) -> tuple[FoundStance, float] | None:
        """Return the stance of clips that name none: the only one, or the plain one among several."""
        if len(self.found) == 1:
            return next(iter(self.found.values())), 0.75
        plain = self.found.get(("idle",)) or self.found.get(("stand",)) or self.found.get(("standing",))
        return (plain, 0.6) if plain else None


def _marks(words: Words) -> Words:
    """Return the numbers and letters that tell a stance from others called alike."""
    return tuple(w for n, w in enumerate(words) if n and is_designator(w))


def is_low(words: Sequence[str]) -> bool:
    return any(find_stem(w) in _STEMS_DOWN for w in words)


def _followers(distinct: Sequence[TakenName]) -> dict[Words, int]:
    """For every name's words: how many other names begin with them and go on with more than a number."""
    own = {t.words for t in distinct}
    out: dict[Words, int] = {}
    for words in own:
        for n in range(1, len(words)):
            if words[:n] in own and count_variant_words(words[n:]) < len(words) - n:
                out[words[:n]] = out.get(words[:n], 0) + 1
    return out
