"""Models judged on takes that they have not seen: motion of several seeds to what the takes hear, and all
that `statistics` says of it, with what stands beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from metagraph.generation.chunks import GUIDANCE
from metagraph.generation.poses import PoseRig
from metagraph.generation.sampler import generate_recording_poses
from metagraph.generation.statistics import (
    DRAWS,
    MeasureRow,
    MotionSample,
    make_motion_sample,
    measure_diversity,
    measure_system,
    tabulate_measures,
)
from metagraph.generation.stored import Model
from metagraph.generation.takes import HELD, SplitError, Take, split_takes

Array = NDArray[Any]

SEEDS = 5


@dataclass(frozen=True)
class SamplingManner:
    """How models are sampled. seeds: how many takes of each. lookahead: frames, None for all that a model
    uses.
    """

    seeds: int = SEEDS
    temperature: float = 1.0
    lookahead: int | None = None
    guidance: float = GUIDANCE


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Takes that models are judged on. floor: poses `[T, X]` of each, other true motion to the same speech;
    None: half of the takes' blocks stands beside the other half.
    """

    takes: Sequence[Take]
    floor: Sequence[Array] | None = None


@dataclass(frozen=True, eq=False)
class JudgedModels:
    """What came of it. true, floor: performances of each take; None: there is no floor of other motion. made:
    of each model, of each seed. rows: the table, recorded motion itself first.
    """

    true: tuple[MotionSample, ...]
    floor: tuple[MotionSample, ...] | None
    made: Mapping[str, tuple[tuple[MotionSample, ...], ...]]
    rows: tuple[MeasureRow, ...]


def generate_poses(model: Model, heard: Array, seed: int, number: int, manner: SamplingManner) -> Array:
    """Return a model's poses `[T, X]`, not standardised, to features `[T, audio + 4]`. number: of the take,
    so that two takes of one seed have other chances.
    """
    return generate_recording_poses(
        model,
        heard,
        seed,
        manner.temperature,
        take=number,
        lookahead=manner.lookahead,
        guidance=manner.guidance,
    )


def find_unseen_takes(model: Model, takes: Sequence[Take]) -> tuple[tuple[Take, ...], tuple[str, ...]]:
    """Return the takes that a model may be judged on, and names of those left out, which it has learned from.
    Of one recording that was learned from except for a block, that block alone. Raises SplitError if none is
    left.
    """
    card = model.card
    seen = {d for t in card.takes for d in t.sha256}
    held = {d for t in card.held_out for d in t.sha256}
    fresh = tuple(t for t in takes if not seen & set(t.source.digests))
    left = tuple(t.source.name for t in takes if seen & set(t.source.digests))
    if fresh:
        return fresh, left
    partly = [t for t in takes if held & set(t.source.digests)]
    total = sum(t.seconds for t in card.held_out)
    block = split_takes(partly, HELD)[1] if len({t.source.digests[:1] for t in partly}) == 1 else ()
    if block and abs(sum(t.seconds for t in block) - total) < 0.1:
        return block, ()
    raise SplitError(
        f"all {len(takes)} takes are among those that the model has learned from"
        + (f" ('{left[0]}')" if left else "")
        + ": what it makes of them says nothing. Give takes that it has not seen"
    )


def find_takes_unseen_by_all(
    models: Mapping[str, Model], takes: Sequence[Take]
) -> tuple[tuple[Take, ...], tuple[str, ...]]:
    """Return the takes that none of the models has learned from, and the others' names. Raises SplitError."""
    chosen, out = tuple(takes), list[str]()
    for model in models.values():
        chosen, left = find_unseen_takes(model, chosen)
        out += left
    return chosen, tuple(dict.fromkeys(out))


def judge_on_takes(
    rig: PoseRig,
    models: Mapping[str, Model],
    held: HeldOut,
    manner: SamplingManner = SamplingManner(),
    hear: Callable[[str, Take], Array] | None = None,
    draws: int = DRAWS,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> JudgedModels:
    """Judge models on takes. hear: what a model is given of a take, its features unless given. Raises
    ValueError if there is too little to judge, CancelledError once `cancelled` says so.
    """
    takes, floor = held.takes, held.floor
    if not takes:
        raise ValueError("there is no take to judge a model on")
    if not 1 <= manner.seeds <= 100:
        raise ValueError(f"a model is judged with 1 to 100 seeds, not {manner.seeds}")
    true = tuple(make_motion_sample(rig, t.poses, t) for t in takes)
    made: dict[str, tuple[tuple[MotionSample, ...], ...]] = {}
    total, done = len(models) * manner.seeds * len(takes), 0
    for name, model in models.items():
        seeds = []
        for seed in range(1, manner.seeds + 1):
            motion = []
            for number, take in enumerate(takes):
                if cancelled is not None and cancelled():
                    raise CancelledError
                if progress is not None:
                    progress(done, total)
                done += 1
                heard = take.features if hear is None else hear(name, take)
                motion.append(
                    make_motion_sample(rig, generate_poses(model, heard, seed, number, manner), take)
                )
            seeds.append(tuple(motion))
        made[name] = tuple(seeds)
    other = None
    if floor is not None:
        other = tuple(make_motion_sample(rig, p, t) for p, t in zip(floor, takes, strict=True))
    own = make_truth_row(true, other, draws)
    return JudgedModels(true, other, made, (own, *tabulate_measures(made, true, other, draws)))


def make_truth_row(
    true: Sequence[MotionSample], other: Sequence[MotionSample] | None, draws: int
) -> MeasureRow:
    """Return the row of recorded motion itself: what it has of its own, and how far two draws of it are
    apart.
    """
    own = measure_system("true", [true], true, draws=draws)
    both = [true] if other is None else [true, other]
    return MeasureRow(own.name, {**own.values, "diversity": measure_diversity(both)}, own.spread)
