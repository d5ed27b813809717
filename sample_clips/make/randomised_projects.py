"""The conformance character with every number drawn by chance, so that a rule that is off shows somewhere."""

from __future__ import annotations

import random
from dataclasses import replace
from typing import get_args

from metagraph.graph import edits
from metagraph.graph.face.rig import with_morphs
from metagraph.graph.life import Life, Manner
from metagraph.graph.model import LAYERS, LIMBS, PARTS, Action, Layer, Markov, Project
from metagraph.graph.words import Mode
from metagraph.playback.planning.markov import KINDS as MODEL_KINDS
from sample_clips.make.conformance_projects import stick
from sample_clips.make.numbered_ids import numbered_ids

TAGS = ("", "x", "positive", "negative unsure", "there", "greeting", "sad", "happy excited")


@numbered_ids()
def randomised(seed: int, morphs: tuple[str, ...] = ()) -> Project:
    """Return the character with weights, timing, likelihoods, cooldowns, spacing, seams, models, planner
    constants and life's dials drawn from a seed.
    """
    chance = random.Random(seed)
    project = stick(f"random{seed}", morphs, size=2.5)
    if morphs:
        project = with_morphs(project, morphs)
    project = edits.set_settings(
        project,
        alpha=_of(chance, 0.2, 4.0),
        never_twice=chance.random() < 0.5,
        shortest=chance.randrange(13, 58) / 64,
        wait=chance.randrange(51, 320) / 64,
        memory=chance.choice((0.0, chance.randrange(5, 26))),
        rest=chance.choice((0.0, _of(chance, 0.05, 0.6))),
        lookahead=_of(chance, 0.0, 0.8),
        variety=chance.choice((0.05, _of(chance, 0.1, 1.5))),
        seed=chance.getrandbits(32),
    )
    for layer in LAYERS:
        for part in PARTS:
            if chance.random() < 0.7:
                project = edits.set_weight(project, layer, part, _of(chance, 0.3, 2.0))
        project = edits.set_markov(project, _model(chance, layer))
        for action in [*project.graphs[layer].actions.values()]:
            project = edits.update_actions(project, [action.id], **_fields(chance, project, action))
    frame = chance.randrange(1, 12)
    project = edits.set_base(project, chance.choice([*project.clips]), frame)
    return replace(project, life=_life(chance))


def _of(chance: random.Random, low: float, high: float) -> float:
    """Return a number with few binary digits, so that sums of times meet exactly in any language."""
    return round(chance.uniform(low, high) * 64) / 64


def _fields(chance: random.Random, project: Project, action: Action) -> dict[str, object]:
    """Return other fields for an action. Loops lose part of
    their beginning, so that their ends do not meet."""
    length = project.clips[action.clip].duration
    start = _of(chance, 0.0, 0.12 * length)
    end = length - _of(chance, 0.0, 0.12 * length)
    timing = replace(
        action.timing,
        start=start,
        end=chance.choice((None, end)),
        blend_in=_of(chance, 0.0, 0.5),
        blend_out=_of(chance, 0.0, 0.6),
    )
    if action.kind == "stance":
        timing = replace(timing, blend_in=_of(chance, 0.0, 0.9))
        return {"timing": timing, "likelihood": _of(chance, 0.2, 3.0)}
    if chance.random() < 0.4:
        timing = replace(timing, earliest_exit=_of(chance, 0.7 * start + 0.3 * end, 0.2 * start + 0.8 * end))
    if action.kind == "gesture" and chance.random() < 0.6:
        marks = sorted(_of(chance, 0.9 * start + 0.1 * end, 0.1 * start + 0.9 * end) for _ in range(4))
        timing = replace(timing, ready=marks[0], stroke=marks[1], stroke_end=marks[2], relax=marks[3])
        if chance.random() < 0.5:
            timing = replace(timing, earliest_exit=_of(chance, marks[3], end))
    tags = tuple(chance.choice(TAGS).split()) if action.kind == "fidget" else action.tags
    return {
        "timing": timing,
        "tags": tags,
        "likelihood": _of(chance, 0.2, 3.0),
        "cooldown": chance.choice((0.0, 0.0, _of(chance, 0.2, 1.0), _of(chance, 1.0, 9.0))),
        "spacing": chance.choice((None, 0, 1, 2, 3, 5)),
        "prominence": chance.choice((None, _of(chance, 0.0, 1.0))),
    }


def _model(chance: random.Random, layer: Layer) -> Markov:
    states = tuple(dict.fromkeys((chance.choice(LIMBS), chance.choice(MODEL_KINDS)) for _ in range(7)))
    rows = []
    for n in range(len(states)):
        row = [chance.random() if chance.random() < 0.6 else 0.0 for _ in states]
        row = row if sum(row) > 0 else [1.0] * len(states)
        if n == 1:  # goes on to itself alone
            row = [float(m == n) for m in range(len(states))]
        rows.append(tuple(x / sum(row) for x in row))
    tagged = chance.random() < 0.5
    return Markov(
        layer,
        states,
        tuple(rows),
        gap=_of(chance, 0.2, 2.5),
        positive=0.0 if tagged else 0.3,
        negative=0.0 if tagged else 0.4,
        tags=tuple(chance.choice(TAGS) for _ in states) if tagged else (),
        lengths=tuple((_of(chance, 0.8, 2.5), _of(chance, 0.0, 1.0)) for _ in states)
        if chance.random() < 0.6
        else (),
        modes=tuple(
            tuple(_of(chance, 0.2, 0.9) if chance.random() < 0.8 else 1.0 for _ in range(3)) for _ in range(3)
        ),
    )


def _life(chance: random.Random) -> Life:
    def manner() -> Manner:
        names = [name for name in Manner.__struct_fields__ if chance.random() < 0.7]
        return Manner(**{name: _of(chance, 0.3, 2.5) for name in names})

    modes: tuple[Mode, ...] = get_args(Mode)
    return Life(
        stillness=_of(chance, 0.0, 0.4),
        breathing=_of(chance, 0.5, 2.0),
        breath_rate=_of(chance, 8.0, 30.0),
        gaze=_of(chance, 0.4, 1.0),
        head_share=_of(chance, 0.1, 0.9),
        aversion_rate=_of(chance, 8.0, 40.0),
        aversion_length=_of(chance, 0.3, 2.5),
        aversion_angle=_of(chance, 8.0, 40.0),
        saccades=_of(chance, 0.5, 2.0),
        saccade_rate=_of(chance, 30.0, 170.0),
        lids=_of(chance, 0.5, 2.0),
        blinks=_of(chance, 15.0, 55.0),
        accent_blinks=_of(chance, 0.3, 1.0),
        blink_close=_of(chance, 0.05, 0.4),
        blink_open=_of(chance, 0.05, 0.5),
        lips=_of(chance, 0.5, 2.0),
        lip_smoothing=_of(chance, 0.0, 0.15),
        modes={mode: manner() for mode in modes},
    )
