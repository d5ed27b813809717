"""The Lab Streaming Layer: whom it may talk to, and what is said where it is missing."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import pytest

from metagraph.common import lab_streaming
from metagraph.common.lab_streaming import (
    THIS_COMPUTER,
    LabStreamError,
    OutletPlan,
    StreamChannel,
    find_own_settings,
    load_lsl,
    open_outlet,
)
from tests.lab_streams import make_layer


@pytest.fixture
def read(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    """A layer that reads its settings as liblsl does; what it read, "" for none."""
    out: list[str] = []
    layer: Any = make_layer()
    make_info = layer.StreamInfo

    def make(*told: Any) -> Any:
        place = os.environ.get("LSLAPICFG")
        out.append(Path(place).read_text("utf-8") if place else "")
        return make_info(*told)

    layer.StreamInfo = make
    monkeypatch.setitem(sys.modules, "pylsl", layer)
    monkeypatch.delenv("LSLAPICFG", raising=False)
    monkeypatch.setattr(lab_streaming, "SETTINGS", (str(tmp_path / "own.cfg"),))
    return out


def test_it_asks_this_computer_alone_unless_it_is_told_otherwise(read: list[str]) -> None:
    load_lsl("--lsl", network=False)
    assert read == [THIS_COMPUTER] and "ResolveScope = machine" in read[0]
    assert "LSLAPICFG" not in os.environ, "programs that are started later have their own settings"


def test_in_the_network_it_has_its_own_way(read: list[str]) -> None:
    load_lsl("--lsl", network=True)
    assert read == [""]


def test_settings_of_the_users_own_count(
    read: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "own.cfg").write_text("[lab]\n", "utf-8")
    assert find_own_settings() == str(tmp_path / "own.cfg")
    named = tmp_path / "named.cfg"
    named.write_text("[lab]\nSessionID = mine\n", "utf-8")
    monkeypatch.setenv("LSLAPICFG", str(named))
    assert find_own_settings() == str(named)
    load_lsl("--lsl", network=False)
    assert "SessionID = mine" in read[0] and os.environ["LSLAPICFG"] == str(named)


def test_a_missing_library_is_said_with_the_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pylsl", None)
    with pytest.raises(LabStreamError, match=r"pip install .*pylsl.*Or leave --lsl out"):
        load_lsl("--lsl", network=False)


def test_parts_of_a_description_with_one_beginning_are_in_one_part() -> None:
    layer = make_layer()
    more = ((("setup", "name"), "here"), (("setup", "space", "up"), "y"))
    open_outlet(layer, OutletPlan("A", "MoCap", "a", (StreamChannel("x", "PositionX"),), more=more))
    top = layer.opened[0].info.desc()
    assert top.child("setup").child_value("name") == "here"
    assert top.child("setup").child("space").child_value("up") == "y"
    assert len(top.inside) == 2


def test_a_stream_that_cannot_be_opened_is_named() -> None:
    layer = make_layer()

    def fail(info: Any) -> Any:
        raise RuntimeError("no port is free")

    layer.StreamOutlet = fail
    with pytest.raises(LabStreamError, match="cannot open the stream 'A': no port is free"):
        open_outlet(layer, OutletPlan("A", "Markers", "a", (StreamChannel("x"),)))
