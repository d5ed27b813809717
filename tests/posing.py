"""Poses and rigs of plans and projects, asked for by plain calls: an evaluator is made for each plan, the
latest are kept.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from metagraph.graph.life import Life
from metagraph.graph.model import Project
from metagraph.graph.requests import Point
from metagraph.motion.contact_solve import ContactRig
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.life.body import Body
from metagraph.playback.life.evaluate import LifeStage, Playing
from metagraph.playback.life.gaze import BodyGaze
from metagraph.playback.life.schedule import Schedule
from metagraph.playback.life.track import Track
from metagraph.playback.manual_playback import ManualEvaluator, ManualPlan
from metagraph.playback.plan import Plan
from metagraph.playback.player import compute_morphs_at, pose_at
from metagraph.playback.posing.composer import ComposerRig
from metagraph.playback.posing.overlay import Overlay
from metagraph.playback.posing.rigs import get_rigs
from metagraph.playback.posing.weight import Weight

__all__ = ["compute_morphs_at", "pose_at"]

KEPT = 8
_kept: list[Evaluator] = []


def evaluator(plan: Plan, project: Project) -> Evaluator:
    for known in _kept:
        if known.plan is plan and known.project is project:
            return known
    _kept.insert(0, Evaluator(plan, project))
    del _kept[KEPT:]
    return _kept[0]


def overlaid(plan: Plan, project: Project, seconds: Any, over: Overlay | None, alive: bool = True) -> Pose:
    return evaluator(plan, project).at(seconds, alive, over)


def faces_at(plan: Plan, project: Project, times: np.ndarray) -> list[dict[str, float]]:
    return evaluator(plan, project).faces_at(times)


def manual_pose_at(plan: ManualPlan, project: Project, seconds: Any, alive: bool = True) -> Pose:
    return ManualEvaluator(plan, project).at(seconds, alive)


def manual_morphs_at(
    plan: ManualPlan, project: Project, seconds: float, alive: bool = True
) -> dict[str, float]:
    return ManualEvaluator(plan, project).morphs_at(seconds, alive)


def enliven(pose: Pose, project: Project, schedule: Schedule, track: Track, times: np.ndarray) -> Pose:
    return LifeStage(project, schedule, track, body_of(project)).run(pose, np.asarray(times, float))


def face_weights(
    project: Project,
    schedule: Schedule,
    track: Track,
    seconds: float,
    pose: Pose | None = None,
    playing: Iterable[Playing] = (),
) -> dict[str, float]:
    return LifeStage(project, schedule, track, body_of(project)).morphs(seconds, pose, playing)


def gaze_of(schedule: Schedule, life: Life, body: Body, points: Mapping[str, Point]) -> BodyGaze:
    return BodyGaze(schedule, life, body, points)


def rig(project: Project) -> ComposerRig:
    return get_rigs(project).composer


def contact_rig(project: Project) -> ContactRig | None:
    return get_rigs(project).contacts


def weight_of(project: Project) -> Weight:
    return get_rigs(project).weight


def body_of(project: Project) -> Body:
    return get_rigs(project).body
