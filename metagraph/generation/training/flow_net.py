"""Torch's twins of the encoder, the autoencoder, the flow and the CVAE (`networks` has the formulas)."""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn import functional

from metagraph.generation.flow import LEAST
from metagraph.generation.networks import ACTIVITY, Control, CvaeSizes, FlowSizes

States = list[tuple[Tensor, Tensor]]


def append_lookahead(features: Tensor, share: Tensor) -> Tensor:
    """Return frames `[N, T, inputs + 1]` with the look-ahead `[N]`, 0..1, as one input more."""
    return torch.cat([features, share[:, None, None].expand(-1, features.shape[1], 1)], -1)


def mask_features(features: Tensor, last: Tensor) -> Tensor:
    """Return frames `[N, T, inputs]` with those after number `last [N]` at 0."""
    known = torch.arange(features.shape[1])[None] <= last[:, None]
    return features * known[:, :, None]


def mask_sound(features: Tensor, deaf: Tensor) -> Tensor:
    """Return frames `[N, T, inputs]` with audio at 0 for those who see who speaks and hear nothing. deaf:
    `[N]`.
    """
    audio = features[..., :-ACTIVITY] * ~deaf[:, None, None]
    return torch.cat([audio, features[..., -ACTIVITY:]], -1)


class NetConvolutions(nn.Module):
    """Convolutions over time. padded: the result is as long as what goes in, zeros around it. They are
    products of neighbours in a row, which a single processor computes faster than torch's own convolutions.
    """

    def __init__(self, inputs: int, width: int, dilations: tuple[int, ...], padded: bool) -> None:
        super().__init__()
        self.input = nn.Conv1d(inputs, width, 1)
        self.blocks = nn.ModuleList(
            nn.Conv1d(width, width, 3, dilation=d, padding=d if padded else 0) for d in dilations
        )
        self.dilations, self.padded = dilations, padded

    def forward(self, frames: Tensor) -> Tensor:
        """Return `[N, T', width]` of `[N, T, inputs]`."""
        x = functional.relu(functional.linear(frames, self.input.weight[:, :, 0], self.input.bias))
        for block, d in zip(self.blocks, self.dilations, strict=True):
            wide = functional.pad(x, (0, 0, d, d)) if self.padded else x
            near = torch.cat([wide[:, : -2 * d], wide[:, d:-d], wide[:, 2 * d :]], -1)
            told = functional.linear(near, block.weight.transpose(1, 2).flatten(1), block.bias)
            x = wide[:, d:-d] + functional.relu(told)
        return x


class ControlNet(nn.Module):
    """What a network hears, and the poses before: `.control` and `.past` are beside each other, as named."""

    control: NetConvolutions
    past: nn.Sequential

    def hears(self, control: Control, pose: int) -> None:
        """Make the layers."""
        self.how = control
        if control.kind == "encoder":
            self.control = NetConvolutions(control.inputs + 1, control.width, control.dilations, False)
            if control.past:
                inner = nn.Linear(control.past * pose, control.width)
                self.past = nn.Sequential(inner, nn.ReLU(), nn.Linear(control.width, control.width))

    def heard(self, frames: Tensor, lookahead: Tensor | None = None, span: int = 1) -> Tensor:
        """Return what is heard of every `span`th frame `[N, T // span, width]` (or its window, flat). frames:
        `[N, before + T + ahead, inputs]`. lookahead: `[N]`, the same for all frames of a stretch; None: all
        is known, and neighbours share their convolutions.
        """
        how = self.how
        if how.kind == "encoder" and lookahead is None:
            return self.control(append_lookahead(frames, torch.ones(len(frames))))[:, ::span]
        each = frames.unfold(1, how.frames, span).transpose(2, 3)  # [N, T // span, frames, inputs]
        count, length = each.shape[:2]
        flat = each.reshape(count * length, how.frames, how.inputs)
        if lookahead is not None:
            every = lookahead.repeat_interleave(length)
            flat = mask_features(flat, how.before + every)
        if how.kind == "window":
            return flat.reshape(count, length, -1)
        share = every / how.ahead if how.ahead else torch.ones(len(flat))
        return self.control(append_lookahead(flat, share)).reshape(count, length, -1)

    def context(self, heard: Tensor, past: Tensor) -> Tensor:
        """Return what enters the network. past: `[..., past, X]`."""
        if not self.how.past:
            return heard
        flat = past.flatten(-2)
        return torch.cat([flat if self.how.kind == "window" else self.past(flat), heard], -1)


class ActNorm(nn.Module):
    def __init__(self, dims: int) -> None:
        super().__init__()
        self.bias, self.logs = nn.Parameter(torch.zeros(dims)), nn.Parameter(torch.zeros(dims))


