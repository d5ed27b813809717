"""Whether tests run whose subject may not have changed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests import unchanged


@pytest.mark.parametrize("name", unchanged.GUARDED)
def test_they_run_when_anything_differs_from_what_passed(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    note = tmp_path / "passed.json"
    monkeypatch.setattr(unchanged, "PASSED", note)
    assert unchanged.only_when_changed(name) == []
    note.write_text(json.dumps({name: "0" * 64}))
    assert unchanged.only_when_changed(name) == []
    note.write_text(json.dumps({name: unchanged.digest(name)}))
    assert [mark.name for mark in unchanged.only_when_changed(name)] == ["nightly"]


def test_one_byte_of_a_clip_or_of_a_maker_makes_another_digest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clip, maker = tmp_path / "sample_clips" / "clips" / "a.glb", tmp_path / "sample_clips" / "make" / "a.py"
    for path in (clip, maker):
        path.parent.mkdir(parents=True)
    monkeypatch.setattr(unchanged, "ROOT", tmp_path)
    found = set()
    for content, words in ((b"a", b"x = 1\n"), (b"b", b"x = 1\n"), (b"b", b"x = 2\n"), (b"b", b"x = 2\r\n")):
        clip.write_bytes(content)
        maker.write_bytes(words)
        found.add(unchanged.digest.__wrapped__("sample clips"))
    assert len(found) == 3  # line ends of a source do not count


def test_what_is_guarded_is_there() -> None:
    for files, places in unchanged.GUARDED.values():
        assert list(unchanged.ROOT.glob(files)) and all((unchanged.ROOT / place).exists() for place in places)
