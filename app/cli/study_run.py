"""`metagraph study run` and `metagraph study check`."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

PROBLEMS = 3


def run_arguments(parser: ArgumentParser) -> None:
    """Add the options of `run`."""
    parser.add_argument("study", type=Path, help="a study file, or the folder it is in")
    parser.add_argument(
        "--participant", metavar="ID", help="the participant's pseudonym (default: the window asks)"
    )
    parser.add_argument(
        "--experimenter",
        action="store_true",
        help="record notes as the experimenter, not as the participant",
    )


def run(options: Namespace) -> int:
    """Open the window and guide a participant through the sitting. Raises FileError, ValueError."""
    from metagraph.research.study.study_plan import read_study

    study = read_study(options.study)
    if options.participant is not None:
        study.plan.known(options.participant)  # a stranger is reported before a window is opened
    from PySide6.QtCore import QTimer

    from app.main import make_window, prepare_application

    app = prepare_application()
    from app.features.study.study_chooser import run_study

    window = make_window()
    window.show()
    QTimer.singleShot(
        0, lambda: run_study(window.shell, study.path, options.participant, options.experimenter)
    )
    return app.exec()


def check_arguments(parser: ArgumentParser) -> None:
    """Add the options of `check`."""
    parser.add_argument("study", type=Path, help="a study file, or the folder it is in")


def check_study(options: Namespace) -> int:
    """Print each participant's order of tasks, and problems of the plan. Raises FileError."""
    from metagraph.research.study.sitting import describe_standing
    from metagraph.research.study.study_plan import read_study

    study = read_study(options.study)
    problems = study.problems() + _promised(study)
    rows = [(who, _order(study, who), describe_standing(study, who)) for who in study.plan.ids]
    if options.json:
        orders = {
            who: [{"condition": c, "tasks": list(tasks)} for c, tasks in blocks] for who, blocks, _ in rows
        }
        print(
            json.dumps(
                {
                    "title": study.plan.title,
                    "orders": orders,
                    "standing": {r[0]: r[2] for r in rows},
                    "problems": problems,
                }
            )
        )
    else:
        print(study.plan.title)
        for who, blocks, stands in rows:
            numbered = {t for _, tasks in blocks for t in tasks if study.hides(who, t)}
            order = "; ".join(
                f"{condition}: {', '.join(f'{t} (names hidden)' if t in numbered else t for t in tasks)}"
                for condition, tasks in blocks
            )
            order = order or "drawn at the start"
            print(f"  {who}  {order}  ({stands})")
        for problem in problems:
            print(f"problem: {problem}")
    return PROBLEMS if problems else 0


def _order(study, participant):
    """Return a participant's conditions with their tasks; nothing if they are not drawn yet."""
    try:
        return study.blocks(participant)
    except ValueError:
        return ()


def _promised(study):
    """Return in words where the study is not what was frozen, preregistered or drawn."""
    from metagraph.research.study.plan import allocation
    from metagraph.research.study.plan.freeze import find_changed_names, read_frozen, study_manifest
    from metagraph.research.study.plan.preregistration import list_departures

    before = read_frozen(study)
    out = (
        [
            f"{name} has changed since it was frozen"
            for name in find_changed_names(before, study_manifest(study))
        ]
        if before
        else []
    )
    drawn = allocation.find_allocation_problems(study) if study.plan.order == "concealed" else []
    return [*out, *list_departures(study), *drawn]
