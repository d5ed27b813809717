"""The window's words in another language.

English stands in the code, inside `tr`; a language is a file of English texts and what stands in their place
(`languages/de.json`), the form that translation services call flat JSON. What a language lacks is shown in
English. It is chosen once, before the window is made. What the domain says of files and graphs knows its
templates (`metagraph.common.wording`) and is translated where it is shown.
"""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from metagraph.common.wording import Told, reworded
from metagraph.errors import error_words

ENGLISH = "en"
NAMES = {"en": "English", "de": "Deutsch"}  # languages by what they call themselves

REMEMBERED = 2048  # texts
# Between thousands where English has a comma, which elsewhere stands before parts of one: a narrow space, as
# ISO 80000-1 has it.
THOUSANDS = "\u202f"

_words: Mapping[str, str] = {}
_english: OrderedDict[str, str] = OrderedDict()  # what was lately shown, and what that is in English
_language = ENGLISH


def tr(text: str, **values: object) -> str:
    """Return a text in the language that was chosen. values: of what it has in braces, as `str.format` has
    it; without any, braces are braces.
    """
    found = _words.get(text, text)
    if not _words:
        return found.format(**values) if values else found
    shown = found.format(**{k: _said(v) for k, v in values.items()}) if values else found
    _remember(shown, text.format(**{k: _in_english(v) for k, v in values.items()}) if values else text)
    return shown


def _remember(shown: str, english: str) -> None:
    _english[shown] = english
    _english.move_to_end(shown)
    if len(_english) > REMEMBERED:
        _english.popitem(last=False)


def in_english(text: str) -> str:
    """Return what was lately said, by `tr` or `tr_told`, in English: for logs that are to be read by others.
    A text that was not is returned as it is.
    """
    return str(_english.get(text, text))


class _Grouped(int):
    """A whole number in another language than English."""

    def __format__(self, form: str) -> str:
        return format(int(self), form).replace(",", THOUSANDS)


def grouped(count: int) -> str:
    """Return a whole number as it stands in the language that was chosen: "2,328"."""
    return f"{_said(count):,}"


def _said(value: object) -> object:
    """Return a value as it stands in a text: what the domain says in the same language."""
    if isinstance(value, BaseException):
        return tr_error(value)
    if isinstance(value, str):
        return tr_told(value)
    return _Grouped(value) if _words and type(value) is int else value


def _in_english(value: object) -> object:
    return _english.get(value, value) if isinstance(value, str) else value


def tr_told(words: str) -> str:
    """Return what the domain says in the language that was chosen, where it knows how it was made."""
    if not _words or not isinstance(words, Told):
        return words
    shown = reworded(words, lambda template: _words.get(template, template), _said)
    _remember(shown, str(words))
    return shown


def tr_error(error: object) -> str:
    """Return what an error says, in the language that was chosen."""
    return tr_told(error_words(error)) if isinstance(error, BaseException) else str(error)


def tr_noop(text: str) -> str:
    """Return a text as it is: one that is looked up later, by `tr` of what holds it."""
    return text


def language() -> str:
    """Return the code of the language that was chosen."""
    return _language


def choose(code: str) -> None:
    """Choose a language for all that is asked from now on; English where there is none of that code."""
    global _words, _language
    found = code if code in NAMES else ENGLISH
    _words, _language = words_of(found), found
    _english.clear()


def words_of(code: str) -> dict[str, str]:
    """Return English texts and what stands in their place."""
    if code == ENGLISH:
        return {}
    import msgspec

    file = Path(__file__).parent / "languages" / f"{code}.json"
    return msgspec.json.decode(file.read_bytes(), type=dict[str, str])


def choose_as_told(settings: Any) -> None:
    """Choose what METAGRAPH_LANGUAGE says, else the settings."""
    choose(os.environ.get("METAGRAPH_LANGUAGE") or str(settings.value("language", ENGLISH)))
