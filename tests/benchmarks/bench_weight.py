"""How far hips go under gestures, whether feet stay, whether knees pop, and what a pose costs with it.
`python tests/benchmarks/bench_weight.py [MINUTES]`

Our sample for an hour of performance (or so many minutes), and projects of clips made by others in
`../shared/data`: the calmest clip is the stance of body and arms, the others are gestures of the arms, a few
of the body, too.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from metagraph.formats.imports import gather, import_files
from metagraph.formats.store import open_project
from metagraph.graph import anatomy, edits
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.playback.plan import Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.foot_slides import (
    SIDES,
    WINDOW,
    find_feet_joints,
    measure_clip_speeds,
    measure_slide_speeds,
)
from tests.posing import pose_at, weight_of

SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / "sample.metagraph.yaml"
SHARED = Path(__file__).resolve().parents[3] / "shared" / "data"
SETS = (
    "smartbody-brad",
    "robot-expressive",
    "kaykit-rogue",
    "bandai-namco-1",
    "sumerian-hosts/glTF/animations/adult_male",
)
MOST = 40  # clips of a set
FPS = 60.0
STANDS = 0.01  # metres a second: a foot that its clip moves slower stands
Array = Any


def stiff(project: Project) -> Project:
    return replace(project, life=msgspec.structs.replace(project.life, follow_through=0.0, shoulder_lift=0.0))


class Watched:
    """What joints do over times `[N]`: hips, feet, knees' angles and hands."""

    def __init__(self, plan: Plan, project: Project, times: Array, alive: bool = True) -> None:
        roles, skeleton = anatomy.project_roles(project), project.skeleton
        assert skeleton is not None
        self.feet = [joint for side in find_feet_joints(project) for joint in side]
        legs = [[roles[f"{s}_{p}"] for p in ("upper_leg", "lower_leg", "foot")] for s in SIDES]
        parts = []
        for some in np.array_split(times, max(1, len(times) // 1000)):
            turned, at = skeleton.globals(pose_at(plan, project, some, alive))
            parts.append(
                (
                    at[:, roles["hips"]],
                    turned[:, roles["hips"]],
                    at[:, self.feet],
                    np.stack([bend(at, leg) for leg in legs], 1),
                )
            )
        self.hips, self.turned, self.at, self.knees = (np.concatenate(x) for x in zip(*parts, strict=True))


def bend(at: Array, leg: Sequence[int]) -> Array:
    """Return how far knees are bent `[N]`, degrees."""
    hip, knee, foot = (at[:, j].astype(float) for j in leg)
    a, b = knee - hip, foot - knee
    size = np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1)
    return np.degrees(np.arccos(np.clip((a * b).sum(-1) / np.maximum(size, 1e-12), -1, 1)))


def travel(plan: Plan, times: Array, on: Watched, off: Watched) -> None:
    """Print how far hips go for each cue of the arms, what feet do and how fast knees bend."""
    far = np.linalg.norm(on.hips - off.hips, axis=-1) * 1000
    turn = np.degrees(rotation.measure_angle_between(on.turned, off.turned))
    cues = [(times >= c.start) & (times < c.end + 0.3) for c in plan.layers["arms"].cues]
    found = np.array([(far[m].max(), turn[m].max()) for m in cues if m.any()] or [(0.0, 0.0)])
    for n, (word, unit) in enumerate((("hips travel", "mm"), ("pelvis turns", "degrees"))):
        quarter, half, more, most = *np.percentile(found[:, n], (25, 50, 90)), found[:, n].max()
        print(
            f"  {word} per cue, {unit}: {quarter:.1f} {half:.1f} {more:.1f} (25, 50, 90 %), most {most:.1f}"
        )
    print(f"  feet moved by it: at most {np.abs(on.at - off.at).max() * 1000:.4f} mm")
    for word, of in (("with", on), ("without", off)):
        speed = np.abs(np.diff(of.knees, axis=0)) * FPS
        jerk = np.abs(np.diff(of.knees, 2, axis=0)).max() * FPS**2
        level = np.percentile(speed, 99.9)
        print(f"  knees {word}: 99.9 % {level:.0f} degrees/s, most {speed.max():.0f}, {jerk:.0f} degrees/s2")


def slides(plan: Plan, project: Project, times: Array, ways: dict[str, Watched]) -> None:
    """Print how fast feet slide that their clip has standing, by what plays."""
    kind, own = measure_clip_speeds(plan, project, times)
    window = round(WINDOW * FPS)
    stands = own[:-window] < STANDS
    print(
        f"  feet that stand (their clip moves them slower than {STANDS * 1000:g} mm/s), mm/s over {WINDOW} s:"
    )
    for word in sorted(set(kind)):
        here = (kind[:-window] == word)[:, None] & (kind[window:] == word)[:, None] & stands
        if not here.any():
            continue
        line = [f"clips {np.mean(own[:-window][here]) * 1000:.1f}"]
        for name, of in ways.items():
            speed = measure_slide_speeds(of.at, FPS)[here] * 1000
            level, most, over = np.percentile(speed, 95), speed.max(), (speed > 2).mean()
            line.append(f"{name} 95 % {level:.1f}, most {most:.1f}, {over:.2%} over 2")
        print(f"    {word:22} {here.sum() / FPS / here.shape[1]:7.1f} s  " + "; ".join(line))


def reported(project: Project, plan: Plan, minutes: float) -> None:
    times = np.arange(0, 60 * minutes, 1 / FPS)
    on, off = Watched(plan, project, times), Watched(plan, stiff(project), times)
    travel(plan, times, on, off)
    slides(plan, project, times, {"composed": Watched(plan, project, times, False), "with life": on})


def costs(project: Project, plan: Plan) -> None:
    """Print what a pose costs with and without, one by one and many at once: ratios of interleaved rounds."""
    times, ways = np.arange(5.0, 35.0, 1 / 30), (stiff(project), project)
    for word, chunks in (("one by one", len(times) // 3), ("many at once", 1)):
        some = times if chunks == 1 else times[::3]
        took: list[list[float]] = [[], []]
        for _ in range(5):
            for n, way in enumerate(ways):
                began = time.perf_counter()
                for part in np.array_split(some, chunks):
                    pose_at(plan, way, part if chunks == 1 else float(part[0]))
                took[n].append((time.perf_counter() - began) / len(some) * 1e6)
        a, b = (float(np.median(x)) for x in took)
        print(f"  a pose {word}: {a:.0f} us without, {b:.0f} with, {b / a:.2f} times")


def hour(minutes: float) -> None:
    project = open_project(SAMPLE).project
    plan = make_plan(project, 60 * minutes, seed=3)
    print(f"the sample, {minutes:g} minutes of performance:")
    costs(project, plan)
    reported(project, plan, minutes)


def upright(at: Array, roles: dict[str, int]) -> float:
    """Return how high hips are above ankles, of the legs' length, on average."""
    parts = [[roles.get(f"{s}_{p}") for p in ("upper_leg", "lower_leg", "foot")] for s in SIDES]
    if any(j is None for leg in parts for j in leg):
        return 0.0
    found = []
    for hip, knee, foot in parts:
        bones = np.linalg.norm(at[:, hip] - at[:, knee], axis=-1) + np.linalg.norm(
            at[:, knee] - at[:, foot], axis=-1
        )
        found.append(float(((at[:, hip, 1] - at[:, foot, 1]) / bones).mean()))
    return min(found)


def shared_project(name: str) -> Project | None:
    """Return a project of a set of clips, none where it is not there."""
    files = gather([SHARED / name])[:MOST] if (SHARED / name).exists() else []
    if not files:
        print(f"{name}: not there")
        return None
    project = import_files(Project(), None, files).into(Project())
    roles, still, high = anatomy.project_roles(project), {}, {}
    for entry in [*project.clips.values()][:MOST]:
        if (
            entry.motion is not None
            and entry.motion.skeleton == project.skeleton
            and entry.motion.frames > 20
        ):
            _, at = entry.motion.skeleton.globals(entry.motion.poses())
            high[entry.id] = upright(at, roles)
            still[entry.id] = float(np.abs(np.diff(at, axis=0)).mean() * entry.motion.fps)
    # Of those that stand: some sit or lie still.
    calm, *others = sorted(still, key=lambda c: (high[c] < 0.85, still[c]))
    for layer in ("body", "arms"):
        project = edits.add_stance(project, layer, "stance", [calm])
        some = others if layer == "arms" else others[:6]
        project = edits.place_clips(project, some, layer, "gesture", [*project.graphs[layer].stances][-1])
    height = project.skeleton.height if project.skeleton is not None else 0.0
    print(f"{name}: {len(still)} clips, {height:.2f} m high")
    return project


def shared(name: str) -> None:
    project = shared_project(name)
    if project is None:
        return
    rig = weight_of(project).rig
    if rig is None:
        print("  no body that answers its arms")
        return
    reported(project, make_plan(project, 120.0, seed=3), 2.0)


def main() -> None:
    for name in SETS:
        shared(name)
    hour(float(sys.argv[1]) if len(sys.argv) > 1 else 60.0)


if __name__ == "__main__":
    main()
