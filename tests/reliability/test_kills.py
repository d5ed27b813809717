"""Sittings killed at any moment: a short count of what `kills.py` does a thousand times."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.processes import started

HERE = Path(__file__).resolve().parent


@pytest.mark.nightly
@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no kill -9 on Windows")
def test_nothing_that_was_finished_is_lost_by_kills_that_follow_each_other() -> None:
    command = (sys.executable, HERE / "kills.py", "--count", 12, "--seed", 3)
    environment = {**os.environ, "PYTHONPATH": str(HERE.parents[1]), "QT_QPA_PLATFORM": "offscreen"}
    with started(
        *command, longest=300, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment
    ) as run:
        said, _ = run.communicate()
    assert run.returncode == 0, said
    assert said.startswith("12 sittings killed") and " 0 left edits" not in said
