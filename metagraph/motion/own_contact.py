"""Hands that meet their own body, carried over: where the source's hand touches its face, trunk, thigh or
other arm, the target's comes to the same place of its own body.

Parts of the body are lines with a radius, a head is a ball; all are sized by the figure's own bones, so that
no mesh is needed. A place is given by how far it is along the part's line and by what way it lies beside
it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.joint_map import SIDES
from metagraph.motion.limbs import ease_reach, fade_above_half, normalize_directions
from metagraph.motion.standing import StandingFigure

Array = NDArray[Any]
Points = Mapping[str, Array]

NEAR = 0.2  # of the arm's length: hands this far from a surface, or in it, do not touch it
CLOSE = 0.03  # of the arm's length: surfaces this much nearer than another count sixteen times as much
PASSES = 5  # hands that follow each other settle in as many
SMOOTH = 0.1  # seconds over which a hand's shift is spread
LEAD = 0.16  # seconds in which a hand comes to its place, and leaves it
BEYOND = 0.25  # of the arm: a place so much out of reach is not reached for
ODD = 0.8  # of the arm: figures so unlike that a place is so far away are not like enough
WIDTH, DEPTH = 0.8, 0.55  # of half the shoulders: a trunk's half axes
ARM, THIGH, SKULL = (
    0.07,
    0.09,
    0.12,
)  # radii of arm and thigh, of their limb's length; a skull's height, of all
BROAD = 0.11  # of all its height: half of shoulders broader than this say nothing of the trunk
EYES = 0.045  # of all its height: how far a figure's eyes are ahead of its skull's middle
HAND = 0.3  # of the arm's length: a hand whose fingers have no joints
BENT = 0.93  # of the arm: from here on it stretches ever less for a contact
HANGS = 40.0  # degrees from straight down: arms that hang less far out touch neither trunk nor thighs
STRAIGHT = (
    0.8,
    0.9,
)  # of the arm, from shoulder to wrist: from here to there on an arm that points down hangs
ALONG = (0.0, 0.5, 0.85)  # of the hand, from wrist to fingertip: what touches


@dataclass(frozen=True, eq=False)
class ContactBody:
    """What of a figure its hands can meet. arm: length. radius: part -> metres. tips, skull: from wrist and
    head, `[3]` in the standing pose.
    """

    figure: StandingFigure
    arm: float
    radius: Mapping[str, float]
    tips: Mapping[str, Array]
    skull: Array

    def points(self, turns: Array, places: Array) -> dict[str, Array]:
        """Return name -> `[F, 3]` of a motion, turns `[F, J, 4]` and places `[F, J, 3]`."""
        roles = self.figure.roles

        def turned(role: str, v: Array) -> Array:
            joint = roles[role]
            turn = rotation.multiply(turns[:, joint], rotation.conjugate(self.figure.rotations[joint]))
            return rotation.rotate_vectors(turn, v)

        names = ("upper_arm", "lower_arm", "hand", "upper_leg", "lower_leg")
        out = {f"{s}_{n}": places[:, roles[f"{s}_{n}"]].astype(float) for s in SIDES for n in names}
        out["hips"] = places[:, roles["hips"]].astype(float)
        out["skull"] = places[:, roles["head"]] + turned("head", self.skull)
        for side in SIDES:
            out[f"{side}_tip"] = out[f"{side}_hand"] + turned(f"{side}_hand", self.tips[side])
        return out


def make_contact_body(figure: StandingFigure) -> ContactBody:
    """Return the body of a figure as it stands."""
    skeleton, roles = figure.skeleton, figure.roles
    tall = max(1e-3, float(np.ptp(figure.positions[:, 1])))
    radius = {"trunk": DEPTH * min(figure.half_shoulders, BROAD * tall)}
    tips: dict[str, Array] = {}
    for side in SIDES:
        arm = figure.length(*(f"{side}_{part}" for part in ("upper_arm", "lower_arm", "hand")))
        leg = figure.length(*(f"{side}_{part}" for part in ("upper_leg", "lower_leg", "foot")))
        radius |= {f"{side}_{part}": ARM * arm for part in ("upper_arm", "lower_arm", "hand")}
        radius[f"{side}_thigh"] = THIGH * leg
        hand = figure.at(f"{side}_hand")
        ends = [figure.positions[j] - hand for j in skeleton.descendants(roles[f"{side}_hand"])]
        tip = max(ends, key=lambda v: float(np.linalg.norm(v)))
        if not 0.1 * arm < np.linalg.norm(tip) < 0.6 * arm:  # none, or a thing held
            tip = HAND * arm * normalize_directions(hand - figure.at(f"{side}_lower_arm"))
        tips[side] = tip
    above = [figure.positions[j, 1] - figure.at("head")[1] for j in skeleton.descendants(roles["head"])]
    size = float(np.clip(max(above), SKULL * tall, 2 * SKULL * tall))
    radius["head"] = size / 2
    skull = np.array([0.0, size / 2, 0])
    if {"left_eye", "right_eye"} <= roles.keys():  # rigs put the head's joint anywhere, but not its eyes
        skull = figure.middle("eye") - figure.at("head") - [0, 0, EYES * tall]
    return ContactBody(figure, figure.arm, radius, tips, skull)


def _line(part: str, p: Points) -> tuple[Array, Array]:
    """Return the ends of a part's line, each `[F, 3]`."""
    if part == "head":
        return p["skull"], p["skull"]
    if part == "trunk":
        return p["hips"], (p["left_upper_arm"] + p["right_upper_arm"]) / 2
    side, kind = part.split("_", 1)
    ends = {
        "upper_arm": ("upper_arm", "lower_arm"),
        "lower_arm": ("lower_arm", "hand"),
        "hand": ("hand", "tip"),
        "thigh": ("upper_leg", "lower_leg"),
    }[kind]
    return p[f"{side}_{ends[0]}"], p[f"{side}_{ends[1]}"]


