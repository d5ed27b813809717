"""Text for XML, SVG and HTML: what XML 1.0 cannot hold is replaced, so that one control character in a name
never spoils a file.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterable
from typing import Any

from metagraph.common.wording import Phrase, phrase

_CANNOT = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
INSTEAD = "\ufffd"


def clean_xml_text(text: str) -> str:
    """Return a text with `INSTEAD` for each character that XML 1.0 cannot hold."""
    return _CANNOT.sub(INSTEAD, text)


def escape(text: str, quote: bool = True) -> str:
    """Return a text as it stands in XML, SVG or HTML. quote: also between quotes, of either kind."""
    return html.escape(clean_xml_text(text), quote)


def quote_xml(text: str) -> str:
    """Return a text as the value of an attribute, with its quotes; line ends and tabs are kept."""
    kept = escape(text).replace("\n", "&#10;").replace("\t", "&#9;").replace("\r", "&#13;")
    return f'"{kept}"'


def describe_replaced(values: Iterable[Any]) -> Phrase | None:
    """Return what to say where texts lose characters in XML; None if none does. values: texts, and mappings
    and lists of them.
    """
    lost = sum(_CANNOT.search(text) is not None for text in _texts(values))
    if not lost:
        return None
    return phrase(
        "{count} texts contain control characters, which XML cannot hold: � replaces them", count=lost
    )


def _texts(value: Any) -> Iterable[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for key, inside in value.items():
            yield from _texts(key)
            yield from _texts(inside)
    elif isinstance(value, Iterable):
        for inside in value:
            yield from _texts(inside)
