"""The folder of a study: what is shown apart from what nobody may see, frozen, read back."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.research.study.perceive.folder import KEY, LOCK, level_times, read_folder
from tests.research.study.perceive.perceive_makers import shown, study, text

pytestmark = pytest.mark.usefixtures("quick_codes")


def test_what_was_written_is_read_back(tmp_path: Path) -> None:
    made = study(tmp_path / "s", text())
    for place in (tmp_path / "s", tmp_path / "s" / "perceive.yaml", tmp_path / "s" / KEY):
        found = read_folder(place)
        assert found.key == made.key and found.plan == made.plan and not found.differences()
    drawn = [json.loads(line) for line in (tmp_path / "s" / "allocation.jsonl").read_text().splitlines()]
    assert [d["participant"] for d in drawn] == ["P01", "P02", "P03", "P04"]


def test_a_folder_without_a_study_and_a_damaged_key_are_told(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="holds no perceptual study"):
        read_folder(tmp_path)
    made = study(tmp_path / "s", text())
    for content in ("{}", "[", "null", '{"perceive": 1}'):
        (made.folder / KEY).write_text(content)
        with pytest.raises(FileError, match="is damaged"):
            read_folder(made.folder)
    with pytest.raises(FileError):
        read_folder(tmp_path / "nowhere")


def test_what_was_changed_or_removed_since_is_named(tmp_path: Path) -> None:
    made = shown(tmp_path / "s", text(items=1), 0.2)
    first, second = sorted((made.show / "videos").iterdir())
    first.write_bytes(b"other")
    second.unlink()
    named = [words.split(" ")[0] for words in made.differences()]
    assert named == [f"show/videos/{first.name}", f"show/videos/{second.name}"]
    (made.folder / LOCK).write_text((made.folder / LOCK).read_text().replace('"digests"', '"digest"'))
    with pytest.raises(FileError, match="changed by hand"):
        made.differences()


def test_times_of_videos_tell_nothing_of_their_order(tmp_path: Path) -> None:
    made = shown(tmp_path / "s", text(items=1), 0.2)
    level_times(made.folder)
    assert len({p.stat().st_mtime_ns for p in (made.show / "videos").iterdir()}) == 1
