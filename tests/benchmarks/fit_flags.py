"""Fit how likely a proposal is wrong: python tests/benchmarks/fit_flags.py

A logistic regression of whether all that decides is right on what the proposal says of itself, over the
sets of `bench_labels.py` and made sets, each proposed with names and motion and with names hidden. Prints
the weights of `metagraph.suggest.flags`, and for several thresholds precision and recall of flags on each
set by weights that were fitted without it; made sets are left out in five parts.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.suggest.flags import measure_proposal  # noqa: E402
from metagraph.suggest.propose import propose  # noqa: E402
from tests.benchmarks.bench_labels import TRUTH, projects  # noqa: E402
from tests.label_zoo import catalogue  # noqa: E402
from tests.label_zoo.measure import meanings, none_of_the_four, right_clip  # noqa: E402

MADE = 60  # drawn sets
PARTS = 5  # in which made sets are left out: they are of the same clips, but made otherwise
THRESHOLDS = (0.1, 0.2, 0.3, 0.4, 0.5)
SOURCES = (("name", "motion"), ("motion",))


def rows(project: Any, truth: Any) -> list[tuple[int, Any, bool]]:
    """Return (which sources, measures, whether right) of a set's proposals."""
    out = []
    for n, sources in enumerate(SOURCES):
        found = propose(project, sources=sources)  # type: ignore[arg-type]
        meant = meanings(project, truth, found)
        for ident, p in found.proposals.items():
            row = truth.get(project.clips[ident].name)
            if row is not None and not none_of_the_four(row):
                out.append((n, measure_proposal(p), right_clip(p, row, meant, found.whole)))
    return out


def fitted(x: Any, right: Any, weight: Any) -> Any:
    """Return the weights of a logistic regression with a little ridge, by Newton's method."""
    w = np.zeros(x.shape[1])
    for _ in range(50):
        p = 1 / (1 + np.exp(-x @ w))
        step = np.linalg.solve(
            (x * (weight * p * (1 - p))[:, None]).T @ x + 0.5 * np.eye(len(w)),
            x.T @ (weight * (right - p)) - 0.5 * w,
        )
        w = w + step
    return w


def main() -> None:
    sets: dict[str, tuple[str, list[tuple[int, Any, bool]]]] = {}
    for path in sorted(TRUTH.glob("*.json")):
        truth = json.loads(path.read_text("utf-8"))["clips"]
        for n, project in enumerate(projects(path.stem)):
            sets[f"{path.stem} {n}"] = path.stem, rows(project, truth)
    for n, made in enumerate([*catalogue.named_sets(), *catalogue.made_sets(MADE, 11)]):
        sets[made.name] = f"made {n % PARTS}", rows(made.project, made.truth)
    data = [(name, family, *row) for name, (family, some) in sets.items() for row in some]
    x = np.array([row[3] for row in data])
    right = np.array([row[4] for row in data], float)
    named = np.array([row[2] == 0 for row in data])
    family = np.array([row[1] for row in data])
    print("weights:", np.round(fitted(x, right, np.ones(len(x))), 3).tolist(), f"of {len(x)} proposals")
    wrong = np.zeros(len(x))
    for one in dict.fromkeys(family.tolist()):
        w = fitted(x[family != one], right[family != one], np.ones(int((family != one).sum())))
        wrong[family == one] = 1 / (1 + np.exp(x[family == one] @ w))
    for chosen, words in ((named, "names and motion"), (~named, "names hidden")):
        for least in THRESHOLDS:
            flagged = chosen & (wrong > least)
            hit, all_ = (flagged & (right == 0)).sum(), (chosen & (right == 0)).sum()
            print(
                f"{words}, above {least:.1f}: {flagged.sum()} of {chosen.sum()} flagged, precision "
                f"{hit / max(1, flagged.sum()):.2f}, recall {hit / max(1, all_):.2f}"
            )
        for a, b in ((0, 0.05), (0.05, 0.1), (0.1, 0.2), (0.2, 0.4), (0.4, 0.6), (0.6, 1.01)):
            there = chosen & (wrong >= a) & (wrong < b)
            if there.any():
                print(f"  said wrong {a:.2f}-{b:.2f}: {1 - right[there].mean():.2f} of {there.sum()}")


if __name__ == "__main__":
    main()
