"""`metagraph study agreement`: how far two annotators of one recording agree."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from metagraph.research.agreement import Agreement

Action = Callable[[str, str, Callable[[Namespace], int]], ArgumentParser]
SHOWN = 5  # confusions that are printed


def add_arguments(action: Action) -> None:
    """Add the action."""
    made = action(
        "agreement", "measure how far two annotators agree: Cohen's kappa by time and by annotation", compare
    )
    made.add_argument("one", type=Path, help="an .eaf file")
    made.add_argument(
        "other",
        type=Path,
        nargs="?",
        help="the second annotator's .eaf file (default: tiers of the same file)",
    )
    made.add_argument(
        "--tiers",
        action="append",
        default=[],
        metavar="A=B",
        help="compare these two tiers; repeat for more (default: tiers with one name in both files; in one "
        "file, tiers whose names differ only in who annotated, or behind @ or the last _)",
    )
    made.add_argument(
        "--tolerance",
        type=float,
        default=0.25,
        help="seconds that starts, and ends, of one annotation may lie apart (default: 0.25)",
    )


def compare(options: Namespace) -> int:
    """Print the agreement of each pair of tiers."""
    from app.cli.command_output import say
    from metagraph.formats.elan import read_elan
    from metagraph.research.agreement import list_unpaired, match_tiers, measure_agreement

    chosen = []
    for words in options.tiers:
        first, equals, second = words.partition("=")
        if not equals:
            raise ValueError(f"--tiers is A=B, not '{words}'")
        chosen.append((first, second))
    one = read_elan(options.one)
    other = read_elan(options.other) if options.other is not None else None
    pairs = match_tiers(one, other, chosen)
    found = [measure_agreement(a, b, options.tolerance) for a, b in pairs]
    left = [] if chosen else list_unpaired(one, other, pairs)
    if left:
        names = ", ".join(f"'{name}'" for name in left)
        print(f"note: not compared, since no other tier has that name: {names}", file=sys.stderr)
    rows = [
        {
            **asdict(x),
            "confusion": [{"one": a, "other": b, "seconds": s} for (a, b), s in x.confusion.items()],
        }
        for x in found
    ]
    say(
        options,
        "\n".join(line for x in found for line in _lines(x, options.tolerance)),
        {"tiers": rows, "unpaired": left},
    )
    return 0


def _lines(found: Agreement, tolerance: float) -> list[str]:
    kappa = "no kappa: chance alone gives this" if found.kappa is None else f"kappa {found.kappa:.2f}"
    out = [
        f"{found.tiers[0]} and {found.tiers[1]}: {kappa} by time; {found.same:.0%} of {found.seconds:.1f} s "
        "have the same label",
        f"  {found.matched} pairs within {tolerance:g} s, of {found.counts[0]} and {found.counts[1]} "
        "annotations",
    ]
    if found.matched:
        of = " (no kappa: chance alone gives this)"
        if found.labels_kappa is not None:
            of = f" (kappa {found.labels_kappa:.2f})"
        out[-1] += f"; {found.labels_same:.0%} with the same label{of}"
        out.append(f"  the second starts {found.starts:+.2f} s and ends {found.ends:+.2f} s later, medians")
    wrong = [(a, b, s) for (a, b), s in found.confusion.items() if a != b][:SHOWN]
    out += [f"  {s:7.1f} s: '{a or 'nothing'}' and '{b or 'nothing'}'" for a, b, s in wrong]
    return out
