"""Shows a file in the system's file manager: selected in its folder where that can be asked for, else the
folder.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QProcess, QUrl
from PySide6.QtGui import QDesktopServices

Start = Callable[[str, list[str]], object]


def how(path: Path, platform: str = sys.platform) -> tuple[str, list[str]] | None:
    """Return the program, with its arguments, that shows a file in its folder; None where there is none that
    can be relied on.
    """
    if platform == "win32":
        return "explorer", ["/select,", str(path).replace("/", "\\")]
    if platform == "darwin":
        return "open", ["-R", str(path)]
    return None


def reveal(path: Path) -> None:
    """Show a file; where it is gone, the nearest folder that is there."""
    if path.exists():
        words = how(path)
        if words is not None:
            QProcess.startDetached(*words)
            return
    folder = next((p for p in path.parents if p.is_dir()), Path.home())
    QDesktopServices.openUrl(QUrl.fromLocalFile(str(folder)))
