"""The pointer over a clip's picture goes through the clip, from its left edge to its right."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QModelIndex, QObject, QPoint, QRect, QTimer
from PySide6.QtWidgets import QListView

from app.features.library.clip_pictures import ClipPictures
from app.features.library.clip_rows import ClipRows

REST = 90  # milliseconds on one picture before its others are wanted: the pointer may only be passing


class ClipScrub(QObject):
    """view: whose pictures are gone through, place_of: where one is. It tells `pictures` which clip, and how
    far.
    """

    def __init__(
        self,
        view: QListView,
        rows: ClipRows,
        pictures: ClipPictures,
        place_of: Callable[[QModelIndex], QRect],
    ) -> None:
        super().__init__(view)
        self.view, self.rows, self.pictures, self.place_of = view, rows, pictures, place_of
        self._wanted: tuple[str, float] | None = None
        self._rest = QTimer(self, singleShot=True, interval=REST)
        self._rest.timeout.connect(self._begin)

    def over(self, at: QPoint) -> None:
        """The pointer is here."""
        index = self.view.indexAt(at)
        picture = self.place_of(index)
        if not index.isValid() or not picture.contains(at):
            self.stop()
            return
        clip = self.rows.entries[index.row()].id
        part = (at.x() - picture.left()) / max(1, picture.width() - 1)
        self._wanted = clip, part
        if self.pictures.scrubbed is not None and self.pictures.scrubbed[0] == clip:
            self._begin()
        else:
            self._show(None)
            self._rest.start()

    def stop(self) -> None:
        """The pointer is elsewhere: clips show what they do."""
        self._rest.stop()
        self._wanted = None
        self._show(None)

    def _begin(self) -> None:
        self._show(self._wanted)

    def _show(self, place: tuple[str, float] | None) -> None:
        before, self.pictures.scrubbed = self.pictures.scrubbed, place
        if before != place:
            for one in (before, place):
                row = self.rows.row_of(one[0]) if one is not None else None
                if row is not None:
                    self.view.viewport().update(self.view.visualRect(self.rows.index(row, 0)))
