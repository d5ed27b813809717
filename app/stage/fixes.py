"""Define what fixes a problem with one press: other times, another end or stance, another clip, or bridges by
blending. `app.stage.remedies` finds which one fits a problem.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from app.translation import tr, tr_noop
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.graph.problem import Problem

BRIDGE = tr_noop("Bridge by blending")


@dataclass(frozen=True)
class Fix:
    """One press that fixes a problem.

    `words` are on the button. `action` is the one whose fields change, as in `edits.update_actions`. `does`
    is another edit, called with the project and `args`. `tip` says what will happen. `instead` is another
    fix, offered in the menu of the problem's row. `alone`: the fix takes something away or writes files, so
    that it is not one of those that are done together. `command`: instead of an edit, a command of the
    window, for these `actions`.
    """

    words: str
    action: str | None = None
    changes: Mapping[str, Any] = field(default_factory=dict, hash=False)
    does: Callable[..., Project] | None = None
    args: tuple[Any, ...] = ()
    tip: str = field(default_factory=lambda: tr("One step that can be undone"))
    instead: Fix | None = None
    alone: bool = False
    command: str = ""
    actions: tuple[str, ...] = ()

    def __call__(self, project: Project) -> Project:
        """Return the project with the fix; unchanged if what it fixes was removed in the meantime."""
        if self.action is not None and project.action(self.action) is None:
            return project
        if self.does is not None:
            return self.does(project, *self.args)
        return edits.update_actions(project, [self.action], **self.changes) if self.action else project


def fix_unreachable(project: Project, problems: Iterable[Problem]) -> dict[Problem, Fix]:
    """Return fixes that connect stances that cannot be reached or left to the others by blending."""
    from metagraph.suggest.jumps import bridges

    out: dict[Problem, Fix] = {}
    for problem in problems:
        if problem.code in ("unreachable", "dead-end") and problem.stance is not None:
            after, made = bridges.bridge_stance(project, problem.stance)
            if made:
                tip = "; ".join(bridges.describe_bridges(after, made))
                words = tr("{what}. You can undo this in one step.", what=tip[:1].upper() + tip[1:])
                out[problem] = Fix(tr(BRIDGE), does=_bridge, args=(problem.stance,), tip=words)
    return out


def _bridge(project: Project, stance: str) -> Project:
    from metagraph.suggest.jumps.bridges import bridge_stance

    return bridge_stance(project, stance)[0]
