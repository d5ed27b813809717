"""The window of generated motion: takes are listed, a training is followed, a model moves a conversation's side
and makes clips for the graph, with real events.
"""

from __future__ import annotations

import contextlib
import os
import shutil
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
import soundfile
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog

from app.features.generation import learn_page
from app.features.generation.generation_dialog import GenerationDialog
from app.features.generation.generation_jobs import FOLDER
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.store import open_project, save_project
from metagraph.generation import offered
from metagraph.generation.features import RATE
from metagraph.generation.standing import hold
from metagraph.generation.stored import read_card, write_model
from metagraph.generation.train_plan import find_training_folder
from metagraph.graph.generated import describe_origin
from tests.generation.makers import babble, conversation, moving, untrained

ROOT = Path(__file__).parents[4]
SHOTS = os.environ.get("SHOTS")  # a folder where pictures of the window are kept to be looked at


@pytest.fixture(scope="module")
def model(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("model") / "tiny.mgmodel"
    write_model(untrained("flow-vae"), path)
    return path


@pytest.fixture
def shown(drive, sample, tmp_path, model, monkeypatch):
    """The dialog on a saved project with two stances, a conversation of 20 s, and a model beside it."""
    whole = make_paths_absolute(sample, ROOT / "sample_clips")
    talk = conversation(20.0)
    sides = tuple(
        msgspec.structs.replace(s, name=("Ada", "Ben")[n], audio="talk.wav", channel=n)
        for n, s in enumerate(talk.sides)
    )
    sound = np.stack([babble(20.0, 1), babble(20.0, 2)], 1).astype(np.float32)
    soundfile.write(tmp_path / "talk.wav", sound, RATE)
    project = replace(whole, conversations={"v9000": msgspec.structs.replace(talk, sides=sides)})
    save_project(project, tmp_path / "copy.metagraph.yaml")
    (tmp_path / "models").mkdir()
    shutil.copy(model, tmp_path / "models" / "tiny.mgmodel")
    monkeypatch.setattr(offered, "SHIPPED", tmp_path / "none.mgmodel")
    drive.files.open(tmp_path / "copy.metagraph.yaml")
    drive.wait(lambda: drive.document.folder == tmp_path and drive.document.project.skeleton is not None)
    drive.do("generate_motion")
    dialog = drive.window.findChild(GenerationDialog)
    yield drive, dialog
    with contextlib.suppress(RuntimeError):  # a test may have closed it
        dialog.close()


def press(button) -> None:
    QTest.mouseClick(button, Qt.MouseButton.LeftButton, pos=button.rect().center())


def shot(dialog, name: str) -> None:
    if SHOTS:
        QTest.qWait(100)
        dialog.grab().save(f"{SHOTS}/{name}.png")


def takes(folder: Path) -> Path:
    """A folder with two takes that can be learned from, one without sound, one of silence."""
    folder.mkdir()
    for n, seconds in enumerate((9.0, 8.0, 8.0, 8.0), 1):
        write_glb(folder / f"talk{n}.glb", [moving(seconds, n)])
        if n < 4:
            voice = np.stack([babble(seconds, n), babble(seconds, n + 10)], 1) * (n < 3)
            soundfile.write(folder / f"talk{n}.wav", voice, RATE)
    return folder


@pytest.mark.nightly
def test_a_model_moves_a_side_of_a_conversation_and_one_undo_takes_it_back(shown, tmp_path):
    drive, dialog = shown
    assert dialog.use.model.currentText() == "tiny" and "this project's skeleton" in dialog.use.about.text()
    assert dialog.use.side.currentText() == "talk: Ada" == dialog.use.speech.currentText()
    shot(dialog, "use")
    dialog.use.seed.setValue(7)
    press(dialog.use.move_button)
    drive.wait(lambda: drive.document.project.conversations["v9000"].sides[0].motion is not None, 60)
    made = drive.document.project.clips[drive.document.project.conversations["v9000"].sides[0].motion]
    assert (made.made_by, made.made_seed) == ("tiny", 7) and "seed 7" in describe_origin(made)
    assert (tmp_path / made.path).parent.name == FOLDER and made.duration == pytest.approx(20.0, abs=0.05)
    drive.wait(lambda: drive.performance.shown.motion == made.id, 60)
    pose = drive.performance.shown.pose(3.0)
    assert np.isfinite(pose.rotations).all()
    save_project(drive.document.project, tmp_path / "copy.metagraph.yaml")
    again = open_project(tmp_path / "copy.metagraph.yaml").project
    assert again.clips[made.id].made_by == "tiny" and again.clips[made.id].motion is not None
    drive.document.undo_stack.undo()
    assert made.id not in drive.document.project.clips
    assert drive.document.project.conversations["v9000"].sides[0].motion is None


@pytest.mark.nightly
def test_takes_are_made_cut_and_dropped_on_the_graph_in_one_step(shown, tmp_path):
    drive, dialog = shown
    use = dialog.use
    use.minutes.setValue(0.6)
    use.temperature.setValue(1.2)
    press(use.cut_button)
    drive.wait(lambda: not use.busy, 120)
    if not use.table.pieces:  # a model that learned nothing need not come back to anything
        from app.features.generation.generation_jobs import GeneratedPiece
        from metagraph.generation.performing import as_project_clip

        clip, _ = as_project_clip(drive.document.project, moving(2.0))
        assert "Nothing can be cut" in dialog.said.text()
        made = [GeneratedPiece(clip.renamed(f"tiny 1_{n:02d}"), "gesture", "both", 0.7) for n in (1, 2, 3)]
        use._of = ("tiny", 1)
        use.table.show_pieces(made)
    count = use.table.rowCount()
    shot(dialog, "pieces")
    cell = use.table.visualItemRect(use.table.item(0, 0))
    QTest.mouseClick(
        use.table.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(cell.left() + 14, cell.center().y())
    )
    assert len(use.table.chosen()) == count - 1
    stance = use.stance.currentData()
    assert stance in drive.document.project.graphs["arms"].stances
    before = drive.document.project
    press(use.drop_button)
    drive.wait(lambda: len(drive.document.project.clips) == len(before.clips) + count - 1, 60)
    project = drive.document.project
    new = [e for e in project.clips.values() if e.id not in before.clips]
    assert all(e.made_by == "tiny" and (tmp_path / e.path).is_file() for e in new)
    placed = [a for e in new for a in project.uses[e.id]]
    assert len(placed) == count - 1
    assert {(a.layer, a.stance) for a in placed} == {("arms", stance)}
    assert use.table.rowCount() == 1
    drive.document.undo_stack.undo()
    assert drive.document.project.clips.keys() == before.clips.keys()
    assert list(drive.document.project.actions()) == list(before.actions())


@pytest.mark.nightly
def test_a_sound_that_is_missing_is_told_and_nothing_changes(shown, tmp_path):
    drive, dialog = shown
    (tmp_path / "talk.wav").unlink()
    before = drive.document.project
    press(dialog.use.move_button)
    drive.wait(lambda: "talk.wav" in dialog.said.text(), 60)
    assert drive.document.project is before and dialog.use.move_button.isEnabled()


@pytest.mark.nightly
def test_a_damaged_model_is_told_where_it_is_chosen(shown, tmp_path):
    _, dialog = shown
    (tmp_path / "models" / "broken.mgmodel").write_bytes(b"no model")
    dialog.use.show_model(tmp_path / "models" / "broken.mgmodel")
    assert dialog.use.model.currentText() == "broken" and "broken.mgmodel" in dialog.use.about.text()


@pytest.mark.nightly
def test_the_programs_own_model_is_offered_where_it_is_installed(shown, model, tmp_path, monkeypatch):
    _, dialog = shown
    names = lambda: [dialog.use.model.itemText(n) for n in range(dialog.use.model.count())]  # noqa: E731
    assert names() == ["tiny"]
    monkeypatch.setattr(offered, "SHIPPED", model)
    dialog.use.fill()
    assert names() == ["Metagraph's own", "tiny"] and dialog.use.model.currentText() == "tiny"
    dialog.use.show_model(model)
    dialog.use.show_model(tmp_path / "models" / "tiny.mgmodel")
    assert dialog.use.model.currentText() == "tiny", "what was just trained is chosen"


@pytest.mark.nightly
def test_takes_are_listed_with_what_is_wrong_with_them_in_words(shown, tmp_path):
    drive, dialog = shown
    dialog.tabs.setCurrentWidget(dialog.learn)
    learn = dialog.learn
    learn.look_through([takes(tmp_path / "takes"), tmp_path / "gone"])
    drive.wait(lambda: not learn.busy and learn.table.rowCount() > 0, 60)
    rows = [[learn.table.item(r, c).text() for c in range(4)] for r in range(learn.table.rowCount())]
    bad = [r for r in rows if r[1] == "skipped"]
    assert len(bad) == 3 and {"gone", "talk4.glb", "talk3"} == {r[0] for r in bad}, bad
    assert any("no sound beside it" in r[3] for r in bad) and any("silent" in r[3] for r in bad)
    good = [r for r in rows if r not in bad]
    assert [r[0] for r in good] == ["talk1", "talk2"] and good[0][1:3] == ["9 s", "by loudness"]
    assert "3 clips skipped" in dialog.said.text() and "Takes · 2" in learn.title.text()
    cell = learn.table.visualItemRect(learn.table.item(0, 0))
    QTest.mouseClick(learn.table.viewport(), Qt.MouseButton.LeftButton, pos=cell.center())
    assert learn.note.text() == rows[0][3]
    shot(dialog, "takes")


class Made:
    """A training that says what it is told to."""

    def __init__(self, out: Path, hear) -> None:
        self.out, self.hear = out, hear
        self.error, self.path = "", out.with_name("none")
        self.running, self.stopped, self.left = True, 0, False

    def say(self, **what) -> None:
        fields = {"event": "step", "step": 0, "share": 0.0, "numbers": {}, "statistics": {}}
        clock = {"minutes": 0.0, "seconds": 60 * what.get("minutes", 0.0)}
        self.hear(SimpleNamespace(**{**fields, **clock, "landmarks": [], "text": "", **what}))

    def stop(self) -> None:
        self.stopped += 1

    def end(self, model: Path) -> None:
        shutil.copy(model, self.out)
        self.path, self.running = self.out, False
        self.say(event="end")

    def wait(self, seconds: float | None = None) -> Path:
        if self.error:
            raise RuntimeError(self.error)
        return self.path

    def leave(self) -> None:
        self.left, self.running = True, False


@pytest.fixture
def training(shown, tmp_path):
    """The dialog with takes, and a training that was begun."""
    drive, dialog = shown
    dialog.tabs.setCurrentWidget(dialog.learn)
    learn, begun = dialog.learn, []

    def begin(batch, wish, out, hear):
        assert batch.takes and set(wish) == {"kind", "size", "minutes"}
        begun.append(Made(out, hear))
        return begun[-1]

    learn.begin = begin
    learn.look_through([takes(tmp_path / "takes")])
    drive.wait(lambda: not learn.busy and learn.table.rowCount() > 0, 60)
    if learn_page.describe_missing_training():
        pytest.skip("torch is not installed")
    learn.name.setText("mine")
    press(learn.train)
    drive.wait(lambda: learn.run is not None)
    yield drive, dialog, begun[0]


@pytest.mark.nightly
def test_a_training_is_followed_stopped_and_kept(training, model):
    drive, dialog, process = training
    learn = dialog.learn
    for n in range(1, 30):
        numbers = {"likelihood": 10.0 + n, "reconstruction": 1 / n}
        process.say(step=n * 100, minutes=n / 10, share=n / 150, numbers=numbers)
        if n % 6 == 0:
            found = {"speed": 2.0 - n / 30, "trembling": 8 / n, "profile": n / 40}
            process.say(event="statistics", minutes=n / 10, statistics=found)
            points = (
                np.cumsum(np.random.default_rng(n).normal(0, 0.01, (60, 9, 3)), 0) + learn.preview.moves[0][0]
            )
            process.say(event="poses", landmarks=points.tolist())
    drive.wait(lambda: learn.stands.text().startswith("2,900 steps"))
    (line,) = learn.plots.goals.values()
    assert len(line) == 29 and line[-1][1] == 39.0
    assert learn.plots.ratios["trembling"][-1][1] == pytest.approx(8 / 24)
    assert learn.preview.moves[1].shape == (60, 9, 3) and learn.progress.value() > 0
    assert not learn.add.isEnabled() and not learn.train.isVisible()
    drive.wait(lambda: learn.preview.isVisible())
    shot(dialog, "training")
    press(learn.stop)
    assert process.stopped == 1 and not learn.stop.isEnabled()
    process.end(model)
    drive.wait(lambda: learn.run is None)
    assert "mine" in dialog.said.text() and dialog.use.model.currentText() == "mine"
    assert learn.train.isVisible() and learn.add.isEnabled()


@pytest.mark.nightly
def test_a_training_that_fails_says_why(training):
    drive, dialog, process = training
    process.error, process.running = "memory ran out: train a smaller model", False
    process.say(event="error")
    drive.wait(lambda: "memory ran out" in dialog.said.text())
    assert dialog.learn.run is None and dialog.learn.train.isEnabled()


@pytest.mark.nightly
def test_closing_ends_the_training(training):
    _, dialog, process = training
    dialog.close()
    assert process.left


def planting():
    pytest.importorskip("torch", reason="training needs torch, which is not installed")
    from tests.generation.training import planting

    return planting


@pytest.mark.nightly
def test_a_training_that_was_cut_short_is_offered_and_not_written_over(shown, tmp_path):
    drive, dialog = shown
    planting().cut_short(tmp_path / "models", "mine", 10)
    assert not dialog.learn.begun.isVisibleTo(dialog.learn)
    dialog.close()
    drive.wait(lambda: drive.window.findChild(GenerationDialog) is None)
    drive.do("generate_motion")
    dialog = drive.window.findChild(GenerationDialog)
    assert "'mine' is not over" in dialog.said.text()
    dialog.tabs.setCurrentWidget(dialog.learn)
    learn = dialog.learn
    assert learn.begun.which.currentText() == "mine · matching, 10 steps, 25 % done"
    shot(dialog, "begun")
    learn.name.setText("mine")
    learn.look_through([takes(tmp_path / "takes")])
    drive.wait(lambda: not learn.busy and learn.table.rowCount() > 0, 60)
    learn.start()
    assert "unfinished training" in dialog.said.text() and learn.run is None
    dialog.close()


@pytest.mark.nightly
def test_what_a_killed_training_had_learned_can_be_kept_as_it_is(shown, tmp_path):
    drive, dialog = shown
    out = planting().cut_short(tmp_path / "models", "mine", 10)
    planting().cut_short(tmp_path / "models", "nothing")
    dialog.learn.fill()
    dialog.tabs.setCurrentWidget(dialog.learn)
    learn = dialog.learn
    learn.begun.which.setCurrentIndex(1)
    assert "nothing saved yet" in learn.begun.which.currentText() and not learn.begun.keep.isEnabled()
    learn.begun.which.setCurrentIndex(0)
    held = hold(find_training_folder(out))
    press(learn.begun.go)
    assert "Another process" in dialog.said.text() and learn.run is None
    held.close()
    press(learn.begun.keep)
    drive.wait(lambda: out.is_file() and learn.run is None, 300)
    assert read_card(out).steps == 10 and read_card(out).notes


@pytest.mark.nightly
def test_a_model_that_is_there_is_not_written_over(shown, tmp_path):
    drive, dialog = shown
    learn = dialog.learn
    learn.look_through([takes(tmp_path / "takes")])
    drive.wait(lambda: not learn.busy and learn.table.rowCount() > 0, 60)
    learn.name.setText("tiny")
    learn.start()
    assert "already" in dialog.said.text() and learn.run is None
    learn.name.setText("a/b")
    learn.start()
    assert "file name" in dialog.said.text()


@pytest.mark.nightly
def test_without_torch_it_says_what_to_install_and_still_samples(shown, monkeypatch):
    drive, dialog = shown
    dialog.close()
    from metagraph.generation import train_process

    monkeypatch.setattr(train_process.importlib.util, "find_spec", lambda name: None)
    drive.wait(lambda: drive.window.findChild(GenerationDialog) is None)
    drive.do("generate_motion")
    dialog = drive.window.findChild(GenerationDialog)
    dialog.tabs.setCurrentWidget(dialog.learn)
    assert "pip install" in dialog.learn.needs.text() and dialog.learn.needs.isVisible()
    assert not dialog.learn.train.isEnabled() and dialog.use.move_button.isEnabled()
    shot(dialog, "no_torch")
    dialog.close()


@pytest.mark.nightly
def test_without_a_conversation_it_says_how_to_get_one(shown):
    drive, dialog = shown
    use = dialog.use
    assert use.side.isVisible() and not use.nobody.isVisible()
    drive.document.edit("No talk", lambda p: replace(p, conversations={}))
    assert not use.side.isVisible() and not use.move_button.isVisible()
    assert use.nobody.isVisible() and "Drop a recording" in use.nobody.text()
    drive.document.undo()
    assert use.side.isVisible() and use.move_button.isEnabled() and not use.nobody.isVisible()


@pytest.mark.nightly
def test_without_a_sound_making_clips_asks_for_one_first(shown, tmp_path, monkeypatch):
    drive, dialog = shown
    use, asked = dialog.use, []
    drive.document.edit("No talk", lambda p: replace(p, conversations={}))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: asked.append(1) or ("", ""))
    press(use.cut_button)
    assert asked == [1] and not use.busy, "nothing was chosen"
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(tmp_path / "talk.wav"), ""))
    use.minutes.setValue(0.2)
    press(use.cut_button)
    assert use.busy and use.speech.currentText() == "talk.wav"
    drive.wait(lambda: not use.busy)
