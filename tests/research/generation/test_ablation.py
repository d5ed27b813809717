from dataclasses import replace

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.generation.features import NONE, PARTNER, SELF
from metagraph.generation.networks import list_weight_shapes, make_sizes
from metagraph.generation.stored import write_model
from metagraph.generation.take_files import find_takes, read_take_batch
from metagraph.research.generation.ablation import (
    CHANGES,
    NAMES,
    AblationMaterial,
    AblationTraining,
    ablate_features,
    ablate_model,
    choose_sizes,
)
from metagraph.research.generation.evaluation import HeldOut, SamplingManner
from metagraph.research.generation.planted import Planted, write_planted
from tests.generation.makers import rig, tiny, untrained
from tests.research.generation.test_evaluation import TAKES

BY_NAME = {c.name: c for c in CHANGES}


class Trained:
    """Writes models that have learned nothing, and remembers what was asked."""

    def __init__(self, fails_at: str = "") -> None:
        self.jobs = []
        self.fails_at = fails_at

    def __call__(self, job):
        if self.fails_at and self.fails_at in job.out.name:
            raise KeyboardInterrupt
        self.jobs.append(job)
        write_model(untrained(job.kind, sizes=job.sizes), job.out)


def material(twins=list):
    return AblationMaterial(rig(), TAKES[:1], HeldOut(TAKES[1:]), {}, twins)


def run(folder, trainer, changes=("whole", "no past", "no activity", "mirrored"), trainings=1):
    return ablate_model(
        folder,
        trainer,
        material(lambda: [replace(TAKES[0], source=replace(TAKES[0].source, mirrored=True))]),
        AblationTraining("flow-vae", tiny("flow-vae"), 1.0, trainings),
        changes=[BY_NAME[c] for c in changes],
        manner=SamplingManner(seeds=1),
        draws=2,
    )


@pytest.mark.parametrize("kind", ["flow-vae", "moglow", "cvae", "matching"])
@pytest.mark.parametrize("size", ["small", "paper"])
def test_every_change_gives_sizes_that_can_be_or_says_nothing(kind, size):
    sizes = make_sizes(kind, size)
    wanted = {c.name: choose_sizes(c, kind, sizes) for c in CHANGES}
    assert wanted["whole"] == (kind, sizes)
    for found in wanted.values():
        assert found is None or list_weight_shapes(found[1])
    if kind == "flow-vae":
        named = [n for n, found in wanted.items() if found is None]
        other = ["any moment", "apart"]
        if size == "paper":
            other = ["no guess", "frame by frame", *other, "no guidance", "no lengths"]
        assert named == other
        assert wanted["no vae"][1].steps == sizes.steps and wanted["no vae"][1].units == sizes.units
        assert wanted["no ahead"][1].control.frames == sizes.control.frames
        assert wanted["no past"][1].control.past == 0


def test_one_thing_is_changed_at_a_time(tmp_path):
    trainer = Trained()
    found = run(tmp_path / "a", trainer)
    assert [r.name for r in found.rows][-4:] == ["whole", "no past", "no activity", "mirrored"]
    whole, past, quiet, mirrored = trainer.jobs
    assert {j.seconds for j in trainer.jobs} == {1.0} and {j.seed for j in trainer.jobs} == {1}
    assert past.sizes.control.past == 0 and whole.sizes.control.past == 5
    assert (quiet.learned[0].features[:, -4:][:, NONE] == 1).all()
    assert (quiet.held[0].features[:, -4:][:, NONE] == 1).all()
    assert (quiet.learned[0].features[:, :-4] == TAKES[0].features[:, :-4]).all()
    assert [t.source.mirrored for t in mirrored.learned] == [False, True]
    assert [t.source.mirrored for t in mirrored.held] == [False]


@pytest.mark.nightly
def test_what_is_trained_is_not_trained_again(tmp_path):
    stopped = Trained(fails_at="no-activity")
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path / "a", stopped)
    assert len(stopped.jobs) == 2
    after = Trained()
    found = run(tmp_path / "a", after)
    assert found.kept == ("whole, seed 1", "no past, seed 1")
    assert found.ran == ("no activity, seed 1", "mirrored, seed 1")
    again = run(tmp_path / "a", Trained())
    assert not again.ran and str(again.rows) == str(found.rows)
    more = Trained()
    run(tmp_path / "a", more, trainings=2)
    assert [j.seed for j in more.jobs] == [2] * 4


def test_another_ablations_folder_is_left_alone(tmp_path):
    run(tmp_path / "a", Trained(), ("whole",))
    with pytest.raises(FileError, match="other seconds"):
        ablate_model(
            tmp_path / "a", Trained(), material(), AblationTraining("flow-vae", tiny("flow-vae"), 2.0)
        )
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "thesis.txt").write_text("mine")
    with pytest.raises(FileError, match="other files"):
        run(tmp_path / "b", Trained())
    with pytest.raises(ValueError, match="1 to 20 trainings"):
        run(tmp_path / "c", Trained(), trainings=0)


def test_what_differs_in_sampling_alone_is_trained_once(tmp_path):
    trainer = Trained()
    found = ablate_model(
        tmp_path,
        trainer,
        material(),
        AblationTraining("matching", tiny("matching"), 1.0),
        changes=[BY_NAME["whole"], BY_NAME["no guidance"], BY_NAME["no past"]],
        manner=SamplingManner(seeds=1),
        draws=1,
    )
    assert len(trainer.jobs) == 1 and found.left == ("no past",)
    assert [r.name for r in found.rows][-2:] == ["whole", "no guidance"]


@pytest.mark.nightly
def test_without_the_partner_neither_voice_nor_activity_is_left(sample, tmp_path):
    write_planted(sample, tmp_path, Planted(count=1, seconds=20.0))
    files, _ = find_takes([tmp_path])
    take = read_take_batch(files).takes[1]
    alone = ablate_features(BY_NAME["no partner"], take, {f.clip.stem: f for f in files})
    own = take.activity[:, SELF] + take.activity[:, PARTNER] + take.activity[:, NONE] > 0
    assert (alone[:, -4:].sum(1) == 1).all() and own.any()
    assert not alone[:, -4:][:, PARTNER].any()
    listening = take.activity[:, PARTNER] > 0.5
    assert alone[listening, :-4].mean() < take.features[listening, :-4].mean() - 1
    talking = take.activity[:, SELF] > 0.5
    assert np.abs(alone[talking, :-4] - take.features[talking, :-4]).mean() < 0.5
    assert len(set(NAMES)) == len(NAMES)
