"""One pose brought to life: how head, eyes and lids turn, in plain numbers. Rotations are quaternions xyzw,
angles radians.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, copysign, cos, hypot, pi, radians, sin, sqrt, tanh
from typing import NamedTuple

from metagraph.playback.life.body import Body, Quaternion, Vector
from metagraph.playback.life.gaze import Moves, ease_gaze

# The head's part of a turn: next to none of a small one (`SMALL`), then more; all that is beyond what eyes do
# with ease.
SMALL = radians(15.0)
TILT_SHARE = 0.8  # of up and down the head does less
EYE_EASE = radians(20.0)
TURNED_AWAY = radians(28.0)  # a body and head that both face farther away than this are turned back
HEAD_SIDEWAYS, HEAD_UP, HEAD_DOWN = radians(65.0), radians(30.0), radians(35.0)
# Eyes turn freely within 0.7 of these, and never beyond.
EYE_SIDEWAYS, EYE_UP, EYE_DOWN = radians(32.0), radians(26.0), radians(30.0)
FREE = 0.7
LOOK_SIDEWAYS, LOOK_UPRIGHT = (
    radians(110.0),
    radians(65.0),
)  # beyond these nobody looks, however much the target is behind
# What is behind is looked at ever less, so that nothing turns from one side to the other in a moment.
LOOK_BEHIND, TURN_BEHIND, EYES_BEHIND = radians(120.0), radians(85.0), radians(100.0)
TURNED_BACK = radians(95.0)  # the farthest that a body counts as turned away
NEAREST = 0.25  # metres; nearer things are looked at as if they were there
WIDEST = -0.8  # how far lids open beyond rest, of their shutting turn


class LifeNow(NamedTuple):
    """What happens at a time. full: how full the chest is. droop, thrust: of the posture. lift, tight: of
    what rises and tightens, breath and mood together. closed: how close the arms are kept. blink: how far a
    blink has shut the eyes, below 0 open wide.
    """

    full: float
    droop: float
    thrust: float
    lift: float
    tight: float
    closed: float
    blink: float


class LifeDials(NamedTuple):
    """gaze: the amount of all looking. calm: of what nobody asked for. head: its share of a turn. lids: how
    far they follow the eyes.
    """

    gaze: float
    calm: float
    head: float
    lids: float


class FaceLids(NamedTuple):
    """A face's lids, in the order of `face.LIDS`. joints: whether each is one. follows, shut_by: as
    `FaceRig`.
    """

    joints: Sequence[bool]
    follows: Sequence[float]
    shut_by: Sequence[Quaternion]


def solve_life(
    body: Body,
    lids: FaceLids,
    dials: LifeDials,
    now: LifeNow,
    read: list[Quaternion],
    places: Sequence[Vector],
    gaze: Moves,
    looks: bool,
) -> tuple[list[Quaternion], list[Vector], list[tuple[float, float]], list[float], list[float]]:
    """Return a body's chain as breath and posture have it, the turns of its joints but the face's, rotation
    vectors, those of the eyes, how far each lid is shut, and how much of that is life's own.

    read: rotations of `body.read`; places: translations of the chain. looks: whether `gaze` counts.
    """
    long = len(places)
    chain = read[:long]
    if now.full != 0.0 or now.droop != 0.0 or now.thrust != 0.0:
        breathe(body, chain, now.full, now.droop, now.thrust)
    turn = [(0.0, 0.0, 0.0) for _ in range(long)]
    eyes = [(0.0, 0.0), (0.0, 0.0)]
    if looks:
        towards, eyes = look(body, chain, places, gaze, dials.gaze, dials.calm, dials.head)
        for k, looker in enumerate(body.lookers):
            turn[looker.place] = towards[k]
    for k, shoulder in enumerate(body.shoulders):
        rises = _scaled(shoulder, now.lift)
        if now.tight != 0.0:
            rises = _plus(rises, _scaled(body.tense[k], now.tight))
        turn.append(_plus(rises, _scaled(body.closed[k], now.closed)) if now.closed != 0.0 else rises)
    down = [-eyes[0][1], -eyes[1][1]]
    place = long
    for side, eye in enumerate(body.eyes):
        if eye.joint:
            turn.append(_plus(_scaled(eye.turn_left, eyes[side][0]), _scaled(eye.turn_up, eyes[side][1])))
            down[side] += measure_part_along(read[place], eye.down)
            place += 1
    shut: list[float] = []
    own: list[float] = []
    for k in range(len(lids.joints)):
        already = 0.0
        if lids.joints[k]:
            already = measure_part_along(read[place], lids.shut_by[k])
            place += 1
        shut.append(compute_lid(down[k % 2], dials.lids * lids.follows[k], already, now.blink))
        own.append(shut[k] - already)
    return chain, turn, eyes, shut, own


def breathe(body: Body, chain: list[Quaternion], full: float, droop: float, thrust: float) -> None:
    """Turn the chain's joints as a breath and a posture do; full: how full the chest is; droop: how bowed;
    thrust: how far it leans into it.
    """
    for n, (axis, angle) in enumerate(body.breath):
        half = 0.5 * (full * angle + droop * body.bowed[n] + thrust * body.thrust[n])
        if half:
            s = sin(half)
            chain[n] = multiply_quaternions(chain[n], (axis[0] * s, axis[1] * s, axis[2] * s, cos(half)))


def look(
    body: Body,
    chain: Sequence[Quaternion],
    places: Sequence[Vector],
    gaze: Moves,
    amount: float,
    calm: float,
    share: float,
) -> tuple[list[Vector], list[tuple[float, float]]]:
    """Return the turns of the body's lookers, rotation vectors in their own space, and of both eyes, radians
    to the left and up.

    chain: the joints' composed rotations, in their parents' space, and places: their translations. amount: of
    all looking; calm: of what nobody asked for. share: the head's of a turn.
    """
    turned, at = compute_globals(chain, places)
    head = turned[-1]
    left, right = body.eyes
    middle = _scaled(_plus(left.at, right.at), 0.5)
    eye = _plus(at[-1], rotate_tuple(head, middle))
    # Where the targets are, seen from there; the eyes' and the head's share of each.
    eyes_x = eyes_y = head_x = head_y = near = whole = 0.0
    for aim, came, moved in gaze.parts:
        away = _minus(aim.at, eye)
        x, y, z = _dot(body.left, away), _dot(body.up, away), _dot(body.ahead, away)
        level = hypot(x, z)
        sideways = _turning(atan2(x, z), LOOK_SIDEWAYS, LOOK_BEHIND)
        upwards = _within(atan2(y, level), LOOK_UPRIGHT)
        weight = aim.amount * amount * (1.0 if aim.asked else calm)
        eyes_x, eyes_y, near = (
            eyes_x + came * sideways,
            eyes_y + came * upwards,
            near + came / max(hypot(level, y), NEAREST),
        )
        head_x, head_y, whole = (
            head_x + moved * weight * sideways,
            head_y + moved * weight * upwards,
            whole + came * weight,
        )
    vector, size = _head(body, turned, head_x + gaze.head[0], head_y + gaze.head[1], whole, share)
    turns = [_scaled(rotate_tuple(_back(turned[j.place]), vector), j.share) for j in body.lookers]
    # Where that brings the eyes: every joint that turns carries what is above it along.
    moved_to, so_far = at[body.lookers[0].place], 0.0
    unit = _scaled(vector, 1 / size) if size > 1e-12 else (0.0, 1.0, 0.0)
    ends = [at[j.place] for j in body.lookers[1:]] + [at[-1]]
    for k, looker in enumerate(body.lookers):
        so_far += looker.share
        arm = _minus(ends[k], at[looker.place])
        moved_to = _plus(moved_to, rotate_tuple(_about(unit, size * so_far), arm))
    head = multiply_quaternions(_about(unit, size), head)
    # The point looked at, in the head's space; each eye turns to it the shortest way, so that it does not
    # roll.
    sideways, upwards = eyes_x + gaze.eyes[0], eyes_y + gaze.eyes[1]
    far = 1 / max(near, 1e-3)
    x, y, z = sin(sideways) * cos(upwards) * far, sin(upwards) * far, cos(sideways) * cos(upwards) * far
    ahead = _plus(_plus(_scaled(body.left, x), _scaled(body.up, y)), _scaled(body.ahead, z))
    inside = rotate_tuple(_back(head), _minus(_plus(eye, ahead), moved_to))
    out: list[tuple[float, float]] = []
    for side in body.eyes:
        away = _minus(inside, side.at)
        x, y = _dot(side.left, away), _dot(side.up, away)
        across = hypot(x, y)
        angle = _turning(atan2(across, _dot(side.ahead, away)), pi, EYES_BEHIND) / max(across, 1e-12) * whole
        rest = 1 - whole
        out.append(limit_eye_turn(x * angle + gaze.eyes[0] * rest, y * angle + gaze.eyes[1] * rest))
    return turns, out


def _head(
    body: Body, turned: Sequence[Quaternion], left: float, up: float, amount: float, share: float
) -> tuple[Vector, float]:
    """Return the head's turn towards a target `left` and `up` of ahead: a rotation vector in the character's
    space, its size.
    """
    beyond = min(1.0, 2 * share)
    x, y = compute_head_part(left, share), TILT_SHARE * compute_head_part(up, share)
    x, y = x + beyond * _excess(left - x, EYE_EASE), y + beyond * _excess(up - y, EYE_EASE)
    # A character that has turned away as a whole turns its head back; one whose head alone or body alone has,
    # means it.
    trunk = _gap(body, left, rotate_tuple(turned[body.trunk], body.trunk_ahead))
    face = _gap(body, left, rotate_tuple(turned[-1], body.head_ahead))
    both = max(min(trunk, face), 0.0) + min(max(trunk, face), 0.0)
    x += beyond * amount * _excess(both, max(TURNED_AWAY, abs(left)))
    x, y = _within(x, HEAD_SIDEWAYS), min(max(y, -HEAD_DOWN), HEAD_UP)
    # First up, then round: the head does not tilt to a shoulder.
    cx, sx, cy, sy = cos(0.5 * x), sin(0.5 * x), cos(0.5 * y), -sin(0.5 * y)
    a, b, c, w = cx * sy, sx * cy, -sx * sy, cx * cy
    length = sqrt(a * a + b * b + c * c)
    size = 2 * atan2(length, w)
    k = size / length if length > 1e-12 else 0.0
    return _plus(_plus(_scaled(body.left, a * k), _scaled(body.up, b * k)), _scaled(body.ahead, c * k)), size


def _gap(body: Body, left: float, facing: Vector) -> float:
    """Return how far it is from where somebody faces to `left`, the short way round; less of it if that is
    behind, or where they face up or down.
    """
    x, z = _dot(body.left, facing), _dot(body.ahead, facing)
    gap = left - atan2(x, z)
    gap = gap - 2 * pi if gap > pi else gap + 2 * pi if gap < -pi else gap
    return _turning(gap, TURNED_BACK, TURN_BEHIND) * ease_gaze(2 * hypot(x, z))


def _turning(angle: float, most: float, behind: float) -> float:
    """Return an angle kept within a limit, and ever less of it from `behind` to half a turn."""
    return _within(angle, most) * (1 - ease_gaze((abs(angle) - behind) / (pi - behind)))


def compute_head_part(angle: float, share: float) -> float:
    """Return the head's part of a turn: `share` of a wide one, next to none of a small one."""
    size = abs(angle)
    return share * angle * size / (size + SMALL)


