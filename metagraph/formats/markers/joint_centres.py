"""Find the centres of joints between markers on the skin, by the names that laboratories give them.

A joint's centre is the middle of the markers at its sides. A hip's lies within the pelvis: from the front
iliac spine 14 % of the distance between both towards the middle, 30 % down and 19 % back (Bell, Pedersen and
Brand 1990). Names: Plug-in Gait and CGM2 (Vicon), ISB and CAST, OpenSim, OpenCap, Pose2Sim, OptiTrack and
Qualisys Animation.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.errors import FileError, clean_text
from metagraph.formats.markers.marker_take import MarkerTake
from metagraph.mimicry.keypoint_layouts import PLACE, POINTS, KeypointTrack

Array = NDArray[Any]

MEDIAL, DOWN, BACK = 0.14, 0.30, 0.19  # Bell 1990, of the distance between the front iliac spines
# Point -> sets of markers whose middle it is; the first that is whole counts. S stands for the side, L or R.
# What only one marker shows, on the skin, comes last.
CENTRES: Mapping[str, tuple[str, ...]] = {
    "shoulder": ("SSJC", "SSHOULDER", "SSHOULDERJOINT", "SSHO", "SCAJ", "SSAE", "SACROMIUM", "SACROMION",
                 "SACR", "SSHOULDERTOP"),
    "elbow": ("SEJC", "SELBOW", "SELBOWLAT SELBOWMED", "SELBOWOUT SELBOWIN", "SLELBOW SMELBOW", "SHLE SHME",
              "SELB SELBM", "SELB SMEL", "SELB SELM", "SLEL SMEL", "SELB", "SELBOWOUT",
              "SLELBOW", "SHLE", "SELBOWLAT"),
    "wrist": ("SWJC", "SWRIST", "SWRA SWRB", "SWRISTOUT SWRISTIN", "SLWRIST SMWRIST", "SRSP SUSP",
              "SWRISTLAT SWRISTMED", "SRADIUS SULNA", "SRAD SULN", "SWRI", "SWRA", "SWRISTOUT", "SLWRIST"),
    "hip": ("SHJC", "SHIP", "SHIPJOINT"),
    "knee": ("SKJC", "SKNEE SMKNEE", "SKNEELAT SKNEEMED", "SKNEEOUT SKNEEIN", "SFLE SFME", "SKNE SKNM",
             "SKNE SKNEM", "SKNE SMKNE", "SKNEE", "SKNE", "SKNEEOUT", "SFLE", "SKNEELAT"),
    "ankle": ("SAJC", "SANKLE SMANKLE", "SANKLELAT SANKLEMED", "SANKLEOUT SANKLEIN", "SFAL STAM", "SANK SMED",
              "SANK SANKM", "SANK SANM", "SANKLE", "SANK", "SANKLEOUT", "SFAL", "SANKLELAT"),
    "ear": ("SEAR", "SFHD SBHD", "HEADS"),
    "eye": ("SEYE",),
}  # fmt: skip
NOSES = ("NOSE", "LFHD RFHD", "HEADFRONT", "FRONTHEAD")
FRONTS = ("SASI", "SASIS", "SIAS", "WAISTSFRONT")  # the front iliac spines
BACKS = ("LPSI RPSI", "LPSIS RPSIS", "LIPS RIPS", "SACR", "SACRUM", "VSACRAL", "WAISTLBACK WAISTRBACK",
         "SACRAL", "WAISTBACK")  # fmt: skip
TRUNK = (0.1, 1.5)  # metres from hips to shoulders: outside of it the unit is another
USUAL = (0.2, 0.9)  # metres that a trunk is long
NEEDED = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
_SETS = "Plug-in Gait, ISB, OpenSim, OpenCap, OptiTrack or Qualisys Animation, or joints: LShoulder"


def find_joint_centres(path: Path, take: MarkerTake) -> KeypointTrack:
    """Return the body's points that markers show, metres, in the axes of keypoints: the body stands along y
    and looks along z at first. Raises FileError where the names are those of no set that is known.
    """
    markers, told = _by_name(take)
    points = np.full((len(take.places), len(POINTS), 3), np.nan)
    skin = []
    for part, sets in CENTRES.items():
        for side in ("left", "right"):
            name = f"{side}_{part}"
            found, used = _middle(markers, [_of_side(words, side) for words in sets])
            if found is None and part == "hip":
                found, used = _hip(markers, side), ""
            if found is not None:
                points[:, PLACE[name]] = found
                if part in NEEDED and used in _ONE_SIDED and part not in skin:
                    skin.append(part)
    nose, _ = _middle(markers, NOSES)
    if nose is not None:
        points[:, PLACE["nose"]] = nose
    seen = np.isfinite(points).all(-1)
    lacking = [p for p in NEEDED if not all(seen[:, PLACE[f"{s}_{p}"]].any() for s in ("left", "right"))]
    if lacking:
        raise FileError(
            path,
            phrase(
                "its markers do not show both of each {parts}; they are named {names}",
                parts=", ".join(lacking),
                names=", ".join(take.names[:12]) + (" ..." if len(take.names) > 12 else ""),
            ),
            "",
            phrase("Name them as in {sets}.", sets=_SETS),
        )
    notes = [*take.notes, *told]
    if skin:
        notes.append(
            phrase("only one marker of the {parts} is known, and it is on the skin", parts=", ".join(skin))
        )
    points = _in_metres(points, notes)
    turned = _upright(np.where(seen[..., None], points, 0.0), seen)
    times = np.arange(len(points)) / take.rate
    return KeypointTrack(times, turned, seen.astype(float), POINTS, 3, tuple(notes))


_ONE_SIDED = frozenset(
    f"{side}{word}"
    for side in "LR"
    for word in (
        "ELB",
        "ELBOWOUT",
        "LELBOW",
        "HLE",
        "ELBOWLAT",
        "WRA",
        "WRISTOUT",
        "LWRIST",
        "KNE",
        "KNEEOUT",
    )
    + ("FLE", "KNEELAT", "ANK", "ANKLEOUT", "FAL", "ANKLELAT", "SHO", "ACR", "ACROMIUM", "ACROMION")
)


def _by_name(take: MarkerTake) -> tuple[dict[str, Array], list[str]]:
    """Return markers `[F, 3]` of one subject by their plain names, and notes: without the subject's name,
    signs, and what says of which study they are; the first of those with one name. Of several subjects it is
    the one with most markers of a body, of equals the first.
    """
    subjects: dict[str, dict[str, Array]] = {}
    for n, name in enumerate(take.names):
        subject, _, own = name.strip().rpartition(":")
        word = re.sub(r"[^a-z0-9]", "", re.sub(r"_study$", "", own, flags=re.I).lower())
        word = re.sub(r"^left", "l", re.sub(r"^right", "r", word))
        subjects.setdefault(subject.strip(), {}).setdefault(word.upper(), take.places[:, n])
    bodies = {who: len(_KNOWN & set(markers)) for who, markers in subjects.items()}
    whose = max(bodies, key=lambda who: bodies[who])
    others = [who for who, count in bodies.items() if who and who != whose and count > 0]
    # Markers without a subject belong to the one that is read.
    out = {**(subjects.get("") or {}), **subjects[whose]}
    if not others:
        return out, []
    return out, [
        phrase(
            "it has several subjects: {whose} is read, not {others}",
            whose=clean_text(whose[:40]) or phrase("the one without a name"),
            others=", ".join(clean_text(who[:40]) for who in others[:6]),
        )
    ]


def _of_side(words: str, side: str) -> str:
    """Return names of markers with the side's letter for the S that stands for it."""
    letter = side[0].upper()
    return " ".join(
        f"HEAD{letter}" if w == "HEADS" else w.replace("WAISTS", f"WAIST{letter}") if "WAISTS" in w
        else letter + w[1:]
        for w in words.split()
    )  # fmt: skip


