"""How many strokes come on time: seven tags of one sentence, and 200 sentences of three to seven.

    .venv/bin/python tests/benchmarks/bench_strokes.py

The sample project; a sentence's words last 0.15 to 0.55 s, and each of some of them, which ones is drawn,
wants a gesture of the arms with a tag that is drawn, its stroke at the word's middle. All of it is asked for
at the sentence's beginning, half a second before the first word. Models fill the time before. On time:
within 0.1 s of the word's middle.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from metagraph.formats.store import open_project
from metagraph.graph.model import Project
from metagraph.graph.requests import Gesture, Go
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import answer_asks, hear_asks
from metagraph.playback.timing.phases import find_phases

SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / "sample.metagraph.yaml"
BEGIN, LEAD, SENTENCES = 20.0, 0.5, 200
TAGS = (
    "beat", "emphasis", "explain", "open", "unsure", "question", "you", "me", "other", "negative", "positive",
    "contrast", "size", "enumerate",
)  # fmt: skip


def sentence(draw: random.Random, count: int) -> list[tuple[float, str]]:
    """Return when strokes are wanted, in seconds from the sentence's beginning, and with which tags."""
    words = [draw.uniform(0.15, 0.55) for _ in range(2 * count)]
    starts = [LEAD + sum(words[:n]) for n in range(len(words))]
    chosen = sorted(draw.sample(range(len(words)), count))
    return [(starts[n] + words[n] / 2, draw.choice(TAGS)) for n in chosen]


def tried(project: Project, wanted: list[tuple[float, str]], late: float | None, seed: int) -> Counter[str]:
    """Return how many strokes were on time, late, and refused, and the worst lateness in ms."""
    stay = Go(id="stay", layer="arms", stance="hands at sides", stay=True)
    plan = hear_asks(project, Plan(seed, 0.0), 0.0, [stay], BEGIN + 20)
    given = {} if late is None else {"late": late}
    asks = [
        Gesture(id=f"g{n}", tags=(tag,), stroke=BEGIN + at, **given) for n, (at, tag) in enumerate(wanted)
    ]
    plan = hear_asks(project, plan, BEGIN, asks, BEGIN + 20)
    told = answer_asks(plan, [a.id for a in asks])
    at = {}
    for cue in plan.layers["arms"].cues:
        at[cue.meta] = cue.start + find_phases(project, cue.action).stroke - cue.entry
    for report in plan.reports:
        served = getattr(report, "by", "")
        if served in at:
            at[report.request] = at[served]
    out: Counter[str] = Counter()
    for ask in asks:
        if ask.id not in at:
            assert told[ask.id].state == "refused", told[ask.id]
            out["refused"] += 1
            continue
        error = at[ask.id] - (ask.stroke or 0.0)
        out["on time" if abs(error) <= 0.1 else "late" if error > 0 else "early"] += 1
        out["worst"] = max(out["worst"], round(1000 * error))
    return out


def main() -> None:
    project = open_project(SAMPLE).project
    draw = random.Random(7)
    seven = sentence(draw, 7)
    many = [sentence(draw, draw.randint(3, 7)) for _ in range(SENTENCES)]
    for late in (None, 1.0, 0.3, 0.0):
        one = tried(project, seven, late, 1)
        whole: Counter[str] = Counter()
        worst = 0
        for n, wanted in enumerate(many):
            found = tried(project, wanted, late, n)
            worst = max(worst, found.pop("worst", 0))
            whole += found
        total = sum(whole.values())
        words = ("on time", "early", "late", "refused")
        shares = ", ".join(f"{100 * whole[w] / total:.1f} % {w}" for w in words)
        ones = ", ".join(f"{one[w]} {w}" for w in words)
        name = "without late" if late is None else f"late: {late:g}"
        print(f"{name}: seven of one sentence: {ones}, worst {one['worst'] / 1000:.2f} s;")
        print(f"    {total} of {SENTENCES} sentences: {shares}, worst {worst / 1000:.2f} s")


if __name__ == "__main__":
    main()
