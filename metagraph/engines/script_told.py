"""Scripts of conformance for lines and places that are reported once more and otherwise: pieces that come
behind a line's end, too late or twice, what cannot be read, and what is forgotten.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from metagraph.engines.script_parts import Ask, ScriptCase, ScriptStep, ask, make_case
from metagraph.graph.model import LAYERS, Project

_ENDS = 30.0  # seconds of each script
_AFTER = (0.25, 2.0, 6.0)
_TWO = [["one", 0.0, 0.375], ["two", 0.5, 0.875]]
_SHAPES = [[0.0, "aa"], [0.25, "PP"], [0.5, "O"]]
# What is said first, and what is said under its id at some times after.
_PIECES: tuple[tuple[dict[str, Any], tuple[tuple[float, dict[str, Any]], ...]], ...] = (
    ({"words": _TWO}, ((3.0, {"words": [*_TWO, ["three", 1.0, 1.5]]}), (5.0, {"words": _TWO}))),
    (
        {"words": _TWO},
        ((3.0, {"words": [["two", 0.5, 0.875], ["three", 1.0, 1.5]]}), (5.0, {"words": _TWO[:1]})),
    ),
    ({"words": _TWO}, ((3.0, {"words": [["other", 0.0, 0.25], ["words", 0.25, 0.5], ["came", 0.5]]}),)),
    (
        {"words": _TWO, "more": True},
        ((3.0, {"words": [["three", 1.0, 1.5]]}), (3.5, {"words": [["four", 1.5, 2.0]]})),
    ),
    (
        {"words": _TWO, "more": True},
        ((0.94, {"words": [["three", 0.875, 1.5]]}), (1.75, {"words": [["four", 1.5, 2.0]]})),
    ),
    ({"words": _TWO, "more": True}, ((0.3, {"words": [["won", 0.0, 0.75], ["too", 0.75, 1.0]]}),)),
    ({"visemes": _SHAPES}, ((3.0, {"visemes": [*_SHAPES, [0.75, "E"]]}), (5.0, {"visemes": _SHAPES}))),
    (
        {"visemes": _SHAPES},
        ((3.0, {"visemes": [[0.0, "aa"], [0.2, "E"]]}), (5.0, {"visemes": [[0.4, "E"], [0.8, "U"]]})),
    ),
    ({"visemes": _SHAPES}, ((3.0, {"visemes": [[0.375, "E"], [0.5, "U"]]}),)),
    (
        {"visemes": _SHAPES, "more": True},
        ((3.0, {"visemes": [[0.75, "E"], [1.0, "U"]]}), (3.5, {"visemes": [[1.25, "I"]]})),
    ),
    (
        {"visemes": _SHAPES, "more": True},
        ((0.75, {"visemes": [[0.625, "E"], [0.875, "U"]]}), (1.75, {"visemes": [[1.0, "I"]]})),
    ),
    ({"visemes": _SHAPES}, ((0.4, {"visemes": [[0.125, "FF"], [0.375, "E"], [0.75, "U"]]}),)),
    (
        {"visemes": _SHAPES},
        ((0.4, {"visemes": [[0.25, "PP"], [0.5, "E"], [0.75, "U"]]}), (0.5, {"visemes": _SHAPES})),
    ),
    (
        {"visemes": _SHAPES, "more": True},
        ((1.0, {"visemes": [[0.0, "E"], [0.25, "U"]]}), (1.5, {"text": "Oh."})),
    ),
    (
        {"text": "It rains", "more": True, "duration": 1.0},
        ((0.5, {"text": " a lot.", "more": True, "duration": 0.5}), (0.75, {"text": "…", "more": True})),
    ),
    (
        {"text": "…", "more": True},
        ((0.5, {"text": " so", "more": True}), (1.0, {"text": "So “that” is—it!"})),
    ),
    ({"text": "Say it so.", "words": [["other", 0.0, 0.25], ["so", 0.5]], "more": True, "duration": 2.0}, ()),
    (
        {
            "text": "One two, two “three”.",
            "words": [["One", 0.0, 0.25], ["two", 0.25, 0.5], ["two", 0.5], ["three", 0.75]],
        },
        (),
    ),
)
# What is refused, and what is just not.
_REFUSED: tuple[dict[str, Any], ...] = (
    {"visemes": [[-0.25, "aa"]]},
    {"visemes": [[3601.0, "aa"]]},
    {"words": [["a", -0.25, 0.5]]},
    {"words": [["a", 3601.0, 3602.0]]},
    {"visemes": [[0.0, "aa"], [0.25, "zz"]], "set": "oculus"},
    {"visemes": [[0.0, "aa"]], "set": "polly"},
    {"visemes": [[0.0, "p"]], "set": "polly"},
    {"visemes": [[0.0, "aa", 1.5]]},
    {"visemes": [[0.0, "aa", -0.5]]},
    {"visemes": [[0.0, "aa", 1.0], [0.0, "PP", 0.0]]},
    {"visemes": [[0.0, "zz"]]},
    {"visemes": [[0.0, "aa"], [0.25, "p"], [0.5, "@"]]},
    {"words": [["a", "0"]]},
    {"words": [["a", 0.25, 0.0]]},
    {"words": [["a", 0.0, "1"]]},
    {"words": [[5, 0.0]]},
    {"words": [["a", 0.0, 0.5, 1.0]]},
    {"visemes": [[0.25]]},
    {"visemes": [["0", "aa"]]},
    {"visemes": [[0.0, 5]]},
    {"visemes": [[0.0, "aa", "1"]]},
    {"visemes": [[0.0, "aa", 0.5, 0.5]]},
    {"words": [{"word": "a"}]},
    {"words": [{"start": 0.0}]},
    {"words": [{"word": "a", "start": 0.25}, {"word": "b", "start": 0.5, "end": 0.75}]},
    {"visemes": [{"time": 0.25, "viseme": "aa"}, {"time": 0.5, "viseme": "PP", "weight": 0.5}]},
    {"visemes": [{"time": 0.0, "id": "aa"}, {"time": 0.25, "viseme": "O"}]},
    {"visemes": [{"viseme": "aa"}]},
    {"visemes": [{"time": 100, "type": "word", "value": "a"}, {"time": 200, "type": "viseme", "value": "p"}]},
    {"words": [{"time": 100, "type": "word", "value": "a"}, {"time": 200, "type": "viseme", "value": "p"}]},
    {
        "words": [
            {"audioOffset": 1000000, "text": "a", "duration": 2500000},
            {"audioOffset": 5000000, "text": "b"},
        ]
    },
    {"words": [["a", 0.0, 0.5]], "duration": 0.5},
    {"words": [["a", 0.0, 0.5]], "duration": 0.45},
    {"visemes": [[0.0, "aa"], [0.5, "PP"]], "duration": 0.5},
    {"visemes": [[0.0, "aa"], [0.5, "PP"]], "duration": 0.45},
    {"words": [["a", 0.5], ["b", 0.5]]},
    {"words": [["a", 0.5], ["b", 0.25]]},
    {"visemes": [[0.5, "aa"], [0.5, "PP"]]},
)


def list_told_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield the cases that suit a project."""
    if not project.life.on:
        return
    for n, (first, later) in enumerate(_PIECES):
        steps = [ScriptStep(0.0, _ENDS, (ask("s", "say", 1.0, **first),))]
        steps += [ScriptStep(1.0 + at, _ENDS, (ask("s", "say", **said),)) for at, said in later]
        last = steps[-1].now
        watched = tuple(last + x for x in _AFTER)
        yield ScriptCase(
            f"told once more {n}", "pieces behind others", tuple(steps), alive=(), watched=watched
        )
    asks = [ask(f"r{n}", "say", 0.5 * n, **said) for n, said in enumerate(_REFUSED)]
    yield make_case("told so that it cannot be said", "or just so that it can", asks, 20.0, alive=())
    shapes = [
        mark
        for n in range(30)
        for mark in ([0.35 * n, "aa"], [0.35 * n + (0.04, 0.2, 0.08, 0.3, 0.12)[n % 5], "PP"])
    ]
    asks = [ask("v", "say", 1.0, visemes=shapes), ask("w", "say", 14.0, visemes=shapes[1::3])]
    yield make_case("open for long and short", "what is open for longer is stressed", asks, 26.0, alive=())
    yield _letters()
    yield _anew()
    yield _broken_off(project)
    yield _kept(project)
    alone = (
        ScriptStep(0.0, _ENDS),
        ScriptStep(5.0, _ENDS, (ask("m", "mood", mood="sad"),)),
        ScriptStep(11.0, _ENDS, (ask("w", "withdraw", what="m"),)),
        ScriptStep(14.0, _ENDS, (ask("n", "mode", mode="listening"),)),
    )
    yield ScriptCase("a mood by itself", "all layers are planned again", alone, idle=True, alive=())
    yield _called(project)
    yield from _same(project)


