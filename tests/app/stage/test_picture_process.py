"""The process that draws pictures ends with whoever wants them, and reports nothing else."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys

import pytest

from app.faults import FOLDER
from app.stage.picture_process import PictureOrder
from tests.processes import started


@pytest.mark.gl
@pytest.mark.skipif(os.name == "nt", reason="pipes end otherwise there")
def test_whoever_wanted_a_picture_may_be_gone_in_the_middle_of_it(toy, tmp_path):
    words = (sys.executable, "-m", "app.stage.picture_process")
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL, "text": False}
    environment = {**os.environ, FOLDER: str(tmp_path)}
    with started(*words, env=environment, longest=120, **pipes) as process:
        process.stdout.close()  # as a window that was killed
        pickle.dump(PictureOrder(1, toy.clip("wave"), "card", "dark", None, None), process.stdin)
        process.stdin.close()
        assert process.wait(60) == 0
    assert not [p for p in tmp_path.iterdir() if p.name != "data"], "it is no fault"
