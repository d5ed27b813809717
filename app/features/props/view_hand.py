"""Choose, move, turn and resize props with the mouse in the view of the character."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, radians, sin
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QObject, QPointF, Qt, QTimer
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.features.props.placing import Placing
from app.features.props.prop_drag import PropDrag
from app.look.theme import get_theme
from app.stage.over_view import lie_over
from app.stage.props import PropFigures, PropMeshes, find_prop_on_ray, put_prop_down
from app.translation import tr
from app.widgets.gesture import PointerHand
from metagraph.graph.prop import LARGEST, Prop
from metagraph.speech.duet import Stand

Array = NDArray[Any]

GRID, STEP, SIZE = 0.05, 15.0, 0.05  # metres, degrees and part of its size that a drag snaps to
HANDLE, REACH = 5.0, 11.0  # pixels: half of a handle, and how near to it a press takes it
ROOM = 26.0  # pixels from the middle of a prop to its handles, at least
FARTHEST = 40.0  # metres along the floor: what is dragged to the horizon stays this near
DOUBLE = 120.0  # pixels of a drag that doubles a prop's size
SETTLED = 700  # milliseconds after the last notch of the wheel: what follows is another step
BODY = 0.09  # metres from a bone: what is seen there is the character, not the prop behind it
SMALLEST = 0.01
SHIFT, CTRL, ALT = (
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.AltModifier,
)


class PropHand(QObject):
    """Takes the mouse of a view where a prop is under it. A click chooses; what is dragged must be chosen, so
    that drags over other props move the camera. panel: the preview, as overlays know it.
    """

    def __init__(self, panel: Any, placing: Placing, figures: PropFigures) -> None:
        super().__init__(panel)
        self.panel, self.view, self.placing, self.figures = panel, panel.view, placing, figures
        self.hand = PointerHand()
        self._pressed: tuple[QPointF, str] | None = None  # a click, unless the mouse moves
        self.marks = PropMarks(self)
        self._wheel = QTimer(self, singleShot=True, interval=SETTLED)
        self._wheel.timeout.connect(placing.end)
        self.view.installEventFilter(self)
        placing.changed.connect(self.view.update)

    @property
    def meshes(self) -> PropMeshes:
        """What the files of props hold."""
        return self.figures.meshes

    # --- places

    @property
    def stand(self) -> Stand | None:
        """Where the character stands whose props are seen; None if they are not seen."""
        shown = self.panel.performance.shown.everyone[0]
        if shown.clip is not None or shown.skeleton is None or not self.panel.performance.is_documents(shown):
            return None
        return shown.stand or Stand()

    def find_ray(self, at: QPointF) -> tuple[Array, Array]:
        """Return the ray through pixels, as its origin and direction in the project's space."""
        view, stand = self.view, self.stand or Stand()
        wide, high = max(1, view.width()), max(1, view.height())
        origin, way = view.camera.ray(at.x() / wide, at.y() / high, wide / high)
        end = stand.own(tuple(map(float, origin + way)))
        start = stand.own(tuple(map(float, origin)))
        return np.array(start), np.array(end) - np.array(start)

    def find_place(self, at: QPointF, high: float) -> tuple[float, float] | None:
        """Return where a ray through pixels meets a level, x and z in metres; None above the horizon."""
        origin, way = self.find_ray(at)
        if abs(way[1]) < 1e-6:
            return None
        far = (high - origin[1]) / way[1]
        if far <= 0:
            return None
        x, z = float(origin[0] + far * way[0]), float(origin[2] + far * way[2])
        size = hypot(x, z)
        share = min(1.0, FARTHEST / size) if size > 0 else 1.0
        return x * share, z * share

    def to_pixels(self, point: Any) -> QPointF | None:
        """Return where a point of the project's space is in the view; None behind the camera."""
        view, stand = self.view, self.stand or Stand()
        wide, high = max(1, view.width()), max(1, view.height())
        x, y = view.camera.project(stand.world(tuple(map(float, point))), wide / high) * [wide, high]
        return QPointF(x, y) if np.isfinite((x, y)).all() else None

    def find_prop(self, at: QPointF) -> str:
        """Return the id of the prop that is seen at pixels, "" for none."""
        if self.stand is None:
            return ""
        origin, way = self.find_ray(at)
        ident, far = find_prop_on_ray(self.placing.document.project, self.meshes, origin, way)
        return ident if ident and not self._is_hidden(at, far) else ""

    def _is_hidden(self, at: QPointF, far: float) -> bool:
        """Return whether the character is before what is so far away at pixels."""
        drawn, view = self.panel.drawn, self.view
        if drawn is None:
            return False
        figure, _, places = drawn
        wide, high = max(1, view.width()), max(1, view.height())
        origin, way = view.camera.ray(at.x() / wide, at.y() / high, wide / high)
        parents = figure.skeleton.parents
        ends = np.flatnonzero(parents >= 0)
        share = np.linspace(0, 1, 8)[:, None, None]
        points = (places[ends] * share + places[parents[ends]] * (1 - share)).reshape(-1, 3) - origin
        along = points @ way
        off = np.linalg.norm(points - along[:, None] * way, axis=1)
        return bool(((off < BODY) & (along > 0) & (along < far)).any())

    # --- what is drawn of the chosen prop

    def find_corners(self, prop: Prop) -> Array | None:
        """Return the corners of the box round a prop as it stands, `[8, 3]`, the lower four first, its back's
        before its front's; None until its file is read.
        """
        mesh = self.meshes.meshes.get(self.meshes.locate(prop.path))
        if mesh is None:
            return None
        low, high = mesh.positions.min(0) * prop.scale, mesh.positions.max(0) * prop.scale
        turn = radians(prop.turn[1])
        out = []
        for y in (low[1], high[1]):
            for x, z in ((low[0], low[2]), (high[0], low[2]), (high[0], high[2]), (low[0], high[2])):
                out.append((x * cos(turn) + z * sin(turn), y, z * cos(turn) - x * sin(turn)))
        return np.array(out) + np.asarray(prop.at)

    def find_handles(self) -> dict[str, QPointF]:
        """Return where the handles of the chosen prop are, by what they do: "turn" and "scale"."""
        prop = self.placing.prop
        corners = self.find_corners(prop) if prop is not None and not prop.joint else None
        if corners is None or prop is None or self.stand is None:
            return {}
        turn = radians(prop.turn[1])
        front = corners[2:4].mean(0) + np.array([sin(turn), 0, cos(turn)]) * 0.12
        middle = self.to_pixels(corners.mean(0))
        out = {"turn": self.to_pixels(front), "scale": self.to_pixels(corners[6])}
        return {
            name: _push_away(at, middle) for name, at in out.items() if at is not None and middle is not None
        }

    # --- events of the view

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if isinstance(event, QKeyEvent):
            return self._take_key(event)
        if isinstance(event, QWheelEvent):
            return self._take_wheel(event)
        if not isinstance(event, QMouseEvent):
            return False
        if kind == QEvent.Type.MouseButtonPress:
            return self._press(event)
        if kind == QEvent.Type.MouseMove:
            return self._move(event)
        if kind == QEvent.Type.MouseButtonRelease:
            return self._release(event)
        return kind == QEvent.Type.MouseButtonDblClick and self._is_over(event.position())

    def _is_over(self, at: QPointF) -> bool:
        """Return whether a press there takes the chosen prop."""
        if self.placing.prop is None:
            return False
        near = any((at - place).manhattanLength() <= REACH for place in self.find_handles().values())
        return near or self.find_prop(at) == self.placing.ident

    def _press(self, event: QMouseEvent) -> bool:
        at, held = event.position(), event.modifiers()
        if event.button() != Qt.MouseButton.LeftButton:
            self.hand.drop("replaced")
            return False
        self._pressed = (at, self.find_prop(at))
        prop, ident = self.placing.prop, self.placing.ident
        if prop is None or prop.joint or not self._is_over(at):
            return False  # the camera's, unless it stays a click
        self._pressed = None
        handles = self.find_handles().items()
        near = [name for name, place in handles if (at - place).manhattanLength() <= REACH]
        if near == ["turn"] or (not near and held & SHIFT):
            self.hand.take(SpinDrag(self, ident, prop), at)
        elif near or held & CTRL:
            self.hand.take(ResizeDrag(self, ident, prop), at)
        else:
            self.hand.take(FloorDrag(self, ident, prop), at)
        return True

    def _move(self, event: QMouseEvent) -> bool:
        at = event.position()
        if self._pressed is not None and (at - self._pressed[0]).manhattanLength() > 3:
            self._pressed = None
        return self.hand.move(at, bool(event.modifiers() & ALT))

    def _release(self, event: QMouseEvent) -> bool:
        pressed, self._pressed = self._pressed, None
        if self.hand.release(event):
            return True
        if pressed is not None and event.button() == Qt.MouseButton.LeftButton:
            self.placing.choose(pressed[1])
        return False

    def _take_key(self, event: QKeyEvent) -> bool:
        """Keep Escape from the window's shortcuts while a drag lasts; otherwise it chooses no prop."""
        if event.key() != Qt.Key.Key_Escape:
            return False
        busy = self.hand.gesture is not None
        if event.type() == QEvent.Type.ShortcutOverride:
            if busy:
                event.accept()
            return busy
        if event.type() != QEvent.Type.KeyPress:
            return False
        if busy:
            self.hand.drop("escape")
            return True
        if self.placing.ident:
            self.placing.choose("")
            return True
        return False

    def _take_wheel(self, event: QWheelEvent) -> bool:
        """Resize the chosen prop under the mouse where Ctrl is held, or while the mouse holds it."""
        prop, ident = self.placing.prop, self.placing.ident
        notches = event.angleDelta().y() / 120
        if prop is None or prop.joint or not notches or self.hand.gesture is not None:
            return self.hand.gesture is not None
        if not event.modifiers() & CTRL or not self._is_over(event.position()):
            return False
        event.accept()
        larger = resize(prop, prop.scale * 1.05**notches)
        self.placing.drag(tr("Resize {name}", name=prop.name), ident, larger)
        self._wheel.start()
        return True


