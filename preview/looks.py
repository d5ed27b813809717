"""Define lights and backgrounds to look at a character in, presets that change a theme, and seats.

The light "studio" and the background "stage" leave the theme unchanged.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from preview.scene import THEMES, BackPicture, Color, SceneTheme, Walls


@dataclass(frozen=True)
class Light:
    """A preset of the lamp. `words` is its name. `toward` is the direction to the lamp, of any length, above
    the ground. `key`, `above`, `below` and `rim` are the linear colours of the lamp and of the light from
    above, from below and round the edges. `dark` is the share of the theme's shadow on the ground, 0..1.
    """

    words: str
    toward: Color
    key: Color
    above: Color
    below: Color
    rim: Color
    dark: float = 1.0


@dataclass(frozen=True)
class BackdropLook:
    """A preset of the background. `words` is its name. `top` and `bottom` are the colours of the gradient
    behind the figure, outside and in its middle, sRGB. `floor` is the colour of the ground near the figure,
    `line` that of its grid, None for no grid. `shadow` says whether the ground shows shadows.
    """

    words: str
    top: Color
    bottom: Color
    floor: Color
    line: Color | None = None
    shadow: bool = True


def _plain(words: str, color: Color, shadow: bool = True) -> BackdropLook:
    return BackdropLook(words, color, color, color, None, shadow)


STUDIO, STAGE = "studio", "stage"
SEATS = ("stool", "chair", "none")  # what is under who sits on something
LIGHTS: Mapping[str, Light | None] = {
    STUDIO: None,
    "day": Light(
        "Day",
        toward=(-0.30, 0.90, 0.42),
        key=(1.62, 1.52, 1.34),
        above=(0.44, 0.54, 0.70),
        below=(0.26, 0.24, 0.20),
        rim=(0.20, 0.24, 0.30),
        dark=1.0,
    ),
    "evening": Light(
        "Evening, from the side",
        toward=(-0.86, 0.42, 0.30),
        key=(1.62, 1.02, 0.62),
        above=(0.22, 0.25, 0.38),
        below=(0.14, 0.11, 0.10),
        rim=(0.95, 0.66, 0.46),
        dark=0.9,
    ),
    "rim": Light(
        "Rim light, from behind",
        toward=(0.55, 0.75, -0.62),
        key=(1.20, 1.22, 1.28),
        above=(0.42, 0.45, 0.52),
        below=(0.22, 0.22, 0.23),
        rim=(1.30, 1.34, 1.42),
        dark=1.0,
    ),
    "flat": Light(
        "Flat",
        toward=(-0.10, 0.95, 0.35),
        key=(0.30, 0.30, 0.30),
        above=(0.92, 0.92, 0.92),
        below=(0.80, 0.80, 0.80),
        rim=(0.0, 0.0, 0.0),
        dark=0.35,
    ),
}
BACKDROPS: Mapping[str, BackdropLook | None] = {
    STAGE: None,
    "sky": BackdropLook(
        "Sky", (0.48, 0.62, 0.78), (0.80, 0.87, 0.92), (0.66, 0.68, 0.68), line=(0.50, 0.52, 0.53)
    ),
    "dusk": BackdropLook(
        "Dusk", (0.15, 0.13, 0.22), (0.47, 0.30, 0.30), (0.20, 0.17, 0.20), line=(0.44, 0.36, 0.38)
    ),
    "warm": BackdropLook(
        "Warm paper", (0.80, 0.76, 0.70), (0.93, 0.90, 0.85), (0.86, 0.83, 0.78), line=(0.66, 0.62, 0.57)
    ),
    "neutral": _plain("Neutral grey, for recording", (0.46, 0.46, 0.46)),
    "white": _plain("White", (1.0, 1.0, 1.0)),
    "black": _plain("Black", (0.0, 0.0, 0.0)),
    "green": _plain("Green, for keying", (0.0, 0.69, 0.25), False),
}
# What a project has behind its character: a studio whose floor turns into the wall, and a room. In metres
# from the ground between the character's feet; they are larger where props stand farther away.
PLACES: Mapping[str, Walls] = {
    "studio": Walls((-4.2, 0.0, -3.2), (4.2, 6.0, 5.2), 1.4, (0.74, 0.74, 0.75), (0.70, 0.705, 0.72)),
    "room": Walls((-2.7, 0.0, -2.1), (2.7, 2.7, 3.6), 0.0, (0.60, 0.45, 0.32), (0.83, 0.80, 0.75), True),
}
MARGIN = 0.7  # metres between the middle of a prop and a wall
NAMES_OF_KEPT = {STUDIO: "Studio", STAGE: "Stage, as in the window"}


def look_name(name: str) -> str:
    """Return the name of a light or a background to show."""
    found = LIGHTS.get(name) or BACKDROPS.get(name)
    return found.words if found is not None else NAMES_OF_KEPT[name]


def look_of(theme: str, light: str = STUDIO, backdrop: str = STAGE) -> SceneTheme:
    """Return a theme in a light before a background. Unknown names change nothing."""
    out, lamp, back = THEMES[theme], LIGHTS.get(light), BACKDROPS.get(backdrop)
    if lamp is not None:
        shadow = tuple(1.0 - lamp.dark * (1.0 - x) for x in out.shadow)
        out = replace(
            out,
            toward=lamp.toward,
            key=lamp.key,
            above=lamp.above,
            below=lamp.below,
            rim=lamp.rim,
            shadow=(shadow[0], shadow[1], shadow[2]),
        )
    if back is not None:
        strength = out.line_strength if back.line is not None else 0.0
        bright = sum(back.floor) > 1.5
        out = replace(
            out,
            top=back.top,
            bottom=back.bottom,
            floor=back.floor,
            line=back.line or back.floor,
            line_strength=strength,
            shadow=out.shadow if back.shadow else (1.0, 1.0, 1.0),
            ink=THEMES["light" if bright else "dark"].ink,
        )
    return out


def set_place(look: SceneTheme, name: str, round_: Sequence[Sequence[float]] = ()) -> SceneTheme:
    """Return a look in one of PLACES, large enough for what stands at some points, metres."""
    walls = PLACES[name]
    low, high = list(walls.low), list(walls.high)
    for at in round_:
        for axis in (0, 2):
            low[axis] = min(low[axis], at[axis] - MARGIN - walls.bend)
            high[axis] = max(high[axis], at[axis] + MARGIN + walls.bend)
    walls = replace(walls, low=(low[0], low[1], low[2]), high=(high[0], high[1], high[2]))
    return replace(_on_plain_ground(look, walls.wall), walls=walls, floor=walls.floor)


def set_plain_color(look: SceneTheme, color: Color) -> SceneTheme:
    """Return a look before one colour, sRGB."""
    return _on_plain_ground(look, color)


def set_back_picture(look: SceneTheme, picture: BackPicture) -> SceneTheme:
    """Return a look before a picture."""
    mean = picture.pixels.reshape(-1, 3).mean(0) / 255
    return replace(_on_plain_ground(look, (float(mean[0]), float(mean[1]), float(mean[2]))), picture=picture)


def _on_plain_ground(look: SceneTheme, color: Color) -> SceneTheme:
    bright = sum(color) > 1.5
    return replace(
        look,
        top=color,
        bottom=color,
        floor=color,
        line=color,
        line_strength=0.0,
        walls=None,
        picture=None,
        ink=THEMES["light" if bright else "dark"].ink,
    )
