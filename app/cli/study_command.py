"""`metagraph study`: reports of timing studies, their data for other tools, the published example, and
simulated studies.
"""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.cli.perceive_command import add_arguments as perceive_arguments
from app.cli.progress_line import ProgressLine
from app.cli.study_agreement import add_arguments as agreement_arguments
from app.cli.study_people import add_arguments as people_arguments
from app.cli.study_pilot import add_pilot_arguments, run_pilot
from app.cli.study_planning import add_arguments as plan_arguments
from app.cli.study_replaying import add_arguments as replay_arguments
from app.cli.study_run import check_arguments, run_arguments
from app.cli.study_run import check_study as check_study
from app.cli.study_run import run as run_study
from app.cli.study_watching import add_arguments as watch_arguments

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.research.study.analysis.results import Results
    from metagraph.research.study.statistics.small_samples import Estimate


def add_arguments(parser: ArgumentParser) -> None:
    """Add the actions of `study`, each with its options."""
    actions = parser.add_subparsers(dest="action", metavar="action", required=True)

    def action(name: str, words: str, run: Any) -> ArgumentParser:
        out = actions.add_parser(name, help=words, description=words[:1].upper() + words[1:] + ".")
        out.add_argument("--json", action="store_true", help="print JSON for programs")
        out.set_defaults(run=run)
        return out

    def folder(out: ArgumentParser) -> None:
        out.add_argument("folder", type=Path, help="the study's folder, or its study.yaml")
        out.add_argument(
            "--no-jumps",
            action="store_true",
            help="do not look for visible jumps, which needs the clips of the reference projects",
        )

    run_arguments(action("run", "guide a participant through a sitting, in the window", run_study))
    add_pilot_arguments(
        action("pilot", "run a pilot of 25 minutes: instruct, train, record, score, pack as BIDS", run_pilot)
    )
    check_arguments(
        action("check", "print each participant's order of tasks, and problems of the plan", check_study)
    )
    reported = action(
        "report", "write the results of a study: a page (report/report.html), and tables as CSV", report_study
    )
    folder(reported)
    reported.add_argument("others", type=Path, nargs="*", help="folders of the same study at other sites")
    reported.add_argument(
        "--out", type=Path, help="where to write it (default: report, in the study's folder)"
    )
    exported = action("export", "write a study's data for other tools", export_study)
    folder(exported)
    exported.add_argument("--bids", type=Path, metavar="OUT", help="a folder for the data in BIDS form")
    exported.add_argument("--xes", type=Path, metavar="OUT", help="a file for process mining (XES)")
    people_arguments(action)
    plan_arguments(action)
    replay_arguments(action)
    watch_arguments(action)
    agreement_arguments(action)
    words = "studies of preferences and ratings of videos: stimuli, page, answers, report"
    perceive_arguments(
        actions.add_parser("perceive", help=words, description=f"{words[:1].upper()}{words[1:]}.")
    )
    action("example", "recompute the comparison published with the meta-graph", print_example)
    made = action("simulate", "write a study of simulated participants with known effects", simulate_study)
    made.add_argument("out", type=Path, help="the folder to make; it must not exist yet")
    made.add_argument(
        "--like", type=Path, metavar="STUDY", help="use the tasks, orders and questions of this study"
    )
    made.add_argument("--participants", type=int, default=24, help="number of participants (default: 24)")
    made.add_argument(
        "--seed",
        type=int,
        default=1,
        help="random seed; another seed gives other people with the same effects (default: 1)",
    )
    made.add_argument(
        "--ratio",
        type=float,
        default=7.9,
        help="how many times longer the work takes by hand (default: 7.9)",
    )
    made.add_argument(
        "--learning", type=float, default=-0.25, help="slope of log seconds over log clips (default: -0.25)"
    )
    made.add_argument(
        "--order",
        type=float,
        default=0.9,
        help="time of a second sitting as a share of the first (default: 0.9)",
    )
    made.add_argument(
        "--spread", type=float, default=0.3, help="standard deviation of people's log ratios (default: 0.3)"
    )
    made.add_argument(
        "--slips",
        type=float,
        nargs=2,
        default=(0.4, 3.0),
        metavar=("META", "MANUAL"),
        help="mean number of mistakes in a task",
    )
    made.add_argument(
        "--hidden",
        type=float,
        nargs=2,
        default=(1.0, 1.0),
        metavar=("META", "MANUAL"),
        help="with --like: times as long a task takes where clips have numbers instead of names",
    )
    made.add_argument(
        "--sus", type=float, nargs=2, default=(78.0, 52.0), metavar=("META", "MANUAL"), help="mean SUS scores"
    )


def run(options: Namespace) -> int:
    """Do the action that was asked for."""
    return int(options.run(options))


