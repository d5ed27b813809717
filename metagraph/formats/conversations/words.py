"""Whose words a transcript's are: its speakers brought to the sides of a conversation, by what each side's
sound tells.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import permutations
from pathlib import Path

import msgspec
import numpy as np

from metagraph.common.wording import join_phrases, phrase
from metagraph.errors import FileError
from metagraph.formats.transcripts.words import Transcript, count, join_as_list
from metagraph.graph.conversation.model import SHORTEST, Segment, Word
from metagraph.speech.activity import HUSH, find_activity
from metagraph.speech.pitch import Pitch
from metagraph.speech.sound import HeardSound

GAPLESS = 0.01  # seconds: words of one subtitle, whose times are shared out, follow each other without a gap


@dataclass(frozen=True, eq=False)
class SideVoice:
    """A sound of one side, or of several who share it: where it is from, as it is called in notes, and what
    is heard there.
    """

    path: Path
    channel: int | None
    called: str
    heard: HeardSound
    pitch: Pitch

    @cached_property
    def top(self) -> float:
        """How loud it is at its loudest, dB."""
        return max(float(np.percentile(self.heard.level, 99)), HUSH)


@dataclass(frozen=True)
class TranscribedSide:
    """What a transcript says of one side. segments: None if it says nothing of them; whom they are said to is
    a place among `names`, all who speak in the transcript. path: the transcript's, None without one.
    """

    name: str = ""
    words: tuple[Word, ...] = ()
    segments: tuple[Segment, ...] | None = None
    path: Path | None = None
    names: tuple[str, ...] = ()


def match_sides(
    notes: list[str], voices: Sequence[SideVoice], said: list[tuple[Path, Transcript]], most: int
) -> tuple[tuple[SideVoice, TranscribedSide], ...]:
    """Return the sides: the sound of each, and what the transcripts say of it. voices: one a channel or file,
    a single one if all share it. most: sides at most.

    There are as many as there are voices, or more where the words name more speakers: those share the sound
    in which they are loudest. One sound without words, or with one speaker's, is a single side.
    """
    if len(said) > 1:
        return _one_a_side(notes, voices, said)
    speakers = _speakers(notes, *said[0], most) if said else []
    if len(speakers) == 1:
        return _one_speaker(notes, voices, said[0][0], speakers[0])
    if len(voices) == 1:
        return tuple((voices[0], one) for one in speakers or [TranscribedSide()])
    if len(speakers) > len(voices):
        return _sharing(notes, voices, said[0][0], speakers)
    of = _best(voices, speakers)
    return tuple(
        (voice, speakers[of.index(n)] if n in of else TranscribedSide()) for n, voice in enumerate(voices)
    )


def _sharing(
    notes: list[str], voices: Sequence[SideVoice], path: Path, speakers: list[TranscribedSide]
) -> tuple[tuple[SideVoice, TranscribedSide], ...]:
    """Return more speakers than sounds, each with the one it is loudest in."""
    out = []
    for one in speakers:
        loud = [_loudness(voices, one.words, n) for n in range(len(voices))]
        out.append((voices[loud.index(max(loud))], one))
    notes.append(
        phrase(
            "{name} names {count} speakers for {count2} channels. Some share a "
            "channel, and there only the transcript shows who speaks.",
            name=path.name,
            count=len(speakers),
            count2=len(voices),
        )
    )
    return tuple(out)


def _best(voices: Sequence[SideVoice], speakers: Sequence[TranscribedSide]) -> tuple[int, ...]:
    """Return the voice of each speaker, no two the same: those in which they are loudest together; as they
    come where that says nothing.
    """
    loud = [[_loudness(voices, one.words, n) for n in range(len(voices))] for one in speakers]
    return max(
        permutations(range(len(voices)), len(speakers)),
        key=lambda order: sum(loud[k][n] for k, n in enumerate(order)),
        default=(),
    )


def _speakers(notes: list[str], path: Path, transcript: Transcript, most: int) -> list[TranscribedSide]:
    """Return those who speak, in the file's order; of more than there may be, those who say most."""
    found = [
        TranscribedSide(name, words, transcript.segments.get(name), path, tuple(transcript.speakers))
        for name, words in transcript.speakers.items()
    ]
    speaking = [s for s in found if s.words or s.segments]
    if len(found) > min(most, 2) <= len(speaking):
        found = speaking
    if len(found) > most:
        kept = sorted(found, key=lambda s: -(len(s.words) or len(s.segments or ())))[:most]
        left = [s for s in found if s not in kept]
        gone = join_phrases(
            [f"'{s.name[:40]}'" if s.name else phrase("an unnamed speaker") for s in left[:8]], ", "
        )
        notes.append(
            phrase(
                "{name} has {count} speakers; skipped in a conversation of {value}: {gone}.",
                name=path.name,
                count=len(found),
                value=phrase("two") if most <= 2 else most,
                gone=gone,
            )
        )
        found = [s for s in found if s in kept]
    return found


