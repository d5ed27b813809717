"""The library by mouse and keys: sizes, columns, groups, marks, saved filters, going through a picture."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QImage, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QInputDialog

from app.features.library.clip_badges import FILLS, INK
from app.features.library.clip_columns import COLUMNS
from app.features.library.clip_filter import Filter, filter_from_text
from app.features.library.clip_header import PLACES
from app.features.library.clip_rows import ENTRY
from app.features.library.clip_sizes import SIZES, place_picture
from app.features.library.library_settings import LibrarySettings
from app.project.reveal import reveal_command
from metagraph.graph.clip_mark import ClipMark
from metagraph.graph.editing.marks import mark, mark_of
from metagraph.graph.problem import Problem
from tests.app.look.test_theme import contrast

KEY, CTRL, SHIFT = Qt.Key, Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def panel(toys):
    toys.workspaces.choose("label")
    toys.pause(20)
    return toys.library


def titles(panel):
    return [s.title for s in panel.rows.sections]


def wheel(view, up: bool) -> None:
    at = QPointF(view.viewport().rect().center())
    step = QPoint(0, 120 if up else -120)
    more = Qt.MouseButton.NoButton, CTRL, Qt.ScrollPhase.NoScrollPhase, False
    QApplication.sendEvent(view.viewport(), QWheelEvent(at, view.mapToGlobal(at), QPoint(), step, *more))


# --- sizes


@pytest.mark.nightly
def test_slider_wheel_and_keys_make_clips_larger_and_it_is_kept(toys, panel):
    view = panel.list
    assert view.side == 108
    wheel(view, True)
    assert view.side == 144 and LibrarySettings().side("cards") == 144
    wheel(view, False)
    view.setFocus()
    toys.key(KEY.Key_Minus, CTRL, view)
    assert view.side == 84
    panel.bar.slider.setFocus()
    for _ in range(4):
        toys.key(KEY.Key_Left, widget=panel.bar.slider)
    assert view.side == SIZES[0] and view.layout_of.cell_height < 30
    panel.restore()
    assert view.side == SIZES[0]


@pytest.mark.nightly
def test_what_is_current_stays_in_sight_at_every_size(toys, panel):
    last = panel.rows.index(len(panel.rows.entries) - 1, 0)
    panel.list.setCurrentIndex(last)
    for side in SIZES:
        panel.show_as("cards", side)
        assert panel.list.viewport().rect().contains(panel.list.visualRect(last).center())


@pytest.mark.nightly
def test_scrolling_shows_what_comes(toys, panel):
    panel.show_as("cards", 224)
    view = panel.list
    before = view.viewport().grab().toImage()
    view.verticalScrollBar().setValue(view.verticalScrollBar().maximum())
    toys.pause(30)
    assert view.verticalScrollBar().value() > 0 and view.viewport().grab().toImage() != before
    assert view.indexAt(QPoint(20, 20)).row() > 0


# --- selecting


def chosen(panel):
    return sorted(i.row() for i in panel.list.selectedIndexes())


def at(panel, row):
    return panel.list.viewport(), panel.list.visualRect(panel.rows.index(row, 0)).center()


@pytest.mark.parametrize(("style", "side"), [("cards", 84), ("cards", 28), ("columns", 28)])
def test_shift_takes_all_between_as_they_are_read(toys, panel, style, side):
    panel.show_as(style, side)
    last = panel.list.layout_of.columns + 1
    toys.click(at(panel, 1))
    toys.click(at(panel, last), SHIFT)
    assert (
        chosen(panel)
        == list(range(1, last + 1))
        == sorted(panel.rows.row_of(c) for c in toys.session.selection.clips)
    )
    toys.click(at(panel, 0), SHIFT)
    assert chosen(panel) == [0, 1], "backwards, too"
    toys.click(at(panel, last), CTRL)
    assert chosen(panel) == [0, 1, last]
    panel.list.setFocus()
    toys.click(at(panel, 2))
    toys.key(KEY.Key_Down, SHIFT, panel.list)
    assert chosen(panel) == list(range(2, 3 + panel.list.layout_of.columns))
    toys.key(KEY.Key_A, CTRL, panel.list)
    assert len(chosen(panel)) == len(panel.rows.entries)


def test_a_rectangle_drawn_beside_the_clips_takes_those_it_touches(toys, panel):
    panel.search.setText("rest")
    view, count = panel.list, panel.list.layout_of.columns
    assert 1 < len(panel.rows.entries) < 2 * count or count > 1
    end = QPoint(view.viewport().width() - 3, view.viewport().height() - 3)
    QTest.mousePress(view.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, end)
    first = view.visualRect(panel.rows.index(0, 0))
    for part in (0.9, 0.5, 0.1, 0.0):
        step = QPoint(first.left() + 10, first.top() + 10)
        QTest.mouseMove(view.viewport(), step + (end - step) * part)
        toys.pause(20)
    QTest.mouseRelease(view.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, step)
    assert chosen(panel) == list(range(len(panel.rows.entries)))
    assert len(toys.session.selection.clips) == len(panel.rows.entries)


# --- columns


def test_a_click_on_a_title_sorts_and_another_turns_it_round(toys, panel):
    toys.click((panel.bar.buttons["columns"], panel.bar.buttons["columns"].rect().center()))
    header = panel.list.header
    assert header.isVisible() and LibrarySettings().style() == "columns"
    n = PLACES["length"]
    at = QPoint(header.sectionViewportPosition(n) + 20, header.height() // 2)
    lengths = lambda: [e.duration for e in panel.rows.entries]  # noqa: E731
    toys.click((header.viewport(), at))
    assert lengths() == sorted(lengths())
    toys.click((header.viewport(), at))
    assert lengths() == sorted(lengths(), reverse=True) and panel.backwards.isChecked()
    assert header.sortIndicatorSection() == n


@pytest.mark.nightly
def test_columns_are_shown_hidden_and_kept(toys, panel):
    panel.show_as("columns")
    panel.menu.fill_columns()
    toys.pick(panel.menu.columns, "Added")
    toys.pick(panel.menu.columns, "File")
    header = panel.list.header
    assert not header.isSectionHidden(PLACES["added"]) and header.isSectionHidden(PLACES["file"])
    header.moveSection(header.visualIndex(PLACES["stance"]), 1)
    header.as_usual()
    header.blockSignals(False)
    panel.menu.columns.clear()
    assert header.isSectionHidden(PLACES["added"])
    header.set_shown(PLACES["added"], True)
    panel.restore()
    assert not header.isSectionHidden(PLACES["added"])


@pytest.mark.nightly
def test_every_column_says_something_of_a_clip_that_has_it_all(toys, panel):
    action = toys.action("rest beat lf")
    toys.document.edit("m", lambda p: mark(p, [action.clip], color="red", rating=2, favourite=True, note="n"))
    found = [Problem("error", "x", "x", "x", action=action.id)]
    panel.facts._problems = lambda: found
    entry = toys.document.project.clips[action.clip]
    said = {c.id: c.words(panel.facts, entry) for c in COLUMNS}
    assert all(said.values()), said
    assert said["problems"] == "1" and said["rating"] == "★★☆☆☆" and said["layer"] == "arms"
    panel.facts._problems = tuple


# --- groups


def test_groups_have_titles_that_close_by_click_and_by_key(toys, panel):
    panel.group_by("kind")
    assert titles(panel)[:2] == ["Stances", "Gestures"]
    count = len(panel.rows.entries)
    assert sum(s.count for s in panel.rows.sections) == count
    view = panel.list
    toys.click((view.viewport(), view.layout_of.head(0).center()))
    assert panel.rows.sections[0].closed and view.layout_of.open_rows()[0] == panel.rows.sections[1].first
    view.setFocus()
    view.setCurrentIndex(panel.rows.index(view.layout_of.open_rows()[0], 0))
    QTest.keyClicks(view, "-")
    assert panel.rows.sections[1].closed
    QTest.keyClicks(view, "+")
    assert not panel.rows.sections[1].closed
    QTest.keyClicks(view, "*")
    assert not any(s.closed for s in panel.rows.sections)
    assert LibrarySettings().group() == "kind"


@pytest.mark.nightly
@pytest.mark.parametrize("group", ["folder", "stance", "tag", "layer", "kind"])
def test_every_clip_is_in_one_group_and_sorted_within_it(toys, panel, group):
    panel.group_by(group)
    panel.sort("name")
    assert len({e.id for e in panel.rows.entries}) == len(toys.document.project.clips)
    assert len(set(titles(panel))) == len(titles(panel)) and all(titles(panel))
    for s in panel.rows.sections:
        names = [e.name.casefold() for e in panel.rows.entries[s.first : s.first + s.count]]
        assert names == sorted(names)


@pytest.mark.nightly
def test_a_clip_that_is_placed_goes_to_its_group_and_stays_selected(toys, toy, panel):
    from metagraph.graph import edits

    toys.document.edit("Add", lambda p: edits.add_clips(p, [("n/x.bvh", 0, "", toy.clip("x"))]))
    panel.group_by("layer")
    clip = next(i for i, e in toys.document.project.clips.items() if e.name == "x")
    toys.session.selection.select_clips((clip,))
    assert titles(panel)[-1] == "Not placed yet"
    stance = toys.action("rest beat lf").stance
    toys.document.edit("Place", lambda p: edits.place_clips(p, [clip], "arms", "gesture", stance))
    assert "Not placed yet" not in titles(panel)
    assert [i.data(ENTRY).id for i in panel.list.selectedIndexes()] == [clip]


# --- marks


@pytest.mark.nightly
def test_keys_rate_favour_and_label_what_is_selected_in_one_step(toys, panel):
    clips = tuple(list(toys.document.project.clips)[:2])
    toys.session.selection.select_clips(clips)
    toys.window.refresh()
    toys.key(KEY.Key_4, CTRL | SHIFT)
    toys.key(KEY.Key_6, CTRL | SHIFT)
    toys.do("color_blue")
    marks = [mark_of(toys.document.project, c) for c in clips]
    assert marks == [ClipMark("blue", 4, True)] * 2
    for _ in range(3):
        toys.key(KEY.Key_Z, CTRL)
    assert toys.document.project.marks == {}


@pytest.mark.nightly
def test_the_menu_marks_duplicates_and_tells_what_is_on_a_clip(toys, panel):
    clip = next(iter(toys.document.project.clips))
    entry = toys.document.project.clips[clip]
    toys.pick(panel.acts.menu(entry), "Mark", "Green label")
    toys.pick(panel.acts.menu(entry), "Mark", "★★★★★")
    marked = panel.acts.menu(entry)
    inner = next(a.menu() for a in marked.actions() if a.text() == "&Mark")
    assert {a.text().split("\t")[0] for a in inner.actions() if a.isChecked()} == {"Green label", "★★★★★"}
    assert "green label" in panel.rows.index(panel.rows.row_of(clip), 0).data(Qt.ItemDataRole.ToolTipRole)
    toys.pick(panel.acts.menu(entry), "Duplicate")
    (made,) = toys.session.selection.clips
    assert toys.document.project.clips[made].name == f"{entry.name} copy"
    assert mark_of(toys.document.project, made) == ClipMark("green", 5)


@pytest.mark.nightly
def test_label_as_is_in_a_clips_menu(toys, toy, panel):
    from metagraph.graph import edits

    toys.document.edit("Add", lambda p: edits.add_clips(p, [("n/x.bvh", 0, "", toy.clip("x"))]))
    entry = next(e for e in toys.document.project.clips.values() if e.name == "x")
    toys.session.selection.select_clips((entry.id,))
    toys.window.refresh()
    toys.pick(panel.acts.menu(entry), "Label as", "Label as 3 fidget")
    assert "x" in toys.names("fidget")


@pytest.mark.nightly
def test_the_note_of_a_selected_clip_is_written_in_the_notes_panel(toys, panel):
    clip = next(iter(toys.document.project.clips))
    toys.shell.show("notes")
    toys.session.selection.select_clips((clip,))
    notes = toys.shell.panel("notes")
    notes.text.setPlainText("too slow")
    notes.finish()
    assert mark_of(toys.document.project, clip).note == "too slow"
    toys.session.selection.clear()
    assert notes.text.toPlainText() == ""


def test_letters_of_labels_are_read_on_their_colours():
    assert all(contrast(INK, fill) >= 7 for fill in FILLS.values())
    assert len({name[0] for name in FILLS}) == len(FILLS)


# --- filters


@pytest.mark.nightly
def test_what_is_asked_for_narrows_what_is_shown_and_what_is_chosen(toys, panel):
    one, two, three = list(toys.document.project.clips)[:3]
    toys.document.edit("m", lambda p: mark(mark(p, [one], rating=3), [two], rating=5, favourite=True))
    toys.session.selection.select_clips((one, three))
    panel.ask_for(stars=3)
    assert {e.id for e in panel.rows.entries} == {one, two}
    assert toys.session.selection.clips == (one,), "what is not seen is not chosen"
    assert panel.more.text() == "★3" and panel.bar.told.text().startswith("2 of")
    panel.menu.fill_marks()
    toys.pick(panel.menu.marks, "♥  Favourites")
    assert [e.id for e in panel.rows.entries] == [two]
    toys.document.edit("m", lambda p: mark(p, [two], favourite=False))
    assert panel.rows.entries == []
    panel.narrow()
    assert len(panel.rows.entries) == len(toys.document.project.clips)


@pytest.mark.nightly
def test_a_filter_is_kept_under_a_name_chosen_again_and_deleted(toys, panel, monkeypatch):
    monkeypatch.setattr(QInputDialog, "getText", lambda *a, **k: ("My beats", True))
    panel.search.setText("beat")
    panel.chips["labelled"].click()
    panel.narrow(layer="arms")
    wanted = [e.id for e in panel.rows.entries]
    panel.menu.fill_kept()
    toys.pick(panel.menu.kept, "Save this filter as…")
    panel.forget()
    assert len(panel.rows.entries) > len(wanted)
    panel.menu.fill_kept()
    toys.pick(panel.menu.kept, "My beats")
    assert [e.id for e in panel.rows.entries] == wanted and panel.search.text() == "beat"
    assert panel.chips["labelled"].isChecked() and panel.more.text() == "Arms"
    panel.menu.fill_kept()
    toys.pick(panel.menu.kept, "Delete", "My beats")
    assert LibrarySettings().filters() == {}


@pytest.mark.parametrize(
    "rule",
    [Filter(), Filter("a | b", False, "arms", "gesture", "red", 2, True, True, True), Filter(labelled=True)],
)
def test_a_filter_survives_being_written(rule):
    assert filter_from_text(rule.as_text()) == rule


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{", '{"stars": 9}', '{"kind": "x"}', '{"text": 3}', '{"favourite": 1}', '{"color": []}'],
)
def test_a_broken_filter_is_none(text):
    assert filter_from_text(text) is None


# --- going through a picture


@pytest.mark.nightly
def test_the_pointer_goes_through_a_clip_and_leaves_it_as_it_was(toys, panel, monkeypatch):
    colors = ("red", "lime", "blue", "white")

    def strip(clip: str) -> list[QImage]:
        out = []
        for color in colors:
            image = QImage(8, 8, QImage.Format.Format_RGB32)
            image.fill(QColor(color))
            out.append(image)
        return out

    monkeypatch.setattr(panel.thumbnails, "scrub", strip)
    view, index = panel.list, panel.rows.index(1, 0)
    box = place_picture("cards", view.side, view.visualRect(index))

    def seen(part: float) -> str:
        at = QPoint(round(box.left() + part * (box.width() - 1)), box.center().y())
        QTest.mouseMove(view.viewport(), at)
        toys.wait(lambda: panel.list.scrub.pictures.scrubbed is not None)
        toys.pause(20)
        return QColor(view.viewport().grab().toImage().pixel(at)).name()

    assert [seen(p) for p in (0.1, 0.4, 0.6, 0.9)] == [QColor(c).name() for c in colors]
    QTest.mouseMove(view.viewport(), QPoint(box.center().x(), box.bottom() + 30))
    toys.wait(lambda: panel.list.scrub.pictures.scrubbed is None)


# --- files


def test_a_file_is_shown_in_its_folder_as_each_system_does():
    from pathlib import Path

    assert reveal_command(Path("/a/b.bvh"), "darwin") == ("open", ["-R", "/a/b.bvh"])
    assert reveal_command(Path("/a/b.bvh"), "win32")[0] == "explorer"
    assert reveal_command(Path("/a/b.bvh"), "linux") is None


def test_reveal_opens_the_folder_of_a_file_or_the_nearest_there_is(monkeypatch, tmp_path):
    from app.project import reveal as module

    opened = []
    monkeypatch.setattr(module.QDesktopServices, "openUrl", lambda url: opened.append(url.toLocalFile()))
    module.reveal(tmp_path / "gone" / "x.bvh")
    assert opened == [str(tmp_path)]


# --- drags and menus are those of the cards, however clips are shown


@pytest.mark.nightly
@pytest.mark.gl
@pytest.mark.parametrize(("style", "side"), [("columns", 28), ("cards", 28)])
def test_a_clip_is_dragged_from_a_line_of_a_group_onto_a_node(toys, toy, style, side):
    from metagraph.graph import edits

    toys.document.edit("Add", lambda p: edits.add_clips(p, [("n/x.bvh", 0, "", toy.clip("x"))]))
    toys.session.place.set_stance(toys.action("rest beat lf").stance)
    toys.library.group_by("folder")
    toys.library.show_as(style, side)
    toys.drag(toys.card("x"), toys.node("fidget"), lambda: "x" in toys.names("fidget"))


@pytest.mark.nightly
def test_the_menu_key_opens_the_menu_of_the_current_clip(toys, panel):
    from PySide6.QtGui import QContextMenuEvent

    asked = []
    panel.list.menu_wanted.disconnect()
    panel.list.menu_wanted.connect(lambda entry, at: asked.append(entry.id))
    panel.list.setCurrentIndex(panel.rows.index(2, 0))
    event = QContextMenuEvent(QContextMenuEvent.Reason.Keyboard, QPoint(5, 5), QPoint(5, 5))
    QApplication.sendEvent(panel.list.viewport(), event)
    panel.list.menu_wanted.disconnect()
    panel.list.menu_wanted.connect(lambda entry, at: panel.acts.menu(entry).exec(at))
    assert asked == [panel.rows.entries[2].id]
