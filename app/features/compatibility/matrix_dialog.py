"""Which clip can enter and leave which stance without a visible jump: clips against the stances of a layer,
at a glance.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import inf
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QFontMetrics
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPushButton,
    QStyledItemDelegate,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from app.features.compatibility.matrix_table import (
    CLIP,
    FIRST,
    ROW,
    USES,
    Cell,
    Legend,
    MatrixMarks,
    MatrixModel,
    Rows,
    describe_cell,
)
from app.look.domain_words import LAYER_LONG_TITLES
from app.look.plural import count_clips
from app.look.theme import KIND_MARKS, KIND_TITLES, strengthen
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.stage.compatibility_state import Compatibility, compare_proposed_timing
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_phrase, tr_plural
from app.widgets.quiet_fields import ComboBox
from app.widgets.within_screen import resize_within_screen
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import KINDS, Action, Project


class MatrixDialog(QDialog):
    """Stays open beside the window; a click plays a clip in the context of a stance, a double click places it
    there.
    """

    def __init__(
        self,
        document: Document,
        session: StageSession,
        compatibility: Compatibility,
        jobs: Jobs,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.compatibility, self.jobs = document, session, compatibility, jobs
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Compatibility"))
        resize_within_screen(self, 1000, 680)
        self.title = QLabel(self)
        self.title.setProperty("heading", True)
        self.search = QLineEdit(self, placeholderText=tr("Search clips"), clearButtonEnabled=True)
        self.search.setAccessibleName(tr("Search clips"))
        self.search.textChanged.connect(self._narrow)
        self.which = ComboBox(self)
        for text, key in (
            (tr("All clips"), "all"),
            (tr("Placed on this layer"), "placed"),
            (tr("Not placed on this layer"), "free"),
        ):
            self.which.addItem(text, key)
        self.which.activated.connect(self._narrow)
        self.model = MatrixModel(self)
        self._make_table()
        self._make_words()
        close = QPushButton(tr("Close"), self)
        close.clicked.connect(self.close)
        self.go.setAutoDefault(False)
        close.setAutoDefault(False)
        self._lay_out(close)
        for signal in (session.place.layer_changed, compatibility.changed):
            signal.connect(self.refresh)
        compatibility.compared.connect(self._compared)
        document.changed.connect(self._follow)
        session.look.changed.connect(self.table.viewport().update)
        self.refresh()
        self._show_current()

    def _make_table(self) -> None:
        self.table = QTableView(self)
        self.table.setTabKeyNavigation(False)  # Tab leaves it, arrows go about in it
        self.table.setModel(self.model)
        self.table.setAccessibleName(tr("Compare clips with stances"))
        header = self.table.horizontalHeader()
        header.setSectionsClickable(True)
        header.setSortIndicatorShown(True)
        header.setSortIndicator(USES, Qt.SortOrder.AscendingOrder)
        header.sortIndicatorChanged.connect(self._sort)
        self.table.setItemDelegate(MatrixMarks(self.session, self))
        self.table.setItemDelegateForColumn(CLIP, QStyledItemDelegate(self.table))
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.table.setShowGrid(False)
        self.table.setAlternatingRowColors(False)
        self.table.setMouseTracking(True)
        self.table.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        rows = self.table.verticalHeader()
        rows.hide()
        rows.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        rows.setDefaultSectionSize(ROW)
        self.table.horizontalHeader().setMinimumSectionSize(44)
        self.table.horizontalHeader().setTextElideMode(Qt.TextElideMode.ElideRight)
        self.table.horizontalHeader().setHighlightSections(False)
        self.table.clicked.connect(self._play)
        self.table.doubleClicked.connect(lambda _: self.place())
        self.table.activated.connect(self._play)
        self.table.selectionModel().currentChanged.connect(lambda *_: self._show_current())

    def _make_words(self) -> None:
        """Make what is said of a place in the table, and what can be done there."""
        self.words = QLabel(self, wordWrap=True)
        self.words.setMinimumHeight(56)
        self.words.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.kind = ComboBox(self)
        self.kind.setAccessibleName(tr("Place as"))
        for kind in KINDS:
            self.kind.addItem(f"{KIND_MARKS[kind]} {KIND_TITLES[kind]}", kind)
        self.kind.setCurrentIndex(KINDS.index("gesture"))
        self.kind.currentIndexChanged.connect(lambda _: self._show_current())
        self.go = QPushButton(self)
        self.go.clicked.connect(self.place)
        strengthen(self.go)

    def _lay_out(self, close: QPushButton) -> None:
        box = QVBoxLayout(self)
        box.setContentsMargins(14, 12, 14, 12)
        box.setSpacing(8)
        top = QHBoxLayout()
        top.addWidget(self.title, 1)
        top.addWidget(self.search, 1)
        top.addWidget(self.which)
        box.addLayout(top)
        box.addWidget(Legend(self.session, self))
        box.addWidget(self.table, 1)
        box.addWidget(self.words)
        row = QHBoxLayout()
        row.addWidget(QLabel(tr("Place as"), self))
        row.addWidget(self.kind)
        row.addWidget(self.go)
        row.addStretch(1)
        row.addWidget(close)
        box.addLayout(row)

    # --- showing

    def _follow(self, before: Project, after: Project) -> None:
        if before.graphs is not after.graphs or before.clips is not after.clips:
            self.refresh()

    def _compared(self, layer: str) -> None:
        if layer == self.session.place.layer:
            self.refresh()

    def refresh(self) -> None:
        """Show the current layer as it was last compared; what is stale is compared again meanwhile."""
        layer, project = self.session.place.layer, self.document.project
        matrix = self.compatibility.matrix(layer)
        stances = tuple(project.graphs[layer].stances)
        if matrix is None or matrix.layer != layer or matrix.stances != stances:
            self.model.show_rows(None)
            waits = (
                tr("Comparing clips with stances…")
                if stances and project.clips
                else tr("Create a stance first: drop a resting clip.")
            )
            self.title.setText(LAYER_LONG_TITLES[layer])
            self.words.setText(waits)
            return
        fresh = self.model.rows is None or self.model.rows.matrix.stances != stances
        with self._same_cell():
            self.model.show_rows(Rows.of(project, matrix))
        self.title.setText(
            tr(
                "{layer}, {clips}",
                layer=LAYER_LONG_TITLES[layer],
                clips=tr_plural("{count:,} clip", "{count:,} clips", len(matrix.clips)),
            )
        )
        if fresh:
            self._arrange()
        self._show_current()

    @contextmanager
    def _same_cell(self) -> Iterator[None]:
        """Keep the current cell and where the table is scrolled to, whatever is sorted or narrowed."""
        found, across = self.current(), self.table.currentIndex().column()
        bar = self.table.verticalScrollBar()
        before = bar.value()
        yield
        row = self.model.row_of(found[0]) if found is not None else None
        if row is not None and across < self.model.columnCount():
            self.table.setCurrentIndex(self.model.index(row, across))
        bar.setValue(before)

    def _arrange(self) -> None:
        header, metrics = self.table.horizontalHeader(), QFontMetrics(self.table.font())
        header.resizeSection(CLIP, 264)
        header.resizeSection(USES, 64)
        for column in range(FIRST, self.model.columnCount()):
            name = str(self.model.headerData(column, Qt.Orientation.Horizontal))
            header.resizeSection(column, min(150, max(72, metrics.horizontalAdvance(name) + 34)))

    def _sort(self, column: int, order: Qt.SortOrder) -> None:
        with self._same_cell():
            self.model.sort(column, order)

    def _narrow(self, *_: object) -> None:
        with self._same_cell():
            self.model.narrow(self.search.text(), str(self.which.currentData()))

    def current(self) -> tuple[str, str | None, Cell | None] | None:
        """Return the clip and the stance of the current cell, and what it holds."""
        index = self.table.currentIndex()
        if not index.isValid():
            return None
        return (
            self.model.clip(index.row()),
            self.model.stance(index.column()),
            self.model.cell(index.row(), index.column()),
        )

    def _show_current(self) -> None:
        found, project = self.current(), self.document.project
        stance = project.stance(found[1]) if found is not None else None
        entry = project.clips.get(found[0]) if found is not None else None
        self.go.setEnabled(stance is not None and entry is not None)
        self.go.setText(tr("Place here") if stance is None else tr("Place on '{name}'", name=stance.name))
        if self.model.rows is None:
            return
        if found is None or found[2] is None or stance is None or entry is None:
            self.words.setText(
                tr(
                    "Click a mark to preview the clip from that stance and back. Double-click "
                    "to place it there."
                )
            )
            return
        words = describe_cell(found[2], entry.name, stance.name)
        if self.kind.currentData() == "transition":
            end = project.stance(self._end(found[0], stance.id))
            words += (
                tr("\nAs a transition it would end in '{name}'.", name=end.name)
                if end is not None
                else tr("\nA transition needs a second stance.")
            )
        self.words.setText(words)

    # --- acting

    def _play(self, *_: object) -> None:
        found = self.current()
        if found is None:
            return
        clip, stance, _cell = found
        here = [a for a in self.document.project.uses.get(clip, ()) if stance is None or a.stance == stance]
        here = [a for a in here if a.layer == self.session.place.layer]
        if stance is None:
            self.session.selection.select_clips((clip,))
            self.session.transport.show_clip(clip)
        elif here:
            self.session.jump(action=here[0].id)
            self.session.show_context(here[0].id)
        else:
            self.session.selection.select_clips((clip,))
            self.session.show_context(clip, tried=stance)

    def _end(self, clip: str, stance: str) -> str | None:
        """Return the stance, other than where it starts, that a clip leaves to without a jump the latest,
        else with the least.
        """
        rows = self.model.rows
        if rows is None or clip not in rows.matrix.clips:
            return None
        m, row = rows.matrix, rows.matrix.clips.index(clip)
        others = [
            (cost > 1, -float(at) if cost <= 1 else float(cost), s)
            for cost, at, s in zip(m.leave_cost[row], m.leave_at[row], m.stances, strict=True)
            if s != stance
        ]
        return min(others, default=(True, inf, None))[2]

    def place(self) -> None:
        """Place the current clip on the current stance, with the times proposed for it, in one step."""
        found = self.current()
        if found is None or found[1] is None:
            return
        clip, stance, kind, layer = found[0], found[1], self.kind.currentData(), self.session.place.layer
        project, judged = self.document.project, self.compatibility.judged
        end = self._end(clip, stance) if kind == "transition" else None
        why = edits.find_placing_refusal(project, [clip], layer, kind, stance, end)
        if why is not None:
            why = tr_phrase(why)
            self.words.setText(f"{why[:1].upper()}{why[1:]}.")
            return
        measured = judged.measured[layer] if judged is not None else None

        def work(_: WindowJob) -> Mapping[str, Any]:
            from metagraph.suggest.jumps.found import compute_stance_curves

            after = edits.place_clips(project, [clip], layer, kind, stance, end)
            action = _newest(project, after)
            seen = compute_stance_curves(after, measured, action) if measured is not None else None
            return (
                compare_proposed_timing(action, seen.proposed, after.clips[clip].duration)
                if seen is not None
                else {}
            )

        document, session, failures = self.document, self.session, list[str]()

        def done(timing: Mapping[str, Any]) -> None:
            """Put it into the project, whether the dialog is still there or not."""

            def placed(p: Project) -> Project:
                after = edits.place_clips(p, [clip], layer, kind, stance, end)
                return edits.update_actions(after, [_newest(p, after).id], timing=timing)

            before = document.project
            try:
                document.edit(tr("Place {clips}", clips=count_clips(1)), placed)
            except EditError as error:
                failures.append(tr_error(error))
                return
            action = _newest(before, document.project)
            session.jump(action=action.id)
            session.show_context(action.id)

        self._failures = failures
        job = self.jobs.start(
            "place", work, done, lambda error: self.words.setText(tr_error(error)), quick=True
        )
        job.done.connect(self._placed)

    def _placed(self) -> None:
        if self._failures:
            self.words.setText(self._failures[0])


def _newest(before: Project, after: Project) -> Action:
    return next(a for a in after.actions() if before.action(a.id) is None)
