"""Another character, body and voice for one who talks: a click on the arrow by the name, one on the choice."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu

from app.features.conversation.partner_menu import make_partner_menu
from app.features.conversation.segment_lanes import place_segment_lanes
from app.widgets.lane_geometry import LEFT
from metagraph.graph.conversation.edits import add_conversation
from metagraph.graph.conversation.model import Conversation, Segment, Side

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture
def two(drive, toy, tmp_path):
    for name, channels in (("talk.wav", 2), ("solo.wav", 1)):
        soundfile.write(tmp_path / name, np.zeros((16000, channels)), 16000)
    for name in ("ada.glb", "ben.glb", "other.metagraph.yaml", "notes.txt"):
        (tmp_path / name).write_bytes(b"")
    sides = (
        Side(name="Ada", audio="talk.wav", channel=0, segments=(Segment("clause", 1.0, 3.0),)),
        Side(name="Ben", audio="talk.wav", channel=1),
    )
    made = Conversation(name="Talk", length=8.0, sides=sides)
    project, ident = add_conversation(toy.project(), made)
    drive.document.load(project, tmp_path / "mine.metagraph.yaml")
    drive.files.opened.emit()
    drive.session.transport.set_playing(False)
    drive.session.onstage.set_conversation(ident)
    drive.wait(lambda: bool(drive.performance.shown.others))
    yield drive, ident
    drive.session.onstage.set_conversation(None)
    drive.told.clear()


def choices(menu: QMenu) -> dict[str, dict[str, object]]:
    inner = {x.text(): x.menu() for x in menu.actions() if x.menu() is not None}
    return {name: {x.text(): x for x in of.actions()} for name, of in inner.items()}


def test_what_lies_beside_the_project_is_offered_and_what_is_so_is_checked(two):
    drive, ident = two
    found = choices(make_partner_menu(drive.conversation, drive.document, ident, 0))
    assert list(found["Character"])[1:] == ["ada", "ben"]
    assert list(found["Body language from"]) == ["This project", "other"]
    assert list(found["Voice"]) == ["No sound", "talk.wav, left", "talk.wav, right", "solo.wav"]
    checked = [[x.isChecked() for x in of.values()].index(True) for of in found.values()]
    assert checked == [0, 0, 1], "the project's own character, this project, the left of the sound"


def test_two_clicks_change_who_is_seen_and_heard(two):
    drive, ident = two
    drive.show("conversation")
    view = drive.conversation.view
    lane = place_segment_lanes(view.width(), view.height(), 2)[1]
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=QPoint(LEFT - 11, round(lane.wave.top()) + 11))
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu) and drive.session.onstage.side == 1
    choices(menu)["Voice"]["solo.wav"].trigger()
    menu.close()
    side = lambda: drive.document.project.conversations[ident].sides[1]  # noqa: E731
    assert (side().audio, side().channel) == ("solo.wav", None)
    choices(make_partner_menu(view, drive.document, ident, 1))["Character"]["ben"].trigger()
    assert side().character == "ben.glb"
    drive.document.undo()
    drive.document.undo()
    assert (side().audio, side().channel, side().character) == ("talk.wav", 1, None)


@pytest.mark.nightly
def test_the_menu_bar_offers_the_same_for_all_who_talk(two):
    drive, _ = two
    drive.shell.actions.refresh()
    menu = drive.shell.actions["partners"].menu()
    menu.aboutToShow.emit()
    assert [x.text() for x in menu.actions()] == ["Ada", "Ben"]
    assert [x.text() for x in menu.actions()[0].menu().actions() if x.text()][
        -1
    ] == "More options and position…"
