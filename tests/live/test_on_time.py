"""A reply that says `planned` is true: what was asked for begins when it was asked for, or the reply says
`late` with the time at which it does.
"""

from __future__ import annotations

import json
import random
from typing import Any

import msgspec
import pytest

from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.playback.planning.sampling import ON_TIME

TICK = 1 / 60
LONG = "wave_hello_rt_01"


@pytest.fixture
def session(sample: Project) -> LiveSession:
    out = LiveSession(sample, idle=False)
    out.tick(1.0)
    out.receive(1, '{"do": "hello", "events": true}')
    out.tick(1.0 + TICK)
    return out


def ask(session: LiveSession, *requests: dict[str, Any]) -> list[dict[str, Any]]:
    session.receive(1, json.dumps(list(requests)))
    return [msgspec.to_builtins(reply) for reply in session.tick(session.now + TICK).replies]


def starts(session: LiveSession, until: float) -> dict[str, float]:
    """Play on; return when each request began."""
    out: dict[str, float] = {}
    while session.now < until:
        for _, event in session.tick(session.now + TICK).events:
            if event.event == "started" and event.id is not None and event.at is not None:
                out.setdefault(event.id, event.at)
    return out


def is_true(reply: dict[str, Any], asked: float) -> bool:
    """Whether a reply says that it is late if and only if it is, by more than it may."""
    return (reply["state"] == "late") == (reply["at"] - asked > ON_TIME)


def length_of(session: LiveSession, name: str) -> float:
    action = next(a for a in session.project.actions() if a.name == name)
    begin, end = session.project.span(action)
    return end - begin


def test_a_gesture_that_the_one_before_it_holds_up_by_less_than_a_second_is_late(
    session: LiveSession,
) -> None:
    length = length_of(session, LONG)
    assert length > 1.5, "it lasts longer than is reserved for it"
    first, second = ask(
        session,
        {"do": "action", "action": LONG, "id": "first", "at": 2.0},
        {"do": "action", "action": "shrug_bt_01", "id": "second", "at": 2.0 + length - 0.6},
    )
    assert first["state"] == "planned" and first["at"] == 2.0
    assert second["state"] == "late"
    assert second["at"] == pytest.approx(2.0 + length, abs=0.3)
    assert "waits 0." in second["why"] and f"s for '{LONG}'" in second["why"]
    assert starts(session, 8.0) == {"first": 2.0, "second": second["at"]}


def test_a_gesture_behind_the_end_of_the_one_before_it_is_planned_at_its_time(session: LiveSession) -> None:
    asked = 2.0 + length_of(session, LONG) + 0.2
    _, second = ask(
        session,
        {"do": "action", "action": LONG, "at": 2.0},
        {"do": "action", "action": "shrug_bt_01", "at": round(asked, 3)},
    )
    assert second["state"] == "planned" and second["at"] == pytest.approx(asked, abs=1e-3)
    assert "why" not in second or not second["why"]


def test_of_three_each_says_how_late_it_is(session: LiveSession) -> None:
    length = length_of(session, LONG)
    times = {"a": 2.0, "b": 2.0 + length - 0.5, "c": 2.0 + 2 * length - 0.3}
    replies = ask(session, *({"do": "action", "action": LONG, "id": x, "at": t} for x, t in times.items()))
    assert [reply["state"] for reply in replies] == ["planned", "late", "late"]
    began = starts(session, 14.0)
    for reply in replies:
        assert began[reply["id"]] == reply["at"] and is_true(reply, times[reply["id"]])


def test_layers_do_not_hold_each_other_up(session: LiveSession) -> None:
    _, nod, bow = ask(
        session,
        {"do": "action", "action": LONG, "id": "arms", "at": 2.0},
        {"do": "nod", "id": "head", "at": 2.4},
        {"do": "fidget", "layer": "body", "id": "body", "at": 2.6},
    )
    assert (nod["state"], nod["at"]) == ("planned", 2.4)
    assert (bow["state"], bow["at"]) == ("planned", 2.6)


def test_an_action_of_the_whole_body_says_so_too(session: LiveSession) -> None:
    names = [
        a.name for a in session.project.graphs["body"].actions.values() if a.kind in ("gesture", "fidget")
    ]
    name = max(names, key=lambda each: length_of(session, each))
    asked = 2.0 + length_of(session, name) - 0.5
    first, second = ask(
        session,
        {"do": "action", "action": name, "id": "first", "at": 2.0},
        {"do": "action", "action": name, "id": "second", "at": asked},
    )
    assert first["state"] == "planned" and second["state"] == "late" and is_true(second, asked)


def test_a_change_of_stance_that_is_held_up_is_late(session: LiveSession) -> None:
    asked = 2.0 + length_of(session, LONG) - 0.5
    _, second = ask(
        session,
        {"do": "action", "action": LONG, "at": 2.0},
        {"do": "stance", "stance": "on hips", "id": "s", "at": asked},
    )
    assert second["state"] == "late" and is_true(second, asked)
    assert starts(session, 8.0)["s"] == second["at"]


def test_what_is_no_longer_held_up_is_told_to_be_on_time(session: LiveSession) -> None:
    asked = 4.0 + length_of(session, LONG) - 0.5
    _, second = ask(
        session,
        {"do": "action", "action": LONG, "id": "first", "at": 4.0},
        {"do": "action", "action": "shrug_bt_01", "id": "second", "at": asked},
    )
    assert second["state"] == "late"
    session.receive(1, '{"do": "withdraw", "what": "first"}')
    changed = [
        e for _, e in session.tick(session.now + TICK).events if e.event == "changed" and e.id == "second"
    ]
    assert changed and changed[-1].state == "planned" and changed[-1].at == pytest.approx(asked, abs=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_whatever_is_asked_in_whatever_order_replies_are_true(sample: Project, seed: int) -> None:
    r = random.Random(seed)
    session = LiveSession(sample, seed, idle=False)
    session.receive(1, '{"do": "hello", "events": true}')
    session.tick(1.0)
    words = (
        {"do": "gesture"},
        {"do": "nod"},
        {"do": "fidget"},
        {"do": "action", "action": LONG},
        {"do": "shake"},
    )
    told: dict[str, tuple[str, float]] = {}
    wanted: dict[str, float] = {}
    for n in range(40):
        at = round(session.now + 0.2 + 6 * r.random(), 2)
        wanted[f"r{n}"] = at
        session.receive(1, json.dumps({**r.choice(words), "id": f"r{n}", "at": at}))
        for _ in range(r.randrange(1, 20)):
            out = session.tick(session.now + TICK)
            for reply in out.replies:
                if isinstance(reply, msgspec.Struct) and reply.id in wanted and reply.at is not None:
                    told[reply.id] = reply.state, reply.at
            for _, event in out.events:
                if event.event == "changed" and event.id is not None and event.at is not None:
                    told[event.id] = event.state, event.at
    assert len(told) > 10
    for ident, (state, at) in told.items():
        if state == "planned":
            assert at - wanted[ident] <= ON_TIME + 1e-3, ident
