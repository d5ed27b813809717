"""What can be heard in a sound file: where it is loud, its syllables, and roughly which shapes the mouth goes
through.

Syllables are found as de Jong and Wempe (2009) do: peaks of loudness that stand 2 dB above the dips beside
them and not far below the loudest. Levels are relative to the line's own, so neither gain nor a steady noise
matters.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import (
    LINE_SECONDS,
    SOUND_BLOCK,
    SOUND_CHANNELS,
    SOUND_FILE,
    SOUND_LOUDEST,
    SOUND_RATES,
    SOUND_SAMPLES,
)
from metagraph.common.files import check_file, guard_reader, is_file, open_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.playback.life.mouth import MouthPiece
from metagraph.speech.quantile import compute_percentile

Array = NDArray[Any]

HOP, WINDOW = 0.010, 0.030  # seconds
LONGEST = LINE_SECONDS  # of one line
LONG = 300.0  # seconds from which samples are kept as float32
SPEECH = (250.0, 3400.0)  # Hz: where syllables are loud and hum and hiss are not
SMOOTH = 0.020  # seconds, of loudness
DIP, BELOW = 2.0, 24.0  # dB: a syllable stands out by; and is at most so much below the loudest
APART = 0.09  # seconds between syllables
OPEN, HALF = 0.66, 0.45  # of a vowel
UNSURE = 0.6  # how far lips close for a gap that may be another stop's
AUDIBLE, SONOROUS = 0.12, 0.4  # how loud speech is at least, and a vowel
_LEAST_RANGE = 9.0  # dB between the loudest and the softest of anything spoken
_HUSH = -84.0  # dB of full scale: softer than this is silence
_BURST = 6.0  # dB a hiss stands out by
_SUFFIXES = "WAV, FLAC, OGG or MP3"
_KINDS = (
    (b"ID3", "an MP3 file"),
    (b"fLaC", "a FLAC file"),
    (b"OggS", "an OGG file"),
    (b"caff", "a Core Audio file"),
    (b".snd", "an AU file"),
    (b"\x1aE\xdf\xa3", "a Matroska or WebM file"),
    (b"\x30\x26\xb2\x75", "a Windows Media file"),
    (b"version https://git-lfs", "a Git LFS pointer whose content was never fetched"),
    (b"<", "a web page or XML file"),
)
_ENDINGS = {
    "a WAV file": (".wav", ".wave", ".bwf", ".rf64"),
    "an MP3 file": (".mp3", ".mpga", ".mp2"),
    "a FLAC file": (".flac", ".fla"),
    "an OGG file": (".ogg", ".oga", ".opus", ".ogx"),
    "an AIFF file": (".aif", ".aiff", ".aifc"),
    "a Core Audio file": (".caf",),
    "an AU file": (".au", ".snd"),
}


@dataclass(frozen=True, eq=False)
class HeardSound:
    """A sound, every `HOP` seconds `[K]`. duration: seconds. level: loudness of speech, dB. loud: 0 as soft
    as what is not speech .. 1 as loud as it gets. open, front: of the vowel, 0..1: how far the mouth is open,
    how far forward the tongue. hiss: share of the energy above 3.5 kHz, 0..1; bright: the middle of that
    energy, Hz.
    """

    duration: float
    times: Array
    level: Array
    loud: Array
    open: Array
    front: Array
    hiss: Array
    bright: Array


@dataclass(frozen=True, eq=False)
class Recording:
    """A sound file, channels apart: samples `[C, N]`, about -1..1, `rate` a second; `original`: how many the
    file has. clipped: share of each channel's samples that were cut off at full scale, 0..1 `[C]`. really:
    what the file is where its ending says another thing, in words, else "".
    """

    samples: Array
    rate: int
    clipped: tuple[float, ...]
    original: int
    really: str = ""

    @property
    def duration(self) -> float:
        """Seconds."""
        return float(self.samples.shape[1] / self.rate)


def read_sound(
    path: str | Path, channel: int | None = None, longest: float = LONGEST, most: int | None = None
) -> tuple[Array, int]:
    """Read a sound file: samples `[N]` of one channel, from 0, or of all mixed, and samples a second.
    longest: seconds it may last. most: as for `read_recording`. Raises FileError.
    """
    read = read_recording(path, longest, most)
    samples = read.samples
    if channel is None:
        return np.asarray(samples.mean(0)), read.rate
    if channel >= len(samples):
        count = f"{len(samples)} channels" if len(samples) > 1 else "one channel"
        raise FileError(
            path,
            phrase("has {count}; there is no channel {channel}", count=count, channel=channel + 1),
            remedy=phrase("Choose the sound again."),
        )
    return samples[channel], read.rate


@guard_reader
def read_head(path: str | Path) -> tuple[int, int, int]:
    """Return samples a second, channels and samples of each of a sound file. Raises FileError."""
    import soundfile

    path = check_file(path, SOUND_FILE)
    try:
        with soundfile.SoundFile(str(path)) as file:
            if not file.frames:
                raise RuntimeError("it holds no sound")
            return int(file.samplerate), int(file.channels), int(file.frames)
    except (soundfile.LibsndfileError, RuntimeError, TypeError, MemoryError, OSError) as error:
        raise _no_sound(path, error) from error


def _no_sound(path: Path, error: Exception) -> FileError:
    cause = str(getattr(error, "error_string", error)).strip().rstrip(".") or type(error).__name__
    if (kind := guess_sound_kind(path)) and not kind.startswith("a WAV"):
        cause = phrase("it is {kind}", kind=kind)
    return FileError(
        path,
        phrase("cannot be read as sound: {cause}", cause=cause),
        phrase("its content"),
        phrase("Save it as {endings}.", endings=_SUFFIXES),
    )


@guard_reader
def read_recording(path: str | Path, longest: float = LONGEST, most: int | None = None) -> Recording:
    """Read a sound file, channels apart, block by block. most: samples a second at most, at least 8000; where
    the file has more, what is too high is taken out, every second, third ... is kept, as float32, so that
    hours fit into memory. Raises FileError.
    """
    import soundfile

    path = Path(path)
    if not is_file(path) and not path.exists():
        raise FileError(
            path,
            phrase("the sound file does not exist"),
            remedy=phrase("Find the file, or choose another one."),
        )
    check_file(path, SOUND_FILE)
    try:
        with soundfile.SoundFile(str(path)) as file:
            rate = int(file.samplerate)
            if file.frames / max(rate, 1) > longest:
                raise FileError(
                    path,
                    phrase(
                        "lasts {lasts:.0f} s, but at most {longest:.0f} s can be read",
                        lasts=file.frames / rate,
                        longest=longest,
                    ),
                    remedy=phrase("Cut it into shorter pieces."),
                )
            if not file.frames or rate < SOUND_RATES[0]:
                why = (
                    phrase("contains no sound")
                    if not file.frames
                    else phrase("has a sample rate of {rate} Hz, too low for speech", rate=rate)
                )
                raise FileError(
                    path,
                    why,
                    remedy=phrase(
                        "Save it as {endings}, with a sample rate of 16000 Hz or more.", endings=_SUFFIXES
                    ),
                )
            if rate > SOUND_RATES[1] or file.channels > SOUND_CHANNELS:
                why = (
                    phrase(
                        "has a sample rate of {rate:,} Hz; the highest that can be read is {most:,} Hz",
                        rate=rate,
                        most=SOUND_RATES[1],
                    )
                    if rate > SOUND_RATES[1]
                    else phrase(
                        "has {channels} channels, but at most {most} can be read",
                        channels=file.channels,
                        most=SOUND_CHANNELS,
                    )
                )
                raise FileError(
                    path,
                    why,
                    remedy=phrase(
                        "Save it again as {endings}, with a sample rate of 48000 Hz.", endings=_SUFFIXES
                    ),
                )
            every = 1 if most is None else max(1, -(-rate // most))
            if file.frames // every * file.channels > SOUND_SAMPLES:
                raise FileError(
                    path,
                    phrase("has more samples than can be read"),
                    remedy=phrase("Cut it, or save it with a sample rate of 48000 Hz."),
                )
            return replace(_read_blocks(file, rate, every), really=explain_misnamed(path))
    except (soundfile.LibsndfileError, RuntimeError, TypeError, MemoryError, OSError) as error:
        raise _no_sound(path, error) from error


def guess_sound_kind(path: str | Path) -> str:
    """Return what a file is by its first bytes, in words ("an MP3 file"), "" if they do not tell."""
    try:
        with open_file(path, SOUND_FILE) as file:
            head = file.read(64)
    except FileError:
        return ""
    if head[4:8] == b"ftyp":
        return "an MPEG-4 file (M4A, MP4)"
    if head[:4] == b"FORM" and head[8:11] == b"AIF":
        return "an AIFF file"
    if head[:4] in (b"RIFF", b"RF64", b"RIFX"):
        return {b"WAVE": "a WAV file", b"AVI ": "an AVI video"}.get(head[8:12], "")
    for start, kind in _KINDS:
        if head.startswith(start):
            return kind
    if len(head) > 2 and head[0] == 0xFF and head[1] & 0xE0 == 0xE0:
        return "an AAC file" if head[1] & 0xF6 == 0xF0 else "an MP3 file"
    return ""


def guess_sound_ending(path: str | Path) -> str:
    """Return the ending of a file that reads as a sound, such as ".wav": its own if that is of a sound, else
    that of its kind. Raises FileError for what is none.
    """
    path = Path(path)
    read_head(path)
    own = path.suffix.lower()
    known = next((endings for words, endings in _ENDINGS.items() if words == guess_sound_kind(path)), ())
    if not known and not any(own in endings for endings in _ENDINGS.values()):
        raise FileError(
            path,
            phrase("has an unusual sound format"),
            phrase("its content"),
            phrase("Save it as {endings}.", endings=_SUFFIXES),
        )
    return path.suffix if not known or own in known else known[0]


def explain_misnamed(path: str | Path) -> str:
    """Return in words what a file is whose ending says it is another kind of sound, else ""."""
    kind = guess_sound_kind(path)
    endings = next((e for words, e in _ENDINGS.items() if words == kind), None)
    suffix = Path(path).suffix.lower()
    return kind if endings is not None and suffix not in endings and suffix else ""


def _read_blocks(file: Any, rate: int, every: int) -> Recording:
    taps = np.hanning(8 * every + 3)[1:-1] * np.sinc(np.arange(-4 * every, 4 * every + 1) / every)
    taps /= taps.sum()
    parts: list[Array] = []
    clipped, count = np.zeros(file.channels), 0
    before = np.zeros((4 * every, file.channels))  # the filter reaches back, and forward
    size = max(1, min(every * rate * 20, SOUND_BLOCK // file.channels))
    for block in file.blocks(blocksize=size, dtype="float64", always_2d=True):
        block = np.nan_to_num(block, nan=0.0, posinf=0.0, neginf=0.0)
        if block.size and max(block.max(), -block.min()) > SOUND_LOUDEST:
            raise RuntimeError("its samples are far beyond full scale")
        clipped += _cut_off(block)
        count += len(block)
        if every == 1:
            parts.append(block.T if file.frames < LONG * rate else block.T.astype(np.float32))
            continue
        before = np.concatenate([before, block])
        full = (len(before) - len(taps) + 1) // every * every
        if full > 0:
            parts.append(_thinned(before[: full + len(taps) - 1], taps, every))
            before = before[full:]
    if every > 1:
        rest = np.concatenate([before, np.zeros((4 * every, file.channels))])
        if len(rest) >= len(taps):
            parts.append(_thinned(rest, taps, every))
    if not count:
        raise RuntimeError("it holds no sound")
    return Recording(np.concatenate(parts, 1), round(rate / every), tuple((clipped / count).tolist()), rate)


def _thinned(samples: Array, taps: Array, every: int) -> Array:
    """Return every so many of the filtered samples `[C, M]`; samples: `[N, C]`."""
    windows = np.lib.stride_tricks.sliding_window_view(samples, len(taps), axis=0)[::every]
    return np.asarray((windows @ taps).T, np.float32)


def _cut_off(samples: Array) -> Array:
    """Return how many of the samples `[N, C]` of each channel stay at full scale for three or more in a
    row.
    """
    full = np.abs(samples) > 0.9999
    row = full[:-2] & full[1:-1] & full[2:]
    out = np.zeros_like(full)
    out[:-2] |= row
    out[1:-1] |= row
    out[2:] |= row
    return np.asarray(out.sum(0))


def analyse_sound(samples: Array, rate: int) -> HeardSound:
    """Analyse a sound: samples `[N]`, about -1..1."""
    duration = len(samples) / rate
    hop, size = HOP * rate, max(16, round(WINDOW * rate))
    count = int(duration / HOP) + 1
    times = np.arange(count) * HOP
    padded = np.pad(samples - samples.mean(), (size // 2, size))
    starts = np.round(np.arange(count) * hop).astype(int)
    hertz = np.fft.rfftfreq(size, 1 / rate)
    window = np.hanning(size)
    scale = window.sum() ** 2 / 4
    bands = [
        (hertz >= low) & (hertz < high)
        for low, high in (SPEECH, (3500, 8000), (1500, 3000), (650, 1300), (120, 3500))
    ]
    middles = [(hertz >= low) & (hertz < high) for low, high in ((220, 1050), (2500, 8000))]
    energies, centres = np.empty((len(bands), count)), np.empty((len(middles), count))
    some_at_once = max(1, min(1000, SOUND_BLOCK // size))  # so that hours fit into memory
    for n in range(0, count, some_at_once):
        now = slice(n, n + some_at_once)
        frames = padded[starts[now, None] + np.arange(size)] * window
        power = np.abs(np.fft.rfft(frames, axis=1)) ** 2 / scale
        for row, some in enumerate(bands):
            energies[row, now] = power[:, some].sum(1)
        for row, some in enumerate(middles):
            amplitude = np.sqrt(power[:, some])
            centres[row, now] = (amplitude @ hertz[some]) / np.maximum(amplitude.sum(1), 1e-12)
    speech, high, forward, back, low = energies
    level = _smooth(10 * np.log10(speech + 1e-12), SMOOTH / HOP)
    floor, top = compute_percentile(level, 8), compute_percentile(level, 97)
    if top < _HUSH or top - floor < _LEAST_RANGE:
        loud = (
            np.zeros(count)
            if top < _HUSH or np.ptp(level) < _LEAST_RANGE
            else np.clip((level - top + BELOW) / BELOW, 0, 1)
        )
    else:
        softest = max(floor + 0.3 * (top - floor), top - BELOW)
        loud = np.clip((level - softest) / (top - softest), 0, 1)
    high_level = 10 * np.log10(high + 1e-12)
    bursts = (high_level > compute_percentile(high_level, 20) + _BURST) & (
        high_level > _HUSH
    )  # a hiss that never stops is noise
    # The first formant rises as the mouth opens, the second as the tongue comes forward.
    first = _smooth(centres[0], 2.0)
    front = _smooth(10 * np.log10((forward + 1e-12) / (back + 1e-12)), 2.0)
    spoken = loud > 0.25
    return HeardSound(
        duration,
        times,
        level,
        loud,
        _relative(first, spoken, 430.0, 600.0),
        _relative(front, spoken, -12.0, 4.0),
        np.where(bursts, high / np.maximum(high + low, 1e-12), 0.0),
        centres[1],
    )


def find_syllables(heard: HeardSound) -> tuple[Array, Array]:
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
    strengths = (
        np.clip(0.5 * loud[kept] + 0.5 * weight[kept] / max(float(weight.max()), 1e-9), 0, 1)
        if kept
        else np.zeros(0)
    )
    return heard.times[kept] if kept else np.zeros(0), strengths


def guess_mouth_shapes(heard: HeardSound) -> list[MouthPiece]:
    """Return the mouth's shapes guessed from the sound alone."""
    labels = _labels(heard)
    out: list[MouthPiece] = []
    start = 0
    for n in range(1, len(labels) + 1):
        if n < len(labels) and labels[n] == labels[start]:
            continue
        begin, end = float(heard.times[start]), float(heard.times[n - 1] + HOP)
        if labels[start] != "sil":
            loud = float(heard.loud[start:n].max())
            strength = 0.35 + 0.65 * loud if labels[start] in ("aa", "E", "I", "O", "U") else 1.0
            if labels[start] == "PP":
                strength = UNSURE
            out.append(MouthPiece(begin, min(end, heard.duration), labels[start], strength))
        start = n
    return out


