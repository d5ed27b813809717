"""OSC addresses and the requests they say."""

from __future__ import annotations

import json
import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import requests as a
from metagraph.live.hub import Hub
from metagraph.live.messages import HeardMessage, Hello, Poses, Reply, encode, read_live_request
from metagraph.live.osc import SENDERS, SILENT, OscError, OscLine, read_osc_request, read_osc_texts
from metagraph.live.osc_bytes import pad_osc


def said(address: str, *values: Any) -> Any:
    found = read_live_request(encode(read_osc_request(f"/metagraph/{address}", values)))
    assert isinstance(found, HeardMessage), found
    return found.message if found.after is None else found


@pytest.mark.parametrize(
    ("address", "values", "message"),
    [
        ("gesture", (), a.Gesture()),
        ("gesture", ("head", "positive", "agree"), a.Gesture(layer="head", tags=("positive", "agree"))),
        (
            "gesture",
            ("beat", "limb=left", "at=2.5", "prepare=false"),
            a.Gesture(tags=("beat",), limb="left", at=2.5, prepare=False),
        ),
        ("fidget", ("priority=3", "resume=true"), a.Fidget(priority=3, resume=True)),
        ("gesture", ("in=1",), HeardMessage(a.Gesture(), 1.0)),
        ("fidget", ("body",), a.Fidget(layer="body")),
        ("change", ("head",), a.Change(layer="head")),
        ("nod", (), a.Nod()),
        ("shake", ("doubt",), a.Shake(tags=("doubt",))),
        ("action", ("bow_01",), a.Play(action="bow_01")),
        ("stance", ("on hips", "arms"), a.Go(stance="on hips", layer="arms")),
        ("look", (), a.Look()),
        ("look", ("door",), a.Look(to="door")),
        ("look", (0.5, 1, 2.0), a.Look(to=(0.5, 1.0, 2.0))),
        ("blink", (), a.Blink()),
        ("say", ("279",), a.Say(line="279")),
        ("say", (279,), a.Say(line="279")),
        ("text", ("Hello", "you"), a.Say(text="Hello you")),
        ("mode", ("listening",), a.Behave(mode="listening")),
        ("mode", (), a.Behave()),
        ("place", ("door", 0, 1, 2), a.Place(name="door", point=(0.0, 1.0, 2.0))),
        ("withdraw", (), a.Withdraw()),
        ("withdraw", ("x",), a.Withdraw(what="x")),
        ("hello", ("secret",), Hello(token="secret")),
        ("events", (1,), Hello(events=True)),
        (
            "poses",
            (60.0, "Head", "space=model"),
            Hello(poses=Poses(rate=60.0, format="osc", joints=("Head",), space="model")),
        ),
        ("poses", (0,), Hello(poses=None)),
    ],
)  # fmt: skip
def test_an_address_says_a_request(address: str, values: tuple[Any, ...], message: Any) -> None:
    assert said(address, *values) == message


@pytest.mark.parametrize(
    "address", ["/metagraph/dance", "/other/nod", "", "/metagraph/", "/metagraph/action", "/metagraph/stance"]
)
def test_other_addresses_say_none(address: str) -> None:
    with pytest.raises(OscError):
        read_osc_request(address, ())


@given(st.binary(max_size=200))
def test_any_datagram_is_taken_apart_or_refused(data: bytes) -> None:
    for each in (
        data,
        b"#bundle\0" + b"\0" * 7 + b"\1" + data,
        pad_osc("/metagraph/gesture") + pad_osc(",s") + data,
    ):
        for _, text in read_osc_texts(each):
            assert isinstance(text, bytes | str | bool | OscError)


def test_bundles_within_bundles_end() -> None:
    data = b""
    for _ in range(2000):
        inner = b"" if not data else len(data).to_bytes(4, "big") + data
        data = b"#bundle\0" + (1).to_bytes(8, "big") + inner
    assert all(isinstance(text, OscError) for _, text in read_osc_texts(data))


def test_senders_are_forgotten_when_they_are_silent_and_only_so_many_are_known() -> None:
    now = [0.0]
    hub = Hub()
    line = OscLine(hub, lambda: now[0])
    message = pad_osc("/metagraph/nod") + pad_osc(",")
    for n in range(SENDERS + 10):
        line.datagram_received(message, ("127.0.0.1", 1000 + n))
    assert len(hub.clients) == SENDERS
    now[0] = SILENT + 1
    line.datagram_received(message, ("127.0.0.1", 5))
    assert list(line.senders) == [("127.0.0.1", 5)] and len(hub.clients) == 1


