"""Pictures of clips, ordered as they come into sight and drawn by another process."""

from __future__ import annotations

import contextlib
import pickle
import queue
import subprocess
import sys
import threading
from pathlib import Path

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QImage

from app.look.theme import theme
from app.project.document import Document
from app.stage.figures import Figures
from app.stage.gl_view import to_image
from app.stage.picture_process import Order
from app.stage.session import Session
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip

Key = tuple[str, str, str]  # clip id, what, theme


class Thumbnails(QObject):
    """ready: clip id; a picture that was asked for is there. Without OpenGL no picture ever comes, and none is missed."""

    ready = Signal(str)
    _drawn = Signal(int, object)

    def __init__(self, document: Document, session: Session, figures: Figures, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.session, self.figures = document, session, figures
        self._pictures: dict[Key, tuple[Clip, list[QImage]]] = {}
        self._asked: dict[Key, Clip] = {}
        self._orders: dict[int, tuple[Key, Clip]] = {}
        self._number = 0
        self._process: subprocess.Popen[bytes] | None = None
        self._queue: queue.SimpleQueue[Order | None] = queue.SimpleQueue()
        self._threads: list[threading.Thread] = []
        self._stopped = False
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
        key = (clip, what, self.session.look.name)
        found = self._pictures.get(key)
        if found is not None and found[0] is motion:
            return found[1]
        if self._asked.get(key) is not motion:
            self._asked[key] = motion
            self._order(key, motion)
        return found[1] if found is not None else None

    def forget(self) -> None:
        """Draw everything anew: the figure has changed."""
        self._pictures.clear()
        self._asked.clear()
        self._orders.clear()
        self.ready.emit("")

    def _follow(self, before: Project, after: Project) -> None:
        if before.skeleton is not after.skeleton and before.skeleton != after.skeleton:
            self.forget()

    def _keep(self, number: int, pictures: list[QImage]) -> None:
        key, motion = self._orders.pop(number, (None, None))
        if key is not None and motion is not None:  # else it was forgotten meanwhile
            self._pictures[key] = (motion, pictures)
            self.ready.emit(key[0])

    # --- the other process

    def _order(self, key: Key, motion: Clip) -> None:
        if self._stopped:
            return
        if self._process is None:
            self._start()
        project = self.document.project
        character = None
        if project.character is not None and motion.skeleton == project.skeleton:
            character = (self.document.folder or Path()) / project.character
        card = theme(self.session.look.name).field
        r, g, b = (int(card[i : i + 2], 16) / 255 for i in (1, 3, 5))
        self._number += 1
        self._orders[self._number] = (key, motion)
        self._queue.put(Order(self._number, motion, key[1], key[2], (r, g, b) if key[1] == "card" else None, character))

    def _start(self) -> None:
        """Start the process; what goes out and what comes in have a thread each, since a full pipe blocks."""
        root = Path(__file__).resolve().parents[2]
        self._process = subprocess.Popen(
            [sys.executable, "-m", "app.stage.picture_process"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, cwd=root,
        )  # fmt: skip
        for work in (self._send, self._listen):
            thread = threading.Thread(target=work, args=(self._process,), name="thumbnails", daemon=True)
            thread.start()
            self._threads.append(thread)

    def _send(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdin is not None
        with contextlib.suppress(OSError, ValueError), process.stdin as pipe:  # it ended; there are no pictures then
            while (order := self._queue.get()) is not None:
                pickle.dump(order, pipe)
                pipe.flush()

    def _listen(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdout is not None
        with contextlib.suppress(EOFError, OSError, RuntimeError, pickle.UnpicklingError), process.stdout as pipe:
            while True:
                number, pictures = pickle.load(pipe)
                self._drawn.emit(number, [to_image(p) for p in pictures])

    def stop(self) -> None:
        """End the process; at closing."""
        self._stopped = True
        if self._process is not None:
            self._queue.put(None)
            self._process.kill()
            self._process.wait(5)
            self._process = None
        for thread in self._threads:  # both end with the process; one that still made pictures would outlive Qt
            thread.join(5)