def _letters() -> ScriptCase:
    text = "բարի օր, אבגד, þing ƿynn ʃʒ"
    times = tuple(round(1.05 + 0.17 * n, 3) for n in range(12))
    asks = [ask("l", "say", 1.0, text=text, duration=3.0)]
    return make_case("letters that are not known", "shapes by turns", asks, 8.0, times=times, alive=(True,))


def _anew() -> ScriptCase:
    """Return a case of something said again in the step in which it is taken back, and of what goes on."""
    mood = {"mood": "happy"}
    steps = (
        ScriptStep(
            0.0,
            _ENDS,
            (ask("s", "say", 1.0, text="This goes on for quite a while.", **mood), ask("s/1", "nod", 2.5)),
        ),
        ScriptStep(
            1.5,
            _ENDS,
            (ask("w", "withdraw", what="s"), ask("s", "say", text="No, this."), ask("s/2", "nod", 3.0)),
        ),
        ScriptStep(2.0, _ENDS, (ask("s", "say", text="And this.", more=True), ask("s", "say", text=" Yes"))),
        ScriptStep(
            6.0,
            _ENDS,
            (ask("t", "say", 7.0, words=_TWO), ask("t", "say", 7.0, words=[["three", 1.0, 1.5]], more=True)),
        ),
        ScriptStep(7.5, _ENDS, (ask("all", "withdraw"), ask("t", "say", words=[["four", 0.0, 0.5]]))),
        ScriptStep(8.0, _ENDS, (ask("t", "say", words=[["five", 0.5, 1.0]]), ask("p", "pause", what="t"))),
        ScriptStep(9.0, _ENDS, (ask("w2", "withdraw", what="t"), ask("t", "say", text="Six"))),
    )
    return ScriptCase("taken back and said anew", "in one step", steps, alive=(), watched=_AFTER_NINE)


