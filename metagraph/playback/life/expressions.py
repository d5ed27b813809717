"""Small events of the face: drawn with the other life layers, shown by `shown_face`, `answer` and `settle`.

What is known and followed here: speakers raise their brows on stressed words (Cave et al. 1996), from about
60 ms before the accent (Flecha-Garcia 2010), and where they ask (Ekman 1979); greeting, people flash their
brows for about a third of a second (Eibl-Eibesfeldt 1972); felt smiles come and go in 2/3 to 4 s and raise
the cheeks (Ekman and Friesen 1982), posed ones may stay. So the face of a mood rises and falls back to a part
of it, instead of being constant. How much, how often and for which tags is ours.

If `Life.expressions` is 0, or at full stillness, the face of a mood is constant and nothing else is added.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from metagraph.graph.life import Life
from metagraph.playback.life.items import find_line_start, measure_line
from metagraph.playback.life.lane import Lane
from metagraph.playback.life.track import Speech, Track
from metagraph.playback.life.voice import Voice, stressed
from metagraph.playback.planning.choice import chance_of, keyed, uniform
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.mood import Bearing, faded, within

# Swells: how the face of a mood comes up; rows: length s, amount, 1 where the mode was listening.
SWELL_GAP = 3.5  # seconds between two, on average
SHORTEST_SWELL = 0.9
LONGEST_SWELL = 4.0
SWELL_RISES = 0.35  # of its length
KEPT = 0.75  # of a mood's face between swells
WARMTH = 0.35  # of a smile that a listener's swell is
# Emphases: brows raised in speech, and where somebody reacts to something; rows: length s, amount, rise s.
EARLY = 0.06  # seconds a raise begins before its syllable
RAISE = 0.35  # seconds it takes at least
RAISE_CHANCE = 0.3  # and what chance adds
RAISE_RISES = 0.12
ASKING = 0.8  # seconds before the end of a question that its brows begin to rise, but in its second half
ASKING_ON = 0.5  # seconds they take to sink after it
ASKING_LIFTS = 0.8  # of a full raise
REACTING = 1.2  # seconds they take where a reaction begins
LONGEST_EMPHASIS = 1.5  # seconds
# Cues: what those with certain tags show.
CUE_RISES = 0.25  # seconds
CUE_LASTS = 1.8
CUE_FALLS = 0.6
FLASH_FROM = 0.1  # seconds after a greeting begins
FLASH_RISES = 0.08
FLASH_LASTS = 0.4
GREETING = "greeting"
# Of smile, frown, brow_down, brow_up, brows.
SHOWN: dict[str, list[float]] = {
    "greeting": [0.6, 0.0, 0.0, 0.0, 0.1], "positive": [0.3, 0.0, 0.0, 0.0, 0.15],
    "agree": [0.1, 0.0, 0.0, 0.0, 0.1], "negative": [0.0, 0.2, 0.35, 0.0, 0.0],
    "surprise": [0.0, 0.0, 0.0, 0.0, 0.9], "question": [0.0, 0.0, 0.0, 0.0, 0.6],
    "unsure": [0.0, 0.3, 0.0, 0.2, 0.5], "thinking": [0.0, 0.1, 0.35, 0.0, 0.0],
}  # fmt: skip
MARKS: tuple[str, ...] = ("?", "？", "؟")  # at the end of questions
DUCHENNE = 0.2  # the smile from which on cheeks rise


@dataclass
class FaceShown:
    """The weights of a face's channels, without lids and lips. brow_up raises only the inner ends of the
    brows, brows the whole of them. The same object is filled again for each time (`shown_face`, `answer`,
    `settle`).
    """

    smile: float = 0.0
    frown: float = 0.0
    brow_down: float = 0.0
    brow_up: float = 0.0
    brows: float = 0.0
    cheeks: float = 0.0


def swells_on(track: Track, seed: Bits, cut: float, drawn: float, before: Lane) -> Lane:
    """Return the lane of swells filled from `cut` to `drawn` seconds."""
    times: list[float] = []
    rows: list[list[float]] = []
    number = before.next
    over = before.times[-1] + before.rows[-1][0] if len(before.times) > 0 else 0.0
    while True:
        key = keyed(seed, "swell", str(number))
        gap = SWELL_GAP * (0.3 + 1.4 * chance_of(key, "gap"))
        at = max(cut, over + gap)
        if at >= drawn:
            return before.plus(times, rows)
        length = SHORTEST_SWELL
        length += (LONGEST_SWELL - SHORTEST_SWELL) * chance_of(key, "length")
        amount = 0.6 + 0.4 * chance_of(key, "amount")
        times.append(at)
        rows.append([length, amount, 1.0 if track.told_mode(at) == "listening" else 0.0])
        over = at + length
        number += 1


def emphases_on(
    life: Life,
    track: Track,
    voices: Mapping[str, Voice],
    seed: Bits,
    cut: float,
    drawn: float,
    before: Lane,
) -> Lane:
    """Return the lane of emphases filled from `cut` to `drawn` seconds: on the share of stressed syllables
    that `accent_brows` says, at the end of questions, and where a reaction begins.
    """
    found: list[list[float]] = []
    for speech in track.speeches:
        if speech.end <= cut or speech.start >= drawn:
            continue
        for n, peak in enumerate(stressed(voices, speech)):
            begin = find_line_start(speech)
            at = max(speech.start, begin + peak - EARLY)
            if at >= speech.end or begin + peak < speech.start:
                continue
            if uniform(seed, speech.id, "brows", str(n)) >= life.accent_brows:
                continue
            chance = uniform(seed, speech.id, "raise", str(n))
            found.append([at, RAISE + RAISE_CHANCE * chance, 0.5 + 0.5 * chance, RAISE_RISES])
        if asks(speech):
            length = measure_line(speech)
            lead = min(ASKING, 0.5 * length)
            at = max(speech.start, find_line_start(speech) + length - lead)
            if at < speech.end:
                found.append([at, lead + ASKING_ON, ASKING_LIFTS, lead])
    for change in track.modes:
        if change.mode == "reacting" and life.accent_brows > 0:
            chance = uniform(seed, change.id, "raise")
            found.append([change.start, REACTING, 0.6 + 0.4 * chance, RAISE_RISES])
    times: list[float] = []
    rows: list[list[float]] = []
    for event in sorted(found, key=lambda x: (x[0], x[3])):
        if cut <= event[0] < drawn:
            times.append(event[0])
            rows.append(event[1:])
    return before.plus(times, rows)


def asks(speech: Speech) -> bool:
    """Return whether a speech is a question, by its last sign."""
    text = speech.text.strip()
    return text != "" and any(text.rpartition(mark)[2] == "" for mark in MARKS)


def shown_face(
    face: FaceShown, life: Life, swells: Lane, emphases: Lane, bears: Bearing, seconds: float
) -> None:
    """Fill in the face at a time, from the mood and the drawn events."""
    calm = 1 - life.stillness
    swell, warm = 0.0, 0.0
    n = bisect_right(swells.times, seconds) - 1
    if n >= 0:
        length, amount, listens = swells.rows[n][0], swells.rows[n][1], swells.rows[n][2]
        gone = seconds - swells.times[n]
        rise = SWELL_RISES * length
        swell = amount * faded(min(gone / rise, (length - gone) / (length - rise)))
        warm = listens * swell
    share = 1 - calm * min(1.0, life.expressions) * (1 - KEPT) * (1 - swell)
    much = calm * life.expressions
    brows = 0.0
    n = bisect_right(emphases.times, seconds) - 1
    while n >= 0 and seconds - emphases.times[n] < LONGEST_EMPHASIS:
        length, amount, rise = emphases.rows[n][0], emphases.rows[n][1], emphases.rows[n][2]
        gone = seconds - emphases.times[n]
        brows = max(brows, amount * faded(min(gone / rise, (length - gone) / (length - rise))))
        n -= 1
    face.smile = share * bears.smile + much * WARMTH * warm * (1 - bears.frown)
    face.frown = share * bears.frown
    face.brow_down = share * bears.brow_down
    face.brow_up = share * bears.brow_up
    face.brows = share * bears.brows + much * brows


def answer(
    face: FaceShown, life: Life, tags: Sequence[str], start: float, end: float, seconds: float
) -> None:
    """Add what a cue with these tags, from `start` to `end`, shows on a face at a time."""
    much = (1 - life.stillness) * life.expressions
    if much <= 0 or seconds <= start or seconds >= min(end, start + CUE_LASTS):
        return
    gone = seconds - start
    shows = much * faded(min(gone / CUE_RISES, (min(end, start + CUE_LASTS) - seconds) / CUE_FALLS))
    for tag in tags:
        if tag in SHOWN:
            of = SHOWN[tag]
            face.smile += shows * of[0]
            face.frown += shows * of[1]
            face.brow_down += shows * of[2]
            face.brow_up += shows * of[3]
            face.brows += shows * of[4]
        if tag == GREETING:
            flash = gone - FLASH_FROM
            left = FLASH_LASTS - flash
            face.brows += much * faded(min(flash / FLASH_RISES, left / (FLASH_LASTS - FLASH_RISES)))


def settle(face: FaceShown) -> None:
    """Clamp all weights to 0..1, and raise the cheeks with a smile."""
    face.smile = within(face.smile, 0.0, 1.0)
    face.frown = within(face.frown, 0.0, 1.0)
    face.brow_down = within(face.brow_down, 0.0, 1.0)
    face.brow_up = within(face.brow_up, 0.0, 1.0)
    face.brows = within(face.brows, 0.0, 1.0)
    face.cheeks = within((face.smile - DUCHENNE) / (1 - DUCHENNE), 0.0, 1.0)
