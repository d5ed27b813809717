"""The texts of a language as a dict, for tests that look them up."""

from __future__ import annotations

from functools import cache

from app.languages.catalogues import read_catalogue
from app.translation import FOLDER


@cache
def catalogue_texts(code: str) -> dict[str, str]:
    """Return by each English text, and by both of a plural, what stands for it in a language, "" if nothing
    does.
    """
    out: dict[str, str] = {}
    for message in read_catalogue(FOLDER / code / "LC_MESSAGES" / "metagraph.po"):
        if isinstance(message.id, tuple):
            out |= zip(message.id, (message.string[0], message.string[-1]), strict=True)
        elif message.id:
            out[message.id] = message.string
    return out