_AFTER_NINE = (9.25, 11.0, 15.0)


def _broken_off(project: Project) -> ScriptCase:
    """Return a case of lines that are broken off, and of what fell silent before it was paused."""
    line = next(iter(project.lines), None)
    lines = [ask("l", "say", 1.0, line=line)] if line is not None else []
    again = [ask("m", "say", 9.0, line=line)] if line is not None else []
    steps = (
        ScriptStep(0.0, _ENDS, (*lines, ask("b", "say", 3.0, text="Hm", more=True))),
        ScriptStep(1.5, _ENDS, (ask("i", "interrupt", what="l"),)),
        ScriptStep(5.0, _ENDS, (ask("p", "pause", what="b"),)),
        ScriptStep(5.5, _ENDS, (ask("f", "finish", what="b"),)),
        ScriptStep(6.0, _ENDS, (ask("r", "resume", what="b"),)),
        ScriptStep(8.0, _ENDS, (*again, ask("far", "gesture", 50.0, layer="arms"))),
        ScriptStep(9.25, _ENDS, (ask("q", "pause", what="m"),)),
        ScriptStep(10.0, _ENDS, (ask("r2", "resume", what="m"),)),
        ScriptStep(10.25, _ENDS, (ask("w", "withdraw", what="m"), ask("far2", "fidget", 60.0, layer="arms"))),
    )
    return ScriptCase("lines that are broken off", "at once", steps, alive=(), watched=(11.0, 14.0))


