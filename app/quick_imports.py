"""Imports without what others do beside them.

Shiboken compiles the patterns that split the signatures of Qt's methods, and those of a generator of stubs,
when it is imported: 35 ms, for what is asked for when an argument is of a wrong type.

PySide puts an import of its own in the place of Python's, so that a module may ask for other spellings of
names (`from __feature__ import snake_case`): it looks at who imports what each time, and searches each
module's source. Nobody here asks; it takes a tenth of the time of all other imports, and keeps every source
in memory.

NumPy writes a text of help into each of its functions: 8 ms, and nobody reads them here. Python itself leaves
them out under -OO, so whoever imports NumPy can do without.

msgspec takes two names from typing_extensions where it is installed, which Python has had since 3.11: 25 ms.
"""

from __future__ import annotations

import builtins
import linecache
import re
import sys
from types import ModuleType
from typing import Any

_HELP = ("numpy._core._add_newdocs", "numpy._core._add_newdocs_scalars")


class _Method:
    """A method of a pattern that is compiled when it is called."""

    def __init__(self, pattern: _Later, name: str) -> None:
        self.pattern, self.name = pattern, name

    def __call__(self, *given: Any, **more: Any) -> Any:
        return getattr(self.pattern.compiled(), self.name)(*given, **more)


class _Later:
    """A pattern that is compiled when the first of its methods is called."""

    def __init__(self, *given: Any, **more: Any) -> None:
        self._given, self._more = given, more

    def compiled(self) -> re.Pattern[Any]:
        return _compile(*self._given, **self._more)  # Python keeps those it compiled

    def __getattr__(self, name: str) -> _Method:
        return _Method(self, name)


_compile = re.compile


def _compile_later(*given: Any, **more: Any) -> Any:
    mine = str(sys._getframe(1).f_globals.get("__name__")).startswith("shibokensupport.")
    return (_Later if mine else _compile)(*given, **more)


def shiboken_compiles_later(on: bool) -> None:
    """While it is on, which is while Shiboken is imported, patterns of Shiboken's are compiled when they are
    used; all others as always.
    """
    re.compile = _compile_later if on else _compile


def without_search() -> None:
    """Give Python its own import back. Nothing happens where PySide is made otherwise."""
    own = getattr(builtins, "__orig_import__", None)
    if own is not None:
        builtins.__import__ = own
        linecache.clearcache()  # the sources that were read until now, a megabyte


def without_array_help() -> None:
    """Let NumPy be imported without its texts of help; nothing happens where it was imported."""
    if "numpy" not in sys.modules:
        sys.modules.update({name: ModuleType(name) for name in _HELP})


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
