"""Define the camera: a frozen value that pure functions turn, move and zoom, with its matrices.

Angles are radians, lengths metres. `yaw` 0 looks at the character's face (the eye is on +Z), positive yaw
shows its left side; `pitch` is the height of the eye above the target, as an angle. Matrices are row-major
(`M @ column`), float64.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]

PITCH_LIMIT = math.radians(89.0)
NEAREST, FARTHEST = 0.05, 500.0  # of `distance`
FLAT = math.radians(1.0)  # field of view; near and far have the same size to half a percent


@dataclass(frozen=True)
class Camera:
    """An eye that orbits a target. The default shows a person of 1.7 m from three quarters in front.

    `fov` is the vertical field of view. A long lens (28 degrees) keeps faces and hands from looking swollen.
    """

    target: tuple[float, float, float] = (0.0, 0.9, 0.0)
    yaw: float = math.radians(28.0)
    pitch: float = math.radians(7.0)
    distance: float = 4.2
    fov: float = math.radians(28.0)

    @cached_property
    def axes(self) -> Array:
        """The camera's right, up and backward directions as rows `[3, 3]`. Read-only."""
        sy, cy, sp, cp = math.sin(self.yaw), math.cos(self.yaw), math.sin(self.pitch), math.cos(self.pitch)
        out = np.array([[cy, 0, -sy], [-sy * sp, cp, -cy * sp], [sy * cp, sp, cy * cp]])
        out.flags.writeable = False
        return out

    @cached_property
    def eye(self) -> Array:
        """The position of the camera, `[3]`. Read-only."""
        out = np.asarray(self.target + self.axes[2] * self.distance)
        out.flags.writeable = False
        return out

    @property
    def near(self) -> float:
        return max(0.01, self.distance * 0.05)

    @property
    def far(self) -> float:
        return max(60.0, self.distance * 12.0)

    def view(self) -> Array:
        """Return the matrix from world to camera, `[4, 4]`."""
        out = np.eye(4)
        out[:3, :3] = self.axes
        out[:3, 3] = -self.axes @ self.eye
        return out

    def projection(self, aspect: float) -> Array:
        """Return the matrix from camera to clip space, `[4, 4]`. `aspect` is width divided by height."""
        f = 1 / math.tan(self.fov / 2)
        near, far = self.near, self.far
        out = np.zeros((4, 4))
        out[0, 0], out[1, 1] = f / max(aspect, 1e-6), f
        out[2, 2], out[2, 3], out[3, 2] = (far + near) / (near - far), 2 * far * near / (near - far), -1
        return out

    def matrix(self, aspect: float) -> Array:
        """Return the matrix from world to clip space, `[4, 4]`, read-only. `aspect` is width divided by
        height.
        """
        return _matrix(self, aspect)

    def ray(self, x: float, y: float, aspect: float) -> tuple[Array, Array]:
        """Return the origin `[3]` and the unit direction `[3]` of the ray through the point `x, y` of the
        picture: 0..1 from its upper left.
        """
        half = math.tan(self.fov / 2)
        right, up, back = self.axes
        direction = right * ((2 * x - 1) * half * aspect) + up * ((1 - 2 * y) * half) - back
        return self.eye, direction / np.linalg.norm(direction)

    def project(self, points: ArrayLike, aspect: float) -> Array:
        """Return where `points [..., 3]` are in the picture, `[..., 2]`: 0..1 from its upper left, NaN for
        points behind the eye.
        """
        points = np.asarray(points, float)
        p = np.einsum("ij,nj->ni", self.axes, points.reshape(-1, 3) - self.eye)
        depth = np.where(p[:, 2] < -1e-9, -p[:, 2], np.nan)
        twice = 2 * math.tan(self.fov / 2)
        out = p[:, :2] / (depth[:, None] * (twice * aspect, -twice)) + 0.5
        return np.asarray(out.reshape(*points.shape[:-1], 2))

    def orbit(self, dx: float, dy: float) -> Camera:
        """Turn round the target by a drag of `dx, dy` picture heights to the right and down. One height is
        half a turn.
        """
        yaw = math.remainder(self.yaw - dx * math.pi, 2 * math.pi)
        return replace(self, yaw=yaw, pitch=min(PITCH_LIMIT, max(-PITCH_LIMIT, self.pitch + dy * math.pi)))

    def pan(self, dx: float, dy: float) -> Camera:
        """Move sideways so that things at the target's depth follow a drag of `dx, dy` picture heights."""
        right, up, _ = self.axes
        size = 2 * math.tan(self.fov / 2) * self.distance
        x, y, z = np.asarray(self.target) + (up * dy - right * dx) * size
        return replace(self, target=(float(x), float(y), float(z)))

    def zoom(self, steps: float) -> Camera:
        """Go nearer by `steps` notches of a mouse wheel, 12 % each. Negative steps go farther away."""
        return replace(self, distance=min(FARTHEST, max(NEAREST, self.distance * 1.12**-steps)))

    def frame(self, bounds: tuple[ArrayLike, ArrayLike], aspect: float, margin: float = 1.08) -> Camera:
        """Keep the direction, aim at the box `bounds` (lowest and highest corner) and step back until it just
        fits.
        """
        low, high = np.asarray(bounds[0], float), np.asarray(bounds[1], float)
        if not (np.isfinite(low).all() and np.isfinite(high).all()):
            return self
        centre, half = (low + high) / 2, np.maximum((high - low) / 2, 1e-3)
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        corners = signs * half @ self.axes.T
        tan_y = math.tan(self.fov / 2) / margin
        tan_x = tan_y * aspect
        distance = np.max(
            corners[:, 2] + np.maximum(np.abs(corners[:, 0]) / tan_x, np.abs(corners[:, 1]) / tan_y)
        )
        return replace(
            self,
            target=(float(centre[0]), float(centre[1]), float(centre[2])),
            distance=max(NEAREST, float(distance)),
        )

    @property
    def flat(self) -> bool:
        """Whether the camera is almost orthographic."""
        return self.fov <= FLAT

    def flattened(self) -> Camera:
        """Return an almost orthographic camera that shows things at the target in the same size."""
        return self._through(FLAT)

    def deepened(self) -> Camera:
        """Return a camera with the usual lens that shows things at the target in the same size."""
        return self._through(Camera().fov) if self.flat else self

    def _through(self, fov: float) -> Camera:
        distance = self.distance * math.tan(self.fov / 2) / math.tan(fov / 2)
        return replace(self, fov=fov, distance=min(FARTHEST, max(NEAREST, distance)))

    def facing(self, yaw: float, pitch: float) -> Camera:
        """Look from another side: `yaw` and `pitch` in radians."""
        return replace(
            self, yaw=math.remainder(yaw, 2 * math.pi), pitch=min(PITCH_LIMIT, max(-PITCH_LIMIT, pitch))
        )