def _labels(heard: HeardSound) -> list[str]:
    """Return a shape for each moment."""
    vowels = np.where(
        heard.open > OPEN,
        "aa",
        np.where(
            heard.open > HALF, np.where(heard.front > 0.45, "E", "O"), np.where(heard.front > 0.5, "I", "U")
        ),
    )
    # Energy high up that is not far below the line's loudest is a sibilant; softer, teeth on the lip.
    hissing = (heard.hiss > 0.45) & (
        heard.level + 10 * np.log10(np.maximum(heard.hiss / np.maximum(1 - heard.hiss, 1e-3), 1e-9))
        > heard.level.max() - 34
    )
    labels = np.where(heard.loud > SONOROUS, vowels, np.where(heard.loud > AUDIBLE, "nn", "sil"))
    labels = np.where(
        hissing, np.where(heard.bright > 4800, "SS", np.where(heard.bright > 3300, "CH", "FF")), labels
    )
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


def _closures(labels: list[str], heard: HeardSound) -> list[str]:
    """Make short gaps in speech the stops they are: lips where what follows is dull, tongue where it
    bursts.
    """
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
    least, most = (compute_percentile(values[spoken], share) for share in (10, 90))
    own = (values - least) / max(most - least, 0.25 * (high - low))
    return np.asarray(np.clip(0.5 * absolute + 0.5 * own, 0, 1))


def _smooth(values: Array, sigma: float) -> Array:
    """Smooth `[K]` with a bell of `sigma` steps; the ends are held."""
    reach = max(1, round(3 * sigma))
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    return np.asarray(np.convolve(np.pad(values, reach, "edge"), bell / bell.sum(), "valid"))
