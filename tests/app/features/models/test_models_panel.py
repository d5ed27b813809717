"""The models panel: the layer's model shown, edited as one step a drag, sampled, compared with what was
seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.features.models.annotation_dialog import SAMPLE
from app.features.models.compare_plot import (
    ComparePlot,
    describe_long,
    describe_model_fit,
    describe_often,
    shorten_state,
)
from app.features.models.models_panel import IMPORTED, ModelsPanel
from app.project.annotation_reading import apply_reading, begin_reading
from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.session import StageSession
from metagraph.formats.elan import read_elan
from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Markov
from metagraph.playback.learning.compare import compare_model
from metagraph.playback.learning.learn import learn_model, list_model_states
from metagraph.playback.planning.markov import ARMS, DEFAULTS
from tests.app.painted_text import faults, seen_in


@pytest.fixture(scope="module")
def reading():
    return begin_reading(read_elan(SAMPLE))


@pytest.fixture
def panel(qtbot, toy, monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    document, jobs = Document(), Jobs()
    document.load(toy.project(), None)
    widget = ModelsPanel(document, StageSession(document), jobs)
    qtbot.addWidget(widget)
    widget.resize(1200, 440)
    widget.show()
    qtbot.waitUntil(lambda: widget.heat.model is not None)
    yield widget
    jobs.stop()
    document.close_journal()


def steps(panel) -> int:
    return panel.document.undo_stack.count()


def pick(menu, *texts):
    for text in texts:
        action = next(a for a in menu.actions() if a.text() == text)
        menu = action.menu() or action
    menu.trigger()


def test_the_default_is_shown_and_an_empty_comparison_teaches(panel):
    assert panel.heat.model is ARMS
    assert "default" in panel.origin.text() and "9 states" in panel.origin.text()
    assert not panel.back.isEnabled() and not panel.chooser.isVisible()
    assert panel.teach.isVisible() and "arms" in panel.teach.text()
    panel.session.place.set_layer("head")
    assert panel.heat.model is DEFAULTS["head"] and panel.title.text() == "Head: which action follows which"


def test_links_and_button_ask_for_an_annotation(panel):
    wanted = []
    panel.learn_wanted.connect(wanted.append)
    panel.learn.click()
    panel.teach.linkActivated.emit("learn")
    panel.teach.linkActivated.emit("sample")
    assert wanted == ["", "", "sample"]


def test_a_drag_is_one_step_whose_proportions_are_those_before_it(panel):
    panel.heat.edited.emit(0, 0, 1.0, True)
    panel.heat.edited.emit(0, 0, 0.5, True)
    panel.heat.edited.emit(0, 0, 0.5, False)
    assert steps(panel) == 1
    row = panel.document.project.markov["arms"].matrix[0]
    assert np.allclose(row[:3], [0.5, 0.25, 1 / 12]), "having been at 100 % has not made the others alike"
    assert panel.back.isEnabled() and panel.origin.text() == "learned or edited · 9 states"
    panel.heat.edited.emit(0, 0, 0.4, True)
    panel.heat.edited.emit(0, 0, 0.4, False)
    assert steps(panel) == 2, "the next drag is the next step"
    panel.document.undo()
    panel.document.undo()
    assert panel.document.project.markov == {} and panel.heat.model is ARMS


def test_a_drag_that_is_given_up_leaves_nothing(panel):
    panel.heat.edited.emit(0, 0, 0.9, True)
    panel.heat.cancelled.emit()
    assert panel.document.project.markov == {} and steps(panel) == 0
    panel.heat.edited.emit(0, 0, 0.5, False)
    assert panel.document.project.markov["arms"].matrix[0][0] == 0.5


def test_rest_and_shares_are_fields_and_shares_never_exceed_all(panel):
    panel.gap.setValue(3.5)
    panel.shares["positive"].setValue(60)
    panel.shares["negative"].setValue(70)
    model = panel.document.project.markov["arms"]
    assert (model.gap, model.positive, model.negative) == (3.5, 0.3, 0.7)
    panel.gap.setValue(0.0)
    assert panel.document.project.markov["arms"].gap == 3.5
    assert panel.gap.value() == 3.5


def test_back_to_default_is_a_step_that_can_be_undone(panel):
    panel.gap.setValue(3.5)
    panel.back.click()
    assert panel.document.project.markov == {} and panel.heat.model is ARMS
    panel.document.undo()
    assert panel.document.project.markov["arms"].gap == 3.5


def test_states_are_added_and_removed_from_the_menu(panel):
    panel.session.place.set_layer("head")
    pick(panel.state_menu(1), "Remove fidget")
    assert [kind for _, kind in panel.heat.model.states] == ["gesture", "transition"]
    pick(panel.state_menu(-1), "Add state", "◆ fidget")
    assert [kind for _, kind in panel.heat.model.states] == ["gesture", "fidget", "transition"]
    assert not any(a.text() == "Add state" and a.isEnabled() for a in panel.state_menu(0).actions()), (
        "all are there"
    )
    panel.session.place.set_layer("arms")
    pick(panel.state_menu(8), "Remove both transition")
    assert len(panel.heat.model.states) == 8


def test_states_the_graph_has_no_action_for_are_dimmed_and_not_sampled(panel, toy):
    assert panel.heat.closed == frozenset()
    project = panel.document.project
    fidgets = [a.id for a in project.actions() if a.kind == "fidget"]
    panel.document.edit("Remove", lambda p: edits.remove_actions(p, fidgets))
    assert panel.heat.closed == {n for n, (_, kind) in enumerate(ARMS.states) if kind == "fidget"}
    assert {a.kind for a in panel.strip.acts["arms"]} <= {"gesture", "transition"}
    panel.session.place.set_layer("body")
    assert panel.heat.closed == frozenset(), "a layer without anything passes over nothing in particular"


def test_another_sample_is_another_minute_of_the_same_model(panel):
    first = panel.strip.acts["arms"]
    assert panel.strip.seconds == 60 and first
    panel.again.click()
    assert panel.strip.acts["arms"] != first
    assert panel.heat.model is ARMS


@pytest.mark.nightly
def test_what_was_learned_is_compared_with_what_was_seen(panel, reading, qtbot):
    made = apply_reading(panel.document.project, reading, LAYERS, True, "talk")
    panel.document.edit("Import annotation", lambda _: made.project)
    panel.show_imported(reading.observed, made.performance)
    assert panel.chooser.currentText() == "talk" and not panel.teach.isVisible()
    qtbot.waitUntil(lambda: panel.plot.found is not None and panel.plot.found.observed is not None)
    assert panel.plot.found.observed.count == 52
    assert panel.plot.words.text().startswith("The model makes each action about as often")
    panel.session.place.set_layer("head")
    assert panel.heat.model.tags == ("positive", "negative", "")
    assert panel.share_words.isVisible() and not panel.shares["positive"].isVisible()
    qtbot.waitUntil(lambda: panel.plot.found.model.layer == "head")
    panel.document.edit(
        "Never nod", lambda p: edits.set_markov(p, replace(p.markov["head"], matrix=((0.1, 0.1, 0.8),) * 3))
    )
    qtbot.waitUntil(
        lambda: (
            "Differs from what was seen: gesture, positive was 72 % of the actions, but the model makes 10 %."
            in panel.plot.words.text()
        )
    )


@pytest.mark.nightly
@pytest.mark.parametrize("wide", [440, 500, 560, 900])
def test_what_stands_under_bars_does_not_touch_however_narrow_the_plot(panel, qtbot, wide):
    qtbot.waitUntil(lambda: panel.plot.found is not None)
    alone = ComparePlot(panel.session)
    qtbot.addWidget(alone)
    alone.show_comparison(panel.plot.found)
    alone.resize(wide, 170)
    alone.show()
    qtbot.waitExposed(alone)
    assert ("▲LR" if wide > 800 else "LR") in {seen.painted.text for seen in seen_in(alone)}
    assert faults(alone) == []


def test_what_was_read_but_not_kept_can_be_compared_with_until_another_project_comes(panel, reading, toy):
    made = apply_reading(panel.document.project, reading, ("arms",), False, None)
    panel.document.edit("Import annotation", lambda _: made.project)
    panel.show_imported(reading.observed, None)
    assert panel.chooser.currentData() == IMPORTED and panel.chooser.currentText() == "the last import"
    panel.document.load(toy.project(), None)
    assert not panel.chooser.isVisible() and panel.imported == {}


def test_nothing_is_worked_out_while_the_panel_is_hidden(panel, qtbot):
    panel.hide()
    panel.document.edit("Edit", lambda p: edits.set_markov(p, replace(ARMS, gap=9.0)))
    assert panel.heat.model is ARMS
    panel.show()
    qtbot.waitUntil(lambda: panel.heat.model.gap == 9.0)


@pytest.mark.nightly
def test_both_themes_are_drawn(panel, qtbot):
    qtbot.waitUntil(lambda: panel.plot.found is not None)
    pictures = []
    for look in ("light", "dark"):
        panel.session.look.choose(look)
        pictures.append(panel.grab().toImage())
    assert pictures[0] != pictures[1]


# --- the plot's words


def test_states_are_told_apart_by_short_marks():
    marks = [shorten_state(state, "arms") for state in list_model_states(ARMS)]
    assert marks[:3] == ["▲L", "◆L", "➜L"] and len(set(marks)) == 9
    assert [
        shorten_state(("both", "gesture", tags), "head") for tags in ("", "positive", "negative", "calm")
    ] == [
        "▲",
        "▲+",
        "▲−",
        "▲ …",
    ]


def test_figures_are_said_in_words(reading):
    acts = reading.observed["arms"]
    found = compare_model(learn_model("arms", [acts]), [acts])
    assert describe_often(found, 2).startswith("right gesture: seen 28.8 %, made ")
    assert describe_long(found, 2).startswith("right gesture: seen 1.6 s (mostly 0.8 to 2.3), made ")
    assert describe_long(found, 7).startswith("rest between actions: seen ")
    alone = compare_model(ARMS, None)
    assert "in the long run" in describe_often(alone, 0) and "seen" not in describe_long(alone, 0)
    assert describe_model_fit(alone).startswith("Nothing to compare with yet")


def test_a_model_that_never_makes_what_was_seen_is_found_out(reading, qtbot):
    acts = reading.observed["head"]
    never = Markov("head", (("both", "gesture"), ("both", "transition")), ((1.0, 0.0), (1.0, 0.0)))
    found = compare_model(never, [acts])
    assert describe_model_fit(found).startswith("Differs from what was seen: ")
    plot = ComparePlot(StageSession(Document()))
    qtbot.addWidget(plot)
    plot.show_comparison(found)
    assert not plot.grab().isNull()


def test_it_fits_a_small_screens_panel_and_its_buttons_are_whole(panel):
    """In Talk at 1280 pixels it is about 700 wide."""
    assert panel.minimumSizeHint().width() <= 700
    for button in (panel.back, panel.learn):
        assert button.width() >= button.sizeHint().width()
