"""`metagraph study perceive`: which of two videos people prefer, from stimuli to a report."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.study.perceive.simulated import Raters

NOTHING = 3  # exit code where nothing can be told


def arguments(parser: ArgumentParser) -> None:
    """Add the actions, each with its options."""
    actions = parser.add_subparsers(dest="step", metavar="step", required=True)

    def action(name: str, words: str, run: Callable[[Namespace], int]) -> ArgumentParser:
        out = actions.add_parser(name, help=words, description=words[:1].upper() + words[1:] + ".")
        out.add_argument("--json", action="store_true", help="print what a program can read")
        out.set_defaults(run=run)
        return out

    made = action("make", "draw the videos of a study and write the page that shows them", make)
    made.add_argument("plan", type=Path, help="a perceive.yaml")
    made.add_argument(
        "--into", type=Path, required=True, metavar="FOLDER", help="a folder that is not there yet"
    )
    served = action("serve", "show the page to browsers, and keep what they answer, until stopped", serve)
    _study(served)
    served.add_argument("--port", type=int, default=0, help="(default: any that is free)")
    served.add_argument(
        "--address", default="127.0.0.1", help="of the interface to listen on (default: this machine alone)"
    )
    brought = action("collect", "keep answers that the page has saved as files", collect)
    _study(brought)
    brought.add_argument("answers", type=Path, nargs="+", help="the files, or folders of them")
    told = action("report", "write what the answers show: a page and tables as CSV", report)
    _study(told)
    told.add_argument("--out", type=Path, help="where to write it (default: report, in the study's folder)")
    planned = action("plan", "say how many answers, and how many people, a forced choice needs", plan)
    planned.add_argument("--share", type=float, required=True, help="of choices that is expected, 0.5 to 1")
    planned.add_argument("--smallest", type=float, help="the smallest share that would matter")
    planned.add_argument("--items", type=int, default=10, help="stretches of motion in all (10)")
    planned.add_argument(
        "--each", type=int, help="answers of a person about the pair (default: one of each item)"
    )
    planned.add_argument("--people-differ", type=float, default=0.5, metavar="SD", help="log odds (0.5)")
    planned.add_argument("--items-differ", type=float, default=0.3, metavar="SD", help="log odds (0.3)")
    planned.add_argument("--chance", type=float, default=0.8, help="to show it (0.8)")
    planned.add_argument("--tests", type=int, default=1, help="that share 0.05 (1)")
    planned.add_argument("--participants", type=int, help="tell the chance with so many instead")
    planned.add_argument("--studies", type=int, default=200, help="that are simulated (200)")
    planned.add_argument("--seed", type=int, default=1)
    faked = action("simulate", "write a study without videos, answered by people who do not exist", simulate)
    faked.add_argument("out", type=Path, help="a folder that is not there yet")
    faked.add_argument("--like", type=Path, metavar="PLAN", help="a perceive.yaml of yours")
    faked.add_argument("--participants", type=int, help="how many (default: the plan's)")
    faked.add_argument(
        "--liked", action="append", default=[], metavar="CONDITION=LOGODDS", help="how much one is liked"
    )
    faked.add_argument("--people-differ", type=float, default=0.4, metavar="SD", help="log odds (0.4)")
    faked.add_argument("--items-differ", type=float, default=0.3, metavar="SD", help="log odds (0.3)")
    faked.add_argument("--left", type=float, default=0.0, help="log odds the left side gains (0)")
    faked.add_argument(
        "--lapses", type=float, default=0.02, help="share of answers given without looking (0.02)"
    )
    faked.add_argument("--careless", type=float, default=0.0, help="share of people who never look (0)")
    faked.add_argument("--unfinished", type=float, default=0.0, help="share of people who break off (0)")
    faked.add_argument("--seed", type=int, default=1, help="other people (1)")
    gone = action("withdraw", "leave somebody's answers out of all reports from now on", withdraw)
    _study(gone)
    gone.add_argument("participant", help="their code")
    gone.add_argument("--why", default="", help="in words, kept in the log")
    deleted = action("delete", "delete all answers of somebody, and note that it was done", delete)
    _study(deleted)
    deleted.add_argument("participant", help="their code")
    deleted.add_argument("--yes", action="store_true", help="do not ask")


def _study(parser: ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, help="the folder that 'make' or 'simulate' wrote")


def _empty(folder: Path) -> None:
    """Raise ValueError for a folder with a study in it: its answers must not get another key."""
    from metagraph.study.perceive.folder import KEY

    if (folder / KEY).exists() or (folder / "answers").exists():
        raise ValueError(f"{folder} holds a study already, perhaps with answers: name another folder")
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"{folder} is a file: name a folder")


def make(options: Namespace) -> int:
    from app.cli.command_output import say
    from app.cli.perceive_stimuli import Stimuli
    from metagraph.speech.soundtrack import RATE
    from metagraph.study.allocation import make_secret
    from metagraph.study.perceive.design import design, sequences
    from metagraph.study.perceive.folder import level_times, write_folder
    from metagraph.study.perceive.perceive_plan import FILE, read_plan
    from preview.video import write_video

    path = options.plan / FILE if options.plan.is_dir() else options.plan
    plan = read_plan(path)
    _empty(options.into)
    stimuli = Stimuli(path.resolve(), plan)
    sounds = stimuli.sounds()  # what is missing is told before anything is drawn
    videos = options.into / "show" / "videos"
    videos.mkdir(parents=True, exist_ok=True)
    secret = make_secret(options.into)
    made = design(plan, secret)
    items = {i.id: i for i in plan.items}
    cameras: dict[str, Any] = {}
    tellable = sys.stderr.isatty() and not options.json
    for n, (name, (condition, ident)) in enumerate(sorted(made.key.stimuli.items())):
        item = items[ident]
        if ident not in cameras:
            cameras[ident] = stimuli.camera(item)
        if tellable:
            print(f"\r{n + 1} of {len(made.key.stimuli)} videos ", end="", file=sys.stderr, flush=True)
        heard = sounds[condition, ident]
        frames = stimuli.pictures(condition, item, cameras[ident])
        look = plan.video
        sound = None if heard is None else (heard, RATE)
        write_video(videos / f"{name}.mp4", frames, look.fps, (look.width, look.height), sound=sound)
    if tellable:
        print(file=sys.stderr)
    level_times(options.into)
    study = write_folder(options.into, plan, path.read_bytes(), made)
    each = [len(s.trials) for s in made.key.sessions.values()]
    rounds = sequences(plan)
    lines = [
        f"{study.show / 'index.html'}: {len(made.key.stimuli)} videos, {len(each)} participants of "
        f"{max(each)} trials",
        f"SHA-256 of the secret: {made.key.commitment}",
        "Give people the folder 'show' and a code each, and nothing else of it; or serve it.",
    ]
    if len(each) % rounds:
        lines.append(
            f"note: pairs and sides are shown equally often with a multiple of {rounds} participants"
        )
    data = {
        "page": str(study.show / "index.html"),
        "videos": len(made.key.stimuli),
        "participants": list(made.key.sessions),
        "commitment": made.key.commitment,
        "design": made.key.design,
        "balanced_for": rounds,
    }
    say(options, "\n".join(lines), data)
    return 0


def serve(options: Namespace) -> int:
    import time

    from app.cli.command_output import until_told_to_stop
    from metagraph.study.perceive.folder import read_folder
    from metagraph.study.perceive.serving import page_of
    from metagraph.study.perceive.serving import serve as begin

    study = read_folder(options.folder)
    page_of(study)
    try:
        served = begin(study, options.port, options.address)
    except (OSError, OverflowError) as error:
        raise ValueError(f"{options.address}:{options.port} cannot be listened on ({error})") from None
    try:
        with until_told_to_stop():
            print(f"the page is at {served.url}#CODE (Ctrl+C stops)", file=sys.stderr, flush=True)
            while True:
                time.sleep(3600)
    finally:
        served.close()
    print("stopped", file=sys.stderr)
    return 0


def collect(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.errors import FileError
    from metagraph.study.perceive.answers import SheetError, keep, read_answers
    from metagraph.study.perceive.folder import read_folder

    study = read_folder(options.folder)
    paths = [q for p in options.answers for q in (sorted(p.glob("*.json")) if p.is_dir() else [p])]
    done: list[dict[str, Any]] = []
    failed: list[str] = []
    for path in paths:
        try:
            sheet = read_answers(path)
            found = keep(study, sheet)
        except FileError as error:
            failed.append(str(error))
        except SheetError as error:
            failed.append(f"{path.name}: {error}. Nothing of it was kept; the file is left as it is.")
        else:
            done.append({"code": sheet.code, "kept": found.kept, "new": found.new, "file": str(path)})
    for words in failed:
        print(f"note: {words}", file=sys.stderr)
    lines = [f"{d['code']}: {d['new']} new events, {d['kept']} in all" for d in done]
    say(options, "\n".join(lines) or "nothing was kept", {"collected": done, "failed": failed})
    return 0 if done and not failed else NOTHING


def report(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.study.perceive.folder import read_folder
    from metagraph.study.perceive.perceive_analysis import analyse
    from metagraph.study.perceive.perceive_data import collect as read_answers
    from metagraph.study.perceive.perceive_report import summary, tables, write_report

    study = read_folder(options.folder)
    results = analyse(read_answers(study))
    written = write_report(results, options.out or study.folder / "report")
    for words in results.answers.odd:
        print(f"note: {words}", file=sys.stderr)
    columns, rows = tables(results)["pairs.csv"]
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
    said = [*summary(results), *(f"- {w}" for w in results.cautions), str(written[0])]
    say(options, "\n".join(said), data)
    return 0 if results.answers.counting else NOTHING


def plan(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.study.perceive import binomial
    from metagraph.study.perceive.perceive_power import Expected, design_effect, people_needed, shown

    if options.tests < 1 or options.items < 1:
        raise ValueError("tests and items are at least 1")
    if not 0.5 < options.share < 1:
        raise ValueError(f"--share is more than 0.5 and less than 1, not {options.share:g}")
    if not 0 < options.chance < 1:
        raise ValueError(f"--chance is between 0 and 1, not {options.chance:g}")
    if options.smallest is not None and not 0.5 < options.smallest < 1:
        raise ValueError(f"--smallest is more than 0.5 and less than 1, not {options.smallest:g}")
    alpha, each = 0.05 / options.tests, options.each or options.items
    expected = Expected(options.share, options.people_differ, options.items_differ)
    answers = binomial.needed(options.share, options.chance, alpha)
    data: dict[str, Any] = {
        "answers": answers,
        "alpha": alpha,
        "design_effect": design_effect(expected, each),
    }
    lines = [
        f"for a chance of {options.chance:.0%}"
        + (f", {options.tests} tests" if options.tests > 1 else "")
        + ":",
        f"  independent answers to show a share of {options.share:.0%}: {_count(answers)} (exact binomial)",
    ]
    if options.smallest is not None:
        data["smallest"] = binomial.needed(options.smallest, options.chance, alpha)
        data["equivalent"] = binomial.equivalence_needed(options.smallest - 0.5, options.chance, alpha)
        lines += [
            f"  to show the smallest that matters, {options.smallest:.0%}: {_count(data['smallest'])}",
            f"  to show that a half is within {1 - options.smallest:.0%} and {options.smallest:.0%}: "
            f"{_count(data['equivalent'])}",
        ]
    lines.append(
        f"answers of one person are alike: {data['design_effect']:.2f} times as many for {each} of each person"
    )
    rest = (options.items, each)
    if options.participants is not None:
        found = shown(expected, options.participants, *rest, alpha, options.studies, options.seed)
        data["power"] = {
            "people": options.participants,
            "chance": found.value,
            "low": found.low,
            "high": found.high,
        }
        lines.append(f"{options.participants} people: {_chance(found)}")
    else:
        people, best = people_needed(expected, *rest, options.chance, alpha, options.studies, options.seed)
        data["people"] = people
        if best is not None:
            data["power"] = {"chance": best.value, "low": best.low, "high": best.high}
        told = _chance(best) if best is not None else ""
        lines.append(
            f"people, by {options.studies} simulated studies of the mixed model: {people}: {told}"
            if people is not None
            else f"even 400 people are too few with {options.items} items that differ so much: {told}"
        )
    say(options, "\n".join(lines), data)
    return 0


def _count(value: int | None) -> str:
    return "more than 100,000" if value is None else f"{value:,}"


def _chance(found: Any) -> str:
    return f"shown in {found.value:.0%} of simulated studies ({found.low:.0%} to {found.high:.0%})"


EXAMPLE = """\
perceive: 1
title: A made-up study
participants: 24
project: sample.metagraph.yaml
conditions:
  all: {title: All responses, conversation: Office}
  deaf: {title: Without the listener, conversation: Office, without: [response, hesitation]}
  other: {title: Another draw, conversation: Office, seed: 7}
