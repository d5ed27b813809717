"""Files that a killed writer left: swept, but only ours, and only when it is gone."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.atomic import FORSAKEN, append_line, sweep, sync_together, write_atomically
from metagraph.formats.locking import process_mark
from tests.processes import started
from tests.sittings import ended

OLD = ".saving-" + "ab" * 16  # as they were called before they said who writes them


def made(folder: Path, name: str, age: float = 0.0) -> Path:
    path = folder / name
    path.write_bytes(b"half")
    os.utime(path, (time.time() - age,) * 2)
    return path


def left_by(pid: int, began: str = "1") -> str:
    return f".saving-{process_mark().split('-')[0]}-{pid}-{began}-{'0' * 12}"


def test_what_a_killed_process_left_is_removed_at_once(tmp_path: Path) -> None:
    left = made(tmp_path, left_by(ended()))
    assert sweep(tmp_path) == [left] and not left.exists()


def test_a_number_that_came_again_is_another_process(tmp_path: Path) -> None:
    made(tmp_path, left_by(os.getpid(), "1"))
    assert len(sweep(tmp_path)) == (1 if process_mark().split("-")[2] else 0)


def test_what_is_being_written_stays(tmp_path: Path) -> None:
    mine = made(tmp_path, f".saving-{process_mark()}-{'0' * 12}", FORSAKEN * 2)
    assert sweep(tmp_path) == [] and mine.exists()


@pytest.mark.parametrize("name", [".saving-00000000-1-1-0123456789ab", OLD, ".clock-ab12_xyz"])
def test_what_cannot_be_asked_after_goes_after_a_day(tmp_path: Path, name: str) -> None:
    made(tmp_path, name, FORSAKEN / 2)
    assert sweep(tmp_path) == []
    made(tmp_path, name, FORSAKEN * 1.1)
    assert len(sweep(tmp_path)) == 1


@pytest.mark.parametrize(
    "name",
    [
        ".saving-mine",
        "saving-" + "ab" * 16,
        ".saving-" + "AB" * 16,
        ".saving",
        "notes.txt",
        ".show.metagraph.yaml.ab.journal",
        ".show.metagraph.yaml.lock",
    ],
)
def test_what_others_call_alike_is_theirs(tmp_path: Path, name: str) -> None:
    path = made(tmp_path, name, FORSAKEN * 9)
    assert sweep(tmp_path) == [] and path.exists()


def test_folders_and_links_of_that_name_stay(tmp_path: Path) -> None:
    (tmp_path / left_by(ended())).mkdir()
    (tmp_path / OLD).symlink_to(tmp_path / "elsewhere")
    assert sweep(tmp_path) == []
    assert sweep(tmp_path / "nowhere") == []


def test_the_first_writing_into_a_folder_sweeps_it(tmp_path: Path) -> None:
    left = made(tmp_path, left_by(ended()))
    write_atomically(tmp_path / "file", b"x")
    assert not left.exists()


CHILD = """
import sys
from pathlib import Path
from metagraph.formats.atomic import write_atomically
print("begun", flush=True)
while True:
    write_atomically(Path(sys.argv[1]), b"x" * 3_000_000)
"""


@pytest.mark.nightly
@pytest.mark.skipif(os.name == "nt", reason="there is no kill -9 on Windows")
def test_after_kills_nothing_stays_but_the_file(tmp_path: Path) -> None:
    for n in range(6):
        with started(sys.executable, "-c", CHILD, tmp_path / "file", stdout=subprocess.PIPE) as child:
            assert child.stdout is not None and child.stdout.readline() == "begun\n"
            time.sleep(0.05 + 0.007 * n)
            os.kill(child.pid, signal.SIGKILL)
            child.wait()
    sweep(tmp_path)
    assert {p.name for p in tmp_path.iterdir()} <= {"file"}


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (None, '{"a": "é"}\n'),
        ("", '{"a": "é"}\n'),
        ("one\n", 'one\n{"a": "é"}\n'),
        ('{"cu', '{"cu\n{"a": "é"}\n'),
    ],
)
def test_a_line_is_added_whole_whatever_a_crash_left_before_it(
    tmp_path: Path, before: str | None, after: str
) -> None:
    path = tmp_path / "log.jsonl"
    if before is not None:
        path.write_bytes(before.encode())
    append_line(path, '{"a": "é"}')
    assert path.read_bytes().decode() == after


def test_what_is_synced_together_is_whole_synced_and_tells_what_cannot_be(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[str] = []
    real = os.fsync

    def told(handle: int) -> None:
        synced.append(Path(f"/proc/self/fd/{handle}").readlink().name)
        real(handle)

    if Path("/proc/self/fd").exists():
        monkeypatch.setattr(os, "fsync", told)
    with sync_together():
        for n in range(20):
            write_atomically(tmp_path / "some" / f"{n}.txt", b"x" * n)
        (tmp_path / "some" / "3.txt").unlink()
        assert synced == []
    assert [(tmp_path / "some" / f"{n}.txt").stat().st_size for n in range(20) if n != 3] == [
        n for n in range(20) if n != 3
    ]
    if Path("/proc/self/fd").exists():
        assert sorted(synced) == sorted([*(f"{n}.txt" for n in range(20) if n != 3), "some"])
    write_atomically(tmp_path / "later.txt", b"")
    assert not synced or "later.txt" in synced or any(".saving" in name for name in synced), (
        "one by one again"
    )
    with pytest.raises(FileError), sync_together():
        write_atomically(tmp_path / "later.txt" / "inside.txt", b"")
