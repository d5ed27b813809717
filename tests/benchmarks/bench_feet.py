"""Whether feet that stand stay where they are while poses blend, and what that costs.
`python tests/benchmarks/bench_feet.py [MINUTES]`

Our sample for an hour of performance (or so many minutes), and projects of clips made by others in
`../shared/data`, as `bench_weight` makes them. A foot stands that the clips which show move slower than 10
mm/s; a step, which has it higher than it would be without, is no slide. Names of sets: only those.
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

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from metagraph.formats.store import open_project
from metagraph.graph.model import Project
from metagraph.playback.plan import Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.foot_slides import (
    RATE,
    SLIDES,
    WINDOW,
    FeetWatch,
    FootState,
    measure_clip_speeds,
    measure_slide_speeds,
)
from tests.benchmarks.bench_weight import FPS, SAMPLE, STANDS, Watched, shared_project
from tests.posing import pose_at, weight_of

SETS = (
    "bandai-namco-1",
    "sumerian-hosts/glTF/animations/adult_male",
    "smartbody-brad",
    "kaykit-rogue",
    "mesh2motion-cmu",
    "fbx-pab",
    "edge-bvh",
)
STEPS = 0.0005  # metres above where it would be: a foot that steps
Array = Any


def gliding(project: Project) -> Project:
    return replace(project, life=msgspec.structs.replace(project.life, planted_feet=0.0))


def slides(plan: Plan, project: Project, times: Array, off: Watched, on: Watched) -> None:
    """Print how fast feet slide that stand, by what plays, without and with, and what steps there are."""
    kind, own = measure_clip_speeds(plan, project, times)
    window = round(WINDOW * FPS)
    stands = own[:-window] < STANDS
    lifted = (on.at - off.at)[..., 1] > STEPS
    total = np.cumsum(lifted, axis=0)
    steps = total[window:] - total[:-window] > 0  # somewhere in the window
    print(f"  feet that stand, mm/s over {WINDOW} s (95 %, most, share over 2):")
    for word in sorted(set(kind)):
        here = (kind[:-window] == word)[:, None] & (kind[window:] == word)[:, None] & stands
        if not here.any():
            continue
        parts = []
        for name, of in (("without", off), ("with", on)):
            ground = here & ~steps if of is on else here
            if not ground.any():
                parts.append(f"{name} all steps")
                continue
            speed = measure_slide_speeds(of.at, FPS)[ground] * 1000
            level, most, over = np.percentile(speed, 95), speed.max(), (speed > 2).mean()
            parts.append(f"{name} {level:.1f} {most:.1f} {over:.2%}")
        share = (here & steps).sum() / here.sum()
        print(
            f"    {word:22} {here.sum() / FPS / here.shape[1]:7.1f} s  "
            + "; ".join(parts)
            + f"; {share:.0%} in steps"
        )
    glide(off, on, lifted)


def glide(off: Watched, on: Watched, lifted: Array) -> None:
    """Print, in windows of 1/20 s of all that plays, how fast feet go over the ground that are not lifted
    where feet are held, and what pops.
    """
    window = 3
    changed = np.abs(on.at - off.at).max(axis=(1, 2)) > 1e-6
    count = changed.mean()
    print(f"  feet are held in {count:.2%} of the time")
    if not changed.any():
        return
    here = changed[:-window] & changed[window:]
    for name, of in (("without", off), ("with", on)):
        level = (of.at[window:] - of.at[:-window])[..., (0, 2)]
        speed = np.linalg.norm(level, axis=-1) / window * FPS * 1000
        ground = here[:, None] & ~(lifted[:-window] | lifted[window:]) if of is on else here[:, None] & True
        some = speed[np.broadcast_to(ground, speed.shape)]
        knees = np.abs(np.diff(of.knees, axis=0)).max() * FPS
        hips = np.linalg.norm(np.diff(of.hips, 2, axis=0), axis=-1) * FPS**2
        print(
            f"    {name}: on the ground {np.percentile(some, (50, 95)).round(1)} mm/s (50, 95 %); "
            f"knees {knees:.0f} degrees/s; hips {np.percentile(hips[changed[1:-1]], 99.9):.1f} m/s2 (99.9 %)"
        )
    rise = (on.at - off.at)[..., 1].max() * 1000
    sink = (off.hips - on.hips)[:, 1].max() * 1000
    aside = np.linalg.norm((off.hips - on.hips)[:, (0, 2)], axis=-1).max() * 1000
    print(f"    feet rise by {rise:.0f} mm at most, hips sink by {sink:.0f} and go {aside:.0f} aside")


def marks(project: Project, plan: Plan, seconds: float) -> None:
    """Print what the window marks: how much of the time feet are held, step and are in the air, and slide."""

    def places(times: Array) -> Array:
        assert project.skeleton is not None
        parts = np.array_split(times, max(1, len(times) // 1000))
        return np.concatenate([project.skeleton.globals(pose_at(plan, project, t))[1] for t in parts])

    seen = FeetWatch(project, places, seconds, plan).at(range(int(seconds * RATE)))
    shares = ", ".join(f"{state.name.lower()} {(seen.states == state).mean():.1%}" for state in FootState)
    held = seen.states == FootState.HELD
    fast = seen.slides[held] * 1000 if held.any() else np.zeros(1)
    share = seen.sliding()[held].mean() if held.any() else 0.0
    print(
        f"  the window marks: {shares}; of what is held {share:.2%} "
        f"slides faster than {SLIDES * 1000:g} mm/s, most {fast.max():.0f}"
    )


def costs(project: Project, plan: Plan, times: Array) -> None:
    """Print what a pose costs with and without: ratios of interleaved rounds."""
    ways = (gliding(project), project)
    for word, chunks in (("one by one", len(times)), ("many at once", 1)):
        took: list[list[float]] = [[], []]
        for _ in range(5):
            for n, way in enumerate(ways):
                began = time.perf_counter()
                for part in np.array_split(times, chunks):
                    pose_at(plan, way, part if chunks == 1 else float(part[0]))
                took[n].append((time.perf_counter() - began) / len(times) * 1e6)
        a, b = (float(np.median(x)) for x in took)
        print(f"  a pose {word}: {a:.0f} us without, {b:.0f} with, {b / a:.2f} times")


def reported(project: Project, plan: Plan, minutes: float) -> None:
    marks(project, plan, 60 * min(minutes, 5.0))
    costs(project, plan, np.arange(5.0, 35.0, 0.1))
    times = np.arange(0, 60 * minutes, 1 / FPS)
    slides(plan, project, times, Watched(plan, gliding(project), times), Watched(plan, project, times))


def main(arguments: Sequence[str]) -> None:
    sets = [a for a in arguments if not a.replace(".", "").isdigit()] or SETS
    minutes = float(next((a for a in arguments if a.replace(".", "").isdigit()), 60))
    for name in sets:
        project = shared_project(name) if name != "sample" else None
        if project is None:
            continue
        if weight_of(project).rig is None:
            print("  no legs to stand on")
            continue
        reported(project, make_plan(project, 120.0, seed=3), 2.0)
    if not arguments or "sample" in arguments or len(sets) == len(SETS):
        project = open_project(SAMPLE).project
        print(f"the sample, {minutes:g} minutes of performance:")
        reported(project, make_plan(project, 60 * minutes, seed=3), minutes)


if __name__ == "__main__":
    main(sys.argv[1:])
