"""Project data from canonical text, as `text.to_text` writes it, in a third of the time YAML takes.

Each value stands on one line, and is JSON once its plain words are in quotes. Whatever else YAML allows (made
by hand, faults) is left to `text.parse`, which says what is wrong and where: what is read here it reads the
same.
"""

from __future__ import annotations

import json
import re
from typing import Any

Data = dict[str, Any]

DEPTH = 16  # of containers within each other; a project needs 6
WORDS = {
    "y",
    "n",
    "yes",
    "no",
    "on",
    "off",
    "true",
    "false",
    "null",
    "none",
    "nan",
    "inf",
}  # YAML 1.1 readers take them for values
# What YAML has nowhere, not in comments either, and what some of its readers take for the end of a line.
ODD = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]")

_BARE = frozenset(("true", "false", "null"))
# A plain word, which may hold spaces; a number; quoted text; a colon that YAML takes for a part of a word.
_TOKEN = re.compile(
    r"([A-Za-z_][A-Za-z0-9_./()+-]*(?: +[A-Za-z0-9_./()+-]+)*"
    r"|-?\d[\d.eE+-]*"
    r'|"[^"\\\n]*(?:\\.[^"\\\n]*)*"'
    r"|:(?=[^ \n]))"
)
_BETWEEN = frozenset("{}[],: -\n")  # what stands between tokens
_STRANGE = re.compile(r"\\/|\\u(?:[dD][89a-fA-F]|0000)")  # said otherwise in YAML than in JSON
_FIELD = re.compile(r'( *)("(?:[^"\\]|\\.)*"):(?: (.+))?\Z')
_ITEM = re.compile(r"( *)- (.+)\Z")
_DIGITS = 15  # of an integer; one of more is no integer to `text.parse`
_FEW = DEPTH - 6  # brackets that open in a line, which cannot be too deep


class _OtherTextError(Exception):
    """The text is not canonical."""


def read_canonical(text: str) -> Data | None:
    """Return the data of a canonical text; None for any other, whatever it is."""
    if "\t" in text or ODD.search(text) or ("\\" in text and _STRANGE.search(text)):
        return None
    try:
        parts = _TOKEN.split(text[_header(text) :])
        if not _BETWEEN.issuperset("".join(parts[::2])):
            return None
        parts[1::2] = map(_Quoted().__getitem__, parts[1::2])
        return _read("".join(parts))
    except (_OtherTextError, ValueError, RecursionError):
        return None


def _header(text: str) -> int:
    """Return where what follows the lines of comment begins."""
    at = 0
    while text.startswith("#", at):
        at = text.find("\n", at) + 1 or len(text)
    return at


class _Quoted(dict[str, str]):
    """The JSON of each token."""

    def __missing__(self, token: str) -> str:
        first = token[0]
        out = token
        if first in "-0123456789":
            if len(token) > _DIGITS and token.lstrip("-").isdigit() and len(token.lstrip("-")) > _DIGITS:
                raise _OtherTextError
        elif first == ":":
            raise _OtherTextError
        elif first != '"' and token not in _BARE:
            if token.lower() in WORDS:
                raise _OtherTextError
            out = f'"{token}"'
        self[token] = out
        return out


def _read(text: str) -> Data:
    """Return the data of lines whose values are JSON."""
    out: Data = {}
    inner: list[Data] = [out]  # the mappings that lines belong to, by their indent: 0, 2 and 4 spaces
    items: list[Any] | None = None  # what `- ` lines are added to
    opened: tuple[Data, str] | None = None  # a field that waits for the lines of its value
    for line in text.splitlines():
        found = _ITEM.match(line)
        if found is not None:
            if opened is not None:
                if len(found[1]) != 2 * len(inner) - 2:
                    raise _OtherTextError
                items = opened[0][opened[1]] = []
                opened = None
            if items is None or len(found[1]) != 2 * len(inner) - 2:
                raise _OtherTextError
            items.append(_value(found[2]))
            continue
        found = _FIELD.match(line)
        if found is None:
            raise _OtherTextError
        items = None
        level, odd = divmod(len(found[1]), 2)
        if opened is not None:  # its value is a mapping, and this its first field
            if level != len(inner) or level > 2:
                raise _OtherTextError
            new: Data = {}
            opened[0][opened[1]] = new
            inner.append(new)
            opened = None
        if odd or level >= len(inner):
            raise _OtherTextError
        del inner[level + 1 :]
        key = found[2][1:-1] if "\\" not in found[2] else json.loads(found[2])
        if key in inner[level]:
            raise _OtherTextError
        if found[3] is None:
            inner[level][key] = None
            opened = (inner[level], key)
        else:
            inner[level][key] = _value(found[3])
    if opened is not None or not out:
        raise _OtherTextError
    return out


def _once(pairs: list[tuple[str, Any]]) -> Data:
    out = dict(pairs)
    if len(out) != len(pairs):
        raise _OtherTextError
    return out


_decode = json.JSONDecoder(object_pairs_hook=_once).decode


def _value(content: str) -> Any:
    value = _decode(content)
    if content.count("{") + content.count("[") > _FEW and _deep(value) > _FEW:
        raise _OtherTextError
    return value


def _deep(value: Any) -> int:
    """Return how many containers are within each other."""
    if isinstance(value, dict):
        return 1 + max(map(_deep, value.values()), default=0)
    if isinstance(value, list):
        return 1 + max(map(_deep, value), default=0)
    return 0
