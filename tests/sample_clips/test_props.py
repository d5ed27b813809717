"""The props of the samples: made by their script, the same to the byte, and of the size of such things."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.props.reader import read_prop
from sample_clips.make.props import MADE, PROPS, make_props

# Metres: how high each is.
HEIGHTS = {
    "desk": (0.70, 0.76), "chair": (0.8, 1.0), "bench": (0.4, 0.5), "lectern": (1.0, 1.25),
    "wall": (2.4, 2.8),
    "plant": (0.5, 1.0), "cup": (0.08, 0.12), "phone": (0.13, 0.17), "microphone": (0.17, 0.22),
}  # fmt: skip


def test_the_script_makes_them_again_the_same_to_the_byte(tmp_path: Path) -> None:
    for made in make_props(tmp_path):
        assert made.read_bytes() == (PROPS / made.name).read_bytes(), made.name
    assert {path.stem for path in PROPS.iterdir()} == set(MADE)


@pytest.mark.parametrize("name", sorted(MADE))
def test_each_stands_on_the_floor_and_is_as_high_as_such_things_are(name: str) -> None:
    mesh = read_prop(PROPS / f"{name}.glb")
    low, high = HEIGHTS[name]
    assert abs(float(mesh.positions[:, 1].min())) < 0.03
    assert low <= float(np.ptp(mesh.positions[:, 1])) <= high
    assert mesh.notes == () and len(mesh.triangles) < 4000
    assert all(material.color[:3] != (1, 1, 1) for material in mesh.materials)
