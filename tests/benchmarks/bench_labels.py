"""How often labels are proposed rightly: python tests/benchmarks/bench_labels.py

With names and motion, with names alone and with names hidden, on the sample clips and on labelled sets made
by others, by field. A stance counts as right where most clips proposed for it are of that stance. Then with
wrong names: a fifth of the clips swap names with clips of another kind, stance or layer, by five seeds; how
many of those are flagged, and how many of the others. Prints the tables of docs/labels.md.
"""

from __future__ import annotations

import json
import random
import sys
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.imports import gather, import_files  # noqa: E402
from metagraph.graph.model import Project  # noqa: E402
from metagraph.suggest.propose import Proposals, accept, propose  # noqa: E402

TRUTH = ROOT / "tests" / "suggest" / "truth"
FIELDS = ("kind", "stance", "end_stance", "layer", "limb")
WAYS = {"names and motion": ("name", "motion"), "names alone": ("name",), "names hidden": ("motion",)}
SEEDS = 5
UNSURE = 0.7  # below this somebody looks at it anyway
SETS = ("sample_clips", "kaykit-rogue", "robot-expressive", "sumerian-hosts", "bandai-namco-1", "fbx-pab")


def projects(name: str) -> list[Project]:
    """Return a set's clips as projects, one for each skeleton."""
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


def count(project: Project, truth: Mapping[str, Any], found: Proposals) -> tuple[Counter[str], Counter[str]]:
    """Return by field how many were right, and how many there are."""
    told = {clip.id: row for clip in project.clips.values() if (row := truth.get(clip.name)) is not None}
    meant: dict[str, Counter[str]] = defaultdict(Counter)
    for ident, row in told.items():
        p = found.proposals.get(ident)
        if p is not None and p.stance is not None and row["stance"] is not None:
            meant[p.stance.value][row["stance"]] += 1
    best = {key: votes.most_common(1)[0][0] for key, votes in meant.items()}
    right, there = Counter[str](), Counter[str]()
    for ident, row in told.items():
        p = found.proposals.get(ident)
        for field in FIELDS:
            if row.get(field) is None:
                continue
            there[field] += 1
            belief = getattr(p, field) if p is not None else None
            value = belief.value if belief is not None else None
            right[field] += (best.get(str(value)) if "stance" in field else value) == row[field]
    return right, there


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


def flagged(project: Project, truth: Mapping[str, Any]) -> Counter[str]:
    """Return how many clips with wrong and with right names there were, with a conflict told, and unsure (or
    with one).
    """
    out = Counter[str]()
    for seed in range(SEEDS):
        wrong, lying = swapped(project, truth, seed)
        if not lying:
            continue
        found = propose(wrong, sources=("name", "motion"))
        for ident, clip in project.clips.items():
            if (truth.get(clip.name) or {}).get("kind") is None:
                continue
            p = found.proposals.get(ident)
            which = "wrong" if ident in lying else "right"
            out[which] += 1
            out[f"{which} told"] += p is not None and bool(p.conflicts)
            out[f"{which} unsure"] += p is None or bool(p.conflicts) or p.confidence < UNSURE
    return out


def main() -> None:
    lies: list[str] = []
    rows: dict[str, list[str]] = {way: [] for way in WAYS}
    for name in SETS:
        data = json.loads((TRUTH / f"{name}.json").read_text("utf-8"))
        known: Sequence[Project] = projects(name)
        tally: Counter[str] = sum((flagged(project, data["clips"]) for project in known), Counter())
        if tally["wrong"]:
            cells = " | ".join(
                f"{tally[f'{w} {f}']}/{tally[w]} ({tally[f'{w} {f}'] / max(tally[w], 1):.0%})"
                for w in ("wrong", "right")
                for f in ("told", "unsure")
            )
            lies.append(f"| {name} | {cells} |")
        for way, sources in WAYS.items():
            right, there = Counter[str](), Counter[str]()
            placed = clips = 0
            for project in known:
                found = propose(project, sources=sources)  # type: ignore[arg-type]
                good, every = count(project, data["clips"], found)
                right, there = right + good, there + every
                placed, clips = placed + len(accept(project, found).placed), clips + len(project.clips)
            if clips:
                cells = " | ".join(f"{right[f]}/{there[f]}" if there[f] else "–" for f in FIELDS)
                rows[way].append(f"| {name} | {cells} | {placed}/{clips} |")
    for way, lines in rows.items():
        print(
            f"\n### With {way}\n\n| set | kind | stance | end stance | layer | limb | placed "
            "|\n|---|---|---|---|---|---|---|"
        )
        print("\n".join(lines))
    columns = ("set", "wrong: told", "wrong: told or unsure", "right: told", "right: told or unsure")
    print(f"\n### With wrong names\n\n| {' | '.join(columns)} |\n|---|---|---|---|---|")
    print("\n".join(lies))


if __name__ == "__main__":
    main()
