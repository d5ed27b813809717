"""A sitting's events as markers of the Lab Streaming Layer."""

from __future__ import annotations

import json
import sys
import types
from typing import Any

import pytest

from metagraph.research.study.logs.lsl_markers import MarkersError, open_marker_outlet


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """A layer that keeps what is sent."""
    out: list[Any] = []
    layer: Any = types.ModuleType("pylsl")
    layer.StreamInfo = lambda *told: out.append(told) or told
    layer.StreamOutlet = lambda _: types.SimpleNamespace(
        push_sample=lambda values: out.append(json.loads(values[0]))
    )
    monkeypatch.setitem(sys.modules, "pylsl", layer)
    return out


def test_kinds_and_numbers_are_sent_and_nothing_else(sent: list[Any]) -> None:
    send = open_marker_outlet("P07")
    send(
        {
            "n": 3,
            "run": "ab",
            "mono": 1.5,
            "wall": "2026",
            "type": "marker",
            "name": "clap",
            "number": 2,
            "x": "y",
        }
    )
    assert sent[0][:4] == ("Metagraph", "Markers", 1, 0) and sent[0][5] == "metagraph-P07"
    assert sent[1] == {"n": 3, "type": "marker", "mono": 1.5, "name": "clap", "number": 2}


def test_where_there_is_no_layer_the_remedy_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pylsl", None)
    with pytest.raises(MarkersError, match=r"pip install .*pylsl.*'lsl: true'"):
        open_marker_outlet("P01")


def test_in_a_bundle_the_command_that_installs_it_there_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pylsl", None)
    monkeypatch.setattr("metagraph.common.extras.is_bundle", lambda: True)
    with pytest.raises(MarkersError, match="metagraph extras add lab"):
        open_marker_outlet("P01")


def test_markers_reach_a_recorder_on_this_machine() -> None:
    pylsl = pytest.importorskip(
        "pylsl", reason="pylsl is not installed", exc_type=(ImportError, RuntimeError)
    )
    send = open_marker_outlet("P01")
    (found, *_) = pylsl.resolve_byprop("source_id", "metagraph-P01", timeout=10.0) or pytest.skip(
        "no network here"
    )
    inlet = pylsl.StreamInlet(found)
    inlet.open_stream(timeout=10.0)
    send({"n": 1, "mono": 0.25, "type": "begin"})
    sample, when = inlet.pull_sample(timeout=10.0)
    assert json.loads(sample[0]) == {"n": 1, "type": "begin", "mono": 0.25} and when
