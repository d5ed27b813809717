"""The Lab Streaming Layer (LSL): how it is loaded, and how streams are opened in it. Programs of laboratories
find streams by their names and record them on one clock.

LSL looks for streams on the whole local network. Here it looks on this computer alone, unless its own file of
settings or the user says otherwise.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from metagraph.common.extras import describe_missing_extra
from metagraph.common.wording import phrase

# Places at which liblsl looks for its settings, in its order; LSLAPICFG names another before them.
SETTINGS = ("lsl_api.cfg", "~/lsl_api/lsl_api.cfg", "/etc/lsl_api/lsl_api.cfg")
# Settings with which liblsl asks nobody beyond this computer, joins no multicast group of a network, and
# prints only what is fatal: we say the rest in our own words.
THIS_COMPUTER = """[ports]
IPv6 = disable
[multicast]
ResolveScope = machine
ListenAddress = 127.0.0.1
[lab]
KnownPeers = {127.0.0.1}
[log]
level = -3
"""


class LabStreamError(ValueError):
    """There is no Lab Streaming Layer here; the message says what to do."""


@dataclass(frozen=True)
class StreamChannel:
    """One number, or text, of a stream's samples. kind, unit: as XDF's pages on metadata name them. object:
    the joint that it is about.
    """

    label: str
    kind: str = ""
    unit: str = ""
    object: str = ""


@dataclass(frozen=True)
class OutletPlan:
    """A stream to be opened. kind: its content type. rate: samples a second, 0 for samples now and then.
    format: "string" or "float32". more: other parts of the description, as (path, text).
    """

    name: str
    kind: str
    source: str
    channels: Sequence[StreamChannel]
    rate: float = 0.0
    format: str = "string"
    more: Sequence[tuple[tuple[str, ...], str]] = ()


def find_own_settings() -> str:
    """Return where the user's own settings of LSL are, "" if there are none."""
    named = os.environ.get("LSLAPICFG", "")
    places = [Path(place).expanduser() for place in ((named,) if named else SETTINGS)]
    return next((str(place) for place in places if place.is_file()), "")


def load_lsl(option: str, network: bool) -> Any:
    """Return the module pylsl. option: what asks for it, for the message. network: whether it may talk to
    other computers; settings of the user's own count in any case. What was loaded first in a process stays.
    Raises LabStreamError.
    """
    settings = "" if network or find_own_settings() else THIS_COMPUTER
    with tempfile.TemporaryDirectory(prefix="metagraph-lsl-") as folder:
        before = os.environ.get("LSLAPICFG")
        if settings:
            place = Path(folder) / "lsl_api.cfg"
            place.write_text(settings, "utf-8")
            os.environ["LSLAPICFG"] = str(place)
        try:
            import pylsl  # loads its library on being imported

            pylsl.StreamInfo("settings", "none", 1, 0, "string", "settings")  # reads the settings, once
        except (ImportError, OSError, RuntimeError) as error:
            missing = isinstance(error, ImportError)
            why = describe_missing_extra("lab", phrase("The Lab Streaming Layer")) if missing else str(error)
            raise LabStreamError(
                phrase(
                    "the Lab Streaming Layer is not available. {why}. Or leave {option} out",
                    why=why,
                    option=option,
                )
            ) from None
        finally:
            if before is None:
                os.environ.pop("LSLAPICFG", None)
            else:
                os.environ["LSLAPICFG"] = before
    return pylsl


def open_outlet(lsl: Any, plan: OutletPlan) -> Any:
    """Return an outlet of pylsl, which others find from now on. lsl: the module pylsl. Raises
    LabStreamError.
    """
    info = lsl.StreamInfo(plan.name, plan.kind, len(plan.channels), plan.rate, plan.format, plan.source)
    described = [channel for channel in plan.channels if channel.kind or channel.unit or channel.object]
    if described or plan.more:
        top = info.desc()
        if described:
            channels = top.append_child("channels")
            for channel in plan.channels:
                _describe(channels.append_child("channel"), channel)
        parts: dict[tuple[str, ...], Any] = {(): top}
        for path, text in plan.more:
            for depth in range(1, len(path)):
                if path[:depth] not in parts:
                    parts[path[:depth]] = parts[path[: depth - 1]].append_child(path[depth - 1])
            parts[path[:-1]].append_child_value(path[-1], text)
    try:
        return lsl.StreamOutlet(info)
    except (RuntimeError, OSError) as error:
        raise LabStreamError(f"LSL cannot open the stream '{plan.name}': {error}") from None


def _describe(place: Any, channel: StreamChannel) -> None:
    told = {"label": channel.label, "object": channel.object, "type": channel.kind, "unit": channel.unit}
    for name, text in told.items():
        if text:
            place.append_child_value(name, text)
