"""Exports of clips nobody here made: their vectors hold for the library and in JavaScript, odd skeletons and
faces included.
"""

from __future__ import annotations

import shutil
import subprocess
from itertools import cycle
from pathlib import Path

import pytest

from metagraph import engines
from metagraph.engines.export import write_project_files
from metagraph.engines.reading import read_export
from metagraph.engines.vectors import check_vectors, list_cases, write_vectors
from metagraph.formats.imports import gather, import_files
from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Kind, Project
from tests.thorough import many

RUNNER = Path(engines.__file__).with_name("runtimes") / "javascript" / "conformance.mjs"
PLACED: tuple[tuple[Kind, bool, bool, int], ...] = (  # kind, from the first stance, to the other, how many
    ("gesture", True, False, 5),
    ("fidget", True, False, 2),
    ("transition", True, True, 1),
    ("transition", False, True, 1),
    ("gesture", False, False, 2),
)


def project_of(files: list[Path], name: str) -> Project:
    """Return a project with two stances a layer, whatever the clips show."""
    project = import_files(Project(name), None, files).into(Project(name))
    clips = [
        i for i, e in project.clips.items() if e.motion is not None and e.motion.skeleton == project.skeleton
    ]
    take = cycle(clips)
    for layer in LAYERS:
        for stance in ("rest", "other"):
            project = edits.add_stance(project, layer, stance, [next(take)])
        a, b = project.graphs[layer].stances
        for kind, first, leads, count in PLACED:
            here, there = (a, b) if first else (b, a)
            project = edits.place_clips(
                project, [next(take) for _ in range(count)], layer, kind, here, there if leads else None
            )
    return project


REAL = [
    ("sumerian-hosts", "adult_male"),
    ("sumerian-hosts", "alien"),
    ("kaykit-rogue", ""),
    ("robot-expressive", ""),
    ("bandai-namco-1", ""),
]
# Spaces in names, other letters, neither fingers nor toes; the other characters are no other to an export.
ZOO = ["biped", "japanese", "bare"]
# Each skeleton has so many-th case, from another on: every second case is tried on one of the eight.
SHARE = many(16, 3)


@pytest.mark.nightly
@pytest.mark.parametrize(("folder", "pattern"), REAL)
def test_vectors_of_real_clips_hold(shared_data: Path, tmp_path: Path, folder: str, pattern: str) -> None:
    files = [path for path in gather([shared_data / folder]) if pattern in path.as_posix()]
    vectors_hold(project_of(files, f"{folder}{pattern}"), tmp_path, REAL.index((folder, pattern)))


@pytest.mark.nightly
@pytest.mark.parametrize("name", ZOO)
def test_vectors_of_the_zoo_hold(zoo_files: dict[str, Path], tmp_path: Path, name: str) -> None:
    vectors_hold(project_of([zoo_files[name]], name), tmp_path, len(REAL) + ZOO.index(name))


def vectors_hold(project: Project, tmp_path: Path, number: int) -> None:
    """The number is the project's among all here."""
    made = write_project_files(project, tmp_path)
    every = list(list_cases(read_export(made.json, resolved=True)))
    assert len(every) > 100
    write_vectors(made.json, every[number % SHARE :: SHARE])
    assert check_vectors(tmp_path).failures == []
    if shutil.which("node") is None:
        pytest.skip("needs Node")
    done = subprocess.run(["node", str(RUNNER), str(tmp_path)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout[-1000:]
