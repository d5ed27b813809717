"""From what was learned to a model's file, with everything there is to know about it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import torch

from metagraph.generation.networks import Weights
from metagraph.generation.poses import Standardisation
from metagraph.generation.stored import Model, ModelCard, list_versions, write_model
from metagraph.generation.train_plan import TrainingPlan
from metagraph.generation.training.learner import Learner, check_weights
from metagraph.generation.training.losses import choose_loss


def make_trained_model(
    plan: TrainingPlan,
    weights: Weights,
    poses: Standardisation,
    audio: Standardisation,
    steps: int,
    statistics: Mapping[str, float] | None = None,
    notes: tuple[str, ...] = (),
) -> Model:
    """Return a model. poses, audio: what standardises them. Raises TrainingError for weights that are no
    numbers.
    """
    check_weights(plan, weights)
    card = ModelCard(
        kind=plan.kind,
        sizes=plan.sizes,
        skeleton=plan.skeleton,
        pose_mean=tuple(poses.mean.tolist()),
        pose_deviation=tuple(poses.deviation.tolist()),
        audio_mean=tuple(audio.mean.tolist()),
        audio_deviation=tuple(audio.deviation.tolist()),
        tracks=plan.tracks,
        loss=plan.settings.loss or choose_loss(plan.sizes),
        seed=plan.seed,
        steps=steps,
        hours=round(sum(t.seconds for t in plan.takes) / 3600, 4),
        takes=plan.takes,
        held_out=plan.held,
        versions={**list_versions(), "torch": str(torch.__version__)},
        statistics=dict(statistics or {}),
        notes=notes,
    )
    return Model(card, weights)


def make_model_so_far(
    learner: Learner, statistics: Mapping[str, float] | None = None, notes: tuple[str, ...] = ()
) -> Model:
    """Return what a training has learned so far, as a model. Raises TrainingError."""
    return make_trained_model(
        learner.plan, learner.weights(), learner.poses, learner.audio, learner.step, statistics, notes
    )


def export_model(model: Model, out: Path) -> None:
    """Write a model, whole or not at all. Raises FileError."""
    write_model(model, out)
