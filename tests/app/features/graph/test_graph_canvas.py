"""The canvas in the window: what is painted of it, and when."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QEvent, QObject, QRect
from PySide6.QtGui import QPaintEvent, QRegion

from metagraph.graph import edits

pytestmark = [pytest.mark.window, pytest.mark.gl]


class Painted(QObject):
    """Notes where a widget is painted."""

    def __init__(self, widget: QObject) -> None:
        super().__init__()
        self.regions: list[QRegion] = []
        widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QPaintEvent):
            self.regions.append(event.region())
        return False


@pytest.mark.nightly
def test_what_an_edit_changed_is_painted_though_a_corner_is_painted_first(drive, toy):
    drive.document.load(toy.project(), None)
    drive.workspaces.choose("graph")
    drive.settle()
    drive.session.transport.set_playing(False)
    canvas, corner = drive.canvas, QRect(0, 0, 2, 2)
    row = canvas.layout_now().nodes["gesture"].rows[0]
    canvas.repaint()
    painted = Painted(canvas)
    drive.document.edit(
        "Likelihood", lambda project: edits.update_actions(project, (row.action.id,), likelihood=2.5)
    )
    canvas.repaint(corner)  # as a picture that comes, or a beat
    assert painted.regions[0].boundingRect() == corner
    drive.wait(lambda: any(region.contains(row.rect.toAlignedRect()) for region in painted.regions))
