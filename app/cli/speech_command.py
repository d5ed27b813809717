"""`metagraph speech`: what two or more say to each other, read from sound and words into clauses, responses
and hesitations.
"""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from contextlib import nullcontext
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.cli.outputs import ProjectOutput

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.formats.conversations.files import Read
    from metagraph.graph.conversation.model import Conversation, Side
    from metagraph.graph.model import Project
    from metagraph.speech.duet import DuetPart

OUT = (".eaf", ".TextGrid", ".vtt", ".srt", ".tsv", ".json")  # `CONVERSATION_OUTPUTS`, imported when written


def add_arguments(parser: ArgumentParser) -> None:
    """Add the command's options."""
    from app.cli.language_options import add_language_arguments

    parser.add_argument(
        "audio",
        type=Path,
        nargs="+",
        help="a sound with one channel per speaker, or one file per speaker",
    )
    parser.add_argument(
        "--words",
        type=Path,
        action="append",
        nargs="+",
        default=[],
        metavar="FILE",
        help="transcripts with times: TextGrid, ELAN, subtitles, JSON of a speech service and others; one "
        "for all, or one per speaker (default: use loudness)",
    )
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        help="write words, segments and peaks (.eaf, .TextGrid, .json), captions (.vtt, .srt), or the mouth "
        "shapes of one speaker as Rhubarb writes them (.tsv)",
    )
    add_language_arguments(parser, "the project's language, else auto")
    parser.add_argument(
        "--speakers",
        metavar="NAMES",
        help="the speakers who take part, in order: 'Ann,Cleo', or numbers (default: all)",
    )
    parser.add_argument("--project", type=Path, help="save the conversation in this project")
    parser.add_argument("--name", help="name of the conversation (default: the sound's name)")


def run(options: Namespace) -> int:
    """Read a conversation and print what is in it; write it to `out`, and save it in `project`, if given."""
    words = [path for some in options.words for path in some]
    out: Path | None = options.out
    if out is not None and out.suffix.casefold() not in [s.casefold() for s in OUT]:
        raise ValueError(f"the file can be {', '.join(OUT)}, not '{out.suffix or out.name}'")
    with ProjectOutput(options.project) if options.project is not None else nullcontext() as output:
        return _read(options, words, out, output)


def _read(options: Namespace, words: list[Path], out: Path | None, output: ProjectOutput | None) -> int:
    """output: where the conversation is kept, if it is."""
    from app.cli.command_output import open_for_command, say
    from app.cli.language_options import read_speaking
    from metagraph.formats.conversations.files import read_conversation
    from metagraph.speech.gaze_shares import join_shares

    folder = options.project.resolve().parent if options.project is not None else None
    project = open_for_command(options.project) if options.project is not None else None
    speaking = read_speaking(options, project.language) if project is not None else read_speaking(options)
    read = read_conversation(options.audio, words, folder, options.name, speaking=speaking)
    if options.speakers is not None:
        read = replace(read, conversation=_with_speakers(read.conversation, options.speakers))
    ident = _keep(output, project, read) if output is not None and project is not None else None
    if out is not None:
        _write(out, read, folder)
    for note in read.notes:
        print(f"note: {note}", file=sys.stderr)
    rows = [_row(n, side) for n, side in enumerate(read.conversation.sides)]
    lines = [f"{read.conversation.name}: {read.conversation.length:.1f} s"]
    for row in rows:
        language = f", {row['language']}" if row["language"] else ""
        lines.append(f"  {row['name']}: {row['words']} words{language}")
        for kind in ("clause", "response", "hesitation"):
            found = row[kind]
            more = (
                f", {found['words']:.2f} +- {found['spread']:.2f} words each"
                if kind == "clause" and found["words"]
                else ""
            )
            lines.append(
                f"    {found['count']:4} {kind}{'s' if found['count'] != 1 else ' '} {found['seconds']:7.1f} "
                f"s{more}"
            )
    parts: tuple[DuetPart, ...] = ()
    if ident is not None:
        parts = _performed(options.project, ident)
        for row, part in zip(rows, parts, strict=True):
            lines += [f"  {row['name']}: {t.words()}" for t in part.told if t.count]
            lines += [f"  {row['name']}: {share.words()}" for share in part.looks]
        shares = join_shares([share for part in parts for share in part.looks])
        lines += [f"  all speakers: {share.words()}" for share in shares]
        name = open_for_command(options.project).conversations[ident].name
        lines.append(f"saved in {options.project} as '{name}' ({ident})")
        if name != read.conversation.name:
            lines.append(f"  there is a '{read.conversation.name}' already, which is unchanged")
    if out is not None:
        lines.append(f"written to {out}")
    data = {
        "name": read.conversation.name,
        "length": read.conversation.length,
        "sides": rows,
        "notes": list(read.notes),
        "kept": ident,
        "delivered": [[asdict(t) for t in part.told] for part in parts],
        "looks": [[asdict(share) for share in part.looks] for part in parts],
        "written": str(out) if out is not None else None,
    }
    say(options, "\n".join(lines), data)
    return 0


