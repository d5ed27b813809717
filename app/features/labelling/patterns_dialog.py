"""Name patterns: what words in clips' names mean, as the user wrote and corrected it; tried out on a name,
and shared as a file.
"""

from __future__ import annotations

from html import escape
from pathlib import Path

from PySide6.QtCore import QModelIndex, Qt, Signal
from PySide6.QtGui import QKeyEvent, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QGridLayout,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QMessageBox,
    QPushButton,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from app.features.labelling.pattern_table import (
    ABOUT,
    MINE,
    NOBODY,
    ChosenPatterns,
    MeaningEditor,
    PatternRow,
    PatternTable,
    fill_meanings,
    remove_pattern,
)
from app.look.theme import KIND_MARKS, get_theme
from app.project.document import Document
from app.project.learned import Learned
from app.project.pattern_files import read_patterns, write_patterns
from app.stage.session import StageSession
from app.translation import make_lazy_texts, tr, tr_error, tr_noop, tr_phrase, tr_plural
from app.widgets.quiet_fields import ComboBox
from app.widgets.vocabulary import get_vocabulary_word
from app.widgets.within_screen import resize_within_screen
from metagraph.common.studio import find_start_folder
from metagraph.errors import FileError
from metagraph.suggest.words.names import NameGuess, Patterns, PatternsError, merge_patterns, read_names
from metagraph.suggest.words.patterns import FIELDS

FILTER = tr_noop("Name patterns (*.json);;All files (*)")
PARTS = make_lazy_texts(
    lambda: (
        ("kind", tr("Kind")),
        ("layer", tr("Layer")),
        ("stance", tr("Stance")),
        ("end_stance", tr("Ends in")),
        ("limb", tr("Arm")),
        ("tags", tr("Tags")),
    )
)


class _Table(QTableView):
    """remove_wanted: the key that removes was pressed on it."""

    remove_wanted = Signal()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.matches(QKeySequence.StandardKey.Delete) or event.key() == Qt.Key.Key_Backspace:
            self.remove_wanted.emit()
        else:
            super().keyPressEvent(event)


