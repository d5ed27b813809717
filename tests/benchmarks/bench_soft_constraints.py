"""What loudness, speaking rate, words and retiming bring, and what they cost: python
tests/benchmarks/bench_soft_constraints.py

Made-up takes, in which swings of the arm are larger the louder it is said, by microphones that are not alike,
and 16 windows of 15 s of other speech. Correlations are of how it was said in the takes with how it is said
now, and of the hand's fastest moment in a clause with how loud that clause is; then how many windows of
scarce takes find motion at a tolerance of one frame, with retiming and without.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from statistics import fmean

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.graph.conversation.model import Segment  # noqa: E402
from metagraph.research.motion_graph.search_evaluation import (  # noqa: E402
    Beside,
    Setting,
    Trials,
    cut_segments,
    evaluate_search,
)
from metagraph.speech.prosody import measure_prosody  # noqa: E402
from metagraph.synthesis.assemble import assemble  # noqa: E402
from metagraph.synthesis.constraints import find_change_states, find_heard_at  # noqa: E402
from metagraph.synthesis.cooccurrence import measure_part_speeds  # noqa: E402
from metagraph.synthesis.graph import build_graph  # noqa: E402
from metagraph.synthesis.iconic_words import parse_word_wish  # noqa: E402
from metagraph.synthesis.prosody_costs import SpokenTake  # noqa: E402
from metagraph.synthesis.search.path_quality import measure_quality  # noqa: E402
from metagraph.synthesis.search.relaxing import Searching, answer_speech  # noqa: E402
from metagraph.synthesis.soft_constraints import SoftMaterial, SoftWish, make_soft_report  # noqa: E402
from metagraph.synthesis.states import key_states, read_states  # noqa: E402
from tests.synthesis.talking import VOICE, aloud, speech, talking  # noqa: E402

WORDS = (parse_word_wish("big"), parse_word_wish("round = river"))
WISHES = {
    "nothing": SoftWish(),
    "loudness 0.1": SoftWish(loudness=0.1),
    "loudness 0.25": SoftWish(loudness=0.25),
    "loudness 1": SoftWish(loudness=1),
    "rate 0.25": SoftWish(rate=0.25),
    "rate 1": SoftWish(rate=1),
    "both 0.25": SoftWish(loudness=0.25, rate=0.25),
    "words": SoftWish(words=WORDS),
    "words, to be met": SoftWish(words=WORDS, hard=True),
    "retimed by 15 %": SoftWish(retime=0.15),
    "all of them": SoftWish(0.25, 0.25, WORDS, retime=0.15),
}
SECONDS = 15.0
Recorded = tuple[list[Segment], list[float], SpokenTake]


def recorded(seed: int, seconds: int, gain: float) -> Recorded:
    said = speech(seconds, seed)
    steps, words, samples = aloud(said, seconds, seed, gain)
    return said, steps, SpokenTake(tuple(said), words, measure_prosody(said, words, samples, VOICE))


def wishes(takes: int = 8, windows: int = 16) -> None:
    """Print a line for each wish and search."""
    made = [recorded(n, 60, -12.0 * (n % 3)) for n in range(takes)]
    clips = [
        talking(f"take {n}", said, 60, n, sizes=[1 + 0.5 * step for step in steps])
        for n, (said, steps, _) in enumerate(made)
    ]
    states, speeches = read_states(clips), [said for said, *_ in made]
    graph = build_graph(states, keys=key_states(states, changes=find_change_states(states, speeches)))
    sound, spoken = find_heard_at(states, speeches), [one for *_, one in made]
    new = [recorded(100 + n, 30, -20.0) for n in range(windows)]

    def material(wish: SoftWish) -> SoftMaterial:
        return SoftMaterial(wish, states, clips, spoken, graph.threshold.limit)

    told = material(SoftWish(loudness=1, rate=1))
    print(
        f"{'asked for':<18}{'search':<8}{'loudness':>9}{'rate':>7}{'gesture':>9}{'jumps/s':>9}{'cost':>7}"
        f"{'words':>8}{'gave up':>9}{'off':>8}{'was':>8}{'a search':>10}"
    )
    for search in ("exact", "greedy"):
        for name, wish in WISHES.items():
            offer, rows, words, steps, moved, took = material(wish), [], [0, 0], [], [], 0.0
            times: list[tuple[float, float]] = []
            for said, heights, one in new:
                searching = Searching(search)  # type: ignore[arg-type]
                soft, begun = offer.constraints(one, 0.0, SECONDS), time.perf_counter()
                found = answer_speech(
                    graph, sound, cut_segments(said, 0, SECONDS), SECONDS, None, searching, soft=soft
                )
                took += time.perf_counter() - begun
                known = told.constraints(one, 0.0, SECONDS)
                report = make_soft_report(soft, states, found.path, found.retiming)
                looks = measure_quality(states, found.path)
                matches = make_soft_report(known, states, found.path, found.retiming).matches
                rows.append([*(m.correlation or 0.0 for m in matches), looks.jumps, found.path.cost])
                rows[-1].append(bool(found.given_up))
                words[0] += sum(w.met for w in report.words)
                words[1] += sum(w.known for w in report.words)
                if report.off is not None and report.was is not None:
                    times.append((1000 * report.off, 1000 * report.was))
                speed = measure_part_speeds(assemble(states, clips, found.path, retiming=found.retiming))[
                    "right_hand"
                ]
                for s, height in zip(said, heights, strict=True):
                    if s.kind == "clause" and s.end < SECONDS:
                        steps.append(height)
                        moved.append(speed[round(30 * s.start) : round(30 * s.end)].max())
            loud, rate, jumps, cost, given = np.mean(rows, axis=0)
            gesture = np.corrcoef(steps, moved)[0, 1]
            off, was = (f"{fmean(t):.0f} ms" for t in zip(*times, strict=True)) if times else ("-", "-")
            met = f"{words[0]}/{words[1]}" if words[1] else "-"
            print(
                f"{name:<18}{search:<8}{loud:>9.2f}{rate:>7.2f}{gesture:>9.2f}{jumps:>9.2f}{cost:>7.2f}"
                f"{met:>8}{given * windows:>9.0f}{off:>8}{was:>8}{took / windows:>8.2f} s",
                flush=True,
            )


def scarce() -> None:
    """Print how many windows of few takes find motion with retiming and without."""
    for share in (0.0, 0.15):
        found = cases = 0
        for takes, seconds in ((4, 45), (3, 45), (3, 30)):
            said = [speech(seconds, n) for n in range(takes)]
            clips = [talking(f"take {n}", s, seconds, n) for n, s in enumerate(said)]
            exactly = (Setting("a frame", tolerance=0.034),)
            wish = SoftWish(retime=share)
            (row,) = evaluate_search(
                clips, said, exactly, Trials(("exact",), 10, 5), beside=Beside(wish)
            ).rows
            found, cases = found + row.found, cases + row.cases
        print(f"within a frame, speed changed by up to {share:.0%}: {found} of {cases} windows find motion")


if __name__ == "__main__":
    wishes()
    scarce()
