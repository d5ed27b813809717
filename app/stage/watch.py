"""What helps to watch the character: marks of feet, ghosts, light, background and how many views there are.
It is the person's, not the project's, and kept in the settings.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

from PySide6.QtCore import QObject, QSettings, Signal

from app.translation import lazy_texts, tr
from preview.scene import THEMES, SceneTheme

KEY = "watch"
STUDIO, STAGE = "studio", "stage"  # of `preview.looks`, which is read when others are chosen
PANES = (1, 2, 4)
SIDES = lazy_texts(
    lambda: {  # of a view beside the first: what it is called
        "front": tr("Front"),
        "left": tr("Left side"),
        "right": tr("Right side"),
        "back": tr("Behind"),
        "above": tr("Above"),
        "quarter": tr("Three quarters"),
        "face": tr("Face"),
        "hands": tr("Hands"),
    }
)
MOST_GHOSTS = 5  # before now, and as many after it: each is drawn in every picture
SPACINGS = (0.05, 0.1, 0.2, 0.5)  # seconds


@dataclass(frozen=True)
class Watched:
    """feet: which foot is held, steps or is lifted, and slides. hands: which are kept in contact. stance: a
    ghost in the stance underneath. before, after: how many ghosts there are of other moments, spacing seconds
    apart. light, background: by the names of `preview.looks`.
    """

    feet: bool = False
    hands: bool = False
    stance: bool = False
    before: int = 0
    after: int = 0
    spacing: float = 0.1
    light: str = STUDIO
    background: str = STAGE
    panes: int = 1
    sides: str = "front left face"

    def look(self, theme: str) -> SceneTheme:
        """Return a theme as it is looked at."""
        if (self.light, self.background) == (STUDIO, STAGE):
            return THEMES[theme]
        from preview.looks import look_of

        return look_of(theme, self.light, self.background)


class Watch(QObject):
    """changed: something else is shown."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.now = _kept()

    def set(self, **changes: Any) -> None:
        """Show other things, named as in `Watched`, from now on and the next time, too."""
        after = replace(self.now, **changes)
        if after != self.now:
            self.now = after
            QSettings().setValue(KEY, json.dumps(asdict(after)))
            self.changed.emit()

    def forget(self) -> None:
        """Show what is shown at first."""
        self.set(**asdict(Watched()))


def _kept() -> Watched:
    """Return what was shown last; what cannot be read is as at first."""
    try:
        found = json.loads(str(QSettings().value(KEY) or "{}"))
        first = Watched()
        known = {f.name: type(getattr(first, f.name)) for f in fields(Watched)}
        good = {k: v for k, v in found.items() if k in known and isinstance(v, known[k])}
        kept = replace(first, **good)
    except (ValueError, TypeError, AttributeError):
        return Watched()
    sides = kept.sides.split()
    if kept.panes not in PANES or len(sides) != 3 or not set(sides) <= set(SIDES):
        kept = replace(kept, panes=first.panes, sides=first.sides)
    ghosts = {k: min(max(getattr(kept, k), 0), MOST_GHOSTS) for k in ("before", "after")}
    if (kept.light, kept.background) != (STUDIO, STAGE):
        from preview.looks import BACKDROPS, LIGHTS

        if kept.light not in LIGHTS or kept.background not in BACKDROPS:
            kept = replace(kept, light=STUDIO, background=STAGE)
    return replace(kept, **ghosts, spacing=min(max(kept.spacing, 0.02), 2.0))
