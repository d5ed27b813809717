"""A path through a motion graph as a clip: frames of takes one after another, blended where they do not
follow, walking on from where they are (Yang et al., section 7.1).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.suggest.tracks import RATE, measure_facing_and_standing, sample_clip_poses, track_rig
from metagraph.synthesis.graph import BLEND
from metagraph.synthesis.retiming import Retiming
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.standing_feet import find_standing, keep_feet_still
from metagraph.synthesis.states import States, SynthesisError

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class _Frames:
    """All states' poses in their own takes: rotations `[F, J, 4]`, translations `[F, J, 3]`; where the hips
    are over the ground `[F, 2]`, x and z, and where the character faces `[F]`, radians about y from +z.
    """

    rotations: Array
    translations: Array
    ground: Array
    heading: Array


@dataclass(frozen=True, eq=False)
class _Walk:
    """A path over the ground: its states `[T]`, where the hips are `[T, 2]` and where they face `[T]`."""

    states: Array
    ground: Array
    heading: Array


def assemble(
    states: States,
    clips: Sequence[Clip],
    path: Path,
    name: str = "synthesised",
    blend: int = BLEND,
    hold_feet: bool = True,
    onward: bool = False,
    retiming: Retiming | None = None,
) -> Clip:
    """Return a path's motion, RATE frames a second. clips: those the states are of. It begins over the
    origin, facing +z; from there the root goes on by what each frame goes on in its take. blend: frames on
    either side of a transition in which one motion fades into the other, by a cosine, rotations along the
    shortest way (slerp). hold_feet: where it goes from piece to piece, feet that stood in the takes stay
    where they were put down. onward: all of the blend comes after the transition, as live, if nobody knew of
    it before. retiming: how it is played faster and slower; feet are held by what is then shown. Raises
    SynthesisError when the takes are others.
    """
    takes = [c for c in clips if c.frames >= 2]
    frames = _frames(takes)
    if len(frames.heading) != len(states):
        raise SynthesisError(
            f"the graph is of {len(states)} frames, but these takes have {len(frames.heading)}"
        )
    way = np.asarray(path.states, np.int64)
    walk = _walk(frames, way, ~_first(states))
    out = _moved(frames, way, walk.ground, walk.heading)
    roots = np.flatnonzero(takes[0].skeleton.parents < 0)
    edges = [0, *path.jumps.tolist(), len(way)]
    for number, jump in enumerate(path.jumps.tolist()):
        # No further than half way to the next transition, and than the takes go on.
        before = min(blend, (jump - edges[number] + 1) // 2)
        after = min(blend, (edges[number + 2] - jump) // 2)
        if onward:
            before, after = 0, min(2 * blend, edges[number + 2] - jump)
        _blend(out, frames, states, walk, jump, (before, after))
    joints = sorted({0, *roots.tolist(), *(j for c in takes for j in c.translated)})
    made = Clip(
        name,
        takes[0].skeleton,
        RATE,
        rotation.make_continuous(rotation.normalize(out.rotations)).astype(np.float32),
        out.translations[:, joints].astype(np.float32),
        tuple(joints),
        notes=(
            f"synthesised from {len({states.take(int(s)) for s in way})} takes with {len(path.jumps)} "
            "transitions",
        ),
    )
    if retiming is not None:
        poses = made.pose_at(retiming.moments / RATE)
        turns = rotation.make_continuous(poses.rotations).astype(np.float32)
        made = replace(made, rotations=turns, translations=poses.translations[:, joints])
        way = way[retiming.frames]
    if not hold_feet or not len(path.jumps):
        return made
    each = [find_standing(c.skeleton, sample_clip_poses(c)) for c in takes]
    feet = {side: np.concatenate([one[side] for one in each])[way] for side in each[0]}
    return keep_feet_still(made, feet)


def _first(states: States) -> Array:
    out = np.zeros(len(states), bool)
    out[states.starts[:-1]] = True
    return out


def _frames(takes: Sequence[Clip]) -> _Frames:
    rig = track_rig(takes[0], None)
    rotations, translations, ground, heading = [], [], [], []
    for clip in takes:
        poses = sample_clip_poses(clip)
        facing, at = measure_facing_and_standing(rig, poses)
        rotations.append(poses.rotations)
        translations.append(poses.translations)
        ground.append(at[:, rig.root][:, [0, 2]])
        heading.append(np.arctan2(facing[:, 0], facing[:, 1]))
    parts = (rotations, translations, ground, heading)
    return _Frames(*(np.concatenate([np.asarray(x, np.float64) for x in part]) for part in parts))


def _turned(v: Array, angle: Array) -> Array:
    """Return x and z `[..., 2]` turned about y."""
    s, c = np.sin(angle), np.cos(angle)
    return np.stack([c * v[..., 0] + s * v[..., 1], c * v[..., 1] - s * v[..., 0]], axis=-1)


def _walk(frames: _Frames, way: Array, has_before: Array) -> _Walk:
    """Return a path's walk, by what each frame goes on from the one before it in its own take."""
    before = np.where(has_before[way], way - 1, way)
    step = _turned(frames.ground[way] - frames.ground[before], -frames.heading[before])
    turn = frames.heading[way] - frames.heading[before]
    turn = (turn + np.pi) % (2 * np.pi) - np.pi
    turn[0] = 0.0
    heading = np.cumsum(turn)
    from_heading = np.concatenate([[0.0], heading[:-1]])
    going = _turned(step, from_heading)
    going[0] = 0.0
    return _Walk(way, np.cumsum(going, axis=0), heading)