class Invertible(nn.Module):
    """W = P L (U + diag(s))."""

    p: Tensor
    sign: Tensor

    def __init__(self, dims: int) -> None:
        super().__init__()
        self.register_buffer("p", torch.eye(dims))
        self.register_buffer("sign", torch.ones(dims))
        self.lower, self.upper = nn.Parameter(torch.zeros(dims, dims)), nn.Parameter(torch.zeros(dims, dims))
        self.log_s = nn.Parameter(torch.zeros(dims))

    def matrix(self) -> Tensor:
        left = torch.tril(self.lower, -1) + torch.eye(len(self.p))
        right = torch.triu(self.upper, 1) + torch.diag(self.sign * torch.exp(self.log_s))
        return self.p @ left @ right


class FlowStep(nn.Module):
    """One step of the flow."""

    def __init__(self, sizes: FlowSizes) -> None:
        super().__init__()
        self.first = sizes.dims // 2
        self.actnorm, self.linear = ActNorm(sizes.dims), Invertible(sizes.dims)
        heard = self.first + sizes.control.context(sizes.told)
        self.lstm = nn.LSTM(heard, sizes.units, sizes.layers, batch_first=True)
        self.out = nn.Linear(sizes.units, 2 * (sizes.dims - self.first))

    def coupling(
        self, a: Tensor, context: Tensor, state: tuple[Tensor, Tensor] | None
    ) -> tuple[Tensor, Tensor, tuple[Tensor, Tensor]]:
        hidden, after = self.lstm(torch.cat([a, context], -1), state)
        shift, scale = self.out(hidden).chunk(2, -1)
        return shift, torch.sigmoid(scale + 2) + LEAST, after


class FlowSteps(nn.Module):
    def __init__(self, sizes: FlowSizes) -> None:
        super().__init__()
        self.first = sizes.dims // 2
        self.steps = nn.ModuleList(FlowStep(sizes) for _ in range(sizes.steps))

    def _each(self) -> list[FlowStep]:
        return [step for step in self.steps if isinstance(step, FlowStep)]

    def forward(self, codes: Tensor, context: Tensor, begin: bool = False) -> tuple[Tensor, Tensor]:
        """Return noise `[N, T, D]` and the logarithm of the determinant `[N, T]`. begin: set actnorm so that
        what it gives has mean 0 and deviation 1.
        """
        z, total = codes, torch.zeros(codes.shape[:2], dtype=codes.dtype)
        for step in self._each():
            norm = step.actnorm
            if begin:
                with torch.no_grad():
                    norm.bias.copy_(-z.mean((0, 1)))
                    norm.logs.copy_(-torch.log(z.std((0, 1)) + 1e-6))
            z = (z + norm.bias) * torch.exp(norm.logs)
            z = z @ step.linear.matrix().T
            a, b = z[..., : self.first], z[..., self.first :]
            shift, scale, _ = step.coupling(a, context, None)
            z = torch.cat([a, (b + shift) * scale], -1)
            total = total + norm.logs.sum() + step.linear.log_s.sum() + torch.log(scale).sum(-1)
        return z, total

    def inverse(self, noise: Tensor, context: Tensor, states: States | None = None) -> tuple[Tensor, States]:
        """Return codes `[N, T, D]` and the states after them. states: None at a sequence's start."""
        z = noise
        after: States = []
        for k in reversed(range(len(self.steps))):
            step = self._each()[k]
            a = z[..., : self.first]
            shift, scale, state = step.coupling(a, context, None if states is None else states[k])
            z = torch.cat([a, z[..., self.first :] / scale - shift], -1)
            z = torch.linalg.solve(step.linear.matrix(), z.flatten(0, 1).T).T.reshape(z.shape)
            z = z * torch.exp(-step.actnorm.logs) - step.actnorm.bias
            after.insert(0, state)
        return z, after


class Code(nn.Module):
    """What is computed of the data: `mean`, `deviation`, and of principal components the `basis`."""

    mean: Tensor
    deviation: Tensor
    basis: Tensor

    def __init__(self, dims: int, whole: int | None) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(dims if whole is None else whole))
        if whole is not None:
            self.register_buffer("basis", torch.eye(dims, whole))
        self.register_buffer("deviation", torch.ones(dims))


