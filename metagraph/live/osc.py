"""OSC over UDP: messages in, and for those who ask replies, events and poses out. The addresses are listed in
docs/agents/osc.md.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from metagraph.graph.words import LAYERS
from metagraph.live.hub import BACKLOG, Hub
from metagraph.live.messages import LONGEST_MESSAGE, Reply, encode
from metagraph.live.osc_bytes import OscError, measure_seconds_ahead, pad_osc, read_osc_messages

ROOT = "/metagraph/"
SILENT = 60.0  # seconds after which a sender is forgotten
SENDERS = 32  # known at once
STEERING = ("withdraw", "interrupt", "pause", "resume", "finish")
AT_ONCE = ("hello", "status", "describe", *STEERING)  # whatever the time tag of their bundle says
# Addresses that take no number, so that a number reports a button: 0 when it is let go.
BUTTONS = ("gesture", "fidget", "change", "nod", "shake", "action", "stance", "blink", "text", *STEERING)
LET_GO = "a value of 0 means a released button; send another number"
LARGEST = 60_000  # bytes of one datagram that is sent


def read_osc_request(address: str, values: Sequence[Any]) -> Mapping[str, Any]:
    """Return the request an OSC message says. Raises OscError with what would be right.

    Texts like `priority=3` or `in=0.5` set fields of any request; the other values mean what the address
    says.
    """
    word = address.removeprefix(ROOT)
    if word == address:
        raise OscError(f"addresses begin with {ROOT}")
    said = _Values.of(values)
    found = _of_moving(word, said) or _of_speech(word, said) or _of_session(word, said)
    if found is None:
        raise OscError(f"there is no address {address[:80]}")
    return found


@dataclass(frozen=True)
class _Values:
    """What a message says. more: the fields it sets by name; plain: its other values, of which some are texts
    and some numbers.
    """

    more: dict[str, Any]
    plain: list[Any]
    texts: list[str]
    numbers: list[float]

    @classmethod
    def of(cls, values: Sequence[Any]) -> _Values:
        more = dict(_field(x) for x in values if isinstance(x, str) and "=" in x)
        plain = [x for x in values if not (isinstance(x, str) and "=" in x)]
        texts = [x for x in plain if isinstance(x, str)]
        return cls(more, plain, texts, [float(x) for x in plain if isinstance(x, int | float)])

    def first(self, name: str) -> dict[str, str]:
        """Return the first text as a field of this name, nothing if there is none."""
        return {name: self.texts[0]} if self.texts else {}


def _of_moving(word: str, said: _Values) -> Mapping[str, Any] | None:
    """Return an ask for motion; None if the address is about something else."""
    texts, more = said.texts, said.more
    match word:
        case "gesture" | "fidget":
            layer = {"layer": texts[0]} if texts and texts[0] in LAYERS else {}
            return {"do": word} | layer | {"tags": texts[len(layer) :]} | more
        case "change":
            return {"do": word} | said.first("layer") | more
        case "nod" | "shake":
            return {"do": word, "tags": texts} | more
        case "action" | "stance":
            if not texts:
                raise OscError(f"{ROOT}{word} needs a name")
            return {"do": word, word: texts[0]} | ({"layer": texts[1]} if len(texts) > 1 else {}) | more
        case "look":
            return {"do": word, "to": texts[0] if texts else said.numbers or "user"} | more
        case "blink":
            return {"do": word} | more
    return None


def _of_speech(word: str, said: _Values) -> Mapping[str, Any] | None:
    """Return an ask to say a line or words; None if the address is about something else."""
    match word:
        case "say":
            line = said.first("line") or ({"line": str(said.plain[0])} if said.plain else {})
            return {"do": word} | line | said.more
        case "text":
            return {"do": "say", "text": " ".join(said.texts)} | said.more
    return None


def _of_session(word: str, said: _Values) -> Mapping[str, Any] | None:
    """Return what is said of the character's surroundings and to the session; None for any other address."""
    texts, numbers, more = said.texts, said.numbers, said.more
    match word:
        case "status" | "describe":
            return {"do": word} | more
        case "mode":
            return {"do": word, "mode": texts[0] if texts and texts[0] else None} | more
        case "place":
            return {"do": word, "name": texts[0] if texts else "user", "point": numbers} | more
        case "withdraw" | "interrupt" | "pause" | "resume" | "finish":
            return {"do": word, "what": texts[0] if texts else ""} | more
        case "hello":
            return {"do": word} | said.first("token") | more
        case "events":
            return {"do": "hello", "events": bool(numbers and numbers[0])} | more
        case "poses":
            rate = numbers[0] if numbers else 30.0
            poses: dict[str, Any] = {"rate": rate, "format": "osc"} | ({"joints": texts} if texts else {})
            for name in ("space", "translations"):
                if name in more:
                    poses[name] = bool(more.pop(name)) if name == "translations" else more.pop(name)
            return {"do": "hello", "poses": poses if rate > 0 else None} | more
        case "set":
            name, *values = said.plain if said.texts[:1] == said.plain[:1] else ("", *said.plain)
            return {"do": "set", "name": name} | ({"value": _join_values(values)} if values else {}) | more
    return None


