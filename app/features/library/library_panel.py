"""The clip library: thumbnails, search, filters; clips are dragged from here, files and folders dropped onto
it.
"""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import (
    QItemSelection,
    QItemSelectionModel,
    Qt,
    Signal,
)
from PySide6.QtGui import (
    QActionGroup,
    QDragEnterEvent,
    QDropEvent,
)
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QPushButton,
    QStackedLayout,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.library.clip_acts import ClipActs
from app.features.library.clip_card import CardDelegate
from app.features.library.clip_list import ClipList, Search
from app.features.library.clip_model import ENTRY, ClipModel, Filter, FilterModel
from app.features.library.clip_names import ClipNames
from app.features.library.clip_order import GIVEN, ORDERS
from app.look.theme import KIND_MARKS
from app.project.document import Document
from app.project.load import readable
from app.stage.session import Session
from app.stage.thumbnails import Thumbnails
from app.widgets.flow import Flow
from app.widgets.making import make_widget
from app.widgets.more_button import MoreButton
from app.widgets.one_stop import OneStop
from metagraph.graph.model import KINDS, LAYERS, ClipEntry, Kind, Project

EMPTY = "Drop a folder of clips here\n\n{}"


class LibraryPanel(QWidget):
    """import_wanted: the user asks for a folder. files_dropped: paths to import."""

    import_wanted = Signal()
    files_dropped = Signal(object)

    def __init__(
        self, document: Document, session: Session, thumbnails: Thumbnails, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.thumbnails = document, session, thumbnails
        self.acts = ClipActs(document, session, self)
        self.model = ClipModel(document)
        self.proxy = FilterModel(self.model)
        names = ClipNames(document, self.proxy)
        self.search = Search(self)
        self.search.textChanged.connect(self._refilter)
        self.list = ClipList(session, thumbnails, names, self)
        self.list.setModel(self.proxy)
        self.list.setItemDelegate(CardDelegate(document, session.look, thumbnails, names, self.list))
        self.list.menu_wanted.connect(lambda entry, at: self.acts.menu(entry).exec(at))
        self.list.files_dropped.connect(self.files_dropped)
        self.search.left.connect(self._into_list)
        self._following = False
        selection = self.list.selectionModel()
        selection.selectionChanged.connect(self._selected)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 4, 0)
        layout.setSpacing(6)
        filters, top = self._filters(), QHBoxLayout()
        top.addWidget(self.search, 1)
        top.addWidget(self.more)  # beside the chips it would not fit where counts are long
        layout.addLayout(top)
        layout.addLayout(filters)
        self.stack = QStackedLayout()
        self.stack.addWidget(self.list)
        self.stack.addWidget(self._empty())
        layout.addLayout(self.stack, 1)
        self.setAcceptDrops(True)
        document.changed.connect(self._follow)
        document.loaded.connect(self.forget)
        session.selection.changed.connect(self._show_selection)
        thumbnails.ready.connect(lambda _: self.list.viewport().update())
        session.look.changed.connect(self.list.viewport().update)
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
        tip = "Show the clips of a layer or kind only, or sort them"
        self.more = MoreButton(self.session.look, "Layer or kind", tip, self)
        menu = self.more.menu_of
        menu.addAction("Any kind, any layer", lambda: self._narrow(None, None))
        menu.addSeparator()
        for kind in KINDS:
            menu.addAction(f"{KIND_MARKS[kind]}  {kind.capitalize()}", partial(self._narrow, None, kind))
        menu.addSeparator()
        for layer in LAYERS:
            menu.addAction(f"{layer.capitalize()} layer", partial(self._narrow, layer, None))
        menu.addSeparator()
        self.orders = menu.addMenu("&Sort by")
        group = QActionGroup(self)
        for order, (words, _) in ORDERS.items():
            action = self.orders.addAction(words, partial(self.sort, order))
            action.setCheckable(True)
            action.setChecked(order == GIVEN)
            action.setData(order)
            group.addAction(action)
        self.orders.addSeparator()
        self.backwards = self.orders.addAction("The other way &round", lambda: self.sort(self.proxy.order))
        self.backwards.setCheckable(True)
        OneStop(tuple(self.chips.values()), self)
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

    def sort(self, order: str) -> None:
        """List the clips in one of `clip_order.ORDERS`."""
        for action in self.orders.actions():
            if action.data() is not None:
                action.setChecked(action.data() == order)
        self._following = True  # what is chosen stays chosen
        self.proxy.set_order(order, self.backwards.isChecked())
        self._following = False
        self._show_selection()

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
        ids = [i for i in self.proxy.listed() if i == clip or self._open(project.clips[i], filtered)]
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
        self.backwards.setChecked(False)
        self.sort(GIVEN)
        self._narrow(None, None)
        self._chip("all")

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
