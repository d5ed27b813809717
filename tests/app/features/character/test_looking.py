"""Looking at the character from where one wants: by key, near the hands, flat, round and round; and its picture
taken along.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QGuiApplication, QKeyEvent
from PySide6.QtWidgets import QApplication

from app.features.character.looking import SIDES
from metagraph.graph import anatomy
from preview.camera import Camera

KEYPAD = Qt.KeyboardModifier.KeypadModifier
CONTROL = Qt.KeyboardModifier.ControlModifier


def test_keys_of_the_number_pad_look_from_each_side_as_near_as_before(toys):
    drive, panel = toys, toys.preview
    panel.frame_all()
    drive.wait(lambda: panel.drawn is not None)
    before = panel.view.camera.zoom(3)
    panel.view.camera = before
    for key, modifiers, side in (
        (Qt.Key.Key_1, KEYPAD, "front"),
        (Qt.Key.Key_3, KEYPAD, "left"),
        (Qt.Key.Key_3, KEYPAD | CONTROL, "right"),
        (Qt.Key.Key_1, KEYPAD | CONTROL, "back"),
        (Qt.Key.Key_7, KEYPAD, "above"),
        (Qt.Key.Key_9, KEYPAD, "quarter"),
    ):
        drive.key(key, modifiers)
        yaw, pitch = SIDES[side]
        camera = panel.view.camera
        assert math.degrees(camera.pitch) == pytest.approx(pitch), side
        assert math.cos(camera.yaw - math.radians(yaw)) == pytest.approx(1.0), side
        assert camera.distance == before.distance and camera.target == before.target


def test_a_real_number_pad_is_heard_where_shortcuts_are_not_asked_for_it(toys):
    """X11 asks Qt's shortcuts for the digit alone: the key comes to the window, as it is sent here."""
    panel = toys.preview
    toys.do("see_quarter")
    sent = QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_3, KEYPAD, "3")
    QApplication.sendEvent(toys.window, sent)
    assert math.degrees(panel.view.camera.yaw) == pytest.approx(90.0)
    QApplication.sendEvent(toys.window, QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_1, KEYPAD & ~KEYPAD, "1"))
    assert math.degrees(panel.view.camera.yaw) == pytest.approx(90.0)  # a digit is none of the pad's


def test_both_hands_fill_the_picture(toys):
    drive, panel = toys, toys.preview
    panel.frame_all()
    drive.wait(lambda: panel.drawn is not None)
    whole = panel.view.camera.distance
    drive.do("see_hands")
    project, (_, _, places) = panel.performance.shown.project, panel.drawn
    roles = anatomy.project_roles(project)
    hands = [places[roles[f"{side}_hand"]] for side in ("left", "right") if f"{side}_hand" in roles]
    assert hands and panel.view.camera.distance < whole
    seen = panel.view.camera.project(hands, panel.view.width() / panel.view.height())
    assert ((seen > 0) & (seen < 1)).all()
    drive.do("frame")
    drive.wait(lambda: panel.view.camera.distance == pytest.approx(whole, rel=0.05))


def test_flat_and_back_what_is_at_the_target_stays_as_large(toys):
    drive, panel = toys, toys.preview
    before = panel.view.camera
    drive.do("flat")
    camera = panel.view.camera
    assert drive.shell.actions["flat"].isChecked() and camera.flat
    right = np.asarray(before.target) + before.axes[0] * 0.3
    assert camera.project([right], 1.0) == pytest.approx(before.project([right], 1.0), abs=1e-3)
    drive.do("flat")
    assert panel.view.camera.distance == pytest.approx(before.distance) and not panel.view.camera.flat


@pytest.mark.parametrize("distance", [0.3, 1.0, 4.2, 30.0])
def test_a_flat_camera_goes_back_to_where_it_was_as_far_as_it_may_go_away(distance):
    camera = Camera(distance=distance)
    flat = camera.flattened()
    assert flat.flat and flat.deepened().distance == pytest.approx(
        distance, rel=1e-6 if distance < 15 else 0.5
    )
    assert camera.deepened() is camera


def test_the_turntable_turns_until_it_is_told_to_stop(toys):
    drive, panel = toys, toys.preview
    yaw = panel.view.camera.yaw
    drive.do("turntable")
    drive.wait(lambda: abs(panel.view.camera.yaw - yaw) > 0.05)
    drive.do("turntable")
    yaw = panel.view.camera.yaw
    drive.pause(100)
    assert panel.view.camera.yaw == yaw and not panel.looking.turning


def test_trails_go_through_the_hands_and_are_drawn_over_the_character(toys):
    drive, panel = toys, toys.preview
    panel.frame_all()
    drive.wait(lambda: panel.drawn is not None)
    plain = panel.view.grab().toImage()
    drive.do("trails")
    assert panel.looking.trailing
    trails = panel.looking.trails
    times, places, known = trails.places()
    assert known and len(times) == len(places) > 30
    now = panel.session.transport.seconds
    n = int(np.abs(times - now).argmin())
    assert abs(times[n] - now) <= 0.02
    roles = anatomy.project_roles(panel.performance.shown.project)
    assert np.linalg.norm(places[n, 0] - panel.drawn[2][roles[known[0]]]) < 0.05
    assert panel.view.grab().toImage() != plain
    panel.session.transport.seek(now + 1.0)
    assert trails.places()[0][-1] > times[-1] or times[-1] >= panel.performance.shown.length - 0.1
    drive.do("trails")
    assert not panel.looking.trailing


def test_the_picture_is_on_the_clipboard(toys):
    toys.do("copy_picture")
    picture = QGuiApplication.clipboard().image()
    assert not picture.isNull() and picture.width() >= toys.preview.view.width()


def test_a_live_trail_keeps_the_past_and_asks_for_one_pose_a_picture(toy):
    from app.features.character.trails import RATE, TrailSamples
    from app.stage.playback_source import ShownPlayback
    from metagraph.playback.planner import make_plan

    project, asked = toy.project(), []

    def over(seconds: float) -> None:
        asked.append(seconds)

    samples = TrailSamples()
    for n in range(20):  # each moment of a live session is another playback
        shown = ShownPlayback(project, make_plan(project, 10.0), 10.0, over=over)
        times, places, known = samples.places(shown, 1.0 + n / RATE)
    assert (
        len(asked) == 20 and len(times) == len(places) == 20 and times[-1] == pytest.approx(1.0 + 19 / RATE)
    )
    assert known
    times, _, _ = samples.places(shown, 0.5)
    assert list(times) == pytest.approx([0.5]), "it began anew"
