"""Roles told from the tree of joints and the rest pose alone, whatever the joints are called.

A figure is two alike limbs that go down, two alike limbs further up, and what is between and above them.
Knee and ankle, elbow and wrist are where bones of about equal length meet, so that joints of twist or a
collar bone on the way count for nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

LIMB = 0.22  # of the figure's size: shorter branches are no limbs
ALIKE = 0.08  # of their length: how much two limbs of a pair may differ
SHARES = {"arm": 0.9, "leg": 1.0}  # how long the lower bone usually is beside the upper one
SPREADS = {"arm": 0.3, "leg": 0.35}  # of the logarithm of that share
WIDE = {"arm": 0.11, "leg": 0.03}  # of the figure's size: as far apart shoulders and hips are at least
PASSED = 0.75  # what each joint counts that lies within a limb's bone
TOP = 1.25  # a last joint this much further from the head than the head from the neck is the top of the skull
LINE, BRANCHES = (
    48,
    24,
)  # joints of a limb, and branches of a joint that are looked at: work grows with their powers
UP = np.array([0.0, 1.0, 0.0])


class _Shape:
    """A skeleton's tree with lengths."""

    def __init__(self, skeleton: Skeleton) -> None:
        self.skeleton = skeleton
        self.parents = [int(p) for p in skeleton.parents]
        _, self.at = skeleton.globals(skeleton.rest)
        self.bones = np.linalg.norm(skeleton.rest_translations, axis=-1)
        self.bones[skeleton.parents < 0] = 0
        count = len(skeleton)
        self.reach = np.zeros(count)  # from a joint to the furthest tip below it
        self.below = np.ones(count, int)
        self.tip = list(range(count))  # the furthest one below each
        self.steps = [0] * count  # joints from each to that one
        for j in range(count - 1, -1, -1):
            if children := skeleton.children[j]:
                far = self._furthest(children)
                self.tip[j], self.steps[j] = self.tip[far], self.steps[far] + 1
            if (p := self.parents[j]) >= 0:
                self.reach[p] = max(self.reach[p], self.reach[j] + self.bones[j])
                self.below[p] += self.below[j]

    def _furthest(self, joints: Sequence[int]) -> int:
        return max(joints, key=lambda c: (self.reach[c] + self.bones[c], -c))

    def line(self, joint: int) -> list[int]:
        """Return the joints from one to its furthest tip."""
        out = [joint]
        while below := self.skeleton.children[out[-1]]:
            out.append(self._furthest(below))
        return out

    def above(self, joint: int) -> list[int]:
        """Return a joint and its ancestors, nearest first."""
        out = [joint]
        while self.parents[out[-1]] >= 0:
            out.append(self.parents[out[-1]])
        return out

    def pairs(self) -> list[tuple[int, int]]:
        """Return pairs of long branches from one joint that are alike and lie apart, none inside others."""
        size = self.size()
        out: list[tuple[int, int]] = []
        inside: set[int] = set()
        for joint in range(len(self.skeleton)):
            if joint in inside or self.parents[joint] in inside:
                inside.add(joint)
                continue
            long = [
                c
                for c in self.skeleton.children[joint]
                if self.reach[c] > LIMB * size and 2 <= self.steps[c] < LINE
            ]
            long = sorted(long, key=lambda c: (-self.reach[c], c))[:BRANCHES]
            long.sort()
            found = []
            for a, b in combinations(long, 2):
                lengths = [float(self.reach[j]) for j in (a, b)]
                ways = [self.at[self.tip[j]] - self.at[joint] for j in (a, b)]
                apart = float(np.linalg.norm(ways[0] - ways[1]))
                odd = abs(lengths[0] - lengths[1]) + abs(float(self.bones[a] - self.bones[b]))
                # Mirrored across a plane between them: as far from the middle, as high.
                odd += abs(float(np.linalg.norm(ways[0]) - np.linalg.norm(ways[1])))
                odd += abs(float(ways[0][1] - ways[1][1]))
                if odd < 2 * ALIKE * sum(lengths) and apart > 0.02 * size:
                    found.append((odd, a, b))
            for _, a, b in sorted(found)[:1]:
                out.append((a, b))
                inside.update((a, b))
        return out

    def size(self) -> float:
        return max(self.skeleton.height, 1e-6)

    def spreads(self, joints: Sequence[int]) -> bool:
        """Whether children lie in different directions from joints in one place."""
        ways = [self.at[c] - self.at[j] for j in joints for c in self.skeleton.children[j]]
        ways = [w / np.linalg.norm(w) for w in ways if np.linalg.norm(w) > 0.005 * self.size()]
        return any(float(a @ b) < 0.9 for a, b in combinations(ways[:BRANCHES], 2))

    def limb(self, joint: int, other: int, kind: str) -> tuple[list[int], int, int, int]:
        """Return a limb's line of joints and the places on it of its upper, lower and end joint."""
        line = self.line(joint)
        bones = [float(self.bones[j]) for j in line[1:]]
        if kind == "leg":  # what counts is how far down it goes: a foot's own length does not
            bones = [max(0.0, float(self.at[a, 1] - self.at[b, 1])) for a, b in pairwise(line)]
        steep = [1.0] + [
            float(self.at[a, 1] - self.at[b, 1]) / max(1e-9, float(self.bones[b])) for a, b in pairwise(line)
        ]
        along = np.cumsum([0.0, *bones])
        place = {line[0]: 0}  # joints in one place have one number
        for above, j in pairwise(line):
            place[j] = place[above] + (float(self.bones[j]) > 0.005 * self.size())
        opposite = self.line(other)
        near = [
            n >= len(opposite)
            or float(np.linalg.norm(self.at[j] - self.at[opposite[n]])) < WIDE[kind] * self.size()
            for n, j in enumerate(line)
        ]
        fingers = [
            n
            for n, j in enumerate(line)
            if n > 1 and along[n] > 0.35 * along[-1] and len(self.branches(j)) > 2
        ]
        ends = fingers[:1] if kind == "arm" and fingers else range(2, len(line))
        best, found = -1.0, (0, 1, 2)
        for end in ends:
            thumbed = (
                kind == "arm"
                and not fingers
                and self.spreads([j for j in line if place[j] == place[line[end]]])
            )
            for upper in range(end - 1):
                for lower in range(upper + 1, end):
                    one, two = along[lower] - along[upper], along[end] - along[lower]
                    if min(one, two) < 1e-3 * max(along[-1], 1e-9):
                        continue
                    share = np.log(two / one / SHARES[kind]) / SPREADS[kind]
                    worth = (one + two) / along[-1] * float(np.exp(-0.5 * share * share))
                    worth *= PASSED ** (place[line[end]] - place[line[upper]] - 2)
                    if kind == "leg":  # the shin comes down to the ankle; most feet have toes
                        worth *= steep[end] ** 2 * (0.8 if end == len(line) - 1 else 1.0)
                        worth *= float(np.sqrt((one + two) / along[-1]))
                    if kind == "arm" and not fingers and (upper, end, len(line)) == (1, 3, 4):
                        worth *= 1.15  # four joints mostly begin with a collar bone
                    if near[upper]:
                        worth *= 0.5  # so near the middle are collar bones, and joints of the pelvis
                    if thumbed:
                        worth *= 2.5  # a thumb beside the hand
                    if worth > best + 1e-9 or (
                        worth > best - 1e-9
                        and place[line[lower]] == place[line[found[1]]]
                        and end == found[2]
                    ):  # the last of joints in one place bends
                        best, found = worth, (upper, lower, end)
        return line, *found

    def branches(self, joint: int) -> list[int]:
        """Return the children that carry more than nothing."""
        return [c for c in self.skeleton.children[joint] if self.reach[c] > 0.01 * self.size()]


