"""Faults of other studios' clips, each in as many variants as one draws: other figures, names, rests, units
and axes, other poses, lengths and words.

Each kind writes a small set of clips, reads and labels it, and says what a person would complain of: nothing
if the program mends the fault and says so, or reports it. The figures are those of `tests.zoo`; the motion is
made here, of a few poses.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.formats.imports import Imported, gather, import_files
from metagraph.graph.check import check_project
from metagraph.graph.clip_source import with_changed_file
from metagraph.graph.editing.retiming import keep_clips_in_place
from metagraph.graph.model import Action, Project
from metagraph.graph.problem import Problem
from metagraph.motion import rotation
from metagraph.motion.roles import find_roles
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.planning.running_plan import improvise
from metagraph.suggest.accept import AcceptedProposals, accept
from metagraph.suggest.flags import needs_look
from metagraph.suggest.jumps.bridges import bridge_all
from metagraph.suggest.proposal import Proposal, Proposals
from metagraph.suggest.propose import propose
from tests import zoo
from tests.zoo import ANIMALS, FIGURE, Animal

Array = NDArray[Any]
Pose = Mapping[str, tuple[float, float, float]]  # joint -> degrees about X after Y after Z, from the T-pose
DOWN = 78.0  # degrees that arms hang below the horizontal


def _both(upper: tuple[float, float, float], lower: tuple[float, float, float] = (0, 0, 0)) -> Pose:
    """Return a pose of both arms, given for the left one."""
    (a, b, c), (d, e, f) = upper, lower
    left = {"left_upper_arm": upper, "left_lower_arm": lower}
    return {**left, "right_upper_arm": (a, -b, -c), "right_lower_arm": (d, -e, -f)}


HANG = _both((0, 0, -DOWN), (0, -12, 0))
ON_HIPS = _both((12, 0, -48), (0, 0, -75))
CROSSED = _both((-25, 0, -70), (0, -105, 0))
BEHIND = _both((32, 0, -70), (0, -35, 0))
BENT = _both((0, 0, -48), (0, -50, 0))  # an A-pose with bent elbows
STANCES: Mapping[str, Pose] = {"hips": ON_HIPS, "crossed": CROSSED, "behind": BEHIND}
SIT: Pose = {
    f"{s}_{leg}": (d, 0, 0)
    for s in ("left", "right")
    for leg, d in (("upper_leg", -88.0), ("lower_leg", 88.0))
}
GESTURES: Mapping[str, Pose] = {
    "beat_rt": {"right_upper_arm": (-32, 0, 0), "right_lower_arm": (0, 68, 0)},
    "beat_lf": {"left_upper_arm": (-32, 0, 0), "left_lower_arm": (0, -68, 0)},
    "offer_bt": {
        "right_upper_arm": (-40, 0, 0),
        "right_lower_arm": (0, 50, 0),
        "left_upper_arm": (-40, 0, 0),
        "left_lower_arm": (0, -50, 0),
    },
    "point_rt": {"right_upper_arm": (-72, 0, 0), "right_lower_arm": (0, 10, 0)},
    "stop_bt": {
        "right_upper_arm": (-55, 0, 0),
        "right_lower_arm": (0, 45, 0),
        "left_upper_arm": (-55, 0, 0),
        "left_lower_arm": (0, -45, 0),
    },
}


def added(*poses: Pose) -> Pose:
    out: dict[str, tuple[float, float, float]] = {}
    for pose in poses:
        for joint, (x, y, z) in pose.items():
            a, b, c = out.get(joint, (0.0, 0.0, 0.0))
            out[joint] = (a + x, b + y, c + z)
    return out


def times(pose: Pose, share: float) -> Pose:
    return {joint: (x * share, y * share, z * share) for joint, (x, y, z) in pose.items()}


@dataclass(frozen=True, eq=False)
class Move:
    """What a figure does. turns: joint -> `[F, 3]` degrees; way `[F, 3]` metres of the hips of a figure of
    the usual size.
    """

    turns: Mapping[str, Array]
    way: Array

    @property
    def frames(self) -> int:
        return len(self.way)

    def then(self, other: Move) -> Move:
        joints = {*self.turns, *other.turns}
        none = [np.zeros((m.frames, 3)) for m in (self, other)]
        turns = {j: np.concatenate([self.turns.get(j, none[0]), other.turns.get(j, none[1])]) for j in joints}
        return Move(turns, np.concatenate([self.way, other.way]))

    def going(self, way: Array) -> Move:
        return replace(self, way=self.way + way)


def smooth(x: Array) -> Array:
    x = np.clip(x, 0, 1)
    return x * x * (3 - 2 * x)


def blended(*parts: tuple[Pose, Array | float], frames: int) -> Move:
    """Return poses, each with its share over time, added up."""
    turns: dict[str, Array] = {}
    for pose, share in parts:
        for joint, degrees in pose.items():
            grown = np.broadcast_to(np.asarray(share, float), (frames,))[:, None] * np.array(degrees, float)
            turns[joint] = turns.get(joint, 0.0) + grown
    return Move(turns, np.zeros((frames, 3)))


@dataclass
class MadeFault:
    """A set with a fault. draw: what varies. figure: who does it. moves: clip -> what it does, in files of
    these names, with `/` in folders. unnamed: whether names say nothing.
    """

    draw: np.random.Generator
    folder: Path
    figure: Animal = field(init=False)
    moves: dict[str, Move] = field(default_factory=dict)
    unnamed: bool = False
    said: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        draw = self.draw
        names = [name for name in ANIMALS if "neck" in ANIMALS[name].names]
        kind = draw.choice([".glb", ".bvh"])
        self.figure = replace(
            ANIMALS[str(draw.choice(names))],
            kind=kind,
            arms=float(draw.choice([0, 20, 45, 60])),
            unit=float(draw.choice([0.01, 1.0, 0.0254] if kind == ".bvh" else [0.01, 1.0, 0.001])),
            up=draw.choice(["Y", "Z"]),
            bones=bool(draw.random() < 0.5) and kind == ".glb",
            fps=float(draw.choice([24, 25, 30, 60])),
            size=float(draw.uniform(0.85, 1.1)),
            legs=float(draw.uniform(0.9, 1.1)),
            bind=False,
            above=None,
        )

    # -- motion

    def seconds(self, low: float, high: float) -> int:
        """Return a number of frames."""
        return max(2, round(self.draw.uniform(low, high) * self.figure.fps) + 1)

    def idle(self, pose: Pose = HANG, low: float = 3.0, high: float = 6.0, wave: float = 1.0) -> Move:
        frames = self.seconds(low, high)
        turn = 2 * np.pi * np.arange(frames) / (frames - 1)
        life = {"chest": (0.9 * wave, 0.0, 0.0), "head": (0.4, 0.7, 0.0)}
        return blended((pose, 1.0), (life, np.sin(turn)), frames=frames)

    def gesture(
        self, pose: Pose = HANG, what: str | None = None, low: float = 1.8, high: float = 3.2
    ) -> Move:
        frames = self.seconds(low, high)
        t = np.linspace(0, 1, frames)
        goal = GESTURES[what or str(self.draw.choice(list(GESTURES)))]
        up, back = self.draw.uniform(0.2, 0.3), self.draw.uniform(0.7, 0.8)
        held = smooth(t / up) * (1 - smooth((t - back) / (1 - back)))
        beat = 1 + 0.16 * np.sin(2 * np.pi * int(self.draw.integers(1, 4)) * t) * held
        nod = {"head": (4.0, 0.0, 0.0), "chest": (2.0, 0.0, 0.0)}
        return blended(
            (pose, 1.0), (times(goal, self.draw.uniform(0.85, 1.1)), held * beat), (nod, held), frames=frames
        )

    def change(self, one: Pose, other: Pose, low: float = 1.0, high: float = 1.8) -> Move:
        frames = self.seconds(low, high)
        part = smooth(np.linspace(0, 1, frames))
        return blended((one, 1 - part), (other, part), frames=frames)

    def walk(self, begins: float = 0.0, low: float = 2.0, high: float = 3.5) -> Move:
        """Return steps ahead, which begin from standing for a share of the clip."""
        frames = self.seconds(low, high)
        t = np.arange(frames) / self.figure.fps
        going = smooth(np.linspace(0, 1, frames) / begins) if begins else np.ones(frames)
        phase = 2 * np.pi * t * self.draw.uniform(0.85, 1.1)
        parts: list[tuple[Pose, Any]] = [(HANG, 1.0)]
        for side, way in (("left", 1.0), ("right", -1.0)):
            parts += [({f"{side}_upper_leg": (-27.0, 0, 0)}, way * np.sin(phase) * going)]
            parts += [({f"{side}_lower_leg": (40.0, 0, 0)}, np.maximum(0, way * np.cos(phase)) * going)]
            parts += [({f"{side}_upper_arm": (20.0, 0, 0)}, way * np.sin(phase) * going)]
        ahead = np.cumsum(going) / self.figure.fps * self.draw.uniform(1.0, 1.4)
        return blended(*parts, frames=frames).going(ahead[:, None] * np.array([0.0, 0, 1]))

    def talker(self, pose: Pose = HANG, stance: str = "idle", gestures: int = 5, word: str = "{}_{}") -> None:
        """Add an idle and gestures of it."""
        self.moves[stance] = self.idle(pose)
        for what in list(GESTURES)[:gestures]:
            self.moves[word.format(stance, what)] = self.gesture(pose, what)

    # -- files

    def write(self) -> None:
        """Write each clip into a file of its own."""
        for name, move in self.moves.items():
            path = self.folder / f"{name}{self.figure.kind}"
            path.parent.mkdir(parents=True, exist_ok=True)
            clip = zoo.clip_doing(self.figure, path.stem, self._turns(move), move.way * self.figure.size)
            if self.figure.kind == ".bvh":
                zoo.write_bvh(path, clip, self.figure)
            else:
                zoo.write_glb_of(path, [clip], self.figure)

    def _turns(self, move: Move) -> dict[str, Array]:
        axes = np.eye(3)
        out: dict[str, Array] = {}
        for joint, (above, _) in FIGURE.items():
            x, y, z = np.radians(move.turns.get(joint, np.zeros((move.frames, 3)))).T
            own = rotation.from_axis_angle(axes[0], x)
            for axis, angle in ((axes[1], y), (axes[2], z)):
                own = rotation.multiply(own, rotation.from_axis_angle(axis, angle))
            out[joint] = own if above is None else rotation.multiply(out[above], own)
        return out

    def rewrite(self, change: Callable[[str], str]) -> None:
        """Change the text of every file."""
        for path in self.folder.rglob(f"*{self.figure.kind}"):
            path.write_text(change(path.read_text("utf-8")), "utf-8")

    # -- what the program makes of it

    @cached_property
    def imported(self) -> Imported:
        return import_files(Project("fault"), self.folder.parent, gather([self.folder]))

    @cached_property
    def project(self) -> Project:
        return self.imported.into(Project("fault"))

    @cached_property
    def found(self) -> Proposals:
        return propose(self.project, sources=("motion",) if self.unnamed else ("name", "motion"))

    @cached_property
    def taken(self) -> AcceptedProposals:
        return accept(self.project, self.found)

    @cached_property
    def labelled(self) -> Project:
        return bridge_all(self.taken.project)[0]

    @cached_property
    def problems(self) -> list[Problem]:
        return [p for p in check_project(self.labelled) if p.severity != "hint"]

    def id(self, name: str) -> str:
        name = name.rpartition("/")[2]
        return next(c for c, entry in self.project.clips.items() if entry.name == name)

    def proposal(self, name: str) -> Proposal | None:
        return self.found.proposals.get(self.id(name))

    def action(self, name: str) -> Action | None:
        """Return what a clip is placed as."""
        ident = self.id(name)
        return next((a for a in self.taken.project.actions() if a.clip == ident), None)

    def actions(self, name: str) -> list[Action]:
        """Return all that a clip is placed as."""
        ident = self.id(name)
        return [a for a in self.labelled.actions() if a.clip == ident]

    def rests_of(self, name: str) -> set[str]:
        """Return the clips that the stance of a placed clip rests in."""
        action = self.action(name)
        graph = self.labelled.graphs[action.layer] if action is not None else None
        loops = graph.of(action.stance, "stance") if graph is not None and action is not None else ()
        return {self.labelled.clips[a.clip].name for a in loops}

    def kind(self, name: str) -> str:
        p = self.proposal(name)
        return "aside" if p is None else p.kind.value

    def stance_of(self, name: str, end: bool = False) -> str:
        p = self.proposal(name)
        belief = None if p is None else p.end_stance if end else p.stance
        return "" if belief is None else self.found.places[belief.value].name

    def is_told(self, name: str) -> bool:
        """Return whether a clip is skipped, left or needs a look, so that a person sees to it."""
        p = self.proposal(name)
        return p is None or needs_look(p, self.taken.left)

    def notes(self, name: str) -> str:
        motion = self.project.clips[self.id(name)].motion
        return " ".join(motion.notes) if motion is not None else ""

    # -- complaints

    def expect(self, holds: object, complaint: str) -> None:
        if not holds:
            self.said.append(complaint)

    def expect_kind(self, name: str, *kinds: str) -> None:
        self.expect(self.kind(name) in kinds, f"{name} is a {self.kind(name)}")


Fault = Callable[[MadeFault], None]
FAULTS: dict[str, Fault] = {}


def fault(make: Fault) -> Fault:
    FAULTS[make.__name__.strip("_").replace("_", " ")] = make
    return make


def complaints(kind: str, number: int, folder: Path) -> list[str]:
    """Return what a person would complain of in a variant of a fault."""
    made = MadeFault(np.random.default_rng([number, *kind.encode()]), folder)
    FAULTS[kind](made)
    return made.said


# -- files


def _bind_poses(made: MadeFault, first: bool) -> None:
    """Most takes begin, or end, in an A-pose with bent elbows; the file's own rest pose is the idle."""
    made.figure = replace(made.figure, arms=DOWN)
    made.talker()
    bind = blended((added(times(BENT, made.draw.uniform(0.9, 1.1))), 1.0), frames=1)
    clean = str(made.draw.choice(list(made.moves)))
    before = {name: move.frames for name, move in made.moves.items()}
    for name, move in made.moves.items():
        if name != clean:
            made.moves[name] = bind.then(move) if first else move.then(bind)
    made.write()
    for name, frames in before.items():
        motion = made.project.clips[made.id(name)].motion
        assert motion is not None
        told = "bind pose" in made.notes(name)
        made.expect(
            told == (name != clean), f"{name}: {made.notes(name) or 'nothing is said of its bind pose'}"
        )
        made.expect(motion.frames == frames, f"{name} has {motion.frames} frames of {frames}")


