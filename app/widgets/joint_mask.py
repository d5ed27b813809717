"""The joints of a skeleton as a tree, and the dialog that says which of them an action moves, and how far."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.project.document import Document
from app.stage.session import StageSession
from app.translation import tr
from app.widgets.joint_figure import JointFigure, format_weight
from app.widgets.making import make_widget
from app.widgets.mask_weights import MaskWeights
from app.widgets.quiet_fields import DoubleSpinBox, Slider, SpinBox
from app.widgets.tree_items import list_items_below
from app.widgets.within_screen import resize_within_screen
from metagraph.graph import edits
from metagraph.graph.manual.machine import State
from metagraph.graph.model import Action, Project

JOINT = Qt.ItemDataRole.UserRole
NOTCH = 0.05  # weight a notch of the wheel, and a press of + and -, stand for


def fill_joint_tree(tree: QTreeWidget, project: Project) -> dict[str, QTreeWidgetItem]:
    """Fill a tree with the skeleton's joints; return joint name -> item."""
    items: dict[str, QTreeWidgetItem] = {}
    skeleton = project.skeleton
    for i, name in enumerate(skeleton.names if skeleton is not None else ()):
        assert skeleton is not None
        parent = skeleton.parents[i]
        item = QTreeWidgetItem([name])
        item.setToolTip(0, name)
        item.setData(0, JOINT, name)
        if parent >= 0:
            items[skeleton.names[parent]].addChild(item)
        else:
            tree.addTopLevelItem(item)
        items[name] = item
    tree.expandAll()
    return items


