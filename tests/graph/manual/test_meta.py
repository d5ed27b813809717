"""The meta-graph a manual machine amounts to: which states become what, and how far the two differ."""

from __future__ import annotations

import pytest

from metagraph.graph import edits
from metagraph.graph.expand import list_connections
from metagraph.graph.manual import edits as m
from metagraph.graph.manual.machine import ANY
from metagraph.graph.manual.meta import as_meta, describe_meta_differences, is_only_manual
from metagraph.graph.model import Project
from tests.projects import clip

pytestmark = pytest.mark.usefixtures("numbered_ids")

CLIPS = ("stand", "sway", "sit", "wave", "nod", "down", "up", "look")


def drawn(loops: tuple[str, ...], *links: str) -> tuple[Project, dict[str, str]]:
    """Links as "stand>wave", with "!" behind those taken when finished; all others wait for a request."""
    project = edits.add_clips(Project("drawn"), [(f"{n}.glb", 0, "", clip(n)) for n in CLIPS])
    ids = {e.name: i for i, e in project.clips.items()}
    names = list(dict.fromkeys([*loops, *(n for x in links for n in x.strip("!").split(">") if n != ANY)]))
    project = m.add_states(project, [ids[n] for n in names], "arms")
    states = {s.name: s.id for s in project.manual["arms"].states.values()} | {ANY: ANY}
    project = m.update_states(project, [states[n] for n in loops], loop=True)
    for text in links:
        a, b = text.strip("!").split(">")
        project = m.add_link(project, "arms", states[a], states[b])
        last = [*project.manual["arms"].links][-1]
        project = m.update_links(
            project, [last], condition={"when": "finished" if text.endswith("!") else "request"}
        )
    return project, states


def kinds(project: Project) -> dict[str, tuple[str, ...]]:
    out = {}
    for a in project.actions():
        names = [s.name for i in (a.stance, a.end_stance) if (s := project.stance(i)) is not None]
        out[a.name] = (a.kind, *names)
    return out


def named(pairs: frozenset[tuple[str, str]], states: dict[str, str]) -> set[str]:
    names = {i: n for n, i in states.items()}
    return {f"{names[a]}>{names[b]}" for a, b in pairs}


def test_an_empty_project_amounts_to_itself() -> None:
    assert as_meta(Project()) == (Project(), frozenset(), frozenset())
    assert describe_meta_differences(Project()) == []
    assert not is_only_manual(Project())


def test_loops_gestures_fidgets_and_transitions_are_told_apart_by_their_links() -> None:
    project, states = drawn(
        ("stand", "sit"),
        "stand>wave",
        "wave>stand!",
        "stand>look!",
        "look>stand!",
        "stand>down",
        "down>sit!",
        "sit>up",
        "up>stand!",
    )
    made, missing, extra = as_meta(project)
    assert kinds(made) == {
        "stand": ("stance", "stand"),
        "sit": ("stance", "sit"),
        "wave": ("gesture", "stand"),
        "look": ("fidget", "stand"),
        "down": ("transition", "stand", "sit"),
        "up": ("transition", "sit", "stand"),
    }
    assert extra == frozenset()
    assert named(missing, states) == {
        "wave>look", "look>wave", "wave>down", "look>down", "up>wave", "up>look", "up>down", "down>up",
    }  # fmt: skip
    assert made.graphs["arms"].start == next(
        s.id for s in made.graphs["arms"].stances.values() if s.name == "stand"
    )
    assert made.manual == {}
    assert is_only_manual(project)


def test_a_machine_drawn_as_the_meta_graph_expands_differs_in_nothing() -> None:
    project, _ = drawn(
        ("stand", "sit"), "stand>wave", "wave>stand!", "stand>down", "down>sit!", "sit>up", "up>stand!"
    )
    made = as_meta(project)[0]
    again, states = edits.add_clips(made, ()), {a.name: a.id for a in made.actions()}
    again = m.add_states(again, [a.clip for a in made.actions()], "arms")
    ids = {s.name: s.id for s in again.manual["arms"].states.values()}
    again = m.update_states(again, [ids["stand"], ids["sit"]], loop=True)
    of = {a: ids[n] for n, a in states.items()}
    for c in list_connections(made, made.graphs["arms"]):
        again = m.add_link(again, "arms", of[c.source], of[c.target])
    back, missing, extra = as_meta(again)
    assert (missing, extra) == (frozenset(), frozenset())
    assert {n: k[1:] for n, k in kinds(back).items()} == {n: k[1:] for n, k in kinds(made).items()}
    assert describe_meta_differences(again) == []


