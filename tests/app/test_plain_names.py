"""Names and texts from a stranger's file are shown as they are: Qt takes none for HTML, and opens no picture
that one names.
"""

from __future__ import annotations

import ctypes
import json
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication, QInputDialog, QLabel, QMessageBox, QToolTip, QWidget

from app.features.study.study_screen import format_markdown
from app.project.files import SAMPLE
from app.shell.workspaces import WORKSPACES
from tests.app.every_dialog import DIALOGS, opened
from tests.app.shared_window import settle

pytestmark = pytest.mark.window
NAMING = {"name", "text", "clip_name", "line", "stance", "notes", "message"}
FILES = {"path", "audio", "phones", "character"}


@pytest.fixture
def picture(tmp_path: Path, qapp: object) -> Path:
    path = tmp_path / "seen.png"
    image = QImage(8, 8, QImage.Format.Format_RGB32)
    image.fill(0)
    assert image.save(str(path))
    return path


@pytest.fixture
def openings(picture: Path) -> Iterator[Callable[[], int]]:
    """How often the picture was opened since it was last asked; on Linux the system tells."""
    if not sys.platform.startswith("linux"):
        yield lambda: 0
        return
    system = ctypes.CDLL(None)
    line = system.inotify_init1(os.O_NONBLOCK)
    assert system.inotify_add_watch(line, os.fsencode(picture), 0x20) > 0  # IN_OPEN

    def count() -> int:
        try:
            return len(os.read(line, 1 << 16)) // 16
        except BlockingIOError:
            return 0

    yield count
    os.close(line)


def hostile(data: Any, bad: str, key: str = "") -> Any:
    """Return a project's data with a tag of HTML in front of each name and text, and files by their whole paths."""
    if isinstance(data, dict):
        own = key == "lines"  # keys are names there
        return {
            bad + k if own else k: v
            if k == "skeleton" or (k == "stance" and "kind" in data)
            else hostile(v, bad, k)
            for k, v in data.items()
        }
    if isinstance(data, list):
        return [hostile(v, bad, key) for v in data]
    if not isinstance(data, str):
        return data
    return (
        str(SAMPLE.parent / data) if key in FILES else bad + data if key in NAMING or key == "tags" else data
    )


def shown_as_rich() -> list[str]:
    """Return the labels on the screen that would show HTML from a file, or guess whether their text is HTML."""
    labels = [w for w in QApplication.allWidgets() if isinstance(w, QLabel) and w.isVisible()]
    return [
        f"{w.textFormat().name} {w.text()}"
        for w in labels
        if w.textFormat() not in (Qt.TextFormat.PlainText, Qt.TextFormat.RichText)
        or (w.textFormat() == Qt.TextFormat.RichText and "<img" in w.text())
    ]


def tips(root: QWidget) -> list[str]:
    """Show the tooltip of each widget; return those that are shown as HTML."""
    out = []
    for widget in [root, *root.findChildren(QWidget)]:
        if "<img" in widget.toolTip():
            QToolTip.showText(QPoint(5, 5), widget.toolTip(), widget)
            out += shown_as_rich()
            QToolTip.hideText()
    return out


