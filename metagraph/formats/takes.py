"""Do what every reader does to a take: find its name and frame rate, and remove poses that do not belong to
it.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import join_phrases, phrase
from metagraph.formats.stray_poses import StrayPoses, find_stray_poses
from metagraph.motion import rotation
from metagraph.motion.clip import Clip, Repair
from metagraph.motion.skeleton import Pose

Array = NDArray[Any]

# What readers repair by default, and leave as it is if asked to.
BIND_POSE, UNIT, UP, NAME, ONE_FRAME = "bind_pose", "unit", "up_axis", "name", "one_frame"
LONE_FRAME, FROM_OFFSET, FRAME_TIME = "lone_frame", "from_offset", "frame_time"
REPAIRS = (BIND_POSE, UNIT, UP, NAME, ONE_FRAME, LONE_FRAME, FROM_OFFSET, FRAME_TIME)

# Default names of tools; the file's name says more.
_GENERIC = re.compile(
    r"(?i)(take|untitled|animation|anim|action|default|scene|clip|unreal "
    r"take|mixamo\.com|bindpose|animstack)[ _.:]*\d*"
)
_RATES = (
    30.0,
    24.0,
    25.0,
    60.0,
    50.0,
    48.0,
    30000 / 1001,
    24000 / 1001,
    60000 / 1001,
    120.0,
    100.0,
    240.0,
    90.0,
    72.0,
)


def take_name(raw: str, stem: str) -> str:
    """Return a take's name, or the file's stem if the take has no name or a tool's default ("Take 001")."""
    parts = [part.strip() for part in raw.split("|") if part.strip()]
    parts = [
        part
        for part in parts
        if not re.fullmatch(r"(?i)armature(\.\d+)?|base ?layer|layer ?\d*|root|rig", part)
    ]
    if not parts or any(_GENERIC.fullmatch(part) for part in parts):
        return stem
    return " ".join(dict.fromkeys(parts))


def take_repair(raw: str, name: str, stem: str, as_is: Collection[str]) -> tuple[str, Repair | None]:
    """Return the name of a take called `raw` in its file, and the repair that this name is, if any. `name` is
    the result of `take_name`.
    """
    raw = raw.strip()
    if not raw or raw == name:
        return name, None
    made = NAME not in as_is
    words = (
        phrase("named after its file instead of '{name}'", name=raw)
        if name == stem
        else phrase("the names of the rig and the layer were removed from its name")
    )
    return name if made else raw, Repair(NAME, words, made)


def note_repair(clip: Clip, repair: Repair | None) -> Clip:
    """Return the clip with a note that a repair was made, or was not."""
    if repair is None:
        return clip
    return replace(clip, notes=(*clip.notes, repair_note(repair)), repairs=(*clip.repairs, repair))


def repair_note(repair: Repair) -> str:
    """Return the note of a repair that was made, or was not."""
    if repair.made:
        return repair.words
    return phrase("left as it is in the file, without this: {repair}", repair=repair.words)


def guess_frame_rate(keys: Sequence[Array], wanted: float | None = None) -> float:
    """Return the frames per second on which key times (seconds, each array ascending) lie; 30 if any rate
    fits.

    `wanted` is a rate to prefer if the keys lie on it.
    """
    start = min((float(k[0]) for k in keys if len(k)), default=0.0)
    every = np.concatenate([np.asarray(k, float) for k in keys] or [np.zeros(1)])
    if not (every[1:] > every[:-1]).all():
        every = np.unique(every)
    every = every - start
    if len(every) < 2:
        return wanted or 30.0
    slack = 1e-3 + 2e-7 * float(every[-1] + abs(start)) * 30
    for rate in (wanted, *_RATES) if wanted else _RATES:
        frames = every * rate
        if np.abs(frames - np.round(frames)).max() <= slack * max(1.0, rate / 30):
            return rate
    gaps = np.diff(every)
    gap = float(np.median(gaps[gaps > 1e-4])) if (gaps > 1e-4).any() else 1 / 30
    rate = float(np.clip(1 / gap, 10.0, 240.0))
    if abs(rate - round(rate)) < 0.05:
        rate = float(round(rate))
    even = np.abs(gaps * rate - np.round(gaps * rate)).max() < 0.05
    return rate if even else 60.0 if rate > 45 else 30.0


