# SPDX-License-Identifier: GPL-3.0-or-later
"""What an action is said to be: read from an export's JSON, compared, and written as a file of labels. Needs
nothing of Blender.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

LAYERS = ("body", "arms", "head")
KINDS = ("stance", "gesture", "fidget", "transition")
LIMBS = ("both", "left", "right")
TEXTS = ("name", "kind", "layer", "stance", "end_stance", "limb")
NUMBERS = ("likelihood", "cooldown", "start", "blend_in", "blend_out", "repeat")  # >= 0
MAYBE = ("end", "earliest_exit", "stroke", "ready", "stroke_end", "relax")  # None: found, or none
ROWS = 1  # the format's number

Label = dict[str, Any]


def read_export(path: str | Path) -> dict[str, Any]:
    """Return an export's JSON. Raises ValueError."""
    try:
        document = json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ValueError(f"{Path(path).name} cannot be read: {error}") from None
    needed = {"metagraph", "glb", "joints", "clips", "layers", "order"}
    if not isinstance(document, dict) or not needed <= document.keys():
        raise ValueError(f"{Path(path).name} is no export of Metagraph: choose the JSON beside the GLB")
    return document


def labels_of(document: Mapping[str, Any]) -> list[Label]:
    """Return what an export says of its actions, in its order: the fields named above, `action` (its id),
    `clip` (its clip's name), `tags`, `joints` and `loop`.
    """
    clips = {clip["id"]: clip["name"] for clip in document["clips"]}
    out = []
    for layer in document["order"]:
        own = document["layers"][layer]
        called = {stance["id"]: stance["name"] for stance in own["stances"]}
        for action in own["actions"]:
            ready, stroke_end, relax = (*action.get("own_phases", ()), None, None, None)[:3]
            out.append(
                {
                    "action": action["id"],
                    "clip": clips.get(action["clip"], ""),
                    "layer": layer,
                    "stance": called[action["stance"]],
                    "end_stance": called.get(action["end_stance"], ""),
                    **{key: action[key] for key in ("name", "kind", "limb", "loop", "likelihood")},
                    **{key: action.get(key, 0.0) for key in ("cooldown", "repeat")},
                    "tags": list(action["tags"]),
                    "joints": list(action["joints"]),
                    **{key: action[key] for key in ("start", "blend_in", "blend_out")},
                    "end": None if action["whole_end"] else action["end"],
                    **{key: action[key] for key in ("earliest_exit", "stroke")},
                    "ready": ready,
                    "stroke_end": stroke_end,
                    "relax": relax,
                }
            )
    return out


def stances_of(document: Mapping[str, Any]) -> dict[str, list[str]]:
    """Return the names of each layer's stances."""
    return {
        layer: [stance["name"] for stance in document["layers"][layer]["stances"]]
        for layer in document["order"]
    }


def same(a: Any, b: Any) -> bool:
    """Say whether two values are the same as far as Blender's single precision keeps them."""
    if isinstance(a, bool) or isinstance(b, bool):
        return bool(a) == bool(b)
    if isinstance(a, (int, float)) and isinstance(b, (int, float)):
        return abs(a - b) <= 1e-5 * max(1.0, abs(a), abs(b))
    return bool(a == b)


def changed(before: Mapping[str, Any], after: Mapping[str, Any]) -> Label:
    """Return the fields of a label that are different now."""
    fields = (*TEXTS, *NUMBERS, *MAYBE, "tags", "loop")
    return {key: after[key] for key in fields if key in after and not same(before.get(key), after[key])}


def faults(label: Mapping[str, Any], seconds: float) -> list[str]:
    """Return why a label would not be taken, in words. seconds: how long its clip is."""
    out = []
    if not str(label.get("name") or "").strip():
        out.append("it has no name")
    if not str(label.get("stance") or "").strip():
        out.append("say which stance it is of")
    if label.get("kind") == "transition":
        if not str(label.get("end_stance") or "").strip():
            out.append("say which stance the transition ends in")
        elif label["end_stance"] == label.get("stance"):
            out.append("a transition ends in another stance")
    if not label.get("likelihood", 1) > 0:
        out.append("its likelihood must be more than 0")
    start, end = label.get("start", 0.0), label.get("end")
    stop = seconds if end is None else end
    if start >= stop:
        out.append("it ends before it begins")
    stroke = label.get("stroke")
    if stroke is not None and not start <= stroke <= stop:
        out.append(f"its stroke is outside {start:.2f} to {stop:.2f} s")
    if stop > seconds + 1e-3:
        out.append(f"it ends after its clip, which is {seconds:.2f} s long")
    return out


def row_of(clip: str, before: Mapping[str, Any] | None, after: Mapping[str, Any]) -> Label:
    """Return the row that tells of an action: what changed of one that was imported, all of a new one. clip:
    the name of the clip that it plays.
    """
    if before is not None:
        row = {"clip": clip, "action": before["action"], **changed(before, after)}
    else:
        row = {"clip": clip, **changed({}, after)}
    if not row.get("end_stance", True):
        del row["end_stance"]
    return row


def label_file(rows: Iterable[Mapping[str, Any]]) -> str:
    """Return the file's text."""
    return json.dumps({"labels": ROWS, "actions": list(rows)}, indent=1, ensure_ascii=False) + "\n"


def split_tags(text: str) -> list[str]:
    """Return the tags of a text with commas between them, each once."""
    return list(dict.fromkeys(tag.strip() for tag in text.split(",") if tag.strip()))


def free_path(folder: Path, stem: str, endings: Iterable[str]) -> Path:
    """Return a path without ending for which no file of the endings is there: clips that a project already
    plays are never written over.
    """
    endings, number = tuple(endings), 1
    while True:
        path = folder / (stem if number == 1 else f"{stem}_{number}")
        if not any(path.with_name(path.name + ending).exists() for ending in endings):
            return path
        number += 1
