"""Runs some long tests only when what they look at has changed since they last passed.

Every night they run, too. `python -m tests.unchanged` runs them and notes that they passed.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PASSED = ROOT / "tests" / "passed.json"
# Line ends of these do not count.
TEXT = (".py", ".json", ".TextGrid", ".js", ".mjs", ".cs", ".gd", ".hpp", ".cpp", ".h")
BINARY = (".glb", ".flac")

# By the name of some tests: the files they are in, and what they look at: folders and files.
GUARDED = {
    "sample clips": ("tests/sample_clips/test_*.py", ("sample_clips", "tests/sample_clips")),
    "translation": (
        "tests/engines/translation/test_translating.py",
        ("metagraph", "tests/engines/translation", "metagraph/engines/runtimes/.gitattributes"),
    ),
    "warnings of C++": (
        "tests/engines/test_cpp_compiles.py",
        ("metagraph/engines/runtimes/cpp", "metagraph/engines/runtimes/unreal", "tests/engines"),
    ),
}


@cache
def digest(name: str) -> str:
    """Return the SHA-256 of what the tests of a name look at."""
    found = hashlib.sha256()
    for path in sorted({path for place in GUARDED[name][1] for path in _list_files(ROOT / place)}):
        content = path.read_bytes()
        found.update(path.relative_to(ROOT).as_posix().encode() + b"\0")
        found.update(content if path.suffix in BINARY else content.replace(b"\r\n", b"\n"))
    return found.hexdigest()


def _list_files(place: Path) -> list[Path]:
    if place.is_file():
        return [place]
    return [path for path in place.rglob("*") if path.suffix in (*TEXT, *BINARY) and path.is_file()]


def only_when_changed(name: str) -> list[pytest.MarkDecorator]:
    """Return the marks of a module whose tests need not run while nothing has changed."""
    noted = json.loads(PASSED.read_text(encoding="ascii")) if PASSED.is_file() else {}
    return [pytest.mark.nightly] if noted.get(name) == digest(name) else []


def main() -> int:
    """Run the tests that have to; note the digests of those that passed."""
    noted = json.loads(PASSED.read_text(encoding="ascii")) if PASSED.is_file() else {}
    failed = 0
    for name, (files, _) in GUARDED.items():
        if noted.get(name) != digest(name):
            words = [str(path) for path in sorted(ROOT.glob(files))]
            if subprocess.call([sys.executable, "-m", "pytest", *words], cwd=ROOT):
                failed = 1
            else:
                noted[name] = digest(name)
    PASSED.write_text(json.dumps(noted, indent=1, sort_keys=True) + "\n", encoding="ascii")
    return failed


if __name__ == "__main__":
    sys.exit(main())