def find_roles_by_shape(skeleton: Skeleton) -> dict[str, int]:
    """Return role -> joint for a figure in a rest pose that stands: two legs, two arms, a head; {} for
    anything else. Sides are given by where the toes point, without toes as if it faced +Z.
    """
    shape = _Shape(skeleton)
    pairs = shape.pairs()
    if len(pairs) < 2:
        return {}

    def tips(pair: tuple[int, int]) -> float:
        return float(np.mean([shape.at[shape.tip[j], 1] for j in pair]))

    legs = min(pairs, key=tips)
    ground = shape.parents[legs[0]]
    hanging = float(np.mean([shape.at[j, 1] for j in legs])) - tips(legs)
    if hanging < 0.6 * float(np.mean([shape.reach[j] for j in legs])):
        return {}  # bones along one axis: what goes down is not known
    found = _arms(shape, [pair for pair in pairs if pair != legs], ground)
    if found is None:
        return {}
    arms, chest = found
    hips = next(j for j in shape.above(chest) if j in shape.above(ground))
    trunk = shape.above(chest)[: shape.above(chest).index(hips)][::-1]
    head = _head(shape, chest, arms)
    if head is None:
        return {}
    shoulders = float(np.mean([shape.at[j, 1] for j in arms]))
    if "neck" not in head and len(trunk) > 1 and shape.at[trunk[-1], 1] > shoulders + 0.02 * shape.size():
        head["neck"] = trunk.pop()
    above = shape.parents[hips]  # the pelvis where the legs hang on the first joint of the spine
    if above >= 0 and float(np.linalg.norm(shape.at[above] - shape.at[hips])) < 0.01 * shape.size():
        trunk.insert(0, hips)
        hips = above
    return {"hips": hips, **_spine(trunk), **head, **_limb_roles(shape, legs, arms)}


