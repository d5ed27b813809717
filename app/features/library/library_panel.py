"""The clip library: thumbnails, search, filters, groups; clips are dragged from here, files and folders
dropped onto it. What is shown is one flow: filter, order, groups (`clip_rows`), places (`clip_layout`),
drawing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from PySide6.QtCore import QItemSelection, QItemSelectionModel, Qt, QTimer, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent
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
from app.features.library.clip_delegate import ClipDelegate
from app.features.library.clip_facts import ClipFacts
from app.features.library.clip_filter import Filter
from app.features.library.clip_list import ClipList
from app.features.library.clip_names import ClipNames
from app.features.library.clip_order import GIVEN
from app.features.library.clip_pictures import ClipPictures
from app.features.library.clip_rows import ENTRY, ClipRows
from app.features.library.clip_sizes import Style
from app.features.library.library_bar import LibraryBar
from app.features.library.library_menu import LibraryMenu
from app.features.library.library_settings import LibrarySettings
from app.features.library.search_field import Search
from app.project.document import Document
from app.project.load import describe_readable_formats
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from app.translation import tr, tr_noop, tr_plural
from app.widgets.drop_frame import DropFrame
from app.widgets.flow import FlowLayout
from app.widgets.making import make_widget
from app.widgets.more_button import MoreButton
from app.widgets.one_stop import OneStop
from metagraph.graph.model import ClipEntry, Project
from metagraph.graph.problem import Problem

EMPTY = tr_noop("Drop a folder of clips here\n\n{}")
PLACED = {"all": None, "unlabelled": False, "labelled": True}  # what the chips ask for
MENU_ASKS = ("layer", "kind", "color", "stars", "favourite", "noted", "broken")
AHEAD = 20  # clips looked at in one go for what they move


class LibraryPanel(QWidget):
    """import_wanted: the user asks for a folder. files_dropped: paths to import. problems: those of the
    project as it is now.
    """

    import_wanted = Signal()
    files_dropped = Signal(object)

    def __init__(
        self,
        document: Document,
        session: StageSession,
        thumbnails: Thumbnails,
        parent: QWidget | None = None,
        problems: Callable[[], Iterable[Problem]] = tuple,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.thumbnails = document, session, thumbnails
        self.settings = LibrarySettings()
        self.facts = ClipFacts(document, problems)
        self.acts = ClipActs(document, session, self)
        self.rows = ClipRows(self.facts)
        self.rows.show(replace(self.rows.listing, group=self.settings.group()))
        names = ClipNames(document, self.rows)
        self.search = Search(self)
        self.search.textChanged.connect(self._refilter)
        pictures = ClipPictures(thumbnails)
        delegate = ClipDelegate(session.look, self.facts, pictures, names)
        self.list = ClipList(session, self.rows, delegate, self)
        self.drop_frame = DropFrame(self, session.look, tr("Drop to import clips"))
        self.list.menu_wanted.connect(lambda entry, at: self.acts.menu(entry).exec(at))
        self.list.files_dropped.connect(self.files_dropped)
        self.search.left.connect(self._into_list)
        self._following = False
        selection = self.list.selectionModel()
        selection.selectionChanged.connect(self._selected)
        self.rows.modelAboutToBeReset.connect(self._hold)
        self.rows.modelReset.connect(self._show_again)
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
        self.bar = LibraryBar(session.look, self)
        self.bar.changed.connect(self.show_as)
        self.list.zoomed.connect(self.bar.step)
        layout.addWidget(self.bar)
        self.list.header.sort_wanted.connect(self._sort_by_title)
        self.list.header.arranged.connect(self._keep_columns)
        self.setAcceptDrops(True)
        self._soon = QTimer(self, interval=0)  # looks at what clips move, while there is nothing else to do
        self._soon.timeout.connect(self._look_ahead)
        document.changed.connect(self._follow)
        document.loaded.connect(self.forget)
        session.selection.changed.connect(self._show_selection)
        thumbnails.ready.connect(self._picture_came)
        session.look.changed.connect(self.list.viewport().update)
        self.restore()
        self._count()

    def _filters(self) -> FlowLayout:
        row = FlowLayout()
        self.chips: dict[str, QToolButton] = {}

        def chip(key: str, text: str, tip: str) -> None:
            button = make_widget(QToolButton, self, text=text, toolTip=tip, checkable=True)
            button.setProperty("tight", True)
            button.clicked.connect(lambda _=False, k=key: self._chip(k))
            self.chips[key] = button
            row.addWidget(button)

        chip("all", tr("All"), tr("All clips"))
        chip("unlabelled", tr("Unlabelled"), tr("Clips that are not in the graph yet"))
        chip("labelled", tr("Placed"), tr("Clips that are in the graph"))
        tip = tr("Filter, sort and group the clips")
        self.more = MoreButton(self.session.look, tr("Filter and sort"), tip, self)
        self.menu = LibraryMenu(self, self.more.menu_of)
        self.orders, self.backwards = self.menu.orders, self.menu.backwards
        OneStop(tuple(self.chips.values()), self)
        self.chips["all"].setChecked(True)
        return row

    # --- how clips are shown

    def show_as(self, style: Style, side: int = -1) -> None:
        """Show cards or columns, with pictures of so many pixels, -1 for as it was; it is kept for this
        person.
        """
        side = side if side > 0 else self.settings.side(style)
        self.settings.keep_size(style, side)
        self._show_as(style, side)

    def _show_as(self, style: Style, side: int) -> None:
        self.list.show_as(style, side)
        self.bar.show_choice(style, side)
        if style == "columns":
            self._soon.start()

    def restore(self) -> None:
        """Show clips as this person had them last."""
        style = self.settings.style()
        columns = self.settings.columns()
        self._restoring = True
        if columns is None or not self.list.header.restoreState(columns):
            self.list.header.as_usual()
        self._restoring = False
        self._show_as(style, self.settings.side(style))
        self.rows.show(replace(self.rows.listing, group=self.settings.group()))
        self.menu.check(self.menu.groups, self.rows.listing.group)

    def _keep_columns(self) -> None:
        if not self._restoring:
            self.settings.keep_columns(self.list.header.saveState())

    _restoring = False

    def group_by(self, group: str) -> None:
        """Put clips into groups, of `clip_groups.GROUPS`; it is kept for this person."""
        self.settings.keep_group(group)
        self.menu.check(self.menu.groups, group)
        self.rows.show(replace(self.rows.listing, group=group))

    def close_all(self) -> None:
        """Let every group show its title only."""
        self.rows.close_groups(frozenset(s.title for s in self.rows.sections if s.title))

    def _sort_by_title(self, order: str) -> None:
        """Sort by what a column's title stands for; once more, the other way round."""
        listing = self.rows.listing
        self.backwards.setChecked(order == listing.order and not listing.backwards)
        self.sort(order)

    def _look_ahead(self) -> None:
        unknown = self.facts.unknown()
        if not unknown or self.list.style_of != "columns":
            self._soon.stop()
        self.facts.ahead(unknown[:AHEAD])

    def problems_changed(self) -> None:
        """Other problems were found."""
        if self.rows.listing.follows_problems:
            self.rows.arrange()
        if self.list.style_of == "columns":
            self.list.viewport().update()

    def _picture_came(self, clip: str) -> None:
        """Draw a clip whose picture is there, or all where they are to be drawn again."""
        row = self.rows.row_of(clip)
        if row is not None:
            self.list.viewport().update(self.list.visualRect(self.rows.index(row, 0)))
        elif not clip:
            self.list.viewport().update()

    def _empty(self) -> QWidget:
        page = QWidget(self)
        box = QVBoxLayout(page)
        box.addStretch(2)
        self.empty = QLabel(tr(EMPTY).format(describe_readable_formats()), page)
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setProperty("dim", True)
        self.empty.setWordWrap(True)
        box.addWidget(self.empty)
        button = QPushButton(tr("Import a folder…"), page)
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
        self.drop_frame.follow(event)

    def dropEvent(self, event: QDropEvent) -> None:
        self.list.dropEvent(event)

    # --- filtering

    def narrow(self, layer: str | None = None, kind: str | None = None) -> None:
        """Show the clips of a layer or kind alone; without, all that are not filtered otherwise."""
        if layer is None and kind is None:
            self.ask_for(**{f: getattr(Filter(), f) for f in MENU_ASKS})
        else:
            self.ask_for(layer=layer, kind=kind)

    def ask_for(self, **changes: Any) -> None:
        """Show only clips of which more is true, or less: fields of `Filter`."""
        self._set_filter(replace(self.rows.filter, **changes))

    def show_filter(self, rule: Filter) -> None:
        """Show what a filter says, in the field and the chips, too."""
        self._following = True
        self.search.setText(rule.text)
        self._following = False
        self._press(next(k for k, v in PLACED.items() if v is rule.labelled))
        self._set_filter(rule)

    def sort(self, order: str) -> None:
        """List the clips in one of `clip_order.ORDERS`."""
        self.menu.check(self.orders, order)
        backwards = self.backwards.isChecked()
        self.rows.show(replace(self.rows.listing, order=order, backwards=backwards))
        self.list.header.show_order(order, backwards)

    def _press(self, key: str) -> None:
        for name, button in self.chips.items():
            button.setChecked(name == key)

    def _chip(self, key: str) -> None:
        self._press(key)
        self._refilter()

    def _refilter(self, *_: object) -> None:
        if not self._following:
            checked = next((k for k, b in self.chips.items() if b.isChecked()), "all")
            self.ask_for(text=self.search.text(), labelled=PLACED[checked])

    def _set_filter(self, rule: Filter) -> None:
        self.more.show_words(rule.words())
        self.rows.show(replace(self.rows.listing, filter=rule))
        if self.session.selection.clips:  # what is not seen is not chosen
            self._selected()
        self._count()

    def _count(self) -> None:
        project = self.document.project
        total = len(project.clips)
        loose = sum(1 for c in project.clips if c not in project.uses and c not in project.drawn)
        self.chips["unlabelled"].setText(tr("Unlabelled {loose}", loose=loose) if total else tr("Unlabelled"))
        self.search.setPlaceholderText(
            tr("Search {clips}", clips=tr_plural("{count:,} clip", "{count:,} clips", total))
            if total
            else tr("Search")
        )
        nothing = not total
        found = len(self.rows.entries)
        hidden = bool(total) and found == 0
        self.bar.told.setText(tr("{found} of {total}", found=found, total=total) if 0 < found < total else "")
        self.empty_button.setVisible(nothing)
        if hidden:
            self.empty.setText(tr("No clip matches.\nClear the search or the filters."))
        else:
            self.empty.setText(tr(EMPTY).format(describe_readable_formats()))
        self.stack.setCurrentIndex(1 if nothing or hidden else 0)

    def next_unlabelled(self, clip: str) -> str | None:
        """Return the clip that comes after one, as they are listed, and serves as nothing yet; from the first
        on where none comes after it. None if there is no other.
        """
        project, filtered = self.document.project, self.rows.filter
        ids = [i for i in self.rows.listed() if i == clip or self._open(project.clips[i], filtered)]
        at = ids.index(clip) if clip in ids else -1
        return next((i for i in (*ids[at + 1 :], *ids[: max(0, at)]) if i != clip), None)

    def _open(self, entry: ClipEntry, rule: Filter) -> bool:
        """Return whether a clip serves as nothing yet, and is looked for."""
        project = self.document.project
        used = entry.id in project.uses or entry.id in project.drawn
        return not used and Filter(rule.text).takes(self.facts, entry)

    def forget(self) -> None:
        """Show all clips: what was searched was of another project."""
        self.search.clear()
        self.backwards.setChecked(False)
        self.sort(GIVEN)
        self.narrow()
        self._chip("all")

    # --- selection

    def _into_list(self) -> None:
        """Give the keyboard to the clips, the first one chosen unless one is already."""
        if self.rows.entries:
            self.list.setFocus(Qt.FocusReason.TabFocusReason)
            if not self.list.selectedIndexes():
                first = self.list.layout_of.beside(-1, 0)
                self.list.setCurrentIndex(self.rows.index(first, 0))

    def _selected(self, *_: QItemSelection) -> None:
        if self._following:
            return
        chosen = sorted(i.row() for i in self.list.selectedIndexes())
        self._following = True
        self.session.selection.select_clips(tuple(self.rows.entries[row].id for row in chosen))
        self._following = False

    def _hold(self) -> None:
        """Other rows come: what is chosen stays so, and what is current."""
        index = self.list.currentIndex()
        self._held = index.data(ENTRY).id if index.isValid() else None
        self._following = True

    _held: str | None = None

    def _show_again(self) -> None:
        self.list.relayout()
        self._following = False
        self._show_selection()
        row = self.rows.row_of(self._held) if self._held is not None else None
        if row is not None and not self.list.currentIndex().isValid():
            none = QItemSelectionModel.SelectionFlag.NoUpdate
            self.list.selectionModel().setCurrentIndex(self.rows.index(row, 0), none)

    def _show_selection(self) -> None:
        """Follow the session: selected clips, or the clips of selected actions faintly by scrolling to the
        first.
        """
        if self._following:
            return
        self._following = True
        wanted = self.session.selection.clips
        if not wanted:
            self.list.clearSelection()
            self._following = False
            return
        rows = sorted(r for r in map(self.rows.row_of, wanted) if r is not None)
        self.list.select_rows(rows)
        if rows and len(wanted) == 1:
            index = self.rows.index(rows[0], 0)
            self.list.selectionModel().setCurrentIndex(index, QItemSelectionModel.SelectionFlag.NoUpdate)
            self.list.scrollTo(index)
        self._following = False

    def _follow(self, before: Project, after: Project) -> None:
        if (
            before.clips is not after.clips
            or before.graphs is not after.graphs
            or before.manual is not after.manual
            or before.marks is not after.marks
        ):
            self._count()
        if before.base != after.base:
            self.list.viewport().update()
        if before.clips is not after.clips and self.list.style_of == "columns":
            self._soon.start()
