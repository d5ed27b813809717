"""The published JSON Schemas of what can be asked: `python -m metagraph.live.schemas` writes them anew after
a change.
"""

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


def schema_texts() -> dict[Path, bytes]:
    """Return the files: one ask as performances, lines and agents have it; all that a live session says and
    hears.
    """
    return {GRAPH: _text(requests.ask_schema()), LIVE: _text(messages.live_schema())}


def _text(schema: dict[str, Any]) -> bytes:
    return msgspec.json.format(msgspec.json.encode(schema), indent=2) + b"\n"


if __name__ == "__main__":
    for path, text in schema_texts().items():
        path.write_bytes(text)
