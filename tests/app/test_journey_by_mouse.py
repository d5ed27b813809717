"""Three errands with nothing but a real pointer, in a window as small as a laptop's: a base pose, a model, a
link of a state machine.
"""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF

from metagraph.graph.model import BasePose
from metagraph.playback.planning.markov import ARMS
from tests.app.pointer import DOWN, UP, choose, from_menu, middle_of, press
from tests.thorough import many

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture(params=["dark", "light"][: many(1, 2)])
def small(drive, sample, request):
    """The sample in a window of 1280 by 720, in the dark theme, and in both where asked to be thorough."""
    drive.window.resize(1280, 720)
    drive.session.look.choose(request.param)
    drive.document.load(sample, None)
    drive.files.opened.emit()
    drive.wait(lambda: len(drive.performance.shown.plan.layers["arms"].cues) > 1)
    drive.session.transport.set_playing(False)
    drive.settle()
    yield drive
    drive.session.look.choose("dark")


def undone(drive) -> bool:
    return drive.document.undo_stack.index() == 0


def undo(drive) -> None:
    """Take everything back, by the button in the header."""
    button = drive.header.widgetForAction(drive.shell.actions["undo"])
    assert button is not None and button.isVisible()
    while not undone(drive):
        step = drive.document.undo_stack.index()
        press(drive, middle_of(button), until=lambda s=step: drive.document.undo_stack.index() < s)


def scroll_to(drive, field) -> None:
    """Turn the wheel over what lies above a field until it is in sight."""
    page = field.parentWidget()
    for _ in range(20):
        if field.visibleRegion().boundingRect().height() >= field.height():
            return
        seen = page.visibleRegion().boundingRect()
        press(drive, (page, seen.topLeft() + QPoint(12, 8)), DOWN)
        drive.pause(60)
    raise AssertionError("the wheel does not bring the field into sight")


def test_the_base_pose_is_taken_from_a_clip_and_given_back(small):
    drive = small
    before = drive.document.project.base
    name = "hands_at_sides"
    entry = next(e for e in drive.document.project.clips.values() if name in e.name and e.id != before.clip)
    press(drive, middle_of(drive.library.search))
    drive.bot.keyClicks(drive.library.search, entry.name)
    drive.settle()
    choose(
        drive,
        drive.card(entry.name),
        "Use first frame as base pose",
        until=lambda: drive.document.project.base == BasePose(entry.id, 0),
    )
    choose(
        drive,
        drive.card(entry.name),
        "Use rest pose as base pose",
        until=lambda: drive.document.project.base == BasePose(),
    )
    drive.wait(lambda: any(p.code.startswith("base-") for p in drive.problems.problems))
    undo(drive)
    assert drive.document.project.base == before
    drive.wait(lambda: not any(p.code.startswith("base-") for p in drive.problems.problems))


def cell(heat, row: int, column: int) -> tuple:
    return heat, heat.grid().cell(row, column).center().toPoint()


@pytest.mark.nightly
def test_a_model_is_changed_by_a_drag_on_its_map_loses_a_state_and_goes_back(small):
    drive = small
    drive.workspaces.show("models")
    drive.wait(lambda: drive.models.heat.isVisible() and drive.models.heat.model is not None)
    drive.settle()
    heat = drive.models.heat
    row = int(np.argmax([max(r) < 0.5 for r in ARMS.matrix]))
    column = int(np.argmax(ARMS.matrix[row]))
    widget, at = cell(heat, row, column)
    known = lambda: drive.document.project.markov.get("arms")  # noqa: E731
    drive.drag((widget, at), (widget, at - QPoint(0, 40)), lambda: known() is not None)
    drive.wait(lambda: drive.document.undo_stack.count() == 1)
    changed = known().matrix[row]
    assert changed[column] > ARMS.matrix[row][column] + 0.1 and sum(changed) == pytest.approx(1.0)
    count = len(ARMS.states)
    choose(drive, cell(heat, count - 1, 0), "Remove", until=lambda: len(known().states) == count - 1)
    assert all(sum(r) == pytest.approx(1.0) for r in known().matrix)
    press(drive, middle_of(drive.models.back), until=lambda: known() is None)
    undo(drive)
    assert known() is None and drive.models.model() is ARMS


@pytest.mark.nightly
def test_a_link_is_drawn_between_two_states_blended_by_the_wheel_and_taken_away(small):
    drive = small
    from_menu(
        drive,
        "Graph",
        "Manual state machine",
        until=lambda: drive.session.onstage.mode == "manual" and drive.editor.isVisible(),
    )
    drive.settle()
    canvas = drive.editor.canvas
    layer = drive.session.place.layer

    def machine():
        return drive.document.project.manual.get(layer)

    def at(x: float, y: float) -> tuple:
        point = canvas.view.to(QPointF(x, y))
        return canvas, QPoint(round(point.x()), round(point.y()))

    arms = drive.document.project.graphs["arms"]
    loop = next(a for a in arms.actions.values() if a.kind == "stance")
    gesture = next(a for a in arms.actions.values() if a.kind == "gesture" and a.stance == loop.stance)
    clips = [drive.document.project.clips[a.clip].name for a in (loop, gesture)]
    for n, clip in enumerate(clips):
        drive.drag(
            drive.card(clip),
            (canvas, QPoint(round(canvas.width() * (0.1 + 0.42 * n)), canvas.height() // 2)),
            lambda n=n: machine() is not None and len(machine().states) == n + 1,
        )
        drive.settle()
    source, target = machine().states
    boxes = canvas.scene().nodes
    edge, middle = boxes[source], boxes[target].center()
    drive.drag(
        at(edge.right() - 4, edge.center().y() + 8),
        at(middle.x(), middle.y()),
        lambda: len(machine().links) == 1,
    )
    (link,) = machine().links.values()
    assert (link.source, link.target) == (source, target)
    between = (edge.center() + middle) / 2
    press(drive, at(between.x(), between.y()), until=lambda: drive.session.selection.links == (link.id,))
    drive.settle()
    blend = drive.editor.inspector.blend
    scroll_to(drive, blend)
    press(drive, middle_of(blend), until=blend.hasFocus)
    press(drive, middle_of(blend), UP, until=lambda: machine().links[link.id].blend > link.blend)
    undo(drive)
    assert machine() is None or not machine().states
