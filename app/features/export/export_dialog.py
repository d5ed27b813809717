"""The export dialog: for which engine, where to, with what; what will be written and lost; progress, and the
folder opened.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

from PySide6.QtCore import QSettings, Qt, QTimer, QUrl
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
    QMessageBox,
    QProgressBar,
    QPushButton,
    QScrollArea,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.chosen import is_chosen
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.project.reveal import open_folder
from app.translation import tr, tr_error, tr_phrase, tr_plural
from app.widgets.making import make_widget
from app.widgets.tree_items import list_items_below, list_top_items
from metagraph.common.studio import find_export_folder
from metagraph.engines.targets import registry
from metagraph.engines.targets.placing import ForeignFilesError
from metagraph.engines.targets.sizes import ExportSize, measure_export
from metagraph.engines.targets.target import Contents, ExportTarget, TargetReport
from metagraph.engines.tools_file import write_tools
from metagraph.engines.vectors import write_vectors
from metagraph.graph.check import check_project
from metagraph.graph.expand import count_machine_size
from metagraph.graph.manual.meta import make_exportable

NAME = Qt.ItemDataRole.UserRole
SOON = 250  # milliseconds after a choice until the size of the export is measured


@dataclass(frozen=True)
class ExportChoice:
    """What was last chosen for a project. folders: by target, where it is not the usual one."""

    target: str = registry.DEFAULT
    folders: dict[str, str] = field(default_factory=dict)
    mesh: bool = True
    expanded: bool = False
    vectors: bool = False
    tools: bool = False
    compress: bool | None = None  # None: as is usual for the target


@dataclass(frozen=True)
class ExportResult:
    """What came of an export: where it stands, and what there is to say of it."""

    folder: str
    words: str
    trouble: str


@cache
def serve_folder(folder: str) -> str:
    """Return the address at which this program shows a folder to the browser, as long as it runs."""
    from metagraph.engines.serve import Served

    return Served(folder).url


class ExportDialog(QDialog):
    """manual: export what the manual state machines amount to, instead of the meta-graph."""

    def __init__(
        self, document: Document, jobs: Jobs, parent: QWidget | None = None, manual: bool = False
    ) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self.project, self.differences = make_exportable(document.project, manual)
        self.setAttribute(
            Qt.WidgetAttribute.WA_DeleteOnClose
        )  # a running export goes on; the status bar shows it
        self.setWindowTitle(tr("Export for engines"))
        self.resize(860, 620)
        self.results: dict[str, ExportResult] = {}  # of what was written, by target
        chosen = self.chosen = self._remembered()
        self.targets = self._list()
        self.title = QLabel(self)
        self.title.setProperty("heading", True)
        self.words, self.sized, self.losses, self.trouble = (QLabel(self, wordWrap=True) for _ in range(4))
        self.words.setProperty("dim", True)
        self.sized.setProperty("dim", True)
        self.sizes: dict[tuple[object, ...], ExportSize | None] = {}  # what was measured, by what was chosen
        self._measuring: WindowJob | None = None
        self._soon = QTimer(self, singleShot=True, interval=SOON)
        self._soon.timeout.connect(self._measure)
        for told in (self.words, self.trouble):  # paths and addresses can be copied
            told.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.losses.setTextFormat(Qt.TextFormat.RichText)
        self.losses.setAlignment(Qt.AlignmentFlag.AlignTop)
        lost = QScrollArea(self, widgetResizable=True)
        lost.setFrameShape(QScrollArea.Shape.NoFrame)
        lost.setWidget(self.losses)
        self.progress = QProgressBar(self)
        self.progress.hide()
        right = QVBoxLayout()
        right.setSpacing(10)
        for part in (self.title, self.words, self.sized):
            right.addWidget(part)
        right.addLayout(self._form(chosen))
        right.addWidget(lost, 1)
        right.addWidget(self.trouble)
        right.addWidget(self.progress)
        columns = QHBoxLayout()
        columns.setSpacing(20)
        columns.addWidget(self.targets)
        columns.addLayout(right, 1)
        layout = QVBoxLayout(self)
        layout.addLayout(columns, 1)
        layout.addWidget(self._buttons())
        self.targets.currentItemChanged.connect(self._describe)
        self.finished.connect(self._stop_measuring)
        self._select(chosen.target)
        errors = [p for p in check_project(self.project) if p.severity == "error"]
        if errors:
            self.go.setEnabled(False)
            self.trouble.setText(
                tr(
                    "Fix this first: {message}. {remedy}",
                    message=tr_phrase(errors[0].message),
                    remedy=tr_phrase(errors[0].remedy),
                )
            )

    # --- parts

    def _list(self) -> QTreeWidget:
        out = make_widget(QTreeWidget, self, headerHidden=True, rootIsDecorated=False)
        out.setAccessibleName(tr("Target"))
        out.setFixedWidth(260)
        groups: dict[str, QTreeWidgetItem] = {}
        for target in registry.list_targets().values():
            if target.group not in groups:
                groups[target.group] = QTreeWidgetItem(out, [tr_phrase(target.group)])
                groups[target.group].setFlags(Qt.ItemFlag.ItemIsEnabled)
                groups[target.group].setForeground(0, self.palette().placeholderText())
            item = QTreeWidgetItem(groups[target.group], [tr_phrase(target.title)])
            item.setData(0, NAME, target.name)
        out.expandAll()
        out.setItemsExpandable(False)
        return out

    def _form(self, chosen: ExportChoice) -> QFormLayout:
        project = self.document.project
        form = QFormLayout()
        row = QHBoxLayout()
        self.folder = QLineEdit(self)
        self.folder.textEdited.connect(self._name_folder)
        self.folder.setAccessibleName(tr("Folder"))
        browse = QPushButton(tr("Choose…"), self)
        browse.clicked.connect(self._browse)
        row.addWidget(self.folder, 1)
        row.addWidget(browse)
        form.addRow(tr("Folder"), row)
        self.mesh = QCheckBox(tr("Character mesh in the GLB"), self)
        self.mesh.setChecked(chosen.mesh and project.character is not None)
        self.mesh.setEnabled(project.character is not None)
        if project.character is None:
            self.mesh.setToolTip(
                tr("This project has no character of its own: choose one in File > Character")
            )
        self.expanded = QCheckBox(tr("Expanded state machine in the JSON"), self)
        self.expanded.setToolTip(
            tr("The ordinary state machine that the graph stands for, with all states and transitions listed")
        )
        self.expanded.setChecked(chosen.expanded)
        self.vectors = QCheckBox(tr("Conformance vectors, which test that a runtime plays the same"), self)
        self.vectors.setChecked(chosen.vectors)
        self.tools = QCheckBox(tr("Possible requests, as tools for a language model"), self)
        self.tools.setChecked(chosen.tools)
        self.compress = QCheckBox(
            tr("Compressed GLB, half the size, for runtimes and viewers that support it"), self
        )
        self.compress.setToolTip(tr("Uses EXT_meshopt_compression, which not every viewer opens"))
        self.compress.clicked.connect(self._choose_packing)
        for box in (self.mesh, self.expanded, self.compress):
            box.toggled.connect(self._measure_soon)
        boxes = (self.mesh, self.expanded, self.vectors, self.tools, self.compress)
        for words, box in zip((tr("Include"), "", "", "", ""), boxes, strict=True):
            form.addRow(words, box)
        return form

    def _buttons(self) -> QDialogButtonBox:
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        self.open_button = buttons.addButton(tr("Open folder"), QDialogButtonBox.ButtonRole.ActionRole)
        self.open_button.setEnabled(False)
        self.open_button.clicked.connect(self._open)
        self.go = buttons.addButton(tr("Export"), QDialogButtonBox.ButtonRole.AcceptRole)
        strengthen(self.go)
        buttons.accepted.connect(self._export)
        buttons.rejected.connect(self.reject)
        return buttons

    # --- what is chosen

    def _key(self) -> str:
        return f"export/{self.document.path}" if self.document.path else "export/unsaved"

    def _remembered(self) -> ExportChoice:
        """Return what was last chosen for this project; what cannot be read is as nothing."""
        try:
            data: Any = json.loads(str(QSettings().value(self._key()) or "{}"))
            known = ExportChoice(**data)
            folders = {str(k): str(v) for k, v in known.folders.items()}
            return replace(
                known,
                folders=folders,
                target=known.target if known.target in registry.list_targets() else registry.DEFAULT,
            )
        except (ValueError, TypeError, AttributeError):
            return ExportChoice()

    def _usual(self, target: str) -> str:
        """Return the folder a target goes to unless another is chosen: one of its own, since exports share
        names of files.
        """
        folder = find_export_folder(self.document.folder)
        return str(folder / f"{self.document.project.name}-export" / target)

    def _name_folder(self, folder: str) -> None:
        self.chosen.folders[self.target.name] = folder

    def _select(self, name: str) -> None:
        found = next(
            i
            for group in list_top_items(self.targets)
            for i in list_items_below(group)
            if i.data(0, NAME) == name
        )
        self.targets.setCurrentItem(found)

    @property
    def target(self) -> ExportTarget:
        """The target that is chosen."""
        item = self.targets.currentItem()
        name = item.data(0, NAME) if item is not None else None
        return registry.get_target(name or registry.DEFAULT)

    def _describe(self) -> None:
        target, project = self.target, self.project
        self.folder.setText(self.chosen.folders.get(target.name) or self._usual(target.name))
        whole = count_machine_size(project)
        played = (target.name == registry.DEFAULT) or target.group == registry.get_target(
            registry.DEFAULT
        ).group
        self.title.setText(tr_phrase(target.title))
        joints = len(project.skeleton) if project.skeleton else 0
        self.words.setText(
            tr(
                "Writes {files}: {states} actions, {clips} clips, {joints} joints.",
                files=tr_phrase(target.files),
                states=whole.states,
                clips=whole.clips,
                joints=joints,
            )
        )
        for box in (self.expanded, self.vectors, self.tools):
            box.setVisible(played)
        self.compress.setVisible(target.unpacks)
        packed = self.chosen.compress
        self.compress.setChecked(target.packs if packed is None else packed)
        self._measure_soon()
        rows = [
            f"<li>{escape(tr_phrase(words))}</li>" for words in registry.describe_losses(project, target.name)
        ]
        note = (
            tr("<p><b>Experimental</b>: {why}.</p>", why=escape(tr_phrase(target.untried)))
            if target.untried
            else ""
        )
        nothing = tr("<p>Nothing else is lost.</p>") if self.differences else tr("<p>Nothing is lost.</p>")
        lost = (
            f"<p><b>{tr('What is lost')}</b></p><ul style='margin-left:-20px'>{''.join(rows)}</ul>"
            if rows
            else nothing
        )
        told = "".join(f"<li>{escape(tr_phrase(words))}</li>" for words in self.differences)
        differs = (
            f"<p><b>{tr('How it differs from the drawn states')}</b></p>"
            f"<ul style='margin-left:-20px'>{told}</ul>"
            if told
            else ""
        )
        self.losses.setText(note + differs + lost)
        self._show_result()

    def _show_result(self) -> None:
        """Say what was written for the target that is chosen; of another it would be wrong here."""
        name = self.target.name
        self.open_button.setText(tr("Open in browser") if name == "web" else tr("Open folder"))
        result = self.results.get(name)
        self.open_button.setEnabled(result is not None)
        if result is not None:
            self.words.setText(result.words)
        if self.go.isEnabled() or result is not None:  # else it says why nothing can be exported
            self.trouble.setText(result.trouble if result is not None else "")

    def _browse(self) -> None:
        name = QFileDialog.getExistingDirectory(self, tr("Export to"), self.folder.text())
        if name:
            self.folder.setText(name)
            self._name_folder(name)

    def _open(self) -> None:
        """Show what was written: a web page in the browser, all else as a folder."""
        name = self.target.name
        folder = self.results[name].folder
        if name != "web":
            if not open_folder(Path(folder)):
                self.trouble.setText(tr("No program opened. The folder is {folder}.").format(folder=folder))
            return
        address = serve_folder(folder)
        opened = QDesktopServices.openUrl(QUrl(address))
        told = tr("The page is at {address} while Metagraph runs.").format(address=address)
        self.words.setText(f"{self.results[name].words}\n{told}")
        self.trouble.setText("" if opened else tr("No browser opened. Open that address yourself."))

    # --- how large it becomes

    def _choose_packing(self, on: bool) -> None:
        self.chosen = replace(self.chosen, compress=on)

    def _collect(self) -> Contents:
        """Return what goes into the export, as it is chosen now."""
        project, base = self.project, self.document.folder
        expanded, compress = (b.isChecked() and not b.isHidden() for b in (self.expanded, self.compress))
        whole = project.character is not None and self.mesh.isChecked()
        character = (base or Path()) / project.character if whole and project.character else None
        return Contents(character, expanded, base, is_chosen, compress)

    def _measure_soon(self) -> None:
        self._soon.start()

    def _wanted(self) -> tuple[object, ...]:
        contents = self._collect()
        return (self.target.name, contents.character, contents.expanded, contents.compress)

    def _measure(self) -> None:
        """Find out how large the export will be, unless that is known or something is wrong with the project.
        What was measured for another choice is given up.
        """
        self._stop_measuring()
        wanted, project, name, contents = self._wanted(), self.project, self.target.name, self._collect()
        if wanted in self.sizes:
            self._show_size()
            return
        self.sized.setText("")
        if not self.go.isEnabled():
            return
        self.sized.setText(tr("Measuring the size…"))

        def done(size: ExportSize | None) -> None:
            self.sizes[wanted], self._measuring = size, None
            self._show_size()

        def work(job: WindowJob) -> ExportSize | None:
            return measure_export(project, name, contents, job.go_on)

        self._measuring = self.jobs.start("size", work, done, lambda error: done(None), quick=True)

    def _stop_measuring(self) -> None:
        self._soon.stop()
        if self._measuring is not None:
            self._measuring.cancel()
            self._measuring = None
            self.sized.setText("")

    def _show_size(self) -> None:
        size = self.sizes.get(self._wanted())
        if size is None:
            self.sized.setText("")
            return
        words = tr_plural(
            "{size:.1f} MB in {count:,} file",
            "{size:.1f} MB in {count:,} files",
            size.files,
            size=size.bytes / 1e6,
        )
        glb = tr("{size:.1f} MB of it in the GLB", size=size.glb / 1e6) if size.glb else ""
        self.sized.setText(f"{words}, {glb}." if glb else f"{words}.")

    # --- writing

    def _export(self, overwrite: bool = False) -> None:
        project, folder, name = self.project, Path(self.folder.text()), self.target.name
        vectors, tools = (box.isChecked() and not box.isHidden() for box in (self.vectors, self.tools))
        contents = self._collect()
        self.chosen = ExportChoice(
            name,
            self.chosen.folders,
            self.mesh.isChecked(),
            self.expanded.isChecked(),
            self.vectors.isChecked(),
            self.tools.isChecked(),
            self.chosen.compress,
        )
        QSettings().setValue(self._key(), json.dumps(asdict(self.chosen)))
        self.go.setEnabled(False)
        self.trouble.clear()
        self.progress.setRange(0, 0)
        self.progress.show()
        self._stop_measuring()

        def work(job: WindowJob) -> TargetReport:
            made = registry.write_for_target(project, name, folder, contents, job.go_on, overwrite)
            if vectors:
                write_vectors(next(path for path in made.files if path.suffix == ".json"))
            if tools:
                write_tools(project, folder)
            return made

        def failed(error: Exception) -> None:
            self._failed(name, error)

        job = self.jobs.start(
            tr("Exporting"), work, lambda made: self._done(made, folder), failed, stands=True
        )
        job.progress.connect(self._tell)
        job.ended.connect(self._ended)

    def _ended(self) -> None:
        self.progress.hide()
        self.go.setEnabled(True)

    def _tell(self, done: int, total: int, words: str) -> None:
        self.progress.setRange(0, total)
        self.progress.setValue(done)

    def _done(self, made: TargetReport, folder: Path) -> None:
        main = [path.name for path in sorted(made.files, key=lambda path: -path.stat().st_size)[:3]]
        names = ", ".join(main)
        if more := len(made.files) - len(main):
            names = tr_plural(
                "{names} and {count:,} more file", "{names} and {count:,} more files", more, names=names
            )
        size = sum(path.stat().st_size for path in made.files) / 1e6
        words = tr_plural(
            "Wrote {names}: {size:.1f} MB, {count:,} clip.",
            "Wrote {names}: {size:.1f} MB, {count:,} clips.",
            made.clips,
            names=names,
            size=size,
        )
        next_steps = [f"{n}. {tr_phrase(step)}" for n, step in enumerate(made.steps, 1)]
        self.results[made.target] = ExportResult(
            str(folder), "\n".join([words, *next_steps]), "\n".join(map(tr_phrase, made.warnings[:5]))
        )
        if self.target.name == made.target:
            self._show_result()
        self.document.exported.emit()

    def _failed(self, target: str, error: Exception) -> None:
        if isinstance(error, ForeignFilesError) and self.target.name == target:
            self._ask_overwrite(error)
        else:
            self.trouble.setText(tr_error(error))

    def _ask_overwrite(self, error: ForeignFilesError) -> None:
        """Ask before anything that is not of this export is overwritten."""
        box = QMessageBox(
            QMessageBox.Icon.Question,
            tr("Overwrite?"),
            tr("{folder} contains files from elsewhere.", folder=error.folder),
            parent=self,
        )
        box.setInformativeText(
            tr("These files would be overwritten:")
            + "".join(f"\n{file}" for file in error.files[:8])
            + ("\n…" if len(error.files) > 8 else "")
        )
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        overwrite = box.addButton(tr("Overwrite"), QMessageBox.ButtonRole.DestructiveRole)
        box.addButton(tr("Choose another folder…"), QMessageBox.ButtonRole.RejectRole)
        box.buttonClicked.connect(
            lambda button: self._export(overwrite=True) if button is overwrite else self._browse()
        )
        self.trouble.setText(tr_error(error))
        box.open()
