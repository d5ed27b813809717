"""Fair shares: one client that floods takes neither the layers nor the kinds of asks from others, and has
what it likes while it is alone; what is more important comes first, whoever asks.
"""

from __future__ import annotations

import json
from typing import Any

import pytest

from metagraph.graph.model import Project
from metagraph.live.hub import Hub
from metagraph.live.limits import PLANNED_PER_TICK, RATES
from metagraph.live.live_session import LiveSession
from metagraph.live.tick_work import order_requests
from metagraph.live.wire import exchange
from tests.live.test_hub import Wire

FLOOD = [
    {"do": "gesture"},
    {"do": "nod"},
    {"do": "look", "to": "user"},
    {"do": "say", "text": "x"},
    {"do": "blink"},
    {"do": "mode", "mode": "idle"},
    {"do": "withdraw", "what": "z"},
]


class Talk:
    """A session and its lines, as time goes on."""

    def __init__(self, project: Project, clients: int) -> None:
        self.hub, self.session, self.now = Hub(), LiveSession(project, seed=1), 0.0
        self.wires = [Wire() for _ in range(clients)]
        self.numbers = [self.hub.open(wire, 0.0) for wire in self.wires]

    def send(self, client: int, *asks: dict[str, Any]) -> None:
        self.hub.message(self.numbers[client], json.dumps(list(asks)))

    def tick(self, times: int = 1) -> None:
        for _ in range(times):
            self.now += 1 / 60
            self.hub.give(exchange(self.session, self.now, self.hub.take()))

    def answers(self, client: int) -> list[dict[str, Any]]:
        return [reply for text in self.wires[client].texts for reply in json.loads(text)]


@pytest.mark.parametrize(
    "ask",
    [
        {"do": "look", "to": "ahead"},
        {"do": "say", "text": "Well."},
        {"do": "blink"},
        {"do": "withdraw", "what": "q"},
        {"do": "bml", "bml": "<bml><gaze target='user'/></bml>"},
    ],
)
def test_an_honest_client_is_served_beside_one_that_floods(sample: Project, ask: dict[str, Any]) -> None:
    talk = Talk(sample, 2)
    for n in range(240):
        talk.send(0, *(FLOOD * 4))
        if n % 60 == 30:
            talk.send(1, ask | {"id": f"mine{n}"})
        talk.tick()
    found = talk.answers(1)
    assert len(found) == 4
    assert [r["state"] for r in found if r["state"] == "refused"] == [], found
    assert len(talk.answers(0)) == 240 * 28  # who floods is answered, too, every time


def test_who_is_alone_may_have_it_all(sample: Project) -> None:
    talk = Talk(sample, 1)
    talk.send(0, *({"do": "blink"} for _ in range(40)))
    talk.tick(2)
    taken = [r for r in talk.answers(0) if r["state"] != "refused"]
    assert len(taken) == RATES["blink"]


def test_others_have_their_share_of_a_kind_that_is_used_up(sample: Project) -> None:
    talk = Talk(sample, 3)
    talk.send(0, *({"do": "blink"} for _ in range(40)))
    talk.tick()
    for client in (1, 2):
        talk.send(client, *({"do": "blink"} for _ in range(3)))
    talk.tick(2)
    for client in (1, 2):
        assert [r["state"] for r in talk.answers(client)].count("refused") == 0


def test_a_tick_s_work_is_shared_and_order_within_a_client_is_kept(sample: Project) -> None:
    assert (
        order_requests([1, 1, 1, 2, 3, 2]) == [0, 3, 4, 1, 5, 2]
        and order_requests([7, 7]) == [0, 1]
        and order_requests([]) == []
    )
    talk = Talk(sample, 2)
    talk.send(0, *({"do": "place", "name": "user", "point": [0, 1, 2]} for _ in range(PLANNED_PER_TICK * 4)))
    talk.send(1, *({"do": "place", "name": "user", "point": [0, 1, 2], "id": f"p{n}"} for n in range(20)))
    talk.tick(2)
    assert [r["id"] for r in talk.answers(1)] == [f"p{n}" for n in range(20)]
    assert all(r["state"] != "refused" for r in talk.answers(1))


def test_what_is_more_important_goes_first_whoever_asks(sample: Project) -> None:
    talk = Talk(sample, 2)
    for n in range(120):
        talk.send(0, {"do": "nod", "priority": 5})
        if n % 30 == 0:
            talk.send(1, {"do": "nod"})
        talk.tick()
    loud = [r for r in talk.answers(0) if r["state"] in ("planned", "late")]
    assert loud, "an important ask is not turned away for the sake of a share"
