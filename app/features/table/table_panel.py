"""The panel with the table of all actions and clips: search, named filters, replacing, what was refused."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import partial

from PySide6.QtCore import QPoint, QSettings, Qt
from PySide6.QtGui import QGuiApplication, QResizeEvent
from PySide6.QtWidgets import (
    QApplication,
    QBoxLayout,
    QHBoxLayout,
    QInputDialog,
    QLabel,
    QLineEdit,
    QMenu,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.table.cell_words import TITLES
from app.features.table.from_names_row import FromNamesRow
from app.features.table.replace_row import ReplaceRow
from app.features.table.table_filter import WHICH, TableFilter, Which, keep_filters, read_filters
from app.features.table.table_model import TableModel
from app.features.table.table_view import TableView
from app.look.theme import get_theme
from app.project.document import Document
from app.shell.verbs import Verbs
from app.stage.session import StageSession
from app.translation import make_lazy_texts, tr, tr_error, tr_plural
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox
from app.widgets.soon import Soon
from metagraph.graph.model import Project
from metagraph.playback.action_table import COLUMNS, Cell, read_cell, write_cells
from metagraph.playback.name_fields import NamePattern, fill_from_names

TITLES_OF: Mapping[Which, str] = make_lazy_texts(
    lambda: {
        "all": tr("All"),
        "actions": tr("Actions"),
        "waiting": tr("Half labelled"),
        "unplaced": tr("Clips without an action"),
    }
)
REASONS = 3  # reasons of refusals that are listed
HIDDEN_FIRST = "clip"  # mostly the same as the name
_HIDDEN_KEY = "table/hidden"

SOUGHT = 170  # pixels of the search field, at least


class TablePanel(QWidget):
    """Selecting rows selects their actions, or their clips where they have none, and the other way round."""

    def __init__(
        self, document: Document, session: StageSession, verbs: Verbs, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self._selecting = self._behind = self._writing = False
        self._column = COLUMNS.index("kind")  # in which what was found is edited
        self.rows = TableModel(get_theme(session.look.name))
        self.view = TableView(self.rows, self)
        self.view.written.connect(self.write)
        self.view.selectionModel().selectionChanged.connect(self._selected)
        self.view.horizontalHeader().setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.view.horizontalHeader().customContextMenuRequested.connect(self._choose_columns)
        self.replacing = ReplaceRow(self)
        self.replacing.hide()
        self.replacing.wanted.connect(self.replace)
        self.replacing.sought_changed.connect(self._count)
        self.naming = FromNamesRow(self)
        self.naming.hide()
        self.naming.wanted.connect(self.fill_from_names)
        self.naming.pattern_changed.connect(self._count)
        self.message = QLabel(self, wordWrap=True)
        self.message.hide()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, 8, 12, 8)
        layout.addLayout(self._make_bar())
        layout.addWidget(self.replacing)
        layout.addWidget(self.naming)
        layout.addWidget(self.view, 1)
        layout.addWidget(self.message)
        self._show_columns()
        self._fresh = Soon(self.refresh, self)
        self.view.itemDelegate().closeEditor.connect(self._catch_up)
        document.changed.connect(self._edited)
        document.loaded.connect(self._forget_edits)
        session.selection.changed.connect(self._follow)
        session.look.changed.connect(self._restyle)
        self._offer(verbs)
        self.rows.project = document.project
        self.rows.show_filter(self.rows.filter)
        self._count()
        self._follow()

    def _changing(self) -> tuple[QWidget, ...]:
        return self.fill, self.names_button, self.replace_button, self.count

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put what changes cells under what finds them, where a line has no room for both."""
        super().resizeEvent(event)
        parts = (self.which, self.kept, *self._changing())
        needed = SOUGHT + sum(part.sizeHint().width() + 8 for part in parts) + 24
        directions = QBoxLayout.Direction
        wide = needed <= event.size().width()
        self._bar.setDirection(directions.LeftToRight if wide else directions.TopToBottom)

    def _make_bar(self) -> QBoxLayout:
        self.search = QLineEdit(self, clearButtonEnabled=True)
        self.search.setPlaceholderText(tr("Search names and labels"))
        self.search.setToolTip(tr("Words of any cell: sit gesture, sit -loop, sit | bow"))
        self.search.setAccessibleName(tr("Search the table"))
        self.search.textChanged.connect(self._filter)
        self.search.returnPressed.connect(self.select_found)
        self.which = ComboBox(self)
        for which in WHICH:
            self.which.addItem(TITLES_OF[which], which)
        self.which.setAccessibleName(tr("Which rows"))
        self.which.setToolTip(tr("Show all rows, or only some"))
        self.which.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToContents)
        self.which.currentIndexChanged.connect(self._filter)
        self.kept = make_widget(QToolButton, self, text=tr("Filters"))
        self.kept.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.kept.setToolTip(tr("Use a filter again, or give this one a name"))
        menu = QMenu(self.kept)
        menu.aboutToShow.connect(lambda: self._fill_filters(menu))
        self.kept.setMenu(menu)
        self.fill = QPushButton(tr("Fill down"), self)
        self.fill.setToolTip(tr("Write what the first selected cell says into those below it (Ctrl+D)"))
        self.fill.clicked.connect(self.view.fill_down)
        self.names_button = make_widget(QToolButton, self, text=tr("From names…"), checkable=True)
        self.names_button.setToolTip(tr("Fill stances and other fields from parts of the clips' names"))
        self.names_button.toggled.connect(self._show_naming)
        self.replace_button = make_widget(QToolButton, self, text=tr("Replace…"), checkable=True)
        self.replace_button.toggled.connect(self._show_replacing)
        self.count = QLabel(self)
        self.count.setProperty("dim", True)
        self.search.setMinimumWidth(SOUGHT)
        self._bar = bar = QBoxLayout(QBoxLayout.Direction.LeftToRight)
        bar.setSpacing(8)
        finding, changing = QHBoxLayout(), QHBoxLayout()
        for row, widgets in ((finding, (self.search, self.which, self.kept)), (changing, self._changing())):
            row.setSpacing(8)
            for widget in widgets:
                row.addWidget(widget, 1 if widget is self.search else 0)
            bar.addLayout(row, 1 if row is finding else 0)
        for button in (self.kept, self.fill, self.names_button, self.replace_button):
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # after a click the cells keep the keyboard
        return bar

    def _offer(self, verbs: Verbs) -> None:
        """Copy, paste, empty, select and edit (F2) cells while they have the keyboard, and find rows."""
        has_keys = self.view.hasFocus
        verbs.offer("find", self._has_focus, self.start_search, rank=0)
        verbs.offer("copy", has_keys, self.copy, rank=0)
        verbs.offer("paste", has_keys, self.paste, rank=0)
        verbs.offer("remove", has_keys, self.view.clear_cells, rank=0)
        verbs.offer("select_all", has_keys, self.view.selectAll, rank=0)
        verbs.offer("rename", has_keys, self.view.edit_current, rank=0)

    def _has_focus(self) -> bool:
        return self.isAncestorOf(QApplication.focusWidget() or self.window())

    def start_search(self) -> None:
        """Type what rows are searched for."""
        self.search.setFocus()
        self.search.selectAll()

    def select_found(self) -> None:
        """Select all rows shown, in the column that was edited last: what is typed next goes there."""
        if self.rows.rows:
            self.view.setFocus()
            self.view.select_column(self._column)

    def take_focus(self) -> None:
        """Give the cells the keyboard."""
        if not self.view.currentIndex().isValid() and self.rows.rows:
            self.view.setCurrentIndex(self.rows.index(0, COLUMNS.index("kind")))
        self.view.setFocus()

    # --- edits

    def write(self, cells: Mapping[Cell, str]) -> None:
        """Write texts into cells, as one step; say which could not be written, and mark them."""
        written = write_cells(self.document.project, cells)
        columns = {column for _, column in cells}
        if len(columns) == 1:
            self._column = COLUMNS.index(next(iter(columns)))
        what = TITLES[next(iter(columns))] if len(columns) == 1 else tr("cells")
        self._writing = True
        self.document.edit(tr("Edit {what} in the table", what=what), lambda _: written.project)
        self._writing = False
        self.rows.show_refused(written.refused)
        self._say(written.refused, len(written.cut))

    def copy(self) -> None:
        """Put the selected cells on the clipboard."""
        QGuiApplication.clipboard().setText(self.view.copy_text())

    def paste(self) -> None:
        """Write what is on the clipboard from the first selected cell on."""
        lost = self.view.paste_text(QGuiApplication.clipboard().text())
        if lost:
            words = tr_plural(
                "{count:,} pasted cell had no place: the table ends before it.",
                "{count:,} pasted cells had no place: the table ends before them.",
                lost,
            )
            self._show_message(
                f"{self.message.text()} {words}".strip() if self.message.isVisible() else words
            )

    def replace(self, column: str, sought: str, put: str) -> None:
        """Replace words in the selected cells of a column, or in all if only one or none is selected."""
        pattern = re.compile(re.escape(sought), re.IGNORECASE)
        texts: dict[Cell, str] = {}
        for row in self._replaced_rows():
            index = self.rows.index(row, self.replacing.chosen_column())
            words = self.rows.text(index)
            if index.flags() & Qt.ItemFlag.ItemIsEditable and pattern.search(words):
                texts[self.rows.cell(index)] = self.rows.typed(index, pattern.sub(lambda _: put, words))
        if texts:
            self.write(texts)
        self._count()

    def fill_from_names(self, pattern: NamePattern) -> None:
        """Fill fields from the names of the selected rows, or of all if only one or none is selected."""
        rows = [self.rows.rows[n] for n in self._replaced_rows()]
        filled = fill_from_names(self.document.project, rows, pattern)
        places = {row.ident: n for n, row in enumerate(self.rows.rows)}
        texts = {
            (ident, column): self.rows.typed(self.rows.index(places[ident], COLUMNS.index(column)), text)
            for (ident, column), text in filled.items()
        }
        if texts:
            self.write(texts)
        self._count()

    def _replaced_rows(self) -> list[int]:
        chosen = self.view.selected_rows()
        return chosen if len(chosen) > 1 else list(range(len(self.rows.rows)))

    def _say(self, refused: Mapping[Cell, str], cut: int) -> None:
        words = []
        if refused:
            words.append(
                tr_plural(
                    "{count:,} cell was left as it was. {reasons}.",
                    "{count:,} cells were left as they were. {reasons}.",
                    len(refused),
                    reasons="; ".join(self._list_reasons(refused)),
                )
            )
        if cut:
            words.append(
                tr_plural(
                    "{count:,} blend was longer than its action and was cut to it.",
                    "{count:,} blends were longer than their actions and were cut to them.",
                    cut,
                )
            )
        self._show_message(" ".join(words))

    def _list_reasons(self, refused: Mapping[Cell, str]) -> list[str]:
        """Return where cells were refused and why, each reason once and at most `REASONS`."""
        project, first = self.document.project, dict[str, Cell]()
        for cell, why in refused.items():
            first.setdefault(why, cell)
        out = []
        for why, (ident, column) in list(first.items())[:REASONS]:
            found = project.action(ident) or project.clips.get(ident)
            name = found.name if found is not None else "?"
            where = tr("{name}, {column}", name=name, column=TITLES[column])
            out.append(f"{where}: {tr_error(ValueError(why))}")
        return [*out, "…"] if len(first) > REASONS else out

    def _show_message(self, words: str) -> None:
        self.message.setText(words)
        self.message.setVisible(bool(words))

    # --- what is shown

    def refresh(self) -> None:
        """Show the project as it is now, with the same cells selected; once no cell is being edited."""
        if self.view.is_editing():
            self._behind = True
            return
        self._behind = False
        chosen = {self.rows.cell(i) for i in self.view.selectedIndexes()}
        at = self.view.currentIndex()
        current = self.rows.cell(at)[0] if at.isValid() else ""
        before = [row.ident for row in self.rows.rows]
        self._selecting = True
        self.rows.show_project(self.document.project)
        if before != [row.ident for row in self.rows.rows]:
            self._select_again(chosen, current, at.column())
        self._selecting = False
        self._count()

    def _catch_up(self) -> None:
        """Show what changed while a cell was edited."""
        if self._behind:
            self._fresh.ask()

    def _select_again(self, chosen: set[Cell], current: str, column: int) -> None:
        """Select cells after rows came or went; a clip that has become an action stays selected."""
        model = self.view.selectionModel()
        for n, row in enumerate(self.rows.rows):
            for name in COLUMNS:
                if (row.ident, name) in chosen or (row.clip, name) in chosen:
                    model.select(self.rows.index(n, COLUMNS.index(name)), model.SelectionFlag.Select)
            if current in (row.ident, row.clip):
                model.setCurrentIndex(self.rows.index(n, column), model.SelectionFlag.NoUpdate)

    def _filter(self) -> None:
        self.rows.show_refused({})
        self.rows.show_filter(TableFilter(self.search.text(), self.which.currentData()))
        self._count()
        self._follow()

    def _count(self) -> None:
        shown = len(self.rows.rows)
        self.view.show_empty_words(
            tr("No row matches. Clear the search, or choose All.")
            if self.rows.filter != TableFilter()
            else tr("Import clips to edit their labels and timing here.")
        )
        self.count.setText(tr_plural("{count:,} row", "{count:,} rows", shown))
        if self.replacing.isVisible():
            sought, column = self.replacing.sought.text().casefold(), self.replacing.chosen_column()
            cells = [self.rows.index(row, column) for row in self._replaced_rows()] if sought else []
            self.replacing.show_count(sum(sought in self.rows.text(i).casefold() for i in cells))
        if self.naming.isVisible():
            self._show_fitting()

    def _show_fitting(self) -> None:
        """Say which names fit the pattern that is typed."""
        pattern = self.naming.read()
        if pattern is None:
            self.naming.show_nothing()
            return
        rows = [self.rows.rows[n] for n in self._replaced_rows()]
        project = self.document.project
        filled = fill_from_names(project, rows, pattern)
        fitting = [row for row in rows if (row.ident, pattern.columns[0]) in filled]
        new = [
            row
            for row in fitting
            if any(filled[row.ident, c] != read_cell(project, row, c) for c in pattern.columns)
        ]
        first = {c: filled[new[0].ident, c] for c in pattern.columns} if new else {}
        name = project.clips[new[0].clip].name if new else ""
        self.naming.show_fitting(len(new), len(fitting), name, first)

    def _fill_filters(self, menu: QMenu) -> None:
        menu.clear()
        filters = read_filters()
        for name, rule in filters.items():
            menu.addAction(name, partial(self.use_filter, rule))
        if filters:
            menu.addSeparator()
        menu.addAction(tr("Keep this filter…"), self._name_filter).setEnabled(
            self.rows.filter != TableFilter()
        )
        if filters:
            gone = menu.addMenu(tr("Forget"))
            for name in filters:
                gone.addAction(name, partial(self._forget_filter, name))

    def use_filter(self, rule: TableFilter) -> None:
        """Show the rows that a filter takes."""
        self.search.setText(rule.text)
        self.which.setCurrentIndex(WHICH.index(rule.which))

    def _name_filter(self) -> None:
        name, accepted = QInputDialog.getText(
            self, tr("Keep this filter"), tr("Name:"), text=self.rows.filter.text
        )
        if accepted and name.strip():
            keep_filters({**read_filters(), name.strip(): self.rows.filter})

    def _forget_filter(self, name: str) -> None:
        keep_filters({n: rule for n, rule in read_filters().items() if n != name})

    def _show_naming(self, on: bool) -> None:
        self.naming.setVisible(on)
        self._count()
        if on:
            self.replace_button.setChecked(False)
            self.naming.pattern.setFocus()

    def _show_replacing(self, on: bool) -> None:
        self.replacing.setVisible(on)
        self._count()
        if on:
            self.names_button.setChecked(False)
            self.replacing.sought.setFocus()

    def _show_columns(self) -> None:
        hidden = str(QSettings().value(_HIDDEN_KEY, HIDDEN_FIRST)).split(",")
        for place, column in enumerate(COLUMNS):
            self.view.setColumnHidden(place, column in hidden)

    def _choose_columns(self, at: QPoint) -> None:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for place, column in enumerate(COLUMNS[1:], 1):
            action = menu.addAction(TITLES[column])
            action.setCheckable(True)
            action.setChecked(not self.view.isColumnHidden(place))
            action.toggled.connect(partial(self._show_column, place))
        menu.popup(self.view.horizontalHeader().mapToGlobal(at))

    def _show_column(self, place: int, on: bool) -> None:
        self.view.setColumnHidden(place, not on)
        hidden = [c for n, c in enumerate(COLUMNS) if self.view.isColumnHidden(n)]
        QSettings().setValue(_HIDDEN_KEY, ",".join(hidden))

    # --- beside the rest of the window

    def _edited(self, before: Project, after: Project) -> None:
        if (
            before.graphs is not after.graphs
            or before.clips is not after.clips
            or before.marks != after.marks
        ):
            self._fresh.ask()
        if not self._writing:  # what was refused before is no longer about the present
            self._forget_refused()

    def _forget_edits(self) -> None:
        """Begin with another project."""
        self._column = COLUMNS.index("kind")
        self._forget_refused()

    def _forget_refused(self) -> None:
        if self.rows.refused or not self.message.isHidden():
            self.rows.show_refused({})
            self._show_message("")

    def _selected(self) -> None:
        """Select what the rows stand for."""
        self._count()
        if self._selecting or not self.view.hasFocus():
            return
        rows = [self.rows.rows[n] for n in self.view.selected_rows()]
        actions = tuple(row.ident for row in rows if row.action is not None)
        self._selecting = True
        if actions:
            self.session.selection.select_actions(actions)
        else:
            self.session.selection.select_clips(tuple(row.ident for row in rows))
        self._selecting = False

    def _follow(self) -> None:
        """Select the rows of what was selected elsewhere."""
        if self._selecting:
            return
        self._fresh.now()
        selection = self.session.selection
        clips = set(selection.clips)
        idents = set(selection.actions) | clips
        rows = [n for n, row in enumerate(self.rows.rows) if row.ident in idents or row.clip in clips]
        self._selecting = True
        self.view.select_rows(rows)
        self._selecting = False

    def _restyle(self) -> None:
        self.rows.look = get_theme(self.session.look.name)
        self.rows.show_refused(self.rows.refused)
