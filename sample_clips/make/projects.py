"""The sample projects: a finished one, one whose clips wait to be labelled, and one of somebody who sits.
`python -m sample_clips.make.projects`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import cast

import msgspec

from metagraph.formats.conversations.files import read_conversation
from metagraph.formats.gltf.reader import read_character
from metagraph.formats.imports import import_files
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph import edits
from metagraph.graph import requests as a
from metagraph.graph.conversation.model import Conversation
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import LAYERS, Kind, Layer, Limb, Project, Timing
from metagraph.speech.automatic_cuts import keep_filmed_conversation
from metagraph.suggest.find_contacts import with_contacts, with_measured_body
from sample_clips.make.babble import sample_lines
from sample_clips.make.catalogue import BASE, RECIPES, SEATED, Entry, catalogue
from sample_clips.make.numbered_ids import numbered_ids

HERE = Path(__file__).resolve().parents[1]
STARTS = {"body": "weight both", "arms": "hands at sides", "head": "straight"}
SITS = {**STARTS, "body": "sitting", "arms": "on lap"}


# What goes with a line, seconds from its start.
WITH_LINES: dict[str, tuple[a.AnyRequest, ...]] = {
    "hello": (a.Gesture(tags=("greeting",), at=0.0, priority=2), a.Nod(at=0.9)),
    "happy": (a.Gesture(tags=("positive",), stroke=0.85, priority=2),),
    "maybe": (a.Gesture(tags=("unsure",), stroke=0.9, priority=2), a.Shake(at=0.2)),
    "you_first": (a.Gesture(tags=("refuse",), at=0.0, priority=2), a.Shake(at=0.1)),
}
GREETING = a.Performance(
    name="greeting",
    length=24.0,
    asks=(
        a.Look(to="user", at=0.0, strict=True, duration=4.0),
        a.Say(line="hello", at=1.0),
        a.Say(line="happy", at=4.2),
        a.Behave(mode="listening", at=6.4),
        a.Go(stance="on hips", at=7.5),
        a.Nod(at=9.0, tags=("agree",)),
        a.Look(to=(1.2, 1.3, 1.5), at=11.0, duration=1.6),
        a.Go(stance="hands at sides", at=13.0),
        a.Behave(mode=None, at=13.5),
        a.Say(line="maybe", at=15.0),
        a.Say(line="you_first", at=19.0),
    ),
)


@numbered_ids()
def practice() -> Project:
    """Return a project of all clips, none of them placed; its base pose is chosen, since practice is about
    dropping.
    """
    return _imported("practice", [HERE / "clips"])


def _imported(name: str, paths: Sequence[Path]) -> Project:
    empty = Project(name=name)
    imported = import_files(empty, HERE, paths)
    if imported.failures:
        raise RuntimeError("\n".join(imported.failures))
    project = imported.into(empty)
    base = next(c.id for c in project.clips.values() if c.name == BASE[0])
    project = edits.set_base(project, base, BASE[1])
    return edits.set_character(project, "mannequin.glb")


@numbered_ids()
def sample() -> Project:
    """Return the finished project: every clip of the catalogue placed with its timing, tags and likelihood,
    and a few lines to say.
    """
    project = performance_edits.add_performance(
        _finished("sample", practice(), catalogue(), STARTS), GREETING
    )[0]
    return keep_filmed_conversation(project, conversation())[0]


@numbered_ids()
def seated() -> Project:
    """Return the project of somebody who sits on a stool, and gets up when asked."""
    kept = {
        "body": {"sitting", "sitting_forward", "weight_both"},
        "arms": {"on_lap", "hands_folded", "hands_at_sides", "arms_crossed", "hand_to_chin"},
        "head": {"head_straight", "head_tilt_left", "head_tilt_right"},
    }
    # From the sides hands go to the lap first: any other way leads through the thighs.
    entries = [
        e
        for e in catalogue((*RECIPES, *SEATED))
        if {e.stance, e.end_stance} <= kept[e.layer]
        and (e.kind != "transition" or "hands_at_sides" not in (e.stance, e.end_stance) or "on_lap" in e.name)
    ]
    files = [HERE / ("seated" if e.name in {r.name for r in SEATED} else "clips") / e.file for e in entries]
    project = _finished("seated", _imported("seated", files), entries, SITS)
    # Again and again, so that nobody gets up without another way to sit.
    again = {
        a.id: {"spacing": 0}
        for a in project.graphs["body"].actions.values()
        if a.name == "to sitting forward"
    }
    # What leans forwards turns the arms back, so that they hang.
    project = edits.set_weight(edits.update_each(project, again), "body", "arms", 1.0)
    return edits.set_character(project, "ben.glb")


def _finished(name: str, project: Project, entries: Sequence[Entry], starts: Mapping[str, str]) -> Project:
    """Return a project of placed clips with lines to say. starts: each layer's first stance."""
    project = edits.set_character(edits.rename_project(project, name), "ada.glb")
    clips = {c.name: c.id for c in project.clips.values()}
    ids: dict[tuple[str, str], str] = {}
    for layer in LAYERS:
        loops = [e for e in entries if e.layer == layer and e.kind == "stance"]
        names = sorted(dict.fromkeys(_words(e.stance) for e in loops), key=lambda n: (n != starts[layer], 0))
        for name in names:
            project = edits.add_stance(project, layer, name)
            ids[(layer, name)] = list(project.graphs[layer].stances)[-1]
    for entry in sorted(entries, key=lambda e: ("stance", "gesture", "fidget", "transition").index(e.kind)):
        project = _place(project, entry, clips[entry.name], ids)
    project = with_measured_body(project, read_character(HERE / "mannequin.glb"))
    project = with_contacts(project, list(project.graphs["arms"].actions))
    project = replace(project, touch=msgspec.structs.replace(project.touch, guard=True))
    lines = {
        name: msgspec.structs.replace(line, asks=WITH_LINES.get(name, ()))
        for name, line in sample_lines().items()
    }
    return replace(project, lines=lines)


