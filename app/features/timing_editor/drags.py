"""What the mouse does in the editor: handles and blocks, the part that plays, the loop, the playhead."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, Protocol

from PySide6.QtCore import QPointF

from app.features.timing_editor.axis import Axis
from app.features.timing_editor.track import Facts, Kept, Stay
from app.project.document import Document
from app.stage.transport import Transport
from app.translation import tr
from app.widgets.gesture import PressDrag, Reason
from metagraph.graph import edits
from metagraph.graph.editing.retiming import set_hold
from metagraph.graph.model import Project
from metagraph.motion.retime import LONGEST, SHORTEST
from metagraph.playback.timing.handles import block_moved, moved_by, slipped
from metagraph.suggest.jumps.snapping import Snap, nearest

SNAP = 7.0  # pixels within which a handle comes to rest
MERGE = "timing"
Changes = Mapping[str, Mapping[str, Any]]


class Host(Protocol):
    """The view, as drags know it. snapped: where what is dragged has come to rest. held: what is dragged, in
    words. snaps: all places to rest there are. stretched: a kept hand as it would be, of which action.
    """

    document: Document
    axis: Axis
    snapped: Snap | None
    held: str
    snaps: tuple[Snap, ...]
    stretched: tuple[str, Kept] | None

    @property
    def transport(self) -> Transport: ...
    def idents(self) -> tuple[str, ...]: ...
    def update(self) -> None: ...


class Scrubbing:
    """The character follows the pointer."""

    begun = True

    def __init__(self, host: Host, facts: Facts) -> None:
        self.host, self.facts = host, facts

    def begin(self, at: QPointF) -> None:
        self.update(at)

    def update(self, at: QPointF, free: bool = False) -> None:
        seconds = min(max(0.0, self.host.axis.seconds(at.x())), self.facts.entry.duration)
        self.host.transport.scrub(self.facts.action.clip, seconds)

    def finish(self, at: QPointF) -> None:
        self.update(at)

    def cancel(self, reason: Reason) -> None:
        """Nothing was changed."""


class Panning:
    """The rows follow the pointer."""

    begun = True

    def __init__(self, host: Host) -> None:
        self.host, self.x = host, 0.0

    def begin(self, at: QPointF) -> None:
        self.x = at.x()

    def update(self, at: QPointF, free: bool = False) -> None:
        self.host.axis = self.host.axis.moved(self.x - at.x())
        self.x = at.x()
        self.host.update()

    def finish(self, at: QPointF) -> None:
        self.update(at)

    def cancel(self, reason: Reason) -> None:
        """Where it stands is where it stays."""


class LoopDrag(PressDrag):
    """A part of the clip is marked that plays again and again."""

    catch = 3.0

    def __init__(self, host: Host, facts: Facts) -> None:
        super().__init__()
        self.host, self.facts = host, facts
        self.before = host.transport.part

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        last = self.facts.entry.duration
        ends = sorted(min(max(0.0, self.host.axis.seconds(x)), last) for x in (self.origin.x(), at.x()))
        if ends[1] - ends[0] >= 1 / self.facts.entry.fps:
            self.host.transport.set_part((self.facts.action.clip, round(ends[0], 3), round(ends[1], 3)))

    def finish(self, at: QPointF) -> None:
        self.update(at)
        if not self.begun:
            self.host.transport.set_part(None)

    def cancel(self, reason: Reason) -> None:
        self.host.transport.set_part(self.before)


class StayDrag(PressDrag):
    """A hold of a clip becomes longer or shorter, once it is let go: the clip is made anew then."""

    catch = 2.0

    def __init__(self, host: Host, facts: Facts, stay: Stay) -> None:
        super().__init__()
        self.host, self.facts, self.stay = host, facts, stay
        self.seconds = stay.hold.seconds

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        longer = (at.x() - self.origin.x()) / self.host.axis.each
        self.seconds = round(min(max(0.0, self.stay.hold.seconds + longer), LONGEST), 2)
        self.host.held = (
            tr("held {seconds:.2f} s", seconds=self.seconds) if self.seconds >= SHORTEST else tr("no hold")
        )
        self.host.update()

    def finish(self, at: QPointF) -> None:
        self.host.held = ""
        if self.begun and self.seconds != self.stay.hold.seconds:
            clip, moment, seconds = self.facts.action.clip, self.stay.hold.at, self.seconds
            self.host.document.edit(tr("Change hold"), lambda p: set_hold(p, clip, moment, seconds))
        self.host.update()

    def cancel(self, reason: Reason) -> None:
        self.host.held = ""
        self.host.update()


class TimingDrag(PressDrag):
    """Something of an action's timing is moved, in as many actions as are selected; all in one step of undo.

    facts: of the action it is dragged in, as it was. grip: where in seconds what is dragged stood. snaps:
    where it may come to rest. change: what is to change in which project when it is moved by seconds. words:
    what is dragged, at a moment.
    """

    catch = 2.0

    def __init__(
        self,
        host: Host,
        facts: Facts,
        grip: float,
        snaps: Iterable[Snap],
        change: Callable[[Project, float], Changes],
        words: Callable[[float], str],
    ) -> None:
        super().__init__()
        self.host, self.facts, self.grip, self.words = host, facts, grip, words
        self.snaps, self.change = tuple(snaps), change
        self.project = host.document.project

    def update(self, at: QPointF, free: bool = False) -> None:
        if not self.caught(at):
            return
        axis = self.host.axis
        by = axis.seconds(at.x()) - axis.seconds(self.origin.x())
        snap = None if free else nearest(self.snaps, self.grip + by, SNAP / axis.each)
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
        self._over()

    def cancel(self, reason: Reason) -> None:
        if self.begun:
            self.host.document.cancel_merging(MERGE)
        self._over()

    def _over(self) -> None:
        self.host.snapped, self.host.snaps, self.host.held = None, (), ""
        self.host.update()


def handle_change(idents: tuple[str, ...], handle: str) -> Callable[[Project, float], Changes]:
    """Return what dragging a handle changes in some actions."""
    return lambda project, by: moved_by(project, idents, handle, by)


def block_change(idents: tuple[str, ...], block: str) -> Callable[[Project, float], Changes]:
    """Return what dragging a phase changes in some actions; "" stands for all of it at once: another part of
    the clip.
    """

    def change(project: Project, by: float) -> Changes:
        out = {}
        for ident in idents:
            action = project.action(ident)
            if action is not None and action.clip in project.clips:
                fields = block_moved(project, action, block, by) if block else slipped(project, action, by)
                out[ident] = {"timing": fields}
        return out

    return change
