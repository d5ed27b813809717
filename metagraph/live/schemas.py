"""Publish the JSON Schemas of requests. `python -m metagraph.live.schemas` writes them after a change."""

from __future__ import annotations

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
    return msgspec.json.format(msgspec.json.encode(schema), indent=2) + b"\n"


if __name__ == "__main__":
    for path, text in make_schema_texts().items():
        path.write_bytes(text)
