"""What of a model is performed while one idles, listens and talks."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.project.annotation_reading import AnnotationReading, apply_reading, begin_reading
from metagraph.formats.elan import read_elan
from metagraph.graph.model import LAYERS, Mode, Project
from metagraph.graph.requests import Behave
from metagraph.playback.learning.learn import Act, learn_model
from metagraph.playback.planning.markov import ARMS, DEFAULTS
from metagraph.playback.planning.mode_shares import find_mode_spans, with_modes
from metagraph.playback.planning.running_plan import plan_performance

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "annotation" / "conversation.eaf"


def kinds(project: Project, mode: Mode | None, seconds: float = 1800.0) -> dict[str, int]:
    asks = [] if mode is None else [Behave(id="m", at=0.0, mode=mode)]
    cues = plan_performance(project, asks, seconds, 3).layers["arms"].cues
    return {
        kind: sum(cue.action.kind == kind for cue in cues) for kind in ("gesture", "fidget", "transition")
    }


@pytest.mark.nightly
def test_who_talks_gestures_more_than_who_listens_or_idles(sample: Project) -> None:
    talking, listening, idle = (kinds(sample, m) for m in ("talking", "listening", "idle"))
    assert talking["gesture"] > 3 * listening["gesture"] and talking["gesture"] > 3 * idle["gesture"]
    assert idle["gesture"] == 0 and idle["fidget"] > 1.5 * talking["fidget"]
    assert kinds(sample, None) == idle, "where nobody says in which mode one is, nobody is talked to"


@pytest.mark.nightly
def test_a_model_without_modes_does_the_same_in_each(sample: Project) -> None:
    settings = replace(sample.settings, variety=0.0)  # or rests depend on the mode
    project = replace(sample, settings=settings, markov={**sample.markov, "arms": replace(ARMS, modes=())})
    assert kinds(project, "talking") == kinds(project, "idle") == kinds(project, None)


def test_pauses_within_a_turn_belong_to_it_and_after_the_others_one_listens_a_while() -> None:
    spans = find_mode_spans([(1.0, 2.0), (2.4, 3.0)], [(8.0, 9.0)], 20.0)
    assert spans == [(0.0, "idle"), (1.0, "talking"), (3.6, "idle"), (8.0, "listening"), (11.0, "idle")]


def test_without_speech_or_acts_a_model_stays_as_it_is() -> None:
    acts = [Act(n * 4.0, n * 4.0 + 1, "left", "gesture") for n in range(10)]
    model = learn_model("arms", [acts])
    assert with_modes(model, acts, [], [], 40.0) is model
    assert with_modes(model, [], [(0.0, 5.0)], [], 40.0) is model


def test_shares_are_those_that_were_seen() -> None:
    """Planted: a gesture every 2 s of talking and every 20 s of listening, a fidget every 10 s of all."""
    own, partner = [(0.0, 199.4)], [(200.0, 398.0)]
    acts = [Act(t + 0.1, t + 0.9, "left", "gesture") for t in range(0, 200, 2)]
    acts += [Act(t + 0.1, t + 0.9, "left", "gesture") for t in range(201, 400, 20)]
    acts += [Act(t + 1.1, t + 1.6, "right", "fidget") for t in range(0, 400, 10)]
    acts.sort(key=lambda a: a.start)
    model = with_modes(learn_model("arms", [acts]), acts, own, partner, 400.0)
    _, listening, talking, *_ = model.modes
    assert listening[0] / talking[0] == pytest.approx(0.1, rel=0.15)
    assert listening[1] == pytest.approx(talking[1], rel=0.1)
    assert all(0 <= x <= 1 for row in model.modes for x in row)


def test_what_is_learned_from_the_sample_gestures_more_talking_than_not(sample: Project) -> None:
    reading = begin_reading(read_elan(SAMPLE))
    made = apply_reading(sample, reading, LAYERS, False, None).project
    idle, _, talking, *_ = made.markov["arms"].modes
    assert talking[0] > idle[0]
    silent = AnnotationReading(reading.annotation, {**reading.roles, "Speech": "ignore"})
    made = apply_reading(sample, silent, LAYERS, False, None).project
    assert made.markov["arms"].modes == DEFAULTS["arms"].modes
