"""How waits grow with the project: python tests/benchmarks/bench_growth.py [ACTIONS [CLIPS]]

Both are sizes with commas between, 1000,10000,50000 and 500,2000,5000 unless said. Processor time in
milliseconds, the least of some rounds, and the exponent between the two largest sizes: 1 is linear. The
actions play the sample's 152 clips; the clips are files of their own, imported into an empty project, then
labelled. bench_motion_graph.py with `scale` does the same for motion graphs, with memory.
"""

from __future__ import annotations

import math
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from bench_projects import SAMPLE, large  # noqa: E402
from bench_waits import make_clips  # noqa: E402

from metagraph.engines.export_document import list_used_clips, to_document  # noqa: E402
from metagraph.formats.imports import import_files  # noqa: E402
from metagraph.formats.project.journal import Journal, make_journal_path  # noqa: E402
from metagraph.formats.recovery import recover  # noqa: E402
from metagraph.formats.store import SUFFIX, open_project, save_project  # noqa: E402
from metagraph.graph import edits  # noqa: E402
from metagraph.graph.check import check_project  # noqa: E402
from metagraph.graph.model import Project  # noqa: E402
from metagraph.playback.planning.running_plan import improvise  # noqa: E402
from metagraph.suggest.propose import accept, propose  # noqa: E402

Row = dict[str, float]


def measure(work: Callable[[], object], rounds: int = 3) -> float:
    """Return the least milliseconds of processor time of some rounds."""
    times = []
    for _ in range(rounds):
        begun = time.process_time()
        work()
        times.append(time.process_time() - begun)
    return min(times) * 1e3


def indexed(project: Project) -> Project:
    """Return a project with what an edit of it takes over."""
    for graph in project.graphs.values():
        _ = graph.index, graph.uses
    return project


def with_actions(count: int, folder: Path) -> Row:
    """Return what a project of so many actions costs."""
    project, path = indexed(large(count, open_project(SAMPLE).project)), folder / f"{count}{SUFFIX}"
    ids = [action.id for action in project.actions()]
    stance = project.graphs["arms"].start or ""
    numbers = iter(range(1, 1000))
    more = lambda some: indexed(  # noqa: E731
        edits.update_actions(project, some, timing={"blend_in": 0.2 + next(numbers) / 1000})
    )
    row = {"edit one action": measure(lambda: more(ids[:1])), "edit all": measure(lambda: more(ids))}
    row["rename a stance"] = measure(
        lambda: indexed(edits.rename_stance(project, stance, f"s {next(numbers)}"))
    )
    every = more(ids)
    journal = Journal(make_journal_path(path), None)
    row["undo the edit of all, into the journal"] = measure(lambda: journal.edit(every, project), 1)
    journal.close()
    row["check"] = measure(lambda: check_project(every))
    row["plan a minute"] = measure(lambda: improvise(more(ids[:1]), 60))
    row["save"] = measure(lambda: save_project(project, path))
    row["open"] = measure(lambda: open_project(path))
    journal = Journal(make_journal_path(path), path)
    journal.edit(project, every)
    journal.close()
    row["recover the edit of all"] = measure(lambda: recover(make_journal_path(path), path))
    names = tuple(entry.name for entry in list_used_clips(project))
    row["export"] = measure(lambda: to_document(project, "a.glb", names))
    return row


def with_clips(count: int, folder: Path) -> Row:
    """Return what so many clips of an empty project cost."""
    source, path = make_clips(folder / str(count), count), folder / f"clips{count}{SUFFIX}"
    found = []
    row = {"import": measure(lambda: found.append(import_files(Project(), folder, [source])), 1)}
    project = found[0].into(Project())
    proposals, placed = [], []
    row["propose labels"] = measure(lambda: proposals.append(propose(project)), 1)
    row["place all"] = measure(lambda: placed.append(accept(project, proposals[0]).project), 1)
    row["check"] = measure(lambda: check_project(placed[0]), 1)
    row["save"] = measure(lambda: save_project(placed[0], path))
    row["open"] = measure(lambda: open_project(path))
    return row


def show(title: str, sizes: list[int], rows: list[Row]) -> None:
    """Print a table: a line for each row, a column for each size, and the last exponent."""
    print(f"| {title} | {' | '.join(f'{size:,}' for size in sizes)} | exponent |")
    print("|---" * (len(sizes) + 2) + "|")
    for name in rows[0]:
        values = [max(row[name], 1e-3) for row in rows]
        rise = math.log(values[-1] / values[-2]) / math.log(sizes[-1] / sizes[-2])
        print(f"| {name} | {' | '.join(f'{value:,.1f}' for value in values)} | {rise:.2f} |")
    print(flush=True)


def main() -> None:
    given = [[int(x) for x in word.split(",")] for word in sys.argv[1:]]
    actions, clips = [*given, *([1000, 10_000, 50_000], [500, 2000, 5000])[len(given) :]]
    folder = Path(tempfile.mkdtemp())
    try:
        show("ms, with so many actions", actions, [with_actions(count, folder) for count in actions])
        show("ms, with so many clips", clips, [with_clips(count, folder) for count in clips])
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
