"""Exhibits of the meta-graph paper about planning: temporal replanning, sampling, variation, what follows
what.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import sqrt

from metagraph.graph.edits import set_settings
from metagraph.graph.model import Layer, Project, Settings
from metagraph.playback.learning.compare import compute_stationary_shares
from metagraph.playback.plan import Cue, MetaAction, MetaRequest
from metagraph.playback.planner import extend_plan, make_plan
from metagraph.playback.planning.choice import key32
from metagraph.playback.planning.markov import ARMS, write
from metagraph.playback.planning.replan import replan
from metagraph.research.exhibits import drawings
from metagraph.research.exhibits.exhibit import ExhibitDrawing, ExhibitTable, MadeExhibit
from metagraph.research.exhibits.material import ExhibitMaterial
from metagraph.research.exhibits.paper_planner import plan_as_in_paper
from metagraph.research.exhibits.published import ALPHA, FIGURE_11, STATES

DRAWS = (600, 6000)  # of figure 7's formula
MOVES = (20_000, 400_000)  # of figure 11's chain
SEEDS = (20, 100)  # of figure 9
COUNTS = range(1, 31)  # denominators that could give a row of figure 11
Case = tuple[str, Sequence[MetaAction], Sequence[MetaAction], str]


def exhibit_replanning(material: ExhibitMaterial) -> MadeExhibit:
    """Figure 6: meta actions that may clash, and the plan that does not."""
    cases: list[Case] = []

    def case(words: str, metas: Sequence[MetaAction]) -> None:
        placed, reports = replan(metas, Settings())
        cases.append((words, metas, placed, "; ".join(f"{r.request} {r.message}" for r in reports)))

    case("nothing clashes", [_meta("a", 0.5, 2), _meta("b", 3, 4.5)])
    case("as important: the later waits", [_meta("a", 0.5, 3), _meta("b", 2, 3.5)])
    case("cut, and goes on", [_meta("long", 0.5, 5, resume=True), _meta("short", 2, 3, 3)])
    case("cut, and its rest dropped", [_meta("long", 0.5, 5), _meta("short", 2, 3, 3)])
    case("no time left to wait", [_meta("a", 0.5, 6), _meta("b", 1, 2)])
    rows = [(w, _told(asked), _told(plan), words or "as asked") for w, asked, plan, words in cases]
    stretches = []
    for n, (_, asked, plan, _) in enumerate(cases, 1):
        for meta in asked:
            stretches.append((f"{n}: asked", [_bar("s3" if meta.request.priority > 1 else "s4", meta)]))
        stretches.append((f"{n}: meta plan", [_bar("ours", m) for m in plan]))
    kept = _kept(material.project)
    says = [
        "Placed greedily by start, then priority, as the paper says. What it leaves open: two that are as "
        f"important do not cut each other, the later waits, up to {Settings().wait:g} s; a remainder under "
        f"{Settings().shortest:g} s is dropped.",
        kept,
    ]
    drawn = drawings.draw_spans(stretches, 7.0, "Five cases of temporal replanning")
    return MadeExhibit(
        f"five cases written for this, and the project '{material.project.name}' for the running action",
        tuple(says),
        (
            ExhibitDrawing("Asked (brown: more important) and planned (green), in the table's order", drawn),
            ExhibitTable("The cases in words", ("case", "asked, s", "planned, s", "told"), tuple(rows)),
        ),
        {"cases": [[w, _told(a), _told(p)] for w, a, p, _ in cases]},
    )  # fmt: skip


def _kept(project: Project) -> str:
    """Say whether a running action stays as it was when more is asked for."""
    layer = _layer(project)
    if layer is None:
        return "The project has no gestures, so a running action could not be looked at."
    asked = [MetaRequest("old", layer, "gesture", 1.0), MetaRequest("later", layer, "gesture", 9.0)]
    before = make_plan(project, 14.0, asked, 1, idle=False)
    now = before.layers[layer].cues[0].start + 0.2
    new = MetaRequest("new", layer, "gesture", now, priority=5)
    after = extend_plan(project, before, now, [new], 14.0, idle=False)
    first, *rest = after.layers[layer].cues
    same = first == before.layers[layer].cues[0]
    names = ", ".join(f"'{c.meta}' at {c.start:.2f} s" for c in rest)
    return (
        f"Asked for at {now:.2f} s, with priority 5, while '{first.meta}' plays: the running action is "
        + ("left as it was" if same else "CHANGED")
        + f", then {names}."
    )


def exhibit_sampling(material: ExhibitMaterial) -> MadeExhibit:
    """Figure 7's three cases, and the formula under it."""
    project = material.project
    layer = _layer(project)
    if layer is None:
        return MadeExhibit(
            f"the project '{project.name}'", missing="it has no gestures: nothing can be sampled"
        )
    graph = project.graphs[layer]
    stance = graph.start or next(iter(graph.stances))
    some = graph.of(stance, "gesture")
    longest = max(project.span(a)[1] - project.span(a)[0] for a in some)
    shortest = min(project.span(a)[1] - project.span(a)[0] for a in some)
    middle = round((shortest + longest) / 2, 2)
    cases = [
        (
            "1: ends before its meta action",
            [_ask("long", layer, 1.0, longest + 3), _ask("next", layer, longest + 5, 1.0)],
        ),
        (
            "2: must end before one of higher priority",
            [_ask("low", layer, 1.0, 2.0), _ask("high", layer, 1.0 + middle, 1.0, 5)],
        ),
        (
            "2: nothing fits",
            [_ask("low", layer, 1.0, 2.0), _ask("high", layer, 1.0 + max(0.1, shortest / 2), 1.0, 5)],
        ),
        (
            "3: wholly covered by what plays",
            [
                _ask("first", layer, 1.0, 0.5),
                _ask("covered", layer, 1.6, 0.2),
                _ask("next", layer, longest + 3, 1.0),
            ],
        ),
    ]
    lanes, rows = [], []
    until = 2 * longest + 7
    for n, (words, asked) in enumerate(cases, 1):
        plan = make_plan(project, until, asked, 1, {layer: stance}, idle=False)
        cues = plan.layers[layer].cues
        told = "; ".join(f"{r.request}: {r.message}" for r in plan.reports if r.layer == layer)
        for r in asked:
            css = "s3" if r.priority > 1 else "s4"
            lanes.append((f"{n}: asked", [(css, r.start, r.start + (r.duration or 1.0), r.id)]))
        lanes.append((f"{n}: plays", [("ours", c.start, c.end, c.meta) for c in cues]))
        rows.append(
            (words, ", ".join(f"{c.meta} {c.start:.2f}-{c.end:.2f}" for c in cues), told or "all play")
        )
    table, off, drawn = _formula(project, layer, stance, DRAWS[material.full])
    says = (
        "Ours differs in two things: a request that comes to nothing says why; and a gesture may be left "
        "early where its timing allows, so that more fit before something important.",
        f"The formula: each of {drawn:,} draws had chances by p = (1 / max(c, 1)) / sum, c growing by "
        f"{ALPHA:g} with each use. Drawn and expected counts differ by chi-square {off[0]:.1f} at {off[1]} "
        f"degrees of freedom (about {off[1]} to be expected by chance, {off[1] + 3 * sqrt(2 * off[1]):.0f} "
        "would be odd).",
    )
    return MadeExhibit(
        f"the project '{project.name}', stance '{graph.stances[stance].name}': {len(some)} gestures",
        says,
        (
            ExhibitDrawing(
                "Meta actions (brown: more important) and what plays (green), in the order of the table",
                drawings.draw_spans(lanes, until, "Three cases"),
            ),
            ExhibitTable("The cases in words", ("case", "plays, s", "told"), tuple(rows)),
            table,
        ),
        {"chi-square": off[0], "degrees": off[1], "draws": drawn},
    )


