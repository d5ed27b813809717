"""Sounds as though others spoke, elsewhere, into another microphone: a model that learns from few voices is
to follow those of its users.

All is done to the mels alone, and to a crop as a whole.
"""

from __future__ import annotations

from math import log

import torch
from torch import Tensor

from metagraph.generation.features import FLOOR, MELS

HIGHER = 2.0  # mels: how far a voice is moved at most, about a fifth of its frequencies
UNEVEN = 1.0  # nats: deviation of each of the SHAPES of a voice's and a microphone's curve, tilt and all
SHAPES = 5
ALIKE = 0.5  # share of crops whose sounds differ less, up to not at all but in loudness
GATED = 0.2  # share of crops in which what is soft is silence
GATE = (4.0, 9.0)  # nats below what is loudest
NOISE = (1.0, 8.0)  # nats that noise is below what is loudest: 4 to 35 dB
NOISY, BANDED, ROOMY = 0.35, 0.15, 0.25  # shares of crops
TAIL = 8  # frames of a room's
DECAY = (0.1, 0.5)  # of its power a frame: it takes 0.25 to 0.8 s to fall by 60 dB
WET = 0.6  # of the sound's power, at most


def vary_voices(mels: Tensor, chance: torch.Generator) -> Tensor:
    """Return mels `[B, T, 27]`, natural logarithms of power, each crop as if others spoke elsewhere."""
    count = len(mels)

    def drawn(low: float, high: float) -> Tensor:
        return low + (high - low) * torch.rand(count, 1, 1, generator=chance)

    def some(share: float) -> Tensor:
        return torch.rand(count, 1, 1, generator=chance) < share

    silence = log(FLOOR)
    mels = _moved(mels, drawn(-HIGHER, HIGHER))
    alike = some(ALIKE)[:, 0, 0]
    mels[alike] = torch.lerp(mels[alike], _loudness_alone(mels[alike]), drawn(0, 1)[alike])
    mels = mels + _curves(count, UNEVEN, chance)
    roomy, wet, decay = some(ROOMY)[:, 0, 0], drawn(0, WET), drawn(*DECAY)
    power = mels[roomy].exp()
    mels[roomy] = (power + wet[roomy] * _tails(power, decay[roomy])).log()
    loudest = mels.amax((1, 2), keepdim=True)
    gate = some(GATED) & (mels.amax(2, keepdim=True) < loudest - drawn(*GATE))
    mels = torch.where(gate, silence, mels)
    floor = loudest - drawn(*NOISE) + _curves(count, UNEVEN, chance)
    noisy = some(NOISY)[:, 0, 0]
    mels[noisy] = torch.logaddexp(mels[noisy], floor[noisy])
    at = torch.arange(MELS)
    through = (at >= drawn(0, 5)) & (at <= drawn(16, MELS))
    mels = torch.where(some(BANDED) & ~through, silence, mels)
    return mels.clamp(min=silence)


def _curves(count: int, deviation: float, chance: torch.Generator) -> Tensor:
    """Return smooth curves over the mels `[B, 1, 27]`: SHAPES cosines, the later the less."""
    at = (torch.arange(MELS) + 0.5) / MELS
    order = torch.arange(SHAPES)[:, None]
    shapes = torch.cos(torch.pi * order * at) / (1 + order / 2)
    return ((deviation * torch.randn(count, SHAPES, generator=chance)) @ shapes)[:, None]


def _loudness_alone(mels: Tensor) -> Tensor:
    """Return sounds that differ in loudness alone: the spectrum of each frame is the mean one of its crop's
    louder half.
    """
    loud = mels.logsumexp(2, keepdim=True)
    heard = (loud >= loud.median(1, keepdim=True).values).to(mels.dtype)
    mean = (mels * heard).sum(1, keepdim=True) / heard.sum(1, keepdim=True)
    return mean - mean.logsumexp(2, keepdim=True) + loud


def _moved(mels: Tensor, far: Tensor) -> Tensor:
    """Return mels `[B, T, 27]` moved up by `far [B, 1, 1]` of them; at the edge they repeat."""
    at = (torch.arange(MELS) - far).clamp(0, MELS - 1)
    low = at.floor()
    part, first = at - low, low.long().expand(mels.shape)
    second = (first + 1).clamp(max=MELS - 1)
    return mels.gather(2, first) * (1 - part) + mels.gather(2, second) * part


def _tails(power: Tensor, decay: Tensor) -> Tensor:
    """Return what is left of the frames before, `[B, T, 27]`."""
    out = torch.zeros_like(power)
    for age in range(1, min(TAIL, power.shape[1] - 1) + 1):
        out[:, age:] += decay**age * power[:, :-age]
    return out
