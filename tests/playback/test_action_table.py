"""The project as a table of texts."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.graph import edits
from metagraph.graph.editing.half_labels import find_half_label
from metagraph.playback.action_table import (
    COLUMNS,
    ActionRow,
    can_write,
    find_row,
    list_rows,
    parse_number,
    read_cell,
    write_cells,
)


@pytest.fixture
def project(toy):
    return edits.add_clips(toy.project(), [("free.glb", 0, "", toy.clip("free", 1.0))])


def ident(project, name):
    return next(a.id for a in project.actions() if a.name == name)


def text(project, row, column):
    return read_cell(project, find_row(project, row), column)


def test_each_action_and_each_clip_without_one_has_a_row(project):
    rows = list_rows(project)
    assert {r.ident for r in rows if r.action is not None} == {a.id for a in project.actions()}
    assert [project.clips[r.clip].name for r in rows if r.action is None] == ["free"]
    assert all(find_row(project, r.ident) == r for r in rows)
    assert find_row(project, "gone") is None
    assert find_row(project, next(iter(project.uses))) is None  # it has the rows of its actions


def test_a_cell_says_what_its_action_is(project):
    beat = ident(project, "rest beat lf")
    row = {c: text(project, beat, c) for c in COLUMNS}
    assert row["kind"] == "gesture"
    assert (row["layer"], row["stance"], row["end_stance"], row["limb"]) == ("arms", "rest", "", "left")
    assert (row["start"], row["end"], row["blend_in"]) == ("0.00", "0.90", "0.20")
    assert (row["likelihood"], row["cooldown"]) == ("1", "0")
    assert text(project, ident(project, "rest to up"), "end_stance") == "up"
    assert text(project, ident(project, "rest loop"), "earliest_exit") == ""


def test_writing_what_every_cell_says_changes_nothing(project):
    cells = {
        (row.ident, column): read_cell(project, row, column)
        for row in list_rows(project)
        for column in COLUMNS
        if can_write(row, column) and column != "prominence"
    }
    written = write_cells(project, cells)
    assert written.refused == {}
    assert written.project == project


def test_each_field_is_set_alone_for_many_rows_and_leaves_the_others(project):
    rows = [ident(project, name) for name in ("rest short", "rest wave rt", "up beat")]
    before = [project.action(i) for i in rows]
    written = write_cells(project, {(i, "kind"): "fidget" for i in rows})
    assert written.refused == {}
    assert [replace(written.project.action(i), kind="gesture") for i in rows] == before
    written = write_cells(project, {(i, "stance"): "far" for i in rows})
    assert {text(written.project, i, "stance") for i in rows} == {"far"}
    assert {text(written.project, i, "kind") for i in rows} == {"gesture"}


@pytest.mark.parametrize(
    ("column", "typed", "shown"),
    [
        ("name", "  new   name ", "new name"),
        ("limb", "both", "both"),
        ("tags", "Hello, positive,hello", "hello, positive"),
        ("blend_in", "0,1 s", "0.10"),
        ("start", ".2", "0.20"),
        ("end", "0.7s", "0.70"),
        ("end", "", "0.90"),
        ("earliest_exit", "0.5", "0.50"),
        ("likelihood", "2.5", "2.5"),
        ("cooldown", "30", "30"),
        ("prominence", "40 %", "40"),
        ("layer", "arms", "arms"),
    ],
)
def test_a_text_becomes_the_value(project, column, typed, shown):
    beat = ident(project, "rest beat lf")
    written = write_cells(project, {(beat, column): typed})
    assert written.refused == {}
    assert written.cut == ()
    assert text(written.project, beat, column) == shown


@pytest.mark.parametrize(
    ("name", "column", "typed", "why"),
    [
        ("rest beat lf", "kind", "gestur", "'gestur' is none of stance, gesture, fidget, transition"),
        ("rest beat lf", "kind", "transition", "write the stance, and the action becomes a transition"),
        ("rest to up", "end_stance", "", "write the stance, and the action becomes a transition"),
        ("rest to up", "end_stance", "rest", "must end in another stance"),
        ("rest to up", "end_stance", "nowhere", "no stance 'nowhere'"),
        ("rest beat lf", "stance", "nowhere", "no stance 'nowhere'"),
        ("rest beat lf", "stance", "", "cannot be empty"),
        ("rest beat lf", "layer", "head", "the head layer has no stance 'rest'"),
        ("rest beat lf", "clip", "x", "renamed in the library"),
        ("rest beat lf", "start", "early", "'early' is not a number"),
        ("rest beat lf", "start", "-1", "too small"),
        ("rest beat lf", "end", "99", "after the clip's end, 0.90 s"),
        ("rest beat lf", "start", "0.9", "not before its end"),
        ("rest beat lf", "end", "0", "not after its start"),
        ("rest beat lf", "earliest_exit", "7", "after the clip's end"),
        ("rest beat lf", "likelihood", "0", "too small"),
        ("rest beat lf", "prominence", "120", "over 100 %"),
        ("rest loop", "earliest_exit", "1", "no such value"),
        ("rest loop", "limb", "left", "no such value"),
    ],
)
def test_what_cannot_be_written_is_refused_with_the_reason_and_changes_nothing(
    project, name, column, typed, why
):
    row = ident(project, name)
    written = write_cells(project, {(row, column): typed})
    assert why in written.refused[row, column]
    assert written.project == project


def test_the_other_cells_are_written_and_long_blends_are_cut_and_reported(project):
    beat, wave = ident(project, "rest beat lf"), ident(project, "rest wave rt")
    written = write_cells(
        project,
        {(beat, "blend_in"): "5", (beat, "kind"): "nod", (wave, "start"): "0.3", ("gone", "name"): "x"},
    )
    assert set(written.refused) == {(beat, "kind"), ("gone", "name")}
    assert written.cut == ((beat, "blend_in"),)
    assert text(written.project, wave, "start") == "0.30"


def test_where_an_action_ends_makes_it_a_transition(project):
    beat = ident(project, "rest beat lf")
    written = write_cells(project, {(beat, "end_stance"): "Far"})
    assert written.refused == {}
    assert (text(written.project, beat, "kind"), text(written.project, beat, "end_stance")) == (
        "transition",
        "far",
    )
    back = write_cells(written.project, {(beat, "kind"): "gesture", (beat, "end_stance"): ""})
    assert back.refused == {}
    assert text(back.project, beat, "end_stance") == ""


def test_a_pasted_table_makes_its_stances_whatever_the_order_of_its_rows(project):
    clip = next(r.ident for r in list_rows(project) if r.action is None)
    beat, loop = ident(project, "rest beat lf"), ident(project, "rest loop")
    cells = {
        (beat, "stance"): "sit",
        (clip, "kind"): "gesture",
        (clip, "stance"): "sit",
        (clip, "limb"): "right",
        (loop, "stance"): "sit",
    }
    for some in (cells, dict(reversed(cells.items()))):
        written = write_cells(project, some)
        assert written.refused == {}
        assert text(written.project, beat, "stance") == text(written.project, loop, "stance") == "sit"
        (action,) = written.project.uses[clip]
        assert (written.project.stance(action.stance).name, action.limb) == ("sit", "right")


def test_a_clip_without_an_action_is_labelled_in_part(project):
    clip = next(r.ident for r in list_rows(project) if r.action is None)
    written = write_cells(project, {(clip, "end_stance"): "up", (clip, "cooldown"): "3"})
    assert find_half_label(written.project, clip).kind == "transition"
    assert "give it a kind and a stance first" in written.refused[clip, "cooldown"]
    assert read_cell(written.project, ActionRow(clip, clip, None), "end_stance") == "up"
    wrong = write_cells(written.project, {(clip, "stance"): "up"})
    assert "another stance" in wrong.refused[clip, "stance"]


@pytest.mark.parametrize(
    ("typed", "value"),
    [("1,5", 1.5), (" 2 s", 2.0), ("40%", 40.0), ("", None), ("nan", None), ("1e99", None), ("x", None)],
)
def test_numbers_are_read_as_people_write_them(typed, value):
    assert parse_number(typed) == value
