"""What the answers show: what was planted, who counts, and how often nothing is found if nothing is."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec import structs

from metagraph.research.study.logs.withdrawal import delete_data, note_withdrawal
from metagraph.research.study.perceive.answers import keep_sheet
from metagraph.research.study.perceive.folder import Perceived
from metagraph.research.study.perceive.perceive_analysis import PerceiveResults, analyse_answers
from metagraph.research.study.perceive.perceive_data import collect_answers
from metagraph.research.study.perceive.perceive_plan import parse_perceive_plan
from metagraph.research.study.perceive.simulated import Raters, write_simulated
from tests.research.study.perceive.perceive_makers import CHOICE, RATING, sheet, study, text
from tests.thorough import many

pytestmark = pytest.mark.usefixtures("quick_codes")


def simulated(folder: Path, raters: Raters, **options: object) -> PerceiveResults:
    words = text(**{"people": 20, "items": 10, **options})  # type: ignore[arg-type]
    return analyse_answers(
        collect_answers(
            write_simulated(folder, parse_perceive_plan(words), words.encode(), f"s{raters.seed}", raters)
        )
    )


@pytest.mark.nightly
@pytest.mark.parametrize("planted", [0.9, -0.7][: many(1, 2)])
def test_a_planted_preference_lies_within_its_interval(tmp_path: Path, planted: float) -> None:
    held = 0
    for seed in range(10):
        raters = Raters({"all": planted}, lapses=0, left=0.4, careless=0.1, seed=seed)
        (found,) = simulated(tmp_path / str(seed), raters).pairs
        assert found.model is not None
        held += found.model.effects["preference"].holds(planted)
        assert found.verdict in (("preferred", "not told") if planted > 0 else ("not preferred", "not told"))
    assert held >= 8


@pytest.mark.nightly
def test_without_a_preference_hardly_any_study_finds_one(tmp_path: Path) -> None:
    found = [simulated(tmp_path / str(s), Raters(seed=s)).pairs[0].verdict for s in range(many(15, 30))]
    assert found.count("not told") >= many(
        12, 26
    )  # of 15 with 5 % each, more than 3 are less likely than 1 in 150


def test_side_bias_is_told_and_who_never_looks_is_left_out(tmp_path: Path) -> None:
    results = simulated(
        tmp_path / "s",
        Raters({"all": 0.5}, left=1.2, careless=0.3, unfinished=0.1, seed=4),
        more="checks: {told: 4, same: 3}\n",
        people=40,
    )
    assert results.left is not None and results.left[0].low is not None and results.left[0].low > 0.55
    assert results.same is not None and results.same[0].value > 0.6
    assert any("left side" in w for w in results.cautions)
    why = [p.why for p in results.answers.people]
    assert why.count("missed checks") >= 5 and why.count("broken off") >= 1
    (found,) = results.pairs
    assert found.model is not None and found.model.effects["side"].low is not None
    assert found.unfiltered is not None and found.share is not None and found.unfiltered.n > found.share.n


def test_ratings_find_what_was_planted_and_more_tests_cost_more(tmp_path: Path) -> None:
    results = simulated(tmp_path / "s", Raters({"all": 1.0}, lapses=0, seed=2), asked=CHOICE + RATING)
    (rated,) = results.rated
    assert rated.difference.holds(1.0) and rated.by == "mixed model"
    assert rated.p is not None and rated.together is not None and rated.together >= rated.p
    assert results.means is not None
    means = results.means["natural"]
    assert means["all"].value > means["deaf"].value and means["all"].n == len(results.answers.counting)


@pytest.fixture
def made(tmp_path: Path) -> Perceived:
    return study(tmp_path / "s", text(people=6, items=4, asked=CHOICE + RATING))


def test_nobody_s_answers_say_nothing(made: Perceived) -> None:
    results = analyse_answers(collect_answers(made))
    assert results.pairs[0].verdict == "no answers" and len(results.cautions) == 1
    assert results.rated == () and results.left is None and not results.answers.odd


def test_one_person_who_always_chooses_the_left_prefers_nothing(made: Perceived) -> None:
    keep_sheet(made, sheet(made))
    results = analyse_answers(collect_answers(made))
    (found,) = results.pairs
    assert found.share is not None and (found.share.value, found.share.n) == (0.5, 4)
    assert results.left is not None and results.left[0].value == 1 and found.people is None
    assert any("few" in w for w in results.cautions)


def test_who_withdrew_was_deleted_declined_or_stopped_is_not_counted(made: Perceived) -> None:
    for who in made.plan.ids:
        keep_sheet(made, sheet(made, who, "right", end=who != "P03"))
    assert note_withdrawal(made, "P01") and not note_withdrawal(made, "P01")
    delete_data(made, "P02")
    found = collect_answers(made)
    assert found.counting == ("P04", "P05", "P06")
    why = {p.participant: p.why for p in found.people}
    assert (why["P01"], why["P02"], why["P03"]) == ("withdrawn", "deleted", "broken off")
    # Of the three who are left out, only who broke off is among those computed with nobody excluded.
    assert {c.participant for c in found.all_choices} == {"P03", "P04", "P05", "P06"}
    with pytest.raises(ValueError, match="does not take part"):
        note_withdrawal(made, "P77")


def test_a_missed_check_excludes_unless_the_plan_allows_it(tmp_path: Path) -> None:
    for allow, counts in ((0, 0), (1, 1)):
        made = study(tmp_path / str(allow), text(people=1, more=f"checks: {{told: 2, allow: {allow}}}\n"))
        whole = sheet(made)
        told = [t.id for t in made.key.sessions["P01"].trials if t.kind == "told"]
        turned = {"left": "right", "right": "left"}
        events = tuple(
            structs.replace(e, value=turned[str(e.value)]) if e.trial == told[0] else e for e in whole.events
        )
        keep_sheet(made, structs.replace(whole, events=events))
        assert len(collect_answers(made).counting) == counts


def test_a_log_that_cannot_be_read_is_told_and_spoils_nobody_else_s(made: Perceived) -> None:
    keep_sheet(made, sheet(made))
    keep_sheet(made, sheet(made, "P02"))
    path = made.log("P01")
    path.unlink()
    path.mkdir()
    found = collect_answers(made)
    assert found.counting == ("P02",)
    made.log("P03").parent.mkdir(parents=True)
    made.log("P03").write_bytes(b"{\n\x00\n[]\n")
    found = collect_answers(made)
    assert found.counting == ("P02",) and sum(w.startswith("P03: line") for w in found.odd) == 3


def test_a_study_that_was_changed_since_is_told(made: Perceived) -> None:
    page = made.show / "index.html"
    page.write_text(page.read_text() + " ")
    (odd,) = collect_answers(made).odd
    assert odd.startswith("show/index.html ")


def test_no_difference_that_matters_needs_an_interval_within_it(tmp_path: Path) -> None:
    results = simulated(
        tmp_path / "s", Raters(people=0, items=0, seed=5), more="smallest: 0.7\n", people=40, items=12
    )
    assert results.pairs[0].verdict == "no difference that matters"
    few = simulated(tmp_path / "t", Raters(people=0, items=0, seed=5), more="smallest: 0.55\n", people=6)
    assert few.pairs[0].verdict == "not told"
