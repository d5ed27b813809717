"""Manual state machines: what links stand for, and their edits."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.manual import edits as m
from metagraph.graph.manual.machine import ANY, Condition, Manual, expand_links
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from tests.projects import clip

pytestmark = pytest.mark.usefixtures("numbered_ids")

CLIPS = ("idle", "wave", "nod", "sit")


def project(*names: str) -> Project:
    """States called as their clips, m5 being the first, in the arms layer."""
    empty = edits.add_clips(Project("small"), [(f"{n}.glb", 0, "", clip(n)) for n in CLIPS])
    ids = {e.name: i for i, e in empty.clips.items()}
    return m.add_states(empty, [ids[n] for n in names or CLIPS], "arms")


def linked(*pairs: tuple[str, str]) -> tuple[Project, dict[str, str]]:
    """The four states linked by name, and the ids by name."""
    out = project()
    ids = {s.name: s.id for s in out.manual["arms"].states.values()} | {ANY: ANY}
    for a, b in pairs:
        out = m.add_link(out, "arms", ids[a], ids[b])
    return out, ids


def test_an_empty_machine_reaches_nothing() -> None:
    assert Manual("arms").reachable() == frozenset()
    assert expand_links(Manual("arms")) == frozenset()
    assert Manual("arms").triggers == ()


def test_clips_that_are_dropped_together_stand_in_a_grid_and_the_first_is_the_start() -> None:
    found = project().manual["arms"]
    assert [(s.x, s.y) for s in found.states.values()] == [(0, 0), (m.WIDE, 0), (0, m.HIGH), (m.WIDE, m.HIGH)]
    assert found.start == "m5"
    assert [s.name for s in found.states.values()] == list(CLIPS)


def test_the_first_state_gives_the_base_pose_as_the_first_stance_does() -> None:
    assert project().base.clip == "c1"
    chosen = edits.set_base(
        edits.add_clips(Project(), [(f"{n}.glb", 0, "", clip(n)) for n in CLIPS]), "c3", 2
    )
    assert m.add_states(chosen, ["c1"], "arms").base.clip == "c3"


def test_a_clip_used_twice_gets_a_name_of_its_own() -> None:
    twice = m.add_states(project(), ["c2", "c2"], "arms")
    assert [s.name for s in twice.manual["arms"].states.values()][4:] == ["wave 2", "wave 3"]


@pytest.mark.parametrize(("clips", "words"), [([], "nothing to place"), (["c99"], "not in this project")])
def test_what_cannot_become_a_state_is_refused(clips: list[str], words: str) -> None:
    with pytest.raises(EditError, match=words):
        m.add_states(project(), clips, "arms")


def test_a_clip_of_another_skeleton_is_refused() -> None:
    import numpy as np

    other = Skeleton(("Root",), np.array([-1]), np.array([[0, 0, 0, 1.0]]), np.zeros((1, 3)))
    strange = Clip("strange", other, 30, np.array([[[0, 0, 0, 1.0]]]), np.zeros((1, 1, 3)))
    with pytest.raises(EditError, match="a different skeleton"):
        m.add_states(edits.add_clips(project(), [("strange.glb", 0, "", strange)]), ["c9"], "arms")


def test_a_link_is_taken_when_its_source_has_finished_and_one_from_any_state_waits_for_a_request() -> None:
    out, ids = linked(("idle", "wave"), (ANY, "nod"))
    first, second = out.manual["arms"].links.values()
    assert first.condition == Condition()
    assert second.condition == Condition("request", "nod")
    assert (second.source, second.target) == (ANY, ids["nod"])


@pytest.mark.parametrize(
    ("source", "target", "words"),
    [("m5", ANY, "other way round"), ("m5", "m99", "two states"), ("c1", "m5", "two states")],
)
def test_a_link_that_joins_no_two_states_is_refused(source: str, target: str, words: str) -> None:
    with pytest.raises(EditError, match=words):
        m.add_link(project(), "arms", source, target)


def test_a_link_from_any_state_stands_for_one_from_every_other() -> None:
    out, ids = linked((ANY, "idle"), ("idle", "wave"), ("wave", "wave"))
    a, b = ids["idle"], ids["wave"]
    expected = {(s, a) for s in out.manual["arms"].states if s != a} | {(a, b), (b, b)}
    assert expand_links(out.manual["arms"]) == expected


def test_what_is_reached_only_from_any_state_is_reached() -> None:
    out, ids = linked(("idle", "wave"), (ANY, "nod"))
    assert out.manual["arms"].reachable() == {ids["idle"], ids["wave"], ids["nod"]}


def test_a_state_goes_with_its_links_and_the_start_moves_on() -> None:
    out, ids = linked(("idle", "wave"), ("wave", "idle"), ("wave", "nod"))
    left = m.remove_states(out, [ids["idle"]]).manual["arms"]
    assert left.start == ids["wave"]
    assert [(x.source, x.target) for x in left.links.values()] == [(ids["wave"], ids["nod"])]


def test_removing_what_is_not_there_changes_nothing() -> None:
    out, _ = linked(("idle", "wave"))
    assert m.remove_states(out, ["m99"], ["l99"]) is out


def test_a_clip_goes_with_its_states_and_their_links() -> None:
    out, ids = linked(("idle", "wave"), ("wave", "nod"), ("nod", "idle"))
    left = edits.remove_clips(out, ["c2"]).manual["arms"]
    assert ids["wave"] not in left.states
    assert len(left.links) == 1
    assert edits.remove_clips(m.remove_states(out, [ids["sit"]]), ["c4"]).manual is not None


def test_a_copy_keeps_the_links_among_its_states_only() -> None:
    out, ids = linked(("idle", "wave"), ("wave", "idle"), ("wave", "nod"), (ANY, "wave"))
    out, made = m.paste_states(out, "arms", m.copy_states(out, [ids["idle"], ids["wave"]]), 500, 600)
    found = out.manual["arms"]
    new = [x for x in found.links.values() if x.source in made or x.target in made]
    assert [(x.source, x.target) for x in new] == [made, made[::-1]]
    assert (found.states[made[0]].x, found.states[made[0]].y) == (500, 600)
    assert [found.states[i].name for i in made] == ["idle 2", "wave 2"]


def test_a_copied_request_is_named_after_the_copy() -> None:
    out, ids = linked(("idle", "wave"))
    out = m.update_links(out, [*out.manual["arms"].links], condition={"when": "request"})
    out, _ = m.paste_states(out, "arms", m.copy_states(out, [ids["idle"], ids["wave"]]), 0, 0)
    assert [x.condition.trigger for x in out.manual["arms"].links.values()] == ["wave", "wave 2"]


def test_states_can_be_pasted_into_another_layer() -> None:
    out, ids = linked(("idle", "wave"))
    out, made = m.paste_states(out, "head", m.copy_states(out, ids.values()), 0, 0)
    assert {s.layer for s in out.manual["head"].states.values()} == {"head"}
    assert out.manual["head"].start == made[0]


def test_what_was_copied_can_be_pasted_after_it_was_removed_but_not_without_its_clip() -> None:
    out, ids = linked(("idle", "wave"))
    piece = m.copy_states(out, [ids["wave"]])
    assert m.paste_states(m.remove_states(out, [ids["wave"]]), "arms", piece, 0, 0)[1]
    with pytest.raises(EditError, match="not in this project"):
        m.paste_states(edits.remove_clips(out, ["c2"]), "arms", piece, 0, 0)


def test_a_links_settings_are_pasted_and_each_waits_for_its_own_target() -> None:
    out, _ = linked(("idle", "wave"), ("idle", "nod"), ("wave", "idle"))
    first, *others = out.manual["arms"].links
    out = m.update_links(out, [first], condition={"when": "request"}, exit_time=0.5, blend=0.1)
    out = m.paste_settings(out, others, out.link(first))  # type: ignore[arg-type]
    assert [(x.condition.trigger, x.exit_time, x.blend) for x in out.manual["arms"].links.values()] == [
        ("wave", 0.5, 0.1), ("nod", 0.5, 0.1), ("idle", 0.5, 0.1),
    ]  # fmt: skip


def test_a_trigger_of_its_own_is_pasted_as_it_is() -> None:
    out, _ = linked(("idle", "wave"), ("idle", "nod"))
    first, second = out.manual["arms"].links
    out = m.update_links(out, [first], condition={"when": "request", "trigger": "greet"})
    assert m.paste_settings(out, [second], out.link(first)).link(second).condition.trigger == "greet"  # type: ignore[arg-type,union-attr]


def test_an_edit_that_changes_nothing_is_no_edit() -> None:
    out, ids = linked(("idle", "wave"))
    assert m.update_states(out, [ids["idle"], "m99"], loop=False) is out
    assert m.update_links(out, ["l99", *out.manual["arms"].links], blend=0.25) is out


@pytest.mark.parametrize("name", ["", "  \n"])
def test_names_and_triggers_need_a_letter(name: str) -> None:
    out, ids = linked(("idle", "wave"))
    with pytest.raises(EditError, match="letter"):
        m.update_states(out, [ids["idle"]], name=name)
    with pytest.raises(EditError, match="letter"):
        m.update_links(out, [*out.manual["arms"].links], condition={"trigger": name})


def test_nodes_move_the_one_for_any_state_too() -> None:
    out, ids = linked()
    found = m.move_nodes(out, "arms", {ids["nod"]: (7, 8), ANY: (9, 10), "m99": (1, 1)}).manual["arms"]
    assert (found.states[ids["nod"]].x, found.any_x, found.any_y) == (7, 9, 10)
    assert replace(found.states[ids["idle"]]) == out.manual["arms"].states[ids["idle"]]


def test_the_start_is_one_of_the_states() -> None:
    out, ids = linked()
    assert m.set_start_state(out, ids["sit"]).manual["arms"].start == ids["sit"]
    with pytest.raises(EditError, match="no longer"):
        m.set_start_state(out, "m99")


def test_states_and_links_are_found_by_id_whatever_their_layer() -> None:
    out, ids = linked(("idle", "wave"))
    assert out.state(ids["nod"]).name == "nod"  # type: ignore[union-attr]
    assert out.link(next(iter(out.manual["arms"].links))) is not None
    assert out.state("l99") is None
    assert out.link(None) is None
