"""What a studio's file says about commands: their shortcuts, and which are not shown."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from PySide6.QtCore import QSettings
from PySide6.QtGui import QKeySequence

from metagraph.common.studio import get_studio, use_studio
from metagraph.common.wording import phrase

SHOW_ALL = "studio/show all"


def is_all_shown(settings: QSettings) -> bool:
    """Return whether the user wants to see what the studio hides."""
    return str(settings.value(SHOW_ALL, "false")) == "true"


def is_anything_hidden() -> bool:
    """Return whether the studio hides features or commands."""
    studio = get_studio()
    return bool(studio.hidden_features or studio.hidden_commands)


def find_studio_shortcuts(usual: Mapping[str, Collection[str]]) -> dict[str, tuple[str, ...]]:
    """Return the shortcuts of the commands that the studio changes, () for none. usual: the shortcuts
    of each command, as portable text. What cannot be is a problem of the studio's file.
    """
    studio, out = get_studio(), dict[str, tuple[str, ...]]()
    for name, words in studio.shortcuts.items():
        where = f"shortcuts/{name}"
        if name not in usual:
            cause = phrase("there is no command '{name}'", name=name)
            remedy = phrase("The page about studios lists the names.")
            studio = studio.with_problem(where, cause, remedy)
            continue
        keys = QKeySequence(words).toString()
        if words and (not keys or any(not key.strip() for key in keys.split(","))):
            cause = phrase("'{keys}' is not a shortcut", keys=words)
            studio = studio.with_problem(where, cause, phrase("Write it as Ctrl+Shift+E."))
            continue
        others = [
            other
            for other, taken in usual.items()
            if other != name
            and keys
            and keys in out.get(other, tuple(taken))
            and other not in studio.shortcuts
        ]
        others += [other for other, taken in out.items() if keys and keys in taken]
        if others:
            cause = phrase("{keys} belongs to '{other}'", keys=keys, other=others[0])
            remedy = phrase("Give '{other}' another shortcut, too.", other=others[0])
            studio = studio.with_problem(where, cause, remedy)
            continue
        out[name] = (keys,) if keys else ()
    use_studio(studio)
    return out


def find_hidden_commands(known: Collection[str], settings: QSettings) -> frozenset[str]:
    """Return the commands that are not shown; unknown ones are problems of the studio's file."""
    studio = get_studio()
    for name in studio.hidden_commands:
        if name not in known:
            cause = phrase("there is no command '{name}'", name=name)
            remedy = phrase("The page about studios lists the names.")
            studio = studio.with_problem(f"hide/commands/{name}", cause, remedy)
    use_studio(studio)
    return frozenset() if is_all_shown(settings) else frozenset(studio.hidden_commands)
