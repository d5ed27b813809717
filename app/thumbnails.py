"""Pictures of clips, drawn by the preview's renderer on a thread of its own, as they are asked for."""

from __future__ import annotations

import queue
import threading
from typing import Any

import numpy as np
from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QImage

from app.document import Document
from app.figures import Figures
from app.panels.view import to_image
from app.session import Session
from app.theme import theme
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from preview.figure import Figure
from preview.scene import THEMES

SIZE, SCALE = 112, 2
MOVING_SIZE, MOVING_RATE, MOVING_MOST = 180, 12, 96  # the loop in the stance card: pixels, pictures a second, at most

Key = tuple[str, str, str]  # clip id, what, theme


class Thumbnails(QObject):
    """ready: clip id; a picture that was asked for is there. Without OpenGL no picture ever comes, and none is missed."""

    ready = Signal(str)
    _drawn = Signal(int, object, object, object)

    def __init__(self, document: Document, session: Session, figures: Figures, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.session, self.figures = document, session, figures
        self._pictures: dict[Key, tuple[Clip, list[QImage]]] = {}
        self._asked: dict[Key, Clip] = {}
        self._queue: queue.LifoQueue[Any] = queue.LifoQueue()  # what was asked for last is in sight now
        self._thread: threading.Thread | None = None
        self._generation = 0
        self._drawn.connect(self._keep, Qt.ConnectionType.QueuedConnection)
        document.changed.connect(self._follow)
        figures.changed.connect(self.forget)

    def picture(self, clip: str, bare: bool = False) -> QImage | None:
        """Return a clip's picture; None until it is drawn. bare: transparent behind the figure."""
        found = self._get(clip, "bare" if bare else "card")
        return found[0] if found else None

    def moving(self, clip: str, beat: int) -> QImage | None:
        """Return one picture of a clip's loop, the `beat`-th of 12 a second; a still until the loop is drawn."""
        found = self._get(clip, "moving")
        return found[beat % len(found)] if found else self.picture(clip, bare=True)

    def _get(self, clip: str, what: str) -> list[QImage] | None:
        entry = self.document.project.clips.get(clip)
        motion = entry.motion if entry is not None else None
        if motion is None:
            return None
        key = (clip, what, self.session.theme)
        found = self._pictures.get(key)
        if found is not None and found[0] is motion:
            return found[1]
        if self._asked.get(key) is not motion:
            self._asked[key] = motion
            self._start()
            self._queue.put((self._generation, key, motion, self.figures.figure(motion.skeleton)))
        return found[1] if found is not None else None

    def forget(self) -> None:
        """Draw everything anew: the figure has changed."""
        self._generation += 1
        self._pictures.clear()
        self._asked.clear()
        self.ready.emit("")

    def _follow(self, before: Project, after: Project) -> None:
        if before.skeleton is not after.skeleton and before.skeleton != after.skeleton:
            self.forget()

    def _keep(self, generation: int, key: Key, motion: Clip, pictures: list[QImage]) -> None:
        if generation != self._generation:
            return  # drawn with the figure before
        self._pictures[key] = (motion, pictures)
        self.ready.emit(key[0])

    # --- the thread

    def _start(self) -> None:
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name="thumbnails", daemon=True)
            self._thread.start()

    def stop(self) -> None:
        """End the thread; at closing."""
        if self._thread is not None:
            self._generation += 1
            self._queue.put(None)
            self._thread.join(3)
            self._thread = None

    def _work(self) -> None:
        from preview.offscreen import Offscreen, OpenGLError

        try:
            offscreen = Offscreen(SIZE * SCALE, SIZE * SCALE)
        except OpenGLError:
            return
        with offscreen:
            while (item := self._queue.get()) is not None:
                generation, key, motion, figure = item
                if generation == self._generation:
                    pictures = draw(offscreen, figure, motion, key[1], key[2])
                    self._send(generation, key, motion, pictures)

    def _send(self, *values: Any) -> None:
        try:
            self._drawn.emit(*values)
        except RuntimeError:
            self._queue.put(None)  # the window is gone


def draw(offscreen: Any, figure: Figure, motion: Clip, what: str, look: str) -> list[QImage]:
    """Return a clip's pictures: one telling pose, or its whole loop when `what` is "moving"."""
    from preview.thumbnail import telling_frame, thumbnail

    card = theme(look).field
    paper = None if what != "card" else tuple(int(card[i : i + 2], 16) / 255 for i in (1, 3, 5))
    options: dict[str, Any] = {"paper": paper, "theme": THEMES[look]}
    poses = motion.poses()
    if what == "moving":
        count = max(1, min(MOVING_MOST, round(motion.duration * MOVING_RATE)))
        frames = np.linspace(0, motion.frames - 1, count, endpoint=False).round().astype(int)
        options["size"] = MOVING_SIZE
    else:
        frames = np.array([telling_frame(motion)])
        options["size"] = SIZE
    rotations, positions = motion.skeleton.globals(poses[frames])
    return [to_image(thumbnail(offscreen, figure, r, p, scale=SCALE, **options)) for r, p in zip(rotations, positions, strict=True)]
