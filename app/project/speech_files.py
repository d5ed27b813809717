"""Find which files are a conversation: sounds and transcripts among dropped files, and files beside
a sound.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from app.translation import tr_plural
from metagraph.formats.transcripts.registry import TRANSCRIPT_SUFFIXES
from metagraph.graph.conversation.model import MOST_SPEAKERS

SOUNDS = (".wav", ".flac", ".ogg", ".mp3")
# Three sounds or more belong to one conversation if they differ in length by at most this many seconds, and
# are longer than lines of dialogue, which may have equal lengths by chance.
UNLIKE, LONG = 0.5, 10.0
TRANSCRIPTS = tuple(
    suffix.lower() for suffix in TRANSCRIPT_SUFFIXES
)  # of several beside a sound, the first counts


def sort_speech_files(paths: Sequence[Path]) -> tuple[tuple[Path, ...], tuple[Path, ...]]:
    """Return the sounds and the transcripts among files, in order of their names."""
    ordered = sorted(paths, key=lambda p: p.name.casefold())
    return tuple(p for p in ordered if p.suffix.lower() in SOUNDS), tuple(
        p for p in ordered if p.suffix.lower() in TRANSCRIPTS
    )


def is_conversation(paths: Sequence[Path]) -> bool:
    """Return whether files dropped on the window are a conversation: two sounds, or more that are long and of
    equal length, a sound and its words, or a sound with a channel for each speaker. A single sound with one
    channel is a line of dialogue, and so is each of many.
    """
    sounds, transcripts = sort_speech_files(paths)
    if not sounds or len(sounds) > MOST_SPEAKERS or len(sounds) + len(transcripts) < len(paths):
        return False
    if len(sounds) > 2:
        lasts = [read_sound_seconds(p) for p in sounds]
        return max(lasts) - min(lasts) <= UNLIKE and min(lasts) >= LONG
    return len(sounds) == 2 or bool(transcripts) or 2 <= count_channels(sounds[0]) <= MOST_SPEAKERS


def count_channels(path: Path) -> int:
    """Return how many channels a sound file has, from its header; 0 if that cannot be read."""
    import soundfile

    try:
        return int(soundfile.info(str(path)).channels)
    except (soundfile.LibsndfileError, RuntimeError, OSError):
        return 0


def read_sound_seconds(path: Path) -> float:
    """Return the length of a sound file in seconds, from its header; 0 if that cannot be read."""
    import soundfile

    try:
        return float(soundfile.info(str(path)).duration)
    except (soundfile.LibsndfileError, RuntimeError, OSError):
        return 0.0


def describe_sound_file(path: Path) -> str:
    """Return a sound file's name with its channels and length, from its header; only the name if that cannot
    be read.
    """
    import soundfile

    try:
        info = soundfile.info(str(path))
    except (soundfile.LibsndfileError, RuntimeError, OSError):
        return path.name
    minutes, seconds = divmod(round(info.duration), 60)
    channels = tr_plural("{count:,} channel", "{count:,} channels", info.channels)
    return f"{path.name} ({channels}, {minutes}:{seconds:02d})"


def find_transcripts_beside(sounds: Sequence[Path]) -> tuple[Path, ...]:
    """Return the transcripts beside sounds with the same names, at most one for each sound."""
    out = []
    for sound in sounds:
        try:
            names = {p.name.casefold(): p for p in sound.parent.iterdir()}
        except OSError:
            continue
        found = next((names[n] for end in TRANSCRIPTS if (n := (sound.stem + end).casefold()) in names), None)
        if found is not None:
            out.append(found)
    return tuple(out)
