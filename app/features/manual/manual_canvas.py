"""The editor's widget: pan, zoom, nodes and arrows; turns the mouse and the keys into gestures and edits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from PySide6.QtCore import QEvent, QPointF, QRectF, QSizeF, Qt, QTimer, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QDragEnterEvent,
    QDragMoveEvent,
    QDropEvent,
    QHelpEvent,
    QKeyEvent,
    QKeySequence,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPixmap,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QMenu, QToolTip, QWidget

from app.features.manual import manual_commands as commands
from app.features.manual import manual_many
from app.features.manual import manual_painter as painter
from app.features.manual.drags.band import Band
from app.features.manual.drags.link import DrawLink
from app.features.manual.drags.move import Move
from app.features.manual.drags.pan import ManualPan
from app.features.manual.manual_overlay import ManualMarks, find_playing_state, paint_over
from app.features.manual.manual_pictures import ManualPictures
from app.features.manual.manual_scene import NODE, NOTHING, ManualScene, ManualView, fit_view
from app.features.manual.manual_spoken import list_manual_items
from app.look.plural import count_clips
from app.look.theme import get_theme
from app.project.document import Document
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from app.translation import tr, tr_error
from app.widgets.gesture import PointerHand
from app.widgets.mime import load_of
from app.widgets.spoken_items import SpokenItem
from metagraph.graph.edit_error import EditError
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual.machine import ANY
from metagraph.graph.model import Layer, Project

SETTLED = 140  # milliseconds of rest after which lines are smooth again
MANY = 800  # links beyond which an edit is shown roughly first
BEAT = 90  # milliseconds between looks at what plays
MAP = QSizeF(168, 104)  # of the map in the corner, pixels


class ManualCanvas(QWidget):
    """The machine of the current layer. files_dropped: (paths, place) to import and then place. refused:
    words for the status bar. viewed: what is seen has changed. find_wanted: states are to be searched for.
    """

    files_dropped = Signal(object, object)
    refused = Signal(str)
    viewed = Signal()
    find_wanted = Signal()

    def __init__(
        self,
        document: Document,
        session: StageSession,
        performance: StagePerformance,
        thumbnails: Thumbnails,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.performance = document, session, performance
        self.pictures = ManualPictures(thumbnails, session)
        self.view = ManualView()
        self.hand = PointerHand()
        self.hover = NOTHING
        self.troubles: dict[str, str] = {}
        self.at = QPointF(200, 200)  # where the mouse was last
        self._views: dict[Layer, ManualView] = {}
        self._scene: ManualScene | None = None
        self._dragged: Mapping[str, tuple[float, float]] = {}
        self._band: QRectF | None = None
        self._link: tuple[str, QPointF, str, tuple[str, ...]] = (
            "",
            QPointF(),
            "",
            (),
        )  # source, where it ends now, target, all sources
        self._link_words = ""
        self._still: tuple[object, QPixmap] | None = None
        self._fast = False
        self._dropping = ""
        self._turn: tuple[str, float] = ("", 0.0)
        self._settle = QTimer(self, singleShot=True, interval=SETTLED)
        self._settle.timeout.connect(self.settle)
        self._beat = QTimer(self, interval=BEAT)
        self._beat.timeout.connect(self._follow_play)
        self._beat.start()
        self.setMouseTracking(True)
        self.setAcceptDrops(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(420, 320)
        self.setAccessibleName(tr("State machine"))
        document.changed.connect(self._edited)
        document.loaded.connect(self._reload)
        session.place.layer_changed.connect(self._relayer)
        for signal in (session.selection.changed, session.look.changed):
            signal.connect(self.update)
        thumbnails.ready.connect(self._pictured)

    # --- what is seen

    def scene(self) -> ManualScene:
        """Return the geometry of the layer's machine as it is, made when first asked for after a change."""
        if self._scene is None:
            self._scene = ManualScene(
                manual_edits.get_machine(self.document.project, self.session.place.layer)
            )
        return self._scene

    def list_spoken_items(self) -> Sequence[SpokenItem]:
        selection = self.session.selection
        return list_manual_items(self.scene(), self.view, selection.states, selection.links)

    def look_at(self, view: ManualView) -> None:
        """Show another part, drawn roughly until it rests."""
        if view != self.view:
            self.view, self._fast = view, True
            self._views[self.session.place.layer] = view
            self._settle.start()
            self.update()
            self.viewed.emit()

    def settle(self) -> None:
        """Draw smoothly again."""
        self._settle.stop()
        if self._fast:
            self._fast = False
            self.update()

    def fit(self) -> None:
        """Show the selected nodes, or all."""
        scene, rect = self.scene(), QRectF()
        for ident in self.session.selection.states:
            rect = rect.united(scene.nodes.get(ident, QRectF()))
        self.look_at(fit_view(rect if not rect.isNull() else scene.bounds, QSizeF(self.size())))
        self.settle()

    def drag_nodes(self, places: Mapping[str, tuple[float, float]]) -> None:
        """Show nodes elsewhere while they are dragged; nothing ends it."""
        self._dragged = places
        self.update()

    def show_band(self, band: QRectF | None) -> None:
        self._band = band
        self.update()

    def show_link(
        self, source: str, at: QPointF, target: str, sources: tuple[str, ...] = (), words: str = ""
    ) -> None:
        """Show a link that is being drawn; no source ends it. words: about it, at the canvas's foot."""
        self._link, self._link_words = (source, at, target, sources or (source,)), words
        if not source:
            self.unsetCursor()
        self.update()

    def set_troubles(self, troubles: dict[str, str]) -> None:
        """Mark states and links that have problems; id -> words."""
        if troubles != self.troubles:
            self.troubles = troubles
            self._stale()

    def _stale(self) -> None:
        self._still = None
        self.update()

    def _pictured(self, clip: str) -> None:
        self.pictures.forget(clip)
        self._settle.start()
        self._fast = True  # many come at once; they are drawn together
        self.update()

    def _reload(self) -> None:
        self._views.clear()
        self._anew = True

    _anew = False  # another project comes, to be seen whole

    def _edited(self, before: Project, after: Project) -> None:
        if self._anew:
            self._anew = False
            self._relayer()
        elif before.manual is not after.manual or before.clips is not after.clips:
            self._scene = None
            if len(self.scene().manual.links) > MANY:
                self._fast = True
                self._settle.start()
            self._stale()

    def _relayer(self) -> None:
        self._scene = None
        self.hand.drop("replaced")
        self.view = self._views.get(self.session.place.layer) or self.scene().first_view(QSizeF(self.size()))
        self._stale()
        self.viewed.emit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        if self.session.place.layer not in self._views:
            self.view = self.scene().first_view(QSizeF(self.size()))
        self._still = None

    # --- painting

    def _look(self, scene: ManualScene) -> painter.ManualLook:
        s = self.session
        pictures = self.pictures.of(scene, self.view, self.devicePixelRatioF())
        return painter.ManualLook(
            get_theme(s.look.name),
            self.document.project,
            scene,
            self.view,
            pictures,
            self.font(),
            s.selection.states,
            s.selection.links,
            self.troubles,
        )

    def paintEvent(self, event: QPaintEvent) -> None:
        scene, rect = self.scene(), QRectF(self.rect())
        look = self._look(scene)
        key = (
            scene,
            self.view,
            self.session.look.name,
            self.size(),
            frozenset(self._dragged),
            self._fast,
            self.pictures.count,
        )
        if self._still is None or self._still[0] != key:
            ratio = self.devicePixelRatioF()
            picture = QPixmap(self.size() * ratio)
            picture.setDevicePixelRatio(ratio)
            p = QPainter(picture)
            painter.paint_still(p, look, rect, tuple(self._dragged), self._fast)
            p.end()
            self._still = (key, picture)
        p = QPainter(self)
        p.drawPixmap(0, 0, self._still[1])
        if self._dragged:
            scene = ManualScene(scene.manual, self._dragged)
            look = self._look(scene)
        marks = ManualMarks(
            self._dragged,
            self.hover,
            *self._link,
            self._band,
            self._turn,
            self.at,
            self.hand.gesture is not None,
            self._dropping or self._link_words,
            self._map(),
        )
        paint_over(p, look, marks, QRectF(self.rect()))
        p.end()

    def _map(self) -> QRectF:
        return QRectF(
            self.width() - MAP.width() - 16, self.height() - MAP.height() - 16, MAP.width(), MAP.height()
        )

    def _follow_play(self) -> None:
        """Show which state plays and how far it is."""
        now = (
            find_playing_state(
                self.performance.shown, self.session.place.layer, self.session.transport.seconds
            )
            if self.isVisible()
            else ("", 0.0)
        )
        if now != self._turn:
            for ident in {now[0], self._turn[0]} & set(self.scene().nodes):
                box = self.scene().nodes[ident]
                rect = QRectF(self.view.to(box.topLeft()), self.view.to(box.bottomRight()))
                self.update(rect.adjusted(-4, -4, 4, 4).toAlignedRect())
            self._turn = now

    # --- mouse

    def show_cursor(self, shape: Qt.CursorShape) -> None:
        self.setCursor(shape)

    def refuse(self, words: str) -> None:
        """Say why something cannot be done."""
        self.refused.emit(words)

    def begin_link(self, source: str) -> None:
        """Draw a link from a node to where the mouse is pressed next: the menu's way."""
        self.hand.take(DrawLink(self, source, sticky=True), self.at)
        self.hand.move(self.at)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        at, button, keys = event.position(), event.button(), event.modifiers()
        self.at = at
        if self.hand.press(event):
            return
        self.hand.drop("replaced")
        if (
            button in (Qt.MouseButton.MiddleButton, Qt.MouseButton.RightButton)
            or keys & Qt.KeyboardModifier.AltModifier
        ):
            self.hand.take(ManualPan(self), at)
            return
        if button != Qt.MouseButton.LeftButton:
            return
        hit = self.scene().hit(self.view.back(at), self.view.scale)
        more = bool(keys & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier))
        s = self.session
        if hit.area == "edge" and not more:
            self.hand.take(DrawLink(self, hit.ident), at)
        elif hit.area in ("node", "edge"):
            if more and hit.ident != ANY:
                s.selection.select_states(_toggled(s.selection.states, hit.ident), s.selection.links)
            elif hit.ident != ANY and hit.ident not in s.selection.states:
                s.selection.select_states((hit.ident,))
            self.hand.take(Move(self, hit.ident), at)
        elif hit.area == "link":
            s.selection.select_states(
                s.selection.states if more else (),
                _toggled(s.selection.links, hit.ident) if more else (hit.ident,),
            )
        else:
            kept = (s.selection.states, s.selection.links) if more else ((), ())
            if not more:
                s.selection.select_states()
            self.hand.take(Band(self, kept), at)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self.at = event.position()
        if self.hand.move(self.at):
            return
        hit = self.scene().hit(self.view.back(self.at), self.view.scale)
        if hit.area == "edge" or hit != self.hover:
            self.hover = hit
            shape = {"edge": Qt.CursorShape.CrossCursor, "link": Qt.CursorShape.PointingHandCursor}.get(
                hit.area
            )
            self.setCursor(shape) if shape is not None else self.unsetCursor()
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.hand.release(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            return
        hit = self.scene().hit(self.view.back(event.position()), self.view.scale)
        alias = self.scene().manual.aliases.get(hit.ident)
        if alias is not None:
            self.hand.drop("replaced")
            self.session.selection.select_states(self.scene().manual.members(alias))
        elif hit.area in ("node", "edge", "link") and hit.ident != ANY:
            self.hand.drop("replaced")
            self.session.show_context(hit.ident)

    def leaveEvent(self, event: QEvent) -> None:
        if self.hover != NOTHING:
            self.hover = NOTHING
            self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:
        steps = event.angleDelta().y() / 120
        if steps:
            self.look_at(self.view.zoomed(1.18**steps, event.position()))
        event.accept()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            self.open_menu(self.at)
        event.accept()  # the mouse's comes when the button is let go, since dragging with it moves the view

    def open_menu(self, at: QPointF) -> None:
        """Offer what can be done with what is there."""
        self.at = at
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        commands.fill_canvas_menu(menu, self, self.scene().hit(self.view.back(at), self.view.scale))
        menu.popup(self.mapToGlobal(at.toPoint()))

    # --- edits

    def do(self, text: str, edit: Callable[[Project], Project]) -> bool:
        """Make an edit, or say why it cannot be made; return whether it was."""
        try:
            self.document.edit(text, edit)
        except EditError as error:
            self.refused.emit(tr_error(error))
            return False
        return True

    def add_links(self, sources: tuple[str, ...], targets: tuple[str, ...]) -> None:
        """Draw a link from each source to each target, and select what was drawn."""
        layer = self.session.place.layer
        if len(sources) == len(targets) == 1:
            self.do_links(tr("Draw link"), lambda p: manual_edits.add_link(p, layer, sources[0], targets[0]))
        else:
            self.do_links(tr("Draw links"), lambda p: manual_edits.add_links(p, layer, sources, targets))

    def do_links(self, text: str, edit: Callable[[Project], Project]) -> None:
        """Make an edit that draws links, and select those."""
        before = set(self.scene().manual.links)
        if self.do(text, edit):
            self.session.selection.select_states(
                (), tuple(i for i in self.scene().manual.links if i not in before)
            )

    def place(self, clips: tuple[str, ...], at: QPointF) -> None:
        """Make states of clips, the first under a point of the widget, and select them."""
        layer, before = self.session.place.layer, set(self.scene().manual.states)
        corner = self.view.back(at) - QPointF(NODE.width() / 2, NODE.height() / 2)
        x, y = round(corner.x() / 8) * 8, round(corner.y() / 8) * 8
        words = tr("Place {clips}", clips=count_clips(len(clips)))
        self._views.setdefault(layer, self.view)
        if self.do(words, lambda p: manual_edits.add_states(p, clips, layer, x, y)):
            self.session.selection.select_states(
                tuple(i for i in self.scene().manual.states if i not in before)
            )
            self.session.transport.show_plan()

    def find_states(self) -> None:
        self.find_wanted.emit()

    # --- drops

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        load = load_of(event.mimeData())
        if load.clips or load.files:
            event.acceptProposedAction()
        else:
            event.ignore()

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        possible, self._dropping = commands.drop_words(self.document.project, load_of(event.mimeData()))
        event.acceptProposedAction() if possible else event.ignore()
        self.update()

    def dragLeaveEvent(self, event: QEvent) -> None:
        self._dropping = ""
        self.update()

    def dropEvent(self, event: QDropEvent) -> None:
        self._dropping = ""
        self.update()
        load = load_of(event.mimeData())
        event.acceptProposedAction()
        if load.clips:
            self.place(load.clips, QPointF(event.position()))
        elif load.files and all(manual_many.is_link_table(Path(f)) for f in load.files):
            for file in load.files:
                manual_many.import_table(self, Path(file))
        elif load.files:
            self.files_dropped.emit(load.files, QPointF(event.position()))

    # --- keyboard and tips

    def event(self, event: QEvent) -> bool:
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and commands.find_key_command(self, event) is not None
        ):
            event.accept()  # before the window's own shortcuts
            return True
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            hit = self.scene().hit(self.view.back(QPointF(event.pos())), self.view.scale)
            QToolTip.showText(event.globalPos(), commands.describe_canvas_hit(self, hit), self)
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        run = commands.find_key_command(self, event)
        if run is not None:
            run()
        elif event.matches(QKeySequence.StandardKey.Cancel):
            self.session.transport.show_plan()
        else:
            super().keyPressEvent(event)


def _toggled(chosen: tuple[str, ...], ident: str) -> tuple[str, ...]:
    return tuple(i for i in chosen if i != ident) if ident in chosen else (*chosen, ident)
