"""Each system's folders for caches and for what programs remember, as the user may have moved them."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from metagraph.common.user_folders import find_user_folder


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    for name in ("LOCALAPPDATA", "APPDATA", "XDG_CACHE_HOME", "XDG_DATA_HOME"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.mark.parametrize(
    ("system", "caches", "data"),
    [
        ("linux", ".cache", ".local/share"),
        ("win32", "AppData/Local", "AppData/Roaming"),
        ("darwin", "Library/Caches", "Library/Application Support"),
    ],
)
def test_each_system_has_its_places(
    home: Path, monkeypatch: pytest.MonkeyPatch, system: str, caches: str, data: str
) -> None:
    monkeypatch.setattr(sys, "platform", system)
    assert find_user_folder("caches") == home / caches and find_user_folder("data") == home / data


def test_a_variable_goes_first_and_an_empty_one_says_nothing(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_DATA_HOME", "/elsewhere")
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    assert find_user_folder("data") == Path("/elsewhere") and find_user_folder("caches") == home / ".cache"


def test_where_nobodys_home_is_known_there_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless() -> Path:
        raise RuntimeError

    monkeypatch.setattr(Path, "home", homeless)
    assert find_user_folder("caches") is None
