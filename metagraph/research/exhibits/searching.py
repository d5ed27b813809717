"""Exhibits of the conversation paper about the search: what it finds, how often, and where constraints
compete.
"""

from __future__ import annotations

from dataclasses import dataclass
from statistics import fmean, median

import msgspec

from metagraph.graph.conversation.model import Conversation, Segment, Side, list_segments_heard_by
from metagraph.graph.model import Project
from metagraph.playback.planning.choice import key32
from metagraph.research.exhibits import drawings
from metagraph.research.exhibits.exhibit import ExhibitDrawing, ExhibitTable, MadeExhibit
from metagraph.research.exhibits.material import (
    SEED,
    ExhibitActor,
    ExhibitMaterial,
    find_side_motion,
    list_actors_rates,
    with_rates,
)
from metagraph.research.exhibits.published import CASES, FOUND, FOUND_WITHOUT_HESITATION, SAVED
from metagraph.research.generation.planted_speech import make_planted_speech
from metagraph.research.motion_graph.search_evaluation import (
    SETTINGS,
    WINDOW,
    EvaluationRow,
    cut_segments,
    evaluate_search,
)
from metagraph.synthesis.constraints import find_change_states, find_heard_at, list_wanted
from metagraph.synthesis.cooccurrence import compute_wilson_interval
from metagraph.synthesis.graph import build_graph
from metagraph.synthesis.search.path_quality import measure_quality
from metagraph.synthesis.search.ruled_search import FREE, JUMP_RULES, find_path
from metagraph.synthesis.states import SynthesisError, key_states, read_states

ALL = "all constraints"
QUICK = (ALL, "without hesitation", "free jumps")
COMPETE = (ALL, "without clause", "without response", "without hesitation", "without edges", "no constraints")
TRIED = (20, 200)  # seeds of the greedy search
JOINED = 0.7  # seconds: gaps between a side's clauses that are closed where clauses adjoin


def exhibit_search(material: ExhibitMaterial) -> MadeExhibit:
    """Figure 5: what the stochastic search finds with one seed and another, beside the best there is."""
    actor = material.actors[0]
    if len(actor.clips) < 2:
        return MadeExhibit(material.about, missing="one take alone cannot be held out: give two or more")
    clips, said = actor.clips[1:], actor.speech[1:]
    states = read_states(clips)
    try:
        graph = build_graph(states, keys=key_states(states, changes=find_change_states(states, said)))
    except SynthesisError as error:
        return MadeExhibit(material.about, missing=str(error))
    length = min(WINDOW, actor.clips[0].duration)
    asked = list_wanted(cut_segments(actor.speech[0], 0.0, length), length)
    sound = find_heard_at(states, said)
    rows, numbers = [], {}
    bars: list[tuple[str, list[drawings.Bar]]] = []
    for words, rules in (("the paper's costs", FREE), ("with prices for jumps", JUMP_RULES)):
        costs, jumps, again = [], [], []
        count = TRIED[material.full]
        for seed in range(1, count + 1):
            try:
                path = find_path(graph, sound, asked, "greedy", rules, seed)
            except SynthesisError:
                continue
            looks = measure_quality(states, path)
            costs.append(path.price)
            jumps.append(looks.jumps)
            again.append(looks.repeated)
        found = f"{len(costs)} of {count}"
        if costs:
            rows.append(
                (
                    words,
                    "by chance",
                    found,
                    f"{median(costs):.3g}",
                    f"{min(costs):.3g}",
                    f"{fmean(jumps):.2f}",
                    f"{fmean(again):.0%}",
                )
            )
            bars.append((f"{words}, median", [("paper", median(costs), min(costs), max(costs))]))
        else:
            rows.append((words, "by chance", found, "-", "-", "-", "-"))
        try:
            path = find_path(graph, sound, asked, "exact", rules)
            looks = measure_quality(states, path)
            cells = (f"{path.price:.3g}", f"{path.price:.3g}", f"{looks.jumps:.2f}", f"{looks.repeated:.0%}")
            rows.append((words, "the best", "1 of 1", *cells))
            bars.append((f"{words}, best", [("ours", path.price, None, None)]))
            numbers[words] = {"greedy": costs, "exact": path.price, "rest": looks.frozen}
        except SynthesisError as error:
            rows.append((words, "the best", f"none: {error}"[:70], "-", "-", "-", "-"))
            numbers[words] = {"greedy": costs, "exact": None}
    says = (
        f"Segment by segment, the {SAVED} cheapest candidates kept, each seed another random set to start "
        "from: the paper's search. It returns a path or none, and cannot say whether there is one.",
        "'The best' is dynamic programming over all frames: it finds a path whenever there is one, and "
        "none costs less.",
    )
    head = ("cost", "search", "found", "median cost", "least", "jumps a second", "shown again")
    drawn = drawings.draw_paired_bars(
        bars, (("paper", "by chance, least to most"), ("ours", "the best")), "cost", "Costs of paths"
    )
    return MadeExhibit(
        f"{material.about} ({actor.name}; the first take's first {length:g} s from the others)",
        says,
        (
            ExhibitTable("One window of speech", head, tuple(rows)),
            ExhibitDrawing("Costs of what was found", drawn),
        ),
        numbers,
    )


