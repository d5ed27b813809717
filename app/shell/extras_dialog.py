"""The dialog that lists the extras, installs and removes them, and says how without a network; and the button
that offers it where something says that an extra is missing.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPlainTextEdit,
    QProgressBar,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.look.theme import strengthen
from app.project.jobs import Jobs, WindowJob
from app.translation import make_lazy_texts, tr, tr_error, tr_phrase
from app.widgets.making import make_widget
from app.widgets.one_dialog import show_one
from metagraph.common.extra_steps import StoppedError, install_extra, remove_extra
from metagraph.common.extras import (
    EXTRAS,
    can_install,
    find_missing_extra,
    is_installed,
    is_removable,
    make_download_command,
    make_install_command,
    make_offline_command,
    make_remove_command,
)

HEADS = make_lazy_texts(
    lambda: (tr("Extra"), tr("For"), tr("Download"), tr("On disk"), tr("Licence"), tr("Status"))
)
STEPS = 1000  # of the progress bar


def show_extras(parent: QWidget, jobs: Jobs, name: str = "") -> ExtrasDialog:
    """Show the extras, with one of them chosen."""
    window = parent.window()
    dialog = show_one(window, ExtrasDialog, lambda: ExtrasDialog(jobs, window))
    dialog.choose(name)
    return dialog


class ExtrasOffer(QPushButton):
    """A button that is there while a text says that an extra is missing. then: called when the extras
    changed.
    """

    def __init__(self, jobs: Jobs, parent: QWidget, then: Callable[[], object] = lambda: None) -> None:
        super().__init__(tr("Extras…"), parent)
        self.setToolTip(tr("Install what is missing"))
        self.jobs, self.then, self.name = jobs, then, ""
        self._dialog: ExtrasDialog | None = None
        self.clicked.connect(self.open_extras)
        self.hide()

    def follow(self, words: object) -> None:
        """Show or hide the button. words: a text or an error."""
        self.name = find_missing_extra(words) or ""
        self.setVisible(bool(self.name))

    def open_extras(self) -> None:
        dialog = show_extras(self, self.jobs, self.name)
        if dialog is not self._dialog:
            self._dialog = dialog
            dialog.changed.connect(self._tell)

    def _tell(self) -> None:
        self.then()


class ExtrasDialog(QDialog):
    """Stays open beside the window. An installation goes on when it is closed. changed: one was installed or
    removed.
    """

    changed = Signal()

    def __init__(self, jobs: Jobs, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Extras"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(940, 600)
        self.jobs = jobs
        self._job: WindowJob | None = None
        words = tr(
            "Some jobs need packages that are too large to ship with Metagraph. Everything else "
            "works without them."
        )
        self.table = self._make_table()
        self.install = self._button(tr("Install"), tr("Download it and install it"), self.install_chosen)
        strengthen(self.install)
        self.from_folder = self._button(
            tr("From a folder…"),
            tr("Install it from files that you copied to this computer"),
            self.ask_folder,
        )
        self.remove = self._button(tr("Remove"), tr("Free the space that it takes"), self.remove_chosen)
        self.stop = self._button(tr("Stop"), tr("Stop, and change nothing"), self.stop_job)
        self.progress = make_widget(QProgressBar, self, textVisible=False)
        self.progress.setRange(0, STEPS)
        self.progress.setAccessibleName(tr("Progress"))
        self.said = QLabel(self, wordWrap=True)
        self.said.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.heading = QLabel(self)
        self.heading.setProperty("title", True)
        self.line = QLineEdit(self, readOnly=True)
        self.line.setAccessibleName(tr("Command"))
        self.copy_line = self._button(tr("Copy"), tr("Copy the command"), self._copy_line)
        self.offline = QLabel(tr("Without a network"), self)
        self.offline.setProperty("title", True)
        self.steps = QPlainTextEdit(self)
        self.steps.setReadOnly(True)
        self.steps.setAccessibleName(tr("Without a network"))
        self.copy_steps = self._button(tr("Copy"), tr("Copy these steps"), self._copy_steps)
        self._lay_out(QLabel(words, self, wordWrap=True))
        self.fill()
        self.choose(next(iter(EXTRAS)))

    # --- building

    def _button(self, words: str, tip: str, do: Callable[[], object]) -> QPushButton:
        button = make_widget(QPushButton, self, text=words, toolTip=tip)
        button.setAutoDefault(False)
        button.clicked.connect(lambda: do())
        return button

    def _make_table(self) -> QTreeWidget:
        table = make_widget(QTreeWidget, self, rootIsDecorated=False, uniformRowHeights=True)
        table.setHeaderLabels(list(HEADS))
        table.setAccessibleName(tr("Extras"))
        header = table.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.Stretch)
        table.currentItemChanged.connect(lambda *_: self._show_chosen())
        return table

    def _lay_out(self, words: QLabel) -> None:
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        buttons.rejected.connect(self.reject)
        row = QHBoxLayout()
        for button in (self.install, self.from_folder, self.remove):
            row.addWidget(button)
        row.addWidget(self.progress, 1)
        row.addWidget(self.stop)
        row.addStretch(0)
        line = QHBoxLayout()
        line.addWidget(self.line, 1)
        line.addWidget(self.copy_line)
        above = QHBoxLayout()
        above.addWidget(self.offline, 1)
        above.addWidget(self.copy_steps)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 16, 16, 12)
        layout.setSpacing(10)
        layout.addWidget(words)
        layout.addWidget(self.table, 3)
        layout.addLayout(row)
        layout.addWidget(self.said)
        layout.addWidget(self.heading)
        layout.addLayout(line)
        layout.addLayout(above)
        layout.addWidget(self.steps, 2)
        layout.addWidget(buttons)

    # --- what is shown

    def fill(self) -> None:
        """Show which extras there are now."""
        chosen = self.get_chosen()
        self.table.clear()
        for name, extra in EXTRAS.items():
            brings = tr_phrase(extra.brings)
            texts = (
                tr_phrase(extra.title),
                brings[:1].upper() + brings[1:],
                tr("{count} MB", count=extra.download),
                tr("{count} MB", count=extra.megabytes),
                extra.licence,
                _describe_state(name),
            )
            item = QTreeWidgetItem(self.table, list(texts))
            item.setData(0, Qt.ItemDataRole.UserRole, name)
            item.setToolTip(1, texts[1])
            for column in (2, 3):
                item.setTextAlignment(column, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.choose(chosen)

    def choose(self, name: str) -> None:
        """Choose an extra by name; an unknown name changes nothing."""
        item = self.table.topLevelItem(list(EXTRAS).index(name)) if name in EXTRAS else None
        if item is not None:
            self.table.setCurrentItem(item)

    def get_chosen(self) -> str:
        """Return the name of the chosen extra, "" for none."""
        item = self.table.currentItem()
        return str(item.data(0, Qt.ItemDataRole.UserRole)) if item is not None else ""

    def _show_chosen(self) -> None:
        name = self.get_chosen()
        if not name:
            return
        own, there, busy = can_install(name), is_installed(name), self._job is not None
        self.install.setVisible(own)
        self.from_folder.setVisible(own)
        self.remove.setVisible(own)
        self.install.setEnabled(not there and not busy)
        self.from_folder.setEnabled(not there and not busy)
        self.remove.setEnabled(is_removable(name) and not busy)
        self.progress.setVisible(busy)
        self.stop.setVisible(busy)
        for widget in (self.heading, self.line, self.copy_line):
            widget.setVisible(not own)
        self.heading.setText(
            tr("To remove it, run this in a terminal")
            if there
            else tr("To install it, run this in a terminal")
        )
        self.line.setText(make_remove_command(name) if there else make_install_command(name))
        self.line.setCursorPosition(0)
        self.copy_line.setText(tr("Copy"))
        self.copy_steps.setText(tr("Copy"))
        self.steps.setPlainText(_describe_offline(name, own))

    def _copy_line(self) -> None:
        QGuiApplication.clipboard().setText(self.line.text())
        self.copy_line.setText(tr("Copied"))

    def _copy_steps(self) -> None:
        QGuiApplication.clipboard().setText(self.steps.toPlainText())
        self.copy_steps.setText(tr("Copied"))

    # --- installing and removing

    def install_chosen(self, folder: Path | None = None) -> None:
        """Install the chosen extra, from the network or from a folder of files."""
        name = self.get_chosen()
        title = tr("Installing {name}", name=tr_phrase(EXTRAS[name].title))

        def work(job: WindowJob) -> str:
            def tell(share: float, words: str) -> None:
                job.tell(round(share * STEPS), STEPS, tr_phrase(words))

            install_extra(name, tell, lambda: job.cancelled, folder)
            return tr("{name} is installed and works.", name=tr_phrase(EXTRAS[name].title))

        self._start(title, work)

    def ask_folder(self) -> None:
        place = QFileDialog.getExistingDirectory(self, tr("A folder of packages"), str(Path.home()))
        if place:
            self.install_chosen(Path(place))

    def remove_chosen(self) -> None:
        """Remove the chosen extra."""
        name = self.get_chosen()
        title = tr_phrase(EXTRAS[name].title)

        def work(_: WindowJob) -> str:
            size = remove_extra(name) / 1e6
            return tr("{name} is removed: {size:.0f} MB are free again.", name=title, size=size)

        self._start(tr("Removing {name}", name=title), work)

    def stop_job(self) -> None:
        """Stop the installation."""
        if self._job is not None:
            self._job.cancel()
            self.stop.setEnabled(False)
            self.said.setText(tr("Stopping…"))

    def _start(self, title: str, work: Callable[[WindowJob], str]) -> None:
        if self._job is not None or self.get_chosen() == "":
            return
        self.said.setText("")
        self._job = job = self.jobs.start(title, work, self._done, self._failed, stands=True)
        self.progress.setValue(0)
        self.stop.setEnabled(True)
        job.progress.connect(self._tell)
        job.ended.connect(self._ended)
        self._show_chosen()

    def _tell(self, done: int, _: int, words: str) -> None:
        if self._job is not None and not self._job.cancelled:
            self.progress.setValue(done)
            self.said.setText(words)

    def _done(self, words: str) -> None:
        self.said.setText(words)
        self.changed.emit()

    def _failed(self, error: Exception) -> None:
        self.said.setText(tr_error(error))

    def _ended(self) -> None:
        if self._job is not None and self._job.cancelled:
            self.said.setText(tr_error(StoppedError(tr("Stopped. Nothing was changed."))))
        self._job = None
        self.fill()
        self._show_chosen()


def _describe_state(name: str) -> str:
    if not is_installed(name):
        return tr("Not installed")
    if can_install(name) and not is_removable(name):
        return tr("Comes with Metagraph")
    return tr("Installed")


def _describe_offline(name: str, own: bool) -> str:
    """Return the steps that bring an extra to a computer without a network, with the exact names."""
    folder = f"metagraph-{name}"
    last = (
        tr("3. Choose that folder here with the button From a folder.")
        if own
        else tr("3. Run this beside that folder:") + f"\n    {make_offline_command(name)}"
    )
    return "\n".join(
        (
            tr("1. Run this on a computer with a network and any Python:"),
            f"    {make_download_command(name)}",
            tr("2. Copy the folder {folder} to this computer.", folder=folder),
            last,
        )
    )
