"""What is made small, and what goes wrong with the paper's loss."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from msgspec.structs import replace as changed

torch = pytest.importorskip("torch", reason="training needs torch, which is not installed")

from metagraph.generation.features import KNOWN, TOLD, count_audio  # noqa: E402
from metagraph.generation.networks import Control, FlowSizes, MatchingSizes  # noqa: E402
from metagraph.generation.takes import measure_scales  # noqa: E402
from metagraph.generation.train_plan import TrainingSettings  # noqa: E402
from metagraph.generation.training.data import TrainingCorpus, count_edge_frames  # noqa: E402
from metagraph.generation.training.learner import Learner  # noqa: E402
from metagraph.generation.training.losses import ALPHA, choose_objective  # noqa: E402
from metagraph.generation.training.nets import make_net  # noqa: E402
from metagraph.generation.vae import count_effective_dimensions, list_spans  # noqa: E402
from tests.generation.makers import rig, shaken, tiny  # noqa: E402
from tests.generation.training.planting import plan, take  # noqa: E402

FLOW = FlowSizes(control=Control(width=12), between=32, dims=8, steps=2, units=12)


@pytest.fixture(scope="module")
def takes() -> Any:
    return take(10.0, 1), take(8.0, 2)


def learned(takes: Any, sizes: FlowSizes = FLOW, steps: int = 200, **changes: Any) -> Learner:
    """A training of some hundred steps."""
    options = {"batch": 8, "frames": 48, "warm": 20, "rate": 5e-3, "least": 5e-3, "head": 0.0, "known": 1.0}
    settings = TrainingSettings(**(options | {"tuned": 100} | changes))
    own = Learner(plan(takes[:1], takes[1:], "flow-vae", sizes=sizes, settings=settings), [takes[0]])
    for _ in range(steps):
        own.advance()
    return own


def codes_of(own: Learner, takes: Any) -> Any:
    """What the flow sees of a take's poses, of all moments."""
    net = own.objective.net
    rows = list_spans(own.poses.apply(takes[0].poses), net.sizes.span)
    with torch.no_grad():
        return ((net.to_code(torch.from_numpy(rows)) - net.code.mean) / net.code.deviation).numpy()


def test_a_finished_code_stays_as_wide_as_it_is(takes: Any) -> None:
    assert 0.5 < codes_of(learned(takes, loss="finished"), takes).std(0).mean() < 2


def test_the_papers_code_shrinks_where_its_likelihood_weighs_more(takes: Any) -> None:
    # So the test above can fail: nothing but the smallness of alpha holds that code.
    own = learned(takes, loss="paper", alpha=100 * ALPHA["paper"], third=0.0, noise=0.0)
    assert not 0.5 < codes_of(own, takes).std(0).mean() < 2


GUESSED = FlowSizes(
    control=Control(width=12, past=1), between=60, dims=24, steps=2, units=12, span=4, guess=True
)


def test_a_finished_code_keeps_at_least_15_of_24_dimensions(takes: Any) -> None:
    """Numbers of a code that are copies of each other would say little: one of 24 was left of one that was
    learned together with its flow and made as wide number by number."""
    assert count_effective_dimensions(codes_of(learned(takes, GUESSED), takes)) >= 15


def test_a_guess_leaves_the_flow_what_is_white(takes: Any) -> None:
    own = learned(takes, GUESSED, steps=1, past_noise=0.0)
    objective = own.objective
    with torch.no_grad():
        batch = objective._batch(own.corpus, own.chance)  # type: ignore[operator]
    # A crop may begin where its take does, with a jump from the mean pose, which no guess knows of.
    codes = batch.codes[:, 1:].flatten(0, 1).numpy()
    assert 0.6 < np.median(codes.var(0)) < 1.4
    together = np.corrcoef(codes, rowvar=False) - np.eye(24)
    assert np.abs(together).mean() < 0.2


def test_the_paper_learns_its_autoencoder_with_the_flow_and_a_finished_one_stays(takes: Any) -> None:
    for loss, moves in (("paper", True), ("finished", False)):
        own = learned(takes, FLOW, 1, loss=loss)
        before = own.weights()["encode.0.weight"].copy()
        for _ in range(3):
            own.advance()
        assert (own.weights()["encode.0.weight"] != before).any() == moves


def test_the_encoder_is_a_gaussian_whose_draws_the_flow_sees(takes: Any) -> None:
    net = learned(takes, FLOW, 1, loss="finished").objective.net
    poses = torch.randn(5, net.sizes.pose, generator=torch.Generator().manual_seed(1))
    one, other = (net.draw_code(poses, torch.Generator().manual_seed(n)) for n in (1, 2))
    mean, deviation = net.encode_gaussian(poses)
    assert not torch.allclose(one, other)
    assert float(((one - mean) / deviation).abs().max()) < 6
    assert torch.equal(net.to_code(poses), mean)


def test_the_draw_of_the_third_term_begins_without_memory(takes: Any) -> None:
    """Codes that the draw gives, of the noise of the way there, are the same codes."""
    sizes = tiny("flow-vae")
    net = make_net(sizes, shaken(sizes))
    chance = torch.Generator().manual_seed(1)
    codes = torch.randn(2, 30, sizes.dims, generator=chance)
    context = torch.randn(2, 30, sizes.control.context(sizes.pose), generator=chance)
    with torch.no_grad():
        z, _ = net.flow(codes, context)
        again, _ = net.flow.inverse(z, context)
    assert float((again - codes).abs().max()) < 1e-4