@fault
def leading_bind_pose(made: MadeFault) -> None:
    _bind_poses(made, True)


@fault
def trailing_bind_pose(made: MadeFault) -> None:
    _bind_poses(made, False)


def _as_bvh(made: MadeFault) -> None:
    made.figure = replace(made.figure, kind=".bvh", bones=False)


def _from_offset(text: str) -> str:
    """Return a BVH whose root has the place of its first frame as OFFSET, and the way from there as
    positions.
    """
    head, _, rows = text.partition("Frame Time: ")
    step, *lines = rows.strip().splitlines()
    table = [line.split(" ", 3) for line in lines]
    first = np.array(table[0][:3], float)
    x, y, z = first
    head = head.replace("OFFSET 0.00000 0.00000 0.00000", f"OFFSET {x:.5f} {y:.5f} {z:.5f}", 1)
    out = []
    for *place, rest in table:
        a, b, c = np.array(place, float) - first
        out.append(f"{a:.5f} {b:.5f} {c:.5f} {rest}")
    return "\n".join([f"{head}Frame Time: {step}", *out]) + "\n"


def _lowest(made: MadeFault, name: str) -> float:
    """Return how high the lowest foot is at first, in heights."""
    motion = made.project.clips[made.id(name)].motion
    assert motion is not None
    roles = find_roles(motion.skeleton)
    _, at = motion.skeleton.globals(motion.pose_at(0.0))
    feet = [roles[role] for role in ("left_foot", "right_foot") if role in roles]
    return float(at[feet or slice(None), 1].min() / motion.skeleton.height)


