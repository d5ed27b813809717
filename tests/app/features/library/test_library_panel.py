"""The library's filters, and names broken so that clips can be told apart."""

from __future__ import annotations

import pytest
from PySide6.QtGui import QFont, QFontMetrics

from app.features.library.library_panel import Filter, two_lines
from metagraph.graph import edits


@pytest.fixture(scope="module")
def project(toy):
    project = toy.project()
    extra = [("nods/yes.bvh", 0, "", toy.clip("Nod Yes")), ("nods/no.bvh", 0, "", toy.clip("Nod No"))]
    project = edits.add_clips(project, extra)
    return edits.add_stance(project, "head", "still", [toy.id(project, "Nod No")])


def taken(project, **rule) -> set[str]:
    return {e.name for e in project.clips.values() if Filter(**rule).takes(project, e)}


def test_no_filter_takes_everything(project):
    assert len(taken(project)) == len(project.clips)


def test_words_match_names_and_paths_in_any_order_and_case(project):
    assert taken(project, text="NOD") == {"Nod Yes", "Nod No"}
    assert taken(project, text="yes nod") == {"Nod Yes"}
    assert taken(project, text="nods/ no.bvh") == {"Nod No"}
    assert taken(project, text="nothing like it") == set()
    assert taken(project, text="   ") == taken(project)


def test_placed_and_unplaced_part_the_clips(project):
    assert taken(project, labelled=False) == {"Nod Yes"}
    assert taken(project, labelled=True) == taken(project) - {"Nod Yes"}


def test_layer_and_kind_look_at_the_same_action(toy, project):
    assert taken(project, layer="head") == {"Nod No"}
    assert taken(project, kind="transition") == {"rest to up", "up to rest", "up to far", "far to up"}
    assert taken(project, layer="head", kind="transition") == set()
    assert taken(project, layer="head", text="yes") == set()


@pytest.fixture
def metrics(qapp):
    font = QFont()
    font.setPixelSize(12)
    return QFontMetrics(font)


@pytest.mark.parametrize(
    "name",
    [
        "a",
        "idle",
        "arms_crossed__point_you_rt_01",
        "x" * 200,
        "one two three four five six",
        "_" * 60,
        "ä ö ü" * 9,
    ],
)
def test_a_name_fits_in_at_most_two_lines(metrics, name):
    for width in (40, 90, 108, 300):
        lines = two_lines(name, metrics, width)
        assert 1 <= len(lines) <= 2
        assert all(metrics.horizontalAdvance(line) <= width for line in lines)
        assert lines[0] == name[: len(lines[0])]


def test_a_long_name_breaks_after_a_separator_and_keeps_its_end(metrics):
    first, second = two_lines("arms_crossed__point_you_rt_01", metrics, 100)
    assert first.endswith("_")
    assert second.endswith("01")
