"""The list of clips as cards, as lines or in columns, from which they are dragged. Where each is says
`clip_layout`; how it looks says its delegate.
"""

from __future__ import annotations

from PySide6.QtCore import QEvent, QItemSelection, QItemSelectionModel, QModelIndex, QPoint, QRect, Qt, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QDrag,
    QDragEnterEvent,
    QDragMoveEvent,
    QDropEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QRegion,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QAbstractItemView, QListView, QStyle, QStyleOptionViewItem, QWidget

from app.features.library.clip_delegate import ClipDelegate
from app.features.library.clip_header import ClipHeader
from app.features.library.clip_layout import ClipLayout
from app.features.library.clip_rows import ENTRY, ClipRows, Index
from app.features.library.clip_scrub import ClipScrub
from app.features.library.clip_sizes import SIZES, Style, measure_cell, place_picture
from app.stage.session import StageSession
from app.translation import tr, tr_plural
from app.widgets.drop_frame import DropFrame
from app.widgets.mime import drag_picture, load_of, make_mime

Move = QAbstractItemView.CursorAction
HIT = QAbstractItemView.ScrollHint


class ClipList(QListView):
    """files_dropped: paths. menu_wanted: a clip's, and where on the screen. zoomed: a step larger or smaller
    is asked for. A click plays the clip alone, a second click plays it in context; over its picture the
    pointer goes through it.
    """

    files_dropped = Signal(object)
    menu_wanted = Signal(object, QPoint)
    zoomed = Signal(int)

    def __init__(
        self, session: StageSession, rows: ClipRows, delegate: ClipDelegate, parent: QWidget
    ) -> None:
        super().__init__(parent)
        self.session, self.rows, self.delegate = session, rows, delegate
        self.style_of: Style = "cards"
        self.side = SIZES[5]
        self.layout_of = ClipLayout((), 1, (1, 1))
        self._pressed: QPoint | None = None  # where a rectangle of selection begins
        self.header = ClipHeader(self)
        self.header.hide()
        self.header.sectionResized.connect(self.relayout)
        self.header.sectionMoved.connect(self.viewport().update)
        self.header.geometriesChanged.connect(self.relayout)
        self.horizontalScrollBar().valueChanged.connect(self.header.setOffset)
        self.scrub = ClipScrub(self, rows, delegate.pictures, self.picture_rect)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setDragEnabled(True)
        self.setDragDropMode(QAbstractItemView.DragDropMode.DragDrop)
        self.viewport().setAcceptDrops(True)
        self.drop_frame = DropFrame(self.viewport(), session.look, tr("Drop to import clips"))
        self.viewport().setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)  # what is scrolled is moved
        self.setMouseTracking(True)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOn)
        self.setAccessibleName(tr("Clips"))
        self.setModel(rows)
        self.setItemDelegate(delegate)
        rows.layoutChanged.connect(self.relayout)

    # --- where things are

    def show_as(self, style: Style, side: int) -> None:
        """Show cards, lines or columns with pictures of so many pixels; what is current stays in sight."""
        self.style_of, self.side = style, side
        self.header.setVisible(style == "columns")
        self.delegate.show_as(style, side, self.header)
        top = self.header.sizeHint().height() if style == "columns" else 0
        self.setViewportMargins(0, top, 0, 0)
        self.relayout()
        if self.currentIndex().isValid():
            self.scrollTo(self.currentIndex())

    def relayout(self, *_: object) -> None:
        """Lay everything out again, now."""
        columns = self.style_of == "columns"
        width = self.header.length() if columns else self.viewport().width()
        self.layout_of = ClipLayout(self.rows.sections, width, measure_cell(self.style_of, self.side, width))
        self.updateGeometries()
        self.viewport().update()

    def doItemsLayout(self) -> None:
        self.relayout()

    def updateGeometries(self) -> None:
        room = self.viewport().size()
        self.header.setGeometry(0, 0, room.width(), self.viewportMargins().top())
        for bar, whole, seen, step in (
            (self.verticalScrollBar(), self.layout_of.height, room.height(), self.layout_of.cell_height),
            (self.horizontalScrollBar(), self.layout_of.width, room.width(), 60),
        ):
            bar.setSingleStep(min(step, 60))
            bar.setPageStep(seen)
            fits = bar.orientation() == Qt.Orientation.Horizontal and self.header.isHidden()
            bar.setRange(0, 0 if fits else max(0, whole - seen))

    def horizontalOffset(self) -> int:
        return self.horizontalScrollBar().value()

    def verticalOffset(self) -> int:
        return self.verticalScrollBar().value()

    def scrollContentsBy(self, dx: int, dy: int) -> None:
        self.viewport().scroll(dx, dy)

    def _shift(self) -> QPoint:
        return QPoint(self.horizontalOffset(), self.verticalOffset())

    def visualRect(self, index: Index) -> QRect:
        rect = self.layout_of.rect(index.row()) if index.isValid() else QRect()
        return rect.translated(-self._shift()) if not rect.isEmpty() else rect

    def picture_rect(self, index: Index) -> QRect:
        """Return where a clip's picture is."""
        return place_picture(self.style_of, self.side, self.visualRect(index))

    def indexAt(self, point: QPoint) -> QModelIndex:
        row = self.layout_of.at(point + self._shift())
        return self.rows.index(row if row is not None else -1, 0)

    def isIndexHidden(self, index: Index) -> bool:
        return self.layout_of.rect(index.row()).isEmpty()

    def scrollTo(self, index: Index, hint: QAbstractItemView.ScrollHint = HIT.EnsureVisible) -> None:
        rect = self.layout_of.rect(index.row()) if index.isValid() else QRect()
        if rect.isEmpty():
            return
        bar, room = self.verticalScrollBar(), self.viewport().height()
        if hint == HIT.PositionAtCenter:
            bar.setValue(rect.center().y() - room // 2)
        elif rect.top() < bar.value() or hint == HIT.PositionAtTop:
            bar.setValue(rect.top())
        elif rect.bottom() > bar.value() + room:
            bar.setValue(min(rect.top(), rect.bottom() - room + 1))

    # --- selection and keys

    def moveCursor(self, action: Move, modifiers: Qt.KeyboardModifier) -> QModelIndex:
        row, layout = self.currentIndex().row(), self.layout_of
        if not self.rows.entries:
            return self.currentIndex()
        page = max(layout.cell_height, self.viewport().height() - layout.cell_height)
        if row < 0 or action == Move.MoveHome:
            found = layout.beside(-1, 0)
        elif action == Move.MoveEnd:
            found = layout.beside(layout.count, 0)
        elif action in (Move.MoveUp, Move.MoveDown):
            high = layout.cell_height
            found = layout.below(row, high if action == Move.MoveDown else -high)
        elif action in (Move.MovePageUp, Move.MovePageDown):
            found = layout.below(row, page if action == Move.MovePageDown else -page)
        elif layout.columns == 1:
            return self.currentIndex()
        else:
            found = layout.beside(row, 1 if action in (Move.MoveRight, Move.MoveNext) else -1)
        return self.rows.index(found, 0)

    def setSelection(self, rect: QRect, command: QItemSelectionModel.SelectionFlag) -> None:
        shift, layout = self._shift(), self.layout_of
        if self._pressed is not None:
            rows = list(layout.rows_in(rect.normalized().translated(shift)))
        else:  # from one clip to another, all between, as they are read
            ends = [layout.at(point + shift) for point in (rect.topLeft(), rect.bottomRight())]
            known = sorted(row for row in ends if row is not None)
            seen = layout.open_rows() if len(known) == 2 and known[0] != known[1] else known[:1]
            rows = [row for row in seen if known[0] <= row <= known[-1]]
        self.selectionModel().select(self._ranges(rows), command)

    def _ranges(self, rows: list[int]) -> QItemSelection:
        out = QItemSelection()
        first = 0
        for n, row in enumerate(rows):
            if n + 1 == len(rows) or rows[n + 1] != row + 1:
                out.select(self.rows.index(rows[first], 0), self.rows.index(row, 0))
                first = n + 1
        return out

    def visualRegionForSelection(self, selection: QItemSelection) -> QRegion:
        seen = self.layout_of.rows_in(self.viewport().rect().translated(self._shift()))
        region = QRegion()
        for row in seen:
            index = self.rows.index(row, 0)
            if selection.contains(index):
                region += self.visualRect(index)
        return region

    def select_rows(self, rows: list[int]) -> None:
        """Select rows, given in order, and no others."""
        flag = QItemSelectionModel.SelectionFlag.ClearAndSelect
        self.selectionModel().select(self._ranges(rows), flag)

    def selectAll(self) -> None:
        self.select_rows(self.layout_of.open_rows())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key, held = event.key(), event.modifiers() & Qt.KeyboardModifier.ControlModifier
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.currentIndex().isValid():
            self.play(self.currentIndex().data(ENTRY).id)
        elif event.text() in ("1", "2", "3", "4"):
            event.ignore()  # the window's keys label the selection, those of the number pad turn the view
        elif held and key in (Qt.Key.Key_Plus, Qt.Key.Key_Equal, Qt.Key.Key_Minus):
            self.zoomed.emit(-1 if key == Qt.Key.Key_Minus else 1)
        elif event.text() in ("+", "-", "*") and self.rows.sections and self.rows.sections[0].title:
            self._open_groups(event.text())
        else:
            super().keyPressEvent(event)

    def _open_groups(self, sign: str) -> None:
        """Close or open the group of the current clip, or open all: as in trees."""
        place = self.layout_of.section_of(max(0, self.currentIndex().row()))
        title = self.rows.sections[place].title
        closed = self.rows.closed
        after = {"-": closed | {title}, "+": closed - {title}, "*": frozenset[str]()}[sign]
        self.rows.close_groups(after)

    def play(self, clip: str) -> None:
        """Play a clip alone; when it already does, in context."""
        session = self.session
        if session.transport.show == "clip" and session.transport.shown == clip:
            session.show_context(clip)
        else:
            session.transport.show_clip(clip)

    # --- the mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        at = event.position().toPoint()
        place = self.layout_of.head_at(at + self._shift())
        if place is not None and event.button() == Qt.MouseButton.LeftButton:
            title = self.rows.sections[place].title
            self.rows.close_groups(self.rows.closed ^ {title})
            return
        self._pressed = at if not self.indexAt(at).isValid() else None
        self.scrub.stop()
        super().mousePressEvent(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        super().mouseMoveEvent(event)
        if event.buttons() == Qt.MouseButton.NoButton:
            self.scrub.over(event.position().toPoint())
        elif self._pressed is not None:
            self.viewport().update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        super().mouseReleaseEvent(event)
        if self._pressed is not None:
            self._pressed = None
            self.viewport().update()
            return
        index = self.indexAt(event.position().toPoint())
        alone = len(self.selectedIndexes()) == 1 and event.button() == Qt.MouseButton.LeftButton
        if index.isValid() and alone:
            self.play(index.data(ENTRY).id)

    def viewportEvent(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Leave:
            self.scrub.stop()
        return super().viewportEvent(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self.zoomed.emit(1 if event.angleDelta().y() > 0 else -1)
            event.accept()
            return
        super().wheelEvent(event)
        self.scrub.stop()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        index = self.indexAt(event.pos())
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            index = self.currentIndex()
        if index.isValid():
            at = event.globalPos()
            if event.reason() == QContextMenuEvent.Reason.Keyboard:
                at = self.viewport().mapToGlobal(self.visualRect(index).center())
            self.menu_wanted.emit(index.data(ENTRY), at)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.relayout()

    # --- drawing

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self.viewport())
        area, shift = event.rect(), self._shift()
        self.delegate.paint_ground(painter, area)
        option = QStyleOptionViewItem()
        self.initViewItemOption(option)
        usual, selection = option.state, self.selectionModel()
        under = self.viewport().mapFromGlobal(self.cursor().pos()) if self.underMouse() else None
        current = self.currentIndex().row() if self.hasFocus() else -1
        seen = area.translated(shift)
        for row in self.layout_of.rows_in(seen):
            index = self.rows.index(row, 0)
            option.rect = self.layout_of.rect(row).translated(-shift)
            option.state = usual
            if selection.isSelected(index):
                option.state |= QStyle.StateFlag.State_Selected
            if under is not None and option.rect.contains(under):
                option.state |= QStyle.StateFlag.State_MouseOver
            if row == current:
                option.state |= QStyle.StateFlag.State_HasFocus
            self.delegate.paint(painter, option, index)
        for place in self.layout_of.heads_in(seen):
            rect = self.layout_of.head(place).translated(0, -shift.y())
            self.delegate.paint_head(painter, rect, self.rows.sections[place])
        if self._pressed is not None:
            here = self.viewport().mapFromGlobal(self.cursor().pos())
            self.delegate.paint_band(painter, QRect(self._pressed, here))
        painter.end()

    # --- drags

    def startDrag(self, actions: Qt.DropAction) -> None:
        chosen = [i.data(ENTRY) for i in sorted(self.selectedIndexes(), key=lambda i: i.row())]
        if not chosen:
            return
        drag = QDrag(self)
        drag.setMimeData(make_mime(clips=[e.id for e in chosen]))
        names = self.delegate.names
        words = (
            " ".join(names.of(chosen[0]))
            if len(chosen) == 1
            else tr_plural("{count:,} clip", "{count:,} clips", len(chosen))
        )
        picture = self.delegate.pictures.thumbnails.picture(chosen[0].id, bare=True)
        drag.setPixmap(drag_picture(words.strip(), self, picture))
        drag.setHotSpot(QPoint(-14, -10))  # beside the pointer: what lies under that stays in sight
        drag.exec(Qt.DropAction.CopyAction)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if load_of(event.mimeData()).files:
            event.acceptProposedAction()
            self.drop_frame.follow(event)
        else:
            event.ignore()

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        if load_of(event.mimeData()).files:
            event.acceptProposedAction()
        else:
            event.ignore()

    def dropEvent(self, event: QDropEvent) -> None:
        files = load_of(event.mimeData()).files
        if files:
            event.acceptProposedAction()
            self.files_dropped.emit(files)
