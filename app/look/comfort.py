"""What makes the window easier to see and calmer: more contrast, less motion, larger text. It belongs to the
user, not to the project, and is kept in the settings.
"""

from __future__ import annotations

import os
from collections.abc import MutableMapping
from dataclasses import dataclass, replace
from typing import Any

from PySide6.QtCore import QSettings, Qt
from PySide6.QtGui import QGuiApplication

SIZES = (100, 110, 125, 150)  # per cent
KEYS = {"contrast": "comfort/contrast", "still": "comfort/still", "size": "comfort/size"}
FACTOR = "QT_SCALE_FACTOR"


@dataclass(frozen=True)
class Comfort:
    """contrast: high contrast. still: nothing moves by itself. size: of text and all else, per cent, from the
    next start on.
    """

    contrast: bool = False
    still: bool = False
    size: int = 100


class _Kept:
    now = Comfort()  # read at each painting, so not from the settings each time


def get_comfort() -> Comfort:
    """Return what the user has chosen, as last read or set."""
    return _Kept.now


def read_comfort() -> Comfort:
    """Return what the settings have, and take it over. Where the user chose no contrast, the system's choice
    holds.
    """
    settings = QSettings()
    wanted = settings.value(KEYS["contrast"])
    contrast = is_contrast_preferred() if wanted is None else str(wanted) == "true"
    still = str(settings.value(KEYS["still"], "")) == "true"
    _Kept.now = Comfort(contrast, still, _read_size(settings))
    return _Kept.now


def set_comfort(**changes: Any) -> None:
    """Change what is named as in `Comfort`, now and for later runs."""
    _Kept.now = replace(_Kept.now, **changes)
    for name, value in changes.items():
        text = str(value).lower() if isinstance(value, bool) else value
        QSettings().setValue(KEYS[name], text)


def is_contrast_preferred() -> bool:
    """Return whether the system asks for high contrast; Qt knows from 6.10 on."""
    hints = QGuiApplication.styleHints()
    found = getattr(hints, "accessibility", None)
    if found is None:
        return False
    return bool(found().contrastPreference() == Qt.ContrastPreference.HighContrast)


def scale_application(environment: MutableMapping[str, str] = os.environ) -> None:
    """Make all that is drawn as large as was chosen; before the application is made. A factor that the
    environment has already stays.
    """
    size = _read_size(QSettings())
    if size != 100 and FACTOR not in environment:
        environment[FACTOR] = f"{size / 100:g}"


def _read_size(settings: QSettings) -> int:
    found = str(settings.value(KEYS["size"], ""))
    return int(found) if found.isdigit() and int(found) in SIZES else 100
