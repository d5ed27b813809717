"""The export dialog: where to, with what, what will be written; progress, and the folder opened."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSettings, Qt, QUrl
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.document import Document
from app.jobs import Job, Jobs
from metagraph.engines.export import Exported, export
from metagraph.graph.check import check
from metagraph.graph.expand import size


class ExportDialog(QDialog):
    def __init__(self, document: Document, jobs: Jobs, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)  # a running export goes on; the status bar shows it
        self.setWindowTitle("Export for engines")
        self.setMinimumWidth(560)
        layout = QVBoxLayout(self)
        project = document.project
        form = QFormLayout()
        row = QHBoxLayout()
        self.folder = QLineEdit(self._start(), self)
        self.folder.setAccessibleName("Folder")
        browse = QPushButton("Choose…", self)
        browse.clicked.connect(self._browse)
        row.addWidget(self.folder, 1)
        row.addWidget(browse)
        form.addRow("Folder", row)
        self.mesh = QCheckBox("the character's mesh in the GLB", self)
        self.mesh.setChecked(project.character is not None)
        self.mesh.setEnabled(project.character is not None)
        self.expanded = QCheckBox("the expanded state machine in the JSON", self)
        form.addRow("Include", self.mesh)
        form.addRow("", self.expanded)
        layout.addLayout(form)
        whole = size(project)
        self.words = QLabel(self, wordWrap=True)
        self.words.setText(
            f"Writes one JSON (the graph: {whole.states} actions, its schema is metagraph/engines/metagraph.schema.json) and one GLB "
            f"({whole.clips} clips on {len(project.skeleton) if project.skeleton else 0} joints)."
        )
        self.words.setProperty("dim", True)
        layout.addWidget(self.words)
        self.trouble = QLabel(self, wordWrap=True)
        layout.addWidget(self.trouble)
        self.progress = QProgressBar(self)
        self.progress.hide()
        layout.addWidget(self.progress)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.open_button = self.buttons.addButton("Open folder", QDialogButtonBox.ButtonRole.ActionRole)
        self.open_button.setEnabled(False)
        self.open_button.clicked.connect(lambda: QDesktopServices.openUrl(QUrl.fromLocalFile(self.folder.text())))
        self.go = self.buttons.addButton("Export", QDialogButtonBox.ButtonRole.AcceptRole)
        self.go.setProperty("strong", True)
        self.go.setDefault(True)
        self.buttons.accepted.connect(self._export)
        self.buttons.rejected.connect(self.reject)
        layout.addWidget(self.buttons)
        errors = [p for p in check(project) if p.severity == "error"]
        if errors:
            self.go.setEnabled(False)
            self.trouble.setText(f"First: {errors[0].message}. {errors[0].remedy}")

    def _key(self) -> str:
        return f"export/{self.document.path}" if self.document.path else "export/unsaved"

    def _start(self) -> str:
        last = QSettings().value(self._key())
        folder = self.document.folder or Path.home()
        return str(last) if last else str(folder / f"{self.document.project.name}-export")

    def _browse(self) -> None:
        name = QFileDialog.getExistingDirectory(self, "Export into", self.folder.text())
        if name:
            self.folder.setText(name)

    def _export(self) -> None:
        project, folder = self.document.project, Path(self.folder.text())
        base = self.document.folder or Path()
        character = base / project.character if project.character else None
        mesh, expanded = self.mesh.isChecked(), self.expanded.isChecked()
        QSettings().setValue(self._key(), str(folder))
        self.go.setEnabled(False)
        self.progress.setRange(0, 0)
        self.progress.show()

        def work(job: Job) -> Exported:
            return export(project, folder, expanded, mesh, character, job.tell)

        job = self.jobs.start("Exporting", work, self._done, self._failed)
        job.progress.connect(self._tell)

    def _tell(self, done: int, total: int, words: str) -> None:
        self.progress.setRange(0, total)
        self.progress.setValue(done)

    def _done(self, made: Exported) -> None:
        self.progress.hide()
        self.go.setEnabled(True)
        self.open_button.setEnabled(True)
        kb = [f"{p.name} ({p.stat().st_size / 1e6:.1f} MB)" for p in (made.json, made.glb)]
        self.words.setText(f"Written: {', '.join(kb)} with {made.clips} clips.")
        self.trouble.setText("\n".join(made.warnings[:5]))

    def _failed(self, error: Exception) -> None:
        self.progress.hide()
        self.go.setEnabled(True)
        self.trouble.setText(str(error))
