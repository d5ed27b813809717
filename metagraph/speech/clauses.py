"""Divide what one side of a conversation says into segments: phonemic clauses, listener responses and its own
hesitation pauses.

A phonemic clause is a group of words around one that is strongly stressed (Boomer and Dittmann 1962; Yang et
al. 2020, section 4.2). Words are divided at pauses and hesitations. Longer runs are divided so that each part
has one word that stands out by pitch, loudness and length, with breaks preferably before small words, at
commas and where the speaker continues a little later; parts of about four words are preferred.

A response is a turn, with pauses around it, that has only response words: a "yes" within a sentence is part
of the sentence. Hesitation words are hesitations everywhere; those that also have a meaning ("well", "like",
"you know") only if they are alone, next to another hesitation, or before a pause after which the same speaker
continues. Words that can be both ("mh", 嗯) are hesitations if the same speaker soon continues.

A language pack says which words these are (`language_packs`); if the language is unknown, the sound decides.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise, zip_longest
from typing import Any

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from metagraph.graph.conversation.model import SHORTEST, Segment, Spoken, Word
from metagraph.graph.vocabulary import Vocabulary, join_tokens, make_word_vocabularies, split_tokens
from metagraph.speech.activity import PAUSE, SpokenStretch, find_activity
from metagraph.speech.language_packs import LanguagePack, read_english_pack
from metagraph.speech.pitch import Pitch, find_pitch_peaks, smooth
from metagraph.speech.sound import HeardSound
from metagraph.speech.stress import CLOSED, measure_stresses, split_into_clauses

Array = NDArray[Any]

HOLDS = 1.5  # seconds within which a hesitating speaker continues
SOON = 0.8  # seconds within which a speaker continues as if without a pause
LONGEST_RESPONSE = 2.5  # seconds that a response lasts at most
BURST = 0.6  # seconds: without words, a sound this short while the partner talks is a response
AROUND = 0.5  # seconds of the speaker's own silence before and after it
LONGEST_CLAUSE = 3.5  # seconds: without words, longer clauses are divided where they are softest
_ASKED = (".", "?", "!", "。", "？", "！", "।", "؟", "．")


@dataclass(frozen=True, slots=True)
class _Part:
    """Words that are one segment, from `first` up to, but not including, `last`."""

    kind: Spoken
    first: int
    last: int


def find_segments(
    words: Sequence[Word],
    pitch: Pitch,
    heard: HeardSound,
    responses: Collection[str] | None = None,
    hesitations: Collection[str] | None = None,
    partner: HeardSound | None = None,
    language: LanguagePack | None = None,
) -> tuple[Segment, ...]:
    """Return one side's clauses, responses and hesitations, by start, never overlapping.

    `words` are as transcribed, by start. `pitch` and `heard` are those of the side's own channel, `partner`
    that of the other side, if that is another channel. `responses` and `hesitations` replace the language's
    own lists. `language` is None for English. Without words, `find_segments_by_sound` is used.
    """
    words = order_words(words, heard.duration)
    if not words:
        return find_segments_by_sound(words, pitch, heard, partner)
    spoken = language if language is not None else read_english_pack()
    lists = [
        tuple(own if some is None else some)
        for own, some in ((spoken.responses, responses), (spoken.hesitations, hesitations))
    ]
    answers, pauses, _, both = make_word_vocabularies(lists[0], lists[1])
    tones = smooth(pitch)
    said = [split_tokens(w.text) for w in words]
    found = _parts(words, said, answers, pauses, both, spoken.lexical)
    return _segments(words, said, found, pitch, tones, heard, spoken)


def find_segments_by_sound(
    words: Sequence[Word], pitch: Pitch, heard: HeardSound, partner: HeardSound | None
) -> tuple[Segment, ...]:
    """Return one side's clauses and responses without understanding words, because there are none or their
    language is unknown. Hesitations are not found.

    Loudness decides (`activity.find_activity`): a sound between pauses is a clause, a short sound while the
    partner talks a response. If a channel is shared or nothing stands out from it, the times of words decide.
    """
    words, tones = order_words(words, heard.duration), smooth(pitch)
    found = _by_loudness(pitch, tones, heard, partner) if partner is not None or not words else ()
    if found or not words:
        return tuple(
            replace(s, text=join_tokens(w.text for w in words if s.start <= (w.start + w.end) / 2 < s.end))
            for s in found
        )
    said = [split_tokens(w.text) for w in words]
    return _segments(
        words, said, [_Part("clause", a, b) for a, b in _turns(words)], pitch, tones, heard, None
    )


def _segments(
    words: Sequence[Word],
    said: Sequence[tuple[str, ...]],
    parts: Sequence[_Part],
    pitch: Pitch,
    tones: Array,
    heard: HeardSound,
    language: LanguagePack | None,
) -> tuple[Segment, ...]:
    """Return parts as segments, with clauses divided further by stress."""
    stress = measure_stresses(words, said, tones, heard, language)
    out: list[Segment] = []
    for part in parts:
        groups = [(part.first, part.last)]
        if part.kind == "clause":
            groups = split_into_clauses(words, said, stress, part.first, part.last, language)
        for first, last in groups:
            out.append(_segment(part.kind, words[first:last], pitch, tones, heard))
    return tuple(out)


def order_words(words: Sequence[Word], length: float) -> list[Word]:
    """Return the words by start, none longer than to the next one's start, none past the length (seconds).
    Words that become too short are removed.
    """
    ordered = sorted(words, key=lambda w: (w.start, w.end))
    out: list[Word] = []
    for word, after in zip_longest(ordered, ordered[1:]):
        end = min(
            word.end,
            length,
            after.start if after is not None and after.start > word.start + SHORTEST / 2 else length,
        )
        start = max(word.start, out[-1].end) if out else word.start
        if end - start >= SHORTEST / 2:
            out.append(
                word if (start, end) == (word.start, word.end) else Word(text=word.text, start=start, end=end)
            )
    return out


def _segment(kind: Spoken, words: Sequence[Word], pitch: Pitch, tones: Array, heard: HeardSound) -> Segment:
    start, end = words[0].start, words[-1].end
    return Segment(
        kind,
        start,
        end,
        find_stress_time(pitch, tones, heard, start, end) if kind == "clause" else None,
        join_tokens(w.text for w in words),
    )


def find_stress_time(pitch: Pitch, tones: Array, heard: HeardSound, start: float, end: float) -> float:
    """Return the time of the stress between two times, in seconds: F0's most prominent peak or, without a
    voice, the loudest moment. `tones` is `pitch.smooth(pitch)`.
    """
    found = find_pitch_peaks(pitch, start, end, tones)
    if found:
        return min(max(round(found[0], 3), start), end)
    part = slice(int(np.searchsorted(heard.times, start)), int(np.searchsorted(heard.times, end, "right")))
    level = heard.level[part]
    return (
        min(max(round(float(heard.times[part][int(level.argmax())]), 3), start), end)
        if len(level)
        else (start + end) / 2
    )


# --- by words


def _parts(
    words: Sequence[Word],
    said: Sequence[tuple[str, ...]],
    responses: Vocabulary,
    hesitations: Vocabulary,
    both: Vocabulary,
    lexical: Vocabulary,
) -> list[_Part]:
    """Divide the words into responses, hesitations and runs between pauses, of which clauses are made, in
    order.
    """
    out: list[_Part] = []
    for first, last in _turns(words):
        answers = responses.made_of(said[first:last]) and _answers(words, first, last)
        whole = tuple(t for w in said[first:last] for t in w)
        unsure = answers and (whole in hesitations or both.made_of(said[first:last]))
        if unsure and _goes_on(words, first, last):
            out.append(_Part("hesitation", first, last))
        elif answers:
            out.append(_Part("response", first, last))
        else:
            out += _hesitating(words, said, first, last, responses, hesitations, lexical)
    return out


def _goes_on(words: Sequence[Word], first: int, last: int) -> bool:
    """Return whether the same speaker continues at once after words, or after a while having spoken just
    before.
    """
    after = words[last].start - words[last - 1].end if last < len(words) else np.inf
    before = words[first].start - words[first - 1].end if first else np.inf
    return bool(after <= SOON or max(before, after) <= HOLDS)


def _turns(words: Sequence[Word]) -> list[tuple[int, int]]:
    """Return runs of words without a pause between them."""
    edges = [0, *(n for n in range(1, len(words)) if words[n].start - words[n - 1].end >= PAUSE), len(words)]
    return [(a, b) for a, b in pairwise(edges) if a < b]


def _hesitating(
    words: Sequence[Word],
    said: Sequence[tuple[str, ...]],
    first: int,
    last: int,
    responses: Vocabulary,
    hesitations: Vocabulary,
    lexical: Vocabulary,
) -> list[_Part]:
    """Divide a turn into hesitations and what is between them; what is between is a response if it has only
    response words.
    """
    marks = [0] * (last - first)  # the number of words in a hesitation that begins here
    n = first
    while n < last:
        size = hesitations.at(said[:last], n)
        if size and responses.at(said[:last], n) > size:  # "uh-huh" is not "uh"
            size = 0
            n += responses.at(said[:last], n)
            continue
        marks[n - first] = size
        n += max(size, 1)
    # A word with a meaning counts only by what is around it; go from the end, because it may depend on one
    # after it.
    for n in reversed(range(first, last)):
        size = marks[n - first]
        if (
            size
            and lexical.is_plainly(tuple(t for w in said[n : n + size] for t in w))
            and not _hangs(words, n, size, first, last, marks)
        ):
            marks[n - first] = 0
    out: list[_Part] = []
    n = begin = first
    while n <= last:
        size = marks[n - first] if n < last else 1
        if not size:
            n += 1
            continue
        if n > begin:
            alone = responses.made_of(said[begin:n]) and (n < last or begin > first)
            out.append(_Part("response" if alone and _answers(words, begin, n) else "clause", begin, n))
        if n < last:
            if out and out[-1].kind == "hesitation" and out[-1].last == n:
                out[-1] = _Part("hesitation", out[-1].first, n + size)
            else:
                out.append(_Part("hesitation", n, n + size))
        n = begin = n + size
    return out


def _hangs(words: Sequence[Word], n: int, size: int, first: int, last: int, marks: Sequence[int]) -> bool:
    """Return whether words with a meaning are a hesitation: alone between pauses, next to another hesitation
    and a pause, or before a pause after which the speaker continues; not at the end of a sentence.
    """
    begins, ends = n == first, n + size == last
    leans = not ends and marks[n + size - first] > 0
    goes_on = n + size < len(words) and words[n + size].start - words[n + size - 1].end <= HOLDS
    asked = words[n + size - 1].text.rstrip(CLOSED).endswith(_ASKED)
    if begins and ends:
        return True
    return (
        (begins and leans)
        or (ends and goes_on and not asked)
        or (leans and any(marks[m - first] and m + marks[m - first] == n for m in range(first, n)))
    )


def _answers(words: Sequence[Word], first: int, last: int) -> bool:
    return words[last - 1].end - words[first].start <= LONGEST_RESPONSE


# --- without words


def _by_loudness(
    pitch: Pitch, tones: Array, heard: HeardSound, partner: HeardSound | None
) -> tuple[Segment, ...]:
    own = find_activity(heard, pitch, partner)
    others = find_activity(partner, None, heard) if partner is not None else ()
    out: list[Segment] = []
    for n, s in enumerate(own):
        before = s.start - own[n - 1].end if n else np.inf
        after = own[n + 1].start - s.end if n + 1 < len(own) else np.inf
        if s.end - s.start < BURST and min(before, after) >= AROUND and _meanwhile(s, others):
            out.append(Segment("response", s.start, s.end))
            continue
        for start, end in _shorter(s, heard):
            out.append(Segment("clause", start, end, find_stress_time(pitch, tones, heard, start, end)))
    return tuple(out)


def _meanwhile(s: SpokenStretch, others: Sequence[SpokenStretch]) -> bool:
    """Return whether the partner talks during a stretch, or stops or starts right beside it."""
    return any(o.start < s.end + AROUND and o.end > s.start - AROUND for o in others)


def _shorter(s: SpokenStretch, heard: HeardSound) -> list[tuple[float, float]]:
    """Return a stretch in parts that are not too long, cut where it is softest."""
    if s.end - s.start <= LONGEST_CLAUSE:
        return [(s.start, s.end)]
    third = (s.end - s.start) / 4
    part = slice(
        int(np.searchsorted(heard.times, s.start + third)), int(np.searchsorted(heard.times, s.end - third))
    )
    at = round(float(heard.times[part][int(heard.level[part].argmin())]), 3)
    return [*_shorter(SpokenStretch(s.start, at), heard), *_shorter(SpokenStretch(at, s.end), heard)]
