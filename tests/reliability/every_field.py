"""Every extreme value in every field of a project file: python tests/reliability/every_field.py

Each is refused with its file, its place and the reason, or read, edited, saved and read again. Exit code 1
where one is not.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.formats.test_every_field import EXTREME, PLACES, TEXTS, refused_or_saved, renamed_or_saved


def main() -> int:
    path, tried, read, wrong = Path("whole.metagraph.yaml"), 0, 0, 0
    for place in PLACES:
        for values, work in ((EXTREME, refused_or_saved), (TEXTS, renamed_or_saved)):
            if work is renamed_or_saved and not isinstance(place[-1], str):
                continue
            for value in values:
                tried += 1
                try:
                    read += work(place, [value], path)
                except Exception as error:
                    wrong += 1
                    print("WRONG:", *getattr(error, "__notes__", ()), type(error).__name__, str(error)[:200])
    kept = f"{read:,} read, saved and read again, {tried - read - wrong:,} refused"
    print(f"{tried:,} values in {len(PLACES)} places: {kept}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
