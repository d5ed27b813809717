"""Finding faces: the mannequin's joints, real hosts' joints shown by their clips, morph targets,
corrections.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.formats.imports import import_files
from metagraph.graph import edits
from metagraph.graph.face.rig import (
    CHANNELS,
    JAW_OPEN,
    LIDS,
    MOUTH,
    FaceRig,
    find_body_axes,
    find_face,
    list_morph_names,
    with_morphs,
)
from metagraph.graph.life import Face, FacePose
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

ROW = {channel: n for n, channel in enumerate(CHANNELS)}


def bound(project: Project, **changes: Any) -> Project:
    return replace(project, face=msgspec.structs.replace(project.face, **changes))


def degrees(face: FaceRig, project: Project, channel: str) -> dict[str, float]:
    """How far a channel turns each joint at 1."""
    assert project.skeleton is not None
    sizes = np.degrees(np.linalg.norm(face.turns[ROW[channel]], axis=1))
    return {
        project.skeleton.names[j]: round(float(x), 3)
        for j, x in zip(face.joints, sizes, strict=True)
        if x > 0
    }


# --- nothing there


def test_a_project_without_a_skeleton_has_no_face() -> None:
    assert find_face(Project()).empty


def test_a_body_without_a_face_has_none(toy: Any) -> None:
    assert find_face(toy.project()).empty


# --- the mannequin


def test_the_mannequins_lids_shut_as_far_as_its_maker_says(sample: Project) -> None:
    face = find_face(sample)
    assert degrees(face, sample, "upper_lid_left") == {"LeftUpperLid": 40.0}
    assert degrees(face, sample, "lower_lid_right") == {"RightLowerLid": 15.0}
    lids = face.turns[[ROW[c] for c in LIDS]].sum(1)
    assert (lids[:2, 0] > 0).all() and (lids[2:, 0] < 0).all() and np.abs(lids[:, 1:]).max() < 1e-9, (
        "about X, down and up"
    )
    assert not face.shifts.any(), "its lids turn about the eye itself"


def test_the_mannequin_speaks_with_its_jaw_and_shuts_it_for_lips_that_meet(sample: Project) -> None:
    face = find_face(sample)
    assert degrees(face, sample, "jaw_open") == {"Jaw": JAW_OPEN}
    assert degrees(face, sample, "viseme_aa")["Jaw"] > degrees(face, sample, "viseme_I")["Jaw"] > 0
    assert degrees(face, sample, "viseme_PP") == {}


def test_the_mannequins_eyes_look_ahead_at_rest(sample: Project) -> None:
    face = find_face(sample)
    assert [e.side for e in face.eyes] == ["left", "right"]
    for eye in face.eyes:
        assert np.allclose(eye.axes, np.eye(3), atol=1e-6)


def test_how_far_a_lid_is_shut_is_read_back_from_its_rotation(sample: Project) -> None:
    face = find_face(sample)
    rest = sample.skeleton.rest_rotations  # type: ignore[union-attr]
    for n, lid in enumerate(LIDS):
        joint = int(face.lid_joints[n])
        turn = face.turns[n, list(face.joints).index(joint)]
        for part in (-0.5, 0.0, 0.3, 1.0):
            q = rotation.multiply(rest[joint], rotation.exp(part * turn))
            assert float(q @ face.shut_by[n]) == pytest.approx(part, abs=0.03), lid


def test_a_correction_moves_a_channel_to_another_joint_or_turns_it_off(sample: Project) -> None:
    moved = bound(sample, channels={"jaw_open": "LeftBrow", "upper_lid_left": "", "eye_right": ""})
    face = find_face(moved)
    assert set(degrees(face, moved, "viseme_aa")) == {"LeftBrow"}
    assert degrees(face, moved, "upper_lid_left") == {} and degrees(face, moved, "upper_lid_right")
    assert face.lid_joints[0] == -1 and [e.side for e in face.eyes] == ["left"]


def test_a_channel_bound_to_what_does_not_exist_is_off(sample: Project) -> None:
    face = find_face(bound(sample, channels={"jaw_open": "Nowhere"}))
    assert not any(face.turns[ROW[c]].any() for c in MOUTH)


def test_what_was_found_is_found_once(sample: Project) -> None:
    assert find_face(sample) is find_face(replace(sample, name="other"))
    assert find_face(sample) is not find_face(bound(sample, channels={"jaw_open": ""}))


# --- lids whose joints are not at the eye


def test_lids_hung_elsewhere_go_round_the_eye() -> None:
    rows = [
        ("Hips", -1, (0, 1, 0)),
        ("Spine", 0, (0, 0.2, 0)),
        ("Neck", 1, (0, 0.3, 0)),
        ("Head", 2, (0, 0.1, 0)),
        ("LeftEye", 3, (0.03, 0.1, 0.05)),
        ("LeftUpperLid", 3, (0.03, 0.1, 0.0)),
        ("RightEye", 3, (-0.03, 0.1, 0.05)),
        ("LeftUpperArm", 1, (0.2, 0.2, 0)),
        ("LeftLowerArm", 7, (0.3, 0, 0)),
        ("LeftHand", 8, (0.2, 0, 0)),
        ("RightUpperArm", 1, (-0.2, 0.2, 0)),
        ("RightLowerArm", 10, (-0.3, 0, 0)),
        ("RightHand", 11, (-0.2, 0, 0)),
    ]
    names, parents, at = zip(*rows, strict=True)
    turns = rotation.from_axis_angle(np.tile([0.3, 0.5, 0.1], (len(rows), 1)), np.linspace(0, 1, len(rows)))
    skeleton = Skeleton(names, np.array(parents), turns, np.array(at, float))
    project = replace(Project(), skeleton=skeleton)
    face = find_face(project)
    place = list(face.joints).index(skeleton.index("LeftUpperLid"))
    before, at_rest = skeleton.globals(skeleton.rest)
    local_r, local_t = skeleton.rest_rotations.copy(), skeleton.rest_translations.copy()
    joint = skeleton.index("LeftUpperLid")
    local_r[joint] = rotation.multiply(local_r[joint], rotation.exp(face.turns[0, place]))
    local_t[joint] += face.shifts[0, place]
    after, moved = skeleton.globals(type(skeleton.rest)(local_r, local_t))
    eye = at_rest[skeleton.index("LeftEye")]
    axes = find_body_axes(
        skeleton, {"left_eye": skeleton.index("LeftEye"), "right_eye": skeleton.index("RightEye")}, at_rest
    )
    turn = rotation.from_axis_angle(axes[0], np.radians(40.0))
    assert np.allclose(moved[joint], eye + rotation.rotate_vectors(turn, at_rest[joint] - eye), atol=1e-9)
    assert rotation.measure_angle_between(after[joint], rotation.multiply(turn, before[joint])) < 1e-7


@pytest.mark.parametrize("turn", [0.0, 1.0, -2.5])
def test_a_character_that_faces_elsewhere_has_its_own_left_and_ahead(toy: Any, turn: float) -> None:
    roles = {"left_upper_leg": 10, "right_upper_leg": 13}
    _, at = toy.skeleton.globals(toy.skeleton.rest)
    spin = rotation.from_axis_angle([0, 1.0, 0], turn)
    axes = find_body_axes(toy.skeleton, roles, rotation.rotate_vectors(spin, at))
    assert np.allclose(axes, rotation.rotate_vectors(spin, np.eye(3)), atol=1e-9)


def test_a_character_without_sides_looks_along_z(toy: Any) -> None:
    assert np.array_equal(find_body_axes(toy.skeleton, {}, np.zeros((16, 3))), np.eye(3))


# --- clips that show a face


def shown(
    project: Project, skeleton: Skeleton, name: str, joint: str, angle: float, shift: float = 0.0
) -> Project:
    """The project with a clip whose second frame turns a joint about X and shifts it along Y."""
    rotations = np.tile(skeleton.rest_rotations, (3, 1, 1))
    rotations[1, skeleton.index(joint)] = rotation.from_axis_angle([1.0, 0, 0], np.radians(angle))
    rotations[:, skeleton.index("LeftHand")] = rotation.from_axis_angle([1.0, 0, 0], 0.5)  # not the face's
    moved = sorted({0, skeleton.index(joint)})
    translations = np.tile(skeleton.rest_translations[moved], (3, 1, 1))
    translations[1, -1, 1] += shift
    return edits.add_clips(
        project, [(f"{name}.glb", 0, "", Clip(name, skeleton, 30, rotations, translations, tuple(moved)))]
    )


def test_a_blink_clip_shows_how_far_lids_shut(sample: Project) -> None:
    skeleton = sample.skeleton
    assert skeleton is not None
    project = shown(sample, skeleton, "blink", "LeftUpperLid", 33.0, -0.002)
    face = find_face(project)
    assert degrees(face, project, "upper_lid_left") == {"LeftUpperLid": pytest.approx(33.0, abs=0.01)}
    place = list(face.joints).index(skeleton.index("LeftUpperLid"))
    assert face.shifts[0, place] == pytest.approx([0, -0.002, 0], abs=1e-6)
    assert degrees(face, project, "upper_lid_right") == {}, "the clip is taken at its word"


def test_a_frame_of_a_clip_bound_by_the_user_goes_before_what_was_found(sample: Project) -> None:
    skeleton = sample.skeleton
    assert skeleton is not None
    project = shown(sample, skeleton, "say ah", "Jaw", 9.0)
    clip = list(project.clips)[-1]
    project = bound(
        project,
        poses={
            "viseme_aa": FacePose(clip=clip),
            "viseme_O": FacePose(clip=clip, frame=2),
            "nonsense": FacePose(clip=clip),
        },
    )
    face = find_face(project)
    assert degrees(face, project, "viseme_aa") == {"Jaw": pytest.approx(9.0, abs=0.01)}
    assert degrees(face, project, "viseme_O") == degrees(find_face(sample), sample, "viseme_O"), (
        "a frame that shows nothing changes nothing"
    )


def test_a_pose_of_a_clip_that_is_gone_is_ignored(sample: Project) -> None:
    project = bound(sample, poses={"viseme_aa": FacePose(clip="c99999")})
    assert degrees(find_face(project), project, "viseme_aa") == degrees(
        find_face(sample), sample, "viseme_aa"
    )


# --- morph targets


def test_morph_targets_go_before_joints_but_eyes_stay_joints(sample: Project) -> None:
    project = with_morphs(
        sample, ["eyeBlinkLeft", "eyeBlinkRight", "jawOpen", "mouthFunnel", "eyeLookUpLeft"]
    )
    face = find_face(project)
    assert {"blink_left", "viseme_aa"} <= face.morphs.keys() and "look_up_left" not in face.morphs
    assert len(face.joints) == 0 and len(face.eyes) == 2


def test_morph_targets_are_known_from_clips_memory_and_the_caller(toy: Any) -> None:
    clip = toy.clip("smile")
    clip = replace(clip, morphs=("jawOpen",), weights=np.zeros((clip.frames, 1)))
    project = with_morphs(edits.add_clips(Project(), [("smile.glb", 0, "", clip)]), ["A"])
    assert list_morph_names(project, ["blink"]) == ("A", "blink", "jawOpen")
    assert "blink" in find_face(project, ["blink"]).morphs and "blink" not in find_face(project).morphs
    assert with_morphs(project, ["A"]) is project


# --- real hosts


@pytest.mark.parametrize(("host", "upper"), [("adult_female", 2), ("alien", 3)])
def test_real_hosts_show_their_faces_by_their_clips(shared_data: Path, host: str, upper: int) -> None:
    folder = shared_data / "sumerian-hosts" / "glTF" / "animations" / host
    project = import_files(
        Project(), folder, [folder / f"{n}.glb" for n in ("stand_idle", "blink", "lipsync")]
    ).into(Project())
    face = find_face(project)
    assert len(face.eyes) == 2 and {f"viseme_{v}" for v in ("PP", "aa", "O", "SS")} <= set(
        face.joint_channels()
    )
    lids = degrees(face, project, "upper_lid_left")
    assert len(lids) >= upper and max(lids.values()) > 40
    assert np.degrees(np.linalg.norm(face.turns, axis=-1)).max() < 90 and face.shifts.any()
    assert project.face == Face(), "nothing had to be set"
