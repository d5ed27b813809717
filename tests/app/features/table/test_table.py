"""The table by mouse and keys: typing, filling down, pasting, filters, half labelled clips."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QInputDialog, QLineEdit, QMenu

from app.features.table.cell_words import parse_typed
from app.features.table.table_filter import TableFilter, keep_filters, read_filters
from app.project.finish_typing import finish_typing
from metagraph.graph import edits
from metagraph.playback.action_table import COLUMNS, find_row, read_cell
from tests.app.painted_text import painted

pytestmark = [pytest.mark.window, pytest.mark.gl]
KEY, CTRL, SHIFT = Qt.Key, Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def panel(toys):
    toys.workspaces.choose("graph")
    toys.do("table")
    found = toys.shell.panel("table")
    toys.wait(found.view.hasFocus)
    yield found
    found.search.clear()
    found.which.setCurrentIndex(0)
    found.replace_button.setChecked(False)
    found.view.sortByColumn(-1, Qt.SortOrder.AscendingOrder)
    toys.docks["table"].close()


@pytest.fixture
def table(toys, panel):
    return Hand(toys, panel)


class Hand:
    """A hand on the table's cells, by action name and column."""

    def __init__(self, drive, panel):
        self.drive, self.panel, self.view, self.rows = drive, panel, panel.view, panel.rows

    def ident(self, name):
        self.drive.wait(lambda: self.rows.project is self.drive.document.project)
        return next(r.ident for r in self.rows.rows if read_cell(self.rows.project, r, "name") == name)

    def index(self, name, column):
        return self.rows.index(self.rows.find([self.ident(name)])[0], COLUMNS.index(column))

    def click(self, name, column, modifier=Qt.KeyboardModifier.NoModifier):
        self.drive.wait(lambda: self.rows.project is self.drive.document.project)
        index = self.index(name, column)
        self.view.scrollTo(index)
        at = self.view.visualRect(index).center()
        QTest.mouseClick(self.view.viewport(), Qt.MouseButton.LeftButton, modifier, at)

    def type(self, words, end=KEY.Key_Return):
        """Type over the selected cell, with the keys going where the keyboard is."""
        for letter in words:
            QTest.keyClicks(QApplication.focusWidget(), letter)
        if end is not None:
            QTest.keyClick(QApplication.focusWidget(), end)
        self.drive.pause(1)

    def key(self, key, modifier=Qt.KeyboardModifier.NoModifier):
        QTest.keyClick(QApplication.focusWidget(), key, modifier)
        self.drive.pause(1)

    def says(self, name, column):
        self.drive.wait(lambda: self.rows.project is self.drive.document.project)
        project = self.drive.document.project
        row = find_row(project, self.ident(name))
        return read_cell(project, row, column)

    def steps(self):
        return self.drive.document.undo_stack.index()


@pytest.mark.nightly
def test_typing_replaces_a_cell_and_is_one_step(table):
    steps = table.steps()
    table.click("rest beat lf", "blend_in")
    table.type("0.1")
    assert table.says("rest beat lf", "blend_in") == "0.10"
    assert table.steps() == steps + 1
    assert "Blend in 0.20 → 0.10 s" in table.drive.document.undo_stack.undoText()
    table.drive.document.undo()
    assert table.says("rest beat lf", "blend_in") == "0.20"


@pytest.mark.nightly
def test_number_keys_are_typed_and_in_kind_they_are_the_kinds(table):
    table.click("rest beat lf", "cooldown")
    table.type("2")
    assert table.says("rest beat lf", "cooldown") == "2"
    assert table.says("rest beat lf", "kind") == "gesture", "2 is typed, it labels nothing"
    table.click("rest beat lf", "kind")
    table.type("3")
    assert table.says("rest beat lf", "kind") == "fidget"
    table.type("gest")
    assert table.says("rest beat lf", "kind") == "gesture"


@pytest.mark.nightly
def test_what_is_typed_goes_into_all_selected_cells_of_the_column_and_changes_nothing_else(table):
    names = ("rest short", "rest wave rt", "up beat")
    table.click(names[0], "kind")
    for name in names[1:]:
        table.click(name, "kind", CTRL)
    stances = [table.says(name, "stance") for name in names]
    steps = table.steps()
    table.type("fidget")
    assert [table.says(name, "kind") for name in names] == ["fidget"] * 3
    assert [table.says(name, "stance") for name in names] == stances
    assert table.steps() == steps + 1


