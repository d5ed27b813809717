"""What a training is asked to do is kept whole; what is damaged is reported."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.generation.features import RATE
from metagraph.generation.takes import SplitError, Take, TakeSound, TakeSource, make_take
from metagraph.generation.train_plan import (
    PLAN,
    TAKES,
    TrainingPlan,
    TrainingSettings,
    choose_settings,
    find_training_folder,
    plan_of,
    read_planned_takes,
    read_training_plan,
    write_plan,
    write_training,
)
from tests.generation.makers import babble, conversation, moving, rig


@pytest.fixture(scope="module")
def takes() -> tuple[Take, Take]:
    out = []
    for seed in (1, 2):
        sound = np.stack([babble(8.0, seed), babble(8.0, seed + 50)])
        source = TakeSource(f"take {seed}", (f"motion {seed}",), "CC0", 2.0)
        heard = TakeSound(sound, RATE)
        out.append(make_take(rig(), moving(8.0, seed), heard, source, conversation(8.0, seed)))
    return out[0], out[1]


def plan(takes: tuple[Take, Take], out: Path, **options: Any) -> TrainingPlan:
    return plan_of(rig(), takes[:1], takes[1:], out, **options)


def test_takes_and_plan_come_back_as_they_were(takes: Any, tmp_path: Path) -> None:
    own = plan(takes, tmp_path / "a.mgmodel")
    folder = find_training_folder(tmp_path / "a.mgmodel")
    write_training(folder, own, takes[:1], takes[1:])
    again = read_training_plan(folder)
    assert again == own and again.fingerprint() == own.fingerprint()
    learned, held = read_planned_takes(folder, again)
    for one, other in zip((*learned, *held), takes, strict=True):
        assert np.array_equal(one.poses, other.poses) and np.array_equal(one.features, other.features)
        assert one.marks == other.marks and one.source == other.source


def test_what_is_held_out_is_not_learned_from(takes: Any, tmp_path: Path) -> None:
    with pytest.raises(SplitError):
        plan_of(rig(), takes, takes[1:], tmp_path / "a.mgmodel")


def test_more_time_goes_on_and_other_settings_do_not(takes: Any, tmp_path: Path) -> None:
    own = plan(takes, tmp_path / "a.mgmodel")
    longer = msgspec.structs.replace(own, minutes=90.0, threads=2, out="elsewhere")
    other = msgspec.structs.replace(own, settings=TrainingSettings(rate=1e-4))
    assert longer.fingerprint() == own.fingerprint() != other.fingerprint()


def test_a_training_begun_anew_forgets_the_one_before(takes: Any, tmp_path: Path) -> None:
    own, folder = plan(takes, tmp_path / "a.mgmodel"), find_training_folder(tmp_path / "a.mgmodel")
    folder.mkdir()
    for name in ("checkpoint.0.npz", "stop"):
        (folder / name).write_bytes(b"old")
    write_training(folder, own, takes[:1], takes[1:])
    assert sorted(p.name for p in folder.iterdir()) == sorted([PLAN, TAKES])


def test_what_is_missing_or_damaged_is_told(takes: Any, tmp_path: Path) -> None:
    own, folder = plan(takes, tmp_path / "a.mgmodel"), find_training_folder(tmp_path / "a.mgmodel")
    with pytest.raises(FileError, match="no training to go on with"):
        read_training_plan(folder)
    write_training(folder, own, takes[:1], takes[1:])
    content = (folder / TAKES).read_bytes()
    for spoiled in (b"", content[: len(content) // 2], b"PK\x03\x04" + bytes(200)):
        (folder / TAKES).write_bytes(spoiled)
        with pytest.raises(FileError, match="damaged"):
            read_planned_takes(folder, own)
    for text in (b"{", b"[]", b'{"kind": "matching"}', b"\xff"):
        (folder / PLAN).write_bytes(text)
        with pytest.raises(FileError, match="no training's plan"):
            read_training_plan(folder)


def test_by_the_papers_loss_nothing_is_done_that_the_paper_does_not() -> None:
    own = choose_settings("paper")
    assert (own.loss, own.voices, own.head, own.noise, own.known) == ("paper", 0, 0, 0, 1)
    assert (own.kept, own.clip, own.calm, own.tuned) == (0, 0, 0, 0), "nor means, clipping, an end"
    assert own.past_dropped == 0.4, "the paper's own"
    assert choose_settings(None).voices > 0


def test_by_the_papers_loss_a_small_model_is_built_as_published(takes: Any, tmp_path: Path) -> None:
    options = {"kind": "flow-vae", "settings": choose_settings("paper", "flow-vae")}
    own = plan(takes, tmp_path / "a.mgmodel", **options)
    ours = plan(takes, tmp_path / "a.mgmodel", kind="flow-vae")
    assert not own.sizes.guess and ours.sizes.guess
    assert ours.settings == choose_settings(None, "flow-vae")


def test_a_plan_names_no_file_on_another_computer(takes: Any, tmp_path: Path) -> None:
    folder = find_training_folder(tmp_path / "a.mgmodel")
    write_training(folder, plan(takes, tmp_path / "a.mgmodel"), takes[:1], takes[1:])
    up = "../" * (len(folder.resolve().parts) - 1)
    for name in (
        "//server/share/a.mgmodel",
        r"\\server\a.mgmodel",
        "/net/server/a",
        f"{up}net/server/a",
        "nul",
    ):
        write_plan(folder, msgspec.structs.replace(read_training_plan(folder), out=name))
        with pytest.raises(FileError, match="its model's file is not written: it is"):
            read_training_plan(folder)
        write_plan(folder, plan(takes, tmp_path / "a.mgmodel"))
