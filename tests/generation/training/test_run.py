"""A training from its first step to the model's file: stopped, killed, gone on with, on a full disk."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch, which is not installed")

from metagraph.errors import FileError
from metagraph.generation.sampler import generate_recording_poses
from metagraph.generation.standing import hold, is_busy, read_standing
from metagraph.generation.stored import read_model
from metagraph.generation.train_plan import (
    TrainingPlan,
    TrainingSettings,
    find_training_folder,
    write_plan,
    write_training,
)
from metagraph.generation.train_process import TrainingEvent, TrainingFailedError, TrainingProcess
from metagraph.generation.training.__main__ import main
from metagraph.generation.training.checkpoint import read_checkpoint
from metagraph.generation.training.run import Run
from tests.generation.training.planting import plan, take
from tests.processes import started

SMALL = TrainingSettings(batch=4, frames=40, warm=20)


@pytest.fixture(scope="module")
def takes() -> Any:
    return take(8.0, 1), take(8.0, 2)


def begun(takes: Any, folder: Path, **options: Any) -> TrainingPlan:
    out = folder / "m.mgmodel"
    own = plan(takes[:1], takes[1:], out=str(out), settings=SMALL, **options)
    write_training(find_training_folder(out), own, takes[:1], takes[1:])
    return own


def test_a_model_says_what_it_was_made_of(takes: Any, tmp_path: Path) -> None:
    events: list[Any] = []
    own = begun(takes, tmp_path, judged=1e-6, checkpoint=1e-6)
    model = read_model(Run(find_training_folder(tmp_path / "m.mgmodel"), events.append).go())
    card = model.card
    assert (card.steps, card.seed, card.loss, card.kind) == (12, 1, "matching", "matching")
    assert (
        card.takes == own.takes and card.held_out == own.held and card.takes[0].licence == "made for a test"
    )
    assert {"torch", "numpy", "python"} <= set(card.versions) and card.hours == pytest.approx(
        8 / 3600, rel=0.01
    )
    assert {"speed", "distance", "frechet"} <= set(card.statistics)
    assert np.isfinite(generate_recording_poses(model, takes[1].features)).all()
    kinds = [e["event"] for e in events]
    assert (
        kinds[0] == "begin"
        and kinds[-1] == "end"
        and {"step", "statistics", "poses", "checkpoint"} <= {*kinds}
    )
    shown = next(e for e in events if e["event"] == "poses")["landmarks"]
    assert np.shape(shown)[1:] == (9, 3)


def test_cut_and_gone_on_with_it_leads_to_the_same_model(takes: Any, tmp_path: Path) -> None:
    for part in ("whole", "cut"):
        (tmp_path / part).mkdir()
        begun(takes, tmp_path / part)
    whole = read_model(Run(find_training_folder(tmp_path / "whole" / "m.mgmodel"), lambda e: None).go())
    folder = find_training_folder(tmp_path / "cut" / "m.mgmodel")
    first = Run(folder, lambda e: None)
    for n in range(5):
        first.learner.advance(n / 12)
    first.keep()
    again = read_model(Run(folder, lambda e: None).go())
    assert all(np.array_equal(whole.weights[n], again.weights[n]) for n in whole.weights)


def test_stopped_it_writes_what_it_has_and_more_time_goes_on(takes: Any, tmp_path: Path) -> None:
    own, folder = begun(takes, tmp_path, steps=10**6), find_training_folder(tmp_path / "m.mgmodel")
    (folder / "stop").touch()
    events: list[Any] = []
    model = read_model(Run(folder, events.append).go())
    assert model.card.steps == 1 and "stopped" in model.card.notes[0] and events[-1]["stopped"]
    assert not (folder / "stop").exists()
    write_plan(folder, msgspec.structs.replace(own, steps=4))
    assert read_model(Run(folder, events.append).go()).card.steps == 4


def test_on_a_full_disk_it_goes_on_learning_and_says_so(
    takes: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun(takes, tmp_path, checkpoint=1e-6)
    folder, events = find_training_folder(tmp_path / "m.mgmodel"), list[Any]()
    run = Run(folder, events.append)
    run.learner.advance()
    run.keep()

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("metagraph.formats.atomic.os.fsync", full)
    with pytest.raises(FileError, match=r"m\.mgmodel"):
        run.go()
    assert run.learner.step == 12
    assert any(e["event"] == "note" and "space left" in e["text"] for e in events)
    found, _ = read_checkpoint(folder, run.plan.fingerprint())
    assert found is not None and found.told.step == 1
    monkeypatch.undo()
    assert read_model(Run(folder, events.append).go()).card.steps == 12


def heard_until(process: TrainingProcess, events: list[TrainingEvent], what: str) -> None:
    for _ in range(15000):
        if any(e.event == what for e in events) or not process.running:
            return
        time.sleep(0.02)


def test_killed_at_any_moment_its_last_checkpoint_can_be_used(takes: Any, tmp_path: Path) -> None:
    own = begun(takes, tmp_path, steps=10**6, checkpoint=0.05)
    out, events = tmp_path / "m.mgmodel", list[TrainingEvent]()
    process = TrainingProcess(out, events.append)
    heard_until(process, events, "checkpoint")
    process.kill()
    with pytest.raises(TrainingFailedError, match="from outside"):
        process.wait(600)
    assert not out.exists()
    kept = max(e.step for e in events if e.event == "checkpoint")
    model = read_model(Run(find_training_folder(out), lambda e: None).finish(True))
    assert model.card.steps >= kept > 0 and model.card.takes == own.takes
    # Gone on with, then asked to stop.
    events.clear()
    process = TrainingProcess(out, events.append)
    heard_until(process, events, "checkpoint")
    if os.name == "posix":
        os.kill(process.pid, signal.SIGTERM)
    else:
        process.stop()
    assert read_model(process.wait(600)).card.steps > model.card.steps
    assert events[0].step >= model.card.steps and events[-1].stopped


def test_it_does_not_outlive_who_began_it_and_keeps_what_it_has(takes: Any, tmp_path: Path) -> None:
    begun(takes, tmp_path, steps=10**6, checkpoint=1e6)
    out, folder = tmp_path / "m.mgmodel", find_training_folder(tmp_path / "m.mgmodel")
    code = (
        "import sys, time; from pathlib import Path\n"
        "from metagraph.generation.train_process import TrainingProcess\n"
        "TrainingProcess(Path(sys.argv[1]), lambda e: e.step > 5 and print(e.step, flush=True))\n"
        "time.sleep(600)"
    )
    with started(sys.executable, "-c", code, out, stdout=subprocess.PIPE) as parent:
        assert parent.stdout is not None and parent.stdout.readline()
        assert is_busy(folder)
        parent.kill()
        parent.wait(10)
        parent.stdout.close()
    late = time.monotonic() + 60
    while is_busy(folder) and time.monotonic() < late:
        time.sleep(0.05)
    assert not is_busy(folder)
    standing = read_standing(folder)
    assert standing is not None and standing.step > 5 and not standing.kept


def test_a_second_process_does_not_learn_in_the_same_folder(
    takes: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    begun(takes, tmp_path)
    folder = find_training_folder(tmp_path / "m.mgmodel")
    held = hold(folder)
    assert held is not None
    with held:
        assert main([str(folder)]) == 2
    event = msgspec.json.decode(capsys.readouterr().out.splitlines()[-1], type=TrainingEvent)
    assert "another process" in event.text and read_standing(folder).step == 0
    assert main([str(folder)]) == 0
    assert read_standing(folder).step == 12


def test_what_goes_wrong_is_told_in_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path / "none.training")]) == 2
    event = msgspec.json.decode(capsys.readouterr().out.splitlines()[-1], type=TrainingEvent)
    assert event.event == "error" and "no training to go on with" in event.text
