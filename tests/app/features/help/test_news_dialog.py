"""What is new, in the window."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app import main
from app.features.help import news_dialog
from app.features.help.news_dialog import NewsDialog
from app.shell import update_check
from app.shell.update_check import ALLOWED, SEEN, Release, UpdateError
from metagraph import __version__

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def address(tmp_path, monkeypatch):
    """A build that has an address; what asks it is replaced."""
    (tmp_path / update_check.ADDRESS).write_text("https://example.org/latest.json")
    monkeypatch.setattr(update_check, "ROOT", tmp_path)


def open_news(drive) -> NewsDialog:
    drive.do("news")
    dialog = drive.window.findChild(NewsDialog)
    drive.wait(dialog.isActiveWindow)
    return dialog


def close(drive, dialog):
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    drive.wait(lambda: not dialog.isVisible())
    dialog.setParent(None)


def test_the_changelog_is_shown_and_from_source_nothing_can_be_asked(drive):
    dialog = open_news(drive)
    assert dialog.heading.text() == f"Metagraph {__version__}" and "Added" in dialog.notes.toPlainText()
    assert not dialog.allow.isVisible() and not dialog.look.isVisible()
    assert "does not know where" in dialog.said.text()
    close(drive, dialog)


def test_only_who_allows_it_can_look(drive, address, monkeypatch):
    release = Release("9.0.0", "<b>Faster</b>", "https://example.org")
    monkeypatch.setattr(news_dialog, "find_update", lambda version, settings: release)
    dialog = open_news(drive)
    assert not dialog.allow.isChecked() and not dialog.look.isEnabled()
    QTest.mouseClick(dialog.allow, Qt.MouseButton.LeftButton, pos=dialog.allow.rect().center() * 0.1)
    dialog.allow.setChecked(True)
    assert str(drive.shell.settings.value(ALLOWED)) == "true"
    QTest.mouseClick(dialog.look, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.heading.text() == "Metagraph 9.0.0 is available")
    assert dialog.notes.toPlainText() == "<b>Faster</b>" and dialog.page.isVisible()
    assert "Install the new version the same way as this one" in dialog.said.text()
    close(drive, dialog)


def test_what_cannot_be_asked_is_said(drive, address, monkeypatch):
    def fail(version, settings):
        raise UpdateError("could not reach the server")

    drive.shell.settings.setValue(ALLOWED, "true")
    monkeypatch.setattr(news_dialog, "find_update", fail)
    dialog = open_news(drive)
    QTest.mouseClick(dialog.look, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.said.text() == "could not reach the server")
    assert dialog.look.isEnabled()
    close(drive, dialog)


def test_after_an_update_the_window_offers_what_is_new(drive):
    drive.shell.settings.setValue(SEEN, "0.0.9")
    main.tell_news(drive.window)
    notice = drive.shell.notice
    assert notice.isVisible() and notice.text() == f"What is new in Metagraph {__version__}…"
    notice.click()
    dialog = drive.window.findChild(NewsDialog)
    drive.wait(dialog.isActiveWindow)
    close(drive, dialog)
    main.tell_news(drive.window)
    assert not notice.isVisible()


def test_a_newer_release_is_offered_in_the_status_bar(drive, address, monkeypatch):
    monkeypatch.setattr(update_check, "find_update", lambda version, settings: Release("9.0.0", "New"))
    main.tell_news(drive.window)
    drive.settle()
    assert not drive.shell.notice.isVisible(), "it is off as it comes"
    drive.shell.settings.setValue(ALLOWED, "true")
    main.tell_news(drive.window)
    drive.wait(lambda: drive.shell.notice.text() == "Metagraph 9.0.0 is available…")
    drive.shell.notice.click()
    dialog = drive.window.findChild(NewsDialog)
    assert dialog.heading.text() == "Metagraph 9.0.0 is available"
    drive.wait(dialog.isActiveWindow)
    close(drive, dialog)
