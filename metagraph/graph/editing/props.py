"""Edits of props. Pure functions: a project in, a project out."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from metagraph.common.wording import phrase
from metagraph.graph.edit_error import EditError
from metagraph.graph.ids import derive_id
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop
from metagraph.motion import rotation
from metagraph.motion.joint_map import find_known_roles
from metagraph.motion.skeleton import Skeleton

Three = tuple[float, float, float]

MOST = 100  # props of a project
PALM, GRIP = 0.45, 0.6  # of a hand's breadth: from its joints out to what it holds, and up what it holds
_NOWHERE = (0.0, 0.0, 0.0)


def add_prop(project: Project, prop: Prop) -> tuple[Project, str]:
    """Return the project with another prop, and the prop's id. Raises EditError if it has `MOST` already."""
    if len(project.props) >= MOST:
        raise EditError(phrase("A project has at most {most} props. Remove one first.", most=MOST))
    ident, number = derive_id("o", prop.path), 1
    while ident in project.props:  # the same file once more
        ident, number = derive_id("o", prop.path, number), number + 1
    return replace(project, props={**project.props, ident: prop}), ident


def set_prop(project: Project, ident: str, prop: Prop) -> Project:
    """Return the project with a changed prop. Raises EditError if it is not there, or for a joint that the
    skeleton has not.
    """
    if ident not in project.props:
        raise EditError(phrase("This prop is no longer in the project."))
    if prop.joint and (project.skeleton is None or prop.joint not in project.skeleton):
        raise EditError(phrase("The character has no joint '{joint}'.", joint=prop.joint))
    return replace(project, props={**project.props, ident: prop})


def remove_prop(project: Project, ident: str) -> Project:
    """Return the project without a prop; its file stays."""
    return replace(project, props={key: prop for key, prop in project.props.items() if key != ident})


def find_grip(project: Project, joint: str) -> tuple[Three, Three]:
    """Return where a prop is that a joint carries, metres, and how it is turned, degrees about x, y and z,
    both in the joint's space. A hand holds it in the palm, its up towards the thumb, as one holds a cup;
    another joint has it in the middle of what is below it.
    """
    skeleton = project.skeleton
    if skeleton is None or joint not in skeleton:
        return _NOWHERE, _NOWHERE
    number = skeleton.names.index(joint)
    below = [skeleton.rest_translations[child] for child in skeleton.children[number]]
    roles = find_known_roles(skeleton, None)
    side = next((s for s in ("right", "left") if roles.get(f"{s}_hand") == number), "")
    if side and {f"{side}_index_1", f"{side}_little_1"} <= roles.keys():
        index, little = (roles[f"{side}_{finger}_1"] for finger in ("index", "little"))
        return _hold(skeleton, number, index, little, side)
    if not below:
        return _NOWHERE, _NOWHERE
    return _three(np.mean(below, axis=0)), _NOWHERE


def _hold(skeleton: Skeleton, hand: int, index: int, little: int, side: str) -> tuple[Three, Three]:
    """Return place and turn of what a hand holds, from the knuckles of two fingers at rest."""
    turns, places = skeleton.globals(skeleton.rest)
    knuckles = [
        rotation.rotate_vectors(rotation.conjugate(turns[hand]), places[joint] - places[hand])
        for joint in (index, little)
    ]
    middle, across = (knuckles[0] + knuckles[1]) / 2, knuckles[0] - knuckles[1]
    wide = float(np.linalg.norm(across))
    out = np.cross(across, middle) * (1 if side == "right" else -1)  # of the palm
    if wide < 1e-6 or np.linalg.norm(out) < 1e-9:
        return _three(middle), _NOWHERE
    up, front = across / wide, out / np.linalg.norm(out)
    front = front - up * float(front @ up)
    axes = np.stack([np.cross(up, front), up, front], 1)
    tip = np.arctan2(axes[2, 1], axes[2, 2])
    turn = np.arctan2(-axes[2, 0], np.hypot(axes[0, 0], axes[1, 0]))
    roll = np.arctan2(axes[1, 0], axes[0, 0])
    at = 0.8 * middle + PALM * wide * front - GRIP * wide * up
    return _three(at), _three(np.degrees([tip, turn, roll]))


def _three(values: Any) -> Three:
    x, y, z = (round(float(value), 4) for value in values)
    return x, y, z
