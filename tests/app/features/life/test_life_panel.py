"""The life panel: a slider, a number and an off for each dial; one undo step a drag; modes apart from the
amounts.
"""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QToolButton

from app.features.life.life_panel import LifePanel
from app.project.document import Document
from app.stage.session import StageSession
from metagraph.graph.life import DIALS, MANNER_DIALS, MANNERS, Life


@pytest.fixture
def panel(qapp, qtbot):
    document = Document()
    out = LifePanel(document, StageSession(document))
    qtbot.addWidget(out)
    yield out
    document.close_journal()


def life(panel) -> Life:
    return panel.document.project.life


def test_every_dial_has_a_row_that_shows_it(panel):
    assert set(panel.rows) == {d.name for d in DIALS}
    for name, row in panel.rows.items():
        assert row.number.value() == pytest.approx(getattr(Life(), name))


def test_the_guard_and_the_contacts_of_hands_are_ticked_and_undone(panel):
    touch = lambda: panel.document.project.touch  # noqa: E731
    assert not panel.guard.isChecked() and panel.contacts.isChecked(), "as projects begin"
    panel.guard.click()
    panel.contacts.click()
    assert touch().guard and not touch().contacts
    panel.document.undo()
    panel.document.undo()
    assert not panel.guard.isChecked() and panel.contacts.isChecked() and not touch().guard


def test_a_number_typed_and_a_slider_moved_set_the_same_field(panel):
    panel.rows["breath_rate"].number.setValue(20.0)
    assert life(panel).breath_rate == 20.0
    panel.rows["breath_rate"].slider.setValue(0)
    assert life(panel).breath_rate == 0.0
    panel.document.undo()
    assert life(panel).breath_rate == 20.0 and panel.rows["breath_rate"].number.value() == 20.0


def test_a_drag_is_one_step(panel):
    slider = panel.rows["stillness"].slider
    slider.setSliderDown(True)
    for place in (10, 20, 55):
        slider.setValue(place)
    slider.setSliderDown(False)
    assert life(panel).stillness == pytest.approx(0.55)
    panel.document.undo()
    assert life(panel).stillness == 0.0 and not panel.document.undo_stack.canUndo()


def test_unticking_turns_off_and_ticking_brings_back(panel):
    row = panel.rows["blinks"]
    row.number.setValue(22.0)
    row.tick.click()
    assert life(panel).blinks == 0.0 and not row.tick.isChecked()
    row.tick.click()
    assert life(panel).blinks == 22.0


def test_a_double_click_puts_a_dial_back(panel):
    panel.rows["gaze"].number.setValue(0.2)
    panel.rows["gaze"].put_back()
    assert life(panel).gaze == Life().gaze


def test_all_of_it_is_turned_off_at_once(panel):
    panel.on.click()
    assert not life(panel).on and not panel.rows["blinks"].slider.isEnabled()
    assert panel.guard.isEnabled(), "the guard needs no life"
    panel.document.undo()
    assert life(panel).on and panel.on.isChecked()


def test_a_mode_has_factors_of_its_own_and_goes_back_to_the_usual(panel):
    panel.tabs.button(2).click()
    assert panel.mode == "listening"
    rows = panel.manner_rows["listening"]
    assert set(rows) == {d.name for d in MANNER_DIALS}
    assert rows["aversion_rate"].number.value() == pytest.approx(MANNERS["listening"].aversion_rate)
    rows["aversion_rate"].number.setValue(2.0)
    assert life(panel).modes["listening"].aversion_rate == 2.0
    assert life(panel).aversion_rate == Life().aversion_rate, "the amount itself stays"
    next(b for b in panel.tabs.parent().findChildren(QToolButton)
         if b.isVisibleTo(panel) and b.text() == "Reset to defaults").click()  # fmt: skip
    assert life(panel).modes == {} and rows["aversion_rate"].number.value() == pytest.approx(
        MANNERS["listening"].aversion_rate
    )


def test_a_named_mood_sets_its_dials_and_a_dial_moved_makes_it_its_own(panel):
    panel.moods.setCurrentIndex(panel.moods.findText("Sad"))
    panel.moods.activated.emit(panel.moods.currentIndex())
    assert (life(panel).valence, life(panel).arousal) == (-0.71, -0.37)
    panel.rows["arousal"].number.setValue(0.25)
    assert life(panel).arousal == 0.25 and panel.moods.currentText() == "Custom"
    panel.document.undo()
    assert panel.moods.currentText() == "Sad"
    panel.document.undo()
    assert panel.moods.currentText() == "Neutral" and life(panel) == Life()
