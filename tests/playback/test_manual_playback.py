"""Manual machines at play: which state when, requests, crossfades, loops and held ends."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from metagraph.graph import edits
from metagraph.graph.manual import edits as m
from metagraph.graph.manual.machine import ANY
from metagraph.graph.model import PARTS, Life, Project
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from metagraph.playback.manual_playback import (
    Fire,
    make_manual_plan,
    plan_link_alone,
    play_state_alone,
    route,
)
from tests.posing import manual_morphs_at, manual_pose_at


@pytest.fixture
def drawn(toy: Any) -> Any:
    """Make a machine on the arms layer, which reaches all joints, of states of the toy's clips and links as
    "rest loop>rest wave rt".
    """

    def make(
        *links: str, loops: tuple[str, ...] = ("rest loop",), start: str = "rest loop"
    ) -> tuple[Project, dict[str, str]]:
        project = toy.project()
        clips = {e.name: i for i, e in project.clips.items()}
        names = list(dict.fromkeys([start, *(n for x in links for n in x.split(">") if n != ANY)]))
        project = m.add_states(project, [clips[n] for n in names], "arms")
        for part in PARTS:
            project = edits.set_weight(project, "arms", part, 1.0)
        ids = {s.name: s.id for s in project.manual["arms"].states.values()} | {ANY: ANY}
        project = m.update_states(project, [ids[n] for n in loops if n in ids], loop=True)
        for text in links:
            a, b = text.split(">")
            project = m.add_link(project, "arms", ids[a], ids[b])
            ids[text] = [*project.manual["arms"].links][-1]
        return project, ids

    return make


def names(project: Project, plan: Any) -> list[str]:
    return [p.action.name for p in plan.layers["arms"].played]


def starts(plan: Any) -> list[float]:
    return [round(p.start, 6) for p in plan.layers["arms"].played]


def apart(a: Pose, b: Pose) -> float:
    return max(
        float(rotation.measure_angle_between(a.rotations, b.rotations).max()),
        float(np.abs(a.translations - b.translations).max()),
    )


def alone(project: Project, name: str, seconds: Any) -> Pose:
    return next(e for e in project.clips.values() if e.name == name).motion.pose_at(seconds)  # type: ignore[union-attr]


def test_a_machine_without_links_plays_its_start(drawn: Any) -> None:
    project, _ = drawn()
    plan = make_manual_plan(project, 10)
    assert names(project, plan) == ["rest loop"]
    times = np.linspace(0, 9.9, 50)
    assert apart(manual_pose_at(plan, project, times), alone(project, "rest loop", times % 2.0)) < 1e-5


def test_a_project_without_a_machine_plays_the_base_pose(toy: Any) -> None:
    project = toy.project()
    plan = make_manual_plan(project, 10)
    assert plan.layers == {}
    assert manual_pose_at(plan, project, 1.0).rotations.shape == (16, 4)


def test_a_state_without_a_way_out_holds_its_last_frame(drawn: Any) -> None:
    project, _ = drawn(start="rest long", loops=())
    plan = make_manual_plan(project, 10)
    assert (
        apart(
            manual_pose_at(plan, project, np.array([2.4, 5.0, 9.0])),
            alone(project, "rest long", np.array([2.4] * 3)),
        )
        < 1e-5
    )


def test_a_finished_link_ends_its_blend_with_its_source(drawn: Any) -> None:
    project, ids = drawn("rest long>rest loop", start="rest long")
    plan = make_manual_plan(m.update_links(project, [ids["rest long>rest loop"]], blend=0.4), 10)
    assert names(project, plan) == ["rest long", "rest loop"]
    assert starts(plan) == [0, 2.0]


def test_a_finished_link_with_an_exit_time_begins_its_blend_there(drawn: Any) -> None:
    project, ids = drawn("rest long>rest loop", start="rest long")
    project = m.update_states(project, [ids["rest long"]], start=0.5)
    plan = make_manual_plan(
        m.update_links(project, [ids["rest long>rest loop"]], blend=0.4, exit_time=1.5), 10
    )
    assert starts(plan) == [0, 1.0]


def test_a_finished_link_leaves_a_loop_after_its_first_round(drawn: Any) -> None:
    project, _ = drawn("rest loop>rest wave rt", "rest wave rt>rest loop")
    plan = make_manual_plan(project, 6)
    assert names(project, plan)[:3] == ["rest loop", "rest wave rt", "rest loop"]
    assert starts(plan)[:3] == [0, 1.75, 1.75 + 1.2 - 0.25]


def test_both_clips_run_on_in_a_crossfade(drawn: Any) -> None:
    project, ids = drawn("rest long>up loop", start="rest long", loops=("up loop",))
    plan = make_manual_plan(m.update_links(project, [ids["rest long>up loop"]], blend=0.5, exit_time=1.0), 10)
    low, high = alone(project, "rest long", 1.25), alone(project, "up loop", 0.25)
    half = manual_pose_at(plan, project, 1.25)
    assert (
        apart(
            half,
            Pose(
                rotation.nlerp(low.rotations, high.rotations, np.full(16, 0.5)),
                (low.translations + high.translations) / 2,
            ),
        )
        < 1e-3
    )
    assert apart(manual_pose_at(plan, project, 1.5001), alone(project, "up loop", 0.5001)) < 1e-3
    steps = manual_pose_at(plan, project, np.linspace(0.9, 1.6, 71))
    assert float(rotation.measure_angle_between(steps.rotations[1:], steps.rotations[:-1]).max()) < 0.08, (
        "nothing jumps"
    )


def test_a_request_is_taken_at_once_where_no_exit_time_says_otherwise(drawn: Any) -> None:
    project, ids = drawn("rest loop>rest wave rt", "rest wave rt>rest loop")
    project = m.update_links(project, [ids["rest loop>rest wave rt"]], condition={"when": "request"})
    assert names(project, make_manual_plan(project, 10)) == ["rest loop"]
    plan = make_manual_plan(project, 10, [Fire("arms", "rest wave rt", 3.3)])
    assert starts(plan) == [0, 3.3, 3.3 + 1.2 - 0.25]


def test_a_request_with_an_exit_time_waits_for_it_each_time_round(drawn: Any) -> None:
    project, ids = drawn("rest loop>rest wave rt", "rest wave rt>rest loop")
    project = m.update_links(
        project, [ids["rest loop>rest wave rt"]], condition={"when": "request"}, exit_time=0.5
    )
    assert starts(make_manual_plan(project, 10, [Fire("arms", "rest wave rt", 3.3)]))[1] == 4.5
    assert starts(make_manual_plan(project, 10, [Fire("arms", "rest wave rt", 4.5)]))[1] == 4.5


def test_a_request_leads_over_the_shortest_way(drawn: Any) -> None:
    project, ids = drawn(
        "rest loop>rest to up",
        "rest to up>up loop",
        "up loop>up beat",
        "up beat>up loop",
        loops=("rest loop", "up loop"),
    )
    project = m.update_links(
        project, [ids["rest loop>rest to up"], ids["up loop>up beat"]], condition={"when": "request"}
    )
    plan = make_manual_plan(project, 20, [Fire("arms", "up beat", 1.0)])
    assert names(project, plan) == ["rest loop", "rest to up", "up loop", "up beat", "up loop"]
    assert route(project.manual["arms"], ids["rest loop"], "rest to up") == (
        project.link(ids["rest loop>rest to up"]),
    )


def test_a_request_that_leads_nowhere_is_reported_and_changes_nothing(drawn: Any) -> None:
    project, _ = drawn("rest loop>rest wave rt", "rest wave rt>rest loop")
    plan = make_manual_plan(project, 10, [Fire("arms", "jump", 1.0)])
    assert [(r.outcome, r.request) for r in plan.reports] == [("no-way", "jump")]
    assert plan.layers == make_manual_plan(project, 10).layers


def test_a_link_from_any_state_is_open_from_each_but_its_own_target(drawn: Any) -> None:
    project, ids = drawn(
        "any>rest wave rt", "rest wave rt>rest loop", "rest loop>rest long", "rest long>rest loop"
    )
    project = m.update_links(project, [ids["rest loop>rest long"]], condition={"when": "request"})
    plan = make_manual_plan(project, 10, [Fire("arms", "rest long", 0.5), Fire("arms", "rest wave rt", 1.0)])
    assert names(project, plan) == ["rest loop", "rest long", "rest wave rt", "rest loop"]
    assert starts(plan)[2] == 1.0


def test_no_blend_begins_while_another_runs(drawn: Any) -> None:
    project, ids = drawn("any>rest wave rt", "any>rest long", "rest wave rt>rest loop", "rest long>rest loop")
    project = m.update_links(project, [ids["any>rest wave rt"]], blend=0.8)
    plan = make_manual_plan(project, 10, [Fire("arms", "rest wave rt", 1.0), Fire("arms", "rest long", 1.1)])
    assert starts(plan)[:3] == [0, 1.0, 1.8]


def test_finished_links_are_drawn_by_weight_and_the_same_each_time(drawn: Any) -> None:
    project, ids = drawn(
        "rest loop>rest wave rt", "rest loop>rest short", "rest wave rt>rest loop", "rest short>rest loop"
    )
    project = m.update_links(project, [ids["rest loop>rest wave rt"]], condition={"weight": 4.0})
    plan = make_manual_plan(project, 600)
    assert plan == make_manual_plan(project, 600)
    played = names(project, plan)
    share = played.count("rest wave rt") / (played.count("rest wave rt") + played.count("rest short"))
    assert 0.7 < share < 0.9
    assert names(project, make_manual_plan(project, 600, seed=2)) != played


def test_a_longer_plan_begins_as_a_shorter_one_and_the_past_stays(drawn: Any) -> None:
    project, _ids = drawn(
        "rest loop>rest wave rt",
        "rest loop>rest short",
        "rest wave rt>rest loop",
        "rest short>rest loop",
        "any>rest cough",
    )
    short, long = make_manual_plan(project, 30), make_manual_plan(project, 60)
    assert long.layers["arms"].played[: len(short.layers["arms"].played)] == short.layers["arms"].played
    fired = make_manual_plan(project, 60, [Fire("arms", "rest cough", 30)])
    before = [p for p in long.layers["arms"].played if p.start < 30]
    assert list(fired.layers["arms"].played[: len(before)]) == before


def test_states_in_a_circle_without_length_do_not_hang(drawn: Any) -> None:
    project, ids = drawn("rest short>rest cough", "rest cough>rest short", start="rest short", loops=())
    project = m.update_states(project, [ids["rest short"], ids["rest cough"]], start=0.5, end=0.5)
    project = m.update_links(project, [*project.manual["arms"].links], blend=0.0)
    assert len(make_manual_plan(project, 2).layers["arms"].played) <= 61


def test_joints_that_a_state_does_not_move_stay_in_the_base_pose(drawn: Any) -> None:
    project, ids = drawn(start="rest wave rt", loops=())
    project = m.update_states(project, [ids["rest wave rt"]], limb="right")
    plan, base = make_manual_plan(project, 5), alone(project, "rest loop", 0.0)
    pose = manual_pose_at(plan, project, 0.6)
    left, right = (project.skeleton.index(n) for n in ("LeftUpperArm", "RightUpperArm"))  # type: ignore[union-attr]
    assert float(rotation.measure_angle_between(pose.rotations[left], base.rotations[left])) < 1e-5
    assert float(rotation.measure_angle_between(pose.rotations[right], base.rotations[right])) > 0.2


def test_a_joint_that_a_state_moves_in_part_goes_so_far_from_the_base_pose(drawn: Any) -> None:
    project, ids = drawn(start="rest wave rt", loops=())
    base, whole = alone(project, "rest loop", 0.0), manual_pose_at(make_manual_plan(project, 5), project, 0.6)
    soft = m.update_states(project, [ids["rest wave rt"]], joint_weights=(("RightUpperArm", 0.5),))
    pose = manual_pose_at(make_manual_plan(soft, 5), soft, 0.6)
    arm = project.skeleton.index("RightUpperArm")  # type: ignore[union-attr]
    far = rotation.measure_angle_between(base.rotations[arm], whole.rotations[arm])
    assert rotation.measure_angle_between(base.rotations[arm], pose.rotations[arm]) == pytest.approx(
        far / 2, abs=1e-4
    )


def test_a_missing_clip_plays_the_base_pose(drawn: Any) -> None:
    project, _ids = drawn(start="rest wave rt", loops=())
    clips = {i: replace(e, motion=None) if e.name == "rest wave rt" else e for i, e in project.clips.items()}
    pose = manual_pose_at(make_manual_plan(project, 5), replace(project, clips=clips), [0.1, 0.6])
    assert apart(Pose(pose.rotations[0], pose.translations[0]), alone(project, "rest loop", 0.0)) < 1e-5


def test_poses_do_not_depend_on_what_else_is_asked(drawn: Any) -> None:
    project, _ = drawn("rest loop>rest wave rt", "rest wave rt>rest loop")
    plan = make_manual_plan(project, 20)
    times = np.random.default_rng(1).uniform(0, 20, 60)
    many = manual_pose_at(plan, project, times)
    for n in range(0, 60, 7):
        one = manual_pose_at(plan, project, float(times[n]))
        assert apart(one, Pose(many.rotations[n], many.translations[n])) < 1e-6


def test_the_life_layers_play_on_top(drawn: Any) -> None:
    project, _ = drawn()
    alive = replace(project, life=Life())
    plan = make_manual_plan(alive, 10)
    assert apart(manual_pose_at(plan, alive, 2.0), manual_pose_at(plan, alive, 2.0, alive=False)) > 1e-4
    assert manual_morphs_at(plan, alive, 2.0) == {}


def test_a_state_is_looked_at_alone_and_a_link_with_what_is_around_it(drawn: Any) -> None:
    project, ids = drawn("rest long>rest loop", "any>rest long", start="rest long")
    only = play_state_alone(project, ids["rest long"])
    assert only.end == pytest.approx(2.4)
    project = m.update_links(project, [ids["rest long>rest loop"]], blend=0.4)
    link = plan_link_alone(project, ids["rest long>rest loop"])
    assert [p.action.name for p in link.layers["arms"].played] == ["rest long", "rest loop"]
    assert (link.layers["arms"].played[0].entry, link.layers["arms"].played[1].start) == (
        pytest.approx(1.0),
        1.0,
    )
    assert [p.action.name for p in plan_link_alone(project, ids["any>rest long"]).layers["arms"].played] == [
        "rest loop",
        "rest long",
    ]
    with pytest.raises(KeyError):
        play_state_alone(project, "m999")


def test_the_plan_shows_as_cues_that_do_not_overlap(drawn: Any) -> None:
    project, _ = drawn("rest loop>rest wave rt", "rest wave rt>rest loop")
    cues = make_manual_plan(project, 10).plan.layers["arms"].cues
    assert cues[0].start == 0
    assert cues[-1].end == 10
    assert all(a.end == b.start for a, b in itertools.pairwise(cues))
