"""How long speakers and listeners look at each other, measured from the poses of conversations of two:

    python tests/benchmarks/bench_gaze.py [MINUTES]

The sample's conversation with other seeds, and made-up conversations of two minutes, on the standing sample
and with the seated one as the partner. Somebody looks at the other if the eyes point at most 8 degrees past
the other's eyes. People: Argyle and Ingham 1972; looks away while speaking: Andrist et al. 2013.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from metagraph.graph import anatomy  # noqa: E402
from metagraph.graph.conversation.model import Conversation  # noqa: E402
from metagraph.graph.model import Project  # noqa: E402
from metagraph.motion import rotation  # noqa: E402
from metagraph.playback.evaluator import Evaluator  # noqa: E402
from metagraph.playback.posing.rigs import get_rigs  # noqa: E402
from metagraph.speech.addressing import find_speaking_spans  # noqa: E402
from metagraph.speech.duet import DuetPart, load_conversation_voices, plan_duet  # noqa: E402
from tests.speech.group import made_up  # noqa: E402

SAMPLES = ROOT / "sample_clips"
RATE = 20.0  # poses a second
PAST = 8.0  # degrees that the eyes may point past the other's
BRIEF = 0.2  # seconds: a shorter look, or look away, is a jump of the eyes
PEOPLE = {"speaks": "41 %", "listens": "75 %", "both look": "31 %"}
Array = Any


@dataclass
class Looked:
    """seconds: of each role, in all and looking at the other. away: of each look away of a speaker."""

    seconds: dict[str, list[float]] = field(default_factory=dict)
    away: list[float] = field(default_factory=list)

    def add(self, role: str, during: Array, looks: Array) -> None:
        of = self.seconds.setdefault(role, [0.0, 0.0])
        of[0] += float(during.sum()) / RATE
        of[1] += float((during & looks).sum()) / RATE

    def share(self, role: str) -> float:
        whole, some = self.seconds[role]
        return some / max(whole, 1e-9)

    @property
    def minutes(self) -> float:
        return self.seconds["both look"][0] / 60.0

    def rows(self) -> Iterator[str]:
        for role in self.seconds:
            yield f"{role:<12} {100 * self.share(role):3.0f} % of the time (people: {PEOPLE.get(role, '?')})"
        every = self.seconds["speaks"][0] / max(1, len(self.away))
        lasts = float(np.mean(self.away))
        yield f"looks away while speaking: {lasts:.2f} s, one in {every:.1f} s (people: 1.96 s in 4.75 s)"


def watch_eyes(part: DuetPart, times: Array) -> tuple[Array, Array]:
    """Return where a character's eyes are, metres, and where they point, `[N, 3]` each, as both stand."""
    skeleton, roles = part.project.skeleton, anatomy.project_roles(part.project)
    assert skeleton is not None
    pose = Evaluator(part.plan, part.project).at(times)
    turns, places = part.stand.placed(*(np.asarray(x, float) for x in skeleton.globals(pose)))
    rest = skeleton.globals(anatomy.get_base_pose(part.project))[0].astype(float)
    ahead = np.asarray(get_rigs(part.project).body.ahead, float)
    out = np.zeros((len(times), 3))
    joints = [roles["left_eye"], roles["right_eye"]]
    for joint in joints:
        own = rotation.rotate_vectors(rotation.conjugate(rest[joint]), ahead)
        out += rotation.rotate_vectors(turns[:, joint], np.broadcast_to(own, out.shape))
    return places[:, joints].mean(1), out / np.linalg.norm(out, axis=-1, keepdims=True)


def without_brief(looks: Array) -> Array:
    """Return looks without those, and those away, that are as short as jumps of the eyes."""
    out = looks.copy()
    for value in (True, False):
        edges = np.diff(np.concatenate([[0], (out != value).astype(int), [0]]))
        for first, last in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
            if last - first < BRIEF * RATE:
                out[first:last] = value
    return out


def look_at(
    found: Looked, talk: Conversation, projects: tuple[Project, Project], folder: Path | None
) -> None:
    """Add what both sides of a conversation look at. folder: of its sound."""
    heard = load_conversation_voices(talk, folder)[0] if folder is not None else (None, None)
    duet = plan_duet(talk, "talk", projects, heard)
    times = np.arange(0.0, duet.length, 1.0 / RATE)
    speaks = []
    for side in talk.sides:
        here = np.zeros(len(times), bool)
        for start, end in find_speaking_spans(side.segments):
            here |= (times >= start) & (times < end)
        speaks.append(here)
    eyes = [watch_eyes(part, times) for part in duet.parts]
    both = np.ones(len(times), bool)
    for n, (at, pointing) in enumerate(eyes):
        way = eyes[1 - n][0] - at
        way /= np.linalg.norm(way, axis=-1, keepdims=True)
        looks = np.degrees(np.arccos(np.clip((way * pointing).sum(-1), -1.0, 1.0))) < PAST
        both &= looks
        own, other = speaks[n] & ~speaks[1 - n], speaks[1 - n] & ~speaks[n]
        found.add("speaks", own, looks)
        found.add("listens", other, looks)
        found.add("is silent", ~own & ~other, looks)
        edges = np.diff(np.concatenate([[0], (~without_brief(looks) & own).astype(int), [0]]))
        lasts = np.flatnonzero(edges == -1) - np.flatnonzero(edges == 1)
        found.away += (lasts / RATE).tolist()
    found.add("both look", np.ones(len(times), bool), both)


def measure(minutes: float, seed: int = 100) -> dict[str, Looked]:
    """Return what was seen in so many minutes of each kind of conversation, from a seed on."""
    sample, seated = (
        open_project(SAMPLES / f"{name}.metagraph.yaml").project for name in ("sample", "seated")
    )
    office = next(iter(sample.conversations.values()))
    out: dict[str, Looked] = {}
    for name, projects in (
        ("two who stand", (sample, sample)),
        ("one who stands, one who sits", (sample, seated)),
    ):
        recorded, made = (out.setdefault(f"{name}, {kind}", Looked()) for kind in ("recorded", "made up"))
        n = seed
        while not recorded.seconds or recorded.minutes < minutes:
            look_at(recorded, msgspec.structs.replace(office, seed=n), projects, SAMPLES)
            n += 1
        while not made.seconds or made.minutes < minutes:
            look_at(made, made_up(2, n, 120.0), projects, None)
            n += 1
    return out


def main() -> None:
    for name, found in measure(float(sys.argv[1]) if len(sys.argv) > 1 else 60.0).items():
        print(f"{name}, {found.minutes:.0f} minutes:", *found.rows(), sep="\n  ", flush=True)


if __name__ == "__main__":
    main()
