"""Words as constraints: where a certain word is said, motion is to come from where a take says it, or one
alike (the future work of Yang et al., section 9).

Which words, and what is alike, the user says: nothing is known of any language.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import join_phrases, phrase
from metagraph.graph.conversation.model import Word
from metagraph.graph.vocabulary import Vocabulary, split_tokens
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import TOLERANCE
from metagraph.synthesis.graph import BLEND
from metagraph.synthesis.prosody_costs import SpokenTake
from metagraph.synthesis.search.frame_costs import FrameCost
from metagraph.synthesis.states import States, SynthesisError

Array = NDArray[Any]

AROUND = BLEND  # frames before and after a word that are its too: no transition is blended into it
PRICE = 2.0  # of the graph's threshold: what a word costs that is missed, unless another price is given


@dataclass(frozen=True)
class WordWish:
    """said: words or short phrases that want motion. alike: what a take may say there instead; what is said
    is alike itself.
    """

    said: tuple[str, ...]
    alike: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """What it is called: its first word."""
        return self.said[0]


def parse_word_wish(text: str) -> WordWish:
    """Return what is wished by "big", "big = huge, tall" (motion for "big", of takes that say any of them) or
    "big, huge" (for both, of either). Raises ValueError if a side names no word.
    """
    left, equals, right = text.partition("=")
    said, alike = (tuple(w.strip() for w in part.split(",") if split_tokens(w)) for part in (left, right))
    if not said or (equals and not alike):
        raise ValueError(
            f"'{text.strip()}' names no word: say big, or big = huge, tall, or big, huge where each may "
            "stand for the other"
        )
    return WordWish(said, alike)


@dataclass(frozen=True, eq=False)
class WordPlace:
    """A word of the new speech that wants motion. text: as it was said. frames: the first and the one after
    the last that are its. at: its middle, seconds. near `[frames, F]`: which states may come at each, none
    where no take says it.
    """

    text: str
    at: float
    frames: tuple[int, int]
    near: Array

    @property
    def known(self) -> bool:
        """Whether any take says it."""
        return bool(self.near.any())

    def met(self, way: Array) -> bool:
        """Whether the states `[T]` of a path come from around the word all along."""
        return bool(self.near[np.arange(len(self.near)), np.asarray(way)[slice(*self.frames)]].all())


def find_phrase_spans(words: Sequence[Word], phrases: Sequence[str]) -> list[tuple[float, float, str]]:
    """Return start, end and text of each phrase that is said, by start: the longest where several begin, none
    within another.
    """
    vocabulary, ordered = Vocabulary(phrases), sorted(words, key=lambda w: w.start)
    parts = [split_tokens(w.text) for w in ordered]
    out, n = [], 0
    while n < len(ordered):
        count = vocabulary.at(parts, n) if parts[n] else 0
        if count:
            some = ordered[n : n + count]
            out.append((some[0].start, max(w.end for w in some), " ".join(w.text.strip() for w in some)))
        n += max(1, count)
    return out


def find_word_places(
    wishes: Sequence[WordWish],
    states: States,
    takes: Sequence[SpokenTake],
    new: SpokenTake,
    start: float,
    seconds: float,
    tolerance: float = TOLERANCE,
) -> tuple[WordPlace, ...]:
    """Return where new speech, from a second of it on, says what is wished, by time; where two wishes want
    the same moment the first of them has it.

    At a frame so far from the middle of a word, a state may come that is as far from the middle of such a
    word in its take, give or take the tolerance, seconds. Raises SynthesisError if there are not as many
    takes, or neither side's words have times.
    """
    if len(takes) != len(states.starts) - 1:
        raise SynthesisError(f"{len(states.starts) - 1} takes have states, but {len(takes)} have speech")
    if wishes and not (new.words and any(t.words for t in takes)):
        whose = "the new speech" if not new.words else "the takes"
        raise SynthesisError(
            f"no words of {whose} have times, so none can be looked for: give transcripts with words"
        )
    frames = max(1, round(seconds * RATE))
    taken, found = np.zeros(frames, bool), []
    for wish in wishes:
        middles = [
            (number, (a + b) / 2 * RATE)
            for number, take in enumerate(takes)
            for a, b, _ in find_phrase_spans(take.words, (*wish.said, *wish.alike))
        ]
        for a, b, text in find_phrase_spans(new.words, wish.said):
            middle = ((a + b) / 2 - start) * RATE
            first, after = max(0, round((a - start) * RATE)), min(frames, round((b - start) * RATE))
            if 0 <= middle < frames and not taken[first:after].any():
                taken[first:after] = True
                found.append((first, max(first + 1, after), middle, text, middles))
    found.sort(key=lambda one: one[0])
    out = []
    for number, (first, after, middle, text, middles) in enumerate(found):
        before = found[number - 1][1] if number else -frames  # what is between two words each has half of
        then = found[number + 1][0] if number + 1 < len(found) else 2 * frames
        first = max(0, first - min(AROUND, (first - before) // 2))
        after = min(frames, after + min(AROUND, (then - after + 1) // 2))
        near = _near(states, middles, middle, first, after, tolerance * RATE)
        out.append(WordPlace(text, middle / RATE, (first, after), near))
    return tuple(out)


def _near(
    states: States, middles: Sequence[tuple[int, float]], middle: float, first: int, after: int, slack: float
) -> Array:
    out = np.zeros((after - first, len(states)), bool)
    for number, there in middles:
        begin, end = int(states.starts[number]), int(states.starts[number + 1])
        for t in range(first, after):
            at = begin + there + t - middle
            low, high = int(np.ceil(at - slack - 0.5)), int(np.floor(at + slack + 0.5))
            out[t - first, max(begin, low) : max(begin, min(end, high + 1))] = True
    if out.any():
        out[~out.any(1)] = True  # where all takes are cut off nothing is asked
    return out


def measure_word_cost(
    places: Sequence[WordPlace], frames: int, price: float, limit: float
) -> FrameCost | None:
    """Return what frames cost that show nothing of a word they should. price: of a word that is missed all
    along, of the graph's threshold (limit, metres); for a part of it as much less.
    """
    known = [p for p in places if p.known]
    if not known:
        return None
    at, rows, count = np.full(frames, -1, np.int32), [], 0
    for p in known:
        rows.append(price * limit / len(p.near) * ~p.near)
        at[slice(*p.frames)] = count + np.arange(len(p.near))
        count += len(p.near)
    return FrameCost("words", at, np.concatenate(rows).astype(np.float32))


def find_states_of_words(places: Sequence[WordPlace]) -> dict[int, Array]:
    """Return, as `WantedSegment.only` has it, the states that alone may come at each word some take says."""
    return {p.frames[0] + n: near for p in places if p.known for n, near in enumerate(p.near)}


@dataclass(frozen=True)
class WordShown:
    """What became of a word. text, at: as said, seconds. known: whether any take says it. met: whether motion
    is from where one does. take, there: from which, and from which second of it; None if it is not met.
    """

    text: str
    at: float
    known: bool
    met: bool
    take: int | None = None
    there: float | None = None


def find_words_shown(places: Sequence[WordPlace], states: States, way: Array) -> tuple[WordShown, ...]:
    """Return what became of each word by the states `[T]` of a path."""
    out = []
    for p in places:
        if not p.known or not p.met(way):
            out.append(WordShown(p.text, p.at, p.known, False))
            continue
        state = int(way[min(round(p.at * RATE), len(way) - 1)])
        take = states.take(state)
        out.append(WordShown(p.text, p.at, True, True, take, (state - int(states.starts[take])) / RATE))
    return tuple(out)


def find_unsaid_wishes(
    wishes: Sequence[WordWish], new: SpokenTake, start: float, seconds: float
) -> tuple[str, ...]:
    """Return the wishes, by name, of which nothing is said in new speech, from a second of it on."""
    return tuple(
        wish.name
        for wish in wishes
        if not any(
            start <= (a + b) / 2 < start + seconds for a, b, _ in find_phrase_spans(new.words, wish.said)
        )
    )


def describe_words(shown: Sequence[WordShown], never: Sequence[str] = ()) -> str:
    """Return how well words are met, or "" if no words were given. never: the words of
    `find_unsaid_wishes`.
    """
    parts = []
    if shown:
        met = sum(w.met for w in shown)
        parts.append(
            phrase(
                "{met} of {count} words have the motion of a take that says them", met=met, count=len(shown)
            )
        )
    missed = [f"'{w.text}' ({w.at:.1f} s)" for w in shown if w.known and not w.met]
    absent = list(dict.fromkeys(f"'{w.text}'" for w in shown if not w.known))
    if missed:
        parts.append(phrase("missed: {words}", words=_first_of(missed)))
    if absent:
        parts.append(phrase("no take says {words}", words=_first_of(absent)))
    if never:
        parts.append(phrase("not in this speech: {words}", words=_first_of([f"'{w}'" for w in never])))
    return join_phrases(parts, "; ") if parts else ""


def _first_of(words: Sequence[str]) -> str:
    """Return up to five words, and how many more there are."""
    first, more = ", ".join(words[:5]), len(words) - 5
    return phrase("{words} and {more} more", words=first, more=more) if more > 0 else first
