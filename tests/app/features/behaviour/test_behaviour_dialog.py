"""The Behaviour dialog: counts for each mode, temperaments, and counting again after an edit."""

from __future__ import annotations

import pytest

from app.features.behaviour.behaviour_dialog import OWN, BehaviourDialog
from metagraph.graph import edits
from metagraph.graph.temperaments import find_rest_scale
from metagraph.playback.planning.markov import DEFAULTS


def shown(dialog):
    return [[dialog.table.item(r, c).text() for c in range(3)] for r in range(dialog.table.rowCount())]


def opened(toys):
    toys.do("behaviour")
    dialog = toys.window.findChild(BehaviourDialog)
    toys.wait(lambda: dialog.table.rowCount() > 0)
    return dialog


@pytest.mark.nightly
def test_it_counts_an_hour_of_each_mode_and_the_stage_shows_that_mode(toys):
    dialog = opened(toys)
    talking = shown(dialog)
    assert talking[0][0] == "Gestures of the arms" and talking[0][1] != "0.0 a minute"
    dialog.modes.button(2).click()
    assert toys.session.onstage.improvised == "idle"
    idle = shown(dialog)
    assert idle[0][1] == "0.0 a minute" and idle != talking
    blinks = next(row for row in idle if row[0] == "Blinks")
    assert blinks[2].startswith("people: 8.0 to 21.0")


@pytest.mark.nightly
def test_a_temperament_is_one_step_to_undo_and_is_counted_again(toys):
    dialog = opened(toys)
    before, calm = toys.document.project, shown(dialog)
    place = dialog.temperament.findData("candidate")
    dialog.temperament.setCurrentIndex(place)
    dialog.temperament.activated.emit(place)
    toys.wait(lambda: shown(dialog) != calm)
    assert toys.document.project.settings.variety == 0.5
    toys.document.undo()
    assert toys.document.project == before and dialog.temperament.currentData() == "neutral"
    toys.document.edit("v", lambda p: edits.set_settings(p, variety=3.0))
    assert dialog.temperament.currentData() == OWN


def test_a_stance_that_has_to_repeat_itself_is_named(toys):
    dialog = opened(toys)
    assert "'rest'" in dialog.lacks.text() and "would end the repetition" in dialog.lacks.text()


def test_it_shows_the_mode_that_plays_wherever_that_was_chosen(toys):
    toys.session.onstage.improvise("idle")
    dialog = opened(toys)
    assert dialog.modes.group.checkedId() == 2 and shown(dialog)[0][1] == "0.0 a minute"
    toys.session.onstage.improvise("talking")
    assert dialog.modes.group.checkedId() == 0 and shown(dialog)[0][1] != "0.0 a minute"


def test_each_dial_sets_one_number_and_is_a_step_to_undo(toys):
    dialog = opened(toys)
    before = toys.document.project
    for name, value in (("rests", 1.5), ("variety", 2.0), ("aversion_rate", 20.0), ("blinks", 9.0)):
        dialog.dials[name].setValue(value)
    project = toys.document.project
    assert project.settings.variety == 2.0 and find_rest_scale(project, DEFAULTS) == 1.5
    assert (project.life.aversion_rate, project.life.blinks) == (20.0, 9.0)
    assert dialog.temperament.currentData() == OWN
    for _ in range(4):
        toys.document.undo()
    assert toys.document.project == before and dialog.dials["blinks"].value() == before.life.blinks


def test_the_source_of_a_figure_for_people_stands_beside_it(toys):
    dialog = opened(toys)
    blinks = next(row for row in shown(dialog) if row[0] == "Blinks")
    assert blinks[2].startswith("people: ") and "Bentivoglio" in blinks[2]
