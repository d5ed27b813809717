"""Compute where the points of a character are over time, relative to its own ground, for the measures of
`traits`.

Each layer's points are relative to what carries it: the arms to the chest, the head to the chest as the hips
face, the body to the ground between the feet. Lengths are in character heights, directions are the
character's own (x left, y up, z ahead).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.words import Layer
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.suggest.self_contact import SKULL

Array = NDArray[Any]

FINGERS = 5  # fingertips of a hand that are used
AHEAD = 0.12  # heights from the middle of the head to its nose and its top, about
NAMES: Mapping[Layer, tuple[str, ...]] = {
    "arms": tuple(
        f"{side}_{part}" for side in ("left", "right") for part in ("hand", "tip", "lower_arm", "upper_arm")
    ),
    "head": ("head", "nose", "crown"),
    "body": ("hips", "trunk", "trunk_ahead", "left_lower_leg", "left_foot", "right_lower_leg", "right_foot"),
}
_CARRIERS = ("upper_chest", "chest", "spine", "hips")
_WORLD = ("_hand", "_tip", "_lower_arm", "_upper_arm", "_upper_leg", "_lower_leg")
_LIMBS = ("upper_arm", "lower_arm", "hand", "upper_leg", "lower_leg", "foot")


@dataclass(frozen=True, eq=False)
class PosedFigure:
    """The part of a skeleton that is posed.

    `keep` has the joints, with every parent; `places` maps roles to indices among them. `turned` has the
    rotation from each role's axes to the character's. `tips` has for each side the indices of the fingertips,
    the farthest from the wrist first.
    """

    small: Skeleton
    keep: Array
    places: Mapping[str, int]
    turned: Mapping[str, Array]
    tips: Mapping[str, tuple[int, ...]]
    height: float


def make_posed_figure(skeleton: Skeleton, named: tuple[tuple[str, int], ...]) -> PosedFigure:
    """Return the figure of a skeleton whose roles are `named` (role, joint), in its rest pose."""
    roles = dict(named)
    wanted = {r: j for r, j in roles.items() if r in (*_CARRIERS, "head") or r.endswith(_LIMBS)}
    if "hips" not in wanted:
        wanted["hips"] = 0
    tips: dict[str, list[int]] = {}
    turns, at = skeleton.globals(skeleton.rest)
    for side in ("left", "right"):
        if (hand := roles.get(f"{side}_hand")) is not None:
            ends = [j for j in skeleton.descendants(hand) if not skeleton.children[j] and j != hand]
            if ends:
                tips[side] = sorted(
                    ends, key=lambda j: (-round(float(np.linalg.norm(at[j] - at[hand])), 5), j)
                )[:FINGERS]
    if len(wanted) < 3:  # not a known figure: use a few of its joints from the root on
        wanted |= {
            f"joint {j}": int(j)
            for j in np.unique(np.linspace(0, len(skeleton) - 1, min(len(skeleton), 12)).astype(int))
        }
    keep = np.array(
        sorted(
            {
                j
                for end in (*wanted.values(), *(t for some in tips.values() for t in some))
                for j in skeleton.chain(end)
            }
        )
    )
    place = {int(j): i for i, j in enumerate(keep)}
    parents = np.array([place.get(int(skeleton.parents[j]), -1) for j in keep])
    small = Skeleton(
        tuple(skeleton.names[j] for j in keep),
        parents,
        skeleton.rest_rotations[keep],
        skeleton.rest_translations[keep],
    )
    axes = _axes_at_rest({r: at[j] for r, j in wanted.items()})
    turned = {r: rotation.multiply(rotation.conjugate(turns[j]), axes) for r, j in wanted.items()}
    return PosedFigure(
        small,
        keep,
        {r: place[j] for r, j in wanted.items()},
        turned,
        {s: tuple(place[j] for j in some) for s, some in tips.items()},
        skeleton.height,
    )


def _axes_at_rest(at: Mapping[str, Array]) -> Array:
    """Return the rotation whose axes are the character's left, up and ahead in its rest pose."""
    across = find_leftward(at)
    top = at.get("head", at.get("upper_chest", at.get("chest")))
    up = np.array([0.0, 1.0, 0.0]) if top is None else top - at["hips"]
    if across is None or np.linalg.norm(across) < 1e-6 or np.linalg.norm(up) < 1e-6:
        return np.array([0.0, 0.0, 0.0, 1.0])
    if up[1] > 0.7 * np.linalg.norm(up):
        up = np.array([0.0, 1.0, 0.0])
    up = up / np.linalg.norm(up)
    left = across - up * (across @ up)
    if np.linalg.norm(left) < 1e-6:
        return np.array([0.0, 0.0, 0.0, 1.0])
    left = left / np.linalg.norm(left)
    return rotation.from_matrix(np.stack([left, up, np.cross(left, up)], axis=-1))


