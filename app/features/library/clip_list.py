"""The list of clips, from which they are dragged, and the field that searches it."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QSize, Qt, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QDrag,
    QDragEnterEvent,
    QDragMoveEvent,
    QDropEvent,
    QKeyEvent,
    QMouseEvent,
    QResizeEvent,
)
from PySide6.QtWidgets import QAbstractItemView, QLineEdit, QListView, QWidget

from app.features.library.clip_model import ENTRY
from app.features.library.clip_names import ClipNames
from app.look.plural import many
from app.stage.session import Session
from app.stage.thumbnails import Thumbnails
from app.widgets.mime import drag_picture, load_of, mime

CARD_WIDTH, CARD_HEIGHT = 124, 176


class Search(QLineEdit):
    """left: the keyboard should go to what was found: Down or Enter. Esc clears it."""

    left = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, clearButtonEnabled=True)
        self.setToolTip(
            "Words of a clip's name or path (Ctrl+F): sit wave, sit -wave, sit | bow; Down goes to the clips"
        )
        self.setAccessibleName("Search clips")

    def event(self, event: QEvent) -> bool:
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and event.key() == Qt.Key.Key_Escape
            and self.text()
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Down, Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.left.emit()
        elif event.key() == Qt.Key.Key_Escape:
            self.clear()
        else:
            super().keyPressEvent(event)


class ClipList(QListView):
    """files_dropped: paths. menu_wanted: a clip's, and where on the screen. A click plays the clip alone, a
    second click plays it in context.
    """

    files_dropped = Signal(object)
    menu_wanted = Signal(object, QPoint)

    def __init__(self, session: Session, thumbnails: Thumbnails, names: ClipNames, parent: QWidget) -> None:
        super().__init__(parent)
        self.session, self.thumbnails, self.names = session, thumbnails, names
        self.setViewMode(QListView.ViewMode.IconMode)
        self.setResizeMode(QListView.ResizeMode.Adjust)
        self.setMovement(QListView.Movement.Static)
        self.setUniformItemSizes(True)
        self.setGridSize(QSize(CARD_WIDTH, CARD_HEIGHT))
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setDragEnabled(True)
        self.setAcceptDrops(True)
        self.setDragDropMode(QAbstractItemView.DragDropMode.DragDrop)
        self.viewport().setAcceptDrops(
            True
        )  # cards that stay in place turn it off, and with it files from outside
        self.setMouseTracking(True)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOn)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setAccessibleName("Clips")

    def startDrag(self, actions: Qt.DropAction) -> None:
        chosen = [i.data(ENTRY) for i in self.selectedIndexes()]
        if not chosen:
            return
        drag = QDrag(self)
        drag.setMimeData(mime(clips=[e.id for e in chosen]))
        words = " ".join(self.names.of(chosen[0])) if len(chosen) == 1 else many(len(chosen), "clip")
        picture = self.thumbnails.picture(chosen[0].id, bare=True)
        drag.setPixmap(drag_picture(words.strip(), self, picture))
        drag.setHotSpot(QPoint(-14, -10))  # beside the pointer: what lies under that stays in sight
        drag.exec(Qt.DropAction.CopyAction)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fill the width with as many columns as fit."""
        width = self.viewport().width() - 2
        self.setGridSize(QSize(max(CARD_WIDTH, width // max(1, width // CARD_WIDTH)), CARD_HEIGHT))
        super().resizeEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        super().mouseReleaseEvent(event)
        index = self.indexAt(event.position().toPoint())
        if (
            not index.isValid()
            or len(self.selectedIndexes()) != 1
            or event.button() != Qt.MouseButton.LeftButton
        ):
            return
        self.play(index.data(ENTRY).id)

    def play(self, clip: str) -> None:
        """Play a clip alone; when it already does, in context."""
        session = self.session
        if session.transport.show == "clip" and session.transport.shown == clip:
            session.show_context(clip)
        else:
            session.transport.show_clip(clip)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.currentIndex().isValid():
            self.play(self.currentIndex().data(ENTRY).id)
        elif event.text() in ("1", "2", "3", "4"):
            event.ignore()  # the window's keys label the selection
        else:
            super().keyPressEvent(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        index = self.indexAt(event.pos())
        if index.isValid():
            self.menu_wanted.emit(index.data(ENTRY), event.globalPos())

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if load_of(event.mimeData()).files:
            event.acceptProposedAction()
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
