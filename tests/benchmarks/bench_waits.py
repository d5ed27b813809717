"""What a user waits for, by the clock and in processor time: python tests/benchmarks/bench_waits.py [CLIPS]

Each row is a whole process, as a user starts it, in the home of a new user; "first" is when the first result
was there. The rows of the window, of motion graphs and of growth come from other scripts, which print below.
CLIPS is how many clips are labelled and imported, 500 unless said; with fewer than 100, videos are short too,
and the other scripts are left out.
"""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
SAMPLE = ROOT / "sample_clips" / "sample.metagraph.yaml"
MORE = (("bench_window.py",), ("bench_library.py",), ("bench_motion_graph.py", "first"), ("bench_growth.py",))


@dataclass(frozen=True)
class Wait:
    """What took how long. wall, processor, first: seconds; processor is of the process and those it started,
    first until the first result, None if there is but one.
    """

    name: str
    wall: float
    processor: float
    first: float | None = None


def make_clips(folder: Path, count: int) -> Path:
    """Write so many clips, each a file, no two alike; return the folder."""
    from dataclasses import replace

    from metagraph.formats.gltf.writer import write_glb
    from metagraph.formats.store import open_project

    folder.mkdir()
    own = [e for e in open_project(SAMPLE).project.clips.values() if e.motion is not None]
    for n in range(count):
        entry, shift = own[n % len(own)], n // len(own)
        assert entry.motion is not None
        rolled = replace(entry.motion, rotations=np.roll(entry.motion.rotations, shift, 0), name=entry.name)
        write_glb(folder / f"{entry.name}_v{shift + 1}.glb", [rolled])
    return folder


def measure(name: str, home: Path, *words: object, first: str = "", numba: bool = True) -> Wait:
    """Run `metagraph` with words in a home of its own, and return what it took. first: what the first result
    has in its words. numba: whether it may be imported. Raises CalledProcessError if it fails; 3, which says
    that something needs a look, is no failure.
    """
    environ = {**os.environ, "XDG_CACHE_HOME": str(home / "cache"), "XDG_DATA_HOME": str(home / "data")}
    if not numba:
        blocked = home / "blocked"
        blocked.mkdir(exist_ok=True)
        (blocked / "numba.py").write_text("raise ImportError('left out')\n")
        environ["PYTHONPATH"] = os.pathsep.join((str(blocked), str(ROOT)))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.perf_counter()
    command = [sys.executable, "-m", "app.cli", *map(str, words)]
    came = None
    with (
        tempfile.TemporaryFile("w+") as told,
        subprocess.Popen(
            command, cwd=ROOT, env=environ, stdout=subprocess.PIPE, stderr=told, text=True
        ) as process,
    ):
        assert process.stdout is not None
        for line in process.stdout:
            if first and first in line and came is None:
                came = time.perf_counter() - begin
        if process.wait() not in (0, 3):
            told.seek(0)
            print(told.read()[-2000:], file=sys.stderr)
            raise subprocess.CalledProcessError(process.returncode, command)
    wall = time.perf_counter() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)
    return Wait(name, wall, spent, came)


def measure_commands(folder: Path, count: int) -> Iterator[Wait]:
    """Yield what each command takes."""
    seconds = 30 if count >= 100 else 1
    clips, home = make_clips(folder / "clips", count), folder / "home"
    home.mkdir()
    labelled = folder / "labelled.metagraph.yaml"
    imported = folder / "imported.metagraph.yaml"
    yield measure("check the sample, the first time", home, "check", SAMPLE)
    yield measure("check the sample, later", home, "check", SAMPLE)
    yield measure(f"import {count} GLBs", home, "import", imported, clips)
    label = ("label", clips, "-o", labelled, "--no-pictures")
    yield measure(f"label {count} GLBs, then play them", home, *label, first="labelled in")
    yield measure(f"check {count} clips", home, "check", labelled)
    yield measure(
        f"check {count} clips, played for {2 * seconds} s", home, "check", labelled, "--play", 2 * seconds
    )
    yield measure(f"label {count} GLBs again", home, *label)
    yield measure("export the sample", home, "export", SAMPLE, "-o", folder / "export")
    video = ("--size", "1280x720", "--seconds", seconds)
    yield measure(f"video of {seconds} s, 1280x720", home, "render", SAMPLE, "-o", folder / "a.mp4", *video)
    one = ("reproduce", "--into", folder / "exhibits")
    if count >= 100:
        yield measure("reproduce the papers' exhibits", home, *one, first="growth: ")
        yield measure("the same without numba", home, *one[:-1], folder / "plain", numba=False)


def main() -> int:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    print(f"load average {os.getloadavg()[0]:.1f}, {len(os.sched_getaffinity(0))} cores")
    print("| wait | seconds | processor | first |\n|---|---|---|---|")
    folder = Path(tempfile.mkdtemp())
    try:
        for wait in measure_commands(folder, count):
            first = "" if wait.first is None else f"{wait.first:.1f}"
            print(f"| {wait.name} | {wait.wall:.1f} | {wait.processor:.1f} | {first} |", flush=True)
    finally:
        shutil.rmtree(folder)
    if count >= 100:
        for words in MORE:
            print(f"\n{' '.join(words)}", flush=True)
            script = Path(__file__).with_name(words[0])
            screen = ("xvfb-run", "-a") if words[0] == "bench_library.py" and shutil.which("xvfb-run") else ()
            subprocess.run([*screen, sys.executable, str(script), *words[1:]], cwd=ROOT)
    return 0


if __name__ == "__main__":
    sys.exit(main())
