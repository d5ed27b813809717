"""`metagraph motion-graph`: graphs over the frames of long takes, motion that goes with new speech, and how
well that works.
"""

from __future__ import annotations

import signal
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.cli.motion_graph_soft import add_soft_arguments, read_soft_wish
from app.cli.progress_line import ProgressLine
from app.cli.takes import (
    add_speech_arguments,
    match_speech,
    match_takes,
    read_given_files,
    read_side_speech,
    read_take_files,
)

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.graph.conversation.model import Segment
    from metagraph.motion.clip import Clip
    from metagraph.synthesis.graph import MotionGraph, Threshold
    from metagraph.synthesis.prosody_costs import SpokenTake
    from metagraph.synthesis.search.path_quality import PathQuality
    from metagraph.synthesis.search.relaxing import RelaxedAnswer
    from metagraph.synthesis.states import States

OUT = (".bvh", ".glb")
SPOKEN = ("clause", "response", "hesitation")


def add_arguments(parser: ArgumentParser) -> None:
    """Add the actions of `motion-graph`, each with its options."""
    actions = parser.add_subparsers(dest="action", metavar="action", required=True)

    def action(name: str, words: str, run: Any, speech: bool | None = False) -> ArgumentParser:
        out: ArgumentParser = actions.add_parser(
            name, help=words, description=words[:1].upper() + words[1:] + "."
        )
        out.add_argument(
            "takes",
            type=Path,
            nargs="+",
            help="clip files, folders of clips, or projects, all with the same skeleton",
        )
        out.add_argument("--json", action="store_true", help="print JSON for programs")
        if speech is not False:  # None: it may be given, and then its changes are key states too
            add_speech_arguments(out, required=bool(speech))
        out.set_defaults(run=run)
        return out

    built = action("build", "build the graph of takes, and describe it", build_and_print, speech=None)
    _graph_options(built)
    built.add_argument(
        "--keep",
        type=Path,
        metavar="FOLDER",
        help="save finished parts here, so that a stopped run can continue",
    )
    words = "compare graphs for k = 2, 3 and 4, with and without parts that cannot be reached"
    _graph_options(action("table", words, print_states, speech=None), k=False)
    _synthesize_options(
        action("synthesize", "make motion for speech from a motion graph", synthesize, speech=True)
    )
    words = "leave each take out once, make motion for its speech from the others, and count matches"
    _evaluate_options(action("evaluate", words, print_evaluation, speech=True))
    words = "count how often hands and head move with speech"
    action("co-occurrence", words, print_co_occurrence, speech=True)


def _graph_options(out: ArgumentParser, k: bool = True) -> None:
    """Add the options of a graph's transitions."""
    if k:
        out.add_argument(
            "--k",
            type=int,
            default=3,
            help="frames between two poses whose difference sets the threshold of transitions (default: 3)",
        )
    out.add_argument(
        "--level",
        type=float,
        default=0.95,
        help="quantile of those differences that is the threshold, 0 to 1 (default: 0.95)",
    )
    out.add_argument(
        "--keys",
        type=float,
        default=0.2225,
        help="share of frames that transitions may leave and enter (default: 0.2225)",
    )
    out.add_argument(
        "--most",
        type=int,
        help="keep only this many of the cheapest transitions of each frame (default: all)",
    )


def _synthesize_options(made: ArgumentParser) -> None:
    """Add the options of the speech, and of the search."""
    _graph_options(made)
    wanted = made.add_mutually_exclusive_group(required=True)
    wanted.add_argument(
        "--take",
        metavar="N",
        help="use the speech of this take (number from 1, or name) and leave its motion out",
    )
    wanted.add_argument("--new", type=Path, metavar="FILE", help="use the speech of this file")
    wanted.add_argument(
        "--again",
        type=Path,
        metavar="FILE",
        help="make the motion of a live session again, from the file of `live --keep`",
    )
    made.add_argument(
        "--start", type=float, default=0.0, help="second of the speech to start at (default: 0)"
    )
    made.add_argument(
        "-s",
        "--seconds",
        type=float,
        help="length in seconds (default: 15, or to the end of a shorter speech)",
    )
    made.add_argument(
        "--search",
        choices=("exact", "greedy"),
        default="exact",
        help="find the cheapest path, or a good one quickly (default: exact)",
    )
    made.add_argument(
        "--without",
        action="append",
        default=[],
        choices=(*SPOKEN, "idle", "peaks", "edges"),
        help="drop a constraint; edges: where segments begin and end, so that only their kinds count",
    )
    made.add_argument(
        "--strict",
        action="store_true",
        help="fail if the constraints cannot all be met, instead of dropping them one by one",
    )
    made.add_argument(
        "--free-jumps",
        action="store_true",
        help="put no limit on jumps, to study the jumps alone",
    )
    made.add_argument(
        "--tolerance",
        type=float,
        default=0.1,
        help="seconds by which starts, ends and stresses may be off (default: 0.1)",
    )
    made.add_argument("--seed", type=int, default=1, help="random seed of the greedy search (default: 1)")
    made.add_argument("-o", "--out", type=Path, required=True, help="the .bvh or .glb file to write")
    add_soft_arguments(made)


