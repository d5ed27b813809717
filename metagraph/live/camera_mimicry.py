"""Keypoints that come in live: whoever is before a client's camera is mimicked (`metagraph.mimicry`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from metagraph.graph.model import Layer, Project
from metagraph.graph.requests import AnyRequest
from metagraph.live.messages import Keypoints
from metagraph.playback.plan import Plan

if TYPE_CHECKING:
    from metagraph.mimicry.mimic import Mimic


@dataclass(slots=True)
class ClientCamera:
    """One client's person. wish: how they are mimicked; a change of it begins again."""

    mimic: Mimic
    wish: tuple[bool, bool, tuple[Layer, ...]]
    project: Project


def see(
    camera: ClientCamera | None, message: Keypoints, project: Project, plan: Plan, now: float, prefix: str
) -> tuple[ClientCamera, list[AnyRequest], dict[Layer, str]]:
    """Take a frame in; return the camera, what is requested because of it, and layer -> name of the stance
    the person is in.

    prefix: of the ids that requests of this camera have in the plan. Raises ValueError for points that cannot
    be, and where the project has nobody who could mimic.
    """
    from metagraph.mimicry.mimic import Mimic  # only sessions that have a camera pay for it
    from metagraph.mimicry.performing import find_goal_stances

    wish = (message.mirror, message.gaze, message.layers)
    if camera is None or camera.wish != wish or camera.project is not project:
        count = camera.mimic.count if camera is not None else 0
        camera = ClientCamera(
            Mimic(project, message.mirror, message.layers, message.gaze, message.priority), wish, project
        )
        camera.mimic.count = count  # ids are not used twice
    size = {len(point) for point in message.points}
    if len(size) > 1:
        raise ValueError("points: give two numbers for every point, or three for every point")
    # Pictures and pose estimators count y downwards and z away from the camera.
    points = [(x, -y, *(-z for z in rest)) for x, y, *rest in message.points]
    asks = camera.mimic.feed(now, points, message.confidence, find_goal_stances(plan, now, prefix))
    seen = {
        layer: found.name
        for layer, ident in camera.mimic.seen.items()
        if (found := project.stance(ident)) is not None
    }
    return camera, asks, seen