def conversation() -> Conversation:
    """Return the sample conversation as it is read from its sound and words (see `make.talk`)."""
    folder = HERE / "conversation"
    read = read_conversation([folder / "talk.ogg"], [folder / "talk.json"], HERE, "Office").conversation
    sides = tuple(
        msgspec.structs.replace(side, name=name, character=body)
        for side, name, body in zip(read.sides, ("Ben", "Ada"), ("ben.glb", None), strict=True)
    )
    return msgspec.structs.replace(read, sides=sides)


def _words(name: str) -> str:
    return name.replace("_", " ")


def _place(project: Project, entry: Entry, clip: str, ids: dict[tuple[str, str], str]) -> Project:
    layer, kind = cast(Layer, entry.layer), cast(Kind, entry.kind)
    stance = ids[(entry.layer, _words(entry.stance))]
    end = ids[(entry.layer, _words(entry.end_stance))] if entry.kind == "transition" else None
    before = set(project.graphs[layer].actions)
    project = edits.place_clips(project, [clip], layer, kind, stance, end)
    made = next(i for i in project.graphs[layer].actions if i not in before)
    length = project.clips[clip].duration
    if kind == "stance":
        timing = Timing(loop=True, blend_in=0.0, blend_out=0.0)
    else:
        last = None if entry.end >= length - 1e-3 else round(entry.end, 3)
        timing = Timing(round(entry.start, 3), last, entry.blend_in, entry.blend_out)
    name = f"to {_words(entry.end_stance)}" if kind == "transition" else entry.name.split("__", 1)[-1]
    return edits.update_actions(
        project,
        [made],
        name=_words(entry.stance) if kind == "stance" else name,
        timing=timing,
        limb=cast(Limb, entry.limb),
        tags=tuple(entry.tags),
        likelihood=entry.likelihood,
    )


def main() -> None:
    for name, project in (("practice", practice()), ("sample", sample()), ("seated", seated())):
        path = HERE / f"{name}{SUFFIX}"
        save_project(project, path, path)
        print(path.name, f"{path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