def _kept(project: Project) -> ScriptCase:
    """Return a case of places, stays, blinks and moods of which some are forgotten or taken back."""
    stays: list[Ask] = []
    for layer in LAYERS:
        stances = [*project.graphs[layer].stances][:2]
        stays += [
            ask(f"{layer}{n}", "stance", 1.0 + 2.0 * n, layer=layer, stance=stance, stay=True)
            for n, stance in enumerate([*stances, *stances])
        ]
    places = [
        ask(f"p{n}", "place", 0.5 + n, name=("lamp", "cat")[n % 2], point=[0.5, 1.5, 0.25 * n])
        for n in range(10)
    ]
    moods = [
        ask("m0", "mood", 0.0, mood="sad"),
        ask("m1", "mood", 1.0, intensity=0.5),
        ask("m2", "mood", 2.0, mood="warm"),
        ask("m3", "mood", 2.5, mood="happy", intensity=1.5),
        ask("m4", "mood", 4.0, mood="calm", duration=30.0),
    ]
    looks = [ask("k0", "look", 4.0, to="lamp"), ask("k1", "look", 7.0, to="cat", strict=True)]
    blinks = [ask(f"b{n}", "blink", 1.0 + n) for n in range(6)]
    steps = (
        ScriptStep(0.0, 14.0, (*places, *moods, *looks, *blinks)),
        ScriptStep(0.5, 14.0, tuple(stays)),
        ScriptStep(3.5, 18.0, (ask("w0", "withdraw", what="b4"), ask("w1", "withdraw", what="b1")), 3.0),
        ScriptStep(5.5, 20.0, (ask("w2", "withdraw", what="p7"), ask("w3", "withdraw", what="arms3")), 5.5),
        ScriptStep(9.0, 30.0, (ask("w4", "withdraw", what="k1"), ask("w5", "withdraw", what="m4")), 8.5),
        ScriptStep(12.0, 40.0),
    )
    return ScriptCase(
        "what lasts is forgotten",
        "but for what still counts",
        steps,
        idle=True,
        times=(12.5, 16.0),
        alive=(True,),
    )


def _called(project: Project) -> ScriptCase:
    """Return a case of actions asked for by name: of two with one name the likelier plays, in the layer that
    is given.
    """
    asks: list[Ask] = []
    for layer in LAYERS:
        names = dict.fromkeys(
            a.name for a in project.graphs[layer].actions.values() if a.kind in ("gesture", "fidget")
        )
        for n, name in enumerate(names):
            asks.append(ask(f"{layer}{n}", "action", 1.0 + 6.0 * n, action=name))
            asks.append(ask(f"{layer}{n}l", "action", 4.0 + 6.0 * n, action=name, layer=layer))
    return make_case("actions by their names", "the likelier of two", asks, 60.0, alive=())


def _same(project: Project) -> Iterator[ScriptCase]:
    """Yield cases in which something that lasts is asked again under its id, another or the same."""
    layer = next((x for x in LAYERS if len(project.graphs[x].stances) > 1), None)
    stances = [*project.graphs[layer].stances] if layer is not None else []
    lamp: dict[str, Any] = {"name": "lamp", "point": [0.5, 1.5, 1.0]}
    pairs: list[tuple[Ask, Ask]] = [
        (ask("x", "place", 6.0, **lamp), ask("x", "place", 6.0, **lamp)),
        (ask("x", "place", 6.0, **lamp), ask("x", "place", 6.0, **{**lamp, "name": "cat"})),
        (ask("x", "place", 6.0, **lamp), ask("x", "place", 7.0, **lamp)),
        (ask("x", "blink", 6.0), ask("x", "blink", 6.0)),
        (ask("x", "blink", 6.0), ask("x", "blink", 7.0)),
        (ask("x", "blink", 6.0), ask("y", "blink", 6.0)),
        (ask("x", "look", 6.0, to="lamp"), ask("x", "look", 6.0, to="lamp")),
        (ask("x", "mood", 6.0, mood="sad"), ask("x", "mood", 6.0, mood="sad")),
    ]
    if layer is not None:
        there: dict[str, Any] = {"layer": layer, "stay": True, "stance": stances[1]}
        begin = {**there, "stance": stances[0]}
        pairs += [
            (ask("x", "stance", 6.0, **there), ask("x", "stance", 6.0, **there)),
            (ask("x", "stance", 6.0, **there), ask("x", "stance", 7.0, **there)),
            (ask("x", "stance", 6.0, **there), ask("y", "stance", 6.0, **begin)),
        ]
    begun = (
        ask("at", "place", 0.0, name="lamp", point=[-0.5, 1.25, 1.0]),
        ask("seen", "look", 5.5, to="lamp"),
    )
    steps: list[ScriptStep] = []
    for n, (first, then) in enumerate(pairs):
        now = 10.0 * n
        at = [{**each, "id": f"{each['id']}{n}", "at": each["at"] + now} for each in (first, then)]
        opened = [{**each, "id": f"{each['id']}{n}", "at": each["at"] + now} for each in begun]
        steps.append(ScriptStep(now, now + 14.0, (*opened, at[0])))
        steps.append(ScriptStep(now + 3.0, now + 14.0, (at[1],), now))
    times = (10.0 * len(pairs) - 2.0,)
    yield ScriptCase(
        "lasting things asked again", "the same, or another", tuple(steps), times=times, alive=(True,)
    )
