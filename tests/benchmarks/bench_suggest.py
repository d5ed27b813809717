"""What is guessed from motion alone: python tests/benchmarks/bench_suggest.py

How often kind, stance, end stance, layer and limb are right with the names hidden - on the sample clips,
where the guesses were tuned, and on labelled sets made by others, which showed what to look out for - and how
long traits and guesses of a thousand clips take. A stance counts as right where most members of the group
that was discovered are of that stance.
"""

from __future__ import annotations

import json
import sys
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.errors import FileError  # noqa: E402
from metagraph.formats.clips import find_clip_files, read_clips  # noqa: E402
from metagraph.formats.store import open_project  # noqa: E402
from metagraph.graph import edits  # noqa: E402
from metagraph.graph.model import LAYERS, Project  # noqa: E402
from metagraph.motion import rotation  # noqa: E402
from metagraph.motion.clip import Clip  # noqa: E402
from metagraph.suggest.alike import Alike, LabelledExample  # noqa: E402
from metagraph.suggest.jumps.compatibility import make_compatibility_matrix  # noqa: E402
from metagraph.suggest.motion_guess import guess  # noqa: E402
from metagraph.suggest.propose import accept, list_examples, propose  # noqa: E402
from metagraph.suggest.stances.known import discover_stances, list_known_stances, measure_distance_from_stance  # noqa: E402
from metagraph.suggest.traits import Traits, measure_all_traits  # noqa: E402

SAMPLE = ROOT / "sample_clips" / "sample.metagraph.yaml"
TRUTH = ROOT / "tests" / "suggest" / "truth"
SHARED = ROOT.parent / "shared" / "data"
FIELDS = ("kind", "stance", "end_stance", "layer", "limb")
Truth = Mapping[str, Mapping[str, Any]]


def truth_of(project: Project) -> Truth:
    """Return clip id -> what a project says of it; the limb of arms and head only, where it means
    something.
    """
    return {
        a.clip: {
            "kind": a.kind,
            "layer": a.layer,
            "stance": a.stance,
            "end_stance": a.end_stance,
            "limb": a.limb if a.layer == "arms" and a.kind in ("gesture", "fidget") else None,
        }
        for a in project.actions()
    }


def right(
    truth: Truth, traits: Mapping[str, Traits], stances: Any
) -> tuple[Counter[str], Counter[str], list[str]]:
    """Return how many of each of FIELDS are right, of how many, and the clips whose kind is not."""
    meant = {}
    for shapes in stances.values():
        for shape in shapes:
            votes: Counter[str] = Counter()
            for m in shape.members:
                if m in truth and truth[m]["kind"] is not None:
                    x = traits[m].layers[shape.layer]
                    ends = measure_distance_from_stance(
                        shape, x.names, x.last
                    ) < measure_distance_from_stance(shape, x.names, x.first)
                    votes[
                        truth[m]["end_stance" if ends and truth[m]["kind"] == "transition" else "stance"]
                    ] += 1
            meant[id(shape)] = shape.id or (votes.most_common(1)[0][0] if votes else None)
    good: Counter[str] = Counter()
    count: Counter[str] = Counter()
    wrong = []
    for name, told in truth.items():
        if told["kind"] is None or name not in traits:
            continue
        g = guess(traits[name], stances)
        said = {
            "kind": g.kind.value,
            "layer": g.layer.value,
            "limb": g.limb.value,
            "stance": meant[id(g.stance.value)] if g.stance else None,
            "end_stance": meant[id(g.end_stance.value)] if g.end_stance else None,
        }
        for field in FIELDS:
            if told[field] is not None:
                count[field] += 1
                good[field] += said[field] == told[field]
        if said["kind"] != told["kind"]:
            wrong.append(f"{name}: {told['kind']}, not {said['kind']} ({g.kind.confidence:.2f})")
    return good, count, wrong


def row(name: str, good: Counter[str], count: Counter[str]) -> str:
    cells = (
        f"{good[f]:4d}/{count[f]:<4d}{100 * good[f] / count[f]:5.1f} %" if count[f] else f"{'-':>15}"
        for f in FIELDS
    )
    return f"{name:33}" + " ".join(f"{cell:>16}" for cell in cells)


def others() -> Sequence[tuple[str, Truth, dict[str, Clip]]]:
    """Return set, truth, clips of the labelled sets made by others, each skeleton by itself."""
    out = []
    for path in sorted(TRUTH.glob("*.json")) if TRUTH.is_dir() and SHARED.is_dir() else []:
        folder = SHARED / path.stem
        if not folder.is_dir():
            continue
        truth = json.loads(path.read_text("utf-8"))["clips"]
        groups: dict[str, dict[str, Clip]] = {}
        for file in find_clip_files(folder):
            try:
                for clip in read_clips(file):
                    groups.setdefault(clip.skeleton.fingerprint, {})[clip.name] = clip
            except FileError:
                continue  # a character without clips
        out += [(path.stem, truth, clips) for clips in groups.values()]
    return out


