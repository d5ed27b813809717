"""What is measured on a clip: on odd skeletons, single frames, mirrored, scaled, reversed and slowed
clips.
"""

from __future__ import annotations

import gc
import weakref
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.model import LAYERS, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Skeleton
from metagraph.suggest import traits as module
from metagraph.suggest.traits import Traits, measure_all_traits, measure_traits

LEFT_FINGERS = [("LeftIndex1", "LeftHand", (0.08, 0, 0.01)), ("LeftIndex2", "LeftIndex1", (0.03, 0, 0))]


def scaled(clip: Clip, factor: float) -> Clip:
    s = clip.skeleton
    big = Skeleton(s.names, s.parents, s.rest_rotations, s.rest_translations * factor)
    return Clip(clip.name, big, clip.fps, clip.rotations, clip.translations * factor, clip.translated)


def mirrored(clip: Clip) -> Clip:
    """The clip as seen in a mirror: of skeletons whose rest rotations are all none, as the toy's are."""
    names = clip.skeleton.names
    swap = {n: n.replace("Left", "#").replace("Right", "Left").replace("#", "Right") for n in names}
    order = [clip.skeleton.index(swap[n]) for n in names]
    rotations = clip.rotations[:, order] * np.array([1, -1, -1, 1])
    return Clip(
        clip.name,
        clip.skeleton,
        clip.fps,
        rotations,
        clip.translations * np.array([-1, 1, 1]),
        clip.translated,
    )


def backwards(clip: Clip) -> Clip:
    return Clip(
        clip.name, clip.skeleton, clip.fps, clip.rotations[::-1], clip.translations[::-1], clip.translated
    )


def moved(clip: Clip, angle: float, way: tuple[float, float, float]) -> Clip:
    """The clip elsewhere, facing elsewhere."""
    turn = rotation.from_axis_angle(np.array([0, 1.0, 0]), np.array(angle))
    rotations, translations = clip.rotations.astype(float).copy(), clip.translations.astype(float).copy()
    rotations[:, 0] = rotation.multiply(turn, rotations[:, 0])
    translations[:, 0] = rotation.rotate_vectors(turn, translations[:, 0]) + np.array(way)
    return Clip(clip.name, clip.skeleton, clip.fps, rotations, translations, clip.translated)


def one_armed(toy: Any, side: str = "Left", seconds: float = 1.5, fps: float = 30) -> Clip:
    frames = round(seconds * fps) + 1
    angle = np.sin(np.pi * np.linspace(0, 1, frames)) ** 2
    rotations = np.tile(toy.skeleton.rest_rotations, (frames, 1, 1))
    rotations[:, toy.skeleton.index(f"{side}UpperArm")] = rotation.from_axis_angle(
        np.array([0, 0, 1.0 if side == "Left" else -1.0]), angle
    )
    return Clip(
        side, toy.skeleton, fps, rotations, np.tile(toy.skeleton.rest_translations[:1], (frames, 1, 1))
    )


def of(clip: Clip) -> Traits:
    return measure_traits(clip.skeleton, None, clip)


def numbers(t: Traits) -> list[float]:
    out = [*t.energy.values(), t.travel, t.symmetry, t.mirrored, t.out, t.near, t.touch, t.duration]
    for x in t.layers.values():
        out += [
            x.loop_error,
            x.steady,
            x.extent,
            x.extent_at,
            x.energy,
            x.peak,
            x.peak_at,
            x.stroke_at,
            x.rest,
            x.bouts,
        ]
        for pose in (x.first, x.last, x.typical, x.farthest, x.low, x.high):
            out += pose.ravel().tolist()
    return out


def chain(count: int, names: str = "joint") -> Skeleton:
    return Skeleton(
        tuple(f"{names}{i}" for i in range(count)),
        np.arange(-1, count - 1),
        np.tile([0, 0, 0, 1.0], (count, 1)),
        np.full((count, 3), 0.1),
    )


@pytest.mark.parametrize("count", [1, 2, 5, 40])
@pytest.mark.parametrize("frames", [1, 2, 3, 50])
def test_a_skeleton_that_is_no_figure_has_traits_of_the_body_alone(count: int, frames: int) -> None:
    skeleton = chain(count)
    turn = np.random.default_rng(1).normal(size=(frames, count, 4))
    found = of(Clip("x", skeleton, 30, rotation.normalize(turn), np.zeros((frames, 1, 3))))
    assert np.isfinite(numbers(found)).all()
    assert found.layers["arms"].names == () and found.layers["head"].names == ()
    assert found.layers["body"].names


def test_a_quadruped_has_traits() -> None:
    names = (
        "Hips",
        "Spine",
        "Neck",
        "Head",
        "FrontLeg_L",
        "FrontPaw_L",
        "FrontLeg_R",
        "FrontPaw_R",
        "HindLeg_L",
        "HindFoot_L",
        "Tail",
    )
    parents = np.array([-1, 0, 1, 2, 1, 4, 1, 6, 0, 8, 0])
    offsets = np.random.default_rng(2).normal(0, 0.3, (len(names), 3))
    skeleton = Skeleton(names, parents, np.tile([0, 0, 0, 1.0], (len(names), 1)), offsets)
    still = np.tile(skeleton.rest_rotations, (10, 1, 1))
    assert np.isfinite(numbers(of(Clip("dog", skeleton, 24, still, np.zeros((10, 1, 3)))))).all()


