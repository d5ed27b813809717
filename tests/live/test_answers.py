"""What a plan does about many asks, in one pass, is what `answer` says of each."""

from __future__ import annotations

import random
from typing import Any

import msgspec

from metagraph.graph import requests as a
from metagraph.graph.model import Project
from metagraph.live.answers import find, find_owning_ask
from metagraph.live.messages import HeardMessage, read_live_request
from metagraph.playback.planning.extend_performance import answer_ask
from metagraph.playback.planning.running_plan import plan_performance
from tests.live.traffic import valid


def test_an_owner_is_found_through_all_parts() -> None:
    assert find_owning_ask("a", {"a"}) == "a"
    assert find_owning_ask("a.1.12", {"a"}) == "a"
    assert find_owning_ask("a.1.12", {"a", "a.1"}) == "a.1"
    assert (
        find_owning_ask("a.b", {"a"}) is None
        and find_owning_ask("ab", {"a"}) is None
        and find_owning_ask("a.", {"a"}) is None
    )


def test_found_together_is_what_is_answered_one_by_one(sample: Project) -> None:
    for seed in range(12):
        r = random.Random(seed)
        asks: list[Any] = []
        while len(asks) < 25:
            heard = read_live_request(msgspec.json.encode(valid(r)))
            assert isinstance(heard, HeardMessage)
            if not isinstance(heard.message, a.Withdraw):
                asks.append(
                    msgspec.structs.replace(heard.message, id=f"x{len(asks)}", at=round(r.random() * 40, 2))
                )  # type: ignore[arg-type]
        plan = plan_performance(sample, asks, 25.0, idle=bool(seed % 2))
        found = find(plan, {ask.id for ask in asks})
        for ask in asks:
            one = answer_ask(plan, ask.id)
            if ask.id not in found:
                assert (one.state, one.why) == ("refused", "nothing came of it")
                continue
            many = found[ask.id]
            assert (many.state, many.at) == (one.state, one.at), ask
            assert sorted(many.what) == sorted(one.what)
            assert many.why == one.why
            assert many.until == (one.until if one.until is not None and one.until < 1e8 else None)
