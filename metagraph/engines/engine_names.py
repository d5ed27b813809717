"""What engines call a project's actions and stances: by their names, in letters of any script, and by numbers
that stay theirs.

An id takes the place of a name without letters or digits, and stands behind a name that an earlier one has
already. So removing or adding one never changes what another, with a name of its own, is called.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping

from metagraph.common.file_names import fold_file_name, make_file_stem
from metagraph.graph.ids import derive_id

MOST = 1 << 24  # Unity compares numbers as single precision, which is exact below


def write_word(text: str) -> str:
    """Return a text's letters, with their marks, and digits, of any script; "_" is for all between them. What
    it returns is an identifier in XML, XState, Godot, Unity and glTF behind any letter.
    """
    out = ""
    for character in unicodedata.normalize("NFKC", text):
        kind = unicodedata.category(character)
        kept = kind[0] == "L" or kind == "Nd" or (kind[0] == "M" and not out.endswith("_") and out)
        out += character if kept else "_"
    return re.sub("_+", "_", out).strip("_")


def name_apart(texts: Mapping[str, str], key: Callable[[str], str] = str) -> dict[str, str]:
    """Return a name for each id: its text, with the id behind it where an earlier one has that name. Names
    are apart if their `key` is.
    """
    out: dict[str, str] = {}
    taken: set[str] = set()
    for ident, text in texts.items():
        name = text
        while key(name) in taken:
            name += f"_{write_word(ident)}"
        taken.add(key(name))
        out[ident] = name
    return out


def name_files(idents: Mapping[str, str]) -> dict[str, str]:
    """Return for each name the stem of a file, apart on every system. idents: the id behind each name."""
    names = {ident: name for name, ident in idents.items()}
    stems = name_apart({ident: make_file_stem(name) for ident, name in names.items()}, fold_file_name)
    return {name: stems[ident] for name, ident in idents.items()}


def assign_numbers(idents: Iterable[str]) -> dict[str, int]:
    """Return for each id a number from 1 on that derives from it, all different."""
    out: dict[str, int] = {}
    taken = {0}
    for ident in idents:
        digits = re.fullmatch(r"[a-z]+(\d{1,7})", ident, re.ASCII)
        number, again = int(digits[1]) if digits else 0, 0
        while number in taken:
            number, again = int(derive_id("n", ident, again)[1:]) % MOST, again + 1
        taken.add(number)
        out[ident] = number
    return out
