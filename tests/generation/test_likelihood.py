"""What is drawn one frame after another is what a whole take is measured by."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.generation.features import compute_conversation_activity, compute_features, count_sound_frames
from metagraph.generation.generators import make_generator
from metagraph.generation.likelihood import find_noise
from metagraph.generation.networks import Control, FlowSizes
from metagraph.generation.noise import draw_noise
from tests.generation.makers import babble, conversation, untrained

SOUND = np.stack([babble(2, 1), babble(2, 2)])
TOLD = compute_conversation_activity(conversation(2), 0, count_sound_frames(SOUND.shape[1]))
HEARD = compute_features(SOUND, TOLD)
WINDOW = Control(kind="window", ahead=20)


@pytest.mark.parametrize("lookahead", [None, 0, 7])
@pytest.mark.parametrize(
    "sizes",
    [
        FlowSizes(code="none", dims=78, steps=3, units=6, control=Control(width=8)),
        FlowSizes(code="none", dims=78, steps=2, units=6, layers=2, control=WINDOW),
        FlowSizes(code="pca", dims=234, steps=2, units=6, control=Control(width=8, past=2), span=3),
        FlowSizes(code="none", dims=78, steps=2, units=6, control=Control(width=8, past=0)),
        FlowSizes(
            code="pca", dims=234, steps=2, units=6, control=Control(width=8, past=2), span=3, guess=True
        ),
    ],
)
def test_a_take_that_was_drawn_gives_its_noise_back(sizes, lookahead):
    """The sampler goes frame by frame, with windows of its own; this goes through the whole at once."""
    model = untrained("moglow", 0.02, sizes)
    made = make_generator(model.weights, sizes, np.zeros(78, np.float32), 0.5, lookahead)
    edges = model.heard(np.concatenate([HEARD[:0], HEARD]))
    quiet = model.heard(np.concatenate([np.tile(np.log(1e-5), 27), [0, 0, 0, 1]])[None].astype(np.float32))
    heard = np.concatenate([quiet] * made.before + [edges] + [quiet] * made.ahead)
    count = len(HEARD) // sizes.span
    rows = [made.step(heard[n * sizes.span :][: made.before + 1 + made.ahead], 4, 0, n) for n in range(count)]
    poses = model.poses.undo(np.concatenate(rows))
    z, logs = find_noise(model, poses, HEARD[: len(poses)], lookahead)
    expected = 0.5 * np.stack([draw_noise(4, 0, n, sizes.dims) for n in range(count)])
    assert np.abs(np.concatenate(rows)).max() < 8
    assert np.abs(z - expected).max() < 2e-3
    assert np.isfinite(logs).all()
    assert logs.shape == (count,)


def test_the_density_of_a_guess_counts_how_far_it_spreads():
    """Noise that spreads three times as far is as likely at a third of each number's density."""
    control = Control(width=8, past=2)
    sizes = FlowSizes(code="pca", dims=5, steps=2, units=6, control=control, span=3, guess=True)
    model = untrained("flow-vae", 0.02, sizes)
    still = np.tile(np.array([1.0, 0, 0, 0, 1, 0] * 13), (len(HEARD), 1))
    near = find_noise(model, still, HEARD)
    model.weights["guess.spread"] = 3 * model.weights["guess.spread"]
    model.weights["guess.bias"] = 0 * model.weights["guess.bias"]
    model.weights["code.mean"] = np.zeros_like(model.weights["code.mean"])
    wide = find_noise(model, still, HEARD)
    flow = wide[0].shape[1]
    assert flow == 5
    assert abs(wide[1].mean() - near[1].mean() + 5 * np.log(3)) < 1.0


def test_what_is_unlike_the_model_is_less_likely():
    model = untrained("flow-vae", 0.05)
    poses = np.tile(np.array([1.0, 0, 0, 0, 1, 0] * 13), (len(HEARD), 1))
    far = poses + 0.5 * np.random.default_rng(1).standard_normal(poses.shape)
    assert find_noise(model, far, HEARD)[1].mean() < find_noise(model, poses, HEARD)[1].mean() - 1


def test_models_without_a_flow_and_takes_that_do_not_fit_are_told():
    with pytest.raises(ValueError, match="matching"):
        find_noise(untrained("matching"), np.zeros((3, 78)), HEARD[:3])
    with pytest.raises(ValueError, match="4 poses cannot go with 3"):
        find_noise(untrained(), np.zeros((4, 78)), HEARD[:3])
