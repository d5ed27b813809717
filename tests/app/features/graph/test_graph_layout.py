"""Where everything on the canvas is, at any size, and what lies under a point."""

from __future__ import annotations

from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PySide6.QtCore import QPointF, QRectF, QSizeF

from app.features.graph.graph_layout import (
    describe_hole,
    lay_out_canvas,
    measure_bar_part,
    read_likelihood_at,
)
from metagraph.graph import edits
from metagraph.graph.model import Project

SIZES = [
    (1, 1),
    (460, 420),
    (640, 480),
    (700, 900),
    (960, 700),
    (1200, 500),
    (1920, 1080),
    (3840, 2160),
    (460, 2000),
    (4000, 420),
]


@pytest.fixture(scope="module")
def crowded(toy):
    """Fourteen stances, one of them with very many actions."""
    project = toy.project()
    clips = list(project.clips)
    for n in range(11):
        project = edits.add_stance(project, "arms", f"a stance with a long name {n}")
    rest, up = toy.id(project, "rest"), toy.id(project, "up")
    for _ in range(40):
        project = edits.place_clips(project, clips, "arms", "gesture", rest)
    project = edits.place_clips(project, clips, "arms", "fidget", rest)
    for _ in range(4):
        project = edits.place_clips(project, clips, "arms", "transition", rest, up)
    return project


def boxes(layout) -> dict[str, QRectF]:
    found = {f"node {kind}": node.rect for kind, node in layout.nodes.items()}
    found["card"] = layout.card
    found |= {f"chip {n}": chip.rect for n, chip in enumerate(layout.chips)}
    if not layout.foot.isEmpty():  # in a narrow room rows go before the sentence
        found["foot"] = layout.foot
    return found


def check(layout) -> None:
    for (a, first), (b, second) in combinations(boxes(layout).items(), 2):
        both = first.intersected(second)
        assert both.width() < 0.5 or both.height() < 0.5, f"{a} lies on {b} at {layout.size}"
    for name, rect in boxes(layout).items():
        assert rect.width() > 0, name
        assert rect.height() > 0, name
        assert rect.left() >= 0, name
        assert rect.right() <= layout.size.width() + 0.5, name
    for node in layout.nodes.values():
        for row in node.rows:
            assert node.rect.contains(row.rect), f"a row sticks out of its {node.kind} node at {layout.size}"
            assert row.rect.contains(row.bar)
            assert row.rect.top() >= node.header.bottom() - 0.5
        for one, other in combinations(node.rows[:12], 2):
            assert not one.rect.adjusted(0.1, 0.1, -0.1, -0.1).intersects(other.rect)


def test_an_empty_project_has_a_card_three_nodes_and_a_plus():
    layout = lay_out_canvas(Project(), "arms", None, QSizeF(900, 700))
    assert list(layout.nodes) == ["gesture", "fidget", "transition"]
    assert [chip.stance for chip in layout.chips] == [None]
    assert layout.hit(layout.card.center()).area == "card"
    assert layout.hit(layout.card.center(), dragging=True).area == "card", (
        "without a stance there is no loop to add"
    )


@pytest.mark.parametrize("size", SIZES)
def test_nothing_overlaps_at_any_size(toy, crowded, size):
    for project in (Project(), toy.project()):
        stance = next(iter(project.graphs["arms"].stances), None)
        check(lay_out_canvas(project, "arms", stance, QSizeF(*size)))


@pytest.mark.parametrize("size", [s for s in SIZES if s[1] >= 700])
def test_many_stances_and_actions_still_fit(toy, crowded, size):
    for stance in crowded.graphs["arms"].stances:
        check(lay_out_canvas(crowded, "arms", stance, QSizeF(*size)))


@pytest.mark.nightly
@settings(max_examples=80, deadline=None)
@given(width=st.floats(1, 5000), height=st.floats(1, 4000))
def test_nothing_overlaps_at_sizes_nobody_thought_of(toy, width, height):
    project = toy.project()
    check(lay_out_canvas(project, "arms", toy.id(project, "rest"), QSizeF(width, height)))


@pytest.mark.parametrize("size", SIZES)
def test_what_is_drawn_is_what_is_hit(toy, size):
    project = toy.project()
    layout = lay_out_canvas(project, "arms", toy.id(project, "rest"), QSizeF(*size))
    for chip in layout.chips:
        hit = layout.hit(chip.rect.center())
        assert (hit.area, hit.ident) == (("chip", chip.stance) if chip.stance else ("add", None))
    for kind, node in layout.nodes.items():
        for row in node.rows:
            on_name, on_bar = QPointF(row.rect.left() + 34, row.rect.center().y()), row.bar.center()
            assert (layout.hit(on_name).area, layout.hit(on_name).ident, layout.hit(on_name).kind) == (
                "row",
                row.action.id,
                kind,
            )
            assert (layout.hit(on_bar).area, layout.hit(on_bar).ident) == ("bar", row.action.id)
            assert layout.row(row.action.id) is row
        at = QPointF(node.header.left() + 20, node.header.center().y())
        assert (layout.hit(at).area, layout.hit(at).kind) == ("node", kind)
    other = layout.nodes["transition"].other.center()
    assert layout.hit(other).area == "other"
    assert layout.hit(other, dragging=True).area == "node", "a drop there is a drop on the node"
    assert layout.hit(layout.loops.center(), dragging=True).area == "loop"
    assert layout.hit(QPointF(layout.card.center().x(), layout.card.top() + 5), dragging=True).area == "card"
    assert layout.hit(QPointF(-5, -5)).area == "nothing"
    assert layout.row("nobody") is None


