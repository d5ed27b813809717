"""What the domain says to people: English words that know what they were made of, so that who shows them can
say the same in another language.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Self


class Told(str):
    """English words, and the template and values they were made of. Values may be told, too."""

    __slots__ = ("template", "values")
    template: str
    values: Mapping[str, Any]

    def __new__(cls, template: str, values: Mapping[str, Any]) -> Self:
        made = super().__new__(cls, filled(template, values))
        made.template, made.values = template, values
        return made

    def __reduce__(self) -> tuple[type[Self], tuple[str, dict[str, Any]]]:
        return type(self), (self.template, dict(self.values))


def told(template: str, /, **values: Any) -> Told:
    """Return words made of a template, in whose braces the values stand, as `str.format` has it; without
    any, braces are braces.

    What a program writes, as JSON or into a log, is `str` of it.
    """
    return Told(template, values)


def joined(words: Sequence[str], between: str) -> Told:
    """Return several words with something between them; each is said in another language by itself."""
    values = {f"part{n}": one for n, one in enumerate(words)}
    between = between.replace("{", "{{").replace("}", "}}")
    return Told(between.join(f"{{{name}}}" for name in values), values)


def requoted(words: str, change: Callable[[str], str], quote: str = "'") -> str:
    """Return words in which what stands in quotes is changed, in whatever language they are said."""
    if not isinstance(words, Told):
        return words
    values = {
        name: value
        if not isinstance(value, str)
        else requoted(value, change, quote)
        if isinstance(value, Told)
        else change(value)
        if f"{quote}{{{name}}}{quote}" in words.template
        else value
        for name, value in words.values.items()
    }
    return Told(words.template, values)


def filled(template: str, values: Mapping[str, Any]) -> str:
    """Return a template with its values."""
    return template.format(**values) if values else template


def reworded(words: str, look_up: Callable[[str], str], said: Callable[[Any], Any] = lambda v: v) -> str:
    """Return words with each template they were made of replaced by what `look_up` finds for it; words that
    do not know their template as they are. said: gives what stands for a value that is no text.
    """
    if not isinstance(words, Told):
        return words
    values = {
        name: reworded(value, look_up, said) if isinstance(value, str) else said(value)
        for name, value in words.values.items()
    }
    return filled(look_up(words.template), values)
