"""The dialog that chooses which joints states move, and how far."""

from __future__ import annotations

from typing import Any

from app.translation import tr
from app.widgets.joint_mask import MaskDialog
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.manual.machine import State


class StateMask(MaskDialog):
    """Says how far the selected states move each joint."""

    def _first(self) -> State | None:
        return self.document.project.state(self.session.selection.states[0])

    def _title(self) -> str:
        return tr("Joints that the state moves")

    def _nothing_moves(self) -> str:
        return tr("A state must move at least one joint.")

    def _keep(self, fields: dict[str, Any]) -> None:
        chosen = self.session.selection.states
        self.document.edit(tr("Change joints"), lambda p: manual_edits.update_states(p, chosen, **fields))
