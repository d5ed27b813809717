"""Find the system's folders for a user's files, without Qt."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Literal

# Of Windows the variable and the usual place below home, of macOS the place, of others as of Windows.
_PLACES = {
    "caches": (("LOCALAPPDATA", "AppData/Local"), "Library/Caches", ("XDG_CACHE_HOME", ".cache")),
    "data": (
        ("APPDATA", "AppData/Roaming"),
        "Library/Application Support",
        ("XDG_DATA_HOME", ".local/share"),
    ),
}


def find_user_folder(kind: Literal["caches", "data"]) -> Path | None:
    """Return the user's folder for caches or for what programs remember; None if nobody's home is known. It
    may not be there yet.
    """
    try:
        home = Path.home()
    except RuntimeError:
        return None
    windows, mac, others = _PLACES[kind]
    if sys.platform == "darwin":
        return home / mac
    variable, usual = windows if sys.platform == "win32" else others
    return Path(os.environ.get(variable) or home / usual)
