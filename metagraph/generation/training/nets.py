"""Torch's nets of a model's sizes, and their weights from and to arrays."""

from __future__ import annotations

import numpy as np
import torch
from torch import nn

from metagraph.generation.networks import CvaeSizes, FlowSizes, Sizes, Weights, list_weight_shapes
from metagraph.generation.training.flow_net import CvaeNet, FlowNet
from metagraph.generation.training.matching_net import MatchingNet

Net = FlowNet | CvaeNet | MatchingNet


def make_net(sizes: Sizes, weights: Weights | None = None) -> Net:
    """Return a net. weights: what it begins with, as `networks.list_weight_shapes` names them."""
    out: Net
    if isinstance(sizes, FlowSizes):
        out = FlowNet(sizes)
    elif isinstance(sizes, CvaeSizes):
        out = CvaeNet(sizes)
    else:
        out = MatchingNet(sizes)
    if weights is not None:
        load(out, weights)
    return out


def load(net: nn.Module, weights: Weights) -> None:
    """Give a net its weights. Raises RuntimeError if names or shapes are others."""
    net.load_state_dict({n: torch.from_numpy(np.array(w, np.float32)) for n, w in weights.items()})


def read_net_weights(net: Net) -> Weights:
    """Return a net's weights, float32, in `list_weight_shapes`'s order."""
    state = net.state_dict()
    return {
        n: state[n].detach().cpu().numpy().astype(np.float32, copy=True)
        for n in list_weight_shapes(net.sizes)
    }