def test_roles_that_are_missing_leave_their_layer_empty(toy: Any) -> None:
    clip = toy.clip("x")
    roles = find_roles(toy.skeleton)
    armless = measure_traits(
        toy.skeleton, {r: j for r, j in roles.items() if "arm" not in r and "hand" not in r}, clip
    )
    assert armless.layers["arms"].names == () and armless.symmetry == 0
    assert armless.layers["head"].names
    none = measure_traits(toy.skeleton, {}, clip)
    assert none.layers["body"].names and not none.layers["arms"].names


def test_a_single_frame_rests() -> None:
    still = of(Clip("pose", chain(3), 30, np.tile([0, 0, 0, 1.0], (1, 3, 1)), np.zeros((1, 1, 3))))
    assert still.duration == 0 and sum(still.energy.values()) == 0
    assert still.layers["body"].rest == 1 and still.layers["body"].loop_error == 0


def test_lying_figures_and_slow_and_fast_frame_rates_are_finite(toy: Any) -> None:
    for fps in (1.0, 23.976, 60.0, 120.0, 1000.0):
        assert np.isfinite(numbers(of(toy.clip("x", 1.0, fps=fps)))).all()
    clip = toy.clip("x")
    lying = clip.rotations.copy()
    lying[:, 0] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.array(np.pi / 2))
    assert np.isfinite(numbers(of(Clip("x", clip.skeleton, 30, lying, clip.translations)))).all()


def test_the_frame_rate_hardly_matters(toy: Any) -> None:
    slow, fast = of(one_armed(toy, fps=30)), of(one_armed(toy, fps=120))
    assert fast.energy["left_arm"] == pytest.approx(slow.energy["left_arm"], rel=0.03)
    assert fast.layers["arms"].extent == pytest.approx(slow.layers["arms"].extent, rel=0.01)
    assert fast.frames <= slow.frames + 1


def test_the_arm_that_moves_is_told(toy: Any) -> None:
    assert of(one_armed(toy, "Left")).symmetry == pytest.approx(1, abs=1e-3)
    assert of(one_armed(toy, "Right")).symmetry == pytest.approx(-1, abs=1e-3)


def test_arms_that_mirror_each_other_are_told(toy: Any) -> None:
    clip = toy.clip("x", swing=0.6)
    rotations = clip.rotations.copy()
    left = rotations[:, toy.skeleton.index("LeftUpperArm")]
    rotations[:, toy.skeleton.index("RightUpperArm")] = left * np.array([1, -1, -1, 1])
    both = of(Clip("x", toy.skeleton, 30, rotations, clip.translations))
    assert both.mirrored == pytest.approx(1, abs=1e-3) and both.symmetry == pytest.approx(0, abs=1e-3)
    assert of(one_armed(toy)).mirrored == pytest.approx(0, abs=1e-3)


@given(st.floats(0.1, 1.0), st.floats(-0.5, 1.2), st.floats(0.4, 2))
def test_a_mirrored_clip_has_mirrored_traits(swing: float, end: float, seconds: float) -> None:
    from tests.conftest import Toy

    clip = Toy().clip("x", seconds, 0.0, end, swing)
    one, other = of(clip), of(mirrored(clip))
    assert other.symmetry == pytest.approx(-one.symmetry, abs=1e-3)
    assert other.energy["left_arm"] == pytest.approx(one.energy["right_arm"], abs=1e-4)
    names = one.layers["arms"].names
    for n, name in enumerate(names):
        m = names.index(name.replace("left", "#").replace("right", "left").replace("#", "right"))
        assert np.allclose(other.layers["arms"].last[m], one.layers["arms"].last[n] * [-1, 1, 1], atol=1e-4)


@pytest.mark.nightly
@given(st.floats(0.01, 100))
def test_size_does_not_matter(factor: float) -> None:
    from tests.conftest import Toy

    clip = Toy().clip("x", 1.0, 0.0, 0.7)
    one, big = of(clip), of(scaled(clip, factor))
    assert np.allclose(numbers(big), numbers(one), atol=2e-4)
    assert big.height == pytest.approx(one.height * factor, rel=1e-4)


@pytest.mark.nightly
@given(st.floats(-3.1, 3.1), st.floats(-3, 3))
def test_neither_place_nor_facing_matter(angle: float, x: float) -> None:
    from tests.conftest import Toy

    clip = Toy().clip("x", 1.0, 0.0, 0.7)
    assert np.allclose(numbers(of(moved(clip, angle, (x, 0, -x)))), numbers(of(clip)), atol=1e-3)


