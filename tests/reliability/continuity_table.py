"""The largest jump that each stage adds to clips:

    python tests/reliability/continuity_table.py [MINUTES] [NAME]...

One row for the sample, for its conversation, for motion that its model generates, for each set of the label
zoo, and for each set of clips in `../shared/data`, labelled as `metagraph label` does: ten minutes of each,
untouched. `playback.continuity` allows 3 cm and 8 degrees in a sixtieth of a second. In blends a joint
may go as fast as in the clips that blend, and as fast as in 99 % of all that plays.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.clips import read_clips  # noqa: E402
from metagraph.formats.store import open_project  # noqa: E402
from metagraph.graph.model import Project  # noqa: E402
from metagraph.playback.continuity import RATE, ContinuityLaw  # noqa: E402
from metagraph.playback.evaluator import BLENDS, STAGES, Evaluator  # noqa: E402
from metagraph.playback.plan import Plan  # noqa: E402
from metagraph.playback.planner import make_plan  # noqa: E402
from metagraph.playback.posing.overlay import make_clip_overlay  # noqa: E402
from metagraph.speech.duet import load_conversation_voices, plan_duet  # noqa: E402
from metagraph.suggest.accept import accept  # noqa: E402
from metagraph.suggest.jumps.bridges import bridge_all  # noqa: E402
from metagraph.suggest.propose import propose  # noqa: E402
from tests.label_zoo.catalogue import RECIPES, named  # noqa: E402

SAMPLES = ROOT / "sample_clips"
SAMPLE = SAMPLES / "sample.metagraph.yaml"
SHARED = ROOT.parent / "shared" / "data"
CLIPS = (
    "bandai-namco-1", "edge-bvh", "fbx-pab", "kaykit-rogue", "mesh2motion-cmu", "robot-expressive",
    "smartbody-brad", "smartbody-rachel", "sumerian-hosts",
)  # fmt: skip
NAMES = ("the sample", "a conversation", "generated motion", *RECIPES, *CLIPS)
MINUTES = 10.0
PIECE, SEED = 30.0, 1  # seconds looked at at once
APART = 0.3  # seconds between jumps that count as two
LEFT = 3  # exit code of `metagraph label` where something needs a look


@dataclass
class Largest:
    """The largest jump of a stage: metres of a figure of 1.75 m, radians, and how often the law is broken."""

    way: float = 0.0
    turn: float = 0.0
    breaks: int = 0


Row = dict[str, Largest]
Made = Callable[[], Row]


def largest(project: Project, plan: Plan, seconds: float, generated: Path | None = None) -> Row:
    """Return the largest jump of each stage in the first seconds of a plan. generated: a clip that is laid
    over it; the law does not measure its blends.
    """
    law, evaluator = ContinuityLaw(project), Evaluator(plan, project)
    clip = read_clips(generated)[0] if generated is not None else None
    out: Row = {}
    for start in np.arange(0, seconds, PIECE):
        times = np.arange(round(start * RATE) - 1, round(min(start + PIECE, seconds) * RATE)) / RATE
        stages = list(
            evaluator.stages(times, make_clip_overlay(project, clip, times) if clip is not None else None)
        )
        found = dict(law.added(stages))
        if clip is None:
            found[BLENDS] = law.blended(plan, times, stages[0][1])
        for name, moves in found.items():
            row = out.setdefault(name, Largest())
            over = np.flatnonzero(moves.breaks.max(1) > 1)
            row.way = max(row.way, float(moves.ways.max()))
            row.turn = max(row.turn, float(moves.turns.max()))
            row.breaks += 1 + int((np.diff(over) > APART * RATE).sum()) if len(over) else 0
    return out


def worst(rows: Iterable[Row]) -> Row:
    """Return the largest of several rows, and the sum of what they break."""
    out: Row = {}
    for row in rows:
        for name, one in row.items():
            known = out.setdefault(name, Largest())
            known.way, known.turn = max(known.way, one.way), max(known.turn, one.turn)
            known.breaks += one.breaks
    return out


def untouched(project: Project, seconds: float) -> Row:
    return largest(project, make_plan(project, seconds, seed=SEED), seconds)


def talking() -> Row:
    """Return the row of both characters of the sample's conversation."""
    project = open_project(SAMPLE).project
    rows = []
    for ident, conversation in project.conversations.items():
        heard, _ = load_conversation_voices(conversation, SAMPLES)
        made = plan_duet(conversation, ident, (project,) * len(conversation.sides), heard)
        rows += [largest(part.project, part.plan, made.length) for part in made.parts]
    return worst(rows)


