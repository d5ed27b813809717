"""The characters that share the mannequin's skeleton: their files, their faces, their builds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_character
from metagraph.graph.face.names import VISEMES, find_morphs
from metagraph.motion.character_mesh import explain_no_character
from sample_clips.make import face_targets
from sample_clips.make.build import built
from sample_clips.make.looks import ADA, BEN, LOOKS, MANNEQUIN, MATERIALS, NEUTRAL, Build
from sample_clips.make.mannequin_skeleton import mannequin_skeleton
from sample_clips.make.shapes import JOINT, MOUTH_HALF, MOUTH_Y

FOLDER = Path(__file__).parents[2] / "sample_clips"
FACED = tuple(look for look in LOOKS if look.targets)


@pytest.fixture(scope="module", params=LOOKS, ids=lambda look: look.name)
def look(request: pytest.FixtureRequest) -> Any:
    return request.param


@pytest.fixture(scope="module", params=FACED, ids=lambda look: look.name)
def faced(request: pytest.FixtureRequest) -> Any:
    return read_character(FOLDER / request.param.file)


def moved(character: Any, name: str, near: tuple[float, float, float], reach: float = 0.008) -> Any:
    """Return how far a target moves the points near a place, on average `[3]`, metres."""
    here = np.linalg.norm(character.positions - np.array(near), axis=1) < reach
    assert here.any()
    return character.morph_positions[character.morphs.index(name)][here].mean(0)


def test_each_is_on_the_one_skeleton_whole_and_light_enough(look: Any) -> None:
    made = read_character(FOLDER / look.file)
    assert made.skeleton == mannequin_skeleton()
    assert explain_no_character(made) is None
    assert np.isfinite(made.positions).all() and np.allclose(made.weights.sum(1), 1, atol=0.01)
    assert len(made.triangles) <= 25_000
    assert (FOLDER / look.file).stat().st_size < 2_500_000
    assert made.positions[:, 1].min() == pytest.approx(0, abs=0.004)
    assert made.morphs == (tuple(face_targets.TARGETS) if look.targets else ())


def test_every_colour_is_of_one_material() -> None:
    named = [row for _, rows, _ in MATERIALS for row in rows]
    assert sorted(named) == sorted(NEUTRAL)
    for look in LOOKS:
        assert set(look.colors) <= set(NEUTRAL)


def test_they_differ_in_build() -> None:
    def waist(name: str) -> float:
        p = read_character(FOLDER / name).positions
        band = p[(np.abs(p[:, 1] - 1.06) < 0.03) & (np.abs(p[:, 0]) < 0.25)]
        return float(np.ptp(band[:, 2]))

    assert waist(ADA.file) < waist(MANNEQUIN.file) < waist(BEN.file)


def test_a_build_like_the_mannequins_moves_nothing_and_a_wide_one_the_trunk_alone() -> None:
    p = np.array([[0.12, 1.1, 0.05], [0.5, 1.1, 0.0]])
    weights = {"Spine": np.array([1.0, 0.0]), "LeftLowerArm": np.array([0.0, 1.0])}
    assert np.array_equal(built(p, weights, Build()), p)
    wide = built(p, weights, Build(trunk=((1.0, 1.5, 1.0, 1.0), (1.2, 1.5, 1.0, 1.0))))
    assert wide[0, 0] == pytest.approx(0.18) and wide[1, 0] == 0.5


def test_arms_grow_about_their_bones() -> None:
    along = JOINT["LeftUpperArm"] + 0.5 * (JOINT["LeftLowerArm"] - JOINT["LeftUpperArm"])
    p = np.array([along, along + [0, 0, 0.04]])
    thick = built(p, {"LeftUpperArm": np.ones(2)}, Build(arms=1.25))
    np.testing.assert_allclose(thick, [along, along + [0, 0, 0.05]], atol=1e-9)


def test_smiles_raise_the_corners_and_frowns_lower_them_each_on_its_side(faced: Any) -> None:
    for name, side, way in (
        ("mouthSmileLeft", 1, 1),
        ("mouthSmileRight", -1, 1),
        ("mouthFrownLeft", 1, -1),
        ("mouthFrownRight", -1, -1),
    ):
        corner = moved(faced, name, (side * MOUTH_HALF, MOUTH_Y, 0.075))
        other = moved(faced, name, (-side * MOUTH_HALF, MOUTH_Y, 0.075))
        assert way * corner[1] > 0.003
        assert abs(other[1]) < 0.25 * abs(corner[1])


def test_the_jaw_opens_downwards_and_leaves_the_upper_lip(faced: Any) -> None:
    assert moved(faced, "jawOpen", (0, 1.512, 0.087), 0.012)[1] < -0.012
    assert abs(moved(faced, "jawOpen", (0, 1.550, 0.092), 0.006)[1]) < 0.002


def test_brows_rise_inside_and_outside(faced: Any) -> None:
    assert moved(faced, "browInnerUp", (0.018, 1.631, 0.087), 0.009)[1] > 0.003
    assert moved(faced, "browOuterUpLeft", (0.044, 1.633, 0.080), 0.009)[1] > 0.003
    assert moved(faced, "browDownLeft", (0.022, 1.631, 0.087), 0.009)[1] < -0.002


def test_no_target_moves_what_is_not_of_the_face(faced: Any) -> None:
    below = faced.positions[:, 1] < 1.44
    assert below.any() and not faced.morph_positions[:, below].any()
    assert all(faced.morph_positions.any((1, 2))), "and each moves something"


def test_every_mouth_shape_is_found_in_the_targets() -> None:
    found = find_morphs(face_targets.TARGETS)
    assert {f"viseme_{v}" for v in VISEMES[1:]} <= set(found)


def test_lips_that_close_after_the_jaw_opened_meet_again() -> None:
    p = np.array([[0.0, 1.5368, 0.084], [0.0, 1.5468, 0.084]])
    open_, close = (
        face_targets.offsets(p, np.array([1.0, 0.0]), np.ones(2))[list(face_targets.TARGETS).index(n)]
        for n in ("jawOpen", "mouthClose")
    )
    assert open_[0, 1] < -0.01
    assert (open_ + close)[0, 1] == pytest.approx(0.0, abs=0.0035)
