"""Convert seconds to pixels, with zoom and scroll."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

CLOSEST = 2400.0  # pixels a second: single frames stand well apart
BESIDE = 0.02  # of a clip's length seen before and after it where all of it is seen
STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0)


@dataclass(frozen=True)
class Axis:
    """A time axis. left: pixels to the left of the rows. width: of the rows. length: seconds in all. first:
    seconds at the left edge. each: pixels a second.
    """

    left: float
    width: float
    length: float
    first: float
    each: float

    @staticmethod
    def whole(left: float, width: float, length: float) -> Axis:
        """Return the axis that shows everything."""
        length, width = max(length, 1e-3), max(width, 1.0)
        each = width / (length * (1 + 2 * BESIDE))
        return Axis(left, width, length, -BESIDE * length, each)

    def x(self, seconds: float) -> float:
        return self.left + (seconds - self.first) * self.each

    def seconds(self, x: float) -> float:
        return self.first + (x - self.left) / self.each

    @property
    def last(self) -> float:
        """Seconds at the right edge."""
        return self.first + self.width / self.each

    @property
    def is_whole(self) -> bool:
        return self.each <= Axis.whole(self.left, self.width, self.length).each * 1.001

    def zoomed(self, x: float, factor: float) -> Axis:
        """Return the axis zoomed by a factor around a point, at least so that everything is visible, at most
        to `CLOSEST`.
        """
        least = Axis.whole(self.left, self.width, self.length).each
        each = min(max(self.each * factor, least), max(CLOSEST, least))
        x = min(max(x, self.left), self.left + self.width)
        return replace(self, each=each, first=self.seconds(x) - (x - self.left) / each)._kept()

    def moved(self, pixels: float) -> Axis:
        """Return the axis scrolled, within its limits."""
        return replace(self, first=self.first + pixels / self.each)._kept()

    def fitted(self, left: float, width: float, length: float) -> Axis:
        """Return the axis for another size or length. It keeps showing everything, or else the same part."""
        if self.is_whole or length != self.length:
            return Axis.whole(left, width, length)
        least = Axis.whole(left, width, length).each
        return replace(self, left=left, width=max(width, 1.0), each=max(self.each, least))._kept()

    def _kept(self) -> Axis:
        low, high = -BESIDE * self.length, (1 + BESIDE) * self.length - self.width / self.each
        return replace(self, first=min(max(self.first, low), max(low, high)))

    def marks(self, apart: float = 62.0) -> Iterator[float]:
        """The seconds to write on the ruler, at least this many pixels apart."""
        step = next((s for s in STEPS if s * self.each >= apart), STEPS[-1])
        n = max(0, int(self.first // step))
        while n * step <= min(self.last, self.length) + 1e-9:
            if n * step >= self.first - 1e-9:
                yield round(n * step, 3)
            n += 1