def _join_values(values: Sequence[Any]) -> Any:
    """Return the one value of a parameter, or a list of several."""
    return values[0] if len(values) == 1 else list(values)


def _field(text: str) -> tuple[str, Any]:
    name, _, value = text.partition("=")
    try:
        return name, float(value) if "." in value else int(value)
    except ValueError:
        return name, {"true": True, "false": False}.get(value, value)


def read_osc_texts(
    datagram: bytes, now: float | None = None
) -> Iterator[tuple[str, bytes | str | OscError | Reply | bool]]:
    """Yield, for each message of a datagram, its address and the JSON it says, what is wrong, the reply if
    nothing is asked, or whether replies are wanted. A request of a bundle begins when the bundle's time tag
    says. `now` is in seconds since 1970, the system's if None.
    """
    try:
        messages = list(read_osc_messages(datagram))
        ahead = measure_seconds_ahead(datagram, time.time() if now is None else now)
    except OscError as error:
        yield "", OscError(f"not OSC: {error}")
        return
    for address, values in messages:
        try:
            if address == ROOT + "replies":
                yield address, bool(values[0]) if values else True
            elif address == ROOT + "json":
                yield address, str(values[0]) if values else ""
            elif _is_let_go(address, values):
                yield address, Reply(state="done", why=LET_GO)
            else:
                asked = dict(read_osc_request(address, values))
                if ahead > 0 and asked["do"] not in AT_ONCE and not {"in", "at"} & asked.keys():
                    asked["in"] = round(ahead, 3)
                yield address, encode(asked)
        except (OscError, TypeError, ValueError) as error:
            yield address, OscError(str(error))


def _is_let_go(address: str, values: Sequence[Any]) -> bool:
    """Whether a message tells that a button is let go."""
    numbers = [x for x in values if isinstance(x, int | float)]
    return address.removeprefix(ROOT) in BUTTONS and len(numbers) == 1 and numbers[0] == 0


class _Sender:
    """One address that sends. wants: whether replies and events are to be sent back."""

    formats = ("osc",)

    def __init__(self, osc: OscLine, address: Any) -> None:
        self.osc, self.address, self.wants, self.number, self.heard = osc, address, False, 0, 0.0

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Send replies and events as texts, poses as they are."""
        for data, binary in messages:
            if binary:
                self.osc.put(data, self.address)
            elif self.wants:
                word = "event" if data.startswith(b'{"event"') else "reply"
                text = data.decode()
                if len(data) > LARGEST:
                    text = '{"error":"the reply is too long for a datagram; ask over WebSocket"}'
                self.osc.put(pad_osc(f"{ROOT}{word}") + pad_osc(",s") + pad_osc(text), self.address)

    def answered(self, messages: int) -> None:
        """Nothing depends on it."""

    def backlog(self) -> int:
        """Datagrams do not wait."""
        return 0

    def close(self, code: int, reason: str) -> None:
        """Forget the sender."""
        self.osc.senders.pop(self.address, None)


class OscLine(asyncio.DatagramProtocol):
    """All senders of one port."""

    def __init__(self, hub: Hub, clock: Callable[[], float]) -> None:
        self.hub, self.clock = hub, clock
        self.senders: dict[Any, _Sender] = {}
        self.transport: Any = None  # asyncio.DatagramTransport, whose types lack how much waits

    def connection_made(self, transport: Any) -> None:
        self.transport = transport

    def datagram_received(self, data: bytes, address: Any) -> None:
        sender = self._sender(address)
        if sender is None:
            return
        for _, text in read_osc_texts(data[:LONGEST_MESSAGE]):
            if isinstance(text, bool):
                sender.wants = text
            elif isinstance(text, OscError):
                sender.send([(encode({"error": str(text)}), False)])
            elif isinstance(text, Reply):
                sender.send([(encode(text), False)])
            elif sender.number:
                self.hub.message(sender.number, text)

    def error_received(self, error: Exception) -> None:
        """Nobody listens where something was sent; that is theirs to know."""

    def _sender(self, address: Any) -> _Sender | None:
        sender = self.senders.get(address)
        if sender is None:
            self.check()
            if len(self.senders) >= SENDERS:
                return None
            sender = _Sender(self, address)
            sender.number = self.hub.open(sender, self.clock())
            if sender.number:
                self.senders[address] = sender
        sender.heard = self.clock()
        return sender if sender.number else None

    def check(self) -> None:
        """Forget those that have been silent for long."""
        now = self.clock()
        for sender in [s for s in self.senders.values() if now - s.heard > SILENT]:
            self.hub.drop(sender.number, 1000, "silent")
            self.senders.pop(sender.address, None)

    def put(self, data: bytes, address: Any) -> None:
        """Send a datagram; while too many wait for the system it is lost, as datagrams may be."""
        transport = self.transport
        if transport is None or transport.is_closing() or transport.get_write_buffer_size() > BACKLOG:
            return
        transport.sendto(data, address)
