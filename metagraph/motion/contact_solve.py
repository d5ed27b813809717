"""Keep hands in contact with the body, and outside it, by moving two-bone arms to their goals.

The body's parts are capsules, each fixed to a joint. Rotations are quaternions xyzw, lengths metres; a place
is an index into a rig's list of joints. The code computes one pose at a time, with plain numbers, the same in
all languages.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import sqrt

from metagraph.motion.plain_vectors import (
    Quaternion,
    Vector,
    back,
    between,
    dot,
    length,
    minus,
    plus,
    rotated,
    scaled,
    times,
    unit,
    unit_turn,
)

REACHED = 0.995  # of an arm's length: it does not snap straight
FOLDED = 0.906  # cosine of the least angle inside an elbow, 25 degrees
WRIST = 0.819  # cosine of half of how far a contact may turn a hand from where it was, 70 degrees
SOFT = 0.006  # metres of depth over which the push out of the body sets in
FIRM = 0.03  # metres of depth from which on a part resists what pushes towards it
THROUGH = 0.25  # of both radii: who is nearer to the other's line passes through it
FULL = 0.9  # from here on, it is pushed all the way
EVEN = 0.05  # how much the middle counts where lines are side by side
STRAIGHT = (0.31, 0.52, 0.8)  # where a straight arm bends to: no side in particular, but always one
ELBOW = 0.3  # how little a forearm is pushed near its elbow, which a wrist cannot move
PASSES = 3  # of the guard
OBSTACLE = 0  # what a capsule is to the guard: others are pushed out of it
FOREARM = 1  # pushed out, from the elbow to the wrist
HAND = 2  # pushed out


@dataclass(frozen=True)
class ContactArm:
    """The places of an arm's joints, and of all joints from its upper arm on, parents first."""

    upper: int
    lower: int
    hand: int
    below: tuple[int, ...]


@dataclass(frozen=True)
class BodyCapsule:
    """A part of the body. joint, to: the places of the joints that carry the ends of its line; a, b: where
    the ends are, in the spaces of those joints. arm: 0 left, 1 right, -1 neither. kind: whether it is pushed
    out of others: an OBSTACLE is not; a FOREARM, from the elbow to the wrist, and a HAND are.
    """

    joint: int
    a: Vector
    to: int
    b: Vector
    radius: float
    arm: int = -1
    kind: int = 0


@dataclass(frozen=True)
class ContactRig:
    """The part of a skeleton that contacts need. joints: parents first. parents: for each joint, the place of
    its parent, -1 for a root. places: joint name -> place. arms: left, right; hands: the names of their
    hands. contacts, guard: whether each is on.
    """

    joints: tuple[int, ...]
    parents: tuple[int, ...]
    places: Mapping[str, int]
    arms: tuple[ContactArm, ...]
    hands: tuple[str, ...]
    capsules: tuple[BodyCapsule, ...]
    contacts: bool = True
    guard: bool = True


@dataclass(frozen=True)
class HandGoal:
    """Where a wrist should be. arm: 0 left, 1 right. to: a place; at, turn: in its space. weight: 0..1."""

    arm: int
    to: int
    at: Vector
    turn: Quaternion
    weight: float


@dataclass
class ContactPose:
    """A pose of a rig's joints: `local` rotations and `moved` translations are in the parents' space;
    `turned` and `at` are in the character's space, and `spread` computes them.
    """

    local: list[Quaternion] = field(default_factory=list)
    moved: list[Vector] = field(default_factory=list)
    turned: list[Quaternion] = field(default_factory=list)
    at: list[Vector] = field(default_factory=list)


def spread(rig: ContactRig, pose: ContactPose) -> None:
    """Compute where all joints are."""
    pose.turned = list(pose.local)
    pose.at = list(pose.moved)
    for place in range(len(rig.parents)):
        _join(rig, pose, place)


def _join(rig: ContactRig, pose: ContactPose, place: int) -> None:
    above = rig.parents[place]
    if above < 0:
        pose.turned[place] = pose.local[place]
        pose.at[place] = pose.moved[place]
    else:
        turn = pose.turned[above]
        x, y, z = rotated(turn, pose.moved[place])
        ax, ay, az = pose.at[above]
        pose.turned[place] = times(turn, pose.local[place])
        pose.at[place] = (ax + x, ay + y, az + z)


