"""`metagraph study pilot`: a timing study of 25 minutes, from instructions to results, by one command."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.research.study.study_plan import Study

KIT = Path(__file__).resolve().parents[2] / "sample_clips" / "pilot"
INCOMPLETE = 3


def add_pilot_arguments(parser: ArgumentParser) -> None:
    """Add the options of `pilot`."""
    parser.add_argument(
        "folder", type=Path, help="the folder of the pilot, which is made if it does not exist yet"
    )
    parser.add_argument(
        "--participant", metavar="ID", help="the participant's pseudonym (default: the next one)"
    )
    parser.add_argument(
        "--make", action="store_true", help="only write the study's files, to read and change them"
    )
    parser.add_argument(
        "--score", action="store_true", help="only write the report and the BIDS data of who took part"
    )


def run_pilot(options: Namespace) -> int:
    """Write the kit, lead somebody through it in the window, then report and pack the data. Raises FileError,
    ValueError.
    """
    from app.cli.command_output import say
    from metagraph.research.study.statistics.distributions import load_scipy
    from metagraph.research.study.study_plan import FILE, read_study

    if not (options.folder / FILE).is_file():
        write_pilot(options.folder)
    study = read_study(options.folder)
    if options.make:
        say(options, f"{study.path}: {study.plan.title}", {"study": str(study.path)})
        return 0
    load_scipy("special")  # before anybody takes part: the report at the end needs it
    if not options.score:
        participant = options.participant or find_next_participant(study)
        study.plan.known(participant)
        _lead(study, participant)
    lines, data, complete = pack_pilot(study)
    say(options, "\n".join(lines), data)
    return 0 if complete else INCOMPLETE


def write_pilot(folder: Path) -> None:
    """Copy the kit into a folder that has nothing in it: study file, references, clips, character. Raises
    FileError.
    """
    from metagraph.errors import FileError
    from metagraph.formats.atomic import write_together
    from metagraph.formats.outputs import claim
    from metagraph.research.study.study_plan import FILE, read_study

    if folder.exists() and any(folder.iterdir()):
        raise FileError(
            folder, "is not empty", "on writing the pilot", "Give a folder that does not exist yet."
        )
    kit = read_study(KIT)
    used = (*(t.clips for t in kit.plan.tasks), *(t.clips for t in kit.plan.training))
    clips = {path.resolve() for named in used for path in kit.clips(named)}
    content = {f"clips/{path.name}": path.read_bytes() for path in sorted(clips)}
    content["mannequin.glb"] = (KIT.parent / "mannequin.glb").read_bytes()
    for path in sorted(KIT.glob("*.yaml")):
        content[path.name] = path.read_text(encoding="utf-8").replace("../", "").encode()
    claim(folder / FILE)
    write_together(folder, content)


def find_next_participant(study: Study) -> str:
    """Return the first who has not come to the end. Raises ValueError if all have."""
    from metagraph.research.study.sitting import describe_standing

    for who in study.plan.ids:
        if describe_standing(study, who) not in ("done", "withdrawn"):
            return who
    raise ValueError(
        "all participants are done; change 'participants' in the study file to let more take part"
    )


def _lead(study: Study, participant: str) -> None:
    """Open the window and guide somebody through; return when it is closed."""
    from PySide6.QtCore import Qt, QTimer

    from app.main import make_window, prepare_application

    app = prepare_application()
    from app.features.study.study_chooser import begin_sitting

    window = make_window()
    window.show()

    def begin() -> None:
        guide = begin_sitting(window.shell, study, participant)
        if guide is None:
            window.close()
        else:
            guide.over.connect(window.close, Qt.ConnectionType.QueuedConnection)

    QTimer.singleShot(0, begin)
    app.exec()


def pack_pilot(study: Study) -> tuple[list[str], dict[str, object], bool]:
    """Write the report and the data in BIDS form beside the study file; return what to print, the same for
    programs, and whether there is something to compare. Raises FileError.
    """
    from app.cli.study_papers import find_pdf_maker
    from metagraph.research.study.analysis.reading import collect_study
    from metagraph.research.study.analysis.results import analyse_study
    from metagraph.research.study.interchange.bids import write_bids
    from metagraph.research.study.report import summarise_study, write_study_report
    from metagraph.research.study.reports.cells import gather_missing

    results = analyse_study(collect_study(study.folder))
    report = write_study_report(results, study.folder / "report", find_pdf_maker())
    packed = write_bids(study, results, study.folder / "bids")
    lines = [*summarise_study(results), *(f"- {w}" for w in gather_missing(results.data.missing))]
    lines += [str(report[0]), f"{study.folder / 'bids'}: {len(packed)} files"]
    data: dict[str, object] = {
        "report": str(report[0]),
        "bids": [str(p) for p in packed],
        "people": sum(1 for p in results.data.people.values() if p.standing == "done"),
        "ratio": None if results.time is None else results.time.ratio.value,
    }
    return lines, data, results.time is not None