# --- what nobody should send


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x1b[31mred\0\0\0",
        b"/a",
        b"/a\0\0",
        b"/\x1b[2J\0\0\0,i\0\0\0\0\0\1",
        b"/metagraph/nod\0\0,z\0\0",
        b"/metagraph/nod\0\0,i\0\0\0",
        b"/metagraph/nod\0\0,[[\0",
        b"/metagraph/nod\0\0,]\0\0",
        b"#bundle\0" + bytes(8) + b"\xff\xff\xff\xff/a\0\0",
        b"#bundle\0" + bytes(8) + b"\0\0\0\1abc",
        b"#bundle\0" * 3,
        bytes(range(256)),
    ],
)
def test_junk_is_told_in_words_and_never_shown(
    data: bytes, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    from metagraph.live.osc import read_osc_texts
    from metagraph.live.osc_bytes import OscError

    for _, found in read_osc_texts(data):
        if isinstance(found, OscError):
            assert str(found).isascii() and str(found).isprintable()
    assert capfd.readouterr() == ("", "") and not caplog.records


def test_bundles_within_bundles_end_somewhere() -> None:
    from metagraph.live.osc_bytes import OscError, pad_osc, read_osc_messages

    data = pad_osc("/a") + pad_osc(",")
    for _ in range(30):
        data = b"#bundle\0" + bytes(8) + len(data).to_bytes(4, "big") + data
    with pytest.raises(OscError, match="deep"):
        list(read_osc_messages(data))
    many = b"#bundle\0" + bytes(8) + (b"\0\0\0\x08" + pad_osc("/a") + pad_osc(",")) * 1001
    with pytest.raises(OscError, match="more than"):
        list(read_osc_messages(many))


def test_values_of_every_type_are_taken_apart() -> None:
    from pythonosc.osc_message_builder import OscMessageBuilder

    from metagraph.live.osc_bytes import read_osc_messages

    built = OscMessageBuilder("/x/é")
    values = [1, 2.5, "wört", b"abc", True, False, None, [3, ["four"]], ""]
    for value in values:
        built.add_arg(value)
    assert list(read_osc_messages(built.build().dgram)) == [("/x/é", values)]


@pytest.mark.parametrize(("ahead", "begins"), [(3.0, 3.0), (0.0, None), (-5.0, None), (None, None)])
def test_a_bundle_begins_when_its_time_tag_says(ahead: float | None, begins: float | None) -> None:
    now = 1_800_000_000.25
    tag = 1 if ahead is None else round((now + ahead + 2_208_988_800) * 2**32)
    messages = [
        pad_osc("/metagraph/gesture") + pad_osc(",s") + pad_osc("greeting"),
        pad_osc("/metagraph/nod") + pad_osc(",s") + pad_osc("in=0.5"),
        pad_osc("/metagraph/status") + pad_osc(","),
    ]
    data = b"#bundle\0" + tag.to_bytes(8, "big") + b"".join(len(m).to_bytes(4, "big") + m for m in messages)
    gesture, nod, status = (json.loads(text) for _, text in read_osc_texts(data, now))  # type: ignore[arg-type]
    assert gesture.get("in") == begins and nod["in"] == 0.5 and "in" not in status


def message(address: str, value: Any) -> bytes:
    """Return an OSC message of one number or truth value."""
    if isinstance(value, bool):
        return pad_osc(address) + pad_osc(",T" if value else ",F")
    return pad_osc(address) + pad_osc(",f") + struct.pack(">f", value)


@pytest.mark.parametrize("value", [0, 0.0, False])
def test_a_button_that_is_let_go_asks_for_nothing_and_is_told_so(value: Any) -> None:
    ((_, let_go),) = read_osc_texts(message("/metagraph/nod", value))
    assert isinstance(let_go, Reply) and let_go.state == "done" and "released button" in let_go.why
    ((_, pressed),) = read_osc_texts(message("/metagraph/nod", 1))
    assert isinstance(pressed, bytes)
    ((_, line),) = read_osc_texts(message("/metagraph/say", value))
    assert isinstance(line, bytes), "a line may be called 0"


def test_a_bundle_for_too_far_ahead_is_refused_with_a_reason() -> None:
    message = pad_osc("/metagraph/blink") + pad_osc(",")
    tag = (2_208_988_800 + 1000) << 32
    data = b"#bundle\0" + tag.to_bytes(8, "big") + len(message).to_bytes(4, "big") + message
    ((_, found),) = read_osc_texts(data, 500.0)
    assert isinstance(found, OscError) and "500 s ahead" in str(found) and "60 s" in str(found)
