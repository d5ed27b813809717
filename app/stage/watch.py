"""Keep the aids for watching the character: marks of feet, ghosts, light, background and the number of views.
They belong to the user, not to the project, and are kept in the settings.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

from PySide6.QtCore import QObject, QSettings, Signal

from app.translation import make_lazy_texts, tr
from preview.scene import THEMES, SceneTheme

KEY = "watch"
STUDIO, STAGE = "studio", "stage"  # names from `preview.looks`, which is imported when others are chosen
PANES = (1, 2, 4)
SIDES = make_lazy_texts(
    lambda: {  # names of the views beside the first
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
MOST_GHOSTS = 5  # before now, and the same number after it; each is drawn in every picture
SPACINGS = (0.05, 0.1, 0.2, 0.5)  # seconds


@dataclass(frozen=True)
class Watched:
    """What helps to watch the character.

    `sticks` draws characters without a mesh as stick figures instead of the default body.
    `feet` shows which foot is held, steps or is lifted, and slides. `hands` shows which are kept in contact.
    `stance` shows a ghost in the stance underneath. `before` and `after` are the numbers of ghosts of other
    moments, `spacing` seconds apart. `light` and `background` are names from `preview.looks`,
    `seat` is one of `preview.looks.SEATS`.
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
    sticks: bool = False
    sides: str = "front left face"
    seat: str = "stool"

    def look(self, theme: str) -> SceneTheme:
        """Return a theme with this light and background."""
        if (self.light, self.background) == (STUDIO, STAGE):
            return THEMES[theme]
        from preview.looks import look_of

        return look_of(theme, self.light, self.background)


class Watch(QObject):
    """Holds the aids. `changed` is emitted if something else is shown."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.now = _kept()

    def set(self, **changes: Any) -> None:
        """Change aids, named as in `Watched`, now and for later runs."""
        after = replace(self.now, **changes)
        if after != self.now:
            self.now = after
            QSettings().setValue(KEY, json.dumps(asdict(after)))
            self.changed.emit()

    def forget(self) -> None:
        """Restore the initial aids."""
        self.set(**asdict(Watched()))


def _kept() -> Watched:
    """Return the aids kept in the settings; those that cannot be read are the initial ones."""
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
    if kept.seat not in ("stool", "chair", "none"):
        kept = replace(kept, seat=first.seat)
    ghosts = {k: min(max(getattr(kept, k), 0), MOST_GHOSTS) for k in ("before", "after")}
    if (kept.light, kept.background) != (STUDIO, STAGE):
        from preview.looks import BACKDROPS, LIGHTS

        if kept.light not in LIGHTS or kept.background not in BACKDROPS:
            kept = replace(kept, light=STUDIO, background=STAGE)
    return replace(kept, **ghosts, spacing=min(max(kept.spacing, 0.02), 2.0))
