"""Segments edited with the real pointer and real keys, each edit one undo step."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest

from app.features.conversation.segment_hits import find_word_edges
from app.look.theme import get_theme
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import SPOKEN

pytestmark = [pytest.mark.window, pytest.mark.gl]
Key, Modifier = Qt.Key, Qt.KeyboardModifier


def steps(talk: Any) -> int:
    return int(talk.drive.document.undo_stack.index())


def press(talk: Any, key: Qt.Key, modifier: Qt.KeyboardModifier = Modifier.NoModifier) -> None:
    talk.view.setFocus()
    QTest.keyClick(talk.view, key, modifier)


@pytest.mark.nightly
def test_an_edge_is_dragged_and_caught_by_a_word(talk: Any) -> None:
    first, before = talk.segments()[0], steps(talk)
    edges = [
        e
        for e in find_word_edges(talk.conversation.sides[0].words, first.end)
        if first.start < e < first.end - 0.1
    ]
    to = max(edges)
    talk.drive.drag(
        talk.at(first.end - 0.02), talk.at(to - 0.01), lambda: talk.segments()[0].end != first.end
    )
    assert talk.segments()[0].end == pytest.approx(to, abs=0.002)
    assert steps(talk) == before + 1
    talk.drive.document.undo()
    assert talk.segments()[0] == first


@pytest.mark.nightly
def test_a_body_is_dragged_up_to_its_neighbour_and_takes_its_stress_along(talk: Any) -> None:
    before = talk.segments()[3]
    assert before.kind == "hesitation"
    talk.drive.drag(
        talk.at((before.start + before.end) / 2),
        talk.at(before.end + 9),
        lambda: talk.segments()[3] != before,
    )
    after = talk.segments()[3]
    assert after.end == talk.segments()[4].start
    assert after.end - after.start == pytest.approx(before.end - before.start)
    assert talk.editing.chosen == {(0, 3)}


@pytest.mark.nightly
def test_the_stress_is_dragged_to_a_top_of_the_pitch(talk: Any) -> None:
    talk.read()
    first = talk.segments()[0]
    heard = talk.drive.conversation.sounds.of(talk.conversation, 0)
    tops = [m for m in heard.maxima if first.start < m < first.end and abs(m - first.peak) > 0.15]
    top = float(tops[0])
    talk.drive.drag(
        talk.at(first.peak, row="wave"),
        talk.at(top + 0.02, row="wave"),
        lambda: talk.segments()[0].peak != first.peak,
    )
    near = min(heard.maxima, key=lambda m: abs(m - talk.segments()[0].peak))
    assert talk.segments()[0].peak == pytest.approx(near, abs=0.002)
    assert talk.drive.document.undo_stack.undoText() == "Move stress"


@pytest.mark.nightly
def test_a_drag_in_a_gap_makes_a_segment_with_its_stress(talk: Any) -> None:
    talk.read()
    count, before = len(talk.segments()), steps(talk)
    talk.editing.select({(0, 1)})
    press(talk, Key.Key_Delete)
    assert len(talk.segments()) == count - 1
    gap = conversation_edits.find_gap_at(talk.conversation, 0, talk.segments()[0].end + 0.2)
    assert gap is not None
    start, end = gap[0] + 0.15, gap[1] - 0.15
    talk.drive.drag(talk.at(start), talk.at(end), lambda: len(talk.segments()) == count)
    made = talk.segments()[1]
    assert (made.kind, talk.editing.chosen) == ("clause", {(0, 1)})
    assert made.start == pytest.approx(start, abs=0.07)
    assert made.end == pytest.approx(end, abs=0.07)
    assert made.start <= made.peak <= made.end
    assert made.text, "the words in it are its words"
    assert steps(talk) == before + 2


def test_escape_cancels_a_drag(talk: Any) -> None:
    first, before = talk.segments()[0], steps(talk)
    view, start = talk.at(first.end - 0.02)
    QTest.mousePress(view, Qt.MouseButton.LeftButton, Modifier.NoModifier, start)
    QTest.mouseMove(view, start - QPoint(60, 0))
    assert view.held is not None
    assert view.conversation().sides[0].segments[0].end < first.end
    press(talk, Key.Key_Escape)
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, Modifier.NoModifier, start - QPoint(60, 0))
    assert view.held is None
    assert talk.segments()[0] == first
    assert steps(talk) == before


def test_keys_label_split_merge_and_remove_several_at_once(talk: Any) -> None:
    whole = talk.segments()
    talk.drive.click(talk.at((whole[0].start + whole[0].end) / 2))
    talk.drive.click(talk.at((whole[1].start + whole[1].end) / 2), Modifier.ControlModifier)
    assert talk.editing.chosen == {(0, 0), (0, 1)}
    for key, kind in zip((Key.Key_2, Key.Key_3, Key.Key_1), (*SPOKEN[1:], SPOKEN[0]), strict=True):
        press(talk, key)
        assert {s.kind for s in talk.segments()[:2]} == {kind}
    press(talk, Key.Key_M)
    assert len(talk.segments()) == len(whole) - 1
    assert talk.segments()[0].text == f"{whole[0].text} {whole[1].text}"
    talk.view.pointer = QPoint(-1, -1).toPointF()
    talk.drive.session.transport.seek(whole[1].start)
    press(talk, Key.Key_S)
    assert [s.text for s in talk.segments()[:2]] == [whole[0].text, whole[1].text]
    before = steps(talk)
    press(talk, Key.Key_Delete)
    assert talk.segments() == whole[2:]
    assert steps(talk) == before + 1
    while talk.drive.document.undo_stack.undoText() != "Add conversation":
        talk.drive.document.undo()
    assert talk.segments() == whole


def test_a_double_click_labels_a_segment_as_what_comes_next(talk: Any) -> None:
    first = talk.segments()[0]
    view, point = talk.at((first.start + first.end) / 2)
    QTest.mouseDClick(view, Qt.MouseButton.LeftButton, Modifier.NoModifier, point)
    assert talk.segments()[0].kind == "response"


@pytest.mark.nightly
def test_tab_and_arrows_go_from_segment_to_segment_and_bring_it_in_sight(talk: Any) -> None:
    press(talk, Key.Key_Tab)
    assert talk.editing.chosen == {(0, 0)}
    for _ in range(30):
        press(talk, Key.Key_Right)
    last = len(talk.segments()) - 1
    assert talk.editing.chosen == {(0, last)}
    assert 0 <= talk.view.scale().x(talk.segments()[last].start) <= talk.view.width()
    press(talk, Key.Key_Left)
    assert talk.editing.chosen == {(0, last - 1)}
    press(talk, Key.Key_Down)
    assert {side for side, _ in talk.editing.chosen} == {1}
    before = talk.editing.segment(talk.editing.last)
    press(talk, Key.Key_Right, Modifier.ShiftModifier)
    after = talk.editing.segment(talk.editing.last)
    assert after.end >= before.end
    assert after.start == before.start
    press(talk, Key.Key_Escape)
    assert not talk.editing.chosen


def test_what_cannot_be_done_is_told_and_leaves_no_step(talk: Any) -> None:
    before = steps(talk)
    talk.view.pointer = QPoint(-1, -1).toPointF()
    talk.drive.session.transport.seek(0.01)
    press(talk, Key.Key_S)
    talk.editing.select({(0, len(talk.segments()) - 1)})
    press(talk, Key.Key_M)
    assert [w.split(":")[0] for w in talk.drive.told] == [
        "There is no segment here. Move the playhead or the pointer to where you want to split one.",
        "There is no segment after this one to merge it with.",
    ]
    assert steps(talk) == before


def test_the_menu_has_what_the_keys_do(talk: Any) -> None:
    first = talk.segments()[0]
    talk.editing.select({(0, 0)})
    menu = talk.view.menu((first.start + first.end) / 2)
    talk.drive.pick(menu, "Split here")
    assert talk.segments()[0].end == pytest.approx((first.start + first.end) / 2, abs=0.001)
    shown = [a.text().split("\t")[1] for a in menu.actions() if "\t" in a.text()]
    assert shown[:6] == ["1", "2", "3", "S", "M", "P"]


def test_waves_pitch_and_segments_are_painted_and_the_playhead_alone_paints_nothing_anew(talk: Any) -> None:
    talk.read()
    talk.drive.pause(50)
    talk.view.look_at(0.0)
    image = talk.view.grab().toImage()

    def colours(at: float, row: str) -> set[str]:
        _, point = talk.at(at, row=row)
        high = 30 if row == "wave" else 6
        return {
            image.pixelColor(point.x() + dx, point.y() + dy).name()
            for dx in range(-3, 4)
            for dy in range(-high, high)
        }

    loud = talk.segments()[0]
    silence = loud.start / 2
    assert len(colours((loud.start + loud.end) / 2, "wave")) > 12, "a waveform with a pitch over it"
    assert len(colours(silence, "wave")) < 8, "nothing is heard before anybody speaks"
    assert any(near(c, get_theme("dark").sounds["clause"]) for c in colours(loud.end - 0.05, "segments"))
    painted = talk.view.painted
    for n in range(5):
        talk.drive.session.transport.seek(0.3 + 0.1 * n)
        talk.view.grab()
    assert talk.view.painted == painted


def test_panning_half_an_hour_looks_only_at_what_is_in_sight(talk: Any) -> None:
    from app.features.conversation.sound_reading import SideSound
    from app.widgets.waveforms import RATE, Envelope

    sounds = talk.drive.conversation.sounds
    long = Envelope(1800)
    long.fill(0, np.random.default_rng(1).standard_normal(round(1800 * RATE)))
    for key in sounds.heard:
        sounds.heard[key] = SideSound(wave=long, pitch=long, told="")
    width = talk.view.width()
    for each in (0.7, 40, 400):
        talk.view.each = each
        long.worked = 0
        talk.view.look_at(12.0)
        talk.view.grab()
        assert 0 < long.worked <= 4 * (4 * width + 8)


def near(a: str, b: str) -> bool:
    """Whether two colours are one on a screen of 16 bits."""
    return all(abs(x - y) <= 9 for x, y in zip(QColor(a).getRgb(), QColor(b).getRgb(), strict=True))


@pytest.mark.nightly
def test_a_missing_sound_is_told_in_its_lane_and_the_rest_works(talk: Any, tmp_path: Path) -> None:
    talk.read()
    ident = talk.drive.session.onstage.conversation
    talk.drive.document.edit(
        "Change", lambda p: conversation_edits.change_side(p, ident, 1, audio=str(tmp_path / "gone.wav"))
    )
    talk.read()
    heard = talk.drive.conversation.sounds.of(talk.conversation, 1)
    assert "gone.wav" in heard.missing
    assert "choose" in heard.missing.lower()
    assert talk.drive.conversation.sounds.of(talk.conversation, 0).wave is not None
    talk.editing.select({(1, 0)})
    press(talk, Key.Key_1)
    assert talk.segments(1)[0].kind == "clause"


def test_tips_say_what_is_said_and_when(talk: Any) -> None:
    first = talk.segments()[0]
    _, point = talk.at((first.start + first.end) / 2)
    tip = talk.view.tip(point.toPointF())
    assert first.text in tip
    assert f"{first.start:.2f} to {first.end:.2f} s" in tip
    _, wave = talk.at(talk.conversation.sides[0].words[0].start + 0.02, row="words")
    assert talk.conversation.sides[0].words[0].text in talk.view.tip(wave.toPointF())