compare: [[all, deaf], [all, other]]
items:
- {id: one, start: 0, seconds: 3}
- {id: two, start: 3, seconds: 3}
- {id: three, start: 6, seconds: 3}
- {id: four, start: 9, seconds: 3}
- {id: five, start: 12, seconds: 3}
- {id: six, start: 15, seconds: 3}
- {id: seven, start: 18, seconds: 3}
- {id: eight, start: 21, seconds: 3}
choice: {question: Which of the two seems more natural?}
"""


def simulate(options: Namespace) -> int:
    from dataclasses import replace

    from msgspec.structs import replace as changed

    from app.cli.command_output import say
    from metagraph.study.perceive.perceive_plan import FILE, from_text, read_plan
    from metagraph.study.perceive.simulated import write_simulated

    _empty(options.out)
    text = EXAMPLE.encode()
    mine = from_text(EXAMPLE)
    raters = _raters(options)
    if options.like is not None:
        path = options.like / FILE if options.like.is_dir() else options.like
        mine, text = read_plan(path), path.read_bytes()
    elif not raters.liked:
        raters = replace(raters, liked={"deaf": -0.8})
    if options.participants is not None:
        if not 1 <= options.participants <= 1000:
            raise ValueError("a study has 1 to 1000 participants")
        mine = changed(mine, participants=options.participants)
    strange = set(raters.liked) - set(mine.conditions)
    if strange:
        raise ValueError(
            f"there is no condition '{sorted(strange)[0]}'; there are {', '.join(mine.conditions)}"
        )
    study = write_simulated(options.out, mine, text, f"simulated {options.seed}", raters)
    count = len(study.key.sessions)
    say(options, f"{study.folder}: {count} simulated raters", {"study": str(study.folder), "raters": count})
    return 0


def _raters(options: Namespace) -> Raters:
    from metagraph.study.perceive.simulated import Raters

    liked = {}
    for words in options.liked:
        name, found, value = words.partition("=")
        try:
            liked[name] = float(value)
        except ValueError:
            found = ""
        if not found:
            raise ValueError(f"what is liked is given as CONDITION=LOGODDS, not {words!r}")
    return Raters(
        liked,
        options.people_differ,
        options.items_differ,
        options.left,
        options.lapses,
        options.careless,
        options.unfinished,
        options.seed,
    )


def withdraw(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.study.perceive.folder import read_folder
    from metagraph.study.withdrawal import withdraw as note

    study = read_folder(options.folder)
    new = note(study, options.participant, options.why)
    say(
        options,
        f"{options.participant}: {'left out from now on' if new else 'had withdrawn before'}; write the report anew",
        {"participant": options.participant, "new": new},
    )
    return 0


def delete(options: Namespace) -> int:
    from app.cli.command_output import say
    from metagraph.study.perceive.folder import read_folder
    from metagraph.study.withdrawal import delete as remove

    study = read_folder(options.folder)
    study.known(options.participant)
    place = study.data(options.participant)
    if not options.yes:
        if options.json or not sys.stdin.isatty():
            raise ValueError(f"deleting {place} cannot be taken back: say --yes")
        if input(f"Delete {place} and all that is in it? It cannot be taken back. [y/N] ").lower() != "y":
            return 1
    note = remove(study, options.participant)
    say(
        options,
        f"{options.participant}: {note['files']} files deleted; write the report anew",
        {"deleted": note},
    )
    return 0
