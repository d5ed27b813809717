"""How often labels read from names are right, by set and field, and whether confidences are: python
tests/benchmarks/bench_names.py [-v]

Truth: tests/suggest/truth/*.json, written by hand. right/said/there: guesses that are right, guesses made,
labels there are. A label nobody can tell (null) is not counted, except as "needless": guesses made if there
is none. "looked at": the patterns were written or bettered with that set in mind. "first read": what was
right when the set was read for the first time, before any pattern was changed for it: what to expect of names
never seen. -v lists what is wrong.
"""

from __future__ import annotations

import json
import statistics
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.suggest.words.names import read_names  # noqa: E402

FIELDS = ("kind", "stance", "end_stance", "layer", "limb")
TRUTH = ROOT / "tests" / "suggest" / "truth"
BINS = ((0.0, 0.6), (0.6, 0.75), (0.75, 0.85), (0.85, 0.93), (0.93, 1.01))


@dataclass
class Score:
    """Of one field in one set: how many labels there are, guessed, guessed rightly; guesses if
    there is none.
    """

    there: int = 0
    said: int = 0
    right: int = 0
    needless: int = 0
    wrong: list[str] = field(default_factory=list)
    confidences: list[tuple[float, bool]] = field(default_factory=list)

    @property
    def accuracy(self) -> float:
        """Share of all labels there are that are guessed rightly."""
        return self.right / self.there if self.there else 1.0

    @property
    def precision(self) -> float:
        """Share of the guesses that are right."""
        return self.right / self.said if self.said else 1.0


def truths() -> Iterator[dict[str, Any]]:
    """Yield the truth tables, those looked at first."""
    tables = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(TRUTH.glob("*.json"))]
    yield from sorted(tables, key=lambda t: (not t["looked_at"], t["set"]))


def measure(table: dict[str, Any]) -> dict[str, Score]:
    """Return field -> score of reading a set's names together."""
    scores = {name: Score() for name in FIELDS}
    guesses = read_names(list(table["clips"]))
    for clip, truth in table["clips"].items():
        for name, score in scores.items():
            guess, wanted = getattr(guesses[clip], name), truth[name]
            if wanted is None:
                score.needless += guess is not None
                continue
            score.there += 1
            if guess is not None:
                right = guess.value == wanted
                score.said += 1
                score.right += right
                score.confidences.append((guess.confidence, right))
            if guess is None or guess.value != wanted:
                got = (
                    "nothing"
                    if guess is None
                    else f"'{guess.value}' ({guess.confidence:.2f}: {guess.reason})"
                )
                score.wrong.append(f"{clip}: {name} '{wanted}', read as {got}")
    return scores


def calibration(scores: list[Score]) -> Iterator[tuple[float, float, int, float, float]]:
    """Yield (from, to, guesses, mean confidence, share right) of each bin."""
    all_of = [c for score in scores for c in score.confidences]
    for low, high in BINS:
        chosen = [(c, right) for c, right in all_of if low <= c < high]
        if chosen:
            yield (
                low,
                high,
                len(chosen),
                statistics.mean(c for c, _ in chosen),
                statistics.mean(r for _, r in chosen),
            )


def main() -> None:
    of_looked: dict[bool, list[Score]] = {True: [], False: []}
    print(
        f"{'set':18s} {'looked at':10s}"
        + "".join(f"{name:>24s}" for name in FIELDS)
        + "   (right/said/there +needless)"
    )
    for table in truths():
        scores = measure(table)
        of_looked[table["looked_at"]] += scores.values()
        cells = [
            f"{s.right}/{s.said}/{s.there}"
            + (f" +{s.needless}" if s.needless else "")
            + (f" {s.accuracy:6.1%}" if s.there else "      -")
            for s in scores.values()
        ]
        print(
            f"{table['set']:18s} {'yes' if table['looked_at'] else 'no':10s}"
            + "".join(f"{c:>24s}" for c in cells)
        )
        if "-v" in sys.argv:
            for score in scores.values():
                print(*(f"    {line}" for line in score.wrong), sep="\n")
    print("\nfirst read (right/there)")
    for table in truths():
        if first := table.get("first_read"):
            print(
                f"{table['set']:28s} "
                + "   ".join(
                    f"{name} {right}/{there} {right / there:.1%}" for name, (right, there) in first.items()
                )
            )
    for looked, scores_of in of_looked.items():
        print(
            f"\nconfidence, sets {'looked at' if looked else 'not looked at'}: bin, guesses, mean "
            "confidence, right"
        )
        for low, high, count, mean, right in calibration(scores_of):
            print(f"  {low:.2f}..{min(high, 1):.2f} {count:5d} {mean:7.2f} {right:7.1%}")
    names = [n for table in truths() for n in table["clips"]]
    thousand = [f"{n}_{i}" for i in range(1000 // len(names) + 1) for n in names][:1000]
    times = []
    for _ in range(5):
        begun = time.perf_counter()
        read_names(thousand)
        times.append(time.perf_counter() - begun)
    print(f"\n{len(thousand)} names in {statistics.median(times):.3f} s")


if __name__ == "__main__":
    main()
