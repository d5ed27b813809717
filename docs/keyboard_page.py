"""Write the page of shortcuts from the window's commands: `xvfb-run python docs/keyboard_page.py`."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))
PAGE = ROOT / "docs" / "animators" / "keyboard.md"
HEAD = """# Keyboard shortcuts

After this page you can work without the mouse.

*Help > Keyboard shortcuts* (Shift+F1) lists the same in the window. Ctrl+Shift+P finds any command by typing.
A key that two places use belongs to the place that has the focus.
"""


def page(actions: Any) -> str:
    """Return the page. actions: a window's."""
    from app.features.help.help_commands import LANES, TIMELINE

    rows: dict[str, list[tuple[str, str]]] = {}
    for command in actions.commands:
        keys = ", ".join(key.toString() for key in actions[command.id].shortcuts())
        if keys:
            changes = command.id.startswith(("undo", "redo", "stance_", "workspace_"))  # its words
            words = command.id.replace("_", " ").capitalize() if changes else command.plain
            rows.setdefault(command.menu.replace("&", ""), []).append((words, keys))
    parts = [HEAD, *(table(f"Menu {menu}", found) for menu, found in rows.items())]
    return "\n".join([*parts, table("On the timeline", TIMELINE), table("In a conversation's lanes", LANES)])


def table(title: str, rows: Iterable[tuple[str, str]]) -> str:
    """Return a section with a table of commands and keys."""
    lines = "".join(f"| {' '.join(words.split())} | {keys} |\n" for words, keys in rows)
    return f"## {title}\n\n| Command | Keys |\n|---|---|\n{lines}"


if __name__ == "__main__":
    from app.main import make_window, prepare_application

    prepare_application()
    PAGE.write_text(page(make_window().shell.actions), encoding="utf-8")
