"""Phrases: English text for people that knows what it was made of, so that the window can show it in another
language.

Each is marked where it is written, by `phrase` or `plural_phrase`; translators find it in the catalogues
(`app/languages`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Self


class Phrase(str):
    """English text with its template and the values in it, which may be phrases, too. plural: the template
    for any `count` but one, or "".
    """

    __slots__ = ("plural", "template", "values")
    template: str
    plural: str
    values: Mapping[str, Any]

    def __new__(cls, template: str, values: Mapping[str, Any], plural: str = "") -> Self:
        chosen = plural if plural and values["count"] != 1 else template
        made = super().__new__(cls, fill_template(chosen, values))
        made.template, made.values, made.plural = template, values, plural
        return made

    def __reduce__(self) -> tuple[type[Self], tuple[str, dict[str, Any], str]]:
        return type(self), (self.template, dict(self.values), self.plural)


def phrase(template: str, /, **values: Any) -> Phrase:
    """Return a phrase. values: for the braces in the template, as in `str.format`; without any, braces are
    braces.

    What a program reads, as JSON or in a log, is the phrase itself, which is English.
    """
    return Phrase(template, values)


def plural_phrase(one: str, many: str, count: int, /, **values: Any) -> Phrase:
    """Return a phrase that depends on a count: `plural_phrase("{count:,} clip", "{count:,} clips", 3)`."""
    return Phrase(one, {"count": count, **values}, many)


def join_phrases(words: Sequence[str], between: str) -> Phrase:
    """Return several phrases with `between` between them; each is translated by itself."""
    values = {f"part{n}": one for n, one in enumerate(words)}
    between = between.replace("{", "{{").replace("}", "}}")
    return Phrase(between.join(f"{{{name}}}" for name in values), values)


def change_quoted(words: str, change: Callable[[str], str], quote: str = "'") -> str:
    """Return a phrase with `change` applied to each value in quotes; other text as it is."""
    if not isinstance(words, Phrase):
        return words
    values = {
        name: value
        if not isinstance(value, str)
        else change_quoted(value, change, quote)
        if isinstance(value, Phrase)
        else change(value)
        if f"{quote}{{{name}}}{quote}" in words.template
        else value
        for name, value in words.values.items()
    }
    return Phrase(words.template, values, words.plural)


def fill_template(template: str, values: Mapping[str, Any]) -> str:
    """Return a template with its values."""
    return template.format(**values) if values else template


def translate_phrase(
    words: str, look_up: Callable[[Phrase], str], show: Callable[[Any], Any] = lambda value: value
) -> str:
    """Return a phrase in another language; other text as it is. look_up: returns the template of a phrase in
    that language. show: returns what stands for a value that is no text, such as a number.
    """
    if not isinstance(words, Phrase):
        return words
    values = {
        name: translate_phrase(value, look_up, show) if isinstance(value, str) else show(value)
        for name, value in words.values.items()
    }
    return fill_template(look_up(words), values)
