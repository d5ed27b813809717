"""A sitting's events as markers of the Lab Streaming Layer, beside which recorders of eyes, voice and pulse
lay theirs on one clock. Only kinds and numbers are sent; the log has the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import msgspec

from metagraph.common.lab_streaming import OutletPlan, StreamChannel, load_lsl, open_outlet

SENT = ("n", "type", "mono", "condition", "task", "name", "number")  # fields of an event


def open_marker_outlet(participant: str) -> Callable[[Mapping[str, Any]], None]:
    """Return what sends an event of the log: a stream `Metagraph` of type `Markers`, one JSON text a sample.
    Recorders on other computers find it, too. Raises LabStreamError.
    """
    lsl = load_lsl("'lsl: true' of the study file", network=True)
    plan = OutletPlan("Metagraph", "Markers", f"metagraph-{participant}", (StreamChannel("event"),))
    stream = open_outlet(lsl, plan)

    def send(event: Mapping[str, Any]) -> None:
        told = {name: event[name] for name in SENT if name in event}
        stream.push_sample([msgspec.json.encode(told).decode()])

    return send
