"""Ways to break a file by knowing what it is made of."""

from __future__ import annotations

import copy
import json
import math
import random
import re
import struct
from collections.abc import Iterator
from typing import Any

NUMBERS = (b"-1", b"0", b"1e309", b"-1e30", b"nan", b"inf", b"9" * 40, b"1e-300", b"4294967296", b"0.5")
JSON = (b"{", b"}", b"[", b"]", b"null", b"true", b'""', b'"\\ud800"', b"[" * 200, b'{"a":' * 200, b",", b":")
XML = (b"<", b">", b"</", b"/>", b"&a;", b"<!DOCTYPE x [<!ENTITY a 'b'>]>", b"<![CDATA[", b"'", b'"')

HOSTILE: tuple[Any, ...] = (
    -1, 0, 1, 3, 255, 1 << 31, (1 << 63) - 1, 1 << 70, 1e308, -1e30, 0.5, None, "", "VEC4", "x" * 300, [], {},
    [0] * 5, [[]], True, "\ud800", "../../etc/passwd", "/dev/zero", {"x": []}, [None], 1e-300,
)  # fmt: skip


def places(value: Any) -> Iterator[tuple[Any, Any]]:
    """Yield every value of a document by what holds it."""
    stack = [value]
    while stack:
        holder = stack.pop()
        some = (
            holder.items()
            if isinstance(holder, dict)
            else enumerate(holder)
            if isinstance(holder, list)
            else ()
        )
        for key, inner in list(some):
            yield holder, key
            stack.append(inner)


def spoilt(chance: random.Random, document: Any) -> Any:
    """Return a document with some values replaced, taken away, doubled or swapped."""
    document = json.loads(json.dumps(document))
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        spots = list(places(document))
        if not spots:
            break
        holder, key = chance.choice(spots)
        match chance.randrange(5):
            case 0 if isinstance(holder, dict):
                holder.pop(key, None)
            case 1 if isinstance(holder, list):
                holder += [copy.deepcopy(holder[key]) for _ in range(chance.choice((1, 7)))]
            case 2:
                other, at = chance.choice(spots)
                holder[key] = copy.deepcopy(other[at])
            case _:
                holder[key] = copy.deepcopy(chance.choice(HOSTILE))
    return document


def spoilt_json(chance: random.Random, data: bytes) -> bytes:
    return json.dumps(spoilt(chance, json.loads(data))).encode()


def packed(document: Any, body: bytes) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(body), len(text), 0x4E4F534A)
    return head + text + struct.pack("<II", len(body), 0x004E4942) + body


def spoilt_glb(chance: random.Random, data: bytes) -> bytes:
    size = struct.unpack_from("<I", data, 12)[0]
    document, body = json.loads(data[20 : 20 + size]), bytearray(data[28 + size :])
    if chance.random() < 0.75:
        document = spoilt(chance, document)
    if chance.random() < 0.5:
        special = struct.pack("<f", chance.choice((math.nan, math.inf, 3e38, 1e-45, -1.0, 0.0)))
        for _ in range(chance.choice((1, 4, 64))):
            at = 4 * chance.randrange(max(1, len(body) // 4))
            body[at : at + 4] = special if chance.random() < 0.5 else chance.randbytes(4)
    return packed(document, bytes(body))


def spoilt_words(chance: random.Random, data: bytes) -> bytes:
    """Return a text with words replaced, lines doubled, dropped or swapped."""
    lines = data.split(b"\n")
    for _ in range(chance.choice((1, 1, 2, 5))):
        n = chance.randrange(len(lines))
        match chance.randrange(4):
            case 0:
                lines[n:n] = [lines[chance.randrange(len(lines))]] * chance.choice((1, 20))
            case 1:
                del lines[n : n + chance.choice((1, 3))]
                lines = lines or [b""]
            case _:
                words = re.split(rb"([ ,;\t])", lines[n])  # every other one is what parts them
                words[2 * chance.randrange(len(words) // 2 + 1)] = chance.choice(NUMBERS)
                lines[n] = b"".join(words)
    return b"\n".join(lines)
