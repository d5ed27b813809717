"""Bringing clips onto other characters."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from metagraph.formats.clips import read_clips
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import JointMap, RetargetError, make_fingerprint, propose_joint_map
from metagraph.motion.retarget import retarget
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.standing import find_standing_pose, is_standing
from tests.retarget_measures import round_trip
from tests.thorough import some
from tests.zoo import ANIMALS

SIDES = ("left", "right")


def roles_of(joint_map: JointMap, skeleton: Skeleton) -> dict[str, int]:
    """Role -> joint of the map's target."""
    return {p.role: skeleton.index(p.target) for p in joint_map.pairs if p.role}


def places(clip: Clip) -> np.ndarray:
    return clip.skeleton.globals(clip.poses())[1]


def rebuilt(
    skeleton: Skeleton,
    *,
    scale: float = 1.0,
    lower: float = 1.0,
    arms_down: float = 0.0,
    axes: int | None = None,
    quarter: int = 0,
) -> Skeleton:
    """The toy's figure as another one: its size, its forearms and shins, its rest pose, its bones' axes,
    where it faces.
    """
    offsets = skeleton.rest_translations * scale
    local = skeleton.rest_rotations.copy()
    for name, sign in (("LeftUpperArm", -1), ("RightUpperArm", 1)):
        local[skeleton.index(name)] = rotation.from_axis_angle(np.array([0, 0, 1.0]), sign * arms_down)
    for name in ("LeftHand", "RightHand"):
        offsets[skeleton.index(name)] *= lower
    turn = rotation.from_axis_angle(np.array([0, 1.0, 0]), quarter * np.pi / 2)
    local[0], offsets[0] = rotation.multiply(turn, local[0]), rotation.rotate_vectors(turn, offsets[0])
    if axes is None:
        return Skeleton(skeleton.names, skeleton.parents, local, offsets)
    model, where = skeleton.globals(Pose(local, offsets))
    model = rotation.normalize(np.random.default_rng(axes).normal(size=model.shape))
    inner = skeleton.parents >= 0
    above = skeleton.parents[inner]
    local, offsets = model.copy(), where.copy()
    local[inner] = rotation.multiply(rotation.conjugate(model[above]), model[inner])
    offsets[inner] = rotation.rotate_vectors(rotation.conjugate(model[above]), where[inner] - where[above])
    return Skeleton(skeleton.names, skeleton.parents, local, offsets)


def gesture(skeleton: Skeleton, seed: int, frames: int = 5) -> Clip:
    """A standing figure that moves all its joints a little, and its elbows and knees more."""
    rng = np.random.default_rng(seed)
    x = np.linspace(0, 1, frames)[:, None, None]
    turns = (
        np.sin(np.pi * (x + rng.random((1, len(skeleton), 1))))
        * rng.normal(size=(1, len(skeleton), 3))
        * 0.15
    )
    for name, axis, angle in (
        ("LeftLowerArm", 1, -0.9),
        ("RightLowerArm", 1, 0.9),
        ("LeftLowerLeg", 0, 0.5),
        ("RightLowerLeg", 0, 0.5),
    ):
        turns[:, skeleton.index(name), axis] += angle
    for name in ("LeftUpperLeg", "RightUpperLeg"):
        turns[:, skeleton.index(name), 0] -= 0.25
    root = skeleton.rest_translations[:1] + 0.05 * np.sin(3 * x) * rng.normal(size=(1, 1, 3))
    return Clip("g", skeleton, 30, rotation.multiply(skeleton.rest_rotations, rotation.exp(turns)), root)


# --- which joint is which


def test_a_skeleton_maps_to_itself_joint_by_joint_and_surely(sample: Any) -> None:
    found = propose_joint_map(sample.skeleton, sample.skeleton)
    assert {p.source: p.target for p in found.pairs} == {n: n for n in sample.skeleton.names}
    assert min(p.sure for p in found.pairs) >= 0.8
    assert not found.missing


def test_fingers_are_paired_by_their_names_and_order_whatever_they_are_called(toy: Any, sample: Any) -> None:
    def hand(first: str, second: str) -> Skeleton:
        names = (*toy.skeleton.names, first, second)
        parents = np.append(toy.skeleton.parents, [toy.skeleton.index("LeftHand"), len(toy.skeleton)])
        return Skeleton(
            names,
            parents,
            np.tile(rotation.IDENTITY, (len(names), 1)),
            np.vstack([toy.skeleton.rest_translations, np.full((2, 3), 0.03)]),
        )

    for first, second in (
        ("f_pinky.01.L", "f_pinky.02.L"),
        ("LeftHandRingPinky1", "LeftHandRingPinky2"),
        ("L_Finger4", "L_Finger41"),
    ):
        found = propose_joint_map(hand(first, second), sample.skeleton)
        assert [found.of(n).target for n in (first, second)] == ["LeftLittle1", "LeftLittle2"]  # type: ignore[union-attr]


