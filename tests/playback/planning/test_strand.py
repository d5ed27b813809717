"""Long sequences share what they have in common, and do what tuples do."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.playback.planning import strand
from metagraph.playback.planning.strand import Strand, join_sequence

counts = st.integers(0, 60)


@pytest.fixture(autouse=True, scope="module")
def _short_chunks() -> Any:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(strand, "CHUNK", 8)
        patch.setattr(strand, "LONG", 20)
        yield


@given(counts, counts, counts)
def test_it_is_what_a_tuple_is(count: int, kept: int, more: int) -> None:
    every = tuple(range(count))
    one = Strand(every).begun(kept, [1000 + n for n in range(more)])
    same = (*every[:kept], *(1000 + n for n in range(more)))
    assert tuple(one) == same and len(one) == len(same) and one == same and same == one
    assert hash(one) == hash(same) and bool(one) == bool(same) and one == Strand(same)
    assert list(reversed(one)) == list(reversed(same))
    assert one != (*same, 0) and one != "words"


@given(counts, st.integers(-70, 70), st.integers(-70, 70), st.sampled_from([None, 1, 2, -1, -3]))
def test_parts_of_it_are_those_of_a_tuple(count: int, first: int, last: int, step: int | None) -> None:
    every = tuple(range(count))
    one = Strand(every)
    for part in (slice(first, last, step), slice(first, None), slice(None, last)):
        assert one[part] == every[part]
    if -count <= first < count:
        assert one[first] == every[first]
    else:
        with pytest.raises(IndexError):
            one[first]


@given(st.lists(st.tuples(counts, counts), max_size=8))
def test_what_is_made_of_one_leaves_it_as_it_was(steps: list[tuple[int, int]]) -> None:
    one, same = Strand[int](), ()
    made = []
    for n, (kept, more) in enumerate(steps):
        added = [100 * n + k for k in range(more)]
        one, same = one.begun(kept, added), (*same[:kept], *added)
        made.append((one, same))
    assert all(tuple(a) == b for a, b in made)


def test_whole_chunks_are_shared() -> None:
    one = Strand(range(100))
    more = one.begun(90, (7,))
    assert all(a is b for a, b in zip(one._chunks[:11], more._chunks[:11], strict=True))


def test_it_is_kept_in_files_of_objects_and_read_as_an_array() -> None:
    one = Strand([0.5, 1.5, 2.5] * 9)
    assert pickle.loads(pickle.dumps(one)) == one
    assert np.array_equal(np.array(one, float), np.array(tuple(one)))
    assert repr(Strand([1])) == "Strand((1,))"
    assert one + (9.0,) == (*one, 9.0) and (9.0, *one) == (9.0,) + one


def test_what_is_short_stays_a_tuple() -> None:
    assert join_sequence((1, 2, 3), 2, (9,)) == (1, 2, 9) and type(join_sequence((1, 2, 3), 2, (9,))) is tuple
    long = join_sequence(range(30), 25, (9,))
    assert isinstance(long, Strand) and long == (*range(25), 9)
    assert join_sequence(long, 3, ()) == (0, 1, 2) and type(join_sequence(long, 3, ())) is tuple