def _push_away(at: QPointF, middle: QPointF) -> QPointF:
    """Return a handle so far from the middle of a small prop that there is room to take the prop itself."""
    off = at - middle
    far = hypot(off.x(), off.y())
    return at if far >= ROOM else middle + (off * (ROOM / far) if far > 1e-6 else QPointF(0, ROOM))


def resize(prop: Prop, scale: float) -> Prop:
    """Return a prop in another size, within what a project can hold."""
    return msgspec.structs.replace(prop, scale=round(min(LARGEST, max(SMALLEST, scale)), 4))


class _ViewDrag(PropDrag):
    """Drags a prop in the view. high: metres, how high it was taken."""

    high = 0.0

    def __init__(self, hand: PropHand, ident: str, before: Prop) -> None:
        super().__init__(hand.placing, ident, before)
        self.hand = hand

    def begin(self, at: QPointF) -> None:
        super().begin(at)
        origin, way = self.hand.find_ray(at)
        project = self.hand.placing.document.project
        found, far = find_prop_on_ray(project, self.hand.meshes, origin, way)
        self.high = float(origin[1] + far * way[1]) if found == self.ident else self.before.at[1]


class FloorDrag(_ViewDrag):
    """Moves a prop along the floor, at the height at which it was taken."""

    def begin(self, at: QPointF) -> None:
        super().begin(at)
        self.start = self.hand.find_place(at, self.high)

    def words(self) -> str:
        return tr("Move {name}", name=self.before.name)

    def place(self, at: QPointF, free: bool) -> Prop:
        place = self.hand.find_place(at, self.high)
        if place is None or self.start is None:
            return self.hand.placing.prop or self.before
        x, z = (was + to - of for was, to, of in zip(self.before.at[::2], place, self.start, strict=True))
        if not free:
            x, z = round(x / GRID) * GRID, round(z / GRID) * GRID
        project = self.hand.placing.document.project
        return put_prop_down(project, self.hand.meshes, self.ident, self.before, (x, z))


