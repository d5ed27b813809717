"""Make hips, spine and legs answer the arms, and keep feet planted: find which joints of a skeleton do so,
what its clips' arms weigh, and the result at a time.

The rules are those of `follow_through`, `planted_feet` and the solvers of `motion`, which all runtimes share;
this module applies them to arrays.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.checks.end_gaps import get_action_motion
from metagraph.graph.face.rig import find_body_axes
from metagraph.graph.model import Action, Layer, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.contact_solve import ContactArm, ContactPose, ContactRig
from metagraph.motion.feet_solve import FootGoal, plant_feet
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.weight_solve import WeightBend, WeightCollar, WeightRig, answer_arms, moves_body
from metagraph.playback.plan import LayerPlan, Plan
from metagraph.playback.posing.feet import FeetOfPlan, Rows, find_feet_layer, make_foot_rows
from metagraph.playback.posing.follow_through import (
    KNOTS,
    NUMBERS,
    RATE,
    STEP,
    UNIT,
    ArmTrack,
    arm_sway,
    driven,
    knot_before,
    knot_time,
)

Array = NDArray[Any]
Vector = tuple[float, float, float]

SIDES = ("left", "right")
# The share of the body's mass that upper arm, lower arm and hand are, and where along them it lies (de Leva
# 1996, the mean of women and men; the hand is taken to be at its wrist).
MASSES = ((0.0263, 0.577), (0.0150, 0.457), (0.0059, 0.0))
# How the joints of the spine undo the hips' turn; together they go a little farther, which the neck undoes.
UNDOING = {"spine": 0.3, "chest": 0.4, "upper_chest": 0.3}
FARTHER = 0.35
# How far a collar bone rises with its arm: from RISES_FROM to RISES_TO (angles between arm and down) up to
# LIFT. The shoulder girdle of people gives about a third of an arm's elevation, most of it by the shoulder
# blade, which skeletons of characters do not have (Inman et al. 1944). How much of it looks right is our
# choice.
RISES_FROM, RISES_TO, LIFT = np.radians(30.0), np.radians(150.0), np.radians(14.0)
REACH_AHEAD = 0.1  # of the height: how far ahead of the shoulders gestures are made
LOOKS_BACK = KNOTS * STEP  # how many seconds back a pose depends on the plan
KEPT = 4096  # times of a plan that are kept


@dataclass(frozen=True, eq=False)
class Weight:
    """The part of a project's body that answers its arms.

    `rows` has the rows of `ArmTrack`s found so far, by clip, and `feet` those of `FootTrack`s. `feet_layer`
    moves the legs, None if no single layer does.
    """

    rig: WeightRig | None
    rows: dict[str, Rows]
    feet: dict[str, Rows]
    feet_layer: Layer | None = None


def find_weight(project: Project) -> Weight:
    """Return the part of a project's body that answers its arms."""
    arms = project.graphs["arms"]
    strength = min(1.0, arms.weight("arms")) * max(0.0, 1.0 - arms.weight("legs"))
    rig = _rig(project, strength)
    return Weight(rig, {}, {}, find_feet_layer(project, rig) if rig is not None else None)


def _rig(project: Project, strength: float) -> WeightRig | None:
    """Return the rig of a project; None if it does not have hips, two legs below them, and two arms."""
    skeleton, roles = project.skeleton, anatomy.project_roles(project)
    needed = ["hips", *(f"{s}_{p}" for s in SIDES for p in ("upper_leg", "lower_leg", "foot"))]
    needed += [f"{s}_{p}" for s in SIDES for p in ("upper_arm", "lower_arm", "hand")]
    if skeleton is None or any(r not in roles for r in needed):
        return None
    hips = roles["hips"]
    for side in SIDES:
        line = [hips, *(roles[f"{side}_{p}"] for p in ("upper_leg", "lower_leg", "foot"))]
        if any(a == b or b not in skeleton.descendants(a) for a, b in pairwise(line)):
            return None
    return _found(skeleton, roles, anatomy.get_base_pose(project), strength)


