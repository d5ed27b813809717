"""Imports without what others do beside them.

After each import PySide looks through the module's source for its own name, to know whether a module may want
its optional spellings of names (`from __feature__ import snake_case`). Nobody here does; the search takes a
tenth of the start and keeps every source in memory.

msgspec takes two names from typing_extensions where it is installed, which Python has had since 3.11: 25 ms.
"""

from __future__ import annotations

import linecache
import sys


def without_search() -> None:
    """Let PySide take it that no module imported from now on wants other spellings. Nothing happens where
    PySide is made otherwise.
    """
    try:
        from shibokensupport import feature  # type: ignore[import-not-found, unused-ignore]
    except ImportError:
        return
    if hasattr(feature, "_mod_uses_pyside"):
        feature._mod_uses_pyside = lambda module: False
        linecache.clearcache()  # the sources that were read until now, a megabyte


def without_typing_extensions() -> None:
    """Import msgspec as if typing_extensions was not installed; it still is for everybody else."""
    name = "typing_extensions"
    if name in sys.modules or "msgspec" in sys.modules:
        return
    sys.modules[name] = None  # type: ignore[assignment]  # how Python notes what cannot be imported
    try:
        import msgspec  # noqa: F401
    finally:
        del sys.modules[name]
