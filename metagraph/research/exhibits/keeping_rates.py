"""An exhibit about what was asked for and what was delivered: an hour of improvising beside its models, and
an hour of conversation beside its rates.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from math import sqrt

from metagraph.graph.conversation.model import SPOKEN, Spoken
from metagraph.graph.model import LAYERS, Layer, Markov, Project
from metagraph.playback.planner import make_plan
from metagraph.playback.planning import markov
from metagraph.playback.planning.choice import key32
from metagraph.research.exhibits.exhibit import ExhibitTable, MadeExhibit
from metagraph.research.exhibits.material import ExhibitMaterial, list_actors_rates, with_rates
from metagraph.research.exhibits.paper_planner import plan_as_in_paper
from metagraph.research.generation.planted_speech import make_planted_speech
from metagraph.speech.delivered import NAMES, Delivered, count_delivered
from metagraph.speech.drive import drive

HOUR = 3600.0  # seconds
TALK = 60.0  # seconds of a conversation
TALKS = (10, 60)
SEED = 7
NEAR = 2.0  # standard errors within which 95 of a hundred shares lie
EXPECTED = 1.0  # moves below which a share's error is not normal: those are not looked at


def exhibit_delivery(material: ExhibitMaterial) -> MadeExhibit:
    """What an hour of improvising and of conversation has, beside what was asked for."""
    project = material.project
    paper = plan_as_in_paper(project)
    improvised = [_improvised(paper, layer) for layer in LAYERS if project.graphs[layer].index]
    spoken = _spoken(project, TALKS[material.full])
    off = [z for row in spoken for z in (_errors(row[1], row[1].performed),)]
    near = sum(abs(z) <= NEAR for z in off)
    minutes = TALKS[material.full] * TALK / 60
    # Of a row's cells the second is how many were written, the fourth how many performed.
    wrote, played = (sum(int(row[place]) for row, _ in improvised) for place in (1, 3))
    says = [
        f"Of {wrote:,} acts that the models wrote {played:,} are performed; the others are what a longer "
        "clip before them covers. Their limbs are wishes, met where the stance has such a clip. What was "
        "written keeps to the matrix, what was performed does so only where the project has every limb in "
        "every stance.",
        f"Conversations: {near} of {len(off)} rates are performed within {NEAR:g} standard errors of what "
        "was asked. A clause counts as accompanied where its peak lies between a stroke and the end of its "
        "hold; those with a stroke of their own are told beside.",
    ]
    head = ("layer", "written", "shares near", "performed", "limb as written", "shares near, performed")
    columns = ("side", "what", "segments", "asked", "drawn", "performed", "errors off", "own strokes")
    told = [
        (
            side,
            NAMES[d.kind],
            f"{d.count}",
            f"{d.asked:.0%}",
            f"{d.drawn / d.count:.0%}",
            f"{d.performed / d.count:.0%}",
            f"{_errors(d, d.performed):+.1f}",
            f"{d.strokes / d.count:.0%}" if d.kind == "clause" else "",
        )
        for side, d in spoken
    ]
    return MadeExhibit(
        f"the project '{project.name}': an hour of each layer, and {minutes:g} minutes of made-up "
        "conversation with the rates of table 1",
        tuple(says),
        (
            ExhibitTable("An hour of improvising", head, tuple(row for row, _ in improvised)),
            ExhibitTable("Conversations", columns, tuple(told)),
        ),
        {
            "improvised": [numbers for _, numbers in improvised],
            "conversation": [
                [s, d.kind, d.count, d.asked, d.drawn, d.performed, d.strokes] for s, d in spoken
            ],
        },
    )


def _improvised(project: Project, layer: Layer) -> tuple[tuple[str, ...], dict[str, object]]:
    chain = markov.model(project, layer)
    plan = make_plan(project, HOUR, (), SEED).layers[layer]
    places = {state: n for n, state in enumerate(chain.states)}
    written = [m for m in plan.metas if m.written]
    asked = [places[m.request.limb or "both", m.request.kind] for m in written]
    last = {cue.meta: cue for cue in plan.cues}  # of a chain of transitions the one that arrives
    done = [last[m.key] for m in written if m.key in last]
    wanted = {m.key: m.request.limb for m in written}
    met = sum(cue.action.limb == wanted[cue.meta] for cue in done)
    played = [places.get((c.action.limb, c.action.kind), -1) for c in done]
    near, of = _near(chain, asked)
    kept, among = _near(chain, played)
    row = (
        layer,
        f"{len(written)}",
        f"{near} of {of}",
        f"{len(done)}",
        f"{met} ({met / len(done):.0%})" if done else "none",
        f"{kept} of {among}",
    )
    return row, {
        "layer": layer,
        "written": len(written),
        "performed": len(done),
        "limb": met,
        "near": [near, of],
        "performed near": [kept, among],
    }


def _near(chain: Markov, sequence: Sequence[int]) -> tuple[int, int]:
    """Return how many of a matrix's shares a sequence keeps to within `NEAR` errors, and of how many. -1: a
    state that the model does not have.
    """
    moves = Counter(pairwise(sequence))
    left = Counter(sequence[:-1])
    errors = [
        (moves[a, b] - left[a] * p) / sqrt(left[a] * p * (1 - p))
        for a, row in enumerate(chain.matrix)
        for b, p in enumerate(row)
        if 0 < p < 1 and left[a] * p > EXPECTED
    ]
    return sum(abs(z) <= NEAR for z in errors), len(errors)


def _spoken(project: Project, talks: int) -> list[tuple[str, Delivered]]:
    """Return what became of both sides' rates over several conversations."""
    sums: Counter[tuple[int, Spoken, str]] = Counter()
    rates = list_actors_rates()
    for n in range(talks):
        said = make_planted_speech(
            TALK, key32(SEED, "speech", f"{n}"), key32(SEED, "moves", f"{n}"), f"talk {n + 1}"
        )
        talk = with_rates(said.conversation, rates)
        for side in (0, 1):
            for d in count_delivered(talk, side, project, drive(talk, side, project)[1]):
                for name in ("count", "drawn", "performed", "strokes"):
                    sums[side, d.kind, name] += getattr(d, name)
    out = []
    for side, name in enumerate(("first", "second")):
        for kind in SPOKEN:
            count, *done = (sums[side, kind, n] for n in ("count", "drawn", "performed", "strokes"))
            if count:
                out.append((name, Delivered(kind, count, getattr(rates[side], kind), *done)))
    return out


def _errors(found: Delivered, times: int) -> float:
    """Return by how many standard errors of the rate asked a count is off."""
    p = found.asked
    return (times - found.count * p) / sqrt(found.count * p * (1 - p)) if 0 < p < 1 else 0.0
