"""Play plans and measure what a viewer sees of them, on all cores if it takes long."""

from __future__ import annotations

import copyreg
import io
import os
import pickle
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.continuity import ContinuityLaw
from metagraph.playback.evaluator import CONTACTS, LIFE, WEIGHT, Evaluator
from metagraph.playback.own_moves import RATE, find_body_joints
from metagraph.playback.plan import Plan
from metagraph.playback.posing.contacts import measure_contact_depths
from metagraph.playback.posing.foot_slides import find_feet_joints
from metagraph.playback.posing.rigs import get_rigs

if TYPE_CHECKING:
    from metagraph.common.child_channel import Child

Array = NDArray[Any]

CHUNK = 600  # poses measured at once
PARTS = ("left_hand", "right_hand", "head", "hips", "left_foot", "right_foot")
ADDED = (WEIGHT, LIFE, CONTACTS)  # stages whose own moves are measured
LEVEL = 0.6  # of a thigh's length: its ends differ less in height where somebody sits
# From so many chunks on, other processes save time: one starts in a second or two, and a chunk takes as long.
WORTH, MOST = 10, 5
PATIENCE = 2.0  # seconds for a process to end by itself


@dataclass(frozen=True, eq=False)
class PlayedPoses:
    """What was seen of a performance. times `[F]` seconds. places `[F, P, 3]` metres of `parts`. lowest
    `[F]`: how high the lowest joint of the body is. sits `[F]`: whether it sits. inside `[F]`:
    how deep an arm is within the body, metres. added: by stage, what it adds on the way to each frame,
    `[4, F]`, as `AddedMoves.worst` returns it. feet `[F, K, 3]`: places of `feet_joints`, metres.
    """

    times: Array
    parts: tuple[str, ...]
    places: Array
    lowest: Array
    sits: Array
    inside: Array
    added: Mapping[str, Array]
    feet_joints: tuple[int, ...]
    feet: Array


class PoseWatcher:
    """Plays one plan of a project with a skeleton, and measures its poses."""

    def __init__(self, project: Project, plan: Plan) -> None:
        skeleton = project.skeleton
        assert skeleton is not None
        self._skeleton = skeleton
        self._evaluator, self._law = Evaluator(plan, project), ContinuityLaw(project)
        roles = anatomy.project_roles(project)
        self._parts = tuple(part for part in PARTS if part in roles)
        self._joints = [roles[part] for part in self._parts]
        self._body = find_body_joints(skeleton, roles)
        self._feet = [joint for side in find_feet_joints(project) for joint in side]
        self._contacts = get_rigs(project).contacts
        self._thighs = [
            [roles[f"{side}_{part}_leg"] for part in ("upper", "lower")]
            for side in ("left", "right")
            if {f"{side}_upper_leg", f"{side}_lower_leg", "hips", "head"} <= roles.keys()
        ]
        self._trunk = [roles["hips"], roles["head"]] if self._thighs else []

    def watch(self, times: Array) -> PlayedPoses:
        """Return what is seen at `times [F]`, which are 1 / RATE apart."""
        stages = list(self._evaluator.stages(np.append(times[:1] - 1 / RATE, times)))
        moves = self._law.added(stages)
        last = stages[-1][1]
        pose = Pose(last.rotations[1:], last.translations[1:])
        _, at = self._skeleton.globals(pose)
        depths = (
            measure_contact_depths(self._contacts, pose).max(-1, initial=0.0)
            if self._contacts is not None
            else np.zeros(len(times))
        )
        return PlayedPoses(
            times,
            self._parts,
            at[:, self._joints].astype(np.float64),
            at[:, self._body, 1].min(1),
            _is_sitting(at, self._thighs, self._trunk),
            depths,
            {name: moves[name].worst(self._law.joints) for name in ADDED},
            tuple(self._feet),
            at[:, self._feet].astype(np.float32),
        )


