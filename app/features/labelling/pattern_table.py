"""The rows of the name patterns: what the user wrote, what was learned, what is built in; searched, sorted
and edited in place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, QSortFilterProxyModel, Qt
from PySide6.QtGui import QFont
from PySide6.QtWidgets import QComboBox, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from app.translation import make_lazy_texts, tr, tr_error, tr_noop, tr_plural
from app.widgets.quiet_fields import ComboBox
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph.words import KINDS, LAYERS, LIMBS
from metagraph.suggest.words.defaults import DEFAULTS, Field
from metagraph.suggest.words.languages import AFTER_FROM, AFTER_TO, MAYBE_FROM, MAYBE_TO, NOTHING
from metagraph.suggest.words.patterns import FIELDS, Patterns, PatternsError, count_correction, forget_learned

Index = QModelIndex | QPersistentModelIndex
COLUMNS = make_lazy_texts(lambda: (tr("Words"), tr("About"), tr("Means"), tr("Source")))
ABOUT = make_lazy_texts(
    lambda: {
        "kinds": tr("kind"),
        "layers": tr("layer"),
        "limbs": tr("arm"),
        "tags": tr("tags"),
        "postures": tr("stance name"),
        "joins": tr("transition"),
        "junk": tr("ignored word"),
        "synonyms": tr("same as"),
        "kind": tr("kind"),
        "layer": tr("layer"),
        "limb": tr("arm"),
        "stance": tr("begins in"),
        "end_stance": tr("ends in"),
    }
)
MEANINGS: dict[str, tuple[str, ...]] = {
    "kinds": (*KINDS, "other"),
    "layers": LAYERS,
    "limbs": LIMBS,
    "tags": (),
    "postures": ("stance",),
    "joins": ("to", "from"),
    "junk": ("junk",),
    "synonyms": (),
    "kind": KINDS,
    "layer": LAYERS,
    "limb": LIMBS,
    "stance": (),
    "end_stance": (),
}
SHOWN = make_lazy_texts(
    lambda: {
        "other": tr("none of the four kinds"),
        "junk": tr("nothing"),
        None: tr("nothing (removed)"),
        NOTHING: tr("nothing"),
        MAYBE_TO: tr("to, between stances"),
        MAYBE_FROM: tr("from, between stances"),
        AFTER_TO: tr("to, after a stance"),
        AFTER_FROM: tr("from, after a stance"),
    }
)
NOBODY, MINE, LEARNED = tr_noop("built in"), tr_noop("you"), tr_noop("corrections")


def describe_meaning(field: str, meaning: str | None) -> str:
    """Return in words what a meaning about a field is; free text stays as it is."""
    if meaning in SHOWN:
        return SHOWN[meaning]
    return get_vocabulary_word(meaning or "") if MEANINGS.get(field) else meaning or ""


@dataclass(frozen=True)
class PatternRow:
    """field: as `Patterns.changes` or, of what was learned, `Patterns.learned` name it. meaning: None of a
    built-in one taken away.
    """

    source: str
    field: str
    phrase: str
    meaning: str | None
    count: int = 0

    @property
    def pattern(self) -> Field:
        """The field of a row that was not learned."""
        return cast(Field, self.field)

    def texts(self) -> tuple[str, str, str, str]:
        """Return what the columns say."""
        source = tr(self.source)
        if self.count:
            source = tr_plural(
                "{source}, {count:,} time", "{source}, {count:,} times", self.count, source=source
            )
        return (
            self.phrase,
            ABOUT[self.field],
            describe_meaning(self.field, self.meaning),
            source,
        )


def list_pattern_rows(patterns: Patterns) -> list[PatternRow]:
    """Return all rows: own ones, learned ones, and what is built in and was not changed."""
    out = [
        PatternRow(MINE, name, phrase, meaning)
        for name, mine in patterns.changes.items()
        for phrase, meaning in mine.items()
    ]
    for name, words in patterns.learned.items():
        out += [
            PatternRow(LEARNED, name, word, value, count)
            for word, counts in words.items()
            for value, count in counts.items()
        ]
    for field in FIELDS:
        changed = patterns.changes.get(field, {})
        out += [
            PatternRow(NOBODY, field, phrase, meaning)
            for phrase, meaning in DEFAULTS[field].items()
            if phrase not in changed
        ]
    return out


def remove_pattern(patterns: Patterns, row: PatternRow) -> Patterns:
    """Return patterns without a row: an own one is forgotten, so that the built-in meaning holds again; a
    learned one too; a built-in one is taken away, which is a change of the user's.
    """
    if row.source == LEARNED:
        counts = {v: c for v, c in patterns.learned[row.field][row.phrase].items() if v != row.meaning}
        bare = forget_learned(patterns, row.field, row.phrase)
        for value, count in counts.items():
            words = {**bare.learned.get(row.field, {})}
            words[row.phrase] = {**words.get(row.phrase, {}), value: count}
            bare = Patterns(bare.changes, {**bare.learned, row.field: words})
        return bare
    if row.source == MINE:
        return patterns.with_pattern(row.pattern, row.phrase, DEFAULTS[row.pattern].get(row.phrase))
    return patterns.with_pattern(row.pattern, row.phrase, None)


def change_pattern(patterns: Patterns, row: PatternRow, phrase: str, meaning: str) -> Patterns:
    """Return patterns in which a row says something else. Raises PatternsError."""
    if row.source == LEARNED:
        return count_correction(
            remove_pattern(patterns, row), row.field, phrase.lower().split(), meaning.strip()
        )
    if phrase != row.phrase and row.source == MINE:
        patterns = remove_pattern(patterns, row)
    return patterns.with_pattern(row.pattern, phrase, meaning.strip())


class PatternTable(QAbstractTableModel):
    """Rows of patterns. change: called with a pure function when a cell was edited; refused: with words when
    it cannot be.
    """

    def __init__(
        self,
        change: Callable[[Callable[[Patterns], Patterns]], None],
        refused: Callable[[str], None],
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self.rows: list[PatternRow] = []
        self.lower: list[tuple[str, ...]] = []  # what the columns of each say, in small letters
        self.patterns = Patterns()
        self._change, self._refused = change, refused
        self._by = 0, Qt.SortOrder.AscendingOrder

    def fill(self, patterns: Patterns) -> None:
        self.beginResetModel()
        self.patterns = patterns
        self._arrange(list_pattern_rows(patterns))
        self.endResetModel()

    def _arrange(self, rows: list[PatternRow]) -> None:
        """Take rows in the order of the column that is sorted by."""
        column, order = self._by
        pairs = [(tuple(text.lower() for text in row.texts()), row) for row in rows]
        pairs.sort(key=lambda pair: pair[0][column], reverse=order == Qt.SortOrder.DescendingOrder)
        self.lower, self.rows = [lower for lower, _ in pairs], [row for _, row in pairs]

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        """Sort here, where a row's words are made once. Asked for by Qt, cell by cell, thousands of rows
        took a third of a second with every letter that is typed.
        """
        if column < 0:
            return
        self.layoutAboutToBeChanged.emit()
        held = self.persistentIndexList()
        rows = [self.rows[index.row()] for index in held]
        self._by = column, order
        self._arrange(self.rows)
        at = {id(row): place for place, row in enumerate(self.rows)}
        self.changePersistentIndexList(
            held, [self.index(at[id(row)], i.column()) for row, i in zip(rows, held, strict=True)]
        )
        self.layoutChanged.emit()

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(COLUMNS)

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        return (
            COLUMNS[section]
            if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole
            else None
        )

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        row = self.rows[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return row.texts()[index.column()]
        if role == Qt.ItemDataRole.EditRole:
            return (row.phrase, "", row.meaning or "", "")[index.column()]
        if role == Qt.ItemDataRole.FontRole:
            font = QFont()
            font.setBold(row.source != NOBODY and index.column() == 0)
            font.setStrikeOut(row.meaning is None and index.column() == 0)
            return font
        if role == Qt.ItemDataRole.UserRole:
            return row
        return None

    def flags(self, index: Index) -> Qt.ItemFlag:
        row, column = self.rows[index.row()], index.column()
        edits = column == 2 or (column == 0 and row.source != NOBODY and row.meaning is not None)
        return super().flags(index) | (Qt.ItemFlag.ItemIsEditable if edits else Qt.ItemFlag.NoItemFlags)

    def setData(self, index: Index, value: Any, role: int = Qt.ItemDataRole.EditRole) -> bool:
        row, text = (
            self.rows[index.row()],
            " ".join(str(value).lower().split()) if index.column() == 0 else " ".join(str(value).split()),
        )
        if not text or text == ((row.phrase, "", row.meaning)[index.column()]):
            return False
        phrase, meaning = (text, row.meaning or "") if index.column() == 0 else (row.phrase, text)
        try:
            change_pattern(self.patterns, row, phrase, meaning)
        except PatternsError as error:
            self._refused(tr_error(error))
            return False
        self._change(lambda p: change_pattern(p, row, phrase, meaning))
        return True


class ChosenPatterns(QSortFilterProxyModel):
    """The rows that match what is searched for; without the built-in ones unless they are wanted."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.words, self.all = "", False

    def look(self, words: str, every: bool) -> None:
        self.words, self.all = words.strip().lower(), every
        self.invalidate()

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        """The rows are in order already."""
        self.sourceModel().sort(column, order)

    def filterAcceptsRow(self, source_row: int, source_parent: Index) -> bool:
        model = self.sourceModel()
        assert isinstance(model, PatternTable)
        row = model.rows[source_row]
        if row.source == NOBODY and not self.all:
            return False
        return all(any(word in text for text in model.lower[source_row]) for word in self.words.split())


class MeaningEditor(QStyledItemDelegate):
    """Edits a meaning by a list where only some words will do."""

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: Index) -> QWidget:
        row: PatternRow = index.data(Qt.ItemDataRole.UserRole)
        few = MEANINGS[row.field]
        if index.column() != 2 or not few:
            return super().createEditor(parent, option, index)
        box = ComboBox(parent)
        fill_meanings(box, row.field)
        return box

    def setEditorData(self, editor: QWidget, index: Index) -> None:
        if isinstance(editor, QComboBox):
            editor.setCurrentIndex(max(0, editor.findData(index.data(Qt.ItemDataRole.EditRole))))
        else:
            super().setEditorData(editor, index)

    def setModelData(self, editor: QWidget, model: Any, index: Index) -> None:
        if isinstance(editor, QComboBox):
            model.setData(index, editor.currentData())
        else:
            super().setModelData(editor, model, index)


def fill_meanings(box: QComboBox, field: str) -> None:
    """Offer what words about a field may mean; free text where anything may."""
    box.clear()
    few = MEANINGS[field]
    box.setEditable(not few)
    for meaning in few:
        box.addItem(describe_meaning(field, meaning), meaning)
