"""`metagraph annotate`: learn from an annotation, or perform it, without a window."""

from __future__ import annotations

import json
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from app.cli.kept_options import check_kept_name
from app.cli.outputs import ProjectOutput
from app.project.annotation_reading import (
    AnnotationReading,
    apply_reading,
    begin_reading,
    count_replayed,
    describe_doubts,
)
from app.project.opening import open_whole
from metagraph.errors import FileError
from metagraph.formats.elan import read_elan
from metagraph.graph.model import LAYERS, Layer
from metagraph.playback.learning.annotation import (
    IGNORE,
    MEANINGS,
    ROLES,
    SPEECH,
    Annotation,
    is_meaning,
    label_of,
)
from metagraph.playback.learning.compare import compare_model
from metagraph.playback.learning.learn import Act, describe_state, learn_model, list_model_states


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("annotation", type=Path, help="an .eaf file")
    parser.add_argument(
        "--tier",
        action="append",
        default=[],
        metavar="NAME=ROLE",
        help="set the role of a tier: left arm, right arm, arms, head action, head stance, body, "
        "speech, partner's speech, ignore",
    )
    parser.add_argument(
        "--label",
        action="append",
        default=[],
        metavar="LABEL=MEANING",
        help='set the meaning of a label: gesture, fidget, transition, ignore ..., then tags ("gesture '
        'positive")',
    )
    parser.add_argument(
        "--annotator",
        metavar="NAME",
        help="if several annotators marked the same, read this one's tiers (default: the one with most "
        "annotations)",
    )
    meaning = parser.add_mutually_exclusive_group()
    meaning.add_argument(
        "--states", action="store_true", help="model positive and negative gestures as separate states"
    )
    meaning.add_argument(
        "--shares",
        action="store_true",
        help="model positive and negative gestures as shares of all gestures (the default)",
    )
    parser.add_argument(
        "--smoothing",
        type=float,
        default=0.0,
        help="number to add to every count (default: 0, as in the paper)",
    )
    parser.add_argument(
        "--learn",
        action="store_true",
        help="learn the models of all annotated layers, and save them in the project",
    )
    parser.add_argument(
        "--perform",
        metavar="NAME",
        type=check_kept_name,
        help="save the annotated actions as a performance of the project",
    )


def run(options: Namespace) -> int:
    """Print how an annotation is read. With `learn` or `perform`, change the project and save it."""
    path: Path = options.project
    if not options.learn and options.perform is None:
        return _annotated(options, None)
    with ProjectOutput(path) as output:
        return _annotated(options, output)


def _annotated(options: Namespace, output: ProjectOutput | None) -> int:
    """output: the path at which the project is saved, or None."""
    path: Path = options.project
    opened = open_whole(path)
    project = opened.project
    reading = _reading(read_elan(options.annotation), options, project.tiers, project.labels)
    if options.smoothing < 0:
        raise ValueError("--smoothing must be 0 or more")
    doubts = describe_doubts(reading)
    if not any(reading.observed.values()) and (options.learn or options.perform is not None):
        tiers = ", ".join(repr(t.name) for t in reading.annotation.tiers[:12]) or "none"
        raise FileError(
            options.annotation, f"no tier is read as an action; the tiers are {tiers}", "in its tiers",
            f"Set their roles: --tier \"NAME=left arm\" (or {', '.join(list(ROLES)[1:])}).",
        )  # fmt: skip
    made = apply_reading(
        project, reading, LAYERS if options.learn else (), options.states, options.perform, options.smoothing
    )
    saved = output is not None and (bool(made.learned) or made.performance is not None)
    if saved and output is not None:
        output.save(made.project)
    models = {layer: _layer(layer, acts, options) for layer, acts in reading.observed.items() if acts}
    notes = [*opened.notes, *doubts]
    data = {
        "annotation": str(options.annotation),
        "seconds": round(reading.annotation.end, 3),
        "tiers": dict(reading.roles),
        "labels": [
            {"layer": x.layer, "label": x.text, "count": x.count, "meaning": x.meaning}
            for x in reading.labels
        ],
        "layers": models,
        "learned": list(made.learned),
        "performance": made.performance,
        "replayed": count_replayed(made.project, made.performance) if made.performance is not None else {},
        "saved": saved,
        "notes": notes,
    }
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
    print(json.dumps(data) if options.json else "\n".join(_lines(data, reading, path)))
    return 0 if models else 3


