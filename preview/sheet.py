"""Make contact sheets (many pictures in rows with text under them) and write PNG files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.formats.outputs import claim_output
from preview.typeface import find_typeface_file

Array = NDArray[Any]
Color = tuple[int, int, int]

PAPER: Color = (28, 29, 33)
INK: Color = (232, 234, 237)


def make_contact_sheet(
    images: Sequence[Array],
    columns: int,
    labels: Sequence[str] = (),
    title: str = "",
    notes: Sequence[str] = (),
    gap: int = 12,
    paper: Color | None = PAPER,
    ink: Color = INK,
) -> Array:
    """Return one picture `[H, W, 3]` uint8 of `images` (uint8 `[h, w, 3 or 4]`, any sizes) in `columns`.
    Without `paper` it is `[H, W, 4]`, transparent between and behind the images, whose alpha is not
    premultiplied.

    `labels` holds a line under each image, `notes` a second, fainter line. Text that is too long for its
    image ends in an ellipsis.
    """
    from PIL import Image, ImageDraw

    columns = max(1, min(columns, len(images) or 1))
    rows = -(-len(images) // columns)
    width = max([im.shape[1] for im in images], default=160)
    height = max([im.shape[0] for im in images], default=0)
    text = max(12, min(18, width // 14))
    lines = (1 if any(labels) else 0) + (1 if any(notes) else 0)
    cell = height + round(lines * text * 1.45) + (6 if lines else 0)
    head = round(text * 2.6) if title else 0
    whole = (columns * (width + gap) + gap, head + rows * (cell + gap) + gap)
    page = Image.new("RGB", whole, paper) if paper is not None else Image.new("RGBA", whole, (*ink, 0))
    draw = ImageDraw.Draw(page)
    font, large = _font(text), _font(round(text * 1.3))
    if title:
        draw.text((gap, gap), _fit(draw, title, large, page.width - 2 * gap), ink, large)
    faint = tuple((2 * a + b) // 3 for a, b in zip(ink, paper or ink, strict=True))
    for i, image in enumerate(images):
        x, y = gap + (i % columns) * (width + gap), head + gap + (i // columns) * (cell + gap)
        picture = Image.fromarray(np.ascontiguousarray(image))
        page.paste(
            picture,
            (x + (width - picture.width) // 2, y + (height - picture.height) // 2),
            picture if picture.mode == "RGBA" and paper is not None else None,
        )
        for line, (words, color) in enumerate(((labels, ink), (notes, faint))):
            if i < len(words):
                at = (x, y + height + 6 + (round(line * text * 1.45) if any(labels) else 0))
                draw.text(at, _fit(draw, words[i], font, width), color, font)
    return np.asarray(page)


def make_straight_alpha(picture: Array) -> Array:
    """Return a picture `[H, W, 4]` uint8 whose colours are not multiplied by alpha, as files have it."""
    out = np.array(picture)
    part = (out[..., 3] > 0) & (out[..., 3] < 255)
    alpha = out[part, 3:].astype(np.uint16)
    out[part, :3] = np.minimum((out[part, :3].astype(np.uint16) * 255 + alpha // 2) // alpha, 255)
    return out


def write_png(path: str | Path, picture: Array) -> None:
    """Write a picture, uint8 `[H, W, 3 or 4]`. The file appears only when it is complete. Raises
    FileError.
    """
    from PIL import Image

    path = Path(path)
    part = path.with_name(f".{path.name}.part")
    try:
        Image.fromarray(np.ascontiguousarray(picture)).save(part, "PNG", compress_level=6)
        with claim_output(path):
            part.replace(path)
    except OSError as error:
        raise FileError(
            path, f"the picture could not be written ({error})", remedy="Check the folder and the free space."
        ) from error
    finally:
        part.unlink(missing_ok=True)


def _font(size: int) -> Any:
    """Return the window's typeface, so that text looks the same on every system."""
    from PIL import ImageFont

    return ImageFont.truetype(find_typeface_file("Regular"), size)


def _fit(draw: Any, words: str, font: Any, width: int) -> str:
    words = " ".join(words.split())
    if draw.textlength(words, font) <= width:
        return words
    while words and draw.textlength(words + "…", font) > width:
        words = words[:-1]
    return words.rstrip() + "…"
