"""What is taken from another project, and what becomes of it here, before it is taken."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QHeaderView,
    QLabel,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)
from shiboken6 import isValid

from app.look.theme import WindowTheme, strengthen
from app.project.document import Document
from app.project.jobs import Jobs
from app.translation import tr, tr_error, tr_noop, tr_phrase
from app.widgets.making import make_widget
from metagraph.formats.project.pieces import ProjectPiece
from metagraph.graph.editing.taking import TakenItem, Taking, describe_taking
from metagraph.graph.model import Project

GROUPS = (
    ("stance", tr_noop("Stances")),
    ("action", tr_noop("Actions")),
    ("clip", tr_noop("Clips")),
)


class TakingDialog(QDialog):
    """Lists what is taken by kind; nothing changes before *Take*, which is one undo step."""

    def __init__(
        self,
        document: Document,
        jobs: Jobs,
        piece: ProjectPiece,
        name: str,
        look: WindowTheme,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.jobs, self.piece, self.name, self.look = document, jobs, piece, name, look
        self.taking: Taking | None = None
        self._of: Project | None = None  # the project that `taking` is worked out for
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Import from {name}", name=name))
        self.resize(760, 560)
        body = QVBoxLayout(self)
        self.summary = QLabel(self, wordWrap=True)
        body.addWidget(self.summary)
        self.list = make_widget(QTreeWidget, self)
        self.list.setHeaderLabels([tr("In that project"), tr("Layer"), tr("In this project")])
        self.list.setAccessibleName(tr("What to import"))
        self.list.setColumnWidth(0, 280)  # names are read whole, what becomes of them has the rest
        self.list.header().setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        self.list.header().setSectionResizeMode(2, QHeaderView.ResizeMode.Stretch)
        body.addWidget(self.list, 1)
        self.retarget = QCheckBox(tr("Retarget clips of another skeleton"), self)
        self.retarget.setChecked(True)
        self.retarget.toggled.connect(self._work_out)
        body.addWidget(self.retarget)
        self.rest = QLabel(self, wordWrap=True)
        self.rest.setProperty("dim", True)
        body.addWidget(self.rest)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        self.take = self.buttons.addButton(tr("Import"), QDialogButtonBox.ButtonRole.AcceptRole)
        strengthen(self.take)
        self.buttons.accepted.connect(self._take)
        self.buttons.rejected.connect(self.reject)
        body.addWidget(self.buttons)
        self._work_out()
        document.changed.connect(self._work_out)

    def _work_out(self) -> None:
        """Work out on a thread what comes of it in the project as it is now: retargeting takes a while."""
        project, piece, retarget = self.document.project, self.piece, self.retarget.isChecked()
        other, own = piece.project.skeleton, project.skeleton
        self.retarget.setVisible(other is not None and own is not None and other != own)
        self.take.setEnabled(False)
        self.summary.setText(tr("Checking what can be imported…"))

        def done(taking: Taking) -> None:
            if isValid(self) and project is self.document.project:
                self.taking, self._of = taking, project
                self._show(taking)

        self.jobs.start(
            tr("Importing"), lambda _: piece.into(project, retarget), done, self._fail, quick=True
        )

    def _fail(self, error: BaseException) -> None:
        if isValid(self):
            self.summary.setText(tr_error(error))

    def _show(self, taking: Taking) -> None:
        self.summary.setText(tr_phrase(describe_taking(taking)))
        self.rest.setText(
            "\n".join(
                [
                    *map(tr_phrase, self.piece.notes),
                    tr("Lines, performances and conversations stay in the other project."),
                ]
            )
        )
        self.take.setEnabled(any(x.becomes in ("new", "renamed") for x in taking.things))
        self.list.clear()
        for kind, title in GROUPS:
            things = [x for x in taking.things if x.kind == kind]
            if not things:
                continue
            new = sum(x.becomes in ("new", "renamed") for x in things)
            words = tr("{new} of {all} are new", new=new, all=len(things))
            top = QTreeWidgetItem(self.list, [tr(title), "", words])
            for thing in things:
                item = self._row(thing)
                if thing.becomes == "left out":
                    item.setForeground(2, QColor(self.look.warning))
                elif thing.becomes in ("there", "joined"):
                    for column in range(3):
                        item.setForeground(column, QColor(self.look.dim))
                top.addChild(item)
            top.setExpanded(kind != "clip" or len(things) < 12)

    def _row(self, thing: TakenItem) -> QTreeWidgetItem:
        item = QTreeWidgetItem([thing.name, tr(thing.layer or ""), tr_phrase(thing.words)])
        item.setToolTip(0, thing.name)
        item.setToolTip(2, tr_phrase(thing.words))
        return item

    def _take(self) -> None:
        taking = self.taking
        if taking is None or self._of is not self.document.project:
            return  # it was edited a moment ago, and is being worked out again
        self.document.changed.disconnect(self._work_out)
        self.document.edit(tr("Import from {name}", name=self.name), lambda _: taking.project)
        self.accept()
