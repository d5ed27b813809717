"""Folders of takes: clips, each with the sound beside it, and its words if there are any.

`talk.bvh` is said with `talk.wav`: its first channel is the take's own voice, the second the partner's. Two
clips of one conversation are `talk_1.bvh` and `talk_2.bvh` (also a and b, left and right), the sides of
`talk.wav`. A transcript has the sound's name.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import CONVERSATION_SECONDS as LONGEST
from metagraph.common.files import make_unforeseen_error
from metagraph.errors import FileError, describe_error
from metagraph.formats.clips import digest, find_clip_files, read_clips
from metagraph.formats.conversations.files import SOUNDS, read_conversation
from metagraph.formats.conversations.languages import Speaking
from metagraph.formats.transcripts.registry import TRANSCRIPT_SUFFIXES
from metagraph.generation.features import RATE, resample_for_features
from metagraph.generation.poses import PoseError, PoseRig, find_rig
from metagraph.generation.takes import Take, TakeError, TakeSound, TakeSource, make_take
from metagraph.graph.conversation.model import Conversation
from metagraph.motion.clip import Clip
from metagraph.speech.sound import read_recording

Array = NDArray[Any]

_SIDE = re.compile(r"(?i)[ ._-]*(1|2|a|b|left|right)$")
_LICENCE = re.compile(r"(?i)(licen[cs]e|copying)([ ._-].*)?")
UNLICENSED = "no licence found beside it"
_WORDS = {s.lower() for s in TRANSCRIPT_SUFFIXES}


@dataclass(frozen=True)
class TakeFiles:
    """A take's files. sounds: one, or own voice and partner's. side: whose channel, and segments, are its
    own.
    """

    clip: Path
    sounds: tuple[Path, ...]
    transcripts: tuple[Path, ...] = ()
    side: int = 0


@dataclass(frozen=True, eq=False)
class TakeSpeech:
    """What is heard with a take: samples `[C, N]` at RATE, own voice first; the share of each channel that
    was cut off at full scale; the conversation where its words are known; what there is to know, in words.
    """

    samples: Array
    clipped: tuple[float, ...]
    conversation: Conversation | None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class TakeBatch:
    """What came of reading many takes. clips: of each take, to make its twin. failures: in words, each naming
    its file; they spoil nothing else.
    """

    rig: PoseRig | None
    takes: tuple[Take, ...]
    clips: tuple[Clip, ...]
    failures: tuple[str, ...]
    notes: tuple[str, ...]


def find_takes(folders: Iterable[Path], speech: Sequence[Path] = ()) -> tuple[list[TakeFiles], list[str]]:
    """Return the takes below folders (or of single clips) by path, and clips without sound, in words. speech:
    sounds, or folders of them, that are looked through as well. Raises FileError.
    """
    found = list(folders)
    clips = [c for f in found for c in ([f] if f.is_file() else find_clip_files(f))]
    beside = [p for f in (*found, *speech) for p in _files(f.parent if f.is_file() else f)]
    named = {identify_file(p): p for p in beside if p.suffix.lower() in SOUNDS}
    words = {identify_file(p): p for p in beside if p.suffix.lower() in _WORDS}
    takes, without = [], []
    for clip in dict.fromkeys(clips):
        key, side = identify_file(clip), 0
        mark = _SIDE.search(clip.stem)
        if _match(named, key) is None and mark:
            key = (key[0], key[1][: -len(mark[0])])
            side = int(mark[1].casefold() in ("2", "b", "right"))
        sound = _match(named, key)
        if sound is None:
            without.append(
                f"{clip.name}: there is no sound beside it. Give one the same name ({clip.stem}.wav), or say "
                "where the speech is"
            )
            continue
        told = _match(words, identify_file(sound))
        takes.append(TakeFiles(clip, (sound,), (told,) if told else (), side))
    return takes, without


def identify_file(path: Path) -> tuple[str, str]:
    """Return what makes files belong together: their folder and their name."""
    return str(path.parent.resolve()), path.stem.casefold()


def _match(files: Mapping[tuple[str, str], Path], key: tuple[str, str]) -> Path | None:
    """Return the file of that name in the same folder, else the only one elsewhere."""
    if key in files:
        return files[key]
    others = [p for (_, stem), p in files.items() if stem == key[1]]
    return others[0] if len(others) == 1 else None


def _files(folder: Path) -> list[Path]:
    if not folder.is_dir():
        raise FileError(folder, "there is no such folder", remedy="Check where the takes are.")
    return sorted(p for p in folder.rglob("*") if p.is_file())


def read_take_batch(
    files: Iterable[TakeFiles],
    rig: PoseRig | None = None,
    roles: Mapping[str, int] | None = None,
    tracks: int = 1,
    progress: Callable[[int, Path], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    speaking: Speaking | None = None,
) -> TakeBatch:
    """Read takes; a bad one fails alone. rig: whose joints count; None: of the skeleton that most of them
    have. roles: of that skeleton, as found unless given. progress: called before each with how many are
    done. speaking: what their words are read in; None for what they tell. Raises CancelledError once
    `cancelled` says so.
    """
    failures: list[str] = []
    read: list[tuple[TakeFiles, Clip]] = []
    several: dict[Path, str] = {}
    for each in files:
        if cancelled is not None and cancelled():
            raise CancelledError
        try:
            there = read_clips(each.clip)
        except Exception as error:  # one bad file spoils no other
            failures.append(str(make_unforeseen_error(each.clip, error)))
            continue
        clip = max(there, key=lambda c: c.frames)
        read.append((each, clip))
        if len(there) > 1:
            several[each.clip] = (
                f"holds {len(there)} animations; the longest, '{clip.name}', {clip.duration:.1f} s, is "
                "taken: save each with its sound in a file of its own to learn from all"
            )
    if rig is None and read:
        counts = {c.skeleton: sum(o.skeleton == c.skeleton for _, o in read) for _, c in read}
        try:
            rig = find_rig(max(counts, key=lambda s: counts[s]), roles)
        except PoseError as error:
            return TakeBatch(None, (), (), (*failures, describe_error(error)), ())
    takes, clips, notes = [], [], []
    licences: dict[Path, str] = {}
    for done, (each, clip) in enumerate(read):
        if cancelled is not None and cancelled():
            raise CancelledError
        if progress is not None:
            progress(done, each.clip)
        assert rig is not None
        try:
            take = _take(rig, each, clip, tracks, licences, speaking)
        except TakeError as error:
            failures.append(describe_error(error))
            continue
        except Exception as error:
            failures.append(str(make_unforeseen_error(each.clip, error)))
            continue
        takes.append(take)
        clips.append(clip)
        told = (*([several[each.clip]] if each.clip in several else ()), *clip.notes)
        notes += [*(f"{each.clip.name}: {note}" for note in told), *take.notes]
    return TakeBatch(rig, tuple(takes), tuple(clips), tuple(failures), tuple(dict.fromkeys(notes)))


def _take(
    rig: PoseRig,
    files: TakeFiles,
    clip: Clip,
    tracks: int,
    licences: dict[Path, str],
    speaking: Speaking | None,
) -> Take:
    speech = read_speech(files, speaking)
    digests = tuple(digest(p) for p in (files.clip, *files.sounds))
    folder = files.clip.parent
    if folder not in licences:
        licences[folder] = read_licence(folder)
    source = TakeSource(files.clip.stem, digests, licences[folder])
    heard = TakeSound(speech.samples, RATE, speech.clipped)
    take = make_take(rig, clip, heard, source, speech.conversation, files.side, tracks)
    return replace(take, notes=(*speech.notes, *take.notes))


def read_speech(files: TakeFiles, speaking: Speaking | None = None) -> TakeSpeech:
    """Return what is heard with a take. speaking: what its words are read in; None for what they tell. Raises
    FileError.
    """
    stamps = tuple(p.stat().st_mtime_ns for p in (*files.sounds, *files.transcripts) if p.exists())
    speech = _speech(files.sounds, files.transcripts, stamps, speaking)
    if len(speech.samples) == 2 and files.side == 1:
        return replace(speech, samples=speech.samples[::-1], clipped=speech.clipped[::-1])
    return speech


@lru_cache(maxsize=1)  # both sides of a conversation are read one after the other
def _speech(
    sounds: tuple[Path, ...],
    transcripts: tuple[Path, ...],
    stamps: tuple[int, ...],
    speaking: Speaking | None,
) -> TakeSpeech:
    """stamps: when the files were written."""
    conversation: Conversation | None = None
    notes: tuple[str, ...] = ()
    if transcripts:
        read = read_conversation(sounds, transcripts, speaking=speaking, most=2)
        conversation, notes = read.conversation, read.notes
    recordings = [read_recording(p, LONGEST) for p in sounds]
    if len(recordings) > 1:
        voices = [resample_for_features(r.samples.mean(0)[None], r.rate)[0] for r in recordings[:2]]
        longest = max(map(len, voices))
        samples = np.stack([np.pad(v, (0, longest - len(v))) for v in voices])
        clipped = tuple(max(r.clipped) for r in recordings[:2])
    else:
        samples, clipped = (
            resample_for_features(recordings[0].samples, recordings[0].rate),
            recordings[0].clipped,
        )
    if len(samples) > 2:
        raise FileError(
            sounds[0],
            f"has {len(samples)} channels, a conversation of two has one for each",
            remedy="Save the two speakers' channels as one file.",
        )
    return TakeSpeech(samples, clipped, conversation, notes)


def read_licence(folder: Path) -> str:
    """Return the first line of the licence that lies in a folder, or in the nearest two above it."""
    for place in (folder, *folder.resolve().parents[:2]):
        for path in sorted(place.iterdir()) if place.is_dir() else ():
            if path.is_file() and _LICENCE.fullmatch(path.name):
                text = path.read_bytes()[:4000].decode("utf-8", "replace")
                line = next((line.strip() for line in text.splitlines() if line.strip()), "")
                if line:
                    return f"{path.name}: {line[:200]}"
    return UNLICENSED
