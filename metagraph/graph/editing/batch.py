"""Edits of many actions at once: names by pattern, properties pasted, clips replaced. Pure, as in `edits`."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

from metagraph.common.wording import phrase
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Action, Project, Timing

# What can be pasted from one action to many: group -> the fields it stands for; those with a dot are of its
# timing.
PROPERTIES: Mapping[str, tuple[str, ...]] = {
    "blends": ("timing.blend_in", "timing.blend_out"),
    "part": ("timing.start", "timing.end"),
    "exit": ("timing.earliest_exit",),
    "repeat": ("timing.repeat",),
    "phases": ("timing.ready", "timing.stroke", "timing.stroke_end", "timing.relax"),
    "limb": ("limb",),
    "joints": ("joints", "joint_weights"),
    "tags": ("tags",),
    "likelihood": ("likelihood",),
    "variation": ("cooldown", "spacing", "prominence"),
}
FIELDS = ("name", "clip", "kind", "layer", "stance", "end", "limb", "n")


def paste_properties(
    project: Project, source: str, targets: Collection[str], groups: Collection[str]
) -> Project:
    """Give actions the chosen properties of one. groups: of `PROPERTIES`. Times are cut to each target's
    clip.

    Raises EditError for a group that does not exist or a source that is gone.
    """
    given = project.action(source)
    if given is None:
        raise EditError(phrase("the action to copy from is no longer in the project"))
    unknown = [g for g in groups if g not in PROPERTIES]
    if unknown:
        raise EditError(
            phrase(
                "there is no setting named '{unknown}' to paste; choose from {names}",
                unknown=unknown[0],
                names=", ".join(PROPERTIES),
            )
        )
    wanted = [field for group in groups for field in PROPERTIES[group]]
    changes = {
        i: _given(project, given, action, wanted)
        for i in targets
        if i != source and (action := project.action(i)) is not None
    }
    return edits.update_each(project, changes)


def _given(project: Project, source: Action, target: Action, fields: Sequence[str]) -> dict[str, Any]:
    """Return the changes that give `target` some fields of `source`."""
    out: dict[str, Any] = {}
    times: dict[str, Any] = {}
    entry = project.clips.get(target.clip)
    length = entry.duration if entry is not None else float("inf")
    for field in fields:
        inside, dot, name = field.partition(".")
        if dot:
            value = getattr(source.timing, name)
            times[name] = (
                min(value, length)
                if isinstance(value, float) and name not in ("blend_in", "blend_out")
                else value
            )
        else:
            out[inside] = getattr(source, inside)
    if times:
        timing: Timing = replace(target.timing, **times)
        if timing.end is not None and timing.end <= timing.start:
            timing = replace(
                timing, start=target.timing.start, end=target.timing.end
            )  # nothing of it would be left
        out["timing"] = timing
    return out


def rename_by_pattern(project: Project, actions: Sequence[str], pattern: str) -> dict[str, str]:
    """Return new names from a pattern: "{stance} {name} {n:02}", with `FIELDS` in braces; n counts from 1 in
    the order given.

    Raises EditError for a field that does not exist, or a pattern that gives an empty name.
    """
    out: dict[str, str] = {}
    number = 0
    for ident in actions:
        action = project.action(ident)
        if action is None:
            continue
        number += 1
        stance, end = project.stance(action.stance), project.stance(action.end_stance)
        clip = project.clips.get(action.clip)
        words = {
            "name": action.name,
            "clip": clip.name if clip is not None else "",
            "kind": action.kind,
            "layer": action.layer,
            "stance": stance.name if stance is not None else "",
            "end": end.name if end is not None else "",
            "limb": action.limb,
        }
        try:
            name = pattern.format(n=number, **words)
        except (KeyError, IndexError, ValueError, AttributeError):
            raise EditError(
                phrase(
                    "'{pattern}' cannot be read; braces can contain {names}, as in {{name}} {{n:02}}",
                    pattern=pattern,
                    names=", ".join(FIELDS),
                )
            ) from None
        out[ident] = _named(name, pattern)
    return out


def rename_by_replacing(
    project: Project, actions: Sequence[str], find: str, put: str, regex: bool = False
) -> dict[str, str]:
    """Return new names with a text replaced wherever it stands; only of actions whose name has it. regex:
    `find` is a regular expression, and `put` may name its groups (\\1). Raises EditError for one that cannot
    be read, or names that would be empty.
    """
    if not find:
        raise EditError(phrase("enter the text to find"))
    try:
        search = re.compile(find if regex else re.escape(find))
        out = {}
        for ident in actions:
            action = project.action(ident)
            if action is not None and search.search(action.name):
                out[ident] = _named(search.sub(put if regex else put.replace("\\", r"\\"), action.name), put)
        return out
    except re.error as error:
        raise EditError(
            phrase("'{find}' is not a valid regular expression: {error}", find=find, error=error)
        ) from None


def _named(name: str, origin: str) -> str:
    clean = " ".join(name.split())
    if not clean:
        raise EditError(phrase("'{origin}' would leave a name empty", origin=origin))
    return clean


def rename_actions(project: Project, names: Mapping[str, str]) -> Project:
    """Rename actions by id."""
    return edits.update_each(project, {ident: {"name": name} for ident, name in names.items()})


def replace_clip(project: Project, actions: Collection[str], clip: str) -> Project:
    """Let actions play another clip, with all that was set; times beyond its end are cut to it.

    Raises EditError when the clip is not in the project.
    """
    entry = project.clips.get(clip)
    if entry is None:
        raise EditError(phrase("that clip is not in the project"))
    changes: dict[str, dict[str, Any]] = {}
    for ident in actions:
        action = project.action(ident)
        if action is not None and action.clip != clip:
            changes[ident] = {"clip": clip, "timing": _within(action.timing, entry.duration)}
    return edits.update_each(project, changes)


def _within(timing: Timing, length: float) -> Timing:
    """Return timing cut to a clip of some length; a part of which nothing would be left becomes the whole
    clip.
    """

    def cut(value: float | None) -> float | None:
        return None if value is None else min(value, length)

    start, end = min(timing.start, length), cut(timing.end)
    if start >= (length if end is None else end):
        start, end = 0.0, None
    return replace(
        timing,
        start=start,
        end=end,
        earliest_exit=cut(timing.earliest_exit),
        stroke=cut(timing.stroke),
        ready=cut(timing.ready),
        stroke_end=cut(timing.stroke_end),
        relax=cut(timing.relax),
    )
