"""Conformance vectors: what is asked of a graph over time, and the plan and the poses that must come of it.

A runtime conforms when it makes the same plans, ids and order alike and times within `SECONDS`, and when
every joint agrees within `METRES` in the character's space and within `DEGREES` in its parent's. The cases
are scripts over whatever a project has; a project without, say, transitions has no cases of transitions.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.engines.reading import read_export
from metagraph.engines.script import make_script_cases
from metagraph.engines.script_boundaries import list_boundary_cases
from metagraph.engines.script_parameters import list_settings, run_settings
from metagraph.engines.script_parts import ScriptCase, ScriptStep
from metagraph.engines.script_rules import find_rule_answer, list_rule_rows
from metagraph.engines.script_sounds import find_heard, list_streams
from metagraph.engines.script_sympathy import find_sympathies, list_taken_moods
from metagraph.engines.script_talk import analyse_talk, list_talks
from metagraph.engines.watched_case import CaseWatch
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.offered import list_offered_requests
from metagraph.graph.requests import AnyRequest, RequestError, make_request
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.life.lane import Lane
from metagraph.playback.plan import LayerPlan, Plan, Report
from metagraph.playback.planning.choice import key32
from metagraph.playback.planning.extend_performance import drop_ended, hear_asks
from metagraph.playback.posing.rigs import get_rigs
from metagraph.playback.posing.weight import has_weight

Array = NDArray[Any]

VERSION = 1
METRES, DEGREES, SECONDS, WEIGHT = 1e-4, 0.05, 1e-6, 1e-3
NAME = "vectors.json"
HASHES: tuple[tuple[int, tuple[str, ...]], ...] = (
    (1, ("a", "b")),
    (0, ()),
    (0, ("",)),
    (0xFFFFFFFF, ("auto/arms/0", "gap")),
    (7, ("ab", "")),
    (7, ("a", "b")),
    (1, ("Größe", "日本語", "🙂")),
)


def play_case(project: Project, case: ScriptCase, watch: CaseWatch | None = None) -> Plan:
    """Return the plan a case leads to. What cannot be read is in its reports, as a runtime tells it. watch:
    what looks on.
    """
    plan = Plan(case.seed, 0.0)
    for step in case.steps:
        asks: list[AnyRequest] = []
        refused: list[Report] = []
        for ask in step.asks:
            try:
                asks.append(make_request(dict(ask)))
            except RequestError as error:
                at = step.now + project.settings.lookahead if step.now > 0 else 0.0
                refused.append(Report(ask.get("id", ""), "not-understood", str(error), "arms", at))
        plan = hear_asks(project, plan, step.now, asks, step.end, case.stances, case.idle)
        plan = replace(plan, reports=(*plan.reports, *refused))
        if watch is not None:
            watch.look(plan, step.now, [dict(ask) for ask in step.asks])
        if step.forget is not None:
            plan = drop_ended(plan, step.forget)
    if watch is not None:
        for seconds in case.watched or ():
            watch.look(plan, seconds, [])
    return plan


def list_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield all cases that suit a project."""
    yield from make_script_cases(project)
    yield from list_boundary_cases(project)


def write_vectors(export: Path, chosen: Iterable[ScriptCase] | None = None, common: bool = True) -> Path:
    """Write the vectors of an export beside its JSON; return the file. chosen: the cases, all that suit it
    when None. common: also what is the same for every character: sounds, texts, others'
    moods, single rules.

    Raises FileError when the export cannot be read or the file cannot be written.
    """
    project = read_export(export, resolved=True)
    found = [_expected(project, case) for case in (list_cases(project) if chosen is None else chosen)]
    head = {
        "vectors": VERSION,
        "export": export.name,
        "tolerance": {"metres": METRES, "degrees": DEGREES, "seconds": SECONDS, "weight": WEIGHT},
        "hashes": [[seed, list(words), key32(seed, *words)] for seed, words in HASHES],
        "described": list_offered_requests(project),
        **(
            {
                "heard": list_streams(),
                "talked": list_talks(),
                "sympathies": list_taken_moods(),
                "rules": list_rule_rows(),
            }
            if common
            else {}
        ),
        "settings": list_settings(project),
    }
    lines = ",\n".join(json.dumps(case, ensure_ascii=False, separators=(",", ":")) for case in found)
    text = json.dumps(head, ensure_ascii=False)[:-1] + f', "cases": [\n{lines}\n]}}\n'
    path = export.with_name(NAME)
    write_atomically(path, text.encode())
    return path


