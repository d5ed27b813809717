"""A study of one's own with people who do not exist: its tasks, orders, limits and questions."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.analysis.results import analyse_study
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.simulation.like_study import write_like
from metagraph.research.study.simulation.people import Truth
from metagraph.research.study.sitting import find_place_in_sitting, list_phases
from metagraph.research.study.study_plan import read_study

SAMPLE = Path(__file__).resolve().parents[4] / "sample_clips" / "study"


@pytest.mark.nightly
def test_the_example_study_is_gone_through_by_people_who_do_not_exist(tmp_path: Path) -> None:
    study = read_study(SAMPLE)
    made = write_like(study, tmp_path / "made", Truth(ratio=3.0, order=0.8))
    assert made.problems() == [] and [t.id for t in made.plan.tasks] == ["ten", "twenty"]
    assert made.plan.consent == study.plan.consent and made.plan.title.endswith("(simulated)")
    for who in made.plan.ids:
        log = read_log(made.log(who))
        assert log.complete and not log.problems
        assert find_place_in_sitting(list_phases(made, who), log.events).phase is None
        assert made.blocks(who) == study.blocks(who)
    data = collect_study(made.folder, jumps=False)
    found = analyse_study(data)
    assert data.simulated and found.time is not None and found.time.ratio.holds(3.0)
    assert found.mistakes[0].means["meta"].value > found.mistakes[0].means["manual"].value
    with pytest.raises(FileError, match="is not empty"):
        write_like(study, tmp_path / "made", Truth())


def test_questions_of_ones_own_limits_and_concealed_orders_are_simulated_too(
    tiny: Path, tmp_path: Path
) -> None:
    text = tiny.read_text().replace("minutes: 5", "minutes: 0.5")
    text = text.replace("questionnaires: [sus,", "order: concealed\nquestionnaires: [tlx_weighted, sus,")
    item = '{id: words, text: "What else?", words: true}'
    more = (
        "{id: which, text: Which?, choices: [one, other]}, {id: sure, text: Sure?, scale: {from: 1, to: 7}}"
    )
    tiny.write_text(text.replace(item, f"{item}, {more}"))
    made = write_like(read_study(tiny), tmp_path / "made", Truth())
    data = collect_study(made.folder, jumps=False)
    assert any(r.run.timed_out for r in data.rows)
    said = {a.item: a.value for a in data.answers if a.questionnaire == "more"}
    assert said["which"] in ("one", "other") and 1 <= said["sure"] <= 7
    assert any(r.measure == "NASA-TLX, weighted" for r in data.ratings)
