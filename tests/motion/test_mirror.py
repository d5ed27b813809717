"""The left/right twin of a clip."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.formats.clips import read_clips
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.mirror import find_joint_twins, mirror, swap_sides
from metagraph.motion.skeleton import Pose, Skeleton
from tests.zoo import ANIMALS

MIRROR = np.array([-1.0, 1, 1])


def random_clip(skeleton: Skeleton, seed: int, frames: int = 3, morphs: tuple[str, ...] = ()) -> Clip:
    rng = np.random.default_rng(seed)
    rotations = rotation.normalize(rng.normal(size=(frames, len(skeleton), 4)))
    moved = tuple(sorted({0, *rng.integers(0, len(skeleton), 3).tolist()}))
    translations = skeleton.rest_translations[list(moved)] + rng.normal(size=(frames, len(moved), 3)) * 0.1
    return Clip(
        "c",
        skeleton,
        30,
        rotation.make_continuous(rotations),
        translations,
        moved,
        morphs,
        rng.random((frames, len(morphs))),
    )


def twisted(skeleton: Skeleton, seed: int) -> Skeleton:
    """The same figure with bones that have other axes, differently on either side."""
    rng = np.random.default_rng(seed)
    model, places = skeleton.globals(skeleton.rest)
    model = rotation.normalize(rng.normal(size=model.shape))
    inner = skeleton.parents >= 0
    above = skeleton.parents[inner]
    local, offsets = model.copy(), places.copy()
    local[inner] = rotation.multiply(rotation.conjugate(model[above]), model[inner])
    offsets[inner] = rotation.rotate_vectors(rotation.conjugate(model[above]), places[inner] - places[above])
    return Skeleton(skeleton.names, skeleton.parents, local, offsets)


def apart(a: Clip, b: Clip) -> tuple[float, float]:
    """Return how far two clips are apart: degrees, metres."""
    turned = rotation.measure_angle_between(a.rotations.astype(float), b.rotations.astype(float)).max()
    return float(np.degrees(turned)), float(np.abs(a.poses().translations - b.poses().translations).max())


@pytest.mark.parametrize(
    ("name", "twin"),
    [
        ("wave_lf", "wave_rt"), ("Wave_RT_01", "Wave_LF_01"), ("LeftHand", "RightHand"),
        ("handLeft", "handRight"),
        ("UpperArm_L", "UpperArm_R"),
        ("arm.r", "arm.l"), ("lHand", "rHand"), ("Palm2L", "Palm2R"),
        ("char:def_l_elbow", "char:def_r_elbow"), ("LEFT HAND", "RIGHT HAND"),
        ("Lefthand", "Righthand"), ("point to the "
                                    "right", "point to the left"), ("bright", "bright"), ("loop", "loop"),
        ("take R2", "take R2"),
        ("wave_bt", "wave_bt"), ("", ""), ("leftover", "leftover"), ("mouthSmile_L", "mouthSmile_R"),
    ],
)  # fmt: skip
def test_words_for_sides_are_exchanged_and_keep_their_case(name: str, twin: str) -> None:
    assert swap_sides(name) == twin
    assert swap_sides(twin) == name


@given(st.text(max_size=30))
def test_any_text_can_be_swapped_without_losing_other_letters(text: str) -> None:
    assert swap_sides(swap_sides(swap_sides(text))) == swap_sides(text)


def test_every_joint_of_the_mannequin_has_its_twin_or_is_in_the_middle(sample: Any) -> None:
    skeleton = sample.skeleton
    for joint, twin in enumerate(find_joint_twins(skeleton)):
        assert skeleton.names[twin] == swap_sides(skeleton.names[joint])


def test_joints_whose_names_say_nothing_are_paired_by_where_they_are(toy: Any) -> None:
    names = tuple(f"j{i}" for i in range(len(toy.skeleton)))
    skeleton = Skeleton(
        names, toy.skeleton.parents, toy.skeleton.rest_rotations, toy.skeleton.rest_translations
    )
    assert find_joint_twins(skeleton) == find_joint_twins(toy.skeleton)


def test_a_mirrored_pose_is_the_mirror_image(toy: Any) -> None:
    clip = random_clip(toy.skeleton, 1)
    pairs = find_joint_twins(toy.skeleton)
    _, before = toy.skeleton.globals(clip.poses())
    _, after = toy.skeleton.globals(mirror(clip, pairs).poses())
    np.testing.assert_allclose(after, before[:, pairs] * MIRROR, atol=1e-5)


@pytest.mark.nightly
@given(st.integers(0, 2**31), st.integers(1, 4))
def test_a_clip_mirrored_twice_is_itself_whatever_the_axes_of_its_bones(
    toy: Any, seed: int, frames: int
) -> None:
    skeleton = twisted(toy.skeleton, seed)
    clip = random_clip(skeleton, seed, frames)
    degrees, metres = apart(
        clip, mirror(mirror(clip, find_joint_twins(skeleton)), find_joint_twins(skeleton))
    )
    assert degrees < 1e-4 and metres < 1e-6


@pytest.mark.nightly
@given(st.integers(0, 2**31))
def test_the_mirror_image_does_not_depend_on_the_axes_of_the_bones(toy: Any, seed: int) -> None:
    skeleton = twisted(toy.skeleton, seed)
    pairs = find_joint_twins(skeleton)
    clip = random_clip(skeleton, seed)
    _, before = skeleton.globals(clip.poses())
    _, after = skeleton.globals(mirror(clip, pairs).poses())
    np.testing.assert_allclose(after, before[:, pairs] * MIRROR, atol=1e-4)


def test_a_figure_that_looks_along_another_axis_is_mirrored_across_its_own_body(toy: Any) -> None:
    turn = rotation.from_axis_angle(np.array([0, 1.0, 0]), np.pi / 2)
    local, offsets = toy.skeleton.rest_rotations.copy(), toy.skeleton.rest_translations.copy()
    local[0], offsets[0] = rotation.multiply(turn, local[0]), rotation.rotate_vectors(turn, offsets[0])
    skeleton = Skeleton(toy.skeleton.names, toy.skeleton.parents, local, offsets)
    clip = random_clip(skeleton, 3)
    pairs = find_joint_twins(skeleton)
    _, before = skeleton.globals(clip.poses())
    _, after = skeleton.globals(mirror(clip, pairs).poses())
    np.testing.assert_allclose(after, before[:, pairs] * np.array([1, 1, -1.0]), atol=1e-5)


def test_morph_targets_change_sides_too_and_those_without_a_twin_stay(toy: Any) -> None:
    morphs = ("smile_L", "jaw", "smile_R", "wink_L")
    clip = random_clip(toy.skeleton, 2, morphs=morphs)
    assert clip.weights is not None
    twin = mirror(clip, find_joint_twins(toy.skeleton))
    assert twin.morphs == morphs and twin.weights is not None
    np.testing.assert_array_equal(twin.weights, clip.weights[:, [2, 1, 0, 3]])


def test_a_clip_of_one_frame_is_mirrored(toy: Any) -> None:
    assert mirror(random_clip(toy.skeleton, 4, 1), find_joint_twins(toy.skeleton)).frames == 1


def test_pairs_of_another_skeleton_are_refused(toy: Any) -> None:
    clip = random_clip(toy.skeleton, 5)
    for pairs in ((0, 1), (99,) * len(toy.skeleton), (1, 2, 0, *range(3, len(toy.skeleton)))):
        with pytest.raises(ValueError, match="cannot be mirrored"):
            mirror(clip, pairs)


def longer(skeleton: Skeleton, name: str, by: float) -> Skeleton:
    offsets = skeleton.rest_translations.copy()
    offsets[skeleton.index(name)] *= by
    return Skeleton(skeleton.names, skeleton.parents, skeleton.rest_rotations, offsets)


def test_a_figure_with_one_long_arm_is_told_in_words(toy: Any) -> None:
    skeleton = longer(toy.skeleton, "LeftHand", 2)
    with pytest.raises(ValueError, match=r"'LeftHand' and 'RightHand' .*25 cm"):
        mirror(random_clip(skeleton, 6), find_joint_twins(skeleton))


def with_joint(skeleton: Skeleton, name: str, parent: str, offset: tuple[float, float, float]) -> Skeleton:
    return Skeleton(
        (*skeleton.names, name),
        np.append(skeleton.parents, skeleton.index(parent)),
        np.vstack([skeleton.rest_rotations, rotation.IDENTITY]),
        np.vstack([skeleton.rest_translations, offset]),
    )


def test_a_joint_on_one_side_alone_is_told_when_it_moves_and_left_at_rest_when_it_does_not(toy: Any) -> None:
    skeleton = with_joint(toy.skeleton, "SwordRight", "RightHand", (0, -0.3, 0))
    clip = random_clip(skeleton, 7)
    with pytest.raises(ValueError, match="'SwordRight'"):
        mirror(clip, find_joint_twins(skeleton))
    rotations = clip.rotations.copy()
    rotations[:, -1] = rotation.IDENTITY
    clip = replace(clip, rotations=rotations, translated=(0,), translations=clip.translations[:, :1])
    twin = mirror(clip, find_joint_twins(skeleton))
    np.testing.assert_allclose(twin.rotations[:, -1], clip.rotations[:, -1], atol=1e-6)


def test_a_head_beside_the_middle_is_told(toy: Any) -> None:
    offsets = toy.skeleton.rest_translations.copy()
    offsets[toy.skeleton.index("Head"), 0] = 0.4
    skeleton = Skeleton(toy.skeleton.names, toy.skeleton.parents, toy.skeleton.rest_rotations, offsets)
    with pytest.raises(ValueError, match="'Head' is 40 cm"):
        mirror(random_clip(skeleton, 8), find_joint_twins(skeleton))


def test_arms_posed_differently_at_rest_do_not_matter(toy: Any) -> None:
    skeleton = toy.skeleton
    local = skeleton.rest_rotations.copy()
    local[skeleton.index("LeftUpperArm")] = rotation.from_axis_angle(np.array([0, 0, 1.0]), -0.9)
    posed = Skeleton(skeleton.names, skeleton.parents, local, skeleton.rest_translations)
    clip = toy.clip("swing")
    pairs = find_joint_twins(posed)
    on = replace(clip, skeleton=posed)
    _, before = posed.globals(on.poses())
    _, after = posed.globals(mirror(on, pairs).poses())
    np.testing.assert_allclose(after, before[:, pairs] * MIRROR, atol=1e-5)


FILES = (
    "sumerian-hosts/glTF/animations/adult_female/stand_idle.glb",
    "sumerian-hosts/glTF/animations/alien/gesture.glb",
    "mesh2motion-cmu/human-addon-animations.glb",
    "mesh2motion-cmu/91_50.fbx",
    "kaykit-rogue/Rogue.glb",
    "robot-expressive/RobotExpressive.glb",
)


@pytest.mark.parametrize("file", FILES)
def test_real_clips_come_back_when_mirrored_twice_and_put_hands_where_the_others_were(
    shared_data: Path, file: str
) -> None:
    mirrored_twice(shared_data / file)


@pytest.mark.parametrize("name", ANIMALS)
def test_clips_of_the_zoo_come_back_when_mirrored_twice_and_put_hands_where_the_others_were(
    zoo_files: dict[str, Path], name: str
) -> None:
    mirrored_twice(zoo_files[name])


def mirrored_twice(file: Path) -> None:
    for clip in read_clips(file)[:5]:
        pairs = find_joint_twins(clip.skeleton)
        twin = mirror(clip, pairs)
        degrees, metres = apart(clip, mirror(twin, pairs))
        assert degrees < 1e-4 and metres < 1e-6 * max(
            1, clip.skeleton.height
        )  # float32 metres of a tall robot
        _, before = clip.skeleton.globals(clip.poses())
        _, after = clip.skeleton.globals(twin.poses())
        ends = ("wrist", "hand.L", "hand.R", "Hand", "wrist.l", "Palm2L", "hand_l", "lhand", "hand.l", "手首")
        hands = [j for j, n in enumerate(clip.skeleton.names) if n.endswith(ends)]
        for hand in hands:  # the robot's hand is made of four palms that rest turned otherwise on either side
            away = np.linalg.norm(after[:, hand] - before[:, pairs[hand]] * MIRROR, axis=-1).max()
            assert away < 0.04 * clip.skeleton.height, clip.skeleton.names[hand]


def test_a_rest_pose_in_which_the_body_lies_across_the_middle_is_told(shared_data: Path) -> None:
    clip = read_clips(next(iter(sorted((shared_data / "bandai-namco-1").glob("*.bvh")))))[0]
    with pytest.raises(ValueError, match="beside the middle"):
        mirror(clip, find_joint_twins(clip.skeleton))


def test_the_rest_pose_is_its_own_mirror_image(toy: Any) -> None:
    rest = toy.skeleton.rest
    clip = Clip("rest", toy.skeleton, 30, rest.rotations[None], rest.translations[None, :1])
    assert apart(clip, mirror(clip, find_joint_twins(toy.skeleton)))[1] < 1e-9
    assert isinstance(rest, Pose)
