"""The page on requests that exports carry beside a runtime, cut from `agents/live.md`: `python
docs/requests_page.py`.
"""

from __future__ import annotations

import re
from pathlib import Path

from metagraph import engines

LIVE = Path(__file__).with_name("agents") / "live.md"
PAGE = Path(engines.__file__).with_name("runtimes") / "requests.md"
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
    """Return the page: what `agents/live.md` says of requests that every runtime takes."""
    text = LIVE.read_text(encoding="utf-8")
    section = text[text.index("\n## Requests\n") : text.index("\n## Replies\n")]
    lines = [line for line in section.splitlines() if not _of_sessions(line)]
    body = "\n".join(lines[lines.index("Every ask may have these fields:") :])
    body = re.sub(r"\[([^\]]+)\]\([^)]*\)", r"\1", body)  # pages that are not there
    return f"""# Requests

What may be asked of a character, as objects whose `do` says which; `after` counts seconds from now and wins
over `at`. `describe` tells what there is to ask for.

{body.strip()}
"""


def _of_sessions(line: str) -> bool:
    return bool(
        set(re.findall(r"`(\w+)`", line.split("|")[1] if line.startswith("|") else "")) & SESSION_ONLY
    )


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
