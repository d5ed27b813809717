"""What a joint's name alone says: its words, its side, and the kind of joint it may be."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_LEFT, _RIGHT = {"left", "l", "lft", "lf"}, {"right", "r", "rgt", "rt"}
# Capture labs write small letters without a gap: lfemur, rhumerus.
_BONES = re.compile(
    r"([lr])(hipjoint|femur|tibia|foot|toes|clavicle|humerus|radius|wrist|hand|fingers|thumb)"
)
# Joints that serve the animator or the skin, not the body.
HELPERS = _words(
    "ik fk pole target ctrl control controller twist roll helper end nub effector goal slot aux adjust adj "
    "dummy socket prop"
    " weapon mch org tweak mid handle locator footsteps offset driver jiggle volume corrective bulge muscle"
)
_FOUR_LEGGED = {"front", "hind", "rear", "back"}
FACE = _words(
    "eye eyes eyeball eyebrow brow lid eyelid lids jaw mouth lip lips tongue cheek nose nostril chin teeth "
    "tooth temple zygomatic"
    " squint sneer crease face facial corner gum forehead"
)
ARM = _words(
    "hand wrist elbow arm forearm upperarm lowerarm shoulder clav clavicle collar thumb index middle ring "
    "pinky little"
    " finger fingers fng palm"
)


@dataclass(frozen=True)
class JointWords:
    """A joint's name taken apart: words without side and digits, run together, and the side it names."""

    words: tuple[str, ...]
    joined: str
    side: str
    number: int


@lru_cache(maxsize=4096)  # clips of a project name the same joints
def split_joint_name(name: str) -> JointWords:
    """Split a name at separators, capitals and digits, without its namespace."""
    bare = re.split(r"[:|]", name)[-1]
    pieces = [
        p.lower() for p in re.findall(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+|[^\W\d_a-zA-Z]+", bare)
    ]
    words: list[str] = []
    side, number = "centre", 0
    for piece in pieces:
        glued = re.fullmatch(r"(left|right)(\w+)", piece) or _BONES.fullmatch(piece)
        for word in (glued[1], glued[2]) if glued else (piece,):
            if word in _LEFT:
                side = "left"
            elif word in _RIGHT:
                side = "right"
            elif word.isdecimal() and len(word) < 10:
                number = int(word)
            elif word not in ("c", "m"):
                words.append(word)
    return JointWords(tuple(words), "".join(words), side, number)


@lru_cache(maxsize=4096)
def guess_joint_kind(words: JointWords) -> str:
    """Return what a name alone says of a limb's joint; "" when it says nothing, or nothing certain."""
    own, joined = set(words.words), words.joined
    if own & _FOUR_LEGGED and ("leg" in joined or "foot" in joined or "paw" in joined or "toe" in joined):
        return ""
    for kind, tests in (
        ("lower_arm", ("forearm", "lowerarm", "lowarm", "armlower", "elbow", "ulna", "radius")),
        ("upper_arm", ("upperarm", "uparm", "armupper", "humerus")),
        ("lower_leg", ("lowerleg", "lowleg", "leglower", "knee", "calf", "shin", "tibia")),
        ("upper_leg", ("upperleg", "upleg", "legupper", "thigh", "femur")),
        ("shoulder", ("clav", "collar", "scapula")),
    ):
        if any(test in joined for test in tests):
            return kind
    for kind, exact in (
        ("hand", {"hand", "wrist", "palm"}),
        ("foot", {"foot", "ankle", "feet"}),
        ("toes", {"toe", "toes", "ball", "toebase"}),
        ("upper_arm", {"arm"}),
    ):
        if own & exact:
            return kind
    return ""
