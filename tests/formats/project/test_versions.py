"""Earlier versions of a project: kept by each save, in order, with the file's rights, whatever fails."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.project import versions as v
from metagraph.formats.project.versions import (
    is_version,
    list_earlier_versions,
    make_version_path,
    write_project,
)
from metagraph.formats.store import SUFFIX

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "my.metagraph.yaml"


def texts(path: Path) -> list[str]:
    return [version.path.read_text() for version in list_earlier_versions(path)]


def test_each_save_keeps_what_was_there_and_the_oldest_goes(path: Path) -> None:
    for n in range(6):
        assert write_project(path, f"state {n}".encode(), 3) is None
    assert path.read_text() == "state 5" and texts(path) == ["state 4", "state 3", "state 2"]
    assert [version.number for version in list_earlier_versions(path)] == [1, 2, 3]
    assert sorted(p.name for p in path.parent.iterdir()) == [
        path.name,
        *(f"{path.name}.{n}" for n in (1, 2, 3)),
    ]


def test_none_are_kept_where_none_are_wanted_and_those_there_stay(path: Path) -> None:
    write_project(path, b"a", 2)
    write_project(path, b"b", 2)
    write_project(path, b"c", 0)
    assert path.read_text() == "c" and texts(path) == ["a"]


def test_fewer_are_kept_when_fewer_are_wanted(path: Path) -> None:
    for n in range(5):
        write_project(path, f"{n}".encode(), 4)
    write_project(path, b"last", 2)
    assert texts(path) == ["4", "3"]


def test_the_same_content_makes_no_version(path: Path) -> None:
    write_project(path, b"a", 3)
    write_project(path, b"b", 3)
    for _ in range(3):
        write_project(path, b"b", 3)
    assert texts(path) == ["a"]


def test_a_gap_is_filled_before_anything_goes(path: Path) -> None:
    for n in range(4):
        write_project(path, f"{n}".encode(), 3)
    make_version_path(path, 2).unlink()
    write_project(path, b"next", 3)
    assert texts(path) == ["3", "2", "0"]


def test_versions_have_the_rights_and_the_time_of_the_file(path: Path) -> None:
    write_project(path, b"secret", 3)
    path.chmod(0o600)
    os.utime(path, (1000, 2000))
    write_project(path, b"also", 3)
    (version,) = list_earlier_versions(path)
    assert version.path.stat().st_mode & 0o777 == 0o600 and version.saved == 2000
    assert path.stat().st_mode & 0o777 == 0o600


def test_versions_lie_beside_the_file_that_a_link_means(path: Path, tmp_path: Path) -> None:
    write_project(path, b"a", 3)
    link = tmp_path / "elsewhere" / "link.metagraph.yaml"
    link.parent.mkdir()
    link.symlink_to(path)
    write_project(link, b"b", 3)
    assert link.is_symlink() and path.read_text() == "b" and texts(link) == texts(path) == ["a"]


def test_other_files_are_no_versions(path: Path) -> None:
    path.write_text("a")
    for name in ("01", "0", "x", "100", "1.bak", "-1"):
        path.with_name(f"{path.name}.{name}").write_text("mine")
    assert list_earlier_versions(path) == ()
    make_version_path(path, 1).mkdir()
    note = write_project(path, b"b", 3)
    assert note is not None and path.read_text() == "b", "a folder in the way does not hold the save up"


def test_a_version_that_cannot_be_kept_is_told_and_the_save_is_whole(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_project(path, b"a", 3)

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(v, "write_all", full)
    note = write_project(path, b"b", 3)
    assert note is not None and "No space left" in note and path.name in note
    assert path.read_text() == "b" and [p.name for p in path.parent.iterdir()] == [path.name]


def test_what_cannot_be_saved_leaves_the_versions_as_they_were(path: Path) -> None:
    write_project(path, b"a", 3)
    write_project(path, b"b", 3)
    path.chmod(0o400)
    if os.access(path, os.W_OK):
        pytest.skip("whoever may do everything may write it")
    with pytest.raises(FileError):
        write_project(path, b"c", 3)
    assert texts(path) == ["a"] and path.read_text() == "b"


KILLED = """
import os, sys
from pathlib import Path
from metagraph.formats.project import versions
left = int(sys.argv[2])
def dying(call):
    def wrapped(*arguments, **more):
        global left
        left -= 1
        if left < 0:
            os.kill(os.getpid(), 9)
        return call(*arguments, **more)
    return wrapped
for name in ("replace", "unlink", "chmod"):
    setattr(Path, name, dying(getattr(Path, name)))
for name in ("open", "write", "fsync", "close"):
    setattr(os, name, dying(getattr(os, name)))
versions.write_project(Path(sys.argv[1]), b"new", 3)
"""


@pytest.mark.parametrize("step", range(20))
def test_a_kill_at_any_step_leaves_the_newest_in_its_place(path: Path, step: int) -> None:
    for n in range(5):
        write_project(path, f"{n}".encode(), 3)
    done = subprocess.run(
        [sys.executable, "-c", KILLED, str(path), str(step)], cwd=ROOT, timeout=60, check=False
    )
    assert path.read_text() in ("4", "new"), "it is there at every moment"
    assert {"3", "2"} <= set(texts(path)) | {path.read_text()}, "and so are all but the oldest"
    assert done.returncode in (0, -9)
    assert write_project(path, b"after", 3) is None and path.read_text() == "after"
    assert len(texts(path)) == 3 and texts(path)[0] in ("4", "new")


@pytest.mark.parametrize(
    ("name", "is_one"),
    [
        (f"a{SUFFIX}.1", True),
        (f"a{SUFFIX}.12", True),
        (f"a{SUFFIX}", False),
        (f"a{SUFFIX}.01", False),
        (f"a{SUFFIX}.x", False),
        ("a.1", False),
        (f"a{SUFFIX}.²", False),
    ],
)
def test_a_version_is_known_by_its_name(name: str, is_one: bool) -> None:
    assert is_version(Path(name)) == is_one
