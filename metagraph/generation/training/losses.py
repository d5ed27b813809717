"""What is made small: of the paper's model, of it without its two faults, of flow matching, of the CVAE.

Each objective draws its own crops. `loss` returns what is made small and, in words, numbers to show.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import log

import torch
from torch import Tensor, nn
from torch.nn import functional

from metagraph.generation import chunks, vae
from metagraph.generation.networks import Control, CvaeSizes, MatchingSizes, Sizes
from metagraph.generation.poses import NUMBERS
from metagraph.generation.train_plan import Loss, TrainingSettings
from metagraph.generation.training.data import TrainingCorpus, take_stretches
from metagraph.generation.training.flow_net import CvaeNet, FlowNet
from metagraph.generation.training.matching_net import MatchingNet
from metagraph.generation.training.nets import Net, load, weights_of

ALPHA = {"paper": 5e-4, "whitened": 5e-3, "finished": 1.0}  # of the likelihood, in bits
THIRD = {"paper": 1.0, "whitened": 0.0, "finished": 0.0}
RUNNING = 0.02  # what a batch adds to the running mean and variance of a code


def choose_loss(sizes: Sizes) -> Loss:
    """Return the loss that suits a model's sizes."""
    if isinstance(sizes, MatchingSizes):
        return "matching"
    if isinstance(sizes, CvaeSizes):
        return "evidence"
    return "whitened" if sizes.code == "autoencoder" else "finished"


