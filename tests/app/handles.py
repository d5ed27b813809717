"""The parts of a window by the names that tests and scripts know them by."""

from __future__ import annotations

from typing import Any

PANELS = {
    "library": "library",
    "canvas": "graph",
    "preview": "character",
    "properties": "properties",
    "timeline": "timeline",
    "life": "life",
    "models": "models",
    "lines": "lines",
    "conversation": "conversation",
    "machine": "machine",
    "problems_panel": "problems",
    "editor": "manual",
}


class Handles:
    """window: made by `app.main.make_window`. Its panels, and the parts of its shell and stage, are
    attributes.
    """

    def __init__(self, window: Any) -> None:
        self.window, self.shell = window, window.shell

    def __getattr__(self, name: str) -> Any:
        """A panel by the name tests know it by, else a part of the shell, its stage, its places or the
        window.
        """
        if name in PANELS:
            return self.shell.panel(PANELS[name])
        for holder in (self.shell, self.shell.stage, self.shell.places, self.window):
            if hasattr(holder, name):
                return getattr(holder, name)
        raise AttributeError(name)

    def do(self, command: str) -> None:
        """Choose a command as from its menu."""
        self.shell.actions.refresh()
        action = self.shell.actions[command]
        assert action.isEnabled(), f"{command} cannot be chosen now"
        action.trigger()
