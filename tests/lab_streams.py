"""The Lab Streaming Layer for tests: the real one, kept to this machine, or a stand-in that keeps what is
sent.
"""

from __future__ import annotations

import os
import types
from pathlib import Path
from typing import Any

import pytest

from metagraph.common.lab_streaming import THIS_COMPUTER


def require_lsl(folder: Path) -> Any:
    """Return pylsl with settings that reach nobody beyond this machine; skip the test where it is not
    installed. folder: to write the settings to. They count for the whole process once they are read.
    """
    place = folder / "lsl_api.cfg"
    place.write_text(THIS_COMPUTER, "utf-8")
    before = os.environ.get("LSLAPICFG")
    os.environ["LSLAPICFG"] = str(place)
    try:
        pylsl = pytest.importorskip(
            "pylsl", reason="pylsl is not installed", exc_type=(ImportError, RuntimeError)
        )
        pylsl.StreamInfo("settings", "none", 1, 0, "string", "settings")
    finally:
        if before is None:
            del os.environ["LSLAPICFG"]
        else:
            os.environ["LSLAPICFG"] = before
    return pylsl


FORMATS = {"float32": 1, "string": 3, "int32": 4}  # LSL's numbers of them


class Element:
    """A part of a description, as pylsl's XMLElement."""

    def __init__(self, name: str = "", text: str = "") -> None:
        self._name, self._text, self.inside = name, text, list[Element]()
        self.above: Element | None = None

    def append_child(self, name: str) -> Element:
        self.inside.append(Element(name))
        self.inside[-1].above = self
        return self.inside[-1]

    def append_child_value(self, name: str, text: str) -> Element:
        self.append_child(name)._text = text
        return self

    def child(self, name: str) -> Element:
        return next((x for x in self.inside if x._name == name), Element())

    def child_value(self, name: str) -> str:
        return self.child(name)._text

    def next_sibling(self, name: str) -> Element:
        later = [] if self.above is None else self.above.inside[self.above.inside.index(self) + 1 :]
        return next((x for x in later if x._name == name), Element())

    def empty(self) -> bool:
        return not self._name


class StreamInfo:
    """What a stream says about itself, as pylsl's StreamInfo."""

    def __init__(self, name: str, kind: str, count: int, rate: float, form: str, source: str) -> None:
        self.told = name, kind, count, rate, form, source
        self._desc = Element("desc")

    def name(self) -> str:
        return self.told[0]

    def type(self) -> str:
        return self.told[1]

    def channel_count(self) -> int:
        return self.told[2]

    def channel_format(self) -> int:
        return FORMATS[self.told[4]]

    def hostname(self) -> str:
        return "here"

    def uid(self) -> str:
        return str(id(self))

    def desc(self) -> Element:
        return self._desc


class StreamOutlet:
    """Keeps what is sent, as (sample, time)."""

    def __init__(self, info: StreamInfo) -> None:
        self.info, self.sent = info, list[tuple[Any, float]]()

    def push_sample(self, sample: Any, stamp: float = 0.0) -> None:
        self.sent.append((sample, stamp))

    def push_chunk(self, samples: Any, stamp: float = 0.0) -> None:
        self.sent += [(sample, stamp) for sample in samples]

    def get_info(self) -> StreamInfo:
        return self.info


def make_layer(clock: float = 1000.0) -> Any:
    """Return a stand-in for the module pylsl, whose clock stands still."""
    layer: Any = types.ModuleType("pylsl")
    layer.opened = list[StreamOutlet]()
    layer.StreamInfo = StreamInfo

    def open_outlet(info: StreamInfo) -> StreamOutlet:
        layer.opened.append(StreamOutlet(info))
        return layer.opened[-1]

    layer.StreamOutlet = open_outlet
    layer.local_clock = lambda: clock
    return layer
