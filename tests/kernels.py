"""Compiles what is compiled when first called, once for all processes that test: `python -m tests.kernels`.

Processes that compile the same kernels at once would leave a cache that crashes both, from then on. So it is
made once, kept under the state of what is compiled, and each process is given a copy of its own.
"""

from __future__ import annotations

import contextlib
import gc
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HOME = ROOT / ".pytest_cache" / "numba"
PATTERNS = ("kernels.py", "*_kernels.py", "compiling.py")


def kept() -> Path:
    """Return the folder of the cache for the sources as they are: numba looks at their times and sizes."""
    sources = sorted(path for pattern in PATTERNS for path in (ROOT / "metagraph").rglob(pattern))
    state = [f"{path} {path.stat().st_mtime_ns} {path.stat().st_size}" for path in [*sources, Path(__file__)]]
    state += [sys.version, *(metadata.version(name) for name in ("numba", "numpy"))]
    return HOME / hashlib.sha256("\n".join(state).encode()).hexdigest()[:16]


def make() -> Path:
    """Compile into the folder of the cache where it is not there yet, and return it; older ones go."""
    found = kept()
    if not found.is_dir():
        for old in HOME.glob("?" * len(found.name)):
            shutil.rmtree(old, ignore_errors=True)
        HOME.mkdir(parents=True, exist_ok=True)
        scratch = tempfile.mkdtemp(dir=HOME)
        subprocess.run(
            [sys.executable, "-m", "tests.kernels", "here"],
            cwd=ROOT,
            env={**os.environ, "NUMBA_CACHE_DIR": scratch},
            check=True,
            timeout=900,
        )
        with contextlib.suppress(OSError):  # another was faster
            Path(scratch).rename(found)
    return found


def provide(name: str) -> Path:
    """Return a folder of that name with a copy of the cache, as far as it was made."""
    own, found = HOME / name, kept()
    stamp = own / f"of-{found.name}"
    if found.is_dir() and not stamp.exists():
        shutil.rmtree(own, ignore_errors=True)
        shutil.copytree(found, own, dirs_exist_ok=True)
        stamp.touch()
    return own


def compile_all() -> None:
    """Call everything that is compiled."""
    from app.features.motion_graph.synthesis_jobs import Wish, choose_takes, list_usable_clips, synthesise
    from metagraph.formats.store import open_project
    from metagraph.synthesis.constraints import find_heard_at
    from metagraph.synthesis.extending.path import PathExtender, make_driver_graph
    from metagraph.synthesis.graph import build_graph
    from metagraph.synthesis.states import read_states

    project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    takes = choose_takes(
        project, [i for i in list_usable_clips(project) if project.clips[i].name.endswith("__stance")]
    )
    graph = build_graph(read_states(takes.clips))
    synthesise(graph, takes, Wish(4.0, ()), "new")
    PathExtender(make_driver_graph(graph, find_heard_at(graph.states, [() for _ in takes.clips]))).step()
    compile_searches()


def compile_searches() -> None:
    """Search with all that motion may be asked to have."""
    from metagraph.synthesis.graph import build_graph
    from tests.synthesis.test_blocks import LIMIT, made
    from tests.synthesis.test_iconic_words import (
        test_motion_comes_from_around_the_word_in_the_take,
        test_words_that_must_be_met_are_and_are_given_up_last_but_one,
    )

    build_graph(made(200), LIMIT, most=7)
    test_motion_comes_from_around_the_word_in_the_take()
    test_words_that_must_be_met_are_and_are_given_up_last_but_one()


if __name__ == "__main__":
    gc.disable()  # a fifth of the time is looking for circles in what LLVM is given
    compile_all() if sys.argv[1:] == ["here"] else make()
