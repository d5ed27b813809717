"""What extras there are, and how each way of installing Metagraph gets them."""

from __future__ import annotations

import pickle
import sys

import pytest

from metagraph.common import extras
from metagraph.common.extras import EXTRAS
from metagraph.common.wording import phrase
from metagraph.errors import FileError


@pytest.fixture
def install(tmp_path, monkeypatch):
    """An installation whose marks are the files that are made in its folders."""
    (tmp_path / "program").mkdir()
    (tmp_path / "python").mkdir()
    monkeypatch.setattr(extras, "ROOT", tmp_path / "program")
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "python"))
    return tmp_path


def test_extras_are_those_that_the_package_offers():
    import tomllib

    offered = tomllib.loads((extras.ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    declared = offered["project"]["optional-dependencies"]
    for name, extra in EXTRAS.items():
        assert declared.get(name) == (None if extra.holds else [extra.wants[0]])


@pytest.mark.parametrize(
    ("marks", "way", "begins"),
    [
        (("program/bundled",), "bundle", "metagraph extras add lab"),
        (("program/run.py", "python/.installed"), "run.py", "PYTHON -m pip install"),
        (("program/run.py",), "pip", "PYTHON -m pip install"),
        (("python/uv-receipt.toml",), "uv", "uv tool install metagraph-studio --with"),
        (("python/pipx_metadata.json",), "pipx", 'pipx inject metagraph-studio "pylsl>=1.16"'),
        ((), "pip", "PYTHON -m pip install"),
    ],
)
def test_the_command_is_that_of_the_way_it_was_installed(install, marks, way, begins):
    for mark in marks:
        (install / mark).touch()
    assert extras.find_way() == way
    assert extras.can_install("lab") is (way in ("bundle", "run.py"))
    python = extras.join_command([sys.executable])
    assert extras.make_install_command("lab").startswith(begins.replace("PYTHON", python))
    assert "pylsl" in extras.make_remove_command("lab") or way in ("bundle", "uv")
    offline = extras.make_offline_command("lab")
    assert way not in ("uv", "pipx") or f"{sys.executable} -m pip" not in offline, "they have no pip"
    assert "metagraph-lab" in offline and ("--no-index" in offline or way == "bundle")


def test_a_tool_of_uv_keeps_its_other_extras_when_one_comes_or_goes(install, monkeypatch):
    (install / "python" / "uv-receipt.toml").touch()
    monkeypatch.setattr(extras, "is_installed", lambda name: name == "fbx")
    added = extras.make_install_command("lab")
    assert added == 'uv tool install metagraph-studio --with "ufbx>=0.0.5" --with "pylsl>=1.16"'
    assert extras.make_remove_command("fbx") == "uv tool install metagraph-studio"


def test_the_files_for_another_computer_are_named_exactly():
    import numpy

    line = extras.make_download_command("compiled")
    assert line.startswith("python3 -m pip download --dest metagraph-compiled --only-binary :all:")
    assert f"--python-version {sys.version_info[0]}.{sys.version_info[1]} " in line
    assert '"numba>=0.60"' in line and f'"numpy=={numpy.__version__}"' in line
    assert "download.pytorch.org" in extras.make_download_command("train")
    assert "download.pytorch.org" not in extras.make_offline_command("train")


def test_a_missing_extra_is_found_in_what_is_said_of_it():
    words = extras.describe_missing_extra("fbx", phrase("Reading FBX"))
    error = pickle.loads(pickle.dumps(FileError("walk.fbx", "it is an FBX file", "on opening it", words)))
    assert extras.find_missing_extra(error) == "fbx"
    assert extras.find_missing_extra(error.words) == "fbx"
    assert extras.find_missing_extra(str(error)) is None, "plain text says nothing"
    assert extras.find_missing_extra(FileError("a", "b")) is None
    assert "6 MB on disk" in words and "Help > Extras" in words


def test_an_extra_that_lives_apart_is_got_in_one_way_wherever_metagraph_is(install):
    for mark in ("python/uv-receipt.toml", "python/pipx_metadata.json"):
        (install / mark).touch()
        assert extras.can_install("camera") and not extras.can_install("lab")
        assert extras.make_install_command("camera") == "metagraph extras add camera"
        assert extras.make_remove_command("camera") == "metagraph extras remove camera"
    assert "mediapipe" not in extras.make_install_command("lab"), "it is no package of this environment"
    assert " --no-deps " in extras.make_download_command("camera")
    assert extras.make_offline_command("camera").startswith("metagraph extras add camera --from")
