"""Without torch everything else works, and training says what to install."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from metagraph.common import extras
from metagraph.generation import train_process
from metagraph.generation.train_process import TrainingFailedError, TrainingProcess


def test_without_torch_it_is_told_what_to_install_and_how_large_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(train_process.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(TrainingFailedError, match=r"(?s)750 MB.*torch.*whl/cpu"):
        TrainingProcess(tmp_path / "m.mgmodel")
    assert not list(tmp_path.iterdir())


def test_in_a_bundle_the_command_that_installs_torch_there_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(train_process.importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(extras, "is_bundle", lambda: True)
    with pytest.raises(TrainingFailedError, match="metagraph extras add train"):
        TrainingProcess(tmp_path / "m.mgmodel")


def test_a_training_is_planned_and_begun_without_torch() -> None:
    code = (
        "import sys\n"
        "import metagraph.generation.train_plan, metagraph.generation.train_process\n"
        "import metagraph.generation.sampler, metagraph.generation.statistics\n"
        "assert 'torch' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(__file__).resolve().parents[2])