def test_no_joint_is_mapped_twice(sample: Any, toy: Any) -> None:
    found = propose_joint_map(toy.skeleton, sample.skeleton)
    assert len({p.source for p in found.pairs}) == len({p.target for p in found.pairs}) == len(found.pairs)


def test_a_map_is_written_and_read_back(sample: Any, toy: Any) -> None:
    found = propose_joint_map(toy.skeleton, sample.skeleton)
    assert JointMap.from_json(json.loads(json.dumps(found.to_json()))) == found


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"source": "a"},
        {"source": "a", "target": "b", "pairs": [1]},
        {"source": 1, "target": 2, "pairs": None},
    ],
)
def test_what_is_no_map_is_refused(data: dict[str, Any]) -> None:
    with pytest.raises(RetargetError, match="no joint map"):
        JointMap.from_json(data)


def test_a_map_is_edited_by_hand_and_says_what_it_lacks(toy: Any) -> None:
    found = propose_joint_map(toy.skeleton, toy.skeleton)
    less = found.without("LeftHand")
    assert less.of("LeftHand") is None and [words.startswith("no left hand") for words in less.missing] == [
        True
    ]
    again = less.with_pair("LeftHand", "LeftHand", "left_hand")
    assert not again.missing
    moved = found.with_pair("Spine", "Neck")
    pair = moved.of("Spine")
    assert pair is not None and (pair.target, pair.role, pair.sure) == (
        "Neck",
        "upper_chest" if pair.role == "upper_chest" else pair.role,
        1.0,
    )
    assert moved.of("Neck") is None


def test_a_map_is_remembered_by_what_stays_the_same_in_every_file_and_size_of_a_rig(
    toy: Any, sample: Any
) -> None:
    same = Skeleton(
        *(getattr(toy.skeleton, f) for f in ("names", "parents", "rest_rotations", "rest_translations"))
    )
    assert (
        make_fingerprint(same)
        == make_fingerprint(toy.skeleton)
        == make_fingerprint(rebuilt(toy.skeleton, scale=2, arms_down=1.0))
    )
    assert make_fingerprint(sample.skeleton) != make_fingerprint(toy.skeleton)
    names = (*toy.skeleton.names[:-1], "Renamed")
    renamed = Skeleton(
        names, toy.skeleton.parents, toy.skeleton.rest_rotations, toy.skeleton.rest_translations
    )
    assert make_fingerprint(renamed) != make_fingerprint(toy.skeleton)


def test_a_retargeted_clip_knows_what_it_was_brought_from(toy: Any, sample: Any) -> None:
    out = retarget(toy.clip("c"), sample.skeleton, propose_joint_map(toy.skeleton, sample.skeleton))
    assert out.brought_from == make_fingerprint(toy.skeleton)
    assert toy.clip("c").brought_from == ""


# --- what cannot be done


def test_too_little_to_go_by_is_refused_in_words(toy: Any) -> None:
    names = ("a", "b", "c")
    rope = Skeleton(names, np.array([-1, 0, 1]), np.tile(rotation.IDENTITY, (3, 1)), np.ones((3, 3)))
    clip = Clip("rope", rope, 30, np.tile(rotation.IDENTITY, (2, 3, 1)), np.zeros((2, 1, 3)))
    with pytest.raises(
        RetargetError,
        match=r"'rope' cannot be brought onto this character: no hips in both, no head in both.* and \d+ "
        r"more",
    ):
        retarget(clip, toy.skeleton, propose_joint_map(rope, toy.skeleton))


def test_a_map_for_another_skeleton_is_refused(toy: Any, sample: Any) -> None:
    with pytest.raises(RetargetError, match="does not have"):
        retarget(toy.clip("c"), sample.skeleton, propose_joint_map(sample.skeleton, sample.skeleton))


