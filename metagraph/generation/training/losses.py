"""What is made small: of the paper's model, of a flow on a finished code, of flow matching, of the CVAE.

Each objective draws its own crops. `loss` returns what is made small and, in words, numbers to show.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import log

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from metagraph.generation import chunks, vae
from metagraph.generation.features import MELS, TOLD
from metagraph.generation.networks import ACTIVITY, Control, CvaeSizes, MatchingSizes, Sizes, Weights
from metagraph.generation.poses import NUMBERS
from metagraph.generation.train_plan import Loss, TrainingSettings
from metagraph.generation.training.autoencoder import set_components, train_autoencoder
from metagraph.generation.training.data import TrainingCorpus, take_stretches
from metagraph.generation.training.flow_net import CvaeNet, FlowNet, mask_sound
from metagraph.generation.training.matching_net import MatchingNet
from metagraph.generation.training.nets import Net, load, read_net_weights

ALPHA = {"paper": 5e-4, "finished": 1.0}  # of the likelihood, in bits
THIRD = {"paper": 1.0, "finished": 0.0}
UNMARKED = 0.6  # share of chunks that do not know all ahead whose marks are not known
SHIFTS = 2  # frames between the beginnings of codes that a guess is made of


def choose_loss(sizes: Sizes) -> Loss:
    """Return the loss that suits a model's sizes."""
    if isinstance(sizes, MatchingSizes):
        return "matching"
    if isinstance(sizes, CvaeSizes):
        return "evidence"
    return "finished"


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


@dataclass(frozen=True, eq=False)
class FlowBatch:
    """What a flow learns from at once. poses: `[B, n, span X]`; codes: what the flow is on, `[B, n, D]`;
    context: `[B, n, C]`; heard: `[B, n, width]`; starts: first frames `[B]`.
    """

    poses: Tensor
    codes: Tensor
    context: Tensor
    heard: Tensor
    starts: Tensor


