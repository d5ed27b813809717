"""What can be heard in a sound file: where it is loud, its syllables, and roughly which shapes the mouth goes through.

Syllables are found as de Jong and Wempe (2009) do: peaks of loudness that stand 2 dB above the dips beside them and not far
below the loudest. Levels are relative to the line's own, so neither gain nor a steady noise matters.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.playback.life.mouth import Piece

Array = NDArray[Any]

HOP, WINDOW = 0.010, 0.030  # seconds
LONGEST = 1800.0  # seconds of one line
SPEECH = (250.0, 3400.0)  # Hz: where syllables are loud and hum and hiss are not
SMOOTH = 0.020  # seconds, of loudness
DIP, BELOW = 2.0, 24.0  # dB: a syllable stands out by; and is at most so much below the loudest
APART = 0.09  # seconds between syllables
OPEN, HALF = 0.66, 0.45  # of a vowel
AUDIBLE, SONOROUS = 0.12, 0.4  # how loud speech is at least, and a vowel
_LEAST_RANGE = 9.0  # dB between the loudest and the softest of anything spoken
_HUSH = -84.0  # dB of full scale: softer than this is silence
_BURST = 6.0  # dB a hiss stands out by
_SUFFIXES = "WAV, FLAC, OGG or MP3"


@dataclass(frozen=True, eq=False)
class Heard:
    """A sound, every `HOP` seconds `[K]`. duration: seconds. level: loudness of speech, dB. loud: 0 as soft as what is not
    speech .. 1 as loud as it gets. open, front: of the vowel, 0..1: how far the mouth is open, how far forward the tongue.
    hiss: share of the energy above 3.5 kHz, 0..1; bright: the middle of that energy, Hz.
    """

    duration: float
    times: Array
    level: Array
    loud: Array
    open: Array
    front: Array
    hiss: Array
    bright: Array


def read_sound(path: str | Path) -> tuple[Array, int]:
    """Read a sound file: samples `[N]` float64, channels mixed, and samples a second. Raises FileError."""
    import soundfile

    path = Path(path)
    if not path.is_file():
        raise FileError(path, "there is no such sound file", remedy="Check the line's sound, or choose the file anew.")
    try:
        with soundfile.SoundFile(str(path)) as file:
            if file.frames / max(file.samplerate, 1) > LONGEST:
                raise FileError(
                    path, f"lasts {file.frames / file.samplerate:.0f} s; a line has {LONGEST:.0f} s at most", remedy="Cut it into lines."
                )
            samples, rate = file.read(dtype="float64", always_2d=True), int(file.samplerate)
    except (soundfile.LibsndfileError, RuntimeError, TypeError, MemoryError, OSError) as error:
        cause = str(getattr(error, "error_string", error)).strip().rstrip(".") or type(error).__name__
        raise FileError(path, f"cannot be read as sound: {cause}", remedy=f"Save it as {_SUFFIXES}.") from error
    if not len(samples) or rate < 4000:
        why = "holds no sound" if not len(samples) else f"has {rate} samples a second, too few for speech"
        raise FileError(path, why, remedy=f"Save it as {_SUFFIXES}, with 16000 samples a second or more.")
    return np.nan_to_num(samples, nan=0.0, posinf=0.0, neginf=0.0).mean(1), rate


def hear(samples: Array, rate: int) -> Heard:
    """Analyse a sound: samples `[N]`, about -1..1."""
    duration = len(samples) / rate
    hop, size = HOP * rate, max(16, round(WINDOW * rate))
    count = int(duration / HOP) + 1
    times = np.arange(count) * HOP
    padded = np.pad(samples - samples.mean(), (size // 2, size))
    starts = np.round(np.arange(count) * hop).astype(int)
    power = np.empty((count, size // 2 + 1))
    window = np.hanning(size)
    for n in range(0, count, 1000):  # a few seconds at a time
        frames = padded[starts[n : n + 1000, None] + np.arange(size)] * window
        power[n : n + 1000] = np.abs(np.fft.rfft(frames, axis=1)) ** 2
    power /= window.sum() ** 2 / 4
    hertz = np.fft.rfftfreq(size, 1 / rate)

    def band(low: float, high: float) -> Array:
        return np.asarray(power[:, (hertz >= low) & (hertz < high)].sum(1))

    def middle(low: float, high: float) -> Array:
        some = (hertz >= low) & (hertz < high)
        amplitude = np.sqrt(power[:, some])
        return np.asarray((amplitude @ hertz[some]) / np.maximum(amplitude.sum(1), 1e-12))

    speech, high = band(*SPEECH), band(3500.0, 8000.0)
    level = _smooth(10 * np.log10(speech + 1e-12), SMOOTH / HOP)
    floor, top = float(np.percentile(level, 8)), float(np.percentile(level, 97))
    if top < _HUSH or top - floor < _LEAST_RANGE:
        loud = np.zeros(count) if top < _HUSH or np.ptp(level) < _LEAST_RANGE else np.clip((level - top + BELOW) / BELOW, 0, 1)
    else:
        softest = max(floor + 0.3 * (top - floor), top - BELOW)
        loud = np.clip((level - softest) / (top - softest), 0, 1)
    high_level = 10 * np.log10(high + 1e-12)
    bursts = (high_level > np.percentile(high_level, 20) + _BURST) & (high_level > _HUSH)  # a hiss that never stops is noise
    # The first formant rises as the mouth opens, the second as the tongue comes forward.
    first = _smooth(middle(220.0, 1050.0), 2.0)
    forward, back = band(1500.0, 3000.0), band(650.0, 1300.0)
    front = _smooth(10 * np.log10((forward + 1e-12) / (back + 1e-12)), 2.0)
    spoken = loud > 0.25
    return Heard(
        duration,
        times,
        level,
        loud,
        _relative(first, spoken, 430.0, 600.0),
        _relative(front, spoken, -12.0, 4.0),
        np.where(bursts, high / np.maximum(high + band(120.0, 3500.0), 1e-12), 0.0),
        middle(2500.0, 8000.0),
    )


def syllables(heard: Heard) -> tuple[Array, Array]:
    """Return times and strengths `[P]`, 0..1, of the peaks of loudness."""
    level, loud = heard.level, heard.loud
    inside = np.flatnonzero((loud[1:-1] > 0.08) & (level[1:-1] >= level[:-2]) & (level[1:-1] > level[2:])) + 1
    kept: list[int] = []
    for peak in inside.tolist():
        if kept:
            last = kept[-1]
            lower, dip = min(level[last], level[peak]), level[last : peak + 1].min()
            if lower - dip < DIP or heard.times[peak] - heard.times[last] < APART:  # still the same syllable
                if level[peak] > level[last]:
                    kept[-1] = peak
                continue
        kept.append(peak)
    # A stressed syllable is loud and long: loudness over a longer while tells it better than its peak.
    weight = _smooth(loud, 0.08 / HOP)
    strengths = np.clip(0.5 * loud[kept] + 0.5 * weight[kept] / max(float(weight.max()), 1e-9), 0, 1) if kept else np.zeros(0)
    return heard.times[kept] if kept else np.zeros(0), strengths


def shapes_heard(heard: Heard) -> list[Piece]:
    """Return the mouth's shapes guessed from the sound alone."""
    labels = _labels(heard)
    out: list[Piece] = []
    start = 0
    for n in range(1, len(labels) + 1):
        if n < len(labels) and labels[n] == labels[start]:
            continue
        begin, end = float(heard.times[start]), float(heard.times[n - 1] + HOP)
        if labels[start] != "sil":
            loud = float(heard.loud[start:n].max())
            strength = 0.35 + 0.65 * loud if labels[start] in ("aa", "E", "I", "O", "U") else 1.0
            out.append(Piece(begin, min(end, heard.duration), labels[start], strength))
        start = n
    return out


