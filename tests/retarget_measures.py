"""How well clips keep what they are on other figures: degrees there and back, hands at their own body."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from metagraph.motion import own_contact, rotation
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import ARM, LEG, SIDES, JointMap, propose_joint_map
from metagraph.motion.own_contact import OwnContact
from metagraph.motion.retarget import retarget
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.standing import StandingFigure

Array = Any

LIMIT = 0.995  # of a limb's length: from here on a degree of its bend is a hair's breadth
LOOSE = 0.001  # of a limb's length: bones that shift more do not hold together
SHORT = 0.005  # of half the shoulders: a hand of the middle figure so far from its place fell short of it


def figures(
    clip: Clip, target: Skeleton, joint_map: JointMap, pose: Pose, other: Pose
) -> list[StandingFigure]:
    """The clip's figure and the target's, as they stand."""
    roles = {p.role: p for p in joint_map.pairs if p.role}
    ours = {r: clip.skeleton.index(p.source) for r, p in roles.items()}
    theirs = {r: target.index(p.target) for r, p in roles.items()}
    return [StandingFigure(clip.skeleton, ours, pose), StandingFigure(target, theirs, other)]


def motion(figure: StandingFigure, clip: Clip) -> tuple[Array, Array]:
    turns, places = clip.skeleton.globals(clip.poses())
    return rotation.multiply(figure.turn, turns), rotation.rotate_vectors(figure.turn, places)


def round_trip(
    clip: Clip, middle: Skeleton, pose: Pose, other: Pose, contacts: bool = False
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Role -> `[F]` degrees a joint is turned from itself there and back, and whether that frame could
    survive.

    What cannot: a leg or arm stretched out on the middle figure, whose hips then come down or whose hand
    falls short of its place; limbs of the clip whose joints shift in their sockets, which stiff bones do not.
    """
    joint_map = replace(propose_joint_map(clip.skeleton, middle), contacts=contacts)
    out = retarget(clip, middle, joint_map, source_pose=pose, target_pose=other)
    back = retarget(out, clip.skeleton, joint_map.reversed, source_pose=other, target_pose=pose)
    turned = rotation.measure_angle_between(
        clip.skeleton.globals(clip.poses())[0], back.skeleton.globals(back.poses())[0]
    )
    degrees = {
        p.role or p.source: np.degrees(turned[:, clip.skeleton.index(p.source)]) for p in joint_map.pairs
    }
    source, target = figures(clip, middle, joint_map, pose, other)
    ours, theirs = motion(source, clip), motion(target, out)
    whole = {
        (side, parts): _holds(source, *ours, side, parts) & _reaches(target, theirs[1], side, parts)
        for side in SIDES
        for parts in (ARM, LEG)
    }
    legs = whole["left", LEG] & whole["right", LEG]  # hips come down for both
    for side in SIDES:
        aside = [_aside(f, m, side) for f, m in ((source, ours), (target, theirs))]
        whole[side, ARM] &= ~((np.abs(aside[0]) < 1) & (np.abs(aside[1] - aside[0]) > SHORT))
    known = {
        role: whole[role.split("_")[0], ARM] if "_arm" in role else legs if "_leg" in role else legs | True
        for role in degrees
        if "_arm" not in role or role.split("_")[0] in SIDES
    }
    return degrees, {role: known.get(role, legs | True) for role in degrees}


def _holds(figure: StandingFigure, turns: Array, places: Array, side: str, parts: tuple[str, ...]) -> Array:
    """Whether a limb's joints are where the standing pose has them, in their own bones."""
    names = [f"{side}_{part}" for part in parts]
    base = "hips" if parts == LEG else names[0]
    if parts == LEG:
        names = ["right_upper_leg" if side == "left" else "left_upper_leg", *names]
    length = figure.length(*[f"{side}_{part}" for part in parts])
    fine = np.ones(len(places), bool)
    for n, (a, b) in enumerate(pairwise(names)):
        joint = figure.roles[base if n == 0 else a]
        turn = rotation.conjugate(
            rotation.multiply(turns[:, joint], rotation.conjugate(figure.rotations[joint]))
        )
        now = rotation.rotate_vectors(turn, places[:, figure.roles[b]] - places[:, figure.roles[a]])
        fine &= np.linalg.norm(now - (figure.at(b) - figure.at(a)), axis=-1) < LOOSE * length
    return fine


