"""Takes to learn from: motion with its speech and its source; and the split into training and held-out
takes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.generation.features import (
    MELS,
    NONE,
    PARTNER,
    RATE,
    SELF,
    compute_features,
    count_sound_frames,
    resample_for_features,
    tell_by_sound,
    tell_conversation,
)
from metagraph.generation.loudness import compute_gain, measure_integrated_loudness
from metagraph.generation.networks import ACTIVITY, FPS
from metagraph.generation.poses import (
    PoseError,
    PoseRig,
    Standardisation,
    encode_clip,
    orthonormalise_rows,
    scale_of,
)
from metagraph.graph.conversation.model import Conversation, list_segments_heard_by
from metagraph.motion.clip import Clip
from metagraph.motion.mirror import find_joint_twins, mirror

Array = NDArray[Any]

SHORTEST = 4.0  # seconds of a take
LEAST_SOUND = 1.0  # deviation of a mel, of natural logarithms: less is a band that one recording lacks
SPOKEN = 0.5  # seconds somebody speaks in a take at least
APART = 6.0  # seconds between what is learned from and what is held out of one take
HELD = 0.15  # of all takes' length is held out
BLOCK = 4.0  # seconds that are compared to find out whether takes share a stretch
_AT_ONCE = 16  # blocks
ALIKE, MOVED = 0.98, 0.95  # correlation of what is heard, and of how much is moved, from which on they do


class TakeError(ValueError):
    """A take that cannot be learned from; the message says which, why, and what would help."""


class SplitError(ValueError):
    """Takes that cannot be split into takes to learn from and takes held out."""


@dataclass(frozen=True)
class TakeSource:
    """Where a take is from. name: as people know it. digests: sha256 of its files, motion first. licence: a
    line. start: seconds of the source before its first frame. mirrored: left and right are exchanged.
    """

    name: str
    digests: tuple[str, ...] = ()
    licence: str = ""
    start: float = 0.0
    mirrored: bool = False


@dataclass(frozen=True)
class TakeMarks:
    """Moments of a take, seconds from its first frame. peaks: stresses of own clauses. responses: where own
    responses begin. hesitations: where the partner hesitates and oneself says nothing.
    """

    peaks: tuple[float, ...] = ()
    responses: tuple[float, ...] = ()
    hesitations: tuple[float, ...] = ()

    def shifted(self, start: float, end: float) -> TakeMarks:
        """Return those from start to end, counted from start."""

        def cut(moments: tuple[float, ...]) -> tuple[float, ...]:
            return tuple(t - start for t in moments if start <= t < end)

        return TakeMarks(cut(self.peaks), cut(self.responses), cut(self.hesitations))


NO_MARKS = TakeMarks()


@dataclass(frozen=True, eq=False)
class Take:
    """A take, FPS frames a second. poses `[T, X]` and features `[T, ...]`, as `features`
    has them, float32, not standardised.
    notes: what there is to know about how it was read, in words.
    """

    source: TakeSource
    poses: Array
    features: Array
    marks: TakeMarks = NO_MARKS
    notes: tuple[str, ...] = ()

    @property
    def seconds(self) -> float:
        return len(self.poses) / FPS

    @property
    def activity(self) -> Array:
        """Who speaks, `[T, 4]`."""
        return np.asarray(self.features[:, -ACTIVITY:])

    def part(self, first: int, last: int) -> Take:
        """Return frames first to last, excluded."""
        first = max(0, first)
        last = max(first, min(last, len(self.poses)))
        source = replace(self.source, start=self.source.start + first / FPS)
        marks = self.marks.shifted(first / FPS, last / FPS)
        return replace(
            self, source=source, poses=self.poses[first:last], features=self.features[first:last], marks=marks
        )


@dataclass(frozen=True, eq=False)
class TakeSound:
    """What is heard with a take. samples: `[C, N]`, own voice first, then the partner's where there is one.
    clipped: share of each channel's samples that were cut off at full scale.
    """

    samples: Array
    rate: int
    clipped: Sequence[float] = ()


def make_take(
    rig: PoseRig,
    clip: Clip,
    heard: TakeSound,
    source: TakeSource,
    conversation: Conversation | None = None,
    side: int = 0,
    tracks: int = 1,
) -> Take:
    """Return a take. conversation: who says what when, `side` being this take's; None: loudness tells. Raises
    TakeError.
    """
    notes: list[str] = []
    who = f"'{source.name}'"
    try:
        poses = encode_clip(rig, clip, FPS)
    except PoseError as error:
        raise TakeError(f"{who}: {error}") from None
    sound = np.atleast_2d(np.asarray(heard.samples, np.float32))
    if not np.isfinite(sound).all() or not np.isfinite(poses).all():
        raise TakeError(f"{who} holds a value that is not a number: export it anew")
    sound = resample_for_features(sound, heard.rate)[:2]
    count = min(len(poses), count_sound_frames(sound.shape[1]))
    if count < SHORTEST * FPS:
        shorter = "motion" if len(poses) <= count_sound_frames(sound.shape[1]) else "sound"
        raise TakeError(
            f"{who}: its {shorter} lasts {count / FPS:.1f} s, too short to learn from (at least "
            f"{SHORTEST:g} s)"
        )
    if abs(len(poses) - count_sound_frames(sound.shape[1])) > FPS:
        notes.append(
            phrase(
                "{who}: the motion lasts {count:.1f} s but the sound {shape:.1f} s; the rest is "
                "skipped. Check that both start at the same moment.",
                who=who,
                count=len(poses) / FPS,
                shape=sound.shape[1] / RATE,
            )
        )
    shared = conversation is not None and all(s.segments for s in conversation.sides)
    _check_sound(who, sound, heard.clipped, shared, notes)
    if tracks == 2 and len(sound) == 1:
        sound = np.concatenate([sound, np.zeros_like(sound)])
    if conversation is None:
        notes.append(
            phrase(
                "{who} has no words: speech is detected from loudness, and strokes cannot be judged.", who=who
            )
        )
        partner = sound[1] if len(sound) > 1 else None
        told, marks = tell_by_sound(sound[0], partner, RATE, count), TakeMarks()
    else:
        told, marks = tell_conversation(conversation, side, count), _marks(conversation, side)
    activity = told[:, -ACTIVITY:]
    own = activity[:, SELF].sum() / FPS
    if activity[:, NONE].sum() / FPS > count / FPS - SPOKEN:
        raise TakeError(f"{who}: nobody speaks in it. Check which sound belongs to it")
    if own < SPOKEN:
        notes.append(phrase("{who}: this speaker hardly speaks and teaches only listening.", who=who))
    elif not activity[:, PARTNER].any():
        notes.append(phrase("{who}: the partner never speaks, so it teaches only speaking.", who=who))
    gains = [compute_gain(channel, RATE) for channel in sound]
    audio = compute_features(sound, told, tracks, gains)[:count]
    if float(poses[:count].std(0).max()) < 1e-3:
        raise TakeError(f"{who} does not move above the hips: there is nothing to learn")
    marks = marks.shifted(0.0, count / FPS)
    return Take(source, poses[:count], audio, marks, tuple(notes))


def _check_sound(who: str, sound: Array, clipped: Sequence[float], shared: bool, notes: list[str]) -> None:
    """shared: one channel has both voices, and the words tell whose each is."""
    silent = [not np.isfinite(measure_integrated_loudness(channel, RATE)) for channel in sound]
    if all(silent):
        raise TakeError(f"{who}: its sound is silent. Check the microphone, or which channel is its own")
    if len(sound) == 1 and not shared:
        notes.append(
            phrase("{who} has only one voice: the speaker's own. The partner never speaks.", who=who)
        )
    elif len(sound) == 1:
        notes.append(
            phrase(
                "{who}: both voices are in one channel, so their loudness cannot be evened out separately.",
                who=who,
            )
        )
    elif silent[0]:
        notes.append(
            phrase(
                "{who}: the speaker's own channel is silent, so it teaches only listening. Check "
                "whether the channels are swapped.",
                who=who,
            )
        )
    elif silent[1]:
        notes.append(phrase("{who} has only one voice: the partner's channel is silent.", who=who))
    worst = max(clipped, default=0.0)
    if worst > 0.02:
        raise TakeError(
            f"{who}: {100 * worst:.2g} % of its sound is cut off at full scale. Record it softer, or "
            "export it anew"
        )
    if worst > 1e-4:
        notes.append(phrase("{who}: {value:.2g} % of the sound is clipped.", who=who, value=100 * worst))


def _marks(conversation: Conversation, side: int) -> TakeMarks:
    segments = list_segments_heard_by(conversation, side)
    return TakeMarks(
        tuple(s.peak for s in segments if s.kind == "clause" and s.peak is not None),
        tuple(s.start for s in segments if s.kind == "response"),
        tuple(s.start for s in segments if s.kind == "hesitation"),
    )


def mirror_take(rig: PoseRig, clip: Clip, take: Take) -> Take:
    """Return a take's twin: left and right of its clip exchanged, what is heard as it was. Raises TakeError
    if the skeleton is not the same on both sides.
    """
    try:
        poses = encode_clip(rig, mirror(clip, find_joint_twins(clip.skeleton)), FPS)
    except ValueError as error:
        raise TakeError(str(error)) from None
    first = round(take.source.start * FPS)
    return replace(
        take, source=replace(take.source, mirrored=True), poses=poses[first : first + len(take.poses)]
    )


def measure_scales(takes: Sequence[Take], audio: int = MELS) -> tuple[Standardisation, Standardisation]:
    """Return what standardises poses, and `audio` numbers of what is heard, of takes: pitch and marks stay as
    they are, so that 0 remains what is not known.
    """
    mels = audio // MELS * MELS
    sound = scale_of(np.concatenate([t.features[:, :mels] for t in takes]), LEAST_SOUND)
    rest = np.zeros(audio - mels, np.float32)
    scale = Standardisation(
        np.concatenate([sound.mean, rest]), np.concatenate([sound.deviation, np.ones_like(rest)])
    )
    return scale_of(np.concatenate([t.poses for t in takes])), scale


# --- splits


def split_takes(
    takes: Sequence[Take], share: float = HELD, seed: int = 1
) -> tuple[tuple[Take, ...], tuple[Take, ...]]:
    """Return takes to learn from and takes held out: whole ones, with all that share a file with them. Where
    there is one alone, a block is cut out of it, and APART seconds on both sides of it. Raises SplitError.
    """
    groups = _groups(takes)
    total = sum(t.seconds for t in takes)
    if len(groups) < 2:
        learned, held = _block_of(takes, share)
    else:
        order = np.random.default_rng(seed).permutation(len(groups)).tolist()
        chosen: set[int] = set()
        for g in order:  # at least one; then those that come nearest to the share
            length = sum(takes[n].seconds for n in groups[g])
            before = sum(takes[n].seconds for c in chosen for n in groups[c])
            closer = abs(before + length - share * total) < abs(before - share * total)
            if len(chosen) < len(groups) - 1 and (not chosen or closer):
                chosen.add(g)
        inside = {n for g in chosen for n in groups[g]}
        learned = tuple(t for n, t in enumerate(takes) if n not in inside)
        held = tuple(t for n, t in enumerate(takes) if n in inside)
    check_split(learned, held)
    return learned, held


def _groups(takes: Sequence[Take]) -> list[list[int]]:
    """Return takes by what they share: a file, motion or sound."""
    group = list(range(len(takes)))
    seen: dict[str, int] = {}
    for n, take in enumerate(takes):
        for digest in take.source.digests or (f"name {take.source.name}",):
            if digest in seen:
                old, new = group[n], group[seen[digest]]
                group = [new if g == old else g for g in group]
            else:
                seen[digest] = n
    return [[n for n, g in enumerate(group) if g == which] for which in dict.fromkeys(group)]


def _block_of(takes: Sequence[Take], share: float) -> tuple[tuple[Take, ...], tuple[Take, ...]]:
    if not takes:
        raise SplitError("there is no take to hold out")
    longest = max(t.seconds for t in takes)
    length = share * longest
    if length < SHORTEST or longest - length - APART < SHORTEST:
        raise SplitError(
            f"all takes are of one recording of {longest:.0f} s, too short to hold a part of it out: add "
            "takes"
        )
    end = max(t.source.start + t.seconds for t in takes)
    begin = end - length
    learned, held = [], []
    for t in takes:
        first = round((begin - t.source.start) * FPS)
        if (early := t.part(0, round((begin - APART - t.source.start) * FPS))).seconds >= SHORTEST:
            learned.append(early)
        if (late := t.part(first, len(t.poses))).seconds >= SHORTEST:
            held.append(late)
    return tuple(learned), tuple(held)


def check_split(learned: Sequence[Take], held: Sequence[Take]) -> None:
    """Raise SplitError where a held-out take is also learned from: the same recording less than APART seconds
    away, or its mirror twin, also where they are other files and only sound and move alike.
    """
    if not learned or not held:
        raise SplitError("one half of the takes is empty: add takes")
    signs = {id(t): _signature(t) for t in (*learned, *held)}
    for h in held:
        for t in learned:
            if _near(t, h) or _alike(signs[id(t)], signs[id(h)]):
                how = "its mirror twin" if t.source.mirrored != h.source.mirrored else "a stretch of it"
                raise SplitError(
                    f"'{h.source.name}' is held out, but {how} ('{t.source.name}') is learned from: "
                    "hold out both"
                )


def _near(a: Take, b: Take) -> bool:
    """Whether takes are of one recording and less than APART seconds from each other."""
    same = bool(a.source.digests[:1]) and a.source.digests[:1] == b.source.digests[:1]
    ends = (a.source.start + a.seconds, b.source.start + b.seconds)
    slack = APART - 0.5 / FPS
    return same and a.source.start - slack < ends[1] and b.source.start - slack < ends[0]


def share_stretch(a: Take, b: Take) -> bool:
    """Whether BLOCK seconds of two takes sound and move alike at the same moments, left and right exchanged
    or not. Either alone is no sign: the same speech is performed twice, and the same gesture made again.
    """
    return _alike(_signature(a), _signature(b))


def _alike(a: tuple[Array, Array], b: tuple[Array, Array]) -> bool:
    size = round(BLOCK * FPS)
    count = len(b[0]) // size
    pieces = b[0][: count * size].reshape(count, size)
    for first in range(0, count, _AT_ONCE):
        found = _correlation(a[0], pieces[first : first + _AT_ONCE])
        for n, at in zip(*np.nonzero(found > ALIKE), strict=True):
            start = (first + int(n)) * size
            both = a[1][at : at + size], b[1][start : start + size]
            if min(x.std() for x in both) > 1e-4 and np.corrcoef(*both)[0, 1] > MOVED:
                return True
    return False


def _signature(take: Take) -> tuple[Array, Array]:
    """Return how loud each frame is, and how far its joints are turned: the same for mirror twins."""
    matrices = orthonormalise_rows(take.poses.reshape(len(take.poses), -1, 2, 3))
    cosine = (np.trace(matrices, axis1=-2, axis2=-1) - 1) / 2
    heard = take.features[:, :MELS].mean(1, dtype=np.float64)
    return heard, np.arccos(np.clip(cosine, -1, 1)).sum(-1)


def _correlation(whole: Array, pieces: Array) -> Array:
    """Return the correlation of each piece `[n, B]` with each stretch of the whole, `[n, T - B + 1]`; 0 for
    pieces that do not vary.
    """
    count, size = pieces.shape
    if len(whole) < size:
        return np.zeros((count, 0))
    length = 1 << int(np.ceil(np.log2(len(whole) + size)))
    whole = whole - whole.mean()
    spread = pieces.std(1, keepdims=True)
    unit = (pieces - pieces.mean(1, keepdims=True)) / (np.maximum(spread, 1e-6) * size)
    product = np.fft.irfft(np.fft.rfft(whole, length) * np.conj(np.fft.rfft(unit, length)), length)
    sums, squares = (np.concatenate([[0.0], np.cumsum(x)]) for x in (whole, whole**2))
    mean = (sums[size:] - sums[:-size]) / size
    deviation = np.sqrt(np.maximum((squares[size:] - squares[:-size]) / size - mean**2, 1e-12))
    return np.asarray(np.where(spread > 1e-6, product[:, : len(mean)] / deviation, 0.0))
