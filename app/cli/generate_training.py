"""`metagraph generate train` and `ablate`: models learned from takes, in a process of their own."""

from __future__ import annotations

import shutil
import signal
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.generation.take_files import TakeBatch
    from metagraph.generation.takes import Take
    from metagraph.generation.train_process import TrainingEvent, TrainingProcess
    from metagraph.research.generation.ablation import AblationJob

KINDS = ("flow-vae", "moglow", "cvae", "matching")
MINUTES = 15.0
EVERY = 30.0  # seconds between lines if nobody looks on


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options of `train`."""
    from app.cli.generate_takes import add_speech_argument

    parser.add_argument(
        "takes",
        type=Path,
        nargs="*",
        metavar="TAKES",
        help="clips, or folders of clips, each with its sound in the same folder: talk.bvh and "
        "talk.wav, or talk_1.bvh and talk_2.bvh for the two speakers of talk.wav",
    )
    add_speech_argument(parser)
    parser.add_argument("-o", "--out", type=Path, required=True, help="the model to write (.mgmodel)")
    add_training_arguments(parser, "matching")
    parser.add_argument(
        "--minutes", type=float, help=f"of the clock, all runs together (default: {MINUTES:g})"
    )
    parser.add_argument(
        "--seconds", type=float, help="processor time in seconds instead, for all runs together"
    )
    parser.add_argument(
        "--seed", type=int, default=1, help="random seed; another seed gives another training (default: 1)"
    )
    parser.add_argument(
        "--loss",
        choices=("paper", "finished"),
        help="'paper' trains a flow-vae as it was published, and adds nothing (default: the loss that "
        "suits the model)",
    )
    parser.add_argument(
        "--mirror",
        action="store_true",
        help="also learn from mirrored takes; the result has no dominant hand",
    )
    parser.add_argument("--resume", action="store_true", help="continue a training that was stopped")


def add_training_arguments(parser: ArgumentParser, kind: str) -> None:
    parser.add_argument("--model", choices=KINDS, default=kind, help=f"what is trained (default: {kind})")
    parser.add_argument(
        "--size",
        choices=("small", "paper"),
        default="small",
        help="'paper' trains for hundreds of processor hours (default: small)",
    )
    parser.add_argument("--two-tracks", action="store_true", help="hear the two voices separately")
    parser.add_argument("--threads", type=int, default=0, help="processor threads to use (default: all)")


def add_ablation_arguments(parser: ArgumentParser) -> None:
    """Add the options of `ablate`."""
    from app.cli.generate_judging import add_manner_arguments
    from app.cli.generate_takes import add_takes_arguments

    add_takes_arguments(parser)
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        required=True,
        help="the folder for models and table; models already there are used again",
    )
    add_training_arguments(parser, "matching")
    parser.add_argument(
        "--seconds", type=float, default=300.0, help="processor time in seconds per training (default: 300)"
    )
    parser.add_argument(
        "--trainings",
        type=int,
        default=1,
        help="number of trainings of each variant, with different seeds (default: 1)",
    )
    parser.add_argument(
        "--change",
        action="append",
        metavar="NAME",
        help="only this change, compared with the full model; repeat for more (default: all)",
    )
    parser.add_argument(
        "--floor",
        type=Path,
        metavar="FOLDER",
        help="other recorded motion to the same speech, as for 'evaluate'",
    )
    add_manner_arguments(parser)


def require_trainable(options: Namespace) -> None:
    """Raise ValueError, RuntimeError for what cannot be trained."""
    from metagraph.generation.train_process import find_missing_tools

    for name in ("minutes", "seconds"):
        value = getattr(options, name, None)
        if value is not None and not 0 < value < 1e7:
            raise ValueError(f"--{name} must be more than 0, not {value:g}")
    if not 0 <= options.threads <= 256:
        raise ValueError(f"--threads must be 0 to 256, not {options.threads}")
    if words := find_missing_tools():
        raise RuntimeError(words)


def train(options: Namespace) -> int:
    """Train a model, or continue its training, and print progress."""
    from app.cli.command_output import say
    from metagraph.formats.outputs import declare_updates
    from metagraph.generation.stored import SUFFIX, read_model
    from metagraph.generation.train_plan import find_training_folder

    out: Path = options.out
    if out.suffix.lower() != SUFFIX:
        raise ValueError(f"a model can be written as {SUFFIX}, not as '{out.suffix or out.name}'")
    require_trainable(options)
    declare_updates(out, find_training_folder(out))  # what is there is gone on with, or refused
    _go_on(options) if options.resume else _begin(options)
    process, stopped = _trained(options, out)
    card = read_model(out).card
    data = {
        "model": str(out),
        "kind": card.kind,
        "steps": card.steps,
        "hours": round(card.hours, 4),
        "learned": len(card.takes),
        "held_out": len(card.held_out),
        "stopped": stopped,
        "seconds": process.last.seconds,
        "minutes": process.last.minutes,
        "statistics": card.statistics,
    }
    lines = [
        f"{out}: {card.kind}, {card.steps:,} steps in {process.last.minutes:.1f} min "
        f"({process.last.seconds:.0f} s of processor time), learned from {len(card.takes)} takes, "
        f"{len(card.held_out)} held out" + (", stopped" if stopped else "")
    ]
    lines += [f"  {name}: {value:.4g}" for name, value in card.statistics.items()]
    if stopped:
        lines.append("to continue, add --resume")
    else:
        lines.append(f"to continue it later, keep {find_training_folder(out)}")
    say(options, "\n".join(lines), data)
    return 0


def _begin(options: Namespace) -> None:
    """Read the takes and write the training's folder. Raises ValueError if that would lose something."""
    from app.cli.generate_takes import read_all
    from metagraph.generation.takes import split_takes
    from metagraph.generation.train_plan import (
        PLAN,
        choose_settings,
        find_training_folder,
        plan_of,
        write_training,
    )

    out: Path = options.out
    if not options.takes:
        raise ValueError("give takes to learn from, or --resume to continue")
    if out.exists() or (find_training_folder(out) / PLAN).exists():
        what = out if out.exists() else find_training_folder(out)
        raise ValueError(f"{what} exists already: choose another name, or continue with --resume")
    tracks = 2 if options.two_tracks else 1
    batch = read_all(options, tracks=tracks)
    assert batch.rig is not None
    learned, held = split_takes(batch.takes)
    if options.mirror:
        learned = (*learned, *make_take_twins(batch, learned))
    plan = plan_of(
        batch.rig,
        learned,
        held,
        out,
        options.model,
        options.size,
        tracks,
        settings=choose_settings(options.loss, options.model),
        seed=options.seed,
        **_limits(options),
    )
    out.parent.mkdir(parents=True, exist_ok=True)
    write_training(find_training_folder(out), plan, learned, held)


