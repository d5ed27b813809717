"""What the sample character's joints are called under the conventions of tools."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

PARTS = (
    "Hips Spine Chest UpperChest Neck Head Jaw Shoulder UpperArm LowerArm Hand UpperLeg LowerLeg Foot Toes"
)


@dataclass(frozen=True)
class Convention:
    """words: a name for each of PARTS, `@` the side. finger: with `{f}` and `{n}`. fingers: their names.
    face: eyes, lids and brows, with `{f}`. root: what is above the hips, where something is.
    """

    words: tuple[str, ...]
    sides: tuple[str, str]
    finger: str
    fingers: tuple[str, ...] = ("Thumb", "Index", "Middle", "Ring", "Pinky")
    face: str = "@{f}"
    root: str = "Root"


def _of(words: str, sides: str, finger: str, **more: str) -> Convention:
    left, right = sides.split()
    return Convention(
        tuple(words.replace("~", " ").split("|")), (left, right), finger.replace("~", " "), **more
    )  # type: ignore[arg-type]


CONVENTIONS: Mapping[str, Convention] = {
    "sample": Convention((), ("", ""), ""),
    "mixamo": _of(
        "mixamorig:Hips|mixamorig:Spine|mixamorig:Spine1|mixamorig:Spine2|mixamorig:Neck|mixamorig:Head|"
        "mixamorig:Jaw|mixamorig:@Shoulder|mixamorig:@Arm|mixamorig:@ForeArm|mixamorig:@Hand|"
        "mixamorig:@UpLeg|mixamorig:@Leg|mixamorig:@Foot|mixamorig:@ToeBase",
        "Left Right",
        "mixamorig:@Hand{f}{n}",
        face="mixamorig:@{f}",
    ),
    "biped": _of(
        "Bip01~Pelvis|Bip01~Spine|Bip01~Spine1|Bip01~Spine2|Bip01~Neck|Bip01~Head|Bip01~Jaw|"
        "Bip01~@~Clavicle|Bip01~@~UpperArm|Bip01~@~Forearm|Bip01~@~Hand|"
        "Bip01~@~Thigh|Bip01~@~Calf|Bip01~@~Foot|Bip01~@~Toe0",
        "L R",
        "Bip01~@~{f}{n}",
        root="Bip01",
    ),
    "unreal": _of(
        "pelvis|spine_01|spine_02|spine_03|neck_01|head|jaw|clavicle_@|upperarm_@|lowerarm_@|hand_@|"
        "thigh_@|calf_@|foot_@|ball_@",
        "l r",
        "{f}_0{n}_@",
        face="{f}_@",
        root="root",
    ),
    "blender": _of(
        "hips|spine|chest|upper_chest|neck|head|jaw|shoulder.@|upper_arm.@|forearm.@|hand.@|"
        "thigh.@|shin.@|foot.@|toe.@",
        "L R",
        "f_{f}.0{n}.@",
        face="{f}.@",
        root="rig",
    ),
    "letters": _of(
        "JtPelvis|JtSpineA|JtSpineB|JtSpineC|JtNeckA|JtSkullA|JtJaw|JtClavicle@|JtShoulder@|JtElbow@|"
        "JtWrist@|JtHip@|JtKnee@|JtAnkle@|JtBall@",
        "Lf Rt",
        "Jt{f}{n}@",
        face="Jt{f}@",
        root="JtRoot",
    ),
    "lower": _of(
        "hips|lowerback|thorax|upperthorax|lowerneck|head|jaw|@clavicle|@humerus|@radius|@hand|"
        "@femur|@tibia|@foot|@toes",
        "l r",
        "@{f}{n}",
        face="@{f}",
        root="reference",
    ),
    "japanese": _of(
        "下半身|上半身|上半身2|上半身3|首|頭|あご|@肩|@腕|@ひじ|@手首|@足|@ひざ|@足首|@つま先",
        "左 右",
        "@{f}{n}",
        fingers=("親指", "人指", "中指", "薬指", "小指"),  # type: ignore[arg-type]
        root="センター",
    ),
    "numbers": Convention((), ("", ""), "", root="node_root"),
}
_FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")


def called(convention: str, name: str) -> str:
    """Return what a joint of the sample character is called."""
    how = CONVENTIONS[convention]
    if convention == "sample":
        return name
    if convention == "numbers":
        from tests.label_zoo.source import skeleton

        return f"joint_{skeleton().index(name):02d}"
    found = re.fullmatch(r"(Left|Right)?(.+?)(\d?)", name)
    assert found is not None
    side, part, number = found.groups()
    if part in _FINGERS:
        word = how.finger.replace("{f}", how.fingers[_FINGERS.index(part)]).replace("{n}", number)
    elif part in PARTS.split():
        word = how.words[PARTS.split().index(part)]
    else:
        word = how.face.replace("{f}", part)
    return word.replace("@", how.sides[side == "Right"] if side else "")
