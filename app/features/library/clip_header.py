"""The titles of the columns of clips: a click sorts, a drag moves, a menu shows and hides."""

from __future__ import annotations

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, QPoint, Qt, Signal
from PySide6.QtWidgets import QHeaderView, QMenu, QWidget

from app.features.library.clip_columns import COLUMNS
from app.translation import tr

PLACES = {column.id: n for n, column in enumerate(COLUMNS)}


class _Titles(QAbstractTableModel):
    def rowCount(self, parent: QModelIndex | QPersistentModelIndex = QModelIndex()) -> int:  # noqa: B008
        return 0

    def columnCount(self, parent: QModelIndex | QPersistentModelIndex = QModelIndex()) -> int:  # noqa: B008
        return len(COLUMNS)

    def data(self, index: QModelIndex | QPersistentModelIndex, role: int = 0) -> object:
        return None

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> object:
        if role == Qt.ItemDataRole.DisplayRole:
            return COLUMNS[section].title
        if role == Qt.ItemDataRole.TextAlignmentRole:
            side = Qt.AlignmentFlag.AlignRight if COLUMNS[section].right else Qt.AlignmentFlag.AlignLeft
            return side | Qt.AlignmentFlag.AlignVCenter
        if role == Qt.ItemDataRole.ToolTipRole:
            return tr("{tip}. Click to sort; right-click to choose columns.", tip=COLUMNS[section].tip)
        return None


class ClipHeader(QHeaderView):
    """sort_wanted: an order of `ORDERS`; asked for again it goes the other way round. arranged: columns were
    moved, resized, shown or hidden.
    """

    sort_wanted = Signal(str)
    arranged = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setModel(_Titles(self))
        self.setSectionsMovable(True)
        self.setSectionsClickable(True)
        self.setFirstSectionMovable(True)
        self.setSortIndicatorShown(False)
        self.setMinimumSectionSize(30)
        self.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.setAccessibleName(tr("Columns"))
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.customContextMenuRequested.connect(self._ask)
        self.sectionClicked.connect(lambda n: self.sort_wanted.emit(COLUMNS[n].order))
        self.as_usual()
        for changed in (self.sectionResized, self.sectionMoved):
            changed.connect(lambda *_: self.arranged.emit())

    def as_usual(self) -> None:
        """Show the columns that are there at first, as they are then."""
        for n, column in enumerate(COLUMNS):
            self.moveSection(self.visualIndex(n), n)
            self.resizeSection(n, column.width)
            self.setSectionHidden(n, not column.shown)

    def show_order(self, order: str, backwards: bool) -> None:
        """Report by an arrow what is sorted by."""
        shown = (n for n, c in enumerate(COLUMNS) if c.order == order and not self.isSectionHidden(n))
        place = next(shown, -1)
        down, up = Qt.SortOrder.DescendingOrder, Qt.SortOrder.AscendingOrder
        self.setSortIndicatorShown(place >= 0)
        self.setSortIndicator(place, down if backwards else up)

    def fill(self, menu: QMenu) -> None:
        """Put the columns into a menu, each to be shown or hidden; the name stays."""
        for n, column in enumerate(COLUMNS):
            action = menu.addAction(tr("Favourites") if column.id == "favourite" else column.title)
            action.setCheckable(True)
            action.setChecked(not self.isSectionHidden(n))
            action.setEnabled(column.id != "name")
            action.toggled.connect(lambda on, n=n: self.set_shown(n, on))
        menu.addSeparator()
        menu.addAction(tr("Reset columns"), self.as_usual)

    def set_shown(self, place: int, on: bool) -> None:
        """Show a column, or hide it."""
        self.setSectionHidden(place, not on)
        self.arranged.emit()

    def _ask(self, at: QPoint) -> None:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.fill(menu)
        menu.exec(self.mapToGlobal(at))
