"""A whole study of simulated participants as files: plan, clips, references, logs and projects, small and all
of them valid.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.clips import digest, read_clips
from metagraph.formats.store import save_project
from metagraph.graph import edits
from metagraph.graph.model import Layer, Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from metagraph.research.study.logs.log import format_wall_time
from metagraph.research.study.machines.klm import USUAL
from metagraph.research.study.plan.freeze import study_manifest
from metagraph.research.study.questionnaires import SUS, TLX
from metagraph.research.study.simulation.people import Simulated, SimulatedWork, Truth, simulate_participants
from metagraph.research.study.simulation.work import draw_every_connection, make_slips
from metagraph.research.study.sitting import Phase, list_phases
from metagraph.research.study.study_plan import FILE, Study, read_study

Array = NDArray[Any]

LAYER: Layer = "arms"
STEP = 30.0  # seconds between events, about: gaps of more than a minute would count as absence
OBSERVED = 1.4  # times what the keystroke-level model predicts
FIRST_DAY = datetime(2026, 1, 5, 9, tzinfo=UTC)

# stance -> how far both arms are raised, radians; task -> clips by stance, (name, kind, how far the right arm
# goes further)
RAISED = {"sides": 0.15, "hips": 0.7, "crossed": 1.2}
GESTURES = {
    "sides": (("wave", "gesture", 1.6), ("shrug", "gesture", 0.5), ("scratch", "fidget", 0.9)),
    "hips": (("point", "gesture", 1.1), ("sway", "fidget", 0.3)),
    "crossed": (("nudge", "gesture", 0.7), ("tap", "fidget", 0.4)),
}
TASKS: Mapping[str, tuple[str, ...]] = {"small": ("sides", "hips"), "large": ("sides", "hips", "crossed")}


def list_task_clips(task: str) -> tuple[str, ...]:
    """Return the names of a task's clips, without endings, in the order in which they are worked on."""
    stances = TASKS[task]
    idles = [f"{s}_idle" for s in stances]
    gestures = [f"{s}_{name}" for s in stances for name, _, _ in GESTURES[s]]
    return (*idles, *gestures, *(f"{a}_to_{b}" for a in stances for b in stances if a != b))


def write_study(folder: Path, truth: Truth) -> Study:
    """Write a study. Raises FileError, also where there is one already: what people did is not to be mixed
    with what nobody did.
    """
    if folder.exists() and any(folder.iterdir()):
        raise FileError(
            folder, "is not empty", "on writing the simulated study", "Give a folder that is not there yet."
        )
    for name in list_task_clips("large"):
        (folder / "clips").mkdir(parents=True, exist_ok=True)
        write_bvh(_clip(name), folder / "clips" / f"{name}.bvh")
    references = {task: _reference(folder, task) for task in TASKS}
    for task, project in references.items():
        save_project(project, folder / f"{task}.metagraph.yaml")
    write_atomically(folder / FILE, _plan(truth).encode())
    study = read_study(folder)
    right = {
        (task, c): p if c == "meta" else draw_every_connection(p)
        for task, p in references.items()
        for c in ("meta", "manual")
    }
    digests = study_manifest(study)
    for number, person in enumerate(simulate_participants(truth, {t: list_task_clips(t) for t in TASKS})):
        _Sitting(study, person, right, truth, number).write(digests)
    return study


def _plan(truth: Truth) -> str:
    told = ", ".join(
        f"{name} {getattr(truth, name):g}"
        for name in ("ratio", "learning", "order", "pace", "spread", "chance")
    )
    tasks = "".join(
        f"- id: {task}\n  title: {len(list_task_clips(task))} clips\n  clips: "
        f"[{', '.join(f'clips/{n}.bvh' for n in list_task_clips(task))}]\n"
        f"  reference: {task}.metagraph.yaml\n  instructions: Make them play without a jump.\n"
        for task in TASKS
    )
    return (
        f"# Nobody took part in this study: it was simulated ({told}).\nstudy: 1\ntitle: A simulated study\n"
        f"participants: {truth.participants}\nconditions: [meta, manual]\nseed: "
        f"{truth.seed}\ntasks:\n{tasks}questionnaires: [sus, tlx]\n"
    )


# --- clips and references

