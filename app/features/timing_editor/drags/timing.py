"""The drag of a handle or a block of the timing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

from PySide6.QtCore import QPointF

from app.features.timing_editor.drags.host import Host
from app.features.timing_editor.drags.rows import SNAP, RowsDrag
from app.features.timing_editor.track import Facts
from app.translation import tr
from app.widgets.gesture import Reason
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.playback.timing.handles import move_block, move_handle_by, slip_action
from metagraph.suggest.jumps.snapping import Snap, find_nearest_snap

MERGE = "timing"
Changes = Mapping[str, Mapping[str, Any]]


class TimingDrag(RowsDrag):
    """Something of an action's timing is moved, in as many actions as are selected; all in one step of undo.

    grip: where in seconds what is dragged stood. snaps: where it may come to rest. change: what is to change
    in which project when it is moved by seconds. words: what is dragged, at a moment. done: called when it
    was moved.
    """

    def __init__(
        self,
        host: Host,
        facts: Facts,
        grip: float,
        snaps: Iterable[Snap],
        change: Callable[[Project, float], Changes],
        words: Callable[[float], str],
        done: Callable[[], object] = lambda: None,
    ) -> None:
        super().__init__(host, facts)
        self.grip, self.words, self.done = grip, words, done
        self.snaps, self.change = tuple(snaps), change
        self.project = host.document.project

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        axis = self.host.axis
        by = axis.seconds(at.x()) - axis.seconds(self.origin.x())
        snap = None if free else find_nearest_snap(self.snaps, self.grip + by, SNAP / axis.each)
        by = snap.at - self.grip if snap is not None else by
        self._move(by)
        seconds = min(max(0.0, self.grip + by), self.facts.entry.duration)
        self.host.snapped, self.host.snaps, self.host.held = snap, self.snaps, self.words(seconds)
        self.host.transport.scrub(self.facts.action.clip, seconds)
        self.host.update()

    def _move(self, by: float) -> None:
        """Change the actions as they were when the drag began: what gave way comes back."""
        was = self.project
        changes = {
            ident: {"timing": replace(action.timing, **fields["timing"])}
            for ident, fields in self.change(was, by).items()
            if (action := was.action(ident)) is not None
        }
        self.host.document.edit(tr("Change timing"), lambda p: edits.update_each(p, changes), MERGE)

    def finish(self, at: QPointF) -> None:
        if self.begun:
            self.host.document.finish_merging()
            self.done()
        self.over()

    def cancel(self, reason: Reason) -> None:
        if self.begun:
            self.host.document.cancel_merging(MERGE)
        self.over()


def handle_change(idents: tuple[str, ...], handle: str) -> Callable[[Project, float], Changes]:
    """Return what dragging a handle changes in some actions."""
    return lambda project, by: move_handle_by(project, idents, handle, by)


def make_block_change(idents: tuple[str, ...], block: str) -> Callable[[Project, float], Changes]:
    """Return what dragging a phase changes in some actions; "" stands for all of it at once: another part of
    the clip.
    """

    def change(project: Project, by: float) -> Changes:
        out = {}
        for ident in idents:
            action = project.action(ident)
            if action is not None and action.clip in project.clips:
                fields = move_block(project, action, block, by) if block else slip_action(project, action, by)
                out[ident] = {"timing": fields}
        return out

    return change
