"""Scripts of conformance for the life layers: looks, blinks, modes, and what is said."""

from __future__ import annotations

from collections.abc import Iterator

from metagraph.engines.script_parts import ScriptCase, ScriptStep, ask, make_case
from metagraph.graph.model import Project
from metagraph.playback.planning.director import musing

ALIVE = (True,)  # the life layers are on


def _timed_lines() -> Iterator[ScriptCase]:
    """Yield lines whose words and mouth shapes are given with their times."""
    words = [["Hello", 0.1, 0.45], ["there", 1.5, 1.9], {"word": "friend", "start": 1.9, "end": 2.4}]
    polly = [
        {"time": 0, "type": "sentence", "start": 0, "end": 7, "value": "Mapped."},
        {"time": 6, "type": "word", "start": 0, "end": 6, "value": "Mapped"},
        {"time": 6, "type": "viseme", "value": "p"},
        {"time": 90, "type": "viseme", "value": "a"},
        {"time": 210, "type": "viseme", "value": "p"},
        {"time": 300, "type": "viseme", "value": "t"},
        {"time": 380, "type": "viseme", "value": "sil"},
    ]
    azure = [
        {"audioOffset": 500_000 + 1_100_000 * n, "visemeId": id} for n, id in enumerate((21, 2, 18, 7, 0))
    ]
    shapes = [[0.0, "ou", 0.7], [0.2, "PP"], [0.3, "oh"], [0.6, "sil"]]
    frames = [{"time": n / 30, "weights": {"jawOpen": 0.02 * n, "mouthFunnel": 0.3}} for n in range(40)]
    asks = [
        ask("w1", "say", 1.0, words=words),
        ask("w2", "say", 5.0, text="Mapped.", visemes=polly),
        ask("w3", "say", 6.0, visemes=azure, duration=1.0),
        ask("w4", "say", 8.0, visemes=frames, set="arkit"),
        ask("w5", "say", 10.0, visemes=shapes, words=words),
        ask("w6", "say", 12.5, words=[["cut", 0.0, 1.0], ["short", 1.2]]),
        ask("w7", "say", 13.2, text="by this"),
        ask("r1", "say", 13.0, visemes=[[0.0, "aa"], [0.1, "nothing"]]),
        ask("r2", "say", 13.0, visemes=[[0.5, "aa"], [0.1, "PP"]]),
        ask("r3", "say", 13.0, words=[["late", 0.0, 3.0]], duration=1.0),
        ask("r4", "say", 13.0, words=[["back", 1.0, 0.5]]),
        ask("r5", "say", 13.0, words=[["only"]]),
    ]  # fmt: skip
    yield make_case(
        "words and shapes with their times",
        "the mouth follows them and is shut between; what cannot be read is refused",
        asks,
        16.0,
        times=(
            1.2,
            1.35,
            2.0,
            2.7,
            3.2,
            5.05,
            5.15,
            5.25,
            6.1,
            6.2,
            6.4,
            8.7,
            9.1,
            10.1,
            10.25,
            10.4,
            12.9,
            13.25,
        ),
        alive=(False, True),
    )
    steps = (
        ScriptStep(0.0, 12.0, (ask("s", "say", 1.0, words=words[:1]),)),
        ScriptStep(1.3, 12.0, (ask("s", "say", words=words[1:]),)),
        ScriptStep(2.2, 12.0, (ask("s", "say", words=[*words, ["again", 2.6, 3.2]]),)),
        ScriptStep(4.0, 12.0, (ask("s", "say", words=[["later", 3.0, 3.9], ["still", 4.0]]),), forget=3.5),
        ScriptStep(5.0, 12.0, (ask("v", "say", visemes=[[0.0, "aa"], [0.3, "PP"], [0.5, "O"]]),)),
        ScriptStep(5.3, 12.0, (ask("v", "say", visemes=[[0.6, "E"], [0.9, "sil"]]),)),
        ScriptStep(6.0, 12.0, (ask("x", "withdraw", what="v"),)),
        ScriptStep(6.2, 12.0, (ask("n", "say", 7.0, words=[["told", 0.1, 0.4]]),)),
        ScriptStep(6.4, 12.0, (ask("n", "say", 7.0, words=[["beforehand", 0.5, 1.0]]),)),
    )
    yield ScriptCase(
        "a line that is added to",
        "what is said of it stands, what comes later is added",
        steps,
        times=(3.6, 3.9, 4.15, 4.3, 4.6, 4.9, 5.2, 5.45, 5.6, 5.75, 5.95, 6.1, 6.3, 7.2, 7.7),
        alive=(False, True),
    )


