"""The canvas widget: turns events into hits, gestures and edits. Layout, painting and drops are pure and live
beside it.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import QEvent, QPoint, QPointF, QSizeF, Qt, QTimer, Signal
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
from PySide6.QtWidgets import QInputDialog, QMenu, QToolTip, QWidget

from app.features.graph.graph_drops import Drop, drop_at, perform
from app.features.graph.graph_gestures import HeadDrag, LikelihoodDrag, RowDrag
from app.features.graph.graph_layout import (
    LEAST_HEIGHT,
    LEAST_WIDTH,
    GraphHit,
    Layout,
    arrange,
    least_height,
)
from app.features.graph.graph_painter import GraphLook, paint
from app.look.names import told_names
from app.look.plural import many
from app.look.theme import theme
from app.project.document import Document
from app.project.load import Load
from app.stage.performance import Performance
from app.stage.session import Session
from app.stage.thumbnails import Thumbnails
from app.widgets.gesture import Hand
from app.widgets.mime import load_of
from metagraph.graph import edits
from metagraph.graph.expand import size
from metagraph.graph.model import KINDS, LAYERS, Action, Kind, Project

NOTHING = GraphHit("nothing")
HOVER = 350  # milliseconds over a row before it plays, over a chip during a drag before it becomes current
HERO_RATE = 12  # pictures a second of the stance in the middle
SLOW = 0.015  # seconds of drawing for each of which a picture of it is left out


class Canvas(QWidget):
    """The meta-graph of the current layer. files_dropped: (paths, drop) to import and then place. refused:
    words for the status bar. labelled: clips were placed by a key; (clips, the actions made of them).
    """

    labelled = Signal(object, object)
    files_dropped = Signal(object, object)
    refused = Signal(str)

    def __init__(
        self,
        document: Document,
        session: Session,
        performance: Performance,
        thumbnails: Thumbnails,
        parent: QWidget | None = None,
    ):
        super().__init__(parent)
        self.document, self.session, self.performance, self.thumbnails = (
            document,
            session,
            performance,
            thumbnails,
        )
        self.hand = Hand()
        self.first_rows: dict[Kind, int] = {}  # in sight of scrolled nodes
        self.row_actions: list[QAction] = []  # the window's commands that go into an action's menu
        self.hover = NOTHING
        self.focus: str | None = None
        self.fresh: tuple[str, ...] = ()  # actions just made by a key
        self.misfits: dict[str, str] = {}
        self._drop: Drop | None = None
        self._drop_hit = NOTHING
        self._arrow: tuple[QPointF, QPointF] | None = None  # of a transition, being dragged
        self._layout: Layout | None = None
        self._counted: tuple[object, str] | None = None  # the graphs, and the sentence about them
        self._beat = 0
        self._rest = 0  # beats to leave out
        self._played: frozenset[str] = frozenset()  # as last drawn
        self.setMouseTracking(True)
        self.setAcceptDrops(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(int(LEAST_WIDTH), int(LEAST_HEIGHT))  # its height follows its width
        self.setAccessibleName("Meta-graph")
        self._hover_timer = QTimer(self, singleShot=True, interval=HOVER)
        self._hover_timer.timeout.connect(self._hovered_long)
        self._hero_timer = QTimer(self, interval=1000 // HERO_RATE)
        self._hero_timer.timeout.connect(self._next_beat)
        self._hero_timer.start()
        document.changed.connect(self._edited)
        document.loaded.connect(lambda: self.reveal(()))
        for signal in (session.place.stance_changed, session.place.layer_changed):
            signal.connect(self._moved_on)
        session.selection.changed.connect(self._selected)
        session.look.changed.connect(self.update)
        thumbnails.ready.connect(lambda _: self.update())
        performance.changed.connect(self.update)

    # --- layout and painting

    def layout_now(self) -> Layout:
        """Return the layout, made when first asked for after a change."""
        if self._layout is None:
            metrics = QFontMetricsF(self.font())
            project, layer, stance = (
                self.document.project,
                self.session.place.layer,
                self.session.place.stance(),
            )
            names = [s.name for s in project.graphs[layer].stances.values()]
            widths = {
                text: metrics.horizontalAdvance(text)
                for text in (*names, "no fidgets", "no gestures", "no way out", "no loop")
            }
            self._layout = arrange(project, layer, stance, QSizeF(self.size()), self.first_rows, widths)
        return self._layout

    def _stale(self) -> None:
        self._layout = None
        self.update()

    def resizeEvent(self, event: object) -> None:
        self.setMinimumHeight(int(least_height(self.width())))
        self._stale()
        self._selected()

    def paintEvent(self, event: QPaintEvent) -> None:
        begun = time.perf_counter()
        look = theme(self.session.look.name)
        project, stance = self.document.project, self.session.place.stance()
        graph = project.graphs[self.session.place.layer]
        hero = next(iter(graph.of(stance, "stance")), None) if stance else None
        chips = {}
        for ident in graph.stances:
            loop = next(iter(graph.of(ident, "stance")), None)
            picture = self.thumbnails.picture(loop.clip, bare=True) if loop is not None else None
            if picture is not None:
                chips[ident] = picture
        rows = (row for node in self.layout_now().nodes.values() for row in node.rows)
        clips = {row.action.clip for row in rows if not row.picture.isEmpty()}
        found = {clip: self.thumbnails.picture(clip, bare=True) for clip in clips}
        painter = QPainter(self)
        paint(
            painter,
            self.layout_now(),
            GraphLook(
                theme=look,
                project=project,
                selected=self.session.selection.actions,
                fresh=self.fresh,
                hover=self.hover,
                focus=self.focus if self.hasFocus() else None,
                playing=self._playing(),
                misfits=self.misfits,
                picture=self.thumbnails.moving(hero.clip, self._beat) if hero is not None else None,
                chip_pictures=chips,
                row_pictures={clip: picture for clip, picture in found.items() if picture is not None},
                other=self.session.place.other(),
                drop=self._drop,
                drop_hit=self._drop_hit,
                drop_at=self._drop_at,
                arrow=self._arrow,
                sentence=self._sentence(),
            ),
            self.font(),
            event.region(),
        )
        painter.end()
        self._rest = min(HERO_RATE, int((time.perf_counter() - begun) / SLOW))

    def _sentence(self) -> str:
        """What a drop outside the nodes would do, else how large the machine is."""
        if self._drop is not None and self._drop_hit.area in ("chip", "add", "nothing"):
            words = self._drop.words.replace("*", "")
            return words[:1].upper() + words[1:]
        graphs = self.document.project.graphs
        if self._counted is None or self._counted[0] is not graphs:
            self._counted = graphs, sentence(self.document.project)
        return self._counted[1]

    def _playing(self) -> frozenset[str]:
        plan = self.performance.shown.plan
        cue = plan.layers[self.session.place.layer].cue_at(self.session.transport.seconds)
        return frozenset({cue.action.id}) if cue is not None else frozenset()

    def _next_beat(self) -> None:
        if self._rest > 0:  # jobs keep the processor busy: the stance moves more slowly, the window does not
            self._rest -= 1
            return
        self._beat += 1
        if self.isVisible() and self.session.place.stance() is not None:
            self.update(self.layout_now().card.toAlignedRect())
            now = self._playing()
            if now != self._played:
                self._played = now
                for node in self.layout_now().nodes.values():
                    self.update(node.rect.toAlignedRect())

    def point(self, drop: Drop | None, hit: GraphHit, arrow: tuple[QPointF, QPointF] | None) -> None:
        """Show an arrow that is being dragged, and what letting it go would do; or none any more."""
        self._drop, self._drop_hit, self._arrow = drop, hit, arrow
        self.update()

    def stop(self) -> None:
        """Let nothing move any more; at closing."""
        self._hero_timer.stop()

    def set_misfits(self, misfits: dict[str, str]) -> None:
        """Mark actions whose ends do not fit; action id -> words."""
        self.misfits = misfits
        self.update()

    def _selected(self) -> None:
        """Bring what was selected elsewhere in sight, too."""
        if len(self.session.selection.actions) == 1:
            self._scroll_to(self.session.selection.actions[0])
        self.update()

    def _edited(self, before: Project, after: Project) -> None:
        if before.graphs is not after.graphs:
            self._stale()
        else:
            self.update()

    def _moved_on(self) -> None:
        self.first_rows.clear()
        self._stale()

    @property
    def widget(self) -> QWidget:
        return self

    def refuse(self, words: str) -> None:
        """Say why something cannot be done."""
        self.refused.emit(words)

    # --- mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        self._hover_timer.stop()
        hit = self.layout_now().hit(event.position())
        if event.button() != Qt.MouseButton.LeftButton:
            return
        if hit.area == "chip" and hit.ident:
            self.session.place.set_stance(hit.ident)
        elif hit.area == "add":
            self.new_stance()
        elif hit.area == "other":
            self._choose_other(event.globalPosition().toPoint())
        elif hit.area == "bar" and hit.ident:
            self.hand.take(LikelihoodDrag(self, hit.ident), event.position())
        elif hit.area in ("row", "head") and hit.ident:
            self._press_row(hit.ident, event)
            if hit.area == "head":
                self.hand.take(HeadDrag(self, hit.ident), event.position())
        elif hit.area == "card" and hit.ident:
            self.session.selection.select_actions(
                tuple(
                    a.id
                    for a in self.document.project.graphs[self.session.place.layer].of(hit.ident, "stance")
                )
            )
        else:
            self.session.selection.select_actions(())

    def _press_row(self, action: str, event: QMouseEvent) -> None:
        chosen = self.session.selection.actions
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self.session.selection.select_actions(
                tuple(i for i in chosen if i != action) if action in chosen else (*chosen, action)
            )
        elif event.modifiers() & Qt.KeyboardModifier.ShiftModifier and self.focus:
            ids = [a.id for a in self.listed()]
            if self.focus in ids and action in ids:
                a, b = sorted((ids.index(self.focus), ids.index(action)))
                self.session.selection.select_actions(tuple(ids[a : b + 1]))
        elif action not in chosen:
            self.session.selection.select_actions((action,))
        self.focus = action
        self.hand.take(RowDrag(self, action), event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton and self.hand.move(event.position()):
            return
        hit = self.layout_now().hit(event.position())
        if hit != self.hover:
            self._set_hover(hit)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        gesture = self.hand.let_go(event.position())
        if gesture is not None:
            hit = self.layout_now().hit(event.position())
            plain = not event.modifiers() & (
                Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
            )
            if (
                isinstance(gesture, RowDrag | HeadDrag)
                and not gesture.begun
                and plain
                and hit.ident == gesture.action
            ):
                self._hover_shown = False  # asked for: it goes on when the pointer leaves
                self.session.selection.select_actions((gesture.action,))
                self.session.show_context(gesture.action)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        hit = self.layout_now().hit(event.position())
        if hit.area in ("chip", "card") and hit.ident:
            self.rename_stance(hit.ident)

    def _set_hover(self, hit: GraphHit) -> None:
        rows = ("row", "head")
        left = self.hover.area in rows and hit.area not in rows
        self.hover = hit
        hand = hit.area in ("chip", "add", "other", "row", "bar", "card", "head")
        self.setCursor(
            Qt.CursorShape.SizeHorCursor
            if hit.area == "bar"
            else Qt.CursorShape.PointingHandCursor
            if hand
            else Qt.CursorShape.ArrowCursor
        )
        if hit.area in rows:
            self._hover_timer.start()
        else:
            self._hover_timer.stop()
            if left and self._hover_shown:
                self._hover_shown = False
                self.session.transport.show_plan()
        self.update()

    _hover_shown = False
    _drop_at: QPointF | None = None  # where something is held over it

    def _hovered_long(self) -> None:
        if self._drop is not None:
            if self._drop_hit.area == "chip" and self._drop_hit.ident:
                self.session.place.set_stance(self._drop_hit.ident)
        elif (
            self.hover.area in ("row", "head") and self.hover.ident and self.session.transport.show != "clip"
        ):
            self._hover_shown = self.session.transport.show == "plan" or self._hover_shown
            self.session.show_context(self.hover.ident)

    def leaveEvent(self, event: QEvent) -> None:
        self._set_hover(NOTHING)

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
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and self.hand.gesture is not None
            and event.key() == Qt.Key.Key_Escape
        ):
            event.accept()  # cancels the drag rather than what the preview shows
            return True
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            hit = self.layout_now().hit(QPointF(event.pos()))
            QToolTip.showText(event.globalPos(), self._tip(hit), self)
            return True
        return super().event(event)

    def _tip(self, hit: GraphHit) -> str:
        project = self.document.project
        action = project.action(hit.ident) if hit.ident else None
        if hit.area == "bar" and action is not None:
            return f"Likelihood {action.likelihood:g}: drag to change"
        if action is not None:
            row = self.layout_now().row(action.id)
            name = told_names(row.words if row is not None else action.name, action.name)
            head = "Drag the arrow onto another stance to end there"
            plain = head if hit.area == "head" else "Click plays it in context, drag moves it"
            note = project.notes.get(action.id, "")
            return "\n".join(x for x in (name, note, self.misfits.get(action.id) or plain) if x)
        stance = project.stance(self.session.place.other() if hit.area == "other" else hit.ident)
        to = "to " if hit.area == "other" else ""
        name = f"{to}{stance.name}\n" if stance is not None else ""
        words = {
            "chip": "Click to make this the current stance",
            "card": "Click selects its loops, double-click renames it",
            "add": "New stance: drop a clip here, or click",
            "other": "The stance that dropped transitions end in",
        }.get(hit.area, "")
        return f"{name}{words}" if words else ""

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
            self._hover_timer.start()
        self._drop_hit, self._drop_at = hit, at
        self._drop = self._what(hit, load_of(event.mimeData()))
        if self._drop.possible:
            event.setDropAction(
                Qt.DropAction.MoveAction
                if event.possibleActions() & Qt.DropAction.MoveAction
                else Qt.DropAction.CopyAction
            )
            event.accept()
        else:
            event.ignore()
        self.update()

    def _what(self, hit: GraphHit, load: Load) -> Drop:
        return drop_at(
            self.document.project,
            self.session.place.layer,
            self.session.place.stance(),
            self.session.place.other(),
            hit,
            load,
        )

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        self._end_drag()

    def _end_drag(self) -> None:
        self._drop, self._drop_hit, self._drop_at = None, NOTHING, None
        self._hover_timer.stop()
        self.update()

    def dropEvent(self, event: QDropEvent) -> None:
        load = load_of(event.mimeData())
        drop = self._what(self.layout_now().hit(QPointF(event.position()), dragging=True), load)
        self._end_drag()
        if not drop.possible:
            self.refused.emit(drop.words)
            event.ignore()
            return
        event.acceptProposedAction()
        if load.files:
            self.files_dropped.emit(load.files, drop)
        else:
            self.do(drop, load)

    def do(self, drop: Drop, load: Load) -> None:
        """Perform a drop and select what it made."""
        before = {a.id for a in self.document.project.actions()}
        layer = self.session.place.layer
        verb = "Move" if load.actions else "Place"
        noun = f"{load.count} {'action' if load.actions else 'clip'}{'s' if load.count != 1 else ''}"
        try:
            self.document.edit(f"{verb} {noun}", lambda p: perform(p, layer, drop, load))
        except edits.EditError as error:
            self.refused.emit(str(error))
            return
        made = tuple(a.id for a in self.document.project.actions() if a.id not in before) or load.actions
        if drop.kind in ("stance", None) and made:
            action = self.document.project.action(made[0])
            if action is not None:
                self.session.place.set_stance(action.stance)
        self.session.selection.select_actions(made)
        self.session.transport.show_plan()

    def place_selection(self, kind: Kind) -> None:
        """Label the selection, clips or actions, with a kind on the current stance: the keys 1 to 4."""
        load = Load(clips=self.session.selection.clips, actions=self.session.selection.actions)
        if not load:
            self.refused.emit("Select clips or actions first.")
            return
        stance = self.session.place.stance()
        new = kind == "stance" and bool(load.clips)
        hit = (
            GraphHit("card", stance, "stance")
            if new
            else GraphHit("loop", stance, "stance")
            if kind == "stance"
            else GraphHit("node", None, kind)
        )
        drop = self._what(hit, load)
        if not drop.possible:
            self.refused.emit(drop.words)
            return
        before = self.document.project
        self.do(drop, load)
        if load.clips and self.document.project is not before:
            self.labelled.emit(load.clips, self.session.selection.actions)

    def reveal(self, actions: Sequence[str]) -> None:
        """Bring actions in sight, and mark them until something else is selected than now."""
        self.fresh = tuple(actions)
        for ident in actions[:1]:
            self._scroll_to(ident)
        self.update()

    # --- keyboard

    def listed(self) -> list[Action]:
        """The actions of the current stance, in the order of the nodes."""
        stance = self.session.place.stance()
        graph = self.document.project.graphs[self.session.place.layer]
        return [a for kind in KINDS[1:] for a in (graph.of(stance, kind) if stance else ())]

    def keyPressEvent(self, event: QKeyEvent) -> None:
        stance = self.session.place.stance()
        loops = self.document.project.graphs[self.session.place.layer].of(stance, "stance") if stance else ()
        listed = [*loops, *self.listed()]
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
            likelihood = next(a for a in listed if a.id == self.focus).likelihood
            value = round(min(3.0, max(0.1, likelihood + (0.1 if key == Qt.Key.Key_Right else -0.1))), 1)
            chosen = self.session.selection.actions or (self.focus,)
            self.document.edit(
                "Change likelihood",
                lambda p: edits.update_actions(p, chosen, likelihood=value),
                merge="likelihood keys",
            )
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

    def _scroll_to(self, action: str) -> None:
        found = self.document.project.action(action)
        node = self.layout_now().nodes.get(found.kind) if found is not None else None
        if node is not None and found is not None and self.layout_now().row(action) is None:
            ids = [a.id for a in self.document.project.graphs[found.layer].of(found.stance, found.kind)]
            self.first_rows[found.kind] = ids.index(action) // node.columns
            self._stale()

    # --- menus and dialogs

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        hit = self.layout_now().hit(QPointF(event.pos()))
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        if hit.area in ("row", "bar", "head") and hit.ident:
            if hit.ident not in self.session.selection.actions:
                self.session.selection.select_actions((hit.ident,))
            menu.addAction("Play in context", lambda: self.session.show_context(str(hit.ident)))
            menu.addSeparator()
            move = menu.addMenu("Move to stance")
            for stance in self.document.project.graphs[self.session.place.layer].stances.values():
                move.addAction(stance.name, partial(self._move_to, stance.id))
            if hit.kind == "transition":
                ends = menu.addMenu("End in stance")
                for stance in self.document.project.graphs[self.session.place.layer].stances.values():
                    if stance.id != self.session.place.stance():
                        ends.addAction(stance.name, partial(self._end_selection_in, stance.id))
            menu.addAction("Show clip in the library", self._show_clip)
            menu.addSeparator()
            menu.addActions(self.row_actions)
            menu.addSeparator()
            menu.addAction("Remove from the graph\tDel", self.remove_selection)
        elif hit.area in ("chip", "card") and hit.ident:
            stance_id = hit.ident
            menu.addAction("Rename stance…\tF2", lambda: self.rename_stance(stance_id))
            menu.addAction(
                "Start here",
                lambda: self.document.edit("Start here", lambda p: edits.set_start(p, stance_id)),
            )
            menu.addSeparator()
            menu.addAction(
                "Remove stance and its actions",
                lambda: self.document.edit("Remove stance", lambda p: edits.remove_stance(p, stance_id)),
            )
        else:
            menu.addAction("New stance…", self.new_stance)
        menu.exec(event.globalPos())

    def _move_to(self, stance: str) -> None:
        chosen = self.session.selection.actions
        try:
            self.document.edit("Move actions", lambda p: edits.to_stance(p, chosen, stance))
        except edits.EditError as error:
            self.refused.emit(str(error))

    def _end_selection_in(self, stance: str) -> None:
        self.end_in(self.session.selection.actions, stance)

    def end_in(self, actions: Sequence[str], stance: str) -> None:
        """Let transitions end in another stance, in one step."""
        try:
            self.document.edit("Change end stance", lambda p: edits.set_ends(p, actions, stance))
        except edits.EditError as error:
            self.refused.emit(str(error))

    def _show_clip(self) -> None:
        actions = self.session.selection.selected_actions()
        self.session.selection.select_clips(tuple(dict.fromkeys(a.clip for a in actions)))

    def _choose_other(self, at: QPoint) -> None:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        current, other = self.session.place.stance(), self.session.place.other()
        for stance in self.document.project.graphs[self.session.place.layer].stances.values():
            if stance.id != current:
                entry = menu.addAction(stance.name, partial(self.session.place.set_other, stance.id))
                entry.setCheckable(True)
                entry.setChecked(stance.id == other)
        if menu.isEmpty():
            menu.addAction("Make a second stance first").setEnabled(False)
        menu.exec(at)

    def new_stance(self) -> None:
        name, accepted = QInputDialog.getText(
            self, "New stance", f"Name of the new {self.session.place.layer} stance:"
        )
        if accepted and name.strip():
            layer = self.session.place.layer
            self.document.edit("New stance", lambda p: edits.add_stance(p, layer, name))
            self.session.place.set_stance(list(self.document.project.graphs[layer].stances)[-1])

    def rename_stance(self, stance: str | None = None) -> None:
        found = self.document.project.stance(stance or self.session.place.stance())
        if found is None:
            return
        name, accepted = QInputDialog.getText(self, "Rename stance", "Name:", text=found.name)
        if accepted and name.strip():
            self.document.edit("Rename stance", lambda p: edits.rename_stance(p, found.id, name))

    def remove_selection(self) -> None:
        """Take the selected actions out of the graph."""
        gone = self.session.selection.actions
        if gone:
            self.document.edit(
                f"Remove {len(gone)} action{'s' if len(gone) > 1 else ''}",
                lambda p: edits.remove_actions(p, gone),
            )


def sentence(project: Project) -> str:
    """Count the machine that was not drawn."""
    whole = size(project)
    if not whole.clips:
        return "Drop clips on the nodes; every connection between them is implied."
    layers = sum(1 for layer in LAYERS if project.graphs[layer].actions)
    over = f" over {layers} layers" if layers > 1 else ""
    clips, states, links = (
        many(whole.clips, "clip"),
        many(whole.states, "state"),
        many(whole.connections, "connection"),
    )
    return f"You placed {clips}{over}. This is the machine you did not have to draw: {states}, {links}."
