"""Files that can be made again: they come back, do not grow without bounds, and what is used stays."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from metagraph.common.disk_cache import LEFT, DiskCache, cache_folder


def aged(folder: Path, ages: dict[str, float]) -> None:
    for path in folder.glob("*/*"):
        if path.parent.name in ages:
            os.utime(path, (1, time.time() - ages[path.parent.name]))


def test_what_is_kept_comes_back_whole_and_what_is_dropped_does_not(tmp_path: Path) -> None:
    cache = DiskCache(tmp_path / "not there yet", 1000, ".x")
    assert cache.read("aabb") is None
    cache.write("aabb", b"one")
    cache.write("aabb", b"two")
    assert cache.read("aabb") == b"two"
    assert [p.name for p in tmp_path.rglob("*.x*")] == ["bb.x"], "nothing half-written is left"
    cache.drop("aabb")
    cache.drop("aabb")
    assert cache.read("aabb") is None


def test_beyond_its_bytes_what_was_unused_longest_goes_as_soon_as_it_is_written(tmp_path: Path) -> None:
    cache = DiskCache(tmp_path, 450, ".x")
    for n in range(4):
        cache.write(f"{n}{n}ff", bytes(100))
    aged(tmp_path, {"00": 9000, "11": 8000, "22": 7000, "33": 6000})
    assert cache.read("00ff") is not None, "a use counts"
    cache.write("44ff", bytes(100))
    assert {p.parent.name for p in tmp_path.glob("*/*")} == {"00", "33", "44"}
    assert sum(p.stat().st_size for p in tmp_path.glob("*/*")) <= LEFT * 450


def test_what_another_program_kept_and_what_it_left_half_written_count(tmp_path: Path) -> None:
    DiskCache(tmp_path, 450, ".x").write("00ff", bytes(300))
    (tmp_path / "00" / "ee.x.123").write_bytes(bytes(100))
    aged(tmp_path, {"00": 9000})
    DiskCache(tmp_path, 450, ".x").write("11ff", bytes(100))
    assert [p.parent.name for p in tmp_path.glob("*/*")] == ["11"]


def test_a_disk_that_refuses_keeps_nothing_and_says_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    for folder in (tmp_path / "file", None):
        cache = DiskCache(folder, 100, ".x")
        cache.write("aabb", b"one")
        cache.drop("aabb")
        cache.clear_old()
        assert cache.read("aabb") is None


def test_the_folder_is_the_systems_for_caches(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    found = cache_folder("things")
    assert found is not None and found.name == "things" and found.is_relative_to(tmp_path)

    def nobody() -> Path:
        raise RuntimeError

    monkeypatch.setattr(Path, "home", nobody)
    assert cache_folder("things") is None
