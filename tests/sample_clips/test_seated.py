"""Sitting: the clips of one who sits, the project of them, and the stool."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.formats.store import open_project
from metagraph.graph.model import BasePose, Project
from metagraph.graph.seats import find_seat
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.playback.plan import MetaRequest
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.contacts import measure_contact_depths
from sample_clips.make.catalogue import RECIPES, SEATED, catalogue
from sample_clips.make.mannequin_rig import REACH, REST, SKELETON, at
from sample_clips.make.measure import Measures, measure
from sample_clips.make.recipe import animate
from sample_clips.make.stance_clips import SEAT
from tests.posing import contact_rig, pose_at
from tests.unchanged import only_when_changed

pytestmark = only_when_changed("sample clips")

SAMPLES = Path(__file__).resolve().parents[2] / "sample_clips"
ENTRIES = {entry.name: entry for entry in catalogue(SEATED)}
NAMES = sorted(ENTRIES)
STANCES = {(e.layer, e.stance): e for e in catalogue((*RECIPES, *SEATED)) if e.kind == "stance"}
TOES = [at("LeftToes"), at("RightToes")]


@cache
def on_disk(name: str) -> Clip:
    folder = "seated" if name in ENTRIES else "clips"
    (clip,) = read_gltf_clips(SAMPLES / folder / f"{name}.glb")
    return clip


@cache
def measured(name: str) -> Measures:
    return measure(on_disk(name))


@cache
def project() -> Project:
    return open_project(SAMPLES / "seated.metagraph.yaml").project


def stance(layer: str, name: str) -> str:
    return next(s.id for s in project().graphs[layer].stances.values() if s.name == name)  # type: ignore[index]


def test_each_recipe_has_its_clip_beside_the_152_and_no_name_is_twice() -> None:
    assert sorted(p.stem for p in (SAMPLES / "seated").glob("*.glb")) == NAMES
    assert len(RECIPES) == 152 and not {r.name for r in RECIPES} & set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_clip_begins_and_ends_in_its_stances_on_what_its_layer_reaches(name: str) -> None:
    clip, entry = on_disk(name), ENTRIES[name]
    joints = [at(j) for j in REACH[entry.layer]]
    for frame, which in ((0, entry.stance), (-1, entry.end_stance)):
        other = on_disk(STANCES[entry.layer, which].name)
        turns = rotation.measure_angle_between(
            clip.rotations[frame, joints].astype(float), other.rotations[0, joints].astype(float)
        )
        assert np.degrees(turns.max()) < 0.1
        if entry.layer == "body":
            assert np.abs(clip.root[frame] - other.root[0]).max() < 1e-4


@pytest.mark.parametrize("name", NAMES)
def test_a_clip_moves_as_a_person_could(name: str) -> None:
    m = measured(name)
    assert m.hand_speed < 3.2
    assert m.turn_speed < 1000
    assert m.turn_change < 520
    assert max(m.wrist[:2]) < 75 and max(m.wrist[2:]) < 42
    assert m.elbow[0] > 8 and m.elbow[1] < 152
    assert m.inside < 0.03 and m.together > 0.045
    assert m.slide < 0.002


@pytest.mark.parametrize(
    "name", [n for n in NAMES if n.startswith("body_sitting") and "weight_both" not in n]
)
def test_who_sits_stays_on_the_seat(name: str) -> None:
    hips = on_disk(name).root - (REST[0] + SEAT)
    assert np.abs(hips[:, 1]).max() < 0.008
    assert np.abs(hips[:, [0, 2]]).max() < 0.03


@pytest.mark.parametrize("name", ["body_weight_both__to__sitting", "body_sitting__to__weight_both"])
def test_feet_stay_planted_on_the_way_down_and_up_and_the_trunk_leans_over_them(name: str) -> None:
    clip = on_disk(name)
    _, places = SKELETON.globals(clip.poses())
    assert np.ptp(places[:, TOES], axis=0).max() < 0.002
    half = np.argmin(np.abs(clip.root[:, 1] - clip.root[[0, -1], 1].mean()))
    assert places[half, at("Head"), 2] - places[half, at("Hips"), 2] > 0.25
    assert np.diff(clip.root[:, 1]).__abs__().max() * clip.fps < 1.0  # m/s: nobody falls


def test_hands_on_the_lap_are_found_there_and_stay_through_every_way_of_sitting() -> None:
    lap = next(a for a in project().graphs["arms"].actions.values() if a.name == "on lap")
    assert {(s.hand, s.to) for s in lap.contacts} == {("left", "LeftUpperLeg"), ("right", "RightUpperLeg")}
    times = np.arange(0.0, 30.0, 0.2)
    rig = contact_rig(project())
    assert rig is not None
    asks = [MetaRequest("f", "body", "transition", 8.0, stance=stance("body", "sitting forward"))]
    plan = make_plan(project(), 30.0, asks, seed=2, idle=False)
    pose = pose_at(plan, project(), times)
    assert np.percentile(measure_contact_depths(rig, pose).max(-1), 95) < 0.005
    turned, places = SKELETON.globals(pose)
    for side in ("Left", "Right"):
        hand, thigh = at(side + "Hand"), at(side + "UpperLeg")
        held = rotation.rotate_vectors(
            rotation.conjugate(turned[:, thigh]), places[:, hand] - places[:, thigh]
        )
        assert np.ptp(held, axis=0).max() < 0.004


def test_one_sits_until_asked_to_stand() -> None:
    idle = make_plan(project(), 300.0, seed=2)
    assert {"sitting", "sitting forward"} == {
        project().graphs["body"].stances[cue.stance].name for cue in idle.layers["body"].cues
    }
    asks = [MetaRequest("up", "body", "transition", 1.0, stance=stance("body", "weight both"))]
    plan = make_plan(project(), 10.0, asks, seed=2, idle=False)
    assert plan.layers["body"].stance_at(9.0) == stance("body", "weight both")
    assert not plan.reports


def lowered(sitting: Project, metres: float) -> Project:
    """Return a project whose clips have their roots lower."""
    clips = {}
    for ident, entry in sitting.clips.items():
        motion = entry.motion
        if motion is not None:
            at = motion.translations.copy()
            at[:, 0, 1] -= metres
            entry = replace(entry, motion=replace(motion, translations=at))
        clips[ident] = entry
    return replace(sitting, clips=clips)


def test_a_seat_is_beneath_who_sits_and_none_where_nobody_does() -> None:
    seat = find_seat(project())
    assert seat is not None
    assert seat.at[1] == pytest.approx(0.45, abs=0.01)
    assert seat.at[2] == pytest.approx(SEAT[2], abs=0.06)
    assert find_seat(open_project(SAMPLES / "sample.metagraph.yaml").project) is None
    assert find_seat(Project()) is None


def test_who_sits_on_the_floor_has_a_place_there() -> None:
    sitting = replace(project(), base=BasePose())
    seat = find_seat(lowered(sitting, 0.36))
    assert seat is not None and seat.floor and seat.at[1] == 0.0 and seat.radius > 0.6
    assert not find_seat(sitting).floor  # type: ignore[union-attr]


@pytest.mark.parametrize("name", NAMES[::9])
def test_making_a_clip_again_gives_what_is_on_disk(name: str) -> None:
    made = animate(next(r for r in SEATED if r.name == name))
    turns = rotation.measure_angle_between(
        made.rotations.astype(float), on_disk(name).rotations.astype(float)
    )
    assert np.degrees(turns.max()) < 0.1