def limit_eye_turn(left: float, up: float) -> tuple[float, float]:
    """Return an eye's turn kept within what eyes can do, softly near the limit."""
    far = hypot(left / EYE_SIDEWAYS, up / (EYE_UP if up > 0 else EYE_DOWN))
    if far <= FREE:
        return left, up
    k = (FREE + (1 - FREE) * tanh((far - FREE) / (1 - FREE))) / far
    return left * k, up * k


def compute_lid(down: float, follow: float, already: float, blink: float) -> float:
    """Return how far a lid is shut: 0 open as at rest, 1 shut. down: the eye's pitch. follow: of the lid, a
    radian of it.

    already: how far a clip has shut it; a blink shuts what is left, so that lids meet and go no farther.
    """
    shut = min(max(already + follow * down, WIDEST), 1.0)
    return shut + blink * (1 - shut)


def measure_part_along(q: Sequence[float], row: Sequence[float]) -> float:
    """Return what a rotation near rest has in common with a row of `Eye.down` or `FaceRig.shut_by`."""
    along = q[0] * row[0] + q[1] * row[1] + q[2] * row[2] + q[3] * row[3]
    return along if q[3] >= 0 else -along


def compute_globals(
    chain: Sequence[Quaternion], places: Sequence[Vector]
) -> tuple[list[Quaternion], list[Vector]]:
    """Return rotations and positions of a chain in the character's space, from those in the parents'."""
    turned, at = [chain[0]], [places[0]]
    for n in range(1, len(chain)):
        at.append(_plus(at[-1], rotate_tuple(turned[-1], places[n])))
        turned.append(multiply_quaternions(turned[-1], chain[n]))
    return turned, at


# --- arithmetic


def multiply_quaternions(a: Sequence[float], b: Sequence[float]) -> Quaternion:
    """Return the product: rotate by `b`, then by `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate_tuple(q: Sequence[float], v: Sequence[float]) -> Vector:
    """Return a vector rotated."""
    x, y, z, w = q
    vx, vy, vz = v
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx


def _about(axis: Vector, angle: float) -> Quaternion:
    s = sin(0.5 * angle)
    return axis[0] * s, axis[1] * s, axis[2] * s, cos(0.5 * angle)


def _back(q: Sequence[float]) -> Quaternion:
    return -q[0], -q[1], -q[2], q[3]


def _plus(a: Sequence[float], b: Sequence[float]) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _minus(a: Sequence[float], b: Sequence[float]) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _scaled(a: Sequence[float], k: float) -> Vector:
    return a[0] * k, a[1] * k, a[2] * k


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _within(x: float, limit: float) -> float:
    return min(max(x, -limit), limit)


def _excess(x: float, free: float) -> float:
    return copysign(max(abs(x) - free, 0.0), x)
