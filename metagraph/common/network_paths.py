"""Names of files that lead to another computer or a device: what a stranger's file may say, and nothing opens
unasked.

On Windows opening `\\\\server\\share` already tells that server who the user is. Such names mean the same on
every system here, so that a project behaves alike wherever it is opened. While they are not allowed, a
project holds them as paths below a folder that does not exist (`closed`), which nothing can mistake for the
real ones, and writes them as they were (`original`).
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path
from urllib.parse import quote, unquote

from metagraph.common.wording import phrase

FOLDER = ".not-opened"  # never there
ANOTHER, DEVICE, ADDRESS = (
    phrase("it is on another computer"),
    phrase("it is the name of a device"),
    phrase("it is an address, not a file"),
)
_DEVICES = re.compile(
    r"(?:con|prn|aux|nul|com[0-9¹²³]|lpt[0-9¹²³]|conin\$|conout\$) *(?:[.:].*)?", re.I | re.S
)
_MOUNTED = re.compile(
    r"/(?:net|misc|afs|Network)/+[^/]*", re.I
)  # where systems reach other computers by themselves
_LINKS = 40  # more than that in one path no system follows
_ADDRESS = re.compile(r"[a-z][a-z0-9+.-]+:[\\/]", re.I)

_allowed = [False]


def explain_refusal(name: str, folder: Path | None = None) -> str | None:
    """Return why a file's name is not opened without asking, in words; None for an ordinary file.

    folder: where a relative name starts; then it is also known where `..` and links lead.
    """
    text = name.strip()
    if _ADDRESS.match(text):
        return ADDRESS
    plain = text.replace("\\", "/")
    if re.match(r"//[.?]/+UNC/", plain, re.I):
        return ANOTHER
    if re.match(r"//[.?]/", plain) or plain.startswith("/??/"):
        return DEVICE
    if plain.startswith("//") or _MOUNTED.match(plain) or "\\\\" in text:
        return ANOTHER
    if any(_DEVICES.fullmatch(part) for part in plain.split("/")):
        return DEVICE
    return ANOTHER if folder is not None and make_escape_check(folder)(text) else None


def make_escape_check(folder: Path) -> Callable[[str], bool]:
    """Return what tells whether a name that starts in a folder leads, by `..` and links, to where systems
    reach other computers by themselves. Nothing there is looked at.

    Where the folder itself is on another computer, the user went there: what is on the same one is ordinary.
    """
    if os.name == "nt":
        return lambda name: False  # it has no such places
    start = os.path.realpath(folder)
    own = _mount(start)
    known: dict[str, str] = {}  # places that were looked at, and where they are; "" for away

    def follow(place: str, parts: list[str], links: int = 0) -> str:
        for part in parts:
            if part in ("", ".") or not place:
                continue
            if part == "..":
                place = place.rpartition("/")[0] or "/"
                continue
            inside = f"{place.rstrip('/')}/{part}"
            if (there := known.get(inside)) is None:
                there = known[inside] = look(place, inside, links)
            place = there
        return place

    def look(place: str, inside: str, links: int) -> str:
        mount = _mount(inside)
        if mount is not None and mount != own:
            return ""
        try:
            target = os.readlink(inside)  # noqa: PTH115 - ten thousand times
        except (OSError, ValueError):  # no link, or not there
            return inside
        if links == _LINKS:
            return inside  # as it is: no system follows it
        return follow("/" if target.startswith("/") else place, target.split("/"), links + 1)

    def away(name: str) -> bool:
        plain = name.replace("\\", "/")
        return not follow("/" if plain.startswith("/") else start, plain.split("/"))

    return away


def _mount(place: str) -> str | None:
    found = _MOUNTED.match(place)
    return found[0] if found is not None else None


def allow(yes: bool) -> None:
    """Let projects that are read from now on name such files, or not."""
    _allowed[0] = yes


def is_allowed() -> bool:
    return _allowed[0]


def find_refusal(name: str, folder: Path | None = None) -> str | None:
    """Return why a name that a file in a folder gives is not opened now; None if it may be."""
    return None if _allowed[0] else explain_refusal(name, folder)


def close_path(name: str) -> str:
    """Return a path that a file gives, or one that leads nowhere in its place if that is not allowed."""
    return make_path_to_nowhere(name) if find_refusal(name) is not None else name


def make_path_to_nowhere(name: str) -> str:
    """Return the path that leads nowhere in a name's place."""
    return f"{FOLDER}/_{quote(name, safe='')}"


def recover_original_path(name: str) -> str:
    """Return what a closed path was; any other as it is."""
    if not name.startswith(f"{FOLDER}/_"):
        return name
    was = unquote(name.removeprefix(f"{FOLDER}/_"))
    return was if make_path_to_nowhere(was) == name else name


def is_closed(name: str) -> bool:
    return recover_original_path(name) != name
