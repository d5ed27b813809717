"""Whether tests of the sample clips run."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.sample_clips import unchanged


def test_they_run_when_anything_differs_from_what_passed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    note = tmp_path / "passed.txt"
    monkeypatch.setattr(unchanged, "PASSED", note)
    assert unchanged.only_when_changed() == []
    note.write_text("0" * 64 + "\n")
    assert unchanged.only_when_changed() == []
    note.write_text(unchanged.digest() + "\n")
    assert [mark.name for mark in unchanged.only_when_changed()] == ["nightly"]


def test_one_byte_of_a_clip_or_of_a_maker_makes_another_digest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clip, maker = tmp_path / "sample_clips" / "clips" / "a.glb", tmp_path / "sample_clips" / "make" / "a.py"
    for path in (clip, maker):
        path.parent.mkdir(parents=True)
    monkeypatch.setattr(unchanged, "ROOT", tmp_path)
    monkeypatch.setattr(unchanged, "HERE", tmp_path / "tests" / "sample_clips")
    found = set()
    for content, words in ((b"a", b"x = 1\n"), (b"b", b"x = 1\n"), (b"b", b"x = 2\n"), (b"b", b"x = 2\r\n")):
        clip.write_bytes(content)
        maker.write_bytes(words)
        found.add(unchanged.digest.__wrapped__())
    assert len(found) == 3  # line ends of a source do not count
