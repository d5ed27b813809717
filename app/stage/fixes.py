"""Define what fixes a problem with one press: other times, another end, another clip, or bridges by
blending.
"""

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
    """One press that fixes a problem.

    `words` are on the button. `action` is the one whose fields change, as in `edits.update_actions`, or whose
    end changes. `stance` is one that gets transitions to and from it by blending. `tip` says what will
    happen. `instead` is another fix, offered in the menu of the problem's row.
    """

    words: str
    action: str | None = None
    changes: Mapping[str, Any] = field(default_factory=dict, hash=False)
    end: str | None = None  # the stance in which a transition should end
    in_place: str | None = None  # the clip to keep in place
    scaled: str | None = None  # the clip whose actions' times are scaled to its length
    kept: str | None = None  # the clip whose actions' times are right as they are
    repeated: str | None = None  # the action to repeat
    stance: str | None = None
    tip: str = field(default_factory=partial(tr, "One step that can be undone"))
    instead: Fix | None = None

    def __call__(self, project: Project) -> Project:
        """Return the project with the fix; unchanged if what it fixes was removed in the meantime."""
        if self.stance is not None:
            from metagraph.suggest.jumps.bridges import bridge_stance

            return bridge_stance(project, self.stance)[0]
        if self.repeated is not None:
            from metagraph.suggest.jumps.soft_blends import repeat_actions

            return repeat_actions(project, [self.repeated])
        clip = self.in_place or self.scaled or self.kept
        if clip is not None:
            return self._of_clip(project, clip) if clip in project.clips else project
        if self.action is None or project.action(self.action) is None:
            return project
        if self.end is not None:
            return edits.set_ends(project, [self.action], self.end)
        return edits.update_actions(project, [self.action], **self.changes)

    def _of_clip(self, project: Project, clip: str) -> Project:
        from metagraph.graph.editing import retiming

        if self.in_place is not None:
            return retiming.keep_clips_in_place(project, [clip])
        return retiming.scale_times(project, clip) if self.scaled else retiming.keep_times(project, clip)


def fix_clips(project: Project, problems: Iterable[Problem]) -> dict[Problem, Fix]:
    """Return fixes that give actions back the clips they were made of, if those are in the project; otherwise
    fixes that keep the clips they have. Clips that travel are kept in place, and actions that are hardly seen
    repeat.
    """
    out: dict[Problem, Fix] = {}
    for problem in problems:
        action = project.action(problem.action or "")
        entry = project.clips.get(action.clip) if action is not None else None
        if entry is not None and problem.code in ("travels", "play-slide") and not entry.in_place:
            out[problem] = Fix(tr("Keep in place"), in_place=entry.id)
        if action is not None and problem.code == "other-length":
            keep = Fix(tr("Keep the times"), kept=action.clip)
            out[problem] = Fix(tr("Scale the times"), scaled=action.clip, instead=keep)
        if action is not None and problem.code == "hardly-seen" and action.timing.repeat <= 0:
            out[problem] = Fix(tr("Repeat it"), repeated=action.id)
        if action is not None and problem.code == "moment":
            phases = dict.fromkeys(("stroke", "ready", "stroke_end", "relax"))
            out[problem] = Fix(tr("Clear the stroke"), action.id, {"timing": phases})
        if action is None or problem.code != "swapped-clip":
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
    """Return the id of the clip that an action was made of; None if it is not in the project."""
    of = [e for e in project.clips.values() if e.name == action.clip_name]
    same = [e for e in of if action.clip_sha256 and e.digest.startswith(action.clip_sha256)]
    return next((e.id for e in (*same, *of)), None)


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
                out[problem] = Fix(tr(BRIDGE), stance=problem.stance, tip=words)
    return out