def _one_a_side(
    notes: list[str], voices: Sequence[SideVoice], said: list[tuple[Path, Transcript]]
) -> tuple[tuple[SideVoice, TranscribedSide], ...]:
    out = []
    for path, transcript in said:
        found = _speakers(notes, path, transcript, 1)
        one = found[0] if found else TranscribedSide()
        out.append(one if one.name else replace(one, name=path.stem[:200]))
    if len(voices) == 1:
        return tuple((voices[0], one) for one in out)
    of = _best(voices, out)
    better, here = (
        sum(_loudness(voices, one.words, n) for one, n in zip(out, order, strict=True))
        for order in (of, range(len(out)))
    )
    if better > here + 3 * sum(bool(s.words) for s in out):
        swapped = [(said[k][0].name, voices[n].called) for k, n in enumerate(of) if k != n]
        each = [phrase("{name} fits {voice}", name=name, voice=voice) for name, voice in swapped]
        fits = join_as_list(each)
        notes.append(
            phrase(
                "{fits} better than the other way round, but they were not swapped. Give "
                "them in the order of the sides.",
                fits=fits,
            )
        )
    return tuple(zip(voices, out, strict=True))


def _keep_lines_whole(words: Sequence[Word], sides: Sequence[int]) -> list[int]:
    """Return the side of each word. Words that follow each other without any gap, as in one subtitle, are all
    of the side that most of their time is.
    """
    out: list[int] = []
    first = 0
    for n in range(1, len(words) + 1):
        if n == len(words) or words[n].start - words[n - 1].end > GAPLESS:
            share: Counter[int] = Counter()
            for word, side in zip(words[first:n], sides[first:n], strict=True):
                share[side] += round(1000 * max(0.001, word.end - word.start))
            out += [share.most_common(1)[0][0]] * (n - first)
            first = n
    return out


def _one_speaker(
    notes: list[str], voices: Sequence[SideVoice], path: Path, one: TranscribedSide
) -> tuple[tuple[SideVoice, TranscribedSide], ...]:
    """Return what one speaker's words are to all sides: each word is whose channel is louder then."""
    if len(voices) == 1:
        notes.append(
            phrase(
                "{name} does not name two speakers, and there is only one sound, so one person says all "
                "words, and another one listens. If two speak, name them in the transcript.",
                name=path.name,
            )
        )
        return ((voices[0], one),)
    if one.segments is not None or not one.words:
        first = _best(voices, [one])[0]
    else:
        sides = _keep_lines_whole(one.words, _louder(voices, one.words))
        shares = [float(np.mean([s == n for s in sides])) for n in range(len(voices))]
        if max(shares) < 0.9:
            notes.append(
                phrase(
                    "{name} does not name two speakers, so each word goes to the side whose "
                    "channel is louder at that moment.",
                    name=path.name,
                )
            )
            if one.name:
                notes.append(
                    phrase(
                        "The name '{speaker}' of {name} is not used, because others speak without a name.",
                        speaker=one.name[:40],
                        name=path.name,
                    )
                )
            return tuple(
                (
                    v,
                    TranscribedSide(
                        words=tuple(w for w, s in zip(one.words, sides, strict=True) if s == n), path=path
                    ),
                )
                for n, v in enumerate(voices)
            )
        first = shares.index(max(shares))
    rest = phrase("the other side has none, so its loudness shows when it speaks")
    if len(voices) > 2:
        rest = phrase("the others have none, so their loudness shows when they speak")
    notes.append(
        phrase(
            "{name} has the words of one speaker only, {called}; {rest}.",
            name=path.name,
            called=voices[first].called,
            rest=rest,
        )
    )
    return tuple((v, one if n == first else TranscribedSide()) for n, v in enumerate(voices))


