"""A conversation from sound: what was found, who is who, what makes a response or a hesitation, and what
comes of it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.features.conversation.conversation_settings import make_caption
from app.features.conversation.speaker_card import Cards, SpeakerCard
from app.features.conversation.word_lists import LanguageBox, Lists, WordLists, name_language
from app.look.theme import get_theme, strengthen
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.project.speech_files import TRANSCRIPTS, describe_sound_file
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_phrase
from app.widgets.act_strip import format_clock
from app.widgets.making import make_widget
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import (
    AUTO,
    MOST_SPEAKERS,
    Conversation,
    Side,
    get_side_name,
    get_word_lists,
    with_sides,
)
from metagraph.graph.model import Project

if TYPE_CHECKING:
    from metagraph.formats.conversations.files import Read

TYPED = 700  # milliseconds of quiet after a word list was typed in before the sound is read by it
NUMBERED = re.compile(r"speaker[ _-]?\d+", re.IGNORECASE)  # names a program gave; ours are as good
MOST = 6  # notes that are shown; more of them do not help


class ImportDialog(QDialog):
    """imported: the id of the conversation that was added. It is read on a thread, again whenever files or
    lists change.
    """

    imported = Signal(str)

    def __init__(
        self,
        document: Document,
        session: StageSession,
        jobs: Jobs,
        sounds: Sequence[Path],
        transcripts: Sequence[Path],
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self.sounds, self.transcripts = tuple(sounds), tuple(transcripts)[:MOST_SPEAKERS]
        self.facts = tuple(describe_sound_file(p) for p in self.sounds)
        self.read: Read | None = None
        self.typed: list[Lists | None] = []  # lists that were typed, by the sides as they are read
        self.order = [0, 1]  # of the cards: which of those that were read each shows
        self.job: WindowJob | None = None
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Conversation from sound"))
        self.resize(920, 500)  # at which both cards are as wide
        self._soon = QTimer(self, singleShot=True, interval=TYPED)
        self._soon.timeout.connect(self.start)
        self._build()
        document.loaded.connect(self.reject)  # what was read is said relative to the project it was read for
        self.start()

    @property
    def cards(self) -> list[SpeakerCard]:
        """A card for each who was read, as they are to stand."""
        return self.table.cards

    # --- building

    def _build(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(18, 16, 18, 14)
        layout.setSpacing(12)
        row = QHBoxLayout()
        row.setSpacing(12)
        row.addWidget(make_caption(tr("Name"), self, True))
        self.name = QLineEdit(self.sounds[0].stem, self)
        self.name.setAccessibleName(tr("Name of the conversation"))
        row.addWidget(self.name, 1)
        row.addWidget(make_caption(tr("Language"), self, True))
        self.language = LanguageBox(self)
        self.language.show_code(self.document.project.language)
        self.language.activated.connect(self.take_language)
        row.addWidget(self.language)
        layout.addLayout(row)
        layout.addLayout(self._found())
        self.table = Cards(self)
        self.swap = self.table.swap
        self.table.moved.connect(self.move_earlier)
        self.table.chosen.connect(self._show_parts)
        layout.addWidget(self.table)
        # All sides' lists, or the first one's and the second one's where two speak different languages.
        self.whose = make_caption("", self), make_caption("", self)
        self.lists, self.others = WordLists(self), WordLists(self)
        for label, lists in zip(self.whose, (self.lists, self.others), strict=True):
            lists.changed.connect(self._typed)
            layout.addWidget(label)
            layout.addWidget(lists, 1)
        self._show_lists()
        self.notes = QLabel(self, wordWrap=True)
        self.notes.setTextFormat(Qt.TextFormat.PlainText)
        self.notes.hide()
        layout.addWidget(self.notes)
        layout.addLayout(self._foot())
        self.session.look.changed.connect(self._restyle)
        self._restyle()

    def _show_parts(self) -> None:
        """Show who takes part."""
        for card in self.cards:
            card.setEnabled(True)
            for widget in (card.name, card.sound, card.words, card.segments):
                widget.setEnabled(card.taken.isChecked())
        self.go.setEnabled(self.read is not None and sum(c.taken.isChecked() for c in self.cards) > 1)

    def _restyle(self) -> None:
        t = get_theme(self.session.look.name)
        self.setStyleSheet(
            f"QFrame#card {{ background: {t.card}; border: 1px solid {t.line}; border-radius: 8px; }}"
        )

    def _found(self) -> QHBoxLayout:
        """The row of what was found, with what can be done about the words."""
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addWidget(make_caption(tr("Detected"), self, True))
        self.files = QLabel(self, wordWrap=True)
        row.addWidget(self.files, 1)
        self.add_words = make_widget(
            QToolButton,
            self,
            text=tr("Add text…"),
            toolTip=tr("A transcript: TextGrid, ELAN, WebVTT, SRT, JSON or CTM"),
        )
        self.add_words.clicked.connect(self.request_words)
        self.other_words = make_widget(
            QToolButton,
            self,
            text=tr("Swap words"),
            toolTip=tr("Use this if each speaker was given the other's words"),
        )
        self.other_words.clicked.connect(self.swap_words)
        self.no_words = make_widget(
            QToolButton,
            self,
            text=tr("Without words"),
            toolTip=tr("Read only the sound: detect speech from loudness and pauses"),
        )
        self.no_words.clicked.connect(lambda: self.take_words(()))
        for button in (self.add_words, self.other_words, self.no_words):
            row.addWidget(button)
        return row

    def _foot(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(10)
        self.told = QLabel(tr("Reading…"), self)
        self.told.setProperty("dim", True)
        self.bar = QProgressBar(self, textVisible=False)
        self.bar.setRange(0, 0)
        self.bar.setFixedWidth(150)
        self.stop = make_widget(
            QToolButton, self, text=tr("Stop"), toolTip=tr("Stop reading, but keep the dialog open")
        )
        self.stop.clicked.connect(self.stop_reading)
        self.again = make_widget(QToolButton, self, text=tr("Read again"), toolTip=tr("Read the files again"))
        self.again.clicked.connect(self.start)
        for widget in (self.bar, self.told, self.stop, self.again):
            row.addWidget(widget)
        row.addStretch(1)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        buttons.button(QDialogButtonBox.StandardButton.Cancel).setIcon(QIcon())
        self.go = QPushButton(tr("Add"), self)
        strengthen(self.go)
        buttons.addButton(self.go, QDialogButtonBox.ButtonRole.AcceptRole)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        row.addWidget(buttons)
        return row

    # --- reading

    @property
    def busy(self) -> bool:
        """Whether it reads, or is about to."""
        return self.job is not None or self._soon.isActive()

    def start(self) -> None:
        """Read everything, by the lists as they are; what was being read is not waited for."""
        self._soon.stop()
        self._end_job()
        self.read = None
        sounds, transcripts, folder = self.sounds, self.transcripts, self.document.folder
        language, usual = str(self.language.currentData()), self.document.project.language
        lists = tuple(self.typed)

        def work(job: WindowJob) -> Any:
            from metagraph.formats.conversations.files import read_conversation
            from metagraph.formats.conversations.languages import Speaking
            from metagraph.speech.language_packs import list_language_packs

            chosen = language if language in list_language_packs() else AUTO  # one's own list is not at hand

            return read_conversation(
                sounds,
                transcripts,
                folder=folder,
                cancelled=lambda: job.cancelled,
                speaking=Speaking(chosen, usual, lists=lists),
            )

        self.job = self.jobs.start(tr("Reading the conversation"), work, self._came, self._failed)
        self._show(tr("Reading the sound and its words…"), busy=True)

    def _end_job(self) -> None:
        if self.job is not None:
            self.job.cancel()
            self.job = None

    def stop_reading(self) -> None:
        self._soon.stop()
        self._end_job()
        self._show(tr("Stopped."))

    def _came(self, read: Read) -> None:
        self.job = None
        self.read = read
        count = len(read.conversation.sides)
        if count != len(self.order):
            self.order = list(range(count))
        self.table.deal(count)
        for card, side in zip(self.cards, self.sides(), strict=True):
            if not card.name.isModified():
                card.name.setText("" if NUMBERED.fullmatch(side.name) else side.name)
        self._show_lists()
        minutes = format_clock(round(read.conversation.length))
        self._show(tr("Read {minutes} of conversation.", minutes=minutes))

    def _failed(self, error: Exception) -> None:
        self.job = None
        self._show(tr("The files cannot be read."), failure=tr_error(error))

    def _show(self, told: str, busy: bool = False, failure: str = "") -> None:
        """Show how things are."""
        self.told.setText(told)
        self.bar.setVisible(busy)
        self.stop.setVisible(busy)
        self.again.setVisible(not busy and self.read is None)
        self.go.setEnabled(self.read is not None)
        self.files.setText(" · ".join((*self.facts, *(p.name for p in self.transcripts))))
        self.no_words.setEnabled(bool(self.transcripts) and not busy)
        self.other_words.setVisible(len(self.transcripts) == 2 == len(self.cards))
        self.other_words.setEnabled(not busy)
        self.swap.setEnabled(self.read is not None)
        for n, card in enumerate(self.cards):
            card.show_side(self.sides()[n] if self.read is not None else None)
        self._show_parts()
        notes = list(self.read.notes) if self.read is not None else [failure] if failure else []
        more = [tr("… and {count} more", count=len(notes) - MOST)] if len(notes) > MOST else []
        t = get_theme(self.session.look.name)
        self.notes.setStyleSheet(f"color: {t.error if failure else t.warning}")
        lines = [f"⚠  {tr_phrase(n)}" for n in notes[:MOST]]
        self.notes.setText("\n".join((*lines, *more)))
        self.notes.setVisible(bool(notes))
        self._fit()

    def _fit(self) -> None:
        """Grow as high as the notes need: a layout does not ask for what words need that are broken into
        lines.
        """
        layout = self.layout()
        if layout is not None:
            layout.activate()
            self.resize(self.width(), max(self.height(), layout.totalHeightForWidth(self.width())))

    def _show_lists(self) -> None:
        """Show whose words are what, as far as they were not typed."""
        read = self.read.conversation if self.read is not None else None
        apart = read is not None and any(
            get_word_lists(read, n) != get_word_lists(read, 0) for n in self.order
        )
        several = len(self.order) > 2
        for label, lists, side in zip(self.whose, (self.lists, self.others), self.order, strict=False):
            if read is None:
                lists.show_lists(lists.usual)
            elif not self.typed or self.typed[side] is None:
                code = read.sides[side].language
                lists.show_lists(get_word_lists(read, side), code)
            if apart and read is not None:
                of = read.sides[side]
                label.setText(f"{get_side_name(read, side)}: {name_language(of.language) or tr('no words')}")
            label.setVisible(apart and not several)
            lists.set_low(apart or several)
        self.lists.setVisible(not (apart and several))
        self.others.setVisible(apart and not several)
        if apart and several and read is not None:
            each = [
                f"{get_side_name(read, n)} {name_language(read.sides[n].language) or tr('without words')}"
                for n in self.order
            ]
            self.whose[0].setText(
                tr(
                    "Each speaker has their own word lists, which you can change later: {each}",
                    each=", ".join(each),
                )
            )
            self.whose[0].setWordWrap(True)
            self.whose[0].setVisible(True)

    def _typed(self) -> None:
        """Read by the lists that are typed, after a while."""
        typed: list[Lists | None] = [self.lists.lists()] * len(self.order)
        if self.others.isVisible():
            typed[self.order[1]] = self.others.lists()
        self.typed = typed
        self._soon.start()

    def take_language(self) -> None:
        """Read by the language that is chosen, and by its lists."""
        self.typed = []
        self.start()

    def sides(self) -> tuple[Side, ...]:
        """Return those who were read, as their cards stand."""
        assert self.read is not None
        return tuple(self.read.conversation.sides[n] for n in self.order)

    # --- choosing

    def move_earlier(self, n: int) -> None:
        """Let one stand before the one before it; of two, swap them."""
        self.order[n - 1], self.order[n] = self.order[n], self.order[n - 1]
        a, b = self.cards[n - 1], self.cards[n]
        states = [(c.name.text(), c.name.isModified(), c.taken.isChecked()) for c in (b, a)]
        for card, (name, typed, taken) in zip((a, b), states, strict=True):
            card.name.setText(name)
            card.name.setModified(typed)
            card.taken.setChecked(taken)
        self._show_lists()
        self._show(self.told.text())

    def swap_words(self) -> None:
        """Let the words of the one be the other's."""
        self.take_words(self.transcripts[::-1])

    def take_words(self, transcripts: Sequence[Path]) -> None:
        self.transcripts = tuple(transcripts)[-max(2, len(self.sounds)) :]  # one for all, or one for each
        self.start()

    def request_words(self) -> None:
        ends = " ".join(f"*{s}" for s in (*TRANSCRIPTS, ".TextGrid"))
        names, _ = QFileDialog.getOpenFileNames(
            self,
            tr("Words of the conversation"),
            str(self.sounds[0].parent),
            tr("Transcripts ({ends})", ends=ends),
        )
        if names:
            self.take_words(
                [*self.transcripts, *(p for n in names if (p := Path(n)) not in self.transcripts)]
            )

    def made(self) -> Conversation:
        """Return the conversation as it would be added."""
        assert self.read is not None
        sides = list(self.read.conversation.sides)
        for n, card in zip(self.order, self.cards, strict=True):
            sides[n] = msgspec.structs.replace(sides[n], name=" ".join(card.name.text().split()))
        name = " ".join(self.name.text().split()) or self.sounds[0].stem
        whole = msgspec.structs.replace(self.read.conversation, name=name, sides=tuple(sides))
        return with_sides(
            whole, [n for n, c in zip(self.order, self.cards, strict=True) if c.taken.isChecked()]
        )

    def accept(self) -> None:
        """Add it as one undo step, and put it on stage."""
        if self.read is None:
            return
        conversation, ident = self.made(), ""

        def edit(project: Project) -> Project:
            nonlocal ident
            from metagraph.speech.automatic_cuts import keep_filmed_conversation

            project, ident = keep_filmed_conversation(project, conversation)
            return conversation_edits.set_language(project, str(self.language.currentData()))

        self.document.edit(tr("Add conversation"), edit)
        self.session.onstage.set_conversation(ident)
        self.session.transport.show_plan()
        self.session.transport.seek(0.0)
        self.imported.emit(ident)
        super().accept()

    def done(self, result: int) -> None:
        self._soon.stop()
        self._end_job()
        super().done(result)
