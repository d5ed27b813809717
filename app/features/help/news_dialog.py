"""The dialog that says what is new in this Metagraph, and looks for a newer one if the user allows it."""

from __future__ import annotations

from PySide6.QtCore import QSettings, Qt, QUrl
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QTextBrowser,
    QVBoxLayout,
    QWidget,
)

from app.project.jobs import Jobs
from app.shell.update_check import (
    ALLOWED,
    Release,
    find_update,
    find_update_address,
    is_asking_allowed,
    read_notes,
)
from app.translation import tr, tr_error
from metagraph import __version__


class NewsDialog(QDialog):
    """Shows the changelog's part for this version; below it, whether to look for updates. release: a newer
    one that is known already.
    """

    def __init__(
        self, jobs: Jobs, settings: QSettings, parent: QWidget, release: Release | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("What is new"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(760, 560)
        self.jobs, self.settings, self._url = jobs, settings, ""
        self.heading = QLabel(self)
        self.heading.setProperty("heading", True)
        self.notes = QTextBrowser(self)
        self.notes.setOpenLinks(False)  # they lead to files of the repository
        self.notes.setAccessibleName(tr("What is new"))
        self.said = QLabel(self, wordWrap=True)
        self.allow = QCheckBox(tr("Look for updates once a day"), self)
        self.allow.setToolTip(
            tr("Sends one request that contains nothing about you or your computer. Installs nothing.")
        )
        self.allow.setChecked(is_asking_allowed(settings))
        self.allow.toggled.connect(self._choose)
        self.look = QPushButton(tr("Look now"), self)
        self.look.setAutoDefault(False)
        self.look.clicked.connect(self.look_now)
        self.page = QPushButton(tr("Open its page"), self)
        self.page.setAutoDefault(False)
        self.page.clicked.connect(self._open_page)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        buttons.rejected.connect(self.reject)
        row = QHBoxLayout()
        row.addWidget(self.allow, 1)
        row.addWidget(self.page)
        row.addWidget(self.look)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 16, 16, 12)
        layout.setSpacing(10)
        layout.addWidget(self.heading)
        layout.addWidget(self.notes, 1)
        layout.addWidget(self.said)
        layout.addLayout(row)
        layout.addWidget(buttons)
        self._show_running()
        if release is not None:
            self._show(release)

    def _show_running(self) -> None:
        self.heading.setText(tr("Metagraph {version}", version=__version__))
        notes = read_notes(__version__)
        self.notes.setMarkdown(notes or tr("This copy of Metagraph came without its changelog."))
        self.page.hide()
        there = find_update_address() is not None
        self.allow.setVisible(there)
        self.look.setVisible(there)
        self.look.setEnabled(is_asking_allowed(self.settings))
        self.said.setText(
            "" if there else tr("This copy of Metagraph does not know where to look for updates.")
        )

    def _open_page(self) -> None:
        if not QDesktopServices.openUrl(QUrl(self._url)):
            self.said.setText(tr("No browser opened. The address is {address}.").format(address=self._url))

    def _choose(self, on: bool) -> None:
        self.settings.setValue(ALLOWED, "true" if on else "false")
        self.look.setEnabled(on)

    def look_now(self) -> None:
        """Ask now."""
        settings = self.settings
        self.said.setText(tr("Looking…"))
        self.look.setEnabled(False)
        self.jobs.start(
            tr("Looking for updates"),
            lambda _: find_update(__version__, settings),
            self._found,
            self._failed,
            quick=True,
        )

    def _found(self, release: Release | None) -> None:
        self.look.setEnabled(is_asking_allowed(self.settings))
        if release is None:
            self.said.setText(tr("This is the newest version of Metagraph."))
        else:
            self._show(release)

    def _failed(self, error: Exception) -> None:
        self.look.setEnabled(is_asking_allowed(self.settings))
        self.said.setText(tr_error(error))

    def _show(self, release: Release) -> None:
        """Show a newer release; its notes are a stranger's text, so they are shown as they are."""
        self.heading.setText(tr("Metagraph {version} is available", version=release.version))
        self.notes.setPlainText(release.notes)
        self._url = release.url
        self.page.setVisible(bool(release.url))
        self.said.setText(
            tr("You have {version}. Install the new version the same way as this one.", version=__version__)
        )
