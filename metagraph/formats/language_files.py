"""Read the user's own language packs from files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import msgspec

from metagraph.common.files import guard_reader
from metagraph.errors import FileError
from metagraph.formats.project.text import TextError, parse_yaml
from metagraph.formats.transcripts.words import read_text_file
from metagraph.graph.requests import explain_invalid_ask
from metagraph.speech.language_packs import (
    LanguagePack,
    PackError,
    PackFile,
    list_language_packs,
    make_language,
)

REMEDY = (
    "A pack is YAML or JSON with code, name, and lists of words: responses, hesitations, lexical, small. "
    "See docs/animators/talk-languages.md."
)


@guard_reader
def read_pack(path: str | Path) -> LanguagePack:
    """Read a pack of words, YAML or JSON. Raises FileError naming the line and the field that is wrong."""
    path = Path(path)
    try:
        data, lines = parse_yaml(read_text_file(path))
    except TextError as error:
        where = f"line {error.line}" if error.line else ""
        raise FileError(path, f"is neither YAML nor JSON: {error}", where, REMEDY) from None
    if not isinstance(data, dict):
        raise FileError(path, "holds no fields", "its beginning", REMEDY)
    try:
        return make_language(msgspec.convert(data, PackFile), list_language_packs())
    except msgspec.ValidationError as error:
        field, _, cause = explain_invalid_ask(error).rpartition(": ")
        raise FileError(path, cause, _place(field, lines), REMEDY) from None
    except PackError as error:
        raise FileError(path, str(error), _place(error.where, lines), REMEDY) from None


def _place(field: str, lines: Mapping[str, int]) -> str:
    if not field:
        return ""
    return f"line {lines[field]}, '{field}'" if field in lines else f"'{field}'"


def gather_packs(paths: Iterable[str | Path]) -> dict[str, LanguagePack]:
    """Return the packs that come with the program and those of files, which take the place of one of the same
    code. Raises FileError.
    """
    out = dict(list_language_packs())
    for path in paths:
        pack = read_pack(path)
        out[pack.code] = pack
    return out
