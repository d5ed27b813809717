"""Sounds as though others spoke elsewhere: other voices, rooms and microphones, and nothing else."""

from __future__ import annotations

from math import log

import pytest

torch = pytest.importorskip("torch", reason="training needs torch, which is not installed")

from metagraph.generation.features import FLOOR, MELS  # noqa: E402
from metagraph.generation.training import voices  # noqa: E402
from metagraph.generation.training.voices import vary_voices  # noqa: E402


def mels(count: int = 300, frames: int = 30) -> torch.Tensor:
    """Somebody who says the same syllable again and again: a hump of mels, then silence."""
    hump = -0.05 * (torch.arange(MELS) - 12.0) ** 2
    out = torch.full((count, frames, MELS), log(FLOOR))
    out[:, ::10] = out[:, 1::10] = hump
    return out


def chance(seed: int = 1) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def test_all_stay_numbers_no_fainter_than_silence_and_each_is_another() -> None:
    heard = vary_voices(mels(), chance())
    assert torch.isfinite(heard).all() and float(heard.min()) >= log(FLOOR) - 1e-5
    assert torch.unique(heard[:, 0, 12]).numel() > 250
    assert torch.equal(heard, vary_voices(mels(), chance()))


def test_a_syllable_stays_where_it_was() -> None:
    loud = vary_voices(mels(), chance()).exp().sum(2)
    assert (loud[:, [0, 1, 10, 11]].amin(1) >= loud[:, [6, 7, 8, 9]].amax(1) * 0.8).float().mean() > 0.95


SHARES = ("NOISY", "BANDED", "ROOMY", "ALIKE", "GATED")


@pytest.mark.parametrize("name", SHARES)
def test_each_that_can_happen_to_a_sound_does_in_its_share_of_crops(name: str, monkeypatch) -> None:
    for other in set(SHARES) - {name}:
        monkeypatch.setattr(voices, other, 0.0)
    monkeypatch.setattr(voices, "HIGHER", 0.0)
    monkeypatch.setattr(voices, "UNEVEN", 0.0)
    before, share = mels(), getattr(voices, name)
    before[:, 5:9] += 3.0  # something soft that is not silence, of another spectrum
    changed = (vary_voices(before, chance()) - before).abs().amax((1, 2)) > 1e-4
    assert abs(float(changed.float().mean()) - share) < 0.12


def test_of_a_single_frame_no_room_is_left() -> None:
    assert vary_voices(mels(9, 1), chance()).shape == (9, 1, MELS)


def test_sounds_that_differ_in_loudness_alone_are_as_loud_as_before() -> None:
    before = mels(2) + torch.randn(2, 30, MELS, generator=chance())
    alone = voices._loudness_alone(before)
    assert torch.allclose(alone.exp().sum(2), before.exp().sum(2), rtol=1e-4)
    assert float((alone - alone.mean(2, keepdim=True)).std(1).max()) < 1e-4