def test_a_target_whose_rest_pose_does_not_stand_needs_a_pose_that_does(toy: Any) -> None:
    lying = toy.skeleton.rest_rotations.copy()
    lying[0] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.pi / 2)
    skeleton = Skeleton(toy.skeleton.names, toy.skeleton.parents, lying, toy.skeleton.rest_translations)
    assert is_standing(toy.skeleton) and not is_standing(skeleton)
    clip, joint_map = toy.clip("c"), propose_joint_map(toy.skeleton, skeleton)
    with pytest.raises(RetargetError, match="does not stand"):
        retarget(clip, skeleton, joint_map)
    upright = Pose(toy.skeleton.rest_rotations, toy.skeleton.rest_translations)
    out = retarget(clip, skeleton, joint_map, target_pose=upright)
    np.testing.assert_allclose(places(out), places(clip), atol=3e-4)


# --- what comes out


@pytest.mark.nightly
def test_onto_itself_a_clip_stays_what_it_is(sample: Any) -> None:
    for entry in list(sample.clips.values())[::12]:
        out = retarget(entry.motion, sample.skeleton, propose_joint_map(sample.skeleton, sample.skeleton))
        assert np.degrees(rotation.measure_angle_between(out.rotations, entry.motion.rotations).max()) < 0.2
        np.testing.assert_allclose(places(out), places(entry.motion), atol=1e-4)


@pytest.mark.nightly
@given(st.integers(0, 2**31), st.floats(0.2, 5), st.floats(0, 1.2), st.integers(0, 3))
@example(642, 1.0, 0.0, 0)  # a leg that is bent by half a degree, and not forwards
@example(2400, 1.0, 0.0, 0)
@hypothesis_settings(max_examples=40)
def test_size_rest_pose_bone_axes_and_facing_make_no_difference_to_the_motion(
    toy: Any, seed: int, scale: float, down: float, quarter: int
) -> None:
    target = rebuilt(toy.skeleton, scale=scale, arms_down=down, axes=seed, quarter=quarter)
    clip = gesture(toy.skeleton, seed)
    out = retarget(clip, target, propose_joint_map(toy.skeleton, target))
    turn = rotation.from_axis_angle(np.array([0, 1.0, 0]), quarter * np.pi / 2)
    wanted = rotation.rotate_vectors(turn, places(clip) * scale)
    assert np.abs(places(out) - wanted).max() < 2e-3 * scale


@pytest.mark.nightly
@given(st.integers(0, 2**31), st.floats(0.5, 2), st.floats(0.6, 1.5), st.floats(0, 1.2))
@hypothesis_settings(max_examples=40)
def test_there_and_back_a_clip_is_itself_within_two_degrees(
    toy: Any, seed: int, scale: float, lower: float, down: float
) -> None:
    target = rebuilt(toy.skeleton, scale=scale, lower=lower, arms_down=down, axes=seed)
    clip = gesture(toy.skeleton, seed)
    joint_map = propose_joint_map(toy.skeleton, target)
    back = retarget(retarget(clip, target, joint_map), toy.skeleton, joint_map.reversed)
    assert np.degrees(rotation.measure_angle_between(clip.rotations, back.rotations).mean()) < 2


@pytest.mark.nightly
@given(st.integers(0, 2**31), st.floats(0.5, 2), st.floats(0, 1.2), st.floats(-0.6, 0.6), st.floats(0.5, 2))
@hypothesis_settings(max_examples=40, deadline=None)
def test_feet_turned_out_otherwise_and_hips_of_another_width_come_back_in_every_joint_and_frame(
    toy: Any, seed: int, scale: float, down: float, out: float, wide: float
) -> None:
    target = rebuilt(toy.skeleton, scale=scale, arms_down=down, axes=seed)
    local, offsets = toy.skeleton.rest_rotations.copy(), toy.skeleton.rest_translations * scale
    for side, sign in (("Left", 1), ("Right", -1)):
        local[toy.skeleton.index(f"{side}Foot")] = rotation.from_axis_angle(np.array([0, 1.0, 0]), sign * out)
        offsets[toy.skeleton.index(f"{side}UpperLeg"), 0] *= wide
    splayed = Skeleton(toy.skeleton.names, toy.skeleton.parents, local, offsets)
    clip = gesture(toy.skeleton, seed)
    for middle in (target, splayed):
        degrees, fine = round_trip(clip, middle, toy.skeleton.rest, middle.rest)
        assert max(float(angle[fine[role]].max(initial=0)) for role, angle in degrees.items()) < 2


