"""How large an export is beside the state machine it stands for: python tests/benchmarks/bench_export_size.py

Graphs of 10 to 10,000 actions in the proportions of the sample project, its number of stances growing with
the square root. Prints the table of docs/reference/export-size.md, with medians of five writings and
readings.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from metagraph.engines import contract as c
from metagraph.engines.export_document import to_document
from metagraph.graph.expand import count_machine_size
from metagraph.graph.model import LAYERS, Action, ClipEntry, Kind, MetaGraph, Project, Stance, Timing
from tests.projects import SKELETON

SHARES: tuple[tuple[Kind, int], ...] = (
    ("gesture", 11),
    ("fidget", 4),
    ("transition", 4),
    ("stance", 1),
)  # of 20 actions


def project(actions: int) -> Project:
    """Return a graph of about so many actions, spread over the layers; its clips have no motion."""
    clips = {
        f"c{n}": ClipEntry(f"c{n}", f"clip {n}", f"clips/{n}.glb", 0, "0" * 64, 60, 30.0)
        for n in range(actions)
    }
    stances = max(2, round(4 * (actions / 152) ** 0.5))
    kinds = [kind for kind, share in SHARES for _ in range(share)]
    out = Project("size", SKELETON, clips)
    number = 0
    for layer in LAYERS:
        nodes = {f"s{layer}{n}": Stance(f"s{layer}{n}", layer, f"stance {n}") for n in range(stances)}
        names, placed = list(nodes), {}
        for n in range(actions // 3 + (1 if layer == "arms" else 0)):
            kind = "stance" if n < stances else kinds[n % 20]
            here, there = names[n % stances], names[(n + 1 + n // stances % (stances - 1)) % stances]
            end = there if kind == "transition" else None
            timing = Timing(0.0, None, 0.2, 0.25, kind == "stance")
            placed[f"a{number}"] = Action(
                f"a{number}", f"c{number % actions}", kind, layer, here, f"{kind} {n}", end, timing
            )
            number += 1
        out = out.with_graph(MetaGraph(layer, nodes, placed, names[0]))
    return out


def median(work: Callable[[], Any]) -> float:
    times = []
    for _ in range(5):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def main() -> None:
    print(
        "| actions | stances | implied connections | JSON | JSON per action | with the machine listed "
        "| ratio | writing | reading |"
    )
    print("|---|---|---|---|---|---|---|---|---|")
    for actions in (10, 100, 1000, 10_000):
        made = project(actions)
        names = tuple(entry.name for entry in made.clips.values())
        plain = msgspec.json.encode(to_document(made, "size.glb", names))
        listed = msgspec.json.encode(to_document(made, "size.glb", names, True))
        whole, stances = count_machine_size(made), sum(len(g.stances) for g in made.graphs.values())
        writing = median(
            lambda made=made, names=names: msgspec.json.encode(to_document(made, "size.glb", names))
        )
        reading = median(lambda plain=plain: msgspec.json.decode(plain, type=c.Export))
        print(
            f"| {whole.states:,} | {stances} | {whole.connections:,} | {len(plain) / 1e3:,.0f} kB | "
            f"{len(plain) / whole.states:.0f} B | "
            f"{len(listed) / 1e3:,.0f} kB | {len(listed) / len(plain):.1f} | {writing * 1e3:.1f} ms | "
            f"{reading * 1e3:.1f} ms |"
        )


if __name__ == "__main__":
    main()