class SpinDrag(_ViewDrag):
    """Turns a prop about the vertical through its origin, as far as the mouse goes round it on the floor."""

    def angle(self, at: QPointF) -> float | None:
        place = self.hand.find_place(at, self.high)
        if place is None:
            return None
        return degrees(atan2(place[0] - self.before.at[0], place[1] - self.before.at[2]))

    def begin(self, at: QPointF) -> None:
        super().begin(at)
        self.start = self.angle(at)

    def words(self) -> str:
        return tr("Turn {name}", name=self.before.name)

    def place(self, at: QPointF, free: bool) -> Prop:
        now = self.angle(at)
        if now is None or self.start is None:
            return self.hand.placing.prop or self.before
        angle = self.before.turn[1] + now - self.start
        angle = angle if free else round(angle / STEP) * STEP
        turn = (self.before.turn[0], round((angle + 180) % 360 - 180, 1), self.before.turn[2])
        return msgspec.structs.replace(self.before, turn=turn)


class ResizeDrag(_ViewDrag):
    """Resizes a prop about its origin: upwards and to the right it grows."""

    def words(self) -> str:
        return tr("Resize {name}", name=self.before.name)

    def place(self, at: QPointF, free: bool) -> Prop:
        by = (at.x() - self.origin.x()) - (at.y() - self.origin.y())
        scale = self.before.scale * 2 ** (by / DOUBLE)
        if not free:
            scale = self.before.scale * max(SIZE, round(scale / self.before.scale / SIZE) * SIZE)
        return resize(self.before, scale)


