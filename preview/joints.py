"""Decide from names and places of joints which of them are drawn and on which side they are."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Skeleton

_CONTROL = re.compile(
    r"(^|[^a-z])(ik|fk|ctrl|control|pole|poletarget|target|twist|roll|helper|dummy|nub|site|end|null|camera|prop|weapon|attach|socket|jiggle)([^a-z]|$)"
)
_FINGER = re.compile(r"thumb|index|middle|ring(?!s)|little|pinky|finger|metacarp|carpal")
_FACE = re.compile(
    r"eye|lid|brow|jaw|tongue|teeth|tooth|lip(?!s?tick)|cheek|nose|nostril|mouth|ear(?!th)|face|squint|smile|hair|beard|tail|skirt|cloth|cape"
)
_LEFT = re.compile(r"left|(^|[^a-z])l([^a-z]|$)")
_RIGHT = re.compile(r"right|(^|[^a-z])r([^a-z]|$)")


@lru_cache(maxsize=4096)  # called for the same joints for each picture
def split_humps(name: str) -> str:
    """Return the name in lower case, split at its capitals: `mixamorig:LeftUpLeg2` gives
    `mixamorig:left_up_leg2`.
    """
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


def is_control(name: str) -> bool:
    """Return whether the joint is a helper of a rig (IK goal, twist, end marker), not part of the body."""
    return bool(_CONTROL.search(re.sub(r"\d+", "", split_humps(name))))


def is_finger(name: str) -> bool:
    return bool(_FINGER.search(split_humps(name)))


def is_face(name: str) -> bool:
    """Return whether the joint is in the face, in hair or in cloth: too small or too loose to stand for a
    bone.
    """
    return bool(
        _FACE.search(
            split_humps(name)
            .replace("forearm", "")
            .replace("fore_arm", "")
            .replace("gear", "")
            .replace("rear", "")
        )
    )


def find_side_signs(skeleton: Skeleton) -> NDArray[Any]:
    """Return `[J]`: 1 for left, -1 for right, 0 for the middle; by the joint's name, or the side of its
    parent if the name has none.
    """
    out = np.zeros(len(skeleton), np.int8)
    for i, name in enumerate(skeleton.names):
        word = split_humps(name)
        left, right = bool(_LEFT.search(word)), bool(_RIGHT.search(word))
        parent = int(skeleton.parents[i])
        out[i] = 1 if left and not right else -1 if right and not left else out[parent] if parent >= 0 else 0
    return out


def find_head(skeleton: Skeleton) -> int | None:
    """Return the head's joint by name, or by its role ("JtSkullA"). None if there is none."""
    found = [
        i
        for i, n in enumerate(skeleton.names)
        if re.search(r"(^|[^a-z])head([^a-z]|$)", re.sub(r"\d+", "", split_humps(n))) and not is_control(n)
    ]
    return found[0] if found else find_roles(skeleton).get("head")


def find_drawn_joints(skeleton: Skeleton) -> NDArray[Any]:
    """Return `[J]` bool: the joints that a stick figure shows. There is always at least one."""
    count, top = len(skeleton), find_head(skeleton)
    keep = np.array([not is_control(n) and not is_face(n) for n in skeleton.names])
    offsets = np.linalg.norm(skeleton.rest_translations, axis=1)
    below = np.ones(count, int)
    for i in range(count - 1, 0, -1):
        if skeleton.parents[i] >= 0:
            below[skeleton.parents[i]] += below[i]
    for i in range(count):
        parent = int(skeleton.parents[i])
        if parent >= 0 and not keep[parent] and not is_control(skeleton.names[parent]):
            keep[i] = False  # joints that hang on hair or a jaw are hidden with it
        if parent >= 0 and below[i] == 1 and offsets[i] < 1e-6:
            keep[i] = False
        if parent >= 0 and below[i] == 1 and below[parent] > 12:
            keep[i] = i == top or (keep[i] and is_finger(skeleton.names[i]))
    # A root on the ground below the hips is no bone: begin where the body branches first.
    branching = [i for i in range(count) if keep[i] and sum(bool(keep[c]) for c in skeleton.children[i]) > 1]
    if branching:
        for i in skeleton.chain(branching[0])[:-1]:
            keep[i] = False
    if not keep.any():
        keep[0] = True
    return keep


def find_nearest_above(skeleton: Skeleton, shown: NDArray[Any]) -> NDArray[Any]:
    """Return `[J]`: for each joint the nearest joint above it that is shown (`shown` `[J]`), or -1."""
    out = np.full(len(skeleton), -1)
    for i, parent in enumerate(skeleton.parents):  # parents stand before their children
        if parent >= 0:
            out[i] = parent if shown[parent] else out[parent]
    return out