@lru_cache(maxsize=16)
def _matrix(camera: Camera, aspect: float) -> Array:
    out = np.asarray(camera.projection(aspect) @ camera.view())
    out.flags.writeable = False
    return out


def make_whole_figure_camera(
    bounds: tuple[ArrayLike, ArrayLike], aspect: float, heading: float = 0.0
) -> Camera:
    """Return a camera three quarters in front with the whole box in the picture. `heading` is where the
    character faces, radians about +Y.
    """
    camera = Camera()
    return camera.facing(camera.yaw + heading, camera.pitch).frame(bounds, aspect)


def close_up(head: ArrayLike, height: float, aspect: float, heading: float = 0.0) -> Camera:
    """Return a camera for head and shoulders. `head` is the middle of the head `[3]`, `height` the height of
    the figure in metres.
    """
    x, y, z = np.asarray(head, float)
    h = 0.115 * height
    camera = Camera(fov=math.radians(22.0)).facing(math.radians(18.0) + heading, math.radians(3.0))
    return camera.frame(((x - h, y - 1.35 * h, z - h * 0.3), (x + h, y + h, z + h * 0.3)), aspect)


def make_upper_body_camera(head: ArrayLike, height: float, aspect: float, heading: float = 0.0) -> Camera:
    """Return a camera for the figure from the hips up, with room for gesturing arms. `head` is the middle of
    the head `[3]`, `height` the height of the figure in metres.
    """
    x, y, z = np.asarray(head, float)
    camera = Camera().facing(math.radians(20.0) + heading, math.radians(5.0))
    return camera.frame(
        (
            (x - 0.24 * height, y - 0.5 * height, z - 0.08 * height),
            (x + 0.24 * height, y + 0.1 * height, z + 0.08 * height),
        ),
        aspect,
    )
