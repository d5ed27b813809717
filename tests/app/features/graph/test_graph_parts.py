"""An edit paints the parts of the canvas that it shows in, and no others."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QSizeF

from app.features.graph.graph_layout import lay_out_canvas
from app.features.graph.graph_look import GraphLook
from app.features.graph.graph_parts import find_stale_region, list_graph_parts
from app.look.theme import get_theme
from metagraph.graph import edits
from metagraph.graph.model import Project


@pytest.fixture
def project(toy) -> Project:
    return toy.project()


def parts(project: Project, stance: str, size: tuple[int, int] = (900, 700), **look):
    layout = lay_out_canvas(project, "arms", stance, QSizeF(*size))
    return layout, list_graph_parts(layout, GraphLook(get_theme(look.pop("theme", "dark")), project, **look))


def gesture(project: Project, stance: str):
    return project.graphs["arms"].of(stance, "gesture")[0]


def test_nothing_is_painted_for_a_timing_that_the_canvas_does_not_show(project, toy):
    rest = toy.id(project, "rest")
    one = gesture(project, rest)
    after = edits.update_actions(project, (one.id,), timing={"blend_in": 0.123})
    assert find_stale_region(parts(project, rest)[1], parts(after, rest)[1]).isEmpty()


def test_a_likelihood_paints_its_row_alone(project, toy):
    rest = toy.id(project, "rest")
    one = gesture(project, rest)
    layout, before = parts(project, rest)
    after = edits.update_actions(project, (one.id,), likelihood=2.5)
    region = find_stale_region(before, parts(after, rest)[1])
    row = layout.row(one.id).rect.toAlignedRect()
    assert region.contains(row)
    assert region.boundingRect().height() < 1.5 * row.height()


def test_what_is_selected_plays_or_does_not_fit_is_painted_where_it_is(project, toy):
    rest = toy.id(project, "rest")
    one = gesture(project, rest).id
    layout, before = parts(project, rest)
    row = layout.row(one).rect.toAlignedRect()
    for look in (
        {"selected": (one,)},
        {"playing": frozenset({one})},
        {"misfits": {one: "begins too far from it"}},
        {"fresh": (one,)},
        {"focus": one},
    ):
        region = find_stale_region(before, parts(project, rest, **look)[1])
        assert region.contains(row) and region.boundingRect().height() < 2 * row.height(), look


def test_a_stances_name_paints_its_chip_and_its_card(project, toy):
    rest = toy.id(project, "rest")
    layout, before = parts(project, rest)
    after = edits.rename_stance(project, rest, "tser")
    region = find_stale_region(before, parts(after, rest)[1])
    assert region is not None
    chip = next(c.rect for c in layout.chips if c.stance == rest)
    assert region.intersects(chip.toAlignedRect()) and region.contains(layout.card.toAlignedRect())


def test_another_count_paints_what_counts_it(project, toy):
    rest = toy.id(project, "rest")
    layout, before = parts(project, rest, sentence="one")
    one = gesture(project, rest)
    after = edits.remove_actions(project, (one.id,))
    region = find_stale_region(before, parts(after, rest, sentence="two")[1])
    if region is not None:  # else nodes lie elsewhere, and all is painted
        assert region.intersects(layout.nodes["gesture"].header.toAlignedRect())
        assert region.intersects(layout.foot.toAlignedRect())


def test_everything_is_painted_in_another_theme_at_another_size_and_of_another_stance(project, toy):
    rest, up = toy.id(project, "rest"), toy.id(project, "up")
    before = parts(project, rest)[1]
    assert find_stale_region(before, parts(project, rest, theme="light")[1]) is None
    assert find_stale_region(before, parts(project, rest, (700, 700))[1]) is None
    assert find_stale_region(before, parts(project, up)[1]) is None
    assert find_stale_region({}, before) is None, "nothing was painted yet"


def test_the_same_is_not_painted_again(project, toy):
    rest = toy.id(project, "rest")
    assert find_stale_region(parts(project, rest)[1], parts(replace(project), rest)[1]).isEmpty()
