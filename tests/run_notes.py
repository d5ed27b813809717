"""What is said at the end of a run of the tests: of each process that took part, how it fared."""

from __future__ import annotations

import pytest

NOTES = pytest.StashKey[dict[str, str]]()  # of this process, by what they are about
KEY = "notes"  # of them in what a process of several tells the one that started it
