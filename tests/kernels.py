"""Compiles what is compiled when first called, once for all processes that test: `python -m tests.kernels`.

Processes that compile the same kernels at once would leave a cache that crashes both, from then on. So it is
made once, kept under the state of what is compiled, and each process is given a copy of its own.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from importlib import metadata
from pathlib import Path

from metagraph.uncollected import uncollected

ROOT = Path(__file__).resolve().parents[1]
HOME = ROOT / ".pytest_cache" / "numba"
PATTERNS = (
    *("kernels.py", "*_kernels.py", "wander.py", "*solve.py", "plain_vectors.py"),
    *("laying.py", "compiling.py", "object_*.py"),
)
LOOPS = "loops"  # a folder within: object code


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
            env={**os.environ, "NUMBA_CACHE_DIR": scratch, "METAGRAPH_LOOP_CACHE": f"{scratch}/{LOOPS}"},
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
    from app.features.motion_graph.synthesis_jobs import Wish, synthesise, takes_of, usable
    from metagraph import keep_loops, object_code
    from metagraph.formats import bvh, bvh_kernels
    from metagraph.formats.store import open_project
    from metagraph.playback import loops
    from metagraph.playback.crowd import Crowd
    from metagraph.playback.planner import make_plan
    from metagraph.synthesis.constraints import heard
    from metagraph.synthesis.extending import PathExtender, driver_graph
    from metagraph.synthesis.graph import build
    from metagraph.synthesis.states import states_of

    for known in keep_loops.ALL:
        assert known.keep(by_numba=True) or not object_code.usable()
    project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    with tempfile.TemporaryDirectory() as folder:
        bvh.COMPILED.now = bvh_kernels  # else only large files need it
        bvh.write_bvh(
            next(clip.motion for clip in project.clips.values() if clip.motion), Path(folder) / "a.bvh"
        )
        bvh.read_bvh(Path(folder) / "a.bvh")
    loops.load()
    crowd = Crowd(project, [make_plan(project, 5.0)])
    crowd.poses(1.0)
    crowd.globals(1.0)
    takes = takes_of(project, [i for i in usable(project) if project.clips[i].name.endswith("__stance")])
    graph = build(states_of(takes.clips))
    synthesise(graph, takes, Wish(4.0, ()), "new")
    PathExtender(driver_graph(graph, heard(graph.states, [() for _ in takes.clips]))).step()


if __name__ == "__main__":
    with uncollected():  # a fifth of the time was looking for circles in what LLVM is told
        compile_all() if sys.argv[1:] == ["here"] else make()
