"""The manual editor in the middle of the window: the canvas, with buttons for triggers, layout and display
above it.
"""

from __future__ import annotations

from PySide6.QtCore import QSizeF
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QToolButton, QVBoxLayout, QWidget

from app.features.manual import manual_commands as commands
from app.features.manual import manual_many
from app.features.manual.manual_canvas import ManualCanvas
from app.features.manual.manual_inspector import Inspector
from app.translation import tr, tr_noop, tr_phrase, tr_plural
from app.widgets.form_fields import QuietChooser
from app.widgets.making import make_widget
from metagraph.graph.model import Project
from metagraph.graph.name_search import matches_search
from metagraph.graph.problem import Problem

FIND = tr_noop("Select the states whose names contain these words (/): sit wave, sit -wave, sit | stand")


class ManualEditor(QWidget):
    """canvas and inspector; `show_problems` marks what is wrong."""

    def __init__(self, canvas: ManualCanvas, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.canvas, self.session = canvas, canvas.session
        self.inspector = Inspector(canvas, canvas.performance)
        self.words = QLabel(self)
        self.words.setProperty("dim", True)
        self.search = make_widget(QLineEdit, self, toolTip=tr(FIND))
        self.search.setPlaceholderText(tr("Find states"))
        self.search.setAccessibleName(tr("Find states"))
        self.search.setClearButtonEnabled(True)
        self.search.setMinimumWidth(90)
        self.search.textEdited.connect(self._find)
        self.search.returnPressed.connect(self._found)
        self.table = _button(
            self,
            tr("Import table…"),
            tr("Draw links from a spreadsheet: from, to, when, trigger, weight, exit, blend"),
        )
        self.table.clicked.connect(self._choose_table)
        self.trigger = QuietChooser(self, toolTip=tr("Choose a trigger of this layer's links"))
        self.trigger.setMinimumWidth(110)
        self.fire = _button(
            self,
            tr("Fire"),
            tr("Fire the trigger now. The machine takes the shortest path of links to get there."),
        )
        self.fire.clicked.connect(self._fire)
        self.arrange = _button(
            self, tr("Arrange"), tr("Arrange the nodes in columns, beginning with the start state")
        )
        self.arrange.clicked.connect(lambda: commands.arrange_canvas(canvas))
        self.fit = _button(self, tr("Show all"), tr("Frame the selection, or all nodes (F)"))
        self.fit.clicked.connect(canvas.fit)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        above, below = self._row(6, 0), self._row(2, 6)
        above.addWidget(self.words, 1)
        above.addWidget(self.arrange)
        above.addWidget(self.fit)
        below.addWidget(self.search, 1)
        for part in (self.table, self.trigger, self.fire):
            below.addWidget(part)
        layout.addLayout(above)
        layout.addLayout(below)
        layout.addWidget(canvas, 1)
        canvas.document.changed.connect(self._edited)
        canvas.viewed.connect(self.show_words)
        canvas.find_wanted.connect(self._begin_finding)
        self.session.place.layer_changed.connect(self.show_words)
        self.show_words()

    @staticmethod
    def _row(top: int, bottom: int) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setContentsMargins(12, top, 12, bottom)
        row.setSpacing(8)
        return row

    def _edited(self, before: Project, after: Project) -> None:
        if before.manual is not after.manual:
            self.show_words()

    def show_words(self) -> None:
        """Show how large the layer's machine is, and its triggers."""
        manual = self.canvas.scene().manual
        zoom = f"{self.canvas.view.scale * 100:.0f} %"
        self.words.setText(
            tr(
                "{states}, {links} for {ways}    {zoom}",
                states=tr_plural("{count:,} state", "{count:,} states", len(manual.states)),
                links=tr_plural("{count:,} link", "{count:,} links", len(manual.links)),
                ways=tr_plural("{count:,} connection", "{count:,} connections", len(manual.ways)),
                zoom=zoom,
            )
        )
        chosen = self.trigger.currentData()
        first = chosen if chosen in manual.triggers else next(iter(manual.triggers), None)
        self.trigger.show_entries([(t, t) for t in manual.triggers], first, tr("no trigger yet"))
        for part in (self.trigger, self.fire):
            part.setEnabled(bool(manual.triggers))
        self.arrange.setEnabled(bool(manual.states))
        self.table.setEnabled(bool(manual.states))
        self.search.setEnabled(bool(manual.states))

    def _find(self, text: str) -> None:
        """Select the states whose names fit, or where none does the aliases."""
        manual = self.canvas.scene().manual
        states = tuple(i for i, s in manual.states.items() if matches_search(text, s.name))
        aliases = tuple(i for i, a in manual.aliases.items() if matches_search(text, a.name))
        self.session.selection.select_states(states or aliases)

    def _begin_finding(self) -> None:
        self.search.setFocus()
        self.search.selectAll()

    def _found(self) -> None:
        """Give the keys back to the canvas, and show what was found where it is not in sight."""
        nodes, chosen = self.canvas.scene().nodes, self.session.selection.states
        seen = self.canvas.view.rect(QSizeF(self.canvas.size()))
        if chosen:
            if not all(seen.contains(nodes[i]) for i in chosen if i in nodes):
                self.canvas.fit()
            self.canvas.setFocus()

    def _choose_table(self) -> None:
        folder = self.canvas.document.folder
        manual_many.choose_table(self.canvas, self, str(folder or ""))

    def _fire(self) -> None:
        trigger = self.trigger.currentData()
        if trigger:
            self.canvas.performance.fire(trigger)

    def show_problems(self, problems: tuple[Problem, ...]) -> None:
        """Mark the states and links that have problems."""
        troubles: dict[str, str] = {}
        for p in problems:
            ident = p.state or p.link
            if ident and p.severity != "hint":
                message = tr_phrase(p.message)
                troubles.setdefault(ident, f"{message[:1].upper()}{message[1:]}. {tr_phrase(p.remedy)}")
        self.canvas.set_troubles(troubles)
        self.inspector.show_selection()


def _button(parent: QWidget, text: str, tip: str) -> QToolButton:
    out = make_widget(QToolButton, parent, text=text, toolTip=tip)
    out.setStyleSheet("QToolButton { padding: 5px 12px; }")
    return out
