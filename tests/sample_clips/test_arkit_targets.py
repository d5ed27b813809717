"""All 52 of ARKit's blend shapes on our characters: what each moves in the exported file, and which way."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.engines.export import export_project
from metagraph.formats.gltf.reader import read_character
from metagraph.graph.edits import add_clips, add_stance
from metagraph.graph.face.arkit import ARKIT
from metagraph.graph.face.rig import LIDS, find_face
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from sample_clips.make.looks import LOOKS
from sample_clips.make.shapes import JOINT, MOUTH_Y
from tests.unchanged import only_when_changed

pytestmark = only_when_changed("sample clips")

FOLDER = Path(__file__).parents[2] / "sample_clips"
EYE = tuple(JOINT["LeftEye"])
CORNER, CHEEK, PUPIL = (0.0215, MOUTH_Y, 0.075), (0.038, 1.588, 0.078), (EYE[0], EYE[1], EYE[2] + 0.0154)
LID, LOW_LID = (EYE[0], EYE[1] + 0.009, EYE[2] + 0.0137), (EYE[0], EYE[1] - 0.009, EYE[2] + 0.0137)
UPPER_LIP, LOWER_LIP, CHIN = (0.0, 1.548, 0.086), (0.0, 1.535, 0.086), (0.0, 1.513, 0.078)
# Of the left of a pair, else of the whole: where a point is, and which way it goes at least half as far as
# the farthest of there: 0 across (1 to the left), 1 up, 2 ahead.
WAYS: dict[str, tuple[tuple[float, float, float], int, int]] = {
    "eyeBlink": (LID, 1, -1), "eyeWide": (LID, 1, 1), "eyeSquint": ((0.033, 1.586, 0.075), 1, 1),
    "eyeLookDown": (PUPIL, 1, -1), "eyeLookUp": (PUPIL, 1, 1), "eyeLookIn": (PUPIL, 0, -1),
    "eyeLookOut": (PUPIL, 0, 1), "jawForward": (CHIN, 2, 1), "jawOpen": (CHIN, 1, -1), "jaw": (CHIN, 0, 1),
    "mouthClose": (LOWER_LIP, 1, 1), "mouthFunnel": (UPPER_LIP, 2, 1), "mouthPucker": (UPPER_LIP, 2, 1),
    "mouth": (UPPER_LIP, 0, 1), "mouthSmile": (CORNER, 1, 1), "mouthFrown": (CORNER, 1, -1),
    "mouthDimple": (CORNER, 2, -1), "mouthStretch": (CORNER, 0, 1), "mouthRollLower": (LOWER_LIP, 2, -1),
    "mouthRollUpper": (UPPER_LIP, 2, -1), "mouthShrugLower": (LOWER_LIP, 1, 1),
    "mouthShrugUpper": (UPPER_LIP, 1, 1), "mouthPress": ((0.009, 1.547, 0.083), 2, -1),
    "mouthLowerDown": ((0.009, 1.535, 0.083), 1, -1), "mouthUpperUp": ((0.009, 1.548, 0.083), 1, 1),
    "browDown": ((0.0165, 1.630, 0.086), 1, -1), "browInnerUp": ((0.0165, 1.630, 0.086), 1, 1),
    "browOuterUp": ((0.044, 1.632, 0.079), 1, 1), "cheekPuff": ((0.040, 1.545, 0.056), 0, 1),
    "cheekSquint": (CHEEK, 1, 1), "noseSneer": ((0.012, 1.574, 0.090), 1, 1),
    "tongueOut": ((0.0, 1.538, 0.070), 2, 1),
}  # fmt: skip


@pytest.fixture(scope="module", params=[look.file for look in LOOKS if look.targets])
def exported(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("face")
    body = read_character(FOLDER / request.param)
    joints = body.skeleton
    still = Clip("still", joints, 30.0, joints.rest_rotations[None], joints.rest_translations[None, :1])
    clips = add_clips(Project(name="face"), [("still.glb", 0, "", still)])
    project = add_stance(clips, "arms", "rest", list(clips.clips))
    return read_character(export_project(project, folder, character=FOLDER / request.param).glb)


def test_an_export_has_all_52_under_arkits_names(exported: Any) -> None:
    assert len(ARKIT) == len(set(ARKIT)) == 52
    assert sorted(exported.morphs) == sorted(ARKIT)


@pytest.mark.parametrize("name", ARKIT)
def test_each_moves_its_part_of_the_face_its_way(exported: Any, name: str) -> None:
    root, side = name, 1
    for word, sign in (("Left", 1), ("Right", -1)):
        if name.endswith(word):
            root, side = name.removesuffix(word), sign
    place, axis, way = WAYS[root]
    if axis == 0:
        way *= side
    moved = exported.morph_positions[exported.morphs.index(name)]
    at = np.array(place) * [-1.0 if side < 0 and root not in ("jaw", "mouth") else 1.0, 1, 1]
    away = np.linalg.norm(exported.positions - at, axis=1)
    size = np.linalg.norm(moved, axis=1)
    here = away < 0.02
    farthest = np.flatnonzero(here)[size[here].argmax()]
    assert 0.001 < size.max() < 0.045, "millimetres"
    assert size[farthest] > 0.5 * size.max() or root == "jawOpen", "it moves most about there"
    assert way * moved[farthest, axis] > 0.4 * size[farthest], "and goes its way"


def test_left_and_right_mirror_each_other(exported: Any) -> None:
    flip = np.array([-1.0, 1, 1])
    order = np.lexsort(np.round(exported.positions * flip, 5).T)
    twin = np.empty(len(order), int)
    twin[np.lexsort(np.round(exported.positions, 5).T)] = order
    paired = np.linalg.norm(exported.positions[twin] - exported.positions * flip, axis=1) < 1e-4
    assert paired.mean() > 0.2
    for left in (n for n in ARKIT if n.endswith("Left")):
        a, b = (
            exported.morph_positions[exported.morphs.index(n)] for n in (left, left.replace("Left", "Right"))
        )
        assert np.abs(a).max() == pytest.approx(np.abs(b).max(), rel=0.08), "heads are sampled, not mirrored"
        assert np.abs(a[paired] - b[twin[paired]] * flip).max() < 4e-4


def test_eyes_and_lids_stay_with_the_joints_so_that_nothing_is_moved_twice() -> None:
    body = read_character(FOLDER / "ada.glb")
    rig = find_face(Project(skeleton=body.skeleton), body.morphs)
    assert len(rig.eyes) == 2 and (rig.lid_joints >= 0).all()
    assert not [c for c in rig.morphs if c.startswith(("blink", "wide", "look"))]
    assert set(LIDS) <= set(rig.joint_channels())