@fault
def roots_relative_to_offset(made: MadeFault) -> None:
    _as_bvh(made)
    made.talker(gestures=2)
    made.write()
    made.rewrite(_from_offset)
    for name in made.moves:
        made.expect("OFFSET" in made.notes(name), f"{name}: nothing is said of its OFFSET")
        made.expect(
            -0.03 < _lowest(made, name) < 0.15, f"{name}: a foot is {_lowest(made, name):.2f} heights high"
        )


@fault
def frame_times_in_milliseconds(made: MadeFault) -> None:
    _as_bvh(made)
    made.talker(gestures=2)
    made.write()
    digits = int(made.draw.integers(2, 7))

    def slower(text: str) -> str:
        head, _, rest = text.partition("Frame Time: ")
        step, _, rest = rest.partition("\n")
        return f"{head}Frame Time: {1000 * float(step):.{digits}f}\n{rest}"

    made.rewrite(slower)
    for name in made.moves:
        motion = made.project.clips[made.id(name)].motion
        assert motion is not None
        made.expect(abs(motion.fps - made.figure.fps) < 0.1, f"{name}: {motion.fps} frames a second")
        made.expect("milliseconds" in made.notes(name), f"{name}: nothing is said of milliseconds")


@fault
def decimal_commas(made: MadeFault) -> None:
    _as_bvh(made)
    made.talker(gestures=2)
    made.write()
    made.rewrite(lambda text: text.replace(".", ","))
    for name, move in made.moves.items():
        motion = made.project.clips[made.id(name)].motion
        assert motion is not None
        made.expect("commas" in made.notes(name), f"{name}: nothing is said of commas")
        made.expect(motion.frames == move.frames, f"{name} has {motion.frames} frames of {move.frames}")
        made.expect(abs(motion.fps - made.figure.fps) < 0.1, f"{name}: {motion.fps} frames a second")