def _across(p: Points) -> Array:
    return normalize_directions(p["left_upper_arm"] - p["right_upper_arm"])


def _touching(side: str, p: Points) -> list[Array]:
    return [p[f"{side}_hand"] + a * (p[f"{side}_tip"] - p[f"{side}_hand"]) for a in ALONG]


@dataclass(frozen=True, eq=False)
class _Place:
    """One point of a hand at one part: how far along it `[F]`, beside it `[F, 3]`, how near its surface 0..1
    `[F]`, how much it counts beside others `[F]`.
    """

    part: str
    point: int
    share: Array
    beside: Array
    near: Array
    weight: Array


class OwnContact:
    """What a motion's hands meet of their own body, and if that is on another figure.

    near: side -> `[F]`, 1 where a hand touches, 0 where it is far from all. Motions as `Body.points` gives
    them.
    """

    def __init__(self, source: StandingFigure, target: StandingFigure, turns: Array, places: Array) -> None:
        self.source, self.target = make_contact_body(source), make_contact_body(target)
        self.points = self.source.points(turns, places)
        self.near: dict[str, Array] = {}
        self.places: dict[str, list[_Place]] = {}
        width = target.half_shoulders / source.half_shoulders
        length = target.length("hips", "head") / source.length("hips", "head")
        self.wide, self.deep = width, float(np.sqrt(width * length))
        for side, other in (SIDES, SIDES[::-1]):
            arms = (f"{other}_{kind}" for kind in ("upper_arm", "lower_arm", "hand"))
            self.near[side] = np.zeros(len(places))
            self.places[side] = []
            hanging = self._hanging(side)
            for part in ("head", "trunk", "left_thigh", "right_thigh", *arms):
                for n, point in enumerate(_touching(side, self.points)):
                    share, beside, gap = self._beside(part, point)
                    near = fade_above_half(np.abs(gap) / (NEAR * self.source.arm))
                    if part == "trunk" or part.endswith("_thigh"):
                        near = near * (1 - hanging)
                    if near.any():
                        self.near[side] = np.maximum(self.near[side], near)
                        close = np.maximum(gap, 0) / (CLOSE * self.source.arm)
                        weight = (near / (1 + close)) ** 4
                        self.places[side].append(_Place(part, n, share, beside, near, weight))

    def _hanging(self, side: str) -> Array:
        """Return 0..1 `[F]`, how far an arm only hangs: then its hand is beside the body, and not on it."""
        arm = self.points[f"{side}_hand"] - self.points[f"{side}_upper_arm"]
        far = np.linalg.norm(arm, axis=-1)
        down = np.degrees(np.arccos(np.clip(-arm[:, 1] / np.maximum(far, 1e-9), -1, 1)))
        least, most = STRAIGHT
        return np.asarray(
            fade_above_half(down / HANGS) * np.clip((far / self.source.arm - least) / (most - least), 0, 1)
        )

    def _beside(self, part: str, point: Array) -> tuple[Array, Array, Array]:
        """Return how far along a part a point is, 0..1, what way beside it, and how far from its surface."""
        a, b = _line(part, self.points)
        line = b - a
        square = np.maximum(np.einsum("fi,fi->f", line, line), 1e-12)
        share = np.clip(np.einsum("fi,fi->f", point - a, line) / square, 0, 1)
        beside = point - a - share[:, None] * line
        radius = self.source.radius[part]
        if part != "trunk":
            return share, beside, np.linalg.norm(beside, axis=-1) - radius
        across = _across(self.points)
        aside = np.einsum("fi,fi->f", beside, across)[:, None] * across
        squashed = beside - (1 - DEPTH / WIDTH) * aside
        return share, beside, np.linalg.norm(squashed, axis=-1) - radius

    def wanted(self, place: _Place, p: Points) -> Array:
        """Return `[F, 3]`, where on the target that moves as `p` that place is."""
        ours, theirs = _line(place.part, self.points), _line(place.part, p)
        beside = place.beside
        if place.part == "trunk":
            across = _across(self.points)
            aside = np.einsum("fi,fi->f", beside, across)[:, None]
            return np.asarray(
                theirs[0]
                + place.share[:, None] * (theirs[1] - theirs[0])
                + self.wide * aside * _across(p)
                + self.deep * (beside - aside * across)
            )
        scale = self.target.radius[place.part] / self.source.radius[place.part]
        if place.part != "head":
            beside = rotation.rotate_vectors(
                rotation.find_rotation_between(ours[1] - ours[0], theirs[1] - theirs[0]), beside
            )
        return np.asarray(theirs[0] + place.share[:, None] * (theirs[1] - theirs[0]) + scale * beside)

    def shift(self, side: str, base: Points, now: Points, before: Array) -> tuple[Array, Array]:
        """Return by what `[F, 3]` a hand that is at `base` gets to its places while all else is as `now`, and
        how much of that is to be done, `[F]` 0..1: none of what is far out of its reach or far away.

        before: the last shift; hands that meet each other go half the way each.
        """
        total, weights, near = np.zeros_like(before), np.zeros(len(before)), np.zeros(len(before))
        hand, wrist = _touching(side, base), base[f"{side}_hand"] - base[f"{side}_upper_arm"]
        for place in self.places[side]:
            away = self.wanted(place, now) - hand[place.point]
            far = np.linalg.norm(wrist + away, axis=-1) / self.target.arm
            can = fade_above_half((far - 1) / BEYOND) * fade_above_half(
                np.linalg.norm(away, axis=-1) / (ODD * self.target.arm)
            )
            if place.part.endswith("_hand"):
                away = (before + away) / 2
            total += (can * place.weight)[:, None] * away
            weights += can * place.weight
            near = np.maximum(near, can * place.near)
        # Where hands only come near, the place is not yet sure: before and after it is that of the touch.
        known = np.flatnonzero((near > near.max() / 2) & (weights > 0))
        if not len(known):
            return np.zeros_like(before), near
        shift = total[known] / weights[known, None]
        frames = np.arange(len(before))
        return np.stack([np.interp(frames, known, x) for x in shift.T], -1), near


