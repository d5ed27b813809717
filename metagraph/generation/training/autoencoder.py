"""The autoencoder of a code that is finished before a flow learns it. It begins as principal components, so
its numbers cannot become copies of each other, and is then tuned by itself as a variational autoencoder: the
paper, too, tunes it without the flow first (section 5).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from metagraph.generation import vae
from metagraph.generation.training.flow_net import FlowNet

Array = NDArray[Any]

NARROW = -6.0  # logarithm of a code's variance to begin with: a deviation of 0.05
EXACT = 0.03  # standardised: deviation of what is decoded, against which a code's divergence weighs
BATCH, RATE = 256, 1e-3


def set_components(net: FlowNet, rows: Array) -> None:
    """Make a net's autoencoder its principal components. Two units of the inner layers, relu(x) and
    relu(-x), carry a component x; what is left keeps its first weights, with nothing coming of it. rows:
    `[N, span X]`. Raises ValueError if there are fewer rows than numbers of a code, or too few units.
    """
    dims, between = net.sizes.dims, net.sizes.between
    if between < 2 * dims:
        raise ValueError(f"{between} units cannot carry {dims} components: it takes {2 * dims}")
    parts = vae.find_principal_components(rows, dims, "code")
    basis = torch.from_numpy(parts["code.basis"] / parts["code.deviation"][:, None])
    back = torch.from_numpy(parts["code.basis"] * parts["code.deviation"][:, None])
    mean = torch.from_numpy(parts["code.mean"])
    both = torch.cat([torch.eye(dims), -torch.eye(dims)])  # [2 D, D]
    (first, _, second), (third, _, last) = net.encode, net.decode
    with torch.no_grad():
        first.weight[: 2 * dims] = both @ basis
        first.bias[: 2 * dims] = -both @ (basis @ mean)
        second.weight.zero_()
        second.weight[:dims, : 2 * dims] = both.T
        second.bias.zero_()
        second.bias[dims:] = NARROW
        third.weight[: 2 * dims] = both
        third.bias[: 2 * dims] = 0
        last.weight.zero_()
        last.weight[:, : 2 * dims] = back.T @ both.T
        last.bias.copy_(mean)


def train_autoencoder(net: FlowNet, rows: Array, steps: int, chance: torch.Generator) -> None:
    """Learn the autoencoder by itself: how wrong draws from its Gaussian are decoded, as by noise of EXACT,
    and how far the Gaussians are from a normal one. rows: `[N, span X]`.
    """
    data = torch.from_numpy(np.asarray(rows, np.float32))
    learned = [*net.encode.parameters(), *net.decode.parameters()]
    optimiser = torch.optim.Adam(learned, lr=RATE)
    for step in range(steps):
        for group in optimiser.param_groups:
            group["lr"] = RATE * min(1.0, 2 * (1 - step / steps))
        some = data[torch.randint(len(data), (BATCH,), generator=chance)]
        loss = compute_evidence_loss(net, some, chance)
        optimiser.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        optimiser.step()


def compute_evidence_loss(net: FlowNet, poses: Tensor, chance: torch.Generator) -> Tensor:
    """Return what is made small: the negative evidence of poses `[N, span X]`, up to a constant, by the
    number of a pose's numbers.
    """
    mean, deviation = net.encode_gaussian(poses)
    code = mean + deviation * torch.randn(mean.shape, generator=chance)
    wrong = ((net.decode(code) - poses) ** 2).mean() / (2 * EXACT**2)
    apart = 0.5 * (mean**2 + deviation**2 - 1 - 2 * torch.log(deviation)).sum(-1).mean()
    return wrong + apart / poses.shape[-1]