def drop_stray_poses(
    clips: Sequence[Clip], as_is: Collection[str] = (), bound: Sequence[Pose] = ()
) -> list[Clip]:
    """Drop bind poses that a tool left at the clips' ends, mend frames unlike both their neighbours, and note
    it. Repairs named in `as_is` are only noted.

    `bound` are other poses besides the rest pose that a tool may have left there.
    """
    found = find_stray_poses(clips, bound)
    return [_without(clip, some, as_is) for clip, some in zip(clips, found, strict=True)]


def _tell_bind(end: str, count: int) -> str:
    """Return what is said of bind poses at an end of a clip: "first" or "last"."""
    if count == 1:
        return (
            phrase("its first frame was the bind pose and was removed")
            if end == "first"
            else phrase("its last frame was the bind pose and was removed")
        )
    return (
        phrase(
            "its first {count} frames were the bind pose or on the way from it, and were removed", count=count
        )
        if end == "first"
        else phrase(
            "its last {count} frames were the bind pose or on the way to it, and were removed", count=count
        )
    )


def _without(clip: Clip, found: StrayPoses, as_is: Collection[str]) -> Clip:
    if found.first or found.last:
        made = BIND_POSE not in as_is
        told = [
            _tell_bind(end, count) for end, count in (("first", found.first), ("last", found.last)) if count
        ]
        repair = Repair(BIND_POSE, join_phrases(told, "; "), made)
    if found.lone:
        mended = LONE_FRAME not in as_is
        words = (
            phrase(
                "frame {frame} was unlike both its neighbours and was interpolated between them",
                frame=found.lone[0] + 1,
            )
            if len(found.lone) == 1
            else phrase(
                "{count} frames (the first is {frame}) were unlike their neighbours and were interpolated "
                "between them",
                count=len(found.lone),
                frame=found.lone[0] + 1,
            )
        )
        clip = note_repair(_mended(clip, found.lone) if mended else clip, Repair(LONE_FRAME, words, mended))
    if found.first or found.last:
        clip = note_repair(clip.trimmed(found.first, clip.frames - found.last) if made else clip, repair)
    return clip


def _mended(clip: Clip, frames: Sequence[int]) -> Clip:
    """Return the clip with these frames halfway between their neighbours."""
    at = np.asarray(frames)
    rotations, translations = clip.rotations.copy(), clip.translations.copy()
    half = np.full((len(at), len(clip.skeleton)), 0.5, np.float32)
    rotations[at] = rotation.nlerp(rotations[at - 1], rotations[at + 1], half)
    translations[at] = (translations[at - 1] + translations[at + 1]) / 2
    weights = None if clip.weights is None else clip.weights.copy()
    if weights is not None:
        weights[at] = (weights[at - 1] + weights[at + 1]) / 2
    return replace(
        clip, rotations=rotation.make_continuous(rotations), translations=translations, weights=weights
    )


def make_takes_unique(clips: Sequence[Clip]) -> list[Clip]:
    """Number takes of one file that share a name: walk, walk_2."""
    seen: dict[str, int] = {}
    taken = {clip.name for clip in clips}
    out = []
    for clip in clips:
        seen[clip.name] = seen.get(clip.name, 0) + 1
        name, n = clip.name, seen[clip.name]
        if n > 1:
            while f"{clip.name}_{n}" in taken:
                n += 1
            name = f"{clip.name}_{n}"
            seen[clip.name] = n
            taken.add(name)
        out.append(clip if name == clip.name else clip.renamed(name))
    return out
