"""Language packs of one's own, from files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import msgspec

from metagraph.common.files import guarded
from metagraph.errors import FileError
from metagraph.formats.project.text import TextError, parse
from metagraph.formats.transcripts.words import text_of
from metagraph.graph.requests import words_of
from metagraph.speech.language_packs import Language, PackError, PackFile, language_of, languages

REMEDY = (
    "A pack is YAML or JSON with code, name, and lists of words: responses, hesitations, lexical, small. "
    "See docs/animators/talk-languages.md."
)


@guarded
def read_pack(path: str | Path) -> Language:
    """Read a pack of words, YAML or JSON. Raises FileError naming the line and the field that is wrong."""
    path = Path(path)
    try:
        data, lines = parse(text_of(path))
    except TextError as error:
        where = f"line {error.line}" if error.line else ""
        raise FileError(path, f"is neither YAML nor JSON: {error}", where, REMEDY) from None
    if not isinstance(data, dict):
        raise FileError(path, "holds no fields", "its beginning", REMEDY)
    try:
        return language_of(msgspec.convert(data, PackFile), languages())
    except msgspec.ValidationError as error:
        field, _, cause = words_of(error).rpartition(": ")
        raise FileError(path, cause, _place(field, lines), REMEDY) from None
    except PackError as error:
        raise FileError(path, str(error), _place(error.where, lines), REMEDY) from None


def _place(field: str, lines: Mapping[str, int]) -> str:
    if not field:
        return ""
    return f"line {lines[field]}, '{field}'" if field in lines else f"'{field}'"


def packs_with(paths: Iterable[str | Path]) -> dict[str, Language]:
    """Return the packs that come with the program and those of files, which take the place of one of the same
    code. Raises FileError.
    """
    out = dict(languages())
    for path in paths:
        pack = read_pack(path)
        out[pack.code] = pack
    return out
