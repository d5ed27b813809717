"""The Markov model: the paper's matrix, and meta actions that only append as the horizon moves."""

from __future__ import annotations

import itertools
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Layer, Markov, Mode, Project
from metagraph.playback.planning import markov
from metagraph.playback.planning.markov import ARMS, DEFAULTS, Cursor, write

# Borer et al., figure 11, in percent, typed in once more from the paper.
FIGURE_11 = {
    "left gesture": (25, 37.5, 12.5, 12.5, 0, 0, 12.5, 0, 0),
    "left fidget": (26.7, 33.3, 6.7, 13.3, 20, 0, 0, 0, 0),
    "left transition": (20, 20, 0, 0, 60, 0, 0, 0, 0),
    "right gesture": (0, 28.6, 0, 42.9, 0, 0, 14.3, 0, 14.3),
    "right fidget": (0, 42.9, 14.3, 0, 0, 0, 14.3, 14.3, 14.3),
    "right transition": (0, 0, 100, 0, 0, 0, 0, 0, 0),
    "both gesture": (25, 0, 0, 25, 25, 0, 0, 25, 0),
    "both fidget": (0, 33.3, 33.3, 0, 0, 0, 33.3, 0, 0),
    "both transition": (0, 0, 0, 0, 20, 20, 0, 0, 60),
}


def test_the_arms_matrix_is_the_papers_figure_11() -> None:
    assert [f"{limb} {kind}" for limb, kind in ARMS.states] == list(FIGURE_11)
    for row, printed in zip(ARMS.matrix, FIGURE_11.values(), strict=True):
        assert np.allclose(np.array(row) * 100, printed, atol=0.1)  # printed to 0.1 %


@pytest.mark.parametrize("layer", LAYERS)
def test_every_row_of_every_model_sums_to_1(layer: str) -> None:
    model = DEFAULTS[layer]  # type: ignore[index]
    assert np.allclose(np.sum(model.matrix, axis=1), 1, atol=1e-12)
    assert np.shape(model.matrix) == (len(model.states), len(model.states)) and model.layer == layer


def test_a_projects_own_model_comes_before_the_default() -> None:
    own = Markov("arms", (("both", "gesture"),), ((1.0,),))
    assert markov.model(edits.set_markov(Project(), own), "arms") is own
    assert markov.model(Project(), "arms") is ARMS


def test_nothing_is_written_for_no_time() -> None:
    assert write(ARMS, 1, 0) == ([], Cursor())


@pytest.mark.parametrize("seed", [0, 1, 99])
def test_a_longer_horizon_only_appends(seed: int) -> None:
    short, long = write(ARMS, seed, 60)[0], write(ARMS, seed, 300)[0]
    assert long[: len(short)] == short and len(long) > len(short)
    assert all(m.start < 60 for m in short) and long[len(short)].start >= 60


@given(st.integers(0, 0xFFFFFFFF), st.lists(st.floats(0, 400), max_size=8), st.sampled_from(LAYERS))
def test_writing_in_many_goes_gives_the_same_bit_for_bit(seed: int, stops: list[float], layer: Layer) -> None:
    chain, cursor, metas = DEFAULTS[layer], Cursor(), []
    for until in [*sorted(stops), 400.0]:
        more, cursor = write(chain, seed, until, cursor=cursor)
        assert all(m.start < until for m in more)
        metas += more
    assert (metas, cursor) == write(chain, seed, 400.0)


def test_the_cursor_stands_before_the_first_meta_action_left_out() -> None:
    metas, _ = write(ARMS, 4, 100)
    for n, meta in enumerate(metas):
        before, cursor = write(ARMS, 4, meta.start)  # ends are open
        assert len(before) == n == cursor.number and cursor.time == (before[-1].end if before else 0.0)
        assert write(ARMS, 4, 100, cursor=cursor)[0] == metas[n:]


def test_an_earlier_horizon_writes_nothing_and_leaves_the_cursor() -> None:
    _, cursor = write(ARMS, 4, 100)
    assert write(ARMS, 4, 50, cursor=cursor) == ([], cursor)


def test_a_cursor_in_a_state_the_model_has_lost_goes_on_from_any_state() -> None:
    small = Markov("arms", (("both", "gesture"),), ((1.0,),))
    assert write(small, 1, 60, cursor=Cursor(3, 7, 10.0))[0][0].request.kind == "gesture"


def test_what_is_written_ascends_without_overlaps_and_says_it_was_written() -> None:
    metas = write(ARMS, 5, 600)[0]
    assert all(a.end < b.start for a, b in itertools.pairwise(metas))
    assert all(m.written and m.request.priority == 0 and 1 <= m.end - m.start <= 3 for m in metas)
    assert len({m.key for m in metas}) == len(metas)


def test_rests_are_as_long_on_average_as_the_model_says() -> None:
    metas = write(ARMS, 3, 20000)[0]
    gaps = np.array([b.start - a.end for a, b in itertools.pairwise(metas)])
    assert gaps.min() >= ARMS.gap / 5 - 1e-9 and gaps.max() <= ARMS.gap * 5 + 1e-9
    # What is cut off at both ends takes 2 % of the mean.
    assert abs(gaps.mean() - ARMS.gap) < 0.02 * ARMS.gap + 4 * gaps.std() / np.sqrt(len(gaps))
    assert 0.7 < gaps.std() / gaps.mean() < 0.95, "people do not rest like a metronome"


