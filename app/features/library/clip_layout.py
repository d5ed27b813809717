"""Where everything in the list of clips is: a pure function of how many there are, in which groups, and of
the room. Points and rectangles are in pixels from the upper left corner of all that can be scrolled to.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPoint, QRect

HEAD = 28  # pixels of a group's title


@dataclass(frozen=True)
class Section:
    """Clips under one title: `count` of them from row `first` on. title "" if there are no groups."""

    title: str
    first: int
    count: int
    closed: bool = False


class ClipLayout:
    """width: of the room. cell: least width and height of a clip; width 0 for lines as wide as the room."""

    def __init__(self, sections: Sequence[Section], width: int, cell: tuple[int, int]) -> None:
        self.sections, self.width = tuple(sections), max(1, width)
        least, self.cell_height = cell
        self.columns = max(1, self.width // least) if least else 1
        self.cell_width = self.width // self.columns
        self.tops: list[int] = []  # of sections
        self.firsts = [s.first for s in self.sections]
        y = 0
        for section in self.sections:
            self.tops.append(y)
            y += HEAD if section.title else 0
            if not section.closed:
                y += -(-section.count // self.columns) * self.cell_height
        self.height = y

    @property
    def count(self) -> int:
        """How many clips there are, in closed groups, too."""
        return self.sections[-1].first + self.sections[-1].count if self.sections else 0

    def section_of(self, row: int) -> int:
        return bisect_right(self.firsts, row) - 1

    def _body(self, place: int) -> int:
        return self.tops[place] + (HEAD if self.sections[place].title else 0)

    def rect(self, row: int) -> QRect:
        """Return where a clip is; nothing if its group is closed."""
        place = self.section_of(row)
        if place < 0 or row >= self.count or self.sections[place].closed:
            return QRect()
        line, column = divmod(row - self.sections[place].first, self.columns)
        return QRect(
            column * self.cell_width,
            self._body(place) + line * self.cell_height,
            self.cell_width,
            self.cell_height,
        )

    def head(self, place: int) -> QRect:
        """Return where the title of a group is; nothing if there are no groups."""
        high = HEAD if self.sections[place].title else 0
        return QRect(0, self.tops[place], self.width, high)

    def at(self, point: QPoint) -> int | None:
        """Return the row under a point."""
        place = bisect_right(self.tops, point.y()) - 1
        if place < 0 or not 0 <= point.x() < self.cell_width * self.columns:
            return None
        section, y = self.sections[place], point.y() - self._body(place)
        if section.closed or y < 0:
            return None
        n = y // self.cell_height * self.columns + point.x() // self.cell_width
        return section.first + n if n < section.count else None

    def head_at(self, point: QPoint) -> int | None:
        """Return the group whose title is under a point."""
        place = bisect_right(self.tops, point.y()) - 1
        return place if place >= 0 and self.head(place).contains(point) else None

    def rows_in(self, area: QRect) -> Iterator[int]:
        """Give the rows that touch an area, from the first on."""
        for place, section in enumerate(self.sections):
            top = self._body(place)
            if section.closed or self.tops[place] > area.bottom():
                continue
            first = max(0, (area.top() - top) // self.cell_height)
            last = min((area.bottom() - top) // self.cell_height, (section.count - 1) // self.columns)
            left = max(0, area.left() // self.cell_width)
            right = min(self.columns - 1, area.right() // self.cell_width)
            for line in range(first, last + 1):
                for column in range(left, right + 1):
                    n = line * self.columns + column
                    if n < section.count:
                        yield section.first + n

    def heads_in(self, area: QRect) -> Iterator[int]:
        """Give the groups whose titles touch an area."""
        return (n for n, s in enumerate(self.sections) if s.title and self.head(n).intersects(area))

    def open_rows(self) -> list[int]:
        """Return the rows that are in no closed group, in order."""
        return [r for s in self.sections if not s.closed for r in range(s.first, s.first + s.count)]

    def beside(self, row: int, steps: int) -> int:
        """Return the row that comes so many after one, or before it; the last one there is."""
        rows = self.open_rows()
        if not rows:
            return row
        at = max(0, bisect_right(rows, row) - 1)
        if rows[at] != row and steps < 0:  # it is in a closed group
            steps += 1
        return rows[min(max(0, at + steps), len(rows) - 1)]

    def below(self, row: int, pixels: int) -> int:
        """Return the row that is so many pixels below one, or above it, as nearly in its column as there is
        one; lines that are farther than the last are the last.
        """
        rect = self.rect(row)
        if rect.isEmpty():
            return self.beside(row, 1 if pixels > 0 else -1)
        down = pixels > 0
        ys = sorted({self.rect(r).top() for r in self._line_starts()})
        at = ys.index(rect.top())
        wanted = rect.top() + pixels
        found = [y for y in (ys[at + 1 :] if down else ys[:at]) if (y <= wanted if down else y >= wanted)]
        if not found:
            found = ys[at + 1 : at + 2] if down else ys[max(0, at - 1) : at]
        if not found:
            return row
        y = found[-1] if down else found[0]
        place = bisect_right(self.tops, y) - 1
        section = self.sections[place]
        n = (y - self._body(place)) // self.cell_height * self.columns + rect.left() // self.cell_width
        return section.first + min(n, section.count - 1)

    def _line_starts(self) -> Iterator[int]:
        for s in self.sections:
            if not s.closed:
                yield from range(s.first, s.first + s.count, self.columns)
