"""Notice when what is said begins and ends, from one moment to the next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from metagraph.playback.life.items import Speech
from metagraph.playback.life.utterances import explain_end


@dataclass(frozen=True, slots=True)
class SpeechEvent:
    """A piece of something said that begins or ends. kind: "begin" or "end". at: seconds. said: the line's
    id, or the text. reason: why the whole utterance is over; "" at a beginning, and where more of it comes.
    """

    kind: str
    at: float
    id: str
    said: str
    reason: str


@dataclass
class SpeechWatch:
    """Notices what is said, and the end of each utterance once. lasting: the last known piece of each
    utterance that has begun and is not over.
    """

    lasting: list[Speech] = field(default_factory=list)

    def watch(self, speeches: Sequence[Speech], seen: float, now: float) -> list[SpeechEvent]:
        """Return what began and ended after `seen`, until `now`, seconds. speeches: all that are said, by
        start.
        """
        out: list[SpeechEvent] = []
        for speech in speeches:
            if speech.end <= seen or speech.start > now:
                continue
            self._follow(speech)
            if speech.start > seen:
                out.append(self._note("begin", speech, speech.start, ""))
            if speech.end <= now and (speech.over is not None or explain_end(speeches, speech) == ""):
                out.append(self._note("end", speech, speech.end, ""))
        lasting: list[Speech] = []
        for one in self.lasting:
            last = self._find_last(speeches, one)
            if last is None:  # something else took its place before it could go on
                out.append(self._note("end", one, now, "replaced"))
                continue
            reason = explain_end(speeches, last)
            until = last.end if last.over is None else max(last.end, last.over)
            if reason == "" or until > now:
                lasting.append(last)
            else:
                out.append(self._note("end", last, until if until > seen else now, reason))
        self.lasting = lasting
        return out

    def _follow(self, speech: Speech) -> None:
        """Take note that an utterance has begun, or goes on."""
        for one in self.lasting:
            if one.id == speech.id and one.asked == speech.asked:
                return
        self.lasting.append(speech)

    def _note(self, kind: str, speech: Speech, at: float, reason: str) -> SpeechEvent:
        said = speech.text if speech.line is None else speech.line
        return SpeechEvent(kind, at, speech.id, said, reason)

    def _find_last(self, speeches: Sequence[Speech], one: Speech) -> Speech | None:
        """Return the last piece of the utterance that a piece belongs to; None if none is left."""
        last: Speech | None = None
        for speech in speeches:
            if speech.id == one.id and speech.asked == one.asked:
                last = speech
        return last
