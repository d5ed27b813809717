"""Every task with a peer in one table, measured in turns: python tests/benchmarks/bench_peers.py [rounds]
[files] [synthesis] [exporting] [windows] [drawing]

Words choose groups of rows. Peers are used where they can be imported: pip install upc-pymotion bvh bvhio
pygltflib cmeel-assimp orjson; what is not there is said. Each round runs both sides of a row once, one after
the other; medians, and the ratio of the medians: above 1 we are faster. Import and compile times are counted
on both sides or on neither. ozz-animation is no package: it is built from its source by hand (-O3
-march=native), and its rows stand in the README of this folder.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]

import bench_export_size  # noqa: E402
import bench_formats  # noqa: E402
import bench_motion_graph  # noqa: E402
from bench_preview import crowd as standing  # noqa: E402

from metagraph.engines.export_document import to_document  # noqa: E402
from metagraph.formats.bvh.file import read_bvh  # noqa: E402
from metagraph.formats.gltf.reader import read_character, read_gltf_clips, write_glb  # noqa: E402
from metagraph.formats.gltf.writer import Keys  # noqa: E402

Work = Callable[[], object]
SAMPLE = ROOT / "sample_clips" / "sample.metagraph.yaml"
STARTED = "import time, sys; started = float(sys.argv[1]); "


@dataclass
class Row:
    """ours, theirs: what runs, or returns seconds that it took by itself. each: what a run is divided by."""

    task: str
    ours_holds: str
    peer: str
    peer_holds: str
    ours: Work
    theirs: Work | None
    each: float = 1.0


def seconds(work: Work) -> float:
    """Return what a run took; what returns seconds was timed within."""
    begun = time.perf_counter()
    result = work()
    return result if isinstance(result, float) else time.perf_counter() - begun


def process(code: str, *arguments: str) -> Work:
    """Return what starts a Python process and waits for it."""

    def run() -> None:
        subprocess.run([sys.executable, "-c", code, *arguments], cwd=ROOT, check=True, capture_output=True)

    return run


def painted(code: str) -> Work:
    """Return what starts a window and returns the seconds it printed first."""

    def run() -> float:
        command = [sys.executable, "-c", code, str(time.time())]
        done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True, timeout=120)
        return float(done.stdout.split()[-3])

    return run


def files(folder: Path) -> Iterator[Row]:
    path, what = bench_formats.long_bvh(folder)
    readers = bench_formats.bvh_readers(path)
    limit, ours, *peers = readers.items()
    read_bvh(path)
    for name, reader in [*peers, limit]:
        peer, _, holds = name.partition(": ")
        own_holds = "names, rests, float32 quaternions, checks"
        yield Row(f"BVH, 10,000 frames ({what}), warm", own_holds, peer, holds, ours[1], reader)
    own = process(
        "import sys; from metagraph.formats.bvh.file import read_bvh; read_bvh(sys.argv[1])", str(path)
    )
    code = "import sys, pymotion.io.bvh as b; f = b.BVH(); f.load(sys.argv[1]); f.get_data()"
    other = process(code, str(path)) if "upc-pymotion: quaternions" in readers else None
    yield Row(
        "the same, a process from start to end", "imports and reading", "upc-pymotion", "the same", own, other
    )
    clip, some = bench_formats.invented(96), []
    for i in range(60):
        some.append(folder / f"clip{i}.glb")
        write_glb(some[-1], [clip.renamed(f"clip{i}")], keys=Keys(quantize=False, tolerance=0))
    limit, ours, *peers = bench_formats.glb_readers(some).items()
    for name, reader in [*peers, limit]:
        peer, _, holds = name.partition(" + ")
        yield Row("GLB, 60 files of one clip, a clip", "clips, resampled", peer, holds, ours[1], reader, 60)
    for name in ("kaykit-rogue", "sumerian-hosts"):
        real = sorted((bench_formats.DATA / name).rglob("*.glb"))
        count = sum(len(read_gltf_clips(p)) for p in real)
        limit, ours, *peers = bench_formats.glb_readers(real).items()
        for reader_name, reader in [*peers, limit] if real else ():
            peer, _, holds = reader_name.partition(" + ")
            own_holds = "clips, resampled, checks; no mesh"
            task = f"GLB, {count} clips of {name}, a clip"
            yield Row(task, own_holds, peer, holds, ours[1], reader, count)


def synthesis() -> Iterator[Row]:
    states = bench_motion_graph.synthetic(50_568)
    keys = bench_motion_graph.key_states(states)
    for share, words in ((0.11, "11 %"), (0.01, "1 %")):
        limit = bench_motion_graph.limit_for(states, keys, share)
        given = bench_motion_graph.Threshold(3, 0.95, np.zeros(0), None, limit, limit)
        plain = bench_motion_graph.straightforward(states, keys, limit)
        some = keys[np.linspace(0, len(keys) - 1, 3).astype(int)]

        def theirs(plain: Any = plain, some: Any = some) -> float:
            begun = time.perf_counter()
            plain(some)
            return (time.perf_counter() - begun) * len(keys) / len(some)

        ours = partial(bench_motion_graph.build, states, given, keys)
        ours()
        yield Row(
            f"motion graph of 50,568 frames, {words} of pairs (published: 47.94 s)",
            "transitions, largest component",
            "NumPy as the paper says, by 3 rows",
            "transitions",
            ours,
            theirs,
        )


def exporting() -> Iterator[Row]:
    project = bench_export_size.project(10_000)
    names = tuple(entry.name for entry in project.clips.values())

    def written(listed: bool) -> bytes:
        return msgspec.json.encode(to_document(project, "size.glb", names, listed))

    plain = json.loads(written(True))  # as one would keep it: dictionaries and lists
    try:
        import orjson
    except ImportError:
        orjson = None
    holds = "the machine, every connection"
    for task, listed in (("export of 10,000 actions", False), ("the same, its machine listed", True)):
        ours = partial(written, listed)
        ours_holds = "document made of the project, text"
        yield Row(task, ours_holds, "json.dumps of what is made", holds, ours, partial(json.dumps, plain))
        theirs = None if orjson is None else partial(orjson.dumps, plain)
        yield Row(task, ours_holds, "orjson of what is made", holds, ours, theirs)


LABEL = (
    STARTED + "from PySide6.QtWidgets import QApplication, QLabel\nfrom PySide6.QtCore import QTimer\n"
    "app = QApplication([])\n"
    "class Label(QLabel):\n"
    "    def paintEvent(self, event):\n"
    "        super().paintEvent(event); t = time.time() - started; print(t, t, 0, flush=True)\n"
    "        QTimer.singleShot(0, app.quit)\n"
    "label = Label('x'); label.resize(1680, 1020); label.show(); app.exec()\n"
)


def windows() -> Iterator[Row]:
    if not os.environ.get("DISPLAY"):
        print("(the cold start needs a screen: xvfb-run)")
        return
    from bench_window import COLD

    words = ("cold start to the first painted window", "imports, the whole window, the sample")
    yield Row(*words, "one label, PySide6", "nothing", painted(COLD), painted(LABEL))


BARE = "#version 330 core\nout vec4 o_color;\nvoid main() { o_color = vec4(0.5, 0.5, 0.5, 1.0); }\n"


def drawing() -> Iterator[Row]:
    import moderngl

    from preview import shaders
    from preview.camera import Camera
    from preview.drawing import set_uniforms
    from preview.figure import SkinnedFigure
    from preview.offscreen import Offscreen
    from preview.scene import Actor, Scene

    figure = SkinnedFigure(read_character(ROOT / "sample_clips" / "mannequin.glb"))
    offscreen = Offscreen(960, 540)
    for count in (1, 10):
        actors = [Actor(figure, *standing(figure.skeleton, count, n / 30)) for n in range(30)]
        camera = Camera().frame(Scene((actors[0],)).bounds(), 960 / 540)

        def ours(actors: Any = actors, camera: Any = camera) -> None:
            for actor in actors:
                offscreen.draw(Scene((actor,)), camera)

        def bare(actors: Any = actors, camera: Any = camera) -> None:
            renderer, target = offscreen.renderer, offscreen._fbo
            pass_ = renderer._drawing
            with offscreen._ctx:
                program = pass_.program("bare", shaders.DEPTH_VERTEX, BARE)
                matrix = camera.projection(960 / 540) @ camera.view()
                for actor in actors:
                    (row,) = pass_.store.prepare([actor], [figure.mesh])
                    pass_.state(target, (0, 0, 960, 540), moderngl.DEPTH_TEST)
                    target.clear(depth=1.0)
                    pass_.store.palette.use(0)
                    set_uniforms(program, u_matrix=matrix, u_palette=0, u_row=row)
                    pass_.triangles(figure.mesh, actor, program, "depth")
                    offscreen._ctx.finish()

        yield Row(
            f"preview, {count} of 14,794 triangles, 960 x 540",
            "lights, shadows, ground, smoothing",
            "bare instanced draw",
            "skinned, one colour",
            ours,
            bare,
            len(actors),
        )


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    wanted = sys.argv[2:]
    with tempfile.TemporaryDirectory() as temporary:
        groups = (files(Path(temporary)), synthesis(), exporting(), windows(), drawing())
        names = ("files", "synthesis", "exporting", "windows", "drawing")
        print(
            "| task | ours has | peer | the peer has | ours | peer | ratio |\n|---|---|---|---|---|---|---|"
        )
        for name, rows in zip(names, groups, strict=True):
            if wanted and name not in wanted:
                continue
            for row in rows:
                one = [
                    [seconds(row.ours), seconds(row.theirs) if row.theirs else np.nan] for _ in range(rounds)
                ]
                ours, theirs = (statistics.median(side) / row.each for side in zip(*one, strict=True))
                peer = f"{1e3 * theirs:,.3g} ms" if row.theirs else "not installed"
                ratio = f"{theirs / ours:.2f}" if row.theirs else ""
                print(
                    f"| {row.task} | {row.ours_holds} | {row.peer} | {row.peer_holds} | "
                    f"{1e3 * ours:,.3g} ms | {peer} | {ratio} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
