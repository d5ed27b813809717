"""Read voices on a thread: the waveform of each line's sound, and its words with times."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.stage.performance import StagePerformance
from app.translation import tr
from app.widgets.memo import Once
from metagraph.errors import FileError
from metagraph.graph.requests import Line

if TYPE_CHECKING:
    from app.widgets.waveforms import Envelope
    from metagraph.graph.conversation.model import Word

LONGEST = 36000.0  # seconds of a sound
KEPT = 16000  # samples a second that a waveform needs
SETTING = "timeline/words"
Key = tuple[str | None, int | None, str | None]  # a line's sound, channel and TextGrid: whole paths


@dataclass(frozen=True)
class LineVoice:
    """The voice of a line. wave: None if there is no readable sound. loudest: the largest sample, 0..1."""

    wave: Envelope | None = None
    loudest: float = 1.0
    words: tuple[Word, ...] = ()


class Voices(QObject):
    """changed: a voice was read. version: how often."""

    changed = Signal()

    def __init__(
        self, document: Document, jobs: Jobs, performance: StagePerformance, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.jobs, self.performance = document, jobs, performance
        self.version = 0
        self._read: dict[Key, LineVoice | None] = {}  # None while it is being read
        self._words: Once[list[tuple[float, float, str]]] = Once()
        performance.changed.connect(self._follow)
        document.loaded.connect(self.forget)
        self._follow()

    def forget(self) -> None:
        self._read, self._words, self.version = {}, Once(), 0

    def _key(self, line: Line) -> Key:
        shown = self.performance.shown
        folder = shown.folder or self.document.folder or Path()
        whole = [os.path.normpath(folder / p) if p else None for p in (line.audio, line.phones)]
        return whole[0], line.channel, whole[1]

    def _lines(self) -> dict[str, Line]:
        """Return the lines that are said, by id."""
        shown = self.performance.shown
        if shown.clip is not None:
            return {}
        found = ((s.line, shown.project.lines.get(s.line or "")) for s in shown.plan.track.speeches)
        return {i: x for i, x in found if i is not None and x is not None and (x.audio or x.phones)}

    def _follow(self) -> None:
        wanted = {self._key(x): x for x in self._lines().values()}
        missing = {k: x for k, x in wanted.items() if k not in self._read}
        self._read = {k: v for k, v in self._read.items() if k in wanted or v is None}
        if not missing:
            return
        self._read.update(dict.fromkeys(missing))
        self.jobs.start(
            tr("Reading voices"), lambda job: _read_all(list(missing), job), self._came, lambda error: None
        )

    def _came(self, found: dict[Key, LineVoice]) -> None:
        self._read.update(found)
        self.version += 1
        self.changed.emit()

    def of(self, line: str | None) -> LineVoice | None:
        """Return the voice of a line, by its id, as far as it is read."""
        found = self.performance.shown.project.lines.get(line or "")
        return self._read.get(self._key(found)) if found is not None else None

    def words(self) -> list[tuple[float, float, str]]:
        """Return the words that are said and whose times are known: first and last second, text."""
        from metagraph.speech.captions import list_timed_words

        shown = self.performance.shown
        if shown.clip is not None:
            return []
        talk = self.document.project.conversations.get(self.performance.conversation or "")

        def make() -> list[tuple[float, float, str]]:
            if talk is not None and shown.side < len(talk.sides):
                return [(w.start, w.end, w.text) for w in talk.sides[shown.side].words]
            said = shown.plan.track.speeches
            lines = {i: v.words for s in said if (i := s.line) and (v := self.of(i)) is not None}
            return [(w.start, w.end, w.text) for s in said for w in list_timed_words(s, lines)]

        return self._words.of((self.version, shown.side), (shown.plan, talk), make)

    @property
    def wanted(self) -> bool:
        """Whether there is anything to show: words with times, or a sound."""
        return bool(self._lines()) or bool(self.words())


def _read_all(keys: list[Key], job: WindowJob) -> dict[Key, LineVoice]:
    out: dict[Key, LineVoice] = {}
    for n, key in enumerate(keys):
        if job.cancelled:
            break
        job.tell(n, len(keys), Path(key[0] or key[2] or "").name)
        out[key] = _voice(key)
    return {**{key: LineVoice() for key in keys}, **out}


def _voice(key: Key) -> LineVoice:
    """Read one; what cannot be read is nothing: who plays it says why."""
    from app.widgets.waveforms import Envelope
    from metagraph.speech.captions import describe_line
    from metagraph.speech.sound import read_recording

    path, channel, phones = key
    words = describe_line(Line(phones=phones), Path()) if phones is not None else ()
    if path is None:
        return LineVoice(words=words)
    try:
        read = read_recording(path, LONGEST, KEPT)
    except FileError:
        return LineVoice(words=words)
    there = channel is None or channel < len(read.samples)
    samples = read.samples.mean(0) if channel is None or not there else read.samples[channel]
    wave = Envelope(len(samples) / read.rate)
    wave.fill(0, samples, read.rate / wave.rate)
    return LineVoice(wave, max(1e-3, float(abs(samples).max(initial=0.0))), words)
