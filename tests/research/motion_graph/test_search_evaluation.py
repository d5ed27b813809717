"""Leave-one-out: windows of held-out speech against the graph of the other takes, with and without each
constraint.
"""

from __future__ import annotations

import csv
import io
import re

import numpy as np
import pytest

from metagraph.graph.conversation.model import SOUNDS, Segment
from metagraph.motion.clip import Clip
from metagraph.research.motion_graph.evaluation_table import format_cases_as_csv, format_cases_as_text
from metagraph.research.motion_graph.search_evaluation import (
    SETTINGS,
    GraphMaking,
    Setting,
    Trials,
    cut_segments,
    evaluate_search,
    hold_out_states,
    list_case_windows,
)
from metagraph.synthesis.states import SynthesisError, read_states, with_velocity
from tests.synthesis.talking import speech, talking

Takes = tuple[list[Clip], list[list[Segment]]]
SOME = (SETTINGS[0], Setting("no constraints", ()))


@pytest.fixture(scope="module")
def takes() -> Takes:
    said = [speech(24, n) for n in range(3)]
    return [talking(f"take {n}", s, 24, n) for n, s in enumerate(said)], said


def first(clip: Clip, frames: int) -> Clip:
    return Clip(
        clip.name,
        clip.skeleton,
        clip.fps,
        clip.rotations[:frames],
        clip.translations[:frames],
        clip.translated,
    )


def test_windows_are_every_fourteen_seconds_and_whole() -> None:
    assert list_case_windows(58) == [(0, 15), (14, 15), (28, 15), (42, 15)]
    assert list_case_windows(56.9) == list_case_windows(43) == [(0, 15), (14, 15), (28, 15)]
    assert (
        list_case_windows(15) == [(0, 15)]
        and list_case_windows(9) == [(0, 9)]
        and list_case_windows(0.5) == []
    )


def test_the_papers_number_of_cases_comes_of_its_takes() -> None:
    # 17 takes of 100 s, seven windows each: 119 cases; the paper's 116 of takes of about that length.
    assert sum(len(list_case_windows(100)) for _ in range(17)) == 119


def test_speech_is_cut_in_the_windows_own_time() -> None:
    said = [Segment("clause", 1, 3, 1.5), Segment("clause", 9, 12, 11.5, "so"), Segment("response", 20, 21)]
    assert cut_segments(said, 2, 9) == [Segment("clause", 0, 1), Segment("clause", 7, 9, None, "so")]
    assert cut_segments(said, 2, 10) == [Segment("clause", 0, 1), Segment("clause", 7, 10, 9.5, "so")]
    assert cut_segments(said, 3, 6) == []


def test_there_is_a_setting_without_each_constraint_without_peaks_and_with_other_tolerances() -> None:
    assert SETTINGS[0].use == SOUNDS and SETTINGS[0].peaks
    assert {s.name: set(SOUNDS) - set(s.use) for s in SETTINGS[1:5]} == {f"without {k}": {k} for k in SOUNDS}
    assert [s.name for s in SETTINGS if not s.peaks] == ["without peaks"] and len(
        {s.tolerance for s in SETTINGS}
    ) == 3
    assert len({s.name for s in SETTINGS}) == len(SETTINGS)


@pytest.mark.nightly
def test_each_take_is_held_out_and_both_searches_find_its_speech_in_the_others(takes: Takes) -> None:
    told: list[tuple[int, int]] = []
    found = evaluate_search(*takes, settings=SOME, progress=lambda n, total: told.append((n, total)))
    assert found.whole and told[-1] == (12, 12) and len(found.cases) == 3 * 1 * 2 * 2
    assert [g.without for g in found.graphs] == ["take 0", "take 1", "take 2"]
    assert all(g.states == 2 * 24 * 30 and 0 < g.kept <= g.states and g.transitions for g in found.graphs)
    by = {(r.setting, r.search): r for r in found.rows}
    whole = by["all constraints", "exact"]
    assert whole.cases == 3 and 0 < whole.found <= 3 and whole.low < 1 and whole.per_second > 0
    assert whole.rest > 0 and 0 <= whole.repeated < 0.2
    assert by["no constraints", "exact"].cost == 0, "a take alone is one that goes with everything"
    assert by["all constraints", "greedy"].cost >= whole.cost
    assert all(c.seconds > 0 for c in found.cases)


