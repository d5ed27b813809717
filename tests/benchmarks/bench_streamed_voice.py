"""What runtimes hear in a sound as it comes in, beside what the analysis of the whole sound makes of it:
`python tests/benchmarks/bench_streamed_voice.py [SOUND ...]`. Our lines and conversation, and recordings made
by others in `../shared/data`; the bounds were chosen on all of these.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from metagraph.playback.life.streamed_voice import StreamedVoice
from metagraph.speech.sound import analyse_sound, guess_mouth_shapes, read_sound

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "data" / "praatio-speech"
SOUNDS = (
    *sorted((ROOT / "sample_clips" / "lines").glob("*.flac")),
    *sorted((ROOT / "sample_clips" / "conversation").glob("*.ogg")),
    *(SHARED / f"{name}.wav" for name in ("bobby_16bit_16khz", "damon_set_test", "mary")),
)
STEP, PIECE, LONGEST = 0.01, 0.1, 20.0  # seconds
# How far each shape opens a mouth.
OPENS = {"sil": 0.0, "PP": 0.0, "FF": 0.08, "SS": 0.15, "CH": 0.2, "DD": 0.25, "nn": 0.25, "aa": 1.0,
         "E": 0.6, "O": 0.7, "I": 0.35, "U": 0.35}  # fmt: skip


def shown(marks: list[tuple[float, float, str, float]], count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return for each step how far the mouth is open, and whether it is shut."""
    opens, shut = np.zeros(count), np.ones(count, bool)
    for start, end, shape, weight in marks:
        some = slice(round(start / STEP), round(end / STEP))
        opens[some], shut[some] = OPENS[shape] * weight, shape in ("sil", "PP")
    return opens, shut


def main() -> None:
    print(
        "sound                        seconds  open or shut  correlation of how open  processor, of real time"
    )
    for path in map(Path, sys.argv[1:] or SOUNDS):
        if not path.is_file():
            print(f"{path.name}: is not there")
            continue
        samples, rate = read_sound(path, None)
        samples = np.asarray(samples)[: round(LONGEST * rate)]
        count = int(len(samples) / rate / STEP)
        whole = [
            (p.start, p.end, p.viseme, p.strength) for p in guess_mouth_shapes(analyse_sound(samples, rate))
        ]
        began = time.process_time()
        voice, marks = StreamedVoice(float(rate)), []
        for n in range(0, len(samples), round(PIECE * rate)):
            marks += voice.hear(samples[n : n + round(PIECE * rate)].tolist())
        spent = time.process_time() - began
        ends = [*(m.at for m in marks[1:]), count * STEP]
        found = [(m.at, end, m.viseme, m.weight) for m, end in zip(marks, ends, strict=True)]
        (wanted, still), (opens, shut) = shown(whole, count), shown(found, count)
        print(
            f"{path.name:28} {len(samples) / rate:7.1f} {100 * np.mean(still == shut):18.0f} % "
            f"{np.corrcoef(wanted, opens)[0, 1]:20.2f} {100 * spent * rate / len(samples):14.1f} %"
        )


if __name__ == "__main__":
    main()
