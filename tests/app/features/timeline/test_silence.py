"""What the lanes say while nothing plays."""

from __future__ import annotations

from typing import Any

import pytest

from tests.app.painted_text import texts

pytestmark = [pytest.mark.window, pytest.mark.gl]


def said(drive: Any) -> str:
    return " ".join(text.text for text in texts(drive.timeline.lanes))


def test_empty_lanes_say_how_something_plays(drive: Any, toy: Any) -> None:
    drive.workspaces.choose("perform")
    drive.settle()
    assert "Drop a clip on a stance" in said(drive)
    assert drive.timeline.title.words == "Nothing plays yet"
    drive.document.load(toy.project(), None)
    drive.files.opened.emit()
    drive.wait(lambda: bool(drive.performance.shown.plan.layers["arms"].cues))
    assert "Drop a clip" not in said(drive)