def solve_contacts(rig: ContactRig, pose: ContactPose, goals: Sequence[HandGoal]) -> bool:
    """Move hands to their goals, then push hands and forearms out of the body; return whether anything moved.
    Call `spread` first.
    """
    moved = False
    held = [0.0, 0.0]
    across = 0.0  # how much one arm is held on the other
    for goal in goals:
        held[goal.arm] = min(1.0, held[goal.arm] + goal.weight)
        if _on_arm(rig, goal.to, 1 - goal.arm):
            across = max(across, goal.weight)
    rounds = 0 if len(goals) == 0 else 2 if across > 0.0 else 1
    wrists = [pose.at[arm.hand] for arm in rig.arms]
    hands = [pose.turned[arm.hand] for arm in rig.arms]
    while rounds > 0:
        rounds -= 1
        for side in range(len(rig.arms)):
            if held[side] > 0.0:
                _hold(rig, pose, goals, side, wrists[side], hands[side])
                moved = True
    kept = [pose.at[arm.hand] for arm in rig.arms]
    if rig.guard and _guarded(rig, pose, held, across):
        moved = True
        for side in range(len(rig.arms)):
            if across > 0.0 and held[side] > 0.0:
                pushed = minus(pose.at[rig.arms[side].hand], kept[side])
                _hold(rig, pose, goals, side, plus(wrists[side], pushed), hands[side])
    return moved


def _on_arm(rig: ContactRig, place: int, arm: int) -> bool:
    return any(place == below for below in rig.arms[arm].below)


def _hold(
    rig: ContactRig, pose: ContactPose, goals: Sequence[HandGoal], side: int, wrist: Vector, hand: Quaternion
) -> None:
    """Move a hand to the weighted mean of its goals. wrist, hand: its position and rotation without goals."""
    total = 0.0
    x, y, z = 0.0, 0.0, 0.0
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    hx, hy, hz, hw = hand
    for goal in goals:
        if goal.arm == side and goal.weight > 0.0:
            k = goal.weight
            px, py, pz = plus(pose.at[goal.to], rotated(pose.turned[goal.to], goal.at))
            qx, qy, qz, qw = times(pose.turned[goal.to], goal.turn)
            x, y, z, total = x + k * px, y + k * py, z + k * pz, total + k
            if qx * hx + qy * hy + qz * hz + qw * hw < 0.0:
                k = -k
            a, b, c, d = a + k * qx, b + k * qy, c + k * qz, d + k * qw
    weight = min(1.0, total)
    mean = (x / total, y / total, z / total)
    turn = _within_wrist(hand, unit_turn((a, b, c, d)))
    tx, ty, tz, tw = turn
    rest = 1.0 - weight
    k = -weight if tx * hx + ty * hy + tz * hz + tw * hw < 0.0 else weight
    turn = unit_turn((hx * rest + tx * k, hy * rest + ty * k, hz * rest + tz * k, hw * rest + tw * k))
    bring(rig, pose, side, plus(wrist, scaled(minus(mean, wrist), weight)), turn, STRAIGHT)


def _within_wrist(hand: Quaternion, turn: Quaternion) -> Quaternion:
    """Return a hand's rotation, limited to what the wrist allows from the hand's earlier rotation."""
    x, y, z, w = times(turn, back(hand))
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    if w >= WRIST:
        return turn
    k = sqrt(1.0 - WRIST * WRIST) / max(sqrt(x * x + y * y + z * z), 1e-12)
    return times((x * k, y * k, z * k, WRIST), hand)


def bring(
    rig: ContactRig, pose: ContactPose, side: int, goal: Vector, hand: Quaternion, side_of: Vector
) -> None:
    """Move a wrist to a goal, or as near as the arm reaches, with the elbow on the side to which it is bent;
    rotate the hand. side_of: the direction in which a straight arm bends, in the upper arm's own space.
    """
    arm = rig.arms[side]
    root, elbow, wrist = pose.at[arm.upper], pose.at[arm.lower], pose.at[arm.hand]
    bone, fore = minus(elbow, root), minus(wrist, elbow)
    above_elbow, below_elbow = length(bone), length(fore)
    now = length(minus(wrist, root))
    if above_elbow < 1e-6 or below_elbow < 1e-6 or now < 1e-6:
        return
    way = minus(goal, root)
    most = max(REACHED * (above_elbow + below_elbow), now)
    least = min(
        sqrt(
            above_elbow * above_elbow + below_elbow * below_elbow - 2.0 * FOLDED * above_elbow * below_elbow
        ),
        now,
    )
    far = min(max(length(way), least), most)
    ahead, before = unit(way), scaled(minus(wrist, root), 1.0 / now)
    aside = minus(bone, scaled(before, dot(bone, before)))
    # A straight arm has no side: it bends to one that goes with its bone.
    spare = rotated(pose.turned[arm.upper], side_of)
    spare = minus(spare, scaled(before, dot(spare, before)))
    aside = plus(aside, scaled(spare, max(0.0, 0.01 * above_elbow - length(aside))))
    aside = unit(rotated(between(before, ahead), aside))
    along = (above_elbow * above_elbow + far * far - below_elbow * below_elbow) / (2.0 * far)
    high = sqrt(max(0.0, above_elbow * above_elbow - along * along))
    knee = plus(scaled(ahead, along), scaled(aside, high))
    swing = between(unit(bone), unit(knee))
    fold = between(unit(rotated(swing, fore)), unit(minus(scaled(ahead, far), knee)))
    both = times(fold, swing)
    above = _above(rig, pose, arm.upper)
    pose.local[arm.upper] = times(back(above), times(swing, pose.turned[arm.upper]))
    above = times(swing, _above(rig, pose, arm.lower))
    pose.local[arm.lower] = times(back(above), times(both, pose.turned[arm.lower]))
    above = times(both, _above(rig, pose, arm.hand))
    pose.local[arm.hand] = times(back(above), hand)
    for place in arm.below:
        _join(rig, pose, place)


