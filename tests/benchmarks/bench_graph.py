"""Milliseconds of edits and checks in a graph of ten thousand actions: python tests/benchmarks/bench_graph.py
[actions]

An edit counts from the call until the index, the uses of a clip and the action by its id are there again;
"compare" is what telling the project from the one before costs then. Medians. "one layer" has all actions in
the arms layer, a hundred stances: the worst case.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from metagraph.graph import edits  # noqa: E402
from metagraph.graph.check import check_project  # noqa: E402
from metagraph.graph.expand import count_machine_size, list_connections  # noqa: E402
from metagraph.graph.model import KINDS, LAYERS, ClipEntry, Layer, Project  # noqa: E402


def large(actions: int, layers: Sequence[Layer], stances: int) -> Project:
    """A project of that many actions, spread evenly over layers, stances and kinds."""
    clips = {f"c{i}": ClipEntry(f"c{i}", f"clip {i}", f"clips/{i}.glb", frames=60) for i in range(actions)}
    project = replace(Project(), clips=clips)
    for n, layer in enumerate(layers):
        for s in range(stances):
            project = edits.add_stance(project, layer, f"stance {s}")
        ids = list(project.graphs[layer].stances)
        own = list(clips)[n :: len(layers)]
        for k, kind in enumerate(KINDS):
            for s in range(stances):
                some = own[k::4][s::stances]
                if some:
                    project = edits.place_clips(
                        project,
                        some,
                        layer,
                        kind,
                        ids[s],
                        ids[(s + 1) % stances] if kind == "transition" else None,
                    )
    return project


def median(work: Callable[[], object], rounds: int) -> float:
    """Milliseconds."""
    out = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        out.append(time.perf_counter() - start)
    return statistics.median(out) * 1e3


def bench_edits(project: Project, title: str) -> None:
    arms = project.graphs["arms"]
    stances = list(arms.stances)
    gestures = [a.id for a in arms.actions.values() if a.kind == "gesture"]
    cases: dict[str, Callable[[Project, int], Project]] = {
        "timing of one": lambda p, i: edits.update_actions(
            p, [gestures[i]], timing={"blend_in": 0.1 + i * 1e-3}
        ),
        "timing of 100": lambda p, i: edits.update_actions(
            p, gestures[:100], timing={"blend_in": 0.1 + i * 1e-3}
        ),
        "likelihood": lambda p, i: edits.update_actions(p, [gestures[-i]], likelihood=2.0 + i),
        "place": lambda p, i: edits.place_clips(p, [f"c{i}"], "arms", "gesture", stances[3]),
        "place 100": lambda p, i: edits.place_clips(
            p, [f"c{n}" for n in range(100)], "arms", "fidget", stances[i % 20]
        ),
        "move": lambda p, i: edits.move_actions(p, [gestures[i]], "fidget", stances[(i + 1) % 20]),
        "remove": lambda p, i: edits.remove_actions(p, [gestures[200 + i]]),
        "rename clip": lambda p, i: edits.rename_clip(p, f"c{i}", f"new {i}"),
        "new stance": lambda p, i: edits.add_stance(p, "arms", f"new {i}"),
        "remove stance": lambda p, i: edits.remove_stance(p, stances[-1 - i]) if i < 5 else p,
    }
    count = sum(1 for _ in project.actions())
    print(f"\n{title}: {count} actions{'':24} {'median':>8} {'worst':>8} {'compare':>8}  ms")
    for graph in project.graphs.values():
        _ = graph.index, graph.uses
    for name, edit in cases.items():
        taken, compared = [], []
        before = project
        for i in range(50):
            start = time.perf_counter()
            after = edit(before, i)
            for graph in after.graphs.values():
                _ = graph.index
            after.uses.get("c5"), after.action(gestures[3])
            middle = time.perf_counter()
            _ = after != before
            compared.append(time.perf_counter() - middle)
            if after is not before:
                taken.append(middle - start)
            before = after
        print(
            f"  {name:40} {statistics.median(taken) * 1e3:8.3f} {max(taken) * 1e3:8.3f} "
            f"{statistics.median(compared) * 1e3:8.3f}"
        )


def main() -> None:
    actions = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    spread = large(actions, LAYERS, 25)
    bench_edits(spread, "three layers")
    bench_edits(large(actions, ["arms"], 100), "one layer")

    sample = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    start = time.perf_counter()
    check_project(sample)
    first = (time.perf_counter() - start) * 1e3
    print(f"\n{'':42} {'median':>8}  ms")
    print(f"  {'check, sample (152 clips), first':40} {first:8.1f}")
    print(f"  {'check, sample, again':40} {median(lambda: check_project(sample), 9):8.1f}")
    print(
        f"  {f'check, {actions} actions without motion':40} {median(lambda: check_project(spread), 5):8.1f}"
    )
    counted = count_machine_size(spread)
    seconds = median(lambda: count_machine_size(spread), 9)
    print(f"  {f'expand.size: {counted.connections} connections':40} {seconds:8.2f}")
    arms = spread.graphs["arms"]
    listed = sum(1 for _ in list_connections(spread, arms))
    print(
        f"  {f'expand.connections, listing {listed}':40} "
        f"{median(lambda: sum(1 for _ in list_connections(spread, arms)), 3):8.1f}"
    )


if __name__ == "__main__":
    main()
