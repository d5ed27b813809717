"""How far a stranger's poses are from those of conformance vectors, by what plays.

.venv/bin/python -m tests.engines.stranger.comparing FOLDER...    the shipped vectors' where none is named
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from tests.engines.stranger.enlivening import Life
from tests.engines.stranger.posing import loop_seconds, morphs, playing, pose, positions, resting
from tests.engines.stranger.reading import Character, read_character
from tests.engines.stranger.stepping import planted
from tests.engines.stranger.weighing import answered

SHIPPED = Path(__file__).resolve().parents[3] / "metagraph" / "engines" / "conformance"
NAMES = ("stick", "sparse", "varied", "standing", "stepping", "repeating")
Vectors = tuple[Character, dict[str, Any]]


def read_vectors(folder: Path) -> Vectors:
    vectors = json.loads((folder / "vectors.json").read_text("utf-8"))
    return read_character(folder / vectors["export"]), vectors


def kinds(character: Character, case: dict[str, Any], t: float) -> Iterator[str]:
    """What plays at a time, in the words of docs/reference."""
    for plan in case["plan"]["layers"].values():
        cue, rests = playing(plan, t), plan["rests"]
        if not rests:
            continue
        current = resting(rests, t)
        _, action, start, fade_start, fade = rests[current]
        yield "stances"
        if current and t < fade_start + fade:
            yield "a loop takes over"
        if loop_seconds(character.actions[action], t - start)[2] > 0.0:
            yield "a loop's seam"
        if cue is None:
            continue
        action = character.actions[cue["action"]]
        if t < cue["start"] + cue["blend_in"]:
            yield "blending in"
        elif t >= cue["end"] - cue["blend_out"]:
            yield "blending out"
        else:
            yield "between the blends"
        if "cycle_to" in cue:
            yield "a cycle that repeats"
        if cue["hold"] > 0.0:
            yield "a stretched hold"
        if action["limb"] != "both":
            yield "limited to a limb"
        if action["joints"]:
            yield "limited to joints"
        if action.get("joint_weights"):
            yield "joints that move in part"


def told(case: dict[str, Any], character: Character, t: float) -> list[tuple[float, float, str]] | None:
    """What is said by voices: start, end, line; None if anything is said that only letters report."""
    out, voices = [], character.data.get("voices", {})
    for now, ask in ((step["now"], ask) for step in case["steps"] for ask in step["asks"]):
        if ask["do"] == "say" and "at" in ask and ask.get("line") in voices:
            out.append((ask["at"], ask["at"] + voices[ask["line"]]["duration"], ask["line"]))
        elif ask["do"] == "say" and t > ask.get("at", now) - 0.2:
            return None
    return out


def compared(character: Character, vectors: dict[str, Any]) -> Iterator[tuple[set[str], dict[str, float]]]:
    """Yield of each pose what plays, and its largest errors: of a joint's place in metres, of its own turn in
    degrees, of a morph target's weight. Poses whose lips are read from letters are left out.
    """
    found = []
    for case in vectors["cases"]:
        life = Life(character, case) if "rig" in character.data else None
        for wanted in case["poses"]:
            t, layers = wanted["time"], case["plan"]["layers"]
            made, weights = pose(character, layers, t), morphs(character, layers, t)
            plays = set(kinds(character, case, t))
            if wanted["alive"] and life is not None:
                said = told(case, character, t)
                if said is None:
                    continue
                held = planted(character, layers, made, t)
                answer = answered(character, layers, held, t)
                weighs, steps = answer is not held, held is not made
                made, more = life.added(answer, t, said)
                for name, value in more.items():
                    shown = weights.get(name, 0.0)
                    weights[name] = min(max(shown + value * (1 - shown), 0.0), 1.0)
                plays = {"with life"} | ({"the arms' weight"} if weighs else set())
                plays |= {"planted feet"} if steps else set()
            names = weights.keys() | wanted["morphs"].keys()
            off = (abs(weights.get(name, 0.0) - wanted["morphs"].get(name, 0.0)) for name in names)
            found.append((wanted, made, plays, max(off, default=0.0)))
    rotations = np.array([made[0] for _, made, _, _ in found])
    far = positions(character, rotations, np.array([made[1] for _, made, _, _ in found]))
    far -= np.array([wanted["positions"] for wanted, _, _, _ in found])
    metres = np.linalg.norm(far, axis=-1).max(1)
    theirs = np.array([wanted["rotations"] for wanted, _, _, _ in found])
    theirs /= np.linalg.norm(theirs, axis=-1, keepdims=True)
    chord = np.minimum(
        np.linalg.norm(rotations - theirs, axis=-1), np.linalg.norm(rotations + theirs, axis=-1)
    )
    degrees = np.degrees(4.0 * np.arcsin(chord.max(1) / 2.0))
    for n, (_, _, plays, weight) in enumerate(found):
        yield plays, {"metres": float(metres[n]), "degrees": float(degrees[n]), "weight": weight}


def main(folders: list[str]) -> None:
    worst: dict[str, tuple[int, float, float, float]] = {}
    for folder in [Path(name) for name in folders] or [SHIPPED / name for name in NAMES]:
        for plays, off in compared(*read_vectors(folder)):
            for kind in plays | {"all"}:
                count, *most = worst.get(kind, (0, 0.0, 0.0, 0.0))
                worst[kind] = (count + 1, *map(max, most, off.values()))  # type: ignore[assignment]
    print("| what plays | poses | metres | degrees | weight |\n|---|---|---|---|---|")
    for kind, (count, metres, degrees, weight) in sorted(worst.items(), key=lambda x: -x[1][0]):
        print(f"| {kind} | {count} | {metres:.6f} | {degrees:.4f} | {weight:.6f} |")


if __name__ == "__main__":
    main(sys.argv[1:])