def _limits(options: Namespace) -> dict[str, Any]:
    seconds = options.seconds or 0.0
    minutes = options.minutes if options.minutes is not None else 0.0 if seconds else MINUTES
    return {"minutes": minutes, "seconds": seconds, "threads": options.threads}


def _go_on(options: Namespace) -> None:
    """Set the new limits of a training that was stopped."""
    from msgspec.structs import replace

    from metagraph.generation.train_plan import find_training_folder, read_training_plan, write_plan

    folder = find_training_folder(options.out)
    plan = read_training_plan(folder)
    new = _limits(options)
    if options.minutes is None and options.seconds is None:
        new |= {"minutes": plan.minutes, "seconds": plan.seconds}
    write_plan(folder, replace(plan, out=str(options.out.resolve()), **new))


def make_take_twins(batch: TakeBatch, takes: Sequence[Take]) -> list[Take]:
    """Return takes' mirror twins. Raises TakeError."""
    from metagraph.generation.takes import mirror_take

    assert batch.rig is not None
    clips = {t.source.digests: c for t, c in zip(batch.takes, batch.clips, strict=True)}
    return [mirror_take(batch.rig, clips[t.source.digests], t) for t in takes]


def _trained(options: Namespace, out: Path) -> tuple[TrainingProcess, bool]:
    """Let a training run to its end, or until Ctrl+C or SIGTERM; return whether it was stopped."""
    from metagraph.generation.train_process import TrainingProcess

    process = TrainingProcess(out, _telling(options))
    asked: list[bool] = []

    def stop() -> None:
        asked.append(True)
        process.stop()

    with _on_stop(stop):
        try:
            process.wait()
        except BaseException:
            if process.running:
                process.kill()
            raise
    return process, bool(asked)


