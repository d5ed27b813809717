"""The library's filters, and names broken so that clips can be distinguished."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QFont, QFontMetrics

from app.features.library.clip_card import break_in_two_lines
from app.features.library.clip_facts import ClipFacts
from app.features.library.clip_filter import Filter
from app.features.library.clip_rows import find_changed_rows as _changed_rows
from metagraph.graph import edits


@pytest.fixture(scope="module")
def project(toy):
    project = toy.project()
    extra = [("nods/yes.bvh", 0, "", toy.clip("Nod Yes")), ("nods/no.bvh", 0, "", toy.clip("Nod No"))]
    project = edits.add_clips(project, extra)
    return edits.add_stance(project, "head", "still", [toy.id(project, "Nod No")])


def taken(project, **rule) -> set[str]:
    facts = ClipFacts(SimpleNamespace(project=project))
    return {e.name for e in project.clips.values() if Filter(**rule).takes(facts, e)}


def test_no_filter_takes_everything(project):
    assert len(taken(project)) == len(project.clips)


def test_words_match_names_and_paths_in_any_order_and_case(project):
    assert taken(project, text="NOD") == {"Nod Yes", "Nod No"}
    assert taken(project, text="yes nod") == {"Nod Yes"}
    assert taken(project, text="nods/ no.bvh") == {"Nod No"}
    assert taken(project, text="nothing like it") == set()
    assert taken(project, text="   ") == taken(project)


def test_placed_and_unplaced_part_the_clips(project):
    assert taken(project, labelled=False) == {"Nod Yes"}
    assert taken(project, labelled=True) == taken(project) - {"Nod Yes"}


def test_layer_and_kind_look_at_the_same_action(toy, project):
    assert taken(project, layer="head") == {"Nod No"}
    assert taken(project, kind="transition") == {"rest to up", "up to rest", "up to far", "far to up"}
    assert taken(project, layer="head", kind="transition") == set()
    assert taken(project, layer="head", text="yes") == set()


@pytest.fixture
def metrics(qapp):
    font = QFont()
    font.setPixelSize(12)
    return QFontMetrics(font)


@pytest.mark.parametrize(
    "name",
    [
        "a",
        "idle",
        "arms_crossed__point_you_rt_01",
        "x" * 200,
        "one two three four five six",
        "_" * 60,
        "ä ö ü" * 9,
    ],
)
def test_a_name_fits_in_at_most_two_lines(metrics, name):
    for width in (40, 90, 108, 300):
        lines = break_in_two_lines(name, metrics, width)
        assert 1 <= len(lines) <= 2
        assert all(metrics.horizontalAdvance(line) <= width for line in lines)
        place = 0
        for piece in "".join(lines).split("…"):
            place = name.replace(" ", "").index(piece.replace(" ", ""), place) + 1


def test_a_long_name_breaks_after_a_separator_and_keeps_its_end(metrics):
    first, second = break_in_two_lines("arms_crossed__point_you_rt_01", metrics, 100)
    assert first.endswith("_")
    assert second.endswith("01")


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_new_project_is_not_searched_for_what_was_wanted_of_the_last(toys, toy):
    toys.library.search.setText("beat")
    toys.library.chips["unlabelled"].click()
    toys.document.load(toy.project(), None)
    assert toys.library.search.text() == "" and toys.library.chips["all"].isChecked()
    assert toys.library.rows.rowCount() == len(toys.document.project.clips)


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_after_a_label_by_key_the_next_clip_without_one_is_selected(toys, toy):
    drive = toys
    more = [(f"more/{n}.bvh", 0, "", toy.clip(f"more {n}")) for n in range(3)]
    drive.document.edit("Add", lambda p: edits.add_clips(p, more))
    ids = {e.name: e.id for e in drive.document.project.clips.values()}
    drive.workspaces.choose("graph")
    drive.session.selection.select_clips((ids["more 1"],))
    drive.library.list.setFocus()
    drive.key(Qt.Key.Key_2, widget=drive.library.list)
    made = next(a for a in drive.document.project.actions() if a.clip == ids["more 1"])
    assert drive.session.selection.clips == (ids["more 2"],)
    assert drive.session.transport.shown == ids["more 2"]
    assert drive.canvas.layout_now().row(made.id) is not None and drive.canvas.fresh == (made.id,)
    assert drive.library.list.currentIndex().data() == "more 2"
    drive.key(Qt.Key.Key_3, widget=drive.library.list)
    assert drive.session.selection.clips == (ids["more 0"],), "it goes on from the first"
    drive.key(Qt.Key.Key_3, widget=drive.library.list)
    last = next(a for a in drive.document.project.actions() if a.clip == ids["more 0"])
    assert drive.session.selection.actions == (last.id,), "there is no other: what was made is selected"


def test_an_edit_redraws_the_cards_it_changes_and_no_others(toy):
    project = toy.project()
    entries = list(project.clips.values())
    rows = {e.id: n for n, e in enumerate(entries)}
    action = next(a for a in project.actions() if a.kind == "gesture")
    faded = edits.update_actions(project, (action.id,), timing={"blend_in": 0.31})
    assert _changed_rows(project, faded, entries) == []
    gone = edits.remove_actions(project, (action.id,))
    assert _changed_rows(project, gone, entries) == [(rows[action.clip],) * 2]
    everywhere = [(0, len(entries) - 1)]
    assert _changed_rows(project, edits.rename_stance(project, action.stance, "x"), entries) == everywhere
    assert _changed_rows(project, edits.set_base(project, entries[0].id, 1), entries) == everywhere
