"""What is wrong with a field of JSON, in words that say what would be right: its name, or its words."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

import msgspec

LISTED = 12  # fields or words that are named where none is near
_UNKNOWN = re.compile(r"unknown field `([^`]*)`")
_ENUM = re.compile(r"Invalid enum value '?([^']*)'?")


def explain_validation(error: Exception, kind: Any) -> str:
    """Return what is wrong with data that should be of a type, with the field it is in and the nearest name
    or word that there is. kind: what `msgspec` was to make of the data.
    """
    message, _, where = str(error).partition(" - at ")
    place = where.strip("`").removeprefix("$").lstrip(".")
    hint = ""
    if (unknown := _UNKNOWN.search(message)) is not None:
        hint = suggest_word(unknown[1], list(_fields_at(kind, place)))
    elif (wrong := _ENUM.search(message)) is not None:
        hint = suggest_word(wrong[1], list(_words_at(kind, place)))
    words = f"{message}; {hint}" if hint else message
    return f"{place}: {words}" if place else words


def suggest_word(word: str, known: Sequence[str]) -> str:
    """Return "did you mean 'x'?", or else what there is; "" if there is nothing."""
    near = get_close_matches(word, known, 1)
    if near:
        return f"did you mean '{near[0]}'?"
    more = ", ..." if len(known) > LISTED else ""
    return f"it is one of {', '.join(known[:LISTED])}{more}" if known else ""


def _fields_at(kind: Any, place: str) -> Iterator[str]:
    for part in _schemas_at(kind, place):
        yield from part.get("properties", ())


def _words_at(kind: Any, place: str) -> Iterator[str]:
    for part in _schemas_at(kind, place):
        yield from (str(word) for word in part.get("enum", ()) if word is not None)


def _schemas_at(kind: Any, place: str) -> list[Mapping[str, Any]]:
    """Return the parts of a type's JSON Schema that describe a place in its data, such as `steps[0].kind`."""
    (schema,), parts = msgspec.json.schema_components([kind], ref_template="#/$defs/{name}")

    def resolve(one: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
        if "$ref" in one:
            yield from resolve(parts[one["$ref"].rpartition("/")[2]])
            return
        yield one
        for other in (*one.get("anyOf", ()), *one.get("oneOf", ())):
            yield from resolve(other)

    found = list(resolve(schema))
    for name, entry in re.findall(r"([^.\[\]]+)|(\[[^\]]*\])", place):
        below: list[Mapping[str, Any]] = []
        for part in found:
            if entry:
                inner = part.get("items") or part.get("additionalProperties")
                below += resolve(inner) if isinstance(inner, Mapping) else ()
                for one in part.get("prefixItems", ()):
                    below += resolve(one)
            elif name in part.get("properties", {}):
                below += resolve(part["properties"][name])
        found = below
    return found