@pytest.mark.nightly
@given(st.integers(0, 2**31), st.floats(0.5, 2), st.floats(0.6, 1.5))
@hypothesis_settings(max_examples=40)
def test_wrists_and_ankles_keep_their_height_and_elbows_their_side(
    toy: Any, seed: int, scale: float, lower: float
) -> None:
    target = rebuilt(toy.skeleton, scale=scale, lower=lower)
    clip = gesture(toy.skeleton, seed)
    out = retarget(clip, target, propose_joint_map(toy.skeleton, target))
    before, after = places(clip), places(out)
    at = toy.skeleton.index
    arm = scale * (0.3 + 0.25 * lower) / 0.55
    for side in ("Left", "Right"):
        high, low = (p[:, at(f"{side}Hand"), 1] - p[:, at(f"{side}UpperArm"), 1] for p in (after, before))
        np.testing.assert_allclose(high, arm * low, atol=0.03)
        np.testing.assert_allclose(
            after[:, at(f"{side}Foot"), 1], scale * before[:, at(f"{side}Foot"), 1], atol=0.03
        )
        for upper, middle, end in (("UpperArm", "LowerArm", "Hand"), ("UpperLeg", "LowerLeg", "Foot")):
            bends = []
            for p in (before, after):
                a, b, c = (p[:, at(side + n)] for n in (upper, middle, end))
                bend = (
                    b
                    - a
                    - (c - a)
                    * (np.einsum("fi,fi->f", b - a, c - a) / np.einsum("fi,fi->f", c - a, c - a))[:, None]
                )
                bends.append(bend / np.linalg.norm(bend, axis=-1, keepdims=True))
            assert (np.einsum("fi,fi->f", *bends) > 0.8).all()


def test_a_clip_of_one_frame_a_figure_without_a_neck_and_one_without_fingers_come_through(
    toy: Any, sample: Any
) -> None:
    keep = [i for i, n in enumerate(toy.skeleton.names) if n != "Neck"]
    parents = [
        keep.index(int(p)) if p in keep else (-1 if p < 0 else keep.index(1))
        for p in toy.skeleton.parents[keep]
    ]
    bare = Skeleton(
        tuple(toy.skeleton.names[i] for i in keep),
        np.array(parents),
        toy.skeleton.rest_rotations[keep],
        toy.skeleton.rest_translations[keep],
    )
    rest = bare.rest
    clip = Clip("one", bare, 24, rest.rotations[None], rest.translations[None, :1])
    out = retarget(clip, sample.skeleton, propose_joint_map(bare, sample.skeleton))
    assert out.frames == 1 and out.fps == 24 and out.skeleton is sample.skeleton
    back = retarget(next(iter(sample.clips.values())).motion, bare, propose_joint_map(sample.skeleton, bare))
    assert np.isfinite(back.rotations).all()


def test_limbs_that_a_file_keeps_apart_from_the_body_are_carried_along(toy: Any) -> None:
    """Feet that hang on the root, as IK rigs bake them, and legs that are roots of their own."""
    skeleton = toy.skeleton
    _, where = skeleton.globals(skeleton.rest)
    parents, offsets = skeleton.parents.copy(), skeleton.rest_translations.copy()
    for name, above in (("LeftFoot", 0), ("RightFoot", 0), ("LeftUpperLeg", -1), ("RightUpperLeg", -1)):
        j = skeleton.index(name)
        parents[j] = above
        offsets[j] = where[j] - (where[above] if above >= 0 else 0)
    apart = Skeleton(skeleton.names, parents, skeleton.rest_rotations, offsets)
    clip = gesture(skeleton, 3)
    out = retarget(clip, apart, propose_joint_map(skeleton, apart))
    np.testing.assert_allclose(places(out), places(clip), atol=1e-3)
    again = retarget(out, skeleton, propose_joint_map(apart, skeleton))
    np.testing.assert_allclose(places(again), places(clip), atol=1e-3)


def test_a_rest_pose_that_hangs_in_the_air_or_lies_in_the_ground_still_puts_the_feet_on_it(toy: Any) -> None:
    """BVH files often rest with the hips at the origin."""
    offsets = toy.skeleton.rest_translations.copy()
    offsets[0] = 0
    sunk = Skeleton(toy.skeleton.names, toy.skeleton.parents, toy.skeleton.rest_rotations, offsets)
    clip = toy.clip("c")
    out = retarget(clip, sunk, propose_joint_map(toy.skeleton, sunk))
    np.testing.assert_allclose(
        places(out), places(clip) - [0, 0.05, 0], atol=2e-3
    )  # its lowest joint, the ankle, is on the ground
    back = retarget(out, toy.skeleton, propose_joint_map(sunk, toy.skeleton))
    np.testing.assert_allclose(places(back), places(clip), atol=2e-3)


