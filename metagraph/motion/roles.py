"""Which joint is the left hand: roles, body parts and sides of a skeleton, from its names and its hierarchy.

Names say what a joint is about, the hierarchy decides between them: an arm is the line of joints above a
hand, so `LeftShoulder` is a collar bone in one skeleton and an upper arm in the next, and a twist or IK
helper beside that line never wins. Where names leave out what a figure needs, or contradict the tree, the
shape of the rest pose decides (`find_roles_by_shape`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

import numpy as np

from metagraph.motion.joint_names import ARM, FACE, HELPERS, guess_joint_kind, split_joint_name
from metagraph.motion.roles_by_shape import find_roles_by_shape
from metagraph.motion.skeleton import Skeleton

_CENTRE = ("hips", "spine", "chest", "upper_chest", "neck", "head", "jaw")
_SIDED = (
    "eye",
    "upper_lid",
    "lower_lid",
    "shoulder",
    "upper_arm",
    "lower_arm",
    "hand",
    "upper_leg",
    "lower_leg",
    "foot",
    "toes",
)
ROLES: tuple[str, ...] = (*_CENTRE, *(f"left_{r}" for r in _SIDED), *(f"right_{r}" for r in _SIDED))
PARTS = ("legs", "spine", "arms", "head", "face")
# What a character needs to gesture, stand and look.
REQUIRED: tuple[str, ...] = (
    "hips",
    "spine",
    "head",
    *(
        f"{s}_{r}"
        for s in ("left", "right")
        for r in ("upper_arm", "lower_arm", "hand", "upper_leg", "lower_leg", "foot")
    ),
)


class _Reader:
    """One skeleton's names and tree, and the roles found so far."""

    def __init__(self, skeleton: Skeleton) -> None:
        self.skeleton = skeleton
        self.words = [split_joint_name(name) for name in skeleton.names]
        helpers = [bool(HELPERS & set(w.words)) for w in self.words]
        common = sum(helpers) > len(helpers) / 2  # a word that most joints bear says nothing
        self.helper = [False] * len(helpers) if common else helpers
        self.kinds = ["" if h else guess_joint_kind(w) for w, h in zip(self.words, self.helper, strict=True)]
        self.parents = [int(p) for p in skeleton.parents]
        self.roles: dict[str, int] = {}

    def above(self, joint: int) -> list[int]:
        """Return the ancestors, nearest first."""
        out = []
        while self.parents[joint] >= 0:
            joint = self.parents[joint]
            out.append(joint)
        return out

    def topmost(self, joints: Iterable[int]) -> list[int]:
        """Return those that have none of the others above them."""
        some = set(joints)
        return sorted(j for j in some if not some.intersection(self.above(j)))

    def called(self, *names: str, side: str = "centre") -> list[int]:
        """Return the joints with one of these words on this side, helpers excluded, topmost only."""
        wanted = set(names)
        return self.topmost(
            i
            for i, w in enumerate(self.words)
            if w.side == side and wanted & set(w.words) and not self.helper[i]
        )

    def ofkind_of(self, kind: str, side: str) -> list[int]:
        return self.topmost(i for i, k in enumerate(self.kinds) if k == kind and self.words[i].side == side)

    def biggest(self, joints: Sequence[int]) -> int:
        """Return the one with the most joints below it, the first of equals."""
        return max(joints, key=lambda j: (self.skeleton.below[j], -j))

    def limb(self, side: str, end: str, lower: str, upper: str, collar: str | None) -> None:
        """Name the joints of an arm or a leg from its end upwards."""
        ends = self.ofkind_of(end, side)
        if end == "hand" and len(ends) > 1:  # several palms: the one that carries the middle finger
            middle = [
                e for e in ends if any("middle" in self.words[d].joined for d in self.skeleton.descendants(e))
            ]
            ends = middle or ends
        line: list[int] = []
        if ends:
            tip = self.biggest(ends)
            self.roles[f"{side}_{end}"] = tip
            line = [j for j in reversed(self.above(tip)) if self.words[j].side == side and not self.helper[j]]
        elif self.ofkind_of(lower, side):
            line = [self.biggest(self.ofkind_of(lower, side))]
            line = [
                *(
                    j
                    for j in reversed(self.above(line[0]))
                    if self.words[j].side == side and not self.helper[j]
                ),
                *line,
            ]
            below = [c for c in self.skeleton.children[line[-1]] if not self.helper[c]]
            if below:
                self.roles[f"{side}_{end}"] = self.biggest(below)

        def take(role: str, kind: str, last: bool) -> None:
            nonlocal line
            known = [i for i, j in enumerate(line) if self.kinds[j] == kind]
            place = known[0] if known else len(line) - 1 if last and line else None
            if place is not None:
                self.roles[f"{side}_{role}"] = line[place]
                line = line[:place]

        take(lower, lower, True)
        take(upper, upper, True)
        if collar:
            take(collar, collar, True)
        for role in (lower, upper):  # limbs cut into separate trees, as IK rigs are
            if f"{side}_{role}" not in self.roles and (named := self.ofkind_of(role, side)):
                self.roles[f"{side}_{role}"] = self.biggest(named)

    def toes(self, side: str) -> None:
        foot = self.roles.get(f"{side}_foot")
        if foot is None:
            return
        below = set(self.skeleton.descendants(foot)) - {foot}
        named = [j for j in self.ofkind_of("toes", side) if j in below]
        free = named or [
            c for c in self.skeleton.children[foot] if not self.helper[c] and self.words[c].side == side
        ]
        if free:
            self.roles[f"{side}_toes"] = self.biggest(free)

    def common(self, joints: Sequence[int]) -> int | None:
        """Return the nearest joint that is, or is above, all of these."""
        lines = [list(reversed([j, *self.above(j)])) for j in joints]
        shared = None
        for step in zip(*lines, strict=False):
            if len(set(step)) > 1:
                break
            shared = step[0]
        return shared

    def pair(self, role: str) -> list[int]:
        """Return the joints of a sided role, the left one first; fewer where it is not known of both."""
        return [self.roles[r] for r in (f"left_{role}", f"right_{role}") if r in self.roles]

    def plain_below(self, joint: int) -> list[int]:
        """Return the children that are no helpers."""
        return [c for c in self.skeleton.children[joint] if not self.helper[c]]

    def trunk(self) -> None:
        """Name hips, spine, chest, neck and head, given the limbs."""
        roles = self.roles
        self._head_by_name()
        if "head" not in roles:
            self._head_over_arms()
        if "neck" in roles and "head" in roles and roles["neck"] not in self.above(roles["head"]):
            del roles["neck"]
        self._hips()
        if "hips" in roles and "head" in roles:
            self._spine()

    def _head_by_name(self) -> None:
        """Name head and neck by what joints are called, the head by the rest pose where none is called so."""
        roles = self.roles
        heads, necks = self.called("head") or self.called("skull", "cranium"), self.called("neck")
        shaped = find_roles_by_shape(self.skeleton).get("head") if not heads else None
        if heads:
            roles["head"] = self.biggest(heads)
        elif shaped is not None and (not necks or self.biggest(necks) in self.above(shaped)):
            roles["head"] = shaped  # the last joint called a neck need not be the last that turns
        if necks:
            roles["neck"] = self.biggest(necks)
            if "head" not in roles:
                self._head_ends_neck()

    def _head_ends_neck(self) -> None:
        """Name the last of the neck's joints the head: there the face hangs."""
        line = [self.roles["neck"]]
        while below := [c for c in self.plain_below(line[-1]) if "neck" in self.words[c].words]:
            line.append(below[0])
        self.roles["head"] = line[-1]
        if len(line) == 1:
            del self.roles["neck"]

    def _head_over_arms(self) -> None:
        """Name the end of the line in the middle that begins between the arms the head."""
        arms = self.pair("upper_arm")
        top = self.common(arms) if len(arms) == 2 else None
        if top is None:
            return
        line = [top]
        while below := [c for c in self.plain_below(line[-1]) if self.words[c].side == "centre"]:
            line.append(self.biggest(below))
        if len(line) > 1:
            self.roles["head"] = line[-1]
        if len(line) > 2:
            self.roles["neck"] = line[1]

    def _hips(self) -> None:
        """Name the hips: the lowest joint called so that carries legs and head, else what carries them."""
        roles = self.roles
        legs = self.pair("upper_leg")
        ends = legs + ([roles["head"]] if "head" in roles else [])
        named = [
            j
            for w in ("hips", "pelvis", "hip")
            for j, x in enumerate(self.words)
            if w in x.words and x.side == "centre" and not self.helper[j]
        ]
        lines = [{e, *self.above(e)} for e in ends]
        fitting = [j for j in named if all(j in line for line in lines)]
        if fitting:
            roles["hips"] = max(fitting, key=lambda j: len(self.above(j)))
        elif len(legs) == 2 and (shared := self.common(ends)) is not None:
            roles["hips"] = shared
        elif named:
            roles["hips"] = named[0]

    def _spine(self) -> None:
        """Name what lies between hips and neck, and the neck where no joint is called so."""
        roles = self.roles
        arms = self.pair("upper_arm")
        top = roles.get("neck", roles["head"])
        line = [j for j in reversed(self.above(top)) if roles["hips"] in self.above(j) and not self.helper[j]]
        if "neck" not in roles and len(arms) == 2:
            # Joints between the arms and the head are the neck, whatever they are called.
            over = self.common(arms)
            beyond = [j for j in line if over in self.above(j)]
            if beyond:
                roles["neck"] = beyond[0]
                line = [j for j in line if j not in beyond]
        if line:
            roles["spine"] = line[0]
        rest = line[1:]
        if len(rest) == 1:
            roles["chest"] = rest[0]
        elif rest:
            roles["upper_chest"] = rest[-1]
            own = [j for j in rest[:-1] if {"chest", "thorax", "ribcage"} & set(self.words[j].words)]
            roles["chest"] = own[0] if own else rest[(len(rest) - 1) // 2]

    def face(self) -> None:
        head = self.roles.get("head")
        if head is None:
            return
        below = set(self.skeleton.descendants(head)) - {head}
        jaws = [j for j in self.called("jaw") if j in below]
        if jaws:
            self.roles["jaw"] = self.biggest(jaws)
        for side in ("left", "right"):
            own = [j for j in sorted(below) if self.words[j].side == side and not self.helper[j]]
            # "adj" marks a helper in most rigs, but VRM's own eyes bear it.
            eyes = [
                j
                for j in sorted(below)
                if self.words[j].side == side
                and self.words[j].joined.endswith(("eye", "eyeball"))
                and "under" not in self.words[j].words
            ]
            if eyes:
                self.roles[f"{side}_eye"] = eyes[0]
            lids = [j for j in own if "lid" in self.words[j].joined]
            low = [j for j in lids if {"low", "lower", "bottom", "dwn", "down"} & set(self.words[j].words)]
            high = [j for j in lids if j not in low]
            for role, found in (("upper_lid", high), ("lower_lid", low)):
                if found:  # the middle one of several along the lid
                    self.roles[f"{side}_{role}"] = sorted(found, key=lambda j: (self.words[j].number, j))[
                        len(found) // 2
                    ]

    def sound(self) -> bool:
        """Whether the limbs' roles lie on lines, no joint has two, and what is on the left is not on the
        right, too.
        """
        roles = self.roles
        if len(set(roles.values())) < len(roles):
            return False
        for side in ("left", "right"):
            for line in (("upper_arm", "lower_arm", "hand"), ("upper_leg", "lower_leg", "foot")):
                known = [roles[r] for part in line if (r := f"{side}_{part}") in roles]
                for upper, lower in pairwise(known):
                    if upper in self.skeleton.descendants(lower):
                        return False
        return True


def find_roles(skeleton: Skeleton) -> dict[str, int]:
    """Return role -> joint for the ROLES that the skeleton has: by names where these agree with the tree and
    leave no needed one out, else by the rest pose's shape.
    """
    reader = _Reader(skeleton)
    for side in ("left", "right"):
        reader.limb(side, "hand", "lower_arm", "upper_arm", "shoulder")
        reader.limb(side, "foot", "lower_leg", "upper_leg", None)
        reader.toes(side)
    reader.trunk()
    reader.face()
    if find_missing_roles(reader.roles) or not reader.sound():
        shaped = find_roles_by_shape(skeleton)
        if len(find_missing_roles(shaped)) < len(find_missing_roles(reader.roles)) or (
            shaped and not reader.sound()
        ):
            reader.roles = shaped
            reader.face()
    return _ordered(reader.roles)


def _ordered(roles: Mapping[str, int]) -> dict[str, int]:
    return {role: roles[role] for role in ROLES if role in roles}


def find_missing_roles(roles: Mapping[str, int]) -> tuple[str, ...]:
    """Return which of the REQUIRED roles are missing: the reasons why a skeleton is no humanoid."""
    return tuple(role for role in REQUIRED if role not in roles)


def is_humanoid(roles: Mapping[str, int]) -> bool:
    """Whether a skeleton with these roles can gesture, stand and look; `find_missing_roles` says what it
    lacks.
    """
    return not find_missing_roles(roles)


def is_mirrored(skeleton: Skeleton, roles: Mapping[str, int] | None = None) -> bool:
    """Return whether both feet of the rest pose point backwards, seen from where its left and right are: the
    left joints are on the right side, as in files whose writer mixed up the handedness of its axes.
    """
    roles = find_roles(skeleton) if roles is None else roles
    if not {"left_upper_leg", "right_upper_leg", "left_foot", "right_foot"} <= roles.keys():
        return False
    _, places = skeleton.globals(skeleton.rest)
    aside = places[roles["left_upper_leg"]] - places[roles["right_upper_leg"]]
    ahead = np.cross(aside, [0.0, 1.0, 0.0])
    if np.linalg.norm(ahead) < 1e-6:
        return False
    ahead /= np.linalg.norm(ahead)
    for side in ("left", "right"):
        foot = roles[f"{side}_foot"]
        below = [j for j in skeleton.descendants(foot) if j != foot]
        if not below:
            return False
        way = max((places[j] - places[foot] for j in below), key=lambda w: abs(float(w @ ahead)))
        level = np.array([way[0], 0.0, way[2]])
        if float(level @ ahead) > -max(0.02 * skeleton.height, 0.7 * float(np.linalg.norm(level))):
            return False
    return True


def assign_body_parts(skeleton: Skeleton, roles: Mapping[str, int] | None = None) -> tuple[str, ...]:
    """Return for each joint one of PARTS.

    Hips and what is above them are "legs", the line from there to the neck is "spine", neck and head are
    "head", what hangs on the head by a facial name is "face", shoulders to fingers are "arms". Any other
    joint goes with its parent.
    """
    reader = _Reader(skeleton)
    roles = find_roles(skeleton) if roles is None else roles
    known: dict[int, str] = {}
    hips = roles.get("hips")
    for joint in [hips, *reader.above(hips)] if hips is not None else ():
        known[joint] = "legs"
    head = roles.get("head")
    for joint in [head, *reader.above(head)] if head is not None else ():
        if joint not in known:
            neck = roles.get("neck")
            high = joint in (head, neck) or (neck is not None and neck in reader.above(joint))
            known[joint] = "head" if high else "spine"
    for role, joint in roles.items():
        part = {
            "spine": "spine",
            "chest": "spine",
            "upper_chest": "spine",
            "neck": "head",
            "head": "head",
        }.get(role)
        if role.endswith(("shoulder", "arm", "hand")):
            part = "arms"
        elif role.endswith(("leg", "foot", "toes")):
            part = "legs"
        elif role.endswith(("eye", "lid", "jaw")):
            part = "face"
        if part and known.get(joint) != "legs":
            known[joint] = part
    inside = set(skeleton.descendants(head)) if head is not None else set()
    out: list[str] = []
    for i, words in enumerate(reader.words):
        parent = reader.parents[i]
        part = known.get(i)
        if part is None and i in inside:
            facial = FACE & set(words.words) or words.joined.endswith(("lip", "lid", "brow", "eye"))
            part = "face" if facial or out[parent] == "face" else "head"
        if (
            part is None
            and words.side != "centre"
            and ARM & set(words.words)
            and (parent < 0 or out[parent] in ("legs", "spine"))
        ):
            foot = {"foot", "toe", "leg"} & set(words.words)  # "LeftFootThumb" is a toe
            part = None if foot else "arms"
        out.append(part or (out[parent] if parent >= 0 else "legs"))
    return tuple(out)


def find_joint_sides(skeleton: Skeleton, roles: Mapping[str, int] | None = None) -> tuple[str, ...]:
    """Return for each joint "left", "right" or "centre": by role, by name, else as its parent."""
    reader = _Reader(skeleton)
    roles = find_roles(skeleton) if roles is None else roles
    known = {
        joint: role.split("_")[0] for role, joint in roles.items() if role.startswith(("left_", "right_"))
    }
    known.update({joint: "centre" for role, joint in roles.items() if role in _CENTRE})
    out: list[str] = []
    for i, words in enumerate(reader.words):
        parent = reader.parents[i]
        inherited = out[parent] if parent >= 0 else "centre"
        out.append(known.get(i) or (words.side if words.side != "centre" else inherited))
    return tuple(out)
