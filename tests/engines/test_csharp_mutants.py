"""The conformance vectors notice when a rule of the C# runtime is broken."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.engines.csharp_runtime import CORE, RUNTIME, VECTORS, Host, needs_mono
from tests.engines.mutants import broken, folders_to_try
from tests.thorough import some

pytestmark = needs_mono


MUTATIONS = [
    ("Basics.cs", "x * x * (3 - 2 * x)", "x", "the blending curve"),
    (
        "Language.cs",
        "return unchecked(value * Prime); // the closing zero byte",
        "return value;",
        "the zero byte that closes a word",
    ),
    ("Language.cs", "value ^= value >> 13;", "value ^= value >> 12;", "the mixing"),
    (
        "Drawing.cs",
        "Math.Max(CountUses(state, a.Id, now), 1.0)",
        "(CountUses(state, a.Id, now) + 1.0)",
        "the count under a likelihood",
    ),
    ("Drawing.cs", "NeverTwice ? 1 : 0;", "NeverTwice ? 0 : 0;", "never the same twice"),
    (
        "Sampling.cs",
        "Math.Max(shape.Shortest, Math.Min(bound.Limit, wish) - shape.Start)",
        "shape.Length",
        "the earliest exit",
    ),
    (
        "CueShapes.cs",
        "(holdTo - holdFrom) / Hurry",
        "(holdTo - holdFrom)",
        "how short a hold can be",
    ),
    ("Sampling.cs", "Math.Min(1.0, length / (into + out_))", "1.0", "blends that must fit"),
    ("Sampling.cs", "a => a.Cooldown <= 0", "a => a.Cooldown <= 1e9", "cooling down"),
    (
        "Sampling.cs",
        "waits > state.Project.Settings.Wait",
        "waits > 1e9",
        "how long what was asked for waits",
    ),
    ("Language.cs", "Basics.ThreeDecimals(number)", "Basics.Words(number)", "the decimals that key a loop"),
    (
        "Steps.cs",
        "if (!exact.Any(a => !again.Contains(a.Id)))",
        "if (!exact.Any())",
        "models that do not repeat themselves",
    ),
    (
        "Directing.cs",
        'if (meta.Request.Kind == "transition" && state.Track.StaysAt(state.Graph.Layer, now))',
        "if (meta.Part > 99 && state.Track.StaysAt(state.Graph.Layer, now))",
        "staying in a stance",
    ),
    ("Markov.cs", "return share >= 1 ||", "return share >= 0 ||", "modes of the models"),
    (
        "Punctuality.cs",
        "if (least > allowed + CueShapesRules.Fits)",
        "if (least > allowed + 9)",
        "what is too late",
    ),
    ("Punctuality.cs", "if (over.Count > 0)", "if (over.Count > 99)", "room for what follows"),
    ("Bounds.cs", "Math.Min(meta.Start, meta.Request.Start)", "meta.Start", "when what is judged begins"),
    (
        "Asks.cs",
        'case "late": Late = Seconds(name, value, 600);',
        'case "late":',
        "reading how late it may be",
    ),
    ("Plan.cs", "held * ((cue.HoldTo - cue.HoldFrom) / cue.Hold)", "held", "the stretch of a hold"),
    ("Replan.cs", "-meta.Request.Priority, meta", "0, meta", "priority at equal starts"),
    (
        "Replan.cs",
        "meta.Request.Id, meta.Part",
        '"", meta.Part',
        "ids at equal starts and priorities",
    ),
    ("Replan.cs", "kept ? last.Part + 1 : last.Part", "last.Part", "the key of a remainder"),
    ("Replan.cs", "var resumes = last.Request.Resume &&", "var resumes =", "what goes on after a cut"),
    (
        "Markov.cs",
        "const double Rests = 0.9;",
        "const double Rests = 0.6;",
        "the gap between what a model writes",
    ),
    ("Hear.cs", "now + graph.Settings.Lookahead", "now", "the lookahead"),
    (
        "Hear.cs",
        "ForEach(cue => RememberingRules.Remember(cue, past.Uses, past.Recent, past.Ended))",
        "ForEach(cue => { })",
        "the uses of what was forgotten",
    ),
    (
        "Pose.cs",
        "composed[j] *= weight == 1 ? found.Turns[j] : found.Turns[j].Power(weight);",
        "composed[j] = (weight == 1 ? found.Turns[j] : found.Turns[j].Power(weight)) * composed[j];",
        "the order in which layers add",
    ),
    (
        "Pose.cs",
        "entering ? cue.Entry : cue.ClipSeconds(cue.End)",
        "cue.ClipSeconds(cue.End)",
        "the edge a clip is led in from",
    ),
    (
        "Pose.cs",
        "double left = CueTimesRules.SeamLeft(cue, time);",
        "double left = 0;",
        "the seam of a cycle",
    ),
    ("Pose.cs", "old = 1 - Basics.Ease(phase / seam);", "old = 0.0;", "the seam of a loop"),
    ("Clip.cs", "Basics.Clamp((time - keys[low]) / gap, 0, 1)", "0.0", "keys that were thinned out"),
    ("Loading.cs", "joint.Side == other", "joint.Side != other", "the arm that a gesture leaves alone"),
    (
        "Life/Gaze.cs",
        "private const double HeadLag = 0.04;",
        "private const double HeadLag = 0.0;",
        "a head that sets off later",
    ),
    (
        "Schedule.cs",
        "first ? shut + 0.1 : ScheduleRules.AfterBlink / Calm",
        "ScheduleRules.AfterBlink / Calm",
        "a blink at the first stressed syllable",
    ),
    ("Life/Solve.cs", "shut + blink * (1 - shut)", "shut + blink", "lids that meet and go no farther"),
    ("ToldTiming.cs", "Ticks = 1e7", "Ticks = 1e6", "what synthesisers count seconds in"),
    (
        "Items.cs",
        "LineTimingRules.Extended(old.Timing, told, said)",
        "LineTimingRules.Extended(old.Timing, told, 0.0)",
        "what has been said of a line stands",
    ),
    (
        "Mouth.cs",
        "public const double Early = 0.075",
        "public const double Early = 0.065",
        "mouths that are early",
    ),
]

# A case that notices each, tried first; the others follow where it does not.
NOTICED_BY = {
    "sparse: arms: holds and preparations": ["the stretch of a hold"],
    "sparse: arms: to stay": ["staying in a stance"],
    "sparse: asked in the past, at rest": ["ids at equal starts and priorities"],
    "sparse: cut": ["what goes on after a cut"],
    "sparse: cut again and again": ["priority at equal starts"],
    "sparse: cut and resumed": ["the key of a remainder"],
    "sparse: hashes": ["the zero byte that closes a word", "the mixing"],
    "sparse: interrupted live": ["cooling down", "the lookahead"],
    "sparse: much that is forgotten": ["the uses of what was forgotten"],
    "sparse: the arms begin in s6": ["the order in which layers add"],
    "sparse: the arms begin in s8": ["the gap between what a model writes"],
    "stick: blinks and modes": ["a head that sets off later", "lids that meet and go no farther"],
    "stick: interrupted live": ["never the same twice"],
    "varied: a queue": ["the earliest exit"],
    "varied: all withdrawn": ["models that do not repeat themselves"],
    "varied: arms: an action of another stance": ["blends that must fit", "the seam of a loop"],
    "varied: arms: fidgets": ["how long what was asked for waits"],
    "varied: arms: for a certain time": ["the count under a likelihood"],
    "varied: arms: holds and preparations": ["how short a hold can be"],
    "varied: beyond the end": ["the decimals that key a loop"],
    "varied: layers body": ["the blending curve", "the edge a clip is led in from"],
    "varied: no room": ["the arm that a gesture leaves alone"],
    "varied: no time at all": ["keys that were thinned out"],
    "varied: stressed syllables": ["a blink at the first stressed syllable", "mouths that are early"],
    "stick: arms: strokes that may not be late": ["room for what follows", "reading how late it may be"],
    "sparse: every shape of every set": ["what synthesisers count seconds in"],
    "stick: a line that is added to": ["what has been said of a line stands"],
    "sparse: arms: strokes that may not be late": ["when what is judged begins"],
    "stick: ties of start and priority": ["ids at equal starts and priorities"],
    "stick: body: strokes that may not be late": ["what is too late"],
}  # fmt: skip
HINTS = {about: case for case, noticed in NOTICED_BY.items() for about in noticed}
TRIED = some(MUTATIONS, 3)


def program_of(host: Host, out: Path, sources: list[Path]) -> Path:
    """Return a program of a runtime's sources and what runs the vectors."""
    host.compile(out, *sources, RUNTIME / "Tests" / "Conformance.cs")
    return out


