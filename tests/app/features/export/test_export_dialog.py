"""The export dialog through the real window: a target is chosen, its losses are read, it is written, and
remembered for the project.
"""

from __future__ import annotations

import json

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMessageBox

from metagraph.engines.targets import registry

pytestmark = [pytest.mark.window, pytest.mark.gl]


def opened(drive):
    from app.features.export.export_dialog import ExportDialog

    drive.actions["export"].trigger()
    dialog = drive.window.findChildren(ExportDialog)[-1]
    drive.pause(50)
    return dialog


def pick(drive, dialog, name: str) -> None:
    """Click a target in the list."""
    from app.features.export.export_dialog import NAME
    from app.widgets.tree_items import list_items_below, list_top_items

    items = [item for group in list_top_items(dialog.targets) for item in list_items_below(group)]
    item = next(i for i in items if i.data(0, NAME) == name)
    dialog.targets.scrollToItem(item)  # as one would by the wheel: the list is longer than its view
    spot = dialog.targets.visualItemRect(item).center()
    assert dialog.targets.viewport().rect().contains(spot)
    QTest.mouseClick(dialog.targets.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(spot.x(), spot.y()))
    drive.pause(30)


def put(dialog, folder: str) -> None:
    """Type a folder."""
    dialog.folder.selectAll()
    QTest.keyClicks(dialog.folder, folder)


@pytest.mark.nightly
def test_every_target_is_offered_and_says_what_it_writes_and_loses(toys):
    drive = toys
    dialog = opened(drive)
    for name, target in registry.list_targets().items():
        pick(drive, dialog, name)
        assert dialog.target.name == name
        assert target.files[:20] in dialog.words.text()
        for words in registry.describe_losses(drive.document.project, name):
            assert words[:25] in dialog.losses.text().replace("&#x27;", "'")
        assert ("Experimental" in dialog.losses.text()) == bool(target.untried)
        assert dialog.vectors.isHidden() == (target.group != "Same playback as the preview")
        assert dialog.compress.isHidden() != target.unpacks
    dialog.reject()


@pytest.mark.nightly
def test_a_group_cannot_be_chosen(toys):
    drive = toys
    dialog = opened(drive)
    before = dialog.target
    from app.widgets.tree_items import list_top_items

    spot = dialog.targets.visualItemRect(list_top_items(dialog.targets)[-1]).center()
    QTest.mouseClick(dialog.targets.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    assert dialog.target is before
    dialog.reject()


@pytest.mark.nightly
def test_a_target_is_written_and_remembered_with_its_options(toys, tmp_path):
    drive = toys
    dialog = opened(drive)
    pick(drive, dialog, "xstate")
    put(dialog, str(tmp_path / "chart"))
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.open_button.isEnabled(), 60)
    chart = next((tmp_path / "chart").glob("*.xstate.json"))
    assert json.loads(chart.read_bytes())["type"] == "parallel"
    assert chart.name in dialog.words.text()
    dialog.reject()
    again = opened(drive)
    assert again.target.name == "xstate"
    assert again.folder.text() == str(tmp_path / "chart")
    again.reject()


