"""Run long jobs off the GUI thread, with progress and cancelling, and deliver results on the GUI thread."""

from __future__ import annotations

import contextlib
import traceback
from collections.abc import Callable
from types import FunctionType, MethodType
from typing import Any

from PySide6.QtCore import QObject, QRunnable, Qt, QThreadPool, QTimer, Signal
from shiboken6 import isValid

from app import faults

WORDS = (OSError, MemoryError, ValueError, RuntimeError)  # their message is shown, besides our own errors


class JobCancelledError(Exception):
    """The work of a job ends here, because the job was cancelled."""


class WindowJob(QObject):
    """A running job. `done` carries its result, `failed` the exception, `progress` (done, total, words).

    Exactly one of `done` and `failed` is emitted, then `ended`; after `cancel`, neither `done` nor `failed`
    is. Then it is freed, with its connections and everything its work holds; only `title` and `cancelled` may
    be used after that.
    """

    progress = Signal(int, int, str)
    done = Signal(object)
    failed = Signal(object)
    ended = Signal()
    _over = Signal(object, object)  # result and error, from the thread

    def __init__(self, title: str, work: Callable[[WindowJob], Any]) -> None:
        super().__init__()
        self.title = title
        self._work = work
        self.cancelled = False
        self.heard = False  # somebody handles its failure
        self.handing_over = False  # its thread is still within `_over`, and Qt reads the job there
        self._over.connect(self._deliver, Qt.ConnectionType.QueuedConnection)

    def cancel(self) -> None:
        self.cancelled = True

    def _deliver(self, result: Any, error: Exception | None) -> None:
        """Deliver the result on the window's thread, unless the job was cancelled in the meantime."""
        if not self.cancelled:
            if error is None:
                self.done.emit(result)
            else:
                self._failed(error)
        self.ended.emit()
        self.forget()

    def _failed(self, error: Exception) -> None:
        """Emit the failure, and report it if it is unexpected or nobody handles it."""
        if not self.heard or not (faults.is_foreseen(error) or isinstance(error, WORDS)):
            faults.report_error(error, f"job: {self.title.split()[0] if self.title else ''}")
        self.failed.emit(error)

    def forget(self) -> None:
        """Free it, and what its work and its connections hold; not before its thread has left Qt's code for
        delivering it, which reads the job.
        """
        self._work = _nothing
        if self.handing_over:
            QTimer.singleShot(1, self.forget)
        else:
            self.deleteLater()  # connected functions and the job hold each other; only Qt can separate them

    def tell(self, done: int, total: int, words: str = "") -> None:
        """Report progress; called by the work, on its own thread."""
        self.progress.emit(done, total, words)

    def go_on(self, done: int, total: int, words: str = "") -> None:
        """Report progress as `tell` does, from where the work can end without leaving anything half done.
        Raises JobCancelledError if it was cancelled.
        """
        if self.cancelled:
            raise JobCancelledError
        self.tell(done, total, words)


def _nothing(job: WindowJob) -> None:
    """Replace the work of a job that is over."""


class _Runner(QRunnable):
    def __init__(self, job: WindowJob) -> None:
        super().__init__()
        self.job = job
        self.setAutoDelete(True)

    def run(self) -> None:
        result, problem = None, None
        try:
            result = self.job._work(self.job)
        except Exception as error:
            error.__notes__ = [*getattr(error, "__notes__", []), traceback.format_exc()]
            problem = error
        self.job.handing_over = True
        with contextlib.suppress(RuntimeError):  # the window is gone; nobody needs the result
            self.job._over.emit(result, problem)
        self.job.handing_over = False
        del self.job  # the pool drops a runner later than the job is delivered


def is_alive(callback: Callable[..., Any], depth: int = 3) -> bool:
    """Return whether no Qt object that a function is a method of, or was made with, has been deleted."""
    held = [getattr(callback, "__self__", None)]
    for cell in getattr(callback, "__closure__", None) or ():
        with contextlib.suppress(ValueError):  # a name without a value yet
            held.append(cell.cell_contents)
    for one in held:
        if isinstance(one, QObject):
            if not isValid(one):
                return False
        elif depth and isinstance(one, FunctionType | MethodType) and not is_alive(one, depth - 1):
            return False
    return True


_BUSY: list[QThreadPool] = []  # pools that outlive their window because a job would not end


class Jobs(QObject):
    """Starts jobs and keeps them alive while they run. `changed` is emitted when one starts or ends.

    A job continues when the dialog that started it is closed, unless that cancels it. `outlived` then reports
    its end instead of the dialog: (title, the exception or None, whether its result still holds).
    """

    changed = Signal()
    outlived = Signal(str, object, bool)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.running: list[WindowJob] = []
        self._alive: set[WindowJob] = set()  # quick jobs, kept from being collected while they run
        self._pool = QThreadPool(self)
        self._pool.setMaxThreadCount(2)  # long jobs must not starve the short ones that the preview needs
        self._quick = QThreadPool(self)
        self._quick.setMaxThreadCount(2)  # a large plan must not delay a figure
        self._stopped = False

    @property
    def at_work(self) -> list[WindowJob]:
        """Return all jobs that have not ended, including quick ones."""
        return [*self.running, *self._alive]

    def start(
        self,
        title: str,
        work: Callable[[WindowJob], Any],
        done: Callable[[Any], None] | None = None,
        failed: Callable[[Exception], None] | None = None,
        quick: bool = False,
        stands: bool = False,
    ) -> WindowJob:
        """Run `work(job)` on a thread. `quick` is for a short background job, which is not shown to the user.
        With `stands`, its result exists without anyone to deliver it to, such as a file.
        """
        job = WindowJob(title, work)
        if done is not None:
            job.done.connect(self._to_who_is_left(done, "" if quick else title, stands))
        if failed is not None:
            job.failed.connect(self._to_who_is_left(failed, "" if quick else title, stands))
            job.heard = True
        if not quick:
            self.running.append(job)
            job.ended.connect(lambda: self._ended(job))
            self.changed.emit()
        else:
            self._alive.add(job)
            job.ended.connect(lambda: self._alive.discard(job))
        if self._stopped:
            job.forget()
        else:
            (self._quick if quick else self._pool).start(_Runner(job))
        return job

    def _to_who_is_left(
        self, callback: Callable[[Any], None], title: str, stands: bool
    ) -> Callable[[Any], None]:
        """Return a function that calls `callback` if its objects still exist, and otherwise reports how the
        job ended.
        """

        def deliver(value: Any) -> None:
            if is_alive(callback):
                callback(value)
            elif title:
                self.outlived.emit(title, value if isinstance(value, Exception) else None, stands)

        return deliver

    def _ended(self, job: WindowJob) -> None:
        if job in self.running:
            self.running.remove(job)
            if not self._stopped:  # otherwise nobody is left to notify
                self.changed.emit()

    def stop(self) -> None:
        """Cancel everything, wait for it, and accept nothing more, on closing.

        A pool is destroyed with its owner and then waits for its threads while it holds the interpreter,
        which they need to end: a deadlock. So none may start after this, and a pool that is still busy is not
        destroyed.
        """
        self._stopped = True
        left = self.at_work
        for job in left:
            job.cancel()
        for pool in (self._pool, self._quick):
            pool.clear()
            if not pool.waitForDone(5000):
                pool.setParent(None)
                _BUSY.append(pool)
                left = []  # one of them is still working, and ends on its own
        for job in left:  # those that waited for their turn will never end
            job.forget()
