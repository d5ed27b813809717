"""The default body in the real window: drawn for clips without a mesh, a stick figure by choice, kept in sight."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.formats.gltf.writer import write_glb
from metagraph.graph import edits
from preview.default_body.figure import DefaultBody
from preview.figure import StickFigure

pytestmark = [pytest.mark.window, pytest.mark.gl]


def shown(drive):
    skeleton = drive.document.project.skeleton
    return drive.shell.stage.figures.figure(skeleton) if skeleton is not None else None


@pytest.fixture
def clips(toy, tmp_path):
    """A clip that stays, and one that goes six metres aside."""
    still = toy.clip("still", 0.6, swing=0.3)
    root = still.translations.copy()
    root[:, 0, 0] += np.linspace(0, 6, len(root))
    for clip in (still, replace(still, name="goes", translations=root)):
        write_glb(tmp_path / f"{clip.name}.glb", [clip])
    return tmp_path


@pytest.mark.nightly
def test_a_choice_in_the_view_menu_draws_bones_and_the_body_again(drive, clips):
    drive.importing.import_paths([str(clips / "still.glb")])
    drive.wait(lambda: isinstance(shown(drive), DefaultBody))
    assert not drive.actions["sticks"].isChecked()
    drive.actions["sticks"].trigger()
    drive.wait(lambda: isinstance(shown(drive), StickFigure))
    drive.wait(lambda: drive.preview.drawn is not None and isinstance(drive.preview.drawn[0], StickFigure))
    assert drive.shell.stage.thumbnails.figures.sticks
    drive.actions["sticks"].trigger()
    drive.wait(lambda: isinstance(shown(drive), DefaultBody))
    drive.wait(lambda: isinstance(drive.preview.drawn[0], DefaultBody))


@pytest.mark.nightly
def test_the_camera_steps_back_for_a_clip_that_would_leave_the_picture(drive, clips):
    drive.importing.import_paths([str(clips)])
    drive.wait(lambda: len(drive.document.project.clips) == 2 and isinstance(shown(drive), DefaultBody))
    drive.wait(lambda: drive.preview.drawn is not None)
    ids = {entry.name: ident for ident, entry in drive.document.project.clips.items()}
    drive.session.transport.show_clip(ids["still"])
    drive.pause(200)
    near = drive.preview.view.camera
    drive.session.transport.show_clip(ids["goes"])
    drive.wait(lambda: drive.preview.view.camera.distance > near.distance + 1)
    assert drive.preview.view.camera.target[0] == pytest.approx(3, abs=1)
    drive.session.transport.show_clip(ids["still"])
    drive.wait(lambda: drive.preview.view.camera.distance < near.distance + 0.5)
    drive.session.transport.show_clip(ids["goes"])
    drive.wait(lambda: drive.preview.view.camera.distance > near.distance + 1)
    drive.preview.view.moved_by_hand = True
    kept = drive.preview.view.camera
    drive.session.transport.show_clip(ids["still"])
    drive.pause(200)
    assert drive.preview.view.camera == kept, "a camera that was moved stays"


def test_the_camera_goes_to_a_performance_that_plays_elsewhere(drive, clips):
    drive.importing.import_paths([str(clips)])
    drive.wait(lambda: len(drive.document.project.clips) == 2 and isinstance(shown(drive), DefaultBody))
    ids = {entry.name: ident for ident, entry in drive.document.project.clips.items()}
    drive.session.transport.show_clip(ids["still"])
    drive.pause(200)
    assert abs(drive.preview.view.camera.target[0]) < 1

    def far(project):
        entry = project.clips[ids["still"]]
        motion = entry.motion
        translations = motion.translations.copy()
        translations[:, 0, 0] += 6.0
        moved = replace(entry, motion=replace(motion, translations=translations))
        project = replace(project, clips={**project.clips, ids["still"]: moved})
        return edits.add_stance(project, "body", "far", [ids["still"]])

    drive.document.edit("put far away", far)
    drive.session.transport.show_plan()
    drive.wait(lambda: abs(drive.preview.view.camera.target[0] - 6) < 1.5)
