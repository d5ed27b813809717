"""In C++ what is translated plays what it plays in Python."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.graph.model import Project, Settings
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.graphemes import read_aloud, spelled
from metagraph.playback.life.mouth import accents_of, mouth_track
from metagraph.playback.life.track import Track
from metagraph.playback.plan import LayerPlan, MetaAction, MetaRequest, Report
from metagraph.playback.planning import layer_planning, markov, replan
from metagraph.playback.planning.choice import key32
from tests.engines import cpp_program
from tests.engines.translation.in_cpp import (
    BUSY,
    LAYER_SEED,
    MOODS,
    SEED,
    TEXTS,
    UNTIL,
    kinds_of,
    layered,
    requests,
)

pytestmark = cpp_program.needs_compiler


def said_by(probe: Path, name: str) -> list[str]:
    """Return the lines that a program says."""
    return [line for line in cpp_program.ran(probe, name).stdout.splitlines() if line.strip()]


@pytest.mark.nightly
def test_in_cpp_letters_become_the_mouth_shapes_they_become_in_python(cpp_probe: Path) -> None:
    said = []
    for text in TEXTS:
        read = spelled(ALPHABET, text, 2.0)
        rows = mouth_track(read.pieces, 2.0)
        said.append(
            " ".join(["pieces", *(f"{p.viseme} {p.start:.6f} {p.strength:.6f}" for p in read.pieces)])
        )
        said.append(f"{sum(sum(row[10:]) for row in rows):.6f} {read_aloud(ALPHABET, text):.6f}")
        accents = accents_of(read.peaks, read.strengths)
        said.append(" ".join(["accents", *(f"{x:.6f}" for x in accents)]))
    assert said_by(cpp_probe, "letters") == said


@pytest.mark.nightly
def test_in_cpp_models_write_and_plans_are_made_anew_as_in_python(cpp_probe: Path) -> None:
    """The whole way through what is translated: draws, what a model writes, what replanning makes of it."""
    metas, cursor = markov.write(markov.ARMS, SEED, UNTIL)
    request = MetaRequest("wave", "arms", "gesture", 10.0, 8.0, priority=3)
    asked = [
        MetaAction(request, 10.0, 18.0),
        MetaAction(MetaRequest("nod", "arms", "fidget", 12.0), 12.0, 13.5),
    ]
    placed, reports = replan.replan([*metas, *asked], Settings(), BUSY)
    said = [f"{key32(SEED, 'a', 'ü')} {len(metas)} {cursor.number} {cursor.state} {cursor.time:.9f}"]
    said += [f"{m.key} {m.request.kind} {m.request.limb or '-'} {m.start:.9f} {m.end:.9f}" for m in placed]
    said += [f"{r.request} {r.outcome} {r.message}" for r in reports]
    assert said_by(cpp_probe, "replanned") == said


@pytest.mark.nightly
def test_in_cpp_a_layer_plays_what_it_plays_in_python(sample: Project, cpp_probe: Path) -> None:
    """An hour of the sample's arms: what the model writes, with requests of every kind between, each action,
    rest and report.
    """
    project = layered(sample)
    graph = project.graphs["arms"]
    kinds = kinds_of(graph)
    plan, reports, every = LayerPlan("arms"), list[Report](), requests(graph)
    for now, fresh, gone, end in (
        (0.0, every[:60], set[str](), 1800.0),
        (1500.0, every[60:], {"r2", "r50"}, 3600.0),
        (3550.0, [], set[str](), 3660.0),
    ):
        drafted = layer_planning.draft(
            project,
            graph,
            markov.ARMS,
            kinds,
            plan,
            reports,
            LAYER_SEED,
            now,
            fresh,
            gone,
            gone,
            end,
            None,
            MOODS,
            Track(),
        )
        plan = drafted.performed(drafted.placed, end)
        reports = drafted.reports
    said = [
        f"{c.action.id} {c.stance} {c.then} {c.meta} "
        + " ".join(f"{x:.9f}" for x in (c.start, c.end, c.entry, c.blend_in, c.hold, c.extent, c.tempo))
        for c in plan.cues
    ]
    said += [f"{r.stance} {r.action.id} {r.start:.9f} {r.fade_start:.9f} {r.fade:.9f}" for r in plan.rests]
    said += [f"{r.request} {r.outcome} {r.message}" for r in reports]
    outcomes = {r.outcome for r in reports}
    assert len(plan.cues) > 250 and len(outcomes) >= 8, outcomes
    assert said_by(cpp_probe, "layer") == said
