"""What new motion is asked for: for whose speech, how it is searched, and what of the speech constrains
it.
"""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDoubleSpinBox,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.features.motion_graph.soft_wishes import SoftWishes
from app.features.motion_graph.synthesis_jobs import Wish
from app.features.motion_graph.takes_list import describe_side
from app.look.theme import strengthen
from app.project.document import Document
from app.translation import make_lazy_texts, tr
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox
from metagraph.graph.conversation.model import SOUNDS, Segment, Side, Sound, list_segments_heard_by

WINDOW = 15.0  # seconds, as in the paper's evaluation
KINDS: tuple[tuple[Sound, str], ...] = make_lazy_texts(
    lambda: (
        ("clause", tr("Clauses")),
        ("response", tr("Responses")),
        ("hesitation", tr("Partner's hesitations")),
        ("idle", tr("Idle")),
    )
)


class Wishes(QFrame):
    """wanted: Find was pressed."""

    wanted = Signal()

    def __init__(self, document: Document, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document = document
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 4, 0, 0)
        box.setSpacing(6)
        title = QLabel(tr("New motion"), self)
        title.setProperty("heading", True)
        box.addWidget(title)
        for row in (self._search_row(), self._sounds_row(), self._soft_row()):
            box.addLayout(row)
        self.fill()

    def _search_row(self) -> QHBoxLayout:
        """Return what it goes with, for how long, and how it is searched."""
        row = QHBoxLayout()
        self.speech = ComboBox(self)
        self.speech.setAccessibleName(tr("Speech to match"))
        self.speech.setMinimumWidth(200)
        self.speech.activated.connect(self._limits)
        self.start = self._seconds(tr("From"), 0.0, 0.0)
        self.length = self._seconds(tr("Seconds"), 1.0, WINDOW)
        self.search = ComboBox(self)
        self.search.setAccessibleName(tr("Search"))
        self.search.addItem(tr("best"), True)
        self.search.addItem(tr("quick, random"), False)
        self.search.setItemData(
            0,
            tr("Dynamic programming over all frames. Finds the motion with the lowest cost if there is one."),
            3,
        )
        self.search.setItemData(
            1,
            tr(
                "Stochastic greedy search, as in the paper. Another seed gives another result. It may "
                "find nothing."
            ),
            3,
        )
        self.search.activated.connect(self._limits)
        self.seed = DoubleSpinBox(self, minimum=1, maximum=9999, decimals=0, value=1)
        self.seed.setAccessibleName(tr("Seed"))
        for words, field in (
            (tr("Speech to match"), self.speech),
            (tr("from"), self.start),
            (tr("for"), self.length),
            (tr("Search"), self.search),
            (tr("seed"), self.seed),
        ):
            row.addWidget(QLabel(words, self))
            row.addWidget(field)
            row.addSpacing(6)
        row.addStretch(1)
        return row

    def _sounds_row(self) -> QHBoxLayout:
        """Return what is met of what is heard, and for whom."""
        row = QHBoxLayout()
        row.addWidget(QLabel(tr("Must match"), self))
        self.kinds: dict[Sound, QCheckBox] = {}
        for kind, words in KINDS:
            self.kinds[kind] = make_widget(QCheckBox, words, self, checked=True)
            row.addWidget(self.kinds[kind])
        self.peaks = make_widget(QCheckBox, tr("Stresses"), self, checked=True)
        self.peaks.setToolTip(tr("Clause stresses must match the stresses in the speech of the take"))
        row.addWidget(self.peaks)
        self.edges = make_widget(QCheckBox, tr("Starts and ends"), self, checked=True)
        self.edges.setToolTip(tr("The speech must start and end when the speech of the take did"))
        row.addWidget(self.edges)
        self.tolerance = DoubleSpinBox(
            self, minimum=0.0, maximum=1.0, singleStep=0.05, decimals=2, value=0.1, suffix=" s"
        )
        self.tolerance.setAccessibleName(tr("Tolerance"))
        row.addSpacing(8)
        row.addWidget(QLabel(tr("±"), self))
        row.addWidget(self.tolerance)
        self.whole = QCheckBox(tr("Move this speaker"), self)
        self.whole.setToolTip(
            tr("Find motion for the whole conversation. It moves this speaker instead of the graph.")
        )
        self.whole.toggled.connect(self._limits)
        row.addSpacing(8)
        row.addWidget(self.whole)
        row.addStretch(1)
        return row

    def _soft_row(self) -> QHBoxLayout:
        """Return what is only wished for, and the button that begins."""
        row = QHBoxLayout()
        self.soft = SoftWishes(self)
        row.addWidget(self.soft, 1)
        self.go = QPushButton(tr("Find"), self, autoDefault=False)
        self.go.clicked.connect(self.wanted)
        self.soft.wanted.connect(self.go.click)
        strengthen(self.go)
        row.addWidget(self.go)
        return row

    def _seconds(self, name: str, least: float, value: float) -> QDoubleSpinBox:
        out = DoubleSpinBox(self, minimum=least, maximum=3600, decimals=1, value=value, suffix=" s")
        out.setAccessibleName(name)
        return out

    def fill(self) -> None:
        """List whose speech there is."""
        chosen, first = self.speech.currentData(), not self.speech.count()
        self.speech.clear()
        self.speech.addItem(tr("no speech"), None)
        for ident, talk in self.document.project.conversations.items():
            for n in range(2):
                self.speech.addItem(describe_side(talk, n), (ident, n))
                if chosen == (ident, n) or (first and self.speech.count() == 2):
                    self.speech.setCurrentIndex(self.speech.count() - 1)
        self._limits()

    def _limits(self) -> None:
        talks = self.speech.currentData() is not None
        for box in (*self.kinds.values(), self.peaks, self.edges, self.tolerance, self.start):
            box.setEnabled(talks)
        self.soft.setEnabled(talks)
        self.seed.setEnabled(not self.search.currentData())
        self.whole.setEnabled(talks)
        self.start.setEnabled(talks and self.moves is None)
        self.length.setEnabled(self.moves is None)

    @property
    def talks(self) -> bool:
        """Whether it is to go with speech."""
        return self.speech.currentData() is not None

    @property
    def moves(self) -> tuple[str, int] | None:
        """Which side of which conversation is to move with it; None for neither."""
        chosen: tuple[str, int] | None = self.speech.currentData()
        return chosen if self.whole.isChecked() else None

    def wish(self) -> Wish:
        """Return what is requested now. Raises ValueError if a word is none."""
        chosen, seconds, start = self.speech.currentData(), self.length.value(), self.start.value()
        if self.moves is not None:
            seconds, start = self.document.project.conversations[self.moves[0]].length, 0.0
        use = tuple(kind for kind in SOUNDS if self.kinds[kind].isChecked()) if chosen is not None else ()
        segments: tuple[Segment, ...] = ()
        whole: tuple[Segment, ...] = ()
        side: Side | None = None
        if chosen is not None:
            talk = self.document.project.conversations[chosen[0]]
            seconds = min(seconds, max(1.0, talk.length - start))
            from metagraph.research.motion_graph.search_evaluation import cut_segments

            whole, side = list_segments_heard_by(talk, chosen[1]), talk.sides[chosen[1]]
            segments = tuple(cut_segments(whole, start, seconds))
        return Wish(
            seconds,
            segments,
            bool(self.search.currentData()),
            use,
            self.peaks.isChecked(),
            self.tolerance.value(),
            int(self.seed.value()),
            self.edges.isChecked(),
            self.soft.wish(),
            side,
            whole,
            start,
        )

    def name(self) -> str:
        """Return what the new clip is called."""
        chosen = self.speech.currentData()
        if chosen is None:
            return tr("new motion")
        talk = self.document.project.conversations[chosen[0]]
        part = "" if self.moves is not None else f" {self.start.value():g}s"
        return f"{talk.name} {talk.sides[chosen[1]].name or chosen[1] + 1}{part}"
