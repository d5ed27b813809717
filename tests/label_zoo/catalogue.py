"""The sets there are: some named, for each class of trouble at least one, and as many more as one draws."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from tests.label_zoo.bodies import SEATED, Whole
from tests.label_zoo.grammar import SIDES, TO, Grammar
from tests.label_zoo.motions import Recording
from tests.label_zoo.rigs import Figure
from tests.label_zoo.sets import MadeSet, Recipe, make
from tests.label_zoo.source import ARMS, BODY, HEAD

ALL = (*ARMS, *BODY, *HEAD)
FEW = ("hands_at_sides", "arms_crossed", "on_hips", "weight_both", "weight_left", "straight")
STANDING = (Whole(), Whole("weight_left", "on_hips"), Whole("weight_right", "arms_crossed"))
SITTING = (Whole("sit"), Whole("sit_back", "arms_crossed"), Whole("sit_forward", "hands_clasped"))
MIXED = (Whole(), Whole("sit"), Whole("lean_wall", "arms_crossed"), Whole("lean_forward", "on_hips"))
ARMED = (Whole(), Whole(arms="hands_clasped"), Whole(arms="hand_to_chin"), Whole(arms="on_hips"))
CLOSE = (Whole(), Whole(near=1, apart=0.07), Whole(near=2, apart=0.06))
CLOSE_BODIES = (Whole(), Whole("weight_left"), Whole("weight_right"))
MOCAP = Recording(fps=60, noise=0.3, drift=0.05, warp=0.6, sizes=(0.7, 1.3), trim=4, strewn=True)
STUDIO = Grammar("ChrX@", style="camel", numbered="Idle", together=True)
SEATS = Grammar("ChrX@", style="camel", numbered="IdleSeated", together=True)
TALL = (("arms", 1.15), ("legs", 1.2), ("trunk", 1.05))
CHILD = (("arms", 0.7), ("legs", 0.62), ("trunk", 0.75), ("shoulders", 0.75), ("head", 1.3))

RECIPES: Mapping[str, Recipe] = {
    # The figure and the file
    "proportions of a child": Recipe(ALL, figure=Figure(limbs=CHILD)),
    "long limbs on mixamo": Recipe(FEW, figure=Figure("mixamo", TALL, "T", "bones")),
    "biped with axes along bones": Recipe(
        FEW, figure=Figure("biped", rest="I", axes="bones", extra=("root",))
    ),
    "unreal with twists and props": Recipe(FEW, figure=Figure("unreal", extra=("root", "twist", "props"))),
    "no turns at rest, no fingers": Recipe(
        FEW, figure=Figure("lower", rest="T", axes="none", missing=("fingers", "face", "toes"))
    ),
    "random axes, a turned rest": Recipe(FEW, figure=Figure("letters", rest="turned", axes="random", seed=3)),
    "few joints": Recipe(
        FEW, figure=Figure("blender", missing=("fingers", "face", "shoulders", "upper chest"))
    ),
    "japanese joints": Recipe(FEW, figure=Figure("japanese", axes="none", missing=("face",))),
    "a hundred times too large": Recipe(FEW, recording=Recording(size=100.0)),
    "film rate": Recipe(FEW, recording=Recording(fps=24, trim=2)),
    "cameras at 120": Recipe(FEW, recording=Recording(fps=120, noise=0.4)),
    "bind keys at both ends": Recipe(
        FEW, figure=Figure("mixamo", rest="T"), recording=Recording(bind=("before", "after"))
    ),
    # The recording
    "trembling": Recipe(ALL, recording=Recording(noise=0.7)),
    "gestures that do not return": Recipe(FEW, recording=Recording(drift=0.06)),
    "large and slow, small and fast": Recipe(FEW, recording=Recording(sizes=(0.6, 1.5), warp=1.0)),
    "mirrored": Recipe(ALL, recording=Recording(mirrored=True)),
    "strewn over the floor": Recipe(FEW, recording=Recording(strewn=True, trim=3), steps=4),
    # Recordings of the whole body
    "standing talker": Recipe(wholes=STANDING),
    "standing talker by number": Recipe(wholes=STANDING, grammar=STUDIO),
    "numbers of unseen stances": Recipe(wholes=STANDING, grammar=STUDIO, unseen=0.67, clips=14),
    "arms tell the stances": Recipe(wholes=ARMED, grammar=Grammar(style="Snake", side="L")),
    "sitting talker": Recipe(wholes=SITTING, grammar=SEATS),
    "seats by posture": Recipe(
        wholes=(Whole("sit"), Whole("sit_back"), Whole("sit_forward"), Whole("sit_back", near=1)),
        grammar=Grammar("ChrX@", "synonym", style="camel", numbered="Idle{}", together=True, side="Lf"),
        unseen=0.5,
    ),
    "seats by letter": Recipe(
        wholes=SITTING,
        grammar=Grammar(style="Snake", numbered="Sit_@", side="L"),
        recording=Recording(noise=0.3),
    ),
    "arms alone": Recipe(ARMS, unlinked=0.0, grammar=Grammar(to="glued", style="camel", side="none")),
    "sitting without legs": Recipe(
        wholes=SITTING, grammar=SEATS, figure=Figure("biped", missing=("legs", "face")), unseen=0.34
    ),
    "sitting, leaning, standing": Recipe(wholes=MIXED, recording=MOCAP, steps=3),
    "close stances": Recipe(wholes=CLOSE, grammar=STUDIO),
    "close stances, unseen, recorded": Recipe(
        wholes=CLOSE, grammar=STUDIO, unseen=0.67, recording=Recording(noise=0.4, drift=0.03)
    ),
    "weight shifts only": Recipe(wholes=CLOSE_BODIES, grammar=Grammar(style="kebab", to="from to")),
    "one stance and exercises": Recipe(
        wholes=(Whole(),), steps=16, clips=14, recording=Recording(strewn=True)
    ),
    # The names
    "generic adult": Recipe(
        wholes=STANDING, grammar=Grammar("generic mle adult ", style="space", side="left", take="1", to="2")
    ),
    "codes before and takes behind": Recipe(
        FEW,
        grammar=Grammar("A_CH01_", style="Snake", side="none", take="001", to="trans", order="action first"),
    ),
    "names without stances": Recipe(
        wholes=STANDING, grammar=Grammar("m_", order="action only", to="To only")
    ),
    "the first stance unsaid": Recipe(FEW, grammar=Grammar(silent=True, to="To only", style="camel")),
    "dots and synonyms": Recipe(wholes=ARMED, grammar=Grammar(language="synonym", style="dots", side="l")),
    "german names": Recipe(FEW, grammar=Grammar(language="de", side="de", style="Snake")),
    "french names": Recipe(wholes=STANDING, grammar=Grammar(language="fr", side="fr", style="space")),
    "spanish names": Recipe(wholes=SITTING, grammar=Grammar(language="es", side="es", accents=False)),
    "italian names": Recipe(FEW, grammar=Grammar(language="it", style="kebab", side="none")),
    "portuguese names": Recipe(wholes=STANDING, grammar=Grammar(language="pt", style="camel", side="none")),
    "japanese in latin letters": Recipe(wholes=STANDING, grammar=Grammar(language="romaji", side="L")),
    "japanese names": Recipe(FEW, grammar=Grammar(language="ja", side="ja", to="to")),
    "chinese in latin letters": Recipe(wholes=SITTING, grammar=Grammar(language="pinyin", side="l")),
    "chinese names": Recipe(FEW, grammar=Grammar(language="zh", side="zh", style="snake")),
    "opaque takes": Recipe(wholes=STANDING, grammar=Grammar(opaque="take_0{}"), recording=MOCAP),
    "opaque days of sitting": Recipe(wholes=SITTING, grammar=Grammar(opaque="mocap_day2_{}"), steps=2),
    "two names swapped": Recipe(FEW, wrong=0.03),
    "many wrong names": Recipe(wholes=STANDING, wrong=0.2),
    "all at once": Recipe(
        wholes=MIXED,
        grammar=Grammar("PRJ_m_", language="synonym", style="camel", numbered="Pose", side="L", take="1"),
        figure=Figure("unreal", CHILD, "T", "random", ("fingers", "face"), ("root", "twist"), 9),
        recording=MOCAP,
        steps=4,
        unseen=0.5,
        wrong=0.06,
    ),
}


@lru_cache(maxsize=6)  # a set is tens of megabytes; the tests of a file go through few
def named(name: str) -> MadeSet:
    """Make a set of RECIPES. Raises KeyError if there is none of that name."""
    return make(name, RECIPES[name], 0)


def named_sets(names: Collection[str] | None = None) -> Iterator[MadeSet]:
    """Make the named sets, all or some, one after another."""
    for name in RECIPES if names is None else names:
        yield named(name)


def made_sets(count: int, seed: int = 0) -> Iterator[MadeSet]:
    """Make so many sets whose troubles are drawn; the first ones of more are those of fewer."""
    for n in range(count):
        yield make(f"drawn {seed}-{n}", drawn(seed, n), seed)


def drawn(seed: int, number: int) -> Recipe:
    """Return the recipe of a drawn set."""
    draw = np.random.default_rng([seed, number, 11])

    def one(*values: Any) -> Any:
        return values[int(draw.integers(len(values)))]

    def maybe(share: float, value: Any, otherwise: Any) -> Any:
        return value if draw.random() < share else otherwise

    wholes, layers = (), ()
    if draw.random() < 0.65:
        wholes = _wholes(draw)
    else:
        some = [
            tuple(draw.permutation(x)[: draw.integers(1, len(x) + 1)].tolist()) for x in (ARMS, BODY, HEAD)
        ]
        layers = tuple(stance for stances in some for stance in stances)
    language = maybe(0.45, "en", one("synonym", "de", "fr", "es", "it", "pt", "romaji", "pinyin", "ja", "zh"))
    side = language if language in SIDES else one("Lf", "L", "left", "l", "Left", "none")
    seated = any(w.body in SEATED for w in wholes)
    grammar = Grammar(
        prefix=one("", "", "ChrX@", "generic fem adult ", "A_CH01_", "m_", "Hero|", "MOB1_"),
        language=language,
        style=one("snake", "camel", "kebab", "space", "dots", "title space", "Snake", "UPPER"),
        side=side,
        order=one("stance first", "stance first", "action first", "action only"),
        silent=draw.random() < 0.15,
        numbered=maybe(
            0.35, one("Idle", "Pose", "IdleSeated" if seated else "Stand", "St", "Idle{}", "Pose_@"), ""
        ),
        together=draw.random() < 0.2,
        to=one(*TO),
        loop=one("", "", "loop", "idle", "base"),
        take=one("01", "01", "1", "001", "", "(1)"),
        opaque=maybe(0.1, one("take_{}", "mocap_day1_{}", "A{}", "Take {}"), ""),
        accents=draw.random() < 0.6,
    )
    figure = Figure(
        names=one("sample", "mixamo", "biped", "unreal", "blender", "letters", "lower"),
        limbs=tuple(
            (limb, float(draw.uniform(0.75, 1.3))) for limb in ("arms", "legs", "trunk", "shoulders")
        ),
        rest=one("A", "T", "I", "turned"),
        axes=one("world", "bones", "random", "none"),
        missing=tuple(
            part
            for part, share in (("fingers", 0.3), ("face", 0.5), ("toes", 0.2), ("shoulders", 0.15))
            if draw.random() < share
        )
        + (("legs",) if seated and all(w.body in SEATED for w in wholes) and draw.random() < 0.4 else ()),
        extra=tuple(part for part in ("root", "twist", "props") if draw.random() < 0.3),
        seed=number,
    )
    recording = Recording(
        fps=one(24.0, 25.0, 30.0, 30.0, 60.0, 120.0),
        noise=maybe(0.5, float(draw.uniform(0.1, 0.6)), 0.0),
        drift=maybe(0.5, float(draw.uniform(0.01, 0.06)), 0.0),
        warp=maybe(0.4, float(draw.uniform(0.2, 1.0)), 0.0),
        sizes=maybe(0.5, (0.6, 1.5), (1.0, 1.0)),
        trim=int(maybe(0.4, 4, 0)),
        strewn=draw.random() < 0.3,
        bind=maybe(0.15, one(("before",), ("after",), ("before", "after")), ()),
        mirrored=draw.random() < 0.3,
        size=maybe(0.1, one(100.0, 0.01), 1.0),
    )
    return Recipe(
        layers=layers,
        wholes=wholes,
        grammar=grammar,
        figure=figure,
        recording=recording,
        steps=int(maybe(0.4, draw.integers(1, 9), 0)),
        clips=int(draw.integers(4, 14)),
        unseen=maybe(0.4, float(draw.uniform(0.3, 1.0)), 0.0),
        unlinked=float(draw.uniform(0, 0.8)),
        wrong=maybe(0.15, 0.06, 0.0),
    )


def _wholes(draw: np.random.Generator) -> tuple[Whole, ...]:
    """Return one to four stances of the whole body, each another."""
    places = [SEATED, (*BODY, "lean_wall"), (*BODY, *SEATED, "lean_wall"), ("weight_both",)]
    among = places[int(draw.integers(len(places)))]
    out: list[Whole] = []
    for n in range(int(draw.integers(1, 5))):
        if out and draw.random() < 0.15:
            first = out[0]
            found = Whole(first.body, first.arms, first.head, n, float(draw.uniform(0.05, 0.08)))
        else:
            head = "straight" if draw.random() < 0.8 else str(draw.choice(HEAD))
            found = Whole(str(draw.choice(among)), str(draw.choice(ARMS)), head)
        if found not in out:
            out.append(found)
    return tuple(out)
