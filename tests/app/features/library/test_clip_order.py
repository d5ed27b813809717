"""Clips in the library, sorted: by name as people count, length, use, stance, folder; what is chosen stays so."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.features.library.clip_order import GIVEN, ORDERS, make_natural_key
from app.features.library.clip_rows import ENTRY


def shown(panel):
    return [panel.rows.index(row, 0).data(ENTRY) for row in range(panel.rows.rowCount())]


def test_names_are_sorted_as_people_count():
    assert sorted(["beat 10", "Beat 2", "beat 1", "arm"], key=make_natural_key) == [
        "arm",
        "beat 1",
        "Beat 2",
        "beat 10",
    ]


@given(st.lists(st.text(max_size=8)))
def test_any_names_can_be_compared(names):
    found = sorted(names, key=make_natural_key)
    assert all(make_natural_key(a) <= make_natural_key(b) for a, b in pairwise(found))


@pytest.mark.nightly
@pytest.mark.parametrize("order", [order for order in ORDERS if order != GIVEN])
def test_clips_are_listed_in_the_order_that_is_chosen_and_back(toys, order):
    panel = toys.library
    given_order = [e.id for e in shown(panel)]
    action = next(a for a in panel.orders.actions() if a.data() == order)
    action.trigger()
    found = shown(panel)
    keys = [ORDERS[order][1](panel.facts, entry) for entry in found]
    assert keys == sorted(keys) and {e.id for e in found} == set(given_order) and action.isChecked()
    assert [e.id for e in found] == panel.rows.listed()
    panel.backwards.trigger()
    assert [e.id for e in shown(panel)] == panel.rows.listed()
    assert [ORDERS[order][1](panel.facts, e) for e in shown(panel)] == sorted(keys, reverse=True)
    panel.forget()
    assert [e.id for e in shown(panel)] == given_order


@pytest.mark.nightly
def test_what_is_chosen_stays_chosen_and_comes_back(toys):
    panel, session = toys.library, toys.session
    chosen = shown(panel)[-1].id
    session.selection.select_clips((chosen,))
    panel.sort("name")
    assert session.selection.clips == (chosen,)
    assert [i.data(ENTRY).id for i in panel.list.selectedIndexes()] == [chosen]
    names = [make_natural_key(e.name) for e in shown(panel)]
    assert names == sorted(names)
    panel.forget()