def report_study(options: Namespace) -> int:
    from app.cli.command_output import say
    from app.cli.study_papers import find_pdf_maker
    from metagraph.formats.outputs import claim
    from metagraph.research.study.report import NAME, summarise_study, write_study_report
    from metagraph.research.study.study_plan import read_study

    place = options.out or read_study(options.folder).folder / "report"
    claim(place / NAME)
    results = _results(options)
    written = write_study_report(results, place, find_pdf_maker())
    _tell_missing(results)
    data = {**_facts(results), "written": [str(p) for p in written]}
    cautions = [f"- {w}" for w in (*data["cautions"], *data["odd"])]
    say(options, "\n".join([*summarise_study(results), *cautions, str(written[0])]), data)
    return 0 if results.time is not None else 3


def export_study(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.common.xml_text import INSTEAD
    from metagraph.formats.outputs import claim
    from metagraph.research.study.interchange.bids import write_bids
    from metagraph.research.study.interchange.xes import write_xes
    from metagraph.research.study.study_plan import read_study

    if options.bids is None and options.xes is None:
        raise ValueError("give at least one of --bids OUT and --xes OUT")
    study, lines = read_study(options.folder), []
    data: dict[str, Any] = {}
    if options.bids is not None:
        claim(options.bids / "dataset_description.json")
        results = _results(options)
        written = write_bids(study, results, options.bids)
        _tell_missing(results)
        lines.append(f"{options.bids}: {len(written)} files")
        data |= {"written": [str(p) for p in written], "missing": list(results.data.missing)}
    if options.xes is not None:
        count = write_xes(study, options.xes)
        lines.append(f"{options.xes}: {count} tasks")
        if INSTEAD in options.xes.read_text(encoding="utf-8"):
            print(f"note: {INSTEAD} replaces characters that XML cannot have", file=sys.stderr)
        data |= {"xes": str(options.xes), "traces": count}
    say(options, "\n".join(lines), data)
    return 0


def print_example(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.research.study.analysis.example import compute_example as recomputed
    from metagraph.research.study.analysis.example import describe_example

    found = recomputed()
    data = {
        "ratio": found.ratio.value,
        "interval": None,
        "minutes_a_clip": {"meta": found.minutes[0], "manual": found.minutes[1]},
        "ratio_with_tutorial": found.with_tutorial,
        "people_needed": {str(k): v for k, v in found.needed.items()},
    }
    say(options, describe_example(found), data)
    return 0


def simulate_study(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.research.study.simulation.files import write_study
    from metagraph.research.study.simulation.people import Truth

    truth = Truth(
        participants=options.participants,
        seed=options.seed,
        ratio=options.ratio,
        learning=options.learning,
        order=options.order,
        spread=options.spread,
        slips=tuple(options.slips),
        sus=tuple(options.sus),
        hidden=tuple(options.hidden),
    )
    if options.like is not None:
        from metagraph.research.study.simulation.like_study import write_like
        from metagraph.research.study.study_plan import read_study

        mine = read_study(options.like)
        truth = replace(truth, participants=len(mine.plan.ids))
        made = write_like(mine, options.out, truth)
    else:
        made = write_study(options.out, truth)
    say(options, f"{made.path}: {truth.participants} simulated participants", {"study": str(made.path)})
    return 0


def _tell_missing(results: Results) -> None:
    from metagraph.research.study.reports.cells import gather_missing

    for words in gather_missing(results.data.missing):
        print(f"note: {words}", file=sys.stderr)


def _results(options: Namespace) -> Results:
    from metagraph.research.study.analysis.reading import collect_study
    from metagraph.research.study.analysis.results import analyse_study
    from metagraph.research.study.plan.sites import merge_site_data

    line = ProgressLine(options, "Looking for jumps")

    def progress(done: int, total: int) -> None:
        line.tell(done + 1, total)

    others = getattr(options, "others", ())
    if others:
        return analyse_study(merge_site_data([options.folder, *others], not options.no_jumps, progress))
    return analyse_study(collect_study(options.folder, not options.no_jumps, progress))


def _facts(results: Results) -> dict[str, Any]:
    time, found = results.time, results.sensitivity
    return {
        "title": results.data.title,
        "simulated": results.data.simulated,
        "people": len(results.data.participants),
        "tasks_done": sum(1 for r in results.data.rows if r.done),
        "ratio": None if time is None else _estimate(time.ratio),
        "seconds": {} if time is None else {c: _estimate(e) for c, e in time.means.items()},
        "p": {name: corrected for name, _, corrected in results.together},
        "otherwise": {} if found is None else {w.name: _estimate(w.ratio) for w in found.ways},
        "odd": [] if found is None else list(found.odd),
        "vanished_seconds": {c: v.seconds for c, v in results.vanished.items()},
        "by_names": {n: _estimate(e) for n, e in results.by_names.items()},
        "names_ratio": None if results.names_ratio is None else _estimate(results.names_ratio),
        "slope": {c: _estimate(x.slope) for c, x in results.curves.items()},
        "second_sitting": None if time is None or time.order is None else _estimate(time.order.second),
        "measures": {
            m.name: {c: _estimate(e) for c, e in m.means.items()}
            for m in (*results.mistakes, *results.ratings)
        },
        "cautions": [] if time is None else list(time.cautions),
        "missing": list(results.data.missing),
    }


def _estimate(found: Estimate) -> dict[str, Any]:
    return {"value": found.value, "low": found.low, "high": found.high, "n": found.n}