def test_every_rule_that_could_be_broken_stands_in_its_file_once() -> None:
    """Of those, one in three is broken here, and all where asked to be thorough."""
    for file, rule, instead, _ in MUTATIONS:
        broken(RUNTIME / "Runtime" / "Core" / file, rule, instead)


@pytest.mark.nightly
def test_what_tries_mutants_finds_no_fault_with_what_is_whole(
    host: Host, single: Path, tmp_path: Path
) -> None:
    program = program_of(host, tmp_path / "whole.exe", CORE)
    hints = dict.fromkeys(HINTS[about] for *_, about in TRIED if about in HINTS)
    tried = [folder for hint in hints for folder in folders_to_try(hint, VECTORS, single)[:1]]
    code, told = host.run(program, *tried)
    assert code == 0, told[:2000]


@pytest.mark.parametrize(
    ("file", "rule", "instead", "about"), TRIED, ids=[m[3].replace(" ", "-") for m in TRIED]
)
@pytest.mark.nightly
def test_the_vectors_notice_when_a_rule_is_broken(
    host: Host, single: Path, tmp_path: Path, file: str, rule: str, instead: str, about: str
) -> None:
    path = RUNTIME / "Runtime" / "Core" / file
    changed = tmp_path / path.name
    changed.write_text(broken(path, rule, instead), encoding="utf-8")
    number = [m[3] for m in MUTATIONS].index(about)
    program = program_of(
        host, tmp_path / f"mutant{number}.exe", [*(other for other in CORE if other != path), changed]
    )
    hinted = folders_to_try(HINTS.get(about), VECTORS, single)
    assert any(host.run(program, folder)[0] != 0 for folder in hinted), about