def _arms(shape: _Shape, pairs: Sequence[tuple[int, int]], ground: int) -> tuple[tuple[int, int], int] | None:
    """Return the longest pair of limbs that hangs above the joint `ground` of the legs, not on it, and the
    joint it hangs on; None if there is no such pair.
    """
    best: tuple[float, tuple[int, int], int] | None = None
    below_legs = set(shape.above(ground))
    for pair in pairs:
        chest = shape.parents[pair[0]]
        if shape.at[chest, 1] <= shape.at[ground, 1]:
            continue
        hips = next(j for j in shape.above(chest) if j in below_legs or j < 0)
        if chest == hips:
            continue
        worth = float(np.mean([shape.reach[j] for j in pair]))
        if best is None or worth > best[0]:
            best = (worth, pair, chest)
    return None if best is None else best[1:]


def _limb_roles(shape: _Shape, legs: tuple[int, int], arms: tuple[int, int]) -> dict[str, int]:
    """Return the roles of the joints of legs and arms, each limb's given by the joint it begins with."""
    limbs = {
        kind: [shape.limb(a, b, kind) for a, b in (pair, pair[::-1])]
        for kind, pair in (("leg", legs), ("arm", arms))
    }
    roles: dict[str, int] = {}
    for kind, names in (
        ("leg", ("upper_leg", "lower_leg", "foot")),
        ("arm", ("upper_arm", "lower_arm", "hand")),
    ):
        for side, n in zip(("left", "right"), _sides(shape, limbs["leg"], limbs[kind]), strict=True):
            line, *places = limbs[kind][n]
            roles.update({f"{side}_{name}": line[k] for name, k in zip(names, places, strict=True)})
            if kind == "arm" and places[0] > 0:
                roles[f"{side}_shoulder"] = line[places[0] - 1]
            if kind == "leg" and places[2] + 1 < len(line):
                roles[f"{side}_toes"] = line[places[2] + 1]
    return roles


def _spine(trunk: Sequence[int]) -> dict[str, int]:
    out = {"spine": trunk[0]} if trunk else {}
    rest = trunk[1:]
    if len(rest) == 1:
        out["chest"] = rest[0]
    elif rest:
        out |= {"chest": rest[(len(rest) - 1) // 2], "upper_chest": rest[-1]}
    return out


def _head(shape: _Shape, chest: int, arms: tuple[int, int]) -> dict[str, int] | None:
    """Return neck and head: the line that goes up between the arms, to where it spreads into a face or
    ends.
    """
    middle = (shape.at[arms[0]] + shape.at[arms[1]]) / 2

    def worth(joint: int) -> float:
        tip = shape.at[shape.tip[joint]]
        level = float(np.linalg.norm((tip - middle)[[0, 2]]))
        return float(tip[1] - middle[1]) - 2 * level + 0.002 * shape.size() * min(20, int(shape.below[joint]))

    free = [c for c in shape.skeleton.children[chest] if c not in arms]
    if not free:
        return None
    joint = max(free, key=worth)
    if shape.at[shape.tip[joint], 1] < shape.at[chest, 1]:
        return None
    line = [joint]
    while len(shape.skeleton.children[line[-1]]) == 1:
        line.append(shape.skeleton.children[line[-1]][0])
    spreads = bool(shape.skeleton.children[line[-1]])
    if not spreads and len(line) > 1:
        # Nothing hangs on it: the last joint is the head, or the top of its skull.
        neck = float(shape.bones[line[-2]]) if len(line) > 2 else 0.06 * shape.size()
        if float(shape.bones[line[-1]]) > TOP * max(neck, 0.04 * shape.size()):
            line.pop()
    out = {"head": line[-1]}
    if len(line) > 1:
        out["neck"] = line[0]
    return out


_Limb = tuple[list[int], int, int, int]


def _sides(shape: _Shape, legs: Sequence[_Limb], pair: Sequence[_Limb]) -> tuple[int, int]:
    """Return which limb of a pair is the left, which the right."""
    ahead = np.zeros(3)
    for line, _, lower, foot in legs:
        ways = [shape.at[j] - shape.at[line[foot]] for j in shape.skeleton.descendants(line[foot])]
        ahead += max(ways, key=lambda way: float(np.hypot(way[0], way[2])))
        upper, knee, ankle = (shape.at[line[n]] for n in (0, lower, foot))
        ahead += 0.2 * (knee - (upper + ankle) / 2)
    ahead[1] = 0
    across = shape.at[pair[0][0][pair[0][1]]] - shape.at[pair[1][0][pair[1][1]]]
    if np.linalg.norm(across) < 1e-3 * shape.size():
        across = shape.at[pair[0][0][-1]] - shape.at[pair[1][0][-1]]
    ahead -= across * (ahead @ across) / max(float(across @ across), 1e-12)
    if np.linalg.norm(ahead) < 0.01 * shape.size():
        ahead = np.array([0.0, 0, 1]) if abs(across[0]) >= abs(across[2]) else np.array([1.0, 0, 0])
    return (0, 1) if float(np.cross(UP, ahead) @ across) > 0 else (1, 0)
