"""Many who begin in the same moment: each gets a place of their own, whatever lock was left behind."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from metagraph.research.study.plan.allocation import find_allocation_problems, prepare_allocation
from metagraph.research.study.plan.drawn_orders import LOG
from metagraph.research.study.study_plan import read_study

ROOT = Path(__file__).resolve().parents[4]
PEOPLE, ROUNDS = 8, 4
# Each waits for a line, so that all begin together however long each took to start; so do its rounds.
BEGIN = """
import sys
from pathlib import Path
from metagraph.research.study.plan.allocation import allocate
from metagraph.research.study.study_plan import read_study
for line in sys.stdin:
    folder, who = line.rstrip("\\n").split("\\t")
    allocate(read_study(Path(folder)), who)
    print("done", flush=True)
"""
# Holds a lock and is killed.
KILLED = """
import os, sys
from pathlib import Path
from metagraph.formats.project.kernel_lock import try_hold
held = try_hold(Path(sys.argv[1]))
os.kill(os.getpid(), 9)
"""


@pytest.fixture
def concealed(tiny: Path) -> Path:
    text = tiny.read_text()
    before = next(line for line in text.splitlines() if line.startswith("participants:"))
    tiny.write_text(text.replace(before, f"participants: {PEOPLE}") + "order: concealed\n")
    return tiny


@pytest.fixture(scope="module")
def people() -> Iterator[list[subprocess.Popen[str]]]:
    """Processes of people who wait for the folder in which they begin."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    found = [subprocess.Popen([sys.executable, "-c", BEGIN], cwd=ROOT, **pipes) for _ in range(PEOPLE)]
    try:
        yield found
    finally:
        for process in found:
            process.kill()
            process.communicate()


@pytest.mark.nightly
@pytest.mark.parametrize("left", ["nothing", "a stale lock", "a lock of a process that was killed"])
def test_eight_who_begin_at_once_have_eight_places(
    concealed: Path, people: list[subprocess.Popen[str]], left: str
) -> None:
    for n in range(ROUNDS):
        folder = concealed.parent / f"round {n}"
        folder.mkdir()
        (folder / concealed.name).write_bytes(concealed.read_bytes())
        for part in concealed.parent.iterdir():
            if part.is_file() and part != concealed:
                (folder / part.name).write_bytes(part.read_bytes())
        study = read_study(folder / concealed.name)
        prepare_allocation(study)
        lock = folder / f".{LOG}.lock"
        if left == "a stale lock":
            lock.touch()
        elif left != "nothing":
            subprocess.run([sys.executable, "-c", KILLED, str(lock)], cwd=ROOT, timeout=60, check=False)
            assert lock.exists()
        for process, who in zip(people, study.plan.ids, strict=True):
            assert process.stdin is not None
            process.stdin.write(f"{folder}\t{who}\n")
        for process in people:
            assert process.stdin is not None
            process.stdin.flush()
        assert [p.stdout.readline() if p.stdout else "" for p in people] == ["done\n"] * PEOPLE
        notes = [json.loads(line) for line in (folder / LOG).read_text().splitlines()]
        assert sorted(note["place"] for note in notes) == list(range(PEOPLE))
        assert sorted(note["participant"] for note in notes) == sorted(study.plan.ids)
        assert find_allocation_problems(study) == [] and not lock.exists()
