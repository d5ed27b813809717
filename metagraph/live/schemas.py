"""Publish the JSON Schemas of requests. `python -m metagraph.live.schemas` writes them after a change."""

from __future__ import annotations

from inspect import cleandoc
from pathlib import Path
from typing import Any

import msgspec

from metagraph.graph import requests
from metagraph.live import messages

GRAPH, LIVE = (
    Path(requests.__file__).with_name("asks.schema.json"),
    Path(__file__).with_name("live.schema.json"),
)


def make_schema_texts() -> dict[Path, bytes]:
    """Return the files: one request as in performances, lines and agents' messages; all messages of a live
    session.
    """
    return {GRAPH: _text(requests.ask_schema()), LIVE: _text(messages.make_live_schema())}


def _text(schema: dict[str, Any]) -> bytes:
    return msgspec.json.format(msgspec.json.encode(_tidied(schema)), indent=2) + b"\n"


def _tidied(value: Any) -> Any:
    """Return a schema whose descriptions have no indents. From 3.13 on, Python itself takes them out."""
    if isinstance(value, dict):
        return {
            key: cleandoc(part) if key == "description" and isinstance(part, str) else _tidied(part)
            for key, part in value.items()
        }
    return [_tidied(part) for part in value] if isinstance(value, list) else value


if __name__ == "__main__":
    for path, text in make_schema_texts().items():
        path.write_bytes(text)