def _above(rig: ContactRig, pose: ContactPose, place: int) -> Quaternion:
    above = rig.parents[place]
    return (0.0, 0.0, 0.0, 1.0) if above < 0 else pose.turned[above]


def _guarded(rig: ContactRig, pose: ContactPose, held: Sequence[float], across: float) -> bool:
    """Push forearms and hands out of the capsules they are inside, by the smallest shift of the wrists;
    return whether any was inside. held: how much a contact holds each hand, which is then not pushed.

    An arm that passes through a capsule is pushed to one side before the middle and to the other side after
    it. The push gets weaker towards the middle, so that the arm does not jump.
    """
    local, turned, at = list(pose.local), list(pose.turned), list(pose.at)
    whole = [1.0, 1.0]
    moved = False
    for number in range(PASSES):
        ends = capsule_ends(rig, pose)
        balls = _balls(rig, ends)
        found = False
        first = number == 0
        shifts = [_shift(rig, ends, balls, side, held, across, whole, first) for side in range(len(rig.arms))]
        for side, shift in enumerate(shifts):
            if length(shift) > 0.0:
                hand = rig.arms[side].hand
                bring(rig, pose, side, plus(pose.at[hand], shift), pose.turned[hand], STRAIGHT)
                found = True
        if not found:
            break
        moved = True
    if moved and min(whole[0], whole[1]) < 1.0:
        goals = [pose.at[arm.hand] for arm in rig.arms]
        pose.local, pose.turned, pose.at = local, turned, at
        for side, arm in enumerate(rig.arms):
            way = minus(goals[side], pose.at[arm.hand])
            if length(way) > 0.0:
                goal = plus(pose.at[arm.hand], scaled(way, whole[side]))
                bring(rig, pose, side, goal, pose.turned[arm.hand], STRAIGHT)
    return moved


def capsule_ends(rig: ContactRig, pose: ContactPose) -> list[Vector]:
    """Return both ends of every capsule's line, one after the other."""
    out: list[Vector] = []
    for capsule in rig.capsules:
        out.append(plus(pose.at[capsule.joint], rotated(pose.turned[capsule.joint], capsule.a)))
        out.append(plus(pose.at[capsule.to], rotated(pose.turned[capsule.to], capsule.b)))
    return out


def _balls(rig: ContactRig, ends: Sequence[Vector]) -> list[Quaternion]:
    """Return a ball round each capsule: its middle and radius."""
    out: list[Quaternion] = []
    for n, capsule in enumerate(rig.capsules):
        ax, ay, az = ends[2 * n]
        bx, by, bz = ends[2 * n + 1]
        x, y, z = bx - ax, by - ay, bz - az
        size = 0.5 * sqrt(x * x + y * y + z * z) + capsule.radius
        out.append((ax + 0.5 * x, ay + 0.5 * y, az + 0.5 * z, size))
    return out


