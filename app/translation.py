"""Show the texts of the window in the language that the user chose.

The code has English, inside `tr` and similar functions; other languages are gettext catalogues
(`app/languages/de/LC_MESSAGES/metagraph.po`). `python -m app.languages` collects the texts and compiles the
catalogues. A text without a translation is shown in English. The domain's phrases
(`metagraph.common.wording`) are translated where they are shown.
"""

from __future__ import annotations

import gettext
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeVar, cast

from metagraph.common.wording import Phrase, fill_template, translate_phrase
from metagraph.errors import describe_error

T = TypeVar("T")
ENGLISH = "en"
NAMES = {"en": "English", "de": "Deutsch", "pl": "Polski"}  # each language by its own name
# The Polish catalogue only covers the first screens, so it is chosen by hand, never because of the system.
COMPLETE = ("en", "de")
FOLDER = Path(__file__).parent / "languages"

# Separators of thousands and of decimals, by language. A narrow space between thousands follows ISO 80000-1.
SEPARATORS = {"en": (",", "."), "de": ("\u202f", ","), "pl": ("\u202f", ",")}


class _Language:
    """The chosen language: its code, its catalogue, and how it writes numbers."""

    def __init__(self, code: str) -> None:
        self.code = code
        self.catalogue = load_catalogue(code)
        self.separators = dict(zip((44, 46), SEPARATORS[code], strict=True))  # by the code points of , and .


_chosen: _Language | None = None  # None: English


class Shown(str):
    """Text in another language that also has its English text. A project keeps a plain `str` of it."""

    __slots__ = ("english",)
    english: str

    @classmethod
    def of(cls, text: str, english: str) -> Shown:
        made = cls(text)
        made.english = english
        return made


def tr(text: str, /, **values: object) -> str:
    """Return a text in the chosen language. `values` replace the braces in the text, as in `str.format`;
    without any, braces are braces.
    """
    if _chosen is None:
        return fill_template(text, values)
    return _filled(_look_up(text), text, values)


def tr_plural(one: str, many: str, count: int, /, **values: object) -> str:
    """Return a text that depends on a count: `tr_plural("{count:,} clip", "{count:,} clips", 3)` is
    "3 clips".
    """
    english = one if count == 1 else many
    values = {"count": count, **values}
    if _chosen is None:
        return english.format(**values)
    return _filled(_chosen.catalogue.ngettext(one, many, count), english, values)


def tr_context(context: str, text: str, /, **values: object) -> str:
    """Return a text that means different things in different places. `context` tells translators
    which one.
    """
    if _chosen is None:
        return fill_template(text, values)
    return _filled(_chosen.catalogue.pgettext(context, text), text, values)


def tr_noop(text: str) -> str:
    """Return a text unchanged, marked for translators. The code that shows it calls `tr` with it."""
    return text


def tr_phrase(words: str) -> str:
    """Return a phrase of the domain in the chosen language; other text unchanged."""
    if _chosen is None or not isinstance(words, Phrase):
        return words
    return Shown.of(translate_phrase(words, _template, _show), str(words))


def tr_error(error: object) -> str:
    """Return the message of an error in the chosen language."""
    return tr_phrase(describe_error(error)) if isinstance(error, BaseException) else str(error)


def get_english(text: str) -> str:
    """Return in English a text that `tr` or a similar function returned, for logs that others read; other
    text unchanged.
    """
    return text.english if isinstance(text, Shown) else str(text)


def group_thousands(count: int) -> str:
    """Return an integer as the chosen language writes it: "2,328"."""
    return f"{_show(count):,}"


def format_number(value: float, form: str) -> str:
    """Return a number in a format of `format`, as the chosen language writes it: "2.25"."""
    return localize_number(format(value, form))


class _Int(int):
    """An integer that is formatted as the chosen language writes it."""

    def __format__(self, form: str) -> str:
        return localize_number(format(int(self), form))


class _Float(float):
    """A number that is formatted as the chosen language writes it."""

    def __format__(self, form: str) -> str:
        return localize_number(format(float(self), form))


def localize_number(number: str) -> str:
    """Return a number in English form, such as "1,234.5", as the chosen language writes it."""
    return number if _chosen is None else number.translate(_chosen.separators)


def _show(value: object) -> Any:
    """Return a value as it appears in a text."""
    if isinstance(value, BaseException):
        return tr_error(value)
    if isinstance(value, str):
        return tr_phrase(value)
    if isinstance(value, float):
        return _Float(value)
    return _Int(value) if type(value) is int else value


def _filled(template: str, english: str, values: Mapping[str, object]) -> Shown:
    if not values:
        return Shown.of(template, english)
    there = english.format(**{name: _in_english(value) for name, value in values.items()})
    return Shown.of(template.format(**{name: _show(value) for name, value in values.items()}), there)


def _in_english(value: object) -> object:
    return get_english(value) if isinstance(value, str) else value


def _look_up(text: str) -> str:
    assert _chosen is not None
    return _chosen.catalogue.gettext(text) if text else text  # "" would find the header


def _template(words: Phrase) -> str:
    assert _chosen is not None
    if words.plural:
        return _chosen.catalogue.ngettext(words.template, words.plural, words.values["count"])
    return _look_up(words.template)


class _Translated:
    """Behaves like the dict or tuple that `make` returns, which is made again in each language."""

    __slots__ = ("_code", "_made", "_make")

    def __init__(self, make: Callable[[], Any]) -> None:
        self._make, self._made, self._code = make, None, ""

    def _now(self) -> Any:
        if self._code != get_language():
            self._made, self._code = self._make(), get_language()
        return self._made

    def __getitem__(self, key: Any) -> Any:
        return self._now()[key]

    def __iter__(self) -> Iterator[Any]:
        return iter(self._now())

    def __len__(self) -> int:
        return len(self._now())

    def __contains__(self, key: object) -> bool:
        return key in self._now()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._now(), name)


def make_lazy_texts(make: Callable[[], T]) -> T:
    """Return a dict or tuple of texts that a module can hold: what `make` returns, in the language chosen
    when it is used. A single text is held by `tr_noop`, and shown by `tr`.
    """
    return cast(T, _Translated(make))


def get_language() -> str:
    """Return the code of the chosen language."""
    return ENGLISH if _chosen is None else _chosen.code


def choose(code: str) -> None:
    """Show all texts in a language from now on; in English if there is no language with this code."""
    global _chosen
    _chosen = _Language(code) if code in NAMES and code != ENGLISH else None


def load_catalogue(code: str) -> gettext.NullTranslations:
    """Return the catalogue of a language; an empty one for English. Raises OSError if it is missing."""
    if code == ENGLISH:
        return gettext.NullTranslations()
    return gettext.translation("metagraph", FOLDER, [code])


def choose_language(settings: Any, system: Iterable[str] = (), usual: str = "") -> None:
    """Choose the language that METAGRAPH_LANGUAGE names, else the one in the settings, else the `usual` one
    of a studio, else the first of the system's that we have. `system` has language tags, such as "de-AT".
    """
    kept = os.environ.get("METAGRAPH_LANGUAGE") or str(settings.value("language", "")) or usual
    wanted = [tag.replace("_", "-").split("-")[0].lower() for tag in system]
    choose(kept or next((code for code in wanted if code in COMPLETE), ENGLISH))