JOINTS = (
    ("Hips", -1, (0, 0.95, 0)), ("Spine", 0, (0, 0.2, 0)), ("Head", 1, (0, 0.35, 0)),
    ("LeftArm", 1, (0.18, 0.25, 0)), ("LeftForeArm", 3, (0.28, 0, 0)), ("LeftHand", 4, (0.26, 0, 0)),
    ("RightArm", 1, (-0.18, 0.25, 0)), ("RightForeArm", 6, (-0.28, 0, 0)), ("RightHand", 7, (-0.26, 0, 0)),
    ("LeftUpLeg", 0, (0.1, -0.05, 0)), ("LeftLeg", 9, (0, -0.42, 0)), ("LeftFoot", 10, (0, -0.42, 0)),
    ("RightUpLeg", 0, (-0.1, -0.05, 0)), ("RightLeg", 12, (0, -0.42, 0)), ("RightFoot", 13, (0, -0.42, 0)),
)  # fmt: skip


def _clip(name: str) -> Clip:
    """Return two seconds of motion that fit the clip's name, 30 frames a second."""
    rest = np.tile([0.0, 0, 0, 1], (len(JOINTS), 1))
    offsets = np.array([o for _, _, o in JOINTS], float)
    skeleton = Skeleton(tuple(n for n, _, _ in JOINTS), np.array([p for _, p, _ in JOINTS]), rest, offsets)
    t = np.linspace(0, 1, 61)
    stance, _, what = name.partition("_")
    ease = (1 - np.cos(np.pi * np.clip(1.5 * t - 0.25, 0, 1))) / 2
    left = np.full(61, RAISED[stance])
    extra = np.zeros(61)
    if what.startswith("to_"):
        left = RAISED[stance] + (RAISED[what.removeprefix("to_")] - RAISED[stance]) * ease
    for gesture, _, far in GESTURES[stance]:
        if gesture == what:
            extra = far * np.sin(np.pi * np.clip(1.5 * t - 0.25, 0, 1)) ** 2
    right = left + extra
    breath = 0.02 * np.sin(2 * np.pi * t)
    turns = np.tile(rest, (61, 1, 1))
    names = [n for n, _, _ in JOINTS]
    for joint, angle in (
        ("LeftArm", left - np.pi / 2 + breath),
        ("RightArm", np.pi / 2 - right - breath),
        ("Spine", 0.5 * breath),
    ):
        turns[:, names.index(joint)] = np.stack([0 * t, 0 * t, np.sin(angle / 2), np.cos(angle / 2)], 1)
    return Clip(name, skeleton, 30.0, turns, np.tile(offsets[:1], (61, 1, 1)))


def _reference(folder: Path, task: str) -> Project:
    """Return the right answer, its paths relative to the study's folder."""
    paths = [folder / "clips" / f"{n}.bvh" for n in list_task_clips(task)]
    project = edits.add_clips(
        Project(task), [(f"clips/{p.name}", 0, digest(p), read_clips(p)[0]) for p in paths]
    )
    ids = {e.name: e.id for e in project.clips.values()}
    for stance in TASKS[task]:
        project = edits.add_stance(project, LAYER, stance, [ids[f"{stance}_idle"]])
    stances = {s.name: s.id for s in project.graphs[LAYER].stances.values()}
    for stance, ident in stances.items():
        for name, kind, _ in GESTURES[stance]:
            project = edits.place_clips(
                project, [ids[f"{stance}_{name}"]], LAYER, "gesture" if kind == "gesture" else "fidget", ident
            )
        for other in stances:
            if other != stance:
                project = edits.place_clips(
                    project, [ids[f"{stance}_to_{other}"]], LAYER, "transition", ident, stances[other]
                )
    return project


# --- logs


