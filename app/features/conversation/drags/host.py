"""What drags on the lanes of a conversation need of the view."""

from __future__ import annotations

from typing import Protocol

from app.features.conversation.segment_editing import Editing
from app.features.conversation.sound_reading import Sounds
from app.project.document import Document, Edit
from app.stage.session import StageSession
from app.widgets.lane_geometry import LaneScale


class SegmentHost(Protocol):
    """The view as its gestures see it. each: pixels a second. first: the first second in sight."""

    document: Document
    session: StageSession
    editing: Editing
    sounds: Sounds
    each: float
    first: float

    def scale(self) -> LaneScale: ...
    def hold(self, edit: Edit | None) -> None: ...
    def look_at(self, first: float) -> None: ...
