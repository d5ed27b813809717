"""Voice activity: pauses, noise, clicks, and the partner heard through one's own microphone."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.speech.activity import find_activity, is_not_crosstalk, measure_crosstalk
from metagraph.speech.pitch import measure_pitch
from metagraph.speech.sound import analyse_sound
from tests.speech import talk

RATE = 16000


def room(seconds: float, level: float = 0.001) -> object:
    return level * np.random.default_rng(3).standard_normal(int(seconds * RATE))


def buzz(seconds: float, hertz: float = 130.0) -> object:
    phase = 2 * np.pi * hertz * np.arange(int(seconds * RATE)) / RATE
    return 0.2 * sum(np.sin(k * phase) / k for k in range(1, 20))


def with_sounds(seconds: float, *sounds: tuple[float, object]) -> np.ndarray:
    out = np.array(room(seconds))
    for at, sound in sounds:
        first = int(at * RATE)
        out[first : first + len(sound)] += sound
    return out


@pytest.mark.parametrize("samples", [np.zeros(3 * RATE), 1e-5 * np.ones(3 * RATE), room(5), room(5, 0.2)])
def test_silence_and_steady_noise_are_nobody_speaking(samples: object) -> None:
    assert find_activity(analyse_sound(np.asarray(samples), RATE)) == ()


def test_pauses_part_and_short_stops_do_not() -> None:
    samples = with_sounds(6, (1.0, buzz(0.8)), (1.9, buzz(0.6)), (3.5, buzz(1.0)))
    found = find_activity(analyse_sound(samples, RATE), measure_pitch(samples, RATE))
    assert [(s.start, s.end) for s in found] == [
        (pytest.approx(1.0, abs=0.06), pytest.approx(2.5, abs=0.06)),
        (pytest.approx(3.5, abs=0.06), pytest.approx(4.5, abs=0.06)),
    ]


def test_gain_does_not_matter() -> None:
    samples = with_sounds(6, (1.0, buzz(0.8)), (3.5, buzz(1.0)))
    assert find_activity(analyse_sound(samples, RATE)) == find_activity(analyse_sound(0.05 * samples, RATE))


def test_a_click_and_a_hiss_are_not_spoken() -> None:
    samples = with_sounds(
        6,
        (1.0, buzz(1.0)),
        (3.0, 0.5 * np.ones(80)),
        (4.0, 0.1 * np.random.default_rng(5).standard_normal(8000)),
    )
    assert len(find_activity(analyse_sound(samples, RATE), measure_pitch(samples, RATE))) == 1


@pytest.mark.parametrize("bleed", [-15.0, -20.0, -25.0])
def test_the_partner_in_ones_microphone_is_not_oneself(bleed: float) -> None:
    plain, mixed = talk.speak(), talk.speak(crosstalk=bleed)
    for side in (0, 1):
        clean = [analyse_sound(s, plain.rate) for s in plain.samples]
        heard = [analyse_sound(s, mixed.rate) for s in mixed.samples]
        assert measure_crosstalk(heard[side], heard[1 - side]) == pytest.approx(bleed, abs=3)
        want = find_activity(clean[side], None, clean[1 - side])
        found = find_activity(heard[side], None, heard[1 - side])
        assert len(found) == len(want)
        for a, b in zip(found, want, strict=True):
            assert abs(a.start - b.start) < 0.12 and abs(a.end - b.end) < 0.2


def test_who_never_speaks_is_not_taken_for_the_partner() -> None:
    loud = talk.speak().samples[0]
    soft = 10 ** (-18 / 20) * loud + 0.0004 * np.random.default_rng(2).standard_normal(len(loud))
    one, other = analyse_sound(loud, talk.RATE), analyse_sound(soft, talk.RATE)
    assert find_activity(other, None, one) == () and len(find_activity(one, None, other)) >= 5


def test_channels_that_hold_the_same_are_not_told_apart() -> None:
    one = analyse_sound(talk.speak().samples[0], talk.RATE)
    assert is_not_crosstalk(one, one).all()