def _evaluate_options(tried: ArgumentParser) -> None:
    """Add the options of the searches."""
    _graph_options(tried)
    tried.add_argument("-o", "--out", type=Path, help="write every case to this .csv file")
    tried.add_argument(
        "--search",
        action="append",
        choices=("exact", "greedy"),
        help="evaluate this search only (default: both)",
    )
    tried.add_argument(
        "--quick", action="store_true", help="evaluate with all constraints only, not with each left out"
    )
    tried.add_argument(
        "--live",
        action="store_true",
        help="evaluate motion that is extended while it plays, for heard and for announced speech, instead",
    )
    tried.add_argument("--seed", type=int, default=1, help="random seed of the greedy search (default: 1)")
    add_soft_arguments(tried)


def run(options: Namespace) -> int:
    """Do the action that was asked for."""
    return int(options.run(options))


# --- what is given


def _heard(options: Namespace) -> tuple[States, list[int]]:
    """Return the states of takes, and those where what is heard changes; none without speech."""
    from metagraph.synthesis.constraints import find_change_states

    if not options.speech:
        return _states([c for _, c in read_take_files(options.takes)]), []
    clips, speech = match_speech(options)
    states = _states(clips)
    return states, list(find_change_states(states, speech))


@contextmanager
def _until_stopped() -> Iterator[Callable[[], bool]]:
    """Yield a function that says whether Ctrl+C was pressed, so that finished work can be kept."""
    stopped: list[int] = []
    before = signal.signal(signal.SIGINT, lambda *_: stopped.append(1))
    try:
        yield lambda: bool(stopped)
    finally:
        signal.signal(signal.SIGINT, before)


def _rates(clips: Sequence[Clip]) -> str:
    other = sum(abs(c.fps - 30) > 1e-6 for c in clips)
    return f"{other} of {len(clips)} takes were resampled to 30 frames a second" if other else ""


# --- what is done


def _states(clips: Sequence[Clip]) -> States:
    from metagraph.synthesis.states import read_states

    if note := _rates(clips):
        print(f"note: {note}", file=sys.stderr)
    return read_states(clips)


def _checked(options: Namespace) -> None:
    if not 0 < options.level < 1:
        raise ValueError(f"--level must be between 0 and 1, not {options.level:g}")
    if not 0 < options.keys <= 1:
        raise ValueError(f"--keys must be more than 0 and at most 1, not {options.keys:g}")
    if getattr(options, "k", 3) < 2:
        raise ValueError("--k must be at least 2, since consecutive frames set no useful threshold")
    if options.most is not None and options.most < 1:
        raise ValueError("--most must be at least 1")


