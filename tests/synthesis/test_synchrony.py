"""What was planted is kept: strokes fall on the stresses of speech that nobody in the takes ever said."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.graph.conversation.model import Segment
from metagraph.motion.clip import Clip
from metagraph.research.motion_graph.search_evaluation import cut_segments
from metagraph.synthesis.assemble import assemble
from metagraph.synthesis.constraints import find_change_states, find_heard_at, list_wanted
from metagraph.synthesis.cooccurrence import find_activation_speed, measure_part_speeds
from metagraph.synthesis.graph import build_graph
from metagraph.synthesis.search.exact_search import find_best_path
from metagraph.synthesis.search.greedy_search import search_greedily
from metagraph.synthesis.states import key_states, read_states
from tests.synthesis.talking import speech, talking

NEAR = 0.15  # seconds: the search's tolerance, and a frame or so
SECONDS = 15.0


def strokes(clip: Clip) -> list[float]:
    """When the right hand is fastest, seconds: maxima that stand out."""
    speed = measure_part_speeds(clip)["right_hand"]
    smooth = np.convolve(speed, np.ones(3) / 3, "same")
    top = (
        (smooth[1:-1] > smooth[:-2])
        & (smooth[1:-1] >= smooth[2:])
        & (smooth[1:-1] > 3 * find_activation_speed(speed))
    )
    return list((np.flatnonzero(top) + 1) / clip.fps)


def met(at: list[float], stresses: list[float]) -> float:
    """The share of stresses with a stroke near."""
    return float(np.mean([min((abs(a - s) for a in at), default=9.0) <= NEAR for s in stresses]))


def stresses(segments: list[Segment]) -> list[float]:
    return [s.peak for s in segments if s.peak is not None]


@pytest.mark.nightly
def test_strokes_fall_on_the_stresses_of_new_speech_and_not_on_those_of_shuffled_speech() -> None:
    said = [speech(60, n) for n in range(4)]
    takes = [talking(f"take {n}", s, 60, n) for n, s in enumerate(said)]
    states = read_states(takes)
    graph = build_graph(states, keys=key_states(states, changes=find_change_states(states, said)))
    sound = find_heard_at(states, said)
    chance = np.random.default_rng(7)
    for search in (search_greedily, find_best_path):
        with_speech, shuffled = [], []
        for seed in range(100, 106):
            new = cut_segments(speech(30, seed), 0, SECONDS)
            at = strokes(assemble(states, takes, search(graph, sound, list_wanted(new, SECONDS))))
            with_speech.append(met(at, stresses(new)))
            turned = [
                [(p + s) % SECONDS for p in stresses(new)] for s in chance.uniform(1.5, SECONDS - 1.5, 40)
            ]
            shuffled.append(float(np.mean([met(at, t) for t in turned])))
        # Measured: all of them with either search; 18 % when the same speech is turned round.
        assert np.mean(with_speech) > 0.9, (np.mean(with_speech), np.mean(shuffled))
        assert np.mean(with_speech) - np.mean(shuffled) > 0.6, (np.mean(with_speech), np.mean(shuffled))
