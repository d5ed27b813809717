"""Bring the surface of a body to a skeleton's measures, and say which joints each point follows.

Each bone of the body carries what is round it to the skeleton's bone: stretched along it to its length,
across it in the size of the whole. Radii thus are the same shares of the height on every skeleton.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.fitting.bind import Bind
from metagraph.motion.fitting.sculpture import FACE, Sculpture
from metagraph.motion.joint_map import FINGERS, SIDES
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

TRUNK = ("hips", "spine", "chest", "upper_chest")
LIMBS = ("upper_arm", "lower_arm", "upper_leg", "lower_leg")
BELOW = {"upper_arm": "lower_arm", "lower_arm": "hand", "upper_leg": "lower_leg", "lower_leg": "foot"}
PARTS = {"leg": 0.5, "trunk": 0.35, "arm": 0.15}  # how much each length says of the body's size
NECK_BASE = (
    0.10  # metres above the shoulders of a body of usual size; a head's joint below that is the neck's
)
PEOPLE = 1.2  # the most by which people's shoulders are broader than their height says
STOUT = 2.5  # how much thicker a body is drawn, at most
ANKLES = (0.04, 0.14)  # metres on a body of usual size, between which an ankle's height is believed
SEAT = 0.05  # metres above the hip joints that the pelvis reaches, wherever the spine begins


class Fit:
    """The surface of a body on a skeleton. `size` is how large it is beside the body as it was made, `broad`
    how thick, `people` how large beside a body of usual size. `ankle` is how high ankles are above the soles,
    metres, None if it is not known.
    """

    def __init__(self, skeleton: Skeleton, bind: Bind, body: Sculpture, ankle: float | None = None) -> None:
        self.ankle = ankle
        self.skeleton, self.bind, self.body = skeleton, bind, body
        self.size = self._size()
        self.people = self.size * body.unit
        self.broad = self.size * self._breadth()
        self.own = {role: bind.at(role) for role in bind.roles}
        self._neck = self._place_neck()
        self.positions = self.carry(np.asarray(body.character.positions, float))

    def _size(self) -> float:
        body, bind = self.body, self.bind
        lengths: dict[str, tuple[float, float]] = {
            "trunk": (
                float(np.linalg.norm(bind.middle("upper_arm") - bind.middle("upper_leg"))),
                float(np.linalg.norm(body.middle("upper_arm") - body.middle("upper_leg"))),
            )
        }
        for limb, chain in (
            ("leg", ("upper_leg", "lower_leg", "foot")),
            ("arm", ("upper_arm", "lower_arm", "hand")),
        ):
            both = [
                sum(
                    float(np.linalg.norm(at[f"{side}_{b}"] - at[f"{side}_{a}"]))
                    for side in SIDES
                    for a, b in itertools.pairwise(chain)
                )
                for at in ({r: bind.at(r) for r in bind.roles}, body.at)
            ]
            lengths[limb] = both[0], both[1]
        return float(np.exp(sum(w * np.log(lengths[k][0] / lengths[k][1]) for k, w in PARTS.items())))

    def _breadth(self) -> float:
        """Return how much stouter than people the body is: 1 within their range."""
        own = float(np.linalg.norm(self.bind.at("left_upper_arm") - self.bind.at("right_upper_arm")))
        share = own / (2 * self.size * float(self.body.at["left_upper_arm"][0]))
        return float(np.clip(share / PEOPLE, 1, STOUT))

    def _place_neck(self) -> Array:
        """Return where the neck begins: above the shoulders. Rigs have its joint anywhere between chest and
        skull.
        """
        usual = self.body.neck - self.body.middle("upper_arm")
        return np.asarray(self.bind.middle("upper_arm") + self.size * usual)

    # --- the surface

    def carry(self, points: Array) -> Array:
        """Return points of the body's vertices `[V, 3]`, or near them, as the skeleton's bones carry them."""
        body = self.body
        out = body.share(*TRUNK, "left_shoulder", "right_shoulder")[:, None] * self._trunk(points)
        out += body.share("neck")[:, None] * self._on_neck(points)
        out += body.share("head", *FACE)[:, None] * self._on_head(points)
        for side in SIDES:
            for part in LIMBS:
                role, to = f"{side}_{part}", f"{side}_{BELOW[part]}"
                moved = self._along(points, role, to, self.own[role], self.own[to], self.broad)
                out += body.share(role)[:, None] * moved
            out += self._hand(points, side)
            out += body.share(f"{side}_foot", f"{side}_toes")[:, None] * self._foot(points, side)
        return np.asarray(out)

    def _along(self, points: Array, role: str, to: str, start: Array, end: Array, across: float) -> Array:
        """Return points carried from a sculpted bone to one from `start` to `end`, scaled across it."""
        a, line = self.body.at[role], self.body.at[to] - self.body.at[role]
        share = (points - a) @ line / float(line @ line)
        return np.asarray(start + across * (points - a) + share[:, None] * (end - start - across * line))

    def _trunk(self, points: Array) -> Array:
        """Return points of the trunk between hips and shoulders, which may be further apart or nearer."""
        body, bind = self.body, self.bind
        low, high = body.middle("upper_leg"), body.middle("upper_arm")
        own_low, own_high = bind.middle("upper_leg"), bind.middle("upper_arm")
        up = (points[:, 1] - low[1]) / (high[1] - low[1])
        within = np.clip(up, 0, 1)[:, None]
        middle = low + within * (high - low)
        out = own_low + within * (own_high - own_low) + self.broad * (points - middle)
        soft = (within * within * (3 - 2 * within))[:, 0]
        for part, share in (("upper_leg", 1 - soft), ("upper_arm", soft)):
            half = float(body.at[f"left_{part}"][0])
            own = float(bind.at(f"left_{part}")[0] - bind.at(f"right_{part}")[0]) / 2
            out[:, 0] += share * np.clip(points[:, 0] / half, -1, 1) * (own - self.broad * half)
        return np.asarray(out)

    def _on_neck(self, points: Array) -> Array:
        if self._head_is_neck or "neck" not in self.body.at:
            return np.asarray(self._neck + self.broad * (points - self.body.neck))
        return self._along(points, "neck", "head", self._neck, self.own["head"], self.broad)

    def _on_head(self, points: Array) -> Array:
        if self._head_is_neck:
            return np.asarray(self._neck + self.broad * (points - self.body.neck))
        return np.asarray(self.own["head"] + self.broad * (points - self.body.at["head"]))

    @property
    def _head_is_neck(self) -> bool:
        """Whether the head's joint lies so low that the neck turns with it."""
        high = self.own["head"][1] - self.bind.middle("upper_arm")[1]
        return bool(high < NECK_BASE * self.people)

    def _foot(self, points: Array, side: str) -> Array:
        """Return points of a foot whose sole is level."""
        body, foot, toes = self.body, f"{side}_foot", f"{side}_toes"
        a, size = body.at[foot], self.broad
        high, there = self.ankle, toes in self.own and toes in body.at
        if high is None and there:
            high = float(self.own[foot][1] - self.own[toes][1] + size * body.at[toes][1])
        usual = float(a[1])
        tall = (
            usual * size
            if high is None
            else float(np.clip(high, ANKLES[0] * self.people, ANKLES[1] * self.people))
        )
        scale = np.array([size, tall / usual, size])
        if there:
            own = float(np.hypot(*(self.own[toes] - self.own[foot])[[0, 2]]))
            line = float(np.hypot(*(body.at[toes] - a)[[0, 2]]))
            scale[2] = float(np.clip(own / line, 0.75 * size, 1.2 * size))
        return np.asarray(self.own[foot] + scale * (points - a))

    def _hand(self, points: Array, side: str) -> Array:
        """Return points of a hand times how much they follow it and its fingers."""
        body, hand = self.body, f"{side}_hand"
        knuckles = [k for k in (f"{side}_{f}_1" for f in FINGERS[1:]) if k in self.own and k in body.at]
        scale = self.broad
        if len(knuckles) > 1:
            own = np.mean([np.linalg.norm(self.own[k] - self.own[hand]) for k in knuckles])
            line = np.mean([np.linalg.norm(body.at[k] - body.at[hand]) for k in knuckles])
            scale = float(np.clip(own / line, 0.7 * self.broad, 1.4 * self.broad))
        else:
            knuckles = []
        on_hand = self.own[hand] + scale * (points - body.at[hand])
        out = body.share(hand)[:, None] * on_hand
        for finger in FINGERS:
            line = [n for n in (1, 2, 3) if f"{side}_{finger}_{n}" in body.at]
            known = bool(knuckles) and len(line) > 1 and f"{side}_{finger}_1" in self.own
            stretch = 1.0
            for n in line:
                role, to = f"{side}_{finger}_{n}", f"{side}_{finger}_{n + 1}"
                moved = on_hand
                if known and role in self.own:
                    if to in self.own and to in body.at:
                        own = float(np.linalg.norm(self.own[to] - self.own[role]))
                        line = float(np.linalg.norm(body.at[to] - body.at[role]))
                        stretch = float(np.clip(own / line / scale, 0.5, 2.0))
                    moved = self._on_finger(points, role, n, finger, scale, stretch)
                elif known:  # a finger with fewer joints: its end is carried by the last one there is
                    last = max(k for k in line if f"{side}_{finger}_{k}" in self.own)
                    moved = self._on_finger(points, f"{side}_{finger}_{last}", last, finger, scale, stretch)
                out += body.share(role)[:, None] * moved
        return np.asarray(out)

    def _on_finger(
        self, points: Array, role: str, n: int, finger: str, scale: float, stretch: float
    ) -> Array:
        """Return points carried with one bone of a finger."""
        body, side = self.body, role.split("_")[0]
        n = n if f"{side}_{finger}_{n + 1}" in body.at else n - 1
        a, b = body.at[f"{side}_{finger}_{n}"], body.at[f"{side}_{finger}_{n + 1}"]
        way = (b - a) / np.linalg.norm(b - a)
        away = points - body.at[role]
        return np.asarray(self.own[role] + scale * (away + (stretch - 1) * (away @ way)[:, None] * way))

    # --- what follows what

    def slots(self) -> tuple[list[int], Array]:
        """Return the joints that carry the body `[S]`, and how much each point follows each, `[V, S]`."""
        carried: dict[int, Array] = {}

        def add(joint: int, weight: Array) -> None:
            carried[joint] = carried.get(joint, 0) + weight

        roles, body = self.bind.roles, self.body
        spine, necks = self.trunk_and_neck()
        sides = [f"{side}_shoulder" for side in SIDES]
        trunk = body.share(*TRUNK, *(s for s in sides if s not in roles))
        for joint, share in zip(spine, self._levels(spine, True), strict=True):
            add(joint, trunk * share)
        neck = body.share("neck")
        for joint, share in zip(necks, self._levels(necks, False), strict=True):
            add(joint, neck * share)
        add(roles["head"], body.share("head", *(part for part in FACE if part not in roles)))
        for part in FACE:
            if part in roles:
                add(roles[part], body.share(part))
        for side in SIDES:
            for part in ("shoulder", *LIMBS, "hand", "foot", "toes"):
                role = f"{side}_{part}"
                to = f"{side}_foot" if part == "toes" and role not in roles else role
                if to in roles:
                    add(roles[to], body.share(role))
            for finger in FINGERS:
                for n in (1, 2, 3):
                    add(roles[self._carrier(side, finger, n)], body.share(f"{side}_{finger}_{n}"))
        return list(carried), np.stack(list(carried.values()), 1)

    def _carrier(self, side: str, finger: str, n: int) -> str:
        """Return the role that carries a bone of a finger: its own, that before it, that of the nearest
        finger there is, else the hand.
        """
        order = (
            [finger]
            if finger == "thumb"
            else sorted(FINGERS[1:], key=lambda f: abs(FINGERS.index(f) - FINGERS.index(finger)))
        )
        for one in order:
            for k in range(n, 0, -1):
                if f"{side}_{one}_{k}" in self.bind.roles:
                    return f"{side}_{one}_{k}"
        return f"{side}_hand"

    def trunk_and_neck(self) -> tuple[list[int], list[int]]:
        """Return the joints from the hips to below the neck, and those from the neck to the head."""
        roles = self.bind.roles
        line = list(self.skeleton.chain(roles["head"]))
        start = line.index(roles["hips"]) if roles["hips"] in line else 0
        line = line[start:]
        if "neck" in roles and roles["neck"] in line:
            at = line.index(roles["neck"])
            return line[:at] or [roles["hips"]], line[at:-1] or line[-1:]
        if self._head_is_neck or len(line) < 2:
            return line[:-1] or line, line[-1:]
        return line[:-1], line[-2:]

    def _levels(self, joints: list[int], trunk: bool) -> list[Array]:
        """Return how much each point follows each joint of a line that goes up, `[V]` each, by its height."""
        high = self.positions[:, 1]
        at = self.bind.positions[joints, 1].copy()
        if trunk:
            least = self.bind.middle("upper_leg")[1] + SEAT * self.people
            at[1:] = np.maximum(at[1:], least)
        at = np.maximum.accumulate(at)
        left, out = np.ones(len(high)), []
        for k in range(1, len(joints)):
            gaps = np.diff(np.append(at, at[-1] + 0.1 * self.people))
            reach = float(np.clip(0.6 * min(gaps[k - 1], gaps[k]), 0.012 * self.people, 0.07 * self.people))
            t = np.clip((high - at[k] + reach) / (2 * reach), 0, 1)
            passed = t * t * (3 - 2 * t)
            out.append(left * (1 - passed))
            left = left * passed
        return [*out, left]