class PatternsDialog(QDialog):
    """Every change is kept at once, for all projects."""

    def __init__(
        self, document: Document, session: StageSession, learned: Learned, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.learned = document, session, learned
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Name patterns"))
        resize_within_screen(self, 760, 720)
        layout = QVBoxLayout(self)
        layout.setSpacing(10)
        layout.addWidget(
            QLabel(
                tr(
                    "Set what words in clip names mean when labels are proposed. All your projects use these "
                    "patterns."
                ),
                self,
                wordWrap=True,
            )
        )
        layout.addLayout(self._trial())
        layout.addLayout(self._finder())
        layout.addWidget(self._table(), 1)
        layout.addLayout(self._adder())
        self.words = QLabel(self, wordWrap=True)
        self.words.setVisible(False)
        layout.addWidget(self.words)
        layout.addLayout(self._foot())
        learned.changed.connect(self._show)
        self._show()
        self.name.setFocus()

    # --- building

    def _trial(self) -> QVBoxLayout:
        self.name = QLineEdit(self, placeholderText=tr("Type a clip name to try, like IdleSeated_Wave_Rt_02"))
        self.name.setAccessibleName(tr("Try a name"))
        self.name.setClearButtonEnabled(True)
        self.name.textChanged.connect(self._try)
        self.read = QLabel(self)
        self.read.setTextFormat(Qt.TextFormat.RichText)
        self.read.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.read.setMinimumHeight(7 * self.fontMetrics().height())
        column = QVBoxLayout()
        column.addWidget(self.name)
        column.addWidget(self.read)
        return column

    def _finder(self) -> QHBoxLayout:
        self.search = QLineEdit(self, placeholderText=tr("Search words and meanings"))
        self.search.setAccessibleName(tr("Search"))
        self.search.setClearButtonEnabled(True)
        self.every = QCheckBox(tr("Built-in words too"), self)
        self.search.textChanged.connect(self._look)
        self.every.toggled.connect(self._look)
        QShortcut(QKeySequence(QKeySequence.StandardKey.Find), self, self.search.setFocus)
        row = QHBoxLayout()
        row.addWidget(self.search, 1)
        row.addWidget(self.every)
        return row

    def _table(self) -> _Table:
        self.model = PatternTable(self.learned.edit, self._tell, self)
        self.chosen = ChosenPatterns(self)
        self.chosen.setSourceModel(self.model)
        self.table = _Table(self)
        self.table.setAccessibleName(tr("Name patterns"))
        self.table.setModel(self.chosen)
        self.table.setItemDelegate(MeaningEditor(self.table))
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setSortingEnabled(True)
        self.table.sortByColumn(0, Qt.SortOrder.AscendingOrder)
        self.table.setShowGrid(False)
        self.table.setAlternatingRowColors(True)
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(2 * self.fontMetrics().height() - 6)
        self.table.setTabKeyNavigation(False)
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setHighlightSections(False)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        for column, width in ((1, 120), (2, 170), (3, 150)):
            self.table.setColumnWidth(column, width)
        self.table.remove_wanted.connect(self._remove)
        self.table.selectionModel().selectionChanged.connect(lambda *_: self._refresh())
        return self.table

    def _adder(self) -> QGridLayout:
        self.phrase = QLineEdit(self, placeholderText=tr("words, like check watch"))
        self.phrase.setAccessibleName(tr("Words of the new pattern"))
        self.field = ComboBox(self)
        self.field.setAccessibleName(tr("About"))
        for name in FIELDS:
            self.field.addItem(ABOUT[name], name)
        self.meaning = ComboBox(self)
        self.meaning.setAccessibleName(tr("Meaning"))
        self.field.currentIndexChanged.connect(
            lambda _: fill_meanings(self.meaning, self.field.currentData())
        )
        fill_meanings(self.meaning, "kinds")
        self.add = QPushButton(tr("Add"), self)
        self.add.clicked.connect(self._add)
        self.phrase.returnPressed.connect(self._add)
        self.remove = QPushButton(tr("Remove"), self)
        self.remove.setToolTip(tr("Remove the selected patterns (Delete); built-in ones then mean nothing"))
        self.remove.clicked.connect(self._remove)
        grid = QGridLayout()
        for column, (widget, wide) in enumerate(
            ((self.phrase, 3), (self.field, 1), (self.meaning, 2), (self.add, 0), (self.remove, 0))
        ):
            grid.addWidget(widget, 0, column)
            grid.setColumnStretch(column, wide)
        return grid

    def _foot(self) -> QHBoxLayout:
        self.on = QCheckBox(tr("Learn from my corrections"), self)
        self.on.setChecked(self.learned.on)
        self.on.toggled.connect(self.learned.set_on)
        self.forget = QPushButton(tr("Forget everything learned…"), self)
        self.forget.clicked.connect(self._forget)
        self.take, self.give = QPushButton(tr("Import…"), self), QPushButton(tr("Export…"), self)
        self.take.clicked.connect(self._import)
        self.give.clicked.connect(self._export)
        close = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        close.rejected.connect(self.reject)
        for button in (*self.findChildren(QPushButton), *close.buttons()):
            if isinstance(button, QPushButton):
                button.setAutoDefault(False)  # Enter in a line adds or tries; it closes nothing
        row = QHBoxLayout()
        row.addWidget(self.on)
        row.addWidget(self.forget)
        row.addStretch(1)
        row.addWidget(self.take)
        row.addWidget(self.give)
        row.addWidget(close)
        return row

    # --- showing

    def _show(self) -> None:
        kept = self._selected()
        # What was learned is shown, and can be forgotten, while it is not used.
        self.model.fill(self.learned.every_pattern)
        self._look()
        rows = [
            i
            for i, row in enumerate(self.model.rows)
            if (row.field, row.phrase) in {(r.field, r.phrase) for r in kept}
        ]
        for i in rows[:1]:
            self.table.setCurrentIndex(self.chosen.mapFromSource(self.model.index(i, 0)))
        self._try()
        self._refresh()

    def _look(self) -> None:
        self.chosen.look(self.search.text(), self.every.isChecked())
        self._refresh()

    def _refresh(self) -> None:
        self.remove.setEnabled(bool(self._selected()))
        self.forget.setEnabled(bool(self.model.patterns.learned) or bool(self.learned.clips))

    def _try(self) -> None:
        name = self.name.text().strip()
        if not name:
            self.read.setText(tr("<i>No name entered.</i>"))
            return
        names = [clip.name for clip in self.document.project.clips.values()]
        self.read.setText(self._said(read_names([*names, name], self.learned.patterns)[name]))

    def _said(self, guess: NameGuess) -> str:
        look = get_theme(self.session.look.name)
        rows = []
        for part, title in PARTS:
            belief = getattr(guess, part)
            if belief is None:
                continue
            text = escape(", ".join(belief.value) if part == "tags" else str(belief.value))
            if part in ("kind", "layer", "limb"):
                text = escape(get_vocabulary_word(str(belief.value)))
            if part == "kind":
                text = (
                    f"<span style='color:{look.kinds[belief.value]}'>{KIND_MARKS[belief.value]} {text}</span>"
                )
            cells = (
                title,
                f"<b>{text}</b>",
                f"{100 * belief.confidence:.0f} %",
                escape(tr_phrase(belief.reason)),
            )
            rows.append(
                "<tr>" + "".join(f"<td style='padding-right:14px'>{cell}</td>" for cell in cells) + "</tr>"
            )
        return f"<table>{''.join(rows)}</table>" if rows else tr("<i>This name matches no pattern.</i>")

    def _tell(self, words: str) -> None:
        self.words.setText(words)
        self.words.setVisible(bool(words))

    # --- changing

    def _selected(self) -> list[PatternRow]:
        return [index.data(Qt.ItemDataRole.UserRole) for index in self.table.selectionModel().selectedRows()]

    def _add(self) -> None:
        phrase = " ".join(self.phrase.text().lower().split())
        field = self.field.currentData()
        meaning = self.meaning.currentText() if self.meaning.isEditable() else self.meaning.currentData()
        try:
            self.model.patterns.with_pattern(field, phrase, " ".join(meaning.split()))
        except PatternsError as error:
            self._tell(tr_error(error))
            self.phrase.setFocus()
            return
        self._tell("")
        self.search.clear()
        self.learned.edit(lambda p: p.with_pattern(field, phrase, " ".join(meaning.split())))
        self.phrase.clear()
        self.phrase.setFocus()
        at = next(
            (
                i
                for i, row in enumerate(self.model.rows)
                if (row.source, row.field, row.phrase) == (MINE, field, phrase)
            ),
            None,
        )
        if at is None:
            self._tell(tr("'{phrase}' already has this meaning: it is built in.", phrase=phrase))
            return
        index = self.chosen.mapFromSource(self.model.index(at, 0))
        self.table.setCurrentIndex(index)
        self.table.scrollTo(index)

    def _remove(self) -> None:
        rows = self._selected()
        if not rows:
            return
        place = self.table.currentIndex().row()

        def change(patterns: Patterns) -> Patterns:
            for row in rows:
                patterns = remove_pattern(patterns, row)
            return patterns

        self.learned.edit(change)
        taken = [row for row in rows if row.source == NOBODY]
        self._tell(
            tr(
                "'{phrase}' no longer means anything. Remove it again to restore its meaning.",
                phrase=taken[0].phrase,
            )
            if len(taken) == 1
            else ""
        )
        if self.chosen.rowCount():
            self.table.setCurrentIndex(
                self.chosen.index(min(place, self.chosen.rowCount() - 1), 0, QModelIndex())
            )

    def _forget(self) -> None:
        count, clips = sum(map(len, self.model.patterns.learned.values())), self.learned.clips
        words = tr(
            "This forgets {words} learned from corrections, and {clips} of saved projects. Patterns "
            "that you wrote stay.",
            words=tr_plural("{count:,} word", "{count:,} words", count),
            clips=tr_plural("{count:,} labelled clip", "{count:,} labelled clips", clips),
        )
        buttons = QMessageBox.StandardButton
        box = QMessageBox(
            QMessageBox.Icon.Question, tr("Forget everything learned?"), words, buttons.Cancel, self
        )
        go = box.addButton(tr("Forget"), QMessageBox.ButtonRole.DestructiveRole)
        box.setDefaultButton(buttons.Cancel)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        go.clicked.connect(self.learned.forget)
        box.open()

    # --- sharing

    def _import(self) -> None:
        name, _ = QFileDialog.getOpenFileName(
            self, tr("Import name patterns"), str(find_start_folder(self.document.folder)), tr(FILTER)
        )
        if name:
            try:
                theirs = read_patterns(Path(name))
            except FileError as error:
                self._tell(tr_error(error))
                return
            self.learned.edit(lambda mine: merge_patterns(mine, theirs))
            own = sum(map(len, theirs.changes.values()))
            learned = sum(map(len, theirs.learned.values()))
            self._tell(
                tr(
                    "Imported {patterns} and {learned} learned ones from {name}.",
                    patterns=tr_plural("{count:,} pattern", "{count:,} patterns", own),
                    learned=learned,
                    name=Path(name).name,
                )
            )

    def _export(self) -> None:
        start = find_start_folder(self.document.folder) / "name-patterns.json"
        name, _ = QFileDialog.getSaveFileName(self, tr("Export name patterns"), str(start), tr(FILTER))
        if name:
            path = Path(name) if Path(name).suffix else Path(name + ".json")
            try:
                write_patterns(path, self.model.patterns)
            except FileError as error:
                self._tell(tr_error(error))
                return
            self._tell(
                tr(
                    "Wrote {name}. Others can import it, or use it with metagraph label --patterns.",
                    name=path.name,
                )
            )