def _found(skeleton: Skeleton, roles: Mapping[str, int], base: Pose, strength: float) -> WeightRig:
    turned, at = (x.astype(float) for x in skeleton.globals(base))
    axes = find_body_axes(skeleton, {r: j for r, j in roles.items() if not r.endswith("eye")}, at)
    hips = roles["hips"]

    def local(joint: int, axis: Array) -> Vector:
        x, y, z = rotation.rotate_vectors(rotation.conjugate(turned[joint]), axis).tolist()
        return x, y, z

    joints = sorted({j for s in SIDES for j in skeleton.chain(roles[f"{s}_foot"])})
    parents = [joints.index(p) if (p := int(skeleton.parents[j])) in joints else -1 for j in joints]

    def place(joint: int) -> int:
        if joint not in joints:
            joints.append(joint)
            parents.append(-1)  # it only turns in its own space
        return joints.index(joint)

    def bend(joint: int, share: float) -> WeightBend:
        left, up, ahead = (local(joint, axis) for axis in axes)
        return WeightBend(place(joint), left, up, ahead, share)

    bends = [bend(hips, 1.0)]
    there = {r: share for r, share in UNDOING.items() if r in roles and roles[r] not in joints}
    whole = sum(there.values())
    above = next((roles[r] for r in ("neck", "head") if r in roles), None)
    farther = FARTHER if above is not None else 0.0
    shares = {roles[r]: -(1.0 + farther) * share / whole for r, share in there.items()}
    if above is not None and shares:
        shares[above] = farther
    if not shares:  # a stiff trunk would throw the arms around
        bends[0] = WeightBend(bends[0].place, bends[0].left, bends[0].up, bends[0].ahead, 0.0)
    bends += [bend(j, share) for j, share in shares.items()]
    collars = []
    for n, (side, sign) in enumerate(zip(SIDES, (1, -1), strict=True)):
        collar, upper = roles.get(f"{side}_shoulder"), roles[f"{side}_upper_arm"]
        if collar is not None and int(skeleton.parents[upper]) == collar:
            collars.append(WeightCollar(place(collar), place(upper), local(collar, sign * axes[2]), n))
    legs = []
    for side in SIDES:
        upper, lower, foot = (joints.index(roles[f"{side}_{p}"]) for p in ("upper_leg", "lower_leg", "foot"))
        below = {joints.index(j) for j in skeleton.descendants(joints[upper]) if j in joints}
        legs.append(ContactArm(upper, lower, foot, tuple(sorted(below))))
    levers = []
    for side in SIDES:
        lever = axes @ (at[roles[f"{side}_upper_arm"]] - at[hips])
        levers.append((float(lever[0]), float(lever[2]) + REACH_AHEAD * skeleton.height))
    up_x, up_y, up_z = axes[1].tolist()
    names = tuple(skeleton.names[roles[f"{s}_hand"]] for s in SIDES)
    body = ContactRig(tuple(joints), tuple(parents), {}, tuple(legs), names, (), False, False)
    knees = tuple(local(roles[f"{s}_upper_leg"], axes[2]) for s in SIDES)
    return WeightRig(
        body,
        tuple(bends),
        tuple(collars),
        knees,
        tuple(levers),
        (up_x, up_y, up_z),
        float(skeleton.height),
        strength,
    )


def find_arm_track_rows(weight: Weight, project: Project, clip: str) -> Rows:
    """Return the rows of a clip's `ArmTrack`; empty if the clip is missing or has another skeleton."""
    found = weight.rows.get(clip)
    if found is None:
        entry = project.clips.get(clip)
        motion = entry.motion if entry is not None else None
        fits = motion is not None and motion.skeleton == project.skeleton and weight.rig is not None
        found = _rows(project, motion) if fits and motion is not None else ()
        weight.rows[clip] = found
    return found


def find_foot_rows(weight: Weight, project: Project, clip: str) -> Rows:
    """Return the rows of a clip's `FootTrack`; empty if the clip is missing, has another skeleton, or if no
    single layer moves the legs.
    """
    found = weight.feet.get(clip)
    if found is None:
        entry = project.clips.get(clip)
        motion = entry.motion if entry is not None else None
        fits = motion is not None and motion.skeleton == project.skeleton
        if fits and motion is not None and weight.rig is not None and weight.feet_layer is not None:
            found = make_foot_rows(project, motion, weight.rig)
        else:
            found = ()
        weight.feet[clip] = found
    return found


