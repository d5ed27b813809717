"""Actions listed elsewhere in their node: by a drag, by keys, from the menu."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF, Qt

from app.features.graph.graph_drops import drop_at, perform_drop
from app.features.graph.graph_layout import GraphHit
from app.project.load import Load
from metagraph.graph import edits

ALT = Qt.KeyboardModifier.AltModifier


def names(project, stance):
    return [a.name for a in project.graphs["arms"].of(stance, "gesture")]


@pytest.fixture
def many(toys, toy):
    """Four gestures in one node."""
    stance = toys.action("rest beat lf").stance
    loaded = [(f"n/{n}.bvh", 0, "", toy.clip(f"g{n}")) for n in range(3)]
    toys.document.edit("Add", lambda p: edits.add_clips(p, loaded))
    known = {e.name: e.id for e in toys.document.project.clips.values()}
    clips = [known[f"g{n}"] for n in range(3)]
    toys.document.edit("Place", lambda p: edits.place_clips(p, clips, "arms", "gesture", stance))
    toys.session.place.set_stance(stance)
    toys.stance = stance
    toys.ids = {a.name: a.id for a in toys.document.project.graphs["arms"].of(stance, "gesture")}
    toys.order = lambda: names(toys.document.project, stance)
    return toys


def row_end(drive, action, lower: bool):
    rect = drive.canvas.layout_now().row(action).rect
    columns = drive.canvas.layout_now().nodes["gesture"].columns
    x = rect.left() + rect.width() * (0.5 if columns == 1 else 0.9 if lower else 0.1)
    y = rect.top() + rect.height() * (0.5 if columns > 1 else 0.9 if lower else 0.1)
    return drive.canvas, QPointF(x, y).toPoint()


@pytest.mark.nightly
@pytest.mark.gl
def test_a_row_is_dragged_in_front_of_another_and_undone(many):
    before = many.order()
    assert before[-3:] == ["g0", "g1", "g2"]
    many.drag(many.row(many.ids["g2"]), row_end(many, many.ids["g0"], False), lambda: many.order() != before)
    assert many.order()[-3:] == ["g2", "g0", "g1"]
    many.key(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert many.order() == before


def test_alt_and_arrows_move_what_is_selected_and_it_stays_selected(many):
    many.session.selection.select_actions((many.ids["g1"],))
    many.window.refresh()
    many.canvas.setFocus()
    many.key(Qt.Key.Key_Up, ALT, many.canvas)
    assert many.order()[-3:] == ["g1", "g0", "g2"]
    many.key(Qt.Key.Key_Down, ALT, many.canvas)
    many.key(Qt.Key.Key_Down, ALT, many.canvas)
    assert many.order()[-3:] == ["g0", "g2", "g1"] and many.session.selection.actions == (many.ids["g1"],)


def test_what_a_drop_in_its_own_node_would_do_is_said(many):
    project, stance = many.document.project, many.stance
    first = many.order()[0]
    g0, g1, g2 = (many.ids[f"g{n}"] for n in range(3))

    def at(hit, *actions):
        return drop_at(project, "arms", stance, None, hit, Load(actions=actions))

    assert at(GraphHit("row", g2, "gesture"), g0).words.endswith("before *g2*")
    assert at(GraphHit("row", g2, "gesture", True), g0).words == "move this action to the end"
    assert at(GraphHit("node", None, "gesture"), g0, g1).words == "move 2 actions to the end"
    assert at(GraphHit("row", many.ids[first], "gesture"), g1).words == "move this action to the start"
    for hit in (
        GraphHit("row", g1, "gesture"),
        GraphHit("row", g0, "gesture"),
        GraphHit("row", g0, "gesture", True),
    ):
        assert not at(hit, g0).possible, "it is there already"
    assert not at(GraphHit("node", None, "fidget"), g0).reorder, "another node takes it"
    drop = at(GraphHit("row", g0, "gesture"), g2, g1)
    assert names(perform_drop(project, "arms", drop, Load(actions=(g2, g1))), stance)[-3:] == [
        "g1",
        "g2",
        "g0",
    ]


def test_the_row_under_the_pointer_says_before_or_behind(many):
    layout = many.canvas.layout_now()
    rect = layout.row(many.ids["g1"]).rect
    columns = layout.nodes["gesture"].columns
    step = QPointF(rect.width() * 0.4, 0) if columns > 1 else QPointF(0, rect.height() * 0.4)
    hits = [layout.hit(rect.center() + way * step, dragging=True) for way in (-1, 1)]
    assert [h.behind for h in hits] == [False, True] and {h.ident for h in hits} == {many.ids["g1"]}
    assert not layout.hit(rect.center(), dragging=False).behind
