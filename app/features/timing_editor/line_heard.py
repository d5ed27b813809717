"""The line that is spoken while an action plays: where it lies along its clip, and what it looks like."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.features.timing_editor.axis import Axis
from app.stage.line_player import RATE
from app.stage.playback_source import ShownPlayback
from app.widgets.waveforms import Envelope
from metagraph.graph.model import Action, Project
from metagraph.playback.life.track import Speech
from metagraph.playback.life.voice import choose_voice
from metagraph.playback.planning.asked_lines import find_asked_line

Array = NDArray[Any]

SYLLABLE = 0.06  # seconds about a peak that is drawn if there is no sound
BEFORE = 0.15  # seconds of an action to which a line that has ended still belongs


@dataclass(frozen=True)
class Said:
    """speech: what is said. offset: seconds of the clip at which it begins, which may be before 0."""

    speech: Speech
    offset: float


def find_line_heard(shown: ShownPlayback, action: Action) -> Said | None:
    """Return what is said where an action first plays with something said; None if nothing is."""
    if shown.clip is not None:
        return None
    for cue in shown.plan.layers[action.layer].cues:
        if cue.action.id != action.id:
            continue
        for speech in shown.plan.track.speeches:
            if speech.start < cue.end and speech.end > cue.start + BEFORE:
                return Said(speech, round(cue.entry + speech.start - cue.start, 3))
    return None


def lay_line(project: Project, ident: str, action: Action, stroke: float) -> Said | None:
    """Return a line of the project laid on an action so that its first stress falls on the stroke; None if
    the line is gone.
    """
    if ident not in project.lines:
        return None
    speech = _speech(project, ident)
    voice = choose_voice(project.voices, speech)
    first = float(voice.accents[0]) if len(voice.accents) else 0.0
    return Said(speech, round(stroke - first, 3))


def find_requested_line(project: Project, action: Action) -> Said | None:
    """Return the line that an action is asked for with, performed or not; None if there is none."""
    found = find_asked_line(project, action) if action.clip in project.clips else None
    if found is None:
        return None
    return Said(_speech(project, found.line), round(project.span(action)[0] + found.at, 3))


def _speech(project: Project, ident: str) -> Speech:
    line = project.lines[ident]
    return Speech("line", 0.0, line.duration or 0.0, ident, line.text, length=line.duration)


def find_line_stresses(project: Project, said: Said | None) -> tuple[float, ...]:
    """Return the moments a line stresses, seconds of the clip."""
    if said is None:
        return ()
    return tuple(round(float(t) + said.offset, 3) for t in choose_voice(project.voices, said.speech).accents)


class Waves:
    """Envelopes of what is said, made once each."""

    def __init__(self) -> None:
        self._made: dict[tuple[str, int], Envelope] = {}

    def columns(
        self, project: Project, said: Said, sounds: Mapping[str, Array], axis: Axis
    ) -> tuple[Array, Array]:
        """Return least and greatest of a line `[W]` in the columns of pixels of an axis, -1..1."""
        samples = sounds.get(said.speech.line or "")
        key = (said.speech.line or said.speech.text, id(samples))
        if key not in self._made:
            self._made = {key: _sound(samples) if samples is not None else _peaks(project, said)}
        return self._made[key].columns(axis.first - said.offset, axis.each, max(1, int(axis.width)))


def _sound(samples: Array) -> Envelope:
    mono = np.asarray(samples, np.float32)
    mono = mono.mean(1) if mono.ndim > 1 else mono
    out = Envelope(len(mono) / RATE)
    loudest = float(np.abs(mono).max(initial=0.0)) or 1.0
    out.fill(0, mono / loudest, RATE / out.rate)
    return out


def _peaks(project: Project, said: Said) -> Envelope:
    """Where there is no sound, its syllables are drawn as guessed from the text."""
    voice = choose_voice(project.voices, said.speech)
    out = Envelope(max(voice.duration, 0.1))
    times = np.arange(int(voice.duration * out.rate) + 1) / out.rate
    loud: Array = voice.strengths if len(voice.strengths) else np.ones(len(voice.peaks))
    heights = np.zeros(len(times))
    for peak, strength in zip(voice.peaks, loud, strict=True):
        heights = np.maximum(heights, strength * np.exp(-(((times - peak) / SYLLABLE) ** 2)))
    out.put(0, -heights.astype(np.float32), heights.astype(np.float32))
    return out
