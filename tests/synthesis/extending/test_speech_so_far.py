"""What is expected of speech that goes on: what was announced, what was heard, what is likely."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.conversation.model import SOUNDS
from metagraph.synthesis.constraints import EDGE, STRESS
from metagraph.synthesis.extending.speech_so_far import LEAST, MOST, ExpectedSpeech, SpeechNews, SpeechSoFar
from tests.thorough import many

IDLE, CLAUSE, RESPONSE = (1 << SOUNDS.index(kind) for kind in ("idle", "clause", "response"))


def after(*news: SpeechNews, first: int = 0, shown: tuple[int, ...] = ()) -> ExpectedSpeech:
    speech = SpeechSoFar()
    for one in news:
        speech.tell(one)
    return speech.expected(first, 60, shown, first)


def waited_for(want: ExpectedSpeech, what: int) -> list[tuple[int, int]]:
    """First and last frame of each window that waits for this."""
    numbers = dict.fromkeys(want.window[(want.window >= 0) & (want.waits == what)].tolist())
    return [(int(f[0]), int(f[-1])) for n in numbers if len(f := np.flatnonzero(want.window == n))]


def test_nothing_known_is_silence_that_counts_the_less_the_farther_off() -> None:
    want = after()
    assert (want.allowed == IDLE).all() and (want.window == -1).all() and (want.barred == STRESS).all()
    assert want.sure[0] == 1.0 and (np.diff(want.sure) <= 0).all() and want.sure[-1] == np.float32(LEAST)


def test_a_clause_that_comes_is_waited_for_where_it_is_stressed_begins_and_ends() -> None:
    want = after(SpeechNews("comes", 0.5, 1.5, 1.0))
    assert want.allowed[30] == CLAUSE and want.allowed[0] == IDLE and want.allowed[59] == IDLE
    assert want.allowed[15] == want.allowed[14] == CLAUSE | IDLE  # either side's at its beginning
    (stress,) = waited_for(want, STRESS)
    assert stress[0] == 27 and stress[1] > 33  # late is better than never
    assert [a for a, _ in waited_for(want, EDGE)] == [12, 42]
    assert (want.sure[:45] == 1.0).all()
    assert np.isclose(want.unmet[want.window == want.window[30]].sum(), 1.0)
    assert want.unmet[27:31].sum() == 0.0  # too early costs nothing, too late more and more


def test_what_was_shown_in_time_is_not_waited_for_again() -> None:
    news = SpeechNews("comes", 0.5, 1.5, 1.0)
    assert waited_for(after(news, first=28), STRESS)
    assert not waited_for(after(news, first=28, shown=(0, 0, STRESS)), STRESS)
    assert waited_for(after(news, first=28, shown=(0, STRESS, 0, 0, 0, 0)), STRESS)  # that was too early


def test_a_stress_that_was_heard_too_late_is_answered_late_and_one_long_ago_never() -> None:
    news = SpeechNews("begins", 0.0), SpeechNews("stress", 1.0)
    (window,) = [w for w in waited_for(after(*news, first=36), STRESS) if w[0] == 0]
    assert window[1] == 9  # half a second after it
    assert not [w for w in waited_for(after(*news, first=50), STRESS) if w[0] == 0]


def test_who_speaks_goes_on_and_who_has_ended_is_silent() -> None:
    begun = SpeechNews("begins", 1.0)
    want = after(begun, first=40)
    assert (want.allowed == CLAUSE).all() and (want.barred == 0).all()
    assert waited_for(want, STRESS)  # there will be one, nobody can say when
    want = after(begun, SpeechNews("ends", 1.5), first=50)
    assert (want.allowed == IDLE).all() and not waited_for(want, STRESS)
    assert (after(begun, SpeechNews("ends", 0.5), first=50).allowed == IDLE).all()  # a false alarm


def test_a_hush_takes_back_what_was_announced_and_cuts_what_goes_on() -> None:
    news = (SpeechNews("comes", 0.0, 2.0, 1.5), SpeechNews("comes", 2.2, 3.0, 2.5))
    want = after(*news, SpeechNews("hush", 1.0), first=33)
    assert (want.allowed == IDLE).all() and not waited_for(want, STRESS)
    assert len(waited_for(after(*news, first=33), STRESS)) == 2


def test_what_is_announced_later_holds_instead_of_what_it_overlaps() -> None:
    want = after(SpeechNews("comes", 0.5, 1.5, 1.0), SpeechNews("comes", 0.6, 1.2, kind="response"))
    assert (want.allowed[22:33] == RESPONSE).all() and not waited_for(want, STRESS)


@settings(max_examples=many(50, 1000), deadline=None)
@given(st.data())
def test_whatever_is_told_prices_are_finite_and_memory_is_bounded(data: st.DataObject) -> None:
    times = st.floats(0, 20, allow_nan=False)
    kinds = st.sampled_from(["clause", "response", "hesitation"])
    what = st.sampled_from(["begins", "ends", "stress", "comes", "hush"])
    one = st.builds(SpeechNews, what, times, times, st.none() | times, kinds)
    speech = SpeechSoFar()
    for news in data.draw(st.lists(one, max_size=30)):
        speech.tell(news)
    first = data.draw(st.integers(0, 700))
    shown = data.draw(st.lists(st.integers(0, 3), max_size=30))
    want = speech.expected(first, 60, shown, first)
    assert np.isfinite(want.unmet).all() and (want.unmet >= 0).all() and (want.unmet <= 1.001).all()
    assert (want.allowed > 0).all() and (want.sure >= np.float32(LEAST)).all() and (want.sure <= 1).all()
    speech.forget(30.0)
    assert not speech.segments and not speech.stresses and len(speech.spoken) <= 1


def test_a_flood_of_clauses_keeps_the_last() -> None:
    speech = SpeechSoFar()
    for n in range(5 * MOST):
        speech.tell(SpeechNews("comes", float(n), n + 0.5))
    assert len(speech.segments) == MOST and speech.segments[-1].start == 5 * MOST - 1