def test_faces_of_one_family_of_characters_move_on(toy: Any) -> None:
    """Joints paired by name carry their shifts too."""
    names = (*toy.skeleton.names, "lip_upper")
    parents = np.append(toy.skeleton.parents, toy.skeleton.index("Head"))
    face = Skeleton(
        names,
        parents,
        np.tile(rotation.IDENTITY, (len(names), 1)),
        np.vstack([toy.skeleton.rest_translations, [[0, 0.05, 0.1]]]),
    )
    clip = toy.clip("c")
    rotations = np.concatenate([clip.rotations, np.tile(rotation.IDENTITY, (clip.frames, 1, 1))], 1)
    lip = np.broadcast_to([0, 0.07, 0.1], (clip.frames, 3))
    clip = replace(
        clip,
        skeleton=face,
        rotations=rotations,
        translations=np.stack([clip.translations[:, 0], lip], 1),
        translated=(0, len(names) - 1),
    )
    target = Skeleton(names, parents, face.rest_rotations, face.rest_translations * 2)
    out = retarget(clip, target, propose_joint_map(face, target))
    np.testing.assert_allclose(
        out.poses().translations[:, -1], np.broadcast_to([0, 0.14, 0.2], (clip.frames, 3)), atol=1e-4
    )


def test_what_was_done_is_noted(toy: Any, sample: Any) -> None:
    out = retarget(toy.clip("c"), sample.skeleton, propose_joint_map(toy.skeleton, sample.skeleton))
    assert "16 joints: 16 " in out.notes[-1]


# --- real characters

FILES: dict[str, tuple[str, Callable[[Clip], bool]]] = {
    "adult": ("sumerian-hosts/glTF/animations/adult_female/stand_idle.glb", lambda c: True),
    "alien": ("sumerian-hosts/glTF/animations/alien/gesture.glb", lambda c: c.name == "many"),
    "mesh2motion": ("mesh2motion-cmu/human-addon-animations.glb", lambda c: c.name == "YMCA"),
    "kaykit": ("kaykit-rogue/Rogue.glb", lambda c: c.name == "Interact"),
    "robot": (
        "robot-expressive/RobotExpressive.glb",
        lambda c: c.name == "Walking",
    ),  # the legs of its Idle do not reach its feet
    "cmu": ("mesh2motion-cmu/91_50.fbx", lambda c: True),
    "bandai": ("bandai-namco-1/dataset-1_bow_angry_001.bvh", lambda c: True),
    "crossarms": ("fbx-pab/crossarms.fbx", lambda c: True),
}
PAIRS = [(a, b) for a in ("sample", *FILES) for b in ("sample", *FILES) if a != b]
if not (Path(__file__).parents[3] / "shared" / "data").is_dir():
    PAIRS = PAIRS[:1]  # where the clips are not, one skip says it for all pairs


@cache
def real(folder: Path, who: str) -> Clip:
    if who == "sample":
        return read_clips(
            Path(__file__).parents[2] / "sample_clips/clips/hands_at_sides__air_quotes_bt_01.glb"
        )[0]
    file, wanted = FILES[who]
    return next(c for c in read_clips(folder / file) if wanted(c))


# Of the zoo, everyone with the sample, both ways, and with the next.
ZOO = [pair for name in ANIMALS for pair in (("sample", name), (name, "sample"))] + list(pairwise(ANIMALS))


@cache
def of_zoo(files: tuple[tuple[str, Path], ...], who: str) -> Clip:
    return real(Path(), who) if who == "sample" else read_clips(dict(files)[who])[0]


@pytest.fixture
def zoo_pair(zoo_files: dict[str, Path], request: pytest.FixtureRequest) -> tuple[Clip, Clip]:
    one, two = (of_zoo(tuple(zoo_files.items()), who) for who in request.param)
    return one, two


@pytest.mark.parametrize("zoo_pair", ZOO, indirect=True, ids="-".join)
def test_clips_of_the_zoo_go_there_and_back(zoo_pair: tuple[Clip, Clip]) -> None:
    there_and_back(*zoo_pair)


@pytest.mark.parametrize(("one", "two"), some(PAIRS, 5))
def test_real_clips_go_there_and_back(shared_data: Path, one: str, two: str) -> None:
    there_and_back(real(shared_data, one), real(shared_data, two))


