"""Lay out the timing editor: a title and rows for each action, from the top down."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from PySide6.QtCore import QRectF

from app.translation import make_lazy_texts, tr

RULER, TITLE = 22.0, 20.0
GUTTER = 86.0  # pixels at the left in which rows are named
RIGHT = 12.0  # pixels at the right that stay free
GAP = 4.0

# Pixels of each row: the least, what it would like, and its share of what is left over. Rows that are not
# wanted are not there; where it is low, pictures give way first.
SIZES: dict[str, tuple[float, float, float]] = {
    "poses": (28.0, 54.0, 0.9),
    "line": (20.0, 30.0, 0.2),
    "phases": (20.0, 22.0, 0.0),
    "speed": (40.0, 90.0, 2.0),
    "numbers": (37.0, 37.0, 0.0),
    "hand": (18.0, 20.0, 0.0),  # of each hand that is kept, "hand 0" the first
    "stance": (20.0, 30.0, 0.4),
}
MOST = {"poses": 150.0, "line": 60.0, "stance": 64.0}
JOINT = 13.0  # pixels of a joint in the dope sheet
TITLES = make_lazy_texts(
    lambda: {
        "poses": tr("poses"),
        "line": tr("line"),
        "phases": tr("phases"),
        "speed": tr("speed"),
        "stance": tr("to stance"),
    }
)


def measure_row_size(row: str) -> tuple[float, float, float]:
    return SIZES[row.split()[0]]


@dataclass(frozen=True)
class TrackRows:
    """ident: of the action. rows: by name, across the whole width. title: where its name stands, empty if it
    is the only one. dope: where its joints stand.
    """

    ident: str
    title: QRectF
    rows: dict[str, QRectF] = field(default_factory=dict)
    dope: QRectF = field(default_factory=QRectF)

    @property
    def top(self) -> float:
        return self.title.top()

    @property
    def bottom(self) -> float:
        return max([self.dope.bottom(), *(r.bottom() for r in self.rows.values())])

    @property
    def handles(self) -> QRectF:
        """Where handles can be taken: over phases and speed."""
        speed = self.rows["speed"]
        above = self.rows.get("phases", speed)
        return QRectF(speed.left(), above.top(), speed.width(), speed.bottom() - above.top())


@dataclass(frozen=True)
class TrackWants:
    """What is to be shown of an action: names of rows, and how many joints of the dope sheet."""

    ident: str
    rows: tuple[str, ...]
    joints: int = 0


def measure_least_rows_height(wants: Sequence[TrackWants]) -> float:
    """Return how many pixels the rows need."""
    return RULER + sum(_least(want, len(wants) > 1) for want in wants)


def lay_out_rows(wants: Sequence[TrackWants], width: float, height: float) -> tuple[TrackRows, ...]:
    """Return the rows of each action in a widget of some size, which is at least
    `measure_least_rows_height` high.
    """
    return tuple(_laid_out(wants, width, height))


def _laid_out(wants: Sequence[TrackWants], width: float, height: float) -> Iterator[TrackRows]:
    many = len(wants) > 1
    spare = max(0.0, height - measure_least_rows_height(wants)) / max(1, len(wants))
    y = RULER
    for want in wants:
        title = QRectF(0, y, width, TITLE if many else 0.0)
        y = title.bottom()
        heights = _heights(want.rows, spare)
        rows = {}
        for name in want.rows:
            rows[name] = QRectF(0, y, width, heights[name])
            y += heights[name] + (0.0 if name == "phases" else GAP)
        dope = QRectF(0, y, width, want.joints * JOINT)
        y = dope.bottom() + (GAP if want.joints else 0.0)
        yield TrackRows(want.ident, title, rows, dope)


def _least(want: TrackWants, many: bool) -> float:
    rows = sum(measure_row_size(name)[0] + (0.0 if name == "phases" else GAP) for name in want.rows)
    return rows + (TITLE if many else 0.0) + (want.joints * JOINT + GAP if want.joints else 0.0)


def _heights(names: Sequence[str], spare: float) -> dict[str, float]:
    """Share what is left over: first what each row would like, then by its share."""
    out = {name: measure_row_size(name)[0] for name in names}
    wanted = {name: measure_row_size(name)[1] - measure_row_size(name)[0] for name in names}
    part = min(1.0, spare / total) if (total := sum(wanted.values())) > 0 else 0.0
    for name in names:
        out[name] += wanted[name] * part
    left, shares = spare - total * part, sum(measure_row_size(name)[2] for name in names)
    for name in names:
        more = left * measure_row_size(name)[2] / shares if shares and left > 0 else 0.0
        out[name] = min(out[name] + more, MOST.get(name, 1e9))
    return out
