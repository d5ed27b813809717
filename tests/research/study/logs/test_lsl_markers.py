"""A sitting's events as markers of the Lab Streaming Layer."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from metagraph.common.lab_streaming import LabStreamError
from metagraph.research.study.logs.lsl_markers import open_marker_outlet
from tests.lab_streams import make_layer, require_lsl


def test_kinds_and_numbers_are_sent_and_nothing_else(monkeypatch: pytest.MonkeyPatch) -> None:
    layer = make_layer()
    monkeypatch.setitem(sys.modules, "pylsl", layer)
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
    (outlet,) = layer.opened
    assert outlet.info.told == ("Metagraph", "Markers", 1, 0, "string", "metagraph-P07")
    assert json.loads(outlet.sent[0][0][0]) == {
        "n": 3,
        "type": "marker",
        "mono": 1.5,
        "name": "clap",
        "number": 2,
    }


def test_where_there_is_no_layer_the_remedy_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pylsl", None)
    with pytest.raises(LabStreamError, match=r"pip install .*pylsl.*'lsl: true'"):
        open_marker_outlet("P01")


def test_in_a_bundle_the_command_that_installs_it_there_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pylsl", None)
    monkeypatch.setattr("metagraph.common.extras.is_bundle", lambda: True)
    with pytest.raises(LabStreamError, match="metagraph extras add lab"):
        open_marker_outlet("P01")


def test_markers_reach_a_recorder_on_this_machine(tmp_path: Path) -> None:
    pylsl = require_lsl(tmp_path)
    send = open_marker_outlet("P01")
    (found, *_) = pylsl.resolve_byprop("source_id", "metagraph-P01", timeout=10.0) or pytest.skip(
        "no network here"
    )
    inlet = pylsl.StreamInlet(found)
    inlet.open_stream(timeout=10.0)
    send({"n": 1, "mono": 0.25, "type": "begin"})
    sample, when = inlet.pull_sample(timeout=10.0)
    assert json.loads(sample[0]) == {"n": 1, "type": "begin", "mono": 0.25} and when
