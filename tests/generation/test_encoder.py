"""What a network hears of a frame."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.generation import encoder
from metagraph.generation.networks import Control
from tests.generation.makers import shaken, tiny

CHANCE = np.random.default_rng(4)


@pytest.mark.parametrize("dilations", [(1, 2, 4, 8), (3, 5, 7), (15,), (2, 4, 8, 1)])
def test_a_window_alone_hears_what_a_whole_recording_hears(dilations):
    control = Control(width=6, audio=3, dilations=dilations)
    w = {"control.input.weight": CHANCE.standard_normal((6, 8, 1)), "control.input.bias": np.ones(6)}
    for n in range(len(dilations)):
        w |= {f"control.blocks.{n}.weight": CHANCE.standard_normal((6, 6, 3)) * 0.2}
        w |= {f"control.blocks.{n}.bias": CHANCE.standard_normal(6)}
    features = CHANCE.standard_normal((50, 7))
    whole = encoder.encode_all(w, control, features)
    alone = encoder.encode_window(w, control, encoder.list_windows(features, 31), 25)
    assert whole.shape == alone.shape == (20, 6)
    assert np.abs(whole - alone).max() < 1e-10


def test_what_never_hears_ahead_is_told_the_same_alone_and_whole():
    control = Control(width=8, before=30, ahead=0)
    w = shaken(tiny("flow-vae"))
    features = CHANCE.standard_normal((40, 31)).astype(np.float32)
    alone = encoder.encode_window(w, control, encoder.list_windows(features, 31), 0)
    assert np.abs(encoder.encode_all(w, control, features) - alone).max() < 1e-5


@pytest.mark.parametrize("kind", ["window", "encoder"])
def test_what_comes_after_the_lookahead_is_not_heard(kind):
    sizes = tiny("flow-vae")
    control = Control(kind=kind, width=8)
    w = shaken(sizes)
    window = CHANCE.standard_normal((31, 31)).astype(np.float32)
    other = window.copy()
    other[5 + 1 + 4 :] = 9
    heard = encoder.encode_window(w, control, window, 4)
    assert (heard == encoder.encode_window(w, control, other, 4)).all()
    assert (heard != encoder.encode_window(w, control, other, 5)).any()
    assert (window != 0).all()  # it is left as it was


def test_the_lookahead_is_told_even_where_there_is_silence():
    sizes = tiny("flow-vae")
    w = shaken(sizes)
    silent = np.zeros((31, 31), np.float32)
    told = [encoder.encode_window(w, sizes.control, silent, g) for g in (0, 25)]
    assert np.abs(told[0] - told[1]).max() > 1e-3


def test_the_papers_window_is_frame_by_frame():
    control = Control(kind="window")
    window = np.arange(31 * 31, dtype=float).reshape(31, 31)
    assert (encoder.encode_window({}, control, window, 25) == np.arange(961)).all()
    poses = np.arange(5 * 54, dtype=float).reshape(5, 54)
    assert (encoder.encode_past({}, control, poses) == np.arange(270)).all()
    assert (encoder.encode_all({}, control, np.zeros((33, 31))) == np.zeros((3, 961))).all()


def test_a_chunks_control_is_padded_and_masked():
    sizes = tiny("matching")
    w = shaken(sizes)
    features = CHANCE.standard_normal((sizes.tokens * sizes.frames, 31)).astype(np.float32)
    heard, deaf = encoder.ChunkHearing(w, sizes, 3).of(features)
    other = features.copy()
    other[sizes.past * 4 + 4 :] = 5
    assert heard.shape == (7, 8)
    assert (encoder.ChunkHearing(w, sizes, 3).of(other)[0] == heard).all()
    assert (encoder.ChunkHearing(w, sizes, sizes.most).of(other)[0] != heard).any()
    silent = features.copy()
    silent[:, : sizes.audio] = 0
    assert np.abs(encoder.ChunkHearing(w, sizes, 3).of(silent)[0] + w["no_sound"] - deaf).max() < 1e-5
    assert (deaf != heard).any()


@pytest.mark.parametrize("kind", ["window", "encoder"])
@pytest.mark.parametrize("lookahead", [0, 6, 25])
def test_a_frame_is_heard_to_the_bit_the_same_however_much_is_known_of_the_next(kind, lookahead):
    control = Control(kind=kind, width=8)
    w = shaken(tiny("flow-vae"))
    features = CHANCE.standard_normal((31 + 20, 31)).astype(np.float32)
    alone = encoder.encode_window(w, control, encoder.list_windows(features, 31), lookahead)

    class Flat:
        told = staticmethod(np.array)

        def more(self, heard, first):
            return np.pad(heard, (first, 31 * 31 - first - len(heard)))

    def heard(start, known):
        hearing = encoder.EncoderHearing(w, control, lookahead, Flat())
        return np.stack([hearing.of(f, features[f : f + known]) for f in range(start, 21)])

    whole = heard(0, 99)
    assert np.abs(whole - alone).max() < 1e-5
    assert heard(0, 6 + lookahead).tobytes() == whole.tobytes()
    assert heard(0, 9 + lookahead).tobytes() == whole.tobytes()
    assert heard(5, 99).tobytes() == whole[5:].tobytes()  # begun anywhere else


@pytest.mark.parametrize("dilation", [1, 2, 5])
def test_a_layer_adds_a_sum_over_dilated_neighbours_to_what_it_reads(dilation):
    w = {"control.input.weight": np.zeros((4, 2, 1)), "control.input.bias": np.zeros(4)}
    w |= {
        "control.blocks.0.weight": CHANCE.standard_normal((4, 4, 3)),
        "control.blocks.0.bias": np.arange(4.0),
    }
    x = CHANCE.standard_normal((2, 14, 4))
    out = encoder.EncoderConvolutions(w, (dilation,), 1.0).layer(0, x, dilation)
    assert out.shape == (2, 14 - 2 * dilation, 4)
    for t in (0, out.shape[1] - 1):
        told = sum(w["control.blocks.0.weight"][:, :, k] @ x[1, t + k * dilation] for k in range(3))
        expected = x[1, t + dilation] + np.maximum(told + np.arange(4), 0)
        assert np.abs(out[1, t] - expected).max() < 1e-12


def test_too_few_frames_for_a_convolution_are_told():
    w = shaken(tiny("flow-vae"))
    with pytest.raises(ValueError, match=r"4 frames .*5"):
        encoder.encode_all(w, Control(width=8), np.zeros((6, 31), np.float32))
