"""Define what the renderer gets for each frame: who is where, and in which light."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preview.figure import MeshFigure

Array = NDArray[Any]
Color = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class LampTurn:
    """How the lamp of a theme is turned: by `angle` radians about +Y, after it changed sides if
    `mirrored`.
    """

    angle: float
    mirrored: bool = False


@dataclass(frozen=True, eq=False)
class Actor:
    """A figure in one pose, or in many at once (a crowd is one draw call).

    `rotations` `[..., J, 4]` (xyzw) and `positions` `[..., J, 3]` are global, on the figure's skeleton.
    `morphs` are weights `[K]`. `marks` are sRGB colours 0..1 for joints to point out, for example those of a
    mask. `bones` draws the skeleton over the mesh. `opacity` below 1 makes a ghost, which has no shadow.
    """

    figure: MeshFigure
    rotations: Array
    positions: Array
    morphs: Array | None = None
    marks: Mapping[int, Color] = field(default_factory=dict)
    bones: bool = False
    opacity: float = 1.0

    @property
    def count(self) -> int:
        """The number of instances."""
        return math.prod(self.rotations.shape[:-2])


@dataclass(frozen=True, eq=False)
class Scene:
    """All actors of a picture and what is behind them.

    `lamp` is what the theme's lamp is turned by, if the light follows the camera. `background` is one flat
    sRGB colour with alpha, premultiplied, instead of the theme's background; there is no ground then.
    `picture` is uint8 `[H, W, 3]`, sRGB, first row at the top, which is shown whole behind the actors, also
    without ground. `focus` is how far before the camera it is sharp, metres; None for everywhere.
    """

    actors: tuple[Actor, ...] = ()
    ground: bool = True
    shadow: bool = True
    background: tuple[float, float, float, float] | None = None
    picture: Array | None = None
    lamp: LampTurn | None = None
    focus: float | None = None

    def same(self, other: Scene) -> bool:
        """Return whether both scenes give exactly the same picture."""
        return (
            (self.ground, self.shadow, self.background, self.lamp, self.focus)
            == (other.ground, other.shadow, other.background, other.lamp, other.focus)
            and self.picture is other.picture
            and len(self.actors) == len(other.actors)
            and all(_same(a, b) for a, b in zip(self.actors, other.actors, strict=True))
        )

    def bounds(self) -> tuple[Array, Array]:
        """Return the lowest and the highest corner of a box round all actors; the size of a person if there
        are none.
        """
        return _round([a.figure.bounds(a.positions) for a in self.actors if a.count])

    def drawn_bounds(self) -> tuple[Array, Array]:
        """Return the same box closer to what is drawn, as the meshes are posed: what a camera is aimed at."""
        return _round([a.figure.posed_bounds(a.rotations, a.positions) for a in self.actors if a.count])


def _round(boxes: Sequence[tuple[Array, Array]]) -> tuple[Array, Array]:
    """Return a box round boxes; the size of a person if there are none."""
    if not boxes:
        return np.array([-0.5, 0.0, -0.5]), np.array([0.5, 1.8, 0.5])
    return np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)


def _same(a: Actor, b: Actor) -> bool:
    return a is b or (
        a.figure is b.figure
        and (a.bones, a.opacity, a.marks) == (b.bones, b.opacity, b.marks)
        and np.array_equal(a.rotations, b.rotations)
        and np.array_equal(a.positions, b.positions)
        and (a.morphs is b.morphs or (a.morphs is not None and np.array_equal(a.morphs, b.morphs)))  # type: ignore[arg-type]
    )


@dataclass(frozen=True)
class Walls:
    """A studio or a room round the character, seen from inside: walls between the eye and it are not drawn.

    `low` and `high` are its corners in metres. `bend` is the radius with which the floor turns into the
    walls. Colours are sRGB. `furnished` adds boards on the floor, a skirting board, a window and a ceiling.
    """

    low: Color
    high: Color
    bend: float
    floor: Color
    wall: Color
    furnished: bool = False


@dataclass(frozen=True, eq=False)
class BackPicture:
    """A picture that fills what is behind the character: uint8 `[H, W, 3]`, sRGB, first row at the top."""

    pixels: Array


@dataclass(frozen=True)
class SceneTheme:
    """The colours of a theme: sky, floor and ink in sRGB 0..1, lights linear. All are neutral, because in the
    window colours stand for kinds.
    """

    name: str
    top: Color
    bottom: Color
    floor: Color
    line: Color
    line_strength: float
    shadow: Color  # the ground is multiplied by this in full shadow
    key: Color
    above: Color
    below: Color
    rim: Color
    ink: Color  # the skeleton drawn over a mesh
    toward: Color = (-0.42, 0.80, 0.62)  # direction to the lamp, of any length, above the ground
    walls: Walls | None = None  # instead of ground and sky
    picture: BackPicture | None = None  # instead of ground and sky; shadows fall on it
    transparent: bool = False  # nothing is behind the figures, not even a ground
    blurred: bool = False  # what is nearer or farther than the face of who is framed, in pictures and videos

    def turned(self, by: LampTurn) -> SceneTheme:
        """Return the theme with its lamp turned."""
        x, y, z = self.toward
        x = -x if by.mirrored else x
        sine, cosine = math.sin(by.angle), math.cos(by.angle)
        return replace(self, toward=(x * cosine + z * sine, y, z * cosine - x * sine))

    @cached_property
    def to_light(self) -> Array:
        """The direction to the lamp, a unit vector `[3]`. Read-only."""
        out = np.asarray(np.array(self.toward) / np.linalg.norm(self.toward))
        out.flags.writeable = False
        return out

    @cached_property
    def lamp(self) -> Array:
        """The lamp's right, up and forward directions as rows `[3, 3]`. Read-only."""
        side = np.cross([0.0, 1, 0], self.to_light)
        side /= np.linalg.norm(side)
        out = np.stack([side, np.cross(self.to_light, side), -self.to_light])
        out.flags.writeable = False
        return out


DARK = SceneTheme(
    "dark",
    top=(0.150, 0.158, 0.176),
    bottom=(0.250, 0.262, 0.290),
    floor=(0.165, 0.173, 0.191),
    line=(0.42, 0.44, 0.48),
    line_strength=0.36,
    shadow=(0.42, 0.42, 0.45),
    key=(1.30, 1.26, 1.20),
    above=(0.40, 0.43, 0.48),
    below=(0.19, 0.175, 0.165),
    rim=(0.42, 0.46, 0.55),
    ink=(0.96, 0.97, 0.98),
)
LIGHT = SceneTheme(
    "light",
    top=(0.855, 0.865, 0.880),
    bottom=(0.965, 0.968, 0.975),
    floor=(0.890, 0.897, 0.910),
    line=(0.62, 0.64, 0.67),
    line_strength=0.42,
    shadow=(0.66, 0.67, 0.70),
    key=(1.22, 1.19, 1.15),
    above=(0.52, 0.54, 0.58),
    below=(0.34, 0.33, 0.32),
    rim=(0.16, 0.17, 0.19),
    ink=(0.08, 0.09, 0.10),
)
THEMES = {theme.name: theme for theme in (DARK, LIGHT)}
