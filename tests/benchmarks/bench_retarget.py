"""How long bringing clips onto another character, and mirroring them, take: python
tests/benchmarks/bench_retarget.py

150 clips of 3 seconds at 30 frames a second on a skeleton of 61 joints, onto one of 134 joints when
../shared/data is here, else onto the same figure in another size. Prints seconds: proposing the joint map,
retargeting and mirroring all, medians of three.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.clips import read_clips  # noqa: E402
from metagraph.motion import rotation  # noqa: E402
from metagraph.motion.clip import Clip  # noqa: E402
from metagraph.motion.joint_map import proposed  # noqa: E402
from metagraph.motion.mirror import mirror, pairs_of  # noqa: E402
from metagraph.motion.retarget import retarget  # noqa: E402
from metagraph.motion.skeleton import Skeleton  # noqa: E402
from sample_clips.make.mannequin_skeleton import mannequin_skeleton  # noqa: E402

CLIPS, FRAMES, ROUNDS = 150, 91, 3


def clips(skeleton: Skeleton) -> list[Clip]:
    rng = np.random.default_rng(1)
    x = np.linspace(0, 2 * np.pi, FRAMES)[:, None, None]
    out = []
    for n in range(CLIPS):
        turns = 0.2 * np.sin(x + rng.random((1, len(skeleton), 1))) * rng.normal(size=(1, len(skeleton), 3))
        root = np.tile(skeleton.rest_translations[:1], (FRAMES, 1, 1))
        out.append(
            Clip(
                f"clip {n}",
                skeleton,
                30,
                rotation.multiply(skeleton.rest_rotations, rotation.exp(turns)),
                root,
            )
        )
    return out


def timed(work: Callable[[], object]) -> float:
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def main() -> None:
    source = mannequin_skeleton()
    file = ROOT.parent / "shared" / "data" / "sumerian-hosts/glTF/animations/adult_female/stand_idle.glb"
    target = read_clips(file)[0].skeleton if file.exists() else Skeleton(
        source.names, source.parents, source.rest_rotations, source.rest_translations * 1.2
    )  # fmt: skip
    many = clips(source)
    joint_map, pairs = proposed(source, target), pairs_of(source)
    print(f"{CLIPS} clips of {(FRAMES - 1) / 30:.0f} s, {len(source)} joints onto {len(target)}")
    print(f"joint map   {timed(lambda: proposed(source, target)):8.3f} s")
    print(f"retarget    {timed(lambda: [retarget(c, target, joint_map) for c in many]):8.3f} s")
    print(f"mirror      {timed(lambda: [mirror(c, pairs) for c in many]):8.3f} s")


if __name__ == "__main__":
    main()
