"""Hold mostly transparent pictures without the empty space around what they show."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import overload

import numpy as np
from PySide6.QtCore import QRect
from PySide6.QtGui import QImage

from app.stage.gl_view import to_image


class Cropped(Sequence[QImage]):
    """A loop's pictures `[H, W, 4]`, premultiplied. Each is restored to full size when it is needed, which
    takes a tenth of a millisecond; the latest one is kept. `bytes` is the memory they take.
    """

    def __init__(self, pictures: Iterable[np.ndarray]) -> None:
        self._held: list[tuple[QRect, QImage]] = []
        for picture in pictures:
            seen = picture[..., 3] > 0
            rows, columns = np.flatnonzero(seen.any(1)), np.flatnonzero(seen.any(0))
            if not len(rows):
                rows = columns = np.zeros(1, int)
            top, left = int(rows[0]), int(columns[0])
            part = to_image(picture[top : int(rows[-1]) + 1, left : int(columns[-1]) + 1])
            self._held.append((QRect(-left, -top, picture.shape[1], picture.shape[0]), part))
        self.bytes = sum(part.sizeInBytes() for _, part in self._held)
        self._last: tuple[int, QImage] | None = None

    def __len__(self) -> int:
        return len(self._held)

    @overload
    def __getitem__(self, at: int) -> QImage: ...
    @overload
    def __getitem__(self, at: slice) -> list[QImage]: ...
    def __getitem__(self, at: int | slice) -> QImage | list[QImage]:
        if isinstance(at, slice):
            return [self[n] for n in range(*at.indices(len(self)))]
        if self._last is None or self._last[0] != at:
            whole, part = self._held[at]
            self._last = at, part.copy(whole)  # everything beyond the cropped picture is transparent
        return self._last[1]