@fault
def clips_far_from_their_rest_pose(made: MadeFault) -> None:
    """The nodes hold a pose in which the hips are metres away from where every clip begins."""
    made.figure = replace(made.figure, kind=".glb")
    made.talker(gestures=3)
    far = made.draw.uniform(3, 12) * np.array([np.cos(a := made.draw.uniform(0, 6)), 0.0, np.sin(a)])
    made.moves = {name: move.going(far) for name, move in made.moves.items()}
    made.write()
    made.expect_kind("idle", "stance")
    for name in made.moves:
        if name != "idle":
            made.expect_kind(name, "gesture")
            made.expect(
                made.rests_of(name) == {"idle"}, f"{name} is of a stance that rests in {made.rests_of(name)}"
            )
    pose = Evaluator(improvise(made.labelled, 4.0), made.labelled).at(np.linspace(0, 4, 9))
    skeleton = made.labelled.skeleton
    assert skeleton is not None
    _, at = skeleton.globals(pose)
    wide = float(np.ptp(at[..., [0, 2]], axis=(0, 1)).max() / skeleton.height)
    made.expect(wide < 1.5, f"what plays needs {wide:.1f} heights of room")
    low = float(at[..., 1].min() / skeleton.height)
    made.expect(-0.03 < low < 0.1, f"it plays {low:.2f} heights above the floor")


