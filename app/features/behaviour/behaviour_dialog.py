"""What the character does by itself in an hour of talking, listening or idling, next to what people do."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import get_theme
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.stage.session import StageSession
from app.translation import make_lazy_texts, tr, tr_error, tr_phrase, tr_plural
from app.widgets.choice_row import ChoiceRow
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox
from metagraph.graph import edits
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import Mode, Project
from metagraph.graph.temperaments import (
    TEMPERAMENTS,
    find_rest_scale,
    find_temperament,
    set_rest_scale,
    set_temperament,
)
from metagraph.playback.behaviour import BehaviourCount, describe_lack, measure_behaviour
from metagraph.playback.planning.markov import DEFAULTS

OWN = "own"
SETTLED = 400  # milliseconds without an edit after which is counted again
MOST_LACKS = 4  # stances that lack actions, named in the dialog
ORDER: tuple[Mode, ...] = ("talking", "listening", "idle")
TITLES = make_lazy_texts(
    lambda: {"talking": tr("Talking"), "listening": tr("Listening"), "idle": tr("Idle")},
)


class BehaviourDialog(QDialog):
    """Stays open beside the window, and counts again after each edit."""

    def __init__(
        self, document: Document, session: StageSession, jobs: Jobs, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self.found: dict[str, BehaviourCount] = {}
        self._counted: Project | None = None
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Behaviour"))
        self.resize(980, 680)
        self._soon = QTimer(self, singleShot=True, interval=SETTLED)
        self._soon.timeout.connect(self._count)
        box = QVBoxLayout(self)
        box.setContentsMargins(16, 14, 16, 12)
        box.setSpacing(10)
        self._add_choices(box)
        self._add_dials(box)
        self._add_table(box)
        self.lacks = QLabel(self, wordWrap=True)
        self.lacks.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        box.addWidget(self.lacks)
        self._add_foot(box)
        document.changed.connect(self._edited)
        document.loaded.connect(self._edited)
        session.look.changed.connect(self._show)
        session.onstage.performance_changed.connect(self._show)
        self._edited()
        self._count()

    def _add_choices(self, box: QVBoxLayout) -> None:
        row = QHBoxLayout()
        row.setSpacing(10)
        ways = (tr("What it does while it talks"), tr("What it does while it listens"), tr("At rest"))
        self.modes = ChoiceRow(self, tuple(zip((TITLES[m] for m in ORDER), ways, strict=True)))
        self.modes.chosen.connect(lambda n: self.session.onstage.improvise(ORDER[n]))
        row.addWidget(self.modes)
        row.addStretch(1)
        row.addWidget(QLabel(tr("Temperament"), self))
        self.temperament = ComboBox(self)
        self.temperament.setAccessibleName(tr("Temperament"))
        for name, of in TEMPERAMENTS.items():
            self.temperament.addItem(tr_phrase(of.title), name)
            self.temperament.setItemData(
                self.temperament.count() - 1, tr_phrase(of.tip), Qt.ItemDataRole.ToolTipRole
            )
        self.temperament.addItem(tr("Custom"), OWN)
        self.temperament.activated.connect(self._set_temperament)
        row.addWidget(self.temperament)
        box.addLayout(row)

    def _add_dials(self, box: QVBoxLayout) -> None:
        """Add the numbers that a temperament sets together, each to be set alone."""
        row = QHBoxLayout()
        row.setSpacing(8)
        self.dials: dict[str, DoubleSpinBox] = {}
        for name, title, tip, most, step, suffix in (
            ("rests", tr("Rests"), tr("How long the rests between acts are: 1 is usual"), 5.0, 0.1, " ×"),
            (
                "variety",
                tr("Variety"),
                tr("How rarely acts and changes of stance are repeated: 1 is usual, 0 repeats at once"),
                4.0,
                0.25,
                " ×",
            ),
            ("aversion_rate", tr("Looks away"), tr("How often it looks away"), 40.0, 0.5, tr(" a minute")),
            ("blinks", tr("Blinks"), tr("How often it blinks by itself"), 60.0, 0.5, tr(" a minute")),
        ):
            least = 0.1 if name == "rests" else 0.0
            number = DoubleSpinBox(self, minimum=least, maximum=most, singleStep=step, decimals=2)
            number.setSuffix(suffix)
            number.setToolTip(tip)
            number.setAccessibleName(title)
            number.setKeyboardTracking(False)
            number.valueChanged.connect(lambda value, name=name, title=title: self._turn(name, title, value))
            label = QLabel(title, self)
            label.setBuddy(number)
            row.addWidget(label)
            row.addWidget(number)
            row.addSpacing(8)
            self.dials[name] = number
        row.addStretch(1)
        box.addLayout(row)

    def _turn(self, name: str, title: str, value: float) -> None:
        """Set the number that a dial is of."""
        words = tr("Change {name}", name=title)
        if name == "rests":
            self.document.edit(words, lambda p: set_rest_scale(p, value, DEFAULTS))
        elif name == "variety":
            self.document.edit(words, lambda p: edits.set_settings(p, variety=value))
        else:
            self.document.edit(words, lambda p: performance_edits.set_life(p, **{name: value}))

    def _show_dials(self) -> None:
        project = self.document.project
        rests = find_rest_scale(project, DEFAULTS)
        self.dials["rests"].setEnabled(rests is not None)
        values = {
            "rests": 1.0 if rests is None else rests,
            "variety": project.settings.variety,
            "aversion_rate": project.life.aversion_rate,
            "blinks": project.life.blinks,
        }
        for name, value in values.items():
            self.dials[name].blockSignals(True)
            self.dials[name].setValue(value)
            self.dials[name].blockSignals(False)

    def _add_table(self, box: QVBoxLayout) -> None:
        self.table = QTableWidget(0, 3, self)
        self.table.setHorizontalHeaderLabels([tr("What"), tr("The character"), tr("People, or aim")])
        self.table.setAccessibleName(tr("Behaviour over an hour"))
        self.table.verticalHeader().hide()
        self.table.setShowGrid(False)
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.table.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        header = self.table.horizontalHeader()
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        for column in (0, 1):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(2, QHeaderView.ResizeMode.Stretch)
        box.addWidget(self.table, 1)

    def _add_foot(self, box: QVBoxLayout) -> None:
        foot = QHBoxLayout()
        self.state = QLabel(self)
        self.state.setProperty("quiet", True)
        foot.addWidget(self.state, 1)
        close = QPushButton(tr("Close"), self)
        close.setAutoDefault(False)
        close.clicked.connect(self.close)
        foot.addWidget(close)
        box.addLayout(foot)

    def _set_temperament(self, _: int) -> None:
        name = self.temperament.currentData()
        if name != OWN:
            self.document.edit(tr("Change the temperament"), lambda p: set_temperament(p, name, DEFAULTS))

    def _edited(self, *_: object) -> None:
        found = find_temperament(self.document.project, DEFAULTS) or OWN
        self.temperament.setCurrentIndex(self.temperament.findData(found))
        self._show_dials()
        self._soon.start()

    def _count(self) -> None:
        project = self.document.project
        if project is self._counted:
            return
        self._counted = project
        self.state.setText(tr("Counting…"))

        def work(job: WindowJob) -> tuple[Project, dict[str, BehaviourCount]]:
            return project, {m: measure_behaviour(project, m) for m in ORDER if not job.cancelled}

        self.jobs.start("behaviour", work, self._done, self._failed, quick=True)

    def _done(self, found: tuple[Project, dict[str, BehaviourCount]]) -> None:
        if found[0] is self._counted:
            self.found = found[1]
            self._show()

    def _failed(self, error: Exception) -> None:
        self.state.setText(tr_error(error))

    def _show(self) -> None:
        mode = self.session.onstage.improvised
        self.modes.show_choice(ORDER.index(mode))
        found = self.found.get(mode)
        if found is None:
            return
        colors = get_theme(self.session.look.name)
        self.table.setRowCount(len(found.rows))
        for n, row in enumerate(found.rows):
            off = row.usual is False
            for column, text in enumerate((row.name, row.amount, row.compared)):
                shown = tr_phrase(text)
                if column == 2 and row.source is not None:
                    shown = f"{shown} ({tr_phrase(row.source)})"
                item = QTableWidgetItem(shown)
                if column == 2:
                    item.setToolTip(shown)
                elif off:
                    item.setToolTip(tr("Outside the range of people, or outside the aim"))
                if column == 1 and row.usual is not None:
                    item.setForeground(QColor(colors.warning if off else colors.text))
                if column == 2:
                    item.setForeground(QColor(colors.dim))
                self.table.setItem(n, column, item)
        lines = [tr_phrase(describe_lack(self.document.project, x)) for x in found.lacks[:MOST_LACKS]]
        if more := len(found.lacks) - MOST_LACKS:
            lines += [tr_plural("{count} more stance", "{count} more stances", more)] if more > 0 else []
        self.lacks.setText("\n".join(lines))
        self.lacks.setVisible(bool(lines))
        self.state.setText(tr("Counted over an hour without speech. With speech, gestures follow the words."))
