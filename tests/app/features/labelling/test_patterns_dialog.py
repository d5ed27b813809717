"""Name patterns in the window: found, tried out, added, changed, taken away, forgotten and shared, with the
keyboard.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QFileDialog, QMessageBox, QPushButton

from app.features.labelling.pattern_table import (
    LEARNED,
    MINE,
    NOBODY,
    PatternRow,
    change_pattern,
    list_pattern_rows,
    remove_pattern,
)
from app.features.labelling.patterns_dialog import PatternsDialog
from app.project.document import Document
from app.project.learned import Learned
from app.stage.session import StageSession
from metagraph.suggest.words.names import Patterns, learn_correction
from tests.thorough import some

NAMES = ["idle_arms_wobble", "idle_arms_shrug", "idle_arms"]


@pytest.fixture
def dialog(qapp: object, qtbot: object) -> PatternsDialog:
    document = Document()
    made = PatternsDialog(document, StageSession(document), Learned())
    qtbot.addWidget(made)  # type: ignore[attr-defined]
    made.show()
    QTest.qWaitForWindowExposed(made)
    return made


def shown(dialog: PatternsDialog) -> list[tuple[str, ...]]:
    return [
        tuple(dialog.chosen.index(i, c).data() for c in range(4)) for i in range(dialog.chosen.rowCount())
    ]


def selected(dialog: PatternsDialog) -> list[tuple[str, ...]]:
    rows = shown(dialog)
    return [rows[index.row()] for index in dialog.table.selectionModel().selectedRows()]


def test_rows_are_own_ones_learned_ones_and_what_is_built_in_and_unchanged() -> None:
    patterns = learn_correction(
        Patterns().with_pattern("kinds", "nod", "fidget"), "idle_arms_wobble", "kind", "gesture", NAMES
    )
    rows = list_pattern_rows(patterns)
    assert (
        PatternRow(MINE, "kinds", "nod", "fidget") in rows
        and PatternRow(LEARNED, "kind", "wobble", "gesture", 1) in rows
    )
    assert not any(r.source == NOBODY and (r.field, r.phrase) == ("kinds", "nod") for r in rows)


def test_removing_gives_back_forgets_or_takes_away() -> None:
    patterns = learn_correction(
        Patterns().with_pattern("kinds", "nod", "fidget"), "idle_arms_wobble", "kind", "gesture", NAMES
    )
    patterns = learn_correction(patterns, "idle_arms_wobble", "kind", "fidget", NAMES)
    assert (
        remove_pattern(patterns, PatternRow(MINE, "kinds", "nod", "fidget")).meanings["kinds"]["nod"]
        == "gesture"
    )
    assert (
        "wave"
        not in remove_pattern(patterns, PatternRow(NOBODY, "kinds", "wave", "gesture")).meanings["kinds"]
    )
    assert remove_pattern(patterns, PatternRow(LEARNED, "kind", "wobble", "fidget", 1)).learned == {
        "kind": {"wobble": {"gesture": 1}}
    }
    assert change_pattern(
        patterns, PatternRow(LEARNED, "kind", "wobble", "fidget", 1), "wobble", "gesture"
    ).learned == {"kind": {"wobble": {"gesture": 2}}}
    renamed = change_pattern(patterns, PatternRow(MINE, "kinds", "nod", "fidget"), "noddle", "fidget")
    assert renamed.meanings["kinds"]["nod"] == "gesture" and renamed.meanings["kinds"]["noddle"] == "fidget"


@pytest.mark.nightly
@pytest.mark.window
def test_a_name_is_read_as_it_is_typed_and_a_new_pattern_changes_that_at_once(dialog: PatternsDialog) -> None:
    QTest.keyClicks(dialog.name, "Wobble_01")
    assert "says nothing" in dialog.read.text() or "gesture" not in dialog.read.text()
    QTest.keyClicks(dialog.phrase, "Wobble")
    dialog.meaning.setCurrentIndex(dialog.meaning.findData("gesture"))
    QTest.keyClick(dialog.phrase, Qt.Key.Key_Return)
    assert shown(dialog) == [("wobble", "kind", "gesture", "you")]
    assert "gesture" in dialog.read.text() and "Wobble" in dialog.read.text() and dialog.isVisible()
    assert Learned().patterns.meanings["kinds"]["wobble"] == "gesture"
    dialog.table.setFocus()
    QTest.keyClick(dialog.table, Qt.Key.Key_Delete)
    assert shown(dialog) == [] and "gesture" not in dialog.read.text()


@pytest.mark.nightly
@pytest.mark.window
def test_built_in_words_are_found_changed_in_place_and_given_back(dialog: PatternsDialog) -> None:
    dialog.every.click()
    QTest.keyClicks(dialog.search, "wave gesture")
    assert shown(dialog) == [("wave", "kind", "gesture", "built in")]
    index = dialog.chosen.index(0, 2)
    dialog.table.setCurrentIndex(index)
    dialog.table.setFocus()
    dialog.table.edit(index)
    box = dialog.table.findChild(QComboBox)
    assert box is not None
    QTest.keyClick(box, Qt.Key.Key_Down)
    QTest.keyClick(box, Qt.Key.Key_Return)
    QTest.qWait(20)
    dialog.search.clear()
    dialog.every.click()
    assert shown(dialog) == [("wave", "kind", "fidget", "you")]
    dialog.table.selectRow(0)
    QTest.mouseClick(dialog.remove, Qt.MouseButton.LeftButton)
    assert shown(dialog) == [] and dialog.learned.patterns.meanings["kinds"]["wave"] == "gesture"


@pytest.mark.nightly
@pytest.mark.window
def test_words_of_other_languages_are_shown_by_what_they_stand_for_and_taken_away(
    dialog: PatternsDialog,
) -> None:
    dialog.every.click()
    dialog.search.setText("schulterzucken")
    assert shown(dialog) == [("schulterzucken", "same as", "shrug", "built in")]
    dialog.table.selectRow(0)
    dialog.remove.click()
    assert shown(dialog) == [("schulterzucken", "same as", "nothing (removed)", "you")]
    dialog.search.setText("zwischen")
    assert shown(dialog) == []


@pytest.mark.nightly
@pytest.mark.window
def test_a_built_in_word_that_is_taken_away_says_so_and_comes_back(dialog: PatternsDialog) -> None:
    dialog.every.click()
    dialog.search.setText("wave gesture")
    dialog.table.selectRow(0)
    dialog.remove.click()
    dialog.search.clear()
    dialog.every.click()
    assert (
        shown(dialog) == [("wave", "kind", "nothing (removed)", "you")]
        and "no longer means anything" in dialog.words.text()
    )
    dialog.table.selectRow(0)
    dialog.remove.click()
    assert shown(dialog) == [] and "wave" in dialog.learned.patterns.meanings["kinds"]


@pytest.mark.window
def test_no_words_or_a_broken_file_are_told_not_raised(
    dialog: PatternsDialog, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    dialog.add.click()
    assert "no words" in dialog.words.text()
    broken = tmp_path / "theirs.json"
    broken.write_text('{"patterns": 1, "kinds": {"wave": 3}}')
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(broken), ""))
    dialog.take.click()
    assert "theirs.json" in dialog.words.text() and "'kinds', 'wave'" in dialog.words.text()


@pytest.mark.nightly
@pytest.mark.window
def test_patterns_are_shared_as_a_file_and_forgetting_leaves_own_ones(
    dialog: PatternsDialog, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    dialog.learned.correct("idle_arms_wobble", "kind", "fidget", NAMES)
    dialog.learned.edit(lambda p: p.with_pattern("kinds", "bonk", "gesture"))
    assert [row[0] for row in shown(dialog)] == ["bonk", "wobble"]
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "ours"), ""))
    dialog.give.click()
    assert set(json.loads((tmp_path / "ours.json").read_text())) == {"patterns", "kinds", "learned"}
    dialog.forget.click()
    (box,) = dialog.findChildren(QMessageBox)
    assert "1 word learned" in box.text() + box.informativeText()
    next(b for b in box.findChildren(QPushButton) if b.text() == "Forget").click()
    QApplication.processEvents()
    assert [row[0] for row in shown(dialog)] == ["bonk"] and not dialog.forget.isEnabled()
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(tmp_path / "ours.json"), ""))
    dialog.take.click()
    assert [row[0] for row in shown(dialog)] == [
        "bonk",
        "wobble",
    ] and "1 pattern and 1 learned" in dialog.words.text()


@pytest.mark.window
def test_while_learning_is_off_what_was_learned_is_shown_but_not_used(dialog: PatternsDialog) -> None:
    dialog.learned.correct("idle_arms_wobble", "kind", "fidget", NAMES)
    dialog.name.setText("wobble_02")
    assert "fidget" in dialog.read.text()
    QTest.mouseClick(dialog.on, Qt.MouseButton.LeftButton)
    assert "fidget" not in dialog.read.text() and [row[0] for row in shown(dialog)] == ["wobble"]


@pytest.mark.window
def test_the_command_opens_it(drive: object) -> None:
    drive.actions["patterns"].trigger()  # type: ignore[attr-defined]
    (made,) = drive.window.findChildren(PatternsDialog)  # type: ignore[attr-defined]
    assert made.isVisible()
    QTest.keyClick(made, Qt.Key.Key_Escape)


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.parametrize("column", some(range(4), 2))
def test_rows_are_sorted_by_any_column_either_way_and_what_is_selected_stays_so(
    dialog: PatternsDialog, column: int
) -> None:
    dialog.every.click()
    header = dialog.table.horizontalHeader()
    for order in (Qt.SortOrder.AscendingOrder, Qt.SortOrder.DescendingOrder):
        dialog.table.selectRow(3)
        (kept,) = selected(dialog)
        header.setSortIndicator(column, order)
        said = [row[column].lower() for row in shown(dialog)]
        assert len(said) > 1000
        assert said == sorted(said, reverse=order == Qt.SortOrder.DescendingOrder)
        assert selected(dialog) == [kept]
    few = len(said)
    dialog.search.setText("WAVE")
    found = [row[column].lower() for row in shown(dialog)]
    assert 1 <= len(found) < few and found == sorted(found, reverse=True)