class GuessNet(nn.Module):
    """What comes next by a linear guess: computed of the data, never learned."""

    weight: Tensor
    bias: Tensor
    spread: Tensor

    def __init__(self, dims: int, past: int, knots: int = 0) -> None:
        super().__init__()
        self.register_buffer("weight", torch.zeros(dims, past * dims))
        self.register_buffer("bias", torch.zeros(dims))
        self.register_buffer("spread", torch.eye(dims))
        if knots:  # of lengths, once it has learned: 0 until then
            self.register_buffer("drawn", torch.zeros(knots))
            self.register_buffer("true", torch.zeros(knots))

    def find_lacked(self, codes: Tensor, past: Tensor) -> Tensor:
        """Return what the guess lacks `[..., D]`. past: `[..., past, D]`."""
        apart = codes - past.flatten(-2) @ self.weight.T - self.bias
        solved = torch.linalg.solve_triangular(torch.tril(self.spread), apart.flatten(0, -2).T, upper=False)
        return solved.T.reshape(apart.shape)

    def complete(self, lacked: Tensor, past: Tensor) -> Tensor:
        """Return the codes `[..., D]` of which `find_lacked` gives what they lack."""
        return past.flatten(-2) @ self.weight.T + self.bias + lacked @ torch.tril(self.spread).T


class FlowNet(ControlNet):
    """The Flow-VAE, and MoGlow."""

    def __init__(self, sizes: FlowSizes) -> None:
        super().__init__()
        self.sizes = sizes
        whole = sizes.pose * sizes.span
        if sizes.code in ("variational", "autoencoder"):
            given = 2 * sizes.dims if sizes.code == "variational" else sizes.dims
            self.encode = nn.Sequential(
                nn.Linear(whole, sizes.between), nn.ReLU(), nn.Linear(sizes.between, given)
            )
            self.decode = nn.Sequential(
                nn.Linear(sizes.dims, sizes.between), nn.ReLU(), nn.Linear(sizes.between, whole)
            )
        if sizes.code != "none":
            self.code = Code(sizes.dims, whole if sizes.code == "pca" else None)
        if sizes.guess:
            self.guess = GuessNet(sizes.dims, sizes.control.past, sizes.knots)
        self.hears(sizes.control, sizes.told)
        self.flow = FlowSteps(sizes)

    def encode_gaussian(self, poses: Tensor) -> tuple[Tensor, Tensor]:
        """Return mean and deviation `[..., D]` of the codes that the encoder gives, before mean and deviation
        of all are taken off. poses: `[..., span X]`.
        """
        mean, spread = self.encode(poses).chunk(2, -1)
        return mean, torch.exp(0.5 * spread.clamp(-20, 4))

    def draw_code(self, poses: Tensor, chance: torch.Generator) -> Tensor:
        """Return codes as `to_code` does, drawn where the encoder is a Gaussian."""
        if self.sizes.code != "variational":
            return self.to_code(poses)
        mean, deviation = self.encode_gaussian(poses)
        return mean + deviation * torch.randn(mean.shape, generator=chance)

    def to_code(self, poses: Tensor) -> Tensor:
        """Return codes as they are before mean and deviation are taken off. poses: `[..., span X]`."""
        if self.sizes.code in ("variational", "autoencoder"):
            return self.encode(poses)[..., : self.sizes.dims]
        if self.sizes.code == "pca":
            return (poses - self.code.mean) @ self.code.basis.T / self.code.deviation
        return poses

    def from_code(self, code: Tensor) -> Tensor:
        """Return poses `[..., span X]` of codes as `to_code` gives them."""
        if self.sizes.code in ("variational", "autoencoder"):
            return self.decode(code)
        if self.sizes.code == "pca":
            return (code * self.code.deviation) @ self.code.basis + self.code.mean
        return code


class CvaeNet(ControlNet):
    """The paper's CVAE."""

    def __init__(self, sizes: CvaeSizes) -> None:
        super().__init__()
        self.sizes = sizes
        self.hears(sizes.control, sizes.pose)
        context = sizes.control.context(sizes.pose)
        self.encoder = nn.LSTM(sizes.pose + context, sizes.units, sizes.layers, batch_first=True)
        self.encoder_out = nn.Linear(sizes.units, 2 * sizes.dims)
        self.decoder = nn.LSTM(sizes.dims + context, sizes.units, sizes.layers, batch_first=True)
        self.decoder_out = nn.Linear(sizes.units, sizes.pose)
        self.drop = nn.Dropout(0.0)

    def encoded(self, poses: Tensor, context: Tensor) -> tuple[Tensor, Tensor]:
        """Return mean and log variance `[N, T, D]`."""
        hidden, _ = self.encoder(torch.cat([poses, context], -1))
        mean, spread = self.encoder_out(self.drop(hidden)).chunk(2, -1)
        return mean, spread

    def decoded(self, codes: Tensor, context: Tensor) -> Tensor:
        """Return poses `[N, T, X]`."""
        hidden, _ = self.decoder(torch.cat([codes, context], -1))
        return self.decoder_out(self.drop(hidden))