def there_and_back(clip: Clip, other: Clip) -> None:
    """The mean of all joints, also of what cannot survive; and every joint in nearly all frames that can: an
    arm all but stretched out loses a little.
    """
    degrees, fine = round_trip(clip, other.skeleton, find_standing_pose(clip), find_standing_pose(other))
    assert np.mean(list(degrees.values())) < 2
    worst = {r: float(np.percentile(a[fine[r]], 95)) if fine[r].any() else 0 for r, a in degrees.items()}
    assert max(worst.values()) < 4, max(worst, key=worst.__getitem__)


@pytest.mark.parametrize(("one", "two"), some(PAIRS, 5))
def test_real_hands_and_feet_keep_their_height_and_planted_feet_stay(
    shared_data: Path, one: str, two: str
) -> None:
    heights_and_feet(real(shared_data, one), real(shared_data, two))


@pytest.mark.parametrize("zoo_pair", ZOO, indirect=True, ids="-".join)
def test_hands_and_feet_of_the_zoo_keep_their_height_and_planted_feet_stay(
    zoo_pair: tuple[Clip, Clip],
) -> None:
    heights_and_feet(*zoo_pair)


def heights_and_feet(clip: Clip, other: Clip) -> None:
    joint_map = propose_joint_map(clip.skeleton, other.skeleton)
    pose = find_standing_pose(other)
    out = retarget(clip, other.skeleton, replace(joint_map, contacts=False), target_pose=pose)
    ours, theirs = roles_of(joint_map.reversed, clip.skeleton), roles_of(joint_map, other.skeleton)
    before, after = places(clip), places(out)

    def length(skeleton: Skeleton, at: Pose, roles: dict[str, int], parts: tuple[str, ...]) -> float:
        _, p = skeleton.globals(at)
        lines = [[p[roles[f"{side}_{part}"]] for part in parts] for side in SIDES]
        return float(np.mean([sum(np.linalg.norm(a - b) for a, b in pairwise(line)) for line in lines]))

    def scale(*parts: str) -> float:
        return length(other.skeleton, pose, theirs, parts) / length(
            clip.skeleton, find_standing_pose(clip), ours, parts
        )

    arm, leg = scale("upper_arm", "lower_arm", "hand"), scale("upper_leg", "lower_leg", "foot")
    tall = max(1.0, other.skeleton.height / 1.8)  # 3 cm on a person, as much more on a giant
    for side in SIDES:
        hand, shoulder = f"{side}_hand", f"{side}_upper_arm"
        low, high = (p[:, r[hand], 1] - p[:, r[shoulder], 1] for p, r in ((before, ours), (after, theirs)))
        assert np.abs(high - arm * low).max() < 0.03 * tall
        foot = f"{side}_foot"
        low, high = before[:, ours[foot], 1], after[:, theirs[foot], 1]
        assert np.abs((high - high.min()) - leg * (low - low.min())).max() < 0.03 * tall
        if clip.frames > 1:
            speeds = [
                np.linalg.norm(np.diff(p[:, r[foot]], axis=0)[:, [0, 2]], axis=-1) * clip.fps
                for p, r in ((before, ours), (after, theirs))
            ]
            facing = clip.skeleton.globals(clip.poses())[0][:, ours[foot]]
            turning = np.degrees(rotation.measure_angle_between(facing[1:], facing[:-1])) * clip.fps
            planted = (
                (low[1:] - low.min() < 0.02) & (speeds[0] < 0.05) & (turning < 15)
            )  # a foot that pivots may shift
            assert not planted.any() or (speeds[1][planted] - leg * speeds[0][planted]).max() < 0.06 * tall


def test_quadrupeds_and_birds_are_refused(shared_data: Path, sample: Any) -> None:
    for file in ("quad-creature-animations.glb", "bird-animations.glb"):
        clip = read_clips(shared_data / "mesh2motion-cmu" / file)[0]
        with pytest.raises(RetargetError, match=re.escape(repr(clip.name))):
            retarget(clip, sample.skeleton, propose_joint_map(clip.skeleton, sample.skeleton))


def test_a_head_that_rests_back_to_front_looks_ahead(shared_data: Path, sample: Any) -> None:
    clip = real(shared_data, "robot")
    out = retarget(clip, sample.skeleton, propose_joint_map(clip.skeleton, sample.skeleton))
    turns, _ = out.skeleton.globals(out.poses())
    head = rotation.multiply(
        turns[:, out.skeleton.index("Head")],
        rotation.conjugate(out.skeleton.globals(out.skeleton.rest)[0][5]),
    )
    assert (rotation.rotate_vectors(head, np.array([0, 0, 1.0]))[:, 2] > 0.8).all()
