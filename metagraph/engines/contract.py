"""Define the exported JSON, field by field. These types write it, read it and publish its JSON Schema (draft
2020-12).

Times are seconds, lengths metres, Y up, right-handed; quaternions xyzw. An id is never a name and never
changes.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct

from metagraph.graph.life import Face, Life
from metagraph.graph.parameter import ChoiceValue, ParameterType
from metagraph.graph.requests import Line, Performance, Point
from metagraph.graph.touch import Touch

FORMAT = 1

Id = Annotated[str, Meta(min_length=1)]
Seconds = Annotated[float, Meta(ge=0, le=1e9)]
Number = Annotated[float, Meta(ge=-1e15, le=1e15)]
Count = Annotated[int, Meta(ge=0, le=1_000_000_000)]
Quaternion = Annotated[
    list[Annotated[float, Meta(ge=-2, le=2)]],
    Meta(min_length=4, max_length=4, description="xyzw, unit length"),
]
Vector = Annotated[
    list[Annotated[float, Meta(ge=-1e6, le=1e6)]], Meta(min_length=3, max_length=3, description="metres")
]
LayerName = Literal["body", "arms", "head"]
KindName = Literal["stance", "gesture", "fidget", "transition"]
LimbName = Literal["left", "right", "both"]
PartName = Literal["legs", "spine", "arms", "head", "face"]


class Joint(Struct, omit_defaults=True, forbid_unknown_fields=True):
    """A joint; parents come before their children. translation, rotation: local, of the rest pose. scales:
    whether it takes part if a cue is played larger or smaller than made: in both, only in smaller ones
    (elbows, which bend one way), or in neither (fingers).
    """

    name: str
    parent: str | None
    part: PartName
    side: Literal["left", "right", "centre"]
    translation: Vector
    rotation: Quaternion
    scales: Literal["both", "smaller", "neither"] = "both"


class ExportedClip(Struct, omit_defaults=True, forbid_unknown_fields=True, gc=False):
    """A clip. animation: its index in the GLB's list of animations, where it has the same name. sha256: of
    the file it came from. made_by, made_seed: the learned model that generated it, and its seed; left out for
    other clips. arms: what its arms weigh, a row of eight numbers for each tenth of a second; left out if the
    arms' layer does not play it, or no body answers its arms. feet: where its feet are and when they stand, a
    row of sixteen numbers for each tenth of a second, or one row for all; left out if the body's layer does
    not play it, or feet are not kept planted.
    """

    id: Id
    name: str
    animation: Count
    fps: Annotated[float, Meta(ge=1e-3, le=1e6)]
    frames: Annotated[int, Meta(ge=1, le=1_000_000_000)]
    duration: Seconds
    sha256: str
    made_by: str = ""
    made_seed: Annotated[int, Meta(ge=0)] = 0
    arms: list[Annotated[list[int], Meta(min_length=8, max_length=8)]] = []
    feet: list[Annotated[list[int], Meta(min_length=16, max_length=16)]] = []


class ExportedStance(Struct, forbid_unknown_fields=True):
    """A stance; its loops are the actions of kind "stance" under it in the index."""

    id: Id
    name: str


class ExportedContact(Struct, forbid_unknown_fields=True):
    """A hand kept in its place on the body. place: the part of it that touches. to: the name of a joint.
    start, end: clip seconds. ease_in, ease_out: seconds at the ends, inside, in which it comes and goes.
    keys: rows of clip seconds, position of the wrist in that joint's own space, metres (3), rotation of the
    hand there, xyzw (4).
    """

    hand: Literal["left", "right"]
    place: Literal["palm", "fingertips", "back", "wrist"]
    to: str
    start: Seconds
    end: Seconds
    ease_in: Seconds
    ease_out: Seconds
    keys: Annotated[
        list[Annotated[list[Number], Meta(min_length=8, max_length=8)]],
        Meta(min_length=1),
    ]


class ExportedAction(Struct, forbid_unknown_fields=True, gc=False):
    """One use of a clip. start, end: the part of the clip that plays (whole_end: the end is the clip's own).
    blend_in and blend_out are inside it; a stance's blend_in is the overlap at its loop's seam.
    earliest_exit: clip time from which it may be left, or null. joints: the only ones it moves, all if empty.
    phases: for a gesture, clip seconds of ready, stroke, stroke end and relax; own_phases: ready, stroke_end,
    relax as the user set them, null if found. cooldown: seconds in which it is not drawn again; spacing: how
    many others come between, null for as never_twice says. vigour: how fast its hands, head or trunk move
    beside the median of the layer's actions of its kind, -1 half as fast .. 1 twice as fast. prominence: how
    much it stands out, 0 hardly .. 1 much, which says how soon it is done again; own_prominence: as the user
    set it, null if measured. contacts: where its hands stay. joint_weights: how far joints move that move in
    part; 1 for those not listed. repeat: for how many seconds a gesture or fidget repeats its part if nobody
    says how long, left out of those that play once; its blends may be longer than the part.
    """

    id: Id
    name: str
    clip: Id
    kind: KindName
    stance: Id
    end_stance: str | None
    start: Seconds
    end: Seconds
    whole_end: bool
    blend_in: Seconds
    blend_out: Seconds
    loop: bool
    earliest_exit: Number | None
    stroke: Number | None
    limb: LimbName
    joints: list[str]
    tags: list[str]
    likelihood: Annotated[float, Meta(gt=0, le=1e15)]
    phases: Annotated[list[Seconds], Meta(max_length=4)] = []
    own_phases: Annotated[list[Number | None], Meta(max_length=3)] = []
    cooldown: Seconds = 0.0
    spacing: Annotated[int, Meta(ge=0, le=1000)] | None = None
    contacts: list[ExportedContact] = []
    vigour: Annotated[float, Meta(ge=-1, le=1)] = 0.0
    joint_weights: dict[str, Annotated[float, Meta(gt=0, le=1)]] = {}
    repeat: Seconds | msgspec.UnsetType = msgspec.UNSET
    prominence: Annotated[float, Meta(ge=0, le=1)] = 0.0
    own_prominence: Annotated[float, Meta(ge=0, le=1)] | None = None


class Transition(Struct, rename={"source": "from", "target": "to"}, forbid_unknown_fields=True):
    """The actions that lead directly from one stance to another."""

    source: Id
    target: Id
    actions: list[Id]


class ExportedMarkov(Struct, forbid_unknown_fields=True):
    """A model that writes meta actions. states: (limb, kind). matrix: rows of probabilities. gap: mean
    seconds of rest between meta actions. positive, negative: the share of gestures that ask for that tag.
    tags: the tags that each state asks for, separated by blanks; empty if no state asks for any. lengths: for
    each state mean and standard deviation in seconds, or empty. modes: a row each for idling, listening,
    talking, thinking and reacting with the shares of written gestures, fidgets and transitions that are
    performed; the last two may be left out; empty for all of them.
    """

    states: list[tuple[LimbName, KindName]]
    matrix: list[list[Annotated[float, Meta(ge=0, le=1)]]]
    gap: Annotated[float, Meta(ge=1e-3, le=1e9)]
    positive: Annotated[float, Meta(ge=0, le=1)]
    negative: Annotated[float, Meta(ge=0, le=1)]
    tags: list[str] = []
    lengths: list[
        Annotated[list[Annotated[float, Meta(ge=0, le=1e6)]], Meta(min_length=2, max_length=2)]
    ] = []
    modes: list[Annotated[list[Annotated[float, Meta(ge=0, le=1)]], Meta(min_length=3, max_length=3)]] = []


class ExportedLayer(Struct, forbid_unknown_fields=True):
    """One layer's meta-graph. weights: how strongly it moves each body part, 0 if not listed. index: the
    multi-index, stance -> kind -> action ids in the order they were placed. Weights and model are played as
    they are; own_weights, own_markov: which of them a user set, for programs that edit.
    """

    start: str | None
    weights: dict[PartName, Annotated[float, Meta(ge=0, le=2)]]
    own_weights: list[PartName]
    stances: list[ExportedStance]
    actions: list[ExportedAction]
    index: dict[str, dict[KindName, list[Id]]]
    transitions: list[Transition]
    markov: ExportedMarkov
    own_markov: bool


class Base(Struct, forbid_unknown_fields=True):
    """The pose that all offsets are relative to. clip, frame: where it came from; null for the rest pose.
    rotations and translations: local, one for each joint.
    """

    clip: str | None
    frame: Count
    rotations: list[Quaternion]
    translations: list[Vector]


class Planner(Struct, forbid_unknown_fields=True):
    """Constants of planning. alpha: added to an action's count when it is used; an action is drawn with
    probability likelihood / max(count, 1). never_twice: not the same action in a row if there is another.
    shortest: seconds below which the rest of a cut request is dropped. wait: how late a request may start.
    window: seconds for a request without a duration. blend: the curve of a blend's weight over its time x.
    memory: seconds after which a use no longer counts, 0 for never. rest: least seconds between two actions
    of a layer. lookahead: seconds ahead of now that stay as planned. hurry: how many times as fast as made a
    hold plays at most. least_blend: seconds in which an action blends in that skips its preparation. variety:
    factor of the times for which the model keeps from repeating itself, 0 for not at all.
    """

    seed: Annotated[int, Meta(ge=0, le=0xFFFFFFFF)]
    alpha: Annotated[float, Meta(ge=0, le=1e15)]
    never_twice: bool
    shortest: Seconds
    wait: Seconds
    window: Seconds
    loop_fade: Seconds
    blend: Literal["3x^2-2x^3"]
    memory: Annotated[float, Meta(ge=0, le=600)] = 0.0
    rest: Annotated[float, Meta(ge=0, le=600)] = 0.0
    lookahead: Annotated[float, Meta(ge=0, le=10)] = 0.1
    hurry: Annotated[float, Meta(ge=1, le=100)] = 2.0
    least_blend: Seconds = 0.25
    variety: Annotated[float, Meta(ge=0, le=4)] = 0.0


class Randomness(Struct, forbid_unknown_fields=True):
    """How draws are keyed. hash: FNV-1a over the words' UTF-8 bytes, each word closed by a zero byte, begun
    at offset xor mix(seed), then mixed; all in 32 bits. uniform: (hash + 0.5) / 2^32. pick: the candidate
    with the smallest -ln(uniform(seed, key, purpose, id)) / weight. test: the hash of seed 1 and the words
    "a", "b".
    """

    hash: Literal["fnv1a32-mix"]
    offset: int
    prime: int
    mix: list[int]
    test: int


class Expanded(Struct, rename={"targets": "to", "sources": "from"}, forbid_unknown_fields=True):
    """The ordinary state machine of a layer, in columns: connection n leads from `states[from[n]]` to
    `states[to[n]]`. leave: clip seconds at which the source may be left, -1 for any time. blend: seconds.
    """

    states: list[Id]
    sources: list[int]
    targets: list[int]
    leave: list[float]
    blend: list[float]


Radians = Annotated[
    list[Annotated[float, Meta(ge=-100, le=100)]],
    Meta(min_length=3, max_length=3, description="rotation vector, radians"),
]
Direction = Annotated[list[Annotated[float, Meta(ge=-2, le=2)]], Meta(min_length=3, max_length=3)]
Place = Annotated[int, Meta(ge=-1, le=1_000_000)]
Four = Annotated[list[Number], Meta(min_length=4, max_length=4)]


class RigEye(Struct, forbid_unknown_fields=True):
    """An eye, or its place if there is none, in the head's own space: where it is, and its directions to the
    left, up and ahead. joint: -1 for none. turn_left, turn_up: rotation vectors in the joint's own space that
    turn it by a radian. down: the dot product of these four with the joint's own rotation (w not negative) is
    how far down it looks already, radians.
    """

    at: Vector
    left: Direction
    up: Direction
    ahead: Direction
    joint: Place
    turn_left: Radians
    turn_up: Radians
    down: Four


class RigShoulder(Struct, forbid_unknown_fields=True):
    """A joint that breathing lifts or tension turns. turn: its rotation vector at the top of a breath, in its
    own space; tense: at full tension; closed: of arms kept close.
    """

    joint: Place
    turn: Radians
    tense: Radians = []
    closed: Radians = []


class RigLooker(Struct, forbid_unknown_fields=True):
    """A joint that takes part in turning the head: its place in the chain, and its share; all shares add up
    to 1.
    """

    place: Count
    share: Annotated[float, Meta(ge=0, le=1)]


class RigFace(Struct, forbid_unknown_fields=True):
    """What moves the face. joints: those that its channels move. turns: for each channel and joint a rotation
    vector in the joint's own space, multiplied on the right; shifts: metres in its parent's space; both at 1.
    The channels: upper_lid_left, upper_lid_right, lower_lid_left, lower_lid_right, blink, jaw_open, then the
    visemes without silence. follows: how far each lid shuts for an eye that looks down by a radian.
    lid_joints: the joint of each lid, -1 for none. shut_by: the dot product of these four with a lid's own
    rotation (w not negative) is how far it is shut already. morphs: channel -> morph target -> its weight at
    1.
    """

    joints: list[Count]
    turns: list[list[Radians]]
    shifts: list[list[Vector]]
    follows: Four
    lid_joints: Annotated[list[Place], Meta(min_length=4, max_length=4)]
    shut_by: Annotated[list[Four], Meta(min_length=4, max_length=4)]
    morphs: dict[str, dict[str, Number]]


class Rig(Struct, forbid_unknown_fields=True):
    """The parts of the body that breathe and look. left, up, ahead: the character's directions. chain: the
    joints from the root to the head. breath: for each of them the axis it turns about in its own space, and
    the radians at the top of a breath. trunk: its place in the chain; trunk_ahead, head_ahead: ahead in their
    own space. eyes: left, right. partner: where "user" is if no point has that name, metres; eyes_at_rest:
    between the eyes in the base pose. bowed: for each joint of the chain the radians of a bowed posture,
    about the axis of its breath; thrust: of one that leans into it; none if empty.
    """

    left: Direction
    up: Direction
    ahead: Direction
    chain: list[Count]
    breath: list[Four]
    shoulders: list[RigShoulder]
    lookers: list[RigLooker]
    trunk: Count
    trunk_ahead: Direction
    head_ahead: Direction
    eyes: Annotated[list[RigEye], Meta(min_length=2, max_length=2)]
    partner: Vector
    eyes_at_rest: Vector
    face: RigFace
    bowed: list[Number] = []
    thrust: list[Number] = []


class ExportedCapsule(Struct, forbid_unknown_fields=True):
    """A part of the body. joint, to: places in the contact rig's joints that the ends of its line are fixed
    to; a, b: where, in their own spaces, metres. arm: 0 left, 1 right, -1 neither. kind: 0 for what hands are
    pushed out of, 1 for a forearm, from elbow to wrist, 2 for a part of a hand.
    """

    joint: Count
    a: Vector
    to: Count
    b: Vector
    radius: Annotated[float, Meta(gt=0, le=1e3)]
    arm: Annotated[int, Meta(ge=-1, le=1)]
    kind: Annotated[int, Meta(ge=0, le=2)]


class ExportedContactRig(Struct, forbid_unknown_fields=True):
    """What keeps hands on the body, and outside it. contacts, guard: which of the two is on. joints: those
    that are needed, parents first; parents: the place of each one's parent among them, -1 for a root. arms:
    left, right: places of upper arm, lower arm, hand.
    """

    contacts: bool
    guard: bool
    joints: list[Count]
    parents: list[Place]
    arms: Annotated[
        list[Annotated[list[Count], Meta(min_length=3, max_length=3)]], Meta(min_length=2, max_length=2)
    ]
    capsules: list[ExportedCapsule]


class ExportedWeightBend(Struct, forbid_unknown_fields=True):
    """A joint that turns with the weight of the arms. place: in the weight rig's joints. left, up, ahead: the
    character's directions in its own space. share: of the hips' turn, below 0 against it.
    """

    place: Count
    left: Direction
    up: Direction
    ahead: Direction
    share: Number


class ExportedWeightCollar(Struct, forbid_unknown_fields=True):
    """A collar bone that rises with its arm. place, upper: places of it and of the upper arm. axis: the axis
    that lifts it, in its own space. side: 0 left, 1 right.
    """

    place: Count
    upper: Count
    axis: Direction
    side: Annotated[int, Meta(ge=0, le=1)]


class ExportedWeightRig(Struct, omit_defaults=True, forbid_unknown_fields=True):
    """The parts of the body that answer its arms. joints: those that are needed, parents first; parents: the
    place of each one's parent among them, -1 if that is not needed. legs: left, right: places of upper leg,
    lower leg, foot. hands: names of the hands' joints. bends: the hips first. knees: the direction in which
    straight legs bend, in the upper legs' own spaces. levers: how far to the left and ahead of the hips each
    arm is, metres. height: of the figure. strength: how much the motion of the arms' layer counts.
    feet_layer: the layer that moves the legs, whose clips have `feet`.
    """

    joints: list[Count]
    parents: list[Place]
    legs: Annotated[
        list[Annotated[list[Count], Meta(min_length=3, max_length=3)]], Meta(min_length=2, max_length=2)
    ]
    hands: Annotated[list[str], Meta(min_length=2, max_length=2)]
    bends: Annotated[list[ExportedWeightBend], Meta(min_length=1)]
    collars: list[ExportedWeightCollar]
    knees: Annotated[list[Direction], Meta(min_length=2, max_length=2)]
    levers: Annotated[
        list[Annotated[list[Number], Meta(min_length=2, max_length=2)]], Meta(min_length=2, max_length=2)
    ]
    up: Direction
    height: Annotated[float, Meta(gt=0)]
    strength: Annotated[float, Meta(ge=0, le=1)]
    feet_layer: LayerName = "body"


class ExportedVoice(Struct, forbid_unknown_fields=True):
    """A line's analysed sound. accents: times of its stressed syllables. weights: how much of each of the 15
    visemes (sil, PP, FF, TH, DD, kk, CH, SS, nn, RR, aa, E, I, O, U) the mouth shows, rows evenly spaced from
    0 to the duration (at least 1 ms).
    """

    duration: Seconds
    accents: list[Seconds]
    weights: Annotated[
        list[Annotated[list[Annotated[float, Meta(ge=0, le=1)]], Meta(min_length=15, max_length=15)]],
        Meta(min_length=2),
    ]


class ExportedChoice(Struct, forbid_unknown_fields=True):
    """A word that a parameter may be set to. value: what it puts into the request's field."""

    name: Id
    value: ChoiceValue


class ExportedParameter(Struct, omit_defaults=True, forbid_unknown_fields=True):
    """A named value that a game sets. request: what that requests, as JSON. field: of the request, which the
    value goes into; "" for a trigger. initial: the value until it is set; null for a trigger. choices: of an
    enum or a list; of a boolean what it does when off, then when on. least, most: of a number. beside: other
    parameters whose values, if they were set, go into the same request. replaces: others that are bound to
    the same; they are as if they were not set, once it is.
    """

    type: ParameterType
    request: dict[str, Any]
    field: str = ""
    initial: float | bool | str | list[str | float] | None = None
    choices: list[ExportedChoice] = []
    least: Number = 0.0
    most: Number = 1.0
    about: str = ""
    beside: list[str] = []
    replaces: list[str] = []


class Export(Struct, omit_defaults=True, forbid_unknown_fields=True):
    """A Metagraph export: this JSON and the GLB it names."""

    metagraph: Annotated[int, Meta(ge=1, le=FORMAT, description="version of this format")]
    name: str
    glb: str
    height: Annotated[float, Meta(gt=0, description="of the skeleton's rest pose, metres")]
    order: Annotated[
        list[LayerName],
        Meta(description="in which layers' offsets are multiplied onto the base pose, from the left"),
    ]
    joints: list[Joint]
    base: Base
    clips: list[ExportedClip]
    layers: dict[LayerName, ExportedLayer]
    planner: Planner
    randomness: Randomness
    roles: dict[str, str] = {}
    parts: dict[str, PartName] = {}
    expanded: dict[LayerName, Expanded] | None = None
    life: Life = Life()
    face: Face = Face()
    points: dict[str, Point] = {}
    lines: dict[str, Line] = {}
    performances: dict[str, Performance] = {}
    rig: Rig | None = None
    voices: dict[str, ExportedVoice] = {}
    touch: Touch = Touch()
    contact_rig: ExportedContactRig | None = None
    weight_rig: ExportedWeightRig | None = None
    parameters: dict[str, ExportedParameter] = {}
    glb_bytes: Annotated[
        int | None,
        Meta(description="the length of the GLB that belongs to this JSON; null in older exports"),
    ] = None
    glb_sha256: Annotated[str | None, Meta(description="its SHA-256 in hex; null in older exports")] = None
    exporter: Annotated[
        str | None, Meta(description='the program that wrote it: "Metagraph 0.1.0"; null in older exports')
    ] = None


def export_schema() -> dict[str, Any]:
    """Return the JSON Schema of an export."""
    out = msgspec.json.schema(Export)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Metagraph export",
        "description": "Times are seconds, lengths metres, Y up, right-handed; quaternions are xyzw.",
        **out,
    }
