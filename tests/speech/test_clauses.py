"""Clauses, responses and hesitations: by word lists, by pauses, by stress; and how much of what was written
is found in speech.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.conversation.model import HESITATIONS, RESPONSES, Segment, Side, Word
from metagraph.graph.vocabulary import Vocabulary, split_tokens
from metagraph.speech.clauses import find_segments, order_words
from metagraph.speech.pitch import Pitch, measure_pitch
from metagraph.speech.sound import HeardSound, analyse_sound
from tests.speech import talk

HEARD = analyse_sound(0.001 * np.random.default_rng(0).standard_normal(16000 * 30), 16000)
VOICELESS = Pitch(HEARD.times, np.full(len(HEARD.times), np.nan))


def words(text: str, each: float = 0.25) -> list[Word]:
    """Words one after another; a number is a pause of so many seconds."""
    out, at = [], 0.5
    for piece in text.split():
        if piece.replace(".", "", 1).isdigit():
            at += float(piece)
            continue
        out.append(Word(text=piece.replace("_", " "), start=round(at, 3), end=round(at + each, 3)))
        at += each
    return out


def kinds(text: str, **lists: tuple[str, ...]) -> list[tuple[str, str]]:
    return [(s.kind, s.text) for s in find_segments(words(text), VOICELESS, HEARD, **lists)]


def test_words_are_compared_without_case_punctuation_and_hyphens() -> None:
    assert split_tokens("Uh-huh.") == split_tokens("uh huh") == ("uh", "huh") and split_tokens(
        "%HESITATION "
    ) == ("%hesitation",)
    assert split_tokens("I’m") == ("i'm",) and split_tokens("--") == () and split_tokens("'Yes!'") == ("yes",)


def test_the_longest_phrase_counts() -> None:
    said = [split_tokens(w) for w in ("uh", "huh", "you", "know", "what")]
    assert Vocabulary(("uh", "uh-huh")).at(said, 0) == 2 and Vocabulary(("you know",)).at(said, 2) == 2
    assert Vocabulary(("you know that",)).at(said, 2) == 0 and Vocabulary(()).at(said, 0) == 0


@pytest.mark.parametrize(
    "text", ["yeah", "Uh-huh.", "uh huh", "I see", "Oh, wow!", "yeah yeah yeah", "mm-hmm", "I_see"]
)
def test_a_turn_of_response_words_alone_is_a_response(text: str) -> None:
    assert [k for k, _ in kinds(f"so he left 1 {text} 1 then we went home")] == [
        "clause",
        "response",
        "clause",
    ]


def test_a_response_word_in_a_sentence_is_part_of_it() -> None:
    assert all(k == "clause" for k, _ in kinds("yes he was right about that"))


@pytest.mark.parametrize("text", ["uh", "um", "%HESITATION", "Hmm,", "um uh"])
def test_hesitations_part_a_sentence(text: str) -> None:
    found = kinds(f"he went {text} back home")
    assert [k for k, _ in found] == ["clause", "hesitation", "clause"] and found[1][1] == text


@pytest.mark.parametrize(
    ("text", "hesitates"),
    [
        ("well 0.5 I think so", True),
        ("and he was like 0.4 really angry", True),
        ("you know um 0.4 we left", True),
        ("we went well beyond that", False),
        ("do you like me", False),
        ("what would you like 4 nothing", False),
        ("do you know? 0.5 yes", False),
    ],
)
def test_words_with_a_meaning_hesitate_only_where_speech_stops(text: str, hesitates: bool) -> None:
    assert any(k == "hesitation" for k, _ in kinds(text)) is hesitates


def test_the_lists_can_be_changed() -> None:
    assert kinds("ja 1 äh 1 nein", responses=("ja",), hesitations=("äh",)) == [
        ("response", "ja"),
        ("hesitation", "äh"),
        ("clause", "nein"),
    ]
    assert kinds("yeah 1 uh", responses=(), hesitations=()) == [("clause", "yeah"), ("clause", "uh")]


def test_pauses_and_sentences_part_clauses() -> None:
    assert kinds("he bought a car 0.4 she sold it") == [
        ("clause", "he bought a car"),
        ("clause", "she sold it"),
    ]
    assert kinds("he bought a car. She sold it") == [
        ("clause", "he bought a car."),
        ("clause", "She sold it"),
    ]


def test_long_runs_become_clauses_of_about_four_words() -> None:
    text = (
        "when we came to the river the boat was gone and nobody knew who had taken it because the keeper "
        "was asleep in his house"
    )
    found = kinds(text)
    assert " ".join(t for _, t in found) == text and 4 <= len(found) <= 8
    assert not any(t.split()[-1] in ("the", "a", "of", "and", "was", "in") for _, t in found)


def test_words_out_of_order_and_past_the_end_are_settled() -> None:
    given = [
        Word(text="b", start=2, end=3),
        Word(text="a", start=1, end=2.5),
        Word(text="c", start=9, end=12),
        Word(text="d", start=11, end=12),
    ]
    assert [(w.text, w.start, w.end) for w in order_words(given, 10)] == [
        ("a", 1, 2),
        ("b", 2, 3),
        ("c", 9, 10),
    ]


def test_a_voiceless_clause_has_its_peak_where_it_is_loudest() -> None:
    samples = 0.001 * np.random.default_rng(0).standard_normal(16000 * 4)
    samples[24000:25600] *= 100
    (found,) = find_segments(
        [Word(text="hush", start=1, end=2)],
        Pitch(VOICELESS.times[:401], VOICELESS.hertz[:401]),
        analyse_sound(samples, 16000),
    )
    assert found.peak == pytest.approx(1.55, abs=0.06)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["so", "uh", "yeah", "you", "know", "house", "well", "", "--", "uh-huh", "the"]),
            st.floats(0, 29),
            st.floats(0, 2),
        ),
        max_size=25,
    )
)
def test_segments_never_overlap_whatever_the_words(rows: list[tuple[str, float, float]]) -> None:
    found = find_segments([Word(text=t, start=a, end=a + b) for t, a, b in rows], VOICELESS, HEARD)
    Side(segments=found)  # says so itself
    assert all(s.end <= HEARD.duration for s in found)


# --- in speech


def heard_of(spoken: talk.Talk) -> list[tuple[HeardSound, Pitch]]:
    return [(analyse_sound(s, spoken.rate), measure_pitch(s, spoken.rate)) for s in spoken.samples]


def of_side(spoken: talk.Talk, side: int, worded: bool) -> tuple[Segment, ...]:
    heard = heard_of(spoken)
    said = [Word(text=t, start=a, end=b) for t, a, b in spoken.words[side]] if worded else []
    return find_segments(said, heard[side][1], heard[side][0], RESPONSES, HESITATIONS, heard[1 - side][0])


@pytest.mark.parametrize("bleed", [None, -18.0])
def test_what_was_written_is_found_in_speech(bleed: float | None) -> None:
    spoken = talk.speak(crosstalk=bleed)
    written, begun, found, sizes = 0, 0, 0, []
    for side in (0, 1):
        got, want = of_side(spoken, side, True), [s for s in spoken.said if s.side == side]
        for kind in ("response", "hesitation"):
            assert [(s.start, s.end) for s in got if s.kind == kind] == [
                (s.start, s.end) for s in want if s.kind == kind
            ]
        clauses = [s for s in got if s.kind == "clause"]
        starts = {s.start for s in want if s.kind == "clause"}
        written, found, begun = (
            written + len(starts),
            found + len(clauses),
            begun + len(starts & {s.start for s in clauses}),
        )
        sizes += [len(s.text.split()) for s in clauses]
        for s in want:  # the stressed word has a peak
            if s.stress is not None:
                assert any(s.stress[0] - 0.08 <= (c.peak or -1) <= s.stress[1] + 0.08 for c in clauses), s
    assert begun / written >= 0.95 and begun / found >= 0.75
    assert 3.4 <= np.mean(sizes) <= 5.0 and 0.7 <= np.std(sizes) <= 2.2


@pytest.mark.parametrize("bleed", [None, -18.0])
def test_without_words_pauses_and_short_answers_are_found(bleed: float | None) -> None:
    spoken = talk.speak(crosstalk=bleed)
    for side in (0, 1):
        got = of_side(spoken, side, False)
        want = [s for s in spoken.said if s.side == side]
        assert all(
            any(s.start < w.end + 0.1 and s.end > w.start - 0.1 for w in want) for s in got
        )  # nothing that was not said
        missed = [
            w
            for w in want
            if w.kind != "hesitation" and not any(s.start < w.end and s.end > w.start for s in got)
        ]
        assert not missed
        answers = [w for w in want if w.kind == "response"]
        right = [
            w
            for w in answers
            if any(s.kind == "response" and s.start < w.end and s.end > w.start for s in got)
        ]
        assert len(right) >= len(answers) - 1
        assert all(b.start >= a.end for a, b in itertools.pairwise(got))