def exhibit_success(material: ExhibitMaterial) -> MadeExhibit:
    """Section 8.1: each take held out, its speech asked of all others."""
    rows: list[tuple[str, ...]] = [
        _published("there: all constraints", FOUND),
        _published("there: without hesitation", FOUND_WITHOUT_HESITATION),
    ]
    bars = [
        ("all, there", [_bar("paper", FOUND)]),
        ("without hesitation, there", [_bar("paper", FOUND_WITHOUT_HESITATION)]),
    ]
    numbers = {}
    for n, actor in enumerate(material.actors, 1):
        if len(actor.clips) < 2:
            material.notes.append(f"{actor.name} has one take: nothing can be held out")
            continue
        done = evaluate_search(actor.clips, actor.speech, [s for s in SETTINGS if s.name in QUICK])
        rows += [_row(f"here, {actor.name}", r) for r in done.rows]
        for r in done.rows:
            numbers[f"{actor.name}, {r.setting}, {r.search}"] = [
                r.found,
                r.cases,
                r.per_second,
                r.repeated,
                r.rest,
            ]
            if r.setting in QUICK[:2]:
                css = "ours" if r.search == "exact" else "s9"
                words = r.setting.removesuffix(" constraints")
                bars.append((f"{words}, {r.search}, {n}", [(css, r.success, r.low, r.high)]))
    if not numbers:
        return MadeExhibit(material.about, missing="nobody has two takes: nothing can be held out")
    says = (
        f"The paper found motion for {FOUND} of {CASES} windows with its search; whether the others had any "
        "it could not know. 'exact' finds it wherever there is some.",
        "A path that stands still longer than its takes ever do counts as not found here. 'free jumps' is "
        "the paper's cost, in which a jump costs nothing where a pose resembles itself.",
    )
    head = ("", "search", "found", "success", "95 %", "jumps a second", "shown again", "longest rest")
    drawn = drawings.draw_paired_bars(
        bars, (("paper", "there"), ("ours", "exact"), ("s9", "by chance")), "share of windows", "Success", 1.0
    )
    return MadeExhibit(
        material.about,
        says,
        (
            ExhibitTable("Windows of 15 s, every 14 s", head, tuple(rows)),
            ExhibitDrawing("Success with 95 % intervals; 1 and 2: the two here", drawn),
        ),
        numbers,
    )


def _published(words: str, found: int) -> tuple[str, ...]:
    low, high = compute_wilson_interval(found, CASES)
    return (
        words,
        "by chance",
        f"{found} of {CASES}",
        f"{found / CASES:.1%}",
        f"{low:.0%} to {high:.0%}",
        "not told",
        "not told",
        "not told",
    )


def _bar(css: str, found: int) -> tuple[str, float, float | None, float | None]:
    return css, found / CASES, *compute_wilson_interval(found, CASES)


def _row(words: str, r: EvaluationRow) -> tuple[str, ...]:
    looks = (f"{r.per_second:.2f}", f"{r.repeated:.0%}", f"{r.rest:.1f} s") if r.found else ("-", "-", "-")
    interval = f"{r.low:.0%} to {r.high:.0%}"
    return f"{words}: {r.setting}", r.search, f"{r.found} of {r.cases}", f"{r.success:.0%}", interval, *looks


# --- where constraints compete


@dataclass(frozen=True)
class Scarcity:
    """Made-up conversations in which there is less to choose from. adjoining: whether a side's clauses follow
    each other without a gap where the gap was short. rare: of so many responses and hesitations one is left.
    """

    name: str
    count: int
    seconds: float
    adjoining: bool = False
    rare: int = 1


SCARCE: tuple[Scarcity, ...] = (
    Scarcity("enough", 6, 45.0),
    Scarcity("few takes", 3, 45.0),
    Scarcity("short takes", 6, 16.0),
    Scarcity("adjoining clauses", 4, 45.0, adjoining=True),
    Scarcity("rare answers", 4, 45.0, rare=4),
    Scarcity("all of it", 3, 30.0, adjoining=True, rare=4),
)


