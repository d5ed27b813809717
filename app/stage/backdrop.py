"""Show what a project has behind its character: a studio, a room, one colour or a picture."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from metagraph.common.budgets import PICTURE_PIXELS
from metagraph.common.network_paths import is_closed
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.graph.backdrop import Backdrop
from metagraph.graph.model import Project

if TYPE_CHECKING:
    from preview.scene import BackPicture, SceneTheme

SIDE = 2560  # pixels: larger pictures are reduced


def set_backdrop(look: SceneTheme, project: Project, folder: Path | None) -> SceneTheme:
    """Return a look with what is behind a project's character; the same if the project leaves that open.
    Raises FileError for a picture that cannot be read.
    """
    from preview.looks import set_back_picture, set_place, set_plain_color

    backdrop = project.backdrop
    if backdrop.kind == "color":
        red, green, blue = (value / 255 for value in backdrop.color)
        return set_plain_color(look, (red, green, blue))
    if backdrop.kind == "picture":
        return set_back_picture(look, read_back_picture((folder or Path()) / backdrop.path))
    if backdrop.kind:
        stands = [prop.at for prop in project.props.values() if not prop.joint]
        return set_place(look, backdrop.kind, stands)
    return look


def read_back_picture(path: Path) -> BackPicture:
    """Return a picture to show behind a character; it is read again when its file has changed. Raises
    FileError.
    """
    if is_closed(str(path)):
        raise FileError(path, phrase("the picture is on another computer"))
    try:
        return _read(path, path.stat().st_mtime_ns)
    except (OSError, ValueError, SyntaxError) as error:
        raise FileError(
            path,
            phrase("the picture could not be read ({error})", error=str(error)),
            remedy=phrase("Choose a PNG, JPEG or WebP file."),
        ) from error


@lru_cache(maxsize=2)
def _read(path: Path, changed: int) -> BackPicture:
    import numpy as np
    from PIL import Image, ImageOps

    from preview.scene import BackPicture

    with Image.open(path) as image:
        if image.width * image.height > PICTURE_PIXELS:
            raise ValueError(
                phrase("it has more than {most} million pixels", most=PICTURE_PIXELS // 1_000_000)
            )
        image.draft("RGB", (SIDE, SIDE))
        upright = ImageOps.exif_transpose(image).convert("RGB")
    upright.thumbnail((SIDE, SIDE))
    return BackPicture(np.asarray(upright))


def read_backdrop(text: str, folder: Path) -> Backdrop | None:
    """Return the backdrop that a text names: "studio", "room", "#rrggbb" or the path of a picture; None for
    another name. Raises FileError for a picture that cannot be read.
    """
    if text in ("studio", "room"):
        return Backdrop(kind="studio" if text == "studio" else "room")
    if len(text) == 7 and text[0] == "#" and all(c in "0123456789abcdefABCDEF" for c in text[1:]):
        return Backdrop(kind="color", color=tuple(bytes.fromhex(text[1:])))
    if Path(text).suffix:
        read_back_picture(folder / text)
        return Backdrop(kind="picture", path=text)
    return None
