"""Keep hands where they touch the body, and outside it: apply contacts and the guard to composed poses.

The rules are those of `motion.contact_solve` and `contact_goals`, which all runtimes share; this module
applies them to arrays.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.checks.end_gaps import get_action_motion
from metagraph.graph.face.rig import find_body_axes
from metagraph.graph.model import LAYERS, Project
from metagraph.motion import rotation
from metagraph.motion.body_capsules import SIDES, BodyPart, make_body_capsules
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.contact_solve import (
    FOREARM,
    HAND,
    OBSTACLE,
    BodyCapsule,
    ContactArm,
    ContactPose,
    ContactRig,
    HandGoal,
    solve_contacts,
    spread,
)
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.playback.plan import Plan
from metagraph.playback.posing.contact_goals import LEAST, layer_goals

Array = NDArray[Any]

FEW = 2  # poses


def find_body_parts(project: Project, character: CharacterMesh | None = None) -> tuple[BodyPart, ...]:
    """Return the parts of a project's body: those it lists, else those found from its skeleton or from a
    character's mesh on it.
    """
    if project.touch.parts or project.skeleton is None:
        return project.touch.parts
    roles, base = anatomy.project_roles(project), anatomy.get_base_pose(project)
    _, at = project.skeleton.globals(base)
    axes = find_body_axes(project.skeleton, {r: j for r, j in roles.items() if not r.endswith("eye")}, at)
    return make_body_capsules(project.skeleton, roles, base, axes, character)


def find_contact_rig(project: Project) -> ContactRig | None:
    """Return the rig that contacts of a project need, None if it does not have two arms."""
    skeleton, roles, targets = project.skeleton, anatomy.project_roles(project), sorted(project.touched)
    arms = [[roles.get(f"{s}_{p}") for p in ("upper_arm", "lower_arm", "hand")] for s in SIDES]
    if skeleton is None or any(j is None for arm in arms for j in arm):
        return None
    return make_contact_rig(
        skeleton,
        [[j for j in arm if j is not None] for arm in arms],
        find_body_parts(project),
        targets,
        project,
    )


def make_contact_rig(
    skeleton: Skeleton,
    arms: Sequence[Sequence[int]],
    parts: Sequence[BodyPart],
    targets: Sequence[str],
    project: Project,
) -> ContactRig | None:
    """Return a rig of some joints of a skeleton: those of the arms (upper, lower, hand), of the parts, those
    that contacts touch, and all their ancestors. Return None if an arm's joints are not one below the other.
    """
    if any(
        lower not in skeleton.descendants(upper) or upper == lower
        for arm in arms
        for upper, lower in pairwise(arm)
    ):
        return None
    wanted = {j for arm in arms for j in arm}
    wanted |= {skeleton.index(n) for p in parts for n in (p.joint, p.to) if n in skeleton}
    wanted |= {skeleton.index(n) for n in targets if n in skeleton}
    joints = sorted({j for one in wanted for j in skeleton.chain(one)})
    place = {j: n for n, j in enumerate(joints)}
    made = []
    for arm in arms:
        below = tuple(place[j] for j in skeleton.descendants(arm[0]) if j in place)
        made.append(ContactArm(place[arm[0]], place[arm[1]], place[arm[2]], below))
    capsules = [_capsule(skeleton, arms, place, p) for p in parts if p.joint in skeleton and p.to in skeleton]
    return ContactRig(
        tuple(joints),
        tuple(place.get(int(skeleton.parents[j]), -1) for j in joints),
        {skeleton.names[j]: n for j, n in place.items()},
        tuple(made),
        tuple(skeleton.names[arm[2]] for arm in arms),
        tuple(capsules),
        project.touch.contacts,
        project.touch.guard,
    )


def _capsule(
    skeleton: Skeleton, arms: Sequence[Sequence[int]], place: Mapping[int, int], part: BodyPart
) -> BodyCapsule:
    joint, to = skeleton.index(part.joint), skeleton.index(part.to)
    side, kind = -1, OBSTACLE
    for n, (upper, lower, hand) in enumerate(arms):
        if joint in skeleton.descendants(upper):
            side = n
            inside = joint in skeleton.descendants(lower)
            kind = HAND if joint in skeleton.descendants(hand) else FOREARM if inside else OBSTACLE
    return BodyCapsule(place[joint], part.a, place[to], part.b, part.radius, side, kind)


def find_hand_goals(plan: Plan, project: Project, rig: ContactRig, time: float) -> list[HandGoal]:
    """Return where the contacts of all layers want the hands at a time."""
    out: list[HandGoal] = []
    for layer in LAYERS:
        of, strength = plan.layers[layer], min(1.0, project.graphs[layer].weight("arms"))
        if strength <= 0:
            continue
        cue = of.cue_at(time)
        if cue is not None and get_action_motion(project, cue.action) is None:
            cue = None
        place = max(int(of.fade_starts.searchsorted(time, "right")) - 1, 0) if of.rests else -1
        if not any(of.rests[n].action.contacts for n in (place, place - 1) if n >= 0) and not (
            cue is not None and cue.action.contacts
        ):
            continue
        out += layer_goals(rig, project, of, cue, place, time, strength)
    return out


def has_contacts(project: Project) -> bool:
    """Return whether a project has the guard on, or has contacts and has them on."""
    touch = project.touch
    return project.skeleton is not None and (touch.guard or (touch.contacts and bool(project.touched)))


class ContactStage:
    """Keeps the hands of a plan in contact, and outside the body."""

    def __init__(self, plan: Plan, project: Project, rig: ContactRig | None) -> None:
        self._plan, self._project = plan, project
        self._rig = rig if has_contacts(project) else None

    def run(self, pose: Pose, times: Array, shown: Array | None = None) -> Pose:
        """Return composed poses `[N, J]` with hands kept in contact and outside the body at `times [N]`; the
        same arrays if nothing changes.

        `shown` `[N]` is how much of the plan's arm motion is seen, 0..1; None for all.
        """
        rig = self._rig
        if rig is None or not len(times):
            return pose
        none: list[HandGoal] = []
        plan, project = self._plan, self._project
        goals = [find_hand_goals(plan, project, rig, t) if rig.contacts else none for t in times.tolist()]
        if shown is not None:
            goals = [
                [replace(g, weight=g.weight * part) for g in some if g.weight * part > LEAST]
                for some, part in zip(goals, shown.tolist(), strict=True)
            ]
        return solve_pose_with_contacts(pose, rig, goals)


def solve_pose_with_contacts(pose: Pose, rig: ContactRig, goals: Sequence[Sequence[HandGoal]]) -> Pose:
    """Return poses `[N, J]` with hands at their goals, and outside the body if the rig's guard is on."""
    busy = np.array([bool(g) for g in goals])
    if rig.guard and not busy.all():
        idle = np.flatnonzero(~busy)
        # A few poses are solved one by one, because setting up arrays takes longer.
        few = len(idle) <= FEW
        busy[idle] = few or find_inside(rig, Pose(pose.rotations[idle], pose.translations[idle]))
    if not busy.any():
        return pose
    rotations = pose.rotations
    joints = list(rig.joints)
    changed = [rig.joints[p] for arm in rig.arms for p in (arm.upper, arm.lower, arm.hand)]
    places = [p for arm in rig.arms for p in (arm.upper, arm.lower, arm.hand)]
    for n in np.flatnonzero(busy).tolist():
        one = ContactPose(
            list(map(tuple, pose.rotations[n, joints].tolist())),
            list(map(tuple, pose.translations[n, joints].tolist())),
        )
        spread(rig, one)
        if solve_contacts(rig, one, goals[n]):
            if rotations is pose.rotations:
                rotations = np.array(rotations)
            rotations[n, changed] = rotation.normalize(np.array([one.local[p] for p in places]))
    return pose if rotations is pose.rotations else Pose(rotations, pose.translations)


