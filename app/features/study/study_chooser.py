"""Begins a sitting: asks which study and who takes part, where that was not told."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QDialog,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QMessageBox,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.features.study.study_guide import Guide
from app.look.theme import strengthen
from app.project.files import Files
from app.shell.places import PanelPlaces
from app.translation import tr, tr_error, tr_noop
from metagraph.errors import FileError
from metagraph.research.study.sitting import describe_standing
from metagraph.research.study.study_plan import Study, read_study

if TYPE_CHECKING:
    from app.shell.context import Shell

OVER = (tr_noop("done"), tr_noop("withdrawn"))  # what `standing` says if nobody goes on
OTHERS = (tr_noop("not begun"), tr_noop("declined"))  # it says that, too


def run_study(
    shell: Shell, path: Path | None = None, participant: str | None = None, experimenter: bool = False
) -> None:
    """Begin or resume a sitting in the window; what is not given is asked for."""
    if path is None:
        name, _ = QFileDialog.getOpenFileName(
            shell.widget, tr("Run a study"), str(Path.home()), tr("Studies (*.yaml *.yml)")
        )
        if not name:
            return
        path = Path(name)
    try:
        study = read_study(path)
    except FileError as error:
        QMessageBox.warning(shell.widget, tr("This study cannot be run"), tr_error(error))
        return
    if participant is not None:
        begin_sitting(shell, study, participant, experimenter)
        return
    chooser = StudyChooser(study, shell.widget)
    chooser.chosen.connect(lambda who: begin_sitting(shell, study, who, experimenter))
    chooser.open()


def begin_sitting(shell: Shell, study: Study, participant: str, experimenter: bool = False) -> Guide | None:
    """Lead a participant through; None, with words, when that cannot be."""
    if not shell.services[Files].may_leave():
        return None
    shell.services[PanelPlaces].make_all()  # nobody is timed while a panel is made
    shell.document.undo_stack.setClean()  # what was there is saved or was declined
    try:
        guide = Guide(shell, study, participant, experimenter)
    except (FileError, ValueError) as error:
        shell.services[Files].show_warning(tr("This sitting cannot start"), error)
        return None
    guide.show()
    return guide


class StudyChooser(QDialog):
    """Participants with how far each is; chosen: who takes part."""

    chosen = Signal(str)

    def __init__(self, study: Study, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Run a study"))
        self.resize(460, 420)
        title = QLabel(study.plan.title, self)
        title.setProperty("heading", True)
        title.setWordWrap(True)
        self.list = QListWidget(self)
        self.list.setAccessibleName(tr("Participants"))
        first: QListWidgetItem | None = None
        for who in study.plan.ids:
            words = describe_standing(study, who)
            item = QListWidgetItem(f"{who}    {tr(words)}", self.list)
            item.setData(Qt.ItemDataRole.UserRole, who)
            if words in OVER:
                item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsEnabled)
            elif first is None:
                first = item
        if first is not None:
            self.list.setCurrentItem(first)
        self.list.itemActivated.connect(lambda _: self._go())
        cancel, self.go = QPushButton(tr("Cancel"), self), QPushButton(tr("Start"), self)
        cancel.clicked.connect(self.reject)
        strengthen(self.go)
        self.go.clicked.connect(self._go)
        self.go.setEnabled(first is not None)
        buttons = QHBoxLayout()
        buttons.addStretch(1)
        buttons.addWidget(self.go)
        buttons.addWidget(cancel)
        column = QVBoxLayout(self)
        column.setContentsMargins(18, 16, 18, 16)
        column.setSpacing(10)
        column.addWidget(title)
        column.addWidget(QLabel(tr("Who takes part?"), self))
        column.addWidget(self.list, 1)
        column.addLayout(buttons)

    def _go(self) -> None:
        item = self.list.currentItem()
        if item is not None:
            self.accept()
            self.chosen.emit(item.data(Qt.ItemDataRole.UserRole))
