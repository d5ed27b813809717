"""The steps of a journal's edits, so that they can be undone one by one after a crash: each with the project
before and after it, which share what the step left alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from metagraph.formats.project.data import FORMAT, from_data, to_data
from metagraph.formats.project.fields import Data, DataError
from metagraph.formats.project.journal import ABOUT, KEYED
from metagraph.formats.project.replay import Replay
from metagraph.formats.recovery import Left
from metagraph.graph.model import ClipEntry, MetaGraph, Project

UNNAMED = "Recovered edit"


@dataclass(frozen=True)
class UndoStep:
    """One step to undo. text: what was done."""

    text: str
    before: Project
    after: Project


def list_undo_steps(left: Left) -> tuple[UndoStep, ...]:
    """Return the steps a journal leads through, the last to its project; without motion.

    What was undone and not done again is no step any more; if nobody knows what was undone, undoing is one
    itself. A journal whose steps cannot be distinguished is one step.
    """
    try:
        steps = _steps(left.base, left.records)
    except (DataError, KeyError, TypeError, AttributeError):
        steps = []
    if steps and to_data(steps[-1].after) == to_data(left.project):
        return tuple(steps)
    begin = from_data(left.base)
    if to_data(begin) == to_data(left.project):
        return ()
    return (UndoStep("Recovered edits", begin, left.project),)


def _steps(base: Data, records: Sequence[Data]) -> list[UndoStep]:
    replay, now = Replay(base), from_data(base)
    steps: list[UndoStep] = []
    for record in records:
        replay.apply(record)
        before, now = now, project_after(now, replay, record)
        text, how = str(record.get("step") or UNNAMED), record.get("how")
        if how == "undone" and steps and now == steps[-1].before:
            now = steps.pop().before
        elif how == "merged" and steps:
            steps[-1] = UndoStep(text, steps[-1].before, now)
        else:
            steps.append(UndoStep(f"Undo {text}" if how == "undone" else text, before, now))
    return steps


def project_after(project: Project, replay: Replay, record: Data) -> Project:
    """Return the project after a record that has been worked into `replay`; only what it names is read."""
    part: Data = {"metagraph": FORMAT}
    for key in record:
        plain = key.removesuffix("_order").removesuffix("_after")
        if key not in ("layers", "manual", "next_id", *ABOUT) and plain not in KEYED:
            part[key] = record[key]
    if clips := [c for c in record.get("clips", {}).values() if c is not None]:
        part["clips"] = clips
    touched = record.get("layers", {})
    part["layers"] = {layer: _read_anew(change, replay.layers[layer]) for layer, change in touched.items()}
    data = replay.data() if "manual" in record else {}
    if data.get("manual"):
        part["manual"] = data["manual"]
    read = from_data(part)
    values: dict[str, Any] = {k: getattr(read, k) for k in part if k not in ("metagraph", "layers", "clips")}
    if "manual" in record:
        values["manual"] = read.manual
    if "clips" in record or "clips_order" in record or "clips_after" in record:
        values["clips"] = _merged(replay.top["clips"], read.clips, project.clips)
    if touched:
        values["graphs"] = {
            layer: _layer(graph, read.graphs[layer], replay.layers[layer]) if layer in touched else graph
            for layer, graph in project.graphs.items()
        }
    return replace(project, **values)


def _read_anew(change: Data, whole: Data) -> Data:
    out: Data = {key: whole[key] for key in ("start", "weights") if key in whole}
    for key in ("stances", "actions"):
        out[key] = [item for item in change.get(key, {}).values() if item is not None]
    return out


def _layer(before: MetaGraph, read: MetaGraph, whole: Data) -> MetaGraph:
    return replace(
        read,
        stances=_merged(whole.get("stances", {}), read.stances, before.stances),
        actions=_merged(whole.get("actions", {}), read.actions, before.actions),
    )


def _merged(order: Mapping[str, Any], new: Mapping[str, Any], old: Mapping[str, Any]) -> dict[str, Any]:
    return {i: new[i] if i in new else old[i] for i in order}


# --- motion


def with_motion(
    steps: Sequence[UndoStep], bare: Project, whole: Project, load: Callable[[Project], Project]
) -> tuple[UndoStep, ...]:
    """Return the steps with the motion of their clips, the last leading to `whole`.

    bare: what the last step leads to, without motion; whole: the same, read. load: reads the clips of a
    project; asked for those that are in earlier steps alone.
    """
    read = {_source(bare.clips[i]): e for i, e in whole.clips.items() if i in bare.clips}
    lost: dict[tuple[Any, ...], tuple[Project, ClipEntry]] = {}
    for step in steps:
        for entry in step.before.clips.values():
            if _source(entry) not in read:
                lost.setdefault(_source(entry), (step.before, entry))
    while lost:
        project = next(iter(lost.values()))[0]
        here = {key: entry for key, (at, entry) in lost.items() if at is project}
        loaded = load(replace(project, clips={entry.id: entry for entry in here.values()}))
        read |= {key: loaded.clips[entry.id] for key, entry in here.items()}
        lost = {key: value for key, value in lost.items() if key not in here}
    entries: dict[int, ClipEntry] = {}
    projects: dict[int, Project] = {id(bare): whole, id(steps[-1].after): whole}

    def filled(project: Project) -> Project:
        if id(project) not in projects:
            clips = {i: entries.setdefault(id(e), _filled(e, read)) for i, e in project.clips.items()}
            same = clips.keys() == whole.clips.keys() and all(clips[i] is whole.clips[i] for i in clips)
            projects[id(project)] = replace(
                project, clips=whole.clips if same else clips, voices=whole.voices
            )
        return projects[id(project)]

    for i, entry in bare.clips.items():
        entries[id(entry)] = whole.clips[i]
    for i, entry in steps[-1].after.clips.items():
        entries[id(entry)] = whole.clips[i]
    return tuple(UndoStep(s.text, filled(s.before), filled(s.after)) for s in steps)


def _source(entry: ClipEntry) -> tuple[Any, ...]:
    stands = (entry.in_place, entry.turned, entry.moved_x, entry.moved_z)
    return entry.path, entry.take, entry.as_is, entry.brought_from, entry.retime, *stands


def _filled(entry: ClipEntry, read: Mapping[tuple[Any, ...], ClipEntry]) -> ClipEntry:
    found = read[_source(entry)]
    if found.motion is None:
        return entry
    return replace(
        entry,
        path=found.path,
        digest=found.digest,
        frames=found.frames,
        fps=found.fps,
        motion=found.motion.renamed(entry.name),
        source=found.source,
        brought_from=found.brought_from,
    )