@pytest.mark.parametrize("layer", LAYERS)
def test_observed_transitions_are_within_sampling_error_of_the_matrix(layer: str) -> None:
    model = DEFAULTS[layer]  # type: ignore[index]
    states = [(m.request.limb, m.request.kind) for m in write(model, 11, 40000)[0]]
    pairs = Counter(itertools.pairwise(states))
    for i, source in enumerate(model.states):
        seen = np.array([pairs[source, target] for target in model.states], float)
        expected = seen.sum() * np.array(model.matrix[i])
        assert not seen[expected == 0].any()
        inner = expected > 0
        degrees = inner.sum() - 1
        chi = ((seen - expected)[inner] ** 2 / expected[inner]).sum()
        assert chi < degrees + 4 * np.sqrt(2 * degrees) + 6, (source, seen, expected)


def test_tags_are_asked_for_as_often_as_the_model_says() -> None:
    model = replace(DEFAULTS["head"], positive=0.3, negative=0.2)
    tags = Counter(m.request.tags for m in write(model, 2, 20000)[0] if m.request.kind == "gesture")
    total = sum(tags.values())
    for tag, share in ((("positive",), 0.3), (("negative",), 0.2)):
        assert abs(tags[tag] / total - share) < 4 * np.sqrt(share * (1 - share) / total)
    assert all(not m.request.tags for m in write(model, 2, 500)[0] if m.request.kind != "gesture")


def test_a_row_of_zeros_starts_again_from_any_state() -> None:
    stuck = Markov("head", (("both", "gesture"), ("both", "fidget")), ((0.0, 0.0), (1.0, 0.0)))
    kinds = {m.request.kind for m in write(stuck, 1, 200)[0]}
    assert kinds == {"gesture", "fidget"}


def test_layers_and_seeds_draw_apart() -> None:
    a, b = write(ARMS, 1, 60)[0], write(ARMS, 2, 60)[0]
    assert [m.start for m in a] != [m.start for m in b]
    assert [m.start for m in write(DEFAULTS["head"], 1, 60)[0]] != [
        m.start for m in write(DEFAULTS["body"], 1, 60)[0]
    ]


def test_kinds_the_graph_has_not_are_passed_over() -> None:
    assert {m.request.kind for m in write(ARMS, 1, 300, {"fidget", "stance"})[0]} == {"fidget"}
    assert write(ARMS, 1, 300, {"stance"})[0] == write(ARMS, 1, 300, ())[0] == []
    assert write(ARMS, 1, 300, {"gesture", "fidget", "transition"})[0] == write(ARMS, 1, 300)[0]


GOLDEN = [
    "right fidget 0.6569 3.4758",
    "left fidget 4.0471 6.1438",
    "left fidget 7.3055 8.6029",
    "right fidget 8.9340 11.7483",
    "both gesture 12.5156 14.2933",
    "right gesture 15.9816 18.5848",
    "right gesture 18.9048 20.8574",
]
LENGTHS = ((0.8, 0.3), (2.5, 2.0), (1.2, 0.0))


def test_lengths_have_the_mean_and_deviation_the_model_says() -> None:
    model = replace(DEFAULTS["head"], lengths=LENGTHS)
    seconds: dict[str, list[float]] = {}
    for meta in write(model, 8, 30000)[0]:
        seconds.setdefault(meta.request.kind, []).append(meta.end - meta.start)
    for (_, kind), (mean, deviation) in zip(model.states, LENGTHS, strict=True):
        drawn = np.array(seconds[kind])
        assert drawn.min() > 0
        assert abs(drawn.mean() - mean) <= 4 * deviation / np.sqrt(len(drawn)) + 1e-9
        assert (
            abs(drawn.std() - deviation) <= 0.15 * deviation + 1e-9
        )  # a log-normal's tail makes this one slow to settle
        assert np.allclose(drawn, mean) == (deviation == 0)


def test_lengths_are_log_normal() -> None:
    model = replace(DEFAULTS["head"], lengths=((1.5, 0.9),) * 3)
    spread = np.log1p((0.9 / 1.5) ** 2)
    z = (np.log([m.end - m.start for m in write(model, 8, 20000)[0]]) - np.log(1.5) + spread / 2) / np.sqrt(
        spread
    )
    for level, share in ((-1.0, 0.1587), (0.0, 0.5), (1.0, 0.8413)):
        assert abs(np.mean(z < level) - share) < 4 * np.sqrt(share * (1 - share) / len(z))


def test_what_the_papers_model_writes_stays_the_same() -> None:
    metas = write(ARMS, 1, 20)[0]
    assert [f"{m.request.limb} {m.request.kind} {m.start:.4f} {m.end:.4f}" for m in metas] == GOLDEN


def test_a_states_tags_are_asked_for_and_shares_are_not_drawn_beside_them() -> None:
    states = (("both", "gesture"), ("both", "gesture"), ("both", "fidget"))
    model = Markov("head", states, ((0.2, 0.4, 0.4),) * 3, positive=1.0, tags=("", "very positive", ""))
    metas = write(model, 4, 3000)[0]
    seen = Counter((m.request.kind, m.request.tags) for m in metas)
    assert set(seen) == {("gesture", ()), ("gesture", ("very", "positive")), ("fidget", ())}
    for key, share in ((("gesture", ()), 0.2), (("gesture", ("very", "positive")), 0.4)):
        assert abs(seen[key] / len(metas) - share) < 4 * np.sqrt(share * (1 - share) / len(metas))


def test_a_model_without_rows_for_moments_performs_as_it_does_while_listening() -> None:
    def share(chain: Markov, mode: Mode) -> float:
        metas, _ = write(chain, 1, 4000.0)
        nods = [m for m in metas if m.request.kind == "gesture"]
        return sum(markov.performs(chain, 1, m, mode) for m in nods) / len(nods)

    head = DEFAULTS["head"]
    short = replace(head, modes=head.modes[:3])
    assert share(head, "thinking") == 0 and share(head, "reacting") == 1
    assert share(short, "thinking") == share(short, "reacting") == share(short, "listening") > 0.5
