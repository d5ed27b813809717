"""How right a machine is, beside a reference: connections found, missing and too many, and what was mistaken
about each clip, in words.

Both are in normal form, so it does not matter how they were authored, nor how stances are called: stances are
those whose loops, and then whose actions, are the same.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import permutations
from typing import Literal

from metagraph.graph.model import LAYERS, Layer
from metagraph.research.study.machines.normal_machine import NormalMachine, NormalState, Pair

TOLERANCE = 0.1  # seconds
MOST_USES = 6  # of one clip, beyond which their order is not tried out
NOTCH = 0.05  # weight of a joint: what is as near as a notch of the wheel that sets it is the same
NAMED = 4  # clips in a sentence, of more only how many

What = Literal["absent", "unwanted", "kind", "stance", "layer", "mask", "timing", "missing", "extra", "jump"]
WORDS: Mapping[What, str] = {
    "absent": "not placed",
    "unwanted": "not wanted",
    "kind": "wrong kind",
    "stance": "wrong stance",
    "layer": "wrong layer",
    "mask": "wrong limb or joints",
    "timing": "wrong timing",
    "missing": "missing connections",
    "extra": "extra connections",
    "jump": "visible jumps",
}


@dataclass(frozen=True, slots=True)
class Mistake:
    """what: the sort; clip: the state it is about; count: how many connections or fields; words: a
    sentence.
    """

    what: What
    layer: Layer
    clip: str
    count: int
    words: str


@dataclass(frozen=True)
class Score:
    """right, missing, extra: connections. wrong: of these, those that lead to another target instead.
    essential, essential_right: the connections between a stance's rest and its actions that the reference
    has, and of them those that were found. states: that the reference has; placed: of these, those with the
    right layer, kind, stance and limb. jumps: connections that jump, None if it was not judged.
    """

    right: int = 0
    missing: int = 0
    extra: int = 0
    wrong: int = 0
    essential: int = 0
    essential_right: int = 0
    states: int = 0
    placed: int = 0
    jumps: int | None = None
    mistakes: tuple[Mistake, ...] = field(default=())

    @property
    def precision(self) -> float | None:
        """Of the connections that were made, the share that is right; None if none was made."""
        return self.right / (self.right + self.extra) if self.right + self.extra else None

    @property
    def recall(self) -> float | None:
        """Of the connections that are wanted, the share that was made; None if none is wanted."""
        return self.right / (self.right + self.missing) if self.right + self.missing else None

    @property
    def f1(self) -> float | None:
        """The harmonic mean of both; 0 where all is wrong, None if nothing is wanted and nothing made."""
        total = 2 * self.right + self.missing + self.extra
        return 2 * self.right / total if total else None

    def count(self, what: What) -> int:
        """Return how many mistakes of a sort there are: clips, for connections how many of them."""
        return sum(
            m.count if what in ("missing", "extra", "jump") else 1 for m in self.mistakes if m.what == what
        )

    def with_jumps(self, jumps: int | None, mistakes: Iterable[Mistake]) -> Score:
        return replace(self, jumps=jumps, mistakes=(*self.mistakes, *mistakes))


def score(
    attempt: Mapping[Layer, NormalMachine],
    reference: Mapping[Layer, NormalMachine],
    tolerance: float = TOLERANCE,
) -> Score:
    """Return how right an attempt is. tolerance: seconds by which a time may be off."""
    right = missing = extra = wrong = essential = essential_right = states = placed = 0
    mistakes: list[Mistake] = []
    for layer in (x for x in LAYERS if x in reference or x in attempt):
        want = reference.get(layer) or NormalMachine(layer, {}, {}, {})
        got = align_machine(attempt.get(layer) or NormalMachine(layer, {}, {}, {}), want)
        both = want.connections.keys() & got.connections.keys()
        less, more = want.connections.keys() - both, got.connections.keys() - both
        right, missing, extra = right + len(both), missing + len(less), extra + len(more)
        wrong += (Counter(a for a, _ in less) & Counter(a for a, _ in more)).total()
        rests = {
            p
            for p in want.connections
            if (want.states[p[0]].kind == "stance") != (want.states[p[1]].kind == "stance")
        }
        essential, essential_right = essential + len(rests), essential_right + len(rests & both)
        stances = match_stances(got, want)
        states += len(want.states)
        told = _told_by_links(got, want, less, more) if got.derived else frozenset()
        for key, mine in want.states.items():
            found = _placing(got.states.get(key), mine, stances, want, attempt, layer)
            placed += not found and got.states[key].kind is not None
            mistakes += [m for m in found if m.what not in ("kind", "stance") or key not in told]
        mistakes += [
            Mistake("unwanted", layer, key, 1, f"{key} is placed on {layer}, where it is not wanted.")
            for key in sorted(got.states.keys() - want.states.keys())
        ]
        mistakes += _timing(got, want, both, tolerance)
        mistakes += _listed("missing", layer, less) + _listed("extra", layer, more)
    mistakes.sort(key=lambda m: (list(WORDS).index(m.what), m.layer, m.clip, m.words))
    return Score(
        right, missing, extra, wrong, essential, essential_right, states, placed, None, tuple(mistakes)
    )


def are_equivalent(
    a: Mapping[Layer, NormalMachine], b: Mapping[Layer, NormalMachine], tolerance: float = TOLERANCE
) -> bool:
    """Return whether two machines are the same except for the names and the order of what is in them."""
    return not score(a, b, tolerance).mistakes


# --- which is which


def match_stances(got: NormalMachine, want: NormalMachine) -> dict[str, str]:
    """Return stance of the one -> stance of the other: those that share most loops, then most actions, come
    together first.
    """
    shared: Counter[tuple[str, str]] = Counter()
    for key in got.states.keys() & want.states.keys():
        mine, theirs = got.states[key], want.states[key]
        weight = 1000 if mine.kind == theirs.kind == "stance" else 1
        if mine.stance is not None and theirs.stance is not None:
            shared[mine.stance, theirs.stance] += weight
        if mine.kind == theirs.kind == "transition" and mine.ends is not None and theirs.ends is not None:
            shared[mine.ends, theirs.ends] += weight
    out: dict[str, str] = {}
    taken: set[str] = set()
    for (mine_id, their_id), _ in sorted(shared.items(), key=lambda item: (-item[1], item[0])):
        if mine_id not in out and their_id not in taken:
            out[mine_id] = their_id
            taken.add(their_id)
    return out


def align_machine(got: NormalMachine, want: NormalMachine) -> NormalMachine:
    """Return a machine with its several uses of one clip numbered as the other has them: those that are used
    alike are the same.
    """
    renamed: dict[str, str] = {}
    for clip in {s.clip for s in got.states.values()}:
        mine = [k for k, s in got.states.items() if s.clip == clip]
        theirs = [k for k, s in want.states.items() if s.clip == clip]
        if len(theirs) > 1 or (len(mine) > 1 and theirs):
            renamed |= _numbered(mine, theirs, got, want)
    if all(a == b for a, b in renamed.items()):
        return got

    def name(key: str) -> str:
        return renamed.get(key, key)

    states = {name(k): replace(s, key=name(k)) for k, s in got.states.items()}
    return replace(
        got, states=states, connections={(name(a), name(b)): c for (a, b), c in got.connections.items()}
    )


def _numbered(mine: list[str], theirs: list[str], got: NormalMachine, want: NormalMachine) -> dict[str, str]:
    """Return key -> the key of the use most like it; what is left over gets numbers that nobody has."""
    alike = {(a, b): _alike(a, b, got, want) for a in mine for b in theirs}
    if max(len(mine), len(theirs)) <= MOST_USES:
        short, long = (mine, theirs) if len(mine) <= len(theirs) else (theirs, mine)
        pairs = max(
            (list(zip(short, some, strict=True)) for some in permutations(long, len(short))),
            key=lambda chosen: sum(alike[p] if short is mine else alike[p[1], p[0]] for p in chosen),
        )
        out = dict(pairs) if short is mine else {b: a for a, b in pairs}
    else:
        out = {}
        for a, b in sorted(alike, key=lambda p: -alike[p]):
            if a not in out and b not in out.values():
                out[a] = b
    clip = got.states[mine[0]].clip
    spare = (n for n in (f"{clip}#{i}" for i in range(2, len(mine) + len(theirs) + 2)) if n not in theirs)
    return {a: out[a] if a in out else next(spare) for a in mine}


def _alike(a: str, b: str, got: NormalMachine, want: NormalMachine) -> float:
    """Return how alike two uses of a clip are: by their neighbours, which clips they are, then by kind, limb
    and part.
    """
    mine, theirs = got.states[a], want.states[b]
    near = [
        {(m.states[y].clip, "to") for x, y in m.connections if x == k}
        | {(m.states[x].clip, "from") for x, y in m.connections if y == k}
        for m, k in ((got, a), (want, b))
    ]
    union = len(near[0] | near[1])
    off = abs(mine.start - theirs.start) + abs(mine.end - theirs.end)
    same = len(near[0] & near[1]) / union if union else 1.0
    return 4 * same + (mine.kind == theirs.kind) + 0.5 * (mine.limb == theirs.limb) + 0.5 / (1 + off)


def _told_by_links(
    got: NormalMachine, want: NormalMachine, less: Collection[Pair], more: Collection[Pair]
) -> frozenset[str]:
    """Return the states whose place follows from links drawn by hand and is unclear only since some to or
    from rest were forgotten: that is one mistake, and is reported for the links.
    """

    def at_rest(pairs: Iterable[Pair], machine: NormalMachine) -> set[str]:
        return {
            key
            for a, b in pairs
            for key, rest in ((a, b), (b, a))
            if key in want.states and machine.states[rest].kind == "stance"
        }

    return frozenset(at_rest(less, want) - at_rest(more, got))


# --- mistakes


def _placing(
    got: NormalState | None,
    want: NormalState,
    stances: Mapping[str, str],
    machine: NormalMachine,
    attempt: Mapping[Layer, NormalMachine],
    layer: Layer,
) -> list[Mistake]:
    """Return what is wrong about where a clip is placed; nothing if links drawn by hand do not tell, as that
    is reported for the links.
    """
    key = want.key
    if got is None:
        elsewhere = next(
            (
                x
                for x, m in attempt.items()
                if x != layer and any(s.clip == want.clip for s in m.states.values())
            ),
            None,
        )
        if elsewhere is not None:
            return [Mistake("layer", layer, key, 1, f"{key} is on {elsewhere} rather than on {layer}.")]
        return [Mistake("absent", layer, key, 1, f"{key} is not placed on {layer}.")]
    out = []
    if got.kind is not None and got.kind != want.kind:
        out.append(Mistake("kind", layer, key, 1, f"{key} is {_kind(got)} rather than {_kind(want)}."))
    begins, ends = (stances.get(x) if x is not None else None for x in (got.stance, got.ends))
    if got.kind is not None and (begins != want.stance or (ends != want.ends and want.kind == "transition")):
        should = machine.stances.get(want.stance or "", "no stance")
        if want.kind == "transition":
            should += f" to {machine.stances.get(want.ends or '', 'no stance')}"
        found = machine.stances.get(begins or "", "another stance")
        if got.kind == "transition":
            found += f" to {machine.stances.get(ends or '', 'another stance')}"
        out.append(Mistake("stance", layer, key, 1, f"{key} is of {found} rather than of {should}."))
    if not _moves_alike(got, want):
        out.append(Mistake("mask", layer, key, 1, f"{key} moves {_moved(got)} rather than {_moved(want)}."))
    return out


def _kind(state: NormalState) -> str:
    return f"a {state.kind}"


def _moves_alike(got: NormalState, want: NormalState) -> bool:
    """Whether both move the same joints, each as far except for a notch of what sets it."""
    if got.limb != want.limb or got.joints != want.joints:
        return False
    has, should = dict(got.joint_weights), dict(want.joint_weights)
    return all(abs(has.get(j, 1.0) - should.get(j, 1.0)) < NOTCH * 1.01 for j in has.keys() | should.keys())


def _moved(state: NormalState) -> str:
    limb = {"both": "everything", "left": "the left arm", "right": "the right arm"}[state.limb]
    out = limb
    if state.joints:
        out = f"{len(state.joints)} joints" + (f" of {limb}" if state.limb != "both" else "")
    if state.joint_weights:
        least, most = (f(round(100 * w) for _, w in state.joint_weights) for f in (min, max))
        share = f"{least} %" if least == most else f"{least} to {most} %"
        out += f", {len(state.joint_weights)} {'of them' if state.joints else 'joints of it'} by {share}"
    return out


def _timing(
    got: NormalMachine, want: NormalMachine, both: Collection[Pair], tolerance: float
) -> list[Mistake]:
    """Return the times that are off. Loops are left whenever something is asked, so when is not compared; the
    blend between two is reported once, of the clip that has it: of what is going back to rest its own, else
    that of what comes.
    """
    out: dict[tuple[str, str], list[tuple[float | None, float | None]]] = {}
    for key in want.states.keys() & got.states.keys():
        a, b = got.states[key], want.states[key]
        for name, is_at, should in (("starts", a.start, b.start), ("ends", a.end, b.end)):
            if _apart(is_at, should, tolerance):
                out.setdefault((key, name), []).append((is_at, should))
    for pair in both:
        c, d = got.connections[pair], want.connections[pair]
        source, target = want.states[pair[0]], want.states[pair[1]]
        if not source.loop and _apart(c.leave, d.leave, tolerance):
            out.setdefault((pair[0], "may be left"), []).append((c.leave, d.leave))
        if _apart(c.blend, d.blend, tolerance):
            back = target.kind == "stance" and source.kind != "stance"
            out.setdefault((pair[0], "blends out") if back else (pair[1], "blends in"), []).append(
                (c.blend, d.blend)
            )
    mistakes = []
    for (key, name), offs in sorted(out.items()):
        mine, theirs = max(
            offs,
            key=lambda o: (
                abs((o[0] if o[0] is not None else 1e3) - (o[1] if o[1] is not None else 1e3)),
                str(o),
            ),
        )
        where = f", on {len(offs)} connections" if len(offs) > 1 else ""
        words = f"{key} {name} {_when(mine, name)} rather than {_when(theirs, name)}{where}."
        mistakes.append(Mistake("timing", want.layer, key, len(offs), words))
    return mistakes


def _apart(a: float | None, b: float | None, tolerance: float) -> bool:
    return a is not b if a is None or b is None else abs(a - b) > tolerance + 1e-9


def _when(seconds: float | None, name: str) -> str:
    if seconds is None:
        return "at any time"
    return f"{'in' if name.startswith('blends') else 'at'} {seconds:.2f} s"


def _listed(what: Literal["missing", "extra"], layer: Layer, pairs: Iterable[Pair]) -> list[Mistake]:
    """Return one mistake a source."""
    by: dict[str, list[str]] = {}
    for source, target in sorted(pairs):
        by.setdefault(source, []).append(target)
    verb = "does not lead to" if what == "missing" else "should not lead to"
    return [
        Mistake(what, layer, source, len(targets), f"{source} {verb} {name_some(targets)}.")
        for source, targets in by.items()
    ]


def name_some(names: list[str]) -> str:
    """Return names in a sentence, of many only the first and how many more."""
    shown = names if len(names) <= NAMED else [*names[: NAMED - 1], f"{len(names) - NAMED + 1} more"]
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} and {shown[-1]}"