@pytest.mark.nightly
def test_the_first_cell_fills_those_below_it(table):
    table.click("rest short", "tags")
    table.type("hello")
    rows = sorted(table.rows.find(map(table.ident, ("rest short", "rest beat lf", "rest wave rt"))))
    first = table.rows.rows[rows[0]].action.name
    table.click(first, "tags")
    table.type("hello")
    for row in rows[1:]:
        table.click(table.rows.rows[row].action.name, "tags", CTRL)
    table.key(KEY.Key_D, CTRL)
    assert {table.says(n, "tags") for n in ("rest short", "rest beat lf", "rest wave rt")} == {"hello"}


@pytest.mark.nightly
def test_cells_go_to_a_spreadsheet_and_back(table):
    table.click("rest beat lf", "likelihood")
    table.click("rest beat lf", "cooldown", CTRL)
    table.key(KEY.Key_C, CTRL)
    table.drive.do("copy")
    assert QGuiApplication.clipboard().text() == "1\t0"
    QGuiApplication.clipboard().setText("2,5\t30\r\n0.5\t10\r\n")
    table.click("rest beat lf", "likelihood")
    row = table.index("rest beat lf", "likelihood").row()
    below = table.rows.rows[row + 1].action.name
    steps = table.steps()
    table.drive.do("paste")
    table.drive.pause(1)
    assert [table.says("rest beat lf", c) for c in ("likelihood", "cooldown")] == ["2.5", "30"]
    assert [table.says(below, c) for c in ("likelihood", "cooldown")] == ["0.5", "10"]
    assert table.steps() == steps + 1


@pytest.mark.nightly
def test_one_pasted_cell_fills_the_selection_and_what_has_no_place_is_reported(table):
    QGuiApplication.clipboard().setText("left")
    table.click("rest short", "limb")
    table.click("rest wave rt", "limb", CTRL)
    table.drive.do("paste")
    table.drive.pause(1)
    assert {table.says(n, "limb") for n in ("rest short", "rest wave rt")} == {"left"}
    last = table.rows.rows[-1]
    QGuiApplication.clipboard().setText("a\nb\nc")
    table.click(read_cell(table.rows.project, last, "name"), "tags")
    table.drive.do("paste")
    assert "2 pasted cells had no place" in table.panel.message.text()