@pytest.mark.parametrize("loss", ["paper", "finished", None])
def test_the_third_term_is_the_papers_alone(takes: Any, loss: Any) -> None:
    objective = choose_objective(make_net(FLOW), TrainingSettings(loss=loss))
    assert objective.third == (1.0 if loss == "paper" else 0.0)


def test_losses_of_other_models_are_refused() -> None:
    for sizes in (tiny("moglow"), GUESSED):
        with pytest.raises(ValueError, match="autoencoder's code"):
            choose_objective(make_net(sizes), TrainingSettings(loss="paper"))
    with pytest.raises(ValueError, match="is for a flow"):
        choose_objective(make_net(tiny("matching")), TrainingSettings(loss="finished"))


def corpus(takes: Any, sizes: Any) -> TrainingCorpus:
    return TrainingCorpus(takes, *measure_scales(takes), *count_edge_frames(sizes))


@pytest.mark.parametrize("unmarked", [0.0, 0.3, 1.0])
def test_a_share_of_crops_is_not_told_the_marks(takes: Any, unmarked: float) -> None:
    sizes = changed(tiny("matching"), audio=count_audio("matching"))
    settings = TrainingSettings(batch=200, known=1.0, unmarked=unmarked, voices=0.0)
    own = choose_objective(make_net(sizes), settings)
    data = TrainingCorpus(takes, *measure_scales(takes, sizes.audio), *count_edge_frames(sizes))
    own.begin(data, torch.Generator().manual_seed(1))
    heard: list[Any] = []
    frames = own.net.frames

    def hear(features: Any, *rest: Any) -> Any:
        heard.append(features)
        return frames(features, *rest)

    own.net.frames = hear
    own.loss(data, torch.Generator().manual_seed(2))
    inside = heard[0][:, sizes.past * sizes.frames : (sizes.past + sizes.new) * sizes.frames]
    known = inside[:, 0, -TOLD + KNOWN] == 1
    assert abs(float((~known).float().mean()) - unmarked) < 0.1
    assert not heard[0][~known][..., -TOLD:-4].any()


def test_a_model_of_an_earlier_version_learns_no_more() -> None:
    with pytest.raises(ValueError, match="begin a new training"):
        choose_objective(make_net(FlowSizes(code="autoencoder", dims=7)), TrainingSettings())


def test_crops_lie_within_takes_and_reach_both_ends(takes: Any) -> None:
    sizes = tiny("flow-vae")
    own = corpus(takes, sizes)
    starts = own.starts(torch.Generator().manual_seed(1), 20000, 150).numpy()
    for first, count in zip(own.first, own.counts, strict=True):
        inside = starts[(starts >= first) & (starts < first + count)]
        assert inside.min() == first and inside.max() == first + count - 150
    assert len(set(starts.tolist())) == int((own.counts - 149).sum())


def test_around_a_take_nobody_speaks_and_the_mean_pose_is_held(takes: Any) -> None:
    sizes = MatchingSizes()
    own = corpus(takes, sizes)
    starts = torch.from_numpy(own.first[1:])
    before = own.rows(own.heard, starts, -sizes.past * sizes.frames, 0)[0]
    assert torch.equal(before[:, -1], torch.ones(len(before))) and not before[:, -4:-1].any()
    assert not own.rows(own.poses, starts, -sizes.past * sizes.frames, 0).any()


@pytest.mark.parametrize("kind", ["flow-vae", "matching"])
def test_what_comes_after_the_look_ahead_changes_nothing(kind: Any) -> None:
    sizes = tiny(kind)
    net = make_net(sizes, shaken(sizes))
    frames = torch.randn(1, 60 if kind == "flow-vae" else sizes.tokens * sizes.frames, 31)
    other = frames.clone()
    with torch.no_grad():
        if kind == "flow-vae":
            other[:, 5 + 4 + 1 :] += 1.0  # the first frame knows 4 ahead
            a, b = (net.heard(x, torch.tensor([4]))[:, 0] for x in (frames, other))
            more = net.heard(other, torch.tensor([5]))[:, 0]
        else:
            other[:, sizes.past * sizes.frames + 4 + 1 :] += 1.0
            a, b = (net.frames(x, torch.tensor([4]), torch.tensor([False])) for x in (frames, other))
            more = net.frames(other, torch.tensor([5]), torch.tensor([False]))
    assert torch.equal(a, b) and not torch.allclose(b, more)


def test_who_hears_nothing_sees_who_speaks() -> None:
    sizes = tiny("matching")
    net = make_net(sizes, shaken(sizes))
    frames = torch.randn(1, sizes.tokens * sizes.frames, 31)
    louder, other = frames.clone(), frames.clone()
    louder[..., :27] += 1.0
    other[..., 27:] += 1.0
    deaf, all_known = torch.tensor([True]), torch.tensor([sizes.most])
    with torch.no_grad():
        a, b, c = (net.heard(net.frames(x, all_known, deaf), deaf) for x in (frames, louder, other))
        hearing = net.heard(net.frames(frames, all_known, ~deaf), ~deaf)
    assert torch.equal(a, b) and not torch.allclose(a, c) and not torch.allclose(a, hearing)


def test_a_clip_that_hardly_moves_has_speeds_that_are_numbers() -> None:
    still = take(8.0, 1)
    held = type(still)(still.source, np.repeat(still.poses[:1], len(still.poses), 0), still.features)
    own = corpus([held], tiny("matching"))
    assert torch.isfinite(own.speeds).all() and rig().numbers == 78
