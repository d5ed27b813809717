"""The dialog that chooses which joints states move."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from app.project.document import Document
from app.stage.session import Session
from app.translation import tr
from app.widgets.joint_mask import MaskDialog
from metagraph.graph import manual_edits


class StateMask(MaskDialog):
    """Chooses the only joints the selected states move."""

    def __init__(self, document: Document, session: Session, parent: QWidget) -> None:
        super().__init__(document, session, parent)
        self.setWindowTitle(tr("Joints the state moves"))
        first = document.project.state(session.selection.states[0])
        masked = set(first.joints) if first is not None else set()
        self.tree.blockSignals(True)
        for name, item in self.items.items():
            item.setCheckState(
                0, Qt.CheckState.Checked if not masked or name in masked else Qt.CheckState.Unchecked
            )
        self.tree.blockSignals(False)

    def accept(self) -> None:
        joints, chosen = self.joints(), self.session.selection.states
        if not joints and any(i.checkState(0) == Qt.CheckState.Unchecked for i in self.items.values()):
            self.document.failed.emit(tr("A state must move at least one joint."))
            return
        self.document.edit(
            tr("Change joints"), lambda p: manual_edits.update_states(p, chosen, joints=joints)
        )
        self.done(self.DialogCode.Accepted)
