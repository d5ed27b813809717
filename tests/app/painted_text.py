"""What a window paints in words, and where: it is drawn once more on a device that keeps texts and nothing
else.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import combinations
from typing import Any
from unittest import mock

from PySide6.QtCore import QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QFontMetricsF,
    QHelpEvent,
    QPaintDevice,
    QPaintEngine,
    QRegion,
    QTextItem,
)
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QDockWidget,
    QGraphicsView,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPlainTextEdit,
    QTabBar,
    QTextEdit,
    QToolTip,
    QWidget,
)

from app.look.theme import KIND_MARKS, SOUND_MARKS

GAP = "…"
SIGNS = "".join((*KIND_MARKS.values(), *SOUND_MARKS.values(), " ⚠→"))  # in front of names
INSET = 1.5  # pixels by which letters may touch


@dataclass(frozen=True)
class Painted:
    """A text as it was painted. rect: of its letters, in the window; seen: the part that is not clipped."""

    text: str
    rect: QRectF
    seen: QRectF

    def __str__(self) -> str:
        x, y, w, h = (round(n) for n in self.rect.getRect())
        return f"{self.text!r} at {x},{y} {w}x{h}"


class _Engine(QPaintEngine):
    def __init__(self) -> None:
        super().__init__(QPaintEngine.PaintEngineFeature.AllFeatures)
        self.found: list[Painted] = []

    def begin(self, device: QPaintDevice) -> bool:
        return True

    def end(self) -> bool:
        return True

    def type(self) -> QPaintEngine.Type:
        return QPaintEngine.Type.User

    def updateState(self, state: Any) -> None:
        pass

    def drawTextItem(self, at: QPointF, item: QTextItem) -> None:
        painter, words = self.painter(), item.text()
        if not words.strip() or painter.opacity() == 0:
            return
        metrics = QFontMetricsF(item.font())
        tight = metrics.tightBoundingRect(words.strip()) if len(words) < 200 else QRectF()
        rect = QRectF(at.x() + tight.x(), at.y() + tight.y(), tight.width(), tight.height())
        placed = painter.combinedTransform().mapRect(rect)
        clip = painter.clipBoundingRect() if painter.hasClipping() else QRectF()
        seen = placed if clip.isNull() else placed.intersected(painter.combinedTransform().mapRect(clip))
        self.found.append(Painted(words.strip(), placed, seen))

    def nothing(self, *_: Any) -> None:
        pass


for _name in ["Pixmap", "Image", "Path", "Rects", "Lines", "Ellipse", "Polygon", "Points", "TiledPixmap"]:
    setattr(_Engine, f"draw{_name}", _Engine.nothing)


class _Device(QPaintDevice):
    def __init__(self, width: int, height: int) -> None:
        super().__init__()
        self.engine = _Engine()
        self._size = width, height

    def paintEngine(self) -> QPaintEngine:
        return self.engine

    def metric(self, what: QPaintDevice.PaintDeviceMetric) -> int:
        of = QPaintDevice.PaintDeviceMetric
        width, height = self._size
        return {
            of.PdmWidth: width, of.PdmHeight: height, of.PdmWidthMM: width // 4, of.PdmHeightMM: height // 4,
            of.PdmNumColors: 2**31 - 1, of.PdmDepth: 32, of.PdmDpiX: 96, of.PdmDpiY: 96,
            of.PdmPhysicalDpiX: 96, of.PdmPhysicalDpiY: 96, of.PdmDevicePixelRatio: 1,
            of.PdmDevicePixelRatioScaled: 65536,
        }.get(what, 0)  # fmt: skip


def painted(widget: QWidget) -> list[Painted]:
    """Return what a widget paints itself, without its children; in its own pixels."""
    device = _Device(widget.width(), widget.height())
    QWidget.render(widget, device, QPoint(), QRegion(), QWidget.RenderFlag(0))
    return device.engine.found


class _Sheet(_Device):
    """Stands for the picture that a widget keeps of itself."""

    def __init__(self, *size: Any) -> None:
        width, height = size if len(size) == 2 else (size[0].width(), size[0].height())
        super().__init__(width, height)

    def setDevicePixelRatio(self, ratio: float) -> None:
        pass

    def fill(self, color: object) -> None:
        pass


# What shows a picture of itself that it has kept, and how it makes a new one.
def _kept() -> dict[str, Any]:
    return {
        "app.features.timeline.lane_view.Lanes": lambda w: w._picture(),
        "app.features.machine.machine_panel.MachinePanel": lambda w: w._draw(),
        "app.features.conversation.segment_view.SegmentView": lambda w: (
            w._picture(w.conversation()) if w.conversation() is not None else None
        ),
    }


def texts(widget: QWidget) -> list[Painted]:
    """Return what a widget paints itself, what it keeps a picture of included; in its own pixels."""
    kind = type(widget)
    make = _kept().get(f"{kind.__module__}.{kind.__qualname__}")
    found = [] if isinstance(widget, SKIPPED) else painted(widget)
    if make is not None:
        if hasattr(widget, "_still"):
            widget._still = type(widget._still)()
        sheets: list[_Sheet] = []

        def sheet(*size: Any) -> _Sheet:
            sheets.append(_Sheet(*size))
            return sheets[-1]

        with mock.patch(f"{kind.__module__}.QPixmap", sheet):
            make(widget)
        if hasattr(widget, "_still"):
            widget._still = type(widget._still)()
        elif hasattr(widget, "_stale"):
            widget._stale()
        found += [p for s in sheets for p in s.engine.found]
    return found


SKIPPED: tuple[type, ...] = ()


@dataclass(frozen=True)
class Seen:
    """A painted text of a widget. place: in the window's pixels, the part that can be seen. at: its middle in
    the widget.
    """

    widget: QWidget
    painted: Painted
    place: QRectF

    @property
    def at(self) -> QPoint:
        return self.painted.seen.center().toPoint()

    def __str__(self) -> str:
        x, y, w, h = (round(n) for n in self.place.getRect())
        name = self.widget.accessibleName() or self.widget.objectName()
        return f"{self.painted.text!r} of {type(self.widget).__name__} {name!r} at {x},{y} {w}x{h}"


def seen_in(window: QWidget, skip: tuple[QWidget, ...] = ()) -> list[Seen]:
    """Return all texts that are to be seen in a window."""
    out = []
    for widget in (window, *window.findChildren(QWidget)):
        if not widget.isVisible() or (widget.isWindow() and widget is not window) or widget in skip:
            continue
        region = widget.visibleRegion().boundingRect()
        if region.isEmpty():
            continue
        to = QPointF(widget.mapTo(window, QPoint()))
        for words in texts(widget):
            part = words.seen.intersected(QRectF(region))
            if part.width() > 1 and part.height() > 1:
                out.append(Seen(widget, words, part.translated(to)))
    return out


def faults(window: QWidget, skip: tuple[QWidget, ...] = ()) -> list[str]:
    """Return in words every text that is cut, that is left out without being told elsewhere, that says what
    its neighbour says, or that lies on another.
    """
    found = seen_in(window, skip)
    out = [f"{one} is cut" for one in found if cut(one)]
    parts: dict[tuple[int, int, int], list[str]] = {}  # of what is in one item of a list
    for one in found:
        if (item := item_of(one)) is not None:
            parts.setdefault(item, []).append(one.painted.text)
    called: dict[tuple[int, str], tuple[Seen, set[str]]] = {}  # by widget and name, what is shown of it
    for one in found:
        if not elided(one):
            continue
        whole = tip(one)
        if not tells(whole, one.painted.text):
            out.append(f"{one} is not told whole by its tooltip {whole!r}")
            continue
        item = item_of(one)
        words = one.painted.text if item is None else "\n".join(parts[item])
        called.setdefault((id(one.widget), whole.split("\n")[0]), (one, set()))[1].add(words)
    shortened: dict[tuple[int, frozenset[str]], tuple[str, Seen]] = {}
    for (widget, name), (one, lines) in called.items():
        like = shortened.setdefault((widget, frozenset(lines)), (name, one))
        if like[0] != name:
            out.append(f"{one} looks like {like[1]}: {name!r}, {like[0]!r}")
    for one, other in combinations(found, 2):
        both = one.place.intersected(other.place)
        if both.width() > INSET and both.height() > INSET:
            out.append(f"{one} lies on {other}")
    return out


def item_of(one: Seen) -> tuple[int, int, int] | None:
    """Return which item of a list a text is in."""
    view = one.widget.parentWidget()
    if not isinstance(view, QAbstractItemView) or one.widget is not view.viewport():
        return None
    index = view.indexAt(one.at)
    return (id(view), index.row(), index.column()) if index.isValid() else None


def cut(one: Seen) -> bool:
    """Return whether a text goes on outside what it is painted in. What is scrolled goes on above and
    below.
    """
    rect, seen = one.painted.rect, one.painted.seen
    room = QRectF(one.widget.rect())
    if isinstance(one.widget, QLineEdit) or isinstance(one.widget.parent(), QAbstractSpinBox):
        return False  # its text moves along
    part = seen.intersected(room)
    if one.painted.text in SIGNS:
        return False  # from another font, whose measures are not these
    aside = rect.width() - part.width() > INSET
    parent = one.widget.parentWidget()
    scrolls = isinstance(parent, QAbstractItemView) and not isinstance(parent, QHeaderView)
    return aside or (rect.height() - part.height() > INSET and not scrolls and parts_whole(one))


def parts_whole(one: Seen) -> bool:
    return one.painted.seen.height() > INSET


def elided(one: Seen) -> bool:
    """Return whether a part of a text was left out, rather than that dots belong to it."""
    words, widget = one.painted.text, one.widget
    if GAP not in words.lstrip(SIGNS).replace(f"“{GAP}”", ""):
        return False
    if isinstance(widget, QAbstractButton | QLineEdit):
        own = widget.text() if isinstance(widget, QAbstractButton) else widget.placeholderText()
        return words not in own.replace("&", "")
    if isinstance(widget, QLabel):
        return words.rstrip(GAP) not in widget.text() or not widget.text().rstrip().endswith(GAP)
    if isinstance(widget, QComboBox):
        return words != widget.currentText()
    if isinstance(edit := widget.parent(), QPlainTextEdit | QTextEdit):
        return words not in edit.toPlainText()  # it names a button that ends with dots
    return words != GAP


def tip(one: Seen) -> str:
    """Return what the tooltip says where a text is."""
    shown: list[str] = []
    widget: QWidget | None = one.widget
    at = one.at
    with mock.patch.object(QToolTip, "showText", lambda _, words, *rest: shown.append(words)):
        while widget is not None and not shown:
            event = QHelpEvent(QHelpEvent.Type.ToolTip, at, widget.mapToGlobal(at))
            parent = widget.parentWidget()
            if isinstance(parent, QHeaderView):
                section = parent.logicalIndexAt(at)
                words = parent.model().headerData(section, parent.orientation(), Qt.ItemDataRole.ToolTipRole)
                shown += [str(words)] if words else []
            elif isinstance(parent, QAbstractItemView):
                words = parent.indexAt(at).data(Qt.ItemDataRole.ToolTipRole)
                shown += [str(words)] if words else []
            elif isinstance(widget, QTabBar):
                shown += [widget.tabToolTip(widget.tabAt(at)) or widget.tabText(widget.tabAt(at))]
            elif isinstance(parent, QGraphicsView):
                QApplication.sendEvent(parent.viewport(), event)
            elif not widget.toolTip():
                QApplication.sendEvent(widget, event)
            if not shown and widget.toolTip():
                shown.append(widget.toolTip())
            if widget.isWindow() or isinstance(widget, QDockWidget):
                break
            at, widget = widget.mapToParent(at), widget.parentWidget()
    return next((words for words in shown if words), "")


def tells(whole: str, words: str) -> bool:
    """Return whether all that is left of a text stands in a whole, in order."""
    plain, at = _plain(whole), 0
    for piece in words.lstrip(SIGNS).split(GAP):
        found = plain.find(_plain(piece), at)
        if found < 0:
            return False
        at = found + len(_plain(piece))
    return bool(plain)


def _plain(words: str) -> str:
    return "".join(words.replace("_", " ").split()).casefold()


@contextmanager
def without(*kinds: type) -> Iterator[None]:
    """Leave widgets of some kinds alone: they show no words, and drawing them again takes its time."""
    global SKIPPED
    before, SKIPPED = SKIPPED, kinds
    try:
        yield
    finally:
        SKIPPED = before
