"""The menu entry of a bundle that was unpacked by hand."""

from __future__ import annotations

import configparser
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from app.bundle.folder import add_desktop_files
from app.project import menu_entry

pytestmark = pytest.mark.skipif(os.name == "nt", reason="Windows has no such entries")


@pytest.fixture
def bundle(tmp_path, monkeypatch):
    """An unpacked bundle in a folder with letters that need care, and a home of its own."""
    folder = tmp_path / 'Мои $1 "100%" программы' / "metagraph"
    add_desktop_files(folder / menu_entry.DESKTOP)
    (folder / "metagraph").write_text("#!/bin/sh\n")
    (folder / "metagraph").chmod(0o755)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    monkeypatch.setattr(sys, "prefix", str(folder / "python"))
    monkeypatch.setattr(menu_entry, "is_bundle", lambda: True)
    return folder


def test_it_comes_and_goes_without_a_trace_of_files(bundle, tmp_path):
    assert menu_entry.find_unpacked_bundle() == bundle and not menu_entry.is_in_menu(bundle)
    menu_entry.add_to_menu(bundle)
    data = tmp_path / "data"
    for name in ("applications/metagraph.desktop", "mime/packages/metagraph.xml"):
        assert (data / name).is_file()
    assert (data / "icons/hicolor/scalable/apps/metagraph.svg").is_file()
    assert menu_entry.is_in_menu(bundle)
    menu_entry.remove_from_menu()
    assert not menu_entry.is_in_menu(bundle)
    left = [p.name for p in data.rglob("*metagraph*") if p.is_file()]
    assert left == [] or left == ["application-x-metagraph.xml"]


def test_it_starts_this_bundle_by_its_whole_path(bundle, tmp_path):
    menu_entry.add_to_menu(bundle)
    path = tmp_path / "data" / "applications" / "metagraph.desktop"
    entry = configparser.ConfigParser(interpolation=None)
    entry.read(path, encoding="utf-8")
    text = entry["Desktop Entry"]["Exec"].replace("\\\\", "\\")  # first read as a text, then as a command
    words = subprocess.run(["sh", "-c", f"printf '%s\\n' {text}"], capture_output=True, text=True, check=True)
    assert words.stdout.splitlines() == [str(bundle / "metagraph").replace("%", "%%"), "window", "%F"]
    assert Path(entry["Desktop Entry"]["TryExec"]) == bundle / "metagraph"
    checker = shutil.which("desktop-file-validate")
    if checker is not None:
        said = subprocess.run([checker, path], capture_output=True, text=True, check=False).stdout
        assert "error" not in said, said


def test_an_entry_of_another_folder_is_not_this_ones(bundle):
    menu_entry.add_to_menu(bundle)
    moved = bundle.with_name("moved")
    shutil.copytree(bundle, moved)
    assert not menu_entry.is_in_menu(moved)


def test_one_that_a_package_installed_has_none_to_add(bundle, monkeypatch):
    (bundle / menu_entry.DESKTOP / "metagraph.desktop").unlink()
    assert menu_entry.find_unpacked_bundle() is None
    monkeypatch.setattr(menu_entry, "is_bundle", lambda: False)
    assert menu_entry.find_unpacked_bundle() is None
