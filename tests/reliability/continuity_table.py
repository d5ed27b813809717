"""The largest jump that each stage adds to clips: python tests/reliability/continuity_table.py [MINUTES]

The sample, and the sets of clips in `../shared/data` where they are, labelled as `metagraph label` does; ten
minutes of each, untouched. `playback.continuity` allows a stage 3 cm and 8 degrees in a sixtieth of a second.
In blends a joint may go as fast as in the clips that blend, and as fast as in 99 % of all that plays.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from metagraph.graph.model import Project  # noqa: E402
from metagraph.playback.continuity import RATE, ContinuityLaw  # noqa: E402
from metagraph.playback.evaluator import BLENDS, STAGES, Evaluator  # noqa: E402
from metagraph.playback.planner import make_plan  # noqa: E402

SAMPLE = ROOT / "sample_clips" / "sample.metagraph.yaml"
SHARED = ROOT.parent / "shared" / "data"
SETS = ("bandai-namco-1", "kaykit-rogue", "robot-expressive", "smartbody-brad", "smartbody-rachel")
PIECE, SEED = 30.0, 1  # seconds looked at at once


def largest(project: Project, seconds: float) -> dict[str, tuple[float, float, int]]:
    """Return for each stage the largest way, cm, and turn, degrees, and how often it breaks the law."""
    law, evaluator = ContinuityLaw(project), Evaluator(make_plan(project, seconds, seed=SEED), project)
    out = dict.fromkeys(STAGES, (0.0, 0.0, 0))
    for start in np.arange(0, seconds, PIECE):
        times = np.arange(round(start * RATE) - 1, round(min(start + PIECE, seconds) * RATE)) / RATE
        stages = list(evaluator.stages(times))
        blends = law.blended(evaluator.plan, times, stages[0][1])
        for name, moves in {BLENDS: blends, **law.added(stages)}.items():
            way, turn, often = out[name]
            over = np.flatnonzero(moves.breaks.max(1) > 1)
            events = 1 + int((np.diff(over) > 0.3 * RATE).sum()) if len(over) else 0
            out[name] = (
                max(way, 100 * float(moves.ways.max())),
                max(turn, float(np.degrees(moves.turns.max()))),
                often + events,
            )
    return out


def labelled(name: str, folder: Path) -> Project | None:
    """Return a set as it is labelled; None where it is not there."""
    clips = SHARED / name
    if not clips.is_dir():
        return None
    out = folder / f"{name}.metagraph.yaml"
    words = ["label", str(clips), "-o", str(out), "--play", "0", "--no-pictures"]
    label = [sys.executable, "-m", "app.cli", *words]
    subprocess.run(label, cwd=ROOT, check=True, capture_output=True)
    return open_project(out).project


def main() -> None:
    seconds = 60 * float(sys.argv[1] if len(sys.argv) > 1 else 10)
    print(f"{'set':18}" + "".join(f"{name:>28}" for name in STAGES))
    with tempfile.TemporaryDirectory() as folder:
        for name in ("the sample", *SETS):
            sample = name == "the sample"
            project = open_project(SAMPLE).project if sample else labelled(name, Path(folder))
            if project is None:
                print(f"{name:18}skipped: {SHARED / name} is not there")
                continue
            rows = largest(project, seconds).values()
            cells = (f"{way:.1f} cm {turn:.0f} deg, {often} x" for way, turn, often in rows)
            print(f"{name:18}" + "".join(f"{cell:>28}" for cell in cells), flush=True)


if __name__ == "__main__":
    main()