@pytest.mark.nightly
@pytest.mark.gl
def test_no_panel_dialog_or_tooltip_takes_a_name_for_html(
    drive: Any, picture: Path, openings: Callable[[], int], tmp_path: Path
) -> None:
    bad = f"<img src='{picture}'>"
    data = hostile(yaml.safe_load(SAMPLE.read_text("utf-8")), bad)
    data["clips"].append({"id": "c999", "name": bad, "path": f"{bad}.bvh"})
    path = tmp_path / "<img src=x>.metagraph.yaml"
    path.write_text(json.dumps(data), "utf-8")  # which is YAML, too
    drive.files.open(path)
    drive.wait(lambda: len(drive.document.project.clips) == len(data["clips"]), 60)
    assert all(a.name.startswith("<img") for a in drive.document.project.actions())
    found: dict[str, list[str]] = {}
    action = next(a for a in drive.document.project.actions() if a.kind == "gesture" and a.layer == "arms")
    for workspace in WORKSPACES:
        drive.workspaces.choose(workspace.id)
        talk = next(iter(drive.document.project.conversations)) if workspace.id == "talk" else None
        drive.session.onstage.set_conversation(talk)
        drive.session.jump(action=action.id)
        drive.session.transport.set_playing(False)
        settle(drive.window)
        found[workspace.id] = shown_as_rich() + tips(drive.window)
    drive.session.onstage.set_conversation(None)
    for panel in ("machine", "models", "problems", "lines", "life"):
        drive.show(panel)
        settle(drive.window)
        found[panel] = shown_as_rich() + tips(drive.window)
    drive.show("machine", False)
    drive.session.selection.select_clips((action.clip,))
    settle(drive.window)
    found["clip"] = shown_as_rich() + tips(drive.window)
    for name, open_it in DIALOGS.items():
        open_it(drive, tmp_path)
        drive.wait(lambda: bool(opened()))
        drive.pause(30)
        found[name] = shown_as_rich() + [line for dialog in opened() for line in tips(dialog)]
        while opened():
            opened()[-1].reject()
    assert not {k: v for k, v in found.items() if v}
    assert openings() == 0


@pytest.mark.nightly
def test_boxes_and_tooltips_of_qt_show_text_as_it_is(
    drive: Any, picture: Path, openings: Callable[[], int]
) -> None:
    bad = f"<img src='{picture}'> of <b>somebody</b>"
    box = QMessageBox(QMessageBox.Icon.Warning, "Metagraph", bad, parent=drive.window)
    box.setInformativeText(bad)
    ask = QInputDialog(drive.window)
    ask.setLabelText(bad)
    label = QLabel(bad, drive.window)
    for words in (bad, f"{bad} again"):
        QToolTip.showText(QPoint(5, 5), words, drive.window)
        tip = next(w for w in QApplication.topLevelWidgets() if w.inherits("QTipLabel") and w.isVisible())
        assert isinstance(tip, QLabel) and tip.text() == words
        assert not shown_as_rich()
    QToolTip.hideText()
    for widget in (box, ask, label):
        widget.show()
    drive.pause(20)
    assert not shown_as_rich() and openings() == 0
    for widget in (box, ask, label):
        widget.close()
        widget.deleteLater()


def test_text_of_the_programs_own_is_still_rich(drive: Any) -> None:
    before = opened()  # a test before this one may have left something
    drive.do("about")
    (box,) = [one for one in opened() if one not in before]
    (words,) = [w for w in box.findChildren(QLabel) if "Metagraph" in w.text()]
    assert words.textFormat() == Qt.TextFormat.RichText
    box.reject()


@pytest.mark.nightly
def test_a_studys_text_shows_html_as_written_and_a_picture_as_its_words(
    drive: Any, picture: Path, openings: Callable[[], int]
) -> None:
    text = (
        f"Do **this** <img src='{picture}'> ![a hand]({picture}) ![]({picture})![two][1]\n\n"
        f"<div style='background-image:url({picture})'>d</div>\n\n"
        f"- ![in a list]({picture})\n\n| a |\n|---|\n| ![in a table]({picture}) |\n\n[1]: {picture}\n"
    )
    label = QLabel(format_markdown(text, 15), drive.window)
    label.setTextFormat(Qt.TextFormat.RichText)
    label.show()
    drive.pause(20)
    assert (
        openings() == 0
        and "<img" not in label.text()
        and "background-image" not in label.text().split("&lt;div")[0]
    )
    assert 'font-weight:700;">this' in label.text() and "&lt;img src=" in label.text()
    assert all(words in label.text() for words in ("a hand", "two", "in a list", "in a table"))
    label.close()
    label.deleteLater()
