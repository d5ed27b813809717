"""Runs tests of the sample clips only when clips, makers or tests have changed since all last passed.

Every night they run, too. `python -m tests.sample_clips.unchanged` runs them and notes that they passed.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
PASSED = HERE / "passed.txt"
TEXT = (".py", ".json", ".TextGrid")  # whose line ends do not count


@cache
def digest() -> str:
    """Return the SHA-256 of the clips, sounds and keypoints, of what makes them and of their tests."""
    found = hashlib.sha256()
    made = [p for p in (ROOT / "sample_clips").rglob("*") if p.suffix in (".glb", ".flac", *TEXT)]
    for path in sorted([*made, *HERE.glob("*.py")]):
        content = path.read_bytes()
        found.update(path.relative_to(ROOT).as_posix().encode() + b"\0")
        found.update(content.replace(b"\r\n", b"\n") if path.suffix in TEXT else content)
    return found.hexdigest()


def only_when_changed() -> list[pytest.MarkDecorator]:
    """Return the marks of a module whose tests need not run while nothing has changed."""
    same = PASSED.is_file() and PASSED.read_text(encoding="ascii").strip() == digest()
    return [pytest.mark.nightly] if same else []


def main() -> int:
    """Run the tests; note the digest where all passed."""
    files = [str(p) for p in sorted(HERE.glob("test_*.py"))]
    failed = subprocess.call([sys.executable, "-m", "pytest", *files], cwd=ROOT)
    if not failed:
        PASSED.write_text(digest() + "\n", encoding="ascii")
    return failed


if __name__ == "__main__":
    sys.exit(main())
