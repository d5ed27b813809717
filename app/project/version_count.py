"""Set how many earlier versions of a project a save keeps: one setting for the window and the
command line.
"""

from __future__ import annotations

import os

from PySide6.QtCore import QSettings

from metagraph.formats.project.versions import KEPT, MOST

KEY = "versions"


def count_kept_versions() -> int:
    """Return how many versions are kept, 0 for none; METAGRAPH_VERSIONS overrides the window's setting."""
    told = os.environ.get("METAGRAPH_VERSIONS")
    try:
        return max(0, min(MOST, int(str(_settings().value(KEY, KEPT) if told is None else told))))
    except ValueError:
        return KEPT


def set_version_count(count: int) -> None:
    _settings().setValue(KEY, max(0, min(MOST, count)))


def _settings() -> QSettings:
    """Return the window's settings, also for the command line, whose application has no such name."""
    return QSettings(QSettings.defaultFormat(), QSettings.Scope.UserScope, "Metagraph", "Metagraph")
