"""Who our characters are: what each wears, its hair, its build and its colours.

All share the mannequin's skeleton, so that every clip moves each of them as it is.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Color = tuple[int, int, int]

# Rows of the image, sRGB in full light. Neighbours may melt into each other: blush, skin, lip, mouth.
NEUTRAL: dict[str, Color] = {
    "blush": (206, 182, 168),
    "skin": (206, 190, 177),
    "lip": (184, 150, 138),
    "mouth": (70, 50, 48),
    "teeth": (232, 229, 222),
    "hair": (82, 76, 73),
    "lash": (58, 52, 50),
    "sweater": (146, 150, 158),
    "band": (112, 116, 124),
    "trousers": (98, 102, 112),
    "shoe": (72, 74, 80),
    "sole": (206, 204, 199),
    "white": (238, 237, 234),
    "iris": (104, 92, 80),
    "pupil": (26, 24, 24),
    "beard": (82, 76, 73),
    "coat": (98, 102, 112),
    "frame": (40, 40, 44),
    "metal": (212, 178, 110),
}
ROWS = {name: i for i, name in enumerate(NEUTRAL)}
GLOSSY = ("white", "iris", "pupil", "teeth", "frame", "metal")  # the first three: of the eyeball's image
LIVING = ("blush", "skin", "lip")  # what light goes a little way into: its shadows are warm
# How rough each kind of surface is, 0..1: the material's name, what is of it, roughness. What covers others
# comes first: so nothing is shaded that is not seen.
MATERIALS = (
    ("hair", ("hair", "lash", "beard"), 0.56),
    ("wool", ("coat",), 0.94),
    ("knit", ("sweater", "band"), 0.92),
    ("denim", ("trousers",), 0.90),
    ("skin", ("blush", "skin", "lip", "mouth"), 0.66),
    ("shoes", ("shoe", "sole"), 0.74),
    ("eyes", GLOSSY, 0.12),
    ("eyeball", (), 0.10),
)


@dataclass(frozen=True)
class Build:
    """How a body differs from the mannequin's. trunk: (height in metres, wide, deep ahead, deep behind), the
    scales of the trunk at heights, upwards. arms, legs, neck: scales about the bones. jaw: of its width.
    nose: of its size. lips: of their fullness. cheeks, chin: metres outwards, downwards. bust: metres that
    the breasts stand out.
    """

    trunk: tuple[tuple[float, float, float, float], ...] = ()
    arms: float = 1.0
    legs: float = 1.0
    neck: float = 1.0
    jaw: float = 1.0
    nose: float = 1.0
    lips: float = 1.0
    cheeks: float = 0.0
    chin: float = 0.0
    brows: float = 1.0
    bust: float = 0.0


@dataclass(frozen=True)
class Look:
    """A character of ours. colors: what differs from `NEUTRAL`. sleeve: metres the sleeves end above the
    wrist. targets: whether the face has morph targets. lids: degrees the upper lids rest lower. lashes: their
    length, metres.
    """

    name: str
    colors: Mapping[str, Color] = field(default_factory=dict)
    hair: Literal["short", "bob", "receding"] = "short"
    build: Build = Build()
    sleeve: float = 0.0
    coat: bool = False
    beard: bool = False
    glasses: bool = False
    earrings: bool = False
    targets: bool = True
    lids: float = 0.0
    lashes: float = 0.0030

    @property
    def file(self) -> str:
        return f"{self.name.lower()}.glb"

    def image(self) -> bytes:
        """Return the colour rows as PNG: 64 texels from shadow to light, one texel a row,
        so that neighbouring rows melt into each other."""
        from PIL import Image

        u = np.linspace(0, 1, 64)[:, None]
        rows = []
        for name, neutral in NEUTRAL.items():
            dark = np.array([0.42, 0.25, 0.22] if name in LIVING and self.colors else [0.30, 0.265, 0.26])
            color = np.array(self.colors.get(name, neutral))
            rows.append(((dark + (1 - dark) * u) * color)[None])
        out = io.BytesIO()
        Image.fromarray(np.concatenate(rows).round().astype(np.uint8)).save(out, "PNG", optimize=True)
        return out.getvalue()


MANNEQUIN = Look("Mannequin", targets=False)
ADA = Look(
    "Ada",
    {
        "blush": (158, 98, 80),
        "skin": (170, 120, 96),
        "lip": (146, 84, 80),
        "mouth": (62, 30, 30),
        "hair": (82, 56, 44),
        "lash": (30, 20, 18),
        "sweater": (204, 128, 104),
        "band": (180, 106, 84),
        "trousers": (66, 76, 98),
        "shoe": (232, 226, 216),
        "sole": (208, 190, 168),
        "iris": (70, 44, 28),
    },
    hair="bob",
    build=Build(
        trunk=(
            (0.80, 0.99, 0.98, 1.02),
            (0.92, 0.99, 0.94, 1.03),
            (1.00, 0.92, 0.88, 0.96),
            (1.09, 0.85, 0.86, 0.94),
            (1.18, 0.86, 0.90, 0.92),
            (1.27, 0.89, 0.98, 0.90),
            (1.35, 0.92, 0.94, 0.90),
            (1.43, 0.95, 0.94, 0.94),
        ),
        arms=0.86,
        legs=0.96,
        neck=0.96,
        jaw=0.93,
        nose=0.90,
        lips=1.22,
        cheeks=0.0012,
        chin=-0.002,
        brows=0.8,
        bust=0.022,
    ),
    sleeve=0.085,
    earrings=True,
    lids=8.0,
)
BEN = Look(
    "Ben",
    {
        "blush": (214, 160, 142),
        "skin": (224, 188, 168),
        "lip": (196, 140, 128),
        "mouth": (74, 38, 36),
        "hair": (134, 130, 126),
        "lash": (92, 84, 78),
        "sweater": (188, 204, 222),
        "band": (206, 220, 234),
        "trousers": (128, 118, 106),
        "shoe": (92, 58, 38),
        "sole": (58, 44, 36),
        "iris": (86, 116, 138),
        "beard": (150, 145, 140),
        "coat": (66, 84, 98),
        "frame": (34, 28, 26),
    },
    hair="receding",
    build=Build(
        trunk=(
            (0.80, 1.03, 1.02, 1.03),
            (0.92, 1.08, 1.14, 1.04),
            (1.02, 1.12, 1.34, 1.05),
            (1.11, 1.12, 1.36, 1.05),
            (1.20, 1.08, 1.18, 1.05),
            (1.30, 1.05, 1.05, 1.05),
            (1.43, 1.03, 1.02, 1.03),
        ),
        arms=1.07,
        legs=1.04,
        neck=1.03,
        jaw=1.07,
        nose=1.16,
        lips=0.92,
        cheeks=0.0015,
        chin=0.002,
        brows=1.35,
    ),
    coat=True,
    beard=True,
    glasses=True,
    lids=8.0,
    lashes=0.0014,
)
LOOKS = (MANNEQUIN, ADA, BEN)
