"""Modules that are imported without being read a second time.

After each import PySide looks through the module's source for its own name, to know whether a module may want
its optional spellings of names (`from __feature__ import snake_case`). Nobody here does; the search takes a
tenth of the start and keeps every source in memory.
"""

from __future__ import annotations


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
