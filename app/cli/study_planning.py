"""`metagraph study plan`: how many people, what is registered beforehand, and the secret that orders are
drawn from.
"""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

Action = Callable[[str, str, Callable[[Namespace], int]], ArgumentParser]
SMALLEST = 1.25


def add_arguments(action: Action) -> None:
    """Add the action."""
    made = action(
        "plan", "compute how many people a study needs; write its preregistration", print_study_plan
    )
    made.add_argument("study", type=Path, nargs="?", help="the study's folder, or its study.yaml")
    made.add_argument("--pilot", type=Path, metavar="FOLDER", help="a pilot study whose ratios are used")
    made.add_argument(
        "--ratio", type=float, help="assumed ratio: how many times longer the work takes by hand"
    )
    made.add_argument("--spread", type=float, help="assumed standard deviation of people's log ratios")
    made.add_argument(
        "--smallest",
        type=float,
        help=f"the smallest ratio that matters (default: the study's, else {SMALLEST})",
    )
    made.add_argument(
        "--within", type=float, default=1.25, help="the widest interval, as a factor (default: 1.25)"
    )
    made.add_argument(
        "--chance", type=float, default=0.8, help="power: the chance to reach each aim (default: 0.8)"
    )
    made.add_argument(
        "--tests",
        type=int,
        help="tests that share the level of 0.05 (default: time, F1 and the study's questionnaires)",
    )
    made.add_argument(
        "--dropouts", type=float, default=0.0, help="share of people who will not finish (default: 0)"
    )
    made.add_argument(
        "--studies",
        type=int,
        default=0,
        help="also simulate so many studies for each number of people, and print how many find the ratio",
    )
    made.add_argument(
        "--people",
        type=int,
        nargs="+",
        metavar="N",
        help="numbers of people to simulate (default: some from 8 to 40)",
    )
    made.add_argument("--allocate", action="store_true", help="make the secret for a concealed order")
    made.add_argument("--preregister", action="store_true", help="write the forms of OSF and AsPredicted")
    made.add_argument("--force", action="store_true", help="write the forms again")


def print_study_plan(options: Namespace) -> int:
    from math import ceil

    from app.cli.command_output import say
    from metagraph.research.study.plan.allocation import prepare_allocation
    from metagraph.research.study.plan.planning import assume_without_pilot, sample_size
    from metagraph.research.study.plan.preregistration import Aims, preregister
    from metagraph.research.study.study_plan import read_study

    study = read_study(options.study) if options.study is not None else None
    if study is None and (options.allocate or options.preregister):
        raise ValueError("give the study to preregister or allocate")
    if (options.pilot is None) == (options.ratio is None or options.spread is None):
        raise ValueError("give a --pilot, or assume both --ratio and --spread")
    if not 0 <= options.dropouts < 1:
        raise ValueError(f"--dropouts must be 0 or more and less than 1, not {options.dropouts:g}")
    found = (
        _pilot(options.pilot)
        if options.pilot is not None
        else assume_without_pilot(options.ratio, options.spread)
    )
    smallest = options.smallest or (study.plan.smallest if study is not None else None) or SMALLEST
    tests = options.tests or (2 + len(study.plan.questions()) if study is not None else 1)
    needed = sample_size(found, smallest, options.within, options.chance, families=tests)
    aims = Aims(found, needed, smallest, options.within, options.chance, families=tests)
    data = {"assumed": asdict(found), "needed": asdict(needed), "smallest": smallest, "tests": tests}
    lines = [
        f"ratio {found.ratio:.2f}, deviation of log ratios {found.spread:.2f}, planned with "
        f"{found.worst:.2f} "
        f"({found.source})",
        f"people needed, for a power of {options.chance:.0%}"
        + (f", {tests} tests" if tests > 1 else "")
        + ":",
    ]
    for what, count in (
        (f"to show a ratio of {found.ratio:.2f}", needed.show),
        (f"to show the smallest ratio that matters, {smallest:g}", needed.smallest),
        (f"for an interval no wider than a factor of {options.within:g} either way", needed.precise),
        (f"to show equivalence: a ratio within a factor of {smallest:g} of 1", needed.equivalent),
    ):
        more = f", {ceil(count / (1 - options.dropouts))} with dropouts" if count and options.dropouts else ""
        lines.append(f"  {what}: {count if count is not None else 'more than 10,000'}{more}")
    lines.append(
        "Two conditions are balanced with any even number of people. Give each order the same number."
    )
    if options.studies:
        lines += _simulate(options, found.ratio, found.worst, 0.05 / tests, data)
    if study is not None and options.allocate:
        data["commitment"] = prepare_allocation(study)
        lines.append(f"SHA-256 of the allocation's secret: {data['commitment']}")
        if study.plan.order != "concealed":
            lines.append("The study file does not say 'order: concealed' yet.")
    if study is not None and options.preregister:
        secret = prepare_allocation(study) if study.plan.order == "concealed" else None
        written = preregister(study, aims, secret, options.force)
        data["written"] = [str(p) for p in written]
        lines += [str(p) for p in written]
    say(options, "\n".join(lines), data)
    return 0


def _simulate(options: Namespace, ratio: float, spread: float, alpha: float, data) -> list[str]:
    """Return the table of simulated studies, which is added to the data, too."""
    from app.cli.progress_line import ProgressLine
    from metagraph.research.study.plan.simulated_power import PEOPLE, simulate_study_power
    from metagraph.research.study.simulation.people import Truth

    counts = tuple(options.people or PEOPLE)
    line, rows = ProgressLine(options, "Simulating studies"), []
    truth = Truth(ratio=ratio, spread=spread)
    for n, one in enumerate(simulate_study_power(truth, counts, options.studies, alpha), 1):
        line.tell(n, len(counts))
        rows.append(one)
    line.finish()
    data["simulated"] = [asdict(one) for one in rows]
    return [
        f"{options.studies} simulated studies for each number of people:",
        "| people | find the ratio | interval, factor | intervals hold it | find one where there is none |",
        "|---|---|---|---|---|",
        *(
            f"| {r.people} | {r.found.value:.0%} | {r.factor:.2f} | {r.held.value:.1%} | "
            f"{r.false.value:.1%} |"
            for r in rows
        ),
    ]


def _pilot(folder: Path):
    from metagraph.research.study.analysis.reading import collect_study
    from metagraph.research.study.analysis.results import analyse_study
    from metagraph.research.study.plan.planning import from_pilot

    time = analyse_study(collect_study(folder, jumps=False)).time
    people = time.people if time is not None else ()
    return from_pilot([p.ratio for p in people], f"the pilot '{folder.name}'")
