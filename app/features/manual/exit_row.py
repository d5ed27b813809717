"""When a link leaves its source: at once or at its end, at a share of it, or at a time of its clip."""

from __future__ import annotations

from typing import Any, Literal

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QWidget

from app.translation import make_lazy_texts, tr
from app.widgets.form_fields import MIXED, Mixed, QuietChooser, Seconds, find_common_value
from metagraph.graph.manual.machine import Link

Way = Literal["none", "end", "part", "time"]
WORDS: dict[Way, str] = make_lazy_texts(
    lambda: {
        "none": tr("none"),
        "end": tr("when the source ends"),
        "part": tr("at a fraction of it"),
        "time": tr("at a time of its clip"),
    }
)


def find_exit_way(link: Link) -> Way:
    """Return how a link says when its source is left."""
    if link.exit_time is not None:
        return "time"
    if link.exit_part is None:
        return "none"
    return "end" if link.exit_part >= 1 else "part"


class ExitRow(QWidget):
    """chosen: another way. timed: seconds of the clip. shared: a share, 0..1, of what plays."""

    chosen = Signal(str)
    timed = Signal(float)
    shared = Signal(float)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.way = QuietChooser(
            self,
            toolTip=tr(
                "When the link can leave the source state. A loop has no end, so a request leaves it at once."
            ),
        )
        self.way.activated.connect(lambda n: self.chosen.emit(self.way.itemData(n)))
        self.time = Seconds(
            self, tr("Exit time: the time in the source's clip from which the link can leave it")
        )
        self.time.valueChanged.connect(self.timed)
        self.part = Seconds(
            self, tr("The fraction of the source's playing time at which the blend ends"), 100, " %", 5, 0
        )
        self.part.valueChanged.connect(lambda v: self.shared.emit(v / 100))
        line = QHBoxLayout(self)
        line.setContentsMargins(0, 0, 0, 0)
        line.addWidget(self.way, 3)
        line.addWidget(self.time, 2)
        line.addWidget(self.part, 2)

    def show_links(self, links: list[Link]) -> None:
        """Show what several links have in common."""
        ways: Any = find_common_value([find_exit_way(x) for x in links])
        when = find_common_value([x.condition.when for x in links])
        none = {"request": tr("at once"), "finished": tr("at its end")}.get(str(when), tr("none"))
        entries = [(none if way == "none" else words, way) for way, words in WORDS.items()]
        self.way.show_entries(entries, None if ways is Mixed else ways, tr(MIXED))
        self.time.setVisible(ways == "time")
        self.part.setVisible(ways == "part")
        if ways == "time":
            self.time.show_value(find_common_value([x.exit_time for x in links]))
        elif ways == "part":
            parts = find_common_value([x.exit_part for x in links])
            self.part.show_value(parts if parts is Mixed else parts * 100)
