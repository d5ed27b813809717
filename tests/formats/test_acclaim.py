"""Acclaim's ASF and AMC: bones where the skeleton puts them, turned as the motion says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.clips import read_clips
from metagraph.motion.clip import Clip

BONES = (  # name, direction, length, axis, dof, parent
    ("lowerback", "0 1 0", 10, "0 0 0", "rx ry rz", "root"),
    ("head", "0 1 0", 5, "0 0 0", "rx", "lowerback"),
    ("lhumerus", "1 0 0", 6, "0 0 90", "rz", "lowerback"),
    ("lradius", "1 0 0", 5, "0 0 0", "", "lhumerus"),
    ("lhand", "1 0 0", 2, "0 0 0", "rx", "lradius"),
)


def asf(length: float = 0.45) -> str:
    data = "".join(
        f"  begin\n    id {n}\n    name {name}\n    direction {way}\n    length {size}\n    axis {axis} XYZ\n"
        + (f"    dof {dof}\n    limits (-90 90)\n" if dof else "")
        + "  end\n"
        for n, (name, way, size, axis, dof, _) in enumerate(BONES, 1)
    )
    tree = "".join(f"    {parent} {name}\n" for name, *_, parent in BONES)
    return (
        f":version 1.10\n:name VICON\n:units\n  mass 1.0\n  length {length}\n  angle deg\n:root\n"
        "  order TX TY TZ RX RY RZ\n  axis XYZ\n  position 0 0 0\n  orientation 0 0 0\n"
        f":bonedata\n{data}:hierarchy\n  begin\n{tree}  end\n"
    )


def amc(turns: tuple[tuple[str, str], ...] = (("lhumerus", "90"),), frames: int = 3) -> str:
    given = dict(turns)
    text = "#!OML:ASF F:\\VICON\n:FULLY-SPECIFIED\n:DEGREES\n"
    for n in range(frames):
        text += f"{n + 1}\nroot {n} 17 0 0 0 0\n"
        text += "".join(
            f"{name} {given.get(name, ' '.join('0' for _ in dof.split()))}\n"
            for name, _, _, _, dof, _ in BONES
            if dof
        )
    return text


def read(folder: Path, motion: str, skeleton: str | None = None, name: str = "01.asf") -> Clip:
    (folder / name).write_text(asf() if skeleton is None else skeleton)
    (folder / "01_02.amc").write_text(motion)
    (clip,) = read_clips(folder / "01_02.amc")
    return clip


def test_bones_lie_end_to_end_in_metres_and_turn_about_their_axes(tmp_path: Path) -> None:
    clip = read(tmp_path, amc())
    metres = 0.0254 / 0.45
    _, at = clip.skeleton.globals(clip.poses())
    place = {n: at[:, k] for k, n in enumerate(clip.skeleton.names)}
    assert clip.fps == 120 and clip.frames == 3
    assert place["root"][2] == pytest.approx([2 * metres, 17 * metres, 0])
    assert place["lradius"][0] - place["lhumerus"][0] == pytest.approx(
        [0, 6 * metres, 0], abs=1e-6
    )  # turned up
    assert place["lhand"][0] - place["lradius"][0] == pytest.approx([0, 5 * metres, 0], abs=1e-6)
    assert any("120 frames a second were assumed" in n for n in clip.notes) and any(
        "01.asf" in n for n in clip.notes
    )


@pytest.mark.parametrize("said", [":RADIANS", ""])
def test_radians_turn_bones_and_their_axes_as_degrees_do(tmp_path: Path, said: str) -> None:
    skeleton = asf().replace("angle deg", "angle rad").replace("0 0 90", f"0 0 {np.pi / 2}")
    motion = amc((("lhumerus", str(np.pi / 2)),)).replace(":DEGREES", said)
    clip = read(tmp_path, motion, skeleton)
    mixed = read(tmp_path, amc(), skeleton)  # its motion says degrees
    want = read(tmp_path, amc())
    for found in (clip, mixed):
        assert np.abs(found.rotations - want.rotations).max() < 1e-6


def test_the_first_turn_is_the_innermost(tmp_path: Path) -> None:
    clip = read(tmp_path, amc((("lowerback", "90 0 90"), ("lhumerus", "0"))))
    _, at = clip.skeleton.globals(clip.poses())
    head = at[0, clip.skeleton.names.index("head")] - at[0, clip.skeleton.names.index("lowerback")]
    assert head / np.linalg.norm(head) == pytest.approx(
        [0, 0, 1], abs=1e-6
    )  # about X to +Z, where Z turns nothing


@pytest.mark.parametrize(
    ("motion", "skeleton", "cause"),
    [
        (amc((("lhumerus", "1 2"),)), None, "'lhumerus' has 2 numbers, but the skeleton says 1"),
        (amc((("lhumerus", "x"),)), None, "'x' are not numbers"),
        (amc(frames=0), None, "no frames"),
        (amc(), asf().replace("name head", "name hed"), "'head' is not defined once"),
        (amc(), ":version 1.10\n", "no bones"),
        (
            amc(),
            asf(length=1e-6).replace("length 10\n", "length 1000000\n"),
            "bone 'lowerback' is far too long",
        ),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, motion: str, skeleton: str | None, cause: str) -> None:
    with pytest.raises(FileError) as caught:
        read(tmp_path, motion, skeleton)
    assert cause in str(caught.value) and caught.value.remedy


def test_a_motion_without_its_skeleton_says_where_that_belongs(tmp_path: Path) -> None:
    (tmp_path / "01_02.amc").write_text(amc())
    with pytest.raises(FileError, match=r"skeleton is not beside it.*\.asf"):
        read_clips(tmp_path / "01_02.amc")
