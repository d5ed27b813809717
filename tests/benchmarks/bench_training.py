"""Training: python tests/benchmarks/bench_training.py [steps]

How many frames a second of one processor models learn from, beside a straightforward way: each frame's window
of audio and activity encoded by itself, without sharing convolutions with its neighbours.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

import msgspec  # noqa: E402
import torch  # noqa: E402

from metagraph.generation.networks import count_parameters, make_sizes  # noqa: E402
from metagraph.generation.train_plan import TrainingSettings  # noqa: E402
from metagraph.generation.training.flow_net import ControlNet  # noqa: E402
from metagraph.generation.training.learner import Learner  # noqa: E402
from tests.generation.training.planting import plan, take  # noqa: E402

SYSTEMS: tuple[tuple[Any, bool, float], ...] = (
    ("flow-vae", False, 1.0),
    ("flow-vae", False, 0.7),
    ("flow-vae", True, 1.0),
    ("cvae", False, 1.0),
    ("cvae", True, 1.0),
    ("moglow", False, 1.0),
    ("matching", False, 0.7),
)


def main(steps: int) -> None:
    torch.set_num_threads(1)
    takes = take(40.0, 1), take(40.0, 2)
    shared = ControlNet.heard

    def alone(self: Any, frames: Any, lookahead: Any = None, span: int = 1) -> Any:
        every = torch.full((len(frames),), self.how.ahead) if lookahead is None else lookahead
        return shared(self, frames, every, span)

    for kind, each, known in SYSTEMS:
        ControlNet.heard = alone if each else shared  # type: ignore[method-assign]
        settings = TrainingSettings(known=known)
        sizes = make_sizes(kind)
        own = Learner(
            msgspec.structs.replace(plan(takes[:1], takes[1:], kind, sizes=sizes), settings=settings),
            takes[:1],
        )
        own.advance()
        began = time.process_time()
        for _ in range(steps):
            own.advance()
        took = time.process_time() - began
        how = "each window by itself" if each else f"shared, all known in {100 * known:.0f} %"
        print(
            f"{kind:10} {count_parameters(sizes) / 1e6:.2f} M  {how:32} "
            f"{steps * own.objective.frames / took:9,.0f} frames/CPU-s",
            flush=True,
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10)
