"""How the race of experts changes with people who err, read slowly or are tired:
python tests/benchmarks/bench_sensitivity.py

Both sides work in the quickest way found (names informative, no proposals, each clip watched once). Some
gestures and fidgets get a wrong kind or a wrong stance; people see it as they watch, and repair each one. The
repairs are made with the real edits, and have to lead to the reference. Prints the table of
docs/researchers/experts-sensitivity.md.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import mean

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from app.project.files import SAMPLE  # noqa: E402
from metagraph.formats.store import read_project  # noqa: E402
from metagraph.graph import edits  # noqa: E402
from metagraph.graph.expand import list_connections  # noqa: E402
from metagraph.graph.model import Action, Project  # noqa: E402
from metagraph.research.study.machines.by_hand import Way  # noqa: E402
from metagraph.research.study.machines.counted_fields import label_by_fields  # noqa: E402
from metagraph.research.study.machines.counted_hand import OperatorCounts, try_way  # noqa: E402
from metagraph.research.study.machines.finding import Finder  # noqa: E402
from metagraph.research.study.machines.klm import OperatorTimes, predict_seconds  # noqa: E402
from metagraph.research.study.machines.normal_machine import normalize_machines  # noqa: E402
from metagraph.research.study.scores.machines import score  # noqa: E402
from tests.app.participant import task  # noqa: E402

BEST = Way("many at once", "from aliases", "words", "many at once")
SHARES = (0.0, 0.02, 0.05, 0.10)
DRAWN = 20
SLOWER = 1.5
PEOPLE = {
    "usual": (OperatorTimes(), 1.0),
    "slow readers": (replace(OperatorTimes(), M=SLOWER * OperatorTimes().M), SLOWER),
    "tired hands": (
        replace(
            OperatorTimes(), **{o: SLOWER * getattr(OperatorTimes(), o) for o in ("K", "P", "B", "H", "S")}
        ),
        1.0,
    ),
}  # seconds of operators, and how many times as long a clip is watched


@dataclass(frozen=True)
class Slip:
    """action: of the reference. wrong: what it was taken for, as changes of the action."""

    action: Action
    kind: str = ""
    stance: str = ""


def draw_slips(reference: Project, share: float, seed: int) -> list[Slip]:
    """Return which clips are mistaken: by turns a gesture for a fidget (or the other way), and for one of
    another stance.
    """
    rng = random.Random(seed)
    chosen = [a for a in reference.actions() if a.kind in ("gesture", "fidget")]
    count = round(share * len(list(reference.actions())))
    out = []
    for n, action in enumerate(rng.sample(chosen, min(count, len(chosen)))):
        others = [s for s in reference.graphs[action.layer].stances if s != action.stance]
        if n % 2 and others:
            out.append(Slip(action, stance=rng.choice(others)))
        else:
            out.append(Slip(action, kind="fidget" if action.kind == "gesture" else "gesture"))
    return out


def mistake(reference: Project, slips: Sequence[Slip]) -> Project:
    """Return what comes of the reference with slips that nobody repairs."""
    out = reference
    for slip in slips:
        change = {"kind": slip.kind} if slip.kind else {"stance": slip.stance}
        out = edits.update_actions(out, [slip.action.id], **change)
    return out


def repair_graph(reference: Project, slips: Sequence[Slip]) -> Counter[str]:
    """Return the operators of repairing the labels in the table: the row is searched for, the field typed."""
    made = OperatorCounts()
    names = [reference.clips[a.clip].name for a in reference.actions()]
    at = {a.id: n for n, a in enumerate(reference.actions())}
    finder, now = Finder(names), mistake(reference, slips)
    for slip in slips:
        words = finder.best(1 << at[slip.action.id])
        text = words.text if words is not None else reference.clips[slip.action.clip].name
        made.think()
        made.think(1 + text.count(" ") + text.count("|"))
        made.keys(2 + len(text) + 1)
        value = slip.action.kind[0] if slip.kind else reference.stance(slip.action.stance).name
        made.keys(1 + len(value) + 1)
        change = {"kind": slip.action.kind} if slip.kind else {"stance": slip.action.stance}
        now = edits.update_actions(now, [slip.action.id], **change)
    found = score(normalize_machines(now, False), normalize_machines(reference, False))
    assert not found.mistakes, found.mistakes[:3]
    return made.counts


def repair_machine(reference: Project, slips: Sequence[Slip]) -> Counter[str]:
    """Return the operators of repairing the state machine with aliases: the state is searched for, and either
    the links into it get another condition, or it changes from one alias to another, as source and as target.
    """
    made = OperatorCounts()
    for layer in dict.fromkeys(s.action.layer for s in slips):
        mine = list(reference.graphs[layer].actions.values())
        finder = Finder([reference.clips[a.clip].name for a in mine])
        for slip in (s for s in slips if s.action.layer == layer):
            words = finder.best(1 << [a.id for a in mine].index(slip.action.id))
            text = words.text if words is not None else reference.clips[slip.action.clip].name
            made.think(1 + text.count(" ") + text.count("|"))
            made.keys(len(text) + 2)
            if slip.kind:
                made.think()
                made.keys(1)  # the links that lead to it
                made.choose()
                continue
            for _ in ("from one alias", "into another"):
                made.think()
                made.click()
                made.think()
                made.click()
            made.think()
            made.click()
            made.keys(1)  # the link from the wrong alias
            made.think()
            made.drag()
            if slip.action.kind == "fidget":
                made.choose()
    return made.counts


def format_ratio(meta: float, manual: float) -> str:
    def told(seconds: float) -> str:
        return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.1f} min"

    return f"{told(meta)} : {told(manual)} = **{manual / meta:.2f}**"


def main() -> None:
    sample = read_project(SAMPLE)
    print("| clips | people | labels mistaken | clips watched once | hands alone | missing connections |")
    print("|---" * 6 + "|")
    for clips in (50, 152):
        reference = task(sample, clips).reference
        by_fields, by_hand = label_by_fields(reference), try_way(BEST, reference)
        assert not by_fields.score.mistakes and not by_hand.score.mistakes
        looked = sum(reference.clips[a.clip].duration for a in reference.actions())
        total = sum(sum(1 for _ in list_connections(reference, g)) for g in reference.graphs.values())
        for who, (times, slower) in PEOPLE.items():
            for share in SHARES:
                meta, manual, wrong = [], [], []
                for seed in range(DRAWN if share else 1):
                    slips = draw_slips(reference, share, seed)
                    a = Counter(by_fields.operators) + repair_graph(reference, slips)
                    b = by_hand.operators + repair_machine(reference, slips)
                    meta.append(predict_seconds(a, times))
                    manual.append(predict_seconds(b, times))
                    unseen = mistake(reference, slips)
                    found = score(normalize_machines(unseen, False), normalize_machines(reference, False))
                    wrong.append(found.missing / total)
                seen = slower * looked
                cells = [clips, who, f"{share:.0%}", format_ratio(mean(meta) + seen, mean(manual) + seen)]
                cells += [format_ratio(mean(meta), mean(manual)), f"{mean(wrong):.1%}"]
                print(f"| {' | '.join(map(str, cells))} |", flush=True)


if __name__ == "__main__":
    main()
