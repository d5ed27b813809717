"""What is learned: the toy's coupling, a clip by heart; and that a training goes on as though never cut."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="training needs torch, which is not installed")

from metagraph.generation import averaging, generators, vae  # noqa: E402
from metagraph.generation.features import with_edges  # noqa: E402
from metagraph.generation.landmarks import place_landmarks  # noqa: E402
from metagraph.generation.networks import FlowSizes, Kind, Sizes, make_sizes  # noqa: E402
from metagraph.generation.stored import make_skeleton_card  # noqa: E402
from metagraph.generation.train_plan import TrainingPlan, TrainingSettings  # noqa: E402
from metagraph.generation.training.learner import FUTILE, Learner, TrainingError  # noqa: E402
from metagraph.generation.training.losses import FlowObjective  # noqa: E402
from metagraph.graph.model import Project  # noqa: E402
from metagraph.playback.bake import bake  # noqa: E402
from metagraph.playback.evaluator import Evaluator  # noqa: E402
from metagraph.speech.drive import drive  # noqa: E402
from tests.generation.makers import conversation, rig  # noqa: E402
from tests.generation.training.planting import plan, stroke, take, toy, toy_sizes  # noqa: E402

SMALL = TrainingSettings(batch=4, frames=40, warm=20)
KINDS: tuple[Kind, ...] = ("flow-vae", "moglow", "cvae", "matching")


@pytest.fixture(scope="module")
def takes() -> Any:
    return take(8.0, 1), take(8.0, 2)


@pytest.mark.parametrize("kind", KINDS)
def test_a_training_that_was_cut_goes_on_to_the_bit(kind: Kind, takes: Any) -> None:
    own = plan((takes[0],), (takes[1],), kind, settings=SMALL)
    whole = Learner(own, [takes[0]])
    for n in range(8):
        whole.advance(n / 8)
    first = Learner(own, [takes[0]])
    for n in range(5):
        first.advance(n / 8)
    kept = first.state()
    again = Learner(own, [takes[0]])
    again.restore(5, kept)
    for n in range(5, 8):
        again.advance(n / 8)
    expected, found = whole.weights(), again.weights()
    assert all(np.array_equal(expected[name], found[name]) for name in expected)


def test_a_checkpoint_of_another_net_is_refused(takes: Any) -> None:
    one = Learner(plan((takes[0],), (takes[1],), "cvae", settings=SMALL), [takes[0]])
    other = Learner(plan((takes[0],), (takes[1],), "matching", settings=SMALL), [takes[0]])
    with pytest.raises(ValueError, match="another net"):
        other.restore(1, one.state())


def test_the_head_is_learned_with_and_not_kept(takes: Any) -> None:
    own = Learner(plan((takes[0],), (takes[1],), "matching", settings=SMALL), [takes[0]])
    before = own.objective.speeds.weight.detach().clone()
    for _ in range(3):
        own.advance()
    assert not torch.equal(before, own.objective.speeds.weight)
    assert not any("speeds" in name for name in own.weights())


def test_steps_without_a_number_change_nothing_and_end_after_a_while(takes: Any) -> None:
    own = Learner(plan((takes[0],), (takes[1],), "matching", settings=SMALL), [takes[0]])
    own.advance()
    before = own.weights()
    own.corpus.heard[:] = torch.nan
    for _ in range(FUTILE - 1):
        own.advance()
    after = own.weights()
    assert all(np.array_equal(before[name], after[name]) for name in before)
    with pytest.raises(TrainingError, match="lower rate"):
        own.advance()


def test_the_rate_rises_falls_and_calms_down(takes: Any) -> None:
    own = Learner(plan((takes[0],), (takes[1],), "cvae", settings=TrainingSettings(warm=100)), [takes[0]])
    rates = []
    for own.step in (0, 49, 99, 399, 99_999):
        rates.append(own.rate(0.0))
    assert np.allclose(rates, [1.5e-5, 7.5e-4, 1.5e-3, 7.5e-4, 1.5e-4])
    assert own.rate(1.0) < 0.11 * own.rate(0.5)


def test_takes_shorter_than_a_crop_are_learned_from(takes: Any) -> None:
    short = takes[0].part(0, 101)
    own = Learner(
        plan((short,), (takes[1],), "flow-vae", settings=TrainingSettings(batch=3, frames=500)), [short]
    )
    assert np.isfinite(own.advance()["loss"]) and own.objective.length == 101


def test_a_clip_of_ten_seconds_is_learned_by_heart(sample: Project) -> None:
    _, performed = drive(conversation(10.0), 0, sample)
    one, other = take(10.0, 1, bake(Evaluator(performed, sample), sample, 10.0, 25.0)), take(10.0, 2)
    sizes = make_sizes("flow-vae", as_published=True)
    assert isinstance(sizes, FlowSizes)
    settings = TrainingSettings(loss="finished", batch=8, frames=64, warm=30, head=0.0, tuned=400)
    own = Learner(plan((one,), (other,), sizes=sizes, settings=settings, kind="flow-vae"), [one])
    own.advance()
    weights, standard = own.weights(), own.poses.apply(one.poses)
    again = vae.decode_spans(weights, sizes, vae.encode_spans(weights, sizes, standard))
    apart = place_landmarks(rig(), own.poses.undo(again)) - place_landmarks(rig(), one.poses)
    assert 100 * np.linalg.norm(apart, axis=-1).mean() < 0.5


def learn_toys(kind: Kind, sizes: Sizes, steps: int, **changes: Any) -> Learner:
    """A training on four toys."""
    options = {"batch": 32, "frames": 96, "warm": 100, "rate": 3e-3, "known": 1.0, "kept": 0.99}
    own = Learner(
        TrainingPlan(
            kind=kind,
            sizes=sizes,
            settings=TrainingSettings(**(options | changes)),
            skeleton=make_skeleton_card(rig()),
            takes=(),
            held=(),
            out="toy",
        ),
        [toy(1500, n) for n in range(4)],
    )
    for n in range(steps):
        own.advance(n / steps)
    return own


@pytest.mark.parametrize(
    ("kind", "guess", "steps"), [("matching", False, 500), ("flow-vae", False, 250), ("flow-vae", True, 250)]
)
def test_what_is_planted_is_found_with_what_is_heard_and_not_without(
    kind: Kind, guess: bool, steps: int
) -> None:
    held, other = toy(1500, 99), toy(1500, 7)
    sizes = toy_sizes(kind, guess)
    own = learn_toys(kind, sizes, steps)
    weights = own.weights()

    def made(told: Any) -> Any:
        maker = generators.make_generator(weights, sizes, np.zeros(18, np.float32))
        heard = np.concatenate([own.audio.apply(told[:, :-4]), told[:, -4:]], 1)
        heard = with_edges(heard, maker.before, maker.ahead + 64)
        reach = maker.before + 1 + maker.ahead
        rows = [maker.step(heard[f : f + reach], 1, 0, f) for f in range(0, len(told), maker.made)]
        return own.poses.undo(averaging.Averaging().whole(np.concatenate(rows)[: len(told)]))

    deaf = held.features.copy()
    deaf[:, :27] = other.features[:, :27]  # what is said to somebody else
    poses = made(held.features)
    true, wrong = stroke(held.poses, held), stroke(other.poses, held)
    assert stroke(poses, held) > wrong + 0.5 * (true - wrong)
    assert abs(stroke(made(deaf), held) - wrong) < 0.25 * (true - wrong)
    peaks = [round(25 * p) for p in held.marks.peaks]
    first = [poses[p, :3].mean() > poses[p, 6:9].mean() for p in peaks]
    assert 0.15 < np.mean(first) < 0.85


@pytest.mark.parametrize("dropped", [0.3, 1.0])
def test_the_flow_makes_use_of_the_past_that_it_is_told(dropped: float) -> None:
    """To a flow that knows the past, codes are less likely after another past, which the guess does not see;
    to one that never learned it (so the test can fail), as likely."""
    own = learn_toys("flow-vae", toy_sizes("flow-vae", True), 200, past_dropped=dropped)
    objective = own.objective
    assert isinstance(objective, FlowObjective)
    objective.settings = TrainingSettings(batch=256, frames=96, past_dropped=0.0)
    with torch.no_grad():
        batch = objective._batch(own.corpus, own.chance)
        width = own.plan.sizes.control.width  # type: ignore[union-attr]
        strange = torch.cat([batch.context[..., :width].roll(1, 0), batch.context[..., width:]], -1)
        right, wrong = (nats(objective, batch.codes, context) for context in (batch.context, strange))
    assert (wrong - right > 0.25) == (dropped < 1)


def nats(objective: FlowObjective, codes: Any, context: Any) -> float:
    """How unlikely codes are, the mean of all moments, up to a constant."""
    z, logs = objective.net.flow(codes, context)
    return float((0.5 * (z * z).sum(-1) - logs).mean())