class PropMarks(QWidget):
    """Draws the box round the chosen prop over the view, a dot that turns it and a square that resizes it. It
    passes all mouse events on.
    """

    def __init__(self, hand: PropHand) -> None:
        super().__init__(hand.view)
        self.hand = hand
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAccessibleName(tr("Chosen prop"))
        self.hide()
        hand.placing.changed.connect(self.show_or_hide)
        hand.view.painted.connect(self._follow)
        self.show_or_hide()

    def show_or_hide(self) -> None:
        prop = self.hand.placing.prop
        words = tr(
            "Drag {name} to move it, its dot to turn it, its square to resize it. Alt: no snapping",
            name=prop.name if prop is not None else "",
        )
        self.setAccessibleDescription(words if prop is not None else "")
        self.setVisible(prop is not None)
        self._follow()

    def _follow(self, *_: object) -> None:
        if not self.isHidden():
            lie_over(self, self.hand.view)

    def paintEvent(self, event: QPaintEvent) -> None:
        prop = self.hand.placing.prop
        corners = self.hand.find_corners(prop) if prop is not None and not prop.joint else None
        if corners is None or self.hand.stand is None:
            return
        points = [at for corner in corners if (at := self.hand.to_pixels(corner)) is not None]
        if len(points) < len(corners):  # a part of it is behind the camera
            return
        look = get_theme(self.hand.panel.session.look.name)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for pen in (QPen(QColor(look.card), 3.0), QPen(QColor(look.text), 1.4)):
            painter.setPen(pen)
            painter.drawPolygon(QPolygonF(points[:4]))
            painter.drawPolygon(QPolygonF(points[4:]))
            for low, high in zip(points[:4], points[4:], strict=True):
                painter.drawLine(low, high)
        painter.setPen(QPen(QColor(look.card), 1.5))
        painter.setBrush(QColor(look.text))
        for name, at in self.hand.find_handles().items():
            if name == "turn":
                painter.drawEllipse(at, HANDLE, HANDLE)
            else:
                painter.drawRect(round(at.x() - HANDLE), round(at.y() - HANDLE), 10, 10)
        painter.end()
