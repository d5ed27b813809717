"""How long motion graphs take to build and search: python tests/benchmarks/bench_motion_graph.py [first |
scale [frames ...]]

Side by side with a straightforward NumPy reading of the paper on the same data, and with SciPy's components:
25 joints, 50,568 frames at 30 Hz, smooth synthetic motion with rests, at thresholds that accept 11 % and 1 %
of all pairs; then, where ../shared/data is, the real takes there. The straightforward one compares a few rows
with all others, and its time is multiplied; its edges are compared one by one.

With `first`: the first graph and the first exact search of 5 s of a new user, for whom nothing is compiled,
and those of a later start; by the clock and in processor time.

With `scale`: the cost against the number of frames, 10k to 1M, each in a process of its own so that its peak
memory is its own, best of several for the small ones; without numbers behind it that is drawn as
docs/images/motion-graph-scale.svg.
"""

from __future__ import annotations

import itertools
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))


from metagraph.graph.conversation.model import SOUNDS, Segment  # noqa: E402
from metagraph.synthesis.constraints import HeardStates, list_wanted  # noqa: E402
from metagraph.synthesis.graph import (  # noqa: E402
    MotionGraph,
    Threshold,
    build_graph,
    find_largest_component,
    find_threshold,
)
from metagraph.synthesis.search.exact_search import find_best_path  # noqa: E402
from metagraph.synthesis.search.greedy_search import search_greedily  # noqa: E402
from metagraph.synthesis.states import States, compute_cost_terms, key_states, read_states, with_velocity  # noqa: E402

Array = Any
ROWS = 12  # the straightforward one compares


