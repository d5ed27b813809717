"""How often labels are proposed rightly: python tests/benchmarks/bench_labels.py [--zoo N] [--json FILE]

On the sample clips, on labelled sets made by others, and on sets made from the sample clips
(`tests.label_zoo`), each left out of whatever is learned from the others: with names and motion, with names
alone and with names hidden, by field. A stance counts as right where most clips proposed for it are of that
stance; "all four" are clips all of whose kind, layer, stance and end stance are right; "rightly skipped" are
those that are none of the four kinds and are marked so. Then: whether what is wrong is flagged for a look,
how often what is said with what confidence is right, how much is right after a person's first looks, and what
happens with wrong names. "seen" are sets that whoever wrote the product looked at. Prints the tables of
docs/contributing/labelling-figures.md.
"""

from __future__ import annotations

import argparse
import importlib
import json
import random
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, pairwise
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.imports import gather, import_files  # noqa: E402
from metagraph.graph.model import Project  # noqa: E402
from metagraph.suggest.propose import propose  # noqa: E402
from tests.label_zoo import catalogue  # noqa: E402
from tests.label_zoo.measure import (  # noqa: E402
    BINS,
    CAUSES,
    FIELDS,
    LabelSet,
    Proposer,
    Tally,
    looked,
    measured,
    others,
)

TRUTH = ROOT / "tests" / "suggest" / "truth"
WAYS = {"names and motion": ("name", "motion"), "names alone": ("name",), "names hidden": ("motion",)}
WHOLE = "names and motion"
HEADS = {"clip": "all four", "none": "rightly skipped"}
LOOKS = (0, 5, 10, 20)
SEEDS = 5
UNSURE = 0.7  # below this somebody looks at it anyway
SPREAD = (  # of the zoo, where not all of it is measured on
    "long limbs on mixamo",
    "random axes, a turned rest",
    "gestures that do not return",
    "strewn over the floor",
    "standing talker by number",
    "numbers of unseen stances",
    "arms tell the stances",
    "sitting without legs",
    "sitting, leaning, standing",
    "close stances, unseen, recorded",
    "one stance and exercises",
    "codes before and takes behind",
    "german names",
    "chinese names",
    "opaque takes",
    "all at once",
)
# given the sets that may be learned from, a function as `propose`
Trainer = Callable[[Sequence[LabelSet]], Proposer]


def projects(name: str) -> list[Project]:
    """Return a set's clips as projects, one for each skeleton; none where the set is not there."""
    folder = (
        ROOT / "sample_clips" / "clips" if name == "sample_clips" else ROOT.parent / "shared" / "data" / name
    )
    files = gather([folder]) if folder.is_dir() else []
    out = []
    while files:
        project = import_files(Project(name), None, files).into(Project(name))
        if not project.clips:
            break
        out.append(project)
        taken = {Path(clip.path).resolve() for clip in project.clips.values()}
        files = [path for path in files if path.resolve() not in taken]
    return out


def real_sets() -> Iterator[LabelSet]:
    """Load the sets that somebody made by hand and that are labelled."""
    for path in sorted(TRUTH.glob("*.json"), key=lambda p: (p.stem != "sample_clips", p.stem)):
        data = json.loads(path.read_text("utf-8"))
        if found := projects(path.stem):
            yield LabelSet(path.stem, found, data["clips"], bool(data["looked_at"]))


def zoo_sets(count: int | None, seed: int = 0) -> Iterator[LabelSet]:
    """Make sets: SPREAD when None, else so many, the named ones first."""
    names = SPREAD if count is None else tuple(catalogue.RECIPES)[:count]
    drawn = 0 if count is None else count - len(names)
    for made in chain(catalogue.named_sets(names), catalogue.made_sets(drawn, seed)):
        what = ("zoo", *made.what)
        yield LabelSet(made.name, [made.project], made.truth, False, made.made_from, what)


def measure(one: LabelSet, propose_: Proposer = propose, looks: bool = True) -> dict[str, Any]:
    """Return a set's tallies by way, and its looks."""
    ways = {}
    for way, sources in WAYS.items():
        ways[way] = Tally()
        for project in one.projects:
            ways[way] += measured(project, one.truth, propose_(project, sources=sources))
    after: dict[int, Counter[str]] = {n: Counter() for n in LOOKS}
    for project in one.projects if looks else ():
        for n, state in looked(project, one.truth, LOOKS, propose_).items():
            after[n].update(state)
    return {"ways": ways, "looks": after}