def _labels(heard: Heard) -> list[str]:
    """Return a shape for each moment."""
    vowels = np.where(
        heard.open > OPEN,
        "aa",
        np.where(heard.open > HALF, np.where(heard.front > 0.45, "E", "O"), np.where(heard.front > 0.5, "I", "U")),
    )
    # Energy high up that is not far below the line's loudest is a sibilant; softer, teeth on the lip.
    hissing = (heard.hiss > 0.45) & (
        heard.level + 10 * np.log10(np.maximum(heard.hiss / np.maximum(1 - heard.hiss, 1e-3), 1e-9)) > heard.level.max() - 34
    )
    labels = np.where(heard.loud > SONOROUS, vowels, np.where(heard.loud > AUDIBLE, "nn", "sil"))
    labels = np.where(hissing, np.where(heard.bright > 4800, "SS", np.where(heard.bright > 3300, "CH", "FF")), labels)
    out = _settled(labels.tolist(), 4)
    return _closures(out, heard)


def _settled(labels: list[str], least: int) -> list[str]:
    """Give what lasts less than `least` moments to what is before it."""
    out = list(labels)
    start = 0
    for n in range(1, len(out) + 1):
        if n < len(out) and labels[n] == labels[start]:
            continue
        if n - start < least and start > 0 and labels[start] != "sil":
            out[start:n] = [out[start - 1]] * (n - start)
        start = n
    return out


def _closures(labels: list[str], heard: Heard) -> list[str]:
    """Make short gaps in speech the stops they are: lips where what follows is dull, tongue where it bursts."""
    out, n = list(labels), 0
    while n < len(out):
        if out[n] != "sil":
            n += 1
            continue
        end = n
        while end < len(out) and out[end] == "sil":
            end += 1
        if n > 0 and end < len(out) and (end - n) * HOP <= 0.16:
            burst = float(heard.hiss[max(0, end - 2) : end + 3].max())
            out[n:end] = ["DD" if burst > 0.3 else "PP"] * (end - n)
        n = end
    return out


def _relative(values: Array, spoken: Array, low: float, high: float) -> Array:
    """Return values from 0 to 1: half by the range this voice has, half by what voices have."""
    absolute = (values - low) / (high - low)
    if spoken.sum() < 8:
        return np.asarray(np.clip(absolute, 0, 1))
    least, most = np.percentile(values[spoken], (10, 90))
    own = (values - least) / max(most - least, 0.25 * (high - low))
    return np.asarray(np.clip(0.5 * absolute + 0.5 * own, 0, 1))


def _smooth(values: Array, sigma: float) -> Array:
    """Smooth `[K]` with a bell of `sigma` steps; the ends are held."""
    reach = max(1, round(3 * sigma))
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    return np.asarray(np.convolve(np.pad(values, reach, "edge"), bell / bell.sum(), "valid"))