def build_and_print(options: Namespace) -> int:
    """Build a graph; print its states, threshold and transitions."""
    from time import perf_counter

    from app.cli.command_output import say
    from metagraph.suggest.jumps.fits import fit_distributions
    from metagraph.synthesis.blocks import BlockMakers
    from metagraph.synthesis.graph import build_graph as build_graph
    from metagraph.synthesis.graph import find_largest_component, find_threshold
    from metagraph.synthesis.states import key_states

    _checked(options)
    states, heard = _heard(options)
    limit = find_threshold(states, options.k, options.level)
    begun = perf_counter()
    whole = build_graph(
        states,
        limit,
        key_states(states, options.keys, heard),
        options.most,
        False,
        ProgressLine(options, "Finding key states").tell,
        makers=BlockMakers(folder=options.keep),
    )
    graph = find_largest_component(whole)
    facts = {
        **_facts(whole, graph),
        "takes": len(states.starts) - 1,
        "seconds": round(perf_counter() - begun, 3),
        **_limits(limit),
        "fits": [asdict(f) for f in fit_distributions(limit.costs, limit.level)],
    }
    others = ", ".join(f"{f['name']} {f['limit']:.4g} m ({f['distance']:.3f})" for f in facts["fits"])
    words = (
        f"{facts['takes']} takes, {facts['states']:,} states, {facts['keys']:,} of them key states\n"
        f"threshold at k = {limit.k}, {limit.level:.0%}: {limit.limit:.4g} m by {facts['by']}, "
        f"{limit.observed:.4g} m observed\n"
        + (f"by distribution, nearest first (greatest difference of shares): {others}\n" if others else "")
        + f"{facts['transitions']:,} transitions; in the largest component {facts['kept']:,} states "
        f"({facts['kept'] / facts['states']:.0%}) "
        f"and {facts['kept_transitions']:,} transitions\nbuilt in {facts['seconds']:.2f} s"
    )
    say(options, words, facts)
    return 0


def _facts(whole: MotionGraph, kept: MotionGraph | None) -> dict[str, Any]:
    states, edges = kept.size if kept is not None else (0, 0)
    return {
        "states": len(whole.states),
        "keys": len(whole.keys),
        "transitions": len(whole.targets),
        "kept": states,
        "kept_transitions": edges,
    }


def _limits(limit: Threshold) -> dict[str, Any]:
    by = "Johnson's S_B" if limit.distribution is not None else "the observed differences"
    return {"k": limit.k, "level": limit.level, "limit": limit.limit, "observed": limit.observed, "by": by}


def print_states(options: Namespace) -> int:
    """Print states and edges for k = 2, 3 and 4, before and after what is not in the largest component is
    removed.
    """
    from app.cli.command_output import say
    from metagraph.synthesis.graph import build_graph as build_graph
    from metagraph.synthesis.graph import find_largest_component, find_threshold
    from metagraph.synthesis.states import SynthesisError, key_states

    _checked(options)
    states, heard = _heard(options)
    keys = key_states(states, options.keys, heard)
    rows, lines = (
        [],
        [
            f"{'k':<3}{'threshold':>11}{'observed':>11}{'states':>10}"
            f"{'edges':>14}{'kept states':>14}{'kept edges':>14}"
        ],
    )
    follows = int((~states.last).sum())
    for k in (2, 3, 4):
        limit = find_threshold(states, k, options.level)
        whole = build_graph(states, limit, keys, options.most, False, ProgressLine(options, f"k = {k}").tell)
        try:
            graph = find_largest_component(whole)
        except SynthesisError:
            graph = None
        f = {**_facts(whole, graph), **_limits(limit)}
        original = (
            int((graph.kept[:-1] & graph.kept[1:] & ~states.last[:-1]).sum()) if graph is not None else 0
        )
        f |= {"edges": f["transitions"] + follows, "kept_edges": f["kept_transitions"] + original}
        rows.append(f)
        lines.append(
            f"{k:<3}{limit.limit:>9.4g} m{limit.observed:>9.4g} m{f['states']:>10,}{f['edges']:>14,}"
            f"{f['kept']:>9,} {f['kept'] / f['states']:>4.0%}{f['kept_edges']:>14,}"
        )
    say(options, "\n".join(lines), rows)
    return 0


