"""How alive a character is when nothing is asked of it: the amounts and rates of breathing, gaze, blinks and
lip sync.

Numbers of people, from the literature the defaults follow: 12 to 20 breaths a minute at rest; 17 blinks a
minute at rest and 26 in conversation (Bentivoglio et al. 1997); who speaks looks away for 1.96 s in each
4.75 s (Andrist et al. 2013); who listens looks at the other 75 % of the time (Argyle and Cook 1976).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, Any, get_type_hints

import msgspec
from msgspec import Meta, Struct

from metagraph.graph.words import MODES, Mode

Factor = Annotated[float, Meta(ge=0, le=4)]


class Manner(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """What a mode makes of the amounts and rates below: factors, 1 leaves them as they are."""

    breathing: Factor = 1.0
    breath_rate: Factor = 1.0
    aversion_rate: Factor = 1.0
    aversion_length: Factor = 1.0
    aversion_angle: Factor = 1.0
    saccades: Factor = 1.0
    saccade_rate: Factor = 1.0
    blinks: Factor = 1.0


# Who talks looks away for some 2 s at a time (Andrist et al. 2013), and at the other for 41 % of the time;
# who listens for three quarters of it (Argyle and Ingham). Where turns end with a look at the other, less is
# left for looks away: measured from poses in conversations, speakers look at the other for half of the time
# (`tests/benchmarks/bench_gaze.py`). Idle, ours: nobody speaks, so the gaze wanders longer and farther,
# and away half of the time. In conversation people blink 26 times a minute, at rest 17. Somebody who thinks
# before an answer looks away for 3.5 s, from 1.3 s before the first word (Andrist et al.), and is still.
# Somebody who reacts looks at the other; these numbers are ours.
MANNERS: Mapping[Mode, Manner] = MappingProxyType({
    "idle": Manner(aversion_rate=1.1, aversion_length=2.4, aversion_angle=1.4, saccade_rate=0.85),
    "listening": Manner(
        aversion_rate=1.0, aversion_length=1.5, aversion_angle=1.1, saccades=0.9, blinks=1.45
    ),
    "talking": Manner(
        breathing=1.15,
        breath_rate=1.1,
        aversion_rate=1.35,
        aversion_length=2.3,
        aversion_angle=1.3,
        blinks=0.65,
    ),
    "thinking": Manner(
        breathing=0.8,
        aversion_rate=1.1,
        aversion_length=3.8,
        aversion_angle=1.3,
        saccades=0.7,
        saccade_rate=0.6,
    ),
    "reacting": Manner(breathing=1.2, aversion_rate=0.2, aversion_angle=0.6, saccades=0.7, blinks=1.6),
})  # fmt: skip


class Life(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """The life layers' settings; what each means, and which value turns it off, says `DIALS`.

    on: whether they play at all. stillness: multiplies every amount by 1 - stillness and stretches the time
    between events; at 1 nothing moves of itself, only lips and what is requested. modes: changes to
    `MANNERS`, by mode. valence, arousal, intensity: the mood where no request tells another.
    """

    on: bool = True
    stillness: Annotated[float, Meta(ge=0, le=1)] = 0.0
    breathing: Annotated[float, Meta(ge=0, le=2)] = 1.0
    breath_rate: Annotated[float, Meta(ge=0, le=40)] = 14.0
    gaze: Annotated[float, Meta(ge=0, le=1)] = 1.0
    head_share: Annotated[float, Meta(ge=0, le=1)] = 0.6
    aversion_rate: Annotated[float, Meta(ge=0, le=40)] = 12.0
    aversion_length: Annotated[float, Meta(ge=0, le=5)] = 0.93
    aversion_angle: Annotated[float, Meta(ge=0, le=40)] = 14.0
    saccades: Annotated[float, Meta(ge=0, le=2)] = 1.0
    saccade_rate: Annotated[float, Meta(ge=0, le=180)] = 60.0
    lids: Annotated[float, Meta(ge=0, le=2)] = 1.0
    blinks: Annotated[float, Meta(ge=0, le=60)] = 17.0
    accent_blinks: Annotated[float, Meta(ge=0, le=1)] = 0.7
    blink_close: Annotated[float, Meta(ge=0.02, le=1)] = 0.07
    blink_open: Annotated[float, Meta(ge=0.02, le=1)] = 0.10
    lips: Annotated[float, Meta(ge=0, le=2)] = 1.0
    lip_smoothing: Annotated[float, Meta(ge=0, le=0.2)] = 0.03
    follow_through: Annotated[float, Meta(ge=0, le=2)] = 1.0
    shoulder_lift: Annotated[float, Meta(ge=0, le=2)] = 1.0
    planted_feet: Annotated[float, Meta(ge=0, le=1)] = 1.0
    expressions: Annotated[float, Meta(ge=0, le=2)] = 1.0
    accent_brows: Annotated[float, Meta(ge=0, le=1)] = 0.4
    valence: Annotated[float, Meta(ge=-1, le=1)] = 0.0
    arousal: Annotated[float, Meta(ge=-1, le=1)] = 0.0
    intensity: Annotated[float, Meta(ge=0, le=2)] = 1.0
    modes: dict[Mode, Manner] = {}


@dataclass(frozen=True)
class Dial:
    """One number of `Life` or `Manner` as animators see it. name: the field. off: the value that turns it
    off, None for a number that is no amount. The ranges are the fields' own; the default is the field's (for
    a manner, `MANNERS`').
    """

    name: str
    group: str
    label: str
    unit: str
    low: float
    high: float
    step: float
    off: float | None
    tip: str


DIALS: tuple[Dial, ...] = (
    Dial(
        "stillness",
        "All",
        "Stillness",
        "",
        0,
        1,
        0.01,
        0,
        "Calms everything at once; at 1, only the lips and requested actions move.",
    ),
    Dial(
        "valence",
        "Mood",
        "Valence",
        "",
        -1,
        1,
        0.01,
        None,
        "Valence: from unpleasant to pleasant; 0 plays the clips as they are.",
    ),
    Dial(
        "arousal",
        "Mood",
        "Arousal",
        "",
        -1,
        1,
        0.01,
        None,
        "Arousal: from tired to excited; 0 plays the clips as they are.",
    ),
    Dial(
        "intensity",
        "Mood",
        "Intensity",
        "×",
        0,
        2,
        0.01,
        None,
        "How large gestures play; 1 is as in the clips.",
    ),
    Dial("breathing", "Breathing", "Depth", "×", 0, 2, 0.05, 0, "How far chest and shoulders rise."),
    Dial("breath_rate", "Breathing", "Breaths", "/ min", 0, 40, 0.5, 0, "People at rest: 12 to 20."),
    Dial(
        "gaze",
        "Gaze",
        "Look-at",
        "",
        0,
        1,
        0.01,
        0,
        "How far the eyes and head turn towards the gaze target.",
    ),
    Dial(
        "head_share",
        "Gaze",
        "Head share",
        "",
        0,
        1,
        0.01,
        0,
        "How much of a wide turn the head makes; the eyes do the rest.",
    ),
    Dial(
        "aversion_rate",
        "Gaze",
        "Looks away",
        "/ min",
        0,
        40,
        0.5,
        0,
        "How often the gaze leaves the conversation partner for a moment.",
    ),
    Dial("aversion_length", "Gaze", "Time away", "s", 0, 5, 0.05, 0, "How long the gaze stays away."),
    Dial(
        "aversion_angle",
        "Gaze",
        "Angle away",
        "°",
        0,
        40,
        0.5,
        0,
        "How far from the partner's face the gaze goes.",
    ),
    Dial(
        "saccades",
        "Eyes",
        "Eye darts",
        "×",
        0,
        2,
        0.05,
        0,
        "Size of the small jumps that the eyes make while they look.",
    ),
    Dial("saccade_rate", "Eyes", "Darts", "/ min", 0, 180, 1, 0, "How often the eyes jump."),
    Dial(
        "lids", "Eyes", "Lids follow", "×", 0, 2, 0.05, 0, "How far the eyelids follow the eyes down and up."
    ),
    Dial(
        "blinks",
        "Blinks",
        "Blinks",
        "/ min",
        0,
        60,
        0.5,
        0,
        "Spontaneous blinks; people at rest: 17.",
    ),
    Dial(
        "accent_blinks",
        "Blinks",
        "On stressed words",
        "",
        0,
        1,
        0.01,
        0,
        "Which share of the stressed syllables triggers a blink.",
    ),
    Dial("blink_close", "Blinks", "Closing", "s", 0.02, 1, 0.01, None, "How long the lids take to close."),
    Dial(
        "blink_open", "Blinks", "Opening", "s", 0.02, 1, 0.01, None, "How long the lids take to open again."
    ),
    Dial(
        "lips", "Lips", "Lip sync", "×", 0, 2, 0.05, 0, "How far the mouth opens and changes shape in speech."
    ),
    Dial(
        "lip_smoothing",
        "Lips",
        "Smoothing",
        "s",
        0,
        0.2,
        0.005,
        0,
        "Higher values give softer lip motion; too much looks like mumbling.",
    ),
    Dial(
        "follow_through",
        "Weight",
        "Follow-through",
        "×",
        0,
        2,
        0.05,
        0,
        "How far hips, spine and legs react to the weight of the arms. The feet stay where they are.",
    ),
    Dial(
        "shoulder_lift",
        "Weight",
        "Shoulders",
        "×",
        0,
        2,
        0.05,
        0,
        "How far the collarbones rise with raised arms, if the clip does not move them.",
    ),
    Dial(
        "planted_feet",
        "Weight",
        "Planted feet",
        "",
        0,
        1,
        0.01,
        0,
        "How firmly planted feet stay in place during blends. They step if the poses need them elsewhere.",
    ),
    Dial(
        "expressions",
        "Face",
        "Expressions",
        "×",
        0,
        2,
        0.05,
        0,
        "How much the brows and the smile move; at 0, the face of a mood stays still.",
    ),
    Dial(
        "accent_brows",
        "Face",
        "Brows on stress",
        "",
        0,
        1,
        0.01,
        0,
        "Which share of the stressed syllables raises the brows.",
    ),
)
MANNER_DIALS: tuple[Dial, ...] = (
    Dial("breathing", "Breathing", "Depth", "×", 0, 4, 0.05, 0, "Breathing depth in this mode."),
    Dial("breath_rate", "Breathing", "Breaths", "×", 0, 4, 0.05, 0, "Breaths per minute in this mode."),
    Dial(
        "aversion_rate",
        "Gaze",
        "Looks away",
        "×",
        0,
        4,
        0.05,
        0,
        "How often the gaze leaves the conversation partner in this mode.",
    ),
    Dial(
        "aversion_length",
        "Gaze",
        "Time away",
        "×",
        0,
        4,
        0.05,
        0,
        "How long the gaze stays away in this mode.",
    ),
    Dial(
        "aversion_angle",
        "Gaze",
        "Angle away",
        "×",
        0,
        4,
        0.05,
        0,
        "How far from the partner's face the gaze goes in this mode.",
    ),
    Dial("saccades", "Eyes", "Eye darts", "×", 0, 4, 0.05, 0, "Size of the small eye jumps in this mode."),
    Dial("saccade_rate", "Eyes", "Darts", "×", 0, 4, 0.05, 0, "How often the eyes jump in this mode."),
    Dial("blinks", "Blinks", "Blinks", "×", 0, 4, 0.05, 0, "Blinks per minute in this mode."),
)


def get_manner(life: Life, mode: Mode) -> Manner:
    """Return what a mode makes of the amounts: the project's own, else the default."""
    return life.modes.get(mode, MANNERS[mode])


def scaled(
    ways: Manner,
    breathing: float,
    breath_rate: float,
    aversion_rate: float,
    saccade_rate: float,
    blinks: float,
) -> Manner:
    """Return what a mode makes of the amounts, each that a mood changes times a factor."""
    return msgspec.structs.replace(
        ways,
        breathing=ways.breathing * breathing,
        breath_rate=ways.breath_rate * breath_rate,
        aversion_rate=ways.aversion_rate * aversion_rate,
        saccade_rate=ways.saccade_rate * saccade_rate,
        blinks=ways.blinks * blinks,
    )


def is_same_life(one: Life | None, other: Life) -> bool:
    """Return whether two are the same settings."""
    return one is other or one == other


def list_limits(kind: type[Struct]) -> dict[str, tuple[float, float]]:
    """Return the range of each number of `Life` or `Manner`."""
    out = {}
    for name, hint in get_type_hints(kind, include_extras=True).items():
        meta = next((m for m in getattr(hint, "__metadata__", ()) if isinstance(m, Meta)), None)
        if meta is not None and meta.ge is not None and meta.le is not None:
            out[name] = (float(meta.ge), float(meta.le))
    return out


def with_life(life: Life, mode: Mode | None = None, **changes: Any) -> Life:
    """Return the settings with fields changed; those of one mode's manner where `mode` is given.

    Raises ValueError naming a field that does not exist or a value outside its range.
    """
    if mode is None:
        out: Life = _checked(life, changes)
        return out
    if mode not in MODES:
        raise ValueError(f"there is no mode '{mode}'; modes are {', '.join(MODES)}")
    return msgspec.structs.replace(
        life, modes={**life.modes, mode: _checked(get_manner(life, mode), changes)}
    )


def _checked(value: Any, changes: Mapping[str, Any]) -> Any:
    fields = {f.name for f in msgspec.structs.fields(type(value))}
    for name in changes:
        if name not in fields:
            raise ValueError(f"there is no dial '{name}'; dials are {', '.join(sorted(fields))}")
    whole = msgspec.structs.replace(value, **changes)
    try:
        return msgspec.convert(
            {name: msgspec.to_builtins(getattr(whole, name)) for name in fields}, type(value)
        )
    except msgspec.ValidationError as error:
        text, _, where = str(error).partition(" - at ")
        raise ValueError(f"{where.strip('`$.')}: {text[:1].lower()}{text[1:]}") from None


class FacePose(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A frame of a clip that shows a face's channel in full. clip: id. frame: null for the frame that differs
    most from `neutral`, the frame that shows the face without it.
    """

    clip: str
    frame: Annotated[int, Meta(ge=0)] | None = None
    neutral: Annotated[int, Meta(ge=0)] = 0


class Face(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """Corrections of what was found in the face. channels: channel -> name of the
    joint or morph target that moves it, "" for nothing. poses: channel -> the frame of a clip that shows it.
    morphs: names of the character's morph targets, as last read from its file. names: what blend shapes of
    imported clips are called there -> what they are: a target, one of ARKit's shapes, another name that is
    known (`blendshape_names`), or "" for nothing.
    """

    channels: dict[str, str] = {}
    poses: dict[str, FacePose] = {}
    morphs: tuple[str, ...] = ()
    names: dict[str, str] = {}
