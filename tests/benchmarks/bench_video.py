"""Seconds that a video takes, wall and processor: python tests/benchmarks/bench_video.py [seconds] [rounds]

The sample's first performance at 640 x 360 and 30 pictures a second, with its faces: posed, drawn without a
display, read back and encoded as the command `render` does; opening the project is not counted.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from app.cli.render_command import Shot, draw_to, load_figure  # noqa: E402
from app.project.files import SAMPLE  # noqa: E402
from app.project.opening import open_whole  # noqa: E402
from app.stage.playback_source import ShownPlayback  # noqa: E402
from metagraph.playback.planner import make_plan  # noqa: E402

SIZE, RATE = (640, 360), 30


def main(seconds: float = 10.0, rounds: int = 3) -> None:
    project = open_whole(SAMPLE).project
    shown = ShownPlayback(project, make_plan(project, seconds), seconds)
    seen = [(load_figure(project, SAMPLE.parent), shown)]
    walls, used = [], []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds):
            wall, busy = time.perf_counter(), time.process_time()
            draw_to(Path(folder) / "video.mp4", seen, Shot(seconds, SIZE, RATE, 0, "dark"))
            walls.append(time.perf_counter() - wall)
            used.append(time.process_time() - busy)
    print(
        f"video of {seconds:g} s ({rounds} rounds): wall median {statistics.median(walls):.2f} s, quickest "
        f"{min(walls):.2f} s; processor {statistics.median(used):.2f} s"
    )


if __name__ == "__main__":
    main(*(kind(word) for kind, word in zip((float, int), sys.argv[1:], strict=False)))
