"""How moods show: whether people could tell, by measures of movement from the literature.

    .venv/bin/python tests/benchmarks/bench_moods.py [PROJECT]

The sample project, or another. Over seeds, two minutes of a character that talks, in five steps of arousal
at no valence, and of valence at no arousal: the hands' mean speed, acceleration and jerk seen from the chest
(what goes with arousal in Pollick et al. 2001), how far from their stance they are when a gesture plays
(extent, as in Laban's kinesphere; Wallbott 1998), how high, gestures a minute, how far the head hangs
(Roether et al. 2009), breaths and blinks a minute. Printed are the medians of the seeds, Spearman's rho over
all seeds, and the effect size of the two ends (Cohen's d). Then how far strokes that were asked for are from
their time, in each mood.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from metagraph.formats.store import open_project
from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.graph.requests import Feel, Gesture
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import hear_asks
from metagraph.playback.planning.mood import MOODS
from metagraph.playback.planning.running_plan import improvise
from metagraph.playback.timing.phases import find_phases
from tests.posing import pose_at

SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / "sample.metagraph.yaml"
STEPS = (-1.0, -0.5, 0.0, 0.5, 1.0)
SEEDS, SECONDS, FPS = 6, 120.0, 30
MEASURES = {
    "hands' speed": "m/s",
    "acceleration": "m/s2",
    "jerk": "m/s3",
    "extent": "m",
    "height": "m",
    "gestures": "/min",
    "head forward": "degrees",
    "breaths": "/min",
    "blinks": "/min",
}


def feeling(project: Project, valence: float, arousal: float) -> Project:
    """Return the project in a mood."""
    return replace(project, life=msgspec.structs.replace(project.life, valence=valence, arousal=arousal))


def measured(project: Project, seed: int) -> list[float]:
    """Return what `MEASURES` names of two minutes of a character that talks: only then it gestures."""
    plan = improvise(project, SECONDS, seed, "talking")
    times = np.arange(0, SECONDS, 1 / FPS)
    skeleton, roles = project.skeleton, anatomy.project_roles(project)
    assert skeleton is not None
    turned, at = skeleton.globals(pose_at(plan, project, times))
    arms = plan.layers["arms"]
    resting = replace(plan, layers={**plan.layers, "arms": replace(arms, cues=())})
    under = skeleton.globals(pose_at(resting, project, times))[1]
    chest = next(roles[r] for r in ("upper_chest", "chest", "spine") if r in roles)
    hands = [roles[f"{side}_hand"] for side in ("left", "right")]
    seen = at[:, hands] - at[:, [chest]]
    steps = [np.linalg.norm(np.diff(seen, n, axis=0) * FPS**n, axis=-1).mean() for n in (1, 2, 3)]
    gestures = [c for c in arms.cues if c.action.kind == "gesture"]
    during = np.any(
        [(times > c.start + c.blend_in) & (times < c.end - c.blend_out) for c in gestures], axis=0
    )
    away = np.linalg.norm(at[:, hands] - under[:, hands], axis=-1).max(-1)
    head = roles["head"]
    rest = skeleton.globals(anatomy.get_base_pose(project))[0][head]
    up = _rotated(turned[:, head], _rotated(_back(rest), np.array([0.0, 1.0, 0.0])))
    return [
        *steps,
        float(away[during].mean()) if during.any() else 0.0,
        float(seen[during][..., 1].mean()) if during.any() else 0.0,
        len(gestures) / SECONDS * 60,
        float(np.degrees(np.arctan2(up[:, 2], up[:, 1])).mean()),
        len(plan.life.breaths) / SECONDS * 60,
        len(plan.life.blinks) / SECONDS * 60,
    ]


def _back(q: Any) -> Any:
    return q * np.array([-1, -1, -1, 1])


def _rotated(q: Any, v: Any) -> Any:
    t = 2 * np.cross(q[..., :3], v)
    return v + q[..., 3:] * t + np.cross(q[..., :3], t)


def spearman(x: Any, y: Any) -> float:
    """Return the correlation of ranks; those of equal values are their mean."""

    def ranks(values: Any) -> Any:
        values = np.asarray(values)
        return ((values[:, None] > values).sum(1) + (values[:, None] >= values).sum(1)) / 2

    a, b = ranks(x), ranks(y)
    return float(np.corrcoef(a, b)[0, 1]) if np.ptp(a) and np.ptp(b) else 0.0


def swept(project: Project, of: str) -> None:
    """Print the measures over arousal, or over valence."""
    found = np.array([
        [measured(feeling(project, *((0.0, x) if of == "arousal" else (x, 0.0))), seed) for seed in
        range(SEEDS)] for x in STEPS
    ])  # fmt: skip
    print(f"\n| by {of} | {' | '.join(f'{x:g}' for x in STEPS)} | rho | d |\n|---|{'---|' * 7}")
    for k, (name, unit) in enumerate(MEASURES.items()):
        values = found[:, :, k]
        rho = spearman(np.repeat(STEPS, SEEDS), values.ravel())
        spread = np.sqrt((values[0].var(ddof=1) + values[-1].var(ddof=1)) / 2)
        d = (values[-1].mean() - values[0].mean()) / max(spread, 1e-9)
        medians = " | ".join(f"{x:.3g}" for x in np.median(values, 1))
        print(f"| {name}, {unit} | {medians} | {rho:+.2f} | {d:+.1f} |")


def strokes(project: Project) -> None:
    """Print how far from their times strokes are that nothing keeps from being on time."""
    print("\n| mood | strokes | off by, ms (mean) | at most |\n|---|---|---|---|")
    for name in MOODS:
        off = []
        for seed in range(4):
            asks = [Gesture(id=f"g{n}", stroke=6.0 + 7.0 * n) for n in range(16)]
            mood = Feel(id="mood", at=0.0, mood=name)  # type: ignore[arg-type]
            plan = hear_asks(project, Plan(seed, 0.0), 0.0, [mood, *asks], 125.0, idle=False)
            for cue in plan.layers["arms"].cues:
                if cue.meta.startswith("g"):
                    late = cue.start + (find_phases(project, cue.action).stroke - cue.entry) / cue.tempo
                    off.append(abs(late - (6.0 + 7.0 * int(cue.meta[1:]))))
        if off:
            print(f"| {name} | {len(off)} | {1000 * np.mean(off):.2f} | {1000 * max(off):.2f} |")


def main() -> None:
    project = open_project(Path(sys.argv[1]) if len(sys.argv) > 1 else SAMPLE).project
    print(f"{project.name}: {SEEDS} seeds of {SECONDS:.0f} s")
    swept(project, "arousal")
    swept(project, "valence")
    strokes(project)


if __name__ == "__main__":
    main()
