"""A window with a conversation of two on stage, spoken by a synthesiser."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QPoint

from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import Conversation, Segment, Side, Word
from tests.speech.talk import make_conversation, speak


class Talk:
    """The panel's view, and where things are in it."""

    def __init__(self, drive: Any, audio: Path, words: Path) -> None:
        self.drive, self.audio, self.words = drive, audio, words

    @property
    def view(self) -> Any:
        return self.drive.conversation.view

    @property
    def editing(self) -> Any:
        return self.drive.conversation.editing

    @property
    def conversation(self) -> Conversation:
        found = self.editing.conversation
        assert found is not None
        return found

    def segments(self, side: int = 0) -> tuple[Segment, ...]:
        return self.conversation.sides[side].segments

    def at(self, seconds: float, side: int = 0, row: str = "segments") -> tuple[Any, QPoint]:
        """A place on the lanes."""
        from app.features.conversation.segment_lanes import place_segment_lanes

        lane = getattr(place_segment_lanes(self.view.width(), self.view.height())[side], row)
        return self.view, QPoint(round(self.view.scale().x(seconds)), round(lane.center().y()))

    def read(self) -> None:
        """Wait until the sound is read."""
        sounds = self.drive.conversation.sounds
        self.drive.wait(lambda: bool(sounds.heard) and not any(h.told for h in sounds.heard.values()), 90)


@pytest.fixture
def talk(drive: Any, tmp_path: Path) -> Talk:
    """A conversation on stage as it was written, with its sound being read."""
    audio, words = make_conversation(tmp_path)
    spoken = speak()
    sides = [
        Side(
            name=("Ann", "Ben")[side],
            audio=str(audio),
            channel=side,
            words=tuple(Word(text=w, start=a, end=b) for w, a, b in spoken.words[side]),
            segments=tuple(
                Segment(s.kind, s.start, s.end, sum(s.stress) / 2 if s.stress else None, s.text)
                for s in spoken.said
                if s.side == side
            ),
        )
        for side in (0, 1)
    ]
    made = Conversation(name="talk", length=spoken.samples.shape[1] / spoken.rate, sides=tuple(sides))
    drive.document.edit("Add conversation", lambda p: conversation_edits.add_conversation(p, made)[0])
    drive.show("conversation")
    drive.session.onstage.set_conversation(next(iter(drive.document.project.conversations)))
    drive.session.transport.set_playing(False)
    drive.pause(50)
    return Talk(drive, audio, words)
