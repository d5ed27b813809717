"""Define a feature's commands as a static table, and the conditions that enable them.

A table is a tuple of `Command`s whose functions take the feature and whose texts are marked by `tr_noop`.
`bind_commands` makes the commands of one window from it. Named conditions enable commands; `require_all`,
`require_any` and `require_not` combine them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import Any

from app.shell.actions import Command
from app.shell.context import Shell
from app.translation import tr

Condition = Callable[[Any], bool]


class Feature:
    """What a feature knows and does in one window: its commands are methods, its state attributes."""

    def __init__(self, shell: Shell) -> None:
        self.shell, self.document = shell, shell.document
        self.session, self.performance = shell.stage.session, shell.stage.performance


def bind_commands(table: Iterable[Command], feature: Feature) -> tuple[Command, ...]:
    """Return a table's commands in the window's language, with their functions bound to the feature."""
    return tuple(_bound(command, feature) for command in table)


def _bound(command: Command, feature: Feature) -> Command:
    of_feature: dict[str, Any] = {
        name: partial(function, feature)
        for name in ("run", "enabled", "checked", "visible", "fill")
        if (function := getattr(command, name)) is not None
    }
    text = partial(command.text, feature) if callable(command.text) else tr(command.text)
    return replace(command, text=text, tip=tr(command.tip) if command.tip else "", **of_feature)


def require_all(*conditions: Condition) -> Condition:
    """Return the condition that all conditions are met."""
    return lambda feature: all(met(feature) for met in conditions)


def require_any(*conditions: Condition) -> Condition:
    """Return the condition that at least one condition is met."""
    return lambda feature: any(met(feature) for met in conditions)


def require_not(condition: Condition) -> Condition:
    """Return the condition that a condition is not met."""
    return lambda feature: not condition(feature)


def has_clips_selected(feature: Feature) -> bool:
    return bool(feature.session.selection.clips)


def has_actions_selected(feature: Feature) -> bool:
    return bool(feature.session.selection.actions)


def is_meta_graph_shown(feature: Feature) -> bool:
    return feature.session.onstage.mode == "meta"


def has_skeleton(feature: Feature) -> bool:
    return feature.document.project.skeleton is not None


def has_character(feature: Feature) -> bool:
    return feature.document.project.character is not None


def is_conversation_staged(feature: Feature) -> bool:
    return feature.session.onstage.conversation is not None
