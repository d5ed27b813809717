"""An autoencoder begins as principal components, and tells more once it is tuned."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="training needs torch, which is not installed")

from metagraph.generation import vae  # noqa: E402
from metagraph.generation.networks import Control, FlowSizes  # noqa: E402
from metagraph.generation.training.autoencoder import (  # noqa: E402
    compute_evidence_loss,
    set_components,
    train_autoencoder,
)
from metagraph.generation.training.nets import make_net  # noqa: E402

SIZES = FlowSizes(pose=12, control=Control(width=4), between=24, dims=4, steps=1, units=4, span=2)


def rows() -> Any:
    """Four numbers, of which 24 others are made, not all in a straight line."""
    chance = np.random.default_rng(1)
    inner = chance.standard_normal((3000, 4))
    made = inner @ chance.standard_normal((4, 24)) + 0.3 * np.abs(inner) @ chance.standard_normal((4, 24))
    return (made / made.std(0)).astype(np.float32)


def test_it_begins_as_principal_components() -> None:
    data, net = rows(), make_net(SIZES)
    set_components(net, data)
    parts = vae.find_principal_components(data, 4, "code")
    pca = FlowSizes(pose=12, code="pca", dims=4, span=2)
    with torch.no_grad():
        code = net.to_code(torch.from_numpy(data))
        back = net.from_code(code).numpy()
    assert np.abs(code.numpy() - vae.encode_spans(parts, pca, data)).max() < 1e-4
    assert np.abs(back - vae.decode_spans(parts, pca, code.numpy())).max() < 1e-4


def test_tuned_it_tells_more_and_keeps_its_dimensions() -> None:
    data, net = rows(), make_net(SIZES)
    set_components(net, data)
    told = torch.from_numpy(data)
    losses = []
    for steps in (0, 300):
        train_autoencoder(net, data, steps, torch.Generator().manual_seed(1))
        with torch.no_grad():
            losses.append(float(compute_evidence_loss(net, told, torch.Generator().manual_seed(2))))
    with torch.no_grad():
        code = net.to_code(told).numpy()
    assert losses[1] < 0.7 * losses[0]
    assert vae.count_effective_dimensions(code) > 3.5


def test_units_that_cannot_carry_the_components_are_told() -> None:
    small = FlowSizes(pose=12, control=Control(width=4), between=7, dims=4, steps=1, units=4, span=2)
    with pytest.raises(ValueError, match="7 units cannot carry 4 components: it takes 8"):
        set_components(make_net(small), rows())
