"""Hold the playhead and what moves it: playing, speed, loop; and what it runs through, the whole performance
or a single clip.
"""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QObject, Signal

from metagraph.graph.model import Project

Show = Literal["plan", "clip", "context"]


class Transport(QObject):
    """The transport. `playing_changed` and `moved` (seconds) are about the playhead. `show_changed` is
    emitted if the preview shows something else (see `show`), `part_changed` if another part of a clip is
    looped.
    """

    playing_changed = Signal()
    moved = Signal(float)
    show_changed = Signal()
    part_changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.playing = True
        self.speed = 1.0
        self.loop = True
        self.seconds = 0.0
        self.show: Show = "plan"
        self.shown: str | None = None  # the clip (or action) shown alone or in context
        self.tried: str | None = None  # the stance on which a clip is shown as if it were placed there
        self.part: tuple[str, float, float] | None = None  # of a clip shown alone: id, first and last second
        self._plan_seconds = 0.0  # where the performance was left

    def set_playing(self, playing: bool) -> None:
        if playing != self.playing:
            self.playing = playing
            self.playing_changed.emit()

    def seek(self, seconds: float) -> None:
        """Move the playhead; `moved` is emitted."""
        self.seconds = max(0.0, seconds)
        self.moved.emit(self.seconds)

    def set_part(self, part: tuple[str, float, float] | None) -> None:
        """Loop only a part of a clip whenever that clip is shown alone: its id, first and last second; None
        for all of it.
        """
        if part != self.part:
            self.part = part
            self.part_changed.emit()

    def scrub(self, clip: str, seconds: float) -> None:
        """Show a clip alone, paused, at a moment."""
        if (self.show, self.shown) != ("clip", clip):
            self._show("clip", clip)
        self.set_playing(False)
        self.seek(seconds)

    def show_plan(self) -> None:
        """Play the whole performance, from where it was left."""
        self._show("plan", None)

    def show_clip(self, clip: str) -> None:
        """Play a clip alone."""
        self._show("clip", clip)

    def show_context(self, ident: str, tried: str | None = None) -> None:
        """Play a clip or an action in context: stance, clip, back to the stance, with the other layers.
        `tried` is the stance on which a clip is shown as if it were placed there.
        """
        self._show("context", ident, tried)

    def _show(self, show: Show, shown: str | None, tried: str | None = None) -> None:
        if (show, shown, tried) != (self.show, self.shown, self.tried):
            self.tried = tried
            if show == "plan":
                self.seconds = self._plan_seconds
            elif self.show == "plan":
                self._plan_seconds = self.seconds
            if show != "plan":
                self.seconds = 0.0
            self.show, self.shown = show, shown
            self.show_changed.emit()
        if show != "plan":
            self.seek(0.0)
            self.set_playing(True)

    def follow(self, after: Project) -> None:
        """Play the performance if an edit removed what was shown."""
        if self.shown is None or self.shown in after.clips:
            return
        if all(find(self.shown) is None for find in (after.action, after.state, after.link)):
            self.show_plan()
