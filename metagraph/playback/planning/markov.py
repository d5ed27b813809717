"""The Markov model that performs when there are no requests: a first-order chain over (limb, kind).

The arms matrix is the paper's (Borer et al., figure 11), learned from annotated casual conversation. Body and
head have no published matrix; theirs are ours, shaped on the paper's labels: the head nods and now and then
changes its tilt, the body mostly rests, shifts and fidgets. The shares of what is performed in the modes
idle, listening and talking are ours, too: the hands gesture with the character's own speech, and the head
nods at the other's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet

from metagraph.graph.model import Kind, Layer, Limb, Markov, Mode, Project
from metagraph.graph.words import MODES
from metagraph.playback.plan import WRITTEN, Cursor, MetaAction, MetaRequest
from metagraph.playback.planning.choice import chance_of, keyed, log_normal, picked, uniform
from metagraph.playback.planning.hashing import Bits

_LIMB: Mapping[str, Limb] = {"L": "left", "R": "right", "LR": "both"}
_KIND: Mapping[str, Kind] = {"G": "gesture", "F": "fidget", "T": "transition"}


def _states(text: str) -> tuple[tuple[Limb, Kind], ...]:
    return tuple((_LIMB[word.split(",")[0]], _KIND[word.split(",")[1]]) for word in text.split())


def _rows(text: str) -> tuple[tuple[float, ...], ...]:
    """Read percentages; each row is scaled to sum to 1, because the printed numbers are rounded."""
    rows = [[float(x) for x in line.split()] for line in text.strip().splitlines()]
    return tuple(tuple(x / sum(row) for x in row) for row in rows)


ARMS = Markov(
    "arms",
    _states("L,G L,F L,T R,G R,F R,T LR,G LR,F LR,T"),
    _rows("""
    25   37.5 12.5 12.5 0  0  12.5 0    0
    26.7 33.3 6.7  13.3 20 0  0    0    0
    20   20   0    0    60 0  0    0    0
    0    28.6 0    42.9 0  0  14.3 0    14.3
    0    42.9 14.3 0    0  0  14.3 14.3 14.3
    0    0    100  0    0  0  0    0    0
    25   0    0    25   25 0  0    25   0
    0    33.3 33.3 0    0  0  33.3 0    0
    0    0    0    0    20 20 0    0    60
    """),
    gap=1.6,
    modes=((0.0, 1.0, 0.8), (0.05, 0.7, 0.5), (1.0, 0.3, 0.5), (0.0, 0.2, 0.3), (0.0, 0.1, 0.1)),
)
HEAD = Markov(
    "head",
    _states("LR,G LR,F LR,T"),
    _rows("60 20 20\n60 15 25\n70 20 10"),
    gap=2.4,
    positive=0.2,
    negative=0.1,
    modes=((0.0, 1.0, 0.8), (1.0, 0.5, 0.6), (0.7, 0.6, 0.7), (0.0, 0.3, 0.8), (1.0, 0.2, 0.3)),
)
BODY = Markov(
    "body",
    _states("LR,G LR,F LR,T"),
    _rows("10 40 50\n20 30 50\n25 45 30"),
    gap=6.0,
    modes=((0.0, 1.0, 0.7), (0.1, 0.8, 0.6), (1.0, 0.5, 0.6), (0.0, 0.2, 0.3), (0.1, 0.2, 0.4)),
)
DEFAULTS: Mapping[Layer, Markov] = {"body": BODY, "arms": ARMS, "head": HEAD}

KINDS: tuple[Kind, ...] = ("gesture", "fidget", "transition")  # as in `Markov.modes`


def model(project: Project, layer: Layer) -> Markov:
    """Return the project's model of a layer, or the default."""
    return project.markov.get(layer, DEFAULTS[layer])


LISTENS = 1  # place of the row that stands for modes of which a model says nothing
BEGIN = Cursor()
RESTS = 0.9  # standard deviation of rests, times their mean