@pytest.mark.nightly
def test_what_cannot_be_written_is_marked_and_explained_and_the_rest_is_written(table):
    table.click("rest beat lf", "stance")
    table.type("nowhere")
    assert "1 cell was left as it was. rest beat lf, Stance: " in table.panel.message.text()
    assert "no stance 'nowhere'" in table.panel.message.text()
    index = table.index("rest beat lf", "stance")
    assert "nowhere" in index.data(Qt.ItemDataRole.ToolTipRole)
    assert index.data(Qt.ItemDataRole.BackgroundRole) is not None
    cell = table.view.visualRect(index)
    seen = table.view.viewport().grab().toImage()
    edge = seen.pixelColor(cell.left() + cell.width() // 2, cell.top() + 1)
    assert edge == QColor(table.rows.look.error), "a frame shows it while it is selected"
    table.type("up")
    assert table.says("rest beat lf", "stance") == "up"
    assert not table.panel.message.isVisible()


@pytest.mark.nightly
def test_what_was_refused_is_forgotten_with_the_next_change(table):
    table.click("rest beat lf", "tags")
    table.type("one")
    table.click("rest beat lf", "end")
    table.type("99")
    assert "after the clip's end" in table.panel.message.text()
    table.drive.document.undo()
    table.drive.pause(1)
    assert not table.panel.message.isVisible() and not table.rows.refused


@pytest.mark.nightly
def test_delete_empties_cells_and_removes_no_action(table):
    table.click("rest beat lf", "tags")
    table.type("one, two")
    assert table.says("rest beat lf", "tags") == "one, two"
    count = len(list(table.drive.document.project.actions()))
    table.drive.do("delete")
    table.drive.pause(1)
    assert table.says("rest beat lf", "tags") == ""
    assert len(list(table.drive.document.project.actions())) == count


@pytest.mark.nightly
def test_the_space_bar_still_plays_and_undo_is_the_windows(table):
    playing = table.drive.session.transport.playing
    table.click("rest beat lf", "kind")
    playing = table.drive.session.transport.playing
    table.drive.key(KEY.Key_Space, widget=table.view)
    table.drive.wait(lambda: table.drive.session.transport.playing is not playing)


@pytest.mark.nightly
def test_a_clip_waits_half_labelled_and_is_placed_when_the_rest_is_typed(table, toy):
    drive = table.drive
    drive.document.edit("Add", lambda p: edits.add_clips(p, [("n.glb", 0, "", toy.clip("new one"))]))
    drive.pause(1)
    table.click("new one", "kind")
    table.type("gesture")
    assert table.index("new one", "stance").data(Qt.ItemDataRole.DisplayRole) == "needed"
    clip = table.ident("new one")
    assert clip in drive.document.project.clips
    table.panel.which.setCurrentIndex(2)
    assert [row.ident for row in table.rows.rows] == [clip]
    table.click("new one", "stance")
    table.type("UP")
    (action,) = drive.document.project.uses[clip]
    assert (action.kind, drive.document.project.stance(action.stance).name) == ("gesture", "up")
    drive.wait(lambda: [row.ident for row in table.rows.rows] == [action.id])  # until the filter changes
    drive.document.undo()
    drive.wait(lambda: [row.ident for row in table.rows.rows] == [clip])


@pytest.mark.nightly
def test_a_clip_that_waits_for_a_stance_is_placed_by_whatever_makes_that_stance(table, toy):
    drive = table.drive
    clips = [("n.glb", 0, "", toy.clip("new one")), ("l.glb", 0, "", toy.clip("new loop"))]
    drive.document.edit("Add", lambda p: edits.add_clips(p, clips))
    drive.pause(1)
    table.click("new one", "kind")
    table.type("fidget")
    table.click("new one", "stance")
    table.type("sitting")
    assert not drive.document.project.uses.get(table.ident("new one"))
    loop = table.ident("new loop")
    drive.document.edit("New stance", lambda p: edits.add_stance(p, "arms", "sitting", [loop]))
    drive.pause(1)
    assert table.says("new one", "stance") == "sitting"
    assert find_row(drive.document.project, table.ident("new one")).action is not None


@pytest.mark.nightly
def test_rows_and_the_rest_of_the_window_select_the_same(table):
    drive = table.drive
    table.click("rest beat lf", "kind")
    table.click("up beat", "kind", CTRL)
    assert set(drive.session.selection.actions) == {table.ident("rest beat lf"), table.ident("up beat")}
    drive.session.selection.select_actions((table.ident("up yawn"),))
    assert table.view.selected_rows() == table.rows.find([table.ident("up yawn")])


@pytest.mark.nightly
def test_search_and_named_filters_show_some_rows(table, monkeypatch):
    every = len(table.rows.rows)
    table.panel.search.setText("gesture up -point")
    assert [row.action.name for row in table.rows.rows] == ["up beat"]
    monkeypatch.setattr(QInputDialog, "getText", lambda *a, **k: ("beats up", True))
    menu = table.panel.kept.menu()
    menu.aboutToShow.emit()
    table.drive.pick(menu, "Keep this filter…")
    table.panel.search.clear()
    assert len(table.rows.rows) == every
    menu.aboutToShow.emit()
    table.drive.pick(menu, "beats up")
    assert table.panel.search.text() == "gesture up -point"
    menu.aboutToShow.emit()
    table.drive.pick(menu, "Forget", "beats up")
    assert read_filters() == {}


def test_filters_are_kept_and_broken_ones_left_out():
    keep_filters({"a": TableFilter("x", "waiting")})
    assert read_filters() == {"a": TableFilter("x", "waiting")}


@pytest.mark.nightly
def test_words_are_replaced_in_a_column_in_one_step(table):
    table.panel.replace_button.setChecked(True)
    row = table.panel.replacing
    row.sought.setText("REST ")
    assert row.count.text() == "in 8 cells"
    row.put.setText("standing ")
    steps = table.steps()
    row.go.click()
    table.drive.pause(1)
    assert "standing beat lf" in {a.name for a in table.drive.document.project.actions()}
    assert not any(a.name.startswith("rest ") for a in table.drive.document.project.actions())
    assert table.steps() == steps + 1
    assert not row.go.isEnabled()


@pytest.mark.nightly
def test_a_click_on_a_title_sorts_and_another_sorts_the_other_way(table):
    table.view.sortByColumn(COLUMNS.index("end"), Qt.SortOrder.DescendingOrder)
    ends = [float(read_cell(table.rows.project, r, "end")) for r in table.rows.rows]
    assert ends == sorted(ends, reverse=True)


@pytest.mark.nightly
def test_a_column_is_hidden_and_stays_so(table):
    panel = table.panel
    panel._choose_columns(panel.view.rect().center())
    menu = next(m for m in panel.findChildren(QMenu) if m.isVisible())
    table.drive.pick(menu, "Cooldown")
    assert panel.view.isColumnHidden(COLUMNS.index("cooldown"))
    menu.close()
    panel._show_column(COLUMNS.index("cooldown"), True)


@pytest.mark.nightly
def test_names_stay_in_sight_when_the_table_is_scrolled_to_the_right(table):
    names, bar, name = table.view.names, table.view.horizontalScrollBar(), COLUMNS.index("name")
    assert not names.isVisible(), "the table's own names are in sight"
    bar.setValue(bar.maximum())
    assert bar.value() > 0 and names.isVisible()
    row = table.rows.find([table.ident("rest wave rt")])[0]
    at = names.visualRect(table.rows.index(row, name)).center()
    QTest.mouseClick(names.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)
    assert table.view.selected_rows() == [row], "a click on a name selects in the table"
    tops = [view.visualRect(table.rows.index(row, name)).top() for view in (names, table.view)]
    assert tops[0] == tops[1], "each name stands beside its row"
    kind = table.rows.index(row, COLUMNS.index("kind"))
    table.view.scrollTo(kind)
    left = table.view.columnViewportPosition(kind.column())
    assert left >= table.view.names.covered(), "no cell that is gone to lies beneath the names"
    bar.setValue(bar.maximum())
    QTest.mouseDClick(names.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)
    assert table.view.is_editing() and not names.isVisible(), "a double click edits the name in the table"
    QTest.keyClick(QApplication.focusWidget(), KEY.Key_Escape)


def test_completions_are_the_stances_of_the_rows_layer(table):
    table.click("rest beat lf", "stance")
    table.key(KEY.Key_F2)
    line = QApplication.focusWidget()
    assert isinstance(line, QLineEdit)
    assert line.text() == "rest"
    model = line.completer().model()
    assert [model.index(n, 0).data() for n in range(model.rowCount())] == ["rest", "up", "far"]
    table.key(KEY.Key_Escape)


@pytest.mark.nightly
def test_enter_takes_what_was_typed_or_the_choice_that_was_gone_to(table):
    table.click("rest beat lf", "kind")
    QTest.keyClicks(QApplication.focusWidget(), "fid")
    choices = QApplication.focusWidget().completer().popup()
    table.drive.wait(choices.isVisible)
    QTest.keyClick(choices, KEY.Key_Return)
    assert table.says("rest beat lf", "kind") == "fidget"
    assert not table.view.is_editing()
    QTest.keyClicks(QApplication.focusWidget(), "e")
    choices = QApplication.focusWidget().completer().popup()
    table.drive.wait(choices.isVisible)
    QTest.keyClick(choices, KEY.Key_Down)
    first = choices.currentIndex().data()
    QTest.keyClick(choices, KEY.Key_Return)
    assert table.says("rest beat lf", "kind") == parse_typed("kind", first) != "fidget"


@pytest.mark.parametrize(
    ("column", "typed", "text"),
    [
        ("kind", "2", "gesture"),
        ("kind", "Tr", "transition"),
        ("kind", "STANCE", "stance"),
        ("kind", "x", "x"),
        ("kind", "", ""),
        ("limb", "l", "left"),
        ("layer", "he", "head"),
        ("name", " a  b ", "a b"),
    ],
)
def test_typed_words_are_the_domains_words(column, typed, text):
    assert parse_typed(column, typed) == text


def test_an_empty_table_says_why(table):
    table.panel.search.setText("no such thing")
    words = " ".join(text.text for text in painted(table.view.viewport()))
    assert "No row matches" in words
    table.panel.search.clear()
    assert not painted(table.view.viewport()) or "No row" not in painted(table.view.viewport())[0].text


@pytest.mark.parametrize("width", [420, 1100])
def test_the_search_is_wide_enough_to_read_what_is_sought(table, width):
    panel = table.panel
    panel.resize(width, 300)
    table.drive.pause(30)
    assert panel.search.width() >= 150
    assert (panel.fill.y() > panel.search.y() + 10) == (width == 420), "a second line where one is too short"
    for button in (panel.kept, panel.fill, panel.replace_button):
        assert button.width() >= button.sizeHint().width()


def test_what_was_found_is_labelled_by_keys_alone(table):
    steps = table.steps()
    table.click("rest short", "kind")
    table.key(KEY.Key_F, CTRL)
    assert table.panel.search.hasFocus()
    table.type("rest -loop -to -scratch -cough")
    assert table.view.hasFocus() and len(table.view.selectedIndexes()) == 4
    table.type("f")
    assert {table.says(name, "kind") for name in ("rest short", "rest beat lf", "rest wave rt")} == {"fidget"}
    table.key(KEY.Key_F, CTRL)
    table.type("beat")
    for _ in range(5):
        table.key(KEY.Key_Right)
    assert {COLUMNS[i.column()] for i in table.view.selectedIndexes()} == {"tags"}
    table.type("small")
    assert table.says("rest beat lf", "tags") == table.says("up beat", "tags") == "small"
    assert table.steps() == steps + 2


def test_without_the_table_the_same_key_finds_clips(toys, table):
    table.drive.canvas.setFocus()
    table.drive.do("find")
    assert table.drive.library.search.hasFocus()


def test_stances_are_filled_from_parts_of_names(toys, table):
    toys.document.edit(
        "Remove", lambda p: edits.remove_actions(p, [a.id for a in p.actions() if a.kind != "stance"])
    )
    table.drive.wait(lambda: table.rows.project is table.drive.document.project)
    panel, steps = table.panel, table.steps()
    QTest.mouseClick(panel.names_button, Qt.MouseButton.LeftButton)
    assert panel.naming.pattern.hasFocus()
    QTest.keyClicks(panel.naming.pattern, "{stance} to {where}")
    assert "{where} is no field" in panel.naming.said.text() and not panel.naming.go.isEnabled()
    panel.naming.pattern.clear()
    QTest.keyClicks(panel.naming.pattern, "{stance} to {end}")
    assert panel.naming.said.text() == "4 rows. rest to up: Stance rest, Ends in up"
    QTest.keyClick(panel.naming.pattern, KEY.Key_Return)
    found = {a.name: a.kind for a in toys.document.project.actions()}
    assert found["rest to up"] == found["far to up"] == "transition" and table.steps() == steps + 1
    table.drive.wait(lambda: panel.naming.said.text() == "4 rows are filled")
    assert not panel.naming.go.isEnabled()
    panel.names_button.setChecked(False)


def test_escape_ends_typing_and_changes_nothing_also_with_the_list_of_choices_open(table):
    steps = table.steps()
    table.click("rest beat lf", "kind")
    table.key(KEY.Key_F, CTRL)
    table.type("beat")
    assert len(table.view.selectedIndexes()) == 2
    table.type("f", end=None)
    popup = QApplication.focusWidget().completer().popup()
    table.drive.wait(popup.isVisible)
    QTest.keyClick(popup, KEY.Key_Escape)
    assert not table.view.is_editing()
    table.click("up beat", "tags")
    assert table.says("rest beat lf", "kind") == table.says("up beat", "kind") == "gesture"
    assert table.steps() == steps


def test_what_is_still_being_typed_is_taken_over_before_saving_and_exporting(table):
    table.click("rest beat lf", "cooldown")
    table.type("2", end=None)
    assert table.view.is_editing()
    finish_typing()
    assert not table.view.is_editing() and table.says("rest beat lf", "cooldown") == "2"
