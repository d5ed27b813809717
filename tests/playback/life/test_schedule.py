"""When life happens: causal, repeatable, forgettable, at the rates people have."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.life import DIALS, Life, Manner, with_life
from metagraph.graph.words import MODES
from metagraph.playback.life.lane import Lane
from metagraph.playback.life.schedule import (
    AFTER_BLINK,
    BLOCK,
    DOUBLE,
    DOUBLES,
    Schedule,
    schedule,
)
from metagraph.playback.life.track import BlinkAt, LookAt, ModeFrom, PlaceFrom, Speech, Track, track_of
from metagraph.playback.life.voice import Voice, guess_voice
from metagraph.playback.life.wanted import PARTNER

LANES = ("breaths", "aversions", "saccades", "blinks", "modes", "swells", "emphases")
HOUR = 3600.0


def drawn(track: Track | None = None, end: float = 60.0, life: Life | None = None, seed: int = 1) -> Schedule:
    return schedule(life or Life(), track or Track(), {}, seed, end, Schedule(), 0.0)


def share(lane: Lane, start: float, end: float) -> float:
    """Events a minute between two times."""
    count = int(np.sum((np.array(lane.times) >= start) & (np.array(lane.times) < end)))
    return count / (end - start) * 60.0


def trains(rate: float, seed: int = 0) -> dict[str, Voice]:
    """Lines of speech with `rate` syllables a second, some of them stressed."""
    rng = np.random.default_rng(seed)
    out = {}
    for n in range(20):
        length = rng.uniform(1.5, 8)
        peaks = np.cumsum(rng.uniform(0.6 / rate, 1.4 / rate, int(length * rate) + 1))
        peaks = peaks[peaks < length]
        out[str(n)] = Voice(
            length, peaks, np.array([0, length]), np.zeros((2, 15)), rng.uniform(0.2, 1, len(peaks))
        )
    return out


def conversation(
    voices: dict[str, Voice], pauses: tuple[float, float] = (0.3, 1.2), end: float = HOUR
) -> Track:
    """Line after line, with pauses between."""
    rng = np.random.default_rng(1)
    names, at, out = list(voices), 0.5, []
    while at < end:
        name = names[rng.integers(len(names))]
        out.append(Speech(f"s{len(out)}", at, at + voices[name].duration, name))
        at += voices[name].duration + rng.uniform(*pauses)
    return track_of(out)


# --- drawing


def test_an_empty_schedule_holds_nothing() -> None:
    assert Schedule().end == 0 and not any(len(getattr(Schedule(), name)) for name in LANES)


def test_the_same_seed_gives_the_same_and_another_another() -> None:
    assert drawn(seed=7) == drawn(seed=7) != drawn(seed=8)


def test_nobody_begins_with_everybody_else() -> None:
    firsts = [(drawn(seed=n).breaths.starts[0], drawn(seed=n).blinks.starts[0]) for n in range(8)]
    assert np.std([b for b, _ in firsts]) > 0.5 and np.std([b for _, b in firsts]) > 0.3
    assert all(breath <= 0 for breath, _ in firsts), "somebody is always breathing"


def test_life_that_is_off_draws_nothing_and_comes_back() -> None:
    off = drawn(life=Life(on=False))
    assert off.end == 60 and not len(off.blinks)
    on = schedule(Life(), Track(), {}, 1, 60.0, off, 10.0)
    assert len(on.blinks) and on.targets


@pytest.mark.parametrize(
    "dial",
    [
        d
        for d in DIALS
        if d.name
        in (
            "breath_rate",
            "aversion_rate",
            "aversion_length",
            "aversion_angle",
            "saccade_rate",
            "blinks",
            "stillness",
        )
    ],
    ids=lambda d: d.name,
)
def test_every_rate_can_be_turned_off(dial: Any) -> None:
    silent = drawn(life=with_life(Life(), **{dial.name: dial.high if dial.name == "stillness" else dial.off}))
    gone = {
        "breath_rate": ["breaths"],
        "saccade_rate": ["saccades"],
        "blinks": ["blinks"],
        "stillness": ["aversions", "saccades", "blinks"],
    }
    for name in gone.get(dial.name, ["aversions"]):
        assert len(getattr(silent, name)) == 0


def test_stillness_calms_gradually() -> None:
    counts = []
    for stillness in (0.0, 0.3, 0.6, 0.9):
        found = drawn(end=600, life=Life(stillness=stillness))
        counts.append([len(getattr(found, name)) for name in ("breaths", "aversions", "saccades", "blinks")])
    assert (np.diff(counts, axis=0) < 0).all(), counts


# --- causality


def same_until(a: Schedule, b: Schedule, seconds: float) -> None:
    for name in LANES:
        assert getattr(a, name).until(seconds) == getattr(b, name).until(seconds), name
    assert [t for t in a.targets if t.start < seconds] == [t for t in b.targets if t.start < seconds]


TALK = [
    Speech("s", 4.0, 9.5, None, "Well, I think that we should go there tomorrow, if the weather is fine."),
    Speech("t", 12.0, 14.0, None, "What do you say?"),
    ModeFrom("m", 15.0, "listening"),
    ModeFrom("n", 24.0, None),
    LookAt("l", 16.0, 20.0, (1.0, 1.5, 1.0), strict=True),
    LookAt("k", 26.0, 29.0, "door"),
    BlinkAt("b", 21.3),
    BlinkAt("c", 30.0),
    PlaceFrom("p", 18.0, "user", (0.3, 1.5, 1.0)),
]


@pytest.mark.parametrize("step", [0.016, 0.25, 3.7])
@pytest.mark.parametrize("horizon", [0.1, 6.0])
def test_tick_by_tick_gives_what_one_call_gives(step: float, horizon: float) -> None:
    track, life = track_of(TALK), Life(stillness=0.1)
    found, now = Schedule(), 0.0
    while now < 40:
        found = schedule(life, track, {}, 3, now + horizon, found, now)
        now += step
    whole = schedule(life, track, {}, 3, found.end, Schedule(), 0.0)
    assert found == whole


@settings(max_examples=25)
@given(st.lists(st.floats(0.05, 9.0), min_size=1, max_size=12), st.integers(0, 2**32 - 1))
def test_uneven_ticks_give_what_one_call_gives(steps: list[float], seed: int) -> None:
    track = track_of(TALK)
    found, now = Schedule(), 0.0
    for n, step in enumerate(steps):
        found = schedule(Life(), track, {}, seed, now + 2.0 + n % 3, found, now)
        now += step
    assert found == schedule(Life(), track, {}, seed, found.end, Schedule(), 0.0)


@settings(max_examples=30)
@given(st.sets(st.sampled_from(range(len(TALK)))), st.floats(0.5, 35.0))
def test_what_is_asked_later_does_not_change_what_has_begun(late: set[int], now: float) -> None:
    early = track_of(item for n, item in enumerate(TALK) if n not in late)
    before = drawn(early, 40.0)
    after = schedule(Life(), track_of(TALK), {}, 1, 40.0, before, now)
    same_until(before, after, now)
    assert all((np.diff(getattr(after, name).starts) > 0).all() for name in LANES)


@pytest.mark.parametrize("now", [0.0, 7.3, 31.0])
def test_turning_a_dial_changes_only_what_comes(now: float) -> None:
    before = drawn(track_of(TALK), 40.0)
    after = schedule(Life(blinks=50, saccade_rate=0), track_of(TALK), {}, 1, 40.0, before, now)
    same_until(before, after, now)
    assert len(after.saccades.starts[after.saccades.starts >= now]) == 0
    assert len(after.blinks) > len(before.blinks)


def test_a_place_that_moves_changes_nothing_but_what_is_looked_at() -> None:
    track = track_of(TALK)
    before = drawn(track, 40.0)
    after = schedule(
        Life(), track.plus([PlaceFrom("q", 10.0, "user", (1.0, 1.0, 1.0))]), {}, 1, 40.0, before, 10.0
    )
    for name in LANES:
        assert getattr(after, name) is getattr(before, name) or getattr(after, name) == getattr(before, name)
    assert any(t.to == (1.0, 1.0, 1.0) for t in after.targets)


def test_what_was_drawn_ahead_is_not_drawn_again() -> None:
    first = drawn(end=BLOCK - 1)
    second = schedule(Life(), Track(), {}, 1, BLOCK - 0.5, first, 3.0)
    assert second.end == BLOCK - 0.5 and second.blinks is first.blinks and second.targets is first.targets


# --- forgetting


@settings(max_examples=25)
@given(st.floats(0.0, 38.0), st.integers(0, 50))
def test_forgetting_the_past_leaves_the_future_as_it_was(seconds: float, seed: int) -> None:
    track = track_of(TALK)
    whole = schedule(Life(), track, {}, seed, 40.0, Schedule(), 0.0)
    less = whole.since(seconds)
    for found in (
        schedule(Life(), track.since(seconds), {}, seed, 80.0, less, seconds),
        schedule(Life(), track, {}, seed, 80.0, less, seconds),
    ):
        want = schedule(Life(), track, {}, seed, 80.0, Schedule(), 0.0)
        for name in LANES:
            got, all_of = getattr(found, name), getattr(want, name)
            new = all_of.starts >= seconds
            assert np.array_equal(got.starts[got.starts >= seconds], all_of.starts[new]), name
            assert np.array_equal(got.values[got.starts >= seconds], all_of.values[new]), name


def test_forgetting_before_anything_has_happened_keeps_what_is_waited_for() -> None:
    life = Life(aversion_rate=2)
    track = track_of([ModeFrom("a", 0, "listening"), ModeFrom("b", 8, "talking")])
    whole = schedule(life, track, {}, 1, 16.0, Schedule(), 0.0)
    assert not len(whole.aversions), "the first comes later"
    want = schedule(life, track, {}, 1, 160.0, Schedule(), 0.0).aversions
    assert len(want) and schedule(life, track, {}, 1, 160.0, whole.since(14.0), 15.0).aversions == want


def test_an_hour_alive_stays_small() -> None:
    found, sizes, now = Schedule(), [], 0.0
    while now < HOUR:
        track = Track((), (Speech("s", now + 1, now + 5, None, "And then we went home again."),))
        found = schedule(Life(), track, {}, 1, now + 10, found.since(now - 1), now)
        sizes.append(sum(len(getattr(found, name)) for name in LANES) + len(found.targets))
        now += 6.0
    assert max(sizes) < 120 and max(sizes[-100:]) <= max(sizes[:300]) + 10


# --- blinks


def gaps(lane: Lane) -> np.ndarray[Any, Any]:
    return np.diff(lane.starts)


def test_at_rest_somebody_blinks_about_17_times_a_minute_at_times_that_spread_as_peoples_do() -> None:
    found = drawn(end=HOUR)
    between = gaps(found.blinks)
    assert between.min() > DOUBLE - 1e-6 and 0.6 < between.std() / between.mean() < 0.85
    assert np.mean(between < 0.5) == pytest.approx(DOUBLES, abs=0.03), "a few come in pairs"
    assert share(found.blinks, 0, HOUR) == pytest.approx(17, abs=1)


@pytest.mark.parametrize(("mode", "rate"), [("idle", 17), ("listening", 26)])
def test_who_listens_blinks_as_often_as_in_conversation_and_who_idles_as_at_rest(
    mode: Any, rate: float
) -> None:
    quiet = drawn(track_of([ModeFrom("m", 0, mode)]), HOUR)
    assert share(quiet.blinks, 0, HOUR) == pytest.approx(rate, abs=1.5)


@pytest.mark.parametrize("rate", [3.0, 4.0, 5.0, 6.0])
def test_who_speaks_blinks_26_times_a_minute(rate: float) -> None:
    voices = trains(rate)
    found = schedule(Life(), conversation(voices), voices, 1, HOUR, Schedule(), 0.0)
    assert share(found.blinks, 0, HOUR) == pytest.approx(26, abs=3)


@pytest.mark.parametrize("seed", range(3))
def test_who_speaks_by_letters_blinks_26_times_a_minute(seed: int) -> None:
    lines = [
        "Well, when I was a child, my grandmother used to tell me stories about the sea. She knew all the "
        "old songs.",
        "Yes, of course! Come in, sit down, and have a cup of tea with us.",
        "That is a very good question.",
        "The museum opens at nine in the morning and closes at half past five, except on Mondays, when it is "
        "closed all day.",
    ]
    voices = {text: guess_voice(text) for text in lines}
    found = schedule(Life(), conversation(voices), voices, seed, HOUR, Schedule(), 0.0)
    assert share(found.blinks, 0, HOUR) == pytest.approx(26, abs=3)


def test_the_first_syllable_of_a_speech_brings_a_blink_and_later_ones_only_a_second_after() -> None:
    voices = trains(4.0)
    track = conversation(voices, end=600)
    found = schedule(Life(), track, voices, 1, 600.0, Schedule(), 0.0)
    blinks = found.blinks.starts
    for speech in track.speeches:
        if speech.start > 590:
            continue
        first = speech.start + float(voices[speech.line or ""].peaks[0])
        before = blinks[blinks < first]
        assert first in blinks or (len(before) and first - before[-1] < 0.3), (
            "unless the lids are moving already"
        )
    stressed = np.flatnonzero(found.blinks.values[:, 0] == 1)
    firsts = {s.start + float(voices[s.line or ""].peaks[0]) for s in track.speeches}
    for n in stressed[1:]:
        if blinks[n] not in firsts:
            assert blinks[n] - blinks[n - 1] >= AFTER_BLINK


def test_stressed_words_can_be_left_unblinked() -> None:
    voices = trains(4.0)
    found = schedule(Life(accent_blinks=0), conversation(voices), voices, 1, HOUR, Schedule(), 0.0)
    assert set(found.blinks.values[:, 0]) == {0.0, 3.0} and share(found.blinks, 0, HOUR) < 18.5


def test_one_in_eight_blinks_by_itself_is_incomplete_and_none_that_is_asked_for() -> None:
    kinds = drawn(end=HOUR).blinks.values[:, 0]
    assert set(kinds) == {0.0, 3.0} and 0.09 < (kinds == 3.0).mean() < 0.15
    asked = track_of([BlinkAt(f"b{n}", 0.7 * n) for n in range(900)])
    wanted = drawn(asked, HOUR / 4, Life(blinks=0, accent_blinks=0)).blinks.values[:, 0]
    assert set(wanted) == {2.0}


def test_a_blink_asked_for_comes_at_its_time() -> None:
    wishes = [3.0, 3.05, 9.0, 30.5]
    found = drawn(track_of([BlinkAt(f"b{t}", t) for t in wishes]), life=Life(stillness=1.0))
    assert found.blinks.starts.tolist() == [3.0, 9.0, 30.5], "one asked for during a blink is that blink"


# --- the other rates


def test_rest_has_14_breaths_a_minute_each_a_little_different() -> None:
    found = drawn(end=HOUR)
    assert share(found.breaths, 0, HOUR) == pytest.approx(14, abs=0.5)
    assert np.ptp(found.breaths.values[:, 0]) > 0.5 and np.ptp(found.breaths.values[:, 1]) > 0.1
    assert np.allclose(found.breaths.starts[1:], found.breaths.starts[:-1] + found.breaths.values[:-1, 0]), (
        "one after the other"
    )


def test_a_mode_can_hold_its_breath() -> None:
    life = with_life(Life(), mode="listening", breath_rate=0.0)
    track = track_of([ModeFrom("m", 20, "listening"), ModeFrom("n", 40, None)])
    found = drawn(track, life=life)
    held = found.breaths.starts[(found.breaths.starts > 20) & (found.breaths.starts < 40)]
    assert len(held) == 0 and (found.breaths.starts > 40).any()
    ticked, now = Schedule(), 0.0
    while now < 58:
        ticked = schedule(life, track, {}, 1, now + 2, ticked, now)
        now += 0.5
    assert ticked.breaths.until(58) == found.breaths.until(58)


def away(found: Schedule, end: float = HOUR) -> tuple[float, float, float]:
    """Aversions a minute, their mean length, and the share of time they take."""
    lengths = found.aversions.values[:, 0] - found.aversions.starts
    return share(found.aversions, 0, end), float(lengths.mean()), float(lengths.sum() / end)


@pytest.mark.parametrize(
    ("mode", "rate", "length"), [("talking", 16.2, 2.14), ("listening", 12.0, 1.4), ("idle", 13.2, 2.2)]
)
def test_the_gaze_is_averted_as_often_and_as_long_as_documented(
    mode: Any, rate: float, length: float
) -> None:
    often, long, _ = away(drawn(track_of([ModeFrom("m", 0, mode)]), HOUR))
    assert often == pytest.approx(rate, rel=0.08) and long == pytest.approx(length, rel=0.08)


def test_a_listener_looks_more_than_an_idler_and_a_speaker_least() -> None:
    shares = [
        away(drawn(track_of([ModeFrom("m", 0, mode)]), HOUR))[2] for mode in ("listening", "idle", "talking")
    ]
    assert shares == sorted(shares) and 0.2 < shares[0] < 0.3
    assert 0.4 < shares[1] < 0.55 and 0.52 < shares[2] < 0.6


def test_aversions_never_meet_and_never_begin_during_a_strict_look() -> None:
    found = drawn(
        track_of([LookAt("l", 100, 300, "door", strict=True), LookAt("m", 400, 500, "door")]),
        600,
        Life(aversion_rate=40),
    )
    assert (found.aversions.starts[1:] - found.aversions.values[:-1, 0] >= 0.5).all()
    inside = (found.aversions.starts > 100.7) & (found.aversions.starts < 300)
    assert not inside.any()
    assert ((found.aversions.starts > 400) & (found.aversions.starts < 500)).any(), "an ordinary look averts"


def test_saccades_are_small_and_as_frequent_as_documented_with_fixations_between() -> None:
    found = drawn(track_of([ModeFrom("m", 0, "talking")]), HOUR)
    assert share(found.saccades, 0, HOUR) == pytest.approx(60, rel=0.05)
    size = np.hypot(found.saccades.values[:, 0], found.saccades.values[:, 1])
    assert gaps(found.saccades).min() >= 0.2 and size.max() <= 4.0 and 0.5 < size.mean() < 1.5
    assert found.saccades.values[:, 1].std() < found.saccades.values[:, 0].std(), (
        "more sideways than up and down"
    )


@given(
    st.builds(
        Manner,
        **{
            n: st.sampled_from([0.0, 0.5, 4.0])
            for n in ("breath_rate", "aversion_rate", "saccade_rate", "blinks")
        },
    )
)
def test_any_manner_is_survived(manner: Manner) -> None:
    life = Life(modes=dict.fromkeys(MODES, manner))
    found = drawn(track_of(TALK), 40.0, life)
    assert all((np.diff(getattr(found, name).starts) > 0).all() for name in LANES)
    assert found.targets[0].to == PARTNER


def test_who_thinks_looks_away_for_long_and_never_down():
    thinking = drawn(track_of([ModeFrom("m", 0, "thinking")]), HOUR)
    lengths = [row[0] - at for at, row in zip(thinking.aversions.times, thinking.aversions.rows, strict=True)]
    assert 3.0 < sum(lengths) / len(lengths) < 4.0
    assert all(row[2] >= 0 for row in thinking.aversions.rows)
    assert any(row[2] < 0 for row in drawn(track_of([ModeFrom("m", 0, "talking")]), HOUR).aversions.rows)


def test_who_reacts_looks_at_it_and_raises_the_brows_once():
    reacting = drawn(track_of([ModeFrom("m", 5.0, "reacting"), ModeFrom("n", 7.0, "listening")]), 20.0)
    assert [at for at in reacting.emphases.times if at < 8] == [5.0]
    assert len(drawn(track_of([ModeFrom("m", 5.0, "listening")]), 20.0).emphases.times) == 0
    away = [
        sum(row[0] - at for at, row in zip(some.aversions.times, some.aversions.rows, strict=True))
        for some in (drawn(track_of([ModeFrom("m", 0, m)]), HOUR) for m in ("reacting", "listening"))
    ]
    assert away[0] < 0.3 * away[1]


def test_who_is_about_to_speak_breathes_in():
    speaks = [12.0, 33.0, 61.0]
    track = track_of([ModeFrom(f"m{at}", at, "talking") for at in speaks])
    breaths = drawn(track, 90.0).breaths
    for at in speaks:
        assert min(abs(start - (at - 0.55)) for start in breaths.times) < 1e-6
    lengths = [row[0] for row in breaths.rows]
    assert max(lengths) < 3 * min(lengths)
