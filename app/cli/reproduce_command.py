"""`metagraph reproduce`: make the papers' tables and figures again, next to the published ones."""

from __future__ import annotations

import json
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.progress_line import ProgressLine, describe_seconds

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.research.exhibits.exhibit import Exhibit, MadeExhibit
    from metagraph.research.exhibits.material import ExhibitMaterial


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "exhibits",
        nargs="*",
        metavar="EXHIBIT",
        help="tables and figures by name, or papers for all of theirs (default: all; --list shows the names)",
    )
    parser.add_argument("--into", type=Path, metavar="FOLDER", help="write report.html and report.json there")
    parser.add_argument(
        "--list", action="store_true", help="list the tables and figures, and how long each takes"
    )
    parser.add_argument(
        "--project", type=Path, metavar="FILE", help="your project (default: the sample project)"
    )
    parser.add_argument(
        "--takes",
        type=Path,
        metavar="FOLDER",
        help="your recorded conversations: clips with their sounds and transcripts in one folder "
        "(default: synthetic ones)",
    )
    parser.add_argument(
        "--model",
        type=Path,
        metavar="FILE",
        help="a learned model (.mgmodel; default: the one that comes with Metagraph)",
    )
    parser.add_argument(
        "--full",
        action="store_true",
        help="use as much synthetic motion as the papers recorded, and more bootstrap draws",
    )


def run(options: Namespace) -> int:
    """Make exhibits; write the report and print the tables."""
    from app.cli.command_output import say
    from metagraph import __version__
    from metagraph.formats.atomic import write_together
    from metagraph.formats.outputs import claim
    from metagraph.research.exhibits.exhibit import choose_exhibits
    from metagraph.research.exhibits.page import encode_exhibits, exhibit_as_text, format_exhibits

    exhibits = choose_exhibits(options.exhibits)
    if options.list:
        return _list(options, exhibits)
    if options.into is None:
        raise ValueError("give a folder for the report with --into FOLDER, or use --list")
    claim(options.into / "report.html", options.into / "report.json")
    material = _material(options)
    told = {"Metagraph": __version__, "project": material.project.name}
    told["conversations"] = material.told or "synthetic"
    made: list[tuple[Exhibit, MadeExhibit, float]] = []
    written: list[str] = []
    for exhibit in exhibits:
        if sys.stderr.isatty() and not options.json:
            far = _estimate(exhibits, made, options.full)
            print(f"{exhibit.name}: {far} ...", file=sys.stderr, flush=True)
        shown, seconds = _made(exhibit, material)
        made.append((exhibit, shown, seconds))
        encoded = encode_exhibits(made)
        data = json.dumps({**told, "exhibits": encoded, "notes": material.notes}, indent=1) + "\n"
        page = format_exhibits(made, told)
        content = {"report.html": page.encode(), "report.json": data.encode()}
        written = [str(path) for path in write_together(options.into, content)]  # who stops it keeps these
        if not options.json:
            print(f"{exhibit_as_text(exhibit, shown)}\n", flush=True)
    for note in dict.fromkeys(material.notes):
        print(f"note: {note}", file=sys.stderr)
    say(options, "\n".join(written), {"exhibits": encode_exhibits(made), "written": written})
    return 3 if any(s.missing for _, s, _ in made) else 0


def _estimate(
    exhibits: Sequence[Exhibit], made: Sequence[tuple[Exhibit, MadeExhibit, float]], full: bool
) -> str:
    """Return how far it is, and how long the rest will take if it takes longer as what was made did."""
    usual = [e.seconds[full] for e in exhibits]
    slower = sum(seconds for *_, seconds in made) / sum(usual[: len(made)]) if made else 1.0
    left = describe_seconds(slower * sum(usual[len(made) :]))
    return f"{len(made) + 1} of {len(exhibits)}, about {left} left"


def _list(options: Namespace, exhibits: Sequence[Exhibit]) -> int:
    from app.cli.command_output import say
    from metagraph.research.exhibits.published import PAPERS

    lines, before = [], ""
    for e in exhibits:
        if e.paper != before:
            lines.append(f"{e.paper}: {PAPERS[e.paper]}")
            before = e.paper
        quick, whole = (f"{s:g} s" if s < 90 else f"{s / 60:.0f} min" for s in e.seconds)
        lines.append(f"  {e.name:<12}{e.place:<18}{e.title:<50}{quick:>6}, --full {whole}")
    data = [
        {"exhibit": e.name, "paper": e.paper, "place": e.place, "title": e.title, "seconds": list(e.seconds)}
        for e in exhibits
    ]
    say(options, "\n".join(lines), data)
    return 0


def _made(exhibit: Exhibit, material: ExhibitMaterial) -> tuple[MadeExhibit, float]:
    """Return an exhibit and the seconds it took. One that cannot be made has the reason instead."""
    from time import perf_counter

    from metagraph.errors import FileError
    from metagraph.research.exhibits.exhibit import MadeExhibit

    began = perf_counter()
    try:
        shown = exhibit.make(material)
    except Exception as error:
        about = material.told or f"the project '{material.project.name}'"
        known = isinstance(error, (FileError, ValueError)) and str(error)
        told = (
            str(error)
            if known
            else f"failed ({type(error).__name__}: {error}); report this together with the project"
        )
        shown = MadeExhibit(about, missing=told)
    return shown, perf_counter() - began


def _material(options: Namespace) -> ExhibitMaterial:
    from app.cli.command_output import open_for_command
    from app.cli.demo_command import SAMPLE
    from metagraph.errors import FileError
    from metagraph.formats.corpora import Recorded, read_corpus
    from metagraph.generation.offered import SHIPPED
    from metagraph.research.exhibits.material import ExhibitMaterial

    if options.model is not None and not options.model.is_file():
        raise FileError(options.model, "there is no such model", remedy="Check where the .mgmodel file is.")
    model = options.model or (SHIPPED if SHIPPED.is_file() else None)
    notes: list[str] = []
    given: tuple[Recorded, ...] = ()
    told = ""
    if options.takes is not None:
        line = ProgressLine(options, "Reading takes")
        corpus = read_corpus(options.takes, progress=lambda done, total: line.tell(done + 1, total))
        line.finish()
        notes += [*corpus.failures, *corpus.notes]
        given, told = corpus.recorded, f"{options.takes.name} ({corpus.layout})"
    project = open_for_command(SAMPLE if options.project is None else options.project)
    return ExhibitMaterial(project, given, told, model, options.full, notes)
