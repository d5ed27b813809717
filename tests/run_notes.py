"""What is said at the end of a run of the tests: of each process that took part, how it fared."""

from __future__ import annotations

import faulthandler
from pathlib import Path
from typing import TextIO

import pytest

CRASHES = Path(__file__).resolve().parents[1] / ".pytest_cache" / "crashes"
SHOWN = 40  # lines of where each thread was in a process that crashed
NOT_SHOWN = ("Extension modules", "/pluggy/", "/_pytest/", "/xdist/", "/execnet/")
NOTES = pytest.StashKey[dict[str, str]]()  # of this process, by what they are about
KEY = "notes"  # of them in what a process of several tells the one that started it


def catch_crash(process: str) -> TextIO:
    """Have this process write where it is, if it crashes, to a file of its own; return the file, which must
    stay open.
    """
    CRASHES.mkdir(parents=True, exist_ok=True)
    file = (CRASHES / f"{process}.txt").open("w", encoding="utf-8")
    faulthandler.enable(file)
    return file


def take_crashes() -> dict[str, list[str]]:
    """Return where processes were that crashed, by process; and forget it."""
    out = {}
    for path in sorted(CRASHES.glob("*.txt")):
        text = path.read_text(encoding="utf-8")
        lines = [x for x in text.splitlines() if not any(name in x for name in NOT_SHOWN)]
        if lines:
            out[path.stem] = lines[:SHOWN]
        path.unlink()
    return out
