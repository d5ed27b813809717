"""Acclaim's motion, AMC, on the skeleton of the ASF beside it, as the CMU Graphics Lab publishes both.

A bone begins where its parent ends, and turns about the axes that its `axis` gives: in its parent's space it
is turned by C R C^-1, where C is `axis` and R what the AMC says of its `dof`, the first innermost. (Acclaim's
"ASF/AMC" description, as the University of Wisconsin keeps it.)
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import FRAMES, JOINTS, MOTION_FILE
from metagraph.common.files import guard_reader, read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError, clean_text
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import FARTHEST, Skeleton

Array = NDArray[Any]

RATE = 120.0  # frames a second of CMU's files; AMC does not say
_INCH = 0.0254  # metres; ASF lengths times 1 / `length` are inches
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_ASF = phrase("Put the skeleton (.asf) beside it, with the same name or the beginning of that name.")
_AGAIN = phrase("Use the file as its makers published it.")


@dataclass
class _Bone:
    """direction: unit; length: in the file's unit. axis: what turns its axes. dof: what the AMC says."""

    name: str
    direction: Array = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    axis: Array = field(default_factory=lambda: rotation.make_identity_rotations())
    dof: tuple[str, ...] = ()
    parent: str = "root"


@dataclass
class _Figure:
    scale: float = 1.0 / 0.45
    degrees: bool = True
    degrees_in_motion: bool | None = None  # where the AMC says it, which counts there
    bones: dict[str, _Bone] = field(default_factory=dict)  # without the root, parents first


@guard_reader
def read_amc(path: str | Path) -> Clip:
    """Return the motion as a clip, metres, Y up, at 120 frames a second. Raises FileError."""
    path = Path(path)
    skeleton_file = _skeleton_of(path)
    figure = _read_asf(skeleton_file)
    order = figure.bones["root"].dof if "root" in figure.bones else ("tx", "ty", "tz", "rx", "ry", "rz")
    names = ("root", *(n for n in figure.bones if n != "root"))
    if len(names) > JOINTS:
        raise FileError(skeleton_file, phrase("has more than {most:,} joints", most=JOINTS), "", _AGAIN)
    frames = list(_frames(path, figure, order))
    if not frames:
        raise FileError(path, phrase("it has no frames"), "", _AGAIN)
    said = figure.degrees_in_motion
    unit = math.pi / 180 if (figure.degrees if said is None else said) else 1.0
    metres = figure.scale * _INCH
    rotations = rotation.make_identity_rotations((len(frames), len(names)))
    places = np.zeros((len(frames), 3))
    for joint, name in enumerate(names):
        bone = figure.bones.get(name, _Bone(name))
        dof = order if name == "root" else bone.dof
        if not dof:
            continue
        table = np.array([f.get(name, [0.0] * len(dof)) for f in frames], float)
        turn = rotation.make_identity_rotations((len(frames),))
        for column, kind in zip(table.T, dof, strict=True):
            if kind[:1] == "r" and kind[1:] in _AXES:
                about = rotation.from_axis_angle(np.array(_AXES[kind[1:]]), column * unit)
                turn = rotation.multiply(about, turn)
            elif kind in ("tx", "ty", "tz") and name == "root":
                places[:, "xyz".index(kind[1:])] = column * metres
        rotations[:, joint] = rotation.multiply(
            rotation.multiply(np.broadcast_to(bone.axis, turn.shape), turn), rotation.conjugate(bone.axis)
        )
    parents = [-1, *(names.index(figure.bones[n].parent) for n in names[1:])]
    rest = [np.zeros(3)] + [
        figure.bones[p].direction * figure.bones[p].length * metres if p in figure.bones else np.zeros(3)
        for p in (figure.bones[n].parent for n in names[1:])
    ]
    long = next((p for p, at in zip(names, rest, strict=True) if not (np.abs(at) < FARTHEST).all()), None)
    if long is not None:
        called = clean_text(figure.bones[long].parent[:40])
        raise FileError(skeleton_file, phrase("bone '{name}' is far too long", name=called), "", _AGAIN)
    skeleton = Skeleton(
        names, np.array(parents), rotation.make_identity_rotations((len(names),)), np.array(rest, float)
    )
    notes = (
        phrase("on the skeleton of {name}", name=skeleton_file.name),
        phrase("it does not give its frame rate: {rate:g} frames a second were assumed", rate=RATE),
    )
    return Clip(
        path.stem, skeleton, RATE, rotation.make_continuous(rotations), places[:, None], (0,), notes=notes
    )


def _skeleton_of(path: Path) -> Path:
    """Return the ASF beside an AMC: of the same name, of what the name begins with, or the only one. Raises
    FileError.
    """
    beside = sorted(p for p in path.parent.iterdir() if p.suffix.lower() == ".asf")
    fitting = [p for p in beside if path.stem.lower().startswith(p.stem.lower())]
    if fitting:
        return max(fitting, key=lambda p: len(p.stem))
    if len(beside) == 1:
        return beside[0]
    raise FileError(path, phrase("its skeleton is not beside it"), "", _ASF)


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    text = read_file(path, MOTION_FILE).decode("latin-1")
    lines = ((n, x.split("#", 1)[0].split()) for n, x in enumerate(text.split("\n"), 1))
    return [(n, cells) for n, cells in lines if cells]


