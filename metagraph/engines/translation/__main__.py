"""`python -m metagraph.engines.translation`: write the translated modules anew."""

from __future__ import annotations

import sys

from metagraph.engines.translation.gesture_word_lists import gesture_word_lists
from metagraph.engines.translation.translating import translated


def main() -> int:
    """Write what differs; say what."""
    for path, text in (translated() | gesture_word_lists()).items():
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
            print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
