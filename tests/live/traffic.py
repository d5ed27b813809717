"""Requests as agents and enemies send them."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from typing import Any

WORDS = ("beat", "positive", "negative", "you", "greeting", "nonsense")
STANCES = ("on hips", "arms crossed", "hands at sides", "head tilt left", "weight left", "nowhere")
BOMB = (
    '<!DOCTYPE b [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;"><!ENTITY c '
    '"&b;&b;&b;&b;&b;&b;">]><bml>&c;</bml>'
)
BLOCK = (
    '<bml><speech id="s1" start="0.2"><text>Well <sync id="tm1"/> no</text></speech><gesture id="g" '
    'lexeme="SHRUG" stroke="s1:tm1"/>'
    '<head lexeme="SHAKE" start="g:end"/><locomotion target="door"/></bml>'
)
CIRCLE = '<bml composition="REPLACE"><gesture id="a" start="b:end"/><gesture id="b" start="a:end"/></bml>'


def valid(r: random.Random) -> dict[str, Any]:
    """What an agent asks for."""
    when: dict[str, Any] = r.choice(
        [{}, {}, {"in": round(r.random() * 20, 2)}, {"priority": r.randint(1, 5)}]
    )
    name: dict[str, Any] = {"id": f"id{r.randrange(40)}"} if r.random() < 0.5 else {}
    ask: dict[str, Any] = r.choice(
        [
            {"do": "gesture", "layer": r.choice(("arms", "body", "head"))},
            {"do": "gesture", "tags": [r.choice(WORDS)], "limb": r.choice(("left", "right", None))},
            {"do": "gesture", "hold": 1.5, "prepare": False},
            {"do": "fidget", "layer": r.choice(("arms", "body", "head")), "resume": True},
            {"do": "nod"},
            {"do": "shake"},
            {"do": "stance", "stance": r.choice(STANCES)},
            {"do": "change", "layer": "head"},
            {"do": "action", "action": r.choice(("shrug_bt_01", "bow_01", "no_such_action"))},
            {
                "do": "look",
                "to": r.choice(("user", "ahead", [0.1, 1.5, 2.0])),
                "duration": r.choice((None, 2.0)),
            },
            {"do": "place", "name": r.choice(("user", "door")), "point": [r.random(), 1.5, 2]},
            {"do": "blink"},
            {"do": "say", "text": "Well, I would not say so.", "duration": r.choice((None, 1.0))},
            {"do": "mode", "mode": r.choice(("idle", "listening", "talking", None))},
            {"do": "withdraw", "what": f"id{r.randrange(40)}"},
            {"do": "bml", "bml": BLOCK},
        ]
    )
    return ask | when | name


HOSTILE: tuple[Callable[[random.Random], str | bytes], ...] = (
    lambda r: "not json at all",
    lambda r: '{"do": "nod"',
    lambda r: '{"do": "nod", "at": NaN}',
    lambda r: '{"do": "nod", "at": 1e400}',
    lambda r: '{"do": "nod", "at": -1}',
    lambda r: '{"do": "nod", "at": ' + "9" * 400 + "}",
    lambda r: '{"do": "gesture", "duration": 999999}',
    lambda r: '{"do": "gesture", "at": 900000}',
    lambda r: '{"do": "gesture", "tags": ' + "[" * 3000 + "]" * 3000 + "}",
    lambda r: "[" * 3000,
    lambda r: '{"do": "nod", "id": 7}',
    lambda r: '{"do": "nod", "id": "' + "x" * 5000 + '"}',
    lambda r: '{"do": "nod", "id": "\\u0000.1+2/../' + str(r.randrange(5)) + '"}',
    lambda r: '{"do": "dance"}',
    lambda r: '{"nod": true}',
    lambda r: "7",
    lambda r: "null",
    lambda r: '{"do": "look", "to": [1, 2]}',
    lambda r: '{"do": "look", "to": [1e300, 2, 3]}',
    lambda r: '{"do": "place", "name": "' + str(r.randrange(10**6)) + '", "point": [0, 0, 0]}',
    lambda r: '{"do": "gesture", "layer": "tail"}',
    lambda r: '{"do": "action", "action": "' + "z" * 150 + str(r.randrange(10**6)) + '"}',
    lambda r: '{"do": "withdraw"}',
    lambda r: '{"do": "withdraw", "what": "' + str(r.randrange(10**6)) + '"}',
    lambda r: json.dumps({"do": "bml", "bml": BOMB}),
    lambda r: json.dumps({"do": "bml", "bml": "<bml>" + "<x>" * 2000}),
    lambda r: json.dumps({"do": "bml", "bml": "<bml>" + "<head lexeme='NOD'/>" * 300 + "</bml>"}),
    lambda r: json.dumps({"do": "bml", "bml": CIRCLE}),
    lambda r: json.dumps({"do": "say", "text": "x" * 19000}),
    lambda r: '{"do": "say", "line": "' + str(r.randrange(1000)) + '"}',
    lambda r: '{"do": "gesture", "priority": ' + str(r.randint(-1000, 1000)) + "}",
    lambda r: '{"do": "hello", "poses": {"rate": 1e9}}',
    lambda r: '{"do": "hello", "poses": {"joints": ["Tail"]}}',
    lambda r: '{"do": "describe"}',
    lambda r: bytes(r.randrange(256) for _ in range(40)),
    lambda r: b'{"do": "nod", "id": "\xff\xfe"}',
    lambda r: "x" * 70_000,
)  # fmt: skip


def hostile(r: random.Random) -> str | bytes:
    """What nobody should send."""
    return r.choice(HOSTILE)(r)


def mixed(r: random.Random) -> str | bytes:
    """One message: two of three are valid."""
    return json.dumps(valid(r)) if r.random() < 0.67 else hostile(r)