def write(
    chain: Markov, seed: Bits, until: float, kinds: AbstractSet[Kind] | None = None, cursor: Cursor = BEGIN
) -> tuple[list[MetaAction], Cursor]:
    """Return the meta actions that start before `until` seconds, from the cursor on, and the cursor before
    the first one left out.

    Rests are log-normal about the mean gap (`rest_length`): most are short, some long, as people's are.
    Windows are as `length` says. kinds: those that the graph has; states of other kinds are passed over, so
    that half-filled graphs perform, too.

    Each draw is keyed by the meta action's number. So a longer horizon only appends, and continuing from a
    cursor gives bit for bit the same as writing in one go. After a row of zeros, the chain starts again from
    any state.
    """
    number, state, time = cursor.number, cursor.state, cursor.time
    open_to = [1.0 if kinds is None or kind in kinds else 0.0 for _, kind in chain.states]
    rows: dict[int, dict[str, float]] = {}
    out: list[MetaAction] = []
    able = any(p > 0 for p in open_to)
    while able:
        ident = f"auto/{chain.layer}/{number}"
        key = keyed(seed, ident)
        start = time + rest_length(chain, key)
        if not start < until:  # nor when it is no number
            break
        if state not in rows:
            rows[state] = _row(chain, state, open_to)
        state = int(picked(key, "state", rows[state]))
        limb, kind = chain.states[state]
        seconds = length(chain, state, key)
        tags = tuple(chain.tag(state).split())
        if kind == "gesture" and len(chain.tags) == 0:
            draw = chance_of(key, "tag")
            if draw < chain.positive:
                tags = ("positive",)
            elif draw < chain.positive + chain.negative:
                tags = ("negative",)
        request = MetaRequest(
            ident, chain.layer, kind, start, seconds, tags=tags, limb=limb, priority=WRITTEN
        )
        out.append(MetaAction(request, start, start + seconds, written=True))
        number, time = number + 1, start + seconds
    return out, Cursor(number, state, time)


def _row(chain: Markov, state: int, open_to: Sequence[float]) -> dict[str, float]:
    """Return the probability of each state that may follow a state (-1: before the first), by its index; of
    all allowed states if none may follow.
    """
    row = list(open_to)
    if 0 <= state < len(row):
        row = [p * may for p, may in zip(chain.matrix[state], open_to, strict=True)]
    if not any(p > 0 for p in row):
        row = list(open_to)
    return {str(i): p for i, p in enumerate(row) if p > 0}


def performs(chain: Markov, seed: Bits, meta: MetaAction, mode: Mode) -> bool:
    """Return whether something that the model wrote is performed in a mode (`Markov.modes`). What is left out
    does not change the rest, so it does not matter when a mode became known.
    """
    if len(chain.modes) == 0 or meta.request.kind not in KINDS:
        return True
    place = MODES.index(mode)
    row = chain.modes[place if place < len(chain.modes) else LISTENS]
    share = row[KINDS.index(meta.request.kind)]
    return share >= 1 or uniform(seed, meta.request.id, "mode") < share


def length(chain: Markov, state: int, key: Bits) -> float:
    """Return how many seconds a meta action of a key lasts: uniform from 1 to 3 if the model has no lengths;
    else log-normal with the state's mean and standard deviation.
    """
    if len(chain.lengths) == 0:
        return 1.0 + 2.0 * chance_of(key, "length")
    mean, deviation = chain.lengths[state]
    return log_normal(mean, deviation, chance_of(key, "length"), chance_of(key, "length2"))


def rest_length(chain: Markov, key: Bits) -> float:
    """Return how many seconds of rest come before a meta action of a key: log-normal with the mean
    `chain.gap`, between a fifth and five times of it.
    """
    drawn = log_normal(chain.gap, RESTS * chain.gap, chance_of(key, "gap"), chance_of(key, "gap2"))
    return min(5.0 * chain.gap, max(0.2 * chain.gap, drawn))
