"""The takes that sets are made of: the sample clips with what they are."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.formats.imports import gather, import_files
from metagraph.graph.model import Project
from metagraph.graph.words import Kind, Layer
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]
ROOT = Path(__file__).resolve().parents[2]
FPS = 30.0
ARMS = ("hands_at_sides", "arms_crossed", "hand_to_chin", "hands_clasped", "on_hips")
BODY = ("weight_both", "weight_left", "weight_right", "lean_forward")
HEAD = ("straight", "tilt_left", "tilt_right")


@dataclass(frozen=True, eq=False)
class Motion:
    """What the sample character does: rotations `[F, J, 4]` local, root `[F, 3]` metres, FPS frames a
    second.
    """

    turns: Array
    root: Array

    @property
    def frames(self) -> int:
        return len(self.turns)


@dataclass(frozen=True, eq=False)
class Take:
    """A motion and what it is. kind None: none of the four. stance, end, action: keys of the words; action
    "" of a stance or a transition.
    """

    motion: Motion
    kind: Kind | None
    layer: Layer | None
    stance: str
    end: str
    limb: str | None
    action: str
    source: str


def key_of(stance: str | None) -> str:
    """Return the key of a stance of the truth: 'head tilt left' -> 'tilt_left'."""
    return (stance or "").removeprefix("head ").replace(" ", "_")


@cache
def takes() -> tuple[Take, ...]:
    """Return the sample clips, by name."""
    folder = ROOT / "sample_clips" / "clips"
    project = import_files(Project("sample"), None, gather([folder])).into(Project("sample"))
    told = json.loads((ROOT / "tests/suggest/truth/sample_clips.json").read_text("utf-8"))["clips"]
    out = []
    for entry in sorted(project.clips.values(), key=lambda e: e.name):
        row, clip = told[entry.name], entry.motion
        assert clip is not None
        part = entry.name.split("__")[1]
        action = "" if row["kind"] in ("stance", "transition") else re.sub(r"(_(rt|lf|bt))?_\d+$", "", part)
        motion = Motion(clip.rotations.astype(np.float64), clip.root.astype(np.float64))
        limb = row["limb"] if row["layer"] == "arms" else None
        out.append(
            Take(
                motion,
                row["kind"],
                row["layer"],
                key_of(row["stance"]),
                key_of(row["end_stance"]),
                limb,
                action,
                entry.name,
            )
        )
    return tuple(out)


@cache
def skeleton() -> Skeleton:
    """Return the sample character's skeleton: no turns at rest, arms slanting down."""
    project = import_files(Project("s"), None, gather([ROOT / "sample_clips" / "clips"])[:1]).into(Project())
    assert project.skeleton is not None
    return project.skeleton


@cache
def loop(stance: str) -> Take:
    """Return the take that rests in a stance of the sample clips."""
    return next(t for t in takes() if t.kind == "stance" and t.stance == stance)


@cache
def base() -> Motion:
    """Return the one pose that everything is taken against."""
    whole = loop("hands_at_sides").motion
    return Motion(whole.turns[:1], whole.root[:1])


def joint(name: str) -> int:
    return skeleton().index(name)


def turn(axis: str, degrees: Any) -> Array:
    """Return turns about an axis of the world: x to the left, y up, z ahead."""
    return rotation.from_axis_angle(np.eye(3)["xyz".index(axis)], np.radians(degrees))


def clip_of(name: str, motion: Motion) -> Clip:
    """Return a motion as a clip."""
    turns = rotation.make_continuous(rotation.normalize(motion.turns))
    return Clip(name, skeleton(), FPS, turns, motion.root[:, None])
