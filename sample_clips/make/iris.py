"""The image of an eyeball, painted by numbers: white, limbal ring, iris with its fibres, pupil."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sample_clips.make.face_pieces import EYE_SEEN, IRIS, PUPIL
from sample_clips.make.looks import Color
from sample_clips.make.shapes import step

Array = NDArray[Any]

SIZE = 256  # pixels


def eye_image(iris: Color) -> bytes:
    """Return the image as PNG: the eye from in front, as far from its middle as it is far round the ball."""
    from PIL import Image

    at = (np.arange(SIZE) + 0.5) / SIZE * 2 - 1
    x, y = np.meshgrid(at, -at)
    degrees, way = np.hypot(x, y) * EYE_SEEN, np.arctan2(y, x)
    white = np.array([238.0, 233.0, 228.0]) * np.ones((SIZE, SIZE, 1))
    pink = step(38.0, 74.0, degrees)[..., None]
    white = white * (1 - pink) + np.array([206.0, 150.0, 140.0]) * pink
    # Lids and lashes shade the ball from above, and a little from below.
    shade = 1 - 0.42 * step(8.0, 30.0, y * EYE_SEEN) - 0.16 * step(14.0, 34.0, -y * EYE_SEEN)
    fibre = sum(np.sin(n * way + p) * a for n, p, a in ((23, 0.3, 0.5), (37, 1.9, 0.35), (61, 4.1, 0.25)))
    share = np.clip((degrees - PUPIL) / (IRIS - PUPIL), 0, 1)
    glow = (
        0.80
        + 0.75 * step(0.5, -0.9, np.sin(way)) * (1 - share) ** 0.5
        + 0.30 * np.exp(-(((share - 0.22) / 0.16) ** 2))
    )
    glow = glow * (1 + 0.16 * fibre * (1 - np.abs(2 * share - 1) ** 2)) * (1 - 0.62 * step(0.66, 1.0, share))
    color = np.clip(np.array(iris) * glow[..., None] * 1.25, 0, 255)
    out = white + (color - white) * step(IRIS + 1.1, IRIS - 0.9, degrees)[..., None]
    ring = np.exp(-(((degrees - IRIS + 0.8) / 1.8) ** 2))[..., None]
    out = out * (1 - 0.55 * ring)
    out = out + (np.array([12.0, 9.0, 9.0]) - out) * step(PUPIL + 0.9, PUPIL - 0.9, degrees)[..., None]
    out = out * shade[..., None]
    file = io.BytesIO()
    Image.fromarray(np.clip(out, 0, 255).round().astype(np.uint8)).save(file, "PNG", optimize=True)
    return file.getvalue()
