"""Names of files that lead to another computer or a device: what a stranger's file may say, and nothing opens
unasked.

On Windows opening `\\\\server\\share` already tells that server who the user is. Such names mean the same on
every system here, so that a project behaves alike wherever it is opened. While they are not allowed, a
project holds them as paths below a folder that does not exist (`closed`), which nothing can mistake for the
real ones, and writes them as they were (`original`).
"""

from __future__ import annotations

import re
from urllib.parse import quote, unquote

from metagraph.wording import told

FOLDER = ".not-opened"  # never there
ANOTHER, DEVICE, ADDRESS = (
    told("it is on another computer"),
    told("it is the name of a device"),
    told("it is an address, not a file"),
)
_DEVICES = re.compile(
    r"(?:con|prn|aux|nul|com[0-9¹²³]|lpt[0-9¹²³]|conin\$|conout\$) *(?:[.:].*)?", re.I | re.S
)
_MOUNTED = re.compile(
    r"/(?:net|misc|afs|Network)/", re.I
)  # where systems reach other computers by themselves
_ADDRESS = re.compile(r"[a-z][a-z0-9+.-]+:[\\/]", re.I)

_allowed = [False]


def reason(name: str) -> str | None:
    """Return why a file's name is not opened without asking, in words; None for an ordinary file."""
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
    return None


def allow(yes: bool) -> None:
    """Let projects that are read from now on name such files, or not."""
    _allowed[0] = yes


def is_allowed() -> bool:
    return _allowed[0]


def refused(name: str) -> str | None:
    """Return why a name that a file gives is not opened now; None where it may be."""
    return None if _allowed[0] else reason(name)


def closed(name: str) -> str:
    """Return a path that a file gives, or one that leads nowhere in its place where that is not allowed."""
    return f"{FOLDER}/_{quote(name, safe='')}" if refused(name) is not None else name


def original(name: str) -> str:
    """Return what a closed path was; any other as it is."""
    if not name.startswith(f"{FOLDER}/_"):
        return name
    was = unquote(name.removeprefix(f"{FOLDER}/_"))
    return was if reason(was) is not None and f"{FOLDER}/_{quote(was, safe='')}" == name else name


def is_closed(name: str) -> bool:
    return original(name) != name
