"""How far a training got is read from its folder, whatever became of it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest

from metagraph.generation.features import MELS
from metagraph.generation.standing import (
    CheckpointNote,
    find_begun_trainings,
    hold,
    is_busy,
    measure_training_share,
    read_standing,
)
from metagraph.generation.takes import Take, TakeMarks, TakeSource
from metagraph.generation.train_plan import TrainingPlan, find_training_folder, plan_of, write_training
from tests.generation.makers import rig
from tests.processes import started


def made(out: Path, **limits: float) -> TrainingPlan:
    own, chance = rig(), np.random.default_rng(1)
    takes = [
        Take(
            TakeSource(f"t{n}", (f"{n}" * 64,), "made for a test"),
            chance.normal(0, 0.1, (50, own.numbers)).astype("f4"),
            np.zeros((50, MELS + 4), "f4"),
            TakeMarks((), (), ()),
        )
        for n in (1, 2)
    ]
    plan = plan_of(own, takes[:1], takes[1:], out, **limits)
    find_training_folder(out).mkdir(parents=True)
    write_training(find_training_folder(out), plan, takes[:1], takes[1:])
    return plan


def checkpoint(out: Path, n: int, plan: TrainingPlan, step: int, minutes: float = 0.0) -> Path:
    told = CheckpointNote(plan=plan.fingerprint(), step=step, seconds=60 * minutes, minutes=minutes)
    path = find_training_folder(out) / f"checkpoint.{n}.npz"
    np.savez(path, told=np.frombuffer(msgspec.json.encode(told), np.uint8), big=np.zeros(1000))
    return path


def test_the_later_checkpoint_counts_and_a_damaged_one_does_not(tmp_path: Path) -> None:
    out = tmp_path / "a.mgmodel"
    plan = made(out, minutes=10.0)
    assert (found := read_standing(find_training_folder(out))) is not None and (found.step, found.share) == (
        0,
        0.0,
    )
    checkpoint(out, 0, plan, 100, 2.0)
    later = checkpoint(out, 1, plan, 250, 5.0)
    found = read_standing(find_training_folder(out))
    assert found is not None and (found.step, found.share, found.kept) == (250, 0.5, False)
    later.write_bytes(later.read_bytes()[:200])
    found = read_standing(find_training_folder(out))
    assert found is not None and (found.step, found.share) == (100, 0.2)


def test_a_checkpoint_of_another_training_does_not_count(tmp_path: Path) -> None:
    out = tmp_path / "a.mgmodel"
    plan = made(out)
    checkpoint(out, 0, msgspec.structs.replace(plan, seed=9), 100, 2.0)
    found = read_standing(find_training_folder(out))
    assert found is not None and found.step == 0


def test_trainings_are_listed_wherever_they_were_moved_those_that_are_over_last(tmp_path: Path) -> None:
    first = tmp_path / "was" / "a.mgmodel"
    checkpoint(first, 0, made(first, minutes=1.0), 9, 1.0)
    made(tmp_path / "was" / "b.mgmodel")
    (tmp_path / "was" / "c.mgmodel.training").mkdir()
    (tmp_path / "was" / "d.mgmodel.training").write_text("no folder")
    (tmp_path / "was").rename(tmp_path / "is")
    assert [(s.out, s.share) for s in find_begun_trainings(tmp_path / "is")] == [
        (tmp_path / "is" / "b.mgmodel", 0.0),
        (tmp_path / "is" / "a.mgmodel", 1.0),
    ]
    assert find_begun_trainings(tmp_path / "gone") == []


@pytest.mark.parametrize(("limits", "share"), [({}, 0.4), ({"seconds": 200.0}, 0.6), ({"steps": 10}, 1.0)])
def test_what_is_over_first_counts(tmp_path: Path, limits: dict[str, float], share: float) -> None:
    plan = made(tmp_path / "a.mgmodel", minutes=5.0, **limits)
    assert measure_training_share(plan, 20, 120.0, 2.0) == pytest.approx(share)


def test_a_folder_is_held_by_one_process_until_that_ends_however_it_ends(tmp_path: Path) -> None:
    out = tmp_path / "a.mgmodel"
    made(out)
    folder = find_training_folder(out)
    code = (
        "import sys; from pathlib import Path; from metagraph.generation.standing import hold\n"
        "held = hold(Path(sys.argv[1])); print(held is not None, flush=True); sys.stdin.read()"
    )
    with started(sys.executable, "-c", code, folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None and other.stdout.readline().strip() == "True"
        assert is_busy(folder) and hold(folder) is None
        other.kill()
        other.wait(10)
    assert not is_busy(folder)
    assert not is_busy(tmp_path / "none.training")
