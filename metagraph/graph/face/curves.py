"""Blend shape curves of clips on the project's own face, whatever the clips call them.

A curve that has the name of one of the character's morph targets moves it. Any other is chosen by what its
name means (`blendshape_names`): it moves the target that is the same shape, else the channels of the face
that come nearest, which may be joints. Curves of eyes and lids turn joints where the face moves those by
joints, so that life's own blinks know what is shut already.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any
from weakref import WeakKeyDictionary, ref

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.face.blendshape_names import CurveMeaning, find_curve_meanings, match_arkit_shape
from metagraph.graph.face.rig import CHANNELS, FaceRig, find_face
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip

Array = NDArray[Any]
Amounts = dict[str, float]

LOOK = float(np.radians(30.0))  # what an eye turns for a look at 1
WIDE = -0.25  # of shut, for lids that open wide
# What a face without one of ARKit's shapes does for it; the amounts are ours.
_FOR: dict[str, Amounts] = {
    "jawOpen": {"jaw_open": 1.0},
    "mouthFunnel": {"viseme_O": 0.5},
    "mouthPucker": {"viseme_U": 0.7},
    "browInnerUp": {"brow_up": 1.0},
    **{f"mouthSmile{s}": {"smile": 0.5} for s in ("Left", "Right")},
    **{f"mouthFrown{s}": {"frown": 0.5} for s in ("Left", "Right")},
    **{f"mouthStretch{s}": {"viseme_I": 0.2} for s in ("Left", "Right")},
    **{f"browDown{s}": {"brow_down": 0.5} for s in ("Left", "Right")},
    **{f"browOuterUp{s}": {"brows": 0.5} for s in ("Left", "Right")},
    **{f"cheekSquint{s}": {"cheeks": 0.5} for s in ("Left", "Right")},
}
# Of the left eye: where ARKit's shape looks.
_WAYS = {"Up": ("up", "up"), "Down": ("down", "down"), "In": ("right", "left"), "Out": ("left", "right")}


def _side(shape: str) -> str:
    return "left" if shape.endswith("Left") else "right"


class Wearing:
    """How clips' curves land on one face. targets: the character's morph targets."""

    def __init__(self, face: FaceRig, targets: Iterable[str], names: Mapping[str, str] | None = None) -> None:
        self.face, self.targets, self.names = face, tuple(targets), dict(names or {})
        self.same: dict[str, str] = {}
        for target in self.targets:
            shape = match_arkit_shape(target)
            if shape is not None:
                self.same.setdefault(shape, target)
        self.by_joints = set(face.joint_channels())
        self.eyes = {eye.side: eye for eye in face.eyes}

    def understood(
        self, morphs: Iterable[str]
    ) -> tuple[dict[str, Amounts], tuple[str, ...], tuple[str, ...]]:
        """Return what each curve moves, by name: targets as "=name", else channels; the names nobody
        understands; and those this face has nothing for.
        """
        morphs = tuple(morphs)
        found, lost = find_curve_meanings(morphs, self.names)
        out: dict[str, Amounts] = {}
        idle: list[str] = []
        for name in morphs:
            told = self.names.get(name, name)
            meaning = found.get(name)
            if told in self.targets and not self._jointed(meaning):
                out[name] = {f"={told}": 1.0}
            elif meaning is not None:
                moves = self._moved(meaning)
                out[name] = moves
                if not moves and (meaning.shapes or meaning.channels):
                    idle.append(name)
        return out, tuple(n for n in lost if n not in out), tuple(idle)

    def _jointed(self, meaning: CurveMeaning | None) -> bool:
        """Whether joints do what a target of the character's would do again."""
        return meaning is not None and any(
            shape.startswith(("eyeBlink", "eyeWide")) and self._lids(_side(shape)) for shape in meaning.shapes
        )

    def _lids(self, side: str) -> bool:
        return f"upper_lid_{side}" in self.by_joints

    def _moved(self, meaning: CurveMeaning) -> Amounts:
        out: Amounts = {}

        def add(more: Mapping[str, float], amount: float) -> None:
            for channel, share in more.items():
                if channel.startswith("=") or self._has(channel):
                    out[channel] = out.get(channel, 0.0) + amount * share

        for shape, amount in meaning.shapes.items():
            if shape in self.same and not self._jointed(CurveMeaning({shape: amount}, {})):
                add({f"={self.same[shape]}": 1.0}, amount)
            else:
                add(self._instead(shape), amount)
        add(meaning.channels, 1.0)
        return out

    def _instead(self, shape: str) -> Amounts:
        side = _side(shape)
        if shape.startswith("eyeBlink"):
            if self._lids(side):
                return {f"upper_lid_{side}": 1.0, f"lower_lid_{side}": 1.0, "blink": 0.5}
            return {f"blink_{side}": 1.0} if self._has(f"blink_{side}") else {"blink": 0.5}
        if shape.startswith("eyeWide"):
            if self._lids(side):
                return {f"upper_lid_{side}": WIDE, f"lower_lid_{side}": WIDE}
            return {f"wide_{side}": 1.0}
        if shape.startswith("eyeLook"):
            way = _WAYS[shape[7:].removesuffix(side.capitalize())][side == "right"]
            return {f"look_{way}_{side}": 1.0}
        return _FOR.get(shape, {})

    def _has(self, channel: str) -> bool:
        if channel.startswith("look_"):
            return channel in self.face.morphs or channel.rsplit("_", 1)[1] in self.eyes
        return channel in self.face.morphs or channel in self.by_joints

    def wear(self, clip: Clip) -> Clip:
        """Return the clip with its curves on this face's targets and joints; itself where they are
        already.
        """
        assert clip.weights is not None
        moves, _, _ = self.understood(clip.morphs)
        if all(moves.get(name) == {f"={name}": 1.0} for name in clip.morphs):
            return clip
        curves: dict[str, Array] = {}
        for n, name in enumerate(clip.morphs):
            for channel, amount in moves.get(name, {}).items():
                curves[channel] = curves.get(channel, 0.0) + amount * clip.weights[:, n].astype(float)
        targets: dict[str, Array] = {}
        turns: dict[int, Array] = {}
        shifts: dict[int, Array] = {}
        for channel, curve in curves.items():
            mix = ((channel[1:], 1.0),) if channel.startswith("=") else self.face.morphs.get(channel, ())
            for target, weight in mix:
                targets[target] = targets.get(target, 0.0) + weight * curve
            if not mix:
                self._turn(channel, curve, turns, shifts)
        weights = np.stack([np.clip(c, 0, 1) for c in targets.values()], 1) if targets else None
        return _turned(replace(clip, morphs=tuple(targets), weights=weights), turns, shifts)

    def _turn(self, channel: str, curve: Array, turns: dict[int, Array], shifts: dict[int, Array]) -> None:
        if channel.startswith("look_"):
            _, way, side = channel.split("_")
            eye = self.eyes[side]
            axis = {"left": eye.axes[1], "right": -eye.axes[1], "up": -eye.axes[0], "down": eye.axes[0]}[way]
            turns[eye.joint] = turns.get(eye.joint, 0.0) + LOOK * curve[:, None] * axis
            return
        row = CHANNELS.index(channel)
        for n, joint in enumerate(self.face.joints.tolist()):
            for found, of in ((turns, self.face.turns), (shifts, self.face.shifts)):
                if of[row, n].any():
                    found[joint] = found.get(joint, 0.0) + curve[:, None] * of[row, n]


