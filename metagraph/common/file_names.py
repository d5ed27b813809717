"""Names of files we write, which every system takes: Windows and macOS as well as Linux.

Windows knows no `:` in a name (it writes a hidden stream), no dot or space at its end, and devices called CON
or NUL whatever their ending; it and macOS do not tell `Wave` from `wave`; all end at 255 bytes or letters.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Iterable

from metagraph.common.budgets import NAME_BYTES

_DEVICES = frozenset(
    ["con", "prn", "aux", "nul", "conin$", "conout$", "clock$"]
    + [f"{kind}{n}" for kind in ("com", "lpt") for n in "0123456789¹²³"]
)
_FORBIDDEN = re.compile(
    '[<>:"/\\\\|?*\x00-\x1f\x7f\ud800-\udfff\u200e\u200f\u202a-\u202e\u2066-\u2069\ufeff]+'
)


def make_file_stem(text: str, otherwise: str = "unnamed", most: int = NAME_BYTES) -> str:
    """Return a text as the name of a file without its ending: as it is where every system takes it. One that
    is cut to `most` bytes ends in a hash of the whole. otherwise: what an empty one is called.
    """
    stem = unicodedata.normalize("NFC", _FORBIDDEN.sub("_", text)).strip(" ").rstrip(". ")
    stem = stem or otherwise
    if len(stem.encode()) > most:
        mark = f"~{hashlib.sha256(text.encode('utf-8', 'surrogatepass')).hexdigest()[:8]}"
        stem = stem.encode()[: most - len(mark)].decode("utf-8", "ignore").rstrip(". ") + mark
    first, dot, rest = stem.partition(".")
    return f"{first}_{dot}{rest}" if first.rstrip(" ").casefold() in _DEVICES else stem


def fold_file_name(name: str) -> str:
    """Return what a name is to a system that does not tell capitals or accents' spelling apart."""
    return unicodedata.normalize("NFC", unicodedata.normalize("NFD", name).casefold())


def make_file_stems(texts: Iterable[str], otherwise: str = "unnamed") -> list[str]:
    """Return a name for each text, no two the same on any system: the first keeps its own, others get
    numbers.
    """
    out: list[str] = []
    taken: set[str] = set()
    for text in texts:
        stem = make_file_stem(text, otherwise)
        name, number = stem, 1
        while fold_file_name(name) in taken:
            number += 1
            name = f"{stem}-{number}"
        taken.add(fold_file_name(name))
        out.append(name)
    return out
