"""The strip under the timing plot: where an action begins and ends without a jump, what snaps there, what is
proposed.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.stage.compatibility_state import compare_proposed_timing
from metagraph.common.wording import translate_phrase
from metagraph.graph import edits
from metagraph.suggest.jumps.found import Measured, compute_stance_curves
from metagraph.suggest.jumps.seen_jumps import SeenJumps, describe_ends, find_far_ends, find_words_at
from tests.app.catalogue_texts import catalogue_texts

ROOT = Path(__file__).resolve().parents[4]


@pytest.fixture(scope="module")
def wide(toy):
    """A wave so wide that it is far from its stance in the middle."""
    project = edits.add_clips(toy.project(), [("wide.glb", 0, "", toy.clip("wide", 2.4, swing=2.4))])
    project = edits.place_clips(
        project, [toy.id(project, "wide")], "arms", "gesture", toy.id(project, "rest")
    )
    return edits.update_actions(project, [toy.id(project, "wide")], timing={"end": 1.5, "blend_out": 0.05})


def seen_of(toy, project, name):
    action = next(a for a in project.actions() if a.name == name)
    return action, SeenJumps(action, compute_stance_curves(project, Measured(project, action.layer), action))


def test_a_gesture_fits_at_its_ends_and_not_in_its_middle(toy, wide):
    _, seen = seen_of(toy, wide, "wide")
    first, *_, last = seen.spans()
    assert first[0] == 0 and 0.1 < first[1] < 1.2 and 1.4 < last[0] < 2.4 and last[1] == pytest.approx(2.4)
    assert seen.cost("end", 1.5) > 1 > seen.cost("end", 2.4)
    assert len(seen.curve()) == len(seen.times) and np.isfinite(seen.curve()).all()


def test_a_longer_blend_widens_what_fits(toy, wide):
    action, seen = seen_of(toy, wide, "wide")
    longer = edits.update_actions(wide, [action.id], timing={"blend_out": 0.4})
    _, wider = seen_of(toy, longer, "wide")
    assert wider.spans()[-1][0] < seen.spans()[-1][0]


def test_handles_come_to_rest_at_what_is_proposed_and_where_nothing_begins_to_show(toy, wide):
    _, seen = seen_of(toy, wide, "wide")
    assert seen.proposed.end in seen.snaps("end") and seen.proposed.start in seen.snaps("start")
    assert all(0 <= t <= 2.4 for handle in ("start", "end") for t in seen.snaps(handle))
    assert seen.snaps("in") == seen.snaps("stroke") == []


def test_a_transition_is_beside_the_stance_it_leaves_and_then_the_one_it_enters(toy, wide):
    action, seen = seen_of(toy, wide, "rest to up")
    assert 0 < seen.pivot < len(seen.times)
    assert "enters from 'rest'" in find_words_at(wide, action, seen, 0.0)
    assert "leaves to 'up'" in find_words_at(wide, action, seen, 0.8)
    far, elsewhere = seen_of(toy, edits.set_ends(wide, [action.id], toy.id(wide, "far")), "rest to up")
    assert "leaves to 'far'" in find_words_at(
        edits.set_ends(wide, [far.id], toy.id(wide, "far")), far, elsewhere, 0.8
    )


def test_words_name_cost_and_blend(toy, wide):
    action, seen = seen_of(toy, wide, "wide")
    words = find_words_at(wide, action, seen, 1.5)
    assert (
        words.startswith("At 1.50 s it leaves to 'rest': ")
        and "times the visible threshold" in words
        and "0.05 s" in words
    )
    assert "no jump, " in find_words_at(wide, action, seen, 2.4)


def test_a_loop_shows_its_seam(toy, wide):
    action, seen = seen_of(toy, wide, "rest loop")
    assert seen.loops and seen.pivot == 0 and seen.snaps("start") == []
    assert find_words_at(wide, action, seen, 2.0).startswith("At 2.00 s it repeats from here")
    assert set(compare_proposed_timing(action, seen.proposed, 2.0)) == {"start", "end", "blend_in"}


@pytest.mark.parametrize(
    ("costs", "words"),
    [
        ({"Begins": 0.1, "ends": 1.0}, "Begins and ends without a jump"),
        (
            {"Begins": 0.1, "ends": 2.71},
            "Begins without a jump, ends with one, 2.7 times the visible threshold",
        ),
        (
            {"Begins": 1.2, "ends": 0.3},
            "Begins with a jump, 1.2 times the visible threshold, ends without one",
        ),
        ({"Repeats": 0.0}, "Loops smoothly"),
        ({"Repeats": 1.6}, "Loop seam jumps, 1.6 times the visible threshold"),
    ],
)
def test_the_verdict_is_one_sentence(costs, words):
    found = describe_ends(costs)
    assert found == words
    german = catalogue_texts("de")
    said = translate_phrase(found, lambda words: german.get(words.template, words.template))
    assert not {"jump", "without", "times"} & set(said.replace(",", "").split())


def test_what_the_problems_call_far_is_never_said_to_be_without_a_jump(toy, wide):
    from metagraph.graph.check import check_project

    action = wide.action(toy.id(wide, "wide"))
    far = find_far_ends(wide, action)
    told = [
        p.message for p in check_project(wide) if p.code in ("far-start", "far-end") and p.action == action.id
    ]
    assert far and len(told) == len(far) and all(any(w[1:] in m for m in told) for w in far.values())
    words = describe_ends({"Begins": 0.1, "ends": 0.2}, far)
    assert "cm from stance 'rest'" in words and words[0].isupper()
    far = "Begins 20 cm from stance 'x'"
    assert describe_ends({"Begins": 0.1, "ends": 3.0}, {"Begins": far}).startswith(
        f"{far}, ends with a jump, 3.0 times "
    )


@pytest.fixture
def timed(toys, toy, wide):
    drive = toys
    drive.document.load(wide, None)
    drive.files.opened.emit()
    drive.wait(
        lambda: (
            drive.compatibility.judged is not None
            and drive.compatibility.judged.measured["arms"].labelled > 5
        )
    )
    drive.session.jump(action=toy.id(wide, "wide"))
    drive.wait(lambda: drive.properties.action.plot.strip.seen is not None)
    drive.settle()
    return drive


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_dragged_end_comes_to_rest_where_it_does_not_jump_in_one_step(timed, toy, wide):
    drive = timed
    timing = drive.properties.action.plot
    plot, box = timing.plot, timing.plot.plotItem.vb
    ident = toy.id(wide, "wide")

    def at(seconds: float) -> tuple:
        point = plot.mapFromScene(box.mapViewToScene(QPointF(seconds, box.viewRect().center().y())))
        return plot.viewport(), QPoint(round(point.x()), round(point.y()))

    goal = min(timing.strip.seen.snaps("end"))
    pixel = box.viewPixelSize()[0]
    before = drive.document.undo_stack.count()
    drive.drag(
        at(1.5),
        at(goal - 4 * pixel),
        lambda: (drive.document.project.action(ident).timing.end or 9) > goal - 2 * pixel,
    )
    drive.pause(300)
    assert drive.document.project.action(ident).timing.end == pytest.approx(goal, abs=0.002), (
        "4 pixels beside, it rests on it"
    )
    assert drive.document.undo_stack.count() == before + 1
    drive.wait(lambda: timing.verdict.text() == "Begins and ends without a jump")


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_alt_leaves_the_marks_out(timed, monkeypatch):
    plot = timed.properties.action.plot
    goal = plot.strip.seen.proposed.end
    near = goal + 3 * plot.plot.plotItem.vb.viewPixelSize()[0]
    assert plot._snapped("end", near) == goal
    assert plot._snapped("end", 1.2) == 1.2
    monkeypatch.setattr(
        QApplication, "keyboardModifiers", staticmethod(lambda: Qt.KeyboardModifier.AltModifier)
    )
    assert plot._snapped("end", near) == near


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_proposed_times_are_taken_over_with_a_click_in_one_step(timed, toy, wide):
    drive = timed
    ident, plot = toy.id(wide, "wide"), drive.properties.action.plot
    assert "94 cm" in plot.verdict.text()
    assert plot.strip.tip(QPointF(200, 20)).startswith("At ")
    proposed = plot.strip.seen.proposed
    QTest.mouseClick(plot.use, Qt.MouseButton.LeftButton)
    drive.wait(lambda: drive.document.undo_stack.count() == 1)
    timing = drive.document.project.action(ident).timing
    assert timing.start == pytest.approx(proposed.start, abs=1e-3) and timing.blend_out == pytest.approx(
        proposed.blend_out, abs=1e-3
    )
    drive.wait(lambda: plot.verdict.text() == "Begins and ends without a jump" and not plot.use.isEnabled())
    drive.document.undo()
    assert drive.document.project.action(ident).timing.end == 1.5
    # Many at once, from the menu.
    drive.session.selection.select_actions((ident, toy.id(wide, "rest wave rt")))
    drive.actions["use_times"].trigger()
    drive.wait(
        lambda: (
            drive.document.undo_stack.count() == 1 and drive.document.project.action(ident).timing.end != 1.5
        )
    )
