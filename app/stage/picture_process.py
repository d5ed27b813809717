"""Draw thumbnails in a process of its own, because compiling shaders and reading pixels back would block the
window's thread.
"""

from __future__ import annotations

import contextlib
import math
import pickle
import queue
import sys
import threading
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from metagraph.motion.clip import Clip
from metagraph.motion.fitting.footing import Footing

SIZE, SCALE = 112, 2
MOVING_SIZE, MOVING_RATE, MOVING_MOST = (
    180,
    12,
    72,
)  # the loop in the stance card: pixels, pictures a second, largest number
STRIP_RATE, STRIP_MOST = 6, 36  # a filmstrip's pictures a second, largest number
SCRUB = 12  # pictures that the pointer passes through over a card
WORTH_LEVELS = 24  # number of a figure's pictures from which on meshes with fewer triangles are worth making
LARGE = 448  # pixels of a picture on a large card
LONG = ("moving", "strip", "scrub")  # orders of many pictures
FRAMED = ("card", "bare", "large", "scrub")  # framed as closely as the moving parts of the clip allow


@dataclass(frozen=True)
class PictureOrder:
    """An order for pictures of a clip.

    `what` is "card", "bare", "large", "scrub", "moving" or "strip". `paper` is the colour behind the figure,
    sRGB 0..1, None for transparent. `character` is its file, `hidden` its meshes that are not drawn.
    Where there is no mesh, `footing` says how the skeleton stands, and `sticks` draws a stick figure.
    """

    number: int
    clip: Clip
    what: str
    theme: str
    paper: tuple[float, float, float] | None
    character: Path | None
    hidden: tuple[str, ...] = ()
    footing: Footing | None = None
    sticks: bool = False


_Drawn = tuple[str, "Path | None", tuple[str, ...], bool]  # skeleton, character, what is hidden, sticks
_Waiting = queue.PriorityQueue[tuple[bool, float, PictureOrder | None]]


def draw_clip_pictures(offscreen: Any, figure: Any, order: PictureOrder) -> list[np.ndarray]:
    """Return a clip's pictures `[H, W, 4]`: one typical pose, or its whole loop."""
    from preview.scene import THEMES
    from preview.thumbnail import ThumbnailStyle, find_telling_frame, render_thumbnail, render_thumbnails

    motion = order.clip
    if order.what in FRAMED:
        frames = np.array([find_telling_frame(motion)])
        if order.what == "scrub":
            count = max(2, min(SCRUB, motion.frames))
            frames = np.linspace(0, motion.frames - 1, count).round().astype(int)
        pixels = LARGE if order.what == "large" else SIZE * SCALE
        return render_thumbnails(offscreen, figure, motion, frames, pixels, THEMES[order.theme], order.paper)
    if order.what == "moving":
        count = max(1, min(MOVING_MOST, round(motion.duration * MOVING_RATE)))
        frames = np.linspace(0, motion.frames - 1, count, endpoint=False).round().astype(int)
    else:
        count = max(2, min(STRIP_MOST, round(motion.duration * STRIP_RATE) + 1))
        frames = np.linspace(0, motion.frames - 1, count).round().astype(int)
    size = MOVING_SIZE if order.what == "moving" else SIZE
    rotations, positions = motion.skeleton.globals(motion.poses()[frames])
    style = ThumbnailStyle(size, SCALE, paper=order.paper, theme=THEMES[order.theme])
    return [
        render_thumbnail(offscreen, figure, r, p, style) for r, p in zip(rotations, positions, strict=True)
    ]


def serve_pictures(orders: BinaryIO, results: BinaryIO) -> None:
    """Answer pickled orders with pickled (number, None) when one is begun and (number, pictures) when it is
    drawn, until the other side has ended: stills before loops, the latest first.
    """
    from preview.offscreen import Offscreen, OpenGLError

    waiting: _Waiting = queue.PriorityQueue()
    threading.Thread(target=_read, args=(orders, waiting), daemon=True).start()
    try:
        offscreen = Offscreen(SIZE * SCALE, SIZE * SCALE)
    except OpenGLError:
        return
    figures: dict[_Drawn, Any] = {}
    drawn: Counter[_Drawn] = Counter()
    with offscreen:
        while (order := waiting.get()[2]) is not None:
            pickle.dump(
                (order.number, None), results
            )  # begun: the other side knows which one it was if this process ends
            results.flush()
            key = (order.clip.skeleton.fingerprint, order.character, order.hidden, order.sticks)
            if key not in figures:
                figures[key] = _figure(order)
            drawn[key] += 1
            if drawn[key] == WORTH_LEVELS:
                figures[key].simplify()
            pickle.dump((order.number, draw_clip_pictures(offscreen, figures[key], order)), results)
            results.flush()


def _read(orders: BinaryIO, waiting: _Waiting) -> None:
    try:
        while True:
            order = pickle.load(orders)
            waiting.put((order.what in LONG, -order.number, order))
    except (EOFError, OSError, pickle.UnpicklingError):
        waiting.put((False, -math.inf, None))


def _figure(order: PictureOrder) -> Any:
    from metagraph.errors import FileError
    from preview.character_file import load_mesh_figure

    skeleton = order.clip.skeleton
    try:
        return load_mesh_figure(order.character, skeleton, order.hidden, order.footing, order.sticks)
    except FileError:  # the preview reports it
        return load_mesh_figure(None, skeleton, (), order.footing, order.sticks)


if __name__ == "__main__":
    from app.faults import install_in_child
    from app.memory import free_memory_early
    from app.stage import picture_process  # orders name their class by its module

    free_memory_early()
    install_in_child()
    # The other process may end in the middle of a picture.
    with contextlib.suppress(BrokenPipeError), sys.stdout.buffer as out:
        picture_process.serve_pictures(sys.stdin.buffer, out)
