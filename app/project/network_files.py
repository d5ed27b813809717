"""Open files on other computers that a project names only if the user agrees, once for each project."""

from __future__ import annotations

from PySide6.QtCore import QObject, QSettings, Qt
from PySide6.QtWidgets import QMessageBox

from app.project.files_host import FilesHost
from app.project.jobs import WindowJob
from app.project.opening import load_whole, take_over
from app.translation import tr
from metagraph.common.network_paths import allow
from metagraph.formats.project.paths import describe_closed_paths, list_closed_paths, reopen_paths
from metagraph.graph.model import Project

SHOWN = 5  # names in the question


class NetworkFiles(QObject):
    """Asks about such files of the open project, and opens them."""

    def __init__(self, files: FilesHost) -> None:
        super().__init__(files.window)
        self.files, self.document = files, files.document
        self._era = 0  # counts the projects that were shown
        self.document.loaded.connect(self._next_era)

    def _next_era(self) -> None:
        self._era += 1

    def _key(self) -> str:
        return f"network/{self.document.path}"

    def tells(self, note: str) -> bool:
        """Return whether a note says what will be asked here."""
        names = list_closed_paths(self.document.project)
        return bool(names) and note == describe_closed_paths(names)

    def look(self) -> None:
        """Ask about the newly opened project, unless its user has answered before."""
        if not list_closed_paths(self.document.project):
            return
        answer = QSettings().value(self._key()) if self.document.path is not None else None
        if answer is None:
            self.ask()
        elif answer in (True, "true"):
            self._open()

    def ask(self) -> None:
        """Ask whether to open them, whatever was answered before; the answer is kept for this project."""
        names = list_closed_paths(self.document.project)
        if not names:
            self.files.told.emit(tr("Every file on other computers that this project names is already open."))
            return
        box = QMessageBox(
            QMessageBox.Icon.Warning,
            tr("Files on other computers"),
            tr("{name} names files on other computers.", name=self.document.project.name),
            parent=self.files.window,
        )
        more = tr("\n… and {count} more", count=len(names) - SHOWN) if len(names) > SHOWN else ""
        box.setInformativeText(
            "\n".join(names[:SHOWN])
            + more
            + "\n\n"
            + tr(
                "Those computers learn that you opened the files, and perhaps who you are. Open them "
                "only if you trust the source of this project. Metagraph remembers your answer for this "
                "project."
            )
        )
        box.setTextFormat(Qt.TextFormat.PlainText)
        yes = box.addButton(tr("Open them"), QMessageBox.ButtonRole.AcceptRole)
        no = box.addButton(tr("Keep them closed"), QMessageBox.ButtonRole.RejectRole)
        box.setDefaultButton(no)
        box.exec()
        opens = box.clickedButton() is yes
        box.deleteLater()  # its parent would keep it
        if self.document.path is not None:
            QSettings().setValue(self._key(), opens)
        if opens:
            self._open()

    def _open(self) -> None:
        allow(True)
        document, era = self.document, self._era
        project, folder = reopen_paths(document.project), document.folder

        def work(job: WindowJob) -> Project:
            return load_whole(project, folder, job.tell).project if folder is not None else project

        def done(found: Project) -> None:
            def edit(now: Project) -> Project:
                now = reopen_paths(now)
                return found if now == project else take_over(now, found)

            if era == self._era:
                document.take_motion(tr("Open files on other computers"), edit)

        self.files.jobs.start(tr("Reading files on other computers"), work, done, self.files.show_failure)
