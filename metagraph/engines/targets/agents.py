"""For agents of other systems: BML blocks, a gesture map for SmartBody, a gesture.json as Amazon's Sumerian
Hosts read it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import msgspec

from metagraph.common.file_names import make_file_stems
from metagraph.common.wording import phrase, plural_phrase
from metagraph.common.xml_text import describe_replaced
from metagraph.engines.engine_machine import (
    EngineState,
    Machine,
    list_machines,
    make_animations,
    write_machine_glb,
)
from metagraph.engines.engine_names import name_files, write_word
from metagraph.engines.targets.losses import MACHINE, PROPS
from metagraph.engines.targets.meshes import find_ordered_mesh
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.errors import describe_error
from metagraph.formats.atomic import write_atomically
from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.repeating import cycle_of
from metagraph.graph.requests import RequestError
from metagraph.playback.bml.writer import write_bml
from metagraph.playback.timing.phases import find_phases

# --- BML


def list_blocks(project: Project) -> Iterator[tuple[str, tuple[a.AnyRequest, ...]]]:
    """Yield a name and the asks of each block: the kept performances, then the lines."""
    for performance in project.performances.values():
        yield performance.name, tuple(x for x in performance.asks if not isinstance(x, a.Bml))
    for ident, line in project.lines.items():
        said = a.Say(id="say", line=ident, at=0.0, gestures=False)
        yield f"line {ident}", (said, *(x for x in line.asks if not isinstance(x, a.Bml)))


def make_block_vocabulary(project: Project) -> dict[str, Any]:
    """Return the words blocks may use: lexemes (tags and names) by layer and stance, postures, speech."""
    gestures: dict[str, Any] = {}
    for layer in LAYERS:
        graph = project.graphs[layer]
        for action in graph.actions.values():
            if action.kind == "gesture" and action.stance in graph.stances:
                of = gestures.setdefault(layer, {}).setdefault(graph.stances[action.stance].name, [])
                of.append(
                    {
                        "lexeme": list(action.tags) or [action.name],
                        "name": action.name,
                        "mode": f"{action.limb.upper()}_HAND",
                    }
                )
    postures = {layer: [s.name for s in project.graphs[layer].stances.values()] for layer in LAYERS}
    return {
        "gestures": gestures,
        "postures": postures,
        "lines": {i: line.text for i, line in project.lines.items()},
    }


def write_blocks(order: ExportOrder) -> ExportedFiles:
    """Write a file for each block, and the vocabulary."""
    files: list[Path] = []
    notes: list[str] = []
    for name, asks in list_blocks(order.project):
        path = order.folder / f"{_file(name, files)}.bml"
        numbered = tuple(_numbered(asks))
        try:
            content = write_bml(numbered).encode()
        except RequestError as error:
            notes.append(phrase("skipped '{name}': {why}", name=name, why=describe_error(error)))
            continue
        lost = describe_replaced([msgspec.to_builtins(numbered)])
        if lost is not None:
            notes.append(phrase("{file}: {what}", file=path.name, what=lost))
        write_atomically(path, content)
        files.append(path)
    words = order.folder / f"{order.stem}.vocabulary.json"
    write_atomically(
        words, json.dumps(make_block_vocabulary(order.project), indent=1, ensure_ascii=False).encode()
    )
    none = (
        ()
        if files
        else ("no performance is kept and no line has requests of its own: there is the vocabulary alone",)
    )
    return ExportedFiles((*files, words), (*notes, *none))


def _numbered(asks: tuple[a.AnyRequest, ...]) -> Iterator[a.AnyRequest]:
    """Yield asks with ids that are unique in their block."""
    seen: set[str] = set()
    for n, ask in enumerate(asks, 1):
        ident = ask.id if ask.id and ask.id not in seen else f"b{n}"
        seen.add(ident)
        yield msgspec.structs.replace(ask, id=ident)


def _file(name: str, taken: list[Path]) -> str:
    stem = re.sub(r"[^\w-]+", "_", name).strip("_")
    return make_file_stems([*(path.stem for path in taken), stem], "block")[-1]


# --- SmartBody

HANDS = {"left": "LEFT_HAND", "right": "RIGHT_HAND", "both": "BOTH_HANDS"}


def format_gesture_map(name: str, built: tuple[Machine, ...], files: Mapping[str, str]) -> str:
    """Return a Python script for SmartBody that maps lexeme, type, hand and posture to animations, which it
    calls by their files. files: animation -> the stem of its file.
    """
    rows = [
        '"""Gestures of '
        + json.dumps(name)
        + ' for SmartBody: run it after the motions of this folder are loaded."""',
        "",
        f"gestures = scene.getGestureMapManager().createGestureMap({json.dumps(name)})",
    ]
    for machine in built:
        for state in machine.states:
            if state.action.kind == "gesture":
                lexeme, kind = _words(state)
                posture = machine.rest(state.action.stance).name
                words = (
                    files.get(state.name, state.name),
                    lexeme,
                    kind,
                    HANDS[state.action.limb],
                    "",
                    posture,
                )
                called = json.dumps(state.action.name, ensure_ascii=False)
                rows.append(
                    f"gestures.addGestureMapping({', '.join(json.dumps(w) for w in words)})  # {called}"
                )
    return "\n".join(rows) + "\n"


