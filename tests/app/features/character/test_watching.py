"""What helps to watch the character: marks of feet with what slides, ghosts of the stance and of other moments."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.features.character.foot_marks import FootState, describe_slide, find_foot_states
from app.stage.watch import Watch
from metagraph.playback.posing.contacts import find_hand_goals
from metagraph.playback.posing.foot_slides import RATE
from tests.posing import contact_rig

pytestmark = [pytest.mark.window, pytest.mark.gl]


def drifting(drive, speed: float = 0.03):
    """Show a clip of the sample alone whose root drifts from its second second on."""
    project = drive.document.project
    loop = next(a for a in project.graphs["body"].actions.values() if a.kind == "stance")
    entry = project.clips[loop.clip]
    moved = np.array(entry.motion.translations)
    moved[:, 0, 0] += speed * np.maximum(0.0, np.arange(len(moved)) / entry.motion.fps - 1.0)
    changed = replace(entry, motion=replace(entry.motion, translations=moved))
    drive.document.load(replace(project, clips={**project.clips, loop.clip: changed}), None)
    drive.files.opened.emit()
    drive.session.transport.show_clip(loop.clip)
    drive.session.transport.set_playing(False)
    drive.wait(lambda: drive.performance.shown.clip == loop.clip)
    return loop


@pytest.fixture
def shown(drive, sample):
    drive.document.load(sample, None)
    drive.files.opened.emit()
    plays = drive.performance
    drive.wait(lambda: plays.shown.project is drive.document.project)
    drive.wait(lambda: len(plays.shown.plan.layers["arms"].cues) > 3)
    drive.wait(lambda: bool(drive.preview.scene().actors))  # its figure is read on a thread
    return drive


@pytest.mark.nightly
def test_feet_are_marked_by_a_key_and_one_that_slides_says_how_fast_and_when(shown):
    drive, feet = shown, shown.preview.overlays.feet
    drifting(drive)
    drive.session.transport.seek(2.0)
    assert feet.isHidden() and feet.line.isHidden()
    drive.key(Qt.Key.Key_G, Qt.KeyboardModifier.ShiftModifier)
    assert drive.shell.actions["feet"].isChecked() and feet.line.isVisible()
    drive.wait(lambda: "mm/s" in feet.line.accessibleDescription())
    seen = feet.seen(None)
    words = describe_slide(seen)
    assert words.startswith("⚠") and any(f" {n} mm/s at 0:0" in words for n in (30, 31, 32))
    n = int(np.abs(seen.times - 2.0).argmin())
    assert seen.sliding()[n].any() and seen.states[n, 0] == FootState.HELD
    first, *_ = [run for run in find_foot_states(seen, 0) if run[3]]
    assert 0.7 < first[0] < 1.3, "it says from when on"
    plain = drive.preview.view.grab().toImage()
    drive.key(Qt.Key.Key_G, Qt.KeyboardModifier.ShiftModifier)
    assert feet.isHidden() and feet.line.isHidden() and drive.preview.view.grab().toImage() != plain


def touching(drive, weight: float):
    """Go to a moment of the sample at which a hand is so far, at least, in contact; return the contacts."""
    shown = drive.performance.shown
    rig = contact_rig(shown.project)
    drive.session.transport.set_playing(False)
    times = np.arange(0.0, shown.length, 0.05)

    def touches(at: float) -> bool:
        return any(g.weight >= weight for g in find_hand_goals(shown.moving, shown.project, rig, at))

    drive.session.transport.seek(next(float(t) for t in times if touches(float(t))))
    marks = drive.preview.overlays.hands
    # The picture of that moment has its hands where they should be.
    drive.wait(lambda: any(t.weight >= weight and not t.missed for t in marks.touches()))
    return marks.touches()


@pytest.mark.nightly
def test_hands_in_contact_are_marked_by_a_key_and_said(shown):
    drive, marks = shown, shown.preview.overlays.hands
    touches = touching(drive, 0.995)
    held = next(t for t in touches if t.held)
    assert marks.isHidden()
    plain = drive.preview.view.grab().toImage()
    drive.key(Qt.Key.Key_J, Qt.KeyboardModifier.ShiftModifier)
    assert drive.shell.actions["hands_touch"].isChecked() and marks.isVisible()
    joint = drive.performance.shown.skeleton.names[held.to]
    drive.wait(lambda: joint in marks.accessibleDescription())
    assert drive.preview.view.grab().toImage() != plain
    drive.key(Qt.Key.Key_J, Qt.KeyboardModifier.ShiftModifier)
    assert marks.isHidden()


@pytest.mark.nightly
def test_a_clip_looked_at_alone_has_the_contacts_of_what_uses_it(shown):
    action = next(a for a in shown.document.project.actions() if a.contacts)
    shown.session.transport.show_clip(action.clip)
    shown.wait(lambda: shown.performance.shown.clip == action.clip)
    shown.session.transport.set_playing(False)
    span = action.contacts[0]
    shown.session.transport.seek((span.start + span.end) / 2)
    shown.wait(lambda: bool(shown.preview.overlays.hands.touches()))


@pytest.mark.nightly
def test_no_event_composes_more_than_a_few_poses(shown):
    feet = shown.preview.overlays.feet
    shown.session.transport.set_playing(False)
    shown.session.transport.seek(7.0)
    asked = []
    watch = feet.watching()
    inner = watch._places_at
    watch._places_at = lambda times: (asked.append(len(times)), inner(times))[1]
    shown.do("feet")
    shown.wait(lambda: len(feet.seen(0).times) > 60 if feet.seen(0) is not None else False)
    assert max(asked) <= 12 and sum(asked) < 2 * 3 * RATE


@pytest.mark.nightly
@pytest.mark.parametrize("command", ["feet", "hands_touch", "stance_ghost", "onion", "trails"])
def test_what_lies_over_the_picture_does_not_draw_it_again_and_again(shown, command):
    shown.session.transport.set_playing(False)
    shown.session.transport.seek(6.0)
    shown.do(command)
    shown.pause(600)  # until all is known of the feet
    before = shown.preview.frames
    shown.pause(300)
    assert shown.preview.frames - before < 6
    shown.do(command)


@pytest.mark.nightly
def test_the_next_slide_is_found_and_none_is_said(shown):
    drifting(shown)
    shown.session.transport.seek(0.0)
    shown.do("next_slide")
    shown.wait(lambda: 0.7 < shown.session.transport.seconds < 1.3)
    assert shown.session.watch.now.feet, "it is marked there"
    other = next(a.clip for a in shown.document.project.graphs["arms"].actions.values())
    shown.session.transport.show_clip(other)
    shown.wait(lambda: shown.performance.shown.clip == other)
    shown.do("next_slide")
    shown.wait(lambda: "No planted foot" in shown.window.statusBar().currentMessage())


@pytest.mark.nightly
def test_the_stance_stands_as_a_ghost_where_the_character_has_left_it(shown):
    panel, session = shown.preview, shown.session
    session.transport.set_playing(False)
    gesture = next(c for c in shown.performance.shown.plan.layers["arms"].cues if c.action.kind == "gesture")
    session.transport.seek((gesture.start + gesture.end) / 2)
    assert len(panel.scene().actors) == 1
    shown.do("stance_ghost")
    solid, ghost = panel.scene().actors
    assert ghost.opacity < 1 and not np.allclose(solid.positions, ghost.positions, atol=0.02)
    clip = shown.document.project.clips[gesture.action.clip]
    session.transport.show_clip(gesture.action.clip)
    session.transport.set_playing(False)
    session.transport.seek(clip.duration / 2)
    assert len(panel.scene().actors) == 2, "of a clip alone, too"


@pytest.mark.nightly
def test_onion_skin_shows_moments_before_and_after_as_many_and_as_far_as_asked(shown):
    panel, session = shown.preview, shown.session
    session.transport.set_playing(False)
    session.transport.seek(6.0)
    shown.key(Qt.Key.Key_O, Qt.KeyboardModifier.ShiftModifier)
    assert len(panel.scene().actors) == 5
    session.watch.set(before=3, after=1, spacing=0.2)
    _, *ghosts = panel.scene().actors
    assert [a.opacity < 1 for a in ghosts] == [True] * 4
    assert ghosts[0].opacity < ghosts[2].opacity, "the farther the fainter"
    at = shown.performance.shown.skeleton.globals(shown.performance.shown.pose(6.0 - 0.6))[1]
    assert ghosts[0].positions == pytest.approx(at, abs=1e-5)
    session.transport.seek(0.0)
    assert len(panel.scene().actors) == 2, "nothing is before the beginning"
    shown.do("onion")
    assert len(panel.scene().actors) == 1


def test_the_button_in_the_view_has_it_all_and_what_was_chosen_is_kept(shown):
    panel = shown.preview
    menu = panel.watch_button.menu_of
    menu.aboutToShow.emit()
    actions = {a.text().replace("&", ""): a for a in menu.actions() if not a.isSeparator()}
    assert {
        "Foot contacts",
        "Ghost of the stance",
        "Onion skin",
        "Show the skeleton",
        "Four views",
    } <= set(actions)
    assert panel.view.rect().contains(panel.watch_button.geometry())
    actions["Ghost of the stance"].trigger()
    shown.session.watch.set(spacing=0.5)
    kept = Watch().now
    assert kept.stance and kept.spacing == 0.5


def test_light_and_background_are_chosen_for_the_view_and_offered_for_rendering(shown):
    from app.features.render.render_dialog import RenderDialog

    shown.key(Qt.Key.Key_L, Qt.KeyboardModifier.ShiftModifier)
    assert shown.session.watch.now.light == "day"
    menu = shown.shell.actions["background"].menu()
    menu.aboutToShow.emit()
    next(a for a in menu.actions() if "Neutral" in a.text()).trigger()
    theme = shown.preview.view.theme
    assert theme.top == theme.bottom and theme.line_strength == 0 and theme.toward != (-0.42, 0.80, 0.62)
    dialog = RenderDialog(shown.performance, shown.session, shown.jobs)
    assert (dialog.light.currentData(), dialog.background.currentData()) == ("day", "neutral")
    dialog.close()


def test_a_background_of_the_project_is_chosen_saved_undone_and_offered_for_rendering(shown, monkeypatch):
    from PySide6.QtGui import QColor
    from PySide6.QtWidgets import QColorDialog

    from app.features.render.render_dialog import RenderDialog

    def choose(words: str) -> None:
        menu = shown.shell.actions["background"].menu()
        menu.aboutToShow.emit()
        next(a for a in menu.actions() if words in a.text()).trigger()

    document, view = shown.document, shown.preview.view
    choose("Room")
    assert document.project.backdrop.kind == "room" and view.theme.walls is not None
    dialog = RenderDialog(shown.performance, shown.session, shown.jobs)
    assert dialog.background.currentText() == "The project's" and dialog.background.currentData() is None
    for suffix, shows in ((".mov", "Transparent"), (".mp4", "The project's"), (".webm", "Transparent")):
        dialog.kind.setCurrentIndex(dialog.kind.findData(suffix))
        dialog.kind.activated.emit(dialog.kind.currentIndex())
        assert dialog.background.currentText() == shows and dialog.file.text().endswith(suffix)
    dialog.close()
    monkeypatch.setattr(QColorDialog, "getColor", lambda *_: QColor("#336699"))
    choose("Plain colour")
    assert document.project.backdrop.color == (0x33, 0x66, 0x99) and view.theme.walls is None
    assert tuple(round(255 * x) for x in view.theme.top) == (0x33, 0x66, 0x99)
    document.undo()
    assert document.project.backdrop.kind == "room" and view.theme.walls is not None
    choose("White")  # one of the user's own takes its place
    assert document.project.backdrop.kind == "" and view.theme.top == (1, 1, 1)


def test_the_seat_is_chosen_and_kept_and_drawn(drive):
    from app.project.files import SEATED
    from preview.furniture import Chair
    from preview.stool import Stool

    drive.files.open(SEATED, template=True)
    drive.wait(lambda: drive.preview.drawn is not None)
    kinds = lambda: [type(a.figure) for a in drive.preview.scene().actors]  # noqa: E731
    drive.wait(lambda: Stool in kinds())
    menu = drive.shell.actions["seat"].menu()
    menu.aboutToShow.emit()
    next(a for a in menu.actions() if a.text() == "Chair").trigger()
    assert Chair in kinds() and Stool not in kinds()
    assert Watch().now.seat == "chair"
    drive.session.watch.set(seat="none")
    assert not {Chair, Stool} & set(kinds())
    drive.session.watch.set(seat="stool")


def test_the_studios_light_follows_the_camera_and_others_stay(shown):
    panel = shown.preview
    panel.frame_all()
    shown.wait(lambda: panel.drawn is not None)
    assert panel.scene().lamp is None
    shown.do("see_left")
    lamp = panel.scene().lamp
    assert lamp is not None and np.degrees(lamp.angle) == pytest.approx(68.0)
    assert panel.composed.lamp == lamp, "in a window of its own, too"
    shown.session.watch.set(light="evening")
    assert panel.scene().lamp is None
    shown.session.watch.set(light="studio")


def test_four_views_show_one_moment_from_four_sides_and_the_pose_is_made_once(shown):
    panel, session = shown.preview, shown.session
    session.transport.set_playing(False)
    session.transport.seek(5.0)
    shown.key(Qt.Key.Key_Q, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier)
    front, side, face = panel.panes.others
    shown.wait(
        lambda: (
            all(p.view.isVisible() for p in panel.panes.others)
            and side.view.camera.yaw
            and face.view.camera.distance < panel.view.camera.distance / 2
        )
    )
    yaws = [round(np.degrees(p.view.camera.yaw)) for p in (front, side)]
    assert yaws == [0, 90] and front.view.camera.flat and not face.view.camera.flat
    composed, pose_of = [], type(panel.performance.shown).pose
    type(panel.performance.shown).pose = lambda self, at: (composed.append(at), pose_of(self, at))[1]
    try:
        drawn = [p.view.grab().toImage() for p in panel.panes.others]
        session.transport.seek(6.5)
        panel.view.grab()
        after = [p.view.grab().toImage() for p in panel.panes.others]
    finally:
        type(panel.performance.shown).pose = pose_of
    assert all(a != b for a, b in zip(drawn, after, strict=True))
    assert [at for at in composed if at == 6.5] == [6.5], "once for all of them"


def test_each_view_has_its_own_camera_side_and_commands(shown):
    panel = shown.preview
    shown.do("two_views")
    (pane,) = panel.panes.others
    shown.wait(pane.view.isVisible)
    panel.view.grab()
    pane.view.grab()
    first = panel.view.camera
    QTest.mouseClick(pane.view, Qt.MouseButton.LeftButton)
    shown.do("see_back")
    assert panel.view.camera == first and abs(np.degrees(pane.view.camera.yaw)) == pytest.approx(180)
    pane.button.menu().aboutToShow.emit()
    next(a for a in pane.button.menu().actions() if a.text() == "Hands").trigger()
    assert pane.button.text().startswith("Hands") and shown.session.watch.now.sides.startswith("hands")
    shown.wait(lambda: abs(pane.view.camera.yaw) < 0.01)
    shown.do("two_views")
    assert not panel.panes.others and panel.panes.active is panel.view


def test_settings_that_cannot_be_read_are_as_at_first(qapp):
    from PySide6.QtCore import QSettings

    for broken in ("[]", "{", '{"feet": 3, "before": 99, "spacing": -1.0}'):
        QSettings().setValue("watch", broken)
        now = Watch().now
        assert not now.feet and now.before in (0, 5) and now.spacing > 0