def swapped(project: Project, truth: Mapping[str, Any], seed: int) -> tuple[Project, set[str]]:
    """Return a project in which a fifth of the labelled clips swapped names with one of another kind, stance
    or layer; and which did.
    """
    draw = random.Random(seed)
    told = {
        i: truth[c.name]
        for i, c in project.clips.items()
        if truth.get(c.name) and truth[c.name]["kind"] is not None
    }
    order = [*told]
    draw.shuffle(order)
    clips, lying = dict(project.clips), set[str]()
    for one in order:
        if len(lying) >= max(2, len(order) / 5):
            break
        unlike = (
            i
            for i in order
            if not {i, one} & lying and any(told[i][f] != told[one][f] for f in ("kind", "stance", "layer"))
        )
        other = next(unlike, None)
        if other is not None:
            lying |= {one, other}
            clips[one] = replace(clips[one], name=project.clips[other].name)
            clips[other] = replace(clips[other], name=project.clips[one].name)
    return replace(project, clips=clips), lying


def flagged(project: Project, truth: Mapping[str, Any], propose_: Proposer = propose) -> Counter[str]:
    """Return how many clips with wrong and with right names there were, with a conflict told, and unsure (or
    with one).
    """
    out = Counter[str]()
    for seed in range(SEEDS):
        wrong, lying = swapped(project, truth, seed)
        if not lying:
            continue
        found = propose_(wrong, sources=("name", "motion"))
        for ident, clip in project.clips.items():
            if (truth.get(clip.name) or {}).get("kind") is None:
                continue
            p = found.proposals.get(ident)
            which = "wrong" if ident in lying else "right"
            out[which] += 1
            out[f"{which} told"] += p is not None and bool(p.conflicts)
            out[f"{which} unsure"] += p is None or bool(p.conflicts) or p.confidence < UNSURE
    return out


# -- tables
# --------------------------------------------------------------------------------------------------


def share(part: float, whole: float) -> str:
    return f"{part / whole:.2f}" if whole else "–"


def fraction(part: float, whole: float) -> str:
    return f"{part:.0f}/{whole:.0f}" if whole else "–"


def table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]], before: str = "") -> None:
    print(f"\n### {title}\n")
    if before:
        print(f"{before}\n")
    print("\n".join(f"| {' | '.join(row)} |" for row in (columns, ["---"] * len(columns), *rows)))


def groups(results: Sequence[tuple[LabelSet, dict[str, Any]]]) -> dict[str, dict[str, Any]]:
    """Return results by what the tables have a row for: each set that was not made, and the made ones by
    their troubles.
    """
    out: dict[str, dict[str, Any]] = {}
    counts = Counter[str]()
    for one, result in results:
        for name in one.what or (f"{one.name}{' (seen)' if one.seen else ''}",):
            name = f"zoo: {name}" if one.what and name != "zoo" else name
            counts[name] += 1
            mine = out.setdefault(name, {"ways": {}, "looks": {n: Counter() for n in LOOKS}})
            for way, tally in result["ways"].items():
                mine["ways"].setdefault(way, Tally()).__iadd__(tally)
            for n, state in result["looks"].items():
                mine["looks"][n].update(state)
    order = sorted(out, key=lambda name: (name.startswith("zoo"), name != "zoo", name))
    real = [name for name in order if not name.startswith("zoo")]
    named = {name: f"{name}, {counts[name]} sets" if name.startswith("zoo") else name for name in order}
    return {named[name]: out[name] for name in [*real, *(n for n in order if n.startswith("zoo"))]}


