"""A path becomes a clip: unbroken stretches are the take itself, transitions are smooth, and the character
walks on from where it is.
"""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
import pytest

from metagraph.formats.clips import read_clips
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.suggest.tracks import measure_facing_and_standing, track_rig
from metagraph.synthesis.assemble import BLEND, assemble
from metagraph.synthesis.constraints import ALL, HeardStates, WantedSegment
from metagraph.synthesis.graph import build_graph
from metagraph.synthesis.search.exact_search import find_best_path
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.states import SynthesisError, read_states

CLIPS = FilePath(__file__).resolve().parents[2] / "sample_clips" / "clips"


@pytest.fixture(scope="module")
def takes() -> list[Clip]:
    names = (
        "hands_at_sides__stance",
        "hands_at_sides__point_you_rt_01",
        "hands_at_sides__shrug_bt_01",
        "hands_at_sides__open_palms_bt_01",
    )
    return [read_clips(CLIPS / f"{name}.glb")[0] for name in names]


def plain(states: list[int]) -> Path:
    way = np.array(states)
    return Path(way, 0.0, np.flatnonzero(np.diff(way) != 1) + 1)


def test_an_unbroken_path_is_the_take_itself(takes: list[Clip]) -> None:
    states = read_states(takes)
    first = int(states.starts[1])
    out = assemble(states, takes, plain(list(range(first, first + 30))))
    same = rotation.measure_angle_between(out.rotations[:, 1:], takes[1].rotations[:30, 1:])
    assert out.frames == 30 and out.fps == 30 and np.degrees(same).max() < 0.1
    high = out.poses().translations[:, 0, 1] - takes[1].poses().translations[:30, 0, 1]
    assert np.abs(high).max() < 1e-5


def test_it_begins_over_the_origin_and_faces_ahead(takes: list[Clip]) -> None:
    states = read_states(takes)
    out = assemble(states, takes, plain(list(range(5, 40))))
    rig = track_rig(out, None)
    facing, at = measure_facing_and_standing(rig, out.poses())
    assert np.abs(at[0, rig.root][[0, 2]]).max() < 1e-5 and facing[0] == pytest.approx([0, 1], abs=1e-5)


def walking(turn: float) -> Clip:
    """Somebody who walks a metre a second, turning."""
    base = read_clips(CLIPS / "hands_at_sides__stance.glb")[0]
    n = 61
    heading = np.linspace(0, turn, n)
    step = np.stack([np.sin(heading), np.zeros(n), np.cos(heading)], axis=-1) / 30
    poses = base.pose_at(np.zeros(n))
    rotations, translations = poses.rotations.copy(), poses.translations[:, :1].copy()
    about = np.stack([np.zeros(n), np.sin(heading / 2), np.zeros(n), np.cos(heading / 2)], axis=-1)
    rotations[:, 0] = rotation.multiply(about, rotations[:, 0])
    translations[:, 0] = rotation.rotate_vectors(about, translations[:, 0]) + np.cumsum(step, axis=0)
    return Clip("walk", base.skeleton, 30.0, rotations.astype(np.float32), translations.astype(np.float32))


def test_the_root_goes_on_from_where_it_is(takes: list[Clip]) -> None:
    walk = walking(np.pi / 2)
    states = read_states([walk, *takes])
    once = list(range(60))
    out = assemble(states, [walk, *takes], plain([*once, *once]), blend=0)
    rig = track_rig(out, None)
    facing, at = measure_facing_and_standing(rig, out.poses())
    steps = np.linalg.norm(np.diff(at[:, rig.root][:, [0, 2]], axis=0), axis=-1)
    assert np.delete(steps, 59) == pytest.approx(
        np.full(118, 1 / 30), rel=0.02
    )  # a transition to a take's first frame stands still
    turned = np.unwrap(np.arctan2(facing[:, 0], facing[:, 1]))
    assert turned[-1] == pytest.approx(2 * np.pi / 2 * 59 / 60, rel=0.02)


def test_transitions_are_smooth_and_stretches_between_them_untouched(takes: list[Clip]) -> None:
    states = read_states(takes)
    a, b = int(states.starts[1]), int(states.starts[2])
    way = plain([*range(a, a + 20), *range(b + 25, b + 50)])
    hard, soft = (assemble(states, takes, way, blend=n) for n in (0, BLEND))
    turns = [
        np.degrees(rotation.measure_angle_between(c.rotations[1:], c.rotations[:-1])).max(-1)
        for c in (hard, soft)
    ]
    assert turns[1].max() < 0.45 * turns[0][19]
    same = np.degrees(rotation.measure_angle_between(hard.rotations, soft.rotations)).max(-1)
    assert same[: 20 - BLEND].max() < 0.1 and same[20 + BLEND :].max() < 0.1 and same[20] > 1


def test_two_transitions_close_to_each_other_share_the_room(takes: list[Clip]) -> None:
    states = read_states(takes)
    a, b = int(states.starts[1]), int(states.starts[2])
    out = assemble(states, takes, plain([*range(a, a + 10), b + 20, b + 21, *range(a + 30, a + 40)]))
    assert out.frames == 22 and np.isfinite(out.rotations).all()


def test_what_a_search_found_plays(takes: list[Clip]) -> None:
    states = read_states(takes)
    graph = build_graph(states)
    path = find_best_path(
        graph,
        HeardStates(np.full(len(states), ALL, np.uint8), np.zeros(len(states), bool)),
        WantedSegment(np.full(300, ALL, np.uint8), np.full(300, -1, np.int32)),
    )
    out = assemble(states, takes, path)
    assert out.duration == pytest.approx(299 / 30)
    fastest = max(
        np.degrees(rotation.measure_angle_between(c.rotations[1:], c.rotations[:-1])).max() * c.fps
        for c in takes
    )
    assert (
        np.degrees(rotation.measure_angle_between(out.rotations[1:], out.rotations[:-1])).max() * 30
        < 1.2 * fastest
    )


def test_other_takes_are_refused(takes: list[Clip]) -> None:
    states = read_states(takes)
    with pytest.raises(SynthesisError, match="but these takes have"):
        assemble(states, takes[:2], plain([0, 1]))


def test_takes_of_other_skeletons_or_of_one_frame_are_refused(takes: list[Clip], toy: object) -> None:
    with pytest.raises(SynthesisError, match="there is none"):
        read_states([])
    one = Clip(
        "one", takes[0].skeleton, 30.0, takes[0].rotations[:1], takes[0].translations[:1], takes[0].translated
    )
    with pytest.raises(SynthesisError, match="only one frame"):
        read_states([one])
    assert len(read_states([one, takes[0]])) == len(read_states([takes[0]]))
