"""`python -m metagraph.engines.translation`: write the translated modules again."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from metagraph.engines.translation.gesture_word_lists import make_gesture_word_modules
from metagraph.engines.translation.listing import RUNTIMES
from metagraph.engines.translation.translating import translate_runtimes

ATTRIBUTES = RUNTIMES / ".gitattributes"


def mark_generated(paths: Iterable[Path]) -> str:
    """Return Git attributes that fold these files in differences, and leave them out of counts of code."""
    names = sorted(path.relative_to(RUNTIMES).as_posix() for path in paths)
    return "".join(f"{name} linguist-generated\n" for name in names)


def main() -> int:
    """Write what differs; say what."""
    files = translate_runtimes() | make_gesture_word_modules()
    for path, text in (files | {ATTRIBUTES: mark_generated(files)}).items():
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
            print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
