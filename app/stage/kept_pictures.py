"""Looks on a thread for pictures that were drawn before, and keeps there what is drawn now."""

from __future__ import annotations

import contextlib
import queue
import threading

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QImage

from app.stage.picture_process import PictureOrder
from app.stage.picture_store import PictureStore, picture_key, pictures_folder

Work = PictureOrder | tuple[str, list[QImage]] | None


class KeptPictures(QObject):
    """found: an order's number and its pictures. missing: an order of which the disk has nothing."""

    found = Signal(int, object)
    missing = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work: queue.LifoQueue[Work] = queue.LifoQueue()  # what was asked for last is in sight
        self._keys: dict[int, str] = {}  # of orders that are missing, what they are found by
        self._wanted: set[int] = set()
        self._thread: threading.Thread | None = None
        self._stopped = False

    def ask(self, order: PictureOrder) -> None:
        """Look for an order's pictures; `found` or `missing` tells."""
        if self._stopped:
            return
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="pictures on disk", daemon=True)
            self._thread.start()
        self._wanted.add(order.number)
        self._work.put(order)

    def keep(self, number: int, pictures: list[QImage]) -> None:
        """Keep what was drawn for an order that was missing."""
        key = self._keys.pop(number, None)
        if key is not None and not self._stopped:
            self._work.put((key, pictures))

    def forget(self, number: int) -> None:
        """Nobody wants an order's pictures any more."""
        self._wanted.discard(number)
        self._keys.pop(number, None)

    def stop(self) -> None:
        """End the thread; at closing."""
        self._stopped = True
        self._work.put(None)
        if self._thread is not None:
            self._thread.join(5)

    def _run(self) -> None:
        store = PictureStore(pictures_folder())
        with contextlib.suppress(RuntimeError):  # the window is gone
            while (work := self._work.get()) is not None:
                if isinstance(work, tuple):
                    store.keep(*work)
                elif work.number in self._wanted:
                    self._wanted.discard(work.number)
                    self._search(store, work)

    def _search(self, store: PictureStore, order: PictureOrder) -> None:
        key = picture_key(order)
        found = store.load(key)
        if found is not None:
            self.found.emit(order.number, found)
        else:
            self._keys[order.number] = key
            self.missing.emit(order)
