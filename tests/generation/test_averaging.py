import numpy as np
import pytest

from metagraph.generation.averaging import FAST, MOVING, Averaging, make_gaussian

PLAIN = Averaging(1.5, None)


def waving(count=200, size=1.0):
    """A joint that swings once in two seconds, and one that rests; both tremble."""
    at = np.arange(count) / 25
    trembling = 0.02 * np.where(np.arange(count) % 2, 1.0, -1.0)
    out = np.zeros((count, 12))
    out[:, :6] = (size * np.sin(np.pi * at))[:, None]
    return out, out + trembling[:, None]


def test_what_stands_still_stays_and_what_trembles_is_gone():
    still = np.full((9, 6), 3.0)
    trembling = np.tile([[1.0], [-1.0]], (20, 6))
    for averaging in (PLAIN, Averaging()):
        assert np.abs(averaging.whole(still) - still).max() < 1e-6
        assert np.abs(averaging.whole(trembling)[8:-8]).max() < 0.05
        assert len(averaging.whole(trembling[:1])) == 1
    assert (Averaging(0.0, None).whole(trembling) == trembling).all()


def test_weights_are_a_whole():
    assert make_gaussian(1.5).sum() == pytest.approx(1)
    assert len(make_gaussian(1.5)) == 11
    assert make_gaussian(0).tolist() == [1.0]


def test_a_joint_that_moves_is_averaged_over_fewer_frames_than_one_that_rests():
    size = 2 * FAST / (np.pi / 25)
    clean, heard = waving(size=size)
    found = Averaging().whole(heard)
    fastest = 25 * (1 + np.arange(7))  # where the sine goes through zero
    assert np.abs(found[fastest, :6] - Averaging(MOVING, None).whole(heard)[fastest, :6]).max() < 1e-6
    rests = np.abs(found[20:-20, 6:])
    assert rests.max() < 1e-3 < 0.5 * 0.02
    assert np.abs(found[20:-20] - clean[20:-20]).max() < 0.06 * size


def test_pieces_are_averaged_as_the_whole_is():
    _, heard = waving()
    averaging = Averaging()
    reach, heard = averaging.reach, heard.astype(np.float32)
    whole = averaging.of(heard)
    cut = [averaging.of(heard[n : n + 7 + 2 * reach]) for n in range(0, len(whole), 7)]
    assert (np.concatenate(cut) == whole).all()
    assert averaging.of(heard[: 2 * reach]).shape == (0, 12)