def test_every_row_can_be_scrolled_into_sight_and_no_further(crowded, toy):
    stance = toy.id(crowded, "rest")
    size = QSizeF(900, 700)
    first = lay_out_canvas(crowded, "arms", stance, size)
    for kind, node in first.nodes.items():
        seen = set()
        for scroll in range(node.most + 1):
            seen |= {
                row.action.id
                for row in lay_out_canvas(crowded, "arms", stance, size, {kind: scroll}).nodes[kind].rows
            }
        assert seen == {a.id for a in crowded.graphs["arms"].of(stance, kind)}
        far = lay_out_canvas(crowded, "arms", stance, size, {kind: 10**6}).nodes[kind]
        assert far.scroll == far.most
        assert far.rows, "scrolled to the end, the last rows are in sight"
        assert far.rows[-1].action is crowded.graphs["arms"].of(stance, kind)[-1]


def test_the_worst_hole_is_named_first(toy):
    project = edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a"))])
    clip = next(iter(project.clips))
    project = edits.add_stance(project, "arms", "one")
    one = toy.id(project, "one")
    assert describe_hole(project, "arms", one) == "no loop"
    project = edits.place_clips(project, [clip], "arms", "stance", one)
    assert describe_hole(project, "arms", one) == "no gestures"
    project = edits.place_clips(project, [clip], "arms", "gesture", one)
    assert describe_hole(project, "arms", one) == "no fidgets"
    project = edits.place_clips(project, [clip], "arms", "fidget", one)
    assert describe_hole(project, "arms", one) == ""
    project = edits.add_stance(project, "arms", "two", [clip])
    assert describe_hole(project, "arms", one) == "no transition out"


@pytest.mark.parametrize("wide", [232, 300, 460])
def test_in_a_narrow_room_no_chip_is_wider_than_it_and_names_go_before_what_is_missing(toy, wide):
    project = edits.add_stance(toy.project(), "arms", "sits on a chair with arms crossed")
    layout = lay_out_canvas(project, "arms", toy.id(project, "rest"), QSizeF(wide, 1400))
    for chip in layout.chips:
        assert chip.rect.right() <= layout.size.width() - 10
        assert not chip.words or len(f"{chip.name}{chip.words}") * 7 < chip.rect.width()


def test_chips_count_what_their_stance_holds(toy):
    project = toy.project()
    chips = {
        c.name: c for c in lay_out_canvas(project, "arms", toy.id(project, "rest"), QSizeF(1200, 800)).chips
    }
    assert chips["rest"].count == 4 + 2 + 1
    assert chips["far"].words == "no gestures"


def test_a_bar_shows_what_is_set_on_it(toy):
    project = toy.project()
    row = lay_out_canvas(project, "arms", toy.id(project, "rest"), QSizeF(1200, 800)).nodes["gesture"].rows[0]
    values = [n / 10 for n in range(1, 31)]
    for value in values:
        x = row.bar.left() + measure_bar_part(value) * row.bar.width()
        assert read_likelihood_at(row, x) == value
    assert read_likelihood_at(row, -1e6) == 0.1
    assert read_likelihood_at(row, 1e6) == 3.0
    parts = [measure_bar_part(v) for v in values]
    assert parts == sorted(parts)
    assert measure_bar_part(1.0) == pytest.approx(0.5), "the usual likelihood stands in the middle"
    assert (measure_bar_part(0.0), measure_bar_part(100.0)) == (0.0, 1.0)


@pytest.mark.nightly
def test_ten_thousand_actions_lay_out_only_what_is_in_sight(toy):
    project = toy.project()
    rest, clips = toy.id(project, "rest"), [next(iter(project.clips))] * 10_000
    project = edits.place_clips(project, clips, "arms", "gesture", rest)
    node = lay_out_canvas(project, "arms", rest, QSizeF(1200, 800)).nodes["gesture"]
    assert node.count == 10_004
    assert 0 < len(node.rows) < 60


def test_the_pointer_on_a_node_says_what_its_kind_means(toy):
    from app.features.graph.graph_layout import GraphHit
    from app.features.graph.graph_words import describe_graph_hit

    layout = lay_out_canvas(toy.project(), "arms", None, QSizeF(960, 700))
    said = {
        kind: describe_graph_hit(toy.project(), layout, GraphHit("node", None, kind), None, {})
        for kind in ("gesture", "fidget", "transition")
    }
    assert "accompanies speech" in said["gesture"] and "without meaning" in said["fidget"]
    assert "ends in another" in said["transition"]


def test_names_of_stances_are_not_cut_where_that_saves_no_line(toy):
    project = toy.project()
    for name in ("arms crossed in front of the body", "hands clasped behind the body"):
        project = edits.add_stance(project, "arms", name)
    low = QSizeF(800, 300)
    chips = [c for c in lay_out_canvas(project, "arms", None, low).chips if c.stance]
    assert len({c.rect.top() for c in chips}) == 1
    wide = {c.name: c.rect.width() for c in chips}
    assert wide["hands clasped behind the body"] > wide["up"], "each as wide as its name"
    narrow = [c for c in lay_out_canvas(project, "arms", None, QSizeF(600, 300)).chips if c.stance]
    assert len({round(c.rect.width()) for c in narrow}) == 1, "as many in a line as can be told apart"
