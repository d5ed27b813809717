"""A sitting's events as markers of the Lab Streaming Layer, beside which recorders of eyes, voice and pulse
lay theirs on one clock. Only kinds and numbers are sent; the log has the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import msgspec

from metagraph.common.extras import describe_missing_extra
from metagraph.common.wording import phrase

SENT = ("n", "type", "mono", "condition", "task", "name", "number")  # fields of an event


class MarkersError(ValueError):
    """There is no Lab Streaming Layer here; the message says what to do."""


def open_marker_outlet(participant: str) -> Callable[[Mapping[str, Any]], None]:
    """Return what sends an event of the log: a stream `Metagraph` of type `Markers`, one JSON text a sample.
    Raises MarkersError.
    """
    try:
        import pylsl  # loads its library on being imported
    except (ImportError, OSError, RuntimeError) as error:
        missing = isinstance(error, ImportError)
        why = describe_missing_extra("lab", phrase("Sending markers")) if missing else str(error)
        raise MarkersError(
            phrase(
                "the Lab Streaming Layer cannot be had. {why}. Or leave 'lsl: true' out of the study file",
                why=why,
            )
        ) from None
    kind = pylsl.StreamInfo("Metagraph", "Markers", 1, 0, "string", f"metagraph-{participant}")
    stream = pylsl.StreamOutlet(kind)

    def send(event: Mapping[str, Any]) -> None:
        told = {name: event[name] for name in SENT if name in event}
        stream.push_sample([msgspec.json.encode(told).decode()])

    return send
