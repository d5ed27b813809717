"""The law of continuity: what is added to clips moves no joint more than `MOST_WAY` or `MOST_TURN` in a
sixtieth of a second beyond what the clips do.

What a stage of the evaluator adds is measured against the stage before it. A joint may do what it did there,
or any part of it: a hand that is kept out of the body, or a foot that is held, does less. All that it does
besides is added. In a blend a joint may go as fast as in the clips that blend, and as fast as it usually goes
in all clips: up to the 99th percentile.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Action, Project
from metagraph.motion import rotation
from metagraph.motion.joint_map import find_known_roles
from metagraph.motion.skeleton import Pose
from metagraph.playback.own_moves import RATE, find_body_joints, play_clips
from metagraph.playback.plan import Cue, LayerPlan, Plan, Rest
from metagraph.playback.posing.composer import find_composer
from metagraph.playback.posing.cue_times import SEAM
from metagraph.playback.posing.layers import LayersStage

Array = NDArray[Any]
Globals = tuple[Array, Array]  # rotations [N, J, 4] and positions [N, J, 3] in the character's space

MOST_WAY = 0.03  # metres, of a figure of TALL
MOST_TURN = float(np.radians(8.0))
TALL = 1.75  # metres
USUAL = 99.0  # the percentile of the clips' own moves that counts as what they do
# What turns faster than that by nature: eyes in saccades, lids in blinks, jaws in speech.
FACE = ("jaw", *(f"{s}_{part}" for s in ("left", "right") for part in ("eye", "upper_lid", "lower_lid")))


@dataclass(frozen=True, eq=False)
class AddedMoves:
    """What a stage adds from each pose to the next. ways `[N-1, J]`: metres, of a figure of TALL. turns
    `[N-1, J]`: radians.
    """

    ways: Array
    turns: Array

    @property
    def breaks(self) -> Array:
        """Each move as a multiple of what the law allows, `[N-1, J]`; above 1 breaks it."""
        return np.maximum(self.ways / MOST_WAY, self.turns / MOST_TURN)

    def worst(self, joints: Sequence[int]) -> Array:
        """Return of each pose, for the joint that breaks the law most, way, turn, by how much, and which of
        `joints` it is: `[4, N-1]`.
        """
        breaks = self.breaks
        rows, most = np.arange(len(breaks)), breaks.argmax(1)
        found = [x[rows, most] for x in (self.ways, self.turns, breaks)]
        return np.stack([*found, np.asarray(joints)[most]])


class ContinuityLaw:
    """Says what blends, and the stages of a project's evaluators, add to clips. joints: those it looks at,
    all but the face's.
    """

    def __init__(self, project: Project) -> None:
        """Raises ValueError for a project without a skeleton."""
        if project.skeleton is None:
            raise ValueError("The project has no skeleton: import a clip first.")
        self.project, self.skeleton = project, project.skeleton
        self.joints = find_moved_joints(project)
        self._size = max(1e-6, project.skeleton.height / TALL)

    def added(self, stages: Iterable[tuple[str, Pose]]) -> Mapping[str, AddedMoves]:
        """Return what each stage but the first adds, by its name. stages: poses a sixtieth of a second apart,
        as `Evaluator.stages` yields them.
        """
        out: dict[str, AddedMoves] = {}
        before: Globals | None = None
        pose: Pose | None = None
        for name, shown in stages:
            after = before if before is not None and shown is pose else self._globals(shown)
            if before is after:
                nothing = np.zeros((max(0, len(after[0]) - 1), len(self.joints)))
                out[name] = AddedMoves(nothing, nothing)
            elif before is not None:
                out[name] = measure_added_moves(before, after, self._size)
            before, pose = after, shown
        return out

    def blended(self, plan: Plan, times: Array, shown: Pose) -> AddedMoves:
        """Return what blends do beyond what the clips do; nothing if nothing blends.

        times `[N]`: a sixtieth of a second apart. shown: what the layers of `plan` compose then.
        """
        far, turned = measure_moves(moves_of(self._globals(shown)))
        own_far, own_turned = self._own(plan, times)
        mixed = find_blending(self.project, plan, times[1:])[:, None]
        return AddedMoves(
            np.where(mixed, np.maximum(0, far - np.maximum(own_far, self._usual[0])), 0) / self._size,
            np.where(mixed, np.maximum(0, turned - np.maximum(own_turned, self._usual[1])), 0),
        )

    def _globals(self, pose: Pose) -> Globals:
        turned, at = self.skeleton.globals(pose)
        return turned[:, self.joints].astype(np.float64), at[:, self.joints].astype(np.float64)

    @cached_property
    def _usual(self) -> tuple[Array, Array]:
        return measure_usual_moves(self.project, self.joints)

    def _own(self, plan: Plan, times: Array) -> tuple[Array, Array]:
        """Return how far joints go, metres, and turn, radians, from each time to the next, `[N-1, J]`, where
        no clip blends: the sum over the layers of what their cues do alone, or the stances under them,
        whichever is more, then or a sixtieth of a second before or after.
        """
        out = np.zeros((2, max(0, len(times) - 1), len(self.joints)))
        for of in plan.layers.values():
            rests = tuple(replace(rest, fade=0.0, action=_without_seam(rest.action)) for rest in of.rests)
            cues = tuple(replace(cue, blend_in=0.0, blend_out=0.0) for cue in of.cues)
            stances = self._alone(plan, replace(of, cues=(), rests=rests), times)
            out += np.maximum(stances, self._alone(plan, replace(of, cues=cues, rests=rests), times))
        return out[0], out[1]

    def _alone(self, plan: Plan, of: LayerPlan, times: Array) -> Array:
        """Return `[2, N-1, J]` as `_own` does for one layer. Nothing where a clip, or a round of it,
        begins.
        """
        alone = replace(
            plan, layers={layer: of if layer == of.layer else LayerPlan(layer) for layer in LAYERS}
        )
        pose = LayersStage(alone, self.project, find_composer(self.project)).run(times)
        sizes = np.stack(measure_moves(moves_of(self._globals(pose))))
        sizes[:, _cuts(self.project, alone, times)] = 0.0
        sizes[:, _within((s for cue in of.cues for s in _seams_of_cue(cue)), times[1:])] = 0.0
        near = sizes.copy()
        near[:, 1:] = np.maximum(near[:, 1:], sizes[:, :-1])
        near[:, :-1] = np.maximum(near[:, :-1], sizes[:, 1:])
        return near


def find_moved_joints(project: Project) -> list[int]:
    """Return the joints that the law is about: those of the body, as `find_body_joints` says, with fingers
    and without the face.
    """
    assert project.skeleton is not None
    roles = anatomy.project_roles(project)
    known = find_known_roles(project.skeleton, roles)
    face = {roles[role] for role in FACE if role in roles}
    return [joint for joint in find_body_joints(project.skeleton, known) if joint not in face]


def moves_of(shown: Globals) -> tuple[Array, Array]:
    """Return how joints go and turn from each pose to the next, `[N-1, J, 3]` each: metres, and rotation
    vectors in the character's space.
    """
    turned, at = shown
    return np.diff(at, axis=0), rotation.log(rotation.multiply(turned[1:], rotation.conjugate(turned[:-1])))


def measure_added_moves(before: Globals, after: Globals, size: float = 1.0) -> AddedMoves:
    """Return what is added to poses. size: of the figure, as a share of TALL."""
    ways, turns = (_beyond(a, b) for a, b in zip(moves_of(after), moves_of(before), strict=True))
    return AddedMoves(ways / size, turns)


def _beyond(moved: Array, before: Array) -> Array:
    """Return how far moves `[..., 3]` are from those before, or from the nearest part of them."""
    square = np.maximum((before * before).sum(-1), 1e-18)
    part = np.clip((moved * before).sum(-1) / square, 0.0, 1.0)
    return np.asarray(np.linalg.norm(moved - part[..., None] * before, axis=-1))


def measure_moves(moves: tuple[Array, Array]) -> tuple[Array, Array]:
    """Return the lengths of moves, `[N-1, J]` each: metres and radians."""
    return np.linalg.norm(moves[0], axis=-1), np.linalg.norm(moves[1], axis=-1)


def measure_usual_moves(project: Project, joints: list[int]) -> tuple[Array, Array]:
    """Return how far each joint goes, metres, and turns, radians, in a sixtieth of a second of the clips,
    `[J]` each: the USUAL percentile over all that plays.
    """
    found = [
        measure_moves(moves_of((turns[:, joints].astype(np.float64), at[:, joints].astype(np.float64))))
        for turns, at in play_clips(project)
    ]
    if not found:
        return np.zeros(len(joints)), np.zeros(len(joints))
    far, turned = (np.concatenate(some) for some in zip(*found, strict=True))
    return np.percentile(far, USUAL, axis=0), np.percentile(turned, USUAL, axis=0)


def find_blending(project: Project, plan: Plan, times: Array) -> Array:
    """Return `[N]` whether two poses blend on any layer at `times [N]`: in blends, fades and seams."""
    blends = [span for of in plan.layers.values() for span in find_blends(of)]
    return _within([*blends, *_seams(project, plan)], times)


def _within(spans: Iterable[tuple[float, float]], times: Array) -> Array:
    """Return `[N]` whether `times [N]` are within any span, or a sixtieth of a second after it."""
    out = np.zeros(len(times), bool)
    for start, end in spans:
        low, high = np.searchsorted(times, (start, end + 1.0 / RATE))
        out[low:high] = True
    return out


def find_blends(of: LayerPlan) -> list[tuple[float, float]]:
    """Return when cues of a layer blend in and out, and when one loop fades into another, seconds."""
    out = [(cue.start, cue.start + cue.blend_in) for cue in of.cues]
    out += [(cue.end - cue.blend_out, cue.end) for cue in of.cues]
    return out + [(rest.fade_start, rest.fade_start + rest.fade) for rest in of.rests[1:]]


def _seams(project: Project, plan: Plan) -> Iterator[tuple[float, float]]:
    """Yield when the ends of loops, and of what cues repeat, blend into their beginnings."""
    for of in plan.layers.values():
        for cue in of.cues:
            yield from _seams_of_cue(cue)
        for rest, starts in _rounds(project, plan, of):
            first, last = project.span(rest.action)
            seam = min(max(0.0, rest.action.timing.blend_in), (last - first) / 2)
            yield from ((at, at + seam) for at in starts if seam > 0)


def _rounds(project: Project, plan: Plan, of: LayerPlan) -> Iterator[tuple[Rest, list[float]]]:
    """Yield each rest of a layer, and when its loop begins again."""
    ends = [*(rest.fade_start + rest.fade for rest in of.rests[1:]), plan.end]
    for rest, end in zip(of.rests, ends, strict=False):
        first, last = project.span(rest.action)
        period = last - first - min(max(0.0, rest.action.timing.blend_in), (last - first) / 2)
        yield rest, np.arange(rest.start + period, end, period).tolist() if period > 0 else []


def _seams_of_cue(cue: Cue) -> Iterator[tuple[float, float]]:
    if cue.repeats:
        cycle = (cue.cycle_to - cue.cycle_from) / cue.tempo
        first = cue.start + (cue.cycle_to - cue.entry) / cue.tempo
        for at in np.arange(first, cue.end, cycle).tolist():
            yield at, at + min(SEAM / cue.tempo, cycle / 2)


def _without_seam(loop: Action) -> Action:
    return replace(loop, timing=replace(loop.timing, blend_in=0.0))


def _cuts(project: Project, plan: Plan, times: Array) -> Array:
    """Return `[N-1]` whether a clip, or another round of a loop, begins between a time and the next."""
    out = np.zeros(max(0, len(times) - 1), bool)
    for of in plan.layers.values():
        edges = [*(c.start for c in of.cues), *(c.end for c in of.cues), *(r.fade_start for r in of.rests)]
        edges += [at for _, starts in _rounds(project, plan, of) for at in starts]
        places = np.searchsorted(times, edges)
        out[places[(places > 0) & (places < len(times))] - 1] = True
    return out