class _Sitting:
    """Writes one participant's log and projects, event by event as the window would."""

    def __init__(
        self,
        study: Study,
        person: Simulated,
        right: Mapping[tuple[str, str], Project],
        truth: Truth,
        number: int,
    ) -> None:
        self.study, self.person, self.right = study, person, right
        self.rng = np.random.default_rng((truth.seed, number, 1))
        self.start = FIRST_DAY + timedelta(days=number)
        self.events: list[dict[str, Any]] = []
        self.mono = 0.0

    def add(self, kind: str, after: float = 0.0, **fields: Any) -> None:
        self.mono += after
        wall = format_wall_time(self.start + timedelta(seconds=self.mono))
        self.events.append(
            {
                "n": len(self.events),
                "run": "simulated",
                "mono": round(self.mono, 6),
                "wall": wall,
                "type": kind,
                **fields,
            }
        )

    def write(self, digests: Mapping[str, str]) -> None:
        works = {(w.condition, w.task): w for w in self.person.works}
        self.add(
            "begin",
            participant=self.person.participant,
            study=self.study.digest,
            version="",
            machine={},
            simulated=True,
        )
        self.add("frozen", digests=digests)
        for phase in list_phases(self.study, self.person.participant):
            self.add("phase", 1.0, state="begin", **phase.fields)
            if phase.name == "task":
                self._work(phase, works[phase.condition or "", phase.task or ""])
            elif phase.questionnaire is not None:
                for item, value in self._answers(phase):
                    self.add("answer", 4.0, questionnaire=phase.questionnaire.id, item=item, value=value)
            self.add("phase", 0.0 if phase.name == "task" else 2.0, state="end", why="done", **phase.fields)
        self.add("end")
        lines = (json.dumps(e, ensure_ascii=False, separators=(",", ":")) for e in self.events)
        write_atomically(
            self.study.log(self.person.participant), "".join(f"{line}\n" for line in lines).encode()
        )

    def _work(self, phase: Phase, work: SimulatedWork) -> None:
        for clip, seconds in work.seconds.items():
            self._clip(clip, seconds, work.condition)
        folder = self.study.data(self.person.participant)
        project = make_slips(
            self.right[work.task, work.condition], work.condition == "manual", work.slips, self.rng
        )
        save_project(project, folder / phase.file, self.study.folder / FILE)
        self.add(
            "artefact",
            path=phase.file,
            digest=digest(folder / phase.file),
            why="done",
            condition=work.condition,
            task=work.task,
        )

    def _clip(self, clip: str, seconds: float, condition: str) -> None:
        """Report the work on one clip, which ends with an edit of it."""
        parts = max(3, int(np.ceil(seconds / STEP)))
        shares = self.rng.dirichlet(np.full(parts, 60.0)) * seconds
        for n, share in enumerate(shares.tolist()):
            last = n == parts - 1
            self.add("ops", share, **self._operators(share, last))
            if last:
                self.add("edit", what="place", words="Place a clip", clips=[clip], layer=LAYER, undone=False)
            elif n % 3 == 1 and self.rng.random() < 0.5:
                self.add("playback", what="play")
            elif n % 3 == 1:
                self.add("view", what="select")
            elif n % 5 == 2 and condition == "manual" and self.rng.random() < 0.3:
                self.add("undo", words="Take back")
            elif n % 2 == 0:
                self.add(
                    "edit", what="timing" if self.rng.random() < 0.4 else "link", words="Change it", clips=[]
                )

    def _operators(self, seconds: float, last: bool) -> dict[str, Any]:
        """Return operators for which an expert would take some of these seconds."""
        left = max(0.0, seconds / OBSERVED - USUAL.M)
        drags = 1 if last else 0
        points = round(left / (2 * USUAL.P)) + drags
        keys = round(max(0.0, left - points * (USUAL.P + 2 * USUAL.B) - USUAL.H) / USUAL.K / 2)
        drag_s = round(min(seconds / 4, 1.6 * drags), 3)
        return {
            "K": keys,
            "P": points,
            "B": 2 * points,
            "D": drags,
            "H": 1,
            "seconds": round(seconds, 3),
            "drag_s": drag_s,
        }

    def _answers(self, phase: Phase) -> Iterator[tuple[str, int]]:
        assert phase.questionnaire is not None and phase.condition is not None
        if phase.questionnaire.id == SUS.id:
            points = round(self.person.sus[phase.condition] / 2.5)
            for n, item in enumerate(SUS.items):
                given = points // 10 + (n < points % 10)
                yield item.id, 1 + given if n % 2 == 0 else 5 - given
            return
        steps = round(
            self.person.tlx[phase.condition] * len(TLX.items) / 5
        )  # of all scales, which go in fives
        for n, item in enumerate(TLX.items):
            yield item.id, 5 * (steps // len(TLX.items) + (n < steps % len(TLX.items)))