def test_loops_that_lead_to_each_other_and_to_the_same_things_are_of_one_stance() -> None:
    project, _ = drawn(
        ("stand", "sway"), "stand>sway", "sway>stand", "stand>wave", "sway>wave", "wave>stand!", "wave>sway!"
    )
    made = as_meta(project)[0]
    assert len(made.graphs["arms"].stances) == 1
    assert kinds(made)["sway"] == ("stance", "stand")


def test_loops_that_lead_elsewhere_are_stances_of_their_own_and_the_link_between_is_lost() -> None:
    project, states = drawn(
        ("stand", "sit"), "stand>sit", "sit>stand", "stand>wave", "wave>stand!", "sit>nod", "nod>sit!"
    )
    made, _, extra = as_meta(project)
    assert len(made.graphs["arms"].stances) == 2
    assert named(extra, states) == {"stand>sit", "sit>stand"}
    assert any("drawn but lost" in words for words in describe_meta_differences(project))


def test_a_state_without_a_way_back_is_a_gesture_whose_way_back_is_missing() -> None:
    project, states = drawn(("stand",), "stand>wave")
    made, missing, _ = as_meta(project)
    assert kinds(made)["wave"] == ("gesture", "stand")
    assert named(missing, states) == {"wave>stand"}


def test_a_state_behind_another_belongs_to_the_same_stance() -> None:
    project, _ = drawn(("stand",), "stand>wave", "wave>nod!", "nod>stand!")
    assert kinds(as_meta(project)[0])["nod"][1:] == ("stand",)


def test_what_nothing_joins_to_a_loop_is_left_out_and_that_is_said() -> None:
    project, _ = drawn(("stand",), "stand>wave", "wave>stand!", "nod>look!")
    assert set(kinds(as_meta(project)[0])) == {"stand", "wave"}
    assert any(words.startswith("2 states ") for words in describe_meta_differences(project))


def test_without_any_loop_the_start_is_the_stance() -> None:
    project, _ = drawn((), "stand>wave!", "wave>stand!")
    assert kinds(as_meta(project)[0]) == {"stand": ("stance", "stand"), "wave": ("fidget", "stand")}


def test_a_link_from_any_state_enters_from_every_stance_but_the_way_back_says_whose_gesture_it_is() -> None:
    project, _ = drawn(("stand", "sit"), "any>wave", "wave>sit!", "stand>down", "down>sit!")
    assert kinds(as_meta(project)[0])["wave"] == ("gesture", "sit")


def test_times_come_from_the_links() -> None:
    project, states = drawn(("stand",), "stand>wave", "wave>stand!")
    first, last = project.manual["arms"].links
    project = m.update_links(m.update_links(project, [first], blend=0.15), [last], blend=0.4, exit_time=0.6)
    project = m.update_states(project, [states["wave"]], start=0.1, end=0.9)
    timing = next(a for a in as_meta(project)[0].actions() if a.name == "wave").timing
    assert (timing.start, timing.end, timing.blend_in, timing.blend_out, timing.earliest_exit) == (
        0.1,
        0.9,
        0.15,
        0.4,
        0.6,
    )


def test_a_trigger_that_is_not_the_states_name_becomes_a_tag() -> None:
    project, _ = drawn(("stand",), "stand>wave", "wave>stand!")
    first = next(iter(project.manual["arms"].links))
    project = m.update_links(project, [first], condition={"trigger": "greet"})
    assert next(a for a in as_meta(project)[0].actions() if a.name == "wave").tags == ("greet",)


def test_layers_without_a_machine_stay_as_they_are() -> None:
    project, _ = drawn(("stand",), "stand>wave", "wave>stand!")
    project = edits.add_stance(project, "head", "ahead", ["c1"])
    assert as_meta(project)[0].graphs["head"] is project.graphs["head"]
    assert not is_only_manual(project)
