"""What drags in the rows of an action share."""

from __future__ import annotations

from app.features.timing_editor.drags.host import Host
from app.features.timing_editor.track import Facts
from app.widgets.gesture import PressDrag, Reason

SNAP = 7.0  # pixels within which a handle comes to rest


class RowsDrag(PressDrag):
    """The view tells about what is dragged until it is over. facts: of the action, as it was."""

    catch = 2.0

    def __init__(self, host: Host, facts: Facts) -> None:
        super().__init__()
        self.host, self.facts = host, facts

    def cancel(self, reason: Reason) -> None:
        self.over()

    def over(self) -> None:
        """Report no more."""
        host = self.host
        host.held, host.snapped, host.snaps, host.stretched = "", None, (), None
        host.update()
