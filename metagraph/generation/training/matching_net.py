"""Torch's twin of the flow matching on tokens (`networks` has the formulas)."""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn import functional

from metagraph.generation.networks import ACTIVITY, MatchingSizes
from metagraph.generation.training.flow_net import (
    Code,
    NetConvolutions,
    append_lookahead,
    mask_features,
    mask_sound,
)


class HearingNet(NetConvolutions):
    """Convolutions over a chunk's frames, and the layer from a token's frames to one place."""

    def __init__(self, sizes: MatchingSizes) -> None:
        super().__init__(sizes.audio + ACTIVITY + 1, sizes.width, sizes.dilations, True)
        self.token = nn.Linear(sizes.frames * sizes.width, sizes.hidden)


class MatchingBlock(nn.Module):
    def __init__(self, sizes: MatchingSizes) -> None:
        super().__init__()
        wide, self.heads = sizes.hidden, sizes.heads
        self.modulation = nn.Linear(sizes.time, 4 * wide)
        self.qkv, self.proj = nn.Linear(wide, 3 * wide), nn.Linear(wide, wide)
        self.mlp = nn.Sequential(
            nn.Linear(wide, sizes.ratio * wide),
            nn.GELU(approximate="tanh"),
            nn.Linear(sizes.ratio * wide, wide),
        )

    def forward(self, x: Tensor, condition: Tensor) -> Tensor:
        s1, b1, s2, b2 = self.modulation(condition)[:, None].chunk(4, -1)
        count, places, wide = x.shape
        parts = self.qkv(functional.layer_norm(x, (wide,)) * (1 + s1) + b1)
        q, k, v = parts.reshape(count, places, 3, self.heads, -1).permute(2, 0, 3, 1, 4)
        mixed = functional.scaled_dot_product_attention(q, k, v)
        x = x + self.proj(mixed.transpose(1, 2).reshape(count, places, wide))
        return x + self.mlp(functional.layer_norm(x, (wide,)) * (1 + s2) + b2)


class Final(nn.Module):
    def __init__(self, sizes: MatchingSizes) -> None:
        super().__init__()
        self.modulation = nn.Linear(sizes.time, 2 * sizes.hidden)
        self.out = nn.Linear(sizes.hidden, sizes.dims)


class MatchingNet(nn.Module):
    def __init__(self, sizes: MatchingSizes) -> None:
        super().__init__()
        self.sizes = sizes
        self.tokens = Code(sizes.dims, sizes.frames * sizes.pose)
        if sizes.around:
            rows = (2 * sizes.around + 1) * sizes.dims
            self.tokens.register_buffer("joined", torch.zeros(rows, sizes.frames * sizes.pose))
        self.control = HearingNet(sizes)
        self.embed_past = nn.Linear(sizes.dims, sizes.hidden)
        self.embed_new = nn.Linear(sizes.dims, sizes.hidden)
        self.place = nn.Parameter(torch.zeros(sizes.tokens, sizes.hidden))
        self.no_past = nn.Parameter(torch.zeros(sizes.hidden))
        self.no_sound = nn.Parameter(torch.zeros(sizes.hidden))
        self.time = nn.Sequential(
            nn.Linear(sizes.time, sizes.time), nn.SiLU(), nn.Linear(sizes.time, sizes.time)
        )
        self.blocks = nn.ModuleList(MatchingBlock(sizes) for _ in range(sizes.layers))
        self.final = Final(sizes)

    def frames(self, features: Tensor, lookahead: Tensor, deaf: Tensor) -> Tensor:
        """Return what is heard of each frame `[N, T, width]`. features: `[N, tokens * frames, inputs]`;
        lookahead: frames after the first new one that are known `[N]`; deaf: `[N]`, who sees who speaks and
        hears nothing.
        """
        sizes = self.sizes
        known = mask_features(mask_sound(features, deaf), sizes.past * sizes.frames + lookahead)
        return self.control(append_lookahead(known, lookahead / sizes.most))

    def heard(self, frames: Tensor, deaf: Tensor) -> Tensor:
        """Return what is heard of each token `[N, tokens, hidden]`. deaf: `[N]`, who hears nothing."""
        told = self.control.token(frames.reshape(len(frames), self.sizes.tokens, -1))
        return told + deaf[:, None, None] * self.no_sound

    def velocity(self, noisy: Tensor, moment: Tensor, past: Tensor, heard: Tensor) -> Tensor:
        """Return the velocity `[N, new, D]` at x_t. moment: t `[N]`. past: `[N, past, hidden]`, embedded;
        heard: `[N, tokens, hidden]`; with `no_past` if there is none.
        """
        sizes = self.sizes
        x = heard + self.place
        after = x.new_zeros(len(x), sizes.ahead, sizes.hidden)
        x = x + torch.cat([past, self.embed_new(noisy), after], 1)
        condition = functional.silu(self.time(_moments(moment, sizes.time)))
        for block in self.blocks:
            x = block(x, condition)
        scale, shift = self.final.modulation(condition)[:, None].chunk(2, -1)
        new = x[:, sizes.past : sizes.past + sizes.new]
        return self.final.out(functional.layer_norm(new, (sizes.hidden,)) * (1 + scale) + shift)


def _moments(moment: Tensor, count: int) -> Tensor:
    half = count // 2
    speed = 1000.0 * 10000.0 ** (-torch.arange(half, dtype=moment.dtype) / half)
    angle = moment[:, None] * speed
    return torch.cat([torch.sin(angle), torch.cos(angle)], -1)
