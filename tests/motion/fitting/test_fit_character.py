"""Characters on skeletons whose joints have other names, other axes and other measures."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.clips import read_clips
from metagraph.formats.gltf.reader import read_character
from metagraph.formats.gltf.writer import write_glb
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.clip import Clip
from metagraph.motion.fitting.fit_character import (
    explain_no_fit,
    fit_character,
    is_named_alike,
    put_on_skeleton,
)
from metagraph.motion.fitting.footing import Footing, find_footing
from metagraph.motion.joint_map import find_known_roles
from metagraph.motion.skeleton import Pose, Skeleton
from preview.figure import SkinnedFigure

SAMPLE = Path(__file__).parents[3] / "sample_clips"


@lru_cache
def ada() -> CharacterMesh:
    return read_character(SAMPLE / "ada.glb")


def renamed(skeleton: Skeleton) -> Skeleton:
    """Return a skeleton whose joints have names of which only the words are the same."""
    names = tuple(f"rig:{name}" for name in skeleton.names)
    return Skeleton(names, skeleton.parents, skeleton.rest_rotations, skeleton.rest_translations)


def turned_axes(skeleton: Skeleton) -> Skeleton:
    """Return a skeleton that stands the same, with each joint's own axes turned another way."""
    rng = np.random.default_rng(4)
    turns = rotation.normalize(rng.normal(size=(len(skeleton), 4)))
    rotations, offsets = [], []
    for joint, parent in enumerate(skeleton.parents):
        above = turns[parent] if parent >= 0 else rotation.IDENTITY
        back = rotation.conjugate(above)
        rotations.append(
            rotation.multiply(rotation.multiply(back, skeleton.rest_rotations[joint]), turns[joint])
        )
        offsets.append(rotation.rotate_vectors(back, skeleton.rest_translations[joint]))
    names = tuple(f"rig:{name}" for name in skeleton.names)
    return Skeleton(names, skeleton.parents, np.array(rotations), np.array(offsets))


