"""Write the page of what is read, from the registries of readers: `python docs/readers_page.py`."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))
PAGE = ROOT / "docs" / "reference" / "readers.md"
HEAD = """# What is read from which tool

After this page you know which transcripts, mouth shapes, clips and keypoints Metagraph reads, and what of
them.

What a file is, its content says; its ending may differ. What was inferred, as a unit of time or a speaker, is
reported. A file that is of none of these kinds is refused, with what was expected.

*Checked with*: **a file of the tool**, or a file that we made from the tool's **published description**.
"""
UNITS = """
Where a file does not name its unit of time, the length of the sound tells it: seconds, hundredths,
milliseconds, microseconds, nanoseconds, or ticks of 100 nanoseconds.
"""
CLIPS = """
[Bring your clips](../animators/bring-clips.md) says what the import repairs. [Keypoints of a
person](../agents/camera-keypoints.md) says how keypoints become stances; TRC and C3D are read there too.
"""


def page() -> str:
    """Return the page."""
    from metagraph.formats.clip_readers import READERS
    from metagraph.formats.keypoints.reader import KEYPOINT_TOOLS
    from metagraph.formats.transcripts.registry import TRANSCRIPT_READERS
    from metagraph.speech.mouth_files.registry import MOUTH_READERS

    clips = (
        (t.name, t.versions, t.holds, t.endings or reader.suffixes, t.by_tool)
        for reader in READERS
        for t in reader.tools
    )
    parts = [
        HEAD,
        table(
            "Transcripts", ((r.name, r.versions, r.holds, r.endings, r.by_tool) for r in TRANSCRIPT_READERS)
        ),
        UNITS,
        table("Mouth shapes", ((r.name, r.versions, r.holds, r.endings, r.by_tool) for r in MOUTH_READERS)),
        table("Clips: motion, bodies and faces", clips),
        CLIPS,
        table("Keypoints", ((t.name, t.versions, t.holds, (".json",), t.by_tool) for t in KEYPOINT_TOOLS)),
    ]
    return "\n".join(parts)


def table(title: str, rows: Iterable[tuple[str, str, str, tuple[str, ...], bool]]) -> str:
    """Return a section with a table of readers."""
    lines = "".join(
        f"| {name} | {versions} | {', '.join(f'`{e}`' for e in endings)} | {holds} | "
        f"{'a file of the tool' if by_tool else 'published description'} |\n"
        for name, versions, holds, endings, by_tool in rows
    )
    head = "| Tool | Version | Files | What is read | Checked with |\n|---|---|---|---|---|\n"
    return f"## {title}\n\n{head}{lines}"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