def find_inside(rig: ContactRig, pose: Pose) -> Array:
    """Return `[N]` whether a forearm or hand is inside another part of the body in poses `[N, J]`."""
    return np.asarray((measure_contact_depths(rig, pose) > 0).any(-1))


def measure_contact_depths(rig: ContactRig, pose: Pose) -> Array:
    """Return `[N, P]` how deep forearms and hands are inside other parts, in metres, negative outside, for
    every pair.
    """
    first, second, _ = list_capsule_pairs(rig)
    a, b = find_capsule_ends(rig, pose)
    radii = np.array([c.radius for c in rig.capsules])
    way, _ = find_nearest_between_lines(a[:, first], b[:, first], a[:, second], b[:, second])
    return np.asarray(radii[first] + radii[second] - np.linalg.norm(way, axis=-1))


def list_capsule_pairs(rig: ContactRig) -> tuple[list[int], list[int], list[tuple[int, int]]]:
    """Return the indices of capsules that are kept apart: those that are pushed, the others, and
    the pairs.
    """
    both = [
        (i, k)
        for i, mine in enumerate(rig.capsules)
        for k, other in enumerate(rig.capsules)
        if mine.kind != OBSTACLE and other.arm != mine.arm and (other.kind == OBSTACLE or i < k)
    ]
    return [i for i, _ in both], [k for _, k in both], both


def find_capsule_ends(rig: ContactRig, pose: Pose) -> tuple[Array, Array]:
    """Return where the capsules' lines begin and end in poses `[N, J]`: `[N, C, 3]` each."""
    joints = list(rig.joints)
    local, moved = (
        np.asarray(pose.rotations[:, joints], float),
        np.asarray(pose.translations[:, joints], float),
    )
    turned, at = local.copy(), moved.copy()
    for n, above in enumerate(rig.parents):
        if above >= 0:
            turned[:, n] = rotation.multiply(turned[:, above], local[:, n])
            at[:, n] = at[:, above] + rotation.rotate_vectors(turned[:, above], moved[:, n])
    out = []
    for joint, point in (
        ([c.joint for c in rig.capsules], [c.a for c in rig.capsules]),
        ([c.to for c in rig.capsules], [c.b for c in rig.capsules]),
    ):
        out.append(at[:, joint] + rotation.rotate_vectors(turned[:, joint], np.array(point)))
    return out[0], out[1]


def find_nearest_between_lines(a: Array, b: Array, c: Array, d: Array) -> tuple[Array, Array]:
    """Return the shortest vectors `[..., 3]` from lines c-d to lines a-b, points `[..., 3]` each, and how far
    along a-b they end, 0..1: `contact_solve.apart` for arrays.
    """
    u, v, w = b - a, d - c, a - c
    uu, uv, vv = (u * u).sum(-1), (u * v).sum(-1), (v * v).sum(-1)
    uw, vw = (u * w).sum(-1), (v * w).sum(-1)
    below = uu * vv - uv * uv
    long, other = uu > 1e-12, vv > 1e-12
    safe = below > 1e-9 * uu * vv
    s = np.where(safe & long, np.clip((uv * vw - vv * uw) / np.where(safe, below, 1), 0, 1), 0.0)
    t = np.where(other, (uv * s + vw) / np.where(other, vv, 1), 0.0)
    inner = np.clip(t, 0, 1)
    s = np.where((t == inner) & other, s, np.clip((uv * inner - uw) / np.where(long, uu, 1), 0, 1))
    s = np.where(long, s, 0.0)
    return w + u * s[..., None] - v * inner[..., None], s
