"""Draw the pictures on the canvas, and animate the stance in the middle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from PySide6.QtCore import QTimer
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QWidget

from app.features.graph.graph_layout import Layout
from app.look.comfort import get_comfort
from app.stage.thumbnails import Thumbnails
from metagraph.graph.model import MetaGraph

RATE = 12  # pictures a second of the stance in the middle
SLOW = 0.015  # seconds of drawing for each of which a picture of it is left out


@dataclass(frozen=True)
class GraphPictures:
    """Pictures of the canvas. hero: of the stance in the middle. chips: by stance. rows: by clip. Pictures
    that are not drawn yet are missing.
    """

    hero: QImage | None = None
    chips: dict[str, QImage] = field(default_factory=dict)
    rows: dict[str, QImage] = field(default_factory=dict)


def find_graph_pictures(thumbnails: Thumbnails, layout: Layout, graph: MetaGraph, beat: int) -> GraphPictures:
    """Return the pictures that a layout has room for, and start drawing the missing ones."""
    loops = {ident: next(iter(graph.of(ident, "stance")), None) for ident in graph.stances}
    chips = {
        ident: thumbnails.picture(loop.clip, bare=True) for ident, loop in loops.items() if loop is not None
    }
    seen = (row for node in layout.nodes.values() for row in node.rows if not row.picture.isEmpty())
    rows = {clip: thumbnails.picture(clip, bare=True) for clip in {row.action.clip for row in seen}}
    hero = loops.get(layout.stance or "")
    return GraphPictures(
        thumbnails.moving(hero.clip, beat) if hero is not None else None,
        {ident: picture for ident, picture in chips.items() if picture is not None},
        {clip: picture for clip, picture in rows.items() if picture is not None},
    )


class Beat:
    """Calls a function repeatedly, less often while drawing is slow. count: number of calls."""

    def __init__(self, call: Callable[[], None], parent: QWidget) -> None:
        self.call, self.count = call, 0
        self._rest = 0  # beats to leave out
        self._timer = QTimer(parent, interval=1000 // RATE)
        self._timer.timeout.connect(self._next)

    def run(self, on: bool) -> None:
        """Start or pause."""
        if on != self._timer.isActive():
            self._timer.start() if on else self._timer.stop()

    def drawn(self, seconds: float) -> None:
        """Report how long a drawing took."""
        self._rest = min(RATE, int(seconds / SLOW))

    def stop(self) -> None:
        self._timer.stop()

    def _next(self) -> None:
        if self._rest > 0:  # jobs keep the processor busy: the stance moves more slowly, the window does not
            self._rest -= 1
            return
        if not get_comfort().still:
            self.count += 1
        self.call()
