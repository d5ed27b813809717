"""The workspaces: chosen by hand and by key, kept, reset, saved as one's own; and that everything fits."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QInputDialog, QLabel, QMessageBox, QScrollArea, QToolButton

from app.shell.workspace_keeper import GROUP, OLD
from app.shell.workspace_tabs import WorkspaceTabs
from app.shell.workspaces import WORKSPACES
from tests.app.conftest import Driver, close

pytestmark = [pytest.mark.window, pytest.mark.gl]
IDS = [w.id for w in WORKSPACES]
CONTROL_ALT = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier


def tabs(drive) -> WorkspaceTabs:
    return drive.window.findChild(WorkspaceTabs)


def seen(drive) -> set[str]:
    return {n for n, d in drive.docks.items() if d.isVisible() and not d.visibleRegion().isEmpty()}


def fit(drive, width: int, height: int) -> None:
    drive.window.resize(width, height)
    drive.pause(30)
    assert drive.window.size().toTuple() == (width, height)


def again(drive, qtbot) -> Driver:
    """Another window, as if the program was begun again."""
    from app.main import make_window

    drive.workspaces.save()
    other = make_window()
    other.resize(1500, 900)
    other.show()
    return Driver(other, qtbot)


@pytest.mark.nightly
def test_a_click_on_a_tab_opens_its_workspace_and_keeps_the_selection(toys):
    drive = toys
    action = next(iter(drive.document.project.actions())).id
    drive.session.selection.select_actions((action,))
    for ident, button in zip(IDS, tabs(drive).buttons, strict=True):
        QTest.mouseClick(button, Qt.MouseButton.LeftButton)
        drive.pause(20)
        assert drive.workspaces.current == ident and button.isChecked()
        assert [b.isChecked() for b in tabs(drive).buttons].count(True) == 1
        assert drive.session.selection.actions == (action,)
        assert drive.places.large() in seen(drive)
        tall = drive.docks["character"].height()
        if ident != "label":  # there the clips are large
            assert all(tall >= drive.docks[n].height() for n in seen(drive)), ident
    assert drive.places.large() == "character"


@pytest.mark.nightly
def test_keys_open_workspaces_and_those_of_stances_stay(toys):
    drive = toys
    for n, ident in enumerate(IDS, 1):
        drive.canvas.setFocus()
        QTest.keyClick(drive.window, Qt.Key(Qt.Key.Key_0 + n), CONTROL_ALT)
        assert drive.workspaces.current == ident
        assert drive.actions[f"workspace_{n}"].isChecked()
    QTest.keyClick(drive.window, Qt.Key.Key_2, Qt.KeyboardModifier.ControlModifier)
    stances = list(drive.document.project.graphs["arms"].stances)
    assert drive.session.place.stance() == stances[1] and drive.workspaces.current == "talk"


@pytest.mark.nightly
def test_the_keyboard_goes_to_what_is_large_where_what_had_it_is_gone(toys):
    drive = toys
    drive.workspaces.choose("graph")
    drive.window.activateWindow()
    drive.library.search.setFocus()
    drive.workspaces.choose("label")
    assert drive.library.search.hasFocus(), "it is still to be seen"
    drive.workspaces.choose("talk")
    focus = QApplication.focusWidget()
    assert focus is not None and focus.isVisible() and drive.preview.isAncestorOf(focus)


@pytest.mark.nightly
@pytest.mark.fresh_window
def test_a_workspace_is_found_as_it_was_left_also_another_time(drive, qtbot):
    drive.workspaces.choose("perform")
    drive.docks["life"].close()
    drive.docks["lines"].close()
    drive.workspaces.choose("label")
    drive.workspaces.choose("perform")
    assert drive.docks["life"].isHidden()
    other = again(drive, qtbot)
    try:
        assert other.workspaces.current == "perform" and other.docks["life"].isHidden()
        other.actions["arrange"].trigger()
        assert not other.docks["life"].isHidden()
        other.workspaces.choose("label")
        other.workspaces.choose("perform")
        assert not other.docks["life"].isHidden(), "what was reset stays reset"
    finally:
        close(other.window)


@pytest.mark.fresh_window
def test_what_an_earlier_version_kept_is_not_misread(drive, qtbot):
    QSettings().setValue(OLD, drive.window.saveState(5))
    QSettings().setValue(f"{GROUP}/graph/left", drive.window.saveState(5))
    QSettings().setValue(f"{GROUP}/own", "[{")
    QSettings().setValue(f"{GROUP}/current", "gone")
    drive.workspaces.restore()
    assert drive.workspaces.current == "graph" and [t.id for t in drive.workspaces.tabs] == IDS
    assert {"library", "graph", "character", "properties"} == seen(drive)
    assert QSettings().value(OLD) is None


@pytest.mark.nightly
@pytest.mark.fresh_window
def test_a_workspace_of_ones_own_is_saved_renamed_reset_and_deleted(drive, qtbot, monkeypatch):
    drive.workspaces.choose("talk")
    drive.shell.places.show("lines")
    monkeypatch.setattr(QInputDialog, "getText", lambda *a, **k: (" Two  at a desk ", True))
    drive.do("save_workspace")
    assert tabs(drive).buttons[-1].text() == "Two at a desk" and tabs(drive).buttons[-1].isChecked()
    drive.docks["lines"].close()
    drive.do("arrange")
    assert not drive.docks["lines"].isHidden(), "it goes back to how it was saved"
    warned = []
    monkeypatch.setattr(QMessageBox, "warning", lambda *a: warned.append(a[2]))
    for taken in ("two at a DESK", "Label", "  "):
        monkeypatch.setattr(QInputDialog, "getText", lambda *a, t=taken, **k: (t, True))
        drive.do("save_workspace")
    assert len(warned) == 3 and len(drive.workspaces.tabs) == 6
    monkeypatch.setattr(QInputDialog, "getText", lambda *a, **k: ("Desk", True))
    drive.do("rename_workspace")
    other = again(drive, qtbot)
    try:
        assert other.workspaces.tab.title == "Desk" and not other.docks["lines"].isHidden()
        QTest.keyClick(other.window, Qt.Key.Key_6, CONTROL_ALT)
        other.do("delete_workspace")
        assert other.workspaces.current == "talk" and [t.id for t in other.workspaces.tabs] == IDS
        assert not other.actions["delete_workspace"].isEnabled()
        assert not other.actions["workspace_6"].isVisible()
        with pytest.raises(ValueError, match="is built in"):
            other.workspaces.delete()
        with pytest.raises(LookupError, match="no workspace 'own-1'"):
            other.workspaces.choose("own-1")
    finally:
        close(other.window)


@pytest.mark.nightly
def test_a_feature_opens_where_it_is_only_if_it_has_no_place_here(toys):
    drive = toys
    drive.workspaces.choose("graph")
    drive.show("problems")
    assert drive.workspaces.current == "graph" and "problems" in seen(drive)
    drive.workspaces.choose("talk")
    drive.show("problems")
    assert drive.workspaces.current == "graph", "among those who talk it has no place"
    drive.workspaces.choose("time")
    drive.show("timeline")
    assert drive.workspaces.current == "perform"
    drive.show("machine")
    assert drive.workspaces.current == "graph" and drive.machine.isVisible()
    drive.show("machine", False)
    drive.workspaces.choose("talk")
    drive.docks["problems"].show()  # by the menu of panels, anywhere
    drive.show("problems")
    assert drive.workspaces.current == "talk"


@pytest.mark.nightly
def test_a_window_becomes_as_small_whatever_was_opened_before(toys):
    drive = toys
    least: dict[str, tuple[int, int]] = {}
    for ident in [*IDS, *reversed(IDS), "graph"]:
        drive.workspaces.choose(ident)
        drive.session.set_mode("manual" if ident == "perform" else "meta")
        drive.pause(20)
        size = drive.window.minimumSizeHint().toTuple()
        assert least.setdefault(ident, size) == size
        assert size[0] <= 1280 and size[1] <= 720
    drive.session.set_mode("meta")


@pytest.mark.nightly
def test_what_a_window_wins_is_shared_out(toys):
    drive = toys
    drive.workspaces.choose("graph")
    fit(drive, 1280, 800)
    before = {n: drive.docks[n].width() for n in ("library", "graph", "character")}
    fit(drive, 1680, 1020)
    for name, width in before.items():
        assert drive.docks[name].width() == pytest.approx(width * 1680 / 1280, rel=0.06), name
    fit(drive, 1280, 800)
    for name, width in before.items():
        assert drive.docks[name].width() == pytest.approx(width, abs=6), name
    fit(drive, 1680, 1020)


@pytest.mark.nightly
def test_no_word_is_cut_at_the_least_size(toys):
    drive = toys
    action = next(a for a in drive.document.project.actions() if a.kind == "gesture")
    for ident in IDS:
        drive.workspaces.choose(ident)
        fit(drive, 1280, 720)
        drive.session.selection.select_actions((action.id,))
        drive.pause(30)
        for name in seen(drive):
            room = drive.docks[name].widget()
            assert isinstance(room, QScrollArea)
            assert room.widget().width() <= room.viewport().width(), f"{name} is cut in {ident}"
        for button in drive.window.header.findChildren(QToolButton):
            if button.text() and button.isVisible():
                assert button.width() >= button.sizeHint().width(), f"{button.text()} is cut in {ident}"
        for label in drive.window.header.findChildren(QLabel):
            assert label.width() >= label.sizeHint().width()
        assert drive.window.header.sizeHint().width() <= 1280, "something is behind the header's end"
    fit(drive, 1680, 1020)