def exhibit_competing(material: ExhibitMaterial) -> MadeExhibit:
    """Where success is below 100 %: fewer and shorter takes, adjoining clauses, rarer kinds."""
    rows: list[tuple[str, ...]] = []
    bars, numbers, odd = [], {}, []
    names = COMPETE if material.full else (ALL, "without clause")
    settings = [s for s in SETTINGS if s.name in names]
    for scarcity in SCARCE:
        actor = make_scarce_takes(material.project, scarcity, 2 if material.full else 1)
        done = evaluate_search(actor.clips, actor.speech, settings)
        by = {(c.take, c.start, c.setting, c.search): c for c in done.cases}
        odd += [k for k, c in by.items() if k[3] == "greedy" and c.found and not by[(*k[:3], "exact")].found]
        rows += [_row(scarcity.name, r) for r in done.rows]
        numbers[scarcity.name] = {
            f"{r.setting}, {r.search}": [r.found, r.cases, r.per_second, r.repeated, r.rest]
            for r in done.rows
        }
        both = [r for r in done.rows if r.setting == ALL]
        bars.append(
            (
                scarcity.name,
                [("ours" if r.search == "exact" else "s9", r.success, r.low, r.high) for r in both],
            )
        )
    tried = [
        (n, v[f"{ALL}, exact"][0], v[f"{ALL}, greedy"][0], v[f"{ALL}, exact"][1]) for n, v in numbers.items()
    ]
    below = [n for n, best, _, cases in tried if best < cases]
    better = [n for n, best, greedy, _ in tried if best > greedy]
    says = (
        "Takes in which all windows find motion show nothing. Here there are fewer takes, shorter ones, "
        "clauses without gaps between them, and answers so rare that some windows ask for what no other "
        "take has.",
        f"Below 100 % even where the best path is looked for: {', '.join(below) or 'none'}. Found by the "
        f"exact search and missed by the one by chance: {', '.join(better) or 'none'}; the other way round "
        f"{len(odd)} windows"
        + (", where the best path stands still and is not counted." if odd else ", as it must be."),
    )
    head = ("", "search", "found", "success", "95 %", "jumps a second", "shown again", "longest rest")
    drawn = drawings.draw_paired_bars(
        bars, (("ours", "exact"), ("s9", "by chance")), "share of windows", "Success", 1.0
    )
    return MadeExhibit(
        f"made-up conversations, performed by the project '{material.project.name}'; whoever made them made "
        "what is measured",
        says,
        (
            ExhibitTable("Scarce takes", head, tuple(rows)),
            ExhibitDrawing("Success with all constraints", drawn),
        ),
        numbers,
    )


def make_scarce_takes(project: Project, scarcity: Scarcity, sides: int = 2, seed: int = SEED) -> ExhibitActor:
    """Return takes of made-up conversations with less to choose from, of both sides or the first alone, as
    one actor's. Raises ValueError if the project cannot perform.
    """
    clips, speech = [], []
    rates = list_actors_rates()
    for n in range(scarcity.count):
        name = f"{scarcity.name} {n + 1}"
        spoken = make_planted_speech(
            scarcity.seconds, key32(seed, "scarce", str(n)), key32(seed, "scarce moves", str(n)), name
        )
        talk = with_rates(_scarcer(spoken.conversation, scarcity), (rates[0], rates[0]))
        for side in range(sides):
            clips.append(find_side_motion(project, talk, side))
            speech.append(list_segments_heard_by(talk, side))
    return ExhibitActor(scarcity.name, tuple(clips), tuple(speech))


def _scarcer(talk: Conversation, scarcity: Scarcity) -> Conversation:
    sides = []
    for side in talk.sides:
        seen = 0
        kept: list[Segment] = []
        for s in side.segments:
            if s.kind != "clause":
                seen += 1
                if (seen - 1) % scarcity.rare:
                    continue
            last = kept[-1] if kept else None
            close = scarcity.adjoining and last is not None and last.kind == s.kind == "clause"
            if close and last is not None and s.start - last.end < JOINED:
                kept[-1] = msgspec.structs.replace(last, end=s.start)
            kept.append(s)
        sides.append(msgspec.structs.replace(side, segments=tuple(kept)))
    made: tuple[Side, Side] = (sides[0], sides[1])
    return msgspec.structs.replace(talk, sides=made)
