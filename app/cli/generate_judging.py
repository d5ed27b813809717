"""`metagraph generate evaluate`: models on takes that they have not seen."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.generation.poses import PoseRig
    from metagraph.generation.stored import Model
    from metagraph.generation.takes import Take
    from metagraph.research.generation.evaluation import SamplingManner


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options of `evaluate`. The endings of the files distinguish models from takes."""
    from app.cli.generate_takes import add_speech_argument

    parser.add_argument(
        "given",
        type=Path,
        nargs="+",
        metavar="MODEL... TAKES",
        help="models (.mgmodel), and takes (clips or folders) that the models have not learned from; "
        "from folders they have learned from, only held-out takes are used",
    )
    add_speech_argument(parser)
    parser.add_argument("-o", "--out", type=Path, help="write a report page, JSON and CSV into this folder")
    parser.add_argument(
        "--floor",
        type=Path,
        metavar="FOLDER",
        help="other recorded motion to the same speech, in clips with the same names (default: another "
        "performance of synthetic takes; else one half of the takes against the other)",
    )
    add_manner_arguments(parser)


def add_manner_arguments(parser: ArgumentParser) -> None:
    """Add the options that say how models are sampled and judged."""
    parser.add_argument("--seeds", type=int, default=5, help="number of takes per model (default: 5)")
    parser.add_argument(
        "--temperature", type=float, default=1.0, help="how much the motion varies, 0 to 1.2 (default: 1)"
    )
    parser.add_argument(
        "--lookahead",
        type=int,
        help="frames of sound the model hears ahead; 0 for live use (default: as many as the model uses)",
    )
    parser.add_argument(
        "--guidance",
        type=float,
        help="how closely a matching model or a flow-vae follows the speech (default: 1.5)",
    )
    parser.add_argument(
        "--draws", type=int, default=200, help="bootstrap draws for the intervals (default: 200)"
    )


def read_manner(options: Namespace) -> SamplingManner:
    """Return how models are sampled. Raises ValueError."""
    from metagraph.generation.chunks import GUIDANCE
    from metagraph.research.generation.evaluation import SamplingManner

    if not 1 <= options.seeds <= 100:
        raise ValueError(f"--seeds must be 1 to 100, not {options.seeds}")
    if not 0 <= options.draws <= 10000:
        raise ValueError(f"--draws must be 0 to 10000, not {options.draws}")
    if options.lookahead is not None and options.lookahead < 0:
        raise ValueError("--lookahead must be 0 frames or more")
    guidance = GUIDANCE if options.guidance is None else options.guidance
    return SamplingManner(options.seeds, options.temperature, options.lookahead, guidance)


def judge_models(options: Namespace) -> int:
    """Judge models; print the table, with `out` write it and the figures."""
    from app.cli.command_output import say
    from app.cli.generate_report import REPORT, report_as_data, report_as_text, write_generation_report
    from app.cli.generate_takes import read_all, read_models
    from app.cli.progress_line import ProgressLine
    from metagraph.formats.outputs import claim
    from metagraph.generation.stored import SUFFIX
    from metagraph.research.generation.evaluation import HeldOut, find_takes_unseen_by_all, judge_on_takes

    paths = [p for p in options.given if p.suffix.lower() == SUFFIX]
    options.takes = [p for p in options.given if p.suffix.lower() != SUFFIX]
    if not paths or not options.takes:
        missing = "takes are missing" if paths else f"a model ({SUFFIX}) is missing"
        raise ValueError(f"give models and takes: {missing}")
    manner = read_manner(options)
    if options.out is not None:
        claim(*(options.out / name for name in REPORT))
    models = read_models(paths)
    first = next(iter(models.values()))
    require_alike(models)
    batch = read_all(options, first.rig, first.card.tracks)
    takes, left = find_takes_unseen_by_all(models, batch.takes)
    if left:
        print(f"note: {len(left)} takes skipped, because a model has learned from them", file=sys.stderr)
    held = HeldOut(takes, find_floor(options.floor, options.takes, takes, first.rig))
    show = ProgressLine(options, "Making motion").tell
    judged = judge_on_takes(first.rig, models, held, manner, draws=options.draws, progress=show)
    beside = {r.name for r in judged.rows} if judged.floor is None else {"other motion"}
    notes = list_judging_cautions(models, takes, beside)
    said: dict[str, Any] = {
        "takes": len(takes),
        "minutes": round(sum(t.seconds for t in takes) / 60, 2),
        "seeds": manner.seeds,
        "temperature": manner.temperature,
        "lookahead": manner.lookahead if manner.lookahead is not None else "all",
        "guidance": manner.guidance,
        "models": ", ".join(f"{n} ({m.card.kind}, {m.card.steps:,} steps)" for n, m in models.items()),
    }
    written = write_generation_report(judged, said, notes, options.out) if options.out is not None else []
    lines = [f"{len(takes)} takes, {said['minutes']:g} min, {manner.seeds} seeds per model"]
    lines += [
        report_as_text(judged.rows),
        *(f"note: {n}" for n in notes),
        *(f"written: {p}" for p in written),
    ]
    data = {**report_as_data(judged.rows, said), "notes": list(notes), "written": [str(p) for p in written]}
    say(options, "\n".join(lines), data)
    return 0