def _turned(clip: Clip, turns: Mapping[int, Array], shifts: Mapping[int, Array]) -> Clip:
    """Return a clip whose joints are turned and shifted besides, `[F, 3]` each, as a `FaceRig` has it."""
    if not turns and not shifts:
        return clip
    rotations = np.array(clip.rotations)
    for joint, vector in turns.items():
        turn = rotation.exp(vector)
        rotations[:, joint] = rotation.multiply(rotations[:, joint].astype(float), turn)
    places = tuple(sorted({*clip.translated, *shifts}))
    translations = np.array(clip.poses().translations[:, list(places)])
    for joint, away in shifts.items():
        translations[:, places.index(joint)] += away
    return replace(
        clip, rotations=rotation.make_continuous(rotations), translations=translations, translated=places
    )


def find_wearing(project: Project) -> Wearing:
    """Return how clips' curves land on the project's face."""
    face = find_face(project)
    known = _wearings.get(id(face))
    if known is not None and known[0]() is face and known[1] == project.face.names:
        return known[2]
    made = Wearing(face, project.face.morphs, project.face.names)
    while len(_wearings) >= 8:
        _wearings.pop(next(iter(_wearings)))
    _wearings[id(face)] = ref(face), project.face.names, made
    return made


def fit_curves_to_face(project: Project, clip: Clip) -> Clip:
    """Return a clip as the project's face wears it; the same one where it has no curves, or nothing is known
    of the face it is for.
    """
    if not clip.morphs or project.character is None or clip.skeleton != project.skeleton:
        return clip
    by = find_wearing(project)
    known = _worn.get(clip)
    if known is not None and known[0] is by:
        return known[1] or clip
    made = by.wear(clip)
    _worn[clip] = by, None if made is clip else made
    return made


_wearings: dict[int, tuple[ref[FaceRig], Mapping[str, str], Wearing]] = {}
_worn: WeakKeyDictionary[Clip, tuple[Wearing, Clip | None]] = WeakKeyDictionary()


def describe_unused_curves(project: Project, clips: Iterable[Clip]) -> tuple[str, ...]:
    """Return, for the user, which curves of clips the project's face leaves, in words."""
    lost: dict[str, None] = {}
    idle: dict[str, None] = {}
    by = find_wearing(project)
    for clip in clips:
        if clip.morphs:
            _, strange, nothing = by.understood(clip.morphs)
            lost |= dict.fromkeys(strange)
            idle |= dict.fromkeys(nothing)
    out: list[str] = []
    if lost:
        out.append(
            f"blend shapes nobody knows: {_few(lost)}. Say what they are in the project file: face, names"
        )
    if idle and project.character is not None:
        out.append(f"blend shapes that this face has nothing for: {_few(idle)}")
    return tuple(out)


def _few(names: Iterable[str]) -> str:
    every = list(names)
    return ", ".join(every[:6]) + (f" and {len(every) - 6} more" if len(every) > 6 else "")