def _expected(project: Project, case: ScriptCase) -> dict[str, Any]:
    watch = CaseWatch() if case.watched is not None else None
    plan = play_case(project, case, watch)
    times = case.times or _telling(plan)
    answers = has_weight(project) and get_rigs(project).weight.rig is not None
    evaluator = Evaluator(plan, project)
    living = (*times, *_living(plan, answers)) if len(case.steps) + case.idle > 1 else times
    return {
        "name": case.name,
        "about": case.about,
        "seed": case.seed,
        "idle": case.idle,
        "stances": dict(case.stances),
        "steps": [{"now": s.now, "end": s.end, "asks": list(s.asks), "forget": s.forget} for s in case.steps],
        "plan": plan_data(plan),
        "life": make_life_data(plan),
        **({"watched": watch.rows} if watch is not None else {}),
        "poses": [
            pose for alive in case.alive for pose in _poses(evaluator, living if alive else times, alive)
        ],
    }


def plan_data(plan: Plan) -> dict[str, Any]:
    """Return what of a plan a runtime must agree with, as plain data."""
    layers = {layer: _layer(plan.layers[layer]) for layer in LAYERS}
    reports = [[r.request, r.outcome, r.layer, _time(r.at), r.played] for r in plan.reports]
    return {"layers": layers, "reports": sorted(reports)}


def _layer(plan: LayerPlan) -> dict[str, Any]:
    return {
        "metas": [[m.key, _time(m.start), _time(m.end), m.written] for m in plan.metas],
        "cues": [
            {
                "action": c.action.id,
                "start": _time(c.start),
                "end": _time(c.end),
                "entry": _time(c.entry),
                "blend_in": _time(c.blend_in),
                "blend_out": _time(c.blend_out),
                "stance": c.stance,
                "then": c.then,
                "meta": c.meta,
                "hold_from": _time(c.hold_from),
                "hold_to": _time(c.hold_to),
                "hold": _time(c.hold),
                **({"extent": _time(c.extent)} if c.extent != 1 else {}),
                **({"tempo": _time(c.tempo)} if c.tempo != 1 else {}),
                **({"cycle_from": _time(c.cycle_from), "cycle_to": _time(c.cycle_to)} if c.repeats else {}),
            }
            for c in plan.cues
        ],
        "rests": [
            [r.stance, r.action.id, _time(r.start), _time(r.fade_start), _time(r.fade)] for r in plan.rests
        ],
    }


LIFE_LANES = ("modes", "breaths", "aversions", "saccades", "blinks", "swells", "emphases")


def make_life_data(plan: Plan) -> dict[str, Any]:
    """Return what the life layers were drawn to do, as plain data."""
    life = plan.life
    targets = [
        [
            _time(t.start),
            t.to if isinstance(t.to, str) else list(t.to),
            _time(t.since),
            t.amount,
            t.strict,
            t.asked,
        ]
        for t in life.targets
    ]
    lanes = {name: _lane(getattr(life, name)) for name in LIFE_LANES}
    if any(list(row) != [0, 0, 1] for row in life.moods.rows):
        lanes["moods"] = _lane(life.moods)
    return {**lanes, "targets": targets}


def _lane(lane: Lane) -> list[list[float]]:
    return [[_time(start), *map(_time, values)] for start, values in zip(lane.times, lane.rows, strict=True)]


def _time(seconds: float) -> float:
    return round(float(seconds), 7)


