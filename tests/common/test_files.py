"""What a path may be: no file at all, one that never ends, one without a name that can be written."""

from __future__ import annotations

import os
import socket
import sys
from concurrent.futures import CancelledError
from pathlib import Path

import pytest

from metagraph.common import files
from metagraph.common.files import check_file, guard_reader, is_file, is_text, open_file, read_file
from metagraph.errors import FileError

posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has none of these")


def refused(path: Path | str, most: int = 100) -> str:
    with pytest.raises(FileError) as caught:
        read_file(path, most)
    assert caught.value.cause and caught.value.where and caught.value.remedy
    assert str(caught.value).isprintable() and len(str(caught.value)) < 2000
    return caught.value.cause


@posix
@pytest.mark.parametrize("kind", ["pipe", "socket", "device", "folder"])
def test_what_is_no_file_is_refused_at_once(
    tmp_path: Path, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = Path("/dev/zero") if kind == "device" else tmp_path / "x"
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "socket":
        monkeypatch.chdir(tmp_path)  # its name may not be long
        held = socket.socket(socket.AF_UNIX)
        held.bind("x")
        held.close()
    words = {"pipe": "a pipe", "folder": "irectory", "socket": "cannot be read", "device": "a device"}
    assert words[kind] in refused(path)
    assert not is_file(path)


@pytest.mark.parametrize("path", ["x" * 5000, "x/" * 2500, "a\0b", "nowhere", ""])
def test_a_path_that_cannot_be_one_is_a_file_error(path: str) -> None:
    refused(path)
    assert not is_file(path)


def test_a_budget_is_kept_to_the_byte(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"x" * 100)
    assert read_file(tmp_path / "a", 100) == b"x" * 100
    assert "larger than" in refused(tmp_path / "a", 99)
    assert read_file(_empty(tmp_path), 0) == b""


def _empty(folder: Path) -> Path:
    (folder / "empty").touch()
    return folder / "empty"


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="needs files that the system makes up")
def test_files_without_a_size_are_read_to_their_end_and_no_further() -> None:
    assert read_file("/proc/self/status", 1 << 20).startswith(b"Name:")
    assert "larger" in refused("/proc/self/status", 10)


@posix
def test_names_in_no_encoding_are_read_and_told_in_words(tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(b"a\xff.bvh")
    try:
        path.write_bytes(b"x")
    except OSError:
        pytest.skip("this disk takes no such name")
    assert read_file(path, 10) == b"x" and not is_text(path) and is_text(tmp_path)
    path.unlink()
    refused(path)


def test_an_error_while_reading_is_told_and_one_of_the_reader_is_not_mistaken_for_it(tmp_path: Path) -> None:
    path = _empty(tmp_path)
    with pytest.raises(FileError), open_file(path, 1):
        raise OSError(5, "Input/output error")
    with pytest.raises(ValueError, match="the reader's own"), open_file(path, 1):
        raise ValueError("the reader's own")
    assert check_file(path, 1) == path


@pytest.mark.parametrize(
    "error",
    [
        KeyError("x"),
        RecursionError(),
        MemoryError(),
        OSError(36, "File name too long"),
        AssertionError("\x1b[31m"),
    ],
)
def test_whatever_a_reader_trips_over_names_the_file(
    error: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    @guard_reader
    def read(path: Path | str) -> None:
        raise error

    monkeypatch.setattr(files, "strict", False)
    with pytest.raises(FileError) as caught:
        read("clip.bvh")
    assert caught.value.cause and caught.value.remedy and str(caught.value).isprintable()
    monkeypatch.setattr(files, "strict", True)
    with pytest.raises(type(error)):
        read("clip.bvh")


@pytest.mark.parametrize("error", [CancelledError(), KeyboardInterrupt(), FileError("a", "b")])
def test_what_is_no_fault_of_the_file_goes_on(error: BaseException, monkeypatch: pytest.MonkeyPatch) -> None:
    @guard_reader
    def read(path: Path | str) -> None:
        raise error

    monkeypatch.setattr(files, "strict", False)
    with pytest.raises(type(error)) as caught:
        read("a")
    assert caught.value is error
