"""Parameters in a live session: set by name over JSON and OSC, answered as the request that this makes."""

from __future__ import annotations

import json
from typing import Any

import pytest

from metagraph.graph.editing.parameters import add_parameter, list_offered_parameters, remove_parameter
from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.live.osc import read_osc_request
from tests.conftest import Toy


@pytest.fixture(scope="module")
def project() -> Project:
    out = Toy().project()
    for offered in list_offered_parameters(out):
        if offered.group in ("state", "gesture"):
            out, _ = add_parameter(out, offered.name, offered.parameter)
    return out


@pytest.fixture
def session(project: Project) -> LiveSession:
    out = LiveSession(project, idle=False)
    out.join(1)
    return out


def say(session: LiveSession, now: float, *requests: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the replies to requests."""
    session.receive(1, json.dumps(requests))
    replies = session.tick(now).replies
    return [json.loads(r if isinstance(r, bytes) else json.dumps(_plain(r))) for r in replies]


def _plain(reply: Any) -> dict[str, Any]:
    return {"id": reply.id, "state": reply.state, "error": reply.error, "actions": list(reply.actions)}


def test_setting_is_answered_as_the_request_that_it_makes(session: LiveSession) -> None:
    mood, gesture, wrong, unknown = say(
        session,
        0.1,
        {"do": "set", "name": "mood", "value": "happy", "id": "m"},
        {"do": "set", "name": "gesture"},
        {"do": "set", "name": "mood", "value": "glad", "id": "w"},
        {"do": "set", "name": "nobody", "value": 1},
    )
    assert (mood["id"], mood["state"], mood["actions"]) == ("m", "planned", ["mood"])
    assert gesture["state"] in ("planned", "late") and gesture["actions"]
    assert wrong["error"].startswith("value: should be one of neutral") and wrong["id"] == "w"
    assert unknown["error"] == "name: there is no parameter 'nobody'"
    assert session.plan.track.moods[-1].valence > 0


def test_describe_lists_them_and_an_edit_takes_them_away(session: LiveSession, project: Project) -> None:
    (described,) = say(session, 0.1, {"do": "describe"})
    assert list(described["parameters"]) == list(project.parameters)
    assert described["parameters"]["energy"]["most"] == 2
    session.change(remove_parameter(project, "mood"))
    described, refused = say(session, 0.2, {"do": "describe"}, {"do": "set", "name": "mood", "value": "sad"})
    assert "mood" not in described["parameters"] and "no parameter 'mood'" in refused["error"]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("energy", 1.5),
        ("energy", 7),
        ("speaking", True),
        ("partner", [1, 1.5, 1]),
        ("attention", 0),
        ("looks_at", "ahead"),
    ],
)
def test_values_of_each_type_are_taken(session: LiveSession, name: str, value: Any) -> None:
    (reply,) = say(session, 0.1, {"do": "set", "name": name, "value": value})
    assert reply["state"] == "planned", reply


@pytest.mark.parametrize("value", [{"a": 1}, [[1]], [None]])
def test_what_is_no_value_is_an_error(session: LiveSession, value: Any) -> None:
    (reply,) = say(session, 0.1, {"do": "set", "name": "mood", "value": value})
    assert "value" in reply["error"]


@pytest.mark.parametrize(
    ("values", "asked"),
    [
        (["mood", "happy"], {"name": "mood", "value": "happy"}),
        (["energy", 1.5], {"name": "energy", "value": 1.5}),
        (["speaking", True], {"name": "speaking", "value": True}),
        (["partner", 1.0, 2.0, 3.0, "id=p"], {"name": "partner", "value": [1.0, 2.0, 3.0], "id": "p"}),
        (["nod"], {"name": "nod"}),
    ],
)
def test_osc_sets_them(values: list[Any], asked: dict[str, Any]) -> None:
    assert read_osc_request("/metagraph/set", values) == {"do": "set", **asked}
