"""Use a model: move a side of a conversation, or make long takes that are cut into clips and placed on the
meta-graph.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from PySide6.QtWidgets import (
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QVBoxLayout,
    QWidget,
)

from app.features.generation.generation_jobs import (
    UNCUT,
    Speaker,
    as_sentence,
    cut_pieces,
    describe_model,
    find_first_stance,
    keep_pieces,
    make_side_motion,
    with_pieces,
    with_side_moved,
)
from app.features.generation.page import GenerationPage
from app.features.generation.pieces_table import PiecesView
from app.look.theme import strengthen
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_noop, tr_phrase, tr_plural
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox, SpinBox
from metagraph.common.studio import find_start_folder
from metagraph.errors import FileError
from metagraph.generation.chunks import GUIDANCE
from metagraph.generation.offered import list_models, name_model
from metagraph.generation.stored import SUFFIX, read_card
from metagraph.graph.conversation.model import get_side_name

FILE, CHOOSE = "file", "choose"  # a sound that was chosen, and choosing one
NOBODY = tr_noop(
    "There is no conversation yet. Drop a recording of two speakers on the window, then "
    "choose a speaker here."
)


class UsePage(GenerationPage):
    def __init__(
        self, document: Document, session: StageSession, jobs: Jobs, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self._of: tuple[str, int] = ("", 1)  # the model and the seed of the pieces
        self._extra: dict[str, Path] = {}  # models chosen as files
        self._sound: Path | None = None
        self._job: WindowJob | None = None
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 8, 0, 0)
        box.setSpacing(6)
        box.addLayout(self._model_row())
        self.about = QLabel(self, wordWrap=True)
        self.about.setProperty("dim", True)
        box.addWidget(self.about)
        for words, row in (
            (tr("A speaker of a conversation"), self._side_row()),
            (tr("Clips for the meta-graph"), self._takes_row()),
        ):
            box.addSpacing(8)
            box.addWidget(self.heading(words))
            box.addLayout(row)
        self.view = PiecesView(document, self)
        self.table = self.view.table
        self.table.itemChanged.connect(lambda _: self._enable())
        box.addWidget(self.view, 1)
        box.addLayout(self._drop_row())
        self.fill()

    # --- building

    def _model_row(self) -> QHBoxLayout:
        self.model = ComboBox(self)
        self.model.setAccessibleName(tr("Model"))
        self.model.setMinimumWidth(220)
        self.model.currentIndexChanged.connect(self._about)
        choose = self.button(
            tr("Choose file…"), tr("Use a model file from another folder"), self.choose_model
        )
        self.seed = SpinBox(self, minimum=1, maximum=9999, value=1)
        self.seed.setAccessibleName(tr("Seed"))
        self.seed.setToolTip(tr("Another seed gives another motion for the same speech"))
        self.temperature = DoubleSpinBox(self, minimum=0, maximum=1.2, singleStep=0.1, decimals=1, value=1.0)
        self.temperature.setAccessibleName(tr("Randomness"))
        self.temperature.setToolTip(
            tr("How random the motion is: 0 gives the least motion, 1 is as in the takes")
        )
        self.guidance = DoubleSpinBox(self, minimum=0, maximum=5, singleStep=0.25, decimals=2, value=GUIDANCE)
        self.guidance.setAccessibleName(tr("Follow speech"))
        self.guidance.setToolTip(
            tr("How closely the motion follows the speech; 1 is as in the takes. Not for all models.")
        )
        return self.row(
            (tr("Model"), self.model),
            ("", choose),
            (tr("Seed"), self.seed),
            (tr("Randomness"), self.temperature),
            (tr("Follow speech"), self.guidance),
        )

    def _side_row(self) -> QHBoxLayout:
        self.side = ComboBox(self)
        self.side.setAccessibleName(tr("Speaker"))
        self.side.setMinimumWidth(260)
        self.move_button = self.button(
            tr("Move with the model"),
            tr(
                "The model moves arms, head and spine for the whole conversation. Legs, eyes and lips "
                "do not change."
            ),
            self.move_side,
        )
        strengthen(self.move_button)
        self.nobody = QLabel(tr(NOBODY), self)
        self.nobody.setProperty("dim", True)
        return self.row((tr("Who"), self.side), ("", self.move_button), ("", self.nobody))

    def _takes_row(self) -> QHBoxLayout:
        self.speech = ComboBox(self)
        self.speech.setAccessibleName(tr("Whose speech drives the motion"))
        self.speech.setMinimumWidth(260)
        self.speech.activated.connect(self._speech_chosen)
        self.minutes = DoubleSpinBox(self, minimum=0.2, maximum=10, singleStep=0.5, decimals=1, value=3)
        self.minutes.setSuffix(" min")
        self.minutes.setAccessibleName(tr("Minutes"))
        self.cut_button = self.button(
            tr("Generate and cut"),
            tr("Generate motion and cut it at still moments with similar poses, so that no jump is visible"),
            self.make_pieces,
        )
        return self.row((tr("To"), self.speech), (tr("for"), self.minutes), ("", self.cut_button))

    def _drop_row(self) -> QHBoxLayout:
        self.stance = ComboBox(self)
        self.stance.setAccessibleName(tr("The stance that the pieces start and end in"))
        self.stance.setMinimumWidth(200)
        self.drop_button = self.button(
            tr("Add"), tr("Add the pieces to the library and to the arms layer of the graph"), self.drop
        )
        self.drop_button.setMinimumWidth(120)
        strengthen(self.drop_button)
        self.progress = make_widget(QProgressBar, self, maximumWidth=180, textVisible=False)
        self.cancel_button = self.button(tr("Cancel"), tr("Stop without changing anything"), self.cancel)
        row = self.row((tr("On"), self.stance), ("", self.drop_button))
        for widget in (self.progress, self.cancel_button):
            widget.hide()
            row.addWidget(widget)
        return row

    # --- what there is

    def fill(self) -> None:
        """Fill the lists of models, sides and stances."""
        self._fill_models()
        project = self.document.project
        for widget in (self.side, self.move_button):
            widget.setVisible(bool(project.conversations))
        self.nobody.setVisible(not project.conversations)
        for box in (self.side, self.speech):
            chosen = box.currentData()
            box.clear()
            for ident, talk in project.conversations.items():
                for n in range(len(talk.sides)):
                    box.addItem(f"{talk.name}: {get_side_name(talk, n)}", (ident, n))
            if box is self.speech:
                if self._sound is not None:
                    box.addItem(self._sound.name, FILE)
                box.addItem(tr("Choose a sound…"), CHOOSE)
            box.choose(chosen)
        stance = self.stance.currentData()
        self.stance.clear()
        for s in project.graphs["arms"].stances.values():
            self.stance.addItem(tr("{layer} · {name}", layer=tr("arms"), name=s.name), s.id)
        self.stance.addItem(tr("only the library"), "")
        wanted = stance if stance is not None else find_first_stance(project)
        self.stance.choose(wanted)
        self._enable()

    def _fill_models(self, wanted: Path | None = None) -> None:
        found = {**list_models(self.document.folder), **self._extra}
        now = wanted or self.model.currentData()
        self.model.blockSignals(True)
        self.model.clear()
        for name, path in found.items():
            self.model.addItem(tr_phrase(name_model(name)), path)
        self.model.choose(now)
        self.model.blockSignals(False)
        self._about()

    def show_model(self, path: Path) -> None:
        """Choose a model, such as one that was just trained."""
        if path not in list_models(self.document.folder).values():
            self._extra[path.stem] = path
        self._fill_models(path)

    def choose_model(self) -> None:
        start = str(find_start_folder(self.document.folder))
        name, _ = QFileDialog.getOpenFileName(
            self, tr("Choose a model"), start, tr("Models (*{suffix})", suffix=SUFFIX)
        )
        if name:
            self.show_model(Path(name))

    def _about(self) -> None:
        """Say what the chosen model is."""
        path = self.model.currentData()
        if path is None:
            self.about.setText(tr("There is no model yet. Train one, or choose a file."))
        else:
            try:
                self.about.setText(describe_model(read_card(path), self.document.project))
            except FileError as error:
                self.about.setText(tr_error(error))
        self._enable()

    def _speech_chosen(self) -> None:
        self._enable()
        if self.speech.currentData() == CHOOSE:
            self._choose_sound()

    def _choose_sound(self) -> None:
        from app.project.speech_files import SOUNDS

        start, kinds = str(find_start_folder(self.document.folder)), " ".join(f"*{s}" for s in SOUNDS)
        name, _ = QFileDialog.getOpenFileName(
            self, tr("Choose a sound"), start, tr("Sounds ({kinds})", kinds=kinds)
        )
        if name:
            self._sound = Path(name)
        self.fill()
        if name:
            self.speech.setCurrentIndex(self.speech.findData(FILE))

    # --- jobs

    @property
    def busy(self) -> bool:
        return self._job is not None

    def _enable(self) -> None:
        free = self._job is None and self.model.currentData() is not None
        self.move_button.setEnabled(free and self.side.count() > 0)
        self.cut_button.setEnabled(free)
        count = len(self.table.chosen())
        self.drop_button.setEnabled(self._job is None and count > 0)
        self.drop_button.setText(
            tr("Add {count}", count=tr_plural("{count:,} clip", "{count:,} clips", count))
            if count
            else tr("Add")
        )

    def _start(self, title: str, work: Callable[[WindowJob], Any], done: Callable[[Any], None]) -> None:
        self.said.emit(f"{title}…")
        job = self.jobs.start(title, work, done, self._failed)
        self._job = job
        self.progress.setRange(0, 0)
        self.progress.show()
        self.cancel_button.show()
        job.progress.connect(self._tell)
        job.ended.connect(self._ended)
        self._enable()

    def _tell(self, done: int, total: int, _: str) -> None:
        self.progress.setRange(0, total)
        self.progress.setValue(done)

    def _ended(self) -> None:
        self._job = None
        self.progress.hide()
        self.cancel_button.hide()
        self._enable()

    def _failed(self, error: Exception) -> None:
        self.said.emit(as_sentence(error))

    def cancel(self) -> None:
        if self._job is not None:
            self._job.cancel()
            self.said.emit(tr("Cancelled. Nothing was changed."))

    def _folder(self) -> Path | None:
        if self.document.folder is None:
            self._failed(ValueError(tr("save the project first: new clips are saved as files beside it")))
        return self.document.folder

    def _chance(self) -> Any:
        from metagraph.generation.performing import Chance

        return Chance(self.seed.value(), self.temperature.value(), self.guidance.value())

    # --- a side

    def move_side(self) -> None:
        """Move the chosen side with the model."""
        path, chosen, folder = self.model.currentData(), self.side.currentData(), self._folder()
        if path is None or chosen is None or folder is None:
            return
        project, chance, named = self.document.project, self._chance(), self.model.currentText()
        ident, side = chosen
        talk = project.conversations[ident]
        if talk.sides[side].project is not None:
            who = get_side_name(talk, side)
            self._failed(
                ValueError(
                    tr(
                        "{who} is moved by another project: first clear 'Moved by' in Sounds and names",
                        who=who,
                    )
                )
            )
            return

        def work(job: WindowJob) -> Any:
            from metagraph.generation.stored import read_model

            speaker = Speaker(project, ident, side, folder)
            return make_side_motion(read_model(path), named, speaker, chance, job.tell, lambda: job.cancelled)

        def done(made: Any) -> None:
            loaded, notes = made
            if ident not in self.document.project.conversations:
                self._failed(
                    ValueError(tr("the conversation no longer exists; the clip is still in its folder"))
                )
                return
            self.document.edit(
                tr("Move with a model"),
                lambda p: with_side_moved(p, loaded, named, chance.seed, ident, side),
            )
            self.session.onstage.set_conversation(ident)
            self.session.onstage.set_side(side)
            self.session.transport.show_plan()
            self.session.transport.seek(0.0)
            self.session.transport.set_playing(True)
            told = " ".join(notes)
            self.said.emit(
                tr(
                    "{who} moves with '{named}', seed {seed}. {told}",
                    who=get_side_name(talk, side),
                    named=named,
                    seed=chance.seed,
                    told=told,
                ).rstrip()
            )

        self._start(tr("Generating motion"), work, done)

    # --- clips

    def make_pieces(self) -> None:
        """Make long takes and cut them. Ask for a sound first if none is chosen."""
        if self.speech.currentData() == CHOOSE:
            self._choose_sound()
        path, speech = self.model.currentData(), self.speech.currentData()
        if path is None or speech == CHOOSE:
            return
        project, chance, named = self.document.project, self._chance(), self.model.currentText()
        seconds, folder, sound = 60 * self.minutes.value(), self.document.folder or Path(), self._sound

        def work(job: WindowJob) -> Any:
            from metagraph.generation.performing import generate_long_takes, hear_file, hear_side
            from metagraph.generation.stored import read_model

            if speech == FILE and sound is not None:
                heard = hear_file(sound)
            else:
                heard = hear_side(project, speech[0], speech[1], folder)
            made, told = generate_long_takes(
                read_model(path),
                project,
                heard,
                seconds,
                chance,
                f"{named} {chance.seed}",
                job.tell,
                lambda: job.cancelled,
            )
            return cut_pieces(made, project, job.tell, lambda: job.cancelled), (*heard.notes, *told)

        def done(made: Any) -> None:
            (found, why), notes = made
            self._of = (named, chance.seed)
            self.table.show_pieces(found)
            told = " ".join(notes)
            if not found:
                self.said.emit(
                    tr(
                        "Nothing can be cut: {why}. {remedy} {told}", why=why, remedy=tr(UNCUT), told=told
                    ).rstrip()
                )
                return
            self.said.emit(
                tr(
                    "{pieces}, not saved yet. Add the ones that you like. {told}",
                    pieces=tr_plural("{count:,} piece", "{count:,} pieces", len(found)),
                    told=told,
                ).rstrip()
            )

        self._start(tr("Generating motion to cut"), work, done)

    def drop(self) -> None:
        """Save the checked pieces as files and place them on the graph, in one undo step."""
        chosen, folder, (named, seed) = self.table.chosen(), self._folder(), self._of
        if not chosen or folder is None:
            return
        project, stance = self.document.project, self.stance.currentData() or None

        def done(loaded: Any) -> None:
            where = stance if stance in self.document.project.graphs["arms"].stances else None
            self.document.edit(
                tr("Add generated clips"), lambda p: with_pieces(p, chosen, loaded, named, seed, where)
            )
            new = {path for path, *_ in loaded}
            ids = tuple(e.id for e in self.document.project.clips.values() if e.path in new)
            self.session.selection.select_clips(ids)
            self.table.show_pieces([p for p in self.table.pieces if p not in chosen])
            place = tr("added to the arms layer") if where else tr("added to the library")
            self.said.emit(
                tr(
                    "{clips} {place}. They record that '{named}' made them.",
                    clips=tr_plural("{count:,} clip", "{count:,} clips", len(ids)),
                    place=place,
                    named=named,
                )
            )

        self._start(tr("Keeping clips"), lambda _: keep_pieces(chosen, project, folder), done)

    def close_down(self) -> None:
        self.view.preview.still()
        if self._job is not None:
            self._job.cancel()