def _row(n: int, side: Side) -> dict[str, Any]:
    from bisect import bisect_left
    from statistics import fmean, pstdev

    middles = [(w.start + w.end) / 2 for w in side.words]
    out: dict[str, Any] = {
        "name": side.name or f"speaker {n + 1}",
        "audio": side.audio,
        "channel": side.channel,
        "words": len(side.words),
        "language": side.language or None,
    }
    for kind in ("clause", "response", "hesitation"):
        some = [s for s in side.segments if s.kind == kind]
        sizes = [  # a text without blanks has as many words as were transcribed
            max(len(s.text.split()), bisect_left(middles, s.end) - bisect_left(middles, s.start))
            for s in some
            if s.text
        ]
        out[kind] = {
            "count": len(some),
            "seconds": round(sum(s.end - s.start for s in some), 3),
            "words": round(fmean(sizes), 3) if sizes else None,
            "spread": round(pstdev(sizes), 3) if sizes else None,
        }
    return out


def _keep(output: ProjectOutput, project: Project, read: Read) -> str:
    from metagraph.speech.automatic_cuts import keep_filmed_conversation

    project, ident = keep_filmed_conversation(project, read.conversation)
    output.save(project)
    return ident


def _with_speakers(conversation: Conversation, chosen: str) -> Conversation:
    """Return a conversation with only the given speakers (names, or numbers from 1), in that order. Raises
    ValueError.
    """
    from metagraph.graph.conversation.model import get_side_name, with_sides

    names = [get_side_name(conversation, n) for n in range(len(conversation.sides))]
    known = {name.casefold(): n for n, name in reversed(list(enumerate(names)))}
    known |= {str(n + 1): n for n in range(len(names)) if str(n + 1) not in known}
    asked = [name.strip() for name in chosen.split(",") if name.strip()]
    for name in asked:
        if name.casefold() not in known:
            there = ", ".join(f"'{x}'" for x in names)
            raise ValueError(f"there is no speaker '{name}'; the speakers are {there}, or numbers from 1")
    return with_sides(conversation, [known[name.casefold()] for name in asked])


def _performed(path: Path, ident: str) -> tuple[DuetPart, ...]:
    """Return what all sides do, with the project's graph moving all of them."""
    from app.cli.command_output import open_for_command
    from metagraph.speech.duet import plan_duet

    project = open_for_command(path)
    conversation = project.conversations[ident]
    count = len(conversation.sides)
    return plan_duet(conversation, ident, (project,) * count, (None,) * count).parts


def _write(out: Path, read: Read, folder: Path | None) -> None:
    import msgspec

    from metagraph.common.xml_text import describe_replaced
    from metagraph.formats.conversations.output_kinds import find_conversation_output, write_conversation

    write_conversation(read.conversation, out, folder)
    kind = find_conversation_output(out)
    lost = describe_replaced([msgspec.to_builtins(read.conversation)])
    if kind is not None and kind.xml and lost is not None:
        print(f"note: {lost}", file=sys.stderr)