def generating(folder: Path) -> Row:
    """Return the row of what the sample's model makes of the conversation's first voice."""
    out, talk = folder / "generated.glb", SAMPLES / "conversation" / "talk.ogg"
    words = ["generate", "sample", str(SAMPLES / "models" / "own.mgmodel"), "--speech", str(talk)]
    run([*words, "--words", str(talk.with_suffix(".json")), "--bare", "-o", str(out)])
    project = open_project(SAMPLE).project
    seconds = read_clips(out)[0].duration
    return largest(project, make_plan(project, seconds, seed=SEED), seconds, out)


def zoo(name: str, seconds: float) -> Row:
    made = named(name)
    project, _ = bridge_all(accept(made.project, propose(made.project)).project)
    return untouched(project, seconds)


def labelled(name: str, folder: Path, seconds: float) -> Row:
    """Return the row of a set as it is labelled. Raises FileNotFoundError if it is not there."""
    clips = SHARED / name
    if not clips.is_dir():
        raise FileNotFoundError(f"{clips} is not there")
    out = folder / f"{name}.metagraph.yaml"
    run(["label", str(clips), "-o", str(out), "--play", "0", "--no-pictures"], fine=(0, LEFT))
    return untouched(open_project(out).project, seconds)


def run(words: list[str], fine: tuple[int, ...] = (0,)) -> None:
    """Run a command. Raises RuntimeError with what it says where its exit code is none of `fine`."""
    done = subprocess.run([sys.executable, "-m", "app.cli", *words], cwd=ROOT, capture_output=True, text=True)
    if done.returncode not in fine:
        raise RuntimeError(done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "it failed")


def rows(folder: Path, seconds: float) -> Iterator[tuple[str, Made]]:
    """Yield each of NAMES and what makes its row."""
    yield "the sample", lambda: untouched(open_project(SAMPLE).project, seconds)
    yield "a conversation", talking
    yield "generated motion", lambda: generating(folder)
    for name in RECIPES:
        yield name, lambda name=name: zoo(name, seconds)  # type: ignore[misc]
    for name in CLIPS:
        yield name, lambda name=name: labelled(name, folder, seconds)  # type: ignore[misc]


def described(row: Mapping[str, Largest]) -> str:
    """Return a row's cells as Markdown."""
    cells = []
    for name in STAGES:
        one = row.get(name)
        words = f"{100 * one.way:.1f} cm {np.degrees(one.turn):.0f}°" if one is not None else "not measured"
        cells.append(f"**{words}, {one.breaks} ×**" if one is not None and one.breaks else words)
    return " | ".join(cells)


def main() -> int:
    """Print the table; return how many rows break the law."""
    seconds = 60 * float(sys.argv[1] if len(sys.argv) > 1 else MINUTES)
    chosen, broken = sys.argv[2:], 0
    print(f"| set | {' | '.join(STAGES)} |\n|---|{'---|' * len(STAGES)}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for name, make in rows(Path(folder), seconds):
            if chosen and name not in chosen:
                continue
            try:
                row = make()
            except (FileNotFoundError, RuntimeError, ValueError) as error:
                print(f"| {name} | skipped: {error} |{' |' * (len(STAGES) - 1)}", flush=True)
                continue
            broken += any(one.breaks for one in row.values())
            print(f"| {name} | {described(row)} |", flush=True)
    return broken


if __name__ == "__main__":
    main()
