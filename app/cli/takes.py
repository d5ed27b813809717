"""Read long takes, and what was said during them, from the options of commands."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.graph.conversation.model import Conversation, Segment, Word
    from metagraph.motion.clip import Clip
    from metagraph.synthesis.prosody_costs import SpokenTake

_SAVED = "Save the conversation's segments from the window, as ELAN or TextGrid."
LONGEST = 7200.0  # seconds of a sound
KEPT = 16000  # samples a second that are kept of one
SPEECH = (".eaf", ".textgrid", ".json")  # what was said during a take


def add_speech_arguments(parser: ArgumentParser, required: bool) -> None:
    """Add the options of the speech during takes, and of the speaker."""
    parser.add_argument(
        "--speech",
        type=Path,
        nargs="+",
        required=required,
        default=[],
        metavar="FILE",
        help="what was said in each take: .eaf, .TextGrid or a conversation's .json, with the take's name; "
        "or a folder of them",
    )
    parser.add_argument(
        "--side",
        default="1",
        help="the speaker whose motion the takes are: a number in the order of the files, or a name "
        "(default: 1)",
    )


def read_take_files(paths: Sequence[Path]) -> list[tuple[str, Clip]]:
    """Return takes by the names of their files, or by their own names if a file has several."""
    from app.cli.command_output import open_for_command
    from metagraph.errors import FileError
    from metagraph.formats.clips import read_clips
    from metagraph.formats.imports import gather

    out: list[tuple[str, Clip]] = []
    for path in paths:
        if not path.exists():
            raise FileError(
                path,
                "there is no such file or folder",
                "while reading takes",
                "Give clip files, folders of them, or projects.",
            )
        if path.suffix in (".yaml", ".yml"):
            out += [
                (Path(c.name).stem, c.motion)
                for c in open_for_command(path).clips.values()
                if c.motion is not None
            ]
            continue
        for file in gather([path]):
            clips = read_clips(file)
            out += [(file.stem if len(clips) == 1 else c.name, c) for c in clips]
    if not out:
        raise FileError(
            paths[0],
            "has no clips",
            "while reading takes",
            "Give clip files, folders of them, or projects.",
        )
    twice = next((n for n, _ in out if sum(n == m for m, _ in out) > 1), None)
    if twice is not None:
        raise ValueError(f"two takes are called '{twice}': rename one")
    return out


def read_side(path: Path, side: str) -> tuple[Conversation, int]:
    """Return the conversation in a file, and which of them is meant. side: a number from 1, or a name.
    Raises FileError.
    """
    import msgspec

    from metagraph.errors import FileError
    from metagraph.formats.transcripts.reader import read_transcript
    from metagraph.graph.conversation.model import MOST_SPEAKERS, Conversation, Side

    made = None
    if path.suffix.lower() == ".json" and path.is_file():
        try:
            made = msgspec.json.decode(path.read_bytes(), type=Conversation)  # as it stands in a project
        except msgspec.DecodeError:
            made = None
    if made is None:
        told = read_transcript(path)
        if not any(told.segments.values()):
            raise FileError(path, "has no clauses, responses or hesitations", "", _SAVED)
        names = [
            n
            for n in dict.fromkeys((*told.speakers, *told.segments))
            if told.segments.get(n) or told.speakers.get(n)
        ][:MOST_SPEAKERS]
        sides = [
            Side(name=n, segments=tuple(told.segments.get(n, ())), words=tuple(told.speakers.get(n, ())))
            for n in names
        ]
        length = max(s.end for one in sides for s in one.segments)
        made = Conversation(
            name=path.stem[:200], length=length, sides=(*sides, *(Side() for _ in range(2 - len(sides))))
        )
    names = [s.name for s in made.sides]
    numbers = [str(n + 1) for n in range(len(names))]
    if side not in (*numbers, *names):
        raise FileError(
            path,
            f"has no speaker '{side}'",
            "its speakers",
            f"They are {', '.join(f'{n!r}' for n in names)}; or give a number from 1 to {len(names)}.",
        )
    return made, names.index(side) if side in names else int(side) - 1


def read_side_speech(
    path: Path, side: str, sound: Path | None = None, transcript: Path | None = None
) -> SpokenTake:
    """Return the segments that one speaker of a file moves with (`list_segments_heard_by`) with its words,
    and how they are said. sound: of the recording, None if there is none; where it has a channel for each of
    them, of its own. transcript: where its words are, None if they are in the file itself. Raises FileError.
    """
    from metagraph.graph.conversation.model import list_segments_heard_by
    from metagraph.speech.prosody import measure_prosody
    from metagraph.speech.sound import read_head, read_sound
    from metagraph.synthesis.prosody_costs import SpokenTake

    made, number = read_side(path, side)
    of, segments = made.sides[number], list_segments_heard_by(made, number)
    words = of.words if transcript is None else _words_of(transcript, of.name, number)
    samples, rate = None, 0
    if sound is not None:
        channel = of.channel if of.channel is not None else number if read_head(sound)[1] >= 2 else None
        samples, rate = read_sound(sound, channel, LONGEST, KEPT)
    return SpokenTake(segments, words, measure_prosody(segments, words, samples, rate))


def _words_of(path: Path, name: str, number: int) -> tuple[Word, ...]:
    """Return the words of one speaker in a transcript, found by name, else by number; or those of the only
    speaker. Raises FileError.
    """
    from metagraph.errors import FileError
    from metagraph.formats.transcripts.reader import read_transcript

    speakers = read_transcript(path).speakers
    if len(speakers) == 1 or name in speakers:
        return speakers[name] if name in speakers else next(iter(speakers.values()))
    if number < len(speakers):
        return list(speakers.values())[number]
    raise FileError(path, "has no words", "", "Give a transcript with words and their times.")


def match_takes(options: Namespace) -> tuple[list[Clip], list[SpokenTake], list[str]]:
    """Return takes, the speech of each, and their names. Raises ValueError if files do not go together."""
    takes = read_take_files(options.takes)
    given = _find_speech(options.speech, {name for name, _ in takes})
    files = {path.stem: path for path in given}
    if len(files) < len(given):
        raise ValueError("two speech files have the same name: rename one")
    missing = [n for n, _ in takes if n not in files]
    left = [p.name for n, p in files.items() if n not in {name for name, _ in takes}]
    if missing or left:
        words = [f"no speech for {', '.join(missing[:5])}"] if missing else []
        words += [f"no take for {', '.join(left[:5])}"] if left else []
        raise ValueError(
            f"{' and '.join(words)}: give a speech file the name of its take, as in take1.bvh and take1.eaf"
        )
    sounds, transcripts = read_given_files(options, "sounds"), read_given_files(options, "transcripts")
    for some, what, ending in ((sounds, "sound", "wav"), (transcripts, "transcript", "srt")):
        if some and (without := [n for n, _ in takes if n not in some]):
            raise ValueError(
                f"no {what} for {', '.join(without[:5])}: give it the name of its take, as in take1.bvh and "
                f"take1.{ending}"
            )
    return (
        [c for _, c in takes],
        [read_side_speech(files[n], options.side, sounds.get(n), transcripts.get(n)) for n, _ in takes],
        [n for n, _ in takes],
    )


def _find_speech(paths: Sequence[Path], takes: set[str]) -> list[Path]:
    """Return files of speech: those given, and of folders those that have a take's name."""
    out = []
    for path in paths:
        if path.is_dir():
            inside = (p for p in sorted(path.iterdir()) if p.suffix.lower() in SPEECH and p.is_file())
            out += [p for p in inside if p.stem in takes]
        else:
            out.append(path)
    return out


def read_given_files(options: Namespace, what: str) -> dict[str, Path]:
    """Return the sounds or transcripts that were given, under the names of their files; none if there is no
    such option. Raises ValueError if two have one name.
    """
    given = getattr(options, what, [])
    out = {path.stem: path for path in given}
    if len(out) < len(given):
        raise ValueError(f"two {what} have the same name: rename one")
    return out


def match_speech(options: Namespace) -> tuple[list[Clip], list[tuple[Segment, ...]]]:
    """Return takes, and what was heard during each. Raises ValueError if files do not go together."""
    clips, spoken, _ = match_takes(options)
    return clips, [one.segments for one in spoken]