def _shift(
    rig: ContactRig,
    ends: Sequence[Vector],
    balls: Sequence[Quaternion],
    side: int,
    held: Sequence[float],
    across: float,
    whole: list[float],
    first: bool,
) -> Vector:
    """Return the shift of a wrist that brings its arm out of all other capsules, or closer to that. whole:
    for each side, the share of the shift to apply, which the first pass finds.
    """
    shift = (0.0, 0.0, 0.0)
    own = 1.0 - held[side]
    if own <= 0.0:
        return shift
    for i, mine in enumerate(rig.capsules):
        if mine.arm != side or mine.kind == OBSTACLE:
            continue
        mx, my, mz, size = balls[i]
        for k in range(len(balls)):
            ox, oy, oz, most = balls[k]
            dx, dy, dz, reach = ox - mx, oy - my, oz - mz, most + size
            if dx * dx + dy * dy + dz * dz >= reach * reach:
                continue  # most are nowhere near
            other = rig.capsules[k]
            if other.arm == side:
                continue
            share = own
            if other.arm >= 0:
                share = min(own, 1.0 - across)
                if other.kind != OBSTACLE:  # both give way
                    share = share * (1.0 - 0.5 * (1.0 - held[other.arm]))
            if share <= 0.0:
                continue
            x, y, z, gap = apart(ends, 2 * i, 2 * k)
            radii = mine.radius + other.radius
            if gap >= radii or gap < 1e-9:
                continue
            depth = radii - gap
            amount = depth - 0.5 * SOFT if depth > SOFT else depth * depth / (2.0 * SOFT)
            # Near to the line it is not pushed all the way, and about it not at all.
            inner = min(1.0, max(0.0, (gap / radii - THROUGH) / (FULL - THROUGH)))
            inner = inner * inner * (3.0 - 2.0 * inner)
            if first:
                whole[side] = min(whole[side], 1.0 - share * (1.0 - inner))
                inner = 1.0
            amount = amount * share * inner
            part = _along(ends, 2 * i, 2 * k) if mine.kind == FOREARM else 1.0
            way = (x / gap, y / gap, z / gap)
            pushed = part * dot(way, shift)
            if pushed < 0.0:  # others push towards it: what hardly touches or hardly counts hardly resists
                pushed = pushed * share * min(1.0, depth / FIRM)
            left = amount - pushed
            if left > 0.0:
                shift = plus(shift, scaled(way, left * part / (part * part + ELBOW * (1.0 - part))))
    return shift


def _along(ends: Sequence[Vector], i: int, k: int) -> float:
    """Return where on the line that begins at `ends[i]` the shortest way from the line at `ends[k]` ends,
    0..1. For nearly parallel lines, where it could end anywhere, the result moves towards the middle.
    """
    a, c = ends[i], ends[k]
    u, v, w = minus(ends[i + 1], a), minus(ends[k + 1], c), minus(a, c)
    uu, uv, vv, uw, vw = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    if uu <= 1e-12:
        return 0.0
    stiff, middle = (1.0 + EVEN) * uu, 0.5 * EVEN * uu - uw
    if vv <= 1e-12:
        return min(max(middle / stiff, 0.0), 1.0)
    s = min(max((vv * middle + uv * vw) / (stiff * vv - uv * uv), 0.0), 1.0)
    t = (uv * s + vw) / vv
    if t < 0.0 or t > 1.0:
        s = min(max((uv * min(max(t, 0.0), 1.0) + middle) / stiff, 0.0), 1.0)
    return s


def apart(ends: Sequence[Vector], i: int, k: int) -> Quaternion:
    """Return the shortest way from the line that begins at `ends[k]` to the one at `ends[i]`, and
    its length. Its vectors are written out, since a guarded pose asks some thirty times.
    """
    ax, ay, az = ends[i]
    bx, by, bz = ends[i + 1]
    cx, cy, cz = ends[k]
    dx, dy, dz = ends[k + 1]
    ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, dx - cx, dy - cy, dz - cz
    wx, wy, wz = ax - cx, ay - cy, az - cz
    uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
    uw, vw = ux * wx + uy * wy + uz * wz, vx * wx + vy * wy + vz * wz
    s, t = 0.0, 0.0
    if uu > 1e-12:
        below = uu * vv - uv * uv
        if below > 1e-9 * uu * vv:
            s = min(max((uv * vw - vv * uw) / below, 0.0), 1.0)
        if vv > 1e-12:
            t = (uv * s + vw) / vv
            if t < 0.0 or t > 1.0:
                t = min(max(t, 0.0), 1.0)
                s = min(max((uv * t - uw) / uu, 0.0), 1.0)
        else:
            s = min(max(-uw / uu, 0.0), 1.0)
    elif vv > 1e-12:
        t = min(max(vw / vv, 0.0), 1.0)
    x, y, z = wx + ux * s - vx * t, wy + uy * s - vy * t, wz + uz * s - vz * t
    return x, y, z, sqrt(x * x + y * y + z * z)
