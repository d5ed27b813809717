"""Evaluate a plan: what it looks like at a time, or at many times at once.

Preview, video, export and tests all use this evaluator, so scrubbing, live play and a baked file agree. A
pose goes through the stages in this order: layers, weight and feet, life, contacts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import LAYERS, Action, Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.life.evaluate import LifeStage, Playing
from metagraph.playback.plan import Plan
from metagraph.playback.posing.composer import find_playable_motion
from metagraph.playback.posing.contacts import ContactStage
from metagraph.playback.posing.layers import LayersStage, compute_cue_weight, compute_loop_seconds
from metagraph.playback.posing.overlay import Overlay, lay_over
from metagraph.playback.posing.rigs import Rigs, get_rigs
from metagraph.playback.posing.weight import WeightStage

Array = NDArray[Any]
BLENDS, WEIGHT, LIFE, CONTACTS = STAGES = ("blends", "feet and weight", "life", "contacts")


class Poses(Protocol):
    """Anything that has a pose and a face at each time."""

    def at(self, seconds: Any, /) -> Pose: ...
    def morphs_at(self, seconds: float, /) -> dict[str, float]: ...
    def faces_at(self, times: Array, /) -> list[dict[str, float]]: ...


class Evaluator:
    """Turns a plan into poses and morph target weights. There is one for each plan; it owns what it computes.

    Before 0 and after the plan's end, the character rests in the first and last stance. An action whose clip
    is missing shows its stance.
    """

    def __init__(self, plan: Plan, project: Project, rigs: Rigs | None = None) -> None:
        """Make the evaluator. `rigs` are the project's, if they are known. Raises ValueError for a project
        without a skeleton.
        """
        self.plan, self.project = plan, project
        self.rigs = rigs if rigs is not None else get_rigs(project)
        self._lives = project.life.on and plan.life.end > 0
        self._layers = LayersStage(plan, project, self.rigs.composer)
        self._still = _first_picture(plan, project)
        self._weight = WeightStage(plan, project, self.rigs.weight)
        self._life = LifeStage(project, plan.life, plan.track, self.rigs.body)
        self._contacts = ContactStage(plan, project, self.rigs.contacts)
        self._last: tuple[float, Pose] | None = None  # the latest pose at one time with life added

    def at(self, seconds: Any, alive: bool = True, overlay: Overlay | None = None) -> Pose:
        """Return the composed pose at `seconds`, a number or an array `[...]`: rotations `[..., J, 4]`,
        translations `[..., J, 3]`.

        With `alive`, life is added as the project has it set. `overlay` is motion for the same times, which
        replaces the layers of the arms and the head.
        """
        at = np.asarray(seconds, np.float64)
        times = at.reshape(-1)
        pose = self._composed(times, overlay)
        shown = None if overlay is None else 1 - overlay.weight * (1 - overlay.arms)
        if alive and self._lives:
            pose = self._weight.run(pose, times, shown)
            if len(times) == 1 and overlay is None:  # its face is usually needed next
                self._last = float(times[0]), _first(pose)
            pose = self._life.run(pose, times)
        pose = self._contacts.run(pose, times, shown)
        shape = (*at.shape, len(self.rigs.composer.ground.skeleton))
        return Pose(pose.rotations.reshape(*shape, 4), pose.translations.reshape(*shape, 3))

    def stages(self, times: Array, overlay: Overlay | None = None) -> Iterator[tuple[str, Pose]]:
        """Yield the poses `[N, J]` at `times [N]` as each of STAGES leaves them; the last are those of `at`.
        A stage that adds nothing leaves the same pose.
        """
        pose = self._composed(times, overlay)
        shown = None if overlay is None else 1 - overlay.weight * (1 - overlay.arms)
        yield BLENDS, pose
        if self._lives:
            pose = self._weight.run(pose, times, shown)
        yield WEIGHT, pose
        if self._lives:
            pose = self._life.run(pose, times)
        yield LIFE, pose
        yield CONTACTS, self._contacts.run(pose, times, shown)

    def follow(self, plan: Plan, project: Project) -> Evaluator:
        """Return the evaluator of a plan: this one for the same plan and project, else a new one."""
        if plan is self.plan and project is self.project:
            return self
        return Evaluator(plan, project, self.rigs if project is self.project else None)

    def layered(self, times: Array) -> Pose:
        """Return what only the layers compose at `times [N]`; the first clip's first frame while no layer has
        a stance to rest in.
        """
        if self._still is None:
            return self._layers.run(times)
        still, count = self._still, (len(times), 1, 1)
        return Pose(np.tile(still.rotations, count), np.tile(still.translations, count))

    def before_life(self, times: Array) -> Pose:
        """Return the poses at `times [N]` before life is added."""
        return self._weight.run(self.layered(times), times)

    def morphs_at(self, seconds: float, alive: bool = True, composed: Pose | None = None) -> dict[str, float]:
        """Return morph target weights, 0..1, at one time: the sums of the layers and, with `alive`, life's on
        top.

        `composed` is the pose `[J]` before life, if it differs from the plan's.
        """
        out: dict[str, float] = {}
        playing = self._play_morphs(seconds, out)
        if alive and self._lives:
            if self.rigs.body.face.morphs and composed is None:  # the eyes hold their gaze against this pose
                composed = self._before_life_at(seconds)
            add_life(out, self._life.morphs(seconds, composed, playing))
        return {name: min(1.0, max(0.0, value)) for name, value in out.items()}

    def faces_at(self, times: Array) -> list[dict[str, float]]:
        """Return morph target weights, 0..1, at each of `times [N]`, equal to the bit to those of
        `morphs_at`.
        """
        times = np.asarray(times, np.float64)
        pose = self.before_life(times)
        return [
            self.morphs_at(float(time), composed=Pose(rotations, translations))
            for time, rotations, translations in zip(times, pose.rotations, pose.translations, strict=True)
        ]

    def _composed(self, times: Array, overlay: Overlay | None) -> Pose:
        if overlay is None or not overlay.weight.any():
            return self.layered(times)
        return lay_over(self.project, self.rigs.composer, self._layers.offsets(times), overlay)

    def _before_life_at(self, seconds: float) -> Pose:
        if self._last is not None and self._last[0] == seconds:
            return self._last[1]
        return _first(self.before_life(np.array([float(seconds)])))

    def _play_morphs(self, seconds: float, out: dict[str, float]) -> list[Playing]:
        """Add the morph target weights of clips at a time to `out`; return what plays."""
        playing: list[Playing] = []
        for layer in LAYERS:
            of = self.plan.layers[layer]
            cue = of.cue_at(seconds)
            rest = next(
                (r for r in reversed(of.rests) if r.fade_start <= seconds), of.rests[0] if of.rests else None
            )
            shares: list[tuple[Action, float, float]] = []
            weight = 0.0
            if cue is not None:
                playing.append((cue.action.tags, cue.start, cue.end))
                weight = float(compute_cue_weight(cue, np.array([seconds]))[0])
                shares.append((cue.action, float(cue.clip_seconds(seconds)), weight))
            if rest is not None:
                elapsed = np.array([seconds - rest.start])
                at, other, old = (
                    float(x[0]) for x in compute_loop_seconds(self.project, rest.action, elapsed)
                )
                shares.append((rest.action, at, (1 - weight) * (1 - old)))
                shares.append((rest.action, other, (1 - weight) * old))
            for action, at, share in shares:
                motion = find_playable_motion(self.project, action)
                if motion is not None and share > 0:
                    for name, value in motion.morphs_at(at).items():
                        out[name] = out.get(name, 0.0) + share * value
        return playing


def _first(pose: Pose) -> Pose:
    """Return the first pose of an array of poses as a copy."""
    return Pose(pose.rotations[0].copy(), pose.translations[0].copy())


def add_life(out: dict[str, float], found: Mapping[str, float]) -> None:
    """Add the life layers' morph target weights to those of clips, as far as these leave room, so that a face
    made for a moment stays as it was made.
    """
    for name, value in found.items():
        played = out.get(name, 0.0)
        out[name] = played + value * (1 - min(1.0, max(0.0, played)))


def _first_picture(plan: Plan, project: Project) -> Pose | None:
    """Return the pose to show while nothing plays and nobody has chosen a base pose: the first frame of the
    first clip, since a rest pose may be anything, such as a heap on the floor. None if something plays.
    """
    if project.base.clip or any(of.rests or of.cues for of in plan.layers.values()):
        return None
    motions = (entry.motion for entry in project.clips.values())
    fitting = (m for m in motions if m is not None and m.skeleton == project.skeleton and m.frames)
    first = next(fitting, None)
    return first.pose_at(0.0) if first is not None else None