def synthetic(frames: int, joints: int = 25, seed: int = 1) -> States:
    """Smooth motion with rests: each joint wanders about a rest pose, now and then everything stands still
    for a while.
    """
    chance = np.random.default_rng(seed)
    knots = frames // 15 + 3
    way = np.cumsum(chance.normal(0, 0.03, (knots, joints, 3)), axis=0)
    moving = np.repeat(chance.random(knots // 8 + 1) < 0.6, 8)[:knots]
    way = np.cumsum(np.where(moving[:, None, None], np.diff(way, axis=0, prepend=0), 0.0), axis=0)
    rest = chance.normal(0, 0.4, (1, joints, 3))
    starts = np.linspace(0, frames, max(2, frames // 2500) + 1).astype(int)
    places32, velocities = (
        np.empty((frames, joints, 3), np.float32),
        np.empty((frames, joints, 3), np.float32),
    )
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
    return float(
        np.quantile(
            [
                np.linalg.norm(x - compute_cost_terms(states, b), axis=-1).sum(-1)
                for x in compute_cost_terms(states, a)
            ],
            share,
        )
    )


def straightforward(states: States, keys: Array, limit: float) -> Any:
    """Return what finds the targets of some key states, as equations 3 and 4 say, in 64 bits; what is the
    same for all is made before.
    """
    into = keys[~np.isin(keys, states.starts[:-1])]
    places, velocities = states.places[into - 1].astype(float), states.velocities[into - 1].astype(float)

    def targets(rows: Array) -> list[Array]:
        out = []
        for i in rows:
            p = np.linalg.norm(states.places[i].astype(float) - places, axis=-1) @ states.weights
            v = np.linalg.norm(states.velocities[i].astype(float) - velocities, axis=-1) @ states.weights
            out.append(into[(p + states.velocity * v <= limit) & (into != i + 1)])
        return out

    return targets


def timed(work: Any, times: int = 5) -> tuple[float, Any]:
    """Return the least seconds of a few runs, since others work on the machine, and the last result."""
    seconds = []
    for _ in range(times):
        begun = time.perf_counter()
        result = work()
        seconds.append(time.perf_counter() - begun)
    return min(seconds), result


def compared(name: str, states: States, limit: float) -> MotionGraph:
    """Print one line, ours beside the straightforward one."""
    keys = key_states(states)
    given = Threshold(3, 0.95, np.zeros(0), None, limit, limit)
    ours, graph = timed(lambda: build_graph(states, given, keys))
    whole = build_graph(states, given, keys, connected=False)
    rows = keys[np.linspace(0, len(keys) - 1, ROWS).astype(int)]
    plain = straightforward(states, keys, limit)
    theirs, found = timed(lambda: plain(rows), 3)
    theirs *= len(keys) / ROWS
    odd = sum(
        len(set(mine) ^ set(whole.targets[whole.starts[i] : whole.starts[i + 1]]))
        for i, mine in zip(rows, found, strict=True)
    )
    share = len(whole.targets) / len(keys) ** 2
    kept, edges = graph.size
    print(
        f"| {name} | {len(states):,} | {len(keys):,} | {share:.2%} | {edges:,} | {kept:,} | {ours:.2f} s | "
        f"{theirs:,.0f} s | "
        f"{theirs / ours:,.0f} | {odd} of {sum(map(len, found)):,} |",
        flush=True,
    )
    return graph


def components(states: States, limit: float) -> None:
    """Print how long the largest component takes, ours beside SciPy's on a matrix that is made already."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import connected_components

    whole = build_graph(states, Threshold(3, 0.95, np.zeros(0), None, limit, limit), connected=False)
    ours, graph = timed(lambda: find_largest_component(whole))
    rows = np.repeat(np.arange(len(states), dtype=np.int32), np.diff(whole.starts))
    follows = np.flatnonzero(~states.last).astype(np.int32)
    shape = (len(states), len(states))
    every = np.concatenate([rows, follows]), np.concatenate([whole.targets, follows + 1])
    making, matrix = timed(lambda: csr_matrix((np.ones(len(every[0]), np.int8), every), shape=shape), 2)
    theirs, (_, labels) = timed(lambda: connected_components(matrix, True, "strong"))
    same = bool((graph.kept == (labels == np.bincount(labels).argmax())).all())
    print(
        f"largest component of {len(every[0]):,} edges: {ours:.2f} s with the rest cut away; SciPy "
        f"{theirs:.2f} s for the labels, "
        f"{making:.2f} s for its matrix: {(theirs + making) / ours:.1f} times; the same states: {same}"
    )


def speech(frames: int, seed: int = 3) -> tuple[HeardStates, list[Segment]]:
    """Return what is heard at states, and 15 s of other speech of the same kind: clauses, answers,
    hesitations, as irregular as talk.
    """
    chance = np.random.default_rng(seed)
    kinds, peaks, edges, at = np.ones(frames, np.uint8), np.zeros(frames, bool), np.zeros(frames, bool), 5
    while at < frames - 120:
        kind = int(chance.choice([1, 1, 1, 2, 3]))
        length = int(chance.integers(12, 60)) // (1 if kind == 1 else 2)
        kinds[at : at + length] = 1 << kind
        edges[[at, at + length]] = True
        if kind == 1:
            peaks[at + int(chance.integers(2, length - 2))] = True
        at += length + int(chance.integers(6, 60))
    out, start = [], 0.4
    while start < 13.5:
        kind = str(chance.choice(SOUNDS[1:], p=[0.6, 0.2, 0.2]))
        length = float(chance.uniform(0.4, 2.0)) / (1 if kind == "clause" else 2)
        peak = start + length * float(chance.uniform(0.1, 0.9)) if kind == "clause" else None
        out.append(Segment(kind, start, start + length, peak))
        start += length + float(chance.uniform(0.2, 2.0))
    return HeardStates(kinds, peaks, edges), out


def searched(name: str, graph: MotionGraph) -> None:
    """Print how long a path for 15 s takes, exact and greedy, and how much dearer the greedy one's are."""
    sound, segments = speech(len(graph.states))
    want = list_wanted(segments, 15.0)
    exact, path = timed(lambda: find_best_path(graph, sound, want), 2)
    print(
        f"\n15 s of speech, {name}: exact {exact:.2f} s, cost {path.cost:.3f}, {len(path.jumps)} transitions"
    )
    begun = time.perf_counter()
    search_greedily(graph, sound, want)
    first = time.perf_counter() - begun
    costs, seconds, failed = [], [], 0
    for seed in range(20):
        try:
            took, other = timed(lambda n=seed: search_greedily(graph, sound, want, n), 2)
        except ValueError:
            failed += 1
            continue
        costs.append(other.cost / path.cost)
        seconds.append(took)
    print(
        f"greedy, 200 kept, 20 seeds: median {1000 * np.median(seconds):.0f} ms, best "
        f"{1000 * min(seconds):.0f} ms (the first of a graph "
        f"{1000 * first:.0f} ms); cost {np.median(costs):.2f} times the least, {min(costs):.2f} to "
        f"{max(costs):.2f}; {failed} found nothing"
    )


SIZES = (10_000, 30_000, 100_000, 300_000, 1_000_000)
SHARE = 0.002  # of pairs of key states that are near enough
MOST = 200  # transitions kept of a state


def one_size(size: int) -> dict[str, Any]:
    """Build a graph of so many frames; return what it took. Meant for a process of its own."""
    build_graph(synthetic(3000))  # compiles
    states = synthetic(size)
    keys = key_states(states)
    given = Threshold(3, 0.95, np.zeros(0), None, limit_for(states, keys, SHARE), 0.0)
    seconds, graph = timed(lambda: build_graph(states, given, keys, MOST), 3 if size < 300_000 else 1)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    rows = keys[np.linspace(0, len(keys) - 1, 3).astype(int)]
    theirs = 0.0
    if size <= 100_000:  # in 64 bits it holds everything several times
        plain = straightforward(states, keys, given.limit)
        theirs = timed(lambda: plain(rows), 3)[0] * len(keys) / len(rows)
    kept, edges = graph.size
    return {
        "frames": size,
        "keys": len(keys),
        "kept": kept,
        "edges": edges,
        "seconds": seconds,
        "gib": peak,
        "numpy": theirs,
    }


def scale(sizes: list[int]) -> list[dict[str, Any]]:
    print(
        "| frames | key states | transitions | states kept | seconds | peak memory | NumPy, from 3 rows | "
        "ratio |"
    )
    print("|---|---|---|---|---|---|---|---|", flush=True)
    rows = []
    for size in sizes:
        code = (
            f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); import bench_motion_graph "
            "as b, json; "
        )
        code += f"print(json.dumps(b.one_size({size})))"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        r = json.loads(done.stdout)
        rows.append(r)
        beside = f"{r['numpy']:,.0f} s | {r['numpy'] / r['seconds']:,.0f}" if r["numpy"] else " | "
        print(
            f"| {size:,} | {r['keys']:,} | {r['edges']:,} | {r['kept']:,} | {r['seconds']:.2f} | "
            f"{r['gib']:.2f} GiB | {beside} |",
            flush=True,
        )
    return rows


def once() -> None:
    """Print what a graph and a search take in this process."""
    states = synthetic(3000)
    keys = key_states(states)
    limit = limit_for(states, keys, 0.05)
    graph: Any = None

    def build() -> None:
        nonlocal graph
        graph = build_graph(states, Threshold(3, 0.95, np.zeros(0), None, limit, limit), keys)

    def search() -> None:
        sound, segments = speech(len(graph.states))
        find_best_path(graph, sound, list_wanted(segments, 5.0))

    for what, work in (("graph", build), ("search", search)):
        begun, busy = time.perf_counter(), time.process_time()
        work()
        wall, used = time.perf_counter() - begun, time.process_time() - busy
        print(f"  first {what}: {wall:.1f} s, processor {used:.1f} s", flush=True)


def first() -> None:
    """Run `once` in a process for which nothing is compiled, then in another one."""
    with tempfile.TemporaryDirectory() as folder:
        for what in ("nothing compiled", "a later start"):
            print(what, flush=True)
            environ = {**os.environ, "NUMBA_CACHE_DIR": folder}
            subprocess.run([sys.executable, __file__, "once"], env=environ, check=True)


def drawn(rows: list[dict[str, Any]]) -> str:
    """Return seconds and memory against frames as an SVG; both axes are logarithmic."""
    left, right, top, bottom = 70.0, 470.0, 46.0, 330.0
    low, high = -2.0, 4.0  # powers of ten of seconds and GiB

    def x(frames: float) -> float:
        return left + (right - left) * (np.log10(frames) - 4) / 2

    def y(value: float) -> float:
        return bottom - (bottom - top) * (np.log10(value) - low) / (high - low)

    style = (
        "text{font:12px "
        "system-ui,sans-serif;fill:#57606a}.t{font-weight:600;fill:#24292f}line{stroke:#d0d7de}"
        ".a{stroke:#0969da;fill:#0969da}.b{stroke:#8250df;fill:#8250df}.c{stroke:#bf5b04;fill:#bf5b04}polyline{"
        "stroke-width:2.5}text.a,text.b,text.c{stroke:none}@media(prefers-color-scheme:dark){text{fill:#9198a1}.t{fill:#e6edf3}"
        "line{stroke:#3d444d}.a{stroke:#4493f8;fill:#4493f8}.b{stroke:#ab7df8;fill:#ab7df8}.c{stroke:#f0883e;fill:#f0883e}}"
    )
    cores = os.cpu_count()
    out = [
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 640 390' role='img' aria-label='Cost of a "
        "motion graph against its frames'>",
        f"<style>{style}</style>",
        f"<text class='t' x='{left}' y='22'>Building a motion graph of 25 joints on {cores} cores, largest "
        "component and all</text>",
    ]
    for power in range(int(low), int(high) + 1):
        at = y(10.0**power)
        out.append(f"<line x1='{left}' x2='{right}' y1='{at:.1f}' y2='{at:.1f}'/>")
        out.append(f"<text x='{left - 8}' y='{at + 4:.1f}' text-anchor='end'>{10.0**power:g}</text>")
    for frames, words in ((1e4, "10k"), (3e4, "30k"), (1e5, "100k"), (3e5, "300k"), (1e6, "1M frames")):
        out.append(f"<text x='{x(frames):.1f}' y='{bottom + 20}' text-anchor='middle'>{words}</text>")
    for css, field, words in (
        ("c", "numpy", "NumPy, seconds"),
        ("a", "seconds", "seconds"),
        ("b", "gib", "peak GiB"),
    ):
        known = [(x(r["frames"]), y(r[field])) for r in rows if r[field]]
        out.append(
            f"<polyline class='{css}' style='fill:none' "
            f"points='{' '.join(f'{a:.1f},{b:.1f}' for a, b in known)}'/>"
        )
        out += [f"<circle class='{css}' cx='{a:.1f}' cy='{b:.1f}' r='3.5'/>" for a, b in known]
        shown = [r for r in rows if r[field]][-1][field]
        out.append(
            f"<text class='{css}' x='{known[-1][0] + 10:.1f}' y='{known[-1][1] + 4:.1f}'>{words}: "
            f"{shown:,.3g}</text>"
        )
    what = (
        f"{SHARE:.1%} of pairs of key states near enough, the {MOST} cheapest of each kept; best runs, "
        "NumPy from three rows"
    )
    out.append(f"<text x='{left}' y='{bottom + 46}'>{what}</text></svg>")
    return "\n".join(out) + "\n"


def main() -> None:
    if sys.argv[1:] in (["once"], ["first"]):
        {"once": once, "first": first}[sys.argv[1]]()
        return
    if sys.argv[1:2] == ["scale"]:
        given = [int(a) for a in sys.argv[2:]]
        rows = scale(given or list(SIZES))
        if not given:
            (ROOT / "docs" / "images" / "motion-graph-scale.svg").write_text(drawn(rows))
        return
    heads = (
        "data",
        "frames",
        "key states",
        "pairs accepted",
        "transitions",
        "states kept",
        "ours, with SCC",
        "NumPy, without",
        "ratio",
    )
    print(f"| {' | '.join((*heads, 'edges that differ'))} |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    build_graph(synthetic(3000))  # compiles
    states = synthetic(50_568)
    keys = key_states(states)
    limits = {share: limit_for(states, keys, share) for share in (0.11, 0.01)}
    graphs = {share: compared(f"synthetic, {share:.0%}", states, limit) for share, limit in limits.items()}
    data = ROOT.parent / "shared" / "data" / "bandai-namco-1"
    if data.is_dir():
        from metagraph.formats.clips import read_clips

        takes = [clip for path in sorted(data.glob("*.bvh")) for clip in read_clips(path)]
        real = read_states([t for t in takes if t.skeleton == takes[0].skeleton])
        for k in (2, 3, 4):
            try:
                compared(f"bandai-namco-1, k = {k}", real, find_threshold(real, k).limit)
            except ValueError as error:
                print(f"bandai-namco-1, k = {k}: {error}")
    print()
    components(states, limits[0.11])
    for share, graph in graphs.items():
        searched(f"{share:.0%} accepted", graph)


if __name__ == "__main__":
    main()
