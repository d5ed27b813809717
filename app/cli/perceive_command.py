"""`metagraph study perceive`: which of two videos people prefer, from stimuli to a report."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from app.cli.perceive_mismatched import add_arguments as mismatched_arguments
from app.cli.perceive_planning import add_arguments as planning_arguments
from app.cli.perceive_planning import require_empty
from app.cli.progress_line import ProgressLine

NOTHING = 3  # exit code if nothing can be told


def add_arguments(parser: ArgumentParser) -> None:
    """Add the actions, each with its options."""
    actions = parser.add_subparsers(dest="step", metavar="step", required=True)

    def action(name: str, words: str, run: Callable[[Namespace], int]) -> ArgumentParser:
        out = actions.add_parser(name, help=words, description=words[:1].upper() + words[1:] + ".")
        out.add_argument("--json", action="store_true", help="print JSON for programs")
        out.set_defaults(run=run)
        return out

    made = action(
        "make", "render the videos of a study and write the page that shows them", make_perceptual_study
    )
    made.add_argument("plan", type=Path, help="the perceive.yaml of the study")
    made.add_argument(
        "--into",
        type=Path,
        required=True,
        metavar="FOLDER",
        help="the folder to make; it must not exist yet",
    )
    served = action(
        "serve", "serve the page to browsers and save the answers, until you stop it", serve_perceptual_study
    )
    _study(served)
    served.add_argument("--port", type=int, default=0, help="the port to listen on (default: any free port)")
    served.add_argument(
        "--address",
        default="127.0.0.1",
        help="the network address to listen on (default: this computer only)",
    )
    brought = action("collect", "add answers that the page has saved as files", print_perceptual_answers)
    _study(brought)
    brought.add_argument("answers", type=Path, nargs="+", help="the files, or folders that have them")
    told = action(
        "report", "write a report of the answers: a page, and tables as CSV", report_perceptual_study
    )
    _study(told)
    told.add_argument("--out", type=Path, help="where to write it (default: report, in the study's folder)")
    planning_arguments(action)
    mismatched_arguments(action, make_perceptual_study)
    gone = action(
        "withdraw",
        "withdraw a participant: leave the answers out of all reports from now on",
        withdraw_person,
    )
    _study(gone)
    gone.add_argument("participant", help="the participant's code")
    gone.add_argument("--why", default="", help="the reason, which the log keeps")
    deleted = action("delete", "delete all answers of a participant, and log the deletion", delete_person)
    _study(deleted)
    deleted.add_argument("participant", help="the participant's code")
    deleted.add_argument("--yes", action="store_true", help="do not ask for confirmation")


def _study(parser: ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, help="the study's folder, which 'make' or 'simulate' wrote")


def make_perceptual_study(options: Namespace) -> int:
    import hashlib

    from app.cli.command_output import say
    from app.cli.perceive_stimuli import Stimuli
    from metagraph.formats.outputs import claim
    from metagraph.research.study.perceive.design import count_sequences, make_design
    from metagraph.research.study.perceive.folder import KEY, level_times, write_folder
    from metagraph.research.study.perceive.perceive_plan import FILE, read_perceive_plan
    from metagraph.research.study.plan.allocation import make_secret
    from metagraph.speech.soundtrack import RATE
    from preview.video import write_video

    path = options.plan / FILE if options.plan.is_dir() else options.plan
    plan = read_perceive_plan(path)
    require_empty(options.into)
    claim(*(options.into / name for name in ("show/index.html", FILE, KEY)))
    stimuli = Stimuli(path.resolve(), plan)
    sounds = stimuli.sounds()  # what is missing is reported before anything is drawn
    videos = options.into / "show" / "videos"
    videos.mkdir(parents=True, exist_ok=True)
    secret = make_secret(options.into)
    made = make_design(plan, secret)
    items = {i.id: i for i in plan.items}
    apart = plan.choice is None or plan.choice.present == "after"  # else one sound is heard of both
    cameras: dict[str, Any] = {}
    shown: dict[tuple[str, str], str] = {}
    line = ProgressLine(options, "Making videos")
    for n, (name, (condition, ident)) in enumerate(sorted(made.key.stimuli.items())):
        item = items[ident]
        if ident not in cameras:
            cameras[ident] = stimuli.camera(item)
        line.tell(n, len(made.key.stimuli))
        heard = sounds[condition, ident]
        content = hashlib.sha256(b"" if heard is None or not apart else heard.tobytes())
        frames = _digested(stimuli.pictures(condition, item, cameras[ident]), content)
        look = plan.video
        sound = None if heard is None else (heard, RATE)
        write_video(videos / f"{name}.mp4", frames, look.fps, (look.width, look.height), sound=sound)
        shown[condition, ident] = content.hexdigest()
    line.finish()
    level_times(options.into)
    study = write_folder(options.into, plan, path.read_bytes(), made)
    each = [len(s.trials) for s in made.key.sessions.values()]
    rounds = count_sequences(plan)
    lines = [
        f"{study.show / 'index.html'}: {len(made.key.stimuli)} videos, {len(each)} participants of "
        f"{max(each)} trials",
        f"SHA-256 of the secret: {made.key.commitment}",
        "Give each participant a code and the folder 'show', and nothing else; or serve the page.",
    ]
    if len(each) % rounds:
        lines.append(
            f"note: pairs and sides are shown equally often with a multiple of {rounds} participants"
        )
    alike = [(a, b, i) for a, b in plan.pairs for i in items if shown[a, i] == shown[b, i]]
    lines += [
        f"note: '{a}' and '{b}' look exactly the same in item '{i}': choose other seconds"
        for a, b, i in alike
    ]
    data = {
        "alike": alike,
        "page": str(study.show / "index.html"),
        "videos": len(made.key.stimuli),
        "participants": list(made.key.sessions),
        "commitment": made.key.commitment,
        "design": made.key.design,
        "balanced_for": rounds,
    }
    say(options, "\n".join(lines), data)
    return 0


def _digested(frames: Iterable[Any], content: Any) -> Iterator[Any]:
    """Yield pictures, adding each to a digest."""
    for picture in frames:
        content.update(picture.tobytes())
        yield picture


def serve_perceptual_study(options: Namespace) -> int:
    import time

    from app.cli.command_output import run_until_stopped
    from metagraph.research.study.perceive.folder import read_folder
    from metagraph.research.study.perceive.serving import find_page
    from metagraph.research.study.perceive.serving import serve_page as begin

    study = read_folder(options.folder)
    find_page(study)
    try:
        served = begin(study, options.port, options.address)
    except (OSError, OverflowError) as error:
        raise ValueError(f"{options.address}:{options.port} is not available ({error})") from None
    try:
        with run_until_stopped():
            print(f"the page is at {served.url}#CODE (stop with Ctrl+C)", file=sys.stderr, flush=True)
            while True:
                time.sleep(3600)
    finally:
        served.close()
    print("stopped", file=sys.stderr)
    return 0


def print_perceptual_answers(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.errors import FileError
    from metagraph.research.study.perceive.answers import SheetError, keep_sheet, read_answers
    from metagraph.research.study.perceive.folder import read_folder

    study = read_folder(options.folder)
    paths = [q for p in options.answers for q in (sorted(p.glob("*.json")) if p.is_dir() else [p])]
    done: list[dict[str, Any]] = []
    failed: list[str] = []
    for path in paths:
        try:
            sheet = read_answers(path)
            found = keep_sheet(study, sheet)
        except FileError as error:
            failed.append(str(error))
        except SheetError as error:
            failed.append(f"{path.name}: {error}. Nothing was added; the file is unchanged.")
        else:
            done.append({"code": sheet.code, "kept": found.kept, "new": found.new, "file": str(path)})
    for words in failed:
        print(f"note: {words}", file=sys.stderr)
    lines = [f"{d['code']}: {d['new']} new events, {d['kept']} in all" for d in done]
    say(options, "\n".join(lines) or "nothing was added", {"collected": done, "failed": failed})
    return 0 if done and not failed else NOTHING


def report_perceptual_study(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.formats.outputs import claim
    from metagraph.research.study.perceive.folder import read_folder
    from metagraph.research.study.perceive.perceive_analysis import analyse_answers
    from metagraph.research.study.perceive.perceive_data import collect_answers as read_answers
    from metagraph.research.study.perceive.perceive_report import (
        NAME,
        perceive_tables,
        summarise_perceive,
        write_perceive_report,
    )

    study = read_folder(options.folder)
    place = options.out or study.folder / "report"
    claim(place / NAME)
    results = analyse_answers(read_answers(study))
    written = write_perceive_report(results, place)
    for words in results.answers.odd:
        print(f"note: {words}", file=sys.stderr)
    columns, rows = perceive_tables(results)["pairs.csv"]
    data = {
        "people": len(results.answers.people),
        "count": len(results.answers.counting),
        "pairs": [dict(zip(columns, row, strict=True)) for row in rows],
        "rated": [
            {"question": r.question, "pair": list(r.pair), "difference": r.difference.value, "p": r.together}
            for r in results.rated
        ],
        "cautions": list(results.cautions),
        "odd": list(results.answers.odd),
        "simulated": results.answers.simulated,
        "written": [str(p) for p in written],
    }
    fake = ["Nobody took part: these answers were simulated."] if results.answers.simulated else []
    said = [*fake, *summarise_perceive(results), *(f"- {w}" for w in results.cautions), str(written[0])]
    say(options, "\n".join(said), data)
    return 0 if results.answers.counting else NOTHING


def withdraw_person(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.research.study.logs.withdrawal import note_withdrawal as note
    from metagraph.research.study.perceive.folder import read_folder

    study = read_folder(options.folder)
    new = note(study, options.participant, options.why)
    say(
        options,
        f"{options.participant}: {'left out from now on' if new else 'withdrawn earlier'}; "
        "write the report again",
        {"participant": options.participant, "new": new},
    )
    return 0


def delete_person(options: Namespace) -> int:
    from app.cli.command_output import may_delete, say
    from metagraph.research.study.logs.withdrawal import delete_data as remove
    from metagraph.research.study.perceive.folder import read_folder

    study = read_folder(options.folder)
    study.known(options.participant)
    place = study.data(options.participant)
    if not may_delete(options, place):
        return 1
    note = remove(study, options.participant)
    say(
        options,
        f"{options.participant}: {note['files']} files deleted; write the report again",
        {"deleted": note},
    )
    return 0