def synthesize(options: Namespace) -> int:
    """Write motion that goes with speech."""
    from app.cli.command_output import say
    from metagraph.graph.conversation.model import SOUNDS
    from metagraph.research.motion_graph.search_evaluation import cut_segments
    from metagraph.synthesis.assemble import assemble
    from metagraph.synthesis.constraints import find_change_states, find_heard_at
    from metagraph.synthesis.graph import build_graph as build_graph
    from metagraph.synthesis.graph import find_threshold
    from metagraph.synthesis.search.path_quality import measure_quality
    from metagraph.synthesis.search.relaxing import Constraints, Searching, answer_speech
    from metagraph.synthesis.search.ruled_search import FREE, JUMP_RULES
    from metagraph.synthesis.soft_constraints import SoftMaterial, make_soft_report
    from metagraph.synthesis.states import key_states

    _checked(options)
    if options.out.suffix not in OUT:
        raise ValueError(
            f"motion can be written as {' or '.join(OUT)}, not as '{options.out.suffix or options.out.name}'"
        )
    wish = read_soft_wish(options)
    clips, spoken, names = match_takes(options)
    if options.again is not None:
        return _again(options, clips, [one.segments for one in spoken])
    held_out = _take_number(options.take, names) if options.take is not None else None
    if held_out is None:
        new = _speech_of_file(options, needs_sound=bool(wish.loudness))
    else:
        new = spoken.pop(held_out)
        clips.pop(held_out)
    seconds = _seconds(options, new)
    speech = [one.segments for one in spoken]
    states = _states(clips)
    keys = key_states(states, options.keys, find_change_states(states, speech))
    graph = build_graph(states, find_threshold(states, options.k, options.level), keys, options.most)
    use = [k for k in SOUNDS if k not in options.without]
    asked = Constraints(
        options.tolerance,
        tuple(use),
        "peaks" not in options.without,
        "edges" not in options.without,
        FREE if options.free_jumps else JUMP_RULES,
    )
    soft = SoftMaterial(wish, states, clips, spoken, graph.threshold.limit).constraints(
        new, options.start, seconds, options.tolerance
    )
    found = answer_speech(
        graph,
        find_heard_at(states, speech),
        cut_segments(new.segments, options.start, seconds),
        seconds,
        asked,
        Searching(options.search, options.seed, options.strict),
        soft=soft,
    )
    path = found.path
    if words := found.words():
        print(f"note: {words}", file=sys.stderr)
    told = make_soft_report(soft, states, path, found.retiming)
    looks = measure_quality(states, path)
    clip = assemble(states, clips, path, options.out.stem, retiming=found.retiming)
    _write(options.out, clip)
    data = {
        "out": str(options.out),
        "seconds": seconds,
        "frames": clip.frames,
        **_path_facts(found, states, looks),
    }
    if wish.asks:
        data["beside"] = told.data()
    say(
        options,
        f"{options.out}: {seconds:.1f} s with {len(path.jumps)} transitions, cost {path.cost:.3g}, of "
        f"{data['takes']} takes; {looks.words()}" + (f"\n{told.told()}" if told.told() else ""),
        data,
    )
    return 0


def _take_number(take: str, names: list[str]) -> int:
    """Return the index of a take, given its name or its number from 1. Raises ValueError."""
    place = names.index(take) if take in names else int(take) - 1 if take.isdecimal() else -1
    if not 0 <= place < len(names):
        raise ValueError(
            f"there is no take '{take}'; the takes are {', '.join(names[:10])}, or 1 to {len(names)}"
        )
    return place


def _speech_of_file(options: Namespace, needs_sound: bool) -> SpokenTake:
    """Return the speech of the file that was named as new. Raises ValueError."""
    sound, transcript = (
        read_given_files(options, what).get(options.new.stem) for what in ("sounds", "transcripts")
    )
    if needs_sound and sound is None:
        raise ValueError(f"no sound for {options.new.name}: --sounds has none with this name")
    return read_side_speech(options.new, options.side, sound, transcript)


def _seconds(options: Namespace, new: SpokenTake) -> float:
    """Return the length of the motion in seconds. Raises FileError, ValueError."""
    from metagraph.errors import FileError
    from metagraph.research.motion_graph.search_evaluation import WINDOW

    end = max((s.end for s in new.segments), default=0.0)
    if options.start < 0 or (options.start >= end and options.seconds is None):
        place = options.new or Path(options.take)
        raise FileError(
            place,
            f"its speech lasts from 0 to {end:.1f} s",
            "",
            "Choose a --start within the speech, or give --seconds.",
        )
    seconds: float = min(WINDOW, end - options.start) if options.seconds is None else options.seconds
    if not 0 < seconds <= 3600:
        raise ValueError("--seconds must be more than 0 and at most 3600")
    return seconds


def _path_facts(found: RelaxedAnswer, states: States, looks: PathQuality) -> dict[str, Any]:
    """Return data on a path that was found, for programs."""
    path = found.path
    return {
        "transitions": len(path.jumps),
        "cost": path.cost,
        "price": path.price,
        "takes": len({states.take(int(s)) for s in path.states}),
        "given_up": list(found.given_up),
        "misses": [asdict(m) for m in found.misses],
        "distinct": looks.distinct,
        "repeated": looks.repeated,
        "rest": looks.frozen,
        "rest_of_takes": looks.source,
        "stands_still": looks.stands_still,
    }


