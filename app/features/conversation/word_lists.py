"""Which words are responses and hesitations, and in which language: fields, and the dialog that changes them
of a conversation.
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QGridLayout,
    QHBoxLayout,
    QPlainTextEdit,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.conversation.conversation_settings import SettingDialog, Tall, make_caption, parse_word_list
from app.look.theme import SOUND_MARKS
from app.translation import tr, tr_noop
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import AUTO, Conversation, get_side_name, get_word_lists
from metagraph.graph.model import Project
from metagraph.speech.language_detection import detect_language
from metagraph.speech.language_packs import list_language_packs

Lists = tuple[tuple[str, ...], tuple[str, ...]]  # responses and hesitations
LOW = 74  # pixels
# Names of the languages that come with Metagraph, as their files have them.
NAMES = (
    *(tr_noop("English"), tr_noop("German"), tr_noop("French"), tr_noop("Spanish"), tr_noop("Italian")),
    *(tr_noop("Portuguese"), tr_noop("Dutch"), tr_noop("Japanese"), tr_noop("Chinese (Mandarin)")),
    tr_noop("Hindi"),
)


def name_language(code: str) -> str:
    """Return the name of the language with a code, or "" for no code."""
    pack = list_language_packs().get(code)
    return (
        tr(pack.name)
        if pack is not None
        else {"": "", "und": tr("language not known")}.get(code, f"'{code}'")
    )


class LanguageBox(ComboBox):
    """A choice of languages: automatic first, then those that have word lists."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.addItem(tr("Automatic"), AUTO)
        for pack in list_language_packs().values():
            name = tr(pack.name)
            self.addItem(
                name if name.casefold() == pack.own.casefold() else f"{name} · {pack.own}", pack.code
            )
        self.setAccessibleName(tr("Language"))
        self.setToolTip(
            tr(
                "The language whose word lists identify responses and hesitations. Automatic detects "
                "it from the words."
            )
        )

    def show_code(self, code: str) -> None:
        """Show a language without emitting a signal. One that is not in the box is added to it."""
        with QSignalBlocker(self):
            if code and self.findData(code) < 0:
                self.addItem(name_language(code).capitalize(), code)
            self.setCurrentIndex(max(0, self.findData(code)))


class WordLists(QWidget):
    """The two lists of words, beside each other. changed: something was typed. usual: the lists of the
    language, to go back to.
    """

    changed = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(16)
        grid.setVerticalSpacing(4)
        english = list_language_packs()["en"]
        self.usual: Lists = (english.responses, english.hesitations)
        self.edits: list[QPlainTextEdit] = []
        for column, (title, kind) in enumerate(
            ((tr("Listener responses"), "response"), (tr("Hesitations"), "hesitation"))
        ):
            row = QHBoxLayout()
            row.addWidget(make_caption(f"{SOUND_MARKS[kind]}  {title}", self), 1)
            reset = make_widget(
                QToolButton,
                self,
                text=tr("Default"),
                toolTip=tr("Restore the list for this language that comes with Metagraph"),
            )
            reset.clicked.connect(
                lambda _=False, n=column: self.edits[n].setPlainText(", ".join(self.usual[n]))
            )
            row.addWidget(reset)
            edit = QPlainTextEdit(self)
            edit.setAccessibleName(title)
            edit.setTabChangesFocus(True)
            edit.setMinimumHeight(72)
            edit.textChanged.connect(self.changed)
            grid.addLayout(row, 0, column)
            grid.addWidget(edit, 1, column)
            self.edits.append(edit)

    def show_lists(self, lists: Lists, code: str = "") -> None:
        """Show lists without telling of it. code: the language whose usual lists there are to go back to."""
        pack = list_language_packs().get(code)
        if pack is not None:
            self.usual = (pack.responses, pack.hesitations)
        for edit, words in zip(self.edits, lists, strict=True):
            text = ", ".join(words)
            if edit.toPlainText() != text:
                with QSignalBlocker(edit):
                    edit.setPlainText(text)

    def set_low(self, low: bool) -> None:
        """Be low beside another pair of lists, or as high as there is room."""
        for edit in self.edits:
            edit.setMaximumHeight(LOW if low else 16777215)

    def lists(self) -> Lists:
        return parse_word_list(self.edits[0].toPlainText()), parse_word_list(self.edits[1].toPlainText())


