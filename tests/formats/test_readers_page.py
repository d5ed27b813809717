"""The manual's page of readers is made from their registries."""

from __future__ import annotations

import runpy
from pathlib import Path

from metagraph.formats.clip_readers import READERS
from metagraph.formats.keypoints.reader import KEYPOINT_TOOLS
from metagraph.formats.transcripts.registry import TRANSCRIPT_READERS, TRANSCRIPT_SUFFIXES
from metagraph.speech.mouth_files.registry import MOUTH_READERS

ROOT = Path(__file__).resolve().parents[2]


def test_the_page_of_readers_is_current() -> None:
    """Else: `python docs/readers_page.py`."""
    made = runpy.run_path(str(ROOT / "docs" / "readers_page.py"))
    assert made["PAGE"].read_text(encoding="utf-8") == made["page"]()


def test_every_reader_says_what_it_is_and_is_listed_once() -> None:
    for readers in (TRANSCRIPT_READERS, MOUTH_READERS):
        said = [(r.name, r.versions) for r in readers]
        assert len(set(said)) == len(said)
        assert all(
            r.name and r.versions and r.holds and all(e.startswith(".") for e in r.endings) for r in readers
        )
    assert TRANSCRIPT_SUFFIXES[0] == ".TextGrid" and not {".txt", ".csv"} & set(TRANSCRIPT_SUFFIXES)


def test_every_reader_of_clips_and_keypoints_says_whose_files_it_reads() -> None:
    assert all(reader.tools for reader in READERS)
    tools = [tool for reader in READERS for tool in reader.tools]
    for said in (tools, KEYPOINT_TOOLS):
        assert len({(tool.name, tool.versions) for tool in said}) == len(said)
        assert all(tool.name and tool.versions and tool.holds for tool in said)
