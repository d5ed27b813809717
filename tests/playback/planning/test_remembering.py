"""How many other draws came after an action's last one."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from metagraph.playback.planning.remembering import REMEMBERED, rested


@given(st.lists(st.sampled_from("abcd"), max_size=REMEMBERED), st.sampled_from("abcde"), st.integers(-2, 40))
def test_an_action_has_rested_where_enough_others_came_after_it(
    recent: list[str], ident: str, needed: int
) -> None:
    since = REMEMBERED if ident not in recent else recent[::-1].index(ident)
    assert rested(tuple(recent), ident, needed) == (since >= needed)
