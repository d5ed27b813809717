"""The clips as they are on disk: whole, in their stances, without jumps, feet on the ground."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from sample_clips.make.catalogue import BASE, RECIPES, Entry, catalogue
from sample_clips.make.mannequin_rig import FPS, REACH, SKELETON, at
from sample_clips.make.measure import Measures, head_ways, likeness, measure, way_of
from sample_clips.make.recipe import animate, follower
from sample_clips.make.shapes import MOUTH_Y
from tests.unchanged import only_when_changed

pytestmark = only_when_changed("sample clips")

FOLDER = Path(__file__).resolve().parents[2] / "sample_clips" / "clips"
ENTRIES = {entry.name: entry for entry in catalogue()}
NAMES = sorted(ENTRIES)
STANCE_OF = {(e.layer, e.stance): e.name for e in ENTRIES.values() if e.kind == "stance"}
CLOSE = 0.1  # degrees
NEAR = 1e-4  # metres


@cache
def on_disk(name: str) -> Clip:
    (clip,) = read_gltf_clips(FOLDER / ENTRIES[name].file)
    return clip


@cache
def measured(name: str) -> Measures:
    return measure(on_disk(name))


def apart(a: Clip, frame_a: int, b: Clip, frame_b: int) -> tuple[float, float]:
    """Return how far two frames are apart: degrees of the worst joint, metres of the root."""
    turns = rotation.measure_angle_between(
        a.rotations[frame_a].astype(float), b.rotations[frame_b].astype(float)
    )
    return float(np.degrees(turns.max())), float(np.abs(a.root[frame_a] - b.root[frame_b]).max())


def entries(layer: str, stance: str, kind: str) -> list[Entry]:
    return [e for e in ENTRIES.values() if (e.layer, e.stance, e.kind) == (layer, stance, kind)]


def test_each_recipe_has_its_clip_and_no_clip_is_without() -> None:
    assert len(RECIPES) == len(ENTRIES)
    assert sorted(p.stem for p in FOLDER.glob("*.glb")) == NAMES


def test_all_files_together_stay_below_6_megabytes() -> None:
    assert sum(p.stat().st_size for p in FOLDER.glob("*.glb")) < 6_000_000


@pytest.mark.parametrize("name", NAMES)
def test_a_clip_reads_back_as_the_mannequin_s_motion_of_the_length_in_the_catalogue(name: str) -> None:
    clip, entry = on_disk(name), ENTRIES[name]
    assert clip.name == name
    assert clip.skeleton == SKELETON
    assert clip.fps == FPS
    assert clip.duration == pytest.approx(entry.end, abs=1e-3)
    assert clip.notes == ()
    assert clip.translated == (0,)


@pytest.mark.parametrize("name", NAMES)
def test_a_clip_begins_and_ends_exactly_in_its_stances_at_rest(name: str) -> None:
    clip, entry = on_disk(name), ENTRIES[name]
    first, last = (on_disk(STANCE_OF[entry.layer, stance]) for stance in (entry.stance, entry.end_stance))
    for frame, stance in ((0, first), (-1, last)):
        degrees, metres = apart(clip, frame, stance, 0)
        assert degrees < CLOSE
        assert metres < NEAR
    for a, b in ((0, 1), (-1, -2)):
        assert apart(clip, a, clip, b)[0] < 0.6  # 18 degrees a second


@pytest.mark.parametrize("name", NAMES)
def test_a_clip_moves_only_what_its_layer_reaches(name: str) -> None:
    clip, base = on_disk(name), on_disk(BASE[0])
    others = [i for i, joint in enumerate(SKELETON.names) if joint not in REACH[ENTRIES[name].layer]]
    turns = rotation.measure_angle_between(
        clip.rotations[:, others].astype(float), base.rotations[BASE[1], others].astype(float)
    )
    assert np.degrees(turns.max()) < CLOSE
    if ENTRIES[name].layer != "body":
        assert np.abs(clip.root - base.root[BASE[1]]).max() < NEAR


@pytest.mark.parametrize("name", NAMES)
def test_a_clip_moves_as_a_person_could(name: str) -> None:
    m = measured(name)
    assert m.hand_speed < 3.2  # m/s
    assert m.turn_speed < 1000  # a quick finger
    assert m.turn_change < 520  # deg/s within one frame: a jump would be thousands
    assert m.wrist[0] < 75
    assert m.wrist[1] < 72
    assert max(m.wrist[2:]) < 42
    assert m.turned[0] < 95
    assert m.turned[1] < 92
    assert m.elbow[0] > 8  # never straight, never the wrong way
    assert m.elbow[1] < 152


@pytest.mark.parametrize("name", NAMES)
def test_hands_and_forearms_stay_outside_the_body_and_of_each_other(name: str) -> None:
    assert (
        measured(name).inside < 0.03
    )  # the torso here is a rough one, and flesh gives a little where a hand rests
    assert measured(name).together > 0.045


@pytest.mark.parametrize("name", NAMES)
def test_planted_feet_do_not_slide_and_none_goes_into_the_ground(name: str) -> None:
    assert measured(name).slide < 0.002
    _, places = SKELETON.globals(on_disk(name).poses())
    rest = SKELETON.globals(SKELETON.rest)[1][at("LeftToes"), 1]
    assert places[:, [at("LeftToes"), at("RightToes")], 1].min() > rest - 0.003


@pytest.mark.parametrize("name", NAMES)
def test_the_length_suits_the_kind(name: str) -> None:
    entry = ENTRIES[name]
    low, high = {"stance": (5, 8), "gesture": (1.2, 3.4), "fidget": (1.5, 4.0), "transition": (0.7, 1.6)}[
        entry.kind
    ]
    assert low <= on_disk(name).duration <= high
    assert 0 <= entry.start < entry.end
    assert 0.1 <= entry.blend_in <= 0.3
    assert 0.1 <= entry.blend_out <= 0.3


@pytest.mark.parametrize(
    "stance", ["hands_at_sides", "on_hips", "arms_crossed", "hand_to_chin", "hands_clasped"]
)
def test_every_arms_stance_has_one_loop_four_gestures_and_two_fidgets(stance: str) -> None:
    assert len(entries("arms", stance, "stance")) == 1
    assert len(entries("arms", stance, "gesture")) >= 4
    assert len(entries("arms", stance, "fidget")) >= 2


def test_hands_at_the_sides_is_the_richest_stance() -> None:
    assert len(entries("arms", "hands_at_sides", "gesture")) >= 20


@pytest.mark.parametrize("layer", ["body", "arms", "head"])
def test_every_stance_of_a_layer_can_be_reached_from_every_other(layer: str) -> None:
    stances = {e.stance for e in ENTRIES.values() if e.layer == layer}
    ways = {(e.stance, e.end_stance) for e in ENTRIES.values() if e.layer == layer and e.kind == "transition"}
    assert all((b, a) in ways for a, b in ways)
    for start in stances:
        reached = {start}
        for _ in stances:
            reached |= {b for a, b in ways if a in reached}
        assert reached == stances
    for stance in stances:
        assert len(entries(layer, stance, "stance")) == 1
        assert len(entries(layer, stance, "gesture")) >= 2
        assert len(entries(layer, stance, "fidget")) >= 1


ONE_ARMED = [
    n
    for n in NAMES
    if ENTRIES[n].kind == "gesture" and ENTRIES[n].layer == "arms" and ENTRIES[n].limb != "both"
]


@pytest.mark.parametrize("name", ONE_ARMED)
def test_a_gesture_of_one_arm_leaves_the_other_in_its_stance(name: str) -> None:
    entry, clip = ENTRIES[name], on_disk(name)
    hand = at("RightHand" if entry.limb == "left" else "LeftHand")
    elbow = at("RightLowerArm" if entry.limb == "left" else "LeftLowerArm")
    turns = rotation.measure_angle_between(
        clip.rotations[:, [hand, elbow]].astype(float), clip.rotations[0, [hand, elbow]].astype(float)
    )
    assert np.degrees(turns.max()) < 9


def test_names_carry_layer_stance_and_side() -> None:
    for entry in ENTRIES.values():
        prefix = f"body_{entry.stance}" if entry.layer == "body" else entry.stance
        assert entry.name.startswith(prefix + "__")
        if entry.layer == "arms" and entry.kind in ("gesture", "fidget"):
            assert f"_{ {'left': 'lf', 'right': 'rt', 'both': 'bt'}[entry.limb] }_" in entry.name


@pytest.mark.parametrize("name", NAMES[::19])
def test_making_a_clip_twice_gives_the_same_numbers_as_on_disk(name: str) -> None:
    recipe = next(r for r in RECIPES if r.name == name)
    once, twice = animate(recipe), animate(recipe)
    assert np.array_equal(once.rotations, twice.rotations)
    assert np.array_equal(once.root, twice.root)
    turns = rotation.measure_angle_between(
        once.rotations.astype(float), on_disk(name).rotations.astype(float)
    )
    assert np.degrees(turns.max()) < 0.1


LED = [r.name for r in RECIPES if follower(r)]


def test_two_hands_that_speak_are_no_twins() -> None:
    found = [likeness(on_disk(name)) for name in LED]
    assert len(found) > 8
    assert np.median(found) < 0.96
    assert max(found) < 0.99


@pytest.mark.parametrize("name", [n for n in NAMES if "__shrug_" in n])
def test_a_shrug_lifts_the_shoulders_so_that_it_is_seen(name: str) -> None:
    assert 0.04 < way_of(on_disk(name), "LeftUpperArm")[1] < 0.06


def test_what_the_body_says_is_large_enough_to_be_read() -> None:
    assert way_of(on_disk("body_weight_both__lean_in_01"), "Head")[2] > 0.13
    assert way_of(on_disk("body_weight_right__lean_back_01"), "Head")[2] > 0.08
    assert way_of(on_disk("body_weight_both__straighten_01"), "Head")[1] > 0.04
    assert way_of(on_disk("body_weight_right__tap_foot_01"), "LeftToes")[1] > 0.035


@pytest.mark.parametrize("name", [n for n in NAMES if "__glance_" in n])
def test_a_glance_goes_to_the_side_and_is_no_nod(name: str) -> None:
    sideways, upright = head_ways(on_disk(name))
    assert sideways > 25
    assert upright < 3


@pytest.mark.parametrize("stance", ["hands_at_sides", "on_hips", "arms_crossed", "hand_to_chin"])
def test_the_fingers_of_a_resting_hand_differ_and_stir(stance: str) -> None:
    clip = on_disk(f"{stance}__stance")
    curls = [
        sum(
            rotation.measure_angle_between(clip.rotations[0, at(f"Right{finger}{bone}")].astype(float), rest)
            for bone in (1, 2, 3)
        )
        for finger in ("Index", "Little")
        for rest in (rotation.make_identity_rotations(()),)
    ]
    assert np.degrees(curls[1] - curls[0]) > 14, "the little finger curls more than the index"
    knuckle = clip.rotations[:, at("RightMiddle2")].astype(float)
    assert np.degrees(rotation.measure_angle_between(knuckle, knuckle[0]).max()) > 1


def test_a_hand_at_the_chin_leaves_the_lips_free() -> None:
    clip = on_disk("hand_to_chin__stance")
    turns, places = SKELETON.globals(clip.poses())
    head = at("Head")
    rest = SKELETON.globals(SKELETON.rest)[1][head]
    for finger in ("Thumb", "Index", "Middle", "Ring", "Little"):
        away = places[:, at(f"Right{finger}3")] - places[:, head]
        seen = rest + rotation.rotate_vectors(rotation.conjugate(turns[:, head]), away)
        assert seen[:, 1].max() < MOUTH_Y - 0.01, finger