def _numbers(path: Path, cells: list[str], n: int) -> list[float]:
    try:
        out = [float(c) for c in cells]
    except ValueError:
        out = [math.nan]
    if not all(abs(x) < 1e7 for x in out):
        value = clean_text(" ".join(cells)[:40])
        raise FileError(
            path, phrase("'{value}' are not numbers", value=value), phrase("line {n}", n=n), _AGAIN
        )
    return out


def _read_asf(path: Path) -> _Figure:
    figure, part, bone = _Figure(), "", _Bone("")
    parents: dict[str, str] = {}
    for n, cells in _lines(path):
        key = cells[0].lower()
        if key.startswith(":"):
            part = key[1:]
        elif part == "units" and key == "length" and len(cells) > 1:
            (length,) = _numbers(path, cells[1:2], n)
            figure.scale = 1.0 / length if length > 0 else 1.0
        elif part == "units" and key == "angle" and len(cells) > 1:
            figure.degrees = not cells[1].lower().startswith("rad")
        elif part == "root" and key == "order":
            figure.bones["root"] = _Bone("root", dof=tuple(c.lower() for c in cells[1:]), parent="")
        elif part == "bonedata":
            bone = _bone_line(path, figure, bone, cells, n)
        elif part == "hierarchy" and key not in ("begin", "end"):
            for child in cells[1:]:
                parents[child] = cells[0]
    ordered: dict[str, _Bone] = {k: v for k, v in figure.bones.items() if k == "root"}
    waiting = ["root"]
    children: dict[str, list[str]] = {}
    for child, parent in parents.items():
        children.setdefault(parent, []).append(child)
    while waiting:
        for child in children.get(waiting.pop(), []):
            found = figure.bones.get(child)
            if found is None or child in ordered:
                raise FileError(
                    path, phrase("bone '{name}' is not defined once", name=clean_text(child[:40])), "", _AGAIN
                )
            found.parent = parents[child]
            ordered[child] = found
            waiting.append(child)
    if len(ordered) < 2:
        raise FileError(path, phrase("it has no bones"), "", _AGAIN)
    figure.bones = ordered
    return figure


def _bone_line(path: Path, figure: _Figure, bone: _Bone, cells: list[str], n: int) -> _Bone:
    """Take in a line of a bone's data; return the bone that the next line belongs to."""
    key = cells[0].lower()
    if key == "begin":
        return _Bone("")
    if key == "name" and len(cells) > 1:
        bone = replace(bone, name=cells[1])  # a bone of its own, also where 'begin' is missing
        figure.bones[bone.name] = bone
    elif key == "direction" and len(cells) > 3:
        bone.direction = np.array(_numbers(path, cells[1:4], n))
    elif key == "length" and len(cells) > 1:
        (bone.length,) = _numbers(path, cells[1:2], n)
    elif key == "axis" and len(cells) > 4:
        angles, order = _numbers(path, cells[1:4], n), cells[4].lower()
        for angle, axis in zip(angles, order, strict=False):
            turned = math.radians(angle) if figure.degrees else angle
            about = rotation.from_axis_angle(np.array(_AXES.get(axis, (0.0, 0.0, 1.0))), turned)
            bone.axis = rotation.multiply(about, bone.axis)
    elif key == "dof":
        bone.dof = tuple(c.lower() for c in cells[1:])
    return bone


def _frames(path: Path, figure: _Figure, order: tuple[str, ...]) -> Iterator[dict[str, list[float]]]:
    """Yield what each frame says of each bone."""
    now: dict[str, list[float]] | None = None
    for count, (n, cells) in enumerate(_lines(path)):
        if cells[0].startswith(":"):
            word = cells[0][1:].upper()
            if word in ("DEGREES", "RADIANS"):
                figure.degrees_in_motion = word == "DEGREES"
            continue
        if len(cells) == 1 and cells[0].isdigit():
            if now is not None:
                yield now
            now = {}
            if count > FRAMES * JOINTS:
                raise FileError(path, phrase("it has no frames, or too many"), "", _AGAIN)
            continue
        bone = figure.bones.get(cells[0])
        size = len(order) if cells[0] == "root" else len(bone.dof) if bone is not None else -1
        if now is None or size != len(cells) - 1:
            raise FileError(
                path,
                phrase(
                    "'{name}' has {found} numbers, but the skeleton says {size}",
                    name=clean_text(cells[0][:40]),
                    found=len(cells) - 1,
                    size=max(size, 0),
                ),
                phrase("line {n}", n=n),
                _ASF,
            )
        now[cells[0]] = _numbers(path, cells[1:], n)
    if now:
        yield now
