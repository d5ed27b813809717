"""Takes as rows of frames, and what crops of them hear."""

from __future__ import annotations

from typing import Any

import pytest

torch = pytest.importorskip("torch", reason="training needs torch, which is not installed")

from metagraph.generation.features import STRANGEST, count_audio  # noqa: E402
from metagraph.generation.networks import ACTIVITY  # noqa: E402
from metagraph.generation.takes import measure_scales  # noqa: E402
from metagraph.generation.training.data import TrainingCorpus  # noqa: E402
from tests.generation.training.planting import take  # noqa: E402


@pytest.fixture(scope="module")
def corpus() -> Any:
    takes = [take(8.0, 1)]
    return TrainingCorpus(takes, *measure_scales(takes), before=5, after=25)


def test_a_share_of_crops_sounds_otherwise_and_who_speaks_stays(corpus: Any) -> None:
    starts = corpus.starts(torch.Generator().manual_seed(1), 200, 40)
    plain = corpus.rows(corpus.heard, starts, -5, 40)
    heard = corpus.hear(starts, -5, 40, 0.3, torch.Generator().manual_seed(2))
    assert torch.equal(heard[..., -ACTIVITY:], plain[..., -ACTIVITY:])
    other = (heard != plain).any(2).any(1).float().mean()
    assert 0.2 < float(other) < 0.4
    assert float(heard[..., :-ACTIVITY].abs().max()) <= STRANGEST
    assert torch.equal(corpus.hear(starts, -5, 40, 0.0, torch.Generator()), plain)


def test_what_is_learned_from_stays_as_it_was(corpus: Any) -> None:
    before = corpus.heard.clone()
    corpus.hear(torch.tensor([5, 9]), -5, 40, 1.0, torch.Generator().manual_seed(2))
    assert torch.equal(corpus.heard, before)


def test_both_tracks_sound_otherwise_each_in_its_own_way() -> None:
    takes = [take(8.0, 1, tracks=2)]
    two = TrainingCorpus(takes, *measure_scales(takes, count_audio("matching", 2)), before=5, after=25)
    starts = torch.arange(5, 15)
    heard = two.hear(starts, 0, 40, 1.0, torch.Generator().manual_seed(2))
    plain = two.rows(two.heard, starts, 0, 40)
    changed = (heard - plain).abs().mean((0, 1))
    assert changed.shape == (65,) and float(changed[:54].min()) > 0 and not changed[54:].any()


def test_crops_in_which_who_speaks_changes_are_drawn_oftener_and_none_leaves_its_take() -> None:
    takes = [take(8.0, 1), take(6.0, 2)]
    for one in takes:
        told = one.features[:, -ACTIVITY:]
        told[:] = 0
        told[:, 0] = 1
    told = takes[0].features[:, -ACTIVITY:]
    told[100:110] = (0, 1, 0, 0)  # somebody says a word
    own = TrainingCorpus(takes, *measure_scales(takes), before=5, after=25)
    drawn = {}
    for turns in (0.0, 1.0, 2.0):
        starts = own.starts(torch.Generator().manual_seed(3), 20000, 40, turns).numpy()
        for start in starts:
            assert any(f <= start <= f + c - 40 for f, c in zip(own.first, own.counts, strict=True))
        inside = starts - own.first[0]
        drawn[turns] = ((inside > 60) & (inside < 110)).mean()
    # Both changes lie in 31 of the crops, one of them in 18; all others weigh 1.
    count = int((own.counts - 39).sum())
    for turns, share in drawn.items():
        heavy = 30 * 3**turns + 20 * 2**turns
        assert abs(share - (heavy - 2**turns) / (count - 50 + heavy)) < 0.03
