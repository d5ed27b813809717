"""How well motion that is extended while it plays goes with speech."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph.conversation.model import Segment
from metagraph.research.motion_graph.extending_evaluation import (
    format_rows_as_text,
    hold_out_takes,
    list_speech_news,
    score_extending,
    score_paths,
)
from metagraph.synthesis.constraints import HeardStates
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.states import SynthesisError
from tests.synthesis.talking import talkers
from tests.synthesis.test_search import graph_of


def test_what_becomes_known_when_it_is_heard_and_when_it_is_announced() -> None:
    said = [Segment("clause", 1.0, 2.0, 1.5), Segment("response", 0.1, 0.4)]
    assert [(round(at, 2), n.what) for at, n in list_speech_news(said, 0.5)] == [
        (0.0, "comes"),
        (0.5, "comes"),
    ]
    heard = [(n.what, n.at) for _, n in list_speech_news(said, None)]
    assert heard == [("begins", 0.1), ("ends", 0.4), ("begins", 1.0), ("stress", 1.5), ("ends", 2.0)]
    assert all(at > n.at for at, n in list_speech_news(said, None))


def test_strokes_are_counted_by_how_much_later_they_come() -> None:
    graph = graph_of(300, [0, 300], {})
    peaks = np.zeros(300, bool)
    peaks[[30, 99, 150]] = True
    sound = HeardStates(np.full(300, 2, np.uint8), peaks)
    said = [Segment("clause", t, t + 1.0, t + 1.0) for t in (0.0, 2.0, 4.0, 8.0)]  # at 1, 3, 5 and 9 s
    path = Path(np.arange(300), 0.0, np.zeros(0, int))
    row = score_paths("some", [(graph.states, sound, said, path)])
    assert row.met == 0.5 and row.answered == 0.75 and row.off == 0.0 and row.strokes == 0.75
    assert row.jumps == 0.0 and row.kinds == pytest.approx(0.4)
    silent = HeardStates(np.ones(300, np.uint8), np.zeros(300, bool))
    none = score_paths("none", [(graph.states, silent, said, path)])
    assert none.met == none.answered == none.chance == 0.0 and "none" in format_rows_as_text([none])


@pytest.mark.nightly
def test_takes_are_held_out_and_driven_and_the_best_paths_stand_beside() -> None:
    takes, said = talkers()
    rows = list(score_extending(hold_out_takes(takes[:3], said[:3])[:1], ahead=(None, 1.0)))
    assert [r.how for r in rows] == ["heard", "announced 1 s ahead", "all known"]
    heard, told, best = rows
    assert heard.met < told.met and told.met > 0.6 and best.met > 0.6 and best.searches == 0
    assert told.searches <= 10.5 and told.work > 0 and told.stresses == heard.stresses > 5
    assert len(format_rows_as_text(rows).splitlines()) == 4


def test_fewer_than_two_takes_cannot_be_held_out() -> None:
    takes, said = talkers()
    with pytest.raises(SynthesisError, match="at least two takes"):
        hold_out_takes(takes[:1], said[:1])