@fault
def stances_that_travel(made: MadeFault) -> None:
    made.talker()
    idle = made.moves["idle"]
    way = made.draw.uniform(1.0, 3.0) * np.linspace(0, 1, idle.frames)[:, None] * np.array([0.0, 0, 1])
    made.moves["idle"] = idle.going(way)
    made.write()
    action = made.action("idle")
    if action is None:
        made.expect(made.is_told("idle"), "nothing is said of the idle")
        return
    told = [p for p in made.problems if p.code == "travels" and p.action == action.id]
    stays = not any(made.labelled.graphs[a.layer].weight("legs") > 0 for a in made.actions("idle"))
    made.expect(stays or told or made.is_told("idle"), "nothing is said of an idle that travels")
    if told:
        made.expect("place" in told[0].remedy.lower(), f"the remedy is: {told[0].remedy}")
        entry = made.labelled.clips[action.clip]
        kept = keep_clips_in_place(made.labelled, [entry.id])
        left = [p for p in check_project(kept) if p.action == action.id and p.code == "travels"]
        made.expect(not left, "it still travels in place")


@fault
def fidgets_that_end_elsewhere(made: MadeFault) -> None:
    made.talker()
    move = made.idle(low=3, high=5, wave=4.0)
    step = smooth(np.linspace(-0.5, 1.2, move.frames))[:, None]
    angle = made.draw.uniform(0, 2 * np.pi)
    made.moves["idle_shift_weight"] = move.going(
        step * made.draw.uniform(0.6, 0.9) * np.array([np.cos(angle), 0.0, np.sin(angle)])
    )
    made.write()
    action = made.action("idle_shift_weight")
    if action is not None and made.labelled.graphs[action.layer].weight("legs") > 0:
        told = [p for p in made.problems if p.action == action.id]
        made.expect(
            told or made.is_told("idle_shift_weight"), "nothing is said of a fidget that ends elsewhere"
        )


@fault
def transitions_into_a_walk(made: MadeFault) -> None:
    made.talker(word="{}_{}")
    one, other = made.draw.permutation(["idle_to_walk", "idle_ToRun", "stand_to_jog", "walk_start_fwd"])[:2]
    for name in (one, other):
        made.moves[str(name)] = made.walk(begins=0.5)
    made.write()
    for name in (str(one), str(other)):
        made.expect(made.action(name) is None, f"{name} is placed as a {made.kind(name)}")
    stances = {s.name for g in made.labelled.graphs.values() for s in g.stances.values()}
    made.expect(not {s for s in stances if "walk" in s or "run" in s}, f"there are stances {stances}")


@fault
def nobody_falls_while_talking(made: MadeFault) -> None:
    made.talker()
    word = str(
        made.draw.choice(
            ["Falling_Idle", "hang_idle", "swim_idle", "Floating Idle", "fall_loop", "climb_idle", "fly_idle"]
        )
    )
    spread = _both((0, 0, made.draw.uniform(-10, 50)), (0, -15, 0))
    legs: Pose = {
        "left_upper_leg": (-20, 0, 0),
        "right_upper_leg": (10, 0, 0),
        "left_lower_leg": (35, 0, 0),
        "right_lower_leg": (20, 0, 0),
    }
    move = made.idle(added(spread, legs), wave=5.0)
    made.moves[word] = move.going(np.array([0.0, made.draw.uniform(0.3, 0.8), 0.0]))
    made.write()
    action = made.action(word)
    if action is not None:
        graph = made.labelled.graphs[action.layer]
        led = [a for a in graph.actions.values() if a.end_stance == action.stance]
        made.expect(action.kind != "stance" or not led, f"{word} is a {action.kind} that is led to")
        made.expect(made.is_told(word), f"{word} is placed as a {action.kind} without a word")


LAP = added(SIT, _both((-24, 0, -68), (0, -62, 0)))


