"""Blend shape curves of clips that call them otherwise, on faces of targets and of joints."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.formats.gltf.reader import read_morph_targets, write_glb
from metagraph.formats.imports import import_files
from metagraph.graph import edits
from metagraph.graph.face.arkit import ARKIT
from metagraph.graph.face.blendshape_names import find_curve_meanings, match_arkit_shape
from metagraph.graph.face.curves import describe_unused_curves, fit_curves_to_face
from metagraph.graph.face.rig import UPPER_LID_SHUT, with_morphs
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from metagraph.motion.clip import Clip
from sample_clips.make.mannequin_skeleton import mannequin_skeleton

SAMPLES = Path(__file__).parents[3] / "sample_clips"
SKELETON = mannequin_skeleton()
PREFIXES = ("", "blendShape1.", "Head_", "head.", "BS_", "CTRL_expressions_", "Face.")


def clip(curves: dict[str, Any]) -> Clip:
    weights = np.array(list(curves.values()), np.float32).T.reshape(-1, len(curves))
    still = np.broadcast_to(SKELETON.rest_rotations, (len(weights), len(SKELETON), 4))
    root = np.broadcast_to(SKELETON.rest_translations[:1], (len(weights), 1, 3))
    return Clip("face", SKELETON, 30.0, still, root, (0,), tuple(curves), weights)


def project(targets: Any, made: Clip, names: dict[str, str] | None = None) -> Project:
    out = edits.set_character(edits.add_clips(Project(), [("face.glb", 0, "", made)]), "somebody.glb")
    out = with_morphs(out, targets)
    return replace(out, face=msgspec.structs.replace(out.face, names=names or {}))


def on(targets: Any, curves: dict[str, Any], names: dict[str, str] | None = None) -> Clip:
    made = clip(curves)
    return fit_curves_to_face(project(targets, made, names), made)


ADA = read_morph_targets(SAMPLES / "ada.glb")
VRM = ("A", "I", "U", "E", "O", "Blink", "Joy", "Angry", "Sorrow")


def styled(name: str, style: str) -> str:
    side = next((s for s in ("Left", "Right") if name.endswith(s)), "")
    root = name.removesuffix(side)
    return {
        "arkit": name,
        "upper": name[0].upper() + name[1:],
        "snake": "".join("_" + c.lower() if c.isupper() else c for c in name),
        "short": f"{root}_{side[:1]}" if side else root,
        "loud": name.upper(),
        "dotted": f"{root}.{side[:1]}" if side else root,
    }[style]


@given(
    st.sampled_from(ARKIT),
    st.sampled_from(("arkit", "upper", "snake", "short", "loud", "dotted")),
    st.sampled_from(PREFIXES),
)
def test_every_shape_is_known_in_any_case_with_any_prefix_and_short_sides(
    shape: str, style: str, prefix: str
) -> None:
    assert match_arkit_shape(prefix + styled(shape, style)) == shape


@given(st.lists(st.text(max_size=20), max_size=8))
def test_no_name_upsets_it_and_each_is_either_understood_or_told(names: list[str]) -> None:
    found, lost = find_curve_meanings(names)
    assert set(found) | set(lost) == set(names) and not set(found) & set(lost)
    for meaning in found.values():
        assert meaning.shapes.keys() <= set(ARKIT)
        assert all(0 < w <= 1 for w in (*meaning.shapes.values(), *meaning.channels.values()))


@given(st.dictionaries(st.sampled_from((*VRM, *ADA, "viseme_PP", "Smile_Left", "x1")), st.floats(0, 1)))
def test_weights_stay_within_0_to_1_and_on_the_characters_own_targets(curves: dict[str, float]) -> None:
    made = on(ADA, {name: [value, 1 - value] for name, value in curves.items()} or {"x1": [0.0]})
    assert set(made.morphs) <= set(ADA)
    assert made.weights is not None and ((made.weights >= 0) & (made.weights <= 1)).all()


def test_curves_of_the_faces_own_are_left_to_the_bit() -> None:
    made = clip({"jawOpen": [0.0, 1.5], "mouthSmileLeft": [0.3, 0.2]})
    assert fit_curves_to_face(project(ADA, made), made) is made
    assert fit_curves_to_face(Project(), made) is made


@pytest.mark.parametrize(
    ("name", "moves"),
    [
        ("Head_Mouth_Smile_L", {"mouthSmileLeft": 1}),
        ("Mouth_Funnel_Up_L", {"mouthFunnel": 0.25}),
        ("CTRL_expressions_mouthCornerPullR", {"mouthSmileRight": 1}),
        ("BrowsDown_Left", {"browDownLeft": 1}),
        ("MouthOpen", {"jawOpen": 1}),
        ("viseme_O", {"jawOpen": 0.4, "mouthFunnel": 0.6}),
        ("V_Explosive", {"mouthPressLeft": 0.45, "mouthRollLower": 0.25}),
        ("Joy", {"mouthSmileLeft": 0.9, "cheekSquintRight": 0.7}),
        ("happy", {"mouthSmileRight": 0.9}),
    ],
)
def test_names_of_other_tools_move_arkits_targets(name: str, moves: dict[str, float]) -> None:
    made = on(ADA, {name: [0.0, 1.0]})
    assert made.weights is not None
    found = dict(zip(made.morphs, made.weights[1].tolist(), strict=True))
    assert {k: pytest.approx(v, abs=1e-6) for k, v in moves.items()} == {k: found.get(k) for k in moves}
    assert not made.weights[0].any()


def test_single_letters_are_vowels_among_others_alone() -> None:
    assert "jawOpen" in on(ADA, {"A": [1.0], "I": [0.0], "U": [0.0]}).morphs
    assert on(ADA, {"A": [1.0]}).morphs == ()


def test_arkits_curves_move_a_face_that_has_only_vrms() -> None:
    made = on(VRM, {"eyeBlinkLeft": [1.0], "eyeBlinkRight": [1.0], "jawOpen": [1.0], "mouthSmileLeft": [1.0]})
    assert made.weights is not None
    found = dict(zip(made.morphs, made.weights[0].tolist(), strict=True))
    assert found["Blink"] == 1.0 and found["Joy"] == pytest.approx(0.25)


def angle(made: Clip, joint: str, frame: int = 0) -> float:
    j = SKELETON.index(joint)
    return float(
        np.degrees(rotation.measure_angle_between(made.rotations[frame, j], SKELETON.rest_rotations[j]))
    )


@pytest.mark.parametrize("targets", [(), ADA], ids=["mannequin", "Ada"])
def test_lids_and_eyes_that_are_joints_turn(targets: Any) -> None:
    made = on(targets, {"eyeBlinkLeft": [1.0, 0.5], "EyeLookUpRight": [1.0, 0.0], "tongueOut": [0.5, 0.5]})
    assert angle(made, "LeftUpperLid") == pytest.approx(UPPER_LID_SHUT, abs=0.1)
    assert angle(made, "LeftUpperLid", 1) == pytest.approx(UPPER_LID_SHUT / 2, abs=0.1)
    assert angle(made, "RightUpperLid") == 0
    assert "eyeBlinkLeft" not in made.morphs
    if not targets:
        assert angle(made, "RightEye") == pytest.approx(30, abs=0.1)
        up = rotation.rotate_vectors(made.rotations[0, SKELETON.index("RightEye")], np.array([0, 0, 1.0]))
        assert up[1] > 0.4


def test_a_jaw_that_is_a_joint_opens() -> None:
    assert angle(on((), {"blendShape1.JawOpen": [1.0]}), "Jaw") > 10
    assert angle(on((), {"viseme_aa": [1.0]}), "Jaw") > 5


def test_the_users_own_words_go_first() -> None:
    names = {"AU12_new": "mouthSmileLeft", "jawOpen": "", "weird": "mouthPucker"}
    made = on(ADA, {"AU12_new": [1.0], "jawOpen": [1.0], "weird": [0.5]}, names)
    assert made.morphs == ("mouthSmileLeft", "mouthPucker")


def test_what_nobody_knows_is_told_and_what_the_face_has_not() -> None:
    made = clip({"muscle_07": [1.0], "cheekPuff": [1.0], "jawOpen": [1.0]})
    told = describe_unused_curves(project((), made), [made])
    assert "muscle_07" in told[0] and "face, names" in told[0]
    assert "cheekPuff" in told[1] and "jawOpen" not in told[1]
    assert describe_unused_curves(project(ADA, made, {"muscle_07": ""}), [made]) == ()


def test_a_glb_with_other_names_comes_in_and_says_what_it_left(tmp_path: Path) -> None:
    curves = {"Head_Mouth_Smile_L": [0.0, 1.0], "muscle_07": [0.0, 1.0]}
    corner = np.eye(3, dtype=np.float32)
    body = CharacterMesh(
        "b", SKELETON, corner, corner, np.zeros((3, 2), np.float32), np.zeros((3, 4), np.uint16),
        np.tile(np.float32([1, 0, 0, 0]), (3, 1)), np.array([[0, 1, 2]], np.uint32), (MeshMaterial("m"),),
        (Surface(0, 1, 0),), tuple(curves), np.full((2, 3, 3), 0.01, np.float32),
    )  # fmt: skip
    write_glb(tmp_path / "smile.glb", [clip(curves)], body)
    empty = project(ADA, clip({"jawOpen": [0.0]}))
    result = import_files(empty, tmp_path, [tmp_path / "smile.glb"])
    assert [n for n in result.notes if "muscle_07" in n]
    after = result.into(empty)
    entry = list(after.clips.values())[-1]
    assert entry.motion is not None and fit_curves_to_face(after, entry.motion).morphs == ("mouthSmileLeft",)