Reach = Callable[[str, Array], tuple[Array, Array]]


def meet(contact: OwnContact, base: Points, reach: Reach, fps: float) -> dict[str, Array]:
    """Bring a target's hands to where they meet their own body; return side -> `[F]` whether it was touched.

    base: the target's points before. reach: brings a side's wrist to a place `[F, 3]` and returns where elbow
    and wrist come to.
    """
    now = dict(base)
    sides = [side for side in SIDES if contact.places[side]]
    full = {side: np.zeros_like(base["hips"]) for side in sides}
    touched = {side: _lasting(contact.near[side], fps) > 1e-3 for side in sides}
    for _ in range(PASSES if sides else 0):
        found = {side: contact.shift(side, base, now, full[side]) for side in sides}
        for side in sides:
            full[side], near = found[side]
            shift = _lasting(near, fps)[:, None] * _spread(full[side], SMOOTH * fps)
            wrist, root = base[f"{side}_hand"], base[f"{side}_upper_arm"]
            goal = root + _held(wrist - root, wrist + shift - root, contact.target.arm)
            elbow, wrist = reach(side, np.where(touched[side][:, None], goal, wrist))
            now[f"{side}_tip"] = now[f"{side}_tip"] + wrist - now[f"{side}_hand"]
            now[f"{side}_lower_arm"], now[f"{side}_hand"] = elbow, wrist
    return touched


def _held(before: Array, goal: Array, arm: float) -> Array:
    """Return a goal from the shoulder, nearer where the arm would be straighter than it was and BENT."""
    far = np.linalg.norm(goal, axis=-1)
    free = np.clip(np.linalg.norm(before, axis=-1) / arm, BENT, 1)
    return np.asarray(goal * (ease_reach(far / arm, free) * arm / np.maximum(far, 1e-9))[:, None])


def _lasting(near: Array, fps: float) -> Array:
    """Return nearness `[F]` that begins and ends softly, in LEAD seconds before and after."""
    reach = min(int(LEAD * fps), len(near) - 1)
    held = near.copy()
    for n in range(1, reach + 1):
        held[n:] = np.maximum(held[n:], near[:-n])
        held[:-n] = np.maximum(held[:-n], near[n:])
    return _spread(held, LEAD / 2 * fps)


def _spread(values: Array, frames: float) -> Array:
    """Return values `[F, ...]` smoothed over some `frames`, the ends going on as they are."""
    reach = int(np.ceil(2.5 * frames))
    if reach < 1 or len(values) < 2:
        return values
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / frames) ** 2)
    kernel /= kernel.sum()
    padded = np.concatenate([values[:1].repeat(reach, 0), values, values[-1:].repeat(reach, 0)])
    return np.asarray(sum(k * padded[n : n + len(values)] for n, k in enumerate(kernel)))
