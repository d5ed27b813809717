"""The scripted participant does a small task in each condition without a mistake."""

from __future__ import annotations

import pytest

from metagraph.formats.store import open_project
from tests.app.participant import CONDITIONS, Participant, bare, task

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


@pytest.mark.parametrize("condition", CONDITIONS)
def test_clips_are_done_without_a_mistake(drive, sample, condition):
    clips = 6 if condition == "manual, every connection" else 10  # their connections grow with the square
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