_KNOWN = frozenset(
    name
    for sets in (*CENTRES.values(), FRONTS, BACKS, NOSES)
    for words in sets
    for side in ("left", "right")
    for name in _of_side(words, side).split()
)


def _middle(markers: Mapping[str, Array], sets: Sequence[str]) -> tuple[Array | None, str]:
    """Return the middle `[F, 3]` of the first set of markers that is whole, and the set."""
    for words in sets:
        names = words.split()
        if all(name in markers for name in names):
            return np.asarray(np.mean([markers[name] for name in names], axis=0)), words
    return None, ""


def _hip(markers: Mapping[str, Array], side: str) -> Array | None:
    """Return where a hip is within the pelvis `[F, 3]`; None if the pelvis has not three markers."""
    left, _ = _middle(markers, [_of_side(words, "left") for words in FRONTS])
    right, _ = _middle(markers, [_of_side(words, "right") for words in FRONTS])
    back, _ = _middle(markers, BACKS)
    if left is None or right is None or back is None:
        return None
    wide = np.linalg.norm(left - right, axis=-1, keepdims=True)
    x = (left - right) / np.maximum(wide, 1e-9)
    z = (left + right) / 2 - back
    z = z - (z * x).sum(-1, keepdims=True) * x
    z = z / np.maximum(np.linalg.norm(z, axis=-1, keepdims=True), 1e-9)
    y = np.cross(z, x)
    own, way = (left, -1.0) if side == "left" else (right, 1.0)
    return np.asarray(own + wide * (way * MEDIAL * x - DOWN * y - BACK * z))


