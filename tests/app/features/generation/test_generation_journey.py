"""From a training to an engine, in the real window: train, make, cut, look, label, drop, export."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
import soundfile
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.features.export.export_dialog import ExportDialog
from app.features.generation.generation_dialog import GenerationDialog
from metagraph.engines.reading import read_export
from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.store import open_project, save_project
from metagraph.generation.features import RATE
from metagraph.generation.stored import Model, read_card, write_model
from metagraph.generation.train_process import find_missing_tools
from metagraph.graph import edits
from metagraph.graph.conversation.model import Conversation, Segment, Side
from metagraph.graph.model import Project
from tests.generation.makers import babble, untrained

pytestmark = [pytest.mark.window, pytest.mark.gl]
ROOT = Path(__file__).parents[4]
SECONDS = 20.0


def press(button) -> None:
    QTest.mouseClick(button, Qt.MouseButton.LeftButton, pos=button.rect().center())


def speech(folder: Path) -> Conversation:
    """Ada says something every 4 s, and nothing in between; Ben listens."""
    t = np.arange(round(SECONDS * RATE)) / RATE
    loud = (t % 4 > 1.5) & (t % 4 < 2.7)
    voice = np.where(loud, babble(SECONDS, 1, 0.9) + 0.2 * np.sin(2 * np.pi * 180 * t), 0.0)
    soundfile.write(folder / "talk.wav", np.stack([voice, 0 * voice], 1).astype(np.float32), RATE)
    said = tuple(Segment("clause", s + 1.5, s + 2.7, s + 2.0) for s in range(0, 20, 4))
    ada = Side(name="Ada", segments=said, audio="talk.wav", channel=0)
    return Conversation(
        name="talk", length=SECONDS, sides=(ada, Side(name="Ben", audio="talk.wav", channel=1))
    )


def few() -> Project:
    """The sample project with one stance a layer, and little else."""
    sample = ROOT / "sample_clips" / "sample.metagraph.yaml"
    project = make_paths_absolute(open_project(sample).project, sample.parent)
    for graph in project.graphs.values():
        for ident in graph.stances:
            project = project if ident == graph.start else edits.remove_stance(project, ident)
    keep = ("__stance", "hands_at_sides__shrug_bt_01", "hands_at_sides__touch_neck_rt_01")
    gone = [e.id for e in project.clips.values() if not e.name.endswith(keep)]
    return replace(edits.remove_clips(project, gone), lines={}, performances={})


def write_mover(path: Path) -> None:
    """A model by chance that rests while nothing is heard, and moves when something is, where Chance is 0."""
    still = untrained("moglow", 0.2)
    card = msgspec.structs.replace(still.card, pose_deviation=(0.15,) * len(still.card.pose_deviation))
    write_model(Model(card, still.weights), path)


@pytest.mark.nightly
def test_from_training_to_an_export_that_says_what_was_generated(drive, tmp_path):
    path = tmp_path / "copy.metagraph.yaml"
    save_project(replace(few(), conversations={"v9000": speech(tmp_path)}), path)
    write_mover(tmp_path / "mover.mgmodel")
    if find_missing_tools() is None:
        from tests.generation.training.planting import cut_short

        cut_short(tmp_path / "models", "learned", 10)
    drive.files.open(path)
    drive.wait(lambda: drive.document.folder == tmp_path and drive.document.project.skeleton is not None)
    drive.do("generate_motion")
    dialog = drive.window.findChild(GenerationDialog)

    # Train: where torch is there, one that was cut short is gone on with.
    if find_missing_tools() is None:
        QTest.mouseClick(
            dialog.tabs.tabBar(), Qt.MouseButton.LeftButton, pos=dialog.tabs.tabBar().tabRect(1).center()
        )
        press(dialog.learn.begun.go)
        drive.wait(lambda: dialog.use.model.currentText() == "learned", 300)
        assert read_card(tmp_path / "models" / "learned.mgmodel").steps == 40
        # There are more minutes to be had, and nothing is left to keep.
        begun = dialog.learn.begun
        assert "training time is up" in begun.which.currentText() and not begun.keep.isVisible()
        assert dialog.learn.preview.moves[0] is not None
        QTest.mouseClick(
            dialog.tabs.tabBar(), Qt.MouseButton.LeftButton, pos=dialog.tabs.tabBar().tabRect(0).center()
        )

    # Make and cut.
    use = dialog.use
    use.model.setCurrentText("mover")
    use.seed.setValue(5)
    use.temperature.setValue(0.0)
    use.minutes.setValue(0.5)
    press(use.cut_button)
    drive.wait(lambda: not use.busy, 120)
    assert "pieces, not saved yet" in dialog.said.text(), dialog.said.text()
    pieces = list(use.table.pieces)
    assert len(pieces) >= 3 and len({p.clip.name for p in pieces}) == len(pieces)

    # Look: a row that is clicked moves beside the list.
    def cell(row: int, x: int) -> QPoint:
        rect = use.table.visualItemRect(use.table.item(row, 0))
        return QPoint(rect.left() + x, rect.center().y())

    QTest.mouseClick(use.table.viewport(), Qt.MouseButton.LeftButton, pos=cell(1, 60))
    assert use.view.preview.words == (pieces[1].clip.name,)
    moved = use.view.preview.moves[0]
    assert moved.shape[1:] == (9, 3) and np.ptp(moved, 0).max() > 0.01

    # Label two, leave one out, drop.
    kinds = [use.table.cellWidget(row, 2) for row in (0, 1)]
    for box, key in zip(kinds, (Qt.Key.Key_F, Qt.Key.Key_G), strict=True):
        box.setFocus()
        QTest.keyClick(box, key)
    limb = use.table.cellWidget(1, 4)
    limb.setFocus()
    QTest.keyClick(limb, Qt.Key.Key_L)
    QTest.mouseClick(use.table.viewport(), Qt.MouseButton.LeftButton, pos=cell(2, 14))
    before, stance = drive.document.project, use.stance.currentData()
    press(use.drop_button)
    drive.wait(lambda: len(drive.document.project.clips) == len(before.clips) + len(pieces) - 1, 60)
    project = drive.document.project
    new = [e for e in project.clips.values() if e.id not in before.clips]
    placed = {a.name: a for e in new for a in project.uses[e.id]}
    first, second = (placed[p.clip.name] for p in pieces[:2])
    assert (first.kind, second.kind, second.limb) == ("fidget", "gesture", "left")
    assert {(a.layer, a.stance) for a in placed.values()} == {("arms", stance)}
    assert pieces[2].clip.name not in placed
    dialog.close()

    # Export: JSON and GLB name them, and say that they are generated.
    drive.do("export")
    export = drive.window.findChild(ExportDialog)
    export.folder.setText(str(tmp_path / "out"))
    press(export.go)
    drive.wait(lambda: export.open_button.isEnabled(), 120)
    export.reject()
    written = tmp_path / "out" / "sample.json"
    clips = {c["name"]: c for c in json.loads(written.read_bytes())["clips"]}
    assert (
        {clips[e.name]["made_by"] for e in new}
        == {"mover"}
        == {c.get("made_by", "mover") for c in clips.values()}
    )
    assert {clips[e.name]["made_seed"] for e in new} == {5}
    assert sum("made_by" in c for c in clips.values()) == len(new)
    again = read_export(written)
    assert {(e.made_by, e.made_seed) for e in again.clips.values() if e.made_by} == {("mover", 5)}
    animations = [c.name for c in read_gltf_clips(next((tmp_path / "out").glob("*.glb")))]
    assert {e.name for e in new} <= {*animations}