@fault
def small_gestures_of_one_who_sits(made: MadeFault) -> None:
    """Beats of a few centimetres out of the lap are gestures; rubbing, tapping and shifting are fidgets."""
    made.unnamed = True
    down = np.array([0.0, -0.41 * made.figure.legs, 0.0])

    def add(name: str, move: Move) -> None:
        made.moves[name] = move.going(down)

    def small(goal: Pose, low: float, high: float) -> Move:
        frames = made.seconds(1.6, 3.6)
        t = np.linspace(0, 1, frames)
        up, back = made.draw.uniform(0.2, 0.3), made.draw.uniform(0.65, 0.8)
        held = smooth(t / up) * (1 - smooth((t - back) / (1 - back)))
        beats = int(made.draw.integers(1, 5))
        beat = 1 + 0.25 * np.sin(2 * np.pi * beats * (t - up) / (back - up)) * held
        nod = {"head": (made.draw.uniform(0.5, 3.0), 0.0, 0.0)}
        return blended(
            (LAP, 1.0), (times(goal, made.draw.uniform(low, high)), held * beat), (nod, held), frames=frames
        )

    def busy(goal: Pose, cycles: float) -> Move:
        frames = made.seconds(1.8, 4.0)
        t = np.arange(frames) / made.figure.fps
        ease = smooth(np.linspace(0, 5, frames)) * smooth(np.linspace(5, 0, frames))
        swing = 0.5 - 0.5 * np.cos(2 * np.pi * cycles * t)
        return blended((LAP, 1.0), (goal, swing * ease), frames=frames)

    add("a", made.idle(LAP, 4, 7, wave=0.6))
    right: Pose = {"right_upper_arm": (-14, 0, 0), "right_lower_arm": (0, 24, 0)}
    left: Pose = {"left_upper_arm": (-14, 0, 0), "left_lower_arm": (0, -24, 0)}
    for n in range(6):
        add(f"g{n}", small((right, left, added(right, left))[n % 3], 0.3, 1.0))
    rub: Pose = {"right_upper_arm": (-7, 0, 0), "right_lower_arm": (0, -9, 0)}
    add("f0", busy(rub, made.draw.uniform(0.8, 1.4)))
    add("f1", busy(added(rub, {"left_upper_arm": (-7, 0, 0), "left_lower_arm": (0, 9, 0)}), 1.0))
    add("f2", busy({"right_hand": (0, 0, 14)}, made.draw.uniform(2, 3)))
    add("f3", busy({"hips": (0, 0, 5), "spine": (0, 0, -6)}, 0.4))
    add("f4", busy({"left_lower_leg": (-9, 0, 0), "left_upper_leg": (6, 0, 0)}, made.draw.uniform(1.5, 3)))
    made.write()
    for name in made.moves:
        kinds = {"a": ("stance",), "g": ("gesture",), "f": ("fidget", "stance")}[name[0]]
        made.expect_kind(name, *kinds)


# -- names and poses


@fault
def named_after_another_stance(made: MadeFault) -> None:
    """A clip begins 40 cm from the stance that it is named after, in another stance that there is."""
    other = str(made.draw.choice(list(STANCES)))
    made.talker()
    made.talker(STANCES[other], other)
    made.moves[f"idle_to_{other}"] = made.change(HANG, STANCES[other])
    made.moves[f"{other}_to_idle"] = made.change(STANCES[other], HANG)
    made.moves["idle_shrug_02"] = made.gesture(STANCES[other], "offer_bt")
    made.write()
    p = made.proposal("idle_shrug_02")
    made.expect(
        made.is_told("idle_shrug_02") or made.stance_of("idle_shrug_02") == other,
        f"a clip of '{other}' is placed in '{made.stance_of('idle_shrug_02')}' without a word",
    )
    made.expect(p is None or p.kind.value == "gesture", f"it is a {made.kind('idle_shrug_02')}")


@fault
def gestures_of_one_cycle(made: MadeFault) -> None:
    made.talker(word="Talk {1}")
    up = {"right_upper_arm": (0.0, 0.0, made.draw.uniform(-60, -40)), "right_lower_arm": (0.0, 0.0, -50.0)}
    together = _both((-45, -25, -55), (0, -60, 0))
    nod: Pose = {"head": (9.0, 0, 0), "neck": (7.0, 0, 0)}
    frames = max(6, round(made.draw.uniform(0.45, 0.8) * made.figure.fps))
    swing = np.sin(2 * np.pi * (np.linspace(0, 1, frames) + made.draw.random()))
    clap: Pose = {"left_lower_arm": (0, -16, 0), "right_lower_arm": (0, 16, 0)}
    raised = {**HANG, **up}
    made.moves["Waving"] = blended((raised, 1.0), ({"right_lower_arm": (0, 0, 24)}, swing), frames=frames)
    made.moves["Clapping"] = blended((together, 1.0), (clap, swing), frames=frames)
    made.moves["Nodding"] = blended((HANG, 1.0), (nod, swing), frames=frames)
    made.write()
    for name in ("Waving", "Clapping", "Nodding"):
        p = made.proposal(name)
        made.expect_kind(name, "gesture")
        repeat = p.timing.get("repeat", 0.0) if p is not None else 0.0
        made.expect(1.2 <= repeat <= 3.3 or made.is_told(name), f"{name} repeats for {repeat} s")