def show(rows: Mapping[str, Mapping[str, Any]]) -> None:
    """Print the tables of what was measured."""
    fields = (*FIELDS, "clip", "none")
    heads = [HEADS.get(f, f.replace("_", " ")) for f in fields]
    for way in WAYS:
        lines = []
        for name, result in rows.items():
            tally: Tally = result["ways"][way]
            cells = [fraction(tally.right[f], tally.there[f]) for f in fields]
            lines.append([name, *cells, fraction(tally.placed, tally.clips)])
        table(f"With {way}", ["set", *heads, "placed"], lines)
    lines = []
    for name, result in rows.items():
        f = result["ways"][WHOLE].flags
        cells = [fraction(f["flagged"], f["clips"]), fraction(f["wrong"], f["clips"])]
        cells += [share(f["both"], f["flagged"]), share(f["both"], f["wrong"])]
        lines.append([name, *cells, *(fraction(f[f"{c} wrong"], f[c]) for c in CAUSES)])
    columns = ["set", "flagged", "wrong", "precision", "recall", *(f"wrong among {c}" for c in CAUSES)]
    table("What needs a look", columns, lines, "Flags against what is wrong, with names and motion.")
    bins = [f"{a:.2f}–{min(b, 1):.2f}" for a, b in pairwise(BINS)]
    for kind in ("made by others", "zoo"):
        whole = {way: Tally() for way in WAYS}
        for name, result in rows.items():
            if (name.split(",")[0] == "zoo") if kind == "zoo" else not name.startswith("zoo"):
                for way in WAYS:
                    whole[way] += result["ways"][way]
        lines = []
        for way in (WHOLE, "names hidden"):
            for name in ("kind", "layer", "stance", "end_stance", "limb", "clip"):
                if name in whole[way].sure:
                    cells = [
                        f"{share(r, n)} of {n} (said {share(said, n)})" if n else "–"
                        for n, r, said in whole[way].sure[name]
                    ]
                    lines.append(
                        [f"{name.replace('_', ' ')}, {way}", *cells, f"{whole[way].calibration(name):.3f}"]
                    )
        if lines:
            table(f"How often what is said is right, {kind}", ["said", *bins, "off by"], lines)
    lines = []
    for name, result in rows.items():
        if result["looks"][0]["all"]:
            states = [result["looks"][n] for n in LOOKS]
            cells = [
                f"{share(s['rest right'], s['rest'])} "
                f"({share(s['all right'], s['all'])}; {s['told']} corrected)"
                for s in states
            ]
            lines.append([name, *cells])
    if lines:
        heads = ["set", *(f"{n} looks" for n in LOOKS)]
        table("After looks", heads, lines, "Right of the rest (of all; fields corrected).")


def show_wrong_names(sets: Sequence[tuple[LabelSet, Counter[str]]]) -> None:
    lines = []
    for one, tally in sets:
        if tally["wrong"]:
            cells = [
                f"{tally[f'{w} {f}']}/{tally[w]} ({tally[f'{w} {f}'] / max(tally[w], 1):.0%})"
                for w in ("wrong", "right")
                for f in ("told", "unsure")
            ]
            lines.append([one.name, *cells])
    columns = (
        "set",
        *("wrong names: conflict", "wrong names: conflict or unsure"),
        *("right names: conflict", "right names: conflict or unsure"),
    )
    table("With wrong names", columns, lines)


def main() -> None:
    parser = argparse.ArgumentParser(description="How often labels are proposed rightly.")
    parser.add_argument("--zoo", type=int, metavar="N", help="made sets to measure on; else a spread of 16")
    parser.add_argument("--seed", type=int, default=0, help="of the made sets that are drawn")
    parser.add_argument("--only", nargs="*", metavar="SET", help="measure on these sets alone")
    parser.add_argument("--quick", action="store_true", help="without looks and without wrong names")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all that was measured here")
    parser.add_argument(
        "--trainer",
        metavar="MODULE:FUNCTION",
        help="learns from the sets it is given and returns a function as `propose`; no set is measured with "
        "what learned from it, from one made of it, or from what it is made of",
    )
    parser.add_argument("--siblings", action="store_true", help="made sets may learn from other made sets")
    options = parser.parse_args()
    began = time.perf_counter()
    trainer: Trainer | None = None
    if options.trainer:
        module, _, function = options.trainer.partition(":")
        trainer = getattr(importlib.import_module(module), function)
    stream = chain(real_sets(), zoo_sets(options.zoo, options.seed))
    every = list(stream) if trainer is not None else stream
    results: list[tuple[LabelSet, dict[str, Any]]] = []
    wrong: list[tuple[LabelSet, Counter[str]]] = []
    for one in every:
        if options.only and one.name not in options.only:
            continue
        proposer = trainer(others(every, one, options.siblings)) if trainer is not None else propose
        result = measure(one, proposer, not options.quick)
        if not one.what and not options.quick:
            tallies = (flagged(project, one.truth, proposer) for project in one.projects)
            wrong.append((one, sum(tallies, Counter[str]())))
        kept = one if trainer is not None else replace(one, projects=())  # nothing keeps the motions
        results.append((kept, result))
        print(f"{time.perf_counter() - began:6.1f} s  {one.name}", file=sys.stderr)
    show(groups(results))
    if wrong:
        show_wrong_names(wrong)
    if options.json:
        data = {
            one.name: {
                "seen": one.seen,
                "made_from": one.made_from,
                "what": one.what,
                "ways": {way: tally.to_json() for way, tally in result["ways"].items()},
                "looks": {str(n): dict(state) for n, state in result["looks"].items()},
            }
            for one, result in results
        }
        names = {one.name: dict(tally) for one, tally in wrong}
        options.json.write_text(json.dumps({"sets": data, "wrong names": names}, indent=1), "utf-8")


if __name__ == "__main__":
    main()
