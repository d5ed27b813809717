"""The skeleton: which joint plays which role and belongs to which body part, and which joints an action
moves.
"""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QTreeWidget,
    QVBoxLayout,
    QWidget,
)

from app.look.joint_roles import describe_joint_role
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.joint_mask import JOINT, fill_joint_tree
from app.widgets.quiet_fields import ComboBox
from app.widgets.vocabulary import get_vocabulary_word
from app.widgets.within_screen import resize_within_screen
from metagraph.graph import anatomy, edits
from metagraph.graph.model import PARTS, Part, Project
from metagraph.motion.roles import ROLES, find_missing_roles

ROW = 36  # pixels of a row, with a choice in it


class SkeletonDialog(QDialog):
    """Shows what was found and corrects it; each choice is an edit that can be undone."""

    def __init__(self, document: Document, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Skeleton"))
        resize_within_screen(self, 720, 680)
        layout = QVBoxLayout(self)
        self.words = QLabel(self, wordWrap=True)
        layout.addWidget(self.words)
        self.tree = QTreeWidget(self)
        self.tree.setAccessibleName(tr("Joints of the skeleton"))
        self.tree.setHeaderLabels([tr("Joint"), tr("Role"), tr("Body part")])
        self.tree.header().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self.tree.header().setStretchLastSection(False)
        self.tree.setSelectionMode(QTreeWidget.SelectionMode.ExtendedSelection)
        layout.addWidget(self.tree, 1)
        self.items = fill_joint_tree(self.tree, document.project)
        self.roles: dict[str, QComboBox] = {}
        self.parts: dict[str, QComboBox] = {}
        for name, item in self.items.items():
            role = ComboBox(self.tree, toolTip=tr("Which part of a human body this joint is"))
            role.addItem("-", None)
            for r in ROLES:
                role.addItem(describe_joint_role(r), r)
            role.activated.connect(lambda _, j=name, box=role: self._set_role(j, box.currentData()))
            part = ComboBox(self.tree, toolTip=tr("The body part decides which layers move the joint"))
            for one in PARTS:
                part.addItem(get_vocabulary_word(one), one)
            part.activated.connect(lambda _, j=name, box=part: self._set_part(j, box.currentData()))
            self.tree.setItemWidget(item, 1, role)
            self.tree.setItemWidget(item, 2, part)
            self.roles[name], self.parts[name] = role, part
            item.setSizeHint(0, QSize(0, ROW))
        for column, boxes in ((1, self.roles), (2, self.parts)):
            for box in boxes.values():
                box.ensurePolished()
            wide = max((box.sizeHint().width() for box in boxes.values()), default=100)
            self.tree.setColumnWidth(column, wide + 12)
        row = QHBoxLayout()
        back = QPushButton(tr("Reset to detected"), self)
        back.clicked.connect(self._reset)
        row.addWidget(back)
        row.addStretch(1)
        close = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, self)
        close.rejected.connect(self.reject)
        row.addWidget(close)
        layout.addLayout(row)
        document.changed.connect(self._show)
        self._show()

    def _show(self, *_: object) -> None:
        project = self.document.project
        if project.skeleton is None:
            self.reject()
            return
        found = anatomy.project_roles(project)
        by_joint = {project.skeleton.names[j]: role for role, j in found.items()}
        parts = dict(zip(project.skeleton.names, anatomy.project_parts(project), strict=True))
        for name in self.items:
            if name not in parts:
                continue
            self.roles[name].setCurrentIndex(max(0, self.roles[name].findData(by_joint.get(name))))
            self.parts[name].setCurrentIndex(PARTS.index(parts[name]))
            font = self.items[name].font(0)
            font.setBold(name in project.parts or name in project.roles.values())
            self.items[name].setFont(0, font)
        missing = find_missing_roles(found)
        words = tr(
            "{found} roles detected from the joint names and the hierarchy. Your corrections are bold.",
            found=len(found),
        )
        if missing:
            words += tr(" Not detected: {roles}.", roles=", ".join(map(describe_joint_role, missing)))
        self.words.setText(words)

    def _chosen(self, joint: str) -> tuple[str, ...]:
        """The joint, or all selected ones when it is among them."""
        selected = tuple(i.data(0, JOINT) for i in self.tree.selectedItems())
        return selected if joint in selected else (joint,)

    def _set_role(self, joint: str, role: str | None) -> None:
        def change(project: Project) -> Project:
            for old, named in list(project.roles.items()):
                if named == joint:
                    project = edits.set_role(project, old, None)
            return edits.set_role(project, role, joint) if role else project

        self.document.edit(tr("Change role"), change)
        self._show()

    def _set_part(self, joint: str, part: str) -> None:
        chosen = self._chosen(joint)
        wanted: Part = next(p for p in PARTS if p == part)
        self.document.edit(tr("Change body part"), lambda p: edits.set_part(p, chosen, wanted))

    def _reset(self) -> None:
        def change(project: Project) -> Project:
            for role in list(project.roles):
                project = edits.set_role(project, role, None)
            return edits.set_part(project, tuple(project.parts), None)

        self.document.edit(tr("Reset roles and parts"), change)
