"""Where nodes and arrows are, what is under a point, and the automatic layout; without a window."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPointF, QRectF, QSizeF

from app.features.manual.arranging import arrange_nodes
from app.features.manual.manual_scene import (
    ANY_NODE,
    LOOP,
    NODE,
    NOTHING,
    ManualHit,
    ManualScene,
    ManualView,
    fit_view,
)
from metagraph.graph.manual.machine import ANY, Link, Manual, State


def machine(places: dict[str, tuple[float, float]], *links: str, start: str | None = None) -> Manual:
    """States by id, links as "a>b" with ids l0, l1, ..."""
    states = {i: State(i, "c1", i, "arms", x=x, y=y) for i, (x, y) in places.items()}
    drawn = {f"l{n}": Link(f"l{n}", *text.split(">")) for n, text in enumerate(links)}
    return Manual("arms", states, drawn, start or next(iter(states), None), any_x=-900, any_y=-900)


FAR = {"a": (0.0, 0.0), "b": (600.0, 0.0), "c": (600.0, 400.0)}


def test_an_empty_machine_has_the_node_for_any_state_alone() -> None:
    scene = ManualScene(Manual("arms"))
    assert list(scene.nodes) == [ANY]
    assert scene.bounds.size() == ANY_NODE
    assert scene.lines.shape == (0, 4)
    assert scene.hit(QPointF(5000, 5000), 1.0) == NOTHING


def test_an_arrow_goes_from_border_to_border() -> None:
    scene = ManualScene(machine(FAR, "a>b"))
    x1, y1, x2, y2 = scene.lines[0]
    assert (x1, y1, y2) == (NODE.width(), NODE.height() / 2, NODE.height() / 2)
    assert 600 - 4 < x2 < 600


def test_arrows_there_and_back_lie_side_by_side() -> None:
    scene = ManualScene(machine(FAR, "a>b", "b>a"))
    assert scene.lines[0, 1] == pytest.approx(scene.lines[0, 3])
    assert abs(scene.lines[0, 1] - scene.lines[1, 1]) > 8


def test_parallel_arrows_of_one_direction_lie_side_by_side() -> None:
    heights = ManualScene(machine(FAR, "a>b", "a>b", "a>b")).lines[:, 1]
    assert len({round(y) for y in heights}) == 3
    assert heights.mean() == pytest.approx(NODE.height() / 2)


def test_nodes_on_top_of_each_other_are_joined_all_the_same() -> None:
    scene = ManualScene(machine({"a": (0, 0), "b": (20, 10), "c": (0, 0)}, "a>b", "a>c"))
    assert np.isfinite(scene.lines).all()


def test_a_node_is_hit_inside_and_at_its_border_where_links_begin() -> None:
    scene = ManualScene(machine(FAR, "a>b"))
    assert scene.hit(QPointF(90, 30), 1.0) == ManualHit("node", "a")
    assert scene.hit(QPointF(3, 30), 1.0) == ManualHit("edge", "a")
    assert scene.hit(QPointF(NODE.width() + 2, 30), 1.0) == ManualHit("edge", "a")
    assert scene.hit(QPointF(-850, -880), 1.0).ident == ANY


def test_zoomed_far_out_a_node_keeps_a_middle_to_be_moved_by() -> None:
    assert ManualScene(machine(FAR)).hit(QPointF(90, 30), 0.1) == ManualHit("node", "a")


def test_the_nearest_arrow_within_reach_is_hit() -> None:
    scene = ManualScene(machine(FAR, "a>b", "a>c"))
    assert scene.hit(QPointF(400, 33), 1.0) == ManualHit("link", "l0")
    assert scene.hit(QPointF(400, 60), 1.0) == NOTHING
    assert scene.hit(scene.middle("l1"), 1.0) == ManualHit("link", "l1")


def test_an_arrow_back_to_its_own_node_is_a_circle_that_can_be_hit() -> None:
    scene = ManualScene(machine(FAR, "a>a", "a>a"))
    first, second = scene.loops.values()
    assert first != second
    assert scene.hit(first.center() + QPointF(0, -LOOP), 1.0) == ManualHit("link", "l0")
    assert scene.middle("l0").y() == first.top()


def test_links_to_what_is_not_there_are_not_drawn() -> None:
    scene = ManualScene(machine(FAR, "a>gone", "gone>gone"))
    assert len(scene.lines) == 0
    assert scene.loops == {}


def test_a_rubber_band_takes_nodes_it_touches_else_arrows_it_holds() -> None:
    scene = ManualScene(machine(FAR, "a>b", "b>c"))
    assert scene.inside(QRectF(-10, -10, 60, 60)) == (("a",), ())
    assert scene.inside(QRectF(NODE.width() - 1, -50, 10, 10)) == ((), ())
    assert scene.inside(QRectF(202, 20, 390, 24)) == ((), ("l0",))


def test_moved_nodes_take_their_arrows_along() -> None:
    scene = ManualScene(machine(FAR, "a>b"), {"b": (600.0, 300.0)})
    assert scene.lines[0, 3] > 250
    assert scene.touching({"b"}) == ("l0",)


def test_zooming_leaves_what_is_under_the_mouse_where_it_is() -> None:
    view, at = ManualView(0.7, 40, -20), QPointF(300, 200)
    for factor in (1.3, 0.5, 100.0, 0.0001):
        after = view.zoomed(factor, at)
        assert (after.back(at) - view.back(at)).manhattanLength() < 1e-6
        assert 0.08 <= after.scale <= 2


def test_fitting_shows_all_and_never_enlarges() -> None:
    rect, size = QRectF(-500, 200, 4000, 900), QSizeF(900, 600)
    assert fit_view(rect, size).rect(size).contains(rect)
    assert fit_view(QRectF(0, 0, 10, 10), size).scale == 1.0


# --- automatic layout


def overlaps(places: dict[str, tuple[float, float]]) -> int:
    boxes = [QRectF(QPointF(*at), NODE) for i, at in places.items()]
    return sum(a.intersects(b) for n, a in enumerate(boxes) for b in boxes[:n])


def test_an_empty_machine_is_arranged() -> None:
    assert set(arrange_nodes(Manual("arms"))) == {ANY}


def test_states_stand_in_columns_from_the_start_on() -> None:
    places = arrange_nodes(machine(dict.fromkeys("dcba", (0.0, 0.0)), "a>b", "b>c", "c>a", "c>d", start="a"))
    assert places["a"][0] < places["b"][0] < places["c"][0] < places["d"][0]


def test_no_two_nodes_overlap_however_many_there_are() -> None:
    names = [f"n{i}" for i in range(152)]
    links = (
        [f"n0>{n}" for n in names[1:100]]
        + [f"{n}>n0" for n in names[1:100]]
        + ["n3>n120", "n140>n141", "n141>n140"]
    )
    places = arrange_nodes(machine(dict.fromkeys(names, (0.0, 0.0)), *links))
    assert overlaps(dict(places)) == 0
    assert len(places) == 153
    wide = max(x for x, _ in places.values()) - min(x for x, _ in places.values())
    high = max(y for _, y in places.values()) - min(y for _, y in places.values())
    assert 0.8 < wide / high < 4


def test_arrows_cross_less_than_in_the_order_of_placing() -> None:
    links = ["s>a", "s>b", "s>c", "a>f", "b>e", "c>d"]
    places = arrange_nodes(machine(dict.fromkeys("sabcdef", (0.0, 0.0)), *links))
    order = {i: places[i][1] for i in "abcdef"}
    assert [order["a"] < order["b"], order["b"] < order["c"]] == [
        order["f"] < order["e"],
        order["e"] < order["d"],
    ]


def test_what_cannot_be_reached_stands_after_all_else() -> None:
    places = arrange_nodes(machine(dict.fromkeys("abxy", (0.0, 0.0)), "a>b", "x>y"))
    assert places["b"][0] < places["x"][0] < places["y"][0]


def test_a_link_from_any_state_brings_its_target_near_the_start() -> None:
    places = arrange_nodes(machine(dict.fromkeys("abx", (0.0, 0.0)), "a>b", f"{ANY}>x"))
    assert places["x"][0] == places["b"][0]
