"""The clip library: thumbnails, search, filters; clips are dragged from here, files and folders dropped onto
it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import (
    QAbstractListModel,
    QEvent,
    QItemSelection,
    QItemSelectionModel,
    QMimeData,
    QModelIndex,
    QPersistentModelIndex,
    QPoint,
    QRect,
    QSize,
    QSortFilterProxyModel,
    Qt,
    Signal,
)
from PySide6.QtGui import (
    QAction,
    QColor,
    QContextMenuEvent,
    QDrag,
    QDragEnterEvent,
    QDragMoveEvent,
    QDropEvent,
    QFont,
    QFontMetrics,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPen,
    QResizeEvent,
)
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QInputDialog,
    QLabel,
    QLineEdit,
    QListView,
    QMenu,
    QPushButton,
    QStackedLayout,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.look.names import plain
from app.look.plural import many, short
from app.look.shortening import fitted, fitting
from app.look.theme import KIND_MARKS, theme
from app.project.document import Document
from app.project.load import readable
from app.stage.session import Session
from app.stage.thumbnails import Thumbnails
from app.widgets.flow import Flow
from app.widgets.making import make_widget
from app.widgets.mime import drag_picture, load_of, mime
from app.widgets.more_button import MoreButton
from metagraph.graph import edits
from metagraph.graph.generated import origin
from metagraph.graph.model import KINDS, LAYERS, ClipEntry, Kind, Project

Index = QModelIndex | QPersistentModelIndex
EMPTY = "Drop a folder of clips here\n\n{}"
ENTRY = Qt.ItemDataRole.UserRole
CARD_WIDTH, CARD_HEIGHT = 124, 176
PICTURE = 108
NEAR = 48  # cards before and behind one, from which its name is told apart


@dataclass(frozen=True)
class Filter:
    """What the library shows. labelled: None for both. kind, layer: None for any; they look at the actions
    that use a clip.
    """

    text: str = ""
    labelled: bool | None = None
    layer: str | None = None
    kind: str | None = None

    def takes(self, project: Project, entry: ClipEntry) -> bool:
        if (
            self.labelled is not None
            and (entry.id in project.uses or entry.id in project.drawn) != self.labelled
        ):
            return False
        if (self.layer or self.kind) and not any(
            (not self.layer or a.layer == self.layer) and (not self.kind or a.kind == self.kind)
            for a in project.uses.get(entry.id, ())
        ):
            return False
        name = f"{entry.name} {entry.path}".lower()
        return all(word in name for word in self.text.lower().split())


class ClipModel(QAbstractListModel):
    """The project's clips, in their order."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self.document = document
        self.entries: list[ClipEntry] = list(document.project.clips.values())
        document.changed.connect(self._follow)

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 - Qt's signature
        return 0 if parent.isValid() else len(self.entries)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        if not index.isValid() or index.row() >= len(self.entries):
            return None
        entry = self.entries[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return entry.name
        if role == ENTRY:
            return entry
        if role == Qt.ItemDataRole.ToolTipRole:
            notes = "".join(
                f"\n{note}"
                for note in (entry.motion.notes if entry.motion is not None else ("The file is missing.",))
            )
            uses = ", ".join(f"{a.kind} ({a.layer})" for a in self.document.project.uses.get(entry.id, ()))
            uses = uses or (
                "drawn as a state" if entry.id in self.document.project.drawn else "not placed yet"
            )
            made = f"\n{origin(entry)}" if entry.made_by else ""
            return (
                f"{entry.name}\n{entry.duration:.2f} s, {entry.frames} frames at {entry.fps:g} "
                f"fps\n{entry.path}{made}\n{uses}{notes}"
            )
        if role == Qt.ItemDataRole.AccessibleTextRole:
            return f"{entry.name}, {entry.duration:.1f} seconds"
        return None

    def flags(self, index: Index) -> Qt.ItemFlag:
        return super().flags(index) | Qt.ItemFlag.ItemIsDragEnabled

    def mimeData(self, indexes: Sequence[QModelIndex]) -> QMimeData:
        return mime(clips=[self.entries[i.row()].id for i in indexes])

    def _follow(self, before: Project, after: Project) -> None:
        if before.clips is not after.clips:
            fresh = list(after.clips.values())
            same = [e.id for e in fresh] == [e.id for e in self.entries]
            if same:
                self.entries = fresh
            else:
                self.beginResetModel()
                self.entries = fresh
                self.endResetModel()
        if before is not after and self.entries:
            self.dataChanged.emit(self.index(0), self.index(len(self.entries) - 1))


class FilterModel(QSortFilterProxyModel):
    def __init__(self, model: ClipModel) -> None:
        super().__init__(model)
        self.filter = Filter()
        self.setSourceModel(model)

    def set_filter(self, rule: Filter) -> None:
        if rule != self.filter:
            if hasattr(self, "beginFilterChange"):
                self.beginFilterChange()
                self.filter = rule
                self.endFilterChange()
            else:
                self.filter = rule
                self.invalidateFilter()

    def filterAcceptsRow(self, row: int, parent: Index) -> bool:
        model = self.sourceModel()
        assert isinstance(model, ClipModel)
        return self.filter.takes(model.document.project, model.entries[row])

    def mimeData(self, indexes: Sequence[QModelIndex]) -> QMimeData:
        return mime(clips=[i.data(ENTRY).id for i in indexes])


class CardDelegate(QStyledItemDelegate):
    """Draws a clip as a card: picture, name, length, a stripe and mark for each kind it serves as."""

    def __init__(self, panel: LibraryPanel) -> None:
        super().__init__(panel)
        self.panel = panel

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        return self.panel.list.gridSize()

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        entry: ClipEntry = index.data(ENTRY)
        if entry is None:
            return
        t = theme(self.panel.session.look.name)
        project = self.panel.document.project
        rect = option.rect.adjusted(4, 4, -4, -4)
        state = option.state
        selected, hover = (
            bool(state & QStyle.StateFlag.State_Selected),
            bool(state & QStyle.StateFlag.State_MouseOver),
        )
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.setBrush(QColor(t.hover if hover or selected else t.field))
        painter.setPen(QPen(QColor(t.text if selected else t.line), 1.6 if selected else 1))
        painter.drawRoundedRect(rect, 6, 6)
        picture = self.panel.thumbnails.picture(entry.id, bare=True)
        box = QRect(rect.left() + (rect.width() - PICTURE) // 2, rect.top() + 2, PICTURE, PICTURE)
        if picture is not None:
            painter.drawImage(box, picture)
        elif entry.motion is None:
            painter.setPen(QColor(t.warning))
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, "file\nmissing")
        kinds = list(dict.fromkeys(a.kind for a in project.uses.get(entry.id, ())))
        drawn = entry.id in project.drawn and not kinds  # a state of a machine is of no kind
        marks = [QColor(t.dim)] if drawn else [t.fill(kind) for kind in kinds]
        for place, mark in enumerate(marks):
            height = (rect.height() - 12) / len(marks)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(mark)
            painter.drawRoundedRect(
                rect.left() + 3, round(rect.top() + 6 + place * height), 4, round(height - 1), 2, 2
            )
        font = QFont(option.font)
        font.setPixelSize(12)
        painter.setFont(font)
        painter.setPen(QColor(t.text))
        line = QRect(rect.left() + 11, rect.bottom() - 53, rect.width() - 16, 16)
        front, rest = self.panel.card_name(entry)
        key, beside = font.toString(), self.panel.beside(index.row())
        shown = (
            (
                fitted(front, line.width(), key, self.panel.stances()),
                fitted(rest, line.width(), key, beside),
            )
            if front
            else two_lines(rest, painter.fontMetrics(), line.width(), beside)
        )
        for n, part in enumerate(shown):
            painter.setPen(QColor(t.dim if front and n == 0 else t.text))
            painter.drawText(line, Qt.AlignmentFlag.AlignVCenter, part)
            line.translate(0, 16)
        painter.setPen(QColor(t.dim))
        line.moveTop(rect.bottom() - 20)
        painter.drawText(line, Qt.AlignmentFlag.AlignVCenter, f"{entry.duration:.1f} s")
        right = line.right()
        for kind in reversed(kinds):
            painter.setPen(t.kind(kind))
            right -= 14
            painter.drawText(
                QRect(right, line.top(), 14, line.height()), Qt.AlignmentFlag.AlignCenter, KIND_MARKS[kind]
            )
        if project.base.clip == entry.id:
            painter.setPen(QColor(t.dim))
            painter.drawText(
                line.adjusted(0, 0, right - line.right() - 2, 0),
                Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter,
                "base",
            )
        painter.restore()


def two_lines(name: str, metrics: QFontMetrics, width: int, beside: Iterable[str] = ()) -> tuple[str, ...]:
    """Break a name over at most two lines, after a separator where there is one. beside: names of the cards
    round it, from which what is shown is to differ.
    """
    if metrics.horizontalAdvance(name) <= width:
        return (name,)
    measure = metrics.horizontalAdvance
    first, second = _broken(name, metrics, width)
    if measure(second) > width:
        rivals = [o[len(name) - len(second) :] for o in beside if o.startswith(first)]
        cut = fitting(second, width, measure, rivals, sure=True)
        if cut:
            return first, cut
        first, second = _broken(fitting(name, 2 * width - 16, measure, beside), metrics, width, hard=True)
    return first, fitting(second, width, measure)


def _broken(name: str, metrics: QFontMetrics, width: int, hard: bool = False) -> tuple[str, str]:
    """Break a name behind a separator, or where the line is full. hard: there if the rest needs it."""
    fits = max((n for n in range(1, len(name)) if metrics.horizontalAdvance(name[:n]) <= width), default=1)
    cuts = [n for n in range(fits, fits // 2, -1) if name[n - 1] in "_- .@"]
    cut = cuts[0] if cuts else fits
    if hard and metrics.horizontalAdvance(name[cut:]) > width:
        cut = fits
    return name[:cut].rstrip(), name[cut:]


class Search(QLineEdit):
    """left: the keyboard should go to what was found: Down or Enter. Esc clears it."""

    left = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, clearButtonEnabled=True)
        self.setToolTip("Words of a clip's name or path (Ctrl+F); Down goes to the clips")
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
    """files_dropped: paths. A click plays the clip alone, a second click plays it in context."""

    files_dropped = Signal(object)
    label = Signal(str)

    def __init__(self, panel: LibraryPanel) -> None:
        super().__init__(panel)
        self.panel = panel
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
        words = " ".join(self.panel.card_name(chosen[0])) if len(chosen) == 1 else many(len(chosen), "clip")
        picture = self.panel.thumbnails.picture(chosen[0].id, bare=True)
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
        session = self.panel.session
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
            self.panel.menu(index.data(ENTRY)).exec(event.globalPos())

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


class LibraryPanel(QWidget):
    """import_wanted: the user asks for a folder. files_dropped: paths to import."""

    import_wanted = Signal()
    files_dropped = Signal(object)

    def __init__(
        self, document: Document, session: Session, thumbnails: Thumbnails, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.thumbnails = document, session, thumbnails
        self.row_actions: list[QAction] = []  # the window's commands that go into a clip's menu
        self.model = ClipModel(document)
        self.proxy = FilterModel(self.model)
        self.search = Search(self)
        self.search.textChanged.connect(self._refilter)
        self.list = ClipList(self)
        self.list.setModel(self.proxy)
        self.list.setItemDelegate(CardDelegate(self))
        self.list.files_dropped.connect(self.files_dropped)
        self.search.left.connect(self._into_list)
        self._following = False
        selection = self.list.selectionModel()
        selection.selectionChanged.connect(self._selected)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 4, 0)
        layout.setSpacing(6)
        layout.addWidget(self.search)
        layout.addLayout(self._filters())
        self.stack = QStackedLayout()
        self.stack.addWidget(self.list)
        self.stack.addWidget(self._empty())
        layout.addLayout(self.stack, 1)
        self.setAcceptDrops(True)
        document.changed.connect(self._follow)
        document.loaded.connect(self.forget)
        session.selection.changed.connect(self._show_selection)
        thumbnails.ready.connect(lambda _: self.list.viewport().update())
        self._count()

    def _filters(self) -> Flow:
        row = Flow()
        self.chips: dict[str, QToolButton] = {}

        def chip(key: str, text: str, tip: str) -> None:
            button = make_widget(QToolButton, self, text=text, toolTip=tip, checkable=True)
            button.setProperty("tight", True)
            button.clicked.connect(lambda _=False, k=key: self._chip(k))
            self.chips[key] = button
            row.addWidget(button)

        chip("all", "All", "All clips")
        chip("unlabelled", "Unlabelled", "Clips that were not placed yet")
        chip("labelled", "Placed", "Clips that are in the graph")
        tip = "Show the clips of a layer or kind only"
        self.more = MoreButton(self.session.look, "Layer or kind", tip, self)
        menu = self.more.menu_of
        menu.addAction("Any kind, any layer", lambda: self._narrow(None, None))
        menu.addSeparator()
        for kind in KINDS:
            menu.addAction(f"{KIND_MARKS[kind]}  {kind.capitalize()}", partial(self._narrow, None, kind))
        menu.addSeparator()
        for layer in LAYERS:
            menu.addAction(f"{layer.capitalize()} layer", partial(self._narrow, layer, None))
        row.addWidget(self.more)
        self.chips["all"].setChecked(True)
        return row

    def _empty(self) -> QWidget:
        page = QWidget(self)
        box = QVBoxLayout(page)
        box.addStretch(2)
        self.empty = QLabel(EMPTY.format(readable()), page)
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setProperty("dim", True)
        self.empty.setWordWrap(True)
        box.addWidget(self.empty)
        button = QPushButton("Import a folder…", page)
        button.clicked.connect(self.import_wanted)
        self.empty_button = button
        row = QHBoxLayout()
        row.addStretch(1)
        row.addWidget(button)
        row.addStretch(1)
        box.addLayout(row)
        box.addStretch(3)
        return page

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        self.list.dragEnterEvent(event)

    def dropEvent(self, event: QDropEvent) -> None:
        self.list.dropEvent(event)

    # --- filtering

    def _chip(self, key: str) -> None:
        for name, button in self.chips.items():
            button.setChecked(name == key)
        self._refilter()

    def _narrow(self, layer: str | None, kind: Kind | None) -> None:
        word = layer or kind
        self.more.show_words((word or "").capitalize())
        self._refilter(layer=layer, kind=kind)

    def _refilter(self, *_: object, **more: str | None) -> None:
        checked = next((k for k, b in self.chips.items() if b.isChecked()), "all")
        labelled = {"all": None, "unlabelled": False, "labelled": True}[checked]
        old = self.proxy.filter
        layer, kind = more.get("layer", old.layer), more.get("kind", old.kind)
        if more:
            layer, kind = more["layer"], more["kind"]
        self.proxy.set_filter(Filter(self.search.text(), labelled, layer, kind))
        self._count()

    def _count(self) -> None:
        project = self.document.project
        total = len(project.clips)
        loose = sum(1 for c in project.clips if c not in project.uses and c not in project.drawn)
        self.chips["unlabelled"].setText(f"Unlabelled {loose}" if total else "Unlabelled")
        self.search.setPlaceholderText(
            f"Search {total} clip{'s' if total != 1 else ''}" if total else "Search"
        )
        nothing = not total
        hidden = bool(total) and self.proxy.rowCount() == 0
        self.empty_button.setVisible(nothing)
        if hidden:
            self.empty.setText("No clip matches.\nClear the search or the filters.")
        else:
            self.empty.setText(EMPTY.format(readable()))
        self.stack.setCurrentIndex(1 if nothing or hidden else 0)

    def next_unlabelled(self, clip: str) -> str | None:
        """Return the clip that comes after one, as they are listed, and serves as nothing yet; from the first
        on where none comes after it. None where there is no other.
        """
        project, filtered = self.document.project, self.proxy.filter
        ids = [i for i, e in project.clips.items() if i == clip or self._open(e, filtered)]
        at = ids.index(clip) if clip in ids else -1
        return next((i for i in (*ids[at + 1 :], *ids[: max(0, at)]) if i != clip), None)

    def _open(self, entry: ClipEntry, rule: Filter) -> bool:
        """Return whether a clip serves as nothing yet, and is looked for."""
        project = self.document.project
        used = entry.id in project.uses or entry.id in project.drawn
        return not used and Filter(rule.text).takes(project, entry)

    def forget(self) -> None:
        """Show all clips: what was searched was of another project."""
        self.search.clear()
        self._narrow(None, None)
        self._chip("all")

    # --- names

    def card_name(self, entry: ClipEntry) -> tuple[str, str]:
        """Return the stance that a clip's name begins with, "" for none, and the rest, as they are read."""
        kept, names = self._names(), self.stances()
        if entry.name not in kept:
            found = next((n for n in names if short(entry.name, n) != entry.name), "")
            kept[entry.name] = found, plain(entry.name, found)
        return kept[entry.name]

    def _names(self) -> dict[str, tuple[str, str]]:
        """Return what is known of names by now; nothing after the graphs changed."""
        graphs = self.document.project.graphs
        if self._named[0] is not graphs:
            some = [(layer, s.name) for layer in LAYERS for s in graphs[layer].stances.values()]
            names = {name for _, name in some} | {f"{layer} {name}" for layer, name in some}
            self._named = graphs, tuple(sorted(names, key=len, reverse=True)), {}
        return self._named[2]

    _named: tuple[object, tuple[str, ...], dict[str, tuple[str, str]]] = None, (), {}

    def stances(self) -> tuple[str, ...]:
        """Return the names of all stances, with their layers in front, too, the longest first."""
        self._names()
        return self._named[1]

    def beside(self, row: int) -> tuple[str, ...]:
        """Return what the cards round one are called, as far as names are shown in a line."""
        near = range(row // NEAR * NEAR - NEAR, row // NEAR * NEAR + 2 * NEAR)
        entries = (self.proxy.index(n, 0).data(ENTRY) for n in near if 0 <= n < self.proxy.rowCount())
        return tuple(dict.fromkeys(self.card_name(e)[1] for e in entries if e is not None))

    # --- selection

    def _into_list(self) -> None:
        """Give the keyboard to the clips, the first one chosen unless one is already."""
        if self.proxy.rowCount():
            self.list.setFocus(Qt.FocusReason.TabFocusReason)
            if not self.list.selectedIndexes():
                self.list.setCurrentIndex(self.proxy.index(0, 0))

    def _selected(self, *_: QItemSelection) -> None:
        if self._following:
            return
        rows = sorted(self.list.selectedIndexes(), key=lambda i: i.row())
        self._following = True
        self.session.selection.select_clips(tuple(i.data(ENTRY).id for i in rows))
        self._following = False

    def _show_selection(self) -> None:
        """Follow the session: selected clips, or the clips of selected actions faintly by scrolling to the
        first.
        """
        if self._following:
            return
        self._following = True
        wanted = set(self.session.selection.clips)
        if not wanted:
            self.list.clearSelection()
            self._following = False
            return
        chosen = QItemSelection()
        first = None
        for row in range(self.proxy.rowCount()):
            index = self.proxy.index(row, 0)
            if index.data(ENTRY).id in wanted:
                chosen.select(index, index)
                first = first or index
        self.list.selectionModel().select(chosen, QItemSelectionModel.SelectionFlag.ClearAndSelect)
        if first is not None and len(wanted) == 1:
            self.list.selectionModel().setCurrentIndex(first, QItemSelectionModel.SelectionFlag.NoUpdate)
            self.list.scrollTo(first)
        self._following = False

    def _follow(self, before: Project, after: Project) -> None:
        if (
            before.clips is not after.clips
            or before.graphs is not after.graphs
            or before.manual is not after.manual
        ):
            rule = self.proxy.filter
            if rule.labelled is not None or rule.layer or rule.kind:
                self._following = True  # clips leaving the view are not deselected by hand
                self.proxy.invalidate()
                self._following = False
            self._count()
        if before.base != after.base:
            self.list.viewport().update()

    # --- commands

    def menu(self, entry: ClipEntry) -> QMenu:
        """Return what can be done with a clip, and with all selected ones."""
        out = QMenu(self)
        out.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        chosen = self.session.selection.clips if entry.id in self.session.selection.clips else (entry.id,)
        out.addAction("Play alone", lambda: self.session.transport.show_clip(entry.id))
        out.addAction("Play in context", lambda: self.session.show_context(entry.id))
        out.addSeparator()
        out.addAction("Use its first frame as base pose", lambda: self.use_as_base(entry.id, 0))
        if self.session.transport.show == "clip" and self.session.transport.shown == entry.id:
            frame = round(self.session.transport.seconds * entry.fps)
            out.addAction(f"Use this frame ({frame}) as base pose", lambda: self.use_as_base(entry.id, frame))
        out.addAction(
            "Use the rest pose as base pose",
            lambda: self.document.edit("Set base pose", lambda p: edits.set_base(p, None)),
        )
        out.addSeparator()
        out.addAction("Rename…\tF2", lambda: self.rename(entry.id))
        out.addActions(self.row_actions)
        out.addSeparator()
        noun = f"{len(chosen)} clips" if len(chosen) > 1 else "clip"
        out.addAction(f"Remove {noun} from the project\tDel", lambda: self.remove(chosen))
        return out

    def use_as_base(self, clip: str, frame: int) -> None:
        self.document.edit("Set base pose", lambda p: edits.set_base(p, clip, frame))

    def rename(self, clip: str) -> None:
        entry = self.document.project.clips[clip]
        name, accepted = QInputDialog.getText(self, "Rename clip", "Name:", text=entry.name)
        if accepted and name.strip():
            self.document.edit("Rename clip", lambda p: edits.rename_clip(p, clip, name))

    def remove(self, clips: Iterable[str]) -> None:
        gone = tuple(clips)
        if gone:
            self.document.edit(
                f"Remove {len(gone)} clip{'s' if len(gone) > 1 else ''}",
                lambda p: edits.remove_clips(p, gone),
            )
        self.list.viewport().update()