def noisy(clip: Clip, seed: int) -> Clip:
    """Return a clip with a little noise on every rotation, so that nothing that is known of the first holds
    of it.
    """
    draw = np.random.default_rng(seed)
    turn = np.concatenate(
        [draw.normal(0, 0.002, (*clip.rotations.shape[:-1], 3)), np.ones((*clip.rotations.shape[:-1], 1))],
        axis=-1,
    )
    rotations = rotation.normalize(rotation.multiply(clip.rotations, turn))
    return Clip(f"{clip.name} {seed}", clip.skeleton, clip.fps, rotations, clip.translations, clip.translated)


def drifting(clip: Clip, seed: int, degrees: float) -> Clip:
    """Return a clip whose joints slowly turn away by some degrees (standard deviation) from first to last
    frame, as captured ones do.
    """
    draw = np.random.default_rng(seed)
    half = (
        np.radians(draw.normal(0, degrees, (1, len(clip.skeleton), 3)))
        / 2
        * np.linspace(-0.5, 0.5, clip.frames)[:, None, None]
    )
    turn = np.concatenate([half, np.ones((*half.shape[:2], 1))], axis=-1)
    rotations = rotation.normalize(rotation.multiply(clip.rotations, turn))
    return Clip(clip.name, clip.skeleton, clip.fps, rotations, clip.translations, clip.translated)


def main() -> None:
    project = open_project(SAMPLE).project
    traits, truth = measure_all_traits(project), truth_of(project)
    print(f"{'names hidden':33}" + " ".join(f"{f:>16}" for f in FIELDS))
    wrong: list[str] = []
    for name, stances in (
        ("sample, its stances known", list_known_stances(project, traits)),
        ("sample, stances discovered", discover_stances(traits)),
    ):
        good, count, wrong = right(truth, traits, stances)
        print(row(name, good, count))
    for degrees in (0.3, 1.0):
        slow = {
            ident: drifting(e.motion, n, degrees)
            for n, (ident, e) in enumerate(project.clips.items())
            if e.motion is not None
        }
        found = {ident: measure_all_traits([clip])[clip.name] for ident, clip in slow.items()}
        good, count, _ = right(truth, found, discover_stances(found))
        print(row(f"sample, joints drift {degrees} degrees", good, count))
    totals: dict[str, tuple[Counter[str], Counter[str]]] = {}
    for name, told, clips in others():
        if name == "sample_clips":
            continue
        found = measure_all_traits(clips.values())
        good, count, _ = right(told, found, discover_stances(found))
        before = totals.setdefault(name, (Counter(), Counter()))
        before[0].update(good)
        before[1].update(count)
    for name, (good, count) in totals.items():
        if count:
            print(row(f"{name} (made by others)", good, count))
    print("\nkinds that are wrong on the sample:")
    for line in wrong:
        ident, rest = line.split(":", 1)
        print(f"    {project.clips[ident].name}:{rest}")
    motions = [e.motion for e in project.clips.values() if e.motion is not None]
    many = [noisy(motions[i % len(motions)], i) for i in range(1000)]
    start = time.perf_counter()
    found = measure_all_traits(many)
    middle = time.perf_counter()
    stances = discover_stances(found)
    later = time.perf_counter()
    for t in found.values():
        guess(t, stances)
    end = time.perf_counter()
    print(
        f"\n{len(many)} clips, {sum(c.frames for c in many)} frames of {len(many[0].skeleton)} joints: "
        f"traits {middle - start:.2f} s, "
        f"stances {later - middle:.2f} s, guesses {end - later:.2f} s, all {end - start:.2f} s"
    )
    waiting = edits.add_clips(
        Project(), [(f"{n}.glb", 0, "", noisy(clip, n + 1000)) for n, clip in enumerate(many)]
    )
    start, busy = time.perf_counter(), time.process_time()
    proposals = propose(waiting)
    middle = time.perf_counter()
    taken = accept(waiting, proposals)
    print(
        f"proposing labels for {len(waiting.clips)} clips: {middle - start:.2f} s, placing "
        f"{len(taken.placed)}: "
        f"{time.perf_counter() - middle:.2f} s; {time.process_time() - busy:.2f} s of a processor"
    )
    some = list_examples(project, traits)
    examples = [
        LabelledExample((*e.words, f"w{n % 40}"), e.measures, e.labels) for n in range(33) for e in some
    ][:5000]
    start = time.perf_counter()
    alike = Alike(examples)
    for e in examples[:1000]:
        alike.guess(e.words, e.measures)
    print(f"asking {len(examples)} labelled clips about 1000: {time.perf_counter() - start:.2f} s")
    start = time.perf_counter()
    for layer in LAYERS:
        make_compatibility_matrix(project, layer)
    first = time.perf_counter() - start
    start = time.perf_counter()
    for layer in LAYERS:
        make_compatibility_matrix(project, layer)
    print(
        f"compatibility of {len(project.clips)} clips with all stances: {first:.2f} s, again "
        f"{time.perf_counter() - start:.2f} s"
    )


if __name__ == "__main__":
    main()
