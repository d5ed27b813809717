"""Show other windows, regularly, that this one still has its file."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Jobs
from app.translation import tr
from metagraph.formats.locking import REFRESH


class Keeper(QObject):
    """Touches the lock and the journal on a thread, because a network drive may be slow. `told` has words if
    another window took the lock.
    """

    told = Signal(str)

    def __init__(self, document: Document, jobs: Jobs, parent: QObject) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self._busy = False
        self._timer = QTimer(self, interval=int(REFRESH * 1000))
        self._timer.timeout.connect(self.refresh)
        self._timer.start()

    def refresh(self) -> None:
        """Touch them once."""
        if self._busy:
            return
        self._busy = True
        document, lock = self.document, self.document.lock

        def work(_: object) -> bool:
            document.touch_journal()
            return lock is None or lock.refresh()

        def done(ours: bool) -> None:
            self._busy = False
            document.autosave.look_after()
            if lock is not None and lock.made_again and document.path is not None:
                lock.made_again = False
                document.warned.emit(
                    tr(
                        "Another program removed the lock file beside {name}, which shows other windows that "
                        "the project is open. Metagraph has restored it.",
                        name=document.path.name,
                    )
                )
            if not ours and document.lock is lock and document.path is not None:
                document.lose_lock()
                self.told.emit(
                    tr(
                        "Another window has taken over {name}. Here you can still look around, try things, "
                        "and save under another name.",
                        name=document.path.name,
                    )
                )

        self.jobs.start("lock", work, done, lambda _: done(True), quick=True)
