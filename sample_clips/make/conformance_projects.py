"""Small characters that have something of everything, which conformance vectors are made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import edits
from metagraph.graph.editing.parameters import set_parameter
from metagraph.graph.face.rig import with_morphs
from metagraph.graph.life import Life, Manner
from metagraph.graph.model import Action, Kind, Layer, Limb, Markov, Project
from metagraph.graph.parameter import CharacterParameter, make_parameter_choices
from metagraph.graph.requests import Feel, Gesture, Go, Line, Look, Nod, Place
from metagraph.graph.touch import Touch
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.contact_spans import ContactKey, ContactSpan
from metagraph.motion.skeleton import Skeleton
from metagraph.playback.life.voice import guess_voice
from sample_clips.make.mannequin_skeleton import mannequin_skeleton
from sample_clips.make.numbered_ids import numbered_ids

Array = NDArray[np.float64]

LEFT_OUT = (
    "Thumb",
    "Index",
    "Middle",
    "Ring",
    "Little",
    "Brow",
    "LowerLid",
    "Toes",
    "Leg",
    "Foot",
    "UpperChest",
)
FPS = 24.0
BINARY_FPS = 32.0  # of characters that are `size`d: times of frames are exact in any language
BOTH_EYES = (  # shut by one target, and what the other set leaves out
    "blink",
    "eyeWideRight",
    "eyeLookInLeft",
    "eyeLookOutLeft",
    "eyeLookUpRight",
    "eyeLookInRight",
    "eyeLookOutRight",
    "jawOpen",
    "aa",
    "ih",
    "ou",
    "ee",
    "oh",
)
MORPHS = (  # of faces that have no joints
    "eyeBlinkLeft",
    "eyeBlinkRight",
    "eyeWideLeft",
    "eyeLookUpLeft",
    "eyeLookDownLeft",
    "eyeLookInLeft",
    "eyeLookOutLeft",
    "eyeLookUpRight",
    "eyeLookDownRight",
    "jawOpen",
    "mouthFunnel",
    "mouthPucker",
    "viseme_aa",
    "viseme_PP",
    "mouthPressLeft",
    "mouthRollLower",
    "mouthUpperUpLeft",
    "mouthSmileLeft",
    "mouthSmileRight",
    "mouthFrownLeft",
    "browInnerUp",
    "browDownLeft",
    "browOuterUpRight",
    "cheekSquintLeft",
)


def stick_skeleton(more: tuple[str, ...] = (), legs: bool = False, rooted: bool = False) -> Skeleton:
    """Return the mannequin's skeleton with few joints, each turned some way, so that no rest rotation is the
    identity. more: parts of the names of joints that are left out as well. legs: those are there. rooted: the
    hips have a joint above them, on the floor.
    """
    without = [word for word in (*LEFT_OUT, *more) if not (legs and word in ("Leg", "Foot"))]
    whole = mannequin_skeleton()
    _, at = whole.globals(whole.rest)
    kept = [i for i, name in enumerate(whole.names) if not any(word in name for word in without)]
    names = [whole.names[i] for i in kept]
    parents = []
    for i in kept:
        up = int(whole.parents[i])
        while up >= 0 and up not in kept:
            up = int(whole.parents[up])
        parents.append(kept.index(up) if up >= 0 else -1)
    chance = np.random.default_rng(4)
    turns = rotation.exp(chance.normal(0.0, 0.25, (len(kept), 3)))
    positions = at[kept]
    local_r, local_t = np.array(turns), np.array(positions)
    for n, up in enumerate(parents):
        if up >= 0:
            back = rotation.conjugate(turns[up])
            local_r[n] = rotation.multiply(back, turns[n])
            local_t[n] = rotation.rotate_vectors(back, positions[n] - positions[up])
    if rooted:
        turn = rotation.exp(np.array([[0.2, -0.4, 0.1]]))
        back = rotation.conjugate(turn[0])
        local_r[0] = rotation.multiply(back, local_r[0])
        local_t[0] = rotation.rotate_vectors(back, local_t[0])
        names, parents = ["Root", *names], [-1, *(up + 1 for up in parents)]
        local_r, local_t = np.vstack([turn, local_r]), np.vstack([np.zeros((1, 3)), local_t])
    return Skeleton(tuple(names), np.array(parents), local_r, local_t)


class Moves:
    """Clips of one skeleton: stances are fixed turns of some joints, actions smooth waves between them."""

    def __init__(self, skeleton: Skeleton, size: float = 1.0) -> None:
        self.skeleton = skeleton
        self.size = size
        self.morphs: tuple[str, ...] = ()

    def there(self, joints: Sequence[str]) -> list[str]:
        """Return those of some joints that the skeleton has."""
        return [name for name in joints if name in self.skeleton]

    def stance(self, seed: int, joints: Sequence[str], size: float = 0.3) -> Array:
        """Return rotation vectors `[J, 3]`. size: standard deviation, radians."""
        out = np.zeros((len(self.skeleton), 3))
        chance = np.random.default_rng(seed)
        for name in joints:
            out[self.skeleton.index(name)] = chance.normal(0.0, size * self.size, 3)
        return out

    def clip(
        self,
        name: str,
        seed: int,
        seconds: float,
        start: Array,
        end: Array | None = None,
        wave: Sequence[str] = (),
        size: float = 0.6,
    ) -> Clip:
        """Return a clip from one stance to another, or back, with waves of some joints between."""
        fps = BINARY_FPS if self.size > 1 else FPS
        frames = max(1, round(seconds * fps) + 1)
        x = np.linspace(0.0, 1.0, frames)[:, None, None]
        ease = x * x * (3 - 2 * x)
        turns = start + ((start if end is None else end) - start) * ease
        chance = np.random.default_rng(seed)
        for joint in self.there(wave):
            place = self.skeleton.index(joint)
            a, b = chance.normal(0.0, size, 3), chance.normal(0.0, 0.4 * size, 3)
            turns[:, place] += (
                np.sin(np.pi * x[:, 0]) ** 2 * a + np.sin(2 * np.pi * x[:, 0]) * np.sin(np.pi * x[:, 0]) * b
            )
        rotations = rotation.make_continuous(
            rotation.multiply(self.skeleton.rest_rotations, rotation.exp(turns))
        )
        if self.size > 1:  # a quaternion and its negative are one rotation
            rotations = rotations * chance.choice((-1.0, 1.0), (1, len(self.skeleton), 1))
        root = np.repeat(self.skeleton.rest_translations[None, :1], frames, 0)
        moved: tuple[int, ...] = (0,)
        if "Hips" in wave:
            root = root + np.sin(np.pi * x) ** 2 * chance.normal(0.0, 0.04, 3)
            moved = (0, self.skeleton.index("Chest"))
            chest = self.skeleton.rest_translations[moved[1]] + np.sin(np.pi * x) * 0.01
            root = np.concatenate([root, chest], 1)
        weights = None
        if self.morphs:
            weights = np.abs(np.sin(np.pi * x[:, 0] * (1 + np.arange(len(self.morphs))))) * 0.5
        return Clip(name, self.skeleton, fps, rotations, root, moved, self.morphs, weights)


ARMS = tuple(
    f"{side}{part}" for side in ("Left", "Right") for part in ("Shoulder", "UpperArm", "LowerArm", "Hand")
)
TRUNK = ("Hips", "Spine", "Chest")
HEAD = ("Neck", "Head")
SHARED = (
    *ARMS,
    "Spine",
    "Chest",
    *HEAD,
)  # layers whose turns of these are added the other way round end elsewhere


class Builder:
    """A project being built."""

    def __init__(
        self,
        name: str,
        morphs: tuple[str, ...] = (),
        size: float = 1.0,
        legs: bool = False,
        rooted: bool = False,
    ) -> None:
        # A face of morph targets has no joints.
        self.moves = Moves(stick_skeleton(("Eye", "Lid", "Jaw") if morphs else (), legs, rooted), size)
        self.moves.morphs = morphs
        self.project = Project(name=name)

    def stance(self, layer: Layer, name: str, *loops: Clip) -> str:
        clips = [self._clip(c) for c in loops]
        self.project = edits.add_stance(self.project, layer, name, clips)
        return [*self.project.graphs[layer].stances][-1]

    def _clip(self, clip: Clip) -> str:
        self.project = edits.add_clips(self.project, [(f"{clip.name}.glb", 0, "", clip)])
        return [*self.project.clips][-1]

    def act(
        self,
        layer: Layer,
        kind: Kind,
        stance: str,
        clip: Clip,
        to: str | None = None,
        timing: Mapping[str, object] | None = None,
        **more: object,
    ) -> str:
        """Place a clip; timing and more: fields that differ from what placing gives."""
        placed = self._clip(clip)
        self.project = edits.place_clips(self.project, [placed], layer, kind, stance, to)
        ident = [*self.project.graphs[layer].actions][-1]
        if timing:
            action = self.project.action(ident)
            assert action is not None
            more["timing"] = replace(action.timing, **timing)  # type: ignore[arg-type]
        if more:
            self.project = edits.update_actions(self.project, [ident], **more)
        return ident


@numbered_ids()
def stick(
    name: str = "stick",
    morphs: tuple[str, ...] = (),
    size: float = 1.0,
    legs: bool = False,
    rooted: bool = False,
) -> Project:
    """Return a project of three layers, chains of stances, several loops, masks, exits, phases and lines.

    size: of the stances' turns, times the usual ones. legs, rooted: whether it has any, and a joint above the
    hips.
    """
    b = Builder(name, morphs, size, legs, rooted=rooted)
    m = b.moves
    stand, lean, sway = m.stance(1, TRUNK, 0.08), m.stance(2, TRUNK, 0.2), ("Hips", "Spine")
    s_stand = b.stance(
        "body",
        "stand",
        m.clip("stand", 11, 2.0, stand, None, sway, 0.05),
        m.clip("stand too", 12, 1.5, stand, None, sway, 0.07),
    )
    s_lean = b.stance("body", "lean", m.clip("lean", 13, 1.25, lean, None, ("Spine",), 0.05))
    b.act("body", "transition", s_stand, m.clip("to lean", 14, 1.0, stand, lean, sway, 0.2), s_lean)
    b.act(
        "body",
        "transition",
        s_lean,
        m.clip("to stand", 15, 0.9, lean, stand, sway, 0.2),
        s_stand,
        timing={"blend_in": 0.1},
    )
    b.act("body", "fidget", s_stand, m.clip("shift", 16, 1.6, stand, None, TRUNK, 0.3))
    b.act(
        "body",
        "gesture",
        s_stand,
        m.clip("bow", 17, 1.8, stand, None, (*TRUNK, *HEAD), 0.5),
        joint_weights=(("Hips", 0.5), ("Spine", 0.25), ("Chest", 0.75)),
        tags=("positive",),
    )
    b.act("body", "gesture", s_lean, m.clip("rock", 18, 1.2, lean, None, TRUNK, 0.4))

    sides, hips, crossed = m.stance(3, ARMS, 0.4), m.stance(4, ARMS, 0.6), m.stance(5, ARMS, 0.8)
    fist = ("LeftHand", "RightHand")
    s_sides = b.stance(
        "arms",
        "at sides",
        m.clip("sides", 21, 1.9, sides, None, fist, 0.1),
        m.clip("sides too", 22, 1.3, sides, None, ARMS, 0.05),
    )
    b.project = edits.set_base(b.project, [*b.project.clips][-2], 3)
    s_hips = b.stance("arms", "on hips", m.clip("hips", 23, 1.4, hips, None, fist, 0.1))
    loose = m.clip("crossed", 24, 2.2, crossed, crossed + m.stance(9, ARMS, 0.05), fist, 0.1)
    s_crossed = b.stance("arms", "crossed", loose)  # its ends do not meet: it plays with a seam
    b.act("arms", "transition", s_sides, m.clip("to hips", 25, 0.8, sides, hips, ARMS, 0.2), s_hips)
    b.act(
        "arms",
        "transition",
        s_sides,
        m.clip("to hips slowly", 26, 1.5, sides, hips, ARMS, 0.2),
        s_hips,
        likelihood=0.4,
    )
    b.act("arms", "transition", s_hips, m.clip("to crossed", 27, 0.9, hips, crossed, ARMS, 0.2), s_crossed)
    b.act("arms", "transition", s_crossed, m.clip("to sides", 28, 1.0, crossed, sides, ARMS, 0.2), s_sides)
    b.act(
        "arms",
        "transition",
        s_hips,
        m.clip("drop right", 29, 0.7, hips, sides, ARMS[4:], 0.2),
        s_sides,
        limb="right",
    )
    pocket = m.stance(8, ARMS, 0.5)
    s_pocket = b.stance("arms", "in pockets", m.clip("pockets", 51, 1.1, pocket, None, fist, 0.1))
    b.act("arms", "transition", s_sides, m.clip("to pockets", 52, 0.8, sides, pocket, ARMS, 0.2), s_pocket)
    b.act(
        "arms",
        "transition",
        s_pocket,
        m.clip("pockets to crossed", 53, 0.8, pocket, crossed, ARMS, 0.2),
        s_crossed,
    )  # as short a way
    b.act(
        "arms", "transition", s_hips, m.clip("to crossed too", 54, 1.1, hips, crossed, ARMS, 0.2), s_crossed
    )
    right, left = ARMS[4:], ARMS[:4]
    wave = {"ready": 0.5, "stroke": 0.8, "stroke_end": 1.1, "relax": 1.5}
    b.act(
        "arms",
        "gesture",
        s_sides,
        m.clip("wave", 31, 2.1, sides, None, (*right, "Chest", "Head")),
        limb="right",
        tags=("greeting", "positive"),
        timing=wave,
    )
    b.act(
        "arms",
        "gesture",
        s_sides,
        m.clip("point", 32, 1.5, sides, None, left),
        limb="left",
        tags=("there", "question", "surprise"),
        timing={"earliest_exit": 0.9},
    )
    b.act(
        "arms",
        "gesture",
        s_sides,
        m.clip("shrug", 33, 1.3, sides, None, SHARED),
        tags=("negative", "unsure"),
        likelihood=2.0,
        timing={"start": 0.1, "end": 1.2},
    )
    b.act(
        "arms",
        "gesture",
        s_sides,
        m.clip("beat", 34, 1.0, sides, None, ARMS),
        joints=("RightLowerArm", "RightHand"),
        joint_weights=(("RightLowerArm", 0.25),),
        cooldown=6.0,
        spacing=2,
    )
    b.act(
        "arms",
        "gesture",
        s_hips,
        m.clip("nudge", 35, 1.2, hips, None, right),
        limb="right",
        tags=("positive",),
        timing={"blend_in": 0.0, "blend_out": 0.0},
    )
    b.act(
        "arms",
        "gesture",
        s_crossed,
        m.clip("lift", 36, 1.4, crossed, None, ARMS),
        timing={"blend_in": 1.0, "blend_out": 1.0},
    )
    b.act(
        "arms", "fidget", s_sides, m.clip("scratch", 37, 1.7, sides, None, left), limb="left", cooldown=10.0
    )
    b.act(
        "arms",
        "fidget",
        s_crossed,
        m.clip("tap", 38, 0.8, crossed, None, fist),
        timing={"earliest_exit": 0.3},
    )

    level, tilted = m.stance(6, HEAD, 0.1), m.stance(7, HEAD, 0.3)
    s_level = b.stance("head", "straight", m.clip("straight", 41, 1.2, level, None, HEAD, 0.03))
    s_tilted = b.stance("head", "tilted", m.clip("tilted", 42, 1.2, tilted, None, HEAD, 0.03))
    b.act("head", "transition", s_level, m.clip("tilt", 43, 0.6, level, tilted, HEAD, 0.1), s_tilted)
    b.act("head", "transition", s_tilted, m.clip("straighten", 44, 0.6, tilted, level, HEAD, 0.1), s_level)
    b.act(
        "head",
        "gesture",
        s_level,
        m.clip("nod yes", 45, 0.9, level, None, HEAD, 0.4),
        tags=("nod", "positive", "agree"),
        spacing=3,
    )
    b.act(
        "head",
        "gesture",
        s_level,
        m.clip("shake it", 46, 1.1, level, None, HEAD, 0.4),
        limb="left",
        tags=("negative", "thinking"),
        spacing=2,
    )
    b.act("head", "gesture", s_tilted, m.clip("nod tilted", 47, 0.8, tilted, None, HEAD, 0.4), tags=("nod",))
    b.act(
        "head",
        "fidget",
        s_level,
        m.clip("glance", 48, 1.0, level, None, (*HEAD, "LeftUpperLid", "RightUpperLid", "LeftEye"), 0.3),
    )
    greeting = (Gesture(tags=("greeting",), at=0.2, stroke=0.9, priority=2), Nod(at=0.5))
    lines = {
        "hello": Line(text="Hello. I am a stick.", asks=greeting),
        "7": Line(text="Seven!", duration=0.8, asks=(Nod(),), mood=(-0.6, 0.4), intensity=1.3),
    }
    voices = {"hello": guess_voice(lines["hello"].text, 1.7)}
    plain = edits.set_settings(b.project, variety=0.0)  # as in the paper; the other characters have some
    return replace(plain, lines=lines, voices=voices, points={"door": (1.5, 1.2, 0.5)})


def with_parameters(project: Project) -> Project:
    """Return a project that games set by named values, of every type, some of them beside others or instead
    of them.
    """
    arms = [s.id for s in project.graphs["arms"].stances.values()]
    moods = make_parameter_choices((name, name) for name in ("happy", "sad", "angry"))
    places = make_parameter_choices((("partner", "user"), ("ahead", "ahead"), ("door", "door")))
    shown = make_parameter_choices((tag, tag) for tag in ("greeting", "negative", "positive"))
    off_on = make_parameter_choices((("off", None), ("on", "tired")))
    stances = make_parameter_choices(zip(("first", "second", "third"), arms, strict=False))
    made = {
        "strength": CharacterParameter(
            type="number", request=Feel(), field="intensity", least=0.25, most=1.5
        ),
        "feeling": CharacterParameter(
            type="enum", request=Feel(mood="happy"), field="mood", choices=moods, about="How it feels."
        ),
        "weary": CharacterParameter(type="boolean", request=Feel(), field="mood", choices=off_on),
        "eyes": CharacterParameter(type="enum", request=Look(), field="to", choices=places),
        "attention": CharacterParameter(type="number", request=Look(), field="amount"),
        "lamp": CharacterParameter(
            type="point", request=Place(name="lamp", point=(1.0, 1.5, 0.5)), field="point"
        ),
        "partner": CharacterParameter(
            type="point", request=Place(name="user", point=(0.0, 1.6, 1.2)), field="point"
        ),
        "posture": CharacterParameter(
            type="enum", request=Go(layer="arms", stance=arms[0]), field="stance", choices=stances
        ),
        "signs": CharacterParameter(type="list", request=Gesture(), field="tags", choices=shown),
        "greet": CharacterParameter(type="trigger", request=Gesture(tags=("greeting",))),
    }
    for name, parameter in made.items():
        project = set_parameter(project, name, parameter)
    return project


@numbered_ids()
def touching(project: Project) -> Project:
    """Return a project whose hands are kept on its body, on each other and out of both: in loops with and
    without a seam, for all of an action or a part of it, at one place or along some.
    """
    chance, changes = np.random.default_rng(11), {}
    targets = ("Chest", "Head", "Hips", "RightLowerArm", "LeftLowerArm", "RightHand", "LeftHand")
    for n, action in enumerate(project.graphs["arms"].actions.values()):
        start, end = project.span(action)
        spans = []
        for hand, other in (("left", "Right"), ("right", "Left")):
            to = targets[(n + len(spans)) % len(targets)]
            if (n + len(spans)) % 4 == 3 or not (to.startswith(other) or to in targets[:3]):
                continue
            times = np.linspace(start, end, 1 + n % 3)
            keys = tuple(_near(project, action, hand, to, float(t), chance) for t in times)
            part = (end - start) * (0.0, 0.2, 0.3)[n % 3]
            first, last, ease_out = start + part, end - part / 2, 0.1 * (n % 2)
            if n % 6 == 5:  # over before it has settled
                first, last, ease_out, keys = start, start + 0.15, 0.05, keys[:1]
            spans.append(ContactSpan(hand, "palm", to, first, last, keys, 0.2, ease_out))
        changes[action.id] = {"contacts": tuple(spans)}
    return replace(edits.update_each(project, changes), touch=Touch(True, True))


def _near(
    project: Project, action: Action, hand: str, to: str, seconds: float, chance: np.random.Generator
) -> ContactKey:
    """Return a key not far from where a clip has a hand on a joint."""
    clip = project.clips[action.clip].motion
    assert clip is not None and project.skeleton is not None
    turned, at = project.skeleton.globals(clip.pose_at(seconds))
    joint, wrist = project.skeleton.index(to), project.skeleton.index(f"{hand.capitalize()}Hand")
    back = rotation.conjugate(turned[joint])
    place = rotation.rotate_vectors(back, at[wrist] - at[joint]) + chance.uniform(-0.08, 0.08, 3)
    turn = rotation.multiply(rotation.multiply(back, turned[wrist]), rotation.exp(chance.normal(0.0, 0.3, 3)))
    return ContactKey(
        round(seconds, 3), tuple(place.round(4).tolist()), tuple(rotation.normalize(turn).tolist())
    )


@numbered_ids()
def varied() -> Project:
    """Return the same character with every constant and dial off its usual value, weights that share joints,
    and a morph face.
    """
    project = with_morphs(stick("varied", MORPHS), MORPHS)
    crossed = next(s.id for s in project.graphs["arms"].stances.values() if s.name == "crossed")
    project = edits.rename_stance(project, crossed, "hand to chin")  # where the arms go in a thought
    arms = {a.name: a.id for a in project.graphs["arms"].actions.values()}
    project = edits.update_actions(
        project, [arms["beat"], arms["lift"]], name="shrug"
    )  # of one name the likeliest
    project = edits.update_actions(project, [arms["scratch"]], name="point", likelihood=3.0)
    tilted = next(a for a in project.graphs["head"].actions.values() if a.name == "tilted")
    wide = replace(tilted.timing, blend_in=1.0)  # a seam longer than half the loop
    project = edits.update_actions(project, [tilted.id], timing=wide)
    project = edits.update_actions(
        project, [arms["point"]], tags=("there", "question", "surprise", "angry", "warm")
    )
    project = edits.set_settings(
        project,
        alpha=1.5,
        never_twice=False,
        shortest=0.6,
        wait=2.0,
        memory=8.0,
        rest=0.3,
        lookahead=0.5,
        variety=0.5,
        seed=0xDEADBEEF,
    )
    for layer, part, weight in (
        ("arms", "spine", 0.5),
        ("arms", "head", 0.0),
        ("head", "head", 0.6),
        ("head", "spine", 0.3),
        ("body", "arms", 0.2),
        ("body", "legs", 0.7),
        ("body", "spine", 0.8),
    ):
        project = edits.set_weight(project, layer, part, weight)  # type: ignore[arg-type]
    states: tuple[tuple[Limb, Kind], ...] = (
        ("left", "gesture"),
        ("both", "gesture"),
        ("left", "fidget"),
        ("both", "transition"),
    )
    rows = ((0.1, 0.4, 0.3, 0.2), (0.5, 0.0, 0.25, 0.25), (0.25, 0.25, 0.25, 0.25), (1.0, 0.0, 0.0, 0.0))
    lengths = ((1.5, 0.5), (2.0, 1.0), (1.0, 0.1), (1.2, 0.0))
    project = edits.set_markov(
        project, Markov("arms", states, rows, 0.8, 0.0, 0.0, ("greeting", "negative unsure", "", ""), lengths)
    )
    life = Life(
        stillness=0.2,
        breathing=1.4,
        breath_rate=18.0,
        gaze=0.8,
        head_share=0.3,
        aversion_rate=20.0,
        saccades=1.5,
        saccade_rate=90.0,
        lids=0.7,
        blinks=30.0,
        accent_blinks=0.6,
        blink_close=0.12,
        blink_open=0.2,
        lips=0.8,
        lip_smoothing=0.06,
        expressions=1.3,
        accent_brows=0.9,
        modes={
            "idle": Manner(aversion_rate=0.5, blinks=2.0, breathing=0.5),
            "thinking": Manner(breath_rate=0.0),
            "reacting": Manner(breath_rate=0.0),
        },
    )
    return replace(edits.set_base(project, None), life=life)


@numbered_ids()
def standing(rooted: bool = False) -> Project:
    """Return a project whose body has legs, and answers its arms: some of them moved by what the body plays,
    too, one on knees that bend, in loops with a seam. rooted: the hips have a joint above them.
    """
    project = stick("standing", legs=True, rooted=rooted)
    body, arms = project.graphs["body"], project.graphs["arms"]
    stand, lean = body.stances
    shared = [a.clip for a in arms.actions.values() if a.kind == "gesture"]
    project = edits.place_clips(project, [shared[0], shared[2]], "body", "fidget", stand)
    project = edits.place_clips(project, [shared[1]], "body", "stance", stand)
    project = edits.update_actions(project, [[*project.graphs["body"].actions][-1]], likelihood=4.0)
    loops = {a.id: {"timing": replace(a.timing, blend_in=0.3)} for a in arms.of(arms.start or "", "stance")}
    project = edits.update_each(project, loops)
    project = edits.set_weight(project, "arms", "legs", 0.15)
    crouch = {"LeftUpperLeg": -0.5, "LeftLowerLeg": 1.0, "RightUpperLeg": -0.4, "RightLowerLeg": 0.8}
    for action in project.graphs["body"].of(lean, "stance"):
        entry = project.clips[action.clip]
        clip = entry.motion
        assert clip is not None
        turns = np.array(clip.rotations)
        for name, angle in crouch.items():
            turn = rotation.exp(np.array([angle, 0.0, 0.0]))
            turns[:, clip.skeleton.index(name)] = rotation.multiply(turns[:, clip.skeleton.index(name)], turn)
        bent = replace(clip, rotations=turns)
        project = replace(project, clips={**project.clips, entry.id: replace(entry, motion=bent)})
    life = Life(stillness=0.1, breath_rate=18.0, follow_through=1.6, shoulder_lift=1.8)
    return replace(project, life=life)


@numbered_ids()
def repeating(touch: bool = False) -> Project:
    """Return the project of `standing` with actions on every layer that repeat a part of their clip, whose
    ends do not meet: with a longer blend than the part, of one arm, that may be left before its first end.

    touch: with a hand kept on the chest at two places, which makes the project "clasping".
    """
    project = replace(standing(rooted=True), name="clasping" if touch else "repeating")
    changes = {}
    for layer, kind, fields in (
        ("body", "gesture", {"repeat": 1.7}),
        ("arms", "gesture", {"repeat": 2.4, "blend_in": 0.9, "blend_out": 0.5}),
        ("head", "gesture", {"repeat": 1.5, "blend_out": 0.0}),
        ("arms", "fidget", {"repeat": 60.1}),
    ):
        graph = project.graphs[layer]  # type: ignore[index]
        action = graph.of(graph.start or "", kind)[0]  # type: ignore[arg-type]
        length = project.clips[action.clip].duration
        timing = replace(action.timing, start=0.24 * length, end=0.6 * length, **fields)  # type: ignore[arg-type]
        if layer == "head":
            timing = replace(timing, earliest_exit=0.45 * length)
        whole = dict.fromkeys(("ready", "stroke", "stroke_end", "relax"))
        changes[action.id] = {"timing": replace(timing, **whole), "tags": (*action.tags, "again")}  # type: ignore[arg-type]
        if touch and (layer, kind) == ("arms", "gesture"):
            chance, times = np.random.default_rng(3), (0.24 * length, 0.5 * length)
            keys = tuple(_near(project, action, "right", "Chest", float(t), chance) for t in times)
            span = ContactSpan("right", "palm", "Chest", *times, keys, 0.2, 0.05)
            changes[action.id]["contacts"] = (span,)
    project = edits.update_each(project, changes)
    if not touch:
        return project
    lifting = Life(
        stillness=0.1, breath_rate=18.0, follow_through=0.0, shoulder_lift=0.9
    )  # shoulders alone answer
    return replace(project, touch=Touch(True, True), life=lifting)


LEGS = tuple(f"{side}{part}" for side in ("Left", "Right") for part in ("UpperLeg", "LowerLeg", "Foot"))


@numbered_ids()
def stepping(layer: Layer = "body") -> Project:
    """Return a project whose feet stand in different places: a loop with a seam, another of the same stance,
    transitions, gestures that are held, near, far, too far, that step themselves, that move some joints.

    layer: the one that moves the legs; the other than the body's is called "striding".
    """
    b = Builder("stepping" if layer == "body" else "striding", legs=True, rooted=layer != "body")
    m = b.moves
    still, sway, apart = m.stance(0, ()), ("Spine", "Chest"), m.stance(2, LEGS, 0.09)
    loose = m.clip("sway", 11, 2.0, still, m.stance(6, LEGS, 0.03), sway, 0.05)  # its ends do not meet
    stand = b.stance(layer, "stand", m.clip("stand", 12, 1.7, still, None, sway, 0.05), loose)
    spread = m.clip("wide", 13, 1.5, apart, None, sway, 0.05)
    turns = np.array(spread.rotations)
    turns[:, spread.skeleton.index("LeftFoot")] *= -1  # a quaternion and its negative are one rotation
    spread = replace(spread, rotations=turns)
    wide = b.stance(layer, "wide", spread, m.clip("wide, still", 16, 0.0, apart))
    for n, action in enumerate([*b.project.graphs[layer].of(stand, "stance")]):
        timing = replace(action.timing, blend_in=0.4 * n, start=0.25 * n)  # the loop with a seam begins later
        b.project = edits.update_actions(b.project, [action.id], timing=timing, likelihood=1.0 + n)
    b.act(layer, "transition", stand, m.clip("to wide", 14, 1.3, still, apart, ("Hips", *LEGS), 0.1), wide)
    b.act(layer, "transition", wide, m.clip("to stand", 15, 1.1, apart, still, sway, 0.1), stand)
    for n, (name, size) in enumerate((("near", 0.02), ("far", 0.1), ("too far", 0.22))):
        there = m.stance(20 + n, LEGS, size)
        b.act(layer, "gesture", stand, m.clip(name, 30 + n, 2.2 + 0.3 * n, there, None, sway, 0.2))
        b.act(layer, "fidget", wide, m.clip(f"{name} again", 40 + n, 0.6 + 0.2 * n, there, None, sway, 0.1))
    own = m.clip("of its own", 35, 2.5, m.stance(24, LEGS, 0.08), None, LEGS, 0.2)
    b.act(layer, "gesture", stand, own)
    some = m.clip("some joints", 36, 1.6, m.stance(25, LEGS, 0.1), None, sway, 0.2)
    b.act(layer, "gesture", stand, some, joints=("Spine", "LeftUpperLeg"))
    for n, more in enumerate(({"joints": ("LeftUpperLeg",)}, {"joint_weights": (("LeftUpperLeg", 0.5),)})):
        one = m.clip(f"one joint {n}", 38 + n, 1.5, m.stance(27 + n, LEGS, 0.1), None, sway, 0.2)
        b.act(layer, "gesture", stand, one, **more)
    nearest = m.clip("nearest", 46, 1.5, m.stance(29, LEGS, 0.006), None, sway, 0.1)
    b.act(layer, "gesture", stand, nearest)
    sudden = m.clip("sudden", 37, 1.2, m.stance(26, LEGS, 0.08), None, sway, 0.2)
    b.act(layer, "fidget", stand, sudden, timing={"blend_in": 0.0, "blend_out": 0.05})
    if layer != "body":
        b.project = edits.set_weight(b.project, layer, "legs", 1.0)
        return replace(
            b.project, life=Life(breath_rate=18.0, planted_feet=0.9, follow_through=0.0, shoulder_lift=0.0)
        )
    sides = b.stance("arms", "at sides", m.clip("sides", 21, 1.9, m.stance(3, ARMS, 0.4), None, ARMS, 0.05))
    b.act("arms", "gesture", sides, m.clip("reach", 51, 1.5, m.stance(3, ARMS, 0.4), None, ARMS))
    b.project = edits.set_base(b.project, b.project.graphs[layer].of(stand, "stance")[0].clip, 0)
    leaning = Life(breath_rate=18.0, planted_feet=0.9, follow_through=0.8, shoulder_lift=0.0)
    return replace(b.project, life=leaning)


@numbered_ids()
def sparse() -> Project:
    """Return a project with gaps: a layer with nothing, one that has no loop, stances that no way leads to, a
    loop of one frame.
    """
    b = Builder("sparse")
    m = b.moves
    sides, hips = m.stance(3, ARMS, 0.4), m.stance(4, ARMS, 0.6)
    b.stance("body", "nowhere")
    first = b.stance("arms", "at sides", m.clip("still", 21, 0.0, sides))
    island = b.stance("arms", "island", m.clip("island", 23, 1.4, hips, None, ("LeftHand",), 0.1))
    hollow = b.stance("arms", "hollow")
    b.act(
        "arms", "gesture", first, m.clip("wave", 31, 1.2, sides, None, ARMS), tags=("Größe",), cooldown=30.0
    )
    b.act("arms", "transition", first, m.clip("into the hollow", 32, 0.8, sides, hips, ARMS), hollow)
    b.act(
        "arms", "gesture", island, m.clip("alone", 33, 1.0, hips, None, ARMS), timing={"earliest_exit": 0.0}
    )
    return replace(b.project, life=Life(on=False))


@numbered_ids()
def still() -> tuple[Project, ...]:
    """Return projects whose life layers are there, each with some of their rates or sizes at 0."""
    lives = {
        "calm": Life(stillness=1.0),
        "quiet": Life(aversion_length=0.0, saccade_rate=0.0, blinks=0.0, breath_rate=0.0),
        "steady": Life(aversion_angle=0.0, saccades=0.0, accent_blinks=0.0, head_share=0.0, lids=0.0),
    }
    lives["slow"] = Life(breath_rate=0.9, aversion_rate=0.9, saccade_rate=0.9, blinks=0.9)
    return tuple(replace(sparse(), name=name, life=life) for name, life in lives.items())
