"""The faces of our characters: openings that close, lids that clear the eyes, heads of the right size. And
grains of their clothes.
"""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from metagraph.formats.gltf.reader import read_character
from metagraph.motion import rotation
from sample_clips.make import face_pieces, openings, weave
from sample_clips.make.face import face_form
from sample_clips.make.iris import eye_image
from sample_clips.make.looks import ADA, BEN, LOOKS
from sample_clips.make.pieces import Piece
from sample_clips.make.shapes import EYE_RADIUS, JOINT

FOLDER = Path(__file__).parents[2] / "sample_clips"


@pytest.fixture(scope="module")
def lids() -> openings.Patch:
    return openings.lids(face_form())


def shut(patch: openings.Patch, row: int) -> Any:
    """Return the row of a patch with both lids shut, as skinning moves it `[C, 3]`."""
    share = openings.lid_shares(patch)[row][:, None]
    degrees = np.where(patch.upper, 40.0, -15.0)
    turn = rotation.from_axis_angle(np.tile([1.0, 0, 0], (len(degrees), 1)), np.radians(degrees))
    away = patch.positions[row] - JOINT["LeftEye"]
    return away + share * (rotation.rotate_vectors(turn, away) - away)


def test_lids_wrap_the_eyeball_and_have_a_little_thickness(lids: openings.Patch) -> None:
    inner, outside = (np.linalg.norm(lids.positions[row] - JOINT["LeftEye"], axis=1) for row in (0, 1))
    assert ((inner > EYE_RADIUS) & (inner < EYE_RADIUS + 0.0015)).all()
    assert (outside - inner).min() > 0.0001 and (outside - inner).max() < 0.003


def test_shut_lids_meet_along_one_line_and_stay_outside_the_eye(lids: openings.Patch) -> None:
    rim = shut(lids, 0)
    across = np.linspace(openings.INNER[0] + 0.001, openings.OUTER[0] - 0.001, 30)
    heights = []
    for upper in (True, False):
        own = rim[lids.upper == upper]
        order = np.argsort(own[:, 0])
        heights.append(np.interp(across, own[order, 0], own[order, 1]))
    assert np.abs(heights[0] - heights[1]).max() < 0.0012
    assert np.linalg.norm(rim, axis=1).min() > EYE_RADIUS - 0.0006


@pytest.mark.nightly
def test_lips_are_closed_at_rest_and_part_when_the_jaw_opens() -> None:
    patch = openings.mouth(face_form())
    contact = patch.positions[2]
    upper, lower = contact[patch.upper], contact[~patch.upper]
    middle = upper[1:-1]
    assert np.abs(middle[np.argsort(middle[:, 0])] - lower[np.argsort(lower[:, 0])]).max() < 1e-9
    piece = face_pieces.lips(face_form(), ADA)
    jaw = piece.weights["Jaw"].reshape(patch.away.shape)[2]
    centre = np.abs(contact[:, 0]) < 0.004
    assert jaw[centre & ~patch.upper].min() > 0.9
    assert jaw[centre & patch.upper].max() < 0.1


@pytest.mark.parametrize("look", LOOKS, ids=lambda look: look.name)
def test_heads_are_a_seventh_and_a_half_of_the_height(look: Any) -> None:
    made = read_character(FOLDER / look.file)
    front = made.positions[(np.abs(made.positions[:, 0]) < 0.01) & (made.positions[:, 2] > 0.03)]
    chin = front[(front[:, 1] > 1.47) & (front[:, 1] < 1.54)][:, 1].min()
    skull = made.positions[:, 1].max() - (0.018 if look.hair != "receding" else 0.0)  # hair stands off it
    assert 1 / 7.9 < (skull - chin) / 1.72 < 1 / 7.1


def test_beards_follow_the_jaw() -> None:
    ben = read_character(FOLDER / BEN.file)
    low = (ben.positions[:, 1] < 1.515) & (ben.positions[:, 2] > 0.085) & (ben.positions[:, 1] > 1.49)
    opened = ben.morph_positions[ben.morphs.index("jawOpen")][low]
    assert low.sum() > 20 and (opened[:, 1] < -0.008).all()


def test_an_eye_is_darkest_in_the_pupil_and_round_the_iris() -> None:
    image = np.asarray(Image.open(io.BytesIO(eye_image((90, 60, 40)))).convert("L")).astype(float)
    middle = len(image) // 2
    along = image[middle, middle:]
    degrees = np.arange(len(along)) / len(along) * face_pieces.EYE_SEEN
    pupil, iris = along[degrees < 8].mean(), along[(degrees > 16) & (degrees < 24)].mean()
    limbus, white = (
        along[(degrees > 28) & (degrees < 30)].mean(),
        along[(degrees > 38) & (degrees < 44)].mean(),
    )
    assert pupil < limbus < iris < white


@pytest.mark.parametrize("name", weave.TILE)
def test_a_grain_repeats_without_a_seam_and_faces_outwards(name: str) -> None:
    image = np.asarray(Image.open(io.BytesIO(weave.grain_image(name)))).astype(float) / 127.5 - 1
    assert np.linalg.norm(image, axis=2) == pytest.approx(np.ones(image.shape[:2]), abs=0.02)
    assert image[..., 2].min() > 0.2 and image[..., :2].std() > 0.03
    assert np.abs(image[..., :2].mean((0, 1))).max() < 0.05, "on average it is flat"


def test_wound_cloth_has_no_triangle_across_the_whole_turn() -> None:
    angle = np.linspace(0, 2 * np.pi, 25)[:-1]
    rings = [np.stack([0.14 * np.sin(angle), np.full(24, y), 0.14 * np.cos(angle)], 1) for y in (1.0, 1.1)]
    p = np.concatenate(rings)
    i = np.arange(24)
    triangles = np.concatenate(
        [
            np.stack([i, (i + 1) % 24, 24 + i], 1),
            np.stack([(i + 1) % 24, 24 + (i + 1) % 24, 24 + i], 1),
        ]
    )
    made = weave.woven(Piece(p, p, triangles, np.zeros(48), {"Hips": np.ones(48)}, "knit"), "knit")
    assert made.grain is not None and len(made.positions) > 48, "points are doubled where the turn ends"
    wide = np.ptp(made.grain[made.triangles][:, :, 0], axis=1)
    assert wide.max() < 1.25 * np.median(wide)


def test_ada_and_bens_clothes_have_grains_and_their_skin_has_none() -> None:
    for look in (ADA, BEN):
        made = read_character(FOLDER / look.file)
        assert made.grain_uvs is not None
        held = {m.name: m.grain is not None for m in made.materials}
        assert held["knit"] and held["denim"] and not held["skin"]
