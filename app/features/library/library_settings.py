"""What a person keeps of the library between programs: how large, in which columns and groups, and filters
that have a name.
"""

from __future__ import annotations

import json

from PySide6.QtCore import QByteArray, QSettings

from app.features.library.clip_filter import Filter, filter_from_text
from app.features.library.clip_groups import GROUPS, NONE
from app.features.library.clip_sizes import USUAL, Style, list_sizes

GROUP = "library"
COLUMNS_NOW = 1  # to be raised when there are other columns


class LibrarySettings:
    """Reads and writes the settings; what is broken is as at first."""

    def style(self) -> Style:
        return "columns" if self._value("style") == "columns" else "cards"

    def side(self, style: Style) -> int:
        """Return how many pixels a picture's side has."""
        value = str(self._value(f"side {style}"))
        return int(value) if value.isdecimal() and int(value) in list_sizes(style) else USUAL[style]

    def keep_size(self, style: Style, side: int) -> None:
        self._keep("style", style)
        self._keep(f"side {style}", side)

    def group(self) -> str:
        found = str(self._value("group"))
        return found if found in GROUPS else NONE

    def keep_group(self, group: str) -> None:
        self._keep("group", group)

    def columns(self) -> QByteArray | None:
        found = self._value(f"columns {COLUMNS_NOW}")
        return found if isinstance(found, QByteArray) else None

    def keep_columns(self, state: QByteArray) -> None:
        self._keep(f"columns {COLUMNS_NOW}", state)

    def filters(self) -> dict[str, Filter]:
        """Return the filters that have a name, by it."""
        try:
            data = json.loads(str(self._value("filters")))
        except ValueError:
            return {}
        found = data.items() if isinstance(data, dict) else ()
        return {name: rule for name, text in found if (rule := filter_from_text(str(text))) is not None}

    def keep_filters(self, filters: dict[str, Filter]) -> None:
        self._keep("filters", json.dumps({name: rule.as_text() for name, rule in filters.items()}))

    def _value(self, key: str) -> object:
        return QSettings().value(f"{GROUP}/{key}")

    def _keep(self, key: str, value: object) -> None:
        QSettings().setValue(f"{GROUP}/{key}", value)
