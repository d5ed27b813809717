"""What contacts and the guard do and cost: how deep hands are in the body, how far they slip where they are
held, and what a pose costs with them. `python tests/benchmarks/bench_contacts.py [MINUTES]`

Our sample for an hour of performance (or so many minutes), and clips made by others in `../shared/data`.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from metagraph.formats.imports import import_files
from metagraph.formats.store import open_project
from metagraph.graph.model import Action, Project
from metagraph.graph.touch import Touch
from metagraph.motion import rotation
from metagraph.motion.contact_solve import ContactRig, HandGoal
from metagraph.motion.contact_spans import contact_key, contact_weight
from metagraph.motion.skeleton import Pose
from metagraph.playback.planner import make_plan
from metagraph.playback.posing.contacts import (
    find_hand_goals,
    measure_contact_depths,
    solve_pose_with_contacts,
)
from metagraph.suggest.find_contacts import find_contacts
from tests.posing import contact_rig, pose_at

SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / "sample.metagraph.yaml"
SHARED = Path(__file__).resolve().parents[3] / "shared" / "data"
SETS = (("smartbody-brad", "*.bvh", 60), ("bandai-namco-1", "*.bvh", 60))
FPS = 15.0  # poses of the hour: enough to meet every touch
DEEP = 0.005  # metres: what can be seen
Goals = Sequence[Sequence[HandGoal]]


def measured(rig: ContactRig, pose: Pose, goals: Goals, fps: float) -> tuple[float, float, float, float]:
    """Return the deepest, the 95 % level (both mm), the share of time deeper than DEEP, and how fast held
    hands slip over what they touch, mm/s, on average.
    """
    deep = np.maximum(0, measure_contact_depths(rig, pose).max(-1))
    slips = []
    joints = list(rig.joints)
    part = Pose(pose.rotations, pose.translations)
    for (n, before), (_, after) in pairwise(enumerate(goals)):
        for a in before:
            b = next((g for g in after if g.arm == a.arm and g.to == a.to), None)
            if b is None or min(a.weight, b.weight) < 0.99:
                continue
            off = []
            for frame, goal in ((n, a), (n + 1, b)):
                turned, at = _globals(rig, part, joints, frame)
                hand = at[rig.arms[goal.arm].hand] - at[goal.to]
                off.append(
                    rotation.rotate_vectors(rotation.conjugate(turned[goal.to]), hand) - np.array(goal.at)
                )
            slips.append(float(np.linalg.norm(off[1] - off[0])) * fps)
    slip = float(np.mean(slips)) * 1000 if slips else 0.0
    return float(deep.max()) * 1000, float(np.percentile(deep, 95)) * 1000, float((deep > DEEP).mean()), slip


def _globals(rig: ContactRig, pose: Pose, joints: list[int], frame: int) -> tuple[Any, Any]:
    turned, at = pose.rotations[frame, joints].astype(float), pose.translations[frame, joints].astype(float)
    for n, above in enumerate(rig.parents):
        if above >= 0:
            at[n] = at[above] + rotation.rotate_vectors(turned[above], at[n])
            turned[n] = rotation.multiply(turned[above], turned[n])
    return turned, at


def said(name: str, found: tuple[float, float, float, float]) -> None:
    deepest, level, share, slip = found
    words = f"deepest {deepest:5.1f} mm, 95 % {level:4.1f} mm, {share:6.2%} over 5 mm"
    print(f"  {name:22} {words}, slip {slip:5.1f} mm/s")


def hour(minutes: float) -> None:
    project = open_project(SAMPLE).project
    plan = make_plan(project, 60 * minutes, seed=3)
    ways = (
        ("neither", Touch(False, False, project.touch.parts)),
        ("contacts", Touch(True, False, project.touch.parts)),
        ("contacts and guard", Touch(True, True, project.touch.parts)),
    )
    print(f"the sample, {minutes:g} minutes of performance:")
    rig = contact_rig(project)
    assert rig is not None
    times = np.arange(0, 60 * minutes, 1 / FPS)
    goals = [find_hand_goals(plan, project, rig, t) for t in times.tolist()]
    for name, touch in ways:
        other = replace(project, touch=touch)
        parts = [pose_at(plan, other, some) for some in np.array_split(times, max(1, len(times) // 1000))]
        pose = Pose(*(np.concatenate([getattr(p, f) for p in parts]) for f in ("rotations", "translations")))
        said(name, measured(rig, pose, goals, FPS))
        fine = pose_at(plan, other, np.arange(0, 60, 1 / 120))
        jerks = np.linalg.norm(np.diff(_wrists(project, fine), 2, axis=0), axis=-1) * 120**2
        level, most = np.percentile(jerks, 99.9), jerks.max()
        print(f"  {'':22} wrists' acceleration: 99.9 % {level:.0f} m/s2, most {most:.0f}")
    held = float(times[int(np.argmax([len(g) for g in goals]))])
    free = float(times[next(n for n, g in enumerate(goals) if not g)])
    usual: dict[str, float] = {}
    for name, touch in ways:
        other = replace(project, touch=touch)
        for what, at, rounds in (("free", free, 200), ("held", held, 200), ("600", times[:600], 5)):
            spent = cost(partial(pose_at, plan, other, at), rounds)
            ratio = spent / usual.setdefault(what, spent)
            print(f"  {name:22} hands {what:5} {spent * 1e3:8.2f} ms, {ratio:.2f} times what neither costs")


def _wrists(project: Project, pose: Pose) -> Any:
    assert project.skeleton is not None
    _, at = project.skeleton.globals(pose)
    rig = contact_rig(project)
    assert rig is not None
    return at[:, [rig.joints[arm.hand] for arm in rig.arms]]


def cost(work: Callable[[], Any], times: int = 200) -> float:
    work()
    found = []
    for _ in range(times):
        began = time.perf_counter()
        work()
        found.append(time.perf_counter() - began)
    return float(np.median(found))


def shared(name: str, pattern: str, most: int) -> None:
    folder = SHARED / name
    files = sorted(folder.rglob(pattern))[:most]
    if not files:
        print(f"{name}: not there")
        return
    empty = Project()
    project = import_files(empty, folder, files).into(empty)
    project = replace(project, touch=Touch(True, True))
    rig = contact_rig(project)
    if rig is None:
        print(f"{name}: no arms")
        return
    rows, count, seconds = [], 0, 0.0
    for entry in project.clips.values():
        if entry.motion is None or entry.motion.skeleton != project.skeleton or entry.motion.frames < 10:
            continue
        spans = find_contacts(project, Action(entry.id, entry.id, "gesture", "arms", "", entry.name))
        count, seconds = count + len(spans), seconds + entry.duration
        times = np.arange(entry.motion.frames) / entry.motion.fps
        goals = [
            [
                HandGoal(("left", "right").index(s.hand), rig.places[s.to], k.at, k.turn, w)
                for s in spans
                if s.to in rig.places and (w := contact_weight(s, t, 0.0, entry.duration)) > 1e-6
                for k in (contact_key(s, t),)
            ]
            for t in times.tolist()
        ]
        pose = entry.motion.poses()
        after = solve_pose_with_contacts(pose, rig, goals)
        rows.append([measured(rig, p, goals, entry.motion.fps) for p in (pose, after)] + [[len(times)] * 4])
    found = np.array(rows)
    weight = found[:, 2, :1]
    print(f"{name}: {len(rows)} clips, {seconds:.0f} s, {count} contacts")
    for n, word in enumerate(("as they are", "contacts and guard")):
        means = (found[:, n] * weight).sum(0) / weight.sum()
        said(word, (float(found[:, n, 0].max()), *map(float, means[1:])))  # type: ignore[arg-type]


def main() -> None:
    for one in SETS:
        shared(*one)
    hour(float(sys.argv[1]) if len(sys.argv) > 1 else 60.0)


if __name__ == "__main__":
    main()