def _reaches(figure: StandingFigure, places: Array, side: str, parts: tuple[str, ...]) -> Array:
    first, *_, last = (f"{side}_{part}" for part in parts)
    far = np.linalg.norm(places[:, figure.roles[last]] - places[:, figure.roles[first]], axis=-1)
    return far < LIMIT * figure.length(*[f"{side}_{part}" for part in parts])


def _aside(figure: StandingFigure, moved: tuple[Array, Array], side: str) -> Array:
    """How far a hand is to its own side of the middle, level, in half the shoulders."""
    turns, places = moved
    chest = next(r for r in ("upper_chest", "chest", "spine", "hips") if r in figure.roles)
    joint, sign = figure.roles[chest], 1 if side == "left" else -1
    turn = rotation.multiply(turns[:, joint], rotation.conjugate(figure.rotations[joint]))
    level = rotation.rotate_vectors(turn, np.array([1.0, 0, 0])) * [1, 0, 1]
    level = level / np.maximum(np.linalg.norm(level, axis=-1, keepdims=True), 0.3)
    away = places[:, figure.roles[f"{side}_hand"]] - places[:, figure.roles[f"{side}_upper_arm"]]
    return sign * np.einsum("fi,fi->f", away, level) / figure.half_shoulders + 1


def contact_errors(
    clip: Clip, target: Skeleton, pose: Pose, other: Pose, contacts: bool
) -> tuple[Array, Array, float]:
    """Of all frames in which a hand of the clip touches its body: heights `[N]` between the target's hand and
    the place that it should touch; the same `[M]` of hands that touch each other; and the greatest
    acceleration of a wrist, heights / s2.
    """
    joint_map = replace(propose_joint_map(clip.skeleton, target), contacts=contacts)
    source, figure = figures(clip, target, joint_map, pose, other)
    contact = OwnContact(source, figure, *motion(source, clip))
    out = retarget(clip, target, joint_map, source_pose=pose, target_pose=other)
    p = contact.target.points(*motion(figure, out))
    errors, hands, most = [np.zeros(0)], [np.zeros(0)], 0.0
    for side in SIDES:
        if clip.frames > 2:
            speed = np.diff(p[f"{side}_hand"], 2, axis=0) * clip.fps**2 / target.height
            most = max(most, float(np.linalg.norm(speed, axis=-1).max()))
        if places := contact.places[side]:
            best = np.argmax([x.weight for x in places], 0)
            hand = own_contact._touching(side, p)
            away = [np.linalg.norm(contact.wanted(x, p) - hand[x.point], axis=-1) for x in places]
            error = np.array(away)[best, np.arange(len(best))] / target.height
            touching = contact.near[side] > 0.95
            errors.append(error[touching])
            hands.append(error[touching & np.array([x.part.endswith("_hand") for x in places])[best]])
    return np.concatenate(errors), np.concatenate(hands), most


def variant(skeleton: Skeleton, arms: float = 1.15, shoulders: float = 1.3, trunk: float = 0.85) -> Skeleton:
    """The figure with longer arms, broader shoulders and a shorter trunk."""
    roles, offsets = find_roles(skeleton), skeleton.rest_translations.copy()

    def stretch(above: str, below: str, by: float) -> None:
        for joint in set(skeleton.chain(roles[below])) - set(skeleton.chain(roles[above])):
            offsets[joint] *= by

    top = next(r for r in ("upper_chest", "chest", "spine") if r in roles)
    stretch("hips", "head", trunk)
    for side in SIDES:
        stretch(top, f"{side}_upper_arm", shoulders)
        stretch(f"{side}_upper_arm", f"{side}_hand", arms)
    return Skeleton(skeleton.names, skeleton.parents, skeleton.rest_rotations, offsets)
