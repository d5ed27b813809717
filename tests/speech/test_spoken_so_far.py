"""What of an utterance was spoken until a moment."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.items import Speech, pace_speech
from metagraph.playback.life.line_timing import LineTiming, SpokenWord
from metagraph.playback.life.track import Track
from metagraph.playback.life.utterances import PAUSED, pause, resume
from metagraph.speech.spoken_so_far import spoken_until

RAIN = Speech("a", 1.0, 4.0, text="It rains all day, so take a coat.")


@pytest.mark.parametrize(
    ("seconds", "text", "last"),
    [(0.5, "", ""), (1.05, "It", "It"), (2.3, "It rains all day,", "day"), (9.0, RAIN.text, "coat")],
)
def test_words_are_spoken_in_turn(seconds: float, text: str, last: str) -> None:
    assert spoken_until(ALPHABET, (RAIN,), "a", seconds) == (text, last)


def test_what_was_said_before_a_pause_counts() -> None:
    track = pause(Track(speeches=(RAIN,)), "a", {"a"}, 2.3, PAUSED)
    assert spoken_until(ALPHABET, track.speeches, "a", 50.0) == ("It rains all day,", "day")
    track = resume(track, "a", {"a"}, 60.0)
    assert spoken_until(ALPHABET, track.speeches, "a", 90.0) == (RAIN.text, "coat")


def test_pieces_of_words_are_put_together() -> None:
    first = pace_speech(ALPHABET, Speech("a", 1.0, 1.0, text="It rai", more=True))
    second = pace_speech(ALPHABET, Speech("a", 5.0, 5.0, text="ns, again", more=True))
    assert spoken_until(ALPHABET, (first, second), "a", 9.0) == ("It rains, again", "again")
    assert spoken_until(ALPHABET, (first, second), "a", 5.01)[0] == "It rains,"


def test_words_with_their_times_are_counted_by_them() -> None:
    timing = LineTiming((SpokenWord("It", 0.0, 0.2), SpokenWord("rains", 2.0, 2.5)))
    said = replace(RAIN, text="It ... rains!", timing=timing)
    assert spoken_until(ALPHABET, (said,), "a", 2.9) == ("It", "It")
    assert spoken_until(ALPHABET, (said,), "a", 3.1) == ("It ... rains!", "rains")
    otherwise = replace(said, text="Something else")
    assert spoken_until(ALPHABET, (otherwise,), "a", 3.1) == ("It rains", "rains")


def test_of_two_utterances_under_one_id_the_last_counts() -> None:
    again = Speech("a", 10.0, 12.0, text="No.", asked=10.0)
    assert spoken_until(ALPHABET, (RAIN, again), "a", 11.5) == ("No.", "No")
