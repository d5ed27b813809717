"""The page on requests that exports carry beside a runtime, made of pages in `agents/`: `python
docs/requests_page.py`.
"""

from __future__ import annotations

import re
from pathlib import Path

AGENTS = Path(__file__).with_name("agents")
PARTS = ("requests", "moods", "speech")  # what every runtime takes
PAGE = Path(__file__).parents[1] / "metagraph" / "engines" / "runtimes" / "requests.md"
SESSION_ONLY = {
    "bml",
    "keypoints",
    "generate",
    "hear",
    "partner",
    "hello",
    "status",
    "describe",
    "in",
    "told",
}


def page() -> str:
    """Return the page: what `agents/` says of requests that every runtime takes."""
    requests, *others = ((AGENTS / f"{part}.md").read_text(encoding="utf-8") for part in PARTS)
    requests = requests[requests.index("\n## Fields of every request\n") :]
    parts = [requests, *(re.sub(r"^#", "##", _without_aim(text), flags=re.M) for text in others)]
    lines = [
        line for line in "\n\n".join(part.strip() for part in parts).splitlines() if not _of_sessions(line)
    ]
    body = re.sub(r"\[([^\]]+)\]\([^)#]+[^)]*\)", r"\1", "\n".join(lines))  # pages that are not there
    # Nor are programs that measure, and sources.
    body = re.sub(r"\s\(`tests/[^)]*\)|\n`metagraph/\S+\.py` [^.]*\.\n", "", body)
    return f"""# Requests

What may be asked of a character, as objects whose `do` says which; `after` counts seconds from now and wins
over `at`. `describe` tells what there is to ask for.

{body.strip()}
"""


def _without_aim(text: str) -> str:
    """Return a page without the sentence on what its reader can do."""
    return re.sub(r"\n\nAfter this page .*?(?=\n\n)", "", text, count=1, flags=re.S)


def _of_sessions(line: str) -> bool:
    return bool(
        set(re.findall(r"`(\w+)`", line.split("|")[1] if line.startswith("|") else "")) & SESSION_ONLY
    )


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
