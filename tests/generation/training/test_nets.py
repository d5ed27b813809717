"""Torch's nets do what NumPy's do, with the same weights and noise."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="training needs torch, which is not installed")

from metagraph.generation import chunks  # noqa: E402
from metagraph.generation.features import with_edges  # noqa: E402
from metagraph.generation.networks import (  # noqa: E402
    Control,
    CvaeSizes,
    FlowSizes,
    Kind,
    MatchingSizes,
    Sizes,
    count_parameters,
)
from metagraph.generation.noise import draw_noise  # noqa: E402
from metagraph.generation.poses import FURTHEST  # noqa: E402
from metagraph.generation.sampler import generate_recording_poses  # noqa: E402
from metagraph.generation.stored import Model  # noqa: E402
from metagraph.generation.training.flow_net import CvaeNet, FlowNet, mask_sound  # noqa: E402
from metagraph.generation.training.matching_net import MatchingNet  # noqa: E402
from metagraph.generation.training.nets import make_net, read_net_weights  # noqa: E402
from tests.generation.makers import shaken, tiny, untrained  # noqa: E402

KINDS: tuple[Kind, ...] = ("flow-vae", "moglow", "cvae", "matching")
FRAMES = 50


def features(frames: int, seed: int = 3) -> Any:
    chance = np.random.default_rng(seed)
    out = np.zeros((frames, 31), np.float32)
    out[:, :27] = chance.normal(-5, 3, (frames, 27))
    out[np.arange(frames), 27 + chance.integers(0, 4, frames)] = 1
    return out


def drawn(model: Model, told: Any, seed: int, lookahead: int | None) -> Any:
    """What torch makes of a recording: poses `[T, X]`, standardised, before they are averaged."""
    sizes = model.card.sizes
    net = make_net(sizes, model.weights).eval()
    with torch.no_grad():
        if isinstance(net, MatchingNet):
            return _chunks(net, model, told, seed, lookahead)
        return _frames(net, model, told, seed, lookahead)


def _frames(net: FlowNet | CvaeNet, model: Model, told: Any, seed: int, lookahead: int | None) -> Any:
    sizes = net.sizes
    control = sizes.control
    features = torch.from_numpy(model.heard(with_edges(told, control.before, control.ahead)))[None]
    ahead = None if lookahead is None else torch.tensor([lookahead])
    heard = net.heard(features, ahead)
    deaf = net.heard(mask_sound(features, torch.tensor([True])), ahead)
    span = sizes.span if isinstance(sizes, FlowSizes) else 1
    past = torch.zeros(1, 1, max(1, control.past), sizes.pose)
    guessed = isinstance(net, FlowNet) and net.sizes.guess
    if isinstance(net, FlowNet) and guessed:
        held = net.to_code(torch.zeros(1, 1, 1, span * sizes.pose)) / net.code.deviation
        past = held.expand(1, 1, control.past, -1)
    out: list[Any] = []
    state: Any = None
    other: Any = None  # of the same flow without sound
    for t in range(0, len(told), span):
        z = torch.from_numpy(draw_noise(seed, 0, t, sizes.dims))[None, None]
        context = net.context(heard[:, t : t + 1], past)
        if isinstance(net, FlowNet):
            code, state = net.flow.inverse(z, context, state)
            if net.sizes.guided:
                without, other = net.flow.inverse(z, net.context(deaf[:, t : t + 1], past), other)
                code = without + chunks.GUIDANCE * (code - without)
            if guessed:
                code = net.guess.complete(code, past).clamp(-FURTHEST, FURTHEST)
                past = torch.cat([past, code[:, :, None]], 2)[:, :, -control.past :]
            poses = net.from_code(code * net.code.deviation if net.sizes.code != "none" else code)
        else:
            hidden, state = net.decoder(torch.cat([z, context], -1), state)
            poses = net.decoder_out(hidden)
        poses = poses.clamp(-FURTHEST, FURTHEST).reshape(1, 1, span, -1)
        if not guessed:
            past = torch.cat([past, poses], 2)[:, :, -max(1, control.past) :]
        out.append(poses[0, 0])
    return torch.cat(out).numpy()[: len(told)]


def _chunks(net: MatchingNet, model: Model, told: Any, seed: int, lookahead: int | None) -> Any:
    s = net.sizes
    before = s.past * s.frames
    heard = torch.from_numpy(model.heard(with_edges(told, before, (s.new + s.ahead) * s.frames)))
    past = torch.from_numpy(chunks.make_still_tokens(model.weights, s, np.zeros(s.pose, np.float32)))
    known = s.most if lookahead is None else lookahead
    ahead, kept_tokens = torch.tensor([known]), min(s.new, max(1, (known + 1) // s.frames))
    out = []
    for t in range(0, len(told), kept_tokens * s.frames):
        window = heard[t : t + s.tokens * s.frames][None]
        own, free = (net.heard(net.frames(window, ahead, d), d) for d in map(torch.tensor, ([False], [True])))
        x = chunks.SPREAD * torch.from_numpy(draw_noise(seed, 0, t, s.new * s.dims).reshape(1, s.new, s.dims))
        for n in range(chunks.STEPS):
            moment, before_it = torch.tensor([n / chunks.STEPS]), net.embed_past(past[None])
            v = net.velocity(x, moment, before_it, own)
            if n < chunks.GUIDED:
                without = net.velocity(x, moment, before_it, free)
                v = (1 - chunks.GUIDANCE) * without + chunks.GUIDANCE * v
            x = x + v / chunks.STEPS
        tokens = x[0, :kept_tokens].clamp(-FURTHEST, FURTHEST)
        past = torch.cat([past, tokens])[-s.past :]
        out.append(tokens)
    tokens, kept = torch.cat(out), net.tokens
    if s.around:
        beside = torch.nn.functional.pad(tokens.T[None], (s.around, s.around), "replicate")[0].T
        near = torch.cat([beside[k : k + len(tokens)] for k in range(2 * s.around + 1)], 1)
        rows = near @ kept.joined + kept.mean
    else:
        rows = (tokens * kept.deviation) @ kept.basis + kept.mean
    return rows.reshape(-1, s.pose).clamp(-FURTHEST, FURTHEST).numpy()[: len(told)]


@pytest.mark.parametrize("kind", KINDS)
def test_weights_are_stored_without_renaming(kind: Kind) -> None:
    weights = shaken(tiny(kind))
    found = read_net_weights(make_net(tiny(kind), weights))
    assert list(found) == list(weights)
    assert all(np.array_equal(found[name], weights[name]) for name in weights)


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_learned_is_what_is_counted(kind: Kind) -> None:
    sizes = tiny(kind)
    learned = sum(p.numel() for p in make_net(sizes).parameters())
    triangles = sum(
        p.numel() - len(p) * (len(p) - 1) // 2
        for n, p in make_net(sizes).named_parameters()
        if n.endswith(("lower", "upper"))
    )
    computed = (
        4 * 78 * 6 + 4 * 78 + 6 + 3 * 6 * 4 * 78 if isinstance(sizes, MatchingSizes) else 0
    )  # the tokens' components
    assert learned - triangles + computed == count_parameters(sizes)


def odd(kind: Kind) -> Sizes:
    """Sizes unlike the usual ones: spans, components, the paper's window, two layers."""
    if kind == "cvae":
        near = Control(kind="window", past=0, before=0, ahead=0)
        return CvaeSizes(control=near, dims=5, units=6, layers=3)
    if kind == "moglow":
        far = Control(kind="window", ahead=20)
        return FlowSizes(control=far, code="none", dims=78, steps=2, units=5, layers=2)
    if kind == "flow-vae":
        control = Control(width=8, past=2)
        return FlowSizes(
            control=control, between=20, dims=7, steps=2, units=6, span=4, guess=True, guided=True
        )
    return MatchingSizes(dims=5, past=1, new=2, ahead=0, hidden=12, heads=3, layers=1, time=6, width=5)


@pytest.mark.parametrize("lookahead", [None, 3])
@pytest.mark.parametrize("sizes", [tiny, odd])
@pytest.mark.parametrize("kind", KINDS)
def test_the_sampler_makes_what_torch_makes_of_the_same_noise(
    kind: Kind, sizes: Any, lookahead: int | None
) -> None:
    model = untrained(kind, 0.1, sizes(kind))
    if kind == "cvae" and sizes is odd:
        lookahead = None  # it knows nothing ahead anyway
    told = features(FRAMES)
    options: dict[str, Any] = {"smooth": 0.0, "lookahead": lookahead}
    made = model.poses.apply(generate_recording_poses(model, told, 7, **options))
    expected = drawn(model, told, 7, lookahead)
    assert np.abs(expected).max() > 0.1
    assert np.abs(made - expected).max() < 1e-4
