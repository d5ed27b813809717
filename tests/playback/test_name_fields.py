"""Fields of labels read out of clips' names by a pattern."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project
from metagraph.playback.action_table import list_rows, write_cells
from metagraph.playback.name_fields import NAME_FIELDS, fill_from_names, parse_name_pattern


def make_project(toy, names):
    """Return a project whose clips have no action yet."""
    return edits.add_clips(Project(), [(f"{name}.glb", 0, "", toy.clip(name)) for name in names])


def test_fields_are_what_stands_between_the_rest_of_a_name():
    pattern = parse_name_pattern("{stance}__to__{end}")
    assert pattern.read("hands_at_sides__to__on_hips") == {
        "stance": "hands at sides",
        "end_stance": "on hips",
    }
    assert pattern.read("hands_at_sides__stance") is None


def test_a_star_is_anything_and_capitals_do_not_matter():
    assert parse_name_pattern("anim_{Stance}_*").read("ANIM_Sitting_wave_02") == {"stance": "Sitting"}


def test_other_signs_are_as_they_stand():
    assert parse_name_pattern("({stance})+*").read("(sit)+wave") == {"stance": "sit"}
    assert parse_name_pattern("a.{stance}").read("abstand") is None


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("wave_*", "at least one field"),
        ("{pose}_*", r"\{pose\} is no field"),
        ("{stance}_{stance}", "twice"),
        ("{stance}{end}", "nothing tells where"),
        ("{stance}*{end}{limb}", "nothing tells where"),
    ],
)
def test_a_pattern_that_cannot_be_read_is_refused_with_what_to_write(text, words):
    with pytest.raises(EditError, match=words):
        parse_name_pattern(text)


def test_nothing_but_blanks_is_no_field():
    assert parse_name_pattern("{stance}-{end}").read("___-sit") is None


@given(st.text(max_size=40))
def test_any_text_is_read_or_refused(text):
    try:
        pattern = parse_name_pattern(text)
    except EditError:
        return
    assert set(pattern.columns) <= set(NAME_FIELDS.values())
    pattern.read("sit__to__stand_01")


@given(
    st.text("abcxyz_ ", min_size=1, max_size=9).filter(str.strip),
    st.text("abcxyz_ ", min_size=1, max_size=9).filter(str.strip),
)
def test_what_was_put_together_is_taken_apart_again(first, second):
    fields = parse_name_pattern("{stance}=>{end}").read(f"{first}=>{second}")
    words = [" ".join(text.replace("_", " ").split()) for text in (first, second)]
    assert fields == (dict(zip(("stance", "end_stance"), words, strict=True)) if all(words) else None)


def test_transitions_are_placed_and_end_in_the_stance_whose_name_ends_so(toy):
    project = make_project(
        toy, ["body_left__stance", "body_right__stance", "body_left__to__right", "body_right__to__left"]
    )
    rows = list_rows(project)
    filled = fill_from_names(project, rows, parse_name_pattern("{stance}__to__{end}"))
    assert {text for (_, column), text in filled.items() if column == "end_stance"} == {
        "body right",
        "body left",
    }
    project = write_cells(project, filled).project
    loops = fill_from_names(project, list_rows(project), parse_name_pattern("{stance}__stance"))
    loops |= {
        (ident, column): text
        for ident, _ in list(loops)
        for column, text in (("kind", "stance"), ("layer", "body"))
    }
    project = write_cells(project, loops).project
    found = {a.name: (project.stance(a.stance).name, a.kind) for a in project.actions()}
    assert found["body_left__to__right"] == ("body left", "transition")
    assert len(found) == 4
    ends = {a.name: project.stance(a.end_stance).name for a in project.actions() if a.kind == "transition"}
    assert ends == {"body_left__to__right": "body right", "body_right__to__left": "body left"}


def test_an_end_that_two_stances_could_be_stays_as_it_is_written(toy):
    project = make_project(toy, ["sit_left__a", "stand_left__a", "x__to__left"])
    project = write_cells(
        project, fill_from_names(project, list_rows(project), parse_name_pattern("{stance}__a"))
    ).project
    filled = fill_from_names(project, list_rows(project), parse_name_pattern("{stance}__to__{end}"))
    assert [text for (_, column), text in filled.items() if column == "end_stance"] == ["left"]
