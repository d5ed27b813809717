"""Connections of a machine that jump visibly: beyond what the clips themselves show between frames, once the
blend is taken off.

The measure is that of `suggest.jumps.compatibility` (Yang et al., section 6), its statistics those of the
reference's clips, so that all attempts are judged alike.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import Action, Layer, Project
from metagraph.motion.clip import Clip
from metagraph.research.study.machines.normal_machine import NormalMachine, NormalState, name_clips
from metagraph.research.study.scores.machines import Mistake, Score, name_some
from metagraph.suggest.jumps.compatibility import MOST_FRAMES, measure_visible_difference
from metagraph.suggest.jumps.found import Measured
from metagraph.suggest.tracks import RATE, make_joint_track, measure_velocity, track_rig

Array = NDArray[Any]
Frames = tuple[Array, Array]  # positions and velocities `[G, J, 3]`


def with_jumps(found: Score, attempt: Mapping[Layer, NormalMachine], reference: Project) -> Score:
    """Return a score with the attempt's visible jumps, and each state that jumps among the mistakes.
    reference: with its clips loaded; where they are not there, or too few to tell what is usual, jumps stay
    None.
    """
    count: int | None = None
    mistakes: list[Mistake] = []
    for layer, machine in attempt.items():
        judge = _Judge(reference, layer)
        if not judge.measured.reliable:
            continue
        costs = judge.costs(machine)
        count = (count or 0) + sum(1 for c in costs.values() if c > 1)
        by: dict[str, list[tuple[str, float]]] = {}
        for (source, target), cost in costs.items():
            if cost > 1:
                by.setdefault(source, []).append((target, cost))
        for source, jumps in by.items():
            worst = max(cost for _, cost in jumps)
            targets = name_some([t for t, _ in jumps])
            words = f"{source} jumps to {targets}: up to {worst:.1f} times what is usual."
            mistakes.append(Mistake("jump", layer, source, len(jumps), words))
    return found.with_jumps(count, mistakes)


class _Judge:
    """What is usual on a layer, and what of the reference's clips has been looked at."""

    def __init__(self, reference: Project, layer: Layer) -> None:
        self.project, self.layer = reference, layer
        self.measured = Measured(reference, layer)
        own = {
            i: e.motion
            for i, e in reference.clips.items()
            if e.motion is not None and e.motion.skeleton == reference.skeleton
        }
        self.motions: dict[str, Clip] = {
            name: own[i] for i, name in name_clips(reference).items() if i in own
        }
        self._weights: dict[Any, Array] = {}

    def costs(self, machine: NormalMachine) -> dict[tuple[str, str], float]:
        """Return connection -> what shows of it, beside the threshold; those whose clips are not there are
        left out.
        """
        entries = {k: f for k, s in machine.states.items() if (f := self._entry(s)) is not None}
        exits: dict[tuple[str, float | None], Frames | None] = {}
        out = {}
        for (a, b), c in sorted(machine.connections.items()):
            source, target = machine.states[a], machine.states[b]
            leave = None if source.loop else c.leave
            if (a, leave) not in exits:
                exits[a, leave] = self._exit(source, leave)
            left = exits[a, leave]
            if left is None or b not in entries:
                continue
            far = self._far(left, entries[b], self._moved(source) * self._moved(target))
            # A loop is left and entered where it fits best; what may be left at any time, at no moment in
            # particular.
            cost = float(far.min()) if source.loop or leave is not None else float(np.median(far.min(axis=1)))
            out[a, b] = float(measure_visible_difference(cost, c.blend))
        return out

    def _far(self, left: Frames, entered: Frames, moved: Array) -> Array:
        """Return `[G, H]` the cost between each two frames, beside the threshold."""
        stats = self.measured.stats
        p, v = (np.linalg.norm(x[:, None] - y[None], axis=-1) for x, y in zip(left, entered, strict=True))
        return np.asarray((p + stats.velocity * v) @ (stats.weights * moved) / stats.threshold)

    def _exit(self, state: NormalState, leave: float | None) -> Frames | None:
        return self._frames(state, None if leave is None else round(min(leave, state.end) * RATE))

    def _entry(self, state: NormalState) -> Frames | None:
        # What is entered at a frame follows something that looks like the frame before it.
        return self._frames(state, None if state.loop else max(0, round(state.start * RATE) - 1))

    def _frames(self, state: NormalState, at: int | None) -> Frames | None:
        """Return one frame of a state's clip, or for None some of all that plays."""
        motion = self.motions.get(state.clip)
        if motion is None:
            return None
        track = make_joint_track(track_rig(motion, self.measured.roles), motion)
        last = len(track) - 1
        first, final = (min(round(t * RATE), last) for t in (state.start, state.end))
        chosen = (
            np.array([min(at, last)])
            if at is not None
            else np.unique(np.linspace(first, final, MOST_FRAMES).astype(int))
        )
        return track[chosen], measure_velocity(track)[chosen]

    def _moved(self, state: NormalState) -> Array:
        """Return `[J]` how far, 0..1, a state moves each of the counted joints."""
        key = state.limb, state.joints, state.joint_weights
        if key not in self._weights:
            action = Action(
                "",
                "",
                "gesture",
                self.layer,
                "",
                "",
                limb=state.limb,
                joints=state.joints,
                joint_weights=state.joint_weights,
            )
            moved = anatomy.make_action_mask(self.project, action)
            rig = track_rig(next(iter(self.motions.values())), self.measured.roles)
            ones = np.ones(len(rig.joints))
            self._weights[key] = ones if moved is None else moved[rig.keep[rig.joints]] * ones
        return self._weights[key]
