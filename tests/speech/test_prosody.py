"""How loud and how fast segments are said, in any language, from words, texts or sound."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.transcripts.reader import read_transcript
from metagraph.graph.conversation.model import Segment, Word
from metagraph.speech.loudness import measure_loudness, measure_loudness_within
from metagraph.speech.prosody import count_letters, measure_prosody
from metagraph.speech.sound import read_sound

RATE = 8000


def tone(seconds: float, loud: float) -> np.ndarray:
    return loud * np.sin(2 * np.pi * 400 * np.arange(round(seconds * RATE)) / RATE)


def word(text: str, start: float, end: float) -> Word:
    return Word(text=text, start=start, end=end)


def test_spans_are_as_loud_as_the_standard_says_and_silence_is_not_known() -> None:
    samples = np.concatenate([tone(1, 0.1), np.zeros(RATE), tone(1, 0.2)])
    found = measure_loudness_within(
        samples, RATE, [(0.2, 0.8), (1.3, 1.7), (2.2, 2.8), (5.0, 6.0), (0.5, 0.5)]
    )
    assert np.isnan(found[[1, 3, 4]]).all()
    assert found[2] - found[0] == pytest.approx(20 * np.log10(2), abs=0.05)
    assert found[0] == pytest.approx(measure_loudness(tone(1, 0.1), RATE) or 0, abs=0.3)
    assert len(measure_loudness_within(samples, RATE, [])) == 0


def test_the_rate_is_of_letters_in_any_writing() -> None:
    assert count_letters("It's 10 o'clock!") == 11
    assert count_letters("नमस्ते") == 4, "marks of vowels belong to their letters"
    assert count_letters("今天天气") == 4 and count_letters("… —") == 0


def test_words_with_times_tell_the_rate_without_the_pauses_around_them() -> None:
    segments = [
        Segment("clause", 0.0, 2.0, 1.0),
        Segment("clause", 3.0, 4.0),
        Segment("hesitation", 5.0, 6.0),
    ]
    words = [word("hello", 0.5, 1.0), word("there", 1.0, 1.5), word("um", 5.1, 5.4)]
    found = measure_prosody(segments, words)
    assert found.rate[0] == pytest.approx(10.0)
    assert np.isnan(found.rate[1:]).all(), "nobody says what; and the partner hesitates"
    assert np.isnan(found.loudness).all()


def test_texts_tell_where_words_have_no_times_and_the_sound_where_there_are_no_texts() -> None:
    segments = [Segment("clause", 0.0, 2.0, 1.0, "hello there"), Segment("response", 3.0, 4.0, None, "yes")]
    assert measure_prosody(segments).rate.tolist() == [5.0, 3.0]
    bare = [Segment("clause", 0.0, 2.0), Segment("clause", 2.0, 4.0)]
    beats = [tone(0.15, 0.2) if n % 2 else np.zeros(round(0.1 * RATE)) for n in range(16)]
    slow = [tone(0.15, 0.2) if n % 2 else np.zeros(round(0.35 * RATE)) for n in range(8)]
    found = measure_prosody(bare, (), np.concatenate([*beats, *slow]), RATE)
    assert found.rate[0] == pytest.approx(4.0, abs=0.6) and found.rate[1] == pytest.approx(2.0, abs=0.6)


def test_nothing_said_and_nothing_known_is_no_error() -> None:
    empty = measure_prosody([])
    assert len(empty.loudness) == len(empty.rate) == 0
    unknown = measure_prosody([Segment("clause", 0.0, 1.0)])
    assert np.isnan(unknown.rate).all() and np.isnan(unknown.loudness).all()
    beyond = measure_prosody([Segment("clause", 9.0, 10.0)], (), tone(1, 0.1), RATE)
    assert np.isnan(beyond.loudness).all()


def test_real_speech_has_the_rate_of_speech_by_its_words_and_by_its_sound(shared_data: Path) -> None:
    folder = shared_data / "praatio-speech"
    (words,) = read_transcript(folder / "bobby_words.TextGrid").speakers.values()
    samples, rate = read_sound(folder / "bobby.wav")
    segments = [Segment("clause", words[0].start, words[-1].end)]
    told, heard = (
        measure_prosody(segments, words, samples, rate),
        measure_prosody(segments, (), samples, rate),
    )
    assert 8 < told.rate[0] < 25, "letters a second"
    assert 2 < heard.rate[0] < 8, "syllables a second"
    assert -45 < told.loudness[0] < -10 and told.loudness[0] == heard.loudness[0]
