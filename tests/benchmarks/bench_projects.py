"""Saving, opening and recovering projects, and the export: python tests/benchmarks/bench_projects.py
[actions]

A project of 10,000 actions (no argument) on the sample's 152 clips. open: the project file alone, without
reading clips. recover: the file and a journal of 1,000 edits. edit: what the journal adds to one edit.
export: the sample project with its mesh. Medians.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.engines.export import export_project  # noqa: E402
from metagraph.engines.reading import read_export  # noqa: E402
from metagraph.formats.project.data import from_data, to_data  # noqa: E402
from metagraph.formats.project.journal import Journal, make_journal_path  # noqa: E402
from metagraph.formats.project.text import read_text_data, to_text  # noqa: E402
from metagraph.formats.recovery import recover  # noqa: E402
from metagraph.formats.store import SUFFIX, open_project, read_project, save_project  # noqa: E402
from metagraph.graph import edits  # noqa: E402
from metagraph.graph.model import LAYERS, Project  # noqa: E402

ROUNDS, EDITS = 5, 1000
SAMPLE = ROOT / "sample_clips" / f"sample{SUFFIX}"


def large(actions: int, project: Project | None = None) -> Project:
    """A project, by default the sample without motion, with copies of its actions until there are so many."""
    project = read_project(SAMPLE) if project is None else project
    while (count := sum(1 for _ in project.actions())) < actions:
        for layer in LAYERS:
            for (stance, kind), bucket in list(project.graphs[layer].index.items()):
                clips = [a.clip for a in bucket][: max(0, actions - count)]
                end = bucket[0].end_stance
                if clips:
                    project = edits.place_clips(project, clips, layer, kind, stance, end)
                    count += len(clips)
    return project


def median(work: Callable[[], object], rounds: int = ROUNDS) -> float:
    """Return the median milliseconds of some rounds of work."""
    times = []
    for _ in range(rounds):
        begun = time.perf_counter()
        work()
        times.append(time.perf_counter() - begun)
    return statistics.median(times) * 1e3


def main() -> None:
    actions = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = folder / f"large{SUFFIX}"
        project = large(actions)
        save = median(lambda: save_project(project, path))
        text = path.read_text(encoding="utf-8")
        data = to_data(project)
        print(f"{sum(1 for _ in project.actions()):,} actions, {len(text) / 1e6:.2f} MB")
        print(f"save               {save:8.0f} ms")
        print(f"open               {median(lambda: read_project(path)):8.0f} ms")
        print(f"  text -> data     {median(lambda: read_text_data(text)):8.0f} ms")
        print(f"  data -> project  {median(lambda: from_data(data)):8.0f} ms")
        print(f"  data -> text     {median(lambda: to_text(data)):8.0f} ms")
        journal = Journal(make_journal_path(path), path)
        ids = [a.id for a in project.actions()]
        each, now = [], project
        for n in range(EDITS):
            chosen = ids[n * 7919 % len(ids)]
            after = (
                edits.remove_actions(now, [chosen])
                if n % 4 == 3
                else edits.update_actions(now, [chosen], likelihood=1.0 + n)
            )
            begun = time.perf_counter()
            journal.edit(now, after)
            each.append(time.perf_counter() - begun)
            now = after
        journal.close()
        size = make_journal_path(path).stat().st_size
        print(f"journal, one edit  {statistics.median(each) * 1e3:8.2f} ms, {size / EDITS:.0f} bytes")
        print(f"recover {EDITS} edits {median(lambda: recover(make_journal_path(path), path)):8.0f} ms")
        sample = open_project(SAMPLE).project
        print(
            f"open the sample    {median(lambda: open_project(SAMPLE)):8.0f} ms, {len(sample.clips)} clips "
            "read"
        )
        mesh = SAMPLE.with_name("mannequin.glb")
        made = export_project(sample, folder / "export", expanded=True, character=mesh)
        taken = median(lambda: export_project(sample, folder / "export", expanded=True, character=mesh))
        print(f"export the sample  {taken:8.0f} ms", end=", ")
        print(f"JSON {made.json.stat().st_size / 1e6:.2f} MB, GLB {made.glb.stat().st_size / 1e6:.2f} MB")
        print(f"read it back       {median(lambda: read_export(made.json)):8.0f} ms")


if __name__ == "__main__":
    main()
