"""The joints of a skeleton as a tree, and the dialog that ticks the only ones an action moves."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.project.document import Document
from app.stage.session import Session
from app.widgets.joint_figure import JointFigure
from app.widgets.tree_items import items_below
from metagraph.graph import edits
from metagraph.graph.model import Project

JOINT = Qt.ItemDataRole.UserRole


def joint_tree(tree: QTreeWidget, project: Project) -> dict[str, QTreeWidgetItem]:
    """Fill a tree with the skeleton's joints; return joint name -> item."""
    items: dict[str, QTreeWidgetItem] = {}
    skeleton = project.skeleton
    for i, name in enumerate(skeleton.names if skeleton is not None else ()):
        assert skeleton is not None
        parent = skeleton.parents[i]
        item = QTreeWidgetItem([name])
        item.setData(0, JOINT, name)
        if parent >= 0:
            items[skeleton.names[parent]].addChild(item)
        else:
            tree.addTopLevelItem(item)
        items[name] = item
    tree.expandAll()
    return items


class MaskDialog(QDialog):
    """Chooses the only joints the selected actions move; all ticked means no mask."""

    def __init__(self, document: Document, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Joints the action moves")
        self.resize(720, 620)
        layout = QVBoxLayout(self)
        words = QLabel(
            "Only ticked joints move; the others keep to the stance. Ticking a joint ticks what hangs on it; "
            "a drag across the figure ticks the joints within, with Alt or the right button it unticks them.",
            self,
            wordWrap=True,
        )
        layout.addWidget(words)
        self.tree = QTreeWidget(self)
        self.tree.setAccessibleName("Joints that move")
        self.tree.setHeaderHidden(True)
        both = QHBoxLayout()
        both.addWidget(self.tree, 1)
        layout.addLayout(both, 1)
        self.figure: JointFigure | None = None
        if document.project.skeleton is not None:
            self.figure = JointFigure(document.project.skeleton, session.look.name, self)
            self.figure.clicked.connect(self._clicked)
            self.figure.circled.connect(self._circled)
            both.addWidget(self.figure, 1)
        self.items = joint_tree(self.tree, document.project)
        actions = session.selection.selected_actions()
        masked = set(actions[0].joints) if actions else set()
        for name, item in self.items.items():
            item.setCheckState(
                0, Qt.CheckState.Checked if not masked or name in masked else Qt.CheckState.Unchecked
            )
        self.tree.itemChanged.connect(self._ticked)
        self._show()
        row = QHBoxLayout()
        for text, on in (("All", True), ("None", False)):
            button = QPushButton(text, self)
            button.clicked.connect(lambda _=False, o=on: self._all(o))
            row.addWidget(button)
        row.addStretch(1)
        box = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel, self
        )
        box.accepted.connect(self.accept)
        box.rejected.connect(self.reject)
        row.addWidget(box)
        layout.addLayout(row)

    def _ticked(self, item: QTreeWidgetItem, column: int) -> None:
        self.tree.blockSignals(True)
        below = [item]
        while below:
            one = below.pop()
            one.setCheckState(0, item.checkState(0))
            below += items_below(one)
        self.tree.blockSignals(False)
        self._show()

    def _show(self) -> None:
        """Show in the figure what is ticked."""
        if self.figure is not None:
            self.figure.show_moving(
                [n for n, i in self.items.items() if i.checkState(0) == Qt.CheckState.Checked]
            )

    def _clicked(self, joint: str) -> None:
        """Tick a joint of the figure, or untick it, with what hangs on it; the list shows it."""
        item = self.items[joint]
        on = item.checkState(0) != Qt.CheckState.Checked
        item.setCheckState(0, Qt.CheckState.Checked if on else Qt.CheckState.Unchecked)
        self.tree.setCurrentItem(item)

    def _circled(self, joints: tuple[str, ...], on: bool) -> None:
        """Tick or untick just these joints."""
        self.tree.blockSignals(True)
        for joint in joints:
            self.items[joint].setCheckState(0, Qt.CheckState.Checked if on else Qt.CheckState.Unchecked)
        self.tree.blockSignals(False)
        self.tree.viewport().update()
        self._show()

    def _all(self, on: bool) -> None:
        self.tree.blockSignals(True)
        for item in self.items.values():
            item.setCheckState(0, Qt.CheckState.Checked if on else Qt.CheckState.Unchecked)
        self.tree.blockSignals(False)
        self.tree.viewport().update()
        self._show()

    def joints(self) -> tuple[str, ...]:
        """Return the ticked joints; () for all."""
        ticked = tuple(n for n, i in self.items.items() if i.checkState(0) == Qt.CheckState.Checked)
        return () if len(ticked) == len(self.items) else ticked

    def accept(self) -> None:
        joints, chosen = self.joints(), self.session.selection.actions
        if not joints and any(i.checkState(0) == Qt.CheckState.Unchecked for i in self.items.values()):
            self.document.failed.emit("An action must move at least one joint.")
            return
        self.document.edit("Change joints", lambda p: edits.update_actions(p, chosen, joints=joints))
        super().accept()
