"""Makes the sample lines: a voice of our own, made of pulses, hiss and formants, that says a few words.

    python -m sample_clips.make.babble

A source of pulses and noise goes through four resonators in a row, whose frequencies glide from phone to
phone (after Klatt 1980). It sounds like a machine, and need not sound like more: it is there so that a line
can be heard, and seen on the lips, at once. Writes `lines/<name>.flac` and the phones, which are known
exactly, as `lines/<name>.TextGrid`.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.requests import Line

Array = NDArray[Any]

FOLDER = Path(__file__).resolve().parents[1] / "lines"
RATE = 16000
FRAME = 80  # samples between two settings of the resonators
PITCH = 112.0  # Hz, where a phrase begins
FOURTH, WIDTHS = 3500.0, (70.0, 95.0, 130.0, 250.0)  # Hz


@dataclass(frozen=True)
class Phone:
    """Formants, Hz; how strong voice and breath are, and what hiss there is beside them: strength, middle and
    width, Hz; ms.
    """

    formants: tuple[float, float, float]
    voice: float = 1.0
    breath: float = 0.0
    hiss: tuple[float, float, float] = (0.0, 4000.0, 1000.0)
    length: float = 80.0


PHONES: dict[str, Phone] = {
    "AA": Phone((730, 1090, 2440), length=125),
    "AE": Phone((660, 1720, 2410), length=125),
    "AH": Phone((620, 1190, 2390), length=80),
    "AO": Phone((570, 840, 2410), length=125),
    "EH": Phone((530, 1840, 2480), length=100),
    "ER": Phone((480, 1350, 1690), length=110),
    "IH": Phone((390, 1990, 2550), length=75),
    "IY": Phone((280, 2290, 3010), length=105),
    "UH": Phone((440, 1020, 2240), length=75),
    "UW": Phone((310, 870, 2240), length=110),
    "OH": Phone((480, 850, 2400), length=90),
    "M": Phone((270, 1000, 2200), 0.42, length=70),
    "N": Phone((270, 1700, 2600), 0.42, length=65),
    "NG": Phone((270, 2200, 2700), 0.4),
    "L": Phone((360, 1050, 2700), 0.6, length=65),
    "R": Phone((400, 1250, 1550), 0.65, length=65),
    "W": Phone((310, 680, 2200), 0.6, length=65),
    "Y": Phone((280, 2200, 3000), 0.6, length=60),
    "HH": Phone((560, 1500, 2500), 0.0, 0.22, length=60),
    "S": Phone((320, 1700, 2600), 0.0, 0.0, (0.34, 6300, 1600), 105),
    "SH": Phone((320, 1800, 2600), 0.0, 0.0, (0.34, 3000, 1200), 105),
    "Z": Phone((300, 1700, 2600), 0.4, 0.0, (0.16, 6300, 1600), 80),
    "F": Phone((320, 1000, 2200), 0.0, 0.0, (0.07, 5200, 4000), 90),
    "V": Phone((320, 1000, 2200), 0.42, 0.0, (0.035, 5200, 4000), 60),
    "TH": Phone((320, 1400, 2500), 0.0, 0.0, (0.06, 6000, 3500), 80),
    "DH": Phone((320, 1400, 2500), 0.42, 0.0, (0.03, 6000, 3500), 45),
}
# Stops: a gap, voiced or not, then a burst: its strength, middle and width; and where the formants point.
STOPS: dict[str, tuple[float, tuple[float, float, float], tuple[float, float, float]]] = {
    "B": (0.10, (0.10, 800, 900), (250, 850, 2200)), "P": (0.0, (0.22, 900, 1000), (300, 850, 2200)),
    "D": (0.10, (0.12, 4200, 1800), (250, 1750, 2700)), "T": (0.0, (0.28, 4400, 1800), (300, 1800, 2700)),
    "G": (0.10, (0.12, 1900, 900), (250, 2000, 2500)), "K": (0.0, (0.26, 2000, 900), (300, 2000, 2500)),
}  # fmt: skip
GLIDES = {"AY": ("AA", "IH"), "EY": ("EH", "IY"), "OW": ("OH", "UW"), "AW": ("AA", "UH"), "OY": ("AO", "IH")}

# Name, words, phones in ARPAbet: 1 stressed, 0 not; a comma is a breath.
LINES: tuple[tuple[str, str, str], ...] = (
    ("hello", "Hello! How are you?", "HH AH0 L OW1 , HH AW1 AA0 R Y UW1"),
    ("happy", "I am so happy to see you.", "AY0 AE0 M S OW1 HH AE1 P IY0 T UH0 S IY1 Y UW0"),
    ("maybe", "Well, maybe. Who knows?", "W EH1 L , M EY1 B IY0 , HH UW1 N OW1 Z"),
    ("you_first", "No, no, no! You first.", "N OW1 , N OW0 , N OW1 , Y UW1 F ER1 S T"),
)


def spoken(phones: str) -> tuple[Array, list[tuple[float, float, str]]]:
    """Return samples `[N]`, -1..1, and the phones: start, end, name; seconds."""
    rows: list[tuple[float, Phone, float]] = []  # milliseconds, phone, pitch
    marks: list[tuple[float, float, str]] = []
    words = phones.split()
    at = 120.0
    rows.append((at, Phone((500, 1500, 2500), 0.0), PITCH))
    for n, word in enumerate(words):
        name, stress = word.rstrip("012"), word[-1:] if word[-1:].isdigit() else ""
        pitch = PITCH * (1.0 - 0.22 * n / len(words)) * {"1": 1.16, "0": 0.98}.get(stress, 1.0)
        parts = [(length * {"1": 1.25, "0": 0.85}.get(stress, 1.0), phone) for length, phone in _parts(name)]
        begin = at
        for length, phone in parts:
            rows.append((length, phone, pitch))
            at += length
        marks.append((begin / 1e3, at / 1e3, "" if name == "," else word))
    rows.append((150.0, Phone((500, 1500, 2500), 0.0), PITCH * 0.75))
    return _sound(rows), [(0.0, 0.12, ""), *marks, (at / 1e3, (at + 150) / 1e3, "")]


def _parts(name: str) -> list[tuple[float, Phone]]:
    if name == ",":
        return [(170.0, Phone((500, 1500, 2500), 0.0))]
    if name in GLIDES:
        first, second = (PHONES[p] for p in GLIDES[name])
        return [(85.0, first), (65.0, second)]
    if name in STOPS:
        voice, burst, formants = STOPS[name]
        return [
            (55.0, Phone(formants, voice)),
            (14.0, Phone(formants, 0.0, 0.0, burst)),
            (18.0, Phone(formants, 0.1, 0.1)),
        ]
    return [(PHONES[name].length, PHONES[name])]


def _sound(rows: list[tuple[float, Phone, float]]) -> Array:
    """Synthesise phones of so many milliseconds each."""
    frames = [max(1, round(length / 1e3 * RATE / FRAME)) for length, _, _ in rows]
    tracks = np.concatenate(
        [
            np.tile([*p.formants, p.voice, p.breath, *p.hiss, pitch], (count, 1))
            for count, (_, p, pitch) in zip(frames, rows, strict=True)
        ]
    )
    for column, reach in ((0, 5), (1, 5), (2, 5), (3, 2), (4, 2), (5, 1), (8, 12)):
        tracks[:, column] = _smooth(tracks[:, column], reach)
    rng = np.random.default_rng(279)
    count = len(tracks) * FRAME
    each = np.repeat(tracks, FRAME, 0)
    phase = np.cumsum(each[:, 8] / RATE)
    pulses = np.diff(np.floor(phase), prepend=0.0)
    source = _lowpass(_lowpass(pulses, 0.86), 0.6) * each[:, 3] * 1.6
    noise = rng.normal(size=count)
    source = source + 0.25 * noise * each[:, 4] + 0.004 * noise * each[:, 3]
    out = np.diff(source, prepend=0.0)  # the lips radiate what changes
    for column, width in enumerate(WIDTHS):
        out = _resonate(
            out,
            tracks[:, column] if column < 3 else np.full(len(tracks), FOURTH),
            np.full(len(tracks), width),
        )
    hiss = _resonate(rng.normal(size=count), tracks[:, 6], tracks[:, 7]) * each[:, 5]
    out = out / max(np.abs(out).max(), 1e-9) + 0.5 * hiss / max(np.abs(hiss).max(), 1e-9) * float(
        each[:, 5].max()
    )
    return np.asarray(0.6 * out / np.abs(out).max())


def _smooth(values: Array, reach: int) -> Array:
    bell = np.hanning(2 * reach + 3)[1:-1]
    return np.convolve(np.pad(values, reach, "edge"), bell / bell.sum(), "valid")


def _lowpass(values: Array, keep: float) -> Array:
    out, last = np.empty(len(values)), 0.0
    for n, value in enumerate(values.tolist()):
        last = keep * last + (1 - keep) * value
        out[n] = last
    return out


def _resonate(values: Array, hertz: Array, width: Array) -> Array:
    """Pass samples through a resonator that is set again each frame; its gain at 0 Hz is 1."""
    r = np.exp(-np.pi * width / RATE)
    b, c = 2 * r * np.cos(2 * np.pi * np.minimum(hertz, 0.46 * RATE) / RATE), -r * r
    out, one, two = [], 0.0, 0.0
    source = values.tolist()
    for frame, (bb, cc) in enumerate(zip(b.tolist(), c.tolist(), strict=True)):
        aa = 1 - bb - cc
        for value in source[frame * FRAME : (frame + 1) * FRAME]:
            one, two = aa * value + bb * one + cc * two, one
            out.append(one)
    return np.array(out)


def text_grid(marks: list[tuple[float, float, str]]) -> str:
    """Return phones as a TextGrid in Praat's short format."""
    end = marks[-1][1]
    rows = [f'{start:.4f}\n{stop:.4f}\n"{name}"' for start, stop, name in marks]
    head = (
        'File type = "ooTextFile"\nObject class = '
        f'"TextGrid"\n\n0\n{end:.4f}\n<exists>\n1\n"IntervalTier"\n"phones"\n0\n{end:.4f}\n'
    )
    return f"{head}{len(rows)}\n" + "\n".join(rows) + "\n"


def sample_lines() -> dict[str, Line]:
    """Return the sample lines as a project beside `lines` has them."""
    return {
        name: Line(text=text, audio=f"lines/{name}.flac", phones=f"lines/{name}.TextGrid")
        for name, text, _ in LINES
    }


def main() -> None:
    import soundfile

    FOLDER.mkdir(exist_ok=True)
    for name, _, phones in LINES:
        samples, marks = spoken(phones)
        soundfile.write(str(FOLDER / f"{name}.flac"), np.round(samples * 32767).astype(np.int16), RATE)
        (FOLDER / f"{name}.TextGrid").write_text(text_grid(marks), "utf-8", newline="\n")
        print(
            f"{name}.flac  {len(samples) / RATE:.2f} s  "
            f"{(FOLDER / f'{name}.flac').stat().st_size / 1e3:.0f} kB"
        )


if __name__ == "__main__":
    main()
