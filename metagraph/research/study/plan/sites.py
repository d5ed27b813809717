"""Several sites' copies of a study taken together: people distinguished by their site, which the mixed model
takes as a random effect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from metagraph.errors import FileError
from metagraph.research.study.analysis.reading import AnalysisRow, Data, Progress, collect_study
from metagraph.research.study.plan.freeze import find_changed_names, study_manifest
from metagraph.research.study.study_plan import read_study

OWN = frozenset({"order", "consent", "thanks", "instructions"})  # may be each site's own


def merge_site_data(
    folders: Sequence[str | Path], jumps: bool = True, progress: Progress | None = None
) -> Data:
    """Return the data of all folders as one. Raises FileError if one cannot be read, has not the same tasks
    and conditions, or is called as another is; what else differs is reported in `missing`.
    """
    studies = [read_study(f) for f in folders]
    names = [s.plan.site or s.folder.name for s in studies]
    first = studies[0]
    for study, name in zip(studies, names, strict=True):
        if names.count(name) > 1:
            raise FileError(
                study.path,
                f"two sites are called '{name}'",
                "site",
                "Give each study file a 'site' of its own.",
            )
        alike = [t.id for t in study.plan.tasks] == [t.id for t in first.plan.tasks]
        if not alike or set(study.plan.conditions) != set(first.plan.conditions):
            raise FileError(
                study.path,
                f"its tasks or conditions are not those of {first.path}",
                "tasks",
                "Merge sites of one study.",
            )
    missing: list[str] = []
    digests = {Path(k).name if "/" in k else k: v for k, v in study_manifest(first).items()}
    found: list[Data] = []
    for study, name in zip(studies, names, strict=True):
        mine = {Path(k).name if "/" in k else k: v for k, v in study_manifest(study).items()}
        differ = [
            n for n in find_changed_names(digests, mine) if n not in OWN and n not in ("tasks", "training")
        ]
        if differ:
            missing.append(
                f"{name}: {', '.join(differ[:5])} {'is' if len(differ) == 1 else 'are'} not {names[0]}'s."
            )
        found.append(_told_apart(collect_study(study.folder, jumps, progress), name))
    return replace(
        found[0],
        title=first.plan.title,
        participants=tuple(p for d in found for p in d.participants),
        rows=tuple(r for d in found for r in d.rows),
        ratings=tuple(r for d in found for r in d.ratings),
        answers=tuple(a for d in found for a in d.answers),
        missing=(*missing, *(m for d in found for m in d.missing)),
        simulated=any(d.simulated for d in found),
        people={p: t for d in found for p, t in d.people.items()},
        sites={p: s for d in found for p, s in d.sites.items()},
    )


def _told_apart(data: Data, site: str) -> Data:
    """Return the data with everybody's site before their name."""

    def named(who: str) -> str:
        return f"{site}-{who}"

    def row(r: AnalysisRow) -> AnalysisRow:
        return replace(r, run=replace(r.run, participant=named(r.run.participant)))

    return replace(
        data,
        participants=tuple(map(named, data.participants)),
        rows=tuple(map(row, data.rows)),
        ratings=tuple(replace(r, participant=named(r.participant)) for r in data.ratings),
        answers=tuple(replace(a, participant=named(a.participant)) for a in data.answers),
        missing=tuple(f"{site}-{m}" for m in data.missing),
        people={named(p): t for p, t in data.people.items()},
        sites={named(p): site for p in data.participants},
    )
