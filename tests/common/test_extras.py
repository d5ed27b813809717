"""Extras are installed into the user's folder of a bundle, whole or not at all."""

from __future__ import annotations

import sys

import pytest

from metagraph.common import extras
from metagraph.common.extras import EXTRAS, ExtraError


@pytest.fixture
def bundle(tmp_path, monkeypatch):
    """A bundle and a home; pip is replaced by what `told` says."""
    (tmp_path / "program").mkdir()
    (tmp_path / "program" / "bundled").touch()
    monkeypatch.setattr(extras, "ROOT", tmp_path / "program")
    monkeypatch.setattr(extras, "find_user_folder", lambda kind: tmp_path / "home" / kind)
    (tmp_path / "home" / "data").mkdir(parents=True)
    monkeypatch.setattr(sys, "path", list(sys.path))
    return tmp_path


def pip(code=0, said="", files=("made_up.py",)):
    """Stand in for pip: write files where it is told to."""
    from pathlib import Path

    def run_program(command, timeout=None, **options):
        place = Path(command[command.index("--target") + 1])
        place.mkdir(parents=True)
        for name in files:
            (place / name).write_text("x = 1")
        return code, said

    return run_program


def test_an_extra_comes_into_a_folder_of_its_own_and_can_be_imported(bundle, monkeypatch):
    monkeypatch.setattr(extras, "run_program", pip())
    extras.install_extra("lab")
    place = extras.find_extras_folder() / "lab"
    assert (place / "made_up.py").is_file() and sys.path[-1] == str(place)
    assert not list(place.parent.parent.glob("*-new"))
    assert extras.remove_extra("lab") and not place.exists()
    assert not extras.remove_extra("lab"), "it is gone"


def test_what_the_bundle_has_is_not_kept_twice(bundle, monkeypatch):
    (extras.ROOT / "numpy.py").touch()
    monkeypatch.setattr(extras, "run_program", pip(files=("numpy.py", "numba.py")))
    extras.install_extra("lab")
    assert [path.name for path in (extras.find_extras_folder() / "lab").iterdir()] == ["numba.py"]


def test_what_fails_half_way_leaves_what_was_there(bundle, monkeypatch):
    monkeypatch.setattr(extras, "run_program", pip())
    extras.install_extra("lab")
    monkeypatch.setattr(extras, "run_program", pip(1, "ERROR: no network", ("half.py",)))
    with pytest.raises(ExtraError, match=r"no network.*Check the network"):
        extras.install_extra("lab")
    place = extras.find_extras_folder()
    assert [path.name for path in (place / "lab").iterdir()] == ["made_up.py"]
    assert [path.name for path in place.parent.iterdir()] == [place.name]


def test_pip_that_hangs_is_reported(bundle, monkeypatch):
    def hang(*_, **__):
        raise TimeoutError("pip took more than 1800 s")

    monkeypatch.setattr(extras, "run_program", hang)
    with pytest.raises(ExtraError, match="1800 s"):
        extras.install_extra("lab")


def test_outside_a_bundle_the_command_is_named(monkeypatch):
    with pytest.raises(ExtraError, match=r'pip install "metagraph-studio\[lab\]"'):
        extras.install_extra("lab")


def test_extras_are_those_that_the_package_offers():
    import tomllib

    offered = tomllib.loads((extras.ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    declared = offered["project"]["optional-dependencies"]
    for name, extra in EXTRAS.items():
        assert declared.get(name) == (None if extra.holds else [extra.wants[0]])


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A home, and a Metagraph that is no bundle."""
    monkeypatch.setattr(extras, "find_user_folder", lambda kind: tmp_path / kind)
    monkeypatch.setattr(sys, "version_info", (3, 12, 1))
    return tmp_path


def place_files(files, commands):
    """Stand in for pip: write files where it is told to, and remember the command."""
    from pathlib import Path

    def run_program(command, timeout=None, **options):
        commands.append(command)
        for name in files:
            path = Path(command[command.index("--target") + 1]) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
        return 0, ""

    return run_program


def test_an_extra_that_lives_apart_is_installed_anywhere_and_never_imported(home, monkeypatch):
    commands = []
    monkeypatch.setattr(extras, "run_program", place_files(EXTRAS["camera"].holds, commands))
    assert not extras.is_installed("camera") and extras.find_extra_folder("camera") is None
    before = list(sys.path)
    extras.install_extra("camera")
    folder = extras.find_extra_folder("camera")
    assert folder == home / "data" / "Metagraph" / "extras-3.12" / "camera"
    assert extras.is_installed("camera") and sys.path == before
    assert "--no-deps" in commands[0] and set(EXTRAS["camera"].wants) <= set(commands[0])
    assert extras.remove_extra("camera") and not extras.is_installed("camera")


def test_a_package_without_its_models_is_not_kept(home, monkeypatch):
    commands = []
    monkeypatch.setattr(extras, "run_program", place_files(["mediapipe/__init__.py"], commands))
    with pytest.raises(ExtraError, match="lacks the files"):
        extras.install_extra("camera")
    assert not extras.is_installed("camera") and not list((home / "data" / "Metagraph").glob("*-new"))


def test_a_python_without_packages_is_told_which_there_are(home, monkeypatch):
    monkeypatch.setattr(sys, "version_info", (3, 13, 0))
    with pytest.raises(ExtraError, match=r"Python 3\.12 and older.*runs with Python 3\.13"):
        extras.install_extra("camera")


def test_a_folder_that_others_write_to_is_not_used(home, monkeypatch):
    monkeypatch.setattr(extras, "run_program", place_files(EXTRAS["camera"].holds, []))
    extras.install_extra("camera")
    (home / "data" / "Metagraph" / "extras-3.12" / "camera").chmod(0o777)
    assert not extras.is_installed("camera")