def count_chunks(seconds: float) -> int:
    """Return in how many pieces so many seconds are measured."""
    return max(1, -(-round(seconds * RATE) // CHUNK))


def watch_plans(
    project: Project,
    plans: Sequence[tuple[Plan, float]],
    step: Callable[[], bool] = lambda: False,
    processes: int | None = None,
) -> list[PlayedPoses]:
    """Return what is seen of each plan in so many seconds of it.

    `step` is called after each piece, and ends all of it by returning True; then only plans that were
    played whole are returned. `processes` is how many work beside this one: by default one for each other
    core, at most MOST, if there is enough to do. What is measured is the same wherever it is.
    """
    pieces = [
        (n, times)
        for n, (_, seconds) in enumerate(plans)
        for times in np.array_split(np.arange(round(seconds * RATE)) / RATE, count_chunks(seconds))
    ]
    if processes is None:
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        processes = min(cores - 1, MOST, len(pieces) // 4) if len(pieces) >= WORTH else 0
    work = _Work(project, [plan for plan, _ in plans], pieces)
    with work.helped(processes):
        work.run(step)
    return work.finished()


class _Work:
    """Pieces of plans that this process and others measure, each when it is free."""

    def __init__(self, project: Project, plans: Sequence[Plan], pieces: Sequence[tuple[int, Array]]) -> None:
        self._project, self._plans, self._pieces = project, plans, pieces
        self._todo = deque(range(len(pieces)))
        self._found: dict[int, PlayedPoses] = {}
        self._helpers: list[threading.Thread] = []
        self._watchers: dict[int, PoseWatcher] = {}

    @contextmanager
    def helped(self, processes: int) -> Iterator[None]:
        """Let so many processes work beside this one while the block lasts."""
        from metagraph.common.child_channel import Child

        children: list[Child] = []
        try:
            begin = _dump((self._project, self._plans)) if processes else b""
            with suppress(OSError):  # where no process can be started, this one does it all
                for _ in range(processes):
                    children.append(Child("metagraph.playback.watching_child"))
                    helper = threading.Thread(target=self._help, args=(children[-1], begin), daemon=True)
                    self._helpers.append(helper)
                    helper.start()
            yield
        finally:
            for child in children:
                child.close(PATIENCE)
            for helper in self._helpers:
                helper.join()

    def run(self, step: Callable[[], bool]) -> None:
        """Measure what nobody else does, until all is done or `step` returns True."""
        told = 0
        while len(self._found) < len(self._pieces):
            try:
                piece = self._todo.popleft()
            except IndexError:
                if not any(helper.is_alive() for helper in self._helpers):
                    continue  # one may have put its piece back, as its process ended
                time.sleep(0.01)
            else:
                plan, times = self._pieces[piece]
                if plan not in self._watchers:
                    self._watchers[plan] = PoseWatcher(self._project, self._plans[plan])
                self._found[piece] = self._watchers[plan].watch(times)
            while told < len(self._found):
                told += 1
                if step():
                    self._todo.clear()
                    return

    def _help(self, child: Child, begin: bytes) -> None:
        """Give a process one piece after the other; a piece that it does not return is done by others."""
        piece = None
        with suppress(OSError, EOFError):
            child.send(begin)
            while True:
                piece = None
                try:
                    piece = self._todo.popleft()
                except IndexError:
                    return
                child.send(pickle.dumps(self._pieces[piece]))
                self._found[piece] = pickle.loads(child.receive())
        if piece is not None:
            self._todo.appendleft(piece)

    def finished(self) -> list[PlayedPoses]:
        """Return the plans of which every piece was measured, up to the first that was not."""
        out = []
        for n in range(len(self._plans)):
            own = [piece for piece, (plan, _) in enumerate(self._pieces) if plan == n]
            if any(piece not in self._found for piece in own):
                break
            out.append(_join_poses([self._found[piece] for piece in own]))
        return out


def make_read_only(values: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    """Return a dictionary that nobody can change, as an unpickled value has it."""
    return MappingProxyType(values)


def _dump(value: object) -> bytes:
    """Return a value for a process of ours, read-only dictionaries as well, which pickle does not know."""
    out = io.BytesIO()
    pickler = pickle.Pickler(out, pickle.HIGHEST_PROTOCOL)
    pickler.dispatch_table = copyreg.dispatch_table | {
        MappingProxyType: lambda view: (make_read_only, (dict(view),))
    }
    pickler.dump(value)
    return out.getvalue()


def _join_poses(pieces: Sequence[PlayedPoses]) -> PlayedPoses:
    def whole(name: str) -> Array:
        return np.concatenate([getattr(piece, name) for piece in pieces])

    added = {name: np.concatenate([piece.added[name] for piece in pieces], 1) for name in ADDED}
    return PlayedPoses(
        whole("times"),
        pieces[0].parts,
        whole("places"),
        whole("lowest"),
        whole("sits"),
        whole("inside"),
        added,
        pieces[0].feet_joints,
        whole("feet"),
    )


def _is_sitting(at: Array, thighs: list[list[int]], trunk: list[int]) -> Array:
    """Return `[F]` whether thighs are level and the trunk is upright, of places `[F, J, 3]` and pairs of
    joints; never where none are known.
    """
    if not thighs:
        return np.zeros(len(at), bool)
    ways = np.diff(at[:, [*thighs, trunk]], axis=2)[:, :, 0]
    rise = ways[..., 1] / np.maximum(np.linalg.norm(ways, axis=-1), 1e-9)
    return np.asarray((np.abs(rise[:, :-1]) < LEVEL).all(1) & (rise[:, -1] > LEVEL))