def _reading(
    annotation: Annotation, options: Namespace, tiers: Mapping[str, str], labels: Mapping[str, str]
) -> AnnotationReading:
    names = [tier.name for tier in annotation.tiers]
    roles = _said(options.tier, "--tier", "LH=left arm", names)
    for role in roles.values():
        if role not in (*ROLES, *SPEECH, IGNORE):
            raise ValueError(
                f"the role of a tier is one of {', '.join((*ROLES, *SPEECH, IGNORE))}, not '{role}'"
            )
    found = begin_reading(annotation, roles, tiers, labels=(labels,))
    if options.annotator is not None and options.annotator not in found.annotators[:1]:
        if options.annotator not in found.annotators:
            there = ", ".join(repr(x) for x in found.annotators) or "no two annotators of the same"
            raise ValueError(
                f"--annotator: '{options.annotator}' annotated nothing that is read; there are {there}"
            )
        found = found.with_annotator(options.annotator)
    here = [x for label in found.labels for x in (label.text, label.key)]
    said = _said(options.label, "--label", "nod=gesture positive", here, label_of)
    for meaning in said.values():
        if not is_meaning(meaning):
            raise ValueError(
                f"the meaning of a label is one of {', '.join(MEANINGS)}, with tags after it, not '{meaning}'"
            )
    return AnnotationReading(annotation, found.roles, said, found.memory)


def _said(
    given: Iterable[str], option: str, example: str, known: list[str], spelled: Any = str
) -> dict[str, str]:
    """Return NAME=WORDS options as a mapping. Raises ValueError for an unknown name."""
    out = {}
    for text in given:
        name, equals, words = text.rpartition("=")
        name, words = spelled(name.strip()), " ".join(words.casefold().split())
        if not equals or not words:
            raise ValueError(f"{option} is given as \"{example}\", not '{text}'")
        if name not in known:
            near = get_close_matches(name, known, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"there are {', '.join(known[:12]) or 'none'}"
            raise ValueError(f"{option}: there is no '{name}' in the annotation; {hint}")
        out[name] = words
    return out


def _layer(layer: Layer, acts: tuple[Act, ...], options: Namespace) -> dict[str, Any]:
    """Return a layer's model and how often it makes what was seen."""
    model = learn_model(layer, [acts], options.states, options.smoothing)
    found = compare_model(model, [acts])
    assert found.observed is not None
    return {
        "actions": len(acts),
        "per_minute": round(found.observed.rate, 2),
        "states": [describe_state(state, layer) for state in list_model_states(model)],
        "matrix": [[round(p, 4) for p in row] for row in model.matrix],
        "lengths": [list(pair) for pair in model.lengths],
        "gap": model.gap,
        "positive": model.positive,
        "negative": model.negative,
        "seen": [round(float(x), 4) for x in found.observed.shares()],
        "made": [round(float(x), 4) for x in found.generated.shares()],
        "chance": [round(float(x), 4) for x in found.deviation],
    }


def _lines(data: Mapping[str, Any], reading: AnnotationReading, path: Path) -> Iterable[str]:
    yield f"{data['annotation']}: {data['seconds']:g} s, {len(data['tiers'])} tiers"
    for tier in reading.annotation.tiers:
        yield f"  {tier.name:24} {len(tier.intervals):5}  {reading.roles[tier.name]}"
    for label in data["labels"][:30]:
        yield f"  {label['layer']:5} {label['label']:24} {label['count']:4} x  {label['meaning']}"
    if len(data["labels"]) > 30:
        yield f"  and {len(data['labels']) - 30} rarer labels"
    for layer, found in data["layers"].items():
        often, rest = found["per_minute"], found["gap"]
        yield f"{layer}: {found['actions']} actions, {often:g} a minute, {rest:g} s of rest on average"
        for n, state in enumerate(found["states"]):
            row = "".join(f"{100 * p:5.0f}" if p else "    ." for p in found["matrix"][n])
            often = f"seen {found['seen'][n]:4.0%}, made {found['made'][n]:4.0%}"
            mean, deviation = found["lengths"][n][:2]
            yield f"  {state:26}{row}   {often}   {mean:.1f} s, deviation {deviation:.1f}"
    if data["learned"]:
        yield f"learned: {', '.join(data['learned'])}"
    if data["performance"]:
        yield f"saved as performance {data['performance']}"
        for layer, n in data["replayed"].items():
            other = (
                f", {n['other_limb']} of them with another limb than in the annotation"
                if n["other_limb"]
                else ""
            )
            yield f"  {layer}: {n['played']} of {n['asked']} acts play{other}"
    yield (
        f"saved {path}"
        if data["saved"]
        else "nothing was saved: add --learn to learn models, or --perform NAME to save a performance"
    )
