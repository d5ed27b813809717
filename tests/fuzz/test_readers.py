"""The gate's share of fuzzing: some broken files for every reader, and every one that was ever found.

Nights read a million a reader: `python -m tests.fuzz.readers all`.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.formats.fbx import processes as fbx_readers
from tests.fuzz import readers
from tests.thorough import THOROUGH

NAMES = tuple(readers.every_reader())
COUNT = 2000 if THOROUGH else 100  # of each reader


@pytest.mark.parametrize("name", NAMES)
def test_broken_files_are_read_or_refused_in_words(name: str, tmp_path: Path) -> None:
    with fbx_readers.batch():  # one process reads them all, as of a folder's, and another where one broke it
        found = [why for _, why in readers.fuzz(name, COUNT, 1, tmp_path)]
    assert not found, "\n".join(found[:3])


@pytest.mark.parametrize("name", NAMES)
def test_what_was_found_before_is_mended(name: str, tmp_path: Path) -> None:
    one = readers.every_reader()[name]
    for place in sorted((readers.KEPT / name).glob("*")):
        for seed in one.seeds():
            path = tmp_path / f"kept{''.join(Path(seed).suffixes[-2:])}"
            path.write_bytes(place.read_bytes())
            readers.survives(one.read, path)


def test_what_a_reader_trips_over_is_found_and_not_hidden(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def trips(path: Path) -> None:
        if path.read_bytes() != b"sound":
            raise KeyError("x")

    one = readers.Fuzzed(trips, lambda: {"a.x": b"sound"})
    monkeypatch.setattr(readers, "every_reader", lambda: {"broken": one})
    assert len(list(readers.fuzz("broken", 20, 1, tmp_path))) > 10


def test_the_same_seed_makes_the_same_files(tmp_path: Path) -> None:
    one = readers.every_reader()["bvh"]
    made = [readers.mutated(readers.random.Random("x"), list(one.seeds().values()), one) for _ in range(2)]
    assert made[0] == made[1]