class MaskDialog(QDialog):
    """Says how far the selected actions move each joint; all of all means no mask."""

    def __init__(self, document: Document, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.document, self.session = document, session
        self.weights = MaskWeights(document.project, self._first())
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(self._title())
        resize_within_screen(self, 760, 660)
        layout = QVBoxLayout(self)
        words = QLabel(
            tr(
                "The action moves only the ticked joints, by their weights. All other joints "
                "follow the stance. Click a joint to give it and its children the strength below, or to "
                "clear them. Drag to set all joints in a rectangle; Alt+drag or right-drag clears them. "
                "The wheel, + and - change a weight."
            ),
            self,
            wordWrap=True,
        )
        layout.addWidget(words)
        both = QHBoxLayout()
        both.addWidget(self._make_tree(), 1)
        layout.addLayout(both, 1)
        self.figure: JointFigure | None = None
        if document.project.skeleton is not None:
            self.figure = JointFigure(document.project.skeleton, session.look.name, self)
            self.figure.clicked.connect(self._clicked)
            self.figure.circled.connect(self._circled)
            self.figure.turned.connect(self._turned)
            both.addWidget(self.figure, 1)
        layout.addLayout(self._make_brush())
        layout.addLayout(self._make_buttons())
        QShortcut(QKeySequence(QKeySequence.StandardKey.Undo), self, self._undo)
        QShortcut(QKeySequence(QKeySequence.StandardKey.Redo), self, self._redo)
        self._show()

    def _first(self) -> Action | State | None:
        """Return whose mask is shown first."""
        actions = self.session.selection.selected_actions()
        return actions[0] if actions else None

    def _title(self) -> str:
        return tr("Joints the action moves")

    def _make_tree(self) -> QTreeWidget:
        self.tree = QTreeWidget(self)
        self.tree.setAccessibleName(tr("Joints that move"))
        self.tree.setColumnCount(2)
        self.tree.setHeaderHidden(True)
        self.tree.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.items = fill_joint_tree(self.tree, self.document.project)
        header = self.tree.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        self.tree.itemChanged.connect(self._ticked)
        self.tree.installEventFilter(self)
        return self.tree

    def _make_brush(self) -> QHBoxLayout:
        """Make what says how far joints are to move."""
        row = QHBoxLayout()
        self.strength = DoubleSpinBox(
            self,
            minimum=NOTCH,
            maximum=1.0,
            singleStep=NOTCH,
            value=1.0,
            toolTip=tr("How far the ticked joints follow the action"),
        )
        self.strength.setAccessibleName(tr("Strength"))
        self.slider = Slider(Qt.Orientation.Horizontal, self, minimum=5, maximum=100, singleStep=5, value=100)
        self.slider.setAccessibleName(tr("Strength"))
        self.slider.setToolTip(self.strength.toolTip())
        self.strength.valueChanged.connect(lambda value: self.slider.setValue(round(100 * value)))
        self.slider.valueChanged.connect(lambda value: self.strength.setValue(value / 100))
        label = QLabel(tr("&Strength"), self)
        label.setBuddy(self.strength)
        self.over = SpinBox(self, minimum=1, maximum=9, value=3)
        self.over.setAccessibleName(tr("Joints of a soft edge"))
        self.over.setToolTip(tr("Number of joints over which a soft edge fades in"))
        row.addWidget(label)
        row.addWidget(self.slider, 1)
        row.addWidget(self.strength)
        row.addWidget(
            self._button(
                tr("Set &selected"),
                tr("Give the joints that are selected in the list this strength"),
                lambda: self._give(self._chosen(), self.strength.value()),
            )
        )
        row.addSpacing(12)
        tip = tr("Fade the weights in where the mask begins: 0.25, 0.5, 0.75 over three joints of the spine")
        row.addWidget(self._button(tr("Soft &edge"), tip, self._soften))
        row.addWidget(self.over)
        return row

    def _make_buttons(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.addWidget(
            self._button(tr("&All"), tr("Let the action move all joints fully"), partial(self._all, True))
        )
        row.addWidget(
            self._button(tr("&None"), tr("Let the action move no joint"), partial(self._all, False))
        )
        self.undo_button = self._button(
            tr("&Undo"), tr("Undo the last change in this dialog (Ctrl+Z)"), self._undo
        )
        self.redo_button = self._button(
            tr("&Redo"), tr("Redo the change in this dialog (Ctrl+Shift+Z)"), self._redo
        )
        row.addWidget(self.undo_button)
        row.addWidget(self.redo_button)
        row.addStretch(1)
        box = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel, self
        )
        box.accepted.connect(self.accept)
        box.rejected.connect(self.reject)
        row.addWidget(box)
        return row

    def _button(self, text: str, tip: str, does: Any) -> QPushButton:
        button = make_widget(QPushButton, text, self, toolTip=tip)
        button.setAutoDefault(False)
        button.clicked.connect(lambda: does())
        return button

    # --- changes

    def _give(self, joints: Iterable[str], weight: float) -> None:
        self.weights.change(dict.fromkeys(joints, weight))
        self._show()

    def _add(self, joints: Iterable[str], amount: float) -> None:
        self.weights.add(joints, amount)
        self._show()

    def _ticked(self, item: QTreeWidgetItem, column: int) -> None:
        on = item.checkState(0) != Qt.CheckState.Unchecked
        self._give(self._with_below(item), self.strength.value() if on else 0.0)

    def _clicked(self, joint: str) -> None:
        """Give a joint of the figure, and what hangs on it, the strength; none where it has that; the list
        shows it.
        """
        item, strength = self.items[joint], self.strength.value()
        self._give(self._with_below(item), 0.0 if self.weights.now[joint] == strength else strength)
        self.tree.setCurrentItem(item)

    def _circled(self, joints: tuple[str, ...], on: bool) -> None:
        """Give just these joints the strength, or nothing."""
        self._give(joints, self.strength.value() if on else 0.0)

    def _turned(self, joint: str, notches: int) -> None:
        """Change the weight of the joint under the wheel, elsewhere the strength."""
        if joint:
            self._add([joint], notches * NOTCH)
        else:
            self.strength.setValue(self.strength.value() + notches * NOTCH)

    def _soften(self) -> None:
        self.weights.soften(self.over.value())
        self._show()

    def _all(self, on: bool) -> None:
        self._give(self.items, 1.0 if on else 0.0)

    def _undo(self) -> None:
        self.weights.undo()
        self._show()

    def _redo(self) -> None:
        self.weights.redo()
        self._show()

    # --- what is seen

    def _with_below(self, item: QTreeWidgetItem) -> list[str]:
        """Return the names of an item's joint and all that hangs on it."""
        out, below = [], [item]
        while below:
            one = below.pop()
            out.append(one.data(0, JOINT))
            below += list_items_below(one)
        return out

    def _chosen(self) -> list[str]:
        return [item.data(0, JOINT) for item in self.tree.selectedItems()]

    def _show(self) -> None:
        """Show in list and figure how far joints move."""
        weights: Mapping[str, float] = self.weights.now
        blocked = self.tree.blockSignals(True)
        for name, item in self.items.items():
            weight = weights[name]
            soft = Qt.CheckState.PartiallyChecked if weight > 0 else Qt.CheckState.Unchecked
            item.setCheckState(0, Qt.CheckState.Checked if weight == 1 else soft)
            item.setText(1, format_weight(weight) if 0 < weight < 1 else "")
        self.tree.blockSignals(blocked)
        self.tree.viewport().update()
        self.undo_button.setEnabled(self.weights.can_undo)
        self.redo_button.setEnabled(self.weights.can_redo)
        if self.figure is not None:
            self.figure.show_weights(weights)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Let + and - in the list change the weights of what is chosen there."""
        if watched is self.tree and isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            way = {Qt.Key.Key_Plus: 1, Qt.Key.Key_Minus: -1}.get(Qt.Key(event.key()))
            if way is not None:
                self._add(self._chosen(), way * NOTCH)
                return True
        return super().eventFilter(watched, event)

    def joints(self) -> tuple[str, ...]:
        """Return the joints that move; () for all."""
        return self.weights.fields().get("joints", ())

    def accept(self) -> None:
        if self.weights.empty and self.items:
            self.document.failed.emit(self._nothing_moves())
            return
        self._keep(self.weights.fields())
        self.done(self.DialogCode.Accepted)

    def _nothing_moves(self) -> str:
        return tr("An action must move at least one joint.")

    def _keep(self, fields: dict[str, Any]) -> None:
        chosen = self.session.selection.actions
        self.document.edit(tr("Change joints"), lambda p: edits.update_actions(p, chosen, **fields))
