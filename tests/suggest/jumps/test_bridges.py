"""Bridges: every stance is led to and led back from, and what was made is reported as what it is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.editing import retiming
from metagraph.graph.expand import find_reachable
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.requests import Play
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.suggest.accept import accept
from metagraph.suggest.jumps.bridges import (
    CALM,
    HASTY,
    LONGEST,
    SHIFT,
    SHORTEST,
    SPEED,
    bridge_all,
    bridge_stance,
    describe_bridges,
    describe_unbridged,
    find_missing_bridges,
)
from metagraph.suggest.propose import propose
from tests.conftest import Toy
from tests.label_zoo.catalogue import named
from tests.label_zoo.motions import scaled
from tests.projects import projects

TOY = Toy()
ANGLES = (0.0, 0.4, 0.8, 1.2, -0.3)


def stances(
    count: int, ways: Sequence[tuple[int, int]] = (), seconds: float = 3.0, size: float = 1.0
) -> Project:
    """Stances with a loop each, s0 the start, and transitions between some."""
    clips = [TOY.clip(f"s{n} loop", seconds, ANGLES[n], swing=0.02) for n in range(count)]
    clips += [TOY.clip(f"{a} to {b}", 0.8, ANGLES[a], ANGLES[b], swing=0.0) for a, b in ways]
    clips = [scaled(c, size) if size != 1.0 else c for c in clips]
    project = edits.add_clips(Project("p"), [(f"{c.name}.glb", 0, "", c) for c in clips])
    for n in range(count):
        project = edits.add_stance(project, "arms", f"s{n}", [TOY.id(project, f"s{n} loop")])
    ids = list(project.graphs["arms"].stances)
    for a, b in ways:
        clip = next(i for i, e in project.clips.items() if e.name == f"{a} to {b}")
        project = edits.place_clips(project, [clip], "arms", "transition", ids[a], ids[b])
    return project


def trouble(project: Project) -> set[str]:
    """What is said of stances that are not joined, and of the ends of actions."""
    codes = {"unreachable", "dead-end", "far-start", "far-end", "trim", "empty", "blend", "open-loop"}
    return {p.code for p in check_project(project)} & codes


graphs = st.integers(0, len(ANGLES)).flatmap(
    lambda n: st.tuples(
        st.just(n),
        st.lists(
            st.tuples(st.integers(0, n - 1), st.integers(0, n - 1)).filter(lambda w: w[0] != w[1]),
            unique=True,
            max_size=8,
        )
        if n > 1
        else st.just([]),
    )
)


@pytest.mark.nightly
@given(graphs)
def test_every_stance_is_led_to_and_led_back_from_and_bridging_again_adds_nothing(
    drawn: tuple[int, list[tuple[int, int]]],
) -> None:
    project = stances(*drawn)
    after, made = bridge_all(project)
    graph = after.graphs["arms"]
    for stance in graph.stances:
        assert stance in find_reachable(graph, str(graph.start)) and graph.start in find_reachable(
            graph, stance
        )
    assert find_missing_bridges(after) == [] and bridge_all(after) == (after, ())
    assert bool(find_missing_bridges(project)) == bool(made)
    before = project.graphs["arms"].actions
    assert set(graph.actions) - set(before) == {x.action for x in made}
    assert all(graph.actions[i] is before[i] for i in before)
    assert not trouble(after)


@given(projects())
def test_whatever_somebody_made_is_bridged_without_an_error_and_only_added_to(project: Project) -> None:
    after, made = bridge_all(project)
    kept = {a.id: a for a in after.actions() if a.id not in {x.action for x in made}}
    assert kept == {a.id: a for a in project.actions()}
    for layer in LAYERS:
        assert after.graphs[layer].stances == project.graphs[layer].stances
        for stance in project.graphs[layer].stances:
            bridge_stance(project, stance)


def test_without_stances_or_with_one_there_is_nothing_to_bridge() -> None:
    assert bridge_all(Project()) == (Project(), ()) and find_missing_bridges(Project()) == []
    one = stances(1)
    assert bridge_all(one) == (one, ()) and bridge_stance(one, next(iter(one.graphs["arms"].stances))) == (
        one,
        (),
    )


def test_a_stance_that_is_not_there_gets_no_bridge() -> None:
    project = stances(2)
    assert bridge_stance(project, "s99") == (project, ())


def test_stances_without_a_loop_are_left_as_they_are() -> None:
    project = stances(3)
    second = list(project.graphs["arms"].stances)[1]
    bare = edits.remove_actions(project, [a.id for a in project.graphs["arms"].of(second, "stance")])
    made = bridge_all(used(bare))[1]
    assert {s for x in made for s in (x.start, x.end)} == set(project.graphs["arms"].stances) - {second}
    assert bridge_stance(bare, second) == (bare, ())
    none = edits.remove_actions(project, [a.id for a in project.actions()])
    assert bridge_all(none) == (none, ())


def test_a_start_without_a_loop_leaves_the_layer_as_it_is() -> None:
    project = stances(3)
    graph = project.graphs["arms"]
    bare = edits.remove_actions(project, [a.id for a in graph.of(str(graph.start), "stance")])
    assert bridge_all(bare) == (bare, ()) and find_missing_bridges(bare) == []


def test_a_loop_of_another_skeleton_or_whose_file_is_gone_gives_way_to_the_next(toy: Any) -> None:
    project = stances(2)
    first, second = project.graphs["arms"].stances
    clip = toy.clip("second loop", 1.5, ANGLES[1], swing=0.02)
    project = edits.add_clips(project, [("second.glb", 0, "", clip)])
    project = edits.place_clips(project, [TOY.id(project, "second loop")], "arms", "stance", second)
    lost = project.graphs["arms"].of(second, "stance")[0].clip
    gone = replace(project, clips={**project.clips, lost: replace(project.clips[lost], motion=None)})
    after, made = bridge_all(gone)
    assert {(x.start, x.end) for x in made} == {(first, second), (second, first)}
    assert after.clips[after.action(made[0].action).clip].name == "second loop"  # type: ignore[union-attr]
    other = replace(
        project.clips[lost], motion=scaled(TOY.clip("other", 2.0), 3.0)
    )  # as reading a changed file again may bring
    assert len(bridge_all(replace(project, clips={**project.clips, lost: other}))[1]) == 2


def test_the_nearest_stance_is_bridged_to_and_from() -> None:
    after, made = bridge_all(stances(3))  # 0.0, 0.4, 0.8: in a row
    first, middle, last = after.graphs["arms"].stances
    assert {(x.start, x.end) for x in made} == {
        (first, middle),
        (middle, last),
        (middle, first),
        (last, middle),
    }


@pytest.mark.parametrize("size", [0.01, 1.0, 100.0])
def test_a_bridge_takes_as_long_whatever_the_units_and_nothing_is_said_to_pop(size: float) -> None:
    after, made = bridge_all(stances(4, size=size))
    plain, usual = bridge_all(stances(4))
    assert [x.seconds for x in made] == pytest.approx([x.seconds for x in usual])
    assert [x.metres for x in made] == pytest.approx([x.metres * size for x in usual], rel=1e-4)
    assert all(SHORTEST - 1e-9 <= x.seconds <= LONGEST + 1e-9 for x in made) and not trouble(after)
    lines = describe_bridges(after, made)
    assert [("a clip would look better" in x) for x in lines] == [
        ("a clip would look better" in x) for x in describe_bridges(plain, usual)
    ]


def test_a_single_pose_is_blended_into_out_of_the_loop_before_it() -> None:
    project = stances(2)
    still = TOY.clip("still").trimmed(0, 1)
    project = edits.add_clips(project, [("still.glb", 0, "", still)])
    project = edits.add_stance(project, "arms", "still", [TOY.id(project, "still")])
    after, made = bridge_all(project)
    ends = list(after.graphs["arms"].stances)[2]
    (into,) = [after.action(x.action) for x in made if x.end == ends]
    assert into is not None and after.clips[into.clip].duration > 1
    assert into.timing.blend_out > into.timing.blend_in > 0 and not trouble(after)
    assert all(x.seconds >= SHORTEST - 1e-9 for x in made)


def used(project: Project) -> Project:
    """The project with a fidget in each stance, so that there is something to go there for."""
    for layer, graph in project.graphs.items():
        for stance in graph.stances:
            for loop in graph.of(stance, "stance")[:1]:
                project = edits.place_clips(project, [loop.clip], layer, "fidget", stance)
    return project


def test_a_far_stance_in_which_nothing_plays_is_left_alone_and_told_but_joined_on_request() -> None:
    clips = [TOY.clip("idle", 2.0, 0.0, swing=0.02), TOY.clip("fighting", 2.0, 1.2, swing=0.02)]
    project = edits.add_clips(Project("p"), [(f"{c.name}.glb", 0, "", c) for c in clips])
    for clip in clips:
        project = edits.add_stance(project, "arms", clip.name, [TOY.id(project, clip.name)])
    assert bridge_all(project) == (project, ())
    (line,) = describe_unbridged(project)
    assert "nothing but its loop plays there" in line and "under Problems" in line
    assert len(bridge_stance(project, TOY.id(project, "fighting"))[1]) == 2
    project = edits.add_clips(project, [("wave.glb", 0, "", TOY.clip("wave", 2.0, 1.2, swing=1.5))])
    fighting = TOY.id(project, "fighting")
    project = edits.place_clips(project, [TOY.id(project, "wave")], "arms", "gesture", fighting)
    assert len(bridge_all(project)[1]) == 2


def two_poses(change: Callable[[Clip], Clip], seconds: float = 2.0, layer: Layer = "body") -> Project:
    """A stance, and another whose clip is changed."""
    clips = [TOY.clip("here", 2.0, 0.0, swing=0.02), change(TOY.clip("there", seconds, 0.4, swing=0.02))]
    project = edits.add_clips(Project("p"), [(f"{c.name}.glb", 0, "", c) for c in clips])
    for name in ("here", "there"):
        project = edits.add_stance(project, layer, name, [TOY.id(project, name)])
    return project


def moved(metres: float) -> Callable[[Clip], Clip]:
    def move(clip: Clip) -> Clip:
        translations = clip.translations.copy()
        translations[:, clip.translated.index(0), 0] += metres
        return replace(clip, translations=translations)

    return move


def faced(degrees: float) -> Callable[[Clip], Clip]:
    def face(clip: Clip) -> Clip:
        rotations = clip.rotations.copy()
        turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.radians(degrees))
        rotations[:, 0] = rotation.multiply(turn, rotations[:, 0])
        return replace(clip, rotations=rotations.astype(np.float32))

    return face


def test_a_short_loop_is_blended_into_out_of_the_longer_loop_before_it() -> None:
    project = two_poses(lambda clip: clip, seconds=0.4, layer="arms")
    after, made = bridge_all(project)
    there = next(x for x in made if x.end == TOY.id(project, "there"))
    into = after.action(there.action)
    assert into is not None and into.timing.blend_out > into.timing.blend_in
    assert after.clips[into.clip].name == "here" and there.seconds > 0.5
    assert len(made) == 2 and not describe_unbridged(after)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (moved(0.8), "slide 0.8 m over the floor"),
        (faced(90.0), "turn by 90 degrees on the spot"),
        (faced(-170.0), "turn by 170 degrees on the spot"),
    ],
)
def test_no_bridge_slides_or_turns_the_body(change: Callable[[Clip], Clip], words: str) -> None:
    project = two_poses(change)
    assert bridge_all(project) == (project, ()) and find_missing_bridges(project) == []
    (line,) = describe_unbridged(project)
    assert line.startswith('"there" is not joined to the others') and words in line


@pytest.mark.parametrize("change", [moved(0.1), faced(20.0)])
def test_a_small_step_or_turn_is_bridged(change: Callable[[Clip], Clip]) -> None:
    after, made = bridge_all(two_poses(change))
    assert len(made) == 2 and describe_unbridged(after) == []


def test_a_layer_that_leaves_the_legs_alone_is_bridged_wherever_the_clips_stand() -> None:
    project = edits.set_weight(two_poses(moved(2.0), layer="arms"), "arms", "legs", 0.0)
    assert len(bridge_all(project)[1]) == 2


def test_no_bridge_throws_the_hands() -> None:
    clips = [TOY.clip(name, 0.25, angle, swing=0.0) for name, angle in (("down", 0.0), ("up", 1.6))]
    project = edits.add_clips(Project("p"), [(f"{c.name}.glb", 0, "", c) for c in clips])
    for clip in clips:
        project = edits.add_stance(project, "arms", clip.name, [TOY.id(project, clip.name)])
    fast = project
    for clip in project.clips:  # what plays at another speed is not held
        fast = retiming.set_speed(fast, clip, 1.01)
    assert bridge_all(fast) == (fast, ())
    (line,) = describe_unbridged(fast)
    assert "both loops are too short" in line and "would look like a jolt" in line
    _, held = bridge_all(used(project))
    _, made = bridge_all(stances(3))
    assert len(held) == 2 and all(x.metres / x.seconds < HASTY for x in (*held, *made))


def among_calm_clips(seconds: float, height: float) -> Project:
    """Two loops of some seconds, the second with its hips higher, and a gesture that moves one hand fast."""
    clips = [TOY.clip(name, seconds, 0.0, swing=0.0) for name in ("low", "high")]
    translations = clips[1].translations.copy()
    translations[:, clips[1].translated.index(0), 1] += height
    clips[1] = replace(clips[1], translations=translations)
    clips.append(TOY.clip("wave", 2.0, 0.0, swing=1.0))
    project = edits.add_clips(Project("p"), [(f"{c.name}.glb", 0, "", c) for c in clips])
    for name in ("low", "high"):
        project = edits.add_stance(project, "body", name, [TOY.id(project, name)])
    stance = next(iter(project.graphs["body"].stances))
    return used(edits.place_clips(project, [TOY.id(project, "wave")], "body", "gesture", stance))


def fastest(project: Project, action: str) -> float:
    """Return how fast any joint goes while an action plays, m/s."""
    played = project.action(action)
    assert played is not None and project.skeleton is not None
    start = {"body": played.stance}
    plan = plan_performance(project, [Play(id="p", action=action, at=1.0)], 6.0, 1, start, idle=False)
    pose = Evaluator(plan, project).layered(np.arange(360) / 60)
    at = project.skeleton.globals(pose)[1]
    return float(np.linalg.norm(np.diff(at, axis=0), axis=-1).max() * 60)


def test_a_bridge_takes_as_long_as_its_slowest_joint_needs_by_the_clips() -> None:
    project = among_calm_clips(4.0, 0.7)
    after, made = bridge_all(project)
    assert len(made) == 2 and all(x.seconds > 0.7 / SPEED * 1.3 for x in made)
    assert all(0.4 < fastest(after, x.action) < 1.6 * CALM for x in made)


def test_no_bridge_is_made_where_a_joint_had_to_go_faster_than_in_the_clips() -> None:
    _, made = bridge_all(among_calm_clips(1.0, 0.7))
    assert len(made) == 2 and all(x.seconds > 0.7 / SPEED * 1.3 for x in made)  # held for so long
    project = among_calm_clips(1.0, 1.4)
    assert bridge_all(project) == (project, ())
    (line,) = describe_unbridged(project)
    assert "moves at 0.9 m/s, but at most at 0.6 m/s in the clips" in line


def test_between_single_poses_there_is_nothing_to_blend() -> None:
    clips = [TOY.clip(name, 1.0, angle).trimmed(0, 1) for name, angle in (("a", 0.0), ("b", 0.8))]
    project = edits.add_clips(Project("p"), [(f"{c.name}.glb", 0, "", c) for c in clips])
    for name in ("a", "b"):
        project = edits.add_stance(project, "arms", name, [TOY.id(project, name)])
    assert bridge_all(project) == (project, ()) and find_missing_bridges(project) == []
    assert bridge_stance(project, next(iter(project.graphs["arms"].stances))) == (project, ())


@pytest.mark.parametrize(("start", "end"), [(0.0, 0.3), (0.1, 0.4), (1.9, 2.2), (3.6, 4.0)])
def test_a_bridge_between_moments_holds_one_of_them_and_shows_nothing_else_of_its_clip(
    start: float, end: float
) -> None:
    project = stances(1, seconds=0.5)
    wave = TOY.clip("wave", 4.0, ANGLES[2], swing=1.5)
    project = edits.add_clips(project, [("wave.glb", 0, "", wave)])
    project = edits.add_stance(project, "arms", "held", [TOY.id(project, "wave")])
    held = list(project.graphs["arms"].actions)[-1]
    project = edits.update_actions(project, [held], timing={"start": start, "end": end, "loop": True})
    after, made = bridge_all(used(project))
    into, out = (after.action(x.action) for x in made)
    assert into is not None and out is not None and into.timing.end is not None
    assert into.timing.blend_in > 2 * into.timing.blend_out > 0 and out.timing.blend_in > 0
    copy = after.clips[into.clip]
    assert copy.name == "held, held" and copy.path == "wave.glb" and copy.motion is not None
    played = copy.motion.pose_at(np.linspace(*after.span(into), 20)).rotations
    moment = wave.pose_at((start + end) / 2).rotations
    assert np.abs(played - moment).max() < 2e-3
    assert len(after.clips) <= len(project.clips) + 2  # each is held where it blends in
    assert not [p for p in check_project(after) if p.action in (into.id, out.id)]


def shifted_talkers(metres: float, held: bool) -> Project:
    """Two stances whose bodies stand apart, the second held in the first frame of a gesture, or with a loop
    of its own; in each, gestures of a body that hardly goes over the floor.
    """
    names = ("one", "other")
    clips = [TOY.clip("one", 4.0, 0.0, swing=0.02), moved(metres)(TOY.clip("other", 4.0, 0.0, swing=0.02))]
    clips += [TOY.clip("one talks", 3.0, 0.0, swing=1.2)]
    clips += [moved(metres)(TOY.clip("other talks", 3.0, 0.0, swing=1.2))]
    project = edits.add_clips(Project("p"), [(f"{c.name}.glb", 0, "", c) for c in clips])
    clip_of = {entry.name: ident for ident, entry in project.clips.items()}
    for n, name in enumerate(names):
        loop = clip_of["other talks" if held and n else name]
        project = edits.add_stance(project, "body", name, [loop])
        stance = list(project.graphs["body"].stances)[-1]
        if held and n:
            rest = list(project.graphs["body"].actions)[-1]
            project = edits.update_actions(project, [rest], timing={"start": 0.0, "end": 0.0})
        project = edits.place_clips(project, [clip_of[f"{name} talks"]], "body", "gesture", stance)
    return project


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize("metres", [0.06, 0.12, 0.2])
def test_a_bridge_shifts_the_body_no_faster_than_the_clips_do_and_shows_no_gesture(
    metres: float, held: bool
) -> None:
    after, made = bridge_all(shifted_talkers(metres, held))
    assert len(made) == 2 and describe_unbridged(after) == []
    for bridge in made:
        played = after.action(bridge.action)
        assert played is not None and after.skeleton is not None
        start = {"body": played.stance}
        asked = [Play(id="p", action=bridge.action, at=1.0)]
        plan = plan_performance(after, asked, 8.0, 1, start, idle=False)
        pose = Evaluator(plan, after).layered(np.arange(480) / 60)
        at = after.skeleton.globals(pose)[1]
        hips = np.linalg.norm(np.diff(at[:, 0][:, (0, 2)], axis=0), axis=-1) * 60
        assert hips.max() < 1.1 * SHIFT
        hand = after.skeleton.names.index("LeftHand")
        around = at[:, hand] - at[:, 0]
        assert np.ptp(around, axis=0).max() < 0.1  # the gesture's swing would be wider


def test_two_bridges_by_one_moment_share_the_copy_that_is_held() -> None:
    project = shifted_talkers(0.1, True)
    after, made = bridge_all(project)
    clips = {played.clip for x in made if (played := after.action(x.action)) is not None}
    assert len(after.clips) - len(project.clips) == len(clips - project.clips.keys()) <= 2
    assert bridge_all(after) == (after, ())


@pytest.mark.nightly
@given(graphs, st.data())
def test_one_stance_is_joined_and_the_others_keep_their_troubles(
    drawn: tuple[int, list[tuple[int, int]]], data: st.DataObject
) -> None:
    project = stances(*drawn)
    ids = list(project.graphs["arms"].stances)
    if len(ids) < 2:
        return
    chosen = data.draw(st.sampled_from(ids))
    after, made = bridge_stance(project, chosen)
    about = [p for p in check_project(after) if p.stance == chosen and p.code in ("unreachable", "dead-end")]
    assert not about and all(chosen in (x.start, x.end) for x in made)
    before = {(p.code, p.stance) for p in check_project(project) if p.code in ("unreachable", "dead-end")}
    assert bool(made) >= any(stance == chosen for _, stance in before)
    assert {
        (p.code, p.stance) for p in check_project(after) if p.code in ("unreachable", "dead-end")
    } <= before
    assert bridge_stance(after, chosen) == (after, ())


@pytest.mark.nightly
@pytest.mark.parametrize("name", ["standing talker", "sitting without legs", "numbers of unseen stances"])
def test_labelled_takes_that_lack_transitions_become_whole(name: str) -> None:
    made = named(name)
    project = accept(made.project, propose(made.project)).project
    after, bridges = bridge_all(project)
    assert find_missing_bridges(project) and bridges and not find_missing_bridges(after)
    mine = {x.action for x in bridges}
    assert not [p for p in check_project(after) if p.action in mine or p.code in ("unreachable", "dead-end")]
    assert len(describe_bridges(after, bridges)) == len(bridges)
    assert np.isfinite([x.metres for x in bridges]).all()