def list_life_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield looks, blinks, modes, lines and nods, where the life layers are on."""
    if not project.life.on:
        return
    yield from _looks()
    yield make_case(
        "blinks and modes",
        "blinks asked for; modes change rates",
        [
            ask("b1", "blink", 1.0),
            ask("b2", "blink", 1.05),
            ask("m1", "mode", 2.0, mode="listening"),
            ask("m2", "mode", 8.0, mode="talking"),
            ask("m3", "mode", 11.0, mode=None),
            ask("m4", "mode", 18.0, mode="thinking"),
            ask("m5", "mode", 36.0, mode="reacting"),
            ask("m6", "mode", 40.0, mode="talking"),
        ],
        60.0,
        times=(0.9, 1.03, 1.1, 9.0, 21.5, 33.3, 36.3),
        alive=ALIVE,
    )
    if musing(project.graphs["arms"].stances) != "":
        yield _thoughts()
    yield _said()
    yield from _timed_lines()
    yield _cut_short()
    yield from _lines(project)
    if any(a.kind == "gesture" for a in project.graphs["head"].actions.values()):
        asks = [ask("n1", "nod", 1.0), ask("n2", "shake", 5.0), ask("n3", "nod", 9.0, priority=2)]
        yield make_case("nods", "gestures of the head tagged so, or called so", asks, alive=ALIVE)
    yield make_case(
        "two minutes",
        "what is drawn goes on being drawn",
        [],
        120.0,
        idle=True,
        times=(61.3, 99.9, 119.5),
        alive=ALIVE,
    )
    yield make_case(
        "a model that talks",
        "what a model writes for one who talks, positive and negative nods among it",
        [ask("m", "mode", 10.0, mode="talking")],
        150.0,
        seed=6,
        idle=True,
    )


def _thoughts() -> ScriptCase:
    """Return thoughts: long ones, one too short to lift a hand, one amid a stay."""
    modes = (
        ("thinking", 5.0), ("talking", 20.0), ("thinking", 34.0), ("listening", 35.5), ("thinking", 50.0),
        ("talking", 62.0), ("thinking", 80.0), ("idle", 95.0),
    )  # fmt: skip
    asks = [ask(f"m{n}", "mode", at, mode=mode) for n, (mode, at) in enumerate(modes)]
    asks.append(ask("s", "stance", 74.0, layer="arms", stance="at sides", stay=True))
    return make_case(
        "thoughts",
        "a hand goes to the chin in a long thought, and home after it; bursts of gestures and rests",
        asks,
        120.0,
        idle=True,
        times=(9.0, 15.3, 22.4, 41.7, 66.6, 90.2),
        alive=ALIVE,
    )


def _looks() -> Iterator[ScriptCase]:
    times = (0.5, 1.05, 1.3, 2.2, 3.6, 5.15, 7.9, 11.0)
    asks = [
        ask("l1", "look", 1.0, to=[0.8, 1.4, 0.9], duration=2.0),
        ask("l2", "look", 5.0, to="ahead", duration=1.5),
        ask("l3", "look", 7.0, to=[-1.0, 0.6, 0.2], amount=0.5),
    ]
    yield make_case(
        "looks",
        "eyes first, the head after; back when a look ends",
        asks,
        idle=False,
        times=times,
        alive=ALIVE,
    )
    near = [
        ask("l4", "look", 1.0, to=[0.06, 1.58, 0.2]),
        ask("l5", "look", 4.0, to=[0.0, 3.0, 0.4], duration=2.0),
    ]
    yield make_case(
        "something near",
        "what is nearer than a hand is looked at as if it were farther",
        near,
        times=times,
        alive=ALIVE,
    )
    asks = [
        ask("s1", "look", 1.0, to="thing", strict=True),
        ask("p1", "place", 0.0, name="thing", point=[0.5, 1.0, 1.0]),
    ]
    asks += [
        ask(f"m{n}", "place", 2.0 + 0.25 * n, name="thing", point=[0.5 - 0.1 * n, 1.0 + 0.05 * n, 1.0])
        for n in range(8)
    ]
    asks += [ask("s2", "look", 6.0, to=[0.0, 1.5, -2.0], priority=0), ask("s3", "look", 8.0, to="user")]
    yield make_case(
        "a thing that moves",
        "strict looks do not avert; the gaze follows a named point",
        asks,
        times=times,
        alive=ALIVE,
    )


def _said() -> ScriptCase:
    asks = [
        ask("t1", "say", 1.0, text="Hello there, nice to see you!"),
        ask("t2", "say", 4.0, text="Größe, naïve Straße: 42", duration=2.0),
        ask("t3", "say", 5.0, text="This interrupts it."),
        ask("t4", "say", 9.0, text="日本 Ещё καλημέρα", priority=2),
        ask("t5", "say", 9.5, text="not said", priority=1),
    ]
    return make_case(
        "words that are said",
        "mouth shapes from letters; what interrupts, what is not said",
        asks,
        times=(1.2, 1.5, 2.0, 4.7, 5.3, 9.3, 9.8, 10.4),
        alive=ALIVE,
    )


def _cut_short() -> ScriptCase:
    long = (
        "This is a rather long sentence, which goes on and on, so that many of its syllables are "
        "stressed, and nobody stops it for a while."
    )
    asks = [
        ask("long", "say", 1.0, text=long),
        ask("cut", "say", 14.0, text="Nobody hears the end of this one, ever, at all."),
    ]
    steps = (ScriptStep(0.0, 24.0, tuple(asks)), ScriptStep(15.0, 24.0, (ask("w", "withdraw", what="cut"),)))
    return ScriptCase(
        "stressed syllables",
        "blinks on them; a mouth that is cut short closes",
        steps,
        times=(2.3, 5.1, 8.7, 15.11, 15.15, 15.2),
        alive=ALIVE,
    )


def _lines(project: Project) -> Iterator[ScriptCase]:
    said = list(project.lines)[:2]
    if not said:
        return
    asks = [ask(f"line{n}", "say", 1.0 + 6 * n, line=line) for n, line in enumerate(said)]
    yield make_case(
        "lines",
        "their sound's mouth shapes and their own requests",
        [*asks, ask("bare", "say", 14.0, line=said[0], gestures=False)],
        24.0,
        times=(1.3, 1.9, 2.6, 7.4, 14.5, 15.2),
        alive=ALIVE,
    )
