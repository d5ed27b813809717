"""Mimicry: python tests/benchmarks/bench_mimicry.py

A frame of keypoints taken in, in space and in a picture, beside one pose of the character (what every picture
of the preview costs); what beginning costs, reading the sample recordings, and mimicking a minute. Medians of
interleaved rounds.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.keypoints.reader import read_keypoints  # noqa: E402
from metagraph.formats.store import open_project  # noqa: E402
from metagraph.mimicry.keypoint_layouts import KeypointTrack  # noqa: E402
from metagraph.mimicry.mimic import Mimic  # noqa: E402
from metagraph.mimicry.performing import mimic_performance  # noqa: E402
from metagraph.playback.planner import make_plan  # noqa: E402
from tests.posing import pose_at  # noqa: E402

FOLDER = ROOT / "sample_clips" / "keypoints"


def timed(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def main() -> None:
    project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    files = {
        "a picture": FOLDER / "conversation.openpose.json",
        "space": FOLDER / "conversation.mediapipe.jsonl",
    }
    seen = {name: read_keypoints(path) for name, path in files.items()}
    plan = make_plan(project, 60.0)

    def frames(keypoints: KeypointTrack) -> Callable[[], object]:
        mimic, points = Mimic(project), keypoints.points[:, :, : keypoints.dims]
        rows = list(zip(keypoints.times.tolist(), points, keypoints.confidence, strict=True))[:200]
        return lambda: [mimic.feed(t + begin, p, c) for t, p, c in rows]

    begin, rounds = 0.0, dict[str, list[float]]()
    works = {name: frames(keypoints) for name, keypoints in seen.items()}
    for _ in range(15):
        begin += 1000.0
        for name, work in works.items():
            rounds.setdefault(name, []).append(timed(work) / 200)
        rounds.setdefault("pose", []).append(
            timed(lambda: [pose_at(plan, project, n * 0.3) for n in range(100)]) / 100
        )
    pose = statistics.median(rounds["pose"])
    print(f"one pose of the character      {pose * 1e3:8.3f} ms")
    for name in works:
        took = statistics.median(rounds[name])
        print(f"a frame seen in {name:15} {took * 1e3:8.3f} ms   {took / pose:5.2f} of a pose")
    print(
        "beginning to mimic             "
        f"{statistics.median(timed(lambda: Mimic(project)) for _ in range(9)) * 1e3:8.1f} ms"
    )
    for name, path in files.items():
        took = statistics.median(timed(lambda path=path: read_keypoints(path)) for _ in range(5))  # type: ignore[misc]
        print(f"reading {len(seen[name]):5} frames of {name:9} {took * 1e3:8.1f} ms")
    took = statistics.median(timed(lambda: mimic_performance(project, seen["a picture"])) for _ in range(3))
    print(f"mimicking {seen['a picture'].seconds:.0f} s                {took:8.2f} s")


if __name__ == "__main__":
    main()