@fault
def idle_variations(made: MadeFault) -> None:
    """Variations of an idle, 4 to 8 s long, come back to it: fidgets of its stance, not stances of a head."""
    made.talker()
    lean: Pose = {
        "spine": (0, 0, 6),
        "hips": (0, 0, -3),
        "left_upper_leg": (0, 0, 3),
        "right_upper_leg": (0, 0, 3),
    }
    round_: Pose = {"head": (0, 40, 0), "neck": (0, 18, 0)}
    kinds = {
        "shift": lean,
        "look": round_,
        "stretch": added(round_, {"chest": (-8, 0, 0)}, _both((-15, 0, 10))),
    }
    names = [f"idle_{word}_{made.draw.choice(['var', 'break', 'variation'])}" for word in kinds]
    for name, pose in zip(names, kinds.values(), strict=True):
        frames = made.seconds(4, 8)
        t = np.linspace(0, 1, frames)
        away = smooth(t / 0.3) * (1 - smooth((t - 0.7) / 0.3)) * np.sin(np.pi * t) ** 0.3
        made.moves[name] = blended((HANG, 1.0), (pose, away), frames=frames)
    made.write()
    for name in names:
        p = made.proposal(name)
        made.expect_kind(name, "fidget", "gesture")
        made.expect(
            p is None or p.kind.value != "stance", f"{name} is a stance of the {p.layer.value if p else ''}"
        )


@fault
def takes_that_stand_a_little_differently(made: MadeFault) -> None:
    """Many takes without telling names, in three poses, each of which stands some degrees differently: nobody
    can use a stance for each of them.
    """
    joints = ("hips", "chest", "head", "left_upper_arm", "right_upper_arm", "left_lower_arm")
    amount = made.draw.uniform(1.0, 2.5)
    for n in range(48):
        x = {joint: tuple(made.draw.normal(0, amount, 3).tolist()) for joint in joints}
        pose = added((HANG, ON_HIPS, CROSSED)[n % 3], x)
        made.moves[f"take {n:03}"] = made.idle(pose) if n % 4 == 0 else made.gesture(pose)
    made.write()
    for layer, graph in made.labelled.graphs.items():
        names = [s.name for s in graph.stances.values()]
        made.expect(len(names) <= 9, f"{layer}: they are {len(names)} stances: {names}")


@fault
def idles_close_together(made: MadeFault) -> None:
    """Three idles some 10 cm apart, of which nothing but gestures of the first continues, are one stance."""
    made.talker(stance="Idle01")
    for n in (2, 3):
        angle = made.draw.uniform(4, 8)
        made.moves[f"Idle0{n}"] = made.idle(added(HANG, _both((angle, 0, 0), (0, -angle, 0))))
    made.write()
    for n in (1, 2, 3):
        made.expect_kind(f"Idle0{n}", "stance")
    for layer, graph in made.labelled.graphs.items():
        names = [s.name for s in graph.stances.values()]
        made.expect(len(names) <= 1, f"{layer}: they are {len(names)} stances: {names}")


@fault
def idles_clearly_apart(made: MadeFault) -> None:
    for n, pose in enumerate((HANG, *made.draw.permutation(np.array(list(STANCES.values()), object))[:2])):
        made.talker(pose, f"Idle0{n + 1}", gestures=3)
    made.write()
    for name in made.moves:
        own = name.partition("_")[0]
        if own != name:
            made.expect(
                made.rests_of(name) == {own},
                f"{name} is of '{made.stance_of(name)}', which rests in {made.rests_of(name)}",
            )
    made.expect(not made.problems, f"there are problems: {[p.message for p in made.problems]}")


@fault
def names_of_transitions(made: MadeFault) -> None:
    made.talker(stance="idle", gestures=3)
    made.talker(ON_HIPS, "idle02", gestures=3)
    sit = added(HANG, SIT)
    down = np.array([0.0, -0.41 * made.figure.legs, 0.0])
    made.talker(sit, "sitidle", gestures=3)
    for name in ("sitidle", *(n for n in made.moves if n.startswith("sitidle_"))):
        made.moves[name] = made.moves[name].going(down)
    made.moves["settle_to_idle02"] = made.change(HANG, ON_HIPS)
    word = str(made.draw.choice(["stand_to_sitidle", "idle_to_sitidle", "down_to_sitidle"]))
    move = made.change(HANG, sit)
    made.moves[word] = move.going(smooth(np.linspace(0, 1, move.frames))[:, None] * down)
    made.write()
    for name, end in (("settle_to_idle02", "idle02"), (word, "sitidle")):
        made.expect_kind(name, "transition")
        there = made.stance_of(end)
        made.expect(
            made.stance_of(name, True) == there,
            f"{name} ends in '{made.stance_of(name, True)}', not in '{there}'",
        )
    made.expect(made.stance_of("idle") != made.stance_of("idle02"), "idle and idle02 are one stance")


@fault
def folders_of_moods(made: MadeFault) -> None:
    moods = {"happy": "positive", "sad": "negative", "angry": "negative"}
    some = [str(x) for x in made.draw.permutation(list(moods))[:2]]
    for mood in some:
        for what in list(GESTURES)[: int(made.draw.integers(2, 5))]:
            made.moves[f"{mood}/{mood[0]}{what}"] = made.gesture(what=what)
    made.moves["idle"] = made.idle()
    made.write()
    for name in made.moves:
        mood = name.partition("/")[0]
        if mood in moods:
            p = made.proposal(name)
            tags = p.tags.value if p is not None and p.tags is not None else ()
            made.expect({mood, moods[mood]} <= {*tags}, f"{name} has the tags {tags}")


