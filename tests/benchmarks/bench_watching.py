"""How far watching bounds the race of experts: python tests/benchmarks/bench_watching.py

Reads the operators of docs/researchers/experts-paths-tables.md, where each clip is watched once. Prints the
ratio that nobody can exceed, because watching alone takes so long (no operators at all with the meta-graph),
and the ratio if both sides watch at twice the speed, chosen once below the character.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from metagraph.research.study.machines.klm import predict_seconds  # noqa: E402
from tests.app.participant import task  # noqa: E402

TABLES = ROOT / "docs" / "researchers" / "experts-paths-tables.md"
SAMPLE = ROOT / "sample_clips" / "sample.metagraph.yaml"
NAMES = ("Informative names", "Uninformative names")
META, MANUAL = "meta-graph, proposals", "state machine, best way found"
FASTER = 2.0  # the highest speed below the character
CHOOSE = {"M": 1, "P": 2, "B": 4, "H": 2}  # open the list of speeds, choose, back to the keys


def read_hands(names: str) -> dict[tuple[int, str], float]:
    """Return (clips, way) -> seconds of operators and waits, where each clip is watched once."""
    _, _, after = TABLES.read_text(encoding="utf-8").partition(f"### {names}; each clip watched once")
    out = {}
    for line in after.partition("\n### ")[0].splitlines():
        cells = [cell.strip() for cell in line.strip("| ").split("|")]
        if len(cells) > 8 and cells[0].isdecimal():
            counts = dict(zip("KPBHMS", (int(c.replace(",", "")) for c in cells[2:8]), strict=True))
            waits = float(cells[8].removesuffix("s"))
            out[int(cells[0]), cells[1].removesuffix(" (counted)")] = predict_seconds({**counts, "R": waits})
    return out


def compute_rows() -> list[tuple[int, str, float, float, float, float]]:
    """Return clips, names, watching in seconds, the ratio at normal speed, its bound, and that at FASTER."""
    project, more = open_project(SAMPLE).project, predict_seconds(CHOOSE)
    out = []
    for names in NAMES:
        hands = read_hands(names)
        for clips in sorted({n for n, _ in hands}):
            meta, manual = hands[clips, META], hands[clips, MANUAL]
            watched = sum(e.duration for e in task(project, clips).project.clips.values())
            fast = watched / FASTER + more
            out.append((
                clips, names, watched, (manual + watched) / (meta + watched),
                (manual + watched) / watched, (manual + fast) / (meta + fast),
            ))  # fmt: skip
    return out


def main() -> None:
    print("| clips | names | watching | ratio | no tool can exceed | ratio at twice the speed |")
    print("|---|---|---|---|---|---|")
    for clips, names, watched, ratio, bound, fast in compute_rows():
        named = names.split()[0].lower()
        print(f"| {clips} | {named} | {5 * round(watched / 5)} s | {ratio:.1f} | {bound:.1f} | {fast:.1f} |")


if __name__ == "__main__":
    main()