def require_alike(models: dict[str, Model]) -> None:
    """Raise ValueError where models cannot be judged on the same takes."""
    first, *others = models.items()
    for name, model in others:
        if model.card.skeleton.fingerprint != first[1].card.skeleton.fingerprint:
            raise ValueError(
                f"'{name}' is for another skeleton than '{first[0]}': evaluate them one at a time"
            )
        if model.card.tracks != first[1].card.tracks or model.rig.roles != first[1].rig.roles:
            raise ValueError(
                f"'{name}' hears or moves other things than '{first[0]}': evaluate them one at a time"
            )


def find_floor(
    folder: Path | None, given: list[Path], takes: tuple[Take, ...], rig: PoseRig
) -> list[Any] | None:
    """Return other true motion to the same speech, poses of each take; None if there is none. Raises
    ValueError.
    """
    from metagraph.generation.take_files import find_takes, read_take_batch

    if folder is not None:
        batch = read_take_batch(find_takes([folder])[0], rig)
        found = {t.source.name: t for t in batch.takes}
        missing = [t.source.name for t in takes if t.source.name not in found]
        if missing:
            why = f" ({batch.failures[0]})" if batch.failures else ""
            raise ValueError(f"{folder} has no other motion for '{missing[0]}'{why}")
        return [cut_like(found[t.source.name], t) for t in takes]
    return perform_planted_floor(given, takes, rig)


def cut_like(whole: Take, take: Take) -> Any:
    """Return the poses `[T, X]` of a whole take that a take which was cut from it has."""
    first = round(take.source.start * 25) - round(whole.source.start * 25)
    return whole.poses[first : first + len(take.poses)]


def perform_planted_floor(given: list[Path], takes: tuple[Take, ...], rig: PoseRig) -> list[Any] | None:
    """Return another performance of takes that the sample project made, or None for other takes."""
    from app.cli.command_output import open_for_command
    from app.cli.demo_command import SAMPLE
    from metagraph.research.generation.planted import perform_again, read_planted

    cards = [card for folder in given if folder.is_dir() and (card := read_planted(folder)) is not None]
    if len(cards) != 1 or len(given) != 1:
        return None
    project = open_for_command(SAMPLE)
    if project.skeleton is None or project.skeleton.fingerprint != cards[0].project:
        return None
    return [cut_like(perform_again(project, cards[0], t, rig), t) for t in takes]


def list_judging_cautions(
    models: dict[str, Model], takes: tuple[Take, ...], beside: set[str]
) -> tuple[str, ...]:
    """Return what nobody should read into the table. beside: names of its rows where the floor is no other
    motion to the same speech.
    """
    out = []
    seconds = sum(t.seconds for t in takes)
    if seconds < 240:
        out.append(f"{seconds:.0f} s are too short to judge a model well: the intervals are wide.")
    if "floor" in beside:
        out.append(
            "The floor compares one half of the takes with the other, not two performances of the same "
            "speech."
        )
    elif "other motion" not in beside:
        out.append("There is too little motion for a floor.")
    if not any(t.marks.hesitations for t in takes):
        out.append("No partner hesitates, or words are missing, so listening is not measured.")
    kinds = {m.card.kind for m in models.values()}
    if len(kinds) > 1:
        out.append(
            "These models differ in several ways at once (the CVAE has neither past poses nor a flow). "
            "`ablate` changes one thing at a time."
        )
    return tuple(out)
