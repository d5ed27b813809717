"""Cooldown, spacing, phases and the planner's numbers are shown for one or many, edited, and undone."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QFormLayout, QWidget

from app.features.properties.variation_rows import ActionRows, PlannerRows
from metagraph.graph import edits
from metagraph.graph.model import Settings
from metagraph.playback.timing.handles import PHASES, handle_times, move_handle
from metagraph.playback.timing.phases import find_phases


@pytest.fixture
def form(qapp, qtbot):
    page = QWidget()
    qtbot.addWidget(page)
    return QFormLayout(page), page


@pytest.fixture
def project(toy):
    return toy.project()


def some(project, toy, *names):
    return [project.action(toy.id(project, name)) for name in names]


def test_phases_are_shown_for_gestures_only(form, project, toy):
    rows = ActionRows(*form)
    rows.show_actions(project, some(project, toy, "rest long"))
    assert form[0].isRowVisible(rows.phase_rows[0]) and form[0].isRowVisible(rows.rest_row)
    rows.show_actions(project, some(project, toy, "rest scratch"))
    assert not form[0].isRowVisible(rows.phase_rows[0]) and form[0].isRowVisible(rows.rest_row)
    rows.show_actions(project, some(project, toy, "rest to up"))
    assert not form[0].isRowVisible(rows.rest_row)


def test_a_number_sets_its_field_and_many_that_differ_are_mixed(form, project, toy):
    rows, told = ActionRows(*form), []
    rows.changed.connect(lambda text, fields: told.append(fields))
    project = edits.update_actions(project, [toy.id(project, "rest long")], cooldown=3.0, spacing=2)
    rows.show_actions(project, some(project, toy, "rest long", "rest short"))
    assert rows.cooldown.text() == rows.spacing.text() == "mixed" and told == []
    rows.cooldown.setValue(5.0)
    rows.spacing.setValue(4)
    rows.show_actions(project, some(project, toy, "rest long"))
    assert (rows.cooldown.value(), rows.spacing.value()) == (3.0, 2)
    rows.spacing.setValue(-1)
    rows.relax.setValue(1.5)
    assert told == [{"cooldown": 5.0}, {"spacing": 4}, {"spacing": None}, {"timing": {"relax": 1.5}}]


def test_phases_go_back_to_what_the_motion_says(form, project, toy):
    rows, told = ActionRows(*form), []
    rows.changed.connect(lambda text, fields: told.append(fields))
    rows.show_actions(project, some(project, toy, "rest long"))
    assert not rows.found.isEnabled()
    project = edits.update_actions(project, [toy.id(project, "rest long")], timing={"relax": 1.9})
    rows.show_actions(project, some(project, toy, "rest long"))
    assert rows.found.isEnabled() and rows.relax.value() == 1.9
    rows.found.click()
    project = edits.update_actions(project, [toy.id(project, "rest long")], **told[-1])
    assert project == edits.update_actions(project, [toy.id(project, "rest long")], timing={"relax": None})


def test_the_planners_numbers_are_edits(form):
    done = []
    rows = PlannerRows(*form, lambda text, function: done.append((text, function)))
    rows.show_settings(Settings(alpha=2.0, rest=1.5, never_twice=False))
    assert done == [] and rows.fields["rest"].value() == 1.5 and not rows.never_twice.isChecked()
    rows.fields["memory"].setValue(60.0)
    rows.never_twice.click()
    after = edits.Project()
    for _, function in done:
        after = function(after)
    assert (after.settings.memory, after.settings.never_twice) == (60.0, True)
    assert done[0][0] == "Change memory"


# --- the handles of the plot


def test_a_phases_handle_stays_between_its_neighbours(project, toy):
    action = some(project, toy, "rest long")[0]
    found = find_phases(project, action)
    at = handle_times(project, action)
    assert [at[p] for p in PHASES] == [found.ready, found.stroke_end, found.relax]
    assert move_handle(project, action, "ready", -1.0) == {"ready": found.start}
    assert move_handle(project, action, "ready", 99.0) == {"ready": round(found.stroke_end, 3)}
    assert move_handle(project, action, "relax", 99.0) == {"relax": round(found.end, 3)}
    assert move_handle(project, action, "hold", found.relax - 0.01) == {
        "stroke_end": round(found.relax - 0.01, 3)
    }


def test_what_is_no_gesture_has_no_phases(project, toy):
    assert all(handle_times(project, some(project, toy, "rest scratch")[0])[p] is None for p in PHASES)
