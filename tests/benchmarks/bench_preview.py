"""Milliseconds a frame of the preview draws, without a display: python tests/benchmarks/bench_preview.py
[frames]

Each frame has its own pose, background, grid, shadow and smoothed edges; `glFinish` ends it. Median and
quickest of the frames. "cpu" is the processor time of all threads: what stays the same when the machine is
busy with other things (divide it by the cores software rendering has). "with read" adds the copy of the
picture that a window does not need.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.gltf.reader import read_character  # noqa: E402
from metagraph.motion import rotation  # noqa: E402
from metagraph.motion.skeleton import Pose, Skeleton  # noqa: E402
from preview.camera import Camera  # noqa: E402
from preview.figure import SkinnedFigure, StickFigure  # noqa: E402
from preview.offscreen import Offscreen  # noqa: E402
from preview.scene import Actor, Scene  # noqa: E402


def crowd(skeleton: Skeleton, count: int, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Global transforms `[count, J, ...]` of people who sway out of step, standing in rows."""
    phase = np.arange(count) * 0.7 + seconds * 3
    rotations = np.tile(skeleton.rest_rotations, (count, 1, 1))
    for name, sign in (("LeftUpperArm", 1), ("RightUpperArm", -1)):
        rotations[:, skeleton.index(name)] = rotation.from_axis_angle(
            np.array([0.0, 0, 1]), sign * (0.5 * np.sin(phase) - 0.3)
        )
    translations = np.tile(skeleton.rest_translations, (count, 1, 1))
    side = int(np.ceil(np.sqrt(count)))
    translations[:, 0, 0] += (np.arange(count) % side - (side - 1) / 2) * 0.9
    translations[:, 0, 2] -= (np.arange(count) // side) * 0.9
    return skeleton.globals(Pose(rotations, translations))


def views(figure: SkinnedFigure, rounds: int) -> None:
    """Print what four views of one moment cost beside one as large as all of them, and four apart."""
    skeleton, small = figure.skeleton, (480, 270)
    one, first = Offscreen(960, 540), Offscreen(*small)
    together = [first, *(Offscreen(*small, beside=first) for _ in range(3))]
    apart = [Offscreen(*small) for _ in range(4)]
    took: list[list[float]] = [[], [], []]
    for i in range(rounds + 2):
        scene = Scene((Actor(figure, *crowd(skeleton, 1, i / 30)),))
        camera = Camera().frame(scene.bounds(), 16 / 9)
        for k, some in enumerate(([one], together, apart)):
            start = time.perf_counter()
            for n, offscreen in enumerate(some):
                offscreen.draw(scene, camera.orbit(0.5 * n, 0.0))
            took[k].append(time.perf_counter() - start)
    ms = [float(np.median(t[2:])) * 1e3 for t in took]
    print(f"one view of 960x540 {ms[0]:.1f} ms, four of 480x270 {ms[1]:.1f}, four apart {ms[2]:.1f}")
    for offscreen in (one, *reversed(together), *apart):
        offscreen.release()


def main() -> None:
    frames = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    character = read_character(ROOT / "sample_clips" / "mannequin.glb")
    skeleton = character.skeleton
    figures = {"mannequin": SkinnedFigure(character), "sticks": StickFigure(skeleton)}
    for figure in figures.values():
        figure.simplify()
        print(len(figure.mesh.triangles), "triangles and", *(len(a.mesh.triangles) for a in figure.levels))
    print(
        f"{'figure':10} {'people':>6} {'size':>10} {'draw median':>12} {'quickest':>9} {'cpu':>7} "
        f"{'with read':>10}  ms"
    )
    for size in ((960, 540), (550, 778), (1280, 720)):
        with Offscreen(*size) as offscreen:
            for name, figure in figures.items():
                for count in (1, 10, 100):
                    rounds = max(5, frames // (1 if count == 1 else 2 if count == 10 else 5))
                    camera = Camera().frame(
                        Scene((Actor(figure, *crowd(skeleton, count, 0)),)).bounds(), size[0] / size[1]
                    )
                    drawn, read, used = [], [], []
                    for i in range(rounds + 2):
                        scene = Scene((Actor(figure, *crowd(skeleton, count, i / 30)),))
                        start, busy = time.perf_counter(), time.process_time()
                        offscreen.draw(scene, camera)
                        middle = time.perf_counter()
                        used.append(time.process_time() - busy)
                        offscreen.render(scene, camera)
                        drawn.append(middle - start)
                        read.append(time.perf_counter() - middle)
                    d, r, u = (np.array(taken[2:]) * 1e3 for taken in (drawn, read, used))
                    print(
                        f"{name:10} {count:6} {size[0]:5}x{size[1]:<4} {np.median(d):12.1f} {d.min():9.1f} "
                        f"{np.median(u):7.1f} {np.median(r):10.1f}",
                        flush=True,
                    )
            if size[0] == 960:
                print(
                    f"({offscreen.description}, {len(character.triangles)} triangles, "
                    f"{len(character.positions)} vertices)"
                )
    views(figures["mannequin"], frames)


if __name__ == "__main__":
    main()