@pytest.mark.nightly
def test_vectors_and_tools_are_written_where_they_are_asked_for(toys, tmp_path):
    drive = toys
    dialog = opened(drive)
    pick(drive, dialog, "metagraph")
    put(dialog, str(tmp_path / "game"))
    QTest.mouseClick(dialog.vectors, Qt.MouseButton.LeftButton, pos=QPoint(8, dialog.vectors.height() // 2))
    QTest.mouseClick(dialog.tools, Qt.MouseButton.LeftButton, pos=QPoint(8, dialog.tools.height() // 2))
    assert dialog.vectors.isChecked() and dialog.tools.isChecked()
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.open_button.isEnabled(), 60)
    assert (tmp_path / "game" / "vectors.json").is_file()
    (tools,) = (tmp_path / "game").glob("*.tools.json")
    assert "gesture" in tools.read_text()
    dialog.reject()
    assert opened(drive).tools.isChecked()


@pytest.mark.nightly
def test_a_glb_is_packed_where_that_is_asked_for_and_its_target_reads_it(toys, tmp_path):
    drive = toys
    dialog = opened(drive)
    pick(drive, dialog, "javascript")
    assert dialog.compress.isChecked(), "its runtime unpacks it"
    pick(drive, dialog, "cpp")
    assert not dialog.compress.isChecked()
    QTest.mouseClick(dialog.compress, Qt.MouseButton.LeftButton, pos=QPoint(8, dialog.compress.height() // 2))
    assert dialog.compress.isChecked()
    for name, packed in (("cpp", True), ("godot", False), ("javascript", True)):
        pick(drive, dialog, name)
        put(dialog, str(tmp_path / name))
        QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
        drive.wait(lambda: dialog.open_button.isEnabled(), 60)
        (glb,) = (tmp_path / name).glob("*.glb")
        assert (b"EXT_meshopt_compression" in glb.read_bytes()) == packed
    dialog.reject()


def test_the_size_is_told_before_anything_is_written(toys, tmp_path):
    drive = toys
    dialog = opened(drive)
    pick(drive, dialog, "javascript")
    drive.wait(lambda: "MB in" in dialog.sized.text(), 60)
    packed = dialog.sized.text()
    assert "of it in the GLB" in packed
    QTest.mouseClick(dialog.compress, Qt.MouseButton.LeftButton, pos=QPoint(8, dialog.compress.height() // 2))
    drive.wait(lambda: dialog._wanted() in dialog.sizes, 60)
    put(dialog, str(tmp_path / "game"))
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.open_button.isEnabled(), 60)
    written = sum(path.stat().st_size for path in (tmp_path / "game").rglob("*") if path.is_file())
    told = dialog.sizes[dialog._wanted()]
    record = next((tmp_path / "game").glob(".metagraph-export.json"), None)
    kept = record.stat().st_size if record is not None else 0
    assert told.bytes == written - kept
    pick(drive, dialog, "xstate")
    drive.wait(lambda: "MB in" in dialog.sized.text() and dialog.target.name == "xstate", 60)
    dialog.reject()


@pytest.mark.nightly
@pytest.mark.parametrize(
    "kept", ["nonsense", "[1]", '{"target": "no such", "folder": "/x"}', '{"colour": 1}']
)
def test_a_memory_that_cannot_be_read_is_as_none(toys, kept):
    from PySide6.QtCore import QSettings

    drive = toys
    first = opened(drive)
    QSettings().setValue(first._key(), kept)
    first.reject()
    assert opened(drive).target.name == registry.DEFAULT


@pytest.mark.nightly
def test_a_web_page_is_opened_in_the_browser_and_all_else_as_a_folder(toys, tmp_path, monkeypatch):
    import urllib.request

    from app.features.export import export_dialog as panel
    from metagraph.engines.targets import web

    opened_urls = []
    monkeypatch.setattr(panel.QDesktopServices, "openUrl", opened_urls.append)  # None: no program opened
    monkeypatch.setattr(web, "is_three_at_hand", lambda: False)
    drive = toys
    dialog = opened(drive)
    for name, words in (("web", "Open in browser"), ("bml", "Open folder")):
        pick(drive, dialog, name)
        put(dialog, str(tmp_path / name))
        QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
        drive.wait(
            lambda words=words: (
                dialog.open_button.isEnabled()
                and dialog.open_button.text() == words
                and dialog.go.isEnabled()
            ),
            60,
        )
        QTest.mouseClick(dialog.open_button, Qt.MouseButton.LeftButton)
        assert "opened" in dialog.trouble.text(), "where nothing opens, this says so"
        assert opened_urls[-1].path() in dialog.words.text() + dialog.trouble.text(), "and where it is"
    page, folder = opened_urls
    with urllib.request.urlopen(page.toString(), timeout=10) as answer:
        assert b"player/main.js" in answer.read()
    assert folder.toLocalFile() == str(tmp_path / "bml")
    dialog.reject()


@pytest.mark.nightly
def test_each_target_has_a_folder_of_its_own_and_its_own_result(toys, tmp_path, monkeypatch):
    from metagraph.engines.targets import web

    monkeypatch.setattr(web, "is_three_at_hand", lambda: False)
    drive = toys
    drive.document.save(tmp_path / "toy.metagraph.yaml")
    dialog = opened(drive)
    folders = {}
    for name in registry.list_targets():
        pick(drive, dialog, name)
        folders[name] = dialog.folder.text()
    assert len(set(folders.values())) == len(folders)
    pick(drive, dialog, "web")
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.open_button.isEnabled(), 60)
    page = (tmp_path / "toy-export" / "web" / "index.html").read_bytes()
    pick(drive, dialog, "unity")
    assert not dialog.open_button.isEnabled() and "Wrote" not in dialog.words.text(), (
        "what was written is the page"
    )
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.open_button.isEnabled(), 60)
    pick(drive, dialog, "web")
    assert "Wrote" in dialog.words.text() and "index.html" not in dialog.folder.text()
    assert (tmp_path / "toy-export" / "web" / "index.html").read_bytes() == page
    dialog.reject()


def test_files_of_another_origin_are_asked_about_before_they_are_overwritten(toys, tmp_path):
    drive = toys
    (tmp_path / "toy.xstate.json").write_text("mine")
    dialog = opened(drive)
    pick(drive, dialog, "xstate")
    put(dialog, str(tmp_path))
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: any(box.isVisible() for box in dialog.findChildren(QMessageBox)), 60)
    box = next(box for box in dialog.findChildren(QMessageBox) if box.isVisible())
    assert "toy.xstate.json" in box.informativeText()
    assert (tmp_path / "toy.xstate.json").read_text() == "mine"
    overwrite = next(b for b in box.buttons() if b.text().replace("&", "") == "Overwrite")
    QTest.mouseClick(overwrite, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.open_button.isEnabled(), 60)
    assert json.loads((tmp_path / "toy.xstate.json").read_bytes())["type"] == "parallel"
    dialog.reject()


@pytest.mark.nightly  # each target is written in tests/engines/test_targets.py
def test_every_target_is_written_by_a_click(toys, tmp_path):
    """One after the other, each into a folder of its own; an avatar, which needs a mesh, says so."""
    drive = toys
    dialog = opened(drive)
    refused, written = {}, []
    told = drive.document.exported.connect(lambda: written.append(dialog.target.name))
    for name in registry.list_targets():
        pick(drive, dialog, name)
        put(dialog, str(tmp_path / name))
        QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
        drive.wait(lambda n=name: n in dialog.results or bool(dialog.trouble.text()), 60)
        if name in dialog.results:
            assert any(path.is_file() for path in (tmp_path / name).rglob("*")), name
            assert dialog.open_button.isEnabled() and dialog.words.text().startswith("Wrote "), name
        else:
            refused[name] = dialog.trouble.text()
    dialog.reject()
    drive.document.exported.disconnect(told)
    assert refused.keys() == {"vrm"} and "choose a mesh" in refused["vrm"]
    assert written == list(dialog.results)


def test_an_export_that_is_cancelled_writes_nothing_and_can_be_begun_again(toys, tmp_path, monkeypatch):
    drive = toys
    dialog = opened(drive)
    pick(drive, dialog, "xstate")
    put(dialog, str(tmp_path / "chart"))
    write = registry.write_for_target

    def cancelled(*given):
        dialog.jobs.running[-1].cancel()
        return write(*given)

    monkeypatch.setattr(registry, "write_for_target", cancelled)
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.go.isEnabled(), 60)
    assert not (tmp_path / "chart").exists() and not dialog.open_button.isEnabled()
    assert dialog.progress.isHidden() and not dialog.trouble.text()
    monkeypatch.setattr(registry, "write_for_target", write)
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: dialog.open_button.isEnabled(), 60)
    assert list((tmp_path / "chart").glob("*.json"))
    dialog.reject()
