"""How well the mismatched-speech protocol finds what is planted: python tests/benchmarks/bench_mismatched.py

Simulated studies of 24 people and 12 stretches, in which five systems' own sounds are recognised better and
better, two of them equally well. Prints the tables of docs/researchers/perceptual-studies.md: each system
beside chance, and systems beside each other.
"""

from __future__ import annotations

import sys
from collections import Counter
from itertools import combinations
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.research.study.perceive import sealed  # noqa: E402
from metagraph.research.study.perceive.crossed import compute_overall_share  # noqa: E402
from metagraph.research.study.perceive.mismatched import list_stretches, make_mismatched_plan  # noqa: E402
from metagraph.research.study.perceive.perceive_analysis import analyse_answers  # noqa: E402
from metagraph.research.study.perceive.perceive_data import collect_answers  # noqa: E402
from metagraph.research.study.perceive.perceive_plan import parse_perceive_plan  # noqa: E402
from metagraph.research.study.perceive.simulated import Raters, write_simulated  # noqa: E402

STUDIES = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
PLANTED = {"a": 0.0, "b": 0.3, "c": 0.6, "d": 0.6, "e": 1.2}  # log odds of choosing the own sound


def main() -> None:
    sealed.ROUNDS = 1  # nobody's answers are hidden here
    shows = {name: {"conversation": "Office"} for name in PLANTED}
    words = make_mismatched_plan("T", 24, shows, list_stretches(96, 8, 12), "p.yaml")
    held, found = dict.fromkeys(PLANTED, 0), dict.fromkeys(PLANTED, 0)
    apart: Counter[tuple[str, str]] = Counter()
    covered: Counter[tuple[str, str]] = Counter()
    for seed in range(STUDIES):
        raters = Raters({f"{n}-own": v for n, v in PLANTED.items()}, lapses=0, seed=seed)
        with TemporaryDirectory() as folder:
            study = write_simulated(
                Path(folder), parse_perceive_plan(words), words.encode(), f"s{seed}", raters
            )
            results = analyse_answers(collect_answers(study))
        for pair in results.pairs:
            name = pair.pair[0].removesuffix("-own")
            model = pair.model
            held[name] += model is not None and model.effects["preference"].holds(PLANTED[name])
            found[name] += pair.verdict in ("preferred", "not preferred")
        for each in results.systems:
            a, b = each.systems
            covered[a, b] += each.difference.holds(PLANTED[a] - PLANTED[b])
            apart[a, b] += each.better is not None
    print(f"{STUDIES} studies")
    print("| own sound recognised by | studies that find it | 95 % intervals that hold it |")
    print("|---|---|---|")
    for name, planted in PLANTED.items():
        share = compute_overall_share(planted, 0.5)
        print(f"| {share:.0%} | {found[name] / STUDIES:.1%} | {held[name] / STUDIES:.1%} |")
    print("| systems | studies that tell them apart | 95 % intervals that hold the difference |")
    print("|---|---|---|")
    for a, b in combinations(PLANTED, 2):
        one, other = (compute_overall_share(PLANTED[name], 0.5) for name in (a, b))
        told, right = apart[a, b] / STUDIES, covered[a, b] / STUDIES
        print(f"| {one:.0%}, {other:.0%} | {told:.1%} | {right:.1%} |")


if __name__ == "__main__":
    main()