def _louder(voices: Sequence[SideVoice], words: Sequence[Word]) -> list[int]:
    """Return the side of each word; words said without a pause between them belong together."""
    levels = [[_level(v, w.start, w.end) for v in voices] for w in words]
    top = [row.index(max(row)) for row in levels]
    out: list[int] = []
    first = 0
    for n in range(1, len(words) + 1):
        if n < len(words) and words[n].start - words[n - 1].end < 0.15 and top[n] == top[n - 1]:
            continue
        out += [int(np.argmax(np.mean(levels[first:n], axis=0)))] * (n - first)
        first = n
    return out


def _loudness(voices: Sequence[SideVoice], words: Sequence[Word], n: int) -> float:
    """Return how loud a voice is on average while words are said, dB under its loudest; 0 without words."""
    return float(np.mean([_level(voices[n], w.start, w.end) for w in words])) if words else 0.0


def _level(voice: SideVoice, start: float, end: float) -> float:
    heard = voice.heard
    part = heard.level[
        int(np.searchsorted(heard.times, start)) : int(np.searchsorted(heard.times, end, "right"))
    ]
    return max(float(part.mean()) - voice.top, -60.0) if len(part) else -60.0


def cut_words_to_sound(notes: list[str], called: str, said: TranscribedSide, length: float) -> list[Word]:
    """Return the words as far as the sound goes, seconds. Raises FileError if it has gone before
    the first.
    """
    words = said.words
    out = [
        w if w.end <= length else msgspec.structs.replace(w, end=round(length, 4))
        for w in words
        if w.start < length - SHORTEST / 2
    ]
    gone = len(words) - len(out)
    cut = sum(w.end > length + 0.05 for w in words[: len(out)])
    if gone and not out and said.path is not None:
        cause = phrase(
            "all of its {count} are past the end of the sound, which lasts {length:.1f} s",
            count=count(gone, "word"),
            length=length,
        )
        raise FileError(said.path, cause, said.name, phrase("Choose the transcript of this sound."))
    if gone or cut:
        parts = [phrase("{count} skipped", count=count(gone, "word"))] if gone else []
        parts += [phrase("{count} cut", count=count(cut, "word"))] if cut else []
        does = join_as_list(parts)
        notes.append(
            phrase(
                "{called}: {does}, past the end of the sound at {length:.1f} s. Check that "
                "the transcript belongs to this sound.",
                called=called,
                does=does,
                length=length,
            )
        )
    return out


def tell_unheard(notes: list[str], called: str, words: Sequence[Word], voice: SideVoice) -> None:
    """Report words if nothing is to be heard: the transcript of another recording, or shifted."""
    spoken = find_activity(voice.heard, None, None)
    heard = sum(any(s.start - 0.2 < (w.start + w.end) / 2 < s.end + 0.2 for s in spoken) for w in words)
    if len(words) >= 5 and heard < 0.5 * len(words):
        notes.append(
            phrase(
                "{called}: {count} of {count2} are where nothing is heard. Check that "
                "transcript and sound belong together and begin at the same moment.",
                called=called,
                count=len(words) - heard,
                count2=count(len(words), "word"),
            )
        )
