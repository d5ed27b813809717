"""What actions are called where the place says the rest."""

from __future__ import annotations

import pytest

from app.look.names import drop_common_start, make_readable_name, name_node_rows, name_rows, tell_apart
from metagraph.graph import edits


@pytest.mark.parametrize(
    ("name", "stance", "limb", "words"),
    [
        ("", "idle", None, ""),
        ("_", "", None, "_"),
        ("idle", "idle", None, "idle"),
        ("hands_at_sides__beat_small_rt_01", "hands at sides", "right", "beat small R 01"),
        ("hands_at_sides__beat_small_rt_01", "hands at sides", "left", "beat small rt 01"),
        ("beat_small_rt", "", None, "beat small rt"),
        ("shrug_bt_01", "idle", "both", "shrug 01"),
        ("left", "idle", "left", "left"),
        ("Wave Left", "idle", "left", "Wave L"),
        ("ChrBrad@Idle01_Scratch01", "idle 1", "both", "Scratch01"),
    ],
)
def test_a_name_is_read_without_what_the_place_says(name, stance, limb, words):
    assert make_readable_name(name, stance, limb) == words


def test_numbers_of_takes_go_where_nothing_else_has_the_name():
    assert tell_apart([]) == []
    assert tell_apart(["shrug 01", "nod 01", "nod 02", "07", "wave (2)"]) == [
        "shrug",
        "nod 01",
        "nod 02",
        "07",
        "wave",
    ]
    assert tell_apart(["nod", "nod 01"]) == ["nod", "nod 01"]


def test_two_ways_to_one_stance_are_told_apart(toy):
    project = toy.project()
    rest = toy.id(project, "rest")
    there = project.graphs["arms"].of(rest, "transition")
    assert list(name_rows(project, there).values()) == [project.stance(a.end_stance).name for a in there]
    clip, end = there[0].clip, there[0].end_stance
    project = edits.place_clips(project, [clip], "arms", "transition", rest, end)
    names = list(name_rows(project, project.graphs["arms"].of(rest, "transition")).values())
    assert all(names) and any(":" in n for n in names)


def test_the_number_of_a_stance_is_no_takes_number(toy):
    project = toy.project()
    rest = toy.id(project, "rest")
    way = project.graphs["arms"].of(rest, "transition")[0]
    project = edits.rename_stance(project, way.end_stance, "idle 3")
    assert name_rows(project, [way]) == {way.id: "idle 3"}
    assert name_rows(project, project.graphs["arms"].of(rest, "transition"))[way.id] == "idle 3"


def test_a_stance_called_after_its_loop_is_left_out_by_what_all_share(toy):
    project = toy.project()
    clips = list(project.clips)
    project = edits.add_stance(project, "arms", "sitting_low__loop", [clips[0]])
    stance = list(project.graphs["arms"].stances)[-1]
    project = edits.place_clips(project, clips[1:3], "arms", "gesture", stance)
    graph = project.graphs["arms"]
    (loop,) = graph.of(stance, "stance")
    one, two = graph.of(stance, "gesture")
    names = {loop.id: "sitting_low__loop", one.id: "sitting_low__nod_01", two.id: "sitting_low__wave_01"}
    project = edits.update_each(project, {i: {"name": n} for i, n in names.items()})
    assert list(name_node_rows(project, "arms", stance, "gesture").values()) == ["nod", "wave"]
    project = edits.update_actions(project, [two.id], name="wave")
    told = list(name_node_rows(project, "arms", stance, "gesture").values())
    assert told == ["sitting low nod", "wave"], "what not all share may tell something"


def test_a_nodes_names_follow_its_actions_and_its_stance(toy):
    project = toy.project()
    rest = toy.id(project, "rest")
    first = name_node_rows(project, "arms", rest, "gesture")
    assert name_node_rows(project, "arms", rest, "gesture") is first
    ident = next(iter(first))
    project = edits.update_actions(project, [ident], name="something_else_07")
    assert name_node_rows(project, "arms", rest, "gesture")[ident] == "something else"


def test_names_of_a_node_are_made_anew_only_where_something_is_called_otherwise(toy):
    project = toy.project()
    layer = "arms"
    action = next(a for a in project.graphs[layer].actions.values() if a.kind == "gesture")
    stance = action.stance

    def names(of):
        return name_node_rows(of, layer, stance, "gesture")

    kept = names(project)
    louder = edits.update_actions(project, (action.id,), likelihood=2.5)
    assert names(louder) is kept
    assert names(edits.rename_stance(louder, stance, "elsewhere")) is not kept
    gone = edits.remove_actions(project, (action.id,))
    assert action.id in names(project) and action.id not in names(gone)


@pytest.mark.parametrize(
    ("names", "short"),
    [
        (["Rachel@Idle01_Nod", "Rachel@Idle02_Nod", "Rachel@Guitar"], ["Idle01_Nod", "Idle02_Nod", "Guitar"]),
        (["idle_nod", "idle_wave"], ["nod", "wave"]),
        (["nodding", "nods"], ["nodding", "nods"]),
        (["set_wave_01", "set_wave_02"], ["wave_01", "wave_02"]),
        (["Idle.001", "Idle.002"], ["Idle.001", "Idle.002"]),
        (["idle_", "idle_nod"], ["idle_", "idle_nod"]),
        (["idle nod"], ["idle nod"]),
        ([], []),
    ],
)
def test_what_all_names_begin_with_is_left_out_up_to_a_mark_between_words(names, short) -> None:
    assert drop_common_start(names) == short