def _in_metres(points: Array, notes: list[str]) -> Array:
    """Return points with a trunk as long as a person's: files say millimetres of metres, and the reverse."""
    ends = [points[:, [PLACE[f"left_{p}"], PLACE[f"right_{p}"]]].mean(1) for p in ("shoulder", "hip")]
    far = np.linalg.norm(ends[0] - ends[1], axis=-1)
    trunk = float(np.median(far[np.isfinite(far)])) if np.isfinite(far).any() else 0.0
    if trunk <= 0 or TRUNK[0] <= trunk <= TRUNK[1]:
        return points
    scale = next((x for x in (1000.0, 0.001, 100.0, 0.01) if USUAL[0] <= trunk * x <= USUAL[1]), None)
    if scale is None:
        return points
    notes.append(
        phrase(
            "in its stated unit, the trunk is {trunk:.3g} m long: read {factor:g} times {way}",
            trunk=trunk,
            factor=max(scale, 1 / scale),
            way=phrase("larger") if scale > 1 else phrase("smaller"),
        )
    )
    return points * scale


def _upright(points: Array, seen: Array) -> Array:
    """Return points turned so that the body stands along y and looks along z at first; the floor stays."""

    def middle(part: str) -> tuple[Array, Array]:
        places = [PLACE[f"left_{part}"], PLACE[f"right_{part}"]]
        return np.asarray(points[:, places].mean(1)), np.asarray(seen[:, places].all(1))

    (top, has_top), (low, has_low) = middle("shoulder"), middle("hip")
    whole = has_top & has_low
    if not whole.any():
        return points
    trunk = np.median((top - low)[whole], axis=0)
    axis = int(np.argmax(np.abs(trunk)))
    up = np.eye(3)[axis] * np.sign(trunk[axis])
    first = int(np.flatnonzero(whole)[0])
    left = points[first, PLACE["left_hip"]] - points[first, PLACE["right_hip"]]
    left = left - (left @ up) * up
    size = float(np.linalg.norm(left))
    if size < 1e-6:
        return points
    x = left / size
    turn = np.stack([x, up, np.cross(x, up)], -1)
    return np.asarray(points @ turn)
