"""The heat map: where cells are, what they say, and editing them with mouse and keys."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest

from app.features.models.heatmap import (
    DRAG,
    HEAD,
    INKS,
    SIDE,
    HeatMap,
    choose_ink,
    describe_matrix_cell,
    fit_grid,
    format_percent,
    measure_contrast,
    shade,
)
from app.look.theme import DARK, LIGHT
from metagraph.graph.model import KINDS, Markov
from metagraph.playback.learning.learn import with_cell
from metagraph.playback.planning.markov import ARMS, DEFAULTS


@pytest.mark.parametrize("count", [1, 3, 9, 18])
def test_every_cell_is_found_where_it_is_drawn_and_heads_beside_them(count):
    cells = fit_grid(count, 700, 300)
    for row in range(count):
        assert cells.at(QPointF(SIDE / 2, cells.cell(row, 0).center().y())) == (row, -1)
        assert cells.at(QPointF(cells.cell(0, row).center().x(), HEAD / 2)) == (-1, row)
        for column in range(count):
            assert cells.at(cells.cell(row, column).center()) == (row, column)
    assert cells.at(QPointF(5, 5)) is None
    assert cells.at(QPointF(-3, 100)) is None
    assert cells.at(cells.cell(count - 1, count - 1).bottomRight() + QPointF(2, 2)) is None


def test_numbers_are_short_and_nothing_is_a_dot():
    assert [format_percent(p) for p in (0, 0.001, 0.0049, 0.005, 0.126, 0.5, 0.999, 1)] == [
        "·",
        "<1",
        "<1",
        "0",
        "13",
        "50",
        "100",
        "100",
    ]


def test_a_cell_is_said_in_a_sentence():
    tagged = Markov(
        "head", (("both", "gesture"), ("both", "gesture")), ((0.5, 0.5), (1, 0)), tags=("", "positive")
    )
    for model, layer, row, column, *pieces in (
        (ARMS, "arms", 0, 4, "left gesture", "right fidget", "never"),
        (ARMS, "arms", 0, 3, "left gesture", "right gesture", "12.5 %"),
        (ARMS, "arms", 0, 0, "left gesture", "the same", "25 %"),
        (ARMS, "arms", 8, 8, "transition of both arms", "the same", "60 %"),
        (ARMS, "arms", 5, 2, "right transition", "left transition", "always"),
        (tagged, "head", 0, 1, "a gesture", "a positive gesture", "50 %"),
        (tagged, "head", 1, 1, "a positive gesture", "the same", "never"),
    ):
        words = describe_matrix_cell(model, layer, row, column)
        places = [words.find(piece) for piece in pieces]
        assert -1 not in places and places[0] < places[1], words


@pytest.mark.parametrize("look", [DARK, LIGHT], ids=lambda t: t.name)
def test_numbers_can_be_read_on_every_shade_of_every_kind(look):
    ground = QColor(look.field)
    for kind in KINDS:
        shades = [shade(look.fill(kind), ground, p / 50) for p in range(51)]
        assert shades[0] == ground
        assert all(measure_contrast(choose_ink(fill), fill) >= 4.5 for fill in shades)
        steps = [measure_contrast(fill, ground) for fill in shades]
        assert steps == sorted(steps), "more is more"
        assert measure_contrast(shades[1], ground) > 1.09, "two percent can be told from nothing"
    assert {choose_ink(QColor(c)).name() for c in ("#000000", "#ffffff")} == set(INKS)


@pytest.fixture
def heat(qtbot):
    """A heat map whose edits are taken over as the panel would."""
    widget = HeatMap()
    qtbot.addWidget(widget)
    widget.resize(760, 320)
    widget.show_model(ARMS, "arms", "dark")
    widget.show()
    qtbot.waitExposed(widget)
    widget.edits, widget.said = [], []

    def take(row, column, p, dragging):
        widget.edits.append((row, column, p, dragging))
        if dragging:
            widget.show_model(with_cell(ARMS, row, column, p), "arms", "dark")

    widget.edited.connect(take)
    widget.pointed.connect(widget.said.append)
    widget.activateWindow()
    widget.setFocus()
    yield widget


def at(heat, row, column, dy=0) -> QPoint:
    return heat.grid().cell(row, column).center().toPoint() + QPoint(0, dy)


def test_dragging_up_makes_more_likely_and_down_less_and_the_last_tells_that_it_is_over(heat):
    QTest.mousePress(heat, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at(heat, 0, 0))
    QTest.mouseMove(heat, at(heat, 0, 0, -2))
    assert heat.edits == [], "a click that trembles is no drag"
    for dy in (-16, -32, 400, -4000):
        QTest.mouseMove(heat, at(heat, 0, 0, dy))
    QTest.mouseRelease(heat, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at(heat, 0, 0))
    assert [e[2:] for e in heat.edits] == [(0.35, True), (0.45, True), (0.0, True), (1.0, True), (1.0, False)]
    assert DRAG == 160
    assert {e[:2] for e in heat.edits} == {(0, 0)}


def test_a_click_only_chooses_a_cell(heat):
    QTest.mouseClick(heat, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at(heat, 3, 1))
    assert heat.edits == [] and heat.current == (3, 1)
    QTest.mouseClick(heat, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, QPoint(20, 100))
    assert heat.current == (3, 1), "a head is no cell"


def test_escape_gives_a_drag_up(heat):
    given_up = []
    heat.cancelled.connect(lambda: given_up.append(True))
    QTest.mousePress(heat, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at(heat, 1, 1))
    QTest.mouseMove(heat, at(heat, 1, 1, -50))
    QTest.keyClick(heat, Qt.Key.Key_Escape)
    count = len(heat.edits)
    QTest.mouseMove(heat, at(heat, 1, 1, -90))
    QTest.mouseRelease(heat, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at(heat, 1, 1))
    assert given_up == [True] and len(heat.edits) == count == 1


def test_arrows_go_from_cell_to_cell_and_signs_change_by_one_percent(heat, qtbot):
    qtbot.waitUntil(heat.hasFocus)
    for key in (Qt.Key.Key_Left, Qt.Key.Key_Up, Qt.Key.Key_Right, Qt.Key.Key_Down, Qt.Key.Key_Down):
        QTest.keyClick(heat, key)
    assert heat.current == (2, 1)
    assert heat.said[-1] == describe_matrix_cell(ARMS, "arms", 2, 1)
    QTest.keyClicks(heat, "+-")
    assert heat.edits == [(2, 1, 0.21, False), (2, 1, 0.19, False)]
    for _ in range(20):
        QTest.keyClick(heat, Qt.Key.Key_Right)
        QTest.keyClick(heat, Qt.Key.Key_Down)
    assert heat.current == (8, 8)


@pytest.mark.parametrize(
    ("typed", "p"), [("4", 0.04), ("37.5", 0.375), ("12,5", 0.125), ("100", 1.0), ("0", 0.0)]
)
def test_a_number_is_typed_over(heat, qtbot, typed, p):
    qtbot.waitUntil(heat.hasFocus)
    QTest.keyClick(heat, typed[0])
    assert heat.field.isVisible()
    QTest.keyClicks(heat.field, typed[1:])
    QTest.keyClick(heat.field, Qt.Key.Key_Return)
    assert heat.edits == [(0, 0, pytest.approx(p), False)]
    assert not heat.field.isVisible()


@pytest.mark.parametrize("typed", ["101", "abc", "-3", "", "1e9", "nan"])
def test_what_is_no_percentage_changes_nothing(heat, qtbot, typed):
    qtbot.waitUntil(heat.hasFocus)
    QTest.keyClick(heat, Qt.Key.Key_Return)
    assert heat.field.text() == "25"
    QTest.keyClicks(heat.field, typed) if typed else heat.field.clear()
    QTest.keyClick(heat.field, Qt.Key.Key_Return)
    assert heat.edits == []


def test_escape_leaves_what_was_typed_and_a_double_click_opens_the_field(heat, qtbot):
    QTest.mouseDClick(heat, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at(heat, 4, 1))
    assert heat.field.isVisible() and heat.field.text() == "42.9"
    QTest.keyClicks(heat.field, "7")
    QTest.keyClick(heat.field, Qt.Key.Key_Escape)
    assert heat.edits == [] and not heat.field.isVisible()


def test_the_pointer_says_what_it_points_at(heat):
    QTest.mouseMove(heat, at(heat, 0, 3))
    assert heat.said[-1] == describe_matrix_cell(ARMS, "arms", 0, 3)
    QTest.mouseMove(heat, QPoint(20, round(heat.grid().cell(1, 0).center().y())))
    assert "left fidget" in heat.said[-1] and "1 to 3 s" in heat.said[-1]
    heat.show_model(DEFAULTS["head"], "head", "light", frozenset({1}))
    QTest.mouseMove(heat, QPoint(21, round(heat.grid().cell(1, 0).center().y())))
    assert "1 to 3 s" in heat.said[-1] and "skipped" in heat.said[-1]


def test_another_model_of_fewer_states_leaves_no_cell_outside_of_it(heat):
    heat.current = heat.hovered = (8, 8)
    heat.show_model(DEFAULTS["head"], "head", "dark")
    assert heat.current == (0, 0) and heat.hovered is None
    heat.grab()


@pytest.mark.parametrize("tags", ["", "positive", "very positive indeed and more"])
@pytest.mark.parametrize("size", [(120, 60), (300, 200), (1400, 900)])
def test_it_is_drawn_at_any_size_with_any_tags(heat, size, tags):
    heat.resize(*size)
    heat.show_model(
        Markov("arms", ARMS.states, ARMS.matrix, tags=(tags,) * 9, lengths=((1, 0.5),) * 9),
        "arms",
        "light",
        frozenset({0, 8}),
    )
    assert not heat.grab().isNull()