def find_leftward(at: Mapping[str, Array]) -> Array | None:
    """Return the vector from right to left, of hips and shoulders together; None if both are missing."""
    pairs = [
        at[f"left_{part}"] - at[f"right_{part}"]
        for part in ("upper_leg", "upper_arm")
        if {f"left_{part}", f"right_{part}"} <= set(at)
    ]
    return np.sum(pairs, axis=0) if pairs else None


def measure_body_points(
    figure: PosedFigure, clips: Sequence[Clip], frames: Sequence[Array]
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return name -> `[F, 3]` of all NAMES that exist, each relative to its ground, and of the points in
    world space; in heights.
    """
    posed = _Posed(figure, clips, frames)
    return posed.arms() | posed.head() | posed.body() | posed.fingers(), posed.world()


class _Posed:
    """A figure in frames of clips.

    `places` `[F, J, 3]` has all its joints, `p` those known by role `[F, 3]`, in heights. `turns` is `[F, J,
    4]`. `carrier` is the role of the joint that carries the arms.
    """

    def __init__(self, figure: PosedFigure, clips: Sequence[Clip], frames: Sequence[Array]) -> None:
        self.figure = figure
        self.turns, places = figure.small.globals(_pose(figure, clips, frames))
        self.places = places / np.float32(figure.height)
        self.p = {role: self.places[:, i] for role, i in figure.places.items()}
        self.p |= {f"{side}_tip": self.places[:, some[0]] for side, some in figure.tips.items()}
        self.carrier = next(role for role in _CARRIERS if role in figure.places)
        self.facing = measure_facing(self.p, self.turns[:, figure.places["hips"]], figure.turned["hips"])

    def axis(self, role: str, direction: Sequence[float]) -> Array:
        """Return where one of the character's directions points after a joint has turned."""
        return rotation.rotate_vectors(
            self.turns[:, self.figure.places[role]],
            rotation.rotate_vectors(self.figure.turned[role], np.array(direction)).astype(np.float32),
        )

    def arms(self) -> dict[str, Array]:
        """Return the arms' points, relative to the joint that carries them."""
        p, place, turned = self.p, self.figure.places[self.carrier], self.figure.turned[self.carrier]
        back = rotation.conjugate(rotation.multiply(self.turns[:, place], turned.astype(np.float32)))
        return {
            name: rotation.rotate_vectors(back, p[name] - p[self.carrier])
            for name in NAMES["arms"]
            if name in p
        }

    def head(self) -> dict[str, Array]:
        """Return the head's points, relative to the joint that carries it."""
        if "head" not in self.p:
            return {}
        ahead, up = self.axis("head", (0, 0, 1)), self.axis("head", (0, 1, 0))
        middle = self.p["head"] - self.p[self.carrier]
        points = {"head": middle, "nose": middle + AHEAD * ahead, "crown": middle + AHEAD * up}
        return {name: turn_to_viewer(self.facing, v) for name, v in points.items()}

    def body(self) -> dict[str, Array]:
        """Return the body's points, relative to the ground between the feet."""
        p, facing = self.p, self.facing
        if "left_foot" in p and "right_foot" in p:
            ground = (p["left_foot"] + p["right_foot"]) / 2 * np.array([1, 0, 1], np.float32)
        else:
            ground = p["hips"] * np.array([1, 0, 1], np.float32)
        legs = [f"{side}_{part}" for side in ("left", "right") for part in ("lower_leg", "foot")]
        out = {name: turn_to_viewer(facing, p[name] - ground) for name in ("hips", *legs) if name in p}
        trunk = p[self.carrier] - ground
        out["trunk"] = turn_to_viewer(facing, trunk)
        out["trunk_ahead"] = turn_to_viewer(facing, trunk + AHEAD * self.axis(self.carrier, (0, 0, 1)))
        for role in p:
            if role.startswith("joint "):
                out[role] = turn_to_viewer(facing, p[role] - ground)
        return out

    def fingers(self) -> dict[str, Array]:
        """Return each hand's fingertips `[F, N, 3]`, relative to the hand."""
        out: dict[str, Array] = {}
        for side, some in self.figure.tips.items():
            wrist = f"{side}_hand"
            hand = rotation.conjugate(self.turns[:, self.figure.places[wrist]])
            out[f"{side}_fingers"] = rotation.rotate_vectors(
                hand[:, None], self.places[:, some] - self.p[wrist][:, None]
            )
        return out

    def world(self) -> dict[str, Array]:
        """Return what is in world space: the facing direction, and hips, limbs and head."""
        p = self.p
        limbs = {name: p[name] for name in p if name.endswith(_WORLD)}
        world = {"facing": self.facing, "hips": p["hips"], **limbs, "carrier": p[self.carrier]}
        if "head" in p:
            world["skull"] = p["head"] + SKULL * self.axis("head", (0, 1, 0))
            world["head"] = p["head"]
        return world


def _pose(figure: PosedFigure, clips: Sequence[Clip], frames: Sequence[Array]) -> Pose:
    """Return the poses of the figure's joints in frames of clips, one after another."""
    small = figure.small
    total = sum(map(len, frames))
    translations = np.broadcast_to(small.rest_translations.astype(np.float32), (total, len(small), 3)).copy()
    where = {int(j): i for i, j in enumerate(figure.keep)}
    at = 0
    for clip, index in zip(clips, frames, strict=True):
        for k, joint in enumerate(clip.translated):
            if joint in where:
                translations[at : at + len(index), where[joint]] = clip.translations[index, k]
        at += len(index)
    rotations = np.concatenate(
        [clip.rotations[np.ix_(index, figure.keep)] for clip, index in zip(clips, frames, strict=True)]
    )
    return Pose(rotations, translations)


def measure_facing(p: Mapping[str, Array], hips: Array, turned: Array) -> Array:
    """Return `[F, 2]` sine and cosine of the direction that hips and shoulders face, about y from +z."""
    across = find_leftward(p)
    if across is None:
        across = rotation.rotate_vectors(
            hips, rotation.rotate_vectors(turned, np.array([1.0, 0, 0])).astype(np.float32)
        )
    flat = np.stack([-across[:, 2], across[:, 0]], axis=-1)
    length = np.linalg.norm(flat, axis=-1, keepdims=True)
    return np.where(length > 1e-6, flat / np.maximum(length, 1e-6), np.array([0.0, 1.0])).astype(np.float32)


def turn_to_viewer(facing: Array, v: Array) -> Array:
    """Return vectors `v` `[..., 3]` as seen by somebody with the facing direction `[..., 2]`, see
    `measure_facing`.
    """
    s, c = facing[..., 0], facing[..., 1]
    return np.stack([c * v[..., 0] - s * v[..., 2], v[..., 1], s * v[..., 0] + c * v[..., 2]], axis=-1)
