"""One step after the other: a net, its running mean, the optimiser and its rate; all of it to be kept."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np
import torch

from metagraph.generation.initial import make_initial_weights
from metagraph.generation.networks import MatchingSizes, Weights, list_weight_shapes
from metagraph.generation.takes import Take, measure_scales
from metagraph.generation.train_plan import TrainingPlan
from metagraph.generation.training.checkpoint import Arrays
from metagraph.generation.training.data import TrainingCorpus, count_edge_frames
from metagraph.generation.training.losses import choose_objective
from metagraph.generation.training.nets import make_net, read_net_weights

CALMEST = 0.1  # of the rate is left at the end of a training that calms down
FUTILE = 50  # steps in a row without a finite gradient


class TrainingError(RuntimeError):
    """A training that cannot go on; the message says why, and what would help."""


class Learner:
    """A training in memory. Raises ValueError for sizes, settings or takes that do not fit together."""

    def __init__(self, plan: TrainingPlan, takes: Sequence[Take]) -> None:
        self.plan, self.step = plan, 0
        sizes = plan.sizes
        audio = sizes.audio if isinstance(sizes, MatchingSizes) else sizes.control.audio
        self.poses, self.audio = measure_scales(takes, audio)
        self.corpus = TrainingCorpus(takes, self.poses, self.audio, *count_edge_frames(plan.sizes))
        self.chance = torch.Generator().manual_seed(plan.seed)
        torch.manual_seed(plan.seed)
        self.objective = choose_objective(
            make_net(plan.sizes, make_initial_weights(plan.sizes, plan.seed)), plan.settings
        )
        self.named = dict(self.objective.named_parameters())
        self.mean = {n: p.detach().clone() for n, p in self.named.items()}
        momentum = 0.99 if plan.kind == "matching" else 0.999  # of the squares: matching's noise is larger
        self.optimiser = torch.optim.Adam(self.named.values(), lr=plan.settings.rate, betas=(0.9, momentum))
        self._bad = 0
        self._begun = False

    def begin(self) -> None:
        """Compute what is computed of the data, for a training that begins."""
        self.objective.begin(self.corpus, self.chance)
        self.mean = {n: p.detach().clone() for n, p in self.named.items()}
        self._begun = True

    def rate(self, share: float) -> float:
        """Return the next step's rate by Noam's decay. share: of the training that is over, 0..1."""
        s, n = self.plan.settings, self.step + 1
        rate = max(s.least if n > s.warm else 0.0, s.rate * min(n / s.warm, (s.warm / n) ** 0.5))
        left = min(1.0, max(0.0, 1 - share) / s.calm) if s.calm else 1.0
        return float(rate) * (CALMEST + (1 - CALMEST) * left)

    def advance(self, share: float = 0.0) -> dict[str, float]:
        """Learn from one batch; return numbers to show. Raises TrainingError if nothing is finite."""
        if not self._begun:
            self.begin()
        rate = self.rate(share)
        for group in self.optimiser.param_groups:
            group["lr"] = rate
        loss, told = self.objective.loss(self.corpus, self.chance)
        self.optimiser.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        size = torch.nn.utils.clip_grad_norm_(self.named.values(), self.plan.settings.clip or inf)
        self.step += 1
        if not bool(torch.isfinite(size)):  # a step that would spoil all weights is left out
            self._bad += 1
            if self._bad >= FUTILE:
                raise TrainingError(
                    f"{FUTILE} steps in a row led nowhere: the gradient is no number. Train with a lower rate"
                )
            return {"rate": rate}
        self._bad = 0
        self.optimiser.step()
        kept = min(self.plan.settings.kept, (1 + self.step) / (10 + self.step))
        with torch.no_grad():
            for n, p in self.named.items():
                self.mean[n].lerp_(p, 1 - kept)
        return {**told, "rate": rate}

    def weights(self) -> Weights:
        """Return the weights to use: their running mean."""
        out = read_net_weights(self.objective.net)
        for name, value in self.mean.items():
            inner = name.removeprefix("net.")
            if name != inner and inner in out:
                out[inner] = value.numpy().astype(np.float32, copy=True)
        return out

    def state(self) -> Arrays:
        """Return everything that is needed to go on to the bit."""
        out: Arrays = {f"net.{n}": w.numpy().copy() for n, w in self.objective.state_dict().items()}
        out |= {f"mean.{n}": w.numpy().copy() for n, w in self.mean.items()}
        for n, p in self.named.items():
            if kept := self.optimiser.state.get(p):
                out[f"first.{n}"] = kept["exp_avg"].numpy().copy()
                out[f"second.{n}"] = kept["exp_avg_sq"].numpy().copy()
                out[f"taken.{n}"] = np.array(float(kept["step"]))
        out["chance"] = self.chance.get_state().numpy().copy()
        out["chance.all"] = torch.get_rng_state().numpy().copy()
        return out

    def restore(self, step: int, arrays: Arrays) -> None:
        """Go on from `state`. Raises ValueError for one of another net."""
        expected = set(self.objective.state_dict())
        given = {n.removeprefix("net.") for n in arrays if n.startswith("net.")}
        if expected != given or {f"mean.{n}" for n in self.named} - set(arrays):
            raise ValueError("the checkpoint is one of another net")
        try:
            self.objective.load_state_dict({n: torch.from_numpy(arrays[f"net.{n}"].copy()) for n in expected})
        except RuntimeError as error:
            raise ValueError(f"the checkpoint is one of another net ({error})") from None
        for n, p in self.named.items():
            self.mean[n] = torch.from_numpy(arrays[f"mean.{n}"].copy())
            if f"first.{n}" in arrays:
                self.optimiser.state[p] = {
                    "step": torch.tensor(float(arrays[f"taken.{n}"])),
                    "exp_avg": torch.from_numpy(arrays[f"first.{n}"].copy()),
                    "exp_avg_sq": torch.from_numpy(arrays[f"second.{n}"].copy()),
                }
        self.chance.set_state(torch.from_numpy(arrays["chance"].copy()))
        torch.set_rng_state(torch.from_numpy(arrays["chance.all"].copy()))
        self.objective.resume(self.corpus)
        self.step, self._begun = step, True


def check_weights(plan: TrainingPlan, weights: Weights) -> None:
    """Raise TrainingError where a weight is no number, or is missing."""
    expected = list_weight_shapes(plan.sizes)
    odd = [n for n in expected if n not in weights or not np.isfinite(weights[n]).all()]
    if odd:
        raise TrainingError(f"the training led to weights that are no numbers ('{odd[0]}'): lower its rate")
