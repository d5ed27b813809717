"""Search on a thread for pictures that were drawn before, and keep new ones there."""

from __future__ import annotations

import contextlib
import queue
import threading

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QImage

from app.stage.picture_process import PictureOrder
from app.stage.picture_store import PictureStore, find_pictures_folder, make_picture_key

Work = PictureOrder | tuple[str, list[QImage]] | None


class KeptPictures(QObject):
    """Searches and keeps pictures on disk. `found` has an order's number and its pictures, `missing` an order
    without pictures on disk.
    """

    found = Signal(int, object)
    missing = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work: queue.LifoQueue[Work] = queue.LifoQueue()  # the latest orders are visible now
        self._keys: dict[int, str] = {}  # by number of a missing order: the key of its pictures
        self._wanted: set[int] = set()
        self._thread: threading.Thread | None = None
        self._stopped = False

    def ask(self, order: PictureOrder) -> None:
        """Search for an order's pictures; `found` or `missing` is emitted."""
        if self._stopped:
            return
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="pictures on disk", daemon=True)
            self._thread.start()
        self._wanted.add(order.number)
        self._work.put(order)

    def keep(self, number: int, pictures: list[QImage]) -> None:
        """Keep the pictures that were drawn for a missing order."""
        key = self._keys.pop(number, None)
        if key is not None and not self._stopped:
            self._work.put((key, pictures))

    def forget(self, number: int) -> None:
        """Drop an order whose pictures are no longer needed."""
        self._wanted.discard(number)
        self._keys.pop(number, None)

    def stop(self) -> None:
        """End the thread, on closing."""
        self._stopped = True
        self._work.put(None)
        if self._thread is not None:
            self._thread.join(5)

    def _run(self) -> None:
        store = PictureStore(find_pictures_folder())
        with contextlib.suppress(RuntimeError):  # the window is gone
            while (work := self._work.get()) is not None:
                if isinstance(work, tuple):
                    store.keep(*work)
                elif work.number in self._wanted:
                    self._wanted.discard(work.number)
                    self._search(store, work)

    def _search(self, store: PictureStore, order: PictureOrder) -> None:
        key = make_picture_key(order)
        found = store.load(key)
        if found is not None:
            self.found.emit(order.number, found)
        else:
            self._keys[order.number] = key
            self.missing.emit(order)
