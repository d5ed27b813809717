"""The AnimationLibrary of a character for Godot 4, as a text resource.

The library's animation RESET is the base pose. Godot takes it, not the skeleton's rest, as what layers are
added to.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.engines.engine_machine import Machine, make_animations
from metagraph.engines.targets.godot_tree import list_track_paths
from metagraph.formats.gltf.key_thinning import find_kept_frames
from metagraph.graph.anatomy import get_base_pose
from metagraph.graph.model import Project

Array = NDArray[Any]

OFF = 5e-4  # how far thinned keys may be off, of a quaternion's part or in metres


def write_animation_library(project: Project, built: Sequence[Machine]) -> str:
    """Return the text of an AnimationLibrary: an animation for each state, and RESET."""
    clips = make_animations(project, tuple(built))
    turns = find_kept_frames([clip.rotations for clip in clips], OFF, True)
    shifts = find_kept_frames([clip.translations for clip in clips], OFF, False)
    states = [(machine, state) for machine in built for state in machine.states]
    parts = [_write_animation(0, "RESET", 0.001, False, 1 / 30, _list_reset_tracks(project))]
    for (machine, state), clip, turned, moved in zip(states, clips, turns, shifts, strict=True):
        tracks = _Tracks(project)
        joints = {clip.skeleton.index(name) for name in machine.joints}
        for column, (joint, kept) in enumerate(zip(clip.translated, moved, strict=True)):
            if joint in joints:
                tracks.add("position", joint, kept / clip.fps, clip.translations[kept, column])
        for joint in sorted(joints):
            kept = turned[joint]
            tracks.add("rotation", joint, kept / clip.fps, clip.rotations[kept, joint])
        step = 1 / clip.fps
        parts.append(_write_animation(len(parts), state.name, clip.duration, state.loop, step, tracks.lines))
    names = ["RESET", *(state.name for _, state in states)]
    rows = ",\n".join(f'&{_quote(name)}: SubResource("{n}")' for n, name in enumerate(names))
    head = '[gd_resource type="AnimationLibrary" format=3]\n\n'
    return f"{head}{''.join(parts)}[resource]\n_data = {{\n{rows}\n}}\n"


class _Tracks:
    """The lines of an animation's tracks."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self.lines: list[str] = []
        self._count = 0

    def add(self, kind: str, joint: int, times: Array, values: Array) -> None:
        """Add a track: values `[K, n]` at seconds `[K]`."""
        assert self._project.skeleton is not None
        (path,) = list_track_paths(self._project, self._project.skeleton.names[joint], 4)
        rows = np.concatenate([times[:, None], np.ones((len(times), 1)), values], 1)
        numbers = ", ".join(f"{x:.5g}" for x in rows.ravel().tolist())
        head = f"tracks/{self._count}/"
        self.lines += [
            f'{head}type = "{kind}_3d"',
            f"{head}imported = true",
            f"{head}enabled = true",
            f"{head}path = NodePath({_quote(path)})",
            f"{head}interp = 1",
            f"{head}loop_wrap = true",
            f"{head}keys = PackedFloat32Array({numbers})",
        ]
        self._count += 1


def _list_reset_tracks(project: Project) -> list[str]:
    assert project.skeleton is not None
    base, tracks = get_base_pose(project), _Tracks(project)
    for joint in range(len(project.skeleton)):
        for kind, values in (("position", base.translations), ("rotation", base.rotations)):
            tracks.add(kind, joint, np.zeros(1), np.asarray(values)[joint : joint + 1])
    return tracks.lines


def _write_animation(
    number: int, name: str, seconds: float, loop: bool, step: float, tracks: Sequence[str]
) -> str:
    lines = [
        f'[sub_resource type="Animation" id="{number}"]',
        f"resource_name = {_quote(name)}",
        f"length = {seconds:.6g}",
        *(["loop_mode = 1"] if loop else []),
        f"step = {step:.6g}",
        *tracks,
    ]
    return "\n".join(lines) + "\n\n"


def _quote(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
