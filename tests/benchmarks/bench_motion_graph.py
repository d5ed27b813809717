"""How long motion graphs take to build and search: python tests/benchmarks/bench_motion_graph.py [frames ...]

Side by side with a straightforward NumPy reading of the paper on the same data: 25 joints, 50,568 frames at 30 Hz, smooth synthetic motion
with rests, at thresholds that accept 11 % and 1 % of all pairs; then, where ../shared/data is, the real takes there. The straightforward
one compares a few rows with all others, and its time is multiplied; its edges are compared one by one. With numbers behind it: the cost
against the number of frames, for the log plot.
"""

from __future__ import annotations

import itertools
import resource
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.graph.conversation import SOUNDS, Segment  # noqa: E402
from metagraph.synthesis.constraints import Heard, wanted  # noqa: E402
from metagraph.synthesis.graph import MotionGraph, Threshold, build, threshold  # noqa: E402
from metagraph.synthesis.search import best, greedy  # noqa: E402
from metagraph.synthesis.states import States, key_states, states_of, terms_of, with_velocity  # noqa: E402

Array = Any
ROWS = 12  # the straightforward one compares


def synthetic(frames: int, joints: int = 25, seed: int = 1) -> States:
    """Smooth motion with rests: each joint wanders about a rest pose, now and then everything stands still for a while."""
    chance = np.random.default_rng(seed)
    knots = frames // 15 + 3
    way = np.cumsum(chance.normal(0, 0.03, (knots, joints, 3)), axis=0)
    moving = np.repeat(chance.random(knots // 8 + 1) < 0.6, 8)[:knots]
    way = np.cumsum(np.where(moving[:, None, None], np.diff(way, axis=0, prepend=0), 0.0), axis=0)
    rest = chance.normal(0, 0.4, (1, joints, 3))
    starts = np.linspace(0, frames, max(2, frames // 2500) + 1).astype(int)
    places32, velocities = np.empty((frames, joints, 3), np.float32), np.empty((frames, joints, 3), np.float32)
    for a, b in itertools.pairwise(starts):  # take by take, so that the whole is never in memory in 64 bits
        t = np.arange(a, b) / 15
        place = t.astype(int)
        part = (t - place)[:, None, None]
        part = part * part * (3 - 2 * part)
        places = rest + 0.3 * np.tanh((1 - part) * way[place] + part * way[place + 1])
        places32[a:b], velocities[a:b] = places, np.gradient(places, 1 / 30, axis=0)
    return with_velocity(States(places32, velocities, np.ones(joints, np.float32), starts, 0.0), 1 / 30)


def limit_for(states: States, keys: Array, share: float) -> float:
    """Return the threshold that accepts about a share of all pairs of key states."""
    chance = np.random.default_rng(2)
    a, b = (chance.choice(keys, 600) for _ in range(2))
    return float(np.quantile([np.linalg.norm(x - terms_of(states, b), axis=-1).sum(-1) for x in terms_of(states, a)], share))


def straightforward(states: States, keys: Array, limit: float, rows: Array) -> list[Array]:
    """Return the targets of some key states, as equations 3 and 4 say, in 64 bits."""
    first = np.isin(keys, states.starts[:-1])
    into = keys[~first]
    places, velocities = states.places.astype(float), states.velocities.astype(float)
    out = []
    for i in rows:
        p = np.linalg.norm(places[i] - places[into - 1], axis=-1) @ states.weights
        v = np.linalg.norm(velocities[i] - velocities[into - 1], axis=-1) @ states.weights
        near = p + states.velocity * v <= limit
        out.append(into[near & (into != i + 1)])
    return out


def timed(work: Any, times: int = 3) -> tuple[float, Any]:
    """Return the median seconds of a few runs, and the last result."""
    seconds = []
    for _ in range(times):
        begun = time.perf_counter()
        result = work()
        seconds.append(time.perf_counter() - begun)
    return sorted(seconds)[len(seconds) // 2], result


def compared(name: str, states: States, limit: float) -> MotionGraph:
    """Print one line, ours beside the straightforward one."""
    keys = key_states(states)
    given = Threshold(3, 0.95, np.zeros(0), None, limit, limit)
    ours, graph = timed(lambda: build(states, given, keys))
    whole = build(states, given, keys, connected=False)
    rows = keys[np.linspace(0, len(keys) - 1, ROWS).astype(int)]
    theirs, found = timed(lambda: straightforward(states, keys, limit, rows), 1)
    theirs *= len(keys) / ROWS
    odd = sum(len(set(mine) ^ set(whole.targets[whole.starts[i] : whole.starts[i + 1]])) for i, mine in zip(rows, found, strict=True))
    share = len(whole.targets) / len(keys) ** 2
    kept, edges = graph.size
    print(
        f"| {name} | {len(states):,} | {len(keys):,} | {share:.2%} | {edges:,} | {kept:,} | {ours:.2f} s | {theirs:,.0f} s | "
        f"{theirs / ours:,.0f} | {odd} of {sum(map(len, found)):,} |",
        flush=True,
    )
    return graph


def searched(graph: MotionGraph) -> None:
    """Print how long a path for 15 s takes, exact and greedy."""
    chance = np.random.default_rng(3)
    frames = len(graph.states)
    kinds = np.ones(frames, np.uint8)
    for at in range(20, frames - 60, 75):
        kinds[at : at + int(chance.integers(15, 45))] = 1 << SOUNDS.index("clause")
    peaks = (kinds == 1 << SOUNDS.index("clause")) & (chance.random(frames) < 0.25)
    sound = Heard(kinds, peaks)
    segments = [Segment("clause", s, s + 1.0, s + 0.5) for s in np.arange(1.0, 14.0, 2.5)]
    want = wanted(segments, 15.0)
    exact, path = timed(lambda: best(graph, sound, want))
    print(f"\n15 s of speech, exact: {exact:.2f} s, cost {path.cost:.3f}, {len(path.jumps)} transitions")
    for branches in (20, 50):
        try:
            seconds, other = timed(lambda n=branches: greedy(graph, sound, want, branches=n))
            more = other.cost / max(path.cost, 1e-9)
            print(f"greedy, 200 kept, {branches} branches: {1000 * seconds:.0f} ms, cost {more:.2f} times the least")
        except ValueError as error:
            print(f"greedy, 200 kept, {branches} branches: {error}")


def main() -> None:
    heads = ("data", "frames", "key states", "pairs accepted", "transitions", "states kept", "ours, with SCC", "NumPy, without", "ratio")
    print(f"| {' | '.join((*heads, 'edges that differ'))} |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    build(synthetic(3000))  # compiles
    sizes = [int(a) for a in sys.argv[1:]]
    if sizes:
        for size in sizes:
            states = synthetic(size)
            keys = key_states(states)
            given = Threshold(3, 0.95, np.zeros(0), None, limit_for(states, keys, 0.002), 0.0)
            seconds, graph = timed(lambda s=states, g=given, k=keys: build(s, g, k, most=200), 1)
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
            kept, edges = graph.size
            print(f"| synthetic | {size:,} | {len(keys):,} | | {edges:,} | {kept:,} | {seconds:.1f} s | | | {peak:.2f} GB |", flush=True)
        return
    states = synthetic(50_568)
    keys = key_states(states)
    graph = None
    for share in (0.11, 0.01):
        graph = compared(f"synthetic, {share:.0%}", states, limit_for(states, keys, share))
    data = ROOT.parent / "shared" / "data" / "bandai-namco-1"
    if data.is_dir():
        from metagraph.formats.clips import read_clips

        takes = [clip for path in sorted(data.glob("*.bvh")) for clip in read_clips(path)]
        real = states_of([t for t in takes if t.skeleton == takes[0].skeleton])
        for k in (2, 3, 4):
            try:
                compared(f"bandai-namco-1, k = {k}", real, threshold(real, k).limit)
            except ValueError as error:
                print(f"bandai-namco-1, k = {k}: {error}")
    assert graph is not None
    searched(graph)


if __name__ == "__main__":
    main()
