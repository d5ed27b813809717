"""The desktop window and the command line."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType


class _BeforeQt:
    """Has `app.guard` stand before the first class of ours is made of one of Qt's. Costs nothing if Qt is
    never imported.
    """

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name == "PySide6.QtCore":
            sys.meta_path.remove(self)
            _guard()
        return None


def _guard() -> None:
    from app.guard import guard_all

    guard_all()


if "PySide6.QtCore" in sys.modules:
    _guard()
else:
    sys.meta_path.insert(0, _BeforeQt())
