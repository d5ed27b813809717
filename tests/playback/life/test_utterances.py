"""What is done to something said: it is broken off, paused, gone on with, finished."""

from __future__ import annotations

import pytest

from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.items import Speech, apart
from metagraph.playback.life.line_timing import SpokenWord, join_letters, measure_text, pace_text
from metagraph.playback.life.track import Track
from metagraph.playback.life.utterances import (
    PAUSED,
    break_off,
    explain_end,
    find_slot,
    find_soon,
    find_stop,
    find_utterances,
    finish_speech,
    goes_on,
    pause,
    resume,
)

LINE = Speech("a", 1.0, 3.0, text="It rains all day.")


def test_a_voice_stops_at_the_end_of_a_sound_and_at_the_latest_a_moment_later() -> None:
    track = Track(speeches=(LINE,))
    times = [1.5 + 0.01 * n for n in range(30)]
    stops = {find_stop(ALPHABET, track, "a", at, at + 0.06) - at for at in times}
    assert all(-0.03 <= stop <= 1e-9 for stop in stops)
    assert any(stop < -1e-3 for stop in stops), "a sound ends in time"


def test_a_line_whose_sounds_nobody_knows_stops_at_once() -> None:
    line = Speech("a", 1.0, 3.0, line="l1")
    assert find_stop(ALPHABET, Track(speeches=(line,)), "a", 2.0, 2.06) == pytest.approx(1.97)


def test_nothing_was_shown_at_the_beginning() -> None:
    assert find_soon(0.0, 0.1) == 0.0
    assert find_soon(5.0, 0.1) == 5.04
    assert find_soon(5.0, 0.0) == 5.0


def test_what_is_paused_is_found_and_goes_on_for_as_long_as_was_left() -> None:
    track = pause(Track(speeches=(LINE,)), "a", {"a"}, 2.0, find_slot(Track()))
    head, rest = track.speeches
    assert (head.end, head.length) == (2.0, 2.0) and (rest.start, rest.skip) == (PAUSED, 1.0)
    assert goes_on(track.speeches, "a", 100.0) and find_utterances(track, "", 100.0) == ["a"]
    assert explain_end(track.speeches, head) == ""
    head, rest = resume(track, "a", {"a"}, 7.0).speeches
    assert (rest.start, rest.end, rest.skip) == (7.0, pytest.approx(8.0), 1.0)
    assert explain_end((head, rest), rest) == "finished"


def test_two_that_are_paused_lie_apart() -> None:
    track = pause(Track(speeches=(LINE,)), "a", {"a"}, 2.0, find_slot(Track()))
    track = track.joined(Track(speeches=(Speech("b", 2.0, 4.0, text="That is so."),)))
    track = pause(track, "b", {"b"}, 3.0, find_slot(track))
    assert len([s for s in track.speeches if s.start >= PAUSED]) == 2
    assert find_utterances(track, "", 9.0) == ["a", "b"]


def test_what_is_broken_off_is_interrupted_whether_it_runs_is_silent_or_is_paused() -> None:
    (running,) = break_off(Track(speeches=(LINE,)), "a", 2.0).speeches
    assert explain_end((running,), running) == "interrupted"
    open_ = Speech("a", 1.0, 3.0, text="It rains", more=True)
    (silent,) = break_off(Track(speeches=(open_,)), "a", 5.0).speeches
    assert (silent.over, explain_end((silent,), silent)) == (5.0, "interrupted")
    paused = pause(Track(speeches=(LINE,)), "a", {"a"}, 2.0, PAUSED)
    (head,) = break_off(paused, "a", 9.0).speeches
    assert (head.end, head.over, explain_end((head,), head)) == (2.0, 9.0, "interrupted")


def test_what_has_more_to_come_is_over_when_it_is_finished() -> None:
    open_ = Speech("a", 1.0, 3.0, text="It rains", more=True)
    assert goes_on((open_,), "a", 50.0) and explain_end((open_,), open_) == ""
    (over,) = finish_speech(Track(speeches=(open_,)), "a", 50.0).speeches
    assert (over.over, explain_end((over,), over)) == (50.0, "finished")
    (running,) = finish_speech(Track(speeches=(open_,)), "a", 2.0).speeches
    assert running.over is None and not running.more


def test_all_pieces_of_what_is_not_over_are_remembered() -> None:
    pieces = (Speech("a", 1.0, 2.0, text="It", more=True), Speech("a", 5.0, 6.0, text=" rains", more=True))
    assert Track(speeches=pieces).since(60.0).speeches == pieces
    assert finish_speech(Track(speeches=pieces), "a", 61.0).since(90.0).speeches == ()


def test_who_is_cut_short_does_not_go_on_behind_who_cut_it() -> None:
    second = Speech("a", 3.0, 4.0, text="And more.")
    said = apart([LINE, Speech("b", 2.0, 2.5, text="No."), second])
    assert [(s.id, s.end) for s in said] == [("a", 2.0), ("b", 2.5)]


def test_words_follow_each_other_at_the_pace_of_their_letters() -> None:
    timing = pace_text(ALPHABET, " all day,", None)
    assert [w.text for w in timing.words] == ["all", "day"] and timing.paced
    assert timing.words[0].start > 0, "a blank takes its time"
    assert measure_text(ALPHABET, " all day,") > timing.words[1].end + 0.05, "so does a comma"


def test_letters_make_words_and_syllables_are_words() -> None:
    letters = [SpokenWord(c, 0.1 * n, 0.1 * n + 0.1) for n, c in enumerate("Hi 二三")]
    assert [(w.text, w.start) for w in join_letters(ALPHABET, letters)] == [
        ("Hi", 0.0), ("二", pytest.approx(0.3)), ("三", pytest.approx(0.4)),
    ]  # fmt: skip
