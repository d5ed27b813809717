"""The scripted participant does a small task in each condition without a mistake."""

from __future__ import annotations

import pytest

from metagraph.formats.store import open_project
from metagraph.research.study.machines.by_hand import Way
from metagraph.research.study.machines.counted_fields import label_by_fields
from metagraph.research.study.machines.counted_hand import try_way
from metagraph.research.study.machines.normal_machine import normalize_machines
from metagraph.research.study.scores.machines import score
from tests.app.expert import Expert, Reviewer, TableExpert, hidden, without_times
from tests.app.participant import CONDITIONS, Participant, bare, task
from tests.thorough import THOROUGH, many, some

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.fixture(scope="module")
def sample():
    from app.project.files import SAMPLE

    return open_project(SAMPLE).project


def test_a_task_of_few_clips_is_whole(sample):
    given = task(sample, 10)
    assert len(given.project.clips) == 10 and not list(given.project.actions())
    kinds = [a.kind for a in given.reference.actions()]
    assert kinds.count("stance") >= 1 and len(kinds) == 10


@pytest.mark.nightly
@pytest.mark.parametrize(
    "condition",
    [each for each in CONDITIONS if THOROUGH or each != "manual"],  # which is part of the others
)
def test_clips_are_done_without_a_mistake(drive, sample, condition):
    clips = (
        many(5, 6) if condition == "manual, every connection" else many(8, 10)
    )  # their connections grow with the square
    given = task(sample, clips)
    bare(drive, given, condition)
    result = Participant(drive, given).do(condition)
    print(
        condition,
        dict(result.operators),
        f"{result.predicted:.0f} s predicted",
        result.score.count("missing"),
        "missing",
    )
    assert result.score.extra == result.score.wrong == 0 and result.score.placed == clips
    assert result.score.essential_right == result.score.essential > 0
    assert (result.score.f1 == 1.0 and not result.score.mistakes) or condition == "manual"
    assert result.operators["B"] >= 20 and result.predicted > 0


@pytest.mark.nightly
@pytest.mark.parametrize(
    "way",
    some(
        [
            Way("many at once", "from aliases", "words", "many at once"),
            Way("many at once", "from any state", "words", "each"),
            Way("one by one", "from aliases", "rubber bands", "many at once", named=False),
            Way("one by one", "from many selected", "clicks", "each"),
        ],
        3,
    ),
    ids=str,
)
def test_an_expert_draws_the_reference_in_the_window_as_was_counted_without_it(drive, sample, way):
    given = task(sample, many(8, 12))
    given = given if way.named else hidden(given)
    bare(drive, given, "manual")
    expert = Expert(drive, given)
    expert.act = lambda _: expert.draw(way)
    result = expert.do("expert")
    assert not result.score.mistakes and result.score.f1 == 1.0
    counted = try_way(way, given.reference)
    assert not counted.score.mistakes
    hands = {k: result.operators[k] for k in "KBM"}  # where the pointer is already, P is not recorded
    print(way, dict(result.operators), dict(counted.operators))
    for name, count in hands.items():
        assert abs(count - counted.operators[name]) <= 2 + 0.2 * counted.operators[name], name


@pytest.mark.nightly
@pytest.mark.parametrize("look", [False, True])
@pytest.mark.parametrize("named", [True, False])
def test_an_expert_goes_through_proposals_without_a_mistake(drive, sample, look, named):
    given = task(sample, 12)
    given = given if named else hidden(given)
    bare(drive, given, "meta")
    reviewer = Reviewer(drive, given)
    reviewer.act = lambda _: reviewer.review(look)
    result = reviewer.do("meta")
    found = score(
        normalize_machines(without_times(drive.document.project)), normalize_machines(given.reference)
    )
    wrong = [m.words for m in found.mistakes]
    assert not wrong or (not look and not named)  # unseen and unnamed, what is sure may be wrong
    assert result.operators["P"] == result.operators["B"] == 0
    assert (reviewer.looked == 12) == look and (reviewer.watched > 0) == look


@pytest.mark.nightly
@pytest.mark.parametrize("from_names", [True, False])
def test_clips_are_labelled_field_by_field_in_the_table_as_was_counted(drive, sample, from_names):
    given = task(sample, 24)
    filled = label_by_fields(given.reference, from_names)
    bare(drive, given, "meta")
    expert = TableExpert(drive, given)
    expert.act = lambda _: expert.fill(filled.steps)
    result = expert.do("meta")
    assert not result.score.mistakes and result.score.f1 == 1.0
    assert {k: result.operators[k] for k in "KM"} == {k: filled.operators[k] for k in "KM"}
