"""Map the joints of one skeleton to those of another: by roles, by parsed names, by hand; each pair has a
certainty.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from numpy.typing import NDArray

from metagraph.motion.joint_names import guess_joint_kind, split_joint_name
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

SIDES = ("left", "right")
FINGERS = ("thumb", "index", "middle", "ring", "little")
# Words for each finger. The first finger that fits counts: "RingPinky" is a little finger.
_MARKS = {
    "thumb": ("thumb",),
    "index": ("index",),
    "middle": ("middle", "mid"),
    "little": ("little", "pinky"),
    "ring": ("ring",),
}
ARM, LEG = ("upper_arm", "lower_arm", "hand"), ("upper_leg", "lower_leg", "foot")
TRUNK = ("hips", "spine", "chest", "upper_chest", "neck", "head")
# Without these, nothing sensible can be carried over.
NEEDED = ("hips", "head", *(f"{side}_{part}" for side in SIDES for part in (*ARM, *LEG)))
_PLAIN = (
    *TRUNK,
    "jaw",
    *(f"{side}_{part}" for side in SIDES for part in ("eye", "shoulder", *ARM, *LEG, "toes")),
)


class RetargetError(ValueError):
    """Raised if a clip cannot be retargeted to a skeleton; the message says why."""


def make_fingerprint(skeleton: Skeleton) -> str:
    """Return a short text that identifies a rig in every file and size, to remember maps by.

    It is made of the joints' names and parents, in any order, because a map does not depend on lengths or
    rest poses.
    """
    above = (skeleton.names[p] if p >= 0 else "" for p in skeleton.parents)
    rows = sorted(f"{name}\t{parent}" for name, parent in zip(skeleton.names, above, strict=True))
    return hashlib.sha256("\n".join(rows).encode()).hexdigest()[:16]


@dataclass(frozen=True, slots=True)
class JointPair:
    """A joint of the source and the joint of the target that follows it.

    `role` is what both do, as in `roles.ROLES`, `left_index_1`, `left_lower_arm_twist_1`, `root`, or "" for a
    pair by name. `sure` is the certainty, 0..1, and `why` the reason in words.
    """

    source: str
    target: str
    role: str = ""
    sure: float = 1.0
    why: str = "chosen by hand"


@dataclass(frozen=True)
class JointMap:
    """Joints of one skeleton and those of another that follow them.

    `source` and `target` are the skeletons' fingerprints. With `contacts`, hands that touch their own body
    touch it at the same place.
    """

    source: str
    target: str
    pairs: tuple[JointPair, ...]
    contacts: bool = True

    def of(self, source: str) -> JointPair | None:
        return next((p for p in self.pairs if p.source == source), None)

    def with_pair(self, source: str, target: str, role: str | None = None) -> JointMap:
        """Return the map with `target` following `source`. Without a role, the pair keeps that of the pair it
        replaces.
        """
        before = [p for p in self.pairs if p.source == source or p.target == target]
        if role is None:
            known = [p.role for p in before if p.source == source] + [p.role for p in before]
            role = next((r for r in known if r), "")
        kept = tuple(p for p in self.pairs if p not in before and (p.role != role or not role))
        return replace(self, pairs=(*kept, JointPair(source, target, role)))

    def without(self, joint: str) -> JointMap:
        """Return the map without the pairs of a joint of either skeleton."""
        return replace(self, pairs=tuple(p for p in self.pairs if joint not in (p.source, p.target)))

    @property
    def reversed(self) -> JointMap:
        pairs = tuple(replace(p, source=p.target, target=p.source) for p in self.pairs)
        return JointMap(self.target, self.source, pairs, self.contacts)

    @property
    def missing(self) -> tuple[str, ...]:
        """Return `find_missing_roles` in words."""
        return tuple(f"no {role.replace('_', ' ')} in both" for role in self.missing_roles)

    @property
    def missing_roles(self) -> tuple[str, ...]:
        """Return the roles that must be mapped and are not. A clip can be retargeted if there are none."""
        roles = {p.role for p in self.pairs}
        return tuple(role for role in NEEDED if role not in roles)

    def to_json(self) -> dict[str, Any]:
        rows = [
            {"from": p.source, "to": p.target, "role": p.role, "sure": round(p.sure, 3), "why": p.why}
            for p in self.pairs
        ]
        out: dict[str, Any] = {"source": self.source, "target": self.target, "pairs": rows}
        return out if self.contacts else {**out, "contacts": False}

    @staticmethod
    def from_json(data: Mapping[str, Any]) -> JointMap:
        """Read a joint map. Raises RetargetError if the data is not one."""
        try:
            pairs = tuple(
                JointPair(
                    str(p["from"]),
                    str(p["to"]),
                    str(p.get("role", "")),
                    float(p.get("sure", 1)),
                    str(p.get("why", "")),
                )
                for p in data["pairs"]
            )
            return JointMap(str(data["source"]), str(data["target"]), pairs, bool(data.get("contacts", True)))
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise RetargetError(f"that is no joint map ({error!r})") from None


def propose_joint_map(
    source: Skeleton,
    target: Skeleton,
    source_roles: Mapping[str, int] | None = None,
    target_roles: Mapping[str, int] | None = None,
) -> JointMap:
    """Propose which joint of `target` follows which joint of `source`: by roles, fingers and twists, then by
    names.
    """
    ours, theirs = find_known_roles(source, source_roles), find_known_roles(target, target_roles)
    pairs: dict[str, JointPair] = {}
    taken: set[str] = set()

    def add(a: int, b: int, role: str, sure: float, why: str) -> None:
        one, two = source.names[a], target.names[b]
        if one not in pairs and two not in taken:
            pairs[one] = JointPair(one, two, role, sure, why)
            taken.add(two)

    for role, joint in ours.items():
        if role in theirs:
            other = theirs[role]
            same = (
                split_joint_name(source.names[joint]).joined == split_joint_name(target.names[other]).joined
            )
            shaped = not role[-1].isdecimal() and _unnamed(source.names[joint], role) + _unnamed(
                target.names[other], role
            )
            sure = 1.0 if same else 0.9 - 0.15 * shaped
            add(
                joint,
                other,
                role,
                sure,
                "same role and name" if same else "same part of the body",
            )
    tops = [[roles[r] for r in ("spine", "chest", "upper_chest") if r in roles] for roles in (ours, theirs)]
    if all(tops):
        add(tops[0][-1], tops[1][-1], "upper_chest", 0.7, "both carry the arms")
    if source.parents[ours.get("hips", 0)] >= 0 and theirs and target.parents[theirs.get("hips", 0)] >= 0:
        add(0, 0, "root", 0.8, "both stand above the hips")
    names: dict[tuple[Any, ...], list[int]] = {}
    for i, name in enumerate(target.names):
        words = split_joint_name(name)
        names.setdefault((words.words, words.side, words.number), []).append(i)
    for i, name in enumerate(source.names):
        words = split_joint_name(name)
        found = names.get((words.words, words.side, words.number), [])
        exact = name in target
        j = target.index(name) if exact else found[0] if len(found) == 1 and words.words else -1
        if j >= 0:
            add(i, j, "", 0.9 if exact else 0.6, "same name" if exact else "same words in the name")
    return JointMap(make_fingerprint(source), make_fingerprint(target), tuple(pairs.values()))


def find_known_roles(skeleton: Skeleton, roles: Mapping[str, int] | None) -> dict[str, int]:
    """Return roles, including those of fingers and twist joints that can be recognised."""
    roles = find_roles(skeleton) if roles is None else roles
    out = {role: roles[role] for role in _PLAIN if role in roles}
    for side in SIDES:
        out.update(_fingers(skeleton, out, side))
    return {**out, **_twists(skeleton, out)}


def _fingers(skeleton: Skeleton, roles: Mapping[str, int], side: str) -> dict[str, int]:
    top = roles.get(f"{side}_lower_arm", roles.get(f"{side}_hand"))
    if top is None:
        return {}
    lines: dict[str, list[int]] = {}
    for j in skeleton.descendants(top):
        words = split_joint_name(skeleton.names[j])
        if {"end", "nub", "tip", "metacarpal", "carpal", "twist", "roll"} & set(words.words):
            continue
        numbered = re.search(r"[Ff]inger(\d)", skeleton.names[j])
        for finger, marks in _MARKS.items():
            named = any(m in words.words or any(w.endswith(m) for w in words.words) for m in marks)
            if named or (numbered and int(numbered[1]) == FINGERS.index(finger)):
                lines.setdefault(finger, []).append(j)
                break
    out = {}
    for finger, line in lines.items():
        for n, joint in enumerate(sorted(line, key=lambda j: len(skeleton.chain(j)))[:3], 1):
            out[f"{side}_{finger}_{n}"] = joint
    return out


def _twists(skeleton: Skeleton, roles: Mapping[str, int]) -> dict[str, int]:
    """Return the joints that turn with a bone but do not bend it: helpers attached to it, numbered from its
    root.
    """
    out: dict[str, int] = {}
    taken = set(roles.values())
    for role in [f"{side}_{part}" for side in SIDES for part in (*ARM[:2], *LEG[:2])]:
        if role not in roles:
            continue
        found = [
            c
            for c in skeleton.children[roles[role]]
            if c not in taken and {"twist", "roll"} & set(split_joint_name(skeleton.names[c]).words)
        ]
        out.update({f"{role}_twist_{n}": c for n, c in enumerate(found, 1)})
    return out


def _unnamed(name: str, role: str) -> int:
    """Return 1 if the name alone does not say the role, else 0."""
    words = split_joint_name(name)
    bare = role.removeprefix("left_").removeprefix("right_")
    return int(guess_joint_kind(words) != bare and bare.replace("_", "") not in words.joined)
