"""Mirrored twins through the real window: written beside the project, placed, one step to undo."""

from __future__ import annotations

import numpy as np
import pytest

from app.features.twins.mirrored_twins import FOLDER

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def saved(drive, toy, tmp_path):
    """A window on a saved project with a wave of the right arm and a beat of the left."""
    from metagraph.formats.gltf.writer import write_glb
    from metagraph.graph import edits

    for name, swing in (("rest", 0.0), ("wave rt", 0.6), ("beat lf", 0.4)):
        clip = toy.clip(name, 1.0, swing=swing)
        write_glb(tmp_path / f"{name}.glb", [clip])
    drive.importing.import_paths([str(tmp_path)])
    drive.wait(lambda: len(drive.document.project.clips) == 3)
    ids = {clip.name: clip.id for clip in drive.document.project.clips.values()}
    drive.document.edit("Stance", lambda p: edits.add_stance(p, "arms", "rest", [ids["rest"]]))
    stance = next(iter(drive.document.project.graphs["arms"].stances))
    drive.document.edit(
        "Place", lambda p: edits.place_clips(p, [ids["wave rt"], ids["beat lf"]], "arms", "gesture", stance)
    )
    drive.action = lambda name: next(a for a in drive.document.project.actions() if a.name == name)
    drive.document.edit(
        "Tag", lambda p: edits.update_actions(p, [drive.action("wave rt").id], tags=("right", "hello"))
    )
    drive.document.save(tmp_path / "p.metagraph.yaml")
    drive.place = tmp_path
    return drive


def make(drive, *names):
    drive.session.selection.select_actions(tuple(drive.action(name).id for name in names))
    drive.pause(30)
    before = len(drive.document.project.clips)
    drive.actions["twins"].trigger()
    drive.wait(lambda: len(drive.document.project.clips) > before)


@pytest.mark.nightly
def test_an_action_gets_a_twin_of_the_other_side_that_is_selected_and_told(saved):
    drive = saved
    make(drive, "wave rt")
    twin = drive.action("wave lf")
    assert (twin.limb, twin.kind, twin.tags) == ("left", "gesture", ("left", "hello"))
    assert drive.session.selection.actions == (twin.id,)
    entry = drive.document.project.clips[twin.clip]
    assert entry.path == f"{FOLDER}/wave lf.glb" and (drive.place / entry.path).is_file()
    assert entry.name == "wave lf" and len(entry.digest) == 64
    message = drive.window.statusBar().currentMessage()
    assert message.startswith("Made 1 mirrored twin: wave lf. Saved in ")
    first = drive.document.project.clips[drive.action("wave rt").clip].motion
    skeleton = first.skeleton
    left, right = skeleton.index("LeftHand"), skeleton.index("RightHand")
    a, b = (skeleton.globals(m.poses())[1] for m in (first, entry.motion))
    np.testing.assert_allclose(b[:, left] * [-1, 1, 1], a[:, right], atol=1e-3)


@pytest.mark.nightly
def test_several_are_one_step_and_their_files_outlive_undo(saved):
    drive = saved
    make(drive, "wave rt", "beat lf")
    assert {"wave lf", "beat rt"} <= set(drive.names("gesture"))
    project = drive.document.project
    drive.actions["undo"].trigger()
    assert sorted(drive.names("gesture")) == ["beat lf", "wave rt"] and len(drive.document.project.clips) == 3
    assert sorted(p.name for p in (drive.place / FOLDER).iterdir()) == ["beat rt.glb", "wave lf.glb"]
    drive.actions["redo"].trigger()
    assert drive.document.project is project


@pytest.mark.nightly
def test_made_again_no_file_is_written_over(saved):
    drive = saved
    make(drive, "wave rt")
    drive.actions["undo"].trigger()
    make(drive, "wave rt")
    assert sorted(p.name for p in (drive.place / FOLDER).iterdir()) == ["wave lf.glb", "wave lf_2.glb"]
    assert drive.document.project.clips[drive.action("wave lf").clip].path == f"{FOLDER}/wave lf_2.glb"


@pytest.mark.nightly
def test_saved_and_opened_the_twin_is_what_it_was(saved):
    drive = saved
    make(drive, "wave rt")
    drive.files.save()
    project = drive.document.project
    drive.files.open(drive.place / "p.metagraph.yaml")
    drive.wait(lambda: drive.document.project is not project)
    clip = drive.action("wave lf").clip
    again, before = drive.document.project.clips[clip], project.clips[clip]
    assert again == before
    np.testing.assert_array_equal(again.motion.rotations, before.motion.rotations)


@pytest.mark.nightly
def test_a_clip_of_the_library_is_mirrored_alone(saved):
    drive = saved
    clip = drive.action("beat lf").clip
    drive.session.selection.select_clips((clip,))
    drive.pause(30)
    drive.actions["twins"].trigger()
    drive.wait(lambda: len(drive.document.project.clips) == 4)
    (new,) = drive.session.selection.clips
    assert drive.document.project.clips[new].name == "beat rt" and new not in drive.document.project.uses
    assert drive.window.statusBar().currentMessage().startswith("Mirrored 1 clip: beat rt.")


@pytest.mark.nightly
def test_what_has_no_side_is_told_and_nothing_is_written(saved, toy):
    from dataclasses import replace

    drive = saved
    ident = drive.action("rest").clip
    entry = drive.document.project.clips[ident]
    still = replace(
        entry.motion, rotations=np.broadcast_to(toy.skeleton.rest_rotations, entry.motion.rotations.shape)
    )
    straight = replace(
        still, translations=np.broadcast_to(toy.skeleton.rest_translations[:1], still.translations.shape)
    )
    project = drive.document.project
    changed = replace(entry, motion=straight, digest="0" * 64)
    drive.document.edit("Still", lambda p: replace(project, clips={**project.clips, ident: changed}))
    drive.session.selection.select_clips((ident,))
    drive.actions["twins"].trigger()
    drive.wait(lambda: "does not need a mirrored twin" in drive.window.statusBar().currentMessage())
    assert not (drive.place / FOLDER).exists()


def test_before_the_project_is_saved_it_says_that_it_must_be(toys):
    drive = toys
    drive.session.selection.select_actions((drive.id("rest wave rt"),))
    drive.pause(30)
    project = drive.document.project
    drive.actions["twins"].trigger()
    assert "Save the project first" in drive.window.statusBar().currentMessage()
    assert drive.document.project is project


def test_it_stands_in_the_menus_of_actions_and_clips(saved):
    drive = saved
    assert drive.actions["twins"] in drive.canvas.row_actions
    entry = next(iter(drive.document.project.clips.values()))
    texts = [a.text().replace("&", "") for a in drive.library.acts.menu(entry).actions()]
    assert "Make mirrored twins" in texts and "Repairs…" in texts
