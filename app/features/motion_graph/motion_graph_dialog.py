"""The motion graph's window: choose takes, see what counts as a jump, let new motion be found, cut long takes
into clips.
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QProgressBar,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.features.motion_graph.cooccurrence_rates import CooccurrenceDialog
from app.features.motion_graph.cost_plot import CostPlot
from app.features.motion_graph.search_options import Wishes
from app.features.motion_graph.synthesis_jobs import (
    FOLDER,
    LEAST,
    MOST,
    ChosenTakes,
    FoundMotion,
    choose_takes,
    count_graph_states,
    synthesise,
)
from app.features.motion_graph.takes_list import TakesList
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.project.new_clips import cut_into_pieces, save
from app.shell.extras_dialog import ExtrasOffer
from app.stage.session import StageSession
from app.translation import group_thousands, tr, tr_error, tr_noop, tr_plural
from app.widgets.making import make_widget
from app.widgets.quiet_fields import DoubleSpinBox, SpinBox
from app.widgets.within_screen import resize_within_screen
from metagraph.common.compiling import is_numba_installed
from metagraph.graph import edits
from metagraph.graph.conversation.edits import change_side
from metagraph.graph.model import Project

KS = (2, 3, 4)  # of the table
LONG = 4000  # ms after which a wait is explained
WAIT = tr_noop(
    "Working… The first time after installing, the search is compiled for this machine: up to a minute."
)
LOADING = tr_noop(
    "Working… New motion needs a compiler, which is being downloaded (60 MB, once); then the "
    "search is compiled for this machine. That takes a minute or two."
)


def describe_fits(limit: Any) -> str:
    """Return what distributions say a transition may cost, the nearest first, and how far off each is."""
    from metagraph.suggest.jumps.fits import fit_distributions

    found = fit_distributions(limit.costs, limit.level)
    rows = "\n".join(
        tr(
            "{name}: {limit:.3g} m, off by {share:.1f} % at most",
            name=f.name,
            limit=f.limit,
            share=100 * f.distance,
        )
        for f in found
    )
    return (
        tr("The limits that other distributions of these costs give, nearest first:\n{rows}", rows=rows)
        if found
        else ""
    )


class MotionGraphDialog(QDialog):
    """Stays open beside the window."""

    def __init__(
        self, document: Document, session: StageSession, jobs: Jobs, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Motion graph"))
        resize_within_screen(self, 1080, 720)
        self.states: Any = None  # synthesis.states.States of the chosen takes
        self.limit: Any = None  # synthesis.graph.Threshold
        self.graph: Any = None  # synthesis.graph.MotionGraph, None until it is built for what is chosen now
        self.takes = ChosenTakes((), (), ())
        self._job: WindowJob | None = None
        self._for: tuple[str, int] | None = None  # the side that is to move with what is found
        self._counted: Any = None  # the takes and the level that the table is of
        self._long = QTimer(self, singleShot=True, interval=LONG)
        self._long.timeout.connect(self._explain)
        self._soon = QTimer(self, singleShot=True, interval=200)
        self._soon.timeout.connect(self._compare)
        self.picked = TakesList(document, self)
        self.picked.changed.connect(self._changed)
        self.picked.cut_wanted.connect(self.cut)
        self.picked.rates_wanted.connect(self.count_rates)
        self._build_right()
        self.wishes = Wishes(document, self)
        self.wishes.wanted.connect(self.find_motion)
        box = QVBoxLayout(self)
        box.setContentsMargins(14, 12, 14, 12)
        box.setSpacing(10)
        columns = QHBoxLayout()
        columns.setSpacing(18)
        columns.addWidget(self.picked, 4)
        columns.addLayout(self.right, 5)
        box.addLayout(columns, 1)
        box.addWidget(self.wishes)
        box.addLayout(self._foot())
        document.loaded.connect(self._leave)
        document.changed.connect(self._follow)
        self.picked.fill()

    # --- building

    def _heading(self, words: str) -> QLabel:
        out = QLabel(words, self)
        out.setProperty("heading", True)
        return out

    def _build_right(self) -> None:
        self.right = QVBoxLayout()
        self.right.setSpacing(6)
        self.right.addWidget(self._heading(tr("Jump limit")))
        row = QHBoxLayout()
        self.k = SpinBox(self, minimum=2, maximum=10, value=3)
        self.k.setToolTip(
            tr(
                "The jump limit comes from the difference between frames this far apart. A larger "
                "number gives more transitions, but rougher ones."
            )
        )
        self.k.setAccessibleName(tr("Frame distance"))
        self.level = DoubleSpinBox(self, minimum=50, maximum=99.9, value=95, suffix=" %", decimals=1)
        self.level.setToolTip(tr("Transitions can cost as much as this share of those differences"))
        self.level.setAccessibleName(tr("Level"))
        for words, field in ((tr("Frame distance (k)"), self.k), (tr("Level"), self.level)):
            row.addWidget(QLabel(words, self))
            row.addWidget(field)
            row.addSpacing(10)
            field.valueChanged.connect(self._changed)
        row.addStretch(1)
        self.right.addLayout(row)
        self.plot = CostPlot(self.session, self)
        self.right.addWidget(self.plot, 1)
        self.words = QLabel(self, wordWrap=True)
        self.words.setProperty("dim", True)
        self.right.addWidget(self.words)
        self.table = QTableWidget(len(KS), 5, self)
        self.table.setTabKeyNavigation(False)  # Tab leaves it, arrows go about in it
        self.table.setHorizontalHeaderLabels(
            ["k", tr("Frames"), tr("Transitions"), tr("Frames kept"), tr("Trans. kept")]
        )
        self.table.horizontalHeader().setDefaultAlignment(
            Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        )
        self.table.setAccessibleName(tr("Frames and transitions for each k"))
        self.table.verticalHeader().hide()
        self.table.setShowGrid(False)
        self.table.setSelectionMode(QTableWidget.SelectionMode.NoSelection)
        self.table.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.table.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.table.horizontalHeader().setHighlightSections(False)
        self.table.setFixedHeight(
            self.table.horizontalHeader().sizeHint().height() + len(KS) * self.table.rowHeight(0) + 4
        )
        self.right.addWidget(self.table)
        self.count_button = QPushButton(tr("Compare k = 2, 3, 4"), self, autoDefault=False)
        self.count_button.setToolTip(
            tr("Metagraph keeps the largest part in which every frame can be reached from every other frame")
        )
        self.count_button.clicked.connect(self.count)
        self.right.addWidget(self.count_button, 0, Qt.AlignmentFlag.AlignLeft)
        self._show_table({})

    def _foot(self) -> QHBoxLayout:
        row = QHBoxLayout()
        self.said = QLabel(self, wordWrap=True)
        self.said.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.progress = make_widget(QProgressBar, self, maximumWidth=180, textVisible=False)
        self.progress.hide()
        self.stop = QPushButton(tr("Cancel"), self, autoDefault=False)
        self.stop.clicked.connect(self.cancel)
        self.stop.hide()
        close = QPushButton(tr("Close"), self, autoDefault=False)
        close.clicked.connect(self.close)
        self.extras = ExtrasOffer(self.jobs, self)
        row.addWidget(self.said, 1)
        for widget in (self.extras, self.progress, self.stop, close):
            row.addWidget(widget)
        return row

    @property
    def busy(self) -> bool:
        """Whether something is worked out, or is about to be."""
        return self._job is not None or self._soon.isActive()

    def _leave(self) -> None:
        """Another project comes: what is being made for the one before is not for it."""
        if self._job is not None:
            self._job.cancel()
        self.states = self.graph = None
        self.said.setText("")

    def _follow(self, before: Project, after: Project) -> None:
        if (
            before.clips is not after.clips
            or before.conversations is not after.conversations
            or before.skeleton is not after.skeleton
        ):
            self.picked.fill()
            self.wishes.fill()

    # --- what counts as a jump

    def _changed(self) -> None:
        """Something was chosen: compare frames again, soon."""
        self.graph = None
        self.takes = choose_takes(self.document.project, self.picked.chosen())
        if self._counted != (self.takes.clips, self.level.value()):
            self._show_table({})
        seconds = sum(clip.duration for clip in self.takes.clips)
        self.picked.title.setText(
            tr("Takes · {count} chosen, {minutes:.1f} min", count=len(self.takes.ids), minutes=seconds / 60)
            if self.takes.ids
            else tr("Takes")
        )
        self._soon.start()

    def _compare(self) -> None:
        takes, k, level = self.takes, self.k.value(), self.level.value() / 100
        known = self.states if self.states is not None and self.states[0] == takes.clips else None
        if not takes.ids:
            self._show_limit(None)
            return

        def work(_: WindowJob) -> Any:
            from metagraph.synthesis.graph import find_threshold
            from metagraph.synthesis.states import read_states

            states = known[1] if known is not None else read_states(takes.clips)
            return takes.clips, states, find_threshold(states, k, level)

        self.jobs.start(tr("Comparing frames"), work, self._compared, self._incomparable, quick=True)

    def _incomparable(self, error: Exception) -> None:
        """What takes before could do is not what these can."""
        self.states = None
        self._show_limit(None)
        self._failed(error)

    def _compared(self, made: Any) -> None:
        clips, states, limit = made
        if clips != self.takes.clips:
            return
        self.states = (clips, states)
        self._show_limit(limit)

    def _show_limit(self, limit: Any) -> None:
        self.limit = limit
        self.plot.show_threshold(limit)
        if limit is None:
            none = not self.picked.list.rowCount()
            self.words.setText(
                tr(
                    "There are no clips yet. Import long recordings. Transitions are made between similar "
                    "frames."
                )
                if none
                else tr(
                    "Choose takes, which are long recordings. Transitions are made between similar frames."
                )
            )
            return
        off = abs(limit.limit - limit.observed) / max(limit.observed, 1e-9)
        beside = tr(" ({off:.0f} % off)", off=100 * off) if off > 0.05 else ""
        self.words.setToolTip(describe_fits(limit))
        self.words.setText(
            tr(
                "A transition may cost {limit:.3g} m, summed over the joints. Dotted line: the limit without "
                "a fitted distribution, {observed:.3g} m{beside}."
                if limit.distribution is None
                else "A transition may cost {limit:.3g} m, summed over the joints (Johnson's S_B, fitted). "
                "Dotted line: the limit without a fitted distribution, {observed:.3g} m{beside}.",
                limit=limit.limit,
                observed=limit.observed,
                beside=beside,
            )
        )

    # --- jobs

    def _start(self, title: str, work: Any, done: Any) -> None:
        if self._job is not None:
            return
        self.said.setText("")
        self.extras.follow("")
        self._long.start()
        job = self.jobs.start(title, work, done, self._failed)
        self._job = job
        self.progress.setRange(0, 0)
        self.progress.show()
        self.stop.show()
        self._enable()
        job.progress.connect(self._tell)
        job.ended.connect(self._ended)

    def _tell(self, done: int, total: int, _: str) -> None:
        self.progress.setRange(0, total)
        self.progress.setValue(done)

    def _explain(self) -> None:
        """Say why it takes so long, if it does."""
        if self._job is not None and not self.said.text():
            self.said.setText(tr(WAIT) if is_numba_installed() else tr(LOADING))

    def _ended(self) -> None:
        self._job = None
        self._long.stop()
        if self.said.text() in (tr(WAIT), tr(LOADING)):
            self.said.setText("")
        self.progress.hide()
        self.stop.hide()
        self._enable()

    def _enable(self) -> None:
        free = self._job is None
        for button in (self.count_button, self.picked.cut_button, self.picked.rates_button, self.wishes.go):
            button.setEnabled(free)

    def cancel(self) -> None:
        if self._job is not None:
            self._job.cancel()
            self.said.setText(tr("Cancelled. Nothing was changed."))

    def _failed(self, error: Exception) -> None:
        self.extras.follow(error)
        text = tr_error(error)
        self.said.setText(f"{text[:1].upper()}{text[1:].rstrip('.')}.")

    def count(self) -> None:
        """Fill the table: how much is kept for each k."""
        takes, level = self.takes, self.level.value() / 100
        if not takes.ids:
            self._failed(ValueError(tr("choose takes first")))
            return
        self._counted = (takes.clips, self.level.value())
        self._start(
            tr("Motion graphs"),
            lambda job: count_graph_states(takes, KS, level, job.tell, lambda: job.cancelled),
            self._show_table,
        )

    def _show_table(self, rows: Any) -> None:
        for row, k in enumerate(KS):
            found = rows.get(k)
            texts = [str(k), *(("–",) * 4 if found is None else map(group_thousands, found))]
            if found is not None and found[0]:
                texts[3] += f"  ({100 * found[2] / found[0]:.0f} %)"
            for column, text in enumerate(texts):
                item = QTableWidgetItem(text)
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                self.table.setItem(row, column, item)

    def count_rates(self) -> None:
        """Count how often people moved when something was said, over the chosen takes that know it."""
        takes = self.takes
        if not takes.told:
            self._failed(
                ValueError(tr("choose takes, and choose beside each one which speaker was heard during it"))
            )
            return

        def work(_: WindowJob) -> Any:
            from metagraph.synthesis.cooccurrence import count_cooccurrence as counted

            told = [n for n, speech in enumerate(takes.speech) if speech]
            return counted([takes.clips[n] for n in told], [takes.speech[n] for n in told])

        self._start(tr("Counting movements"), work, self._show_rates)

    def _show_rates(self, rows: Any) -> None:
        CooccurrenceDialog(self.document, rows, self).open()

    # --- new motion

    def find_motion(self) -> None:
        """Find new motion as wished, and add it to the library."""
        takes, graph, limit = self.takes, self.graph, self.limit
        try:
            wish = self.wishes.wish()
        except ValueError as error:  # a word that is none
            self._failed(error)
            return
        if not takes.ids or limit is None or self.states is None or self.states[0] != takes.clips:
            why = (
                tr("these takes cannot be compared: choose other takes")
                if takes.ids
                else tr("choose takes first")
            )
            self._failed(
                ValueError(tr("{why}; Metagraph must compare their frames before it can search", why=why))
            )
            return
        folder = self._folder()
        if folder is None:
            return
        self._for = self.wishes.moves
        states, name, taken = (
            self.states[1],
            self.wishes.name(),
            {e.name for e in self.document.project.clips.values()},
        )

        def work(job: WindowJob) -> Any:
            from metagraph.synthesis.constraints import find_change_states
            from metagraph.synthesis.graph import build_graph
            from metagraph.synthesis.states import key_states

            made = graph
            if made is None:
                keys = key_states(states, changes=find_change_states(states, takes.speech))
                made = build_graph(states, limit, keys, progress=job.tell, cancelled=lambda: job.cancelled)
            found = synthesise(made, takes, wish, name, lambda: job.cancelled, folder)
            return made, found, () if job.cancelled else save([found.clip], folder, FOLDER, taken)

        self._start(tr("New motion"), work, self._found)

    def _found(self, made: Any) -> None:
        self.graph, found, loaded = made[0], made[1], made[2]
        graph, takes_told = self.graph, self.takes.told
        assert isinstance(found, FoundMotion)
        self._keep(loaded, tr("Add new motion"), self._for)
        self.graph = graph  # the takes are the same
        deaf = (
            ""
            if takes_told or not self.wishes.talks
            else tr(" The speech during the takes is not known, so it could not guide the search.")
        )
        self.said.setText(found.words() + deaf)

    def _keep(self, loaded: Any, words: str, side: tuple[str, int] | None = None) -> None:
        """Add kept clips to the library, choose them and play the first; or let it move a side of a
        conversation, and play that.
        """
        paths = {path for path, *_ in loaded}

        def edit(project: Project) -> Project:
            project = edits.add_clips(project, loaded)
            made = next((e.id for e in project.clips.values() if e.path in paths), None)
            return project if side is None or made is None else change_side(project, *side, motion=made)

        self.document.edit(words, edit)
        new = [e.id for e in self.document.project.clips.values() if e.path in paths]
        if new and side is not None:
            self.session.onstage.set_conversation(side[0])
            self.session.onstage.set_side(side[1])
            self.session.transport.show_plan()
            self.session.transport.seek(0.0)
            self.session.transport.set_playing(True)
        elif new:
            self.session.selection.select_clips(tuple(new))
            self.session.transport.show_clip(new[0])
            self.session.transport.set_playing(True)

    def _folder(self) -> Any:
        folder = self.document.folder
        if folder is None:
            self._failed(ValueError(tr("save the project first: new clips are saved as files beside it")))
        return folder

    # --- clips from takes

    def cut(self) -> None:
        """Cut the selected takes, or all that are chosen, into clips that wait to be labelled."""
        ids = self.picked.selected()
        project, k, level = self.document.project, self.k.value(), self.level.value() / 100
        clips = choose_takes(project, ids).clips
        if not clips:
            self._failed(ValueError(tr("choose takes first")))
            return
        folder = self._folder()
        if folder is None:
            return
        taken = {e.name for e in project.clips.values()}

        def work(job: WindowJob) -> Any:
            from metagraph.synthesis.cut import find_candidates
            from metagraph.synthesis.graph import find_threshold
            from metagraph.synthesis.states import read_states

            limit = find_threshold(read_states(clips), k, level).limit
            cuts = []
            for n, clip in enumerate(clips):
                job.tell(n, len(clips))
                cuts += cut_into_pieces(
                    clip, [(start, end) for start, end, _ in find_candidates(clip, limit, LEAST, MOST)]
                )
            return save(cuts, folder, FOLDER, taken) if cuts and not job.cancelled else ()

        self._start(tr("Cutting takes"), work, self._cut)

    def _cut(self, loaded: Any) -> None:
        if not loaded:
            self.said.setText(
                tr(
                    "These takes have no still moments in a pose that they return to. Raise k or the "
                    "level, or cut them by hand."
                )
            )
            return
        self._keep(loaded, tr("Cut takes into clips"))
        self.said.setText(
            tr(
                "{clips} in the library, not labelled yet: Graph > Label clips… proposes a label for each.",
                clips=tr_plural("{count:,} clip", "{count:,} clips", len(loaded)),
            )
        )