def _rows(project: Project, clip: Clip) -> tuple[tuple[float, ...], ...]:
    skeleton, roles = clip.skeleton, anatomy.project_roles(project)
    base = anatomy.get_base_pose(project)
    turned, at = (x.astype(float) for x in skeleton.globals(base))
    axes = find_body_axes(skeleton, {r: j for r, j in roles.items() if not r.endswith("eye")}, at)
    poses = clip.pose_at(np.arange(int(np.ceil(clip.duration * RATE - 1e-6)) + 1) / RATE)
    out = np.zeros((len(poses.rotations), NUMBERS))
    for n, side in enumerate(SIDES):
        joints = [roles[f"{side}_{p}"] for p in ("upper_arm", "lower_arm", "hand")]
        first = roles.get(f"{side}_shoulder", joints[0])
        if joints[0] not in skeleton.descendants(first):
            first = joints[0]
        line = [j for j in skeleton.chain(joints[2]) if j in skeleton.descendants(first)]
        moved = _along(skeleton, line, poses.rotations, base.translations, turned, at)
        rest = _along(skeleton, line, base.rotations[None], base.translations, turned, at)
        out[:, 3 * n : 3 * n + 3] = (_moment(moved, joints) - _moment(rest, joints)) @ axes.T
        if first != joints[0]:
            own = _steep(moved[joints[0]] - moved[first], axes) - _steep(rest[joints[0]] - rest[first], axes)
            wanted = _raised(moved, joints, axes) - _raised(rest, joints, axes)
            out[:, 6 + n] = np.maximum(0.0, wanted - np.maximum(0.0, own))
    return tuple(tuple(row) for row in np.round(out / UNIT).tolist())


def _along(
    skeleton: Skeleton, line: Sequence[int], rotations: Array, moved: Array, turned: Array, at: Array
) -> dict[int, Array]:
    """Return the positions `[F, 3]` of an arm's joints on a trunk that stands as in the base pose."""
    parent = int(skeleton.parents[line[0]])
    turn = np.broadcast_to(turned[parent] if parent >= 0 else rotation.IDENTITY, (len(rotations), 4))
    here = np.broadcast_to(at[parent] if parent >= 0 else np.zeros(3), (len(rotations), 3))
    out = {}
    for joint in line:
        here = here + rotation.rotate_vectors(turn, np.broadcast_to(moved[joint].astype(float), here.shape))
        turn = rotation.multiply(turn, rotations[:, joint].astype(float))
        out[joint] = here
    return out


def _moment(places: Mapping[int, Array], joints: Sequence[int]) -> Array:
    """Return `[F, 3]`: the mass of an arm, as a share of the body's, times its position."""
    ends = [*joints, joints[-1]]
    parts = []
    for (mass, part), a, b in zip(MASSES, ends[:-1], ends[1:], strict=True):
        parts.append(mass * (places[a] + part * (places[b] - places[a])))
    return np.asarray(sum(parts))


def _steep(way: Array, axes: Array) -> Array:
    """Return how far directions `[F, 3]` rise above the horizontal, in radians."""
    return np.asarray(
        np.arcsin(np.clip(way @ axes[1] / np.maximum(np.linalg.norm(way, axis=-1), 1e-9), -1, 1))
    )


def _raised(places: Mapping[int, Array], joints: Sequence[int], axes: Array) -> Array:
    """Return how far a collar bone would rise with its arm `[F]`, in radians."""
    angle = _steep(places[joints[1]] - places[joints[0]], axes) + np.pi / 2
    x = np.clip((angle - RISES_FROM) / (RISES_TO - RISES_FROM), 0.0, 1.0)
    return np.asarray(LIFT * x * x * (3 - 2 * x))


def has_sway(project: Project) -> bool:
    """Return whether the bodies of a project answer their arms."""
    life = project.life
    return life.on and life.stillness < 1 and (life.follow_through > 0 or life.shoulder_lift > 0)


def has_planted_feet(project: Project) -> bool:
    """Return whether the feet of a project stay planted in blends."""
    return project.life.on and project.life.planted_feet > 0


def has_weight(project: Project) -> bool:
    """Return whether the bodies of a project answer their arms, or keep their feet planted."""
    return has_sway(project) or has_planted_feet(project)


