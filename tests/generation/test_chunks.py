"""Codes, tokens and chunks."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.generation import chunks, cvae, vae
from metagraph.generation.networks import Control, CvaeSizes, FlowSizes, MatchingSizes
from tests.generation.makers import shaken, tiny

CHANCE = np.random.default_rng(8)


def test_components_tell_most_of_what_varies_together():
    source = CHANCE.standard_normal((400, 3)) @ CHANCE.standard_normal((3, 20)) + 5
    w = vae.find_principal_components(source, 3, "code")
    sizes = FlowSizes(pose=20, code="pca", dims=3)
    codes = vae.encode_spans(w, sizes, source)
    assert np.allclose(codes.mean(0), 0, atol=1e-5)
    assert np.allclose(np.cov(codes, rowvar=False, bias=True), np.eye(3), atol=1e-4)
    assert np.abs(vae.decode_spans(w, sizes, codes) - source).max() < 1e-4
    assert np.abs(vae.Decoder(w, sizes).one(codes[7].astype(np.float32)) - source[7]).max() < 1e-4
    assert np.allclose(w["code.basis"] @ w["code.basis"].T, np.eye(3), atol=1e-5)
    assert (np.diff(w["code.deviation"]) <= 0).all()
    again = vae.find_principal_components(source, 3, "code")
    assert all((again[n] == w[n]).all() for n in w)


def test_components_of_too_few_rows_are_refused():
    with pytest.raises(ValueError, match=r"3 stretches .*3 components"):
        vae.find_principal_components(np.zeros((3, 9)), 3, "code")
    assert np.isfinite(vae.find_principal_components(np.ones((9, 4)), 2, "code")["code.deviation"]).all()


@pytest.mark.parametrize("code", ["none", "autoencoder", "variational"])
def test_a_codes_mean_and_deviation_come_off_and_on(code):
    dims = 78 if code == "none" else 7
    sizes = FlowSizes(code=code, dims=dims)
    w = shaken(sizes)
    poses = CHANCE.standard_normal((4, 78)).astype(np.float32)
    plain, back = (
        vae.encode_spans(w, sizes, poses),
        vae.decode_spans(w, sizes, vae.encode_spans(w, sizes, poses)),
    )
    assert plain.shape == (4, dims)
    assert back.shape == (4, 78)
    if code != "none":
        w["code.mean"], w["code.deviation"] = w["code.mean"] + 3, w["code.deviation"] * 2
        assert np.allclose(vae.encode_spans(w, sizes, poses), (plain - 3) / 2, atol=1e-5)
        assert np.allclose(vae.decode_spans(w, sizes, vae.encode_spans(w, sizes, poses)), back, atol=1e-4)
    one = vae.Decoder(w, sizes).one(vae.encode_spans(w, sizes, poses)[2])
    assert np.allclose(one, back[2], atol=1e-4)


def test_what_is_drawn_by_a_guess_varies_and_moves_as_what_it_was_made_of():
    """Of a process that it can tell whole: two numbers that go round, with a little chance."""
    turn, codes = np.array([[0.9, -0.3], [0.3, 0.9]]), [np.zeros(2)]
    for _ in range(20000):
        codes.append(codes[-1] @ turn.T + CHANCE.standard_normal(2) * (0.1, 0.4))
    codes = np.array(codes)
    w = vae.fit_guess([codes[:9000], codes[9000:]], 2, 0.0)
    guess, past, drawn = vae.Guess(w), np.zeros((2, 2), np.float32), []
    for _ in range(20000):
        new = guess.one(past.reshape(-1), CHANCE.standard_normal(2).astype(np.float32)).copy()
        past = np.stack([past[1], new])
        drawn.append(new)
    for make in (np.asarray, lambda rows: np.diff(rows, axis=0)):
        assert np.allclose(make(drawn).std(0), make(codes).std(0), rtol=0.06)
    lacked = guess.find_lacked(codes[2:], vae.join_past(codes, 2))
    assert np.allclose(np.cov(lacked, rowvar=False), np.eye(2), atol=0.02)
    again = guess.one(codes[:2].reshape(-1).astype(np.float32), lacked[0].astype(np.float32))
    assert np.abs(again - codes[2]).max() < 1e-5


def test_a_guess_from_too_few_codes_is_refused():
    with pytest.raises(ValueError, match="3 stretches are too few for a guess from 2 codes"):
        vae.fit_guess([np.zeros((5, 4)), np.zeros((2, 4))], 2, 0.1)


def test_copies_of_one_number_are_one_dimension():
    source = CHANCE.standard_normal((5000, 6))
    assert vae.count_effective_dimensions(source) > 5.9
    assert vae.count_effective_dimensions(source[:, :1] * np.arange(1, 7)) < 1.01
    assert 1.9 < vae.count_effective_dimensions(np.repeat(source[:, :2], 3, 1)) < 2.1


def test_frames_are_put_in_rows_and_the_rest_is_left_out():
    assert vae.list_spans(np.arange(22).reshape(11, 2), 4).tolist() == [[*range(8)], [*range(8, 16)]]


def test_tokens_of_all_components_give_their_poses_back():
    sizes = MatchingSizes(pose=5, dims=20)
    poses = np.cumsum(CHANCE.standard_normal((400, 5)), 0)
    w = vae.find_principal_components(vae.list_spans(poses, 4), 20, "tokens")
    tokens = chunks.make_tokens(w, sizes, poses)
    assert tokens.shape == (100, 20)
    assert np.abs(chunks.join_token_poses(w, sizes, tokens) - poses).max() < 1e-3
    held = chunks.make_still_tokens(w, sizes, poses[7])
    assert held.shape == (6, 20)
    assert np.ptp(held, axis=0).max() == 0


def _few_components():
    """Smooth motion, and less of its components than there are."""
    sizes = MatchingSizes(pose=5, dims=7, around=1)
    rows = np.cumsum(CHANCE.standard_normal((4000, 5)), 0)
    poses = np.stack([np.convolve(r, np.ones(5) / 5, "same") for r in rows.T], 1)
    w = vae.find_principal_components(vae.list_spans(poses, 4), 7, "tokens")
    tokens = chunks.make_tokens(w, sizes, poses)
    w["tokens.joined"] = chunks.join_by_least_squares(
        [(tokens, vae.list_spans(poses, 4) - w["tokens.mean"])], 1
    )
    return sizes, w, poses, tokens


def test_pieces_told_by_their_neighbours_meet():
    sizes, w, poses, tokens = _few_components()
    apart = chunks.join_token_poses(w, sizes, tokens)
    joining = chunks.Joining(w, sizes, len(tokens))
    together = np.concatenate([joining.of(tokens), joining.rest()])
    assert together.shape == poses.shape

    def seams(made):
        """How far frames are from what they were, at the seams of pieces and all over."""
        wrong = np.abs(np.diff(made - poses, axis=0)).mean(1)
        return wrong[3::4].mean(), wrong.mean()

    assert seams(together)[0] < 0.6 * seams(apart)[0]
    assert seams(together)[1] < seams(apart)[1]


def test_pieces_come_out_once_and_in_order_however_many_at_once():
    sizes, w, _, tokens = _few_components()
    for count in (1, 2, 5):
        joining = chunks.Joining(w, sizes, count)
        parts = [joining.of(tokens[n : n + count]) for n in range(0, 40, count)]
        assert len(parts[0]) == 4 * (count - 1)
        made = np.concatenate([*parts, joining.rest()])
        whole = chunks.Joining(w, sizes, 40)
        assert np.allclose(made, np.concatenate([whole.of(tokens[:40]), whole.rest()]), atol=1e-5)
    assert chunks.Joining(w, sizes, 2).rest().shape == (0, 5)


def test_a_model_whose_pieces_are_told_alone_gives_them_at_once():
    _, w, _, tokens = _few_components()
    alone = MatchingSizes(pose=5, dims=7)
    joining = chunks.Joining(w, alone, 2)
    assert joining.delay == 0
    assert np.array_equal(joining.of(tokens[:2]), chunks.join_token_poses(w, alone, tokens[:2]))
    assert not len(joining.rest())


def _places(sizes: MatchingSizes):
    w = shaken(sizes, dtype=np.float64)
    heard = CHANCE.standard_normal((sizes.tokens, sizes.hidden))
    past, noise = (CHANCE.standard_normal((n, sizes.dims)) for n in (sizes.past, sizes.new))
    return w, heard, past, noise


def test_guidance_is_between_and_beyond_both_velocities():
    sizes = tiny("matching")
    assert isinstance(sizes, MatchingSizes)
    w, heard, past, noise = _places(sizes)
    free = heard[::-1] + 0.3
    both = np.stack([heard, free])
    drawn = [chunks.TokenDrawing(w, sizes, g, 1).draw(noise, past, both) for g in (0.0, 1.0, 2.0)]
    told = chunks.TokenDrawing(w, sizes, 1.0, 1).draw(noise, past, free[None])
    assert np.abs(drawn[0] - told).max() < 1e-12
    assert np.abs(drawn[2] - (2 * drawn[1] - drawn[0])).max() < 1e-12


def test_eulers_steps_follow_a_straight_line_exactly():
    """A network that always says the same goes as far in 1 step as in 8."""
    sizes = tiny("matching")
    assert isinstance(sizes, MatchingSizes)
    w, heard, past, noise = _places(sizes)
    w["final.out.weight"] *= 0
    for steps in (1, 8):
        out = chunks.TokenDrawing(w, sizes, 2.0, steps).draw(noise, past, np.stack([heard, -heard]))
        assert np.abs(out - (noise + w["final.out.bias"])).max() < 1e-12


def test_a_cvae_frame_by_frame_is_the_whole():
    sizes = CvaeSizes(pose=9, control=Control(past=0, width=4), dims=3, units=5, layers=3)
    w = shaken(sizes, dtype=np.float64)
    codes, context = CHANCE.standard_normal((8, 3)), CHANCE.standard_normal((8, 4))
    whole = cvae.decode_cvae(w, sizes, codes, context)
    drawing = cvae.CvaeDrawing(w, sizes)
    told = drawing.told(context)
    for t in range(8):
        assert np.abs(drawing.draw(codes[t], told[t]) - whole[t]).max() < 1e-12
    mean, log_variance = cvae.encode_cvae(w, sizes, whole, context)
    assert mean.shape == log_variance.shape == (8, 3)