def _moved(frames: _Frames, which: Array, ground: Array, heading: Array) -> Pose:
    """Return poses of states with their hips over another place, facing elsewhere."""
    turn = heading - frames.heading[which]
    zero = np.zeros_like(turn)
    about = np.stack([zero, np.sin(turn / 2), zero, np.cos(turn / 2)], axis=-1)
    rotations, translations = frames.rotations[which].copy(), frames.translations[which].copy()
    rotations[:, 0] = rotation.multiply(about, rotations[:, 0])
    root = translations[:, 0]
    flat = _turned(root[:, [0, 2]] - frames.ground[which], turn) + ground
    translations[:, 0] = np.stack([flat[:, 0], root[:, 1], flat[:, 1]], axis=-1)
    return Pose(rotations, translations)


def _blend(
    out: Pose, frames: _Frames, states: States, walk: _Walk, jump: int, about: tuple[int, int]
) -> None:
    """Fade one motion into the other about a transition: before it towards what the new take did there, after
    it away from what the old one would have gone on to do. about: for how many frames before and after.
    """
    way, before, span = walk.states, about[0], sum(about)
    if not span:
        return
    weight = 0.5 - 0.5 * np.cos(np.pi * (np.arange(span) + 1) / (span + 1))
    for number in range(span):
        t = jump - before + number
        offset = t - jump
        if offset < 0:
            other = int(way[jump]) + offset
            take = states.take(int(way[jump]))
        else:
            other = int(way[jump - 1]) + 1 + offset
            take = states.take(int(way[jump - 1]))
        other = min(max(other, int(states.starts[take])), int(states.starts[take + 1]) - 1)
        # It stands where this one does: only how it moves its limbs is blended, the ground is walked over by
        # the path alone.
        there = _moved(frames, np.array([other]), walk.ground[t : t + 1], walk.heading[t : t + 1])
        w = float(weight[number]) if offset < 0 else 1.0 - float(weight[number])
        out.rotations[t] = rotation.slerp(
            out.rotations[t], there.rotations[0], np.full(len(out.rotations[t]), w)
        )
        out.translations[t] = out.translations[t] * (1 - w) + there.translations[0] * w
