"""Small events of the face: when they come, and that nothing shows if nothing happens."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.graph.life import Life
from metagraph.playback.life.expressions import CUE_LASTS, KEPT, FaceShown, answer, asks, settle, shown_face
from metagraph.playback.life.schedule import Schedule, schedule
from metagraph.playback.life.track import Item, ModeFrom, Speech, track_of
from metagraph.playback.life.voice import guess_voice
from metagraph.playback.planning.mood import Bearing, Mood, bearing

TIMES = np.arange(0.0, 40.0, 0.02)
TEXT = "We walked along the river for hours and talked of all the people we had known"
HAPPY, SAD = bearing(Mood(0.8, 0.1)), bearing(Mood(-0.7, -0.4))
CHANNELS = ("smile", "frown", "brow_down", "brow_up", "brows", "cheeks")


def values(face: FaceShown) -> list[float]:
    settle(face)
    return [getattr(face, channel) for channel in CHANNELS]


def drawn(*items: Item, life: Life | None = None, seed: int = 1) -> Schedule:
    return schedule(life or Life(), track_of(items), {}, seed, 40.0, Schedule(), 0.0)


def shown(found: Schedule, bears: Bearing | None = None, life: Life | None = None) -> dict[str, np.ndarray]:
    rows = []
    for t in TIMES:
        face = FaceShown()
        shown_face(face, life or Life(), found.swells, found.emphases, bears or Bearing(), float(t))
        rows.append(values(face))
    return dict(zip(CHANNELS, np.array(rows).T, strict=True))


def said(text: str, start: float = 2.0) -> Speech:
    return Speech("s", start, start + guess_voice(text).duration, None, text)


def test_who_is_in_no_mood_and_does_nothing_shows_nothing() -> None:
    assert all((each == 0).all() for each in shown(drawn()).values())


def test_a_moods_face_comes_up_and_goes_back_but_not_to_nothing() -> None:
    smile = shown(drawn(), HAPPY)["smile"]
    assert smile.min() == pytest.approx(KEPT * HAPPY.smile)
    assert smile.max() > 0.9 * HAPPY.smile
    assert 0.1 < (smile > 0.8 * HAPPY.smile).mean() < 0.6
    assert np.abs(np.diff(smile)).max() < 0.05, "no pops"


@pytest.mark.parametrize("life", [Life(expressions=0.0), Life(stillness=1.0)])
def test_without_expressions_a_moods_face_stands_as_it_is(life: Life) -> None:
    found = shown(drawn(said(TEXT + "?"), ModeFrom("m", 10.0, "listening")), SAD, life)
    assert (found["frown"] == SAD.frown).all() and (found["brow_up"] == SAD.brow_up).all()
    assert not found["brows"].any() and not found["smile"].any()


def test_brows_rise_on_as_many_stressed_syllables_as_the_dial_says() -> None:
    counts = [len(drawn(said(TEXT), life=Life(accent_brows=share)).emphases) for share in (0.0, 1.0)]
    assert counts == [0, len(guess_voice(TEXT).accents)]
    some = [len(drawn(said(TEXT), seed=seed).emphases) for seed in range(60)]
    assert 0.25 < np.mean(some) / counts[1] < 0.55


def test_a_raise_begins_just_before_its_syllable_and_is_soon_over() -> None:
    found = drawn(said(TEXT), life=Life(accent_brows=1.0))
    early = 2.0 + guess_voice(TEXT).accents - found.emphases.starts
    assert (early > 0).all() and early.max() == pytest.approx(0.06)
    assert found.emphases.values[:, 0].max() <= 0.65
    assert shown(found)["brows"].max() > 0.5


@pytest.mark.parametrize("mark", ["?", "? ", "？"])
def test_a_question_lifts_the_brows_towards_its_end(mark: str) -> None:
    quiet = Life(accent_brows=0.0)
    speech = said(TEXT + mark)
    brows = shown(drawn(speech, life=quiet), life=quiet)["brows"]
    assert brows[np.abs(TIMES - speech.end).argmin()] == pytest.approx(0.8, abs=0.02)
    assert not brows[speech.end - 0.85 > TIMES].any() and not brows[speech.end + 0.55 < TIMES].any()
    assert not shown(drawn(said(TEXT + "."), life=quiet), life=quiet)["brows"].any()


def test_a_question_that_is_cut_before_its_end_lifts_nothing() -> None:
    quiet = Life(accent_brows=0.0)
    cut = track_of([said(TEXT + "?")]).without({"s"}, 3.0)
    assert len(schedule(quiet, cut, {}, 1, 40.0, Schedule(), 0.0).emphases) == 0


def test_only_what_ends_in_a_question_mark_asks() -> None:
    assert asks(said("Why?")) and asks(said("Why?\n"))
    assert not asks(said("Why? Because.")) and not asks(Speech("s", 0, 1))


def test_a_listener_smiles_in_passing_but_not_who_feels_bad() -> None:
    found = drawn(ModeFrom("m", 0.0, "listening"))
    smile = shown(found)["smile"]
    assert 0.15 < smile.max() < 0.4 and (smile == 0).mean() > 0.3
    grim = shown(found, replace(SAD, frown=1.0))
    assert not grim["smile"].any()


def test_cheeks_rise_with_a_smile_that_is_more_than_polite() -> None:
    assert values(FaceShown(smile=0.2))[5] == 0
    assert values(FaceShown(smile=1.0))[5] == pytest.approx(1.0)


def test_a_greeting_flashes_the_brows_for_less_than_half_a_second_and_smiles_longer() -> None:
    faces = []
    for t in np.arange(0.0, 4.0, 0.02):
        face = FaceShown()
        answer(face, Life(), ["wave", "greeting"], 1.0, 3.5, float(t))
        faces.append(values(face))
    rows = np.array(faces)
    assert rows[:, 4].max() > 0.9
    assert 0.2 < 0.02 * (rows[:, 4] > 0.3).sum() < 0.45
    assert 0.8 < 0.02 * (rows[:, 0] > 0.3).sum() < CUE_LASTS
    assert not rows[:50].any() and not rows[int((1.0 + CUE_LASTS) / 0.02) :].any()


def test_what_a_cue_shows_is_over_with_the_cue() -> None:
    for t in np.arange(1.0, 1.6, 0.02):
        face = FaceShown()
        answer(face, Life(), ["positive"], 1.0, 1.5, float(t))
        assert face.smile <= 0.3 * max(0.0, 1.5 - t) / 0.2


def test_more_than_one_reason_to_smile_is_still_one_smile() -> None:
    face = FaceShown(smile=0.9)
    answer(face, Life(expressions=2.0), ["greeting", "positive", "agree"], 0.0, 4.0, 0.9)
    assert face.smile > 1 and max(values(face)) == 1