def _poses(evaluator: Evaluator, times: Sequence[float], alive: bool) -> Iterator[dict[str, Any]]:
    """Yield what is shown at each time: all of a case at once, which takes a third of the time."""
    if not times:
        return
    at = np.array(times)
    pose = evaluator.at(at, alive)
    before = evaluator.before_life(at) if alive else None
    skeleton = evaluator.rigs.composer.ground.skeleton
    every = pose.rotations.astype(float)
    _, positions = skeleton.globals(Pose(every, pose.translations.astype(float)))
    for n, (time, rotations, place) in enumerate(
        zip(times, np.round(every, 5).tolist(), np.round(positions, 5).tolist(), strict=True)
    ):
        composed = Pose(before.rotations[n], before.translations[n]) if before is not None else None
        yield {
            "time": time,
            "alive": alive,
            "rotations": rotations,
            "positions": place,
            "morphs": {
                name: round(value, 5)
                for name, value in sorted(evaluator.morphs_at(time, alive, composed).items())
                if value > 1e-5
            },
        }


MOST = 6  # times at which a case is looked at


def _telling(plan: Plan) -> tuple[float, ...]:
    """Return times at which most can go wrong: in blends, holds and seams, between cues, before the beginning
    and after the end.
    """
    found: list[float] = []
    for of in plan.layers.values():
        for cue in of.cues:
            found += [
                cue.start + 0.4 * cue.blend_in,
                (cue.start + cue.end) / 2,
                cue.end - 0.3 * cue.blend_out,
            ]
        found += [rest.fade_start + 0.6 * rest.fade for rest in of.rests[1:]]
    found = sorted(found)
    chosen = found[:: max(1, len(found) // (MOST - 2))][: MOST - 2]
    held = [
        c.start + c.hold_from - c.entry + 0.4 * c.hold
        for of in plan.layers.values()
        for c in of.cues
        if c.hold
    ]
    return tuple(round(x, 3) for x in (*chosen, *held[:2], 0.37 * plan.end, plan.end + 1.5))


def _living(plan: Plan, answers: bool) -> tuple[float, ...]:
    """Return times amid what the life layers do of themselves: a dart of the eyes, a look away and back, a
    blink, a breath. answers: and while the body answers its arms, up to a moment after they have come back.
    """
    life = plan.life
    found = [t.start + 0.1 for t in life.targets[1:3]]
    for lane, delays in (
        (life.saccades, (0.012, 0.02)),
        (life.aversions, (0.03, 0.2)),
        (life.blinks, (0.03, 0.11)),
        (life.breaths, (0.4, 1.1)),
    ):
        starts = [float(start) for start in lane.times]
        last = len(starts) - 1
        found += [
            starts[place] + delay
            for delay, place in zip(delays, (last // 3, 2 * last // 3), strict=True)
            if starts
        ]
    found += [float(values[0]) + 0.06 for values in life.aversions.rows[1:3]]
    if answers:
        cues = plan.layers["arms"].cues
        for cue in cues[:: max(1, len(cues) // 6)]:
            found += [cue.start + 0.5 * cue.blend_in, cue.start + 0.6 * (cue.end - cue.start), cue.end + 0.1]
    return tuple(round(x, 4) for x in sorted(found) if x >= 0)


# --- checking


@dataclass
class Outcome:
    """What checking vectors found. failures: (case, what) in words."""

    passed: int = 0
    failures: list[tuple[str, str]] = field(default_factory=list)


def check_vectors(folder: Path, project: Project | None = None) -> Outcome:
    """Check this library against a folder's vectors, from its JSON and GLB alone, or for a project.

    Raises FileError when the vectors cannot be read or are of a newer version.
    """
    path = folder / NAME
    try:
        data = json.loads(path.read_bytes())
    except OSError as error:
        raise FileError(
            path,
            f"cannot be read ({error.strerror})",
            "on opening it",
            "Write vectors with metagraph export --vectors.",
        ) from None
    except ValueError as error:
        raise FileError(
            path, f"is not JSON ({error})", "on reading it", "Write vectors with metagraph export --vectors."
        ) from None
    if data.get("vectors") != VERSION:
        raise FileError(
            path,
            f"has version {data.get('vectors')}, this is {VERSION}",
            "$.vectors",
            "Update Metagraph, or write them again.",
        )
    if project is None:
        project = read_export(folder / data["export"], resolved=True)
    out = Outcome()
    for seed, words, expected in data["hashes"]:
        if key32(seed, *words) != expected:
            out.failures.append(("hashes", f"{seed} {words}"))
    wrong = (
        _unlike(list_offered_requests(project), data["described"], "described") if "described" in data else []
    )
    out.failures += [("described", what) for what in wrong]
    for n, sound in enumerate(data.get("heard", ())):
        heard = find_heard(sound)
        wrong = _unlike(heard, {name: sound[name] for name in heard}, f"heard[{n}]")
        out.failures += [("heard", what) for what in wrong]
    for n, row in enumerate(data.get("talked", ())):
        found = analyse_talk(row)
        wrong = _unlike(found, {name: row[name] for name in found}, f"talked[{n}]")
        out.failures += [("talked", what) for what in wrong]
    for n, row in enumerate(data.get("sympathies", ())):
        found = find_sympathies(row)
        wrong = _unlike(found, {name: row[name] for name in found}, f"sympathies[{n}]")
        out.failures += [("sympathies", what) for what in wrong]
    for n, row in enumerate(data.get("rules", ())):
        wrong = _unlike(find_rule_answer(row), row[4], f"rules[{n}], {row[0]}")
        out.failures += [("rules", what) for what in wrong]
    if "settings" in data:
        pairs = [(row["name"], row["value"]) for row in data["settings"]]
        wrong = _unlike(run_settings(project, pairs), data["settings"], "settings")
        out.failures += [("settings", what) for what in wrong]
    for case in data["cases"]:
        wrong = find_case_differences(project, case)
        out.failures += [(case["name"], what) for what in wrong]
        out.passed += not wrong
    return out


def find_case_differences(project: Project, case: Mapping[str, Any]) -> list[str]:
    """Return in words how what this library makes of a case differs from what the case expects."""
    steps = tuple(ScriptStep(s["now"], s["end"], tuple(s["asks"]), s["forget"]) for s in case["steps"])
    watched = [row["now"] for row in case.get("watched", ())][len(steps) :]
    watch = CaseWatch() if "watched" in case else None
    script = ScriptCase(
        case["name"], "", steps, case["seed"], case["idle"], case["stances"], watched=tuple(watched)
    )
    plan = play_case(project, script, watch)
    out = [
        *(_unlike(watch.rows, case["watched"], "watched") if watch is not None else ()),
        *_unlike(plan_data(plan), case["plan"], "plan"),
        *_unlike(make_life_data(plan), case["life"], "life"),
    ]
    if out:
        return out
    evaluator = Evaluator(plan, project)
    for alive, group in groupby(case["poses"], lambda pose: bool(pose["alive"])):
        expected = list(group)
        ours = _poses(evaluator, [pose["time"] for pose in expected], alive)
        out += [words for pair in zip(ours, expected, strict=True) for words in _apart(*pair)]
    return out


def _unlike(ours: Any, theirs: Any, where: str) -> list[str]:
    if isinstance(theirs, Mapping) and isinstance(ours, Mapping) and ours.keys() == theirs.keys():
        return [words for key in theirs for words in _unlike(ours[key], theirs[key], f"{where}.{key}")]
    if isinstance(theirs, list) and isinstance(ours, Sequence) and len(ours) == len(theirs):
        return [
            words
            for n, (a, b) in enumerate(zip(ours, theirs, strict=True))
            for words in _unlike(a, b, f"{where}[{n}]")
        ]
    number = isinstance(theirs, int | float) and isinstance(ours, int | float)
    alike = abs(ours - theirs) <= SECONDS if number else ours == theirs
    return [] if alike else [f"{where}: {str(ours)[:80]} instead of {str(theirs)[:80]}"]


def _apart(ours: Mapping[str, Any], expected: Mapping[str, Any]) -> list[str]:
    far = float(np.linalg.norm(np.array(ours["positions"]) - np.array(expected["positions"]), axis=-1).max())
    turn = float(
        degrees(
            rotation.measure_angle_between(np.array(ours["rotations"]), np.array(expected["rotations"])).max()
        )
    )
    names = ours["morphs"].keys() | expected["morphs"].keys()
    weight = max(
        (abs(ours["morphs"].get(n, 0.0) - expected["morphs"].get(n, 0.0)) for n in names), default=0.0
    )
    wrong = [(far, METRES, "m"), (turn, DEGREES, "degrees"), (weight, WEIGHT, "of a morph target")]
    return [
        f"pose at {expected['time']} s: {value:.2g} {unit} apart"
        for value, most, unit in wrong
        if value > most
    ]
