"""The papers' exhibits: that each is made, of whatever material, and says what it shows."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from msgspec import structs

from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.clips import read_clips
from metagraph.formats.corpora import Recorded
from metagraph.formats.store import open_project
from metagraph.generation.offered import SHIPPED
from metagraph.graph.edits import place_clips
from metagraph.graph.expand import count_machine_size, list_connections
from metagraph.graph.model import Project
from metagraph.research.exhibits import generated, searching
from metagraph.research.exhibits import material as materials
from metagraph.research.exhibits.authoring import (
    exhibit_hours,
    keep_first_uses,
    make_figure_1,
    make_smaller_project,
)
from metagraph.research.exhibits.exhibit import (
    EXHIBITS,
    NUMBERS,
    Exhibit,
    ExhibitDrawing,
    ExhibitTable,
    MadeExhibit,
    choose_exhibits,
)
from metagraph.research.exhibits.material import ExhibitMaterial, list_actors_rates, make_conversations
from metagraph.research.exhibits.page import encode_exhibits, exhibit_as_text, format_exhibits
from metagraph.research.exhibits.planning import find_fewest_transitions
from metagraph.research.exhibits.published import FIGURE_6, FIGURE_11, TABLE_1, TABLE_2
from metagraph.research.exhibits.searching import Scarcity, exhibit_competing, make_scarce_takes


@pytest.fixture(scope="module")
def talks(sample: Project) -> tuple[Recorded, ...]:
    return make_conversations(sample, 2, 32.0)


def test_an_exhibit_is_found_by_its_name_and_by_its_paper() -> None:
    assert choose_exhibits([]) == EXHIBITS
    assert [e.name for e in choose_exhibits(["ratings", "growth"])] == ["growth", "ratings"]
    assert {e.paper for e in choose_exhibits(["generator"])} == {"generator"}
    assert len(choose_exhibits(["growth", "meta-graph", "growth"])) == len(choose_exhibits(["meta-graph"]))
    with pytest.raises(ValueError, match="'grwth'"):
        choose_exhibits(["grwth"])


def test_what_is_printed_agrees_with_its_own_counts() -> None:
    assert all(round(100 * r.matched / r.total) == r.printed for r in TABLE_1)
    assert all(round(100 * r.chosen / r.answers) == r.printed for r in FIGURE_6)
    assert [round(100 * v[2] / v[0]) for v in TABLE_2.values()] == [8, 80, 95]
    assert all(abs(sum(row) - 100) < 0.11 for row in FIGURE_11)


def test_a_row_of_percentages_comes_of_a_few_counts() -> None:
    assert find_fewest_transitions((100.0, 0.0)) == 1
    assert find_fewest_transitions((33.3, 33.3, 33.3)) == 3
    assert find_fewest_transitions((26.7, 33.3, 6.7, 13.3, 20)) == 15
    assert find_fewest_transitions((1.2345, 98.7655)) == 0
    least = [find_fewest_transitions(row) for row in FIGURE_11]
    assert sum(least) == 55 and least[5] == 1


def test_the_graph_that_figure_1_imagines_has_as_many_connections_as_listing_them_gives() -> None:
    project = make_figure_1()
    found = count_machine_size(project)
    assert found.connections == len(list(list_connections(project, project.graphs["arms"])))
    assert found.states == 9 * (1 + 5 + 5 + 8)


def test_a_smaller_project_keeps_its_stances_first(sample: Project) -> None:
    few = list(make_smaller_project(sample, 9).actions())
    assert len(few) == 9 and {a.kind for a in few} == {"stance"}


def test_clips_that_are_used_twice_are_wired_once_and_that_is_told(few: Path) -> None:
    project = open_project(few).project
    graph = project.graphs["arms"]
    stance = next(iter(graph.stances))
    clip = graph.of(stance, "gesture")[0].clip
    twice = place_clips(project, [clip], "arms", "fidget", stance, None)
    assert len(list(keep_first_uses(twice).actions())) == len(list(project.actions()))
    shown = exhibit_hours(ExhibitMaterial(twice))
    assert "1 further uses" in shown.material and shown.says


@pytest.mark.nightly
@pytest.mark.parametrize("exhibit", EXHIBITS, ids=lambda e: e.name)
def test_of_a_project_without_clips_each_exhibit_is_made_or_says_what_is_missing(exhibit: Exhibit) -> None:
    try:
        shown = exhibit.make(ExhibitMaterial(Project(name="empty")))
    except ValueError as error:
        assert str(error)
        return
    assert shown.missing or exhibit.needs == NUMBERS or shown.says


@pytest.mark.nightly
@pytest.mark.parametrize("exhibit", EXHIBITS, ids=lambda e: e.name)
def test_of_somebodys_takes_each_exhibit_is_made(
    exhibit: Exhibit, sample: Project, talks: tuple[Recorded, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    if exhibit.name == "competing":
        monkeypatch.setattr(searching, "SCARCE", (Scarcity("few", 2, 20.0),))
    shown = exhibit.make(ExhibitMaterial(sample, talks, "two talks"))
    if exhibit.needs == "model":
        assert "generator" in shown.missing
        return
    assert shown.says and shown.parts and not shown.missing
    assert "two talks" in shown.material or exhibit.needs != "takes" or exhibit.name == "competing"
    for part in shown.parts:
        if isinstance(part, ExhibitDrawing):
            ElementTree.fromstring(part.svg)
        else:
            assert all(len(row) == len(part.columns) for row in part.rows)


@pytest.mark.nightly
def test_a_side_nobody_recorded_and_one_take_alone_spoil_nothing(
    sample: Project, talks: tuple[Recorded, ...]
) -> None:
    half = tuple(replace(t, clips=(t.clips[0], None)) for t in talks)
    assert [a.name for a in ExhibitMaterial(sample, half).actors] == ["Speaker 1"]
    named = tuple(
        replace(t, conversation=structs.replace(t.conversation, sides=(
            structs.replace(t.conversation.sides[0], name=f"p{n}"), t.conversation.sides[1])))
        for n, t in enumerate(talks)
    )  # fmt: skip
    assert [a.name for a in ExhibitMaterial(sample, named).actors] == ["side 1", "Speaker 2"]
    none = ExhibitMaterial(sample, (replace(talks[0], clips=(None, None)),))
    with pytest.raises(ValueError, match="motion"):
        _ = none.actors
    alone = ExhibitMaterial(sample, talks[:1])
    assert "be held out" in searching.exhibit_success(alone).missing
    assert "cannot be held out" in searching.exhibit_search(alone).missing


@pytest.mark.nightly
@pytest.mark.skipif(not SHIPPED.is_file(), reason="no learned generator is installed")
def test_takes_of_another_figure_are_retargeted_before_a_model_is_judged_on_them(
    sample: Project, talks: tuple[Recorded, ...], tmp_path: Path
) -> None:
    clip = talks[0].clips[0]
    assert clip is not None
    write_bvh(clip, tmp_path / "other.bvh")  # which has no rest rotations: another skeleton
    (other,) = read_clips(tmp_path / "other.bvh")
    assert other.skeleton != clip.skeleton
    talk = replace(talks[0], clips=(other, None))
    material = ExhibitMaterial(sample, (talk,), "one talk", SHIPPED)
    shown = generated.exhibit_distance(material)
    assert not shown.missing and shown.numbers["wrists"]["recorded"] > 0
    (note,) = material.notes
    assert note.startswith("1 takes ") and "retargeted" in note
    plain = generated.exhibit_distance(
        ExhibitMaterial(sample, (replace(talk, clips=(clip, None)),), "one talk", SHIPPED)
    )
    assert shown.numbers["wrists"]["recorded"] == pytest.approx(plain.numbers["wrists"]["recorded"], rel=0.05)


@pytest.mark.nightly
def test_made_up_conversations_are_the_same_each_time_and_move_at_the_actors_rates(sample: Project) -> None:
    a, b = (make_conversations(sample, 1, 20.0)[0] for _ in range(2))
    assert a.conversation == b.conversation
    assert a.clips[0] is not None and b.clips[0] is not None
    assert (a.clips[0].rotations == b.clips[0].rotations).all()
    assert [s.rates for s in a.conversation.sides] == list(list_actors_rates())
    assert list_actors_rates()[0].clause == pytest.approx(0.7515, abs=1e-4)


@pytest.mark.nightly
def test_where_constraints_compete_some_find_nothing_and_the_best_finds_more(sample: Project) -> None:
    settings = [s for s in searching.SETTINGS if s.name in (searching.ALL, "no constraints")]
    actor = make_scarce_takes(sample, Scarcity("few", 4, 30.0, adjoining=True), 1)
    done = searching.evaluate_search(actor.clips, actor.speech, settings)
    found = {(r.setting, r.search): r.found for r in done.rows}
    cases = done.rows[0].cases
    assert found[searching.ALL, "greedy"] < found[searching.ALL, "exact"] < cases
    assert found["no constraints", "exact"] == cases


@pytest.mark.nightly
def test_adjoining_clauses_leave_no_short_gap_and_rare_answers_are_rarer(sample: Project) -> None:
    plain = make_scarce_takes(sample, Scarcity("x", 1, 40.0), 1)
    closed = make_scarce_takes(sample, Scarcity("x", 1, 40.0, adjoining=True), 1)
    rare = make_scarce_takes(sample, Scarcity("x", 1, 40.0, rare=3), 1)

    def clauses(actor: materials.ExhibitActor) -> list[tuple[float, float]]:
        return [(s.start, s.end) for s in actor.speech[0] if s.kind == "clause"]

    def answers(actor: materials.ExhibitActor) -> int:
        return sum(s.kind != "clause" for s in actor.speech[0])

    gaps = [b[0] - a[1] for a, b in zip(clauses(closed), clauses(closed)[1:], strict=False)]
    assert any(g == 0 for g in gaps) and not any(0 < g < 0.05 for g in gaps)
    assert len(clauses(closed)) == len(clauses(plain))
    assert answers(rare) < answers(plain)


@pytest.mark.nightly
def test_the_numbers_of_competing_say_who_found_what(
    sample: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(searching, "SCARCE", (Scarcity("few", 3, 20.0),))
    shown = exhibit_competing(ExhibitMaterial(sample))
    (few,) = shown.numbers.values()
    best, by_chance = few["all constraints, exact"], few["all constraints, greedy"]
    assert by_chance[0] <= best[0] <= best[1]
    assert any("the other way round 0 windows" in words for words in shown.says)


def test_a_page_needs_nothing_beside_it_and_escapes_what_it_shows() -> None:
    table = ExhibitTable("<caption>", ("a",), (("<b>",),))
    shown = MadeExhibit("<material>", ("<says>",), (table, ExhibitDrawing("<drawn>", "<svg/>")), {"n": 1})
    told = format_exhibits(
        [(EXHIBITS[0], shown, 1.0), (EXHIBITS[1], MadeExhibit("x", missing="<gone>"), 0.0)], {"<k>": "<v>"}
    )
    for words in ("caption", "material", "says", "drawn", "gone", "v"):
        assert f"&lt;{words}&gt;" in told and f"<{words}>" not in told
    assert "http" not in told.replace("http://www.w3.org/2000/svg", "") and "src=" not in told
    assert "missing: <gone>" in exhibit_as_text(EXHIBITS[1], MadeExhibit("x", missing="<gone>"))
    assert encode_exhibits([(EXHIBITS[0], shown, 1.0)])[0]["tables"][0]["rows"] == [["<b>"]]