class Objective(nn.Module, ABC):
    """A net, with what only training needs: a head that predicts from what is heard how fast the joints turn,
    without which past poses explain away what is heard.
    """

    net: Net

    def __init__(self, net: Net, width: int, pose: int, settings: TrainingSettings) -> None:
        super().__init__()
        self.net, self.settings = net, settings
        self.speeds = nn.Linear(width, pose // NUMBERS)

    @abstractmethod
    def begin(self, corpus: TrainingCorpus, chance: torch.Generator) -> None:
        """Compute what is computed of the data."""

    def resume(self, corpus: TrainingCorpus) -> None:
        """Compute what is not kept, once weights are as they were."""

    @abstractmethod
    def loss(self, corpus: TrainingCorpus, chance: torch.Generator) -> tuple[Tensor, dict[str, float]]:
        """Return what is made small of one batch, and numbers to show."""

    def head(self, heard: Tensor, speeds: Tensor) -> Tensor:
        """Return how badly speeds are predicted."""
        return functional.mse_loss(self.speeds(heard), speeds)

    def crops(
        self, corpus: TrainingCorpus, control: Control, chance: torch.Generator
    ) -> tuple[Tensor, Tensor, Tensor, Tensor | None]:
        """Return starts `[B]` of crops, their poses `[B, T, X]`, what a control hears of them `[B, before + T
        + ahead, inputs]`, and how far ahead each knows `[B]`; None: all do as far as they can.
        """
        batch = self.settings.batch
        starts = corpus.starts(chance, batch, self.length, self.settings.turns)
        poses = corpus.rows(corpus.poses, starts, 0, self.length)
        last = self.length + control.ahead
        features = corpus.hear(starts, -control.before, last, self.settings.voices, chance)
        ahead: Tensor | None = None
        if control.ahead and float(torch.rand(1, generator=chance)) >= self.settings.known:
            ahead = torch.randint(control.ahead + 1, (batch,), generator=chance)
        return starts, poses, features, ahead

    @property
    def frames(self) -> int:
        """Frames that one batch learns from."""
        return self.settings.batch * self.length

    length: int


class FlowObjective(Objective):
    """The Flow-VAE and MoGlow. what: which loss."""

    net: FlowNet

    def __init__(self, net: FlowNet, settings: TrainingSettings) -> None:
        sizes = net.sizes
        width = sizes.control.width if sizes.control.kind == "encoder" else sizes.control.context(0)
        super().__init__(net, width, sizes.pose, settings)
        self.sizes = sizes
        self.what: Loss = settings.loss or choose_loss(sizes)
        if self.what not in ALPHA or (self.what == "finished") != (sizes.code != "autoencoder"):
            raise ValueError(f"the loss '{self.what}' is not for a flow on code '{sizes.code}'")
        self.alpha = ALPHA[self.what] if settings.alpha is None else settings.alpha
        self.third = THIRD[self.what] if settings.third is None else settings.third
        self.length = settings.frames
        self.deviation = 1.0  # of the code before it is whitened, to be watched

    def begin(self, corpus: TrainingCorpus, chance: torch.Generator) -> None:
        self.resume(corpus)
        if self.sizes.code == "pca":
            parts = vae.principal(take_stretches(corpus, self.sizes.span), self.sizes.dims, "code")
            load(self.net, weights_of(self.net) | parts)
        with torch.no_grad():
            poses, context, _, _ = self._batch(corpus, chance)
            code = self.net.to_code(poses)
            if self.what == "whitened":
                self.net.code.mean.copy_(code.mean((0, 1)))
                self.net.code.deviation.copy_(code.std((0, 1)) + 1e-6)
            self.net.flow(self._whitened(code), context, begin=True)

    def resume(self, corpus: TrainingCorpus) -> None:
        self.length = corpus.longest_crop(self.settings.frames)
        self.length -= self.length % self.sizes.span

    def loss(self, corpus: TrainingCorpus, chance: torch.Generator) -> tuple[Tensor, dict[str, float]]:
        poses, context, heard, starts = self._batch(corpus, chance)
        code = self.net.to_code(poses)
        self.deviation = float(code.detach().std((0, 1)).mean())
        clean = code
        if self.what == "whitened":
            code = self._renormed(code)
            clean = code = code + self.settings.noise * torch.randn(code.shape, generator=chance)
        elif self.what == "finished":
            code = code + self.settings.noise * torch.randn(code.shape, generator=chance)
        z, logs = self.net.flow(code, context)
        nats = (0.5 * (z * z + log(2 * torch.pi)).sum(-1) - logs).mean()
        bits = nats / log(2.0)
        out = self.alpha * bits
        told = {"likelihood": -float(nats.detach())}
        if self.what != "finished":
            again = functional.mse_loss(self.net.from_code(self._coloured(clean)), poses)
            told |= {"reconstruction": float(again.detach()), "deviation": self.deviation}
            out = out + again
        else:
            out = out / code.shape[-1]
        if self.third:
            # The states begin at 0 again: those of the sequence's end would tell the draw what comes.
            drawn, _ = self.net.flow.inverse(torch.randn(code.shape, generator=chance), context)
            out = out + self.third * functional.mse_loss(self.net.from_code(self._coloured(drawn)), poses)
        if self.settings.head and self.sizes.control.kind == "encoder":
            head = self.head(heard, corpus.rows(corpus.speeds, starts, 0, self.length)[:, :: self.sizes.span])
            out = out + self.settings.head * head * (1.0 if self.what == "finished" else 0.1)
            told["speeds"] = float(head.detach())
        return out, told | {"loss": float(out.detach())}

    def _batch(
        self, corpus: TrainingCorpus, chance: torch.Generator
    ) -> tuple[Tensor, Tensor, Tensor, Tensor]:
        """Return spans of poses `[B, n, span X]`, the context `[B, n, C]`, what is heard, and the starts."""
        control, span, batch = self.sizes.control, self.sizes.span, self.settings.batch
        starts, poses, features, ahead = self.crops(corpus, control, chance)
        heard = self.net.heard(features, ahead, span)
        past = torch.zeros(batch, self.length // span, 0, 0)
        if control.past:
            rows = corpus.rows(corpus.poses, starts, -control.past, self.length - 1)
            past = rows.unfold(1, control.past, 1).transpose(2, 3)[:, ::span]
            told = torch.rand(past.shape[:3], generator=chance) >= self.settings.past_dropped
            past = past * told[..., None]
        return poses.reshape(batch, -1, span * self.sizes.pose), self.net.context(heard, past), heard, starts

    def _renormed(self, code: Tensor) -> Tensor:
        """Return a code by its batch's mean and variance, and keep the running ones."""
        mean, spread = code.mean((0, 1)), code.std((0, 1)) + 1e-6
        self._now = mean, spread
        with torch.no_grad():
            kept = self.net.code
            kept.mean.lerp_(mean, RUNNING)
            kept.deviation.lerp_(spread, RUNNING)
        return (code - mean) / spread

    def _whitened(self, code: Tensor) -> Tensor:
        if self.what != "whitened":
            return code
        return (code - self.net.code.mean) / self.net.code.deviation

    def _coloured(self, code: Tensor) -> Tensor:
        return code * self._now[1] + self._now[0] if self.what == "whitened" else code


class CvaeObjective(Objective):
    """The CVAE: reconstruction, and how far codes are from normal ones, by the poses' numbers."""

    net: CvaeNet

    def __init__(self, net: CvaeNet, settings: TrainingSettings) -> None:
        sizes = net.sizes
        width = sizes.control.width if sizes.control.kind == "encoder" else sizes.control.context(0)
        super().__init__(net, width, sizes.pose, settings)
        self.sizes = sizes
        self.length = settings.frames
        net.drop.p = 0.2

    def begin(self, corpus: TrainingCorpus, chance: torch.Generator) -> None:
        self.resume(corpus)

    def resume(self, corpus: TrainingCorpus) -> None:
        self.length = corpus.longest_crop(self.settings.frames)

    def loss(self, corpus: TrainingCorpus, chance: torch.Generator) -> tuple[Tensor, dict[str, float]]:
        _, poses, features, ahead = self.crops(corpus, self.sizes.control, chance)
        heard = self.net.heard(features, ahead)
        mean, spread = self.net.encoded(poses, heard)
        spread = spread.clamp(-12, 12)
        code = mean + torch.exp(0.5 * spread) * torch.randn(mean.shape, generator=chance)
        again = functional.mse_loss(self.net.decoded(code, heard), poses)
        apart = 0.5 * (mean**2 + spread.exp() - 1 - spread).sum(-1).mean() / self.sizes.pose
        out = again + apart
        told = {"reconstruction": float(again.detach()), "divergence": float(apart.detach())}
        return out, told | {"loss": float(out.detach())}


class MatchingObjective(Objective):
    """Flow matching on tokens."""

    net: MatchingNet

    def __init__(self, net: MatchingNet, settings: TrainingSettings) -> None:
        super().__init__(net, net.sizes.width, net.sizes.pose, settings)
        self.sizes = net.sizes
        self.length = net.sizes.new * net.sizes.frames

    def begin(self, corpus: TrainingCorpus, chance: torch.Generator) -> None:
        sizes = self.sizes
        parts = vae.principal(take_stretches(corpus, sizes.frames), sizes.dims, "tokens")
        if sizes.around:
            rows = [poses[n:] for poses in corpus.each() for n in range(sizes.frames)]
            told = (
                (chunks.make_tokens(parts, sizes, r), vae.list_spans(r, sizes.frames) - parts["tokens.mean"])
                for r in rows
            )
            parts["tokens.joined"] = chunks.join_by_least_squares(told, sizes.around)
        load(self.net, weights_of(self.net) | parts)
        self.resume(corpus)

    def resume(self, corpus: TrainingCorpus) -> None:
        # Every frame's token once, and what components weigh.
        sizes, kept = self.sizes, self.net.tokens
        rows = corpus.poses.unfold(0, sizes.frames, 1).transpose(1, 2)
        with torch.no_grad():
            self._tokens = torch.cat(
                [
                    (part.flatten(1) - kept.mean) @ kept.basis.T / kept.deviation
                    for part in torch.split(rows, 8192)
                ]
            )
            weight = torch.sqrt(kept.deviation)
            self._weight = weight / weight.mean()

    def loss(self, corpus: TrainingCorpus, chance: torch.Generator) -> tuple[Tensor, dict[str, float]]:
        sizes, s, batch, net = self.sizes, self.settings, self.settings.batch, self.net
        frames = sizes.frames
        starts = corpus.starts(chance, batch, self.length, s.turns)
        places = torch.arange(-sizes.past, sizes.new) * frames
        tokens = self._tokens[starts[:, None] + places]
        past, new = tokens[:, : sizes.past], tokens[:, sizes.past :]
        first, last = -sizes.past * frames, (sizes.new + sizes.ahead) * frames
        features = corpus.hear(starts, first, last, s.voices, chance)
        ahead = torch.randint(sizes.most + 1, (batch,), generator=chance)
        full = torch.rand(batch, generator=chance) < s.known
        deaf = torch.rand(batch, generator=chance) < s.sound_dropped
        told = net.frames(features, torch.where(full, sizes.most, ahead), deaf)
        heard = net.heard(told, deaf)
        past = net.embed_past(past + s.past_noise * torch.randn(past.shape, generator=chance))
        alone = torch.rand(batch, generator=chance) < s.past_dropped
        past = torch.where(alone[:, None, None], net.no_past, past)
        t = torch.sigmoid(s.spread * torch.randn(batch, generator=chance) - s.early)
        x0 = torch.randn(new.shape, generator=chance)
        noisy = (1 - t)[:, None, None] * x0 + t[:, None, None] * new
        v = net.velocity(noisy, t, past, heard)
        out = (((v - (new - x0)) ** 2) * self._weight).mean()
        shown = {"matching": float(out.detach())}
        if s.head:
            # The frames that are heard and known alone: of the others little can be told.
            inner = slice(sizes.past * frames, (sizes.past + sizes.new) * frames)
            speeds = corpus.rows(corpus.speeds, starts, 0, self.length)
            known = full[:, None] | (torch.arange(self.length)[None] <= ahead[:, None])
            head = ((self.speeds(told[:, inner]) - speeds) ** 2).mean(-1)
            known &= ~deaf[:, None]
            head = (head * known).sum() / known.sum().clamp(min=1)
            out = out + s.head * head
            shown["speeds"] = float(head.detach())
        return out, shown | {"loss": float(out.detach())}


def objective_of(net: Net, settings: TrainingSettings) -> Objective:
    """Return what a net learns by. Raises ValueError for a loss that is not for it."""
    if isinstance(net, FlowNet):
        return FlowObjective(net, settings)
    if settings.loss not in (None, choose_loss(net.sizes)):
        raise ValueError(f"the loss '{settings.loss}' is for a flow")
    if isinstance(net, CvaeNet):
        return CvaeObjective(net, settings)
    return MatchingObjective(net, settings)
