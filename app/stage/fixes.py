"""What mends a problem with one press: other times, another end, another clip, or ways by blending."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from app.translation import tr, tr_noop
from metagraph.graph import edits
from metagraph.graph.model import Action, Project
from metagraph.graph.problem import Problem

BRIDGE = tr_noop("Bridge by blending")


@dataclass(frozen=True)
class Fix:
    """One press that mends a problem. words: on the button. action: whose fields change, as
    `edits.update_actions` takes them, or whose end. stance: that is led to and from by blending. tip: what
    comes of it. instead: another way, offered in the menu of the problem's row.
    """

    words: str
    action: str | None = None
    changes: Mapping[str, Any] = field(default_factory=dict, hash=False)
    end: str | None = None  # the stance a transition should end in
    stance: str | None = None
    tip: str = field(default_factory=partial(tr, "One step that can be undone"))
    instead: Fix | None = None

    def __call__(self, project: Project) -> Project:
        """Return the project mended; as it is where what was to be mended went meanwhile."""
        if self.stance is not None:
            from metagraph.suggest.jumps.bridges import bridge_stance

            return bridge_stance(project, self.stance)[0]
        if self.action is None or project.action(self.action) is None:
            return project
        if self.end is not None:
            return edits.set_ends(project, [self.action], self.end)
        return edits.update_actions(project, [self.action], **self.changes)


def fix_clips(project: Project, problems: Iterable[Problem]) -> dict[Problem, Fix]:
    """Return what gives actions back the clips they were made of, where those are in the project; else what
    keeps the clips they have.
    """
    out: dict[Problem, Fix] = {}
    for problem in problems:
        action = project.action(problem.action or "") if problem.code == "swapped-clip" else None
        if action is None:
            continue
        keep = Fix(
            tr("Keep '{clip}'", clip=project.clips[action.clip].name), action.id, {"clip": action.clip}
        )
        made_of = find_original_clip(project, action)
        if made_of is None:
            out[problem] = keep
            continue
        words = tr("Play '{clip}'", clip=project.clips[made_of].name)
        out[problem] = Fix(words, action.id, {"clip": made_of}, instead=keep)
    return out


def find_original_clip(project: Project, action: Action) -> str | None:
    """Return the id of the clip that an action says it was made of; None where that is not in the project."""
    of = [e for e in project.clips.values() if e.name == action.clip_name]
    same = [e for e in of if action.clip_sha256 and e.digest.startswith(action.clip_sha256)]
    return next((e.id for e in (*same, *of)), None)


def fix_unreachable(project: Project, problems: Iterable[Problem]) -> dict[Problem, Fix]:
    """Return what joins stances that cannot be reached or left to the others by blending."""
    from metagraph.suggest.jumps import bridges

    out: dict[Problem, Fix] = {}
    for problem in problems:
        if problem.code in ("unreachable", "dead-end") and problem.stance is not None:
            after, made = bridges.bridge_stance(project, problem.stance)
            if made:
                tip = "; ".join(bridges.describe_bridges(after, made))
                words = tr("{what}. You can undo this in one step.", what=tip[:1].upper() + tip[1:])
                out[problem] = Fix(tr(BRIDGE), stance=problem.stance, tip=words)
    return out
