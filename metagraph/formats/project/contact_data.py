"""Contacts of actions as plain data, and back."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from metagraph.formats.project.fields import (
    Data,
    DataError,
    as_plain,
    get,
    read_floats,
    refuse_unknown_fields,
    require_one_of,
    round_number,
)
from metagraph.motion.contact_spans import EASE, HANDS, PLACES, ContactKey, ContactSpan

_FIELDS = ("hand", "place", "to", "start", "end", "ease_in", "ease_out", "keys")
MOST = 100_000  # keys of a contact


def encode_contacts(contacts: Iterable[ContactSpan]) -> list[Data]:
    """Return contacts; a key is a row of eight: clip seconds, where the wrist is, how the hand is turned."""
    out = []
    for span in contacts:
        data = {name: as_plain(getattr(span, name)) for name in _FIELDS[:5]}
        data |= {name: as_plain(x) for name in _FIELDS[5:7] if (x := getattr(span, name)) != EASE}
        out.append({**data, "keys": [as_plain((k.time, *k.at, *k.turn)) for k in span.keys]})
    return out


def decode_contacts(data: Data, where: str) -> tuple[ContactSpan, ...]:
    """Return an action's contacts from its data. Raises DataError."""
    if "contacts" not in data:
        return ()
    return tuple(_spans(get(data, "contacts", list, where, ()), where))


def _spans(items: Iterable[Data], where: str) -> Iterator[ContactSpan]:
    for n, item in enumerate(items):
        place = f"{where}.contacts[{n}]"
        hand, touching, to = (get(item, name, str, place) for name in _FIELDS[:3])
        start, end = (get(item, name, float, place) for name in ("start", "end"))
        ease_in, ease_out = (get(item, name, float, place, EASE) for name in ("ease_in", "ease_out"))
        rows = get(item, "keys", list, place)
        refuse_unknown_fields(item, _FIELDS, place)
        require_one_of(hand, HANDS, f"{place}.hand")
        require_one_of(touching, PLACES, f"{place}.place")
        if not 0 <= start <= end <= 1e5:
            raise DataError(f"{place}.start", f"should be 0 or more and not after the end, found {start:g}")
        if not (0 <= ease_in <= 1e5 and 0 <= ease_out <= 1e5):
            raise DataError(f"{place}.ease_in", "and ease_out should be 0 or more seconds")
        if not 0 < len(rows) <= MOST:
            raise DataError(f"{place}.keys", f"should be one key or more, and at most {MOST}")
        keys = tuple(_key(row, f"{place}.keys[{m}]") for m, row in enumerate(rows))
        if any(a.time >= b.time for a, b in pairwise(keys)):
            raise DataError(f"{place}.keys", "should be in the order of their times")
        yield ContactSpan(hand, touching, to, start, end, keys, ease_in, ease_out)


def _key(row: object, where: str) -> ContactKey:
    if not isinstance(row, list):
        raise DataError(where, "should be a list of eight numbers")
    time, x, y, z, *turn = read_floats(row, 8, where, 1e6)
    size = sum(q * q for q in turn) ** 0.5
    if not 0.9 < size < 1.1:
        raise DataError(where, "should end with a quaternion of length 1")
    a, b, c, d = turn if abs(size - 1) < 1e-4 else (q / size for q in turn)
    return ContactKey(float(round_number(time)), (x, y, z), (a, b, c, d))