class FlowObjective(Objective):
    """The Flow-VAE and MoGlow. By the paper's loss all is learned at once; else the code is finished before
    the flow learns it.
    """

    net: FlowNet

    def __init__(self, net: FlowNet, settings: TrainingSettings) -> None:
        sizes = net.sizes
        width = sizes.control.width if sizes.control.kind == "encoder" else sizes.control.context(0)
        super().__init__(net, width, sizes.pose, settings)
        self.sizes = sizes
        self.what: Loss = settings.loss or choose_loss(sizes)
        if self.what not in ALPHA:
            raise ValueError(f"the loss '{self.what}' is not for a flow")
        if sizes.code == "autoencoder":
            raise ValueError("models of earlier versions are used, but learn no more: begin a new training")
        if self.what == "paper" and (sizes.code != "variational" or sizes.guess):
            raise ValueError(f"the paper's loss is for an autoencoder's code, not '{sizes.code}'")
        self.alpha = ALPHA[self.what] if settings.alpha is None else settings.alpha
        self.third = THIRD[self.what] if settings.third is None else settings.third
        self.length = settings.frames
        if self.what == "finished" and sizes.code == "variational":
            for part in (net.encode, net.decode):
                part.requires_grad_(False)

    def begin(self, corpus: TrainingCorpus, chance: torch.Generator) -> None:
        self.resume(corpus)
        if self.what == "finished":
            self._finish_code(corpus, chance)
        with torch.no_grad():
            batch = self._batch(corpus, chance)
            self.net.flow(batch.codes, batch.context, begin=True)

    def _finish_code(self, corpus: TrainingCorpus, chance: torch.Generator) -> None:
        """Make the code from the takes, and the guess of what comes next."""
        net, sizes = self.net, self.sizes
        if sizes.code == "none":
            return
        rows = take_stretches(corpus, sizes.span)
        if sizes.code == "pca":
            load(net, read_net_weights(net) | vae.find_principal_components(rows, sizes.dims, "code"))
        else:
            set_components(net, rows)
            with torch.enable_grad():
                for part in (net.encode, net.decode):
                    part.requires_grad_(True)
                train_autoencoder(net, rows, self.settings.tuned, chance)
                for part in (net.encode, net.decode):
                    part.requires_grad_(False)
            with torch.no_grad():
                codes = net.draw_code(torch.from_numpy(np.asarray(rows, np.float32)), chance)
                net.code.mean.copy_(codes.mean(0))
                net.code.deviation.copy_(codes.std(0) + vae.FLOOR)
        if sizes.guess:
            load(net, read_net_weights(net) | self._fit_guess(corpus, chance))

    def _fit_guess(self, corpus: TrainingCorpus, chance: torch.Generator) -> Weights:
        codes = []
        with torch.no_grad():
            for poses in corpus.each():
                for shift in range(0, self.sizes.span, SHIFTS):
                    rows = torch.from_numpy(vae.list_spans(poses[shift:], self.sizes.span))
                    codes.append(self._standard(self.net.draw_code(rows, chance)).numpy())
        return vae.fit_guess(codes, self.sizes.control.past, self.settings.past_noise)

    def resume(self, corpus: TrainingCorpus) -> None:
        self.length = corpus.longest_crop(self.settings.frames)
        self.length -= self.length % self.sizes.span

    def loss(self, corpus: TrainingCorpus, chance: torch.Generator) -> tuple[Tensor, dict[str, float]]:
        batch = self._batch(corpus, chance)
        z, logs = self.net.flow(batch.codes, batch.context)
        nats = (0.5 * (z * z + log(2 * torch.pi)).sum(-1) - logs).mean()
        out = self.alpha * nats / log(2.0)
        told = {"likelihood": -float(nats.detach())}
        if self.what == "paper":
            again = functional.mse_loss(self.net.from_code(batch.codes), batch.poses)
            told["reconstruction"] = float(again.detach())
            out = out + again
        else:
            out = out / self.sizes.dims
        if self.third and self.what == "paper":
            # The states begin at 0 again: those of the sequence's end would tell the draw what comes.
            noise = torch.randn(batch.codes.shape, generator=chance)
            drawn, _ = self.net.flow.inverse(noise, batch.context)
            out = out + self.third * functional.mse_loss(self.net.from_code(drawn), batch.poses)
        if self.settings.head and self.sizes.control.kind == "encoder":
            speeds = corpus.rows(corpus.speeds, batch.starts, 0, self.length)
            speeds = speeds.unflatten(1, (-1, self.sizes.span)).mean(2)
            head = self.head(batch.heard, speeds)
            out = out + self.settings.head * head
            told["speeds"] = float(head.detach())
        return out, told | {"loss": float(out.detach())}

    def _batch(self, corpus: TrainingCorpus, chance: torch.Generator) -> FlowBatch:
        sizes, settings = self.sizes, self.settings
        control, span, count = sizes.control, sizes.span, settings.batch
        starts, poses, features, ahead = self.crops(corpus, control, chance)
        if sizes.guided:
            deaf = torch.rand(count, generator=chance) < settings.sound_dropped
            features = mask_sound(features, deaf)
        heard = self.net.heard(features, ahead, span)
        poses = poses.reshape(count, -1, span * sizes.pose)
        if sizes.guess:
            before = corpus.rows(corpus.poses, starts, -sizes.before, 0).reshape(count, control.past, -1)
            every = self._standard(self.net.draw_code(torch.cat([before, poses], 1), chance))
            codes = every[:, control.past :]
            every = every + settings.past_noise * torch.randn(every.shape, generator=chance)
            past = every.unfold(1, control.past, 1).transpose(2, 3)[:, :-1]
            codes = self.net.guess.find_lacked(codes, past)
            known = torch.rand((*past.shape[:2], 1, 1), generator=chance) >= settings.past_dropped
            past = past * known  # the guess knows them all the same
        else:
            codes = self._standard(self.net.draw_code(poses, chance))
            if self.what == "finished":
                codes = codes + settings.noise * torch.randn(codes.shape, generator=chance)
            past = torch.zeros(count, self.length // span, 0, 0)
            if control.past:
                rows = corpus.rows(corpus.poses, starts, -control.past, self.length - 1)
                past = rows.unfold(1, control.past, 1).transpose(2, 3)[:, ::span]
                known = torch.rand(past.shape[:3], generator=chance) >= settings.past_dropped
                past = past * known[..., None]
        return FlowBatch(poses, codes, self.net.context(heard, past), heard, starts)

    def _standard(self, code: Tensor) -> Tensor:
        """Return codes as the flow sees them."""
        if self.sizes.code != "variational":
            return code
        return (code - self.net.code.mean) / self.net.code.deviation


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
        parts = vae.find_principal_components(take_stretches(corpus, sizes.frames), sizes.dims, "tokens")
        if sizes.around:
            rows = [poses[n:] for poses in corpus.each() for n in range(sizes.frames)]
            told = (
                (chunks.make_tokens(parts, sizes, r), vae.list_spans(r, sizes.frames) - parts["tokens.mean"])
                for r in rows
            )
            parts["tokens.joined"] = chunks.join_by_least_squares(told, sizes.around)
        load(self.net, read_net_weights(self.net) | parts)
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
        if sizes.audio % MELS:
            unknown = torch.rand(batch, generator=chance) < torch.where(full, s.unmarked, UNMARKED)
            features[unknown, :, -TOLD:-ACTIVITY] = 0
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


def choose_objective(net: Net, settings: TrainingSettings) -> Objective:
    """Return what a net learns by. Raises ValueError for a loss that is not for it."""
    if isinstance(net, FlowNet):
        return FlowObjective(net, settings)
    if settings.loss not in (None, choose_loss(net.sizes)):
        raise ValueError(f"the loss '{settings.loss}' is for a flow")
    if isinstance(net, CvaeNet):
        return CvaeObjective(net, settings)
    return MatchingObjective(net, settings)
