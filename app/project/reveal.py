"""Show files and folders in the system's file manager; nothing in a project is opened as a program."""

from __future__ import annotations

import sys
import threading
from pathlib import Path

from PySide6.QtCore import QUrl
from PySide6.QtGui import QDesktopServices

from metagraph.common.programs import find_system_program, run_program


def reveal_command(path: Path, platform: str = sys.platform) -> tuple[str, list[str]] | None:
    """Return the name of the system's program, with its arguments, that shows a file in its folder; None if
    there is no reliable one.
    """
    if platform == "win32":
        return "explorer", ["/select,", str(path).replace("/", "\\")]
    if platform == "darwin":
        return "open", ["-R", str(path)]
    return None


def reveal(path: Path) -> None:
    """Show a file; if it is gone, the nearest folder that exists."""
    if path.exists() and _shown(path):
        return
    open_folder(next((p for p in path.parents if p.is_dir()), Path.home()))


def open_folder(folder: Path) -> bool:
    """Show the content of a folder, and return whether a program did. Only folders are opened; on macOS, a
    folder that is a program is shown, not started.
    """
    if not folder.is_dir():
        return False
    if sys.platform == "darwin" and folder.suffix and _shown(folder):
        return True
    return QDesktopServices.openUrl(QUrl.fromLocalFile(str(folder)))


def _shown(path: Path) -> bool:
    words = reveal_command(path)
    program = find_system_program(words[0]) if words is not None else None
    if words is None or program is None:
        return False
    threading.Thread(target=run_program, args=([program, *words[1]],), daemon=True).start()
    return True
