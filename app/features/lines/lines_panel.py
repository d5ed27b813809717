"""The lines panel: the dialogue an agent calls by its ids, with text and sound; each can be said now."""

from __future__ import annotations

from pathlib import Path

import msgspec
from PySide6.QtCore import QEvent, QItemSelection, QItemSelectionModel, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QDragEnterEvent,
    QDragMoveEvent,
    QDropEvent,
    QKeyEvent,
    QResizeEvent,
    QShowEvent,
)
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFileDialog,
    QHeaderView,
    QLabel,
    QLineEdit,
    QTableWidget,
    QTableWidgetItem,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.lines.line_files import LISTS, SOUNDS, Lines, add_lines, read_lines
from app.look.theme import WindowTheme, get_theme
from app.project.chosen import keep_chosen
from app.project.document import Document, Edit
from app.project.jobs import Jobs
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.translation import format_number, make_lazy_texts, tr, tr_error, tr_noop, tr_phrase, tr_plural
from app.widgets.drop_frame import DropFrame
from app.widgets.flow import FlowLayout
from app.widgets.making import make_widget
from metagraph.common.studio import find_start_folder
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import Project
from metagraph.graph.requests import Line, Say
from metagraph.playback.planning.line_lengths import find_spoken_seconds

COLUMNS = make_lazy_texts(lambda: (tr("Id"), tr("Words"), tr("Sound"), tr("Length"), tr("Requests")))
ID, WORDS, SOUND, LENGTH, ASKS = range(5)
WIDEST = 180  # pixels of the ids at most
EMPTY = tr_noop(
    "Drop sound files or a list (CSV: id, text, sound) here.\nAgents say a line by its id, "
    "and the lips follow its sound."
)


class Table(QTableWidget):
    """deleted: the Delete key was pressed. said: Enter was."""

    deleted = Signal()
    said = Signal()

    def event(self, event: QEvent) -> bool:
        mine = (Qt.Key.Key_Delete, Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and event.key() in mine
        ):
            event.accept()  # here they are about lines, not about what is selected elsewhere
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Delete:
            self.deleted.emit()
        elif (
            event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
            and self.state() != QAbstractItemView.State.EditingState
        ):
            self.said.emit()
        else:
            super().keyPressEvent(event)


