"""What the whole path takes a person, from a folder to an export: python tests/benchmarks/bench_paths.py

For labelled sets, with names and with names hidden: the folder is dropped on the library, labels are
proposed, every clip is watched once, alone and in full, what is wrong is corrected by keys, all is accepted,
the problems are looked at, and the result is exported. Operators of the keystroke-level model: a thought
before each correction, each key that goes on after one, and each command; two keys a field that is wrong.
Prints the table of docs/researchers/experts-paths.md.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.research.study.machines.klm import predict_seconds  # noqa: E402
from metagraph.suggest.propose import propose  # noqa: E402
from tests.benchmarks.bench_labels import real_sets  # noqa: E402
from tests.label_zoo.measure import LabelSet, meanings, none_of_the_four, verdict  # noqa: E402

SETS = ("sample_clips", "kaykit-rogue", "sumerian-hosts")
FIELDS = ("kind", "layer", "stance", "end_stance", "limb")


def path_of(one: LabelSet, sources: tuple[str, ...]) -> dict[str, Any]:
    """Return what a set's largest project takes."""
    project = max(one.projects, key=lambda p: len(p.clips))
    began = time.monotonic()
    found = propose(project, sources=sources)
    waited = time.monotonic() - began
    meant = meanings(project, one.truth, found)
    hands: Counter[str] = Counter()
    hands.update({"M": 1, "P": 2, "B": 2})  # the folder is dropped
    hands.update({"M": 2, "K": 3, "H": 1, "R": round(waited)})  # proposals are asked for, and watched
    wrong = fields = 0
    for ident, entry in project.clips.items():
        row, p = one.truth.get(entry.name), found.proposals.get(ident)
        if row is None:
            continue
        none = none_of_the_four(row)
        off = (
            []
            if none or p is None
            else [f for f, ok in verdict(p, row, meant).items() if f in FIELDS and not ok]
        )
        missed = p is None and not none  # it was skipped, and is a clip like the others
        unwanted = p is not None and none
        if off or missed or unwanted:
            wrong += 1
            count = len(off) + (len([f for f in FIELDS if row.get(f)]) if missed else 0)
            fields += count
            hands.update({"M": 1 + count, "K": 1 + 2 * count})
    hands.update({"M": 1, "K": 1})  # all is accepted
    hands.update({"M": 1, "P": 1, "B": 2, "H": 1})  # problems
    hands.update({"M": 1, "K": 3, "H": 1})  # exported
    looked = sum(e.duration for e in project.clips.values())
    return {
        "clips": len(project.clips), "proposed": len(found.proposals), "wrong": wrong, "fields": fields,
        "hands": hands, "looked": looked, "seconds": predict_seconds({**hands, "L": looked}),
    }  # fmt: skip


def main() -> None:
    print(
        "| set | names | clips | proposed | wrong | fields corrected | operators | hands | watching | total |"
    )
    print("|---" * 10 + "|")
    for one in real_sets():
        if one.name not in SETS:
            continue
        for words, sources in (("informative", ("name", "motion")), ("hidden", ("motion",))):
            row = path_of(one, sources)
            operators = " ".join(f"{n:.0f} {k}" for k, n in row["hands"].items())
            hands = predict_seconds(row["hands"])
            cells = [one.name, words, row["clips"], row["proposed"], row["wrong"], row["fields"], operators]
            cells += [f"{hands:.0f} s", f"{row['looked']:.0f} s", f"{row['seconds'] / 60:.1f} min"]
            print(f"| {' | '.join(map(str, cells))} |", flush=True)


if __name__ == "__main__":
    main()