def test_rows_are_told_as_a_table_and_cases_as_csv(takes: Takes) -> None:
    found = evaluate_search(*takes, settings=SOME, trials=Trials(("greedy",)))
    lines = list(csv.DictReader(io.StringIO(format_cases_as_csv(found.cases))))
    assert (
        len(lines) == 6
        and lines[0]["take"] == "take 0"
        and lines[0]["found"] == "1"
        and float(lines[0]["length"]) == 15
    )
    text = format_cases_as_text(found)
    assert (
        "3 graphs, each without one take" in text
        and "all constraints" in text
        and re.search(r"[123]/3", text)
        and "ms" in text
    )


def test_speech_that_no_other_take_has_is_not_found_and_says_where(takes: Takes) -> None:
    clips, said = takes
    only = [said[0], *([s for s in some if s.kind != "response"] for some in said[1:])]
    only[0] = [Segment("response", 2.0, 4.0)]
    found = evaluate_search(clips, only, settings=(SETTINGS[0], SETTINGS[2]))
    mine = [c for c in found.cases if c.take == "take 0"]
    assert [c.found for c in mine][:2] == [False, False] and mine[3].found
    assert "no motion goes with this speech beyond" in mine[0].why
    row = next(r for r in found.rows if (r.setting, r.search) == ("all constraints", "exact"))
    assert row.found < row.cases == 3 and row.success == row.found / 3


def test_it_can_be_cancelled_and_keeps_what_there_is(takes: Takes) -> None:
    seen: list[int] = []
    found = evaluate_search(
        *takes,
        settings=SOME,
        trials=Trials(("greedy",)),
        progress=lambda n, _: seen.append(n),
        cancelled=lambda: len(seen) >= 3,
    )
    assert not found.whole and len(found.cases) == 3
    assert "cancelled" in format_cases_as_text(found)
    none = evaluate_search(*takes, cancelled=lambda: True)
    assert not none.whole and none.cases == () and none.rows == []


def test_takes_without_which_there_is_no_graph_find_nothing_and_say_why(takes: Takes) -> None:
    clips, said = takes
    short = [first(c, 3) for c in clips[1:]]
    found = evaluate_search(
        [clips[0], *short], [said[0], [], []], settings=SETTINGS[:1], making=GraphMaking(k=4)
    )
    assert found.graphs == () and [c.found for c in found.cases] == [False, False]
    assert "longer takes" in found.cases[0].why and "0/1" in format_cases_as_text(found)


def test_bad_input_is_told(takes: Takes) -> None:
    clips, said = takes
    with pytest.raises(SynthesisError, match="3 takes, but speech for 2"):
        evaluate_search(clips, said[:2])
    with pytest.raises(SynthesisError, match="at least two takes"):
        evaluate_search(clips[:1], said[:1])
    one = first(clips[1], 1)
    with pytest.raises(SynthesisError, match="one frame"):
        evaluate_search([clips[0], one], said[:2])
    brief = [first(c, 20) for c in clips]
    with pytest.raises(SynthesisError, match="longer takes"):
        evaluate_search(brief, [[], [], []])


def test_speech_longer_than_its_take_and_none_at_all_are_fine(takes: Takes) -> None:
    clips, said = takes
    beyond = [*said[0], Segment("clause", 23.5, 60.0, 40.0)]
    free = next(s for s in SETTINGS if s.name == "free jumps")
    found = evaluate_search(clips, [beyond, [], said[2]], settings=[free], trials=Trials(("greedy",)))
    assert len(found.cases) == 3 and not found.cases[1].why.startswith("no motion"), "silence is idle"


def test_takes_of_other_rates_are_brought_to_thirty_frames_a_second(takes: Takes) -> None:
    clips, said = takes
    fast = talking("fast", said[1], 24, 1, fps=60.0)
    found = evaluate_search(
        [clips[0], fast, clips[2]], said, settings=SETTINGS[:1], trials=Trials(("greedy",))
    )
    assert [c.length for c in found.cases] == [15, 15, 15] and abs(found.graphs[0].states - 2 * 24 * 30) <= 2


def test_the_states_of_all_but_one_are_those_of_the_others(takes: Takes) -> None:
    every, rest = read_states(takes[0]), read_states([takes[0][0], takes[0][2]])
    mine = hold_out_states(every, 1)
    assert np.array_equal(mine.places, rest.places) and np.array_equal(mine.velocities, rest.velocities)
    assert mine.starts.tolist() == rest.starts.tolist() and mine.velocity == pytest.approx(
        with_velocity(rest, None).velocity
    )
