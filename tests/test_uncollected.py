"""Making many things without looking for circles among them."""

from __future__ import annotations

import gc
from collections.abc import Iterator

import pytest

from metagraph.uncollected import uncollected


@pytest.fixture(autouse=True)
def as_it_was() -> Iterator[None]:
    was = gc.isenabled()
    yield
    (gc.enable if was else gc.disable)()


def test_nothing_is_collected_meanwhile_and_afterwards_as_before() -> None:
    gc.enable()
    with uncollected():
        assert not gc.isenabled()
        with uncollected():
            assert not gc.isenabled()
        assert not gc.isenabled()
    assert gc.isenabled()


def test_who_does_not_collect_at_all_is_left_so() -> None:
    gc.disable()
    with uncollected():
        pass
    assert not gc.isenabled()


def test_an_error_leaves_it_as_before() -> None:
    gc.enable()
    with pytest.raises(ZeroDivisionError), uncollected():
        raise ZeroDivisionError
    assert gc.isenabled()


def test_what_lasts_is_not_looked_through_even_afterwards() -> None:
    gc.enable()
    try:
        with uncollected(lasting=True):
            kept = [[n] for n in range(2000)]
            before = gc.get_stats()[0]["collections"]
        assert gc.isenabled() and gc.get_freeze_count() >= len(kept)
        assert gc.get_stats()[0]["collections"] == before
    finally:
        gc.unfreeze()
