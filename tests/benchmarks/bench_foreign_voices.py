"""A model and voices of another make: python tests/benchmarks/bench_foreign_voices.py MODEL [seeds]

eSpeak NG says conversations of a minute in several languages and voices; who says what when is read from
sound and words as for any user's recording, the driver performs it on the sample project's graph, and the
model's motion is measured beside that. The planted takes' own synthesiser has no part in it.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
from msgspec.structs import replace as changed  # noqa: E402

from app.cli.command_output import open_for_command  # noqa: E402
from metagraph.formats.conversations.files import read_conversation  # noqa: E402
from metagraph.formats.conversations.languages import Speaking  # noqa: E402
from metagraph.generation.features import compute_features, count_sound_frames, tell_conversation  # noqa: E402
from metagraph.generation.performing import read_side_sound  # noqa: E402
from metagraph.generation.poses import encode_clip  # noqa: E402
from metagraph.generation.statistics import (  # noqa: E402
    MotionSample,
    compute_measures,
    make_motion_sample,
    mismatch_speech,
)
from metagraph.generation.stored import Model, read_model  # noqa: E402
from metagraph.generation.takes import Take, TakeSource, _marks  # noqa: E402
from metagraph.research.generation.evaluation import SamplingManner, generate_poses  # noqa: E402
from metagraph.research.generation.planted import AGAIN, perform_planted  # noqa: E402
from sample_clips.make import talk as maker  # noqa: E402

SHOWN = ("speed", "acceleration", "distance", "still", "trembling", "role", "stroke", "nods_responses")
SHOWN = (*SHOWN, "nods_hesitations", "profile", "frechet")
WORDS = {
    "en-us": "we you they house water never always small road money people green table morning open walk",
    "de": "wir haben gestern keine Zeit unter dem Fenster schnell arbeiten wieder Wasser niemand klein Haus",
    "fr": "nous avons toujours mangé avec des amis dans la petite maison verte demain jamais fenêtre rouge",
    "es": "ellos tienen siempre mucho trabajo sobre la mesa grande nunca mañana caminar verde dinero casa",
    "pl": "oni mają zawsze dużo pracy w małym domu nigdy jutro zielone drzwi woda ludzie stary stół",
    "hi": "हम लोग हमेशा घर में काम करते हैं पानी छोटा रास्ता कभी नहीं सुबह दरवाज़ा",
}
PAIRS = (  # of voices: name, pitch, words a minute
    (("en-us", 38, 165), ("en-us+f3", 58, 175)),
    (("de+m3", 45, 155), ("de+f2", 62, 170)),
    (("fr+f4", 55, 180), ("fr+m1", 40, 160)),
    (("es+m7", 30, 190), ("es+f1", 66, 150)),
    (("pl+m5", 50, 170), ("pl+f5", 70, 165)),
    (("hi+f2", 60, 160), ("hi+m2", 35, 150)),
)
SECONDS = 60.0


def turns(language: str, seed: int) -> tuple[maker.Turn, ...]:
    """Return about a minute of turns, by chance."""
    chance = np.random.default_rng(seed)
    words = WORDS[language].split()
    out, side, spent = [], 0, 0.0
    while spent < SECONDS:
        clauses = []
        for _ in range(int(chance.integers(1, 4))):
            some = chance.choice(words, int(chance.integers(3, 8)))
            at = int(chance.integers(1, len(some)))
            clauses.append(" ".join(f"*{w}*" if n == at else str(w) for n, w in enumerate(some)))
            spent += 0.4 * len(some)
        if chance.random() < 0.3:
            out.append(maker.Turn(side, float(chance.uniform(0.2, 0.6)), ("hesitation: um",)))
            spent += 1
        out.append(maker.Turn(side, float(chance.uniform(0.1, 0.8)), tuple(clauses)))
        if chance.random() < 0.4:
            out.append(maker.Turn(1 - side, float(chance.uniform(-0.3, 0.2)), ("response: yeah",)))
            spent += 0.6
        side = 1 - side
    return tuple(out)


def takes(model: Model, folder: Path) -> tuple[list[Take], list[Take]]:
    """Return takes of all languages, and the same speech performed again."""
    opened_as = open_for_command(ROOT / "sample_clips" / "sample.metagraph.yaml")
    project = getattr(opened_as, "project", opened_as)
    found, again = [], []
    for n, pair in enumerate(PAIRS):
        maker.VOICES = pair
        language = list(WORDS)[n]
        talk = maker.speak(turns(language, n))
        sound, said = folder / f"{language}.wav", folder / f"{language}.json"
        maker.write_sound(sound, talk.samples, talk.rate)
        maker.write_words(said, talk)
        read = changed(
            read_conversation([sound], [said], folder, language, speaking=Speaking("en")).conversation, seed=n
        )
        for side in (0, 1):
            samples, _ = read_side_sound(read, side, folder)
            count = count_sound_frames(samples.shape[1])
            heard = compute_features(samples, tell_conversation(read, side, count), model.card.tracks)
            for seed, into in ((n, found), (n + AGAIN, again)):
                clip = perform_planted(project, changed(read, seed=seed), side)
                poses = encode_clip(model.rig, clip, 25.0)
                take = Take(
                    TakeSource(f"{language} {side + 1}", (), ""), poses[:count], heard, _marks(read, side)
                )
                into.append(take.part(0, min(len(poses), count)))
    return found, again


def main(path: Path, seeds: int) -> None:
    model = read_model(path)
    with TemporaryDirectory() as folder:
        recorded, again = takes(model, Path(folder))
    true = [make_motion_sample(model.rig, t.poses, t) for t in recorded]
    print(f"{path.name}: {len(true)} sides, {sum(t.seconds for t in recorded) / 60:.1f} min, {seeds} seeds")
    print(f"{'':24}" + "".join(f"{name.replace('nods_', '')[:10]:>12}" for name in SHOWN))

    def show(name: str, values: dict[str, float]) -> None:
        print(f"{name:24}" + "".join(f"{values[s]:12.2f}" for s in SHOWN), flush=True)

    show("driver", compute_measures(true, true))
    show("driver again", compute_measures([make_motion_sample(model.rig, t.poses, t) for t in again], true))
    show("to other speech", compute_measures(mismatch_speech(true), true))
    made: list[list[MotionSample]] = []
    for seed in range(1, seeds + 1):
        poses = [
            generate_poses(model, t.features, seed, n, SamplingManner(seeds=1))
            for n, t in enumerate(recorded)
        ]
        made.append([make_motion_sample(model.rig, p, t) for p, t in zip(poses, recorded, strict=True)])
    for n, language in enumerate(WORDS):
        both = slice(2 * n, 2 * n + 2)
        of = [compute_measures(m[both], true[both]) for m in made]
        show(language, {s: float(np.mean([v[s] for v in of])) for s in SHOWN})
    of = [compute_measures(m, true) for m in made]
    show("all", {s: float(np.mean([v[s] for v in of])) for s in SHOWN})


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 3)
