"""The conversation panel: which conversation is on stage, what its segments are, and the lanes."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QDragMoveEvent, QDropEvent, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QToolButton, QVBoxLayout, QWidget

from app.features.conversation.segment_editing import Editing
from app.features.conversation.segment_lanes import KINDS, PLURALS, describe_segment
from app.features.conversation.segment_view import SegmentView
from app.features.conversation.sound_reading import Sounds
from app.look.plural import list_in_words
from app.look.theme import SOUND_MARKS, get_theme
from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from app.translation import group_thousands, tr, tr_noop, tr_plural
from app.widgets.drop_frame import DropFrame
from app.widgets.making import make_widget
from app.widgets.mime import read_sound_paths
from app.widgets.more_button import MoreButton
from app.widgets.quiet_fields import ComboBox
from app.widgets.sentence import Sentence
from metagraph.graph.conversation.model import SPOKEN, get_side_name

NONE = tr_noop("None on stage")
BELOW_WORDS = 150  # pixels from the top of these words to the button below them
# pixels of the panel below which the legend leaves its words out: the sentence beside needs the room
BRIEF = 1000


class ConversationPanel(QWidget):
    """files_dropped: sounds and transcripts were dropped here. more_menu: filled by the window's commands."""

    files_dropped = Signal(object)

    def __init__(
        self,
        document: Document,
        session: StageSession,
        jobs: Jobs,
        performance: StagePerformance,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.performance = document, session, performance
        self.sounds = Sounds(document, session, jobs, self)
        self.editing = Editing(document, session, self.sounds, self)
        self.setAcceptDrops(True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 4, 0, 0)
        layout.setSpacing(0)
        layout.addLayout(self._header())
        self.view = SegmentView(self.editing, self.sounds, self)
        layout.addWidget(self.view, 1)
        below = QVBoxLayout(self.view)  # what the view says while nothing is on stage
        below.addStretch(1)
        below.addSpacing(BELOW_WORDS)
        self.play = QPushButton(self.view)
        self.play.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # a click leaves the focus; the lanes would take it
        self.play.clicked.connect(self._play_first)
        below.addWidget(self.play, 0, Qt.AlignmentFlag.AlignHCenter)
        below.addStretch(1)
        self._soon = QTimer(self, singleShot=True, interval=0)  # many changes in a row are counted once
        self._soon.timeout.connect(self._words)
        document.changed.connect(lambda before, after: self._restage())
        session.onstage.conversation_changed.connect(self._restage)
        session.look.changed.connect(self._soon.start)
        session.onstage.mode_changed.connect(self._soon.start)
        self.editing.changed.connect(self._soon.start)
        performance.changed.connect(self._soon.start)
        self.drop_frame = DropFrame(self, session.look, tr("Drop to make a conversation"))
        self._restage()

    def _header(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setContentsMargins(12, 0, 12, 2)
        row.setSpacing(8)
        self.stage = ComboBox(self, toolTip=tr("The conversation on stage. It moves all its characters."))
        self.stage.setAccessibleName(tr("Conversation on stage"))
        self.stage.setMinimumWidth(150)
        self.stage.activated.connect(
            lambda _: self.session.onstage.set_conversation(self.stage.currentData())
        )
        row.addWidget(self.stage)
        tip = tr("Rename, change, export and remove the conversation")
        self.more = MoreButton(self.session.look, tr("Conversations"), tip, self)
        self.more_menu = self.more.menu_of
        row.addWidget(self.more)
        self.title = Sentence(self)
        self.title.setMinimumHeight(2 * self.title.fontMetrics().height())
        row.addWidget(self.title, 1)
        self.legend = QLabel(self, textFormat=Qt.TextFormat.RichText)
        self.legend.setToolTip(
            tr("Clauses, responses and hesitations. Press 1, 2 or 3 to label the selected segments.")
        )
        row.addWidget(self.legend)
        self.add = make_widget(
            QToolButton,
            self,
            text=tr("From sound…"),
            toolTip=tr("Read a conversation from sound files, with transcripts if you have them"),
        )
        row.addWidget(self.add)
        return row

    # --- showing

    def _restage(self) -> None:
        """Show which conversations there are, and which is on stage."""
        wanted = [(tr(NONE), None), *((c.name, i) for i, c in self.document.project.conversations.items())]
        if wanted != [(self.stage.itemText(n), self.stage.itemData(n)) for n in range(self.stage.count())]:
            self.stage.clear()
            for name, ident in wanted:
                self.stage.addItem(name, ident)
        self.stage.setCurrentIndex(
            next((n for n, (_, i) in enumerate(wanted) if i == self.session.onstage.conversation), 0)
        )
        self.stage.setEnabled(len(wanted) > 1)
        first = next(iter(self.document.project.conversations.values()), None)
        self.play.setVisible(first is not None and self.session.onstage.conversation is None)
        if first is not None:
            self.play.setText(tr("Play '{name}'", name=first.name))
        self._soon.start()

    def _play_first(self) -> None:
        """Put the first conversation on stage, and play it from its beginning."""
        first = next(iter(self.document.project.conversations))
        self.session.onstage.set_conversation(first)
        self.session.transport.seek(0.0)
        self.session.transport.set_playing(True)

    def _words(self) -> None:
        of, t = self.editing.conversation, get_theme(self.session.look.name)
        self.legend.setVisible(of is not None)
        if of is None:
            self.title.say("")
            return
        counts = {kind: sum(s.kind == kind for side in of.sides for s in side.segments) for kind in SPOKEN}
        brief = self.width() < BRIEF
        parts = []
        for k in SPOKEN:
            words = "" if brief else f" {KINDS[k] if counts[k] == 1 else PLURALS[k]}"
            mark = (
                f"<span style='background:{t.sounds[k]}; color:#17181b'>&nbsp;{SOUND_MARKS[k]}&nbsp;</span>"
            )
            parts.append(f"{mark} <span style='color:{t.dim}'>{group_thousands(counts[k])}{words}</span>")
        self.legend.setText("&nbsp;&nbsp; ".join(parts))
        if self.session.onstage.mode == "manual":
            self.title.say(
                tr(
                    "The manual state machine now moves one character. Switch back to the meta-graph to "
                    "move all speakers with the speech."
                )
            )
            return
        chosen, found = self.editing.chosen, self.editing.segment(self.editing.last)
        if len(chosen) == 1 and found is not None and self.editing.last is not None:
            self.title.say(
                f"{get_side_name(of, self.editing.last[0])}: {describe_segment(found)}".replace("\n", ", "),
                True,
            )
        elif chosen:
            self.title.say(
                tr(
                    "{segments} selected",
                    segments=tr_plural("{count:,} segment", "{count:,} segments", len(chosen)),
                ),
                True,
            )
        else:
            minutes, seconds = divmod(round(of.length), 60)
            who = list_in_words([get_side_name(of, side) for side in range(len(of.sides))])
            self.title.say(f"{who}, {minutes}:{seconds:02d}{self._delivered()}")

    def _delivered(self) -> str:
        """Say how many clauses get a gesture, beside how many were asked for: of more than two in all."""
        told = [t for one in self.performance.shown.everyone for t in one.told[:1] if t.count]
        if not told:
            return ""
        shares = [(t.performed / t.count, t.asked) for t in told]
        if len(told) > 2:
            whole = sum(t.count for t in told)
            shares = [(sum(t.performed for t in told) / whole, sum(t.asked * t.count for t in told) / whole)]
        done, asked = (
            list_in_words([f"{100 * share:.0f} %" for share in some]) for some in zip(*shares, strict=True)
        )
        return tr(". {done} of the clauses have a gesture; the rates ask for {asked}", done=done, asked=asked)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._soon.start()

    # --- drops

    def dragEnterEvent(self, event: QDragMoveEvent) -> None:
        if read_sound_paths(event.mimeData()):
            event.acceptProposedAction()
            self.drop_frame.follow(event)

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        self.dragEnterEvent(event)

    def dropEvent(self, event: QDropEvent) -> None:
        paths = read_sound_paths(event.mimeData())
        if paths:
            event.acceptProposedAction()
            self.files_dropped.emit(paths)
