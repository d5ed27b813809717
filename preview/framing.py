"""Choose how near a clip is shown, and from where: the whole body if it walks or stands, down to the hips if
the arms gesture, down to the chest if only the head moves; from the front.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.clip import Clip
from metagraph.motion.moving import find_moved_parts
from metagraph.motion.roles import find_roles, is_humanoid
from metagraph.motion.skeleton import Skeleton
from preview import joints as rules
from preview.camera import Camera
from preview.figure import MeshFigure
from preview.scene import THEMES, Actor, LampTurn, SceneTheme

Array = NDArray[Any]
Near = Literal["whole", "upper", "head"]
Box = tuple[Array, Array]  # its lowest and its highest corner, metres

# Shares of the character's height: how far beside its middle a picture reaches at least, and how far below
# the joint at its lower edge. The numbers are our own, by eye.
ASIDE: dict[Near, float] = {"upper": 0.3, "head": 0.15}
BELOW: dict[Near, float] = {"upper": 0.03, "head": 0.02}
HAND = 0.07  # beyond a wrist
CENTRAL = 0.15  # of the field of view: about so far from the middle of a picture a face has the focus
AVERTED = 1.0  # radians from the front beyond which a face is hardly seen


def choose_nearness(clip: Clip) -> Near:
    """Return how near to show a clip, by what it moves. Skeletons that are no humanoids are shown whole."""
    parts = set(find_moved_parts(clip))
    if not parts or parts & {"place", "legs"} or not is_humanoid(find_roles(clip.skeleton)):
        return "whole"
    return "upper" if parts & {"arms", "spine"} else "head"


def find_near_box(skeleton: Skeleton, near: Near, positions: Array, whole: Box, height: float) -> Box:
    """Return the box to show of a character in poses `positions [F, J, 3]`, which faces +Z above the origin.
    `whole` is the box round all of it, `height` the height of the character at rest, in metres.
    """
    roles = find_roles(skeleton)
    edge = "hips" if near == "upper" else next(r for r in ("upper_chest", "chest", "spine") if r in roles)
    low, high = whole[0].copy(), whole[1].copy()
    low[1] = positions[:, roles[edge], 1].min() - BELOW[near] * height
    middle = positions[:, roles["head"], 0].mean()
    joints = [roles["head"]]
    if near == "upper":
        joints += [i for role, i in roles.items() if role.endswith(("arm", "hand"))]
    shown = positions[:, joints]
    beside = HAND * height
    low[0] = min(shown[..., 0].min() - beside, middle - ASIDE[near] * height)
    high[0] = max(shown[..., 0].max() + beside, middle + ASIDE[near] * height)
    low[2], high[2] = shown[..., 2].min() - beside, shown[..., 2].max() + beside
    low[1] = min(low[1], shown[..., 1].min() - beside)
    return low, high


def find_heading(figure: MeshFigure, positions: Array) -> float:
    """Return where the hips face, radians about +Y: across the line from the right limbs to the left ones;
    0 if that is not known. positions: `[J, 3]`.
    """
    side = rules.find_side_signs(figure.skeleton) * figure.drawn
    if not ((side > 0).any() and (side < 0).any()):
        return 0.0
    p = np.asarray(positions, float)
    near = np.array([rules.is_finger(n) for n in figure.skeleton.names])
    upper = [i for i in range(len(side)) if side[i] and not near[i] and side[figure.skeleton.parents[i]] == 0]
    left, right = [i for i in upper if side[i] > 0], [i for i in upper if side[i] < 0]
    if not left or not right:
        return 0.0
    across = p[left].mean(0) - p[right].mean(0)
    return float(np.arctan2(-across[2], across[0])) if np.hypot(across[0], across[2]) > 1e-6 else 0.0


# Where the studio's lamp stands, degrees about +Y from where the character faces, by where the camera stands:
# as in the first view while both cheeks are seen, then on the camera's side, behind the camera for a back.
CAMERA_YAWS = (-180.0, -90.0, 28.0, 90.0, 180.0)
LAMP_YAWS = (-180.0, -34.0, -34.0, 34.0, 180.0)


def find_lamp_turn(yaw: float, heading: float = 0.0) -> LampTurn | None:
    """Return how the studio's lamp is turned for a camera at `yaw`, so that no face in sight is in shadow;
    None for as the theme has it. heading: where the character faces. Both are radians about +Y. The turn
    changes steadily with the yaw.
    """
    beside = float(np.degrees(np.arctan2(np.sin(yaw - heading), np.cos(yaw - heading))))
    turn = heading + float(np.radians(np.interp(beside, CAMERA_YAWS, LAMP_YAWS) - LAMP_YAWS[1]))
    return LampTurn(turn) if abs(turn) > 1e-6 else None


def has_studio_lamp(theme: SceneTheme) -> bool:
    """Return whether a theme's lamp stands where the studio's does: it follows the camera; others stay."""
    return theme.toward == THEMES[theme.name].toward


def find_focus(camera: Camera, actors: Sequence[Actor]) -> float | None:
    """Return how far before a camera the face is on which it is focused, metres: of several that of whom the
    picture's middle is nearest to, and between two in the middle of both. None if no face is before it.
    """
    far, weights = [], []
    for actor in actors:
        place = np.asarray(actor.positions, float).reshape(-1, len(actor.figure.skeleton), 3)[0]
        face = place[_find_face(actor.figure.skeleton)].mean(0)
        x, y, z = camera.axes @ (face - camera.eye)
        if z < -camera.near:
            far.append(-z)
            weights.append(np.exp(-((np.hypot(x, y) / -z / (CENTRAL * camera.fov)) ** 2)) + 1e-9)
    return float(np.average(far, weights=weights)) if far else None


@lru_cache(maxsize=32)
def _find_face(skeleton: Skeleton) -> list[int]:
    """Return the joints between which a skeleton's face is: its eyes, its head, or else all."""
    roles = find_roles(skeleton)
    eyes = [roles[name] for name in ("left_eye", "right_eye") if name in roles]
    return eyes or ([roles["head"]] if "head" in roles else list(range(len(skeleton))))


def turn_to_face(figure: MeshFigure, positions: Array) -> float:
    """Return by how far a camera goes round a figure to see its face, radians about +Y: 0 for one that faces
    the front, or nearly. positions: `[J, 3]`, of its first pose.
    """
    heading = find_heading(figure, positions)
    return heading if abs(heading) > AVERTED else 0.0
