"""The law of continuity: what is added to clips moves no joint more than `MOST_WAY` or `MOST_TURN` in a
sixtieth of a second beyond what the clips do.

What a stage of the evaluator adds is measured against the stage before it. A joint may do what it did there,
or any part of it: a hand that is kept out of the body, or a foot that is held, does less. All that it does
besides is added. Blends are measured against how fast the clips themselves go.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Project
from metagraph.motion import rotation
from metagraph.motion.joint_map import find_known_roles
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.own_moves import RATE, body_joints, play_clips
from metagraph.playback.plan import Plan

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
    """Says what the stages of a project's evaluators add. joints: those it looks at: all but the face's."""

    def __init__(self, project: Project) -> None:
        """Raises ValueError for a project without a skeleton."""
        if project.skeleton is None:
            raise ValueError("The project has no skeleton: import a clip first.")
        self.skeleton: Skeleton = project.skeleton
        self.joints = moved_joints(project)
        self._size = max(1e-6, project.skeleton.height / TALL)
        self._usual = usual_moves(project, self.joints)

    def added(self, plan: Plan, times: Array, stages: Iterable[tuple[str, Pose]]) -> Mapping[str, AddedMoves]:
        """Return what each stage adds, by its name. times `[N]`: a sixtieth of a second apart. stages: the
        poses of `plan` then, as `Evaluator.stages` yields them.
        """
        out: dict[str, AddedMoves] = {}
        before: Globals | None = None
        pose: Pose | None = None
        for name, shown in stages:
            if before is None:
                before = self._globals(shown)
                out[name] = self._blends(plan, times, before)
            elif shown is pose:
                nothing = np.zeros((max(0, len(times) - 1), len(self.joints)))
                out[name] = AddedMoves(nothing, nothing)
            else:
                after = self._globals(shown)
                out[name] = added_moves(before, after, self._size)
                before = after
            pose = shown
        return out

    def _globals(self, pose: Pose) -> Globals:
        turned, at = self.skeleton.globals(pose)
        return turned[:, self.joints].astype(np.float64), at[:, self.joints].astype(np.float64)

    def _blends(self, plan: Plan, times: Array, shown: Globals) -> AddedMoves:
        """Return what blends do beyond what the clips do; nothing where nothing blends."""
        ways, turns = moves_of(shown)
        mixed = blending(plan, times[1:])[:, None]
        return AddedMoves(
            np.where(mixed, np.maximum(0, np.linalg.norm(ways, axis=-1) - self._usual[0]), 0) / self._size,
            np.where(mixed, np.maximum(0, np.linalg.norm(turns, axis=-1) - self._usual[1]), 0),
        )


def moved_joints(project: Project) -> list[int]:
    """Return the joints that the law is about: those of the body, as `body_joints` says, with fingers and
    without the face.
    """
    assert project.skeleton is not None
    roles = anatomy.project_roles(project)
    known = find_known_roles(project.skeleton, roles)
    face = {roles[role] for role in FACE if role in roles}
    return [joint for joint in body_joints(project.skeleton, known) if joint not in face]


def moves_of(shown: Globals) -> tuple[Array, Array]:
    """Return how joints go and turn from each pose to the next, `[N-1, J, 3]` each: metres, and rotation
    vectors in the character's space.
    """
    turned, at = shown
    return np.diff(at, axis=0), rotation.log(rotation.multiply(turned[1:], rotation.conjugate(turned[:-1])))


def added_moves(before: Globals, after: Globals, size: float = 1.0) -> AddedMoves:
    """Return what is added to poses. size: of the figure, as a share of TALL."""
    ways, turns = (_beyond(a, b) for a, b in zip(moves_of(after), moves_of(before), strict=True))
    return AddedMoves(ways / size, turns)


def _beyond(moved: Array, before: Array) -> Array:
    """Return how far moves `[..., 3]` are from those before, or from the nearest part of them."""
    square = np.maximum((before * before).sum(-1), 1e-18)
    part = np.clip((moved * before).sum(-1) / square, 0.0, 1.0)
    return np.asarray(np.linalg.norm(moved - part[..., None] * before, axis=-1))


def usual_moves(project: Project, joints: list[int]) -> tuple[Array, Array]:
    """Return how far each joint goes, metres, and turns, radians, in a sixtieth of a second of the clips,
    `[J]` each: the USUAL percentile over all that plays.
    """
    far: list[Array] = []
    turned: list[Array] = []
    for turns, at in play_clips(project):
        found = moves_of((turns[:, joints].astype(np.float64), at[:, joints].astype(np.float64)))
        far.append(np.linalg.norm(found[0], axis=-1))
        turned.append(np.linalg.norm(found[1], axis=-1))
    if not far:
        return np.zeros(len(joints)), np.zeros(len(joints))
    return np.percentile(np.concatenate(far), USUAL, axis=0), np.percentile(
        np.concatenate(turned), USUAL, axis=0
    )


def blending(plan: Plan, times: Array) -> Array:
    """Return `[N]` whether two poses blend on any layer at `times [N]`."""
    out = np.zeros(len(times), bool)
    for layer in LAYERS:
        of = plan.layers[layer]
        spans = [(c.start, c.start + c.blend_in) for c in of.cues]
        spans += [(c.end - c.blend_out, c.end) for c in of.cues]
        spans += [(r.fade_start, r.fade_start + r.fade) for r in of.rests[1:]]
        for start, end in spans:
            low, high = np.searchsorted(times, (start, end + 1.0 / RATE))
            out[low:high] = True
    return out
