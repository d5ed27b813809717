"""`metagraph speech`: what two say to each other, read from sound and words into clauses, responses and
hesitations.
"""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.formats.conversations import Read
    from metagraph.graph.conversation import Side
    from metagraph.speech.delivered import Delivered

OUT = (".eaf", ".TextGrid", ".json")


def arguments(parser: ArgumentParser) -> None:
    """Add the command's options."""
    parser.add_argument(
        "audio",
        type=Path,
        nargs="+",
        help="a sound with one channel a speaker, or one file for each of the two",
    )
    parser.add_argument(
        "--words",
        type=Path,
        action="append",
        nargs="+",
        default=[],
        metavar="FILE",
        help="what is said: TextGrid, ELAN, WebVTT, SRT, JSON or CTM; one for both, or one for each "
        "(default: loudness tells)",
    )
    parser.add_argument("-o", "--out", type=Path, help=f"write words, segments and peaks ({', '.join(OUT)})")
    parser.add_argument("--project", type=Path, help="keep it in this project")
    parser.add_argument("--name", help="what the conversation is called (default: as the sound)")


def run(options: Namespace) -> int:
    """Read a conversation, tell what is in it; with `out` write it, with `project` keep it there."""
    from app.cli.command_output import say
    from metagraph.formats.conversations import read_conversation

    words = [path for some in options.words for path in some]
    if len(options.audio) > 2 or len(words) > 2:
        raise ValueError("a conversation of two has one or two sounds, and at most two files with words")
    out: Path | None = options.out
    if out is not None and out.suffix.casefold() not in [s.casefold() for s in OUT]:
        raise ValueError(f"it is written as {', '.join(OUT)}, not as '{out.suffix or out.name}'")
    folder = options.project.resolve().parent if options.project is not None else None
    read = read_conversation(options.audio, words, folder, options.name)
    ident = _keep(options.project, read) if options.project is not None else None
    if out is not None:
        _write(out, read, folder)
    for note in read.notes:
        print(f"note: {note}", file=sys.stderr)
    rows = [_row(n, side) for n, side in enumerate(read.conversation.sides)]
    lines = [f"{read.conversation.name}: {read.conversation.length:.1f} s"]
    for row in rows:
        lines.append(f"  {row['name']}: {row['words']} words")
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
    told: tuple[tuple[Delivered, ...], ...] = ()
    if ident is not None:
        told = _delivered(options.project, ident)
        for row, of in zip(rows, told, strict=True):
            lines += [f"  {row['name']}: {t.words()}" for t in of if t.count]
        lines.append(f"kept in {options.project} as {ident}")
    if out is not None:
        lines.append(f"written to {out}")
    data = {
        "name": read.conversation.name,
        "length": read.conversation.length,
        "sides": rows,
        "notes": list(read.notes),
        "kept": ident,
        "delivered": [[asdict(t) for t in of] for of in told],
        "written": str(out) if out is not None else None,
    }
    say(options, "\n".join(lines), data)
    return 0


def _row(n: int, side: Side) -> dict[str, Any]:
    from statistics import fmean, pstdev

    out: dict[str, Any] = {
        "name": side.name or f"speaker {n + 1}",
        "audio": side.audio,
        "channel": side.channel,
        "words": len(side.words),
    }
    for kind in ("clause", "response", "hesitation"):
        some = [s for s in side.segments if s.kind == kind]
        sizes = [len(s.text.split()) for s in some if s.text]
        out[kind] = {
            "count": len(some),
            "seconds": round(sum(s.end - s.start for s in some), 3),
            "words": round(fmean(sizes), 3) if sizes else None,
            "spread": round(pstdev(sizes), 3) if sizes else None,
        }
    return out


def _keep(path: Path, read: Read) -> str:
    from app.cli.command_output import opened
    from metagraph.formats.store import save_project
    from metagraph.graph.conversation_edits import add_conversation

    project, ident = add_conversation(opened(path), read.conversation)
    save_project(project, path, path)
    return ident


def _delivered(path: Path, ident: str) -> tuple[tuple[Delivered, ...], ...]:
    """Return what becomes of both sides' rates, where the project's graph moves both."""
    from app.cli.command_output import opened
    from metagraph.speech.delivered import delivered
    from metagraph.speech.drive import drive

    project = opened(path)
    conversation = project.conversations[ident]
    plans = [drive(conversation, side, project)[1] for side in (0, 1)]
    return tuple(delivered(conversation, side, project, plan) for side, plan in enumerate(plans))


def _write(out: Path, read: Read, folder: Path | None) -> None:
    from metagraph.formats.conversation_writers import write_elan, write_json, write_textgrid

    kind = out.suffix.casefold()
    if kind == ".eaf":
        write_elan(read.conversation, out, folder)
    elif kind == ".json":
        write_json(read.conversation, out)
    else:
        write_textgrid(read.conversation, out)
