"""Performances, asks, lines and points are edited without breaking what refers to them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import requests as a
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import Project


def staged(*asks: a.AnyRequest) -> tuple[Project, str]:
    return performance_edits.add_performance(Project(), a.Performance(name="talk", asks=asks))


def test_asks_of_a_performance_get_ids_that_differ() -> None:
    project, ident = staged(a.Nod(), a.Nod(id="r1"), a.Nod(id="r1"), a.Shake())
    ids = [x.id for x in project.performances[ident].asks]
    assert len(set(ids)) == 4 and "r1" in ids


def test_two_performances_of_one_name_are_told_apart() -> None:
    project, _ = staged()
    project, other = performance_edits.add_performance(project, a.Performance(name="talk"))
    assert project.performances[other].name == "talk 2"
    assert len(project.performances) == 2


def test_a_name_with_a_number_behind_it_is_no_longer_than_can_be_kept() -> None:
    project, _ = performance_edits.add_performance(Project(), a.Performance(name="x" * a.LONGEST_NAME))
    for _ in range(3):
        project, _ = performance_edits.add_performance(project, a.Performance(name="x" * a.LONGEST_NAME))
    names = {p.name for p in project.performances.values()}
    assert len(names) == 4 and max(map(len, names)) <= a.LONGEST_NAME
    project, ident = performance_edits.add_performance(project, a.Performance(name="y" * 5000))
    assert len(project.performances[ident].name) <= a.LONGEST_NAME


def test_an_ask_is_added_changed_and_taken_back() -> None:
    project, ident = staged()
    project = performance_edits.add_request(project, ident, a.Gesture(at=2.0, tags=("beat",)))
    project = performance_edits.change_request(project, ident, "r1", priority=3, at=2.5)
    (ask,) = project.performances[ident].asks
    assert (ask.at, ask.priority, ask.tags) == (2.5, 3, ("beat",))
    assert performance_edits.remove_requests(project, ident, ["r1"]).performances[ident].asks == ()


@pytest.mark.parametrize(
    "changes", [{"priority": "high"}, {"at": -1.0}, {"nonsense": 1}, {"limb": "tail"}, {"at": float("nan")}]
)
def test_what_an_ask_cannot_take_is_refused(changes: dict[str, object]) -> None:
    project, ident = staged(a.Gesture(id="x"))
    with pytest.raises(EditError):
        performance_edits.change_request(project, ident, "x", **changes)


@given(st.lists(st.floats(0, 100), min_size=1, max_size=5), st.floats(-200, 200))
def test_moving_asks_keeps_their_distance_and_stays_after_the_beginning(
    times: list[float], by: float
) -> None:
    project, ident = staged(*[a.Nod(id=f"n{n}", at=t) for n, t in enumerate(times)])
    after = (
        performance_edits.move_requests(project, ident, [f"n{n}" for n in range(len(times))], by)
        .performances[ident]
        .asks
    )
    gone = [x.at - t for x, t in zip(after, times, strict=True)]
    assert min(x.at for x in after) >= 0
    assert max(gone) - min(gone) < 2e-3
    if min(times) + by >= 0:
        assert gone[0] == pytest.approx(by, abs=1e-3)


def test_an_ask_without_a_time_can_be_moved_and_one_with_a_stroke_moves_its_stroke() -> None:
    project, ident = staged(a.Nod(id="n"), a.Gesture(id="g", stroke=3.0))
    after = performance_edits.move_requests(project, ident, ["n", "g"], 1.5).performances[ident].asks
    assert (after[0].at, after[1].at, after[1].stroke) == (1.5, None, 4.5)


def test_a_performance_is_renamed_and_removed_and_nothing_else_is() -> None:
    project, ident = staged()
    assert (
        performance_edits.change_performance(project, ident, name="  new   name ").performances[ident].name
        == "new name"
    )
    assert performance_edits.change_performance(project, ident, name="talk") is project
    assert performance_edits.remove_performance(project, ident).performances == {}
    for wrong in ({"name": "  "}, {"length": 0.0}, {"length": float("nan")}, {"seed": -1}):
        with pytest.raises(EditError):
            performance_edits.change_performance(project, ident, **wrong)
    with pytest.raises(EditError):
        performance_edits.remove_performance(project, "p99")


def test_a_line_renamed_is_called_by_its_new_id() -> None:
    project, ident = staged(a.Say(line=279), a.Say(line="280"))
    project = performance_edits.set_line(
        performance_edits.set_line(project, "279", a.Line(text="Hello")), "280", a.Line(text="Bye")
    )
    after = performance_edits.rename_line(project, "279", "greeting")
    assert list(after.lines) == ["greeting", "280"]
    assert [x.line for x in after.performances[ident].asks] == ["greeting", "280"]
    for taken in ("280", " "):
        with pytest.raises(EditError):
            performance_edits.rename_line(project, "279", taken)


def test_another_sound_forgets_the_old_ones_voice() -> None:
    from dataclasses import replace

    project = performance_edits.set_line(Project(), "1", a.Line(audio="a.wav"))
    project = replace(project, voices={"1": object()})
    assert performance_edits.set_line(project, "1", a.Line(audio="a.wav", text="more")).voices
    assert not performance_edits.set_line(project, "1", a.Line(audio="b.wav")).voices
    assert not performance_edits.set_line(project, "1", None).lines


def test_points_and_life_are_set_within_their_ranges() -> None:
    project = performance_edits.set_point(Project(), "anna", (1.0, 1.5, 2.0))
    assert project.points == {"anna": (1.0, 1.5, 2.0)}
    assert performance_edits.set_point(project, "anna", None).points == {}
    assert performance_edits.set_life(project, stillness=0.5).life.stillness == 0.5
    for wrong in ({"stillness": 2.0}, {"stillness": "very"}, {"nonsense": 1}):
        with pytest.raises(EditError):
            performance_edits.set_life(project, **wrong)
