"""How aroused somebody's voice is, beside how they speak usually: for lines that say nothing of their mood.

Louder, faster and more varied in pitch than usual is more aroused (Scherer 1986; Juslin and Laukka 2003, who
found all three in 104 studies of vocal expression). Valence is hardly heard in them, so nothing is said of
it. The weights and bounds are ours.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec
import numpy as np

from metagraph.graph.model import Project
from metagraph.speech.lines import Array
from metagraph.speech.loudness import measure_loudness
from metagraph.speech.pitch import measure_pitch, smooth
from metagraph.speech.sound import analyse_sound, find_syllables, read_sound

# By how much of each above the speaker's own median a voice is as aroused as it can be: LU, of the rate,
# semitones of range; ours.
FULL = (10.0, 0.5, 8.0)
MOST = 0.8  # a voice alone makes nobody more or less aroused than this
LEAST = 3  # lines of a speaker below which nothing is reported: the median would be of next to nothing
SHORTEST = 0.6  # seconds of sound below which nothing is reported


@dataclass(frozen=True, slots=True)
class VoiceFeatures:
    """How something is said. loudness: LUFS. rate: syllables a second. range: semitones between the 10th and
    90th percentile of its pitch; each NaN where it is not heard.
    """

    loudness: float
    rate: float
    range: float


def measure_voice(samples: Array, rate: int) -> VoiceFeatures:
    """Return how a sound `[N]`, -1..1, is said."""
    nan = float("nan")
    if len(samples) < SHORTEST * rate:
        return VoiceFeatures(nan, nan, nan)
    loud = measure_loudness(samples, rate)
    heard = analyse_sound(samples, rate)
    beats = find_syllables(heard)[0]
    spoken = float(beats[-1] - beats[0]) if len(beats) > 1 else 0.0
    tones = smooth(measure_pitch(samples, rate))
    tones = tones[np.isfinite(tones)]
    span = float(np.ptp(np.percentile(tones, (10, 90)))) if len(tones) >= 10 else nan
    return VoiceFeatures(
        nan if loud is None else loud, (len(beats) - 1) / spoken if spoken > 0.3 else nan, span
    )


def measure_arousals(said: Sequence[VoiceFeatures]) -> list[float]:
    """Return how aroused one speaker's voice is in each of what they said, -0.8..0.8: the mean of how far
    each feature that is heard is from its median. All 0 of fewer than three.
    """
    if len(said) < LEAST:
        return [0.0] * len(said)
    rows = np.array([[s.loudness, s.rate, s.range] for s in said])
    with np.errstate(invalid="ignore"):
        known = np.isfinite(rows).any(0)
        middle = np.array(
            [np.median(c[np.isfinite(c)]) if k else 0.0 for c, k in zip(rows.T, known, strict=True)]
        )
        away = rows - middle
        away[:, 1] /= max(float(middle[1]), 1e-6)
        each = np.clip(away / FULL, -1.0, 1.0)
    out = [float(np.mean(row[np.isfinite(row)])) if np.isfinite(row).any() else 0.0 for row in each]
    return [MOST * x for x in out]


def with_voice_moods(project: Project, folder: str | Path) -> Project:
    """Return the project with moods on its lines that have a sound and say nothing of theirs; one speaker is
    taken to say them all. folder: of the project file. Lines whose sound is missing stay as they are.
    """
    heard: dict[str, VoiceFeatures] = {}
    for ident, line in project.lines.items():
        path = Path(folder) / line.audio if line.audio is not None else None
        if path is not None and path.is_file():
            samples, rate = read_sound(path, line.channel)
            heard[ident] = measure_voice(samples, rate)
    told: Mapping[str, float] = dict(zip(heard, measure_arousals(list(heard.values())), strict=True))
    lines = {
        ident: msgspec.structs.replace(line, mood=(0.0, round(told[ident], 2)))
        if ident in told and line.mood is None and round(told[ident], 2) != 0
        else line
        for ident, line in project.lines.items()
    }
    return replace(project, lines=lines)
