"""What is made once for all processes that test."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.made_once import made_once


@pytest.fixture
def factory(tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch):
    """Temporary folders as a process of several has them."""
    monkeypatch.setenv("PYTEST_XDIST_WORKER", "gw7")
    monkeypatch.setattr(tmp_path_factory, "_basetemp", tmp_path / "popen-gw7")
    (tmp_path / "popen-gw7").mkdir()
    return tmp_path_factory


def test_what_fails_is_made_anew_and_nothing_of_it_is_left(factory: pytest.TempPathFactory) -> None:
    def fails(folder: Path) -> None:
        (folder / "half").touch()
        raise ValueError("no")

    with pytest.raises(ValueError):
        made_once(factory, "thing", fails)
    folder = made_once(factory, "thing", lambda folder: (folder / "whole").touch())
    assert [p.name for p in folder.iterdir()] == ["whole"]


def test_it_is_made_once_and_each_name_has_its_own(factory: pytest.TempPathFactory, tmp_path: Path) -> None:
    made: list[Path] = []
    found = {made_once(factory, name, made.append) for name in ("a", "b", "a")}
    assert len(made) == 2 and found == set(made)


def test_another_process_finds_it(
    factory: pytest.TempPathFactory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = made_once(factory, "thing", lambda folder: (folder / "whole").touch())
    monkeypatch.setattr(factory, "_basetemp", tmp_path / "popen-gw8")
    (tmp_path / "popen-gw8").mkdir()
    assert made_once(factory, "thing", lambda folder: None) == first
    assert (first / "whole").exists()