def _words(state: EngineState) -> tuple[str, str]:
    """Return a gesture's lexeme and type: its tags, else its name."""
    tags = [word for tag in state.action.tags if (word := write_word(tag).upper())]
    name = write_word(state.action.name) or state.action.id
    return (tags[0] if tags else name.upper()), (tags[1] if len(tags) > 1 else "")


def write_smartbody(order: ExportOrder) -> ExportedFiles:
    """Write the map, and a BVH for each animation it names and each posture."""
    from metagraph.formats.bvh.file import write_bvh

    built = list_machines(order.project)
    script = order.folder / f"{order.stem}_gestures.py"
    wanted = {s.name for m in built for s in m.states if s.action.kind in ("gesture", "stance")}
    clips = [clip for clip in make_animations(order.project, built) if clip.name in wanted]
    idents = {s.name: s.action.id for m in built for s in m.states}
    names = name_files({clip.name: idents[clip.name] for clip in clips})
    write_atomically(script, format_gesture_map(order.stem, built, names).encode())
    files = [script]
    for n, (clip, name) in enumerate(zip(clips, names.values(), strict=True)):
        order.tell(n, len(clips), clip.name)
        files.append(order.folder / "motions" / f"{name}.bvh")
        write_bvh(clip, files[-1])
    return ExportedFiles(tuple(files))


# --- Sumerian

FPS = 30.0  # frames a second that "from" and "to" count


def _held(project: Project, state: EngineState) -> tuple[float, float, float]:
    """Return from when to when a gesture's animation may be held, and how long it is, seconds."""
    action, found = state.action, find_phases(project, state.action)
    cycle = cycle_of(action.kind, action.timing, found.start, found.end)
    if cycle > 0:
        return cycle, max(cycle, state.seconds - cycle), state.seconds
    return found.stroke_end - found.start, found.relax - found.start, found.end - found.start


def make_gesture_file(project: Project, built: tuple[Machine, ...]) -> dict[str, Any]:
    """Return gesture.json: each gesture's way in, its hold, which repeats, and its way out; frames."""
    out: dict[str, Any] = {}
    for machine in built:
        for state in machine.states:
            if state.action.kind == "gesture":
                hold, relax, end = (round(x * FPS) for x in _held(project, state))
                out[state.name] = {
                    "queueOptions": [
                        {"name": "in", "from": 0, "to": hold, "loopCount": 1},
                        {"name": "hold", "from": hold, "to": relax},
                        {"name": "out", "from": relax, "to": end, "loopCount": 1},
                    ]
                }
    return out


def write_sumerian(order: ExportOrder) -> ExportedFiles:
    """Write gesture.json and the GLB with its animations."""
    built = list_machines(order.project)
    table, glb = order.folder / "gesture.json", order.folder / f"{order.stem}.glb"
    body, notes = find_ordered_mesh(order)
    notes += write_machine_glb(order.project, built, glb, body, order.contents.base)
    write_atomically(table, json.dumps(make_gesture_file(order.project, built), indent=1).encode())
    return ExportedFiles((table, glb), notes)


def _unsaid(project: Project) -> int:
    return sum(isinstance(x, a.Bml) for p in project.performances.values() for x in p.asks)


_ALONE = phrase("written according to its documentation; not tested in the system itself")
TARGETS = (
    ExportTarget(
        "bml",
        phrase("BML blocks"),
        phrase("a block for each performance and each line, and the vocabulary they use"),
        write_blocks,
        (
            Loss(
                phrase(
                    "blocks contain the requests, not the actions that play: the planner that reads a "
                    "block chooses its own actions"
                )
            ),
            Loss(phrase("blocks do not store when a request became known")),
            Loss(
                plural_phrase(
                    "{count} request that is a BML block itself is skipped",
                    "{count} requests that are BML blocks themselves are skipped",
                    0,
                ),
                _unsaid,
            ),
            PROPS,
        ),
        group=phrase("Agents"),
    ),
    ExportTarget(
        "smartbody",
        phrase("SmartBody gesture map"),
        phrase("a Python script that maps lexemes to animations, and a BVH for each"),
        write_smartbody,
        (
            *MACHINE,
            Loss(phrase("no transitions or fidgets: SmartBody moves between postures by itself")),
            Loss(phrase("a gesture has only one lexeme and one type: its first two tags")),
            PROPS,
        ),
        _ALONE,
        phrase("Agents"),
    ),
    ExportTarget(
        "sumerian",
        "Sumerian Hosts (gesture.json)",
        phrase("gesture.json with in, hold and out, and one GLB"),
        write_sumerian,
        (
            *MACHINE,
            Loss(
                phrase(
                    "stances, fidgets and transitions are only in the GLB; gesture.json cannot describe them"
                )
            ),
        ),
        _ALONE,
        phrase("Agents"),
    ),
)
