"""Clips faster, slower and held: the same poses in order, at other times."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.motion.retime import Course, Hold, Retime, apply_retiming

holds = st.lists(st.tuples(st.floats(-1, 4), st.floats(0, 3)), max_size=5).map(
    lambda found: tuple(Hold(a, s) for a, s in found)
)
retimes = st.builds(Retime, st.floats(0.05, 6), holds)


@pytest.fixture(scope="module")
def clip(toy):
    return toy.clip("wave", 2.0, swing=1.0)


def test_a_plain_retiming_is_the_clip_itself(clip):
    assert apply_retiming(clip, Retime()) is clip


@pytest.mark.parametrize(("speed", "seconds"), [(2.0, 1.0), (0.5, 4.0), (1.25, 1.6)])
def test_speed_changes_how_long_it_is_and_not_where_it_goes(clip, speed, seconds):
    out = apply_retiming(clip, Retime(speed))
    assert out.fps == clip.fps and out.duration == pytest.approx(seconds, abs=0.5 / clip.fps)
    for pose, other in ((0, 0), (-1, -1), (out.frames // 2, clip.frames // 2)):
        assert np.allclose(out.rotations[pose], clip.rotations[other], atol=0.05)
    assert np.allclose(out.rotations[-1], clip.rotations[-1], atol=1e-5)


def test_a_hold_lengthens_the_clip_by_itself_and_stands_still(clip):
    retime = Retime(1.0, (Hold(0.7, 0.8),))
    out, course = apply_retiming(clip, retime), Course(retime, clip.duration, clip.fps)
    assert out.duration == pytest.approx(clip.duration + 0.8, abs=0.5 / clip.fps)
    first, last = course.stays[0]
    frames = range(int(np.ceil(first * out.fps)), int(last * out.fps))
    assert len(frames) > 10
    for n in frames:
        assert np.allclose(out.rotations[n], out.rotations[frames[0]], atol=1e-5)


def test_nothing_stops_dead_at_a_hold(clip):
    retime = Retime(1.0, (Hold(1.0, 0.8),))
    course = Course(retime, clip.duration, clip.fps)
    speed = np.gradient(course.moments(np.linspace(0, 2.8, 2801)), 0.001)
    assert np.abs(np.diff(speed)).max() < 0.05, "its speed falls and rises smoothly"
    assert speed.min() >= -1e-6 and speed.max() < 1.05


@given(retimes, st.floats(0, 2))
def test_whatever_is_asked_for_time_never_runs_back_and_both_ends_stay(retime, moment):
    kept = retime.kept(2.0)
    assert kept.kept(2.0) == kept
    course = Course(kept, 2.0, 30.0)
    moments = course.moments(np.arange(course.frames) / 30.0)
    assert (np.diff(moments) >= -1e-9).all()
    assert moments[0] == 0 and moments[-1] == pytest.approx(2.0)
    wanted = 2.0 / kept.speed + sum(h.seconds for h in kept.holds)
    assert (course.frames - 1) / 30 == pytest.approx(wanted, abs=0.5 / 30 + 1e-6)
    assert float(course.moments(np.array(course.time(moment)))) == pytest.approx(moment, abs=2e-3)
    assert course.time(moment, late=True) >= course.time(moment) - 1e-9


@given(retimes, retimes, st.floats(0, 20), st.floats(0, 20))
def test_moments_keep_their_order_from_one_retiming_to_another(a, b, one, other):
    one, other = sorted((one, other))
    before, after = Course(a.kept(2.0), 2.0, 30.0), Course(b.kept(2.0), 2.0, 30.0)
    assert before.along(one, after) <= before.along(other, after) + 2e-3


def test_what_is_before_a_new_hold_stays_and_what_is_after_it_goes_on(clip):
    plain, held = (Course(r, 2.0, 30.0) for r in (Retime(), Retime(1.0, (Hold(1.0, 0.6),))))
    assert plain.along(0.5, held) == pytest.approx(0.5, abs=0.01)
    assert plain.along(1.5, held) == pytest.approx(2.1, abs=0.02)
    assert plain.along(1.0, held, late=True) - plain.along(1.0, held) > 0.4
    assert held.along(plain.along(1.5, held), plain) == pytest.approx(1.5, abs=0.01)


def test_a_clip_of_one_frame_is_left_alone(toy):
    one = toy.clip("one", 2.0).trimmed(0, 1)
    assert apply_retiming(one, Retime(2.0)) is one
    assert Course(Retime(2.0), 0.0, 30.0).frames == 1