@contextmanager
def _on_stop(act: Callable[[], None]) -> Iterator[None]:
    """Act on Ctrl+C and SIGTERM instead of ending."""
    before = {n: signal.signal(n, lambda *_: act()) for n in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _telling(options: Namespace, prefix: str = "") -> Any:
    show = sys.stderr.isatty() and not options.json
    told = [0.0]

    def heard(event: TrainingEvent) -> None:
        if event.event == "note":
            print(f"note: {event.text}", file=sys.stderr)
        if event.event != "step" or options.json:
            return
        numbers = ", ".join(f"{n} {v:.3g}" for n, v in event.numbers.items() if n != "rate")
        words = f"{prefix}{100 * event.share:3.0f} %, step {event.step:,}: {numbers}"
        if show:
            print(f"\r{words[:110]:<110}", end="\n" if event.share >= 1 else "", file=sys.stderr, flush=True)
        elif monotonic() - told[0] > EVERY:
            told[0] = monotonic()
            print(words, file=sys.stderr, flush=True)

    return heard


def run_ablation(options: Namespace) -> int:
    """Train a model with one thing changed at a time, and compare."""
    import json

    from app.cli.command_output import say
    from app.cli.generate_judging import find_floor, read_manner
    from app.cli.generate_report import report_as_csv, report_as_data, report_as_text
    from app.cli.generate_takes import read_all
    from metagraph.formats.atomic import write_atomically
    from metagraph.formats.outputs import claim
    from metagraph.generation.features import count_audio
    from metagraph.generation.networks import make_sizes
    from metagraph.generation.take_files import find_takes
    from metagraph.generation.takes import split_takes
    from metagraph.research.generation import ablation
    from metagraph.research.generation.evaluation import HeldOut

    require_trainable(options)
    claim(options.out / "table.json", options.out / "table.csv")
    manner = read_manner(options)
    changes = choose_changes(options.change)
    tracks = 2 if options.two_tracks else 1
    batch = read_all(options, tracks=tracks)
    assert batch.rig is not None
    rig = batch.rig
    learned, held = split_takes(batch.takes)
    files, _ = find_takes(options.takes, [p for p in options.speech if p.is_dir()])
    sizes = make_sizes(options.model, options.size, rig.numbers, count_audio(options.model, tracks))
    done = ablation.ablate_model(
        options.out,
        lambda job: _train_one(options, rig, tracks, job),
        ablation.AblationMaterial(
            rig,
            learned,
            HeldOut(held, find_floor(options.floor, options.takes, held, rig)),
            {f.clip.stem: f for f in files},
            lambda: make_take_twins(batch, learned),
        ),
        ablation.AblationTraining(options.model, sizes, options.seconds, options.trainings),
        changes,
        manner,
        options.draws,
        lambda name: None if options.json else print(name, file=sys.stderr, flush=True),
    )
    said = {
        "model": f"{options.model}, {options.size}",
        "seconds": options.seconds,
        "trainings": options.trainings,
        "learned": len(learned),
        "held_out": len(held),
        "hours": round(sum(t.seconds for t in learned) / 3600, 3),
        "seeds": manner.seeds,
        "changes": {c.name: c.words for c in changes},
        "trained_now": list(done.ran),
        "kept": list(done.kept),
        "left_out": list(done.left),
    }
    data = report_as_data(done.rows, said)
    write_atomically(options.out / "table.json", (json.dumps(data, indent=1) + "\n").encode())
    write_atomically(options.out / "table.csv", report_as_csv(done.rows).encode())
    lines = [
        f"{said['model']}: {options.seconds:g} s of processor time each, {len(learned)} takes "
        f"({said['hours']:g} h), {len(held)} held out; {len(done.ran)} trained now, {len(done.kept)} kept",
        report_as_text(done.rows),
        *(f"  {c.name}: {c.words}" for c in changes if c.name not in done.left),
        *(f"  skipped, does not apply to this model: {name}" for name in done.left),
        f"written: {options.out / 'table.json'}, {options.out / 'table.csv'}",
    ]
    say(options, "\n".join(lines), data)
    return 0


def choose_changes(names: list[str] | None) -> list[Any]:
    """Return changes by name, the whole model always first. Raises ValueError."""
    from metagraph.research.generation.ablation import CHANGES, NAMES

    odd = next((n for n in names or () if n not in NAMES), None)
    if odd is not None:
        raise ValueError(f"there is no change '{odd}'; the changes are {', '.join(NAMES[1:])}")
    return [c for n, c in enumerate(CHANGES) if not n or names is None or c.name in names]


def _train_one(options: Namespace, rig: Any, tracks: int, job: AblationJob) -> None:
    """Train one model of an ablation, or continue a training that was cut short."""
    from msgspec.structs import replace

    from metagraph.errors import FileError
    from metagraph.generation.train_plan import (
        choose_settings,
        find_training_folder,
        plan_of,
        read_training_plan,
        write_plan,
        write_training,
    )
    from metagraph.generation.train_process import TrainingProcess

    folder = find_training_folder(job.out)
    plan = plan_of(
        rig,
        job.learned,
        job.held,
        job.out,
        job.kind,
        options.size,
        tracks,
        job.sizes,
        settings=replace(choose_settings(job.settings.get("loss"), job.kind), **job.settings),
        seed=job.seed,
        minutes=0.0,
        seconds=job.seconds,
        threads=options.threads,
    )
    try:
        same = read_training_plan(folder).fingerprint() == plan.fingerprint()
    except FileError:
        same = False
    if same:
        write_plan(folder, plan)  # whatever file the one that was there names
    else:
        write_training(folder, plan, job.learned, job.held)
    process = TrainingProcess(job.out, _telling(options, f"{job.out.stem}: "))
    try:
        process.wait()
    except BaseException:  # its checkpoint stays; the next run goes on from it
        if process.running:
            process.kill()
        raise
    shutil.rmtree(folder, ignore_errors=True)
