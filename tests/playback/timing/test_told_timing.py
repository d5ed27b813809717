"""Words and visemes as synthesisers tell them: the mouth follows, and is shut between."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import requests as a
from metagraph.graph.face.names import VISEMES
from metagraph.graph.model import Project
from metagraph.playback.life.line_timing import ARKIT, AZURE, OCULUS, POLLY, SETS
from metagraph.playback.life.lips import compute_mouth_shapes
from metagraph.playback.life.utterances import VOICE
from metagraph.playback.life.voice import choose_voice
from metagraph.playback.plan import Plan
from metagraph.playback.planning.running_plan import RunningPlan, plan_performance
from metagraph.playback.timing.told_timing import read_given_timing

OPEN = [VISEMES.index(v) - 1 for v in ("aa", "E", "I", "O", "U")]
WORDS = [["Hello", 0.1, 0.5], ["there", 1.5, 1.9]]


def shown(plan: Plan, times: Any) -> Any:
    """Return how much of each shape but silence the mouth shows, `[N, 14]`."""
    found = compute_mouth_shapes(plan.track, {}, 0.03, np.asarray(times, float))
    return np.zeros((len(times), len(VISEMES) - 1)) if found is None else found


def said(project: Project, **fields: Any) -> Plan:
    return plan_performance(
        project, [a.make_request({"do": "say", "id": "s", "at": 1.0, **fields})], 10.0, idle=False
    )


def refusal(project: Project, **fields: Any) -> str:
    (report,) = said(project, **fields).reports
    return report.message


def test_the_mouth_is_shut_in_a_pause_between_words(sample: Project) -> None:
    pause = 1.0 + np.linspace(0.65, 1.35, 50)
    without = shown(said(sample, text="Hello there", duration=2.0), pause).sum(1).max()
    timed = shown(said(sample, words=WORDS), pause).sum(1).max()
    assert without > 0.7 and timed < 0.02
    spoken = shown(said(sample, words=WORDS), 1.0 + np.linspace(0.1, 0.5, 50)).sum(1).max()
    assert spoken > 0.7


def test_the_page_on_the_format_tells_when_the_mouth_is_shut(sample: Project) -> None:
    page = (Path(__file__).parents[3] / "docs" / "reference" / "life.md").read_text(encoding="utf-8")
    page = " ".join(page.split())
    found = re.search(r"`(\{\"do\": \"say\".*\})` the mouth is shut from (\S+) to (\S+) s", page)
    assert found is not None
    plan = plan_performance(sample, [a.read_request(found[1])], 10.0, idle=False)
    assert shown(plan, np.linspace(float(found[2]), float(found[3]), 50)).max() < 0.05
    assert shown(plan, [1.3, 2.7]).sum(1).min() > 0.4


def test_words_alone_are_what_is_said(sample: Project) -> None:
    (speech,) = said(sample, words=WORDS).track.speeches
    assert speech.text == "Hello there"
    assert speech.end == pytest.approx(1.0 + 1.9 + 0.065, abs=0.02), "the mouth needs a little to shut"
    accents = choose_voice({}, speech).accents
    assert 0.1 < accents[0] < 0.5


@pytest.mark.parametrize(
    "words",
    [
        [{"word": "Hello", "start": 0.1, "end": 0.5}, {"text": "there", "start": 1.5, "end": 1.9}],
        [
            {"audioOffset": 1_000_000, "duration": 4_000_000, "text": "Hello"},
            {"audioOffset": 15_000_000, "duration": 4_000_000, "text": "there"},
        ],
    ],
)
def test_words_may_be_objects(words: list[Any]) -> None:
    plain = read_given_timing(a.Say(words=tuple(WORDS)))
    assert read_given_timing(a.Say(words=tuple(words))) == plain


def test_what_polly_says_is_taken_as_it_is() -> None:
    marks = [
        {"time": 6, "type": "word", "start": 0, "end": 3, "value": "Map"},
        {"time": 6, "type": "viseme", "value": "p"},
        {"time": 80, "type": "viseme", "value": "a"},
        {"time": 200, "type": "viseme", "value": "p"},
        {"time": 260, "type": "viseme", "value": "sil"},
        {"time": 0, "type": "sentence", "start": 0, "end": 3, "value": "Map."},
    ]
    timing = read_given_timing(a.Say(visemes=tuple(marks)))
    assert timing is not None
    assert [m.viseme for m in timing.marks] == ["PP", "aa", "PP", "sil"]
    assert timing.marks[1].at == pytest.approx(0.08)
    assert [(w.text, w.end) for w in timing.words] == [("Map", pytest.approx(0.26))]


def test_what_azure_says_is_taken_as_it_is() -> None:
    marks = ({"audioOffset": 500_000, "visemeId": 21}, {"audioOffset": 1_500_000, "visemeId": 2}, [0.3, 0])
    timing = read_given_timing(a.Say(visemes=marks))
    assert timing is not None
    assert [(m.at, m.viseme) for m in timing.marks] == [(0.05, "PP"), (0.15, "aa"), (0.3, "sil")]


def test_blend_shapes_are_taken_with_their_weights() -> None:
    frames = tuple({"time": n / 60, "weights": {"jawOpen": 0.1 * n, "mouthFunnel": 0.2}} for n in range(6))
    timing = read_given_timing(a.Say(visemes=frames))
    assert timing is not None
    assert [m.viseme for m in timing.marks[:2]] == ["aa", "O"] and timing.marks[4].weight == pytest.approx(
        0.2
    )


@pytest.mark.parametrize(
    ("name", "table"), [("oculus", OCULUS), ("azure", AZURE), ("polly", POLLY), ("arkit", ARKIT)]
)
def test_a_set_is_known_by_its_names(name: str, table: dict[str, str]) -> None:
    marks = tuple([0.1 * n, viseme] for n, viseme in enumerate(table))
    guessed, named = (
        read_given_timing(a.Say(visemes=marks)),
        read_given_timing(a.Say(visemes=marks, set=name)),
    )  # type: ignore[arg-type]
    assert guessed == named and guessed is not None
    assert [m.viseme for m in guessed.marks] == list(table.values())
    assert set(table.values()) <= set(VISEMES) and name in SETS


@pytest.mark.parametrize(
    "marks",
    [[[0.0, "aa"], [0.2, "PP"], [0.3, "aa"], [0.5, "sil"]], [[0.0, 2], [0.2, 21], [0.3, 2], [0.5, 0]]],
)
def test_lips_meet_where_a_viseme_says_so(sample: Project, marks: list[Any]) -> None:
    found = shown(said(sample, visemes=marks), [1.1, 1.25, 1.4, 1.8])
    closed = VISEMES.index("PP") - 1
    assert found[1, closed] > 0.6 and found[0, OPEN].sum() > 0.5 and found[2, OPEN].sum() > 0.4
    assert found[3].sum() < 0.02


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"visemes": [[0.0, "aa"], [0.2, "xx"]]}, ("visemes[1] 'xx'", "oculus, azure, sapi, polly, arkit")),
        ({"visemes": [[0.0, "aa"]], "set": "polly"}, ("visemes[0] 'aa'", "not in the set 'polly'")),
        ({"visemes": [[0.0, "p"], [0.1, "jawOpen"]]}, ("no set has all of them", "polly")),
        ({"visemes": [[0.5, "aa"], [0.2, "PP"]]}, ("visemes[1] 'PP'", "before the one before it")),
        ({"visemes": [[-0.5, "aa"]]}, ("visemes[0] 'aa'", "times are from 0")),
        ({"visemes": [[0.5, "aa", 2.0]]}, ("visemes[0] 'aa'", "weights are from 0 to 1")),
        ({"visemes": [[0.5, "aa"]], "duration": 0.2}, ("visemes[0] 'aa'", "past the end at 0.200 s")),
        ({"visemes": ["aa"]}, ("visemes", "array")),
        ({"visemes": [["aa", 0.1]]}, ("visemes[0]", "[seconds, viseme]")),
        ({"words": [["a", 1.0, 0.5]]}, ("words[0] 'a'", "ends at 0.500 s, before it begins")),
        ({"words": [["a", 1.0, 1.2], ["b", 0.2, 0.4]]}, ("words[1] 'b'", "put words in order")),
        ({"words": [["a", -1.0, 1.2]]}, ("words[0] 'a'", "times are from 0")),
        ({"words": [["a", 0.0, 5.0]], "duration": 2.0}, ("words[0] 'a'", "past the end at 2.000 s")),
        ({"words": [[0.0, "a", 5.0]]}, ("words[0]", "[word, start, end]")),
        ({"words": [["a", 10**400, 1.0]]}, ("words[0]", "[word, start, end]")),
        ({"visemes": [[10**400, "aa"]]}, ("visemes[0]", "[seconds, viseme]")),
        ({"visemes": [[0.1, "aa", float("nan")]]}, ("visemes[0]", "[seconds, viseme]")),
        ({"visemes": [[0.1, float("inf")]]}, ("visemes[0]", "[seconds, viseme]")),
        ({"visemes": [{"time": 10**400, "type": "viseme", "value": "p"}]}, ("visemes[0]", "[seconds")),
        ({"visemes": [{"audioOffset": 10**400, "visemeId": 1}]}, ("visemes[0]", "[seconds, viseme]")),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_its_place_and_a_remedy(
    sample: Project, fields: dict[str, Any], words: tuple[str, ...]
) -> None:
    try:
        told = refusal(sample, **fields)
    except a.RequestError as error:
        told = str(error)
    assert all(word in told for word in words), told


# --- lines that are added to while they are said


def test_a_line_is_added_to_while_it_is_said_without_a_jump(sample: Project) -> None:
    words = [["one", 0.1, 0.4], ["two", 0.5, 0.8], ["three", 1.2, 1.6], ["four", 1.8, 2.2]]
    whole = RunningPlan(sample, idle=False)
    whole.hear(1.0, [a.make_request({"do": "say", "id": "s", "words": words})])
    for later in (words[2:], words):  # what is new alone, or all of it again
        growing = RunningPlan(sample, idle=False)
        growing.hear(1.0, [a.make_request({"do": "say", "id": "s", "words": words[:2]})])
        before = growing.plan
        growing.hear(1.6, [a.make_request({"do": "say", "id": "s", "words": later})])
        (speech,) = growing.plan.track.speeches
        (wanted,) = whole.plan.track.speeches
        assert speech == wanted
        said = np.arange(0.0, 1.6, 0.01)
        assert np.abs(shown(growing.plan, said) - shown(before, said)).max() < 1e-6
        fine = shown(growing.plan, np.arange(0.9, 4.0, 1 / 240))
        assert np.abs(np.diff(fine, axis=0)).max() < 0.12, "no shape comes or goes within a frame"


def test_what_has_been_said_stands_whatever_comes_later(sample: Project) -> None:
    running = RunningPlan(sample, idle=False)
    running.hear(
        1.0, [a.make_request({"do": "say", "id": "s", "words": [["one", 0.1, 0.4], ["two", 0.9, 1.2]]})]
    )
    running.hear(
        1.6, [a.make_request({"do": "say", "id": "s", "words": [["one", 0.1, 0.4], ["too", 0.9, 1.3]]})]
    )
    (speech,) = running.plan.track.speeches
    assert speech.timing is not None and [w.text for w in speech.timing.words] == ["one", "too"]


def test_what_comes_too_late_takes_nothing_back(sample: Project) -> None:
    running = RunningPlan(sample, idle=False)
    running.hear(
        1.0, [a.make_request({"do": "say", "id": "s", "words": [["one", 0.1, 0.4], ["two", 0.9, 1.2]]})]
    )
    running.hear(1.8, [a.make_request({"do": "say", "id": "s", "words": [["and", 0.45, 0.5]]})])
    (speech,) = running.plan.track.speeches
    assert speech.timing is not None and [w.text for w in speech.timing.words] == ["one", "two"]


def test_a_line_that_is_over_is_said_anew_under_its_id(sample: Project) -> None:
    running = RunningPlan(sample, idle=False)
    running.hear(1.0, [a.make_request({"do": "say", "id": "s", "words": WORDS})])
    again = [["please", 0.0, 0.4], ["open", 0.5, 0.8], ["both", 0.9, 4.0]]
    running.hear(5.0, [a.make_request({"do": "say", "id": "s", "words": again})])
    last = running.plan.track.last_speech("s")
    assert last is not None and last.start == pytest.approx(5.0 + VOICE)
    assert last.text == "please open both"
    assert shown(running.plan, last.start + np.linspace(0.9, 3.9, 50)).sum(1).max() > 0.7


@pytest.mark.parametrize("more", [[["again", 2.5, 3.2]], [*WORDS, ["again", 2.5, 3.2]]])
def test_words_that_come_after_a_line_has_run_out_still_belong_to_it(
    sample: Project, more: list[Any]
) -> None:
    running = RunningPlan(sample, idle=False)
    running.hear(1.0, [a.make_request({"do": "say", "id": "s", "words": WORDS})])
    (first,) = running.plan.track.speeches
    running.hear(first.end + 0.2, [a.make_request({"do": "say", "id": "s", "words": more})])
    last = running.plan.track.last_speech("s")
    assert last is not None and last.start == first.start and last.text == "Hello there again"


def hear_words(running: RunningPlan, now: float, *words: list[Any]) -> list[str]:
    """Say words under one id; return all that is said under it, in order, with when it begins."""
    running.hear(now, [a.make_request({"do": "say", "id": "s", "words": list(words)})])
    speech = running.plan.track.last_speech("s")
    assert speech is not None and speech.timing is not None
    return [f"{word.text} {word.start:.1f}" for word in speech.timing.words]


def test_a_piece_that_begins_at_0_again_comes_after_what_was_told(sample: Project) -> None:
    running = RunningPlan(sample, idle=False)
    hear_words(running, 1.0, ["I", 0.0, 0.3], ["saw", 0.4, 0.9])
    assert hear_words(running, 1.1, ["I", 0.0, 0.3]) == ["I 0.0", "saw 0.4"], "it is told again"
    hear_words(running, 1.2, ["a", 0.0, 0.1], ["bird", 0.1, 0.6])
    said = hear_words(running, 2.0, ["today", 0.0, 0.5])
    assert said == ["I 0.0", "saw 0.4", "a 0.9", "bird 1.0", "today 1.5"]


def test_words_that_are_late_are_said_at_once_and_what_follows_them_keeps_its_distance(
    sample: Project,
) -> None:
    running = RunningPlan(sample, idle=False)
    hear_words(running, 1.0, ["I", 0.0, 0.3], ["saw", 0.4, 0.9])
    hear_words(running, 4.0, ["a", 1.0, 1.1], ["bird", 1.2, 1.6])
    assert hear_words(running, 4.2, ["today", 1.8, 2.2]) == [
        "I 0.0", "saw 0.4", "a 3.0", "bird 3.2", "today 3.8",
    ]  # fmt: skip


def test_shapes_that_begin_at_0_again_come_after_those_that_were_told(sample: Project) -> None:
    running = RunningPlan(sample, idle=False)
    first, second = [[0.0, "aa"], [0.4, "sil"]], [[0.0, "O"], [0.3, "sil"]]
    for now, marks in ((1.0, first), (1.3, second)):
        running.hear(now, [a.make_request({"do": "say", "id": "s", "visemes": marks})])
    (speech,) = running.plan.track.speeches
    assert speech.timing is not None
    assert [m.viseme for m in speech.timing.marks if m.viseme != "sil"] == ["aa", "O"]
    assert speech.timing.marks[-1].at == pytest.approx(0.7)


def test_another_line_is_another_line(sample: Project) -> None:
    running = RunningPlan(sample, idle=False)
    running.hear(1.0, [a.make_request({"do": "say", "id": "s", "words": [["one", 0.1, 4.0]]})])
    running.hear(2.0, [a.make_request({"do": "say", "id": "t", "words": [["two", 0.1, 0.4]]})])
    first, second = running.plan.track.speeches
    assert first.end == second.start == pytest.approx(2.0 + VOICE)


def test_a_line_that_is_added_to_may_be_taken_back(sample: Project) -> None:
    running = RunningPlan(sample, idle=False)
    for now, start in ((1.0, 0.1), (1.4, 1.0)):
        running.hear(now, [a.make_request({"do": "say", "id": "s", "words": [["word", start, start + 0.8]]})])
    running.hear(1.5, [a.make_request({"do": "withdraw", "id": "w", "what": "s"})])
    (speech,) = running.plan.track.speeches
    assert speech.end == pytest.approx(1.5 + sample.settings.lookahead)


# --- whatever comes

numbers = st.floats(-1, 30) | st.integers(-1, 25)
entries = (
    st.tuples(numbers, st.sampled_from([*OCULUS, *POLLY, *ARKIT, "x", "", "21", 3]))
    | st.dictionaries(
        st.sampled_from(["time", "type", "value", "audioOffset", "visemeId", "id", "word", "start"]),
        numbers | st.sampled_from(["word", "viseme", "p", "sil"]),
    )
    | st.lists(st.none() | st.booleans() | numbers | st.text(max_size=5), max_size=4).map(tuple)
)  # fmt: skip


@given(st.lists(entries, max_size=6), st.lists(entries, max_size=6), st.none() | st.floats(0, 30))
def test_whatever_is_told_is_understood_or_refused(
    words: list[Any], marks: list[Any], duration: float | None
) -> None:
    ask = a.Say(words=tuple(words), visemes=tuple(marks), duration=duration)
    try:
        read_given_timing(ask)
    except a.RequestError as error:
        assert str(error).startswith(("words", "visemes"))


@given(st.lists(st.tuples(st.text(max_size=8), st.floats(0, 1), st.floats(0, 1)), min_size=1, max_size=8))
def test_every_moment_of_any_words_has_a_mouth(sample: Project, told: list[tuple[str, float, float]]) -> None:
    at, words = 0.0, []
    for text, pause, length in told:
        words.append([text, at + pause, at + pause + length])
        at += pause + length
    plan = said(sample, words=words)
    found = shown(plan, np.linspace(0.5, at + 4, 200))
    assert np.isfinite(found).all() and (found >= 0).all() and (found.sum(1) <= 1 + 1e-6).all()
    assert found[-1].sum() == 0