def _formula(
    project: Project, layer: Layer, stance: str, draws: int
) -> tuple[ExhibitTable, tuple[float, int], int]:
    """Return how often candidates were drawn that had been used less or more than others, chi-square with its
    degrees of freedom, and how many draws.
    """
    plain = set_settings(plan_as_in_paper(project), never_twice=False, memory=0.0, alpha=ALPHA)
    limbs = [
        a.id for a in plain.graphs[layer].of(stance, "gesture") if a.spacing is None and a.cooldown <= 0
    ][:6]
    if len(limbs) < 2:
        return ExhibitTable("The formula", ("candidates",), ((str(len(limbs)),),)), (0.0, 0), 0
    likely = {a.id: a.likelihood for a in plain.graphs[layer].actions.values() if a.id in limbs}
    expected, seen, done = [0.0] * 4, [0] * 4, 0
    for run in range(draws // 20):
        asked = [replace(_ask(f"{run}/{n}", layer, 20.0 * n, 1.0), among=tuple(limbs)) for n in range(20)]
        plan = make_plan(plain, 410.0, asked, key32(7, str(run)), {layer: stance}, idle=False)
        uses = Counter[str]()
        for cue in plan.layers[layer].cues:
            if cue.stance != stance or cue.action.id not in limbs:
                continue
            weights = {i: likely[i] / max(ALPHA * uses[i], 1.0) for i in limbs}
            total, least = sum(weights.values()), min(uses[i] for i in limbs)
            for i in limbs:
                expected[min(uses[i] - least, 3)] += weights[i] / total
            seen[min(uses[cue.action.id] - least, 3)] += 1
            uses[cue.action.id] += 1
            done += 1
    keys = [k for k in range(4) if expected[k] >= 5]
    chi = sum((seen[k] - expected[k]) ** 2 / expected[k] for k in keys)
    rows = tuple(
        (f"{k} more than the least used" if k < 3 else "3 or more", f"{expected[k]:.1f}", f"{seen[k]}")
        for k in keys
    )
    words = f"{len(limbs)} candidates, {done:,} draws: how often one was drawn that had been used so often"
    return (
        ExhibitTable(words, ("uses", "expected by the formula", "drawn"), rows),
        (chi, max(1, len(keys) - 1)),
        done,
    )


def exhibit_variation(material: ExhibitMaterial) -> MadeExhibit:
    """Figures 9 and 12: the same abstract sequence, and none at all, performed again and again."""
    project = material.project
    layer = _layer(project)
    if layer is None:
        return MadeExhibit(f"the project '{project.name}'", missing="it has no gestures: nothing varies")
    seeds = SEEDS[material.full]
    asked = [_ask(f"gesture {n}", layer, 1.0 + 5.0 * n, 2.0) for n in range(8)]
    paper = plan_as_in_paper(project)
    plans = [make_plan(paper, 45.0, asked, s, idle=False) for s in range(1, seeds + 1)]
    alone = [make_plan(paper, 60.0, (), s) for s in range(1, seeds + 1)]
    rows, numbers = [], {}
    for words, some in (
        ("eight gestures asked for (figure 9)", plans),
        ("nothing asked for (figure 12)", alone),
    ):
        played = [[c.action.id for c in p.layers[layer].cues] for p in some]
        pairs = [(a, b) for k, a in enumerate(played) for b in played[k + 1 :]]
        alike = [
            sum(x == y for x, y in zip(a, b, strict=False)) / max(1, min(len(a), len(b))) for a, b in pairs
        ]
        again = [sum(x == y for x, y in pairwise(a)) for a in played]
        different = len({tuple(p) for p in played})
        used = len({i for p in played for i in p})
        share = sum(alike) / max(1, len(alike))
        rows.append((words, f"{different} of {seeds}", f"{share:.0%}", str(used), str(sum(again))))
        numbers[words] = {"different": different, "seeds": seeds, "alike": share, "used": used}
    lanes = [
        (
            f"seed {n + 1}",
            [(f"s{_colour(c)}", c.start, c.end, c.action.name[:14]) for c in p.layers[layer].cues],
        )
        for n, p in enumerate(plans[:5])
    ]
    head = (
        "",
        "different sequences",
        "the same at the same place",
        "actions used",
        "the same twice in a row",
    )
    return MadeExhibit(
        f"the project '{project.name}', layer {layer}, seeds 1 to {seeds}",
        (
            "The paper shows three pictures and claims that performances differ; here it is counted. The "
            "same seed gives the same performance in every runtime.",
        ),
        (
            ExhibitTable("How much performances differ", head, tuple(rows)),
            ExhibitDrawing(
                "The same eight requests with five seeds",
                drawings.draw_spans(lanes, 45.0, "Five performances"),
            ),
        ),
        numbers,
    )


def exhibit_matrix(material: ExhibitMaterial) -> MadeExhibit:
    """Figure 11: the published matrix, and how often ours does what."""
    until = MOVES[material.full] * (ARMS.gap + 2.0)
    states = {s: n for n, s in enumerate(ARMS.states)}
    written, _ = write(ARMS, 11, until)
    sequence = [states[m.request.limb or "both", m.request.kind] for m in written]
    count = len(STATES)
    moves = [[0] * count for _ in range(count)]
    for a, b in pairwise(sequence):
        moves[a][b] += 1
    rows, worst, ours = [], 0.0, []
    for n, row in enumerate(moves):
        left = sum(row)
        shares = [v / left if left else 0.0 for v in row]
        ours.append(shares)
        for j, share in enumerate(shares):
            p = ARMS.matrix[n][j]
            if 0 < p < 1 and left:
                worst = max(worst, abs(share - p) / sqrt(p * (1 - p) / left))
        cells = [
            f"{FIGURE_11[n][j]:g} / {100 * shares[j]:.1f}" if FIGURE_11[n][j] or row[j] else "0"
            for j in range(count)
        ]
        rows.append((STATES[n], *cells))
    forbidden = sum(moves[i][j] for i in range(count) for j in range(count) if not FIGURE_11[i][j])
    least = [find_fewest_transitions(row) for row in FIGURE_11]
    long_run = compute_stationary_shares(ARMS.matrix)
    says = [
        f"{len(sequence):,} actions written by the model that ships: no share is off the published one by "
        f"more than {worst:.1f} standard deviations (81 are looked at), and what has 0 % never came "
        f"({forbidden}).",
        "Rounded in print, three rows sum to 99.9 or 100.1 %; ours sum to 1. The percentages are fractions "
        f"of {', '.join(map(str, least))}: the whole matrix can come of {sum(least)} transitions, 'R, T "
        "then L, T 100 %' of a single one. It is an example, as the paper says, not how people are.",
        "In the long run: "
        + ", ".join(
            f"{s} {p:.0%}" for s, p in sorted(zip(STATES, long_run, strict=True), key=lambda x: -x[1])
        )
        + ".",
    ]
    grids = {
        "there": ("paper", [[v / 100 for v in row] for row in FIGURE_11]),
        "here": ("ours", ours),
    }
    return MadeExhibit(
        "the published matrix, which ships as the arms' default model",
        tuple(says),
        (
            ExhibitDrawing(
                "Rows: now; columns: next", drawings.draw_heat(STATES, grids, "Figure 11 and ours")
            ),
            ExhibitTable("Percent there / here", ("", *STATES), tuple(rows)),
        ),
        {"moves": len(sequence) - 1, "worst": worst, "least": least},
    )


def find_fewest_transitions(row: Sequence[float]) -> int:
    """Return the fewest transitions that round to a row of percentages: to one place, or to whole numbers and
    halves where they are.
    """
    for n in COUNTS:
        if all(abs(round(v * n / 100) * 100 / n - v) <= 0.051 for v in row):
            return n
    return 0


# --- pieces


def _meta(ident: str, start: float, end: float, priority: int = 1, resume: bool = False) -> MetaAction:
    request = MetaRequest(ident, "arms", "gesture", start, end - start, priority=priority, resume=resume)
    return MetaAction(request, start, end)


def _ask(ident: str, layer: Layer, start: float, duration: float, priority: int = 1) -> MetaRequest:
    return MetaRequest(ident, layer, "gesture", start, duration, priority=priority)


def _told(metas: Sequence[MetaAction]) -> str:
    return ", ".join(f"{m.key} {m.start:g}-{m.end:g}" for m in metas)


def _bar(css: str, meta: MetaAction) -> tuple[str, float, float, str]:
    return css, meta.start, meta.end, meta.key


def _colour(cue: Cue) -> int:
    return key32(3, cue.action.id) % 11


def _layer(project: Project) -> Layer | None:
    """Return the layer whose start stance has most gestures."""
    best: tuple[int, Layer] | None = None
    for layer, graph in project.graphs.items():
        stance = graph.start or next(iter(graph.stances), "")
        count = len(graph.of(stance, "gesture")) if graph.of(stance, "stance") else 0
        if count and (best is None or count > best[0]):
            best = count, layer
    return None if best is None else best[1]