SCRIPTS: Mapping[str, tuple[str, str, str, str]] = {  # stance, gesture, fidget, what leads to a walk
    "ja": ("待機", "手を振る", "頭をかく", "歩く"),
    "zh": ("站立", "挥手", "挠头", "走路"),
    "ru": ("стойка", "жест_рукой", "почесать_голову", "ходьба"),
    "ko": ("대기", "손_흔들기", "머리_긁기", "걷기"),
}


@fault
def names_in_other_scripts(made: MadeFault) -> None:
    stance, gesture, _, walk = SCRIPTS[str(made.draw.choice(list(SCRIPTS)))]
    made.moves[stance] = made.idle()
    for n, what in enumerate(GESTURES, 1):
        made.moves[f"{gesture}_{n:02d}"] = made.gesture(what=what)
    made.moves[walk] = made.walk()
    made.write()
    made.expect_kind(stance, "stance")
    made.expect_kind(walk, "aside")
    for n in range(1, len(GESTURES) + 1):
        made.expect_kind(f"{gesture}_{n:02d}", "gesture")
    names = [a.name for a in made.labelled.actions()]
    made.expect(all(name.strip() for name in names), "an action has no name")


@fault
def clips_exported_again(made: MadeFault) -> None:
    """A clip that was labelled is exported again, longer or shorter."""
    made.talker()
    made.write()
    name = next(n for n in made.moves if made.kind(n) == "gesture")
    before = made.labelled
    share = float(made.draw.choice([0.35, 0.5, 1.7, 2.5]))
    move = made.moves[name]
    at = np.linspace(0, move.frames - 1, max(4, round(share * move.frames)))
    low = np.minimum(at.astype(int), move.frames - 2)
    part = (at - low)[:, None]
    made.moves = {
        name: Move(
            {j: v[low] * (1 - part) + v[low + 1] * part for j, v in move.turns.items()},
            move.way[low] * (1 - part) + move.way[low + 1] * part,
        )
    }
    made.write()
    again = import_files(Project("again"), None, [p for p in gather([made.folder]) if p.stem == name])
    motion = next(iter(again.into(Project("again")).clips.values())).motion
    entry = before.clips[made.id(name)]
    assert motion is not None and entry.motion is not None
    after = with_changed_file(entry, motion, "another")
    project = replace(before, clips={**before.clips, entry.id: after})
    action = next(a for a in project.actions() if a.clip == entry.id)
    told = [p for p in check_project(project) if p.action == action.id and p.severity != "hint"]
    made.expect(told, f"nothing is said of a clip that is {share} times as long")


@fault
def z_up_beside_y_up(made: MadeFault) -> None:
    """One program wrote half of the files, another with other axes the rest."""
    _as_bvh(made)
    made.talker()
    every, made.moves = made.moves, {}
    for n, (name, move) in enumerate(every.items()):
        made.figure = replace(made.figure, up="YZ"[n % 2])
        made.moves = {name: move}
        made.write()
    made.moves = every
    made.expect(not made.imported.failures, f"left out: {made.imported.failures[:1]}")
    for name in every:
        made.expect_kind(name, "stance" if name == "idle" else "gesture")
    shapes = {e.motion.skeleton.fingerprint for e in made.project.clips.values() if e.motion is not None}
    made.expect(len(shapes) == 1, "several skeletons are in the project")


@fault
def recordings_that_nobody_cut(made: MadeFault) -> None:
    """Takes of a minute with many gestures are no gesture."""
    for n in range(int(made.draw.integers(1, 4))):
        take = made.idle(low=1.0, high=2.0)
        for _ in range(int(made.draw.integers(14, 20))):
            take = take.then(made.gesture(low=1.8, high=2.6)).then(made.idle(low=0.8, high=1.5))
        made.moves[f"take_{n + 1}"] = take
    made.write()
    for name in made.moves:
        made.expect_kind(name, "aside")
        made.expect("recording" in made.found.aside.get(made.id(name), ""), f"{name}: nothing is said")


@fault
def idles_of_one_name_in_folders(made: MadeFault) -> None:
    """Each mood has a folder with an idle of its own pose, and its gestures."""
    for mood, pose in (("happy", HANG), ("angry", ON_HIPS), ("afraid", CROSSED)):
        made.moves[f"{mood}/idle"] = made.idle(pose)
        for what in list(GESTURES)[:3]:
            made.moves[f"{mood}/{what}"] = made.gesture(pose, what)
    made.write()
    stances = {
        Path(made.project.clips[c].path).parent.name: p.stance.value
        for c, p in made.found.proposals.items()
        if p.kind.value == "gesture" and p.stance is not None
    }
    made.expect(len(set(stances.values())) == len(stances) == 3, f"stances of the moods: {stances}")
