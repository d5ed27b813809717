"""Files that live motion can be made again of."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.live.graph_motion import KeptMotion
from metagraph.live.kept_motion import read_kept, write_kept
from metagraph.synthesis.extending.speech_so_far import SpeechNews

ONE = KeptMotion(
    graph="takes",
    size=(10, 20),
    seed=5,
    begun=1.25,
    frames=60,
    told=((3, SpeechNews("comes", 1.0, 2.0, 1.5, "clause")), (9, SpeechNews("hush", 0.3))),
)


def test_what_is_written_is_read(tmp_path: Path) -> None:
    write_kept(tmp_path / "a.json", [ONE, ONE])
    assert read_kept(tmp_path / "a.json") == (ONE, ONE)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "not a motion of a live session"),
        (b"[1, 2]", "not a motion of a live session"),
        (b"[" * 100_000, "not a motion of a live session"),
        (b'{"format": "other", "version": 1, "motions": []}', "has the format 'other' 1"),
        (b'{"format": "metagraph live motion", "version": 2, "motions": []}', "2"),
        (b'{"format": "metagraph live motion", "version": 1, "motions": []}', "has no motion"),
        (b'{"format": "metagraph live motion", "version": 1, "motions": [{"seed": "x"}]}', "motions"),
    ],
)
def test_other_files_are_refused_with_a_remedy(content: bytes, words: str, tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(content)
    with pytest.raises(FileError, match="Give a file of") as error:
        read_kept(path)
    assert words in str(error.value)


def test_a_file_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(FileError):
        read_kept(tmp_path / "none.json")
