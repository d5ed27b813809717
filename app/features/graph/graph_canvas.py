"""The canvas widget: turns events into hits, gestures and edits. Layout, painting and drops are pure and live
beside it.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

from PySide6.QtCore import QEvent, QPointF, QRectF, QSizeF, Qt, Signal
from PySide6.QtGui import (
    QAction,
    QContextMenuEvent,
    QDragEnterEvent,
    QDragLeaveEvent,
    QDragMoveEvent,
    QDropEvent,
    QFontMetricsF,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QToolTip, QWidget

from app.features.graph.drags.chip import ChipDrag
from app.features.graph.drags.head import HeadDrag
from app.features.graph.drags.likelihood import LikelihoodDrag
from app.features.graph.drags.row import RowDrag
from app.features.graph.graph_acts import GraphActs
from app.features.graph.graph_drops import Drop
from app.features.graph.graph_hover import Hover
from app.features.graph.graph_layout import (
    HOLES,
    LEAST_HEIGHT,
    LEAST_WIDTH,
    GraphHit,
    Layout,
    lay_out_canvas,
    measure_least_canvas_height,
)
from app.features.graph.graph_look import NOWHERE, GraphLook
from app.features.graph.graph_menus import make_ends_menu, make_menu_for
from app.features.graph.graph_painter import paint_graph
from app.features.graph.graph_parts import Parts, find_stale_region, list_graph_parts
from app.features.graph.graph_pictures import Beat, GraphPictures, find_graph_pictures
from app.features.graph.graph_spoken import list_graph_items
from app.features.graph.graph_words import count_machine, describe_graph_hit, describe_same_stances
from app.look.theme import get_theme
from app.project.document import Document
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from app.translation import tr, tr_noop
from app.widgets.gesture import PointerHand
from app.widgets.memo import Once
from app.widgets.mime import load_of
from app.widgets.soon import Soon
from app.widgets.spoken_items import SpokenItem, tell_spoken_change, tell_spoken_focus
from metagraph.graph.model import Kind, Project, Stance
from metagraph.graph.same_stances import find_same_stances

KEYS = tr_noop(
    "The actions of each node. Up and Down select an action, Left and Right lower or raise "
    "its likelihood, Enter shows its properties."
)


class Canvas(QWidget):
    """The meta-graph of the current layer. files_dropped: (paths, drop) to import and then place. acts: what
    it does to the graph.
    """

    files_dropped = Signal(object, object)

    def __init__(
        self,
        document: Document,
        session: StageSession,
        performance: StagePerformance,
        thumbnails: Thumbnails,
        parent: QWidget | None = None,
    ):
        super().__init__(parent)
        self.document, self.session = document, session
        self.performance, self.thumbnails = performance, thumbnails
        self.acts = GraphActs(document, session, self)
        self.hand = PointerHand()
        self.first_rows: dict[Kind, int] = {}  # in sight of scrolled nodes
        self.row_actions: list[QAction] = []  # the window's commands that go into an action's menu
        self.hover = Hover(session, lambda: self._drop_hit if self.drop is not None else None, self)
        self.focus: str | None = None
        self.fresh: tuple[str, ...] = ()  # actions just made by a key
        self.misfits: dict[str, str] = {}
        self.drop: Drop | None = None  # what letting go of what is dragged would do
        self._drop_hit = NOWHERE
        self._drop_at: QPointF | None = None  # where something is held over it
        self.arrow: tuple[QPointF, QPointF] | None = None  # of a transition, being dragged
        self.mark: QRectF | None = None  # where a stance that is dragged would be listed
        self._layout: Layout | None = None
        self._counted: Once[str] = Once()  # the sentence about the graphs
        self._sames: Once[Mapping[str, tuple[Stance, ...]]] = Once()
        self._played: frozenset[str] = frozenset()  # as last drawn
        self._drawn: Parts = {}  # as last painted
        self._soon = Soon(self._refresh, self)
        self.setMouseTracking(True)
        self.setAcceptDrops(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(int(LEAST_WIDTH), int(LEAST_HEIGHT))  # its height follows its width
        self.setAccessibleName(tr("Meta-graph"))
        self.setAccessibleDescription(tr(KEYS))
        self._beat = Beat(self._next_beat, self)
        self._beat.run(session.transport.playing)
        session.transport.playing_changed.connect(lambda: self._beat.run(session.transport.playing))
        session.transport.moved.connect(lambda _: None if session.transport.playing else self._next_beat())
        document.changed.connect(self._edited)
        document.loaded.connect(lambda: self.reveal(()))
        for signal in (session.place.stance_changed, session.place.layer_changed):
            signal.connect(self._moved_on)
        session.selection.changed.connect(self._selected)
        session.look.changed.connect(self.update)
        thumbnails.ready.connect(lambda _: self.update())
        performance.changed.connect(self._soon.ask)

    # --- layout and painting

    def layout_now(self) -> Layout:
        """Return the layout, made when first asked for after a change."""
        if self._layout is None:
            metrics = QFontMetricsF(self.font())
            project, place = self.document.project, self.session.place
            names = [s.name for s in project.graphs[place.layer].stances.values()]
            same = describe_same_stances(self._same())
            widths = {text: metrics.horizontalAdvance(text) for text in (*names, *HOLES, *same.values())}
            size, rows = QSizeF(self.size()), self.first_rows
            self._layout = lay_out_canvas(project, place.layer, place.stance(), size, rows, widths, same)
        return self._layout

    def _stale(self) -> None:
        self._layout = None
        self.update()

    def _refresh(self) -> None:
        """Let what is drawn otherwise than it was painted be painted again."""
        if not self.isVisible():
            return  # when it is shown, all of it is painted
        region = find_stale_region(
            self._drawn, list_graph_parts(self.layout_now(), self._look(GraphPictures()))
        )
        if region is None:
            self.update()
        elif not region.isEmpty():
            self.update(region)

    def resizeEvent(self, event: object) -> None:
        self.setMinimumHeight(int(measure_least_canvas_height(self.width())))
        self._stale()
        self._selected()

    def paintEvent(self, event: QPaintEvent) -> None:
        begun = time.perf_counter()
        self._soon.now()  # else what an edit changed elsewhere would be taken for painted with this part
        layout, graph = self.layout_now(), self.document.project.graphs[self.session.place.layer]
        look = self._look(find_graph_pictures(self.thumbnails, layout, graph, self._beat.count))
        painter = QPainter(self)
        paint_graph(painter, layout, look, self.font(), event.region())
        painter.end()
        # Whatever else is drawn otherwise has asked to be painted, too.
        self._drawn = list_graph_parts(layout, look)
        self._beat.drawn(time.perf_counter() - begun)

    def _look(self, pictures: GraphPictures) -> GraphLook:
        """Return what is drawn besides the layout."""
        return GraphLook(
            theme=get_theme(self.session.look.name),
            project=self.document.project,
            selected=self.session.selection.actions,
            fresh=self.fresh,
            hover=self.hover.hit,
            focus=self.focus if self.hasFocus() else None,
            playing=self._playing(),
            misfits=self.misfits,
            picture=pictures.hero,
            chip_pictures=pictures.chips,
            row_pictures=pictures.rows,
            other=self.session.place.other(),
            drop=self.drop,
            drop_hit=self._drop_hit,
            drop_at=self._drop_at,
            arrow=self.arrow,
            mark=self.mark,
            same=self._same(),
            sentence=self._sentence(),
        )

    def _sentence(self) -> str:
        """What a drop outside the nodes would do, else how large the machine is."""
        if self.drop is not None and self._drop_hit.area in ("chip", "add", "nothing"):
            words = self.drop.words.replace("*", "")
            return words[:1].upper() + words[1:]
        project = self.document.project
        return self._counted.of((), (project.graphs,), lambda: count_machine(project))

    def _same(self) -> Mapping[str, tuple[Stance, ...]]:
        """The stances of other layers that are one posture with a stance of this layer, by its id."""
        project, layer = self.document.project, self.session.place.layer
        return self._sames.of((layer,), (project.graphs,), lambda: find_same_stances(project, layer))

    def _playing(self) -> frozenset[str]:
        plan = self.performance.shown.plan
        cue = plan.layers[self.session.place.layer].cue_at(self.session.transport.seconds)
        return frozenset({cue.action.id}) if cue is not None else frozenset()

    def _next_beat(self) -> None:
        """Let the stance move, and mark what plays now."""
        if self.isVisible() and self.session.place.stance() is not None:
            self.update(self.layout_now().card.toAlignedRect())
            now = self._playing()
            if now != self._played:
                self._played = now
                for node in self.layout_now().nodes.values():
                    self.update(node.rect.toAlignedRect())

    def point(
        self,
        drop: Drop | None,
        hit: GraphHit,
        arrow: tuple[QPointF, QPointF] | None,
        mark: QRectF | None = None,
    ) -> None:
        """Show an arrow that is being dragged, or a mark between two stances, and what letting go would do;
        or none any more.
        """
        self.drop, self._drop_hit, self.arrow, self.mark = drop, hit, arrow, mark
        self.update()

    def stop(self) -> None:
        """Let nothing move any more; at closing."""
        self._beat.stop()

    def set_misfits(self, misfits: dict[str, str]) -> None:
        """Mark actions whose ends do not fit; action id -> words."""
        self.misfits = misfits
        self._soon.ask()

    def _selected(self) -> None:
        """Bring what was selected elsewhere in sight, too."""
        if len(self.session.selection.actions) == 1:
            self._scroll_to(self.session.selection.actions[0])
        self._soon.ask()

    def _edited(self, before: Project, after: Project) -> None:
        if before.graphs is not after.graphs:
            self._layout = None
            tell_spoken_change(self)
        if before.clips is not after.clips:  # pictures may be others
            self.update()
        else:
            self._soon.ask()

    def _moved_on(self) -> None:
        self.first_rows.clear()
        self._stale()
        tell_spoken_change(self)

    @property
    def widget(self) -> QWidget:
        return self

    def end_in(self, actions: Sequence[str], stance: str) -> None:
        self.acts.end_in(actions, stance)

    def merge(self, merged: str, into: str) -> None:
        self.acts.merge(merged, into)

    def list_stance(self, stance: str, before: str | None) -> None:
        self.acts.list_stance(stance, before)

    def refuse(self, words: str) -> None:
        self.acts.refused.emit(words)

    # --- for screen readers

    def list_spoken_items(self) -> Sequence[SpokenItem]:
        return list_graph_items(self.layout_now(), self._look(GraphPictures()), self.misfits)

    # --- mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        self.hover.timer.stop()
        hit = self.layout_now().hit(event.position())
        if event.button() != Qt.MouseButton.LeftButton:
            return
        if hit.area == "chip" and hit.ident:
            self.acts.show_stance(hit.ident)
            self.hand.take(ChipDrag(self, hit.ident), event.position())
        elif hit.area == "add":
            self.acts.new_stance()
        elif hit.area == "find":
            self.acts.find_stance()
        elif hit.area == "other":
            make_ends_menu(self.acts).exec(event.globalPosition().toPoint())
        elif hit.area == "bar" and hit.ident:
            self.hand.take(LikelihoodDrag(self, hit.ident), event.position())
        elif hit.area in ("row", "head") and hit.ident:
            self._press_row(hit.ident, event)
            if hit.area == "head":
                self.hand.take(HeadDrag(self, hit.ident), event.position())
        elif hit.area == "card" and hit.ident:
            self.session.selection.select_actions(tuple(a.id for a in self.acts.loops()))
        else:
            self.session.selection.select_actions(())

    def _press_row(self, action: str, event: QMouseEvent) -> None:
        keys, held = Qt.KeyboardModifier, event.modifiers()
        self.acts.select(
            action, bool(held & keys.ControlModifier), self.focus if held & keys.ShiftModifier else None
        )
        self.focus = action
        self.hand.take(RowDrag(self, action), event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton and self.hand.move(event.position()):
            return
        hit = self.layout_now().hit(event.position())
        self.hover.move(hit)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.hand.release(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        hit = self.layout_now().hit(event.position())
        if hit.area in ("chip", "card") and hit.ident:
            self.acts.rename_stance(hit.ident)

    def leaveEvent(self, event: QEvent) -> None:
        self.hover.move(NOWHERE)

    def wheelEvent(self, event: QWheelEvent) -> None:
        for kind, node in self.layout_now().nodes.items():
            if node.rect.contains(event.position()) and node.most:
                step = -1 if event.angleDelta().y() > 0 else 1
                self.first_rows[kind] = min(node.most, max(0, node.scroll + step))
                self._stale()
                event.accept()
                return
        event.ignore()

    def event(self, event: QEvent) -> bool:
        escapes = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape
        if event.type() == QEvent.Type.ShortcutOverride and escapes and self.hand.gesture is not None:
            event.accept()  # cancels the drag rather than what the preview shows
            return True
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            hit = self.layout_now().hit(QPointF(event.pos()))
            project, other = self.document.project, self.session.place.other()
            words = describe_graph_hit(project, self.layout_now(), hit, other, self.misfits, self._same())
            QToolTip.showText(event.globalPos(), words, self)
            return True
        return super().event(event)

    # --- drops

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if load_of(event.mimeData()):
            event.acceptProposedAction()
        else:
            event.ignore()

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        at = QPointF(event.position())
        hit = self.layout_now().hit(at, dragging=True)
        if hit != self._drop_hit and hit.area == "chip":
            self.hover.timer.start()
        self._drop_hit, self._drop_at = hit, at
        self.drop = self.acts.what(hit, load_of(event.mimeData()))
        if self.drop.possible:
            move, copy = Qt.DropAction.MoveAction, Qt.DropAction.CopyAction
            event.setDropAction(move if event.possibleActions() & move else copy)
            event.accept()
        else:
            event.ignore()
        self.update()

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        self._end_drag()

    def _end_drag(self) -> None:
        self.drop, self._drop_hit, self._drop_at = None, NOWHERE, None
        self.hover.timer.stop()
        self.update()

    def dropEvent(self, event: QDropEvent) -> None:
        load = load_of(event.mimeData())
        drop = self.acts.what(self.layout_now().hit(QPointF(event.position()), dragging=True), load)
        self._end_drag()
        if not drop.possible:
            self.acts.refused.emit(drop.words)
            event.ignore()
            return
        event.acceptProposedAction()
        if load.files:
            self.files_dropped.emit(load.files, drop)
        else:
            self.acts.do(drop, load)

    def reveal(self, actions: Sequence[str]) -> None:
        """Bring actions in sight, and mark them until something else is selected than now."""
        self.fresh = tuple(actions)
        for ident in actions[:1]:
            self._scroll_to(ident)
        self.update()

    # --- keyboard

    def keyPressEvent(self, event: QKeyEvent) -> None:
        loops, listed = self.acts.loops(), [*self.acts.loops(), *self.acts.listed()]
        ids = [a.id for a in listed]
        key = event.key()
        step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(Qt.Key(key))
        if step is not None and ids:
            first = min(len(loops), len(ids) - 1)  # the loops are above the first row
            place = (
                ids.index(self.focus) + step if self.focus in ids else (first if step > 0 else len(ids) - 1)
            )
            self._focus_on(
                ids[min(len(ids) - 1, max(0, place))],
                bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier),
            )
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Right) and self.focus in ids:
            self.acts.nudge_likelihood(str(self.focus), 0.1 if key == Qt.Key.Key_Right else -0.1)
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.focus in ids:
            self.session.show_context(str(self.focus))
        elif key != Qt.Key.Key_Escape or not self.hand.drop("escape"):
            super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Left, Qt.Key.Key_Right) and not event.isAutoRepeat():
            self.document.finish_merging()  # a key held down is one step
        super().keyReleaseEvent(event)

    def _focus_on(self, action: str, extend: bool) -> None:
        self.focus = action
        kept = self.session.selection.actions if extend else ()
        self.session.selection.select_actions((*(i for i in kept if i != action), action))
        self._scroll_to(action)
        tell_spoken_focus(self)

    def _scroll_to(self, action: str) -> None:
        found = self.document.project.action(action)
        node = self.layout_now().nodes.get(found.kind) if found is not None else None
        if node is not None and found is not None and self.layout_now().row(action) is None:
            ids = [a.id for a in self.document.project.graphs[found.layer].of(found.stance, found.kind)]
            self.first_rows[found.kind] = ids.index(action) // node.columns
            self._stale()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        hit = self.layout_now().hit(QPointF(event.pos()))
        make_menu_for(self.acts, hit, self.row_actions).exec(event.globalPos())
