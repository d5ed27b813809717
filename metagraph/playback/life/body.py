"""What of a body breathes and looks: found once for a project's skeleton, base pose and face."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.face.rig import CHANNELS, SIDES, FaceRig, find_body_axes, find_face
from metagraph.graph.model import Project
from metagraph.motion import rotation
from metagraph.motion.joint_map import NEEDED, find_known_roles
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.standing import is_standing
from metagraph.playback.life.tension import CLOSED, TENSE, find_tension

Array = NDArray[Any]

# Degrees at the top of a breath, about the axis to the left (plus bends forwards): the chest rises and opens,
# neck and head undo it, so that the face stays level. Collar bones lift about the axis ahead.
BREATH = {"spine": -0.2, "chest": -0.9, "upper_chest": -0.7, "neck": 0.75, "head": 0.85}
SHOULDERS = 1.3
# Degrees a bowed posture bends each forwards (`mood.Bearing.droop` of 1): the head most; ours.
BOWED = {"spine": 4.0, "chest": 5.0, "upper_chest": 5.0, "neck": 5.0, "head": 11.0}
# The same of a body that leans into it (`mood.Bearing.thrust` of 1; below 0 it draws back): trunk ahead, face
# nearly level.
THRUST = {"spine": 6.0, "chest": 6.0, "upper_chest": 4.0, "neck": 6.0, "head": -20.0}
# Who takes how much of a turn towards what is looked at; what a skeleton lacks, the others take. The turn
# grows with the square of small angles, so a glance moves the trunk by a degree, and a look far aside turns
# it along.
SHARES = {"spine": 0.08, "chest": 0.08, "upper_chest": 0.08, "neck": 0.30, "head": 0.46}
# Metres ahead, at the height of the eyes, where "user" is unless somebody says otherwise; as much farther as
# a figure is larger than `LARGE` metres, whose head would pass by it.
PARTNER_AWAY, LARGE = 1.2, 2.4
# Where the eyes are, seen from the head's joint, in heights of the figure: up, ahead, to each side.
EYE_UP, EYE_AHEAD, EYE_SIDE = 0.055, 0.05, 0.018


Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Looker:
    """A joint that takes part in turning the head: its place in the chain, its share; all shares sum to 1."""

    place: int
    share: float


@dataclass(frozen=True, slots=True)
class EyeAt:
    """An eye, or where one would be, in the head's own space: where it is, and its directions to the left, up
    and ahead.

    joint: whether it is one. turn_left, turn_up: rotation vectors in the joint's own space that turn it a
    radian. down: what the joint's own rotation says about how far down it looks already, radians: the product
    of the two, part by part.
    """

    at: Vector
    left: Vector
    up: Vector
    ahead: Vector
    joint: bool
    turn_left: Vector
    turn_up: Vector
    down: Quaternion


@dataclass(frozen=True, eq=False)
class Body:
    """What lives in a body. Directions `left`, `up`, `ahead` are the character's; metres.

    chain: the joints from the root to the head, or to the chest if there is none. breath: for each of them
    the axis it turns about in its own space and by how many radians at the top of a breath. bowed: by how
    many in a bowed posture, thrust: in one that leans into it. joints: all that life may turn: the chain,
    then shoulders and what else tightens, eyes that are joints, the face's. read: whose rotations it must
    know: the chain, eyes that are joints, lids. shoulders: their rotation vectors at the top of a breath;
    tense: those of the same joints at full tension; closed: of arms kept close. lookers: empty if there is no
    head, from the root upwards. trunk: its place in the chain; trunk_ahead, head_ahead: ahead in their own
    space. eyes: left, right. partner: where "user" is; eyes_at_rest: between the eyes in the base pose.
    """

    left: Vector
    up: Vector
    ahead: Vector
    chain: Array
    breath: tuple[tuple[Vector, float], ...]
    bowed: tuple[float, ...]
    thrust: tuple[float, ...]
    joints: Array
    read: Array
    shoulders: tuple[Vector, ...]
    tense: tuple[Vector, ...]
    closed: tuple[Vector, ...]
    lookers: tuple[Looker, ...]
    trunk: int
    trunk_ahead: Vector
    head_ahead: Vector
    eyes: tuple[EyeAt, EyeAt]
    partner: Vector
    eyes_at_rest: Vector
    face: FaceRig

    @property
    def empty(self) -> bool:
        """Whether nothing of it can live."""
        return not (
            self.lookers
            or len(self.shoulders)
            or any(angle for _, angle in self.breath)
            or not self.face.empty
        )


def _vector(values: Any) -> Vector:
    x, y, z = (float(v) for v in values)
    return x, y, z


def _upright_pose(project: Project, roles: Mapping[str, int]) -> Pose:
    """Return the base pose; if nobody has chosen one and the rest pose is a heap on the floor, the first
    clip's first frame.
    """
    skeleton, pose = project.skeleton, anatomy.get_base_pose(project)
    if project.base.clip or skeleton is None or any(role not in roles for role in NEEDED):
        return pose
    if is_standing(skeleton, roles):
        return pose
    motions = (entry.motion for entry in project.clips.values())
    first = next((m for m in motions if m is not None and m.skeleton == skeleton), None)
    return pose if first is None else first.pose_at(0.0)


def find_body(project: Project) -> Body:
    """Return the body of a project with a skeleton."""
    skeleton = project.skeleton
    assert skeleton is not None
    roles = anatomy.project_roles(project)
    turned, at = (x.astype(float) for x in skeleton.globals(_upright_pose(project, roles)))
    left, up, ahead = axes = find_body_axes(
        skeleton, {r: j for r, j in roles.items() if not r.endswith("eye")}, at
    )
    face = find_face(project)

    def local(joint: int, axis: Array) -> Array:
        return rotation.rotate_vectors(rotation.conjugate(turned[joint]), axis)

    head = roles.get("head")
    top = next((roles[r] for r in ("head", "neck", "upper_chest", "chest", "spine") if r in roles), 0)
    chain = list(skeleton.chain(top))
    breath: list[tuple[Vector, float]] = [((1.0, 0.0, 0.0), 0.0)] * len(chain)
    for role, degrees in BREATH.items():
        if roles.get(role) in chain:
            breath[chain.index(roles[role])] = (_vector(local(roles[role], left)), float(np.radians(degrees)))
    bowed, thrust = [0.0] * len(chain), [0.0] * len(chain)
    for degrees_of, radians in ((BOWED, bowed), (THRUST, thrust)):
        for role, degrees in degrees_of.items():
            if roles.get(role) in chain:
                radians[chain.index(roles[role])] = float(np.radians(degrees))
    collars = [
        (roles[f"{s}_shoulder"], sign)
        for s, sign in zip(SIDES, (1, -1), strict=True)
        if f"{s}_shoulder" in roles
    ]
    lifts = {j: np.radians(SHOULDERS) * sign * local(j, ahead) for j, sign in collars}
    known = find_known_roles(skeleton, roles)
    tight, closed = (find_tension(known, at, axes, local, amounts) for amounts in (TENSE, CLOSED))
    seen = {*chain, *(e.joint for e in face.eyes), *face.joints.tolist()}
    rising = [*lifts, *(j for j in tight if j not in lifts and j not in seen)]
    none = np.zeros(3)
    found = {r: chain.index(roles[r]) for r in SHARES if roles.get(r) in chain} if head is not None else {}
    whole = sum(SHARES[r] for r in found)
    lookers = sorted((Looker(place, SHARES[r] / whole) for r, place in found.items()), key=lambda x: x.place)
    trunk = next(
        (roles[r] for r in ("upper_chest", "chest", "spine", "hips") if roles.get(r) in chain), chain[0]
    )
    eyes = _eyes(skeleton, face, top, axes, local)
    middle = np.mean([eye.at for eye in eyes], axis=0) if head is not None else np.zeros(3)
    rest = at[top] + rotation.rotate_vectors(turned[top], middle)
    joints = [*chain, *rising, *(e.joint for e in face.eyes), *face.joints.tolist()]
    read = [*chain, *(e.joint for e in face.eyes), *(j for j in face.lid_joints.tolist() if j >= 0)]
    return Body(
        _vector(left),
        _vector(up),
        _vector(ahead),
        np.array(chain),
        tuple(breath),
        tuple(bowed),
        tuple(thrust),
        np.array(joints),
        np.array(read),
        tuple(_vector(lifts.get(j, none)) for j in rising),
        tuple(_vector(tight.get(j, none)) for j in rising),
        tuple(_vector(closed.get(j, none)) for j in rising),
        tuple(lookers),
        chain.index(trunk),
        _vector(local(trunk, ahead)),
        _vector(local(top, ahead)),
        eyes,
        _vector(rest + PARTNER_AWAY * max(1.0, skeleton.height / LARGE) * ahead),
        _vector(rest),
        face,
    )


def _eyes(
    skeleton: Skeleton, face: FaceRig, head: int, axes: Array, local: Callable[[int, Array], Array]
) -> tuple[EyeAt, EyeAt]:
    """Return both eyes; the rest pose tells where those look that are joints, since the head of the base pose
    may hang a little.
    """
    turned, at = skeleton.globals(skeleton.rest)
    back = rotation.conjugate(turned[head])
    spot = skeleton.height * (EYE_UP * axes[1] + EYE_AHEAD * axes[2])
    out = []
    for side, sign in zip(SIDES, (1, -1), strict=True):
        eye = next((e for e in face.eyes if e.side == side), None)
        if eye is None:
            looks = [_vector(local(head, axis)) for axis in axes]
            place = _vector(local(head, spot + sign * skeleton.height * EYE_SIDE * axes[0]))
            out.append(EyeAt(place, looks[0], looks[1], looks[2], False, (0.0,) * 3, (0.0,) * 3, (0.0,) * 4))
            continue
        looks = [
            _vector(rotation.rotate_vectors(back, rotation.rotate_vectors(turned[eye.joint], axis)))
            for axis in eye.axes
        ]
        place = _vector(rotation.rotate_vectors(back, at[eye.joint] - at[head]))
        # rest^-1 q is nearly 1 + half the turn: the vector part along the axis to the left, doubled, is how
        # far down it looks.
        basis = rotation.multiply(rotation.conjugate(skeleton.rest_rotations[eye.joint]), np.eye(4))[:, :3]
        x, y, z, w = (2 * basis @ eye.axes[0]).tolist()
        turn = (
            _vector(eye.axes[1]),
            _vector(-eye.axes[0]),
        )  # to the left is about up, upwards about the right
        out.append(EyeAt(place, looks[0], looks[1], looks[2], True, *turn, (x, y, z, w)))
    return out[0], out[1]


def _lifeless() -> Body:
    """Return a body of which nothing can live."""
    axes: tuple[Vector, Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    none: Vector = (0.0, 0.0, 0.0)
    eye = EyeAt(none, *axes, False, none, none, (0.0, 0.0, 0.0, 0.0))
    shapes, first = np.zeros((len(CHANNELS), 0, 3)), np.zeros(1, int)
    face = FaceRig((), np.zeros(0, int), shapes, shapes, np.zeros(4), np.full(4, -1), np.zeros((4, 4)), {})
    breath = ((axes[0], 0.0),)
    return Body(
        *axes,
        first,
        breath,
        (0.0,),
        (0.0,),
        first,
        first,
        (),
        (),
        (),
        (),
        0,
        axes[2],
        axes[2],
        (eye, eye),
        axes[2],
        none,
        face,
    )


LIFELESS = _lifeless()  # of a character of which nothing lives