class WeightStage:
    """Keeps the feet of a plan planted, and makes the body answer its arms. What the arms do at a time is
    computed once.
    """

    def __init__(self, plan: Plan, project: Project, weight: Weight) -> None:
        self._plan, self._project, self._weight = plan, project, weight
        self._tracks: dict[str, ArmTrack] = {}
        self._sways: dict[int, list[float]] = {}
        rig = weight.rig
        self._feet = (
            FeetOfPlan(partial(find_foot_rows, weight), rig.height, weight.feet_layer)
            if rig and weight.feet_layer and has_planted_feet(project)
            else None
        )
        self._answers = bool(rig and rig.strength > 0 and has_sway(project) and plan.layers["arms"].cues)

    def run(self, pose: Pose, times: Array, shown: Array | None = None) -> Pose:
        """Return composed poses `[N, J]` at `times [N]` in which feet stay planted and the body answers its
        arms; the same arrays if nothing moves them.

        `shown` `[N]` is how much of the plan's arm motion is seen, 0..1; None for all.
        """
        rig, life, feet = self._weight.rig, self._project.life, self._feet
        if rig is None or not (self._answers or feet) or not len(times):
            return pose
        calm = 1.0 - life.stillness
        parts = [calm] * len(times) if shown is None else (calm * shown).tolist()
        if not self._answers:
            parts = [0.0] * len(times)
        drives: list[list[float]] = []
        goals: list[list[FootGoal]] = []
        for part, time in zip(parts, times.tolist(), strict=True):
            drives.append(self.drive(time) if part > 0 else [])
            goals.append(feet.goals(self._plan, self._project, time) if feet else [])
        if shown is not None and feet is not None and feet.layer != "body":  # other motion covers that layer
            goals = [
                [replace(goal, planted=goal.planted * part) for goal in some]
                for some, part in zip(goals, shown.tolist(), strict=True)
            ]
        busy = [n for n in range(len(times)) if goals[n] or moves_body(drives[n])]
        if not busy:
            return pose
        joints, hips = list(rig.body.joints), rig.bends[0].place
        rotations, translations = np.array(pose.rotations), np.array(pose.translations)
        locals_, moved = rotations[busy][:, joints].tolist(), translations[busy][:, joints].tolist()
        changed = []
        for k, n in enumerate(busy):
            one = ContactPose([tuple(q) for q in locals_[k]], [tuple(v) for v in moved[k]])
            found = plant_feet(rig, one, goals[n], life.planted_feet)
            follow, lift = life.follow_through * parts[n], life.shoulder_lift * parts[n]
            if parts[n] > 0 and answer_arms(rig, one, drives[n], follow, lift):
                found = True
            if found:
                changed.append(k)
                locals_[k], moved[k] = one.local, one.moved[hips]
        if not changed:
            return pose
        here = [busy[k] for k in changed]
        rotations[np.ix_(here, joints)] = rotation.normalize(np.array([locals_[k] for k in changed]))
        translations[here, joints[hips]] = [moved[k] for k in changed]
        return Pose(rotations, translations)

    def drive(self, time: float) -> list[float]:
        """Return what moves the body at a time."""
        last = knot_before(time)
        return driven([self._at(n) for n in range(last - KNOTS + 1, last + 1)], time)

    def _at(self, number: int) -> list[float]:
        known = self._sways.get(number)
        if known is not None:
            return known
        time, rig = knot_time(number), self._weight.rig
        assert rig is not None
        arms, body = self._plan.layers["arms"], self._plan.layers["body"]
        cue, place = self._playing(arms, time, True)
        body_cue, body_place = self._playing(body, time, False) if cue is not None else (None, -1)
        hands, now = rig.body.hands, (arms, cue, place, body, body_cue, body_place, time)
        out = arm_sway(self._project, self._tracks, hands, *now)
        if len(self._sways) >= KEPT:
            self._sways.clear()
        self._sways[number] = out
        return out

    def _playing(self, of: LayerPlan, time: float, whole: bool) -> tuple[Any, int]:
        """Return the cue with motion that plays in a layer, and the index of its rest. Their tracks are made;
        with `whole`, these have rows.
        """
        cue = of.cue_at(time)
        if cue is not None and get_action_motion(self._project, cue.action) is None:
            cue = None
        place = max(int(of.fade_starts.searchsorted(time, "right")) - 1, 0) if of.rests else -1
        actions: list[Action] = [cue.action] if cue is not None else []
        actions += [of.rests[n].action for n in (place, place - 1) if n >= 0]
        for action in actions:
            if action.id not in self._tracks:
                rows = find_arm_track_rows(self._weight, self._project, action.clip) if whole else ()
                self._tracks[action.id] = ArmTrack(action.clip, rows)
        return cue, place