class WordsDialog(SettingDialog):
    """Which words make a segment a response or a hesitation, of all or of each."""

    title, text = tr_noop("Word lists"), tr_noop("Change word lists")

    def build(self, layout: QVBoxLayout) -> None:
        layout.addWidget(
            make_caption(
                tr("Segments that contain only these words get this label. Your own labels do not change."),
                self,
                True,
            )
        )
        of = self.conversation
        self.apart = QCheckBox(tr("Separate lists for each speaker"), self)
        self.sides = range(len(of.sides))
        self.apart.setChecked(any(get_word_lists(of, n) != get_word_lists(of, 0) for n in self.sides))
        everyone = tr("Both") if len(self.sides) == 2 else tr("All")
        inside = QWidget(self)
        inner = QVBoxLayout(inside)
        inner.setContentsMargins(0, 0, 0, 0)
        self.rows: list[tuple[QWidget, LanguageBox, WordLists]] = []
        for side in self.sides:
            whole = QWidget(inside)
            column = QVBoxLayout(whole)
            column.setContentsMargins(0, 0, 0, 0)
            row = QHBoxLayout()
            row.setSpacing(10)
            name, box, lists = make_caption("", whole), LanguageBox(whole), WordLists(whole)
            box.show_code(of.sides[side].language or "en")
            box.activated.connect(lambda _, n=side: self._take_language(n))
            lists.show_lists(get_word_lists(of, side), of.sides[side].language)
            row.addWidget(name, 1)
            row.addWidget(make_caption(tr("Language"), whole, True))
            row.addWidget(box)
            column.addLayout(row)
            column.addWidget(lists, 1)
            inner.addWidget(whole, 1)
            self.rows.append((whole, box, lists))
            self.apart.toggled.connect(
                lambda on, label=name, n=side: label.setText(get_side_name(of, n) if on else everyone)
            )
            name.setText(get_side_name(of, side) if self.apart.isChecked() else everyone)
        layout.addWidget(inside if len(self.sides) == 2 else Tall(inside, 480, self), 1)
        self.lists = self.rows[0][2]
        self._show_other(self.apart.isChecked())
        self.apart.toggled.connect(self._show_other)
        layout.addWidget(self.apart)
        self.lists.edits[0].setFocus()

    def _show_other(self, on: bool) -> None:
        for whole, _, _ in self.rows[1:]:
            whole.setVisible(on)
        self.resize(620, 580 if on else 420)

    def _take_language(self, n: int) -> None:
        """Show the lists of the language that was chosen; Automatic is what the words tell."""
        _, box, lists = self.rows[n]
        code = str(box.currentData())
        if code == AUTO:
            code = _spoken_by(self.conversation, (n,) if self.apart.isChecked() else self.sides)
            box.show_code(code)
        pack = list_language_packs().get(code)
        if pack is not None:
            lists.show_lists((pack.responses, pack.hesitations), code)

    def change(self, project: Project) -> Project:
        sides: Sequence[int | None] = self.sides if self.apart.isChecked() else (None,)
        for side in sides:
            _, box, lists = self.rows[side or 0]
            code = str(box.currentData())
            if code == (self.conversation.sides[side or 0].language or "en"):
                code = self.conversation.sides[side or 0].language  # as it was; nothing said stays so
            project = conversation_edits.set_word_lists(project, self.ident, *lists.lists(), side, code)
        return project


def _spoken_by(conversation: Conversation, sides: Sequence[int]) -> str:
    """Return the code of what sides' words tell; English where they tell nothing."""
    words = [w.text for side in sides for w in conversation.sides[side].words]
    found = detect_language(words, tuple(list_language_packs().values())).language
    return found.code if found is not None else "en"
