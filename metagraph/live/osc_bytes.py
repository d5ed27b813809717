"""OSC 1.0 as bytes: texts packed, and datagrams taken apart without a word on anybody's screen about what is
in them.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Any

DEEPEST = 8  # bundles within bundles, lists within lists
LONGEST_AHEAD = 60.0  # seconds that a bundle may be for; a clock that is off by more is no clock
_SINCE_1900 = 2_208_988_800  # seconds from 1900, which time tags count from, to 1970
MOST = 1000  # messages of one datagram
_NUMBERS = {"i": ">i", "f": ">f", "h": ">q", "d": ">d", "t": ">Q"}
_PLAIN = {"T": True, "F": False, "N": None, "I": None}
_BUNDLE = b"#bundle\0"


class OscError(ValueError):
    """A message that cannot be turned into a request."""


def pad_osc(text: str) -> bytes:
    """Return a text as OSC has it: ended by a zero byte and filled up to four."""
    data = text.encode("utf-8", "replace").replace(b"\0", b"?") + b"\0"
    return data + b"\0" * (-len(data) % 4)


def read_osc_messages(datagram: bytes, depth: int = 0) -> Iterator[tuple[str, list[Any]]]:
    """Yield address and values of each message. Raises OscError with the place, never with the bytes."""
    if not datagram.startswith(_BUNDLE):
        yield _message(datagram)
        return
    if depth >= DEEPEST:
        raise OscError(f"bundles are nested more than {DEEPEST} deep")
    at = len(_BUNDLE) + 8  # the time at which it should be heard
    count = 0
    while at < len(datagram):
        size = int.from_bytes(datagram[at : at + 4], "big")
        part = datagram[at + 4 : at + 4 + size]
        if not size or size % 4 or len(part) < size:
            raise OscError(f"the part at byte {at} of a bundle is larger than the bundle")
        for found in read_osc_messages(part, depth + 1):
            count += 1
            if count > MOST:
                raise OscError(f"the bundle has more than {MOST} messages")
            yield found
        at += 4 + size


def measure_seconds_ahead(datagram: bytes, now: float) -> float:
    """Return in how many seconds a bundle is to be heard, by its time tag; 0 for at once, for what is past,
    and for a message by itself. `now` is in seconds since 1970. Raises OscError for more than
    `LONGEST_AHEAD`.
    """
    tag = datagram[len(_BUNDLE) : len(_BUNDLE) + 8]
    if not datagram.startswith(_BUNDLE) or len(tag) < 8:
        return 0.0
    seconds, part = int.from_bytes(tag[:4], "big"), int.from_bytes(tag[4:], "big")
    ahead = seconds - _SINCE_1900 + part / 2**32 - now
    if ahead > LONGEST_AHEAD:
        raise OscError(f"the bundle is for {ahead:.0f} s ahead; at most {LONGEST_AHEAD:.0f} s are allowed")
    return max(0.0, ahead)


def _message(data: bytes) -> tuple[str, list[Any]]:
    address, at = _text(data, 0)
    if not address.startswith("/") or not address.isprintable():
        raise OscError("the message does not begin with an address")
    if at >= len(data):
        return address, []
    types, at = _text(data, at)
    if not types.startswith(","):
        raise OscError("the type tags are missing")
    stack: list[list[Any]] = [[]]
    for kind in types[1:]:
        if kind == "[":
            if len(stack) > DEEPEST:
                raise OscError(f"lists are nested more than {DEEPEST} deep")
            stack.append([])
        elif kind == "]":
            if len(stack) < 2:
                raise OscError("a list ends that did not begin")
            inner = stack.pop()
            stack[-1].append(inner)
        else:
            value, at = _value(kind, data, at)
            stack[-1].append(value)
    if len(stack) > 1:
        raise OscError("a list does not end")
    return address, stack[0]


def _value(kind: str, data: bytes, at: int) -> tuple[Any, int]:
    if kind in _PLAIN:
        return _PLAIN[kind], at
    if kind in "sS":
        return _text(data, at)
    if kind == "b":
        size = int.from_bytes(data[at : at + 4], "big")
        end = at + 4 + size
        if end > len(data):
            raise OscError(f"the message ends within the value at byte {at}")
        return data[at + 4 : end], end + (-size % 4)
    code = _NUMBERS.get(kind)
    size = struct.calcsize(code) if code is not None else 4
    if kind not in (*_NUMBERS, "c", "r", "m"):
        raise OscError("the message has a value of an unknown type")
    if at + size > len(data):
        raise OscError(f"the message ends within the value at byte {at}")
    return (struct.unpack_from(code, data, at)[0] if code is not None else data[at : at + 4]), at + size


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.find(b"\0", at)
    if end < 0 or end >= len(data):
        raise OscError(f"the text at byte {at} does not end")
    return data[at:end].decode("utf-8", "replace"), end + 4 - (end - at) % 4
