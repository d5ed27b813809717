"""The conformance vectors notice when a rule of the JavaScript runtime is broken."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.engines.javascript_runtime import (
    RUNTIME,
    STICK,
    VARIED,
    VECTORS,
    needs_node,
)
from tests.engines.mutants import broken, folders_to_try
from tests.processes import Answering, started
from tests.thorough import some

pytestmark = needs_node


MUTATIONS = [
    ("rotation.js", "x * x * (3 - 2 * x)", "x", "the blending curve"),
    ("hashing.js", "return close(plain);", "return plain;", "the zero byte that closes a word"),
    ("hashing.js", "value ^= value >>> 13;", "value ^= value >>> 12;", "the mixing"),
    (
        "hashing.js",
        "UTF8.encode(word).reduce",
        "[...word].map((c) => c.charCodeAt(0)).reduce",
        "bytes of UTF-8",
    ),
    ("choice.js", "/ weight;", "* weight;", "the weight of a candidate"),
    (
        "drawing.js",
        "Math.max(countUses(state, a.id, now), 1)",
        "(1 + countUses(state, a.id, now))",
        "the count under a likelihood",
    ),
    ("drawing.js", "return alpha * (state.uses", "return 1 * (state.uses", "alpha"),
    ("drawing.js", "settings.neverTwice ? 1 : 0", "settings.neverTwice ? 0 : 0", "never the same twice"),
    ("drawing.js", "needs.get(a.id) - less", "needs.get(a.id) - 2 * less", "spacing that gives way by one"),
    (
        "routes.js",
        'state.graph.of(stance, "transition")',
        '[...state.graph.of(stance, "transition")].reverse()',
        "the first short way",
    ),
    (
        "routes.js",
        "while (at < queue.length && !before.has(goal)) {",
        "while (at < queue.length && before.size < 3 && !before.has(goal)) {",
        "ways",
    ),
    ("sampling.js", "hops ? `${meta.key}/${step.hop}` : meta.key", "meta.key", "the key of a hop"),
    (
        "steps.js",
        "exact = found.length > 0 ? found : every;",
        "exact = every;",
        "the model's wishes, one after the other",
    ),
    (
        "sampling.js",
        "Math.max(shape.shortest, Math.min(bound.limit, wish) - shape.start)",
        "shape.length",
        "the earliest exit",
    ),
    (
        "cue_shapes.js",
        "Math.max(0, left) + action.timing.blendOut",
        "Math.max(0, left)",
        "blending out of an exit",
    ),
    (
        "phase_times.js",
        "this.ready - Math.max(blendIn, LEAST_BLEND)",
        "this.ready",
        "where a gesture without preparation begins",
    ),
    ("cue_shapes.js", "request.stroke - (found.stroke - entry)", "request.stroke", "a stroke in time"),
    ("cue_shapes.js", "(holdTo - holdFrom) / HURRY", "holdTo - holdFrom", "how short a hold can be"),
    (
        "sampling.js",
        "into = Math.max(into, LEAST_BLEND);",
        "",
        "the least blend of what is cut into",
    ),
    (
        "sampling.js",
        "const squeeze = into + out > 0 ? Math.min(1, length / (into + out)) : 1;",
        "const squeeze = 1;",
        "blends that must fit",
    ),
    (
        "sampling.js",
        "a.cooldown <= 0 || findCooled(state, a)",
        "true || findCooled(state, a)",
        "cooling down",
    ),
    ("sampling.js", "waits > state.project.settings.wait", "false", "how long what was asked for waits"),
    (
        "sampling.js",
        "const until = cue.end - cue.blendOut;",
        "const until = cue.end;",
        "when a loop begins anew",
    ),
    ("punctuality.js", "if (least > allowed + FITS) {", "if (least > allowed + 9) {", "what is too late"),
    (
        "punctuality.js",
        "late.get(a.id) <= Math.max(least, 0) + FITS",
        "late.get(a.id) <= allowed + FITS",
        "the least late first",
    ),
    ("punctuality.js", "const both = timely.filter", "const both = [].filter", "strokes that are shared"),
    ("punctuality.js", "if (over.length > 0) {", "if (over.length > 99) {", "room for what follows"),
    ("leaving.js", "const atOnce = now + Math", "const atOnce = now + 99 + Math", "leaving what runs"),
    ("cue_shapes.js", "left = found.strokeEnd - shape.entry;", "", "leaving out a hold"),
    ("bounds.js", "Math.min(meta.start, meta.request.start)", "meta.start", "when what is judged begins"),
    (
        "layer_planning.js",
        "TEMPORAL.has(report.outcome) && !judged.has(report.request)",
        "TEMPORAL.has(report.outcome)",
        "lateness that is told anew",
    ),
    ("layer_planning.js", "|| served.has(meta.request.id)) {", ") {", "what is served once"),
    ("plan.js", "held * ((cue.holdTo - cue.holdFrom) / cue.hold)", "held", "the stretch of a hold"),
    ("replan.js", "-meta.request.priority, meta", "meta", "priority at equal starts"),
    ("replan.js", "meta.request.id, meta.part", "meta.part", "ids at equal starts and priorities"),
    (
        "replan.js",
        "start: meta.end, part: kept ? last.part + 1 : last.part",
        "start: meta.end, part: last.part",
        "the key of a remainder",
    ),
    ("replan.js", "const resumes = last.request.resume &&", "const resumes =", "what goes on after a cut"),
    (
        "replan.js",
        "const kept = meta.start - last.start >= settings.shortest;",
        "const kept = true;",
        "the shortest part worth keeping",
    ),
    ("replan.js", "late > settings.wait", "late > 1e9", "what is past"),
    (
        "replan.js",
        "if (other.start - start >= shortest) {",
        "if (other.start > start) {",
        "gaps for what models write",
    ),
    ("markov.js", "const RESTS = 0.9;", "const RESTS = 0.6;", "the gap between what a model writes"),
    ("markov.js", "return 1 + 2 * chanceOf(", "return 1 + chanceOf(", "how long what a model writes lasts"),
    (
        "markov.js",
        "draw < chain.positive + chain.negative",
        "draw < chain.negative",
        "the share of negative gestures",
    ),
    (
        "layer_planning.js",
        "Math.max(length, request.stroke - request.start + FITS)",
        "length",
        "the window of a stroke",
    ),
    (
        "directing.js",
        'if (meta.request.kind === "transition" && state.track.staysAt(state.graph.layer, now)) {',
        "if (false) {",
        "staying in a stance",
    ),
    (
        "markov.js",
        "return share >= 1 ||",
        "return share >= 0 ||",
        "modes of the models",
    ),
    (
        "hearing.js",
        "if (turns) {",
        "if (false) {",
        "planning again where the mode changes",
    ),
    (
        "layer_planning.js",
        "busy = Math.max(busy, meta.end);",
        "",
        "time that models leave to what runs",
    ),
    (
        "hear.js",
        "const fixed = now > 0 ? now + graph.settings.lookahead : 0;",
        "const fixed = now;",
        "the lookahead",
    ),
    (
        "hearing.js",
        "owners(ident).some((o) => gone.has(o))",
        "false",
        "parts that are withdrawn with their owner",
    ),
    (
        "meaning.js",
        "Math.max(0, stroke - findLongestLead(this.project, this.graphOf(layer), ask.tags))",
        "at",
        "how early a gesture with a stroke may begin",
    ),
    ("meaning.js", "tags = [ask.do, ...ask.tags];", "tags = ask.tags;", "the tag of a nod"),
    (
        "life.js",
        "aversion_rate: 1.1, aversion_length: 2.4",
        "aversion_rate: 1, aversion_length: 2.4",
        "the idle manner",
    ),
    ("life.js", "breath_rate: [14,", "breath_rate: [15,", "the usual rate of breath"),
    (
        "pose.js",
        "rotations, 4 * joint, added.rotations, 4 * i)",
        "added.rotations, 4 * i, rotations, 4 * joint)",
        "the side of offsets",
    ),
    (
        "words.js",
        'LAYERS = ["body", "arms", "head"]',
        'LAYERS = ["head", "arms", "body"]',
        "the order of the layers",
    ),
    (
        "pose.js",
        "power(added.rotations, 4 * i, weights[i])",
        "power(added.rotations, 4 * i, 1)",
        "weights of turns",
    ),
    (
        "pose.js",
        "entering ? cue.entry : clipSeconds(cue, cue.end)",
        "cue.entry",
        "the edge a cue is led out from",
    ),
    ("pose.js", "const left = seamLeft(cue, time);", "const left = 0;", "the seam of a cycle"),
    ("pose.js", "blending && cue.repeats", "false", "how a cycle blends"),
    (
        "repeating.js",
        "seconds / cycle, MOST_TIMES) + 0.5",
        "seconds / cycle, MOST_TIMES)",
        "the nearest number of cycles",
    ),
    ("pose.js", "w * added.translations", "added.translations", "weights of translations"),
    ("pose.js", "Math.min(period + phase, length)", "phase", "the seam of a loop"),
    (
        "pose.js",
        "const period = length - seam;",
        "const period = length;",
        "the period of a loop with a seam",
    ),
    (
        "pose.js",
        "if (at === 0 || rest.fadeStart + rest.fade <= time) return stance;",
        "return stance;",
        "the fade from loop to loop",
    ),
    (
        "pose.js",
        "for (let s = 0; s < action.partly.length; s++) {",
        "for (let s = 0; s < 0; s++) {",
        "the other arm of a one-armed action",
    ),
    ("life/evaluate.js", "const INHALE = 0.4;", "const INHALE = 0.5;", "the shape of a breath"),
    ("life/evaluate.js", "(whole - gone) / life.blinkOpen", "1", "the shape of a blink"),
    (
        "life/evaluate.js",
        "channels[n] = shut[n] - already;",
        "channels[n] = shut[n];",
        "lids that a clip has shut already",
    ),
    ("life/evaluate.js", "MORPH_LOOK = 30 * RADIANS", "MORPH_LOOK = 25 * RADIANS", "morph targets of a look"),
    (
        "life/solve.js",
        "const SMALL = 15 * RADIANS;",
        "const SMALL = 10 * RADIANS;",
        "the head's part of a turn",
    ),
    (
        "life/solve.js",
        "turns[3 * n + k] *= lookers[n].share",
        "turns[3 * n + k] *= 1 / lookers.length",
        "the shares of neck and chest",
    ),
    ("life/solve.js", "const TILT_SHARE = 0.8;", "const TILT_SHARE = 1;", "the head's part up and down"),
    ("life/solve.js", "shut + blink * (1 - shut)", "Math.max(shut, blink)", "what a blink closes"),
    ("life/solve.js", "const NEAREST = 0.25;", "const NEAREST = 0;", "things nearer than the nose"),
    ("life/gaze.js", "const HEAD_LAG = 0.04;", "const HEAD_LAG = 0;", "the head that follows the eyes"),
    ("life/gaze.js", "const SPRING = 8;", "const SPRING = 6;", "how the head settles"),
    ("life/gaze.js", "if (since > times[n]) scale", "if (false) scale", "a look that ends an aversion"),
    (
        "life/gaze.js",
        "EYE_TIME_PER_DEGREE] = [0.021, 0.0022]",
        "EYE_TIME_PER_DEGREE] = [0.021, 0.003]",
        "how fast eyes jump",
    ),
    ("schedule.js", "const FIXATION = 0.2;", "const FIXATION = 0.3;", "the shortest fixation"),
    ("schedule.js", "const AFTER_BLINK = 1;", "const AFTER_BLINK = 3;", "blinks on stressed syllables"),
    (
        "schedule.js",
        "(first ? shut + 0.1 : AFTER_BLINK / this.calm)",
        "AFTER_BLINK / this.calm",
        "the blink that opens a speech",
    ),
    ("schedule.js", "if (strict === 1 || rate <= 0) {", "if (rate <= 0) {", "strict looks"),
    ("schedule.js", "AVERSION_GAP = 0.6;", "AVERSION_GAP = 0.5;", "the time between aversions"),
    ("schedule.js", "UPRIGHT = 0.6;", "UPRIGHT = 0.5;", "jumps up and down"),
    (
        "wanted.js",
        "track.looks[x].priority > look.priority",
        "false",
        "looks that wait beneath a more important one",
    ),
    ("items.js", "if (speech.priority < last.priority) {", "if (false) {", "a lesser speech"),
    (
        "mouth.js",
        "export const EARLY = 0.075;",
        "export const EARLY = 0.05;",
        "how early a mouth shapes itself",
    ),
    (
        "life/lips.js",
        "const CLOSING = 0.12;",
        "const CLOSING = 0.3;",
        "a mouth that closes where speech was cut",
    ),
    ("told_timing.js", "isNumber(x) ? x / of : x", "x", "what synthesisers count seconds in"),
    (
        "line_timing.js",
        "export const SHAPE = 0.2;",
        "export const SHAPE = 0.4;",
        "how long a last shape stays",
    ),
    ("items.js", "Math.max(now - findLineStart(old), old.skip)", "0", "what has been said of a line stands"),
    ("graphemes.js", '["th", ["TH"]]', '["th", ["DD"]]', "spelling"),
    ("graphemes.js", "const finalE = ", "const finalE = false && ", "the silent e"),
    (
        "glb.js",
        "slerp(out, o, values, a, values, b, part);",
        "slerp(out, o, values, a, values, b, 0);",
        "keys that were thinned out",
    ),
]

# A case that notices each, tried first; the others follow where it does not.
NOTICED_BY = {
    "rare: cut short": ["parts that are withdrawn with their owner"],
    "sample: head: holds and preparations": ["the window of a stroke"],
    "sample: nods": ["lids that a clip has shut already"],
    "sparse: a queue": ["ids at equal starts and priorities"],
    "sparse: arms: holds and preparations": [
        "where a gesture without preparation begins", "the stretch of a hold",
        "how early a gesture with a stroke may begin",
    ],
    "sparse: arms: strokes in time": ["a stroke in time"],
    "sparse: arms: to stay": ["gaps for what models write", "staying in a stance"],
    "sparse: asked again under the same id": ["keys that were thinned out"],
    "sparse: asked in the past, at rest": ["what is past", "the lookahead"],
    "sparse: chatter 3": ["time that models leave to what runs"],
    "sparse: cut": ["what goes on after a cut"],
    "sparse: cut again and again": ["priority at equal starts"],
    "sparse: cut and resumed": ["cooling down", "the key of a remainder"],
    "sparse: hashes": ["the zero byte that closes a word", "the mixing", "bytes of UTF-8"],
    "sparse: layers arms": ["when a loop begins anew"],
    "sparse: much that is forgotten": ["the weight of a candidate"],
    "sparse: no room": ["the shortest part worth keeping"],
    "sparse: the arms begin in s6": [
        "the gap between what a model writes", "how long what a model writes lasts", "the side of offsets",
    ],
    "stick: a past that is forgotten": [
        "the head's part of a turn", "the shares of neck and chest", "the head's part up and down",
        "how the head settles",
    ],
    "stick: a queue": ["the earliest exit", "blending out of an early exit"],
    "stick: a thing that moves": ["strict looks"],
    "stick: arms: a way that is interrupted": ["the first short way", "ways"],
    "stick: arms: holds and preparations": ["how short a hold can be", "the least blend of what is cut into"],
    "stick: arms: the same asked over and over": ["alpha", "never the same twice", "the order of the layers"],
    "stick: arms: to stay": [
        "the key of a hop", "blends that must fit", "the seam of a loop", "the period of a loop with a seam",
    ],
    "stick: a model that talks": ["the share of negative gestures"],
    "stick: body: an action of another stance": [
        "the blending curve", "the idle manner", "the usual rate of breath", "the edge a cue is led out from",
        "the fade from loop to loop",
    ],
    "stick: body: to stay": ["the other arm of a one-armed action"],
    "stick: chatter 1": ["the blink that opens a speech", "looks that wait beneath a more important one"],
    "stick: chatter 2": ["spelling"],
    "stick: cut": ["the shortest fixation", "the time between aversions", "jumps up and down"],
    "stick: head: the same asked over and over": ["spacing that gives way by one"],
    "stick: lines": [
        "the shape of a blink", "what a blink closes", "the head that follows the eyes",
        "how early a mouth shapes itself",
    ],
    "stick: looks": ["a look that ends an aversion"],
    "stick: nods": ["the tag of a nod"],
    "stick: something near": ["things nearer than the nose", "how fast eyes jump"],
    "stick: stressed syllables": [
        "the shape of a breath", "blinks on stressed syllables", "a mouth that closes where speech was cut",
    ],
    "stick: words that are said": ["a lesser speech", "the silent e"],
    "varied: all withdrawn": ["the count under a likelihood", "the model's wishes, one after the other"],
    "varied: arms: fidgets": ["how long what was asked for waits"],
    "varied: blinks and modes": ["morph targets of a look"],
    "varied: looks": ["weights of turns", "weights of translations"],
    "quiet: moods over moods": ["modes of the models"],
    "sparse: arms: strokes that may not be late": ["when what is judged begins"],
    "sparse: every shape of every set": ["what synthesisers count seconds in"],
    "sparse: modes asked for live": ["planning again where the mode changes"],
    "stick: a line that is added to": ["what has been said of a line stands"],
    "stick: arms: strokes that become known late": ["blending out of an exit"],
    "stick: arms: strokes that may not be late": ["room for what follows", "leaving out a hold"],
    "stick: arms: strokes that are planned on": ["the least late first", "what is served once"],
    "stick: body: strokes that are planned on": ["lateness that is told anew"],
    "stick: body: strokes that become known late": ["strokes that are shared", "leaving what runs"],
    "stick: body: strokes that may not be late": ["what is too late"],
    "stick: words and shapes with their times": ["how long a last shape stays"],
}  # fmt: skip
HINTS = {about: case for case, noticed in NOTICED_BY.items() for about in noticed}
TRIED = some(MUTATIONS, 3)


@pytest.fixture(scope="module")
def node() -> Iterator[Answering]:
    """One Node that tries all mutants."""
    with started(
        "node", Path(__file__).parent / "run" / "mutants.mjs", stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        yield Answering(process)


def test_every_rule_that_could_be_broken_stands_in_its_file_once() -> None:
    """Of those, one in three is broken here, and all where asked to be thorough."""
    for file, rule, instead, _ in MUTATIONS:
        broken(RUNTIME / file, rule, instead)


@pytest.mark.nightly
def test_what_tries_mutants_finds_no_fault_with_what_is_whole(
    node: Answering, single: Path, tmp_path: Path, rare: Path, sample_export: Path
) -> None:
    runtime = shutil.copytree(RUNTIME, tmp_path / "javascript")
    folders = [VARIED, STICK, rare, sample_export, *VECTORS]
    hints = dict.fromkeys(HINTS[about] for *_, about in TRIED if about in HINTS)
    tried = [folders_to_try(hint, folders, single)[0] for hint in hints]
    found = json.loads(node.ask(json.dumps({"runtime": str(runtime), "folders": list(map(str, tried))})))
    assert found == {"fault": "", "difference": ""}


@pytest.mark.parametrize(
    ("file", "rule", "instead", "about"), TRIED, ids=[m[3].replace(" ", "-") for m in TRIED]
)
@pytest.mark.nightly
def test_the_vectors_notice_when_a_rule_is_broken(
    node: Answering,
    single: Path,
    tmp_path: Path,
    sample_export: Path,
    rare: Path,
    file: str,
    rule: str,
    instead: str,
    about: str,
) -> None:
    changed = broken(RUNTIME / file, rule, instead)
    runtime = tmp_path / "javascript"  # of its own: a module is loaded once from a place
    shutil.copytree(RUNTIME, runtime)
    (runtime / file).write_text(changed, encoding="utf-8")
    tried = folders_to_try(HINTS.get(about), [VARIED, STICK, rare, sample_export, *VECTORS], single)
    found = json.loads(node.ask(json.dumps({"runtime": str(runtime), "folders": list(map(str, tried))})))
    assert not found["fault"], "a mutant that cannot be loaded proves nothing"
    assert found["difference"], about