@given(st.floats(0.1, 1.0), st.floats(-0.5, 1.2))
def test_a_clip_backwards_begins_where_it_ended(swing: float, end: float) -> None:
    from tests.conftest import Toy

    clip = Toy().clip("x", 1.0, 0.0, end, swing)
    one, back = of(clip), of(backwards(clip))
    for layer in LAYERS:
        assert np.allclose(back.layers[layer].first, one.layers[layer].last, atol=1e-5)
        assert np.allclose(back.layers[layer].last, one.layers[layer].first, atol=1e-5)
        assert back.layers[layer].loop_error == pytest.approx(one.layers[layer].loop_error, abs=1e-5)
        assert back.layers[layer].extent == pytest.approx(one.layers[layer].extent, abs=1e-4)
    assert sum(back.energy.values()) == pytest.approx(sum(one.energy.values()), rel=1e-3)


def test_fingers_that_move_are_told_from_a_hand_that_moves(toy: Any) -> None:
    s = toy.skeleton
    names, parents, offsets = list(s.names), list(s.parents), list(s.rest_translations)
    for name, parent, offset in LEFT_FINGERS:
        parents.append(names.index(parent))
        names.append(name)
        offsets.append(offset)
    skeleton = Skeleton(
        tuple(names), np.array(parents), np.tile([0, 0, 0, 1.0], (len(names), 1)), np.array(offsets)
    )
    rotations = np.tile(skeleton.rest_rotations, (60, 1, 1))
    rotations[:, names.index("LeftIndex1")] = rotation.from_axis_angle(
        np.array([0, 0, 1.0]), 0.5 * np.sin(np.linspace(0, 12, 60))
    )
    found = of(Clip("x", skeleton, 30, rotations, np.tile(skeleton.rest_translations[:1], (60, 1, 1))))
    assert found.energy["fingers"] > 0.01 and found.energy["left_arm"] == pytest.approx(0, abs=1e-6)
    assert found.symmetry == pytest.approx(1)


def test_what_was_found_is_kept_as_long_as_the_clip(toy: Any) -> None:
    clip = toy.clip("x")
    first = of(clip)
    assert of(clip) is first
    assert measure_traits(toy.skeleton, {"hips": 0}, clip) is not first  # other roles, other traits
    kept = weakref.ref(of(clip))
    gc.collect(1)
    assert kept() is not None and of(clip) is kept()
    del clip
    gc.collect(1)  # all of it is young
    assert kept() is None


def test_many_at_once_are_as_one_by_one(sample: Project) -> None:
    clips = [e.motion for e in list(sample.clips.values())[::17] if e.motion is not None]
    again = [c.renamed(c.name) for c in clips]
    together = measure_all_traits(again)
    for clip in clips:
        assert np.allclose(numbers(together[clip.name]), numbers(of(clip)), atol=1e-5)


def test_clips_of_several_skeletons_are_taken_apart(toy: Any) -> None:
    odd = Clip("odd", chain(4), 30, np.tile([0, 0, 0, 1.0], (5, 4, 1)), np.zeros((5, 1, 3)))
    assert set(measure_all_traits([toy.clip("one"), odd, toy.clip("two")])) == {"one", "odd", "two"}


def test_nothing_has_no_traits_and_work_can_be_cancelled(toy: Any) -> None:
    assert measure_all_traits([]) == {} and measure_all_traits(Project()) == {}
    assert measure_all_traits([toy.clip("x")], cancelled=lambda: True) == {}


def test_progress_ends_at_all(toy: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "BATCH", 40)
    told: list[tuple[int, int]] = []
    measure_all_traits(
        [toy.clip(str(n)) for n in range(5)], progress=lambda done, of: told.append((done, of))
    )
    assert told[-1] == (5, 5) and len(told) > 1


def test_missing_clips_are_left_out(sample: Project) -> None:
    from dataclasses import replace

    some = dict(list(sample.clips.items())[:3])
    first = next(iter(some))
    project = replace(sample, clips={**some, first: replace(some[first], motion=None)})
    assert set(measure_all_traits(project)) == set(some) - {first}


def test_clips_of_the_zoo_have_finite_traits(zoo_files: dict[str, Path]) -> None:
    from metagraph.formats.clips import read_clips

    for path in zoo_files.values():
        for found in measure_all_traits(read_clips(path)).values():
            assert np.isfinite(numbers(found)).all(), path.name


@pytest.mark.nightly
@pytest.mark.parametrize("name", ["mesh2motion-cmu", "robot-expressive", "fbx-pab"])
def test_real_clips_have_finite_traits(shared_data: Path, name: str) -> None:
    from metagraph.errors import FileError
    from metagraph.formats.clips import find_clip_files, read_clips

    pytest.importorskip("ufbx", reason="ufbx, which reads FBX, is not installed")
    clips: list[Clip] = []
    for file in find_clip_files(shared_data / name):
        try:
            clips += read_clips(file)
        except FileError:
            continue
    for found in measure_all_traits(clips).values():
        assert np.isfinite(numbers(found)).all()
