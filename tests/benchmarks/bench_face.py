"""How far the mouth closes and opens in speech, and how much of a face moves in moods and talk.

    .venv/bin/python tests/benchmarks/bench_face.py [CHARACTER.glb]

Ada, or another character whose morph targets have ARKit's names. Twelve lines with many lip sounds are said
from their letters at a slow, a usual and a quick rate (10, 14 and 20 characters a second), the sample's four
recorded lines by their phones. Printed are, for the sounds whose lips must meet (p, b, m) and for f and v,
how much of their mouth shape shows at the most within the sound (as `lip_smoothing` leaves it), and in the
frame of 25 a second that shows most of it; how many of them reach 0.95; the gap that is left between the
lips in the middle of the face (mm); and how much of a vowel's shape is reached.

Then, over a minute in each of some moods, and of a minute's talk, how far the left corner of the mouth and
the inner end of the left brow are from where they are at rest, upwards (least and most, mm), and by how many
pixels that changes where the whole figure fills a picture of 1080 lines.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from metagraph.formats.gltf.reader import read_character
from metagraph.formats.store import open_project
from metagraph.graph.face.names import VISEMES, find_morphs
from metagraph.graph.face.rig import with_morphs
from metagraph.graph.life import Life
from metagraph.graph.model import Project
from metagraph.graph.requests import Say
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import spelled
from metagraph.playback.life.lips import compute_mouth_shapes
from metagraph.playback.life.mouth import MouthPiece
from metagraph.playback.life.track import Speech, Track
from metagraph.playback.life.voice import Voice, make_voice
from metagraph.playback.plan import Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.extend_performance import hear_asks
from metagraph.playback.planning.mood import MOODS
from metagraph.speech.phones import list_mouth_pieces
from metagraph.speech.textgrid import read_textgrid
from tests.posing import face_weights

Array = NDArray[Any]
SAMPLES = Path(__file__).resolve().parents[2] / "sample_clips"
LINES = (
    "My mother made a map of Mumbai.",
    "Peter Piper picked a peck of pickled peppers.",
    "Maybe Bob will be about by Monday evening.",
    "People from Panama prefer papaya to apples.",
    "We fly five very fast planes before eleven.",
    "Have you found a safe way to move the piano?",
    "You should choose the blue room upstairs.",
    "Hello! How are you? I am so happy to see you.",
    "Well, maybe. Who knows what happens tomorrow?",
    "The number of stars is bigger than any of us can imagine.",
    "Both of them hope to be home before summer.",
    "Remember to bring warm gloves and a favourite book.",
)
RATES = (10.0, 14.0, 20.0)
VOWELS = ("aa", "E", "I", "O", "U")
FRAME = 0.04


def lip_points(body: CharacterMesh) -> tuple[Array, Array]:
    """Return the vertices in the middle of the upper and of the lower lip."""
    names = list(body.morphs)
    shifts = body.morph_positions
    middle = np.abs(body.positions[:, 0]) < 0.006

    def moved(target: str) -> Array:
        size = sum(np.abs(shifts[names.index(target + side)][:, 1]) for side in ("Left", "Right"))
        near = np.asarray(size) * middle
        return np.flatnonzero(near > 0.7 * near.max())

    return moved("mouthUpperUp"), moved("mouthLowerDown")


def lip_gap(body: CharacterMesh, weights: dict[str, float]) -> float:
    """Return how much farther apart than at rest the lips are, mm."""
    upper, lower = lip_points(body)
    moved = sum(
        w * body.morph_positions[body.morphs.index(n)] for n, w in weights.items() if n in body.morphs
    )
    if isinstance(moved, int):
        return 0.0
    return float(moved[upper, 1].mean() - moved[lower, 1].mean()) * 1e3


def shown(voice: Voice, times: Array) -> Array:
    """Return how much of each mouth shape but silence shows, `[N, 14]`."""
    track = Track(speeches=(Speech("s", 0.0, voice.duration, line="l"),))
    out = compute_mouth_shapes(track, {"l": voice}, Life().lip_smoothing, times)
    assert out is not None
    return out


def targets(row: Array, morphs: dict[str, Any]) -> dict[str, float]:
    out: dict[str, float] = {}
    for name, value in zip(VISEMES[1:], row.tolist(), strict=True):
        for target, weight in morphs.get(f"viseme_{name}", ()):
            out[target] = out.get(target, 0.0) + value * weight
    return {name: min(1.0, value) for name, value in out.items()}


def measured(body: CharacterMesh, said: list[tuple[list[MouthPiece], float]]) -> dict[str, Array]:
    """Return for each kind of sound rows of (most of its shape, most in a frame, least gap mm)."""
    morphs = find_morphs(body.morphs)
    out: dict[str, list[list[float]]] = {"p b m": [], "f v": [], "vowels": []}
    for pieces, length in said:
        voice = make_voice(pieces, length, np.zeros(0), np.zeros(0))
        for piece in pieces:
            kind = {"PP": "p b m", "FF": "f v"}.get(piece.viseme, "vowels" if piece.viseme in VOWELS else "")
            if not kind or piece.strength < 0.6:
                continue
            fine = np.arange(piece.start, piece.end + 1e-9, 0.004)
            frames = np.arange(np.floor(piece.start / FRAME), np.ceil(piece.end / FRAME) + 1) * FRAME
            place = VISEMES.index(piece.viseme) - 1
            rows = shown(voice, fine)
            most = rows[:, place].max() / piece.strength
            seen = shown(voice, frames)[:, place].max() / piece.strength
            gaps = [lip_gap(body, targets(row, morphs)) for row in rows] if kind != "vowels" else [0.0]
            out[kind].append([most, seen, min(gaps)])
    return {kind: np.array(rows) for kind, rows in out.items()}


def moving(project: Project, body: CharacterMesh, plan: Plan) -> Array:
    """Return how high the left corner of the mouth and the left brow's inner end are above their rest,
    `[N, 2]` mm.
    """
    shifts, names = body.morph_positions, list(body.morphs)
    left = body.positions[:, 0] > 0.003
    smile, brow = (
        np.argmax(np.linalg.norm(shifts[names.index(target)], axis=1) * left)
        for target in ("mouthSmileLeft", "browInnerUp")
    )
    out = []
    for t in np.arange(0.0, plan.end, 0.1):
        weights = face_weights(project, plan.life, plan.track, float(t))
        moved = sum(w * shifts[names.index(n)] for n, w in weights.items() if n in names)
        out.append([0.0, 0.0] if isinstance(moved, int) else [moved[smile, 1], moved[brow, 1]])
    return np.array(out) * 1e3


def faces(body: CharacterMesh) -> None:
    project = with_morphs(open_project(SAMPLES / "sample.metagraph.yaml").project, body.morphs)
    pixel = 1080 / (1.1 * float(np.ptp(body.positions[:, 1])) * 1e3)
    print(f"a minute of the face: least..most mm above rest; {pixel:.2f} pixels a mm at 1080 lines")
    for name in ("neutral", "happy", "excited", "angry", "sad", "tired", "talk"):
        valence, arousal = MOODS.get(name, (0.0, 0.0))
        life = msgspec.structs.replace(project.life, valence=valence, arousal=arousal, lips=0.0)
        felt = replace(project, life=life)
        plan = make_plan(felt, 60.0, idle=False)
        if name == "talk":
            asks = [Say(id=f"s{n}", at=5.0 * n, text=line) for n, line in enumerate(LINES)]
            plan = hear_asks(felt, plan, 0.0, asks, 60.0, idle=False)
        rows = moving(felt, body, plan)
        corner, brow = ([x.min(), x.max(), np.ptp(x) * pixel] for x in rows.T)
        print(
            f"  {name:8} corner {corner[0]:+.1f}..{corner[1]:+.1f} mm, changes {corner[2]:.1f} px   "
            f"brow {brow[0]:+.1f}..{brow[1]:+.1f} mm, changes {brow[2]:.1f} px"
        )


def main() -> None:
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else SAMPLES / "ada.glb"
    body = read_character(path)
    groups: dict[str, list[tuple[list[MouthPiece], float]]] = {}
    for rate in RATES:
        spoken = [(text, len(text) / rate) for text in LINES]
        groups[f"letters, {rate:.0f} a second"] = [
            (spelled(ALPHABET, text, length).pieces, length) for text, length in spoken
        ]
    grids = [read_textgrid(p) for p in sorted((SAMPLES / "lines").glob("*.TextGrid"))]
    recorded = [
        (list_mouth_pieces(grid), max(i.end for t in grid.tiers for i in t.intervals)) for grid in grids
    ]
    groups["phones of recorded lines"] = recorded
    print(f"{path.name}: median (least) of the most; of the best frame; share that reach 0.95; gap mm")
    for name, said in groups.items():
        for kind, rows in measured(body, said).items():
            if not len(rows):
                continue
            most, seen, gap = rows.T
            line = f"{np.median(most):.2f} ({most.min():.2f})   {np.median(seen):.2f} ({seen.min():.2f})"
            closed = f"{(most >= 0.95).mean():4.0%}   gap {np.median(gap):+.1f} (most {gap.max():+.1f})"
            print(f"  {name:26} {kind:7} n {len(rows):4d}   {line}   {closed if kind != 'vowels' else ''}")
    faces(body)


if __name__ == "__main__":
    main()
