"""Runs whenever the Python of a bundle starts: it finds the bundle's own libraries and the user's extras."""

import ctypes.util
import sys
from pathlib import Path

from metagraph.common.extras import add_extras

_find = ctypes.util.find_library


def find_beside(name):
    """Return a library of the bundle, or of the system."""
    beside = Path(sys.prefix) / "lib" / "libportaudio.so.2"
    return str(beside) if name == "portaudio" and beside.exists() else _find(name)


ctypes.util.find_library = find_beside
add_extras()
