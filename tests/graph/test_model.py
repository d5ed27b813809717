"""The values of a project: ids, spans, and an index that is patched as if it had been built again."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import KINDS, LAYERS, PARTS, REACH, Action, ClipEntry, MetaGraph, Project, Timing
from metagraph.motion.contact_spans import ContactKey, ContactSpan

KEY = ContactKey(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def fresh(graph: MetaGraph) -> MetaGraph:
    """The same graph with nothing derived yet."""
    return MetaGraph(graph.layer, graph.stances, graph.actions, graph.start, graph.weights)


def assert_derived_as_if_anew(project: Project) -> None:
    for layer in LAYERS:
        graph = project.graphs[layer]
        assert dict(graph.index) == dict(fresh(graph).index)
        assert dict(graph.uses) == dict(fresh(graph).uses)
        assert dict(graph.into) == dict(fresh(graph).into)
        assert dict(graph.touched) == dict(fresh(graph).touched)
        assert all(bucket for bucket in graph.index.values()), "no empty buckets"


def test_an_empty_project_has_three_empty_layers() -> None:
    project = Project()
    assert list(project.graphs) == ["body", "arms", "head"]
    assert (
        list(project.actions()) == []
        and project.action("a1") is None
        and project.stance("s1") is None
        and project.stance(None) is None
    )
    assert len(project.uses) == 0 and "c1" not in project.uses and project.uses.get("c1", ()) == ()
    with pytest.raises(KeyError):
        project.uses["c1"]


def test_values_cannot_be_changed(toy: Any) -> None:
    project = toy.project()
    with pytest.raises(FrozenInstanceError):
        project.name = "other"
    with pytest.raises(FrozenInstanceError):
        next(iter(project.actions())).likelihood = 2
    with pytest.raises(TypeError):
        project.graphs["arms"].index["s", "gesture"] = ()


def test_weights_are_the_papers_until_changed() -> None:
    graph = MetaGraph("body")
    assert (
        [graph.weight(part) for part in PARTS] == [REACH["body"][part] for part in PARTS] == [1, 1, 0, 1, 1]
    )
    assert MetaGraph("arms", weights={"legs": 0.5}).weight("legs") == 0.5


@pytest.mark.parametrize(
    ("timing", "expected"),
    [
        (Timing(), (0, 2)),
        (Timing(0.5, 1.5), (0.5, 1.5)),
        (Timing(-1, 9), (0, 2)),
        (Timing(1.5, 0.5), (1.5, 1.5)),
        (Timing(5, None), (2, 2)),
    ],
)
def test_what_plays_stays_inside_the_clip_and_never_ends_before_it_starts(
    timing: Timing, expected: tuple[float, float]
) -> None:
    project = Project(clips={"c1": ClipEntry("c1", "clip", "clip.glb", frames=61, fps=30)})
    action = Action("a1", "c1", "gesture", "arms", "s1", "clip", timing=timing)
    assert project.span(action) == expected
    assert project.span(replace(action, clip="lost")) == (min(max(0, timing.start), 0), 0)


def test_a_clip_of_no_frames_has_no_duration() -> None:
    assert ClipEntry("c1", "clip", "clip.glb").duration == 0


def test_uses_reach_over_layers_in_order(toy: Any) -> None:
    project = toy.project()
    clip = toy.id(project, "rest beat lf")
    clip = project.action(clip).clip
    head = edits.add_stance(project, "head", "still", [clip])
    assert [a.layer for a in head.uses[clip]] == ["arms", "head"]
    assert [a.layer for a in project.uses[clip]] == ["arms"]
    assert set(head.uses) == {a.clip for a in head.actions()} and len(head.uses) == len(set(head.uses))


@st.composite
def steps(draw: st.DrawFn) -> list[tuple[Any, ...]]:
    pick = st.integers(0, 30)
    one = st.one_of(
        st.tuples(st.just("place"), pick, st.sampled_from(LAYERS), st.sampled_from(KINDS), pick, pick),
        st.tuples(
            st.just("move"), st.lists(pick, min_size=1, max_size=4), st.sampled_from(KINDS), pick, pick
        ),
        st.tuples(st.just("remove"), st.lists(pick, max_size=4)),
        st.tuples(st.just("update"), st.lists(pick, max_size=4), st.floats(0.1, 5)),
        st.tuples(st.just("touch"), st.lists(pick, max_size=4), st.lists(st.sampled_from("abc"), max_size=3)),
        st.tuples(st.just("reclip"), pick, pick),
        st.tuples(st.just("stance"), st.sampled_from(LAYERS), pick),
        st.tuples(st.just("drop stance"), pick),
        st.tuples(st.just("drop clip"), pick),
    )
    return draw(st.lists(one, max_size=14))


def apply(project: Project, step: tuple[Any, ...]) -> Project:
    """One edit on whatever is there; numbers choose among the things there are."""
    actions, clips = [a.id for a in project.actions()], list(project.clips)
    stances = [s.id for layer in LAYERS for s in project.graphs[layer].stances.values()]

    def some(of: list[str], n: int) -> str:
        return of[n % len(of)] if of else "none"

    word, *rest = step
    if word == "place":
        own = list(project.graphs[rest[1]].stances)
        return edits.place_clips(
            project, [some(clips, rest[0])], rest[1], rest[2], some(own, rest[3]), some(own, rest[4])
        )
    if word == "move":
        target = project.stance(some(stances, rest[2]))
        own = list(project.graphs[target.layer].stances) if target else []
        return edits.move_actions(
            project, [some(actions, n) for n in rest[0]], rest[1], some(stances, rest[2]), some(own, rest[3])
        )
    if word == "remove":
        return edits.remove_actions(project, [some(actions, n) for n in rest[0]])
    if word == "update":
        return edits.update_actions(project, [some(actions, n) for n in rest[0]], likelihood=rest[1])
    if word == "touch":
        spans = tuple(ContactSpan("left", "palm", to, 0.0, 1.0, (KEY,)) for to in rest[1])
        return edits.update_actions(project, [some(actions, n) for n in rest[0]], contacts=spans)
    if word == "reclip":
        return edits.update_actions(project, [some(actions, rest[0])], clip=some(clips, rest[1]))
    if word == "stance":
        return edits.add_stance(project, rest[0], "new", [some(clips, rest[1])])
    if word == "drop stance":
        return edits.remove_stance(project, some(stances, rest[0]))
    return edits.remove_clips(project, [some(clips, rest[0])])


@pytest.mark.nightly
@given(steps())
@settings(max_examples=60, deadline=None)
def test_after_any_edits_the_index_is_what_building_it_anew_gives_and_old_projects_are_as_they_were(
    steps: list[tuple[Any, ...]],
) -> None:
    project = PROJECT
    history = [project]
    for layer in LAYERS:
        _ = project.graphs[layer].index, project.graphs[layer].uses, project.graphs[layer].touched
    for step in steps:
        try:
            after = apply(project, step)
        except EditError:
            continue
        assert_derived_as_if_anew(after)
        history.append(after)
        project = after
    snapshots = [(fresh(p.graphs["arms"]).index, p.graphs["arms"].index) for p in history]
    assert all(dict(anew) == dict(kept) for anew, kept in snapshots), "an edit changed an earlier project"
    assert history[0] == PROJECT_AGAIN


PROJECT = PROJECT_AGAIN = Project()


@pytest.fixture(autouse=True, scope="module")
def _project(toy: Any) -> None:
    global PROJECT, PROJECT_AGAIN
    PROJECT, PROJECT_AGAIN = toy.project(), toy.project()
