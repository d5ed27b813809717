"""Frames that were said otherwise cost something, by each speaker's own measure."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph.conversation.model import Segment
from metagraph.speech.prosody import Prosody
from metagraph.synthesis.prosody_costs import (
    FARTHEST,
    UNKNOWN,
    SpokenTake,
    measure_prosody_cost,
    measure_prosody_match,
    measure_speech_prosody,
    measure_state_prosody,
    standardise_prosody,
)
from metagraph.synthesis.states import SynthesisError
from tests.synthesis.test_search import graph_of


def said(loudness: list[float], kinds: str = "", gain: float = 0.0) -> SpokenTake:
    """Segments of a second, one after another: c a clause, r a response, h a hesitation."""
    names = {"c": "clause", "r": "response", "h": "hesitation"}
    segments = tuple(
        Segment(names[k], float(n), n + 1.0)  # type: ignore[arg-type]
        for n, k in enumerate(kinds or "c" * len(loudness))
    )
    loud = np.array(loudness, float) + gain
    return SpokenTake(segments, (), Prosody(loud, np.full(len(loud), np.nan)))


def test_a_quiet_recording_is_not_a_quiet_voice() -> None:
    near, far = standardise_prosody([said([-20, -23, -26]), said([-20, -23, -26], gain=-30)], "loudness")
    assert near == pytest.approx(far) and near[0] > 1 and near[1] == pytest.approx(0)
    both = np.concatenate([near, far])
    assert both.mean() == pytest.approx(0, abs=1e-9) and both.std() == pytest.approx(1)


def test_clauses_are_compared_with_clauses_and_responses_with_responses() -> None:
    (found,) = standardise_prosody([said([-20, -22, -24, -40, -42, -44, -10], "cccrrrh")], "loudness")
    assert found[:3] == pytest.approx(found[3:6]) and np.isnan(found[6])


def test_a_recording_of_few_segments_has_the_mean_of_all() -> None:
    one, few = standardise_prosody([said([-20, -24, -28]), said([-28])], "loudness")
    assert few[0] < -0.5 and one[0] == pytest.approx(-one[2])
    assert standardise_prosody([said([-20])], "loudness")[0].tolist() == [0.0]
    assert np.isnan(standardise_prosody([SpokenTake(said([-20]).segments)], "loudness")[0]).all()


def test_what_is_off_costs_by_the_second_and_what_is_unknown_as_much_as_chance() -> None:
    graph = graph_of(150, [0, 90, 150], {})
    takes = [said([-20, -26, -20]), SpokenTake(())]
    of_state = measure_state_prosody(graph.states, takes, "loudness")
    assert np.isnan(of_state[90:]).all() and of_state[0] == of_state[60] > 0 > of_state[30]
    of_frame = measure_speech_prosody(said([-10, -16, np.nan, -10]), 0.5, 3.0, "loudness")
    assert np.isnan(of_frame[45:75]).all() and of_frame[0] == of_frame[-1]
    cost = measure_prosody_cost("loudness", 0.5, of_state, of_frame, 2.0)
    assert cost.at[0] == cost.at[-1] >= 0 and (cost.at[45:75] == -1).all()
    a_second = 30 * cost.rows
    off = abs(of_frame[0] - of_state[30])
    assert a_second[cost.at[0], 30] == pytest.approx(0.5 * 2.0 * min(off, FARTHEST), rel=1e-4)
    assert a_second[cost.at[0], 100] == pytest.approx(0.5 * 2.0 * UNKNOWN, rel=1e-4)
    assert cost.paid(np.full(90, 100)) == pytest.approx(60 / 30 * UNKNOWN, rel=1e-4)


def test_how_well_a_path_goes_with_speech_is_told_in_spreads() -> None:
    of_state = np.array([-1.0, 0.0, 1.0, np.nan])
    of_frame = np.array([-1.0, 0.0, 1.0, 1.0, np.nan])
    same = measure_prosody_match("rate", of_state, of_frame, np.array([0, 1, 2, 2, 0]))
    assert same is not None and same.off == 0 and same.correlation == pytest.approx(1) and same.known == 1
    other = measure_prosody_match("rate", of_state, of_frame, np.array([2, 1, 0, 3, 0]))
    assert other is not None and other.correlation == pytest.approx(-1) and other.known == 0.75
    assert other.words() == "rate differs by 1.33 standard deviations, correlation -1.00"
    assert measure_prosody_match("rate", of_state, of_frame, np.full(5, 3)) is None


def test_takes_and_speech_that_do_not_go_together_are_told() -> None:
    with pytest.raises(SynthesisError, match="1 takes have states, but 2"):
        measure_state_prosody(graph_of(9, [0, 9], {}).states, [said([0]), said([0])], "loudness")
