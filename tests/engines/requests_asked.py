"""Requests that characters of several runtimes are asked, sensible ones and others."""

from __future__ import annotations

from typing import Any

ASKED: dict[int, list[dict[str, Any]]] = {
    0: [{"do": "gesture", "id": "a", "after": 1.0}],
    31: [
        {"do": "gesture", "id": "b", "layer": "head", "priority": 2},
        {"do": "say", "id": "c", "text": "and now for something else"},
    ],
    90: [
        {"do": "look", "id": "d", "to": [1, 1.5, 1], "duration": 2},
        {"do": "gesture", "id": "e", "after": 30.0},
    ],
    130: [
        {"do": "withdraw", "id": "f", "what": "e"},
        {"do": "gesture", "id": "b", "layer": "arms", "at": 20},
    ],
    300: [{"do": "change", "id": "g", "layer": "arms"}, {"do": "blink", "id": "h"}],
}


SENSELESS: list[Any] = [
    "",
    "null",
    "[]",
    "7",
    "{",
    '{"do":"gesture"} x',
    "[" * 9000,
    '{"do":"gesture","id":"\\ud800"}',
    {},
    {"do": 1},
    {"do": "dance"},
    {"do": "gesture", "layer": "legs"},
    {"do": "gesture", "layer": None},
    {"do": "gesture", "tags": "positive"},
    {"do": "gesture", "tags": [1]},
    {"do": "gesture", "mood": 1},
    {"do": "gesture", "priority": 1.5},
    {"do": "gesture", "priority": 1001},
    {"do": "gesture", "at": True},
    {"do": "gesture", "at": -1},
    {"do": "gesture", "at": 1e7},
    {"do": "gesture", "hold": 601},
    {"do": "gesture", "prepare": 1},
    {"do": "gesture", "after": "soon"},
    {"do": "gesture", "after": -1},
    {"do": "gesture", "id": "x" * 201},
    {"do": "action"},
    {"do": "action", "action": "juggle"},
    {"do": "action", "action": ""},
    {"do": "stance", "stance": "lotus"},
    {"do": "stance"},
    {"do": "look", "to": [1, 2]},
    {"do": "look", "to": ""},
    {"do": "look", "amount": 2},
    {"do": "say"},
    {"do": "say", "line": "no such line"},
    {"do": "say", "line": 1.5},
    {"do": "mode", "mode": "angry"},
    {"do": "place", "name": "door"},
    {"do": "place", "name": "door", "point": [0, 0, None]},
    {"do": "withdraw", "what": None},
    {"do": "nod", "tags": ["no such tag"]},
    {"do": "gesture", "tags": ["no such tag"]},
    {"do": "bml", "bml": "<bml/>"},
]
