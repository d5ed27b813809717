"""Order pictures of clips as they come into sight; another process draws them."""

from __future__ import annotations

import contextlib
import pickle
import queue
import subprocess
import threading
from collections import OrderedDict
from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QObject, Qt, QTimer, Signal
from PySide6.QtGui import QImage

from app.look.theme import get_theme
from app.project.document import Document
from app.stage.cropped import Cropped
from app.stage.figures import Figures
from app.stage.gl_view import to_image
from app.stage.kept_pictures import KeptPictures
from app.stage.picture_process import LONG, PictureOrder
from app.stage.picture_store import KEPT
from app.stage.session import StageSession
from metagraph.common.programs import make_python_command, start
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip

Key = tuple[str, str, str]  # clip id, what, theme
MOST = (
    128 * 1024 * 1024
)  # bytes of pictures that are kept; those unseen for longest are dropped, and drawn again when needed
REST = 20_000  # milliseconds without an order after which the process, and its memory, is released
WAITING = 120  # stills that wait, at most; those dropped are ordered again when they are seen
AHEAD = 4  # orders that the process has at a time
TRIES = 3  # how often the process is started without drawing anything before giving up


class Thumbnails(QObject):
    """Holds the pictures. `ready` has the id of a clip whose picture is ready. Without OpenGL there are never
    pictures, and that is no error.
    """

    ready = Signal(str)
    _drawn = Signal(int, object)
    _ended = Signal(object)  # with the process

    def __init__(
        self, document: Document, session: StageSession, figures: Figures, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.figures = document, session, figures
        self._pictures: OrderedDict[Key, tuple[Clip, Sequence[QImage]]] = OrderedDict()
        self.bytes = 0  # bytes of all pictures
        self._asked: dict[Key, Clip] = {}
        self._orders: dict[int, tuple[Key, Clip]] = {}
        self._line: dict[int, PictureOrder] = {}  # those of them that the process has not got yet
        self._given: set[int] = set()  # those that it has
        self._number = 0
        self.kept = KeptPictures(self)
        self._process: subprocess.Popen[bytes] | None = None
        self._queue: queue.SimpleQueue[PictureOrder | None] = queue.SimpleQueue()
        self._threads: list[threading.Thread] = []
        self._stopped = False
        self._begun: int | None = None  # the order that is being drawn
        self._fruitless = 0  # starts of the process that drew nothing
        self._rest = QTimer(self, singleShot=True, interval=REST)
        self._rest.timeout.connect(self._send_home)
        self._ended.connect(self._restart, Qt.ConnectionType.QueuedConnection)
        self._drawn.connect(self._keep, Qt.ConnectionType.QueuedConnection)
        self.kept.found.connect(self._keep, Qt.ConnectionType.QueuedConnection)
        self.kept.missing.connect(self._wait_in_line, Qt.ConnectionType.QueuedConnection)
        document.changed.connect(self._follow)
        figures.changed.connect(self.forget)

    @property
    def waiting(self) -> bool:
        """Return whether ordered pictures are missing."""
        return bool(self._orders)

    def picture(self, clip: str, bare: bool = False, large: bool = False) -> QImage | None:
        """Return a clip's picture; None until it is drawn. `bare` is transparent behind the figure. `large`
        is bare and twice as large, or a small one until it is drawn.
        """
        found = self._get(clip, "large" if large else "bare" if bare else "card")
        if large and not found:
            return self.picture(clip, bare=True)
        return found[0] if found else None

    def scrub(self, clip: str) -> Sequence[QImage]:
        """Return a few pictures from a clip's first frame to its last, framed as its still; empty until they
        are drawn.
        """
        return self._get(clip, "scrub") or []

    def moving(self, clip: str, beat: int) -> QImage | None:
        """Return one picture of a clip's loop, number `beat` at 12 a second; a still until the loop
        is drawn.
        """
        found = self._get(clip, "moving")
        return found[beat % len(found)] if found else self.picture(clip, bare=True)

    def strip(self, clip: str) -> Sequence[QImage]:
        """Return pictures of a clip's poses from its first frame to its last, evenly spaced, transparent
        behind the figure; empty until they are drawn.
        """
        return self._get(clip, "strip") or []

    def _get(self, clip: str, what: str) -> Sequence[QImage] | None:
        entry = self.document.project.clips.get(clip)
        motion = entry.motion if entry is not None else None
        if motion is None:
            return None
        key = (clip, what, self.session.look.name)
        found = self._pictures.get(key)
        if found is not None and found[0] is motion:
            self._pictures.move_to_end(key)
            return found[1]
        if self._asked.get(key) is not motion:
            self._asked[key] = motion
            self._order(key, motion)
        return found[1] if found is not None else None

    def forget(self) -> None:
        """Draw everything again, because the figure has changed."""
        self._pictures.clear()
        self.bytes = 0
        self._asked.clear()
        self._orders.clear()
        self._line.clear()
        self.ready.emit("")

    def _follow(self, before: Project, after: Project) -> None:
        if before.skeleton is not after.skeleton and before.skeleton != after.skeleton:
            self.forget()
        elif before.clips is not after.clips:
            for key in [k for k in self._pictures if k[0] not in after.clips]:
                self._let_go(key)

    def _keep(self, number: int, pictures: Sequence[QImage] | None) -> None:
        if pictures is None:
            self._begun = number
            return
        if number in self._given:
            self._begun, self._fruitless = None, 0
            self._given.discard(number)
            if isinstance(pictures, list):
                self.kept.keep(number, pictures)
            self._feed()
        key, motion = self._orders.pop(number, (None, None))
        if key is None or motion is None:  # it was dropped in the meantime
            return
        self._let_go(key)
        self._asked[key] = motion
        self._pictures[key] = (motion, pictures)
        self.bytes += _size(pictures)
        while self.bytes > MOST and len(self._pictures) > 1:
            self._let_go(next(iter(self._pictures)))
        self.ready.emit(key[0])

    def _let_go(self, key: Key) -> None:
        """Drop a picture; it is drawn again when it is needed."""
        found = self._pictures.pop(key, None)
        if found is not None:
            self.bytes -= _size(found[1])
            self._asked.pop(key, None)

    # --- the other process

    def _order(self, key: Key, motion: Clip) -> None:
        if self._stopped or self._fruitless >= TRIES:
            return
        project = self.document.project
        character = None
        if project.character is not None and motion.skeleton == project.skeleton:
            character = (self.document.folder or Path()) / project.character
        card = get_theme(self.session.look.name).field
        r, g, b = (int(card[i : i + 2], 16) / 255 for i in (1, 3, 5))
        self._number += 1
        self._orders[self._number] = (key, motion)
        paper = (r, g, b) if key[1] == "card" else None
        footing = self.figures.footing(motion.skeleton, project)
        order = PictureOrder(
            self._number,
            motion,
            key[1],
            key[2],
            paper,
            character,
            project.hidden,
            footing,
            self.figures.sticks,
        )
        if key[1] in KEPT:
            self.kept.ask(order)
        else:
            self._wait_in_line(order)

    def _wait_in_line(self, order: PictureOrder) -> None:
        """Queue an order until the process has time for it; of too many stills, the oldest are dropped."""
        if order.number not in self._orders:  # it was dropped in the meantime
            return
        self._line[order.number] = order
        self._feed()
        for number in list(self._line)[: max(0, len(self._line) - WAITING)]:
            del self._line[number]
            self.kept.forget(number)
            key, motion = self._orders.pop(number, (None, None))
            if key is not None and self._asked.get(key) is motion:
                del self._asked[key]

    def _feed(self) -> None:
        """Give the process the latest orders, stills before orders of many pictures."""
        while self._line and len(self._given) < AHEAD and not self._stopped:
            stills = (n for n in self._line if self._line[n].what not in LONG)
            number = max(stills, default=max(self._line))
            if self._process is None:
                self._start()
            self._rest.start()
            self._given.add(number)
            self._queue.put(self._line.pop(number))

    def _start(self) -> None:
        """Start the process. Output and input have a thread each, because a full pipe blocks."""
        self._process = start(
            make_python_command("app.stage.picture_process"),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        self._threads = [t for t in self._threads if t.is_alive()]
        for work, more in ((self._send, (self._queue,)), (self._listen, ())):
            thread = threading.Thread(
                target=work, args=(self._process, *more), name="thumbnails", daemon=True
            )
            thread.start()
            self._threads.append(thread)

    @staticmethod
    def _send(process: subprocess.Popen[bytes], orders: queue.SimpleQueue[PictureOrder | None]) -> None:
        assert process.stdin is not None
        with (
            contextlib.suppress(OSError, ValueError),
            process.stdin as pipe,
        ):  # it ended; there are no pictures then
            while (order := orders.get()) is not None:
                pickle.dump(order, pipe)
                pipe.flush()

    def _listen(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdout is not None
        with (
            contextlib.suppress(EOFError, OSError, RuntimeError, pickle.UnpicklingError),
            process.stdout as pipe,
        ):
            while True:
                number, pictures = pickle.load(pipe)
                if pictures is not None:  # one after the other, so that a loop is never in memory twice
                    each = (pictures.pop(0) for _ in range(len(pictures)))
                    (_, what, _), _ = self._orders.get(number, (("", "", ""), None))
                    pictures = Cropped(each) if what == "moving" else [to_image(p) for p in each]
                self._drawn.emit(number, pictures)
                del pictures  # until the next pictures, which may take long
        with contextlib.suppress(subprocess.TimeoutExpired):  # also one that was released
            process.wait(5)
        with contextlib.suppress(RuntimeError):  # the window is gone
            self._ended.emit(process)

    def _restart(self, process: subprocess.Popen[bytes]) -> None:
        """Start another process after one ended unexpectedly, without the picture at which it ended."""
        if self._stopped:
            return
        if process is not self._process:  # it was released
            return
        self._queue.put(None)
        self._process, self._queue = None, queue.SimpleQueue()
        if self._begun is not None:
            self._orders.pop(self._begun, None)  # it stays ordered, so that nobody orders it again
            self._begun = None
        else:
            self._fruitless += 1
        again, self._orders = self._orders, {}
        self._line.clear()
        self._given.clear()
        if self._fruitless < TRIES:
            for key, motion in again.values():
                self._order(key, motion)

    def _send_home(self) -> None:
        """Release a process that has been idle for long; the next order starts another."""
        if self._orders:
            self._rest.start()
        elif self._process is not None:
            self._queue.put(None)
            self._process, self._queue = None, queue.SimpleQueue()

    def stop(self) -> None:
        """End the process, on closing."""
        self._stopped = True
        self._rest.stop()
        self.kept.stop()
        if self._process is not None:
            self._queue.put(None)
            self._process.kill()
            self._process.wait(5)
            self._process = None
        for (
            thread
        ) in self._threads:  # both end with the process; one that still made pictures would outlive Qt
            thread.join(5)


def _size(pictures: Sequence[QImage]) -> int:
    if isinstance(pictures, Cropped):
        return pictures.bytes
    return sum(picture.sizeInBytes() for picture in pictures)
