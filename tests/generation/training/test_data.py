"""Takes as rows of frames, and what crops of them hear."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="training needs torch, which is not installed")

from metagraph.generation.features import STRANGEST  # noqa: E402
from metagraph.generation.networks import ACTIVITY  # noqa: E402
from metagraph.generation.takes import scales_of  # noqa: E402
from metagraph.generation.training.data import Corpus  # noqa: E402
from tests.generation.training.planting import take  # noqa: E402


@pytest.fixture(scope="module")
def corpus() -> Any:
    takes = [take(8.0, 1)]
    return Corpus(takes, *scales_of(takes), before=5, after=25)


def test_each_crop_sounds_otherwise_but_all_of_it_alike_and_who_speaks_stays(corpus: Any) -> None:
    starts = corpus.starts(torch.Generator().manual_seed(1), 6, 40)
    plain = corpus.rows(corpus.heard, starts, -5, 40)
    heard = corpus.hear(starts, -5, 40, 0.3, torch.Generator().manual_seed(2))
    assert torch.equal(heard[..., -ACTIVITY:], plain[..., -ACTIVITY:])
    added = (heard - plain)[..., :-ACTIVITY].numpy()
    free = np.abs(heard[..., :-ACTIVITY].numpy()) < STRANGEST
    for crop, inside in zip(added, free, strict=True):
        whole = inside.all(0)
        assert np.abs(crop[:, whole] - crop[:1, whole]).max() < 1e-5, "the same curve for all frames"
    assert added[:, 0].std(0).mean() > 0.1, "another for each crop"
    assert float(heard[..., :-ACTIVITY].abs().max()) <= STRANGEST
    assert torch.equal(corpus.hear(starts, -5, 40, 0.0, torch.Generator()), plain)
