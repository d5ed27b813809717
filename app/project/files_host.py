"""Define what the parts of a window's files know of the whole."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from PySide6.QtCore import SignalInstance
from PySide6.QtWidgets import QWidget

from app.project.document import Document
from app.project.jobs import Jobs
from app.project.saver import Saver
from metagraph.formats.recovery import Left


class FilesHost(Protocol):
    """See `app.project.files.Files`."""

    document: Document
    jobs: Jobs
    window: QWidget
    saver: Saver
    told: SignalInstance
    report: SignalInstance
    opened: SignalInstance
    noticed: SignalInstance

    def go_on(self, chosen: Left, path: Path) -> None: ...
    def may_leave(self) -> bool: ...
    def recent(self) -> list[Path]: ...
    def save_as(self) -> bool: ...
    def show_failure(self, error: Exception) -> None: ...
    def tell_lost(self, left: Left) -> None: ...
