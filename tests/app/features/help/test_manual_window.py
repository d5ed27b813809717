"""The manual in the window: the page of the panel that has the keyboard, links, search, ways back, themes."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt, QUrl
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMessageBox

from app.features.help import manual_pages
from app.features.help.manual_window import ManualWindow
from app.shell.actions import SUBMENUS

pytestmark = [pytest.mark.window, pytest.mark.gl]
ROOT = Path(__file__).resolve().parents[4]


def opened(drive) -> ManualWindow:
    return drive.window.findChildren(ManualWindow)[-1]


def page(manual: ManualWindow) -> str:
    return Path(manual.browser.source().toLocalFile()).relative_to(manual_pages.DOCS).as_posix()


def read(drive, name: str) -> ManualWindow:
    drive.do("handbook")
    manual = opened(drive)
    manual.open_page(name)
    return manual


def test_every_panel_has_a_page_that_exists(toys):
    assert set(manual_pages.PAGES) == set(toys.shell.places.panels)
    listed = {entry.page for entry in manual_pages.list_manual_entries()}
    assert {*manual_pages.PAGES.values(), manual_pages.FIRST} <= listed
    assert all((manual_pages.DOCS / name).is_file() for name in listed if name)


@pytest.mark.nightly
def test_f1_opens_the_page_of_the_panel_that_has_the_keyboard(toys):
    for panel, field in (("library", toys.library.search), ("graph", toys.canvas)):
        toys.window.activateWindow()
        toys.wait(toys.window.isActiveWindow)
        field.setFocus()
        toys.wait(field.hasFocus)
        QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_F1)
        manual = opened(toys)
        toys.wait(lambda m=manual, p=panel: m.isVisible() and page(m) == manual_pages.PAGES[p])
        assert manual.tree.currentItem().data(0, Qt.ItemDataRole.UserRole).page == page(manual)
        toys.wait(manual.isActiveWindow)
        QTest.keyClick(manual.tree, Qt.Key.Key_Escape)
        toys.wait(lambda m=manual: not m.isVisible())
    assert len(toys.window.findChildren(ManualWindow)) == 1


def test_links_are_underlined_and_other_words_are_not(toys):
    manual = read(toys, "start/ten-minutes.md")
    lined = set()
    block = manual.browser.document().begin()
    while block.isValid():
        place = block.begin()
        while not place.atEnd():
            form = place.fragment().charFormat()
            lined.add((form.isAnchor(), form.fontUnderline()))
            place += 1
        block = block.next()
    assert lined == {(True, True), (False, False)}
    manual.close()


@pytest.mark.nightly
def test_links_lead_on_and_keys_lead_back(toys):
    manual = read(toys, "index.md")
    manual.browser.anchorClicked.emit(QUrl("animators/talk.md#edit-the-segments"))
    assert page(manual) == "animators/talk.md"
    toys.wait(lambda: manual.browser.verticalScrollBar().value() > 0)
    toys.wait(manual.isActiveWindow)
    QTest.keyClick(manual, Qt.Key.Key_Left, Qt.KeyboardModifier.AltModifier)
    toys.wait(lambda: page(manual) == "index.md")
    QTest.keyClick(manual, Qt.Key.Key_Right, Qt.KeyboardModifier.AltModifier)
    toys.wait(lambda: page(manual) == "animators/talk.md")
    manual.browser.anchorClicked.emit(QUrl("https://example.org"))
    assert page(manual) == "animators/talk.md", "nothing comes from a network"
    manual.close()


@pytest.mark.nightly
def test_what_is_searched_for_is_listed_and_enter_opens_the_first(toys):
    manual = read(toys, "index.md")
    QTest.keyClicks(manual.search, "loop range")
    hits = [manual.tree.topLevelItem(n).text(0) for n in range(manual.tree.topLevelItemCount())]
    assert "Use the timeline – Perform" in hits
    QTest.keyClick(manual.search, Qt.Key.Key_Return)
    toys.wait(lambda: page(manual) == manual.tree.topLevelItem(0).data(0, Qt.ItemDataRole.UserRole).page)
    manual.search.setText("zzyzx")
    assert manual.tree.topLevelItem(0).text(0) == "No page has these words."
    QTest.keyClick(manual.search, Qt.Key.Key_Return)
    manual.search.clear()
    assert manual.tree.topLevelItemCount() > 5
    manual.close()


@pytest.mark.nightly
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_pages_have_the_windows_colours_and_pictures_the_room_there_is(toys, theme):
    before = toys.session.look.name
    toys.session.look.choose(theme)
    try:
        manual = read(toys, "animators/perform.md")
        toys.wait(lambda: manual.browser.document().size().width() > 0)
        assert manual.browser.document().size().width() <= manual.browser.viewport().width() + 1
        ground = manual.browser.viewport().grab().toImage().pixelColor(QPoint(3, 3)).lightness()
        assert (ground < 80) == (theme == "dark")
        manual.close()
    finally:
        toys.session.look.choose(before)


NO_COMMANDS = {"View > Panels": "a list of all panels"}
WORDS = re.compile(r"(?<!\*)\*([^*\n]+(?:\n[^*\n]+)?)\*(?!\*)")


def test_menus_that_pages_for_animators_name_are_there(toys):
    menus: dict[str, set[str]] = {}
    for command in toys.actions.commands:
        inside = SUBMENUS.get(command.menu, {}).get(command.group)
        path = f"{inside} > {command.plain}" if inside else command.plain
        menus.setdefault(command.menu.replace("&", ""), set()).add(path.replace("&", ""))
    wrong = []
    for place in ("README.md", "docs/index.md", *(p for f in ("start", "animators") for p in files(f))):
        for words in WORDS.findall((ROOT / place).read_text(encoding="utf-8")):
            menu, _, entry = " ".join(words.split()).partition(" > ")
            if entry and menu in menus and entry.partition("…")[0] not in menus[menu]:
                wrong += [] if words.startswith(tuple(NO_COMMANDS)) else [(str(place), words)]
    assert not wrong


def files(folder: str) -> list[Path]:
    return sorted((ROOT / "docs" / folder).glob("*.md"))


def test_admonitions_are_told_by_a_bold_word():
    text = manual_pages.format_for_qt(
        'a\n\n!!! note\n    one\n\n    two\n\nb\n!!! warning "Limits"\n    x\n', {"note": "N"}
    )
    assert text == "a\n\n> **N**\n>\n> one\n\n> two\n\nb\n> **Limits**\n>\n> x\n"


@pytest.mark.nightly
def test_a_copy_without_a_manual_says_so(toys, monkeypatch, tmp_path):
    monkeypatch.setattr(manual_pages, "DOCS", tmp_path)
    toys.do("handbook")
    box = toys.window.findChildren(QMessageBox)[-1]
    assert "came without its manual" in box.text()
    box.close()


def test_the_page_of_shortcuts_is_the_windows(toys):
    """Else: `xvfb-run python docs/keyboard_page.py`."""
    made = runpy.run_path(str(ROOT / "docs" / "keyboard_page.py"))
    assert made["PAGE"].read_text(encoding="utf-8") == made["page"](toys.actions)