class LinesPanel(QWidget):
    """told: words about what could not be read."""

    told = Signal(str)

    def __init__(
        self,
        document: Document,
        session: StageSession,
        performance: StagePerformance,
        jobs: Jobs,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.performance, self.jobs = document, session, performance, jobs
        self._filling = False
        self._stale = True  # lines have changed that nobody has seen
        self._rows: dict[int, tuple[object, ...]] = {}  # what each row shows
        self.setAcceptDrops(True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, 6, 12, 6)
        layout.setSpacing(6)
        row = FlowLayout(spacing=6)
        self.search = QLineEdit(self, placeholderText=tr("Search lines"), clearButtonEnabled=True)
        self.search.setAccessibleName(tr("Search lines"))
        self.search.setFixedWidth(170)
        self.search.textChanged.connect(self._search)
        row.addWidget(self.search)
        self.words = QLabel(self)
        self.words.setProperty("dim", True)
        row.addWidget(self.words)
        for text, tip, run in (
            (tr("Say line"), tr("Say the selected line at the playhead (Enter)"), self.say),
            (tr("Add files…"), tr("Add sounds or a list of lines"), self.ask_files),
            (tr("Add text…"), tr("Add a line without sound"), self.add_words),
        ):
            button = make_widget(QToolButton, self, text=text, toolTip=tip)
            button.clicked.connect(run)
            row.addWidget(button)
            if run == self.say:
                self.say_button = button
        layout.addLayout(row)
        self.table = Table(0, len(COLUMNS), self)
        self.table.setTabKeyNavigation(False)  # Tab leaves it, arrows go about in it
        self.table.setHorizontalHeaderLabels(COLUMNS)
        self.table.verticalHeader().hide()
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setEditTriggers(
            QAbstractItemView.EditTrigger.DoubleClicked | QAbstractItemView.EditTrigger.EditKeyPressed
        )
        self.table.setShowGrid(False)
        self.table.setAlternatingRowColors(True)
        header = self.table.horizontalHeader()
        header.setMinimumSectionSize(56)
        header.setSectionResizeMode(WORDS, QHeaderView.ResizeMode.Stretch)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft)
        self.table.setColumnWidth(SOUND, 190)
        self.table.itemChanged.connect(self._typed)
        self.table.itemSelectionChanged.connect(
            lambda: self.say_button.setEnabled(bool(self.table.selectedItems()))
        )
        self.say_button.setEnabled(False)
        self.table.setAccessibleName(tr("Lines"))
        self.table.deleted.connect(self.remove)
        self.table.said.connect(self.say)
        layout.addWidget(self.table, 1)
        self.empty = QLabel(tr(EMPTY), self, alignment=Qt.AlignmentFlag.AlignCenter)
        self.empty.setProperty("dim", True)
        layout.addWidget(self.empty, 1)
        document.changed.connect(self._edited)
        document.loaded.connect(self.search.clear)  # what is not looked for here must not hide lines there
        session.look.changed.connect(self._changed)
        self.drop_frame = DropFrame(self, session.look, tr("Drop to add lines"))

    # --- showing

    def _edited(self, before: Project, after: Project) -> None:
        if before.lines is not after.lines or before.voices is not after.voices:
            self._changed()

    def _changed(self) -> None:
        """Refresh what is seen; what is not waits until it is: some hundred lines take a while."""
        self._stale = True
        if self.isVisible():
            self.refresh()

    def showEvent(self, event: QShowEvent) -> None:
        if self._stale:
            self.refresh()
        super().showEvent(event)

    def refresh(self) -> None:
        """Show the lines as they are."""
        self._stale = False
        project, chosen, look = self.document.project, set(self.chosen()), get_theme(self.session.look.name)
        here = self.table.currentItem()
        current = (here.data(Qt.ItemDataRole.UserRole), here.column()) if here is not None else None
        self._filling = True
        self.table.setUpdatesEnabled(False)
        self.table.setRowCount(len(project.lines))
        selection = QItemSelection()
        model, last = self.table.model(), len(COLUMNS) - 1
        for n, (ident, line) in enumerate(project.lines.items()):
            shown = (ident, line, project.voices.get(ident), look.name)
            first = self.table.item(n, ID)
            if first is None or not _same(self._rows.get(n), shown):
                self._row(n, ident, line, look)
                self._rows[n] = shown
            if ident in chosen:
                selection.select(model.index(n, 0), model.index(n, last))
        self.table.selectionModel().select(selection, QItemSelectionModel.SelectionFlag.ClearAndSelect)
        if current is not None:
            row = next((n for n, i in enumerate(project.lines) if i == current[0]), -1)
            if row >= 0:
                self.table.selectionModel().setCurrentIndex(
                    model.index(row, current[1]), QItemSelectionModel.SelectionFlag.NoUpdate
                )
        for column in (ID, LENGTH, ASKS):
            self.table.resizeColumnToContents(column)
        if self.table.columnWidth(ID) > WIDEST:
            self.table.setColumnWidth(ID, WIDEST)
        self.table.setUpdatesEnabled(True)
        self._filling = False
        self.table.setVisible(bool(project.lines))
        self.empty.setVisible(not project.lines)
        self.search.setVisible(bool(project.lines))
        silent = sum(1 for x in project.lines.values() if not x.audio)
        words = tr_plural("{count:,} line", "{count:,} lines", len(project.lines)) if project.lines else ""
        self.words.setText(
            tr("{lines}, {silent} without sound", lines=words, silent=silent) if silent else words
        )
        self._search(self.search.text())

    def _row(self, n: int, ident: str, line: Line, look: WindowTheme) -> None:
        """Fill a row of the table."""
        project = self.document.project
        lost = bool(line.audio) and ident not in project.voices
        seconds = find_spoken_seconds(project, ident, line.text)
        asks = tr_plural("{count:,} request", "{count:,} requests", len(line.asks)) if line.asks else ""
        texts = (
            ident,
            line.text,
            Path(line.audio).name if line.audio else "",
            f"{format_number(seconds, '.1f')} s",
            asks,
        )
        for column, text in enumerate(texts):
            item = self.table.item(n, column)
            if item is None:
                item = QTableWidgetItem()
                self.table.setItem(n, column, item)
            item.setText(text)
            item.setData(Qt.ItemDataRole.UserRole, ident)
            if column >= SOUND and item.flags() & Qt.ItemFlag.ItemIsEditable:
                item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsEditable)
            if column == SOUND:
                item.setForeground(QColor(look.warning if lost else look.dim))
                item.setToolTip(
                    tr("{audio}\nThe sound cannot be read, so the lips follow the text", audio=line.audio)
                    if lost
                    else line.audio or ""
                )
            elif column in (ID, WORDS):
                item.setToolTip(text)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """What is said has most of the width."""
        super().resizeEvent(event)
        self.table.setColumnWidth(SOUND, min(190, round(0.25 * event.size().width())))

    def _search(self, text: str) -> None:
        wanted = text.lower().split()
        for n, (ident, line) in enumerate(self.document.project.lines.items()):
            found = f"{ident} {line.text}".lower()
            self.table.setRowHidden(n, not all(word in found for word in wanted))

    def chosen(self) -> list[str]:
        """Return the ids of the selected lines."""
        rows = sorted({i.row() for i in self.table.selectedItems()})
        return [str(self.table.model().index(n, ID).data(Qt.ItemDataRole.UserRole)) for n in rows]

    # --- changing

    def _try(self, text: str, function: Edit) -> None:
        try:
            self.document.edit(text, function)
        except EditError as error:
            self.told.emit(tr_error(error))
            self.refresh()

    def _typed(self, item: QTableWidgetItem) -> None:
        if self._filling:
            return
        ident, text = str(item.data(Qt.ItemDataRole.UserRole)), item.text()
        self._rows.pop(item.row(), None)  # what was typed may be refused
        if item.column() == ID:
            self._try(tr("Rename line"), lambda p: performance_edits.rename_line(p, ident, text))
        else:
            line = self.document.project.lines[ident]
            self._try(
                tr("Change line"),
                lambda p: performance_edits.set_line(
                    p, ident, msgspec.structs.replace(line, text=text.strip()[:20000])
                ),
            )

    def remove(self) -> None:
        """Remove the selected lines; their sound files stay where they are."""
        chosen = self.chosen()

        def edit(project: Project) -> Project:
            for ident in chosen:
                project = performance_edits.set_line(project, ident, None)
            return project

        if chosen:
            self._try(
                tr("Remove {what}", what=tr_plural("{count:,} line", "{count:,} lines", len(chosen))), edit
            )

    def add_words(self) -> None:
        """Add a line and let its words be typed."""
        lines = self.document.project.lines
        self.search.clear()  # the new one must be seen
        number = next(n for n in range(1, len(lines) + 2) if str(n) not in lines)
        self._try(
            tr("Add line"), lambda p: performance_edits.set_line(p, str(number), Line(text=str(tr("Hello"))))
        )
        self.table.setCurrentCell(len(lines), WORDS)
        self.table.edit(self.table.model().index(len(lines), WORDS))

    def ask_files(self) -> None:
        names = " ".join(f"*{s}" for s in (*SOUNDS, *LISTS))
        paths, _ = QFileDialog.getOpenFileNames(
            self,
            tr("Add lines"),
            str(find_start_folder(self.document.folder)),
            tr("Sounds and lists ({names})", names=names),
        )
        if paths:
            self.add_files([Path(p) for p in paths])

    def add_files(self, paths: list[Path]) -> None:
        """Read sounds and lists on a thread, then add their lines as one step."""
        folder = self.document.folder

        def done(read: Lines) -> None:
            if read.lines:
                self._try(
                    tr("Add {what}", what=tr_plural("{count:,} line", "{count:,} lines", len(read.lines))),
                    lambda p: add_lines(p, read),
                )
            if read.notes:
                more = tr(" (and {count} more)", count=len(read.notes) - 1) if len(read.notes) > 1 else ""
                self.told.emit(tr_phrase(read.notes[0]) + more)

        self.jobs.start(
            tr("Reading lines"),
            lambda _: read_lines(paths, folder, keep_chosen),
            done,
            lambda error: self.told.emit(tr_error(error)),
        )

    def say(self) -> None:
        """Ask for the selected line at the playhead."""
        for ident in self.chosen()[:1]:
            self.performance.requests.ask(Say(line=ident), tr("Request line"))

    # --- files dropped

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if self._files(event):
            event.acceptProposedAction()
            self.drop_frame.follow(event)

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        paths = self._files(event)
        if paths:
            event.acceptProposedAction()
            self.add_files(paths)

    def _files(self, event: QDropEvent) -> list[Path]:
        paths = [Path(u.toLocalFile()) for u in event.mimeData().urls() if u.isLocalFile()]
        return [p for p in paths if p.suffix.lower() in (*SOUNDS, *LISTS)]


def _same(before: tuple[object, ...] | None, now: tuple[object, ...]) -> bool:
    """Whether a row shows the same; a line and its voice by identity, since every edit makes new ones of what
    it changes.
    """
    return (
        before is not None
        and before[0] == now[0]
        and before[1] is now[1]
        and before[2] is now[2]
        and before[3] == now[3]
    )