def posed(body: CharacterMesh, skeleton: Skeleton, rotations: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return the vertices `[V, 3]` as the preview moves them."""
    matrices = SkinnedFigure(body, skeleton).palette(rotations, places).astype(float)
    points = np.concatenate([body.positions, np.ones((len(body.positions), 1))], 1)
    each = np.einsum("vkij,vj->vki", matrices[body.joints], points)
    return np.einsum("vk,vki->vi", body.weights, each)


@pytest.mark.parametrize("change", [renamed, turned_axes])
def test_on_a_skeleton_of_the_same_measures_a_character_is_as_it_was_made(change) -> None:
    skeleton = change(ada().skeleton)
    assert not is_named_alike(ada(), skeleton)
    fitted = fit_character(ada(), skeleton)
    assert np.abs(fitted.positions - ada().positions).max() < 0.004
    assert (np.einsum("vi,vi->v", fitted.normals, ada().normals) > 0.98).mean() > 0.99
    at_rest = posed(fitted, skeleton, *skeleton.globals(skeleton.rest))
    assert np.abs(at_rest - ada().positions).max() < 0.004
    assert fitted.morphs == ada().morphs
    assert fitted.morph_positions is not None and ada().morph_positions is not None
    assert np.abs(fitted.morph_positions - ada().morph_positions).max() < 0.004


def test_it_moves_as_on_its_own_skeleton() -> None:
    clip = read_clips(SAMPLE / "clips" / "hands_at_sides__wave_hello_rt_01.glb")[0]
    other = renamed(clip.skeleton)
    pose = clip.pose_at(1.2)
    here, there = clip.skeleton.globals(pose), other.globals(pose)
    own, fitted = posed(ada(), clip.skeleton, *here), posed(fit_character(ada(), other), other, *there)
    away = np.linalg.norm(own - fitted, axis=1)
    assert np.median(away) < 0.004 and np.percentile(away, 99) < 0.035


def test_a_tall_skeleton_makes_it_tall() -> None:
    small = ada().skeleton
    skeleton = Skeleton(
        tuple(f"rig:{n}" for n in small.names),
        small.parents,
        small.rest_rotations,
        small.rest_translations * 1.5,
    )
    fitted = fit_character(ada(), skeleton)
    assert np.ptp(fitted.positions[:, 1]) == pytest.approx(1.5 * np.ptp(ada().positions[:, 1]), rel=0.01)
    assert fitted.morph_positions is not None
    assert np.abs(fitted.morph_positions).max() == pytest.approx(
        1.5 * np.abs(ada().morph_positions).max(), rel=0.02
    )


def test_a_character_that_faces_elsewhere_is_turned_to_the_front() -> None:
    own = ada().skeleton
    turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.array(2.0))
    rotations, offsets = own.rest_rotations.copy(), own.rest_translations.copy()
    rotations[0] = rotation.multiply(turn, rotations[0])
    offsets[0] = rotation.rotate_vectors(turn, offsets[0])
    away = replace(
        ada(),
        skeleton=Skeleton(own.names, own.parents, rotations, offsets),
        positions=rotation.rotate_vectors(turn, np.asarray(ada().positions, float)),
        normals=rotation.rotate_vectors(turn, np.asarray(ada().normals, float)),
    )
    fitted, straight = (fit_character(body, renamed(own)) for body in (away, ada()))
    assert np.abs(fitted.positions - straight.positions).max() < 1e-4


def test_one_without_limbs_stays_what_it_is_and_says_why() -> None:
    own = ada().skeleton
    names = tuple(f"bone {n}" for n in range(len(own)))
    flat = Skeleton(names, np.arange(-1, len(own) - 1), own.rest_rotations, own.rest_translations * 0.1)
    body, why = put_on_skeleton(ada(), flat)
    assert body is ada() and why is not None and "none of the skeleton's joints" in why
    assert explain_no_fit(ada(), flat) == "is bound to none of the skeleton's joints"


def test_a_stand_in_is_not_fitted() -> None:
    few = replace(ada(), triangles=ada().triangles[:3], surfaces=())
    assert put_on_skeleton(few, renamed(ada().skeleton))[1] == "is 3 triangles, a stand-in"


def test_a_character_whose_joints_have_the_same_names_is_not_changed() -> None:
    body, why = put_on_skeleton(ada(), ada().skeleton)
    assert body is ada() and why is None


def test_things_in_the_hand_follow_the_hand() -> None:
    hand = ada().skeleton.index("RightHand")
    surfaces = (replace(ada().surfaces[0], held=hand), *ada().surfaces[1:])
    joints, weights = ada().joints.copy(), ada().weights.copy()
    of = np.unique(ada().triangles[surfaces[0].first : surfaces[0].first + surfaces[0].count])
    joints[of], weights[of] = [hand, 0, 0, 0], [1, 0, 0, 0]
    body = replace(ada(), surfaces=surfaces, joints=joints, weights=weights)
    fitted = fit_character(body, renamed(ada().skeleton))
    assert fitted.surfaces[0].held == hand and all(s.held == -1 for s in fitted.surfaces[1:])


SETS = {
    "bandai-namco-1": "dataset-1_bow_active_001.bvh",
    "smartbody-rachel": "ChrRachel_ChrBrad@Idle02_BeatHighRt01.bvh",
    "smartbody-brad": "*.bvh",
    "kaykit-rogue": "Rogue.glb",
    "mesh2motion-cmu": "human-addon-animations.glb",
    "sumerian-hosts": "glTF/animations/adult_female/stand_idle.glb",
    "edge-bvh": "cmu_12_01_walk.bvh",
}


@pytest.mark.parametrize("name", SETS)
def test_on_real_skeletons_each_part_is_where_its_joint_is_in_every_pose(
    name: str, shared_data: Path
) -> None:
    files = sorted((shared_data / name).glob(SETS[name]))
    if not files:
        pytest.skip(f"{name} is not there")
    clip: Clip = max(read_clips(files[0]), key=lambda c: c.frames)
    fitted = fit_character(ada(), clip.skeleton, find_footing(clip))
    own, roles = find_known_roles(ada().skeleton, None), find_known_roles(clip.skeleton, None)
    rest = ada().skeleton.globals(ada().skeleton.rest)[1]
    tall = float(np.ptp(fitted.positions[:, 1]) / np.ptp(ada().positions[:, 1]))
    for frame in np.linspace(0, clip.frames - 1, 5).round().astype(int):
        rotations, places = clip.skeleton.globals(clip.poses()[frame])
        points = posed(fitted, clip.skeleton, rotations, places)
        for role in ("head", "left_hand", "right_hand", "left_foot", "right_foot", "left_lower_leg"):
            whole = (ada().weights * (ada().joints == own[role])).sum(1) > 0.99
            made = np.linalg.norm(ada().positions[whole] - rest[own[role]], axis=1)
            found = np.linalg.norm(points[whole] - places[roles[role]], axis=1)
            assert np.median(found) < 3 * tall * np.median(made), f"{role} in frame {frame}"


def test_on_a_skeleton_that_rests_folded_what_is_exported_is_what_is_drawn(tmp_path: Path) -> None:
    """Its rest is bent by a right angle at the waist and the knees, as recorded skeletons may be."""
    own = ada().skeleton
    rotations = own.rest_rotations.copy()
    for name, axis in (("Spine", [1.0, 0, 0]), ("LeftLowerLeg", [1.0, 0, 0]), ("Neck", [0, 1.0, 0])):
        joint = own.index(name)
        bent = rotation.from_axis_angle(np.array(axis), np.array(1.5))
        rotations[joint] = rotation.multiply(rotations[joint], bent)
    names = tuple(f"rig:{name}" for name in own.names)
    folded = Skeleton(names, own.parents, rotations, own.rest_translations)
    standing = Footing(Pose(own.rest_rotations, own.rest_translations))
    fitted = fit_character(ada(), folded, standing)
    here = folded.globals(standing.pose)
    assert np.abs(posed(fitted, folded, *here) - ada().positions).max() < 0.004
    clip = read_clips(SAMPLE / "clips" / "hands_at_sides__wave_hello_rt_01.glb")[0]
    write_glb(tmp_path / "folded.glb", [replace(clip, skeleton=folded, morphs=(), weights=None)], fitted)
    written = read_character(tmp_path / "folded.glb")
    there = written.skeleton.globals(clip.pose_at(1.2))
    waving = folded.globals(clip.pose_at(1.2))
    drawn, read = posed(fitted, folded, *waving), posed(written, written.skeleton, *there)
    for points in (drawn[::97], drawn[1::101]):
        apart = np.linalg.norm(read[:, None] - points, axis=2).min(0)
        assert apart.max() < 1e-3