def _write(path: Path, clip: Clip) -> None:
    from metagraph.formats.bvh.file import write_bvh
    from metagraph.formats.gltf.writer import write_glb

    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix == ".bvh":
        write_bvh(clip, path)
    else:
        write_glb(path, [clip])


def _again(options: Namespace, clips: list[Clip], speech: list[tuple[Segment, ...]]) -> int:
    """Write the last motion of a live session once more."""
    from app.cli.command_output import say
    from metagraph.live.graph_motion import make_live_graph
    from metagraph.live.kept_motion import read_kept, remake_motion

    kept = read_kept(options.again)[-1]
    graph = make_live_graph(clips, speech, options.k, options.level, options.keys, options.most)
    clip = remake_motion(graph, kept, options.out.stem)
    _write(options.out, clip)
    data = {"out": str(options.out), "seconds": clip.duration, "frames": clip.frames, "begun": kept.begun}
    say(options, f"{options.out}: {clip.duration:.1f} s, from {kept.begun:.1f} s of the session on", data)
    return 0


def print_evaluation(options: Namespace) -> int:
    """Print for each setting how much held-out speech finds motion."""
    from app.cli.command_output import say
    from metagraph.formats.atomic import write_atomically
    from metagraph.research.motion_graph.evaluation_table import format_cases_as_csv, format_cases_as_text
    from metagraph.research.motion_graph.search_evaluation import SETTINGS, Beside, GraphMaking, Trials
    from metagraph.research.motion_graph.search_evaluation import evaluate_search as run

    _checked(options)
    wish = read_soft_wish(options)
    clips, spoken, _ = match_takes(options)
    if note := _rates(clips):
        print(f"note: {note}", file=sys.stderr)
    if options.live:
        return _evaluate_live(options, clips, [one.segments for one in spoken])
    with _until_stopped() as stopped:
        found = run(
            clips,
            [one.segments for one in spoken],
            SETTINGS[:1] if options.quick else SETTINGS,
            Trials(options.search or ("greedy", "exact"), seed=options.seed),
            GraphMaking(options.k, options.level, options.keys, options.most),
            ProgressLine(options, "Measuring cases").tell,
            stopped,
            Beside(wish, spoken),
        )
    if options.out is not None:
        write_atomically(options.out, format_cases_as_csv(found.cases).encode())
    data = {
        "rows": [asdict(r) for r in found.rows],
        "graphs": [asdict(g) for g in found.graphs],
        "cases": len(found.cases),
        "whole": found.whole,
    }
    say(options, format_cases_as_text(found) + (f"\n{options.out}" if options.out is not None else ""), data)
    return 0 if found.whole else 3


def _evaluate_live(options: Namespace, clips: list[Clip], speech: list[tuple[Segment, ...]]) -> int:
    """Print how well motion that is extended while it plays follows speech that becomes known in pieces."""
    from app.cli.command_output import say
    from metagraph.research.motion_graph.extending_evaluation import (
        format_rows_as_text,
        hold_out_takes,
        score_extending,
    )

    graphs = hold_out_takes(clips, speech, options.k, options.level, options.keys, options.most)
    rows = list(
        score_extending(graphs, seed=options.seed, progress=ProgressLine(options, "Playing drives").tell)
    )
    say(options, format_rows_as_text(rows), [asdict(r) for r in rows])
    return 0


def print_co_occurrence(options: Namespace) -> int:
    """Print how often each kind of segment comes with which movement, and how often by chance."""
    from app.cli.command_output import say
    from metagraph.synthesis.cooccurrence import count_cooccurrence as count

    clips, speech = match_speech(options)
    rows = count(clips, speech)
    lines = [f"{'':<34}{'matched':>8}{'total':>7}{'rate':>7}  {'95 %':<13}{'chance':>7}"]
    for r in rows:
        rates = (
            f"{r.rate:>7.0%}  {f'{r.low:.0%} to {r.high:.0%}':<13}{r.chance:>7.0%}"
            if r.total
            else f"{'-':>7}"
        )
        lines.append(f"{r.hypothesis:<34}{r.matched:>8}{r.total:>7}{rates}")
    say(options, "\n".join(lines), [asdict(r) for r in rows])
    return 0
