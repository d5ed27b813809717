"""A study's preregistration: the forms of OSF and of AsPredicted filled in from its plan, frozen by digest.

What they say of the analysis is what the report does, so that nothing is chosen after the data are seen.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

import msgspec

from metagraph import __version__
from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.research.study.analysis.results import TITLES
from metagraph.research.study.logs.log import format_wall_time
from metagraph.research.study.plan.freeze import seal, study_manifest
from metagraph.research.study.plan.planning import Assumed, SampleSize
from metagraph.research.study.scores.tasks import AWAY
from metagraph.research.study.study_plan import Study

FOLDER, RECORD = "preregistration", "plan.json"
TITLE_OF = {"osf.md": "OSF Preregistration", "aspredicted.md": "AsPredicted"}


@dataclass(frozen=True)
class Aims:
    """What a study was planned by. within, chance, alpha, families: as `sample_size` takes them."""

    found: Assumed
    needed: SampleSize
    smallest: float
    within: float
    chance: float
    alpha: float = 0.05
    families: int = 1


def preregister(study: Study, aims: Aims, secret: str | None, force: bool = False) -> list[Path]:
    """Write both forms and a record of them with their digests into a folder beside the study; return the
    files. secret: the digest of the allocation's secret. Raises FileError if they are there and would change,
    unless forced.
    """
    folder = study.folder / FOLDER
    digests = study_manifest(study)
    forms = {
        "osf.md": write_osf_form(study, aims, secret, seal(digests)),
        "aspredicted.md": as_predicted(study, aims, secret, seal(digests)),
    }
    told = {name: hashlib.sha256(text.encode()).hexdigest() for name, text in forms.items()}
    record = folder / RECORD
    if record.is_file() and not force:
        if _record(record).get("forms") == told:
            return [record, *(folder / name for name in forms)]
        raise FileError(
            record,
            "there is a preregistration already, and this one would be another",
            "forms",
            "Keep it, or write anew with --force, and register the new one, too.",
        )
    data = {
        "written": format_wall_time(datetime.now(UTC)),
        "version": __version__,
        "study": seal(digests),
        "forms": told,
        "allocation": secret,
        "assumed": asdict(aims.found),
        "needed": asdict(aims.needed),
        "aims": {k: getattr(aims, k) for k in ("smallest", "within", "chance", "alpha", "families")},
    }
    content = {name: text.encode() for name, text in forms.items()}
    content[RECORD] = (json.dumps(data, indent=1, ensure_ascii=False) + "\n").encode()
    for name, text in content.items():
        write_atomically(folder / name, text)
    return [record, *(folder / name for name in forms)]


def _record(path: Path) -> Mapping[str, object]:
    try:
        found = msgspec.json.decode(read_file(path, TEXT_FILE))
        return found if isinstance(found, dict) else {}
    except msgspec.DecodeError:
        return {}


def list_departures(study: Study) -> list[str]:
    """Return in words what is not as it was preregistered; nothing if nothing was."""
    folder = study.folder / FOLDER
    if not (folder / RECORD).is_file():
        return []
    record = _record(folder / RECORD)
    out = []
    if record.get("study") != seal(study_manifest(study)):
        out.append("the study is not as it was preregistered")
    forms = record.get("forms")
    for name, told in forms.items() if isinstance(forms, dict) else ():
        path = folder / str(name)
        if not path.is_file() or hashlib.sha256(path.read_bytes()).hexdigest() != told:
            out.append(f"the form '{FOLDER}/{name}' is not as it was written")
    return out


# --- the forms


def _people(study: Study, aims: Aims) -> str:
    n, need = len(study.plan.ids), aims.needed
    said = {
        f"a ratio of {aims.found.ratio:.2f}": need.show,
        f"the smallest ratio that matters, {aims.smallest:g}": need.smallest,
        f"an interval that reaches no further than {aims.within:g} times either way": need.precise,
        f"that a ratio of 1 is within 1/{aims.smallest:g} and {aims.smallest:g}": need.equivalent,
    }
    rows = "; ".join(
        f"{what}: {count if count is not None else 'more than 10,000'}" for what, count in said.items()
    )
    return (
        f"{n} participants. Needed with a chance of {aims.chance:.0%} each (two-sided alpha {aims.alpha:g}"
        + (f", shared among {aims.families} tests" if aims.families > 1 else "")
        + f") to show {rows}. Reckoned with a standard deviation of the logs of people's ratios of "
        f"{aims.found.worst:.2f} ({aims.found.source})."
    )


def _existing(study: Study) -> str:
    begun = sum(study.log(who).is_file() for who in study.plan.ids)
    if not begun:
        return "No data have been collected for this study yet."
    return f"Data of {begun} participants exist already; this was written after they were collected."


def _conditions(study: Study) -> str:
    return " and ".join(TITLES[c] for c in study.plan.conditions)


def _tasks(study: Study) -> str:
    return "; ".join(
        f"{t.name} ({f'limit {t.minutes:g} minutes' if t.minutes else 'no limit'})" for t in study.plan.tasks
    )


def _hypothesis(study: Study, aims: Aims) -> str:
    return (
        f"Working on the {TITLES['manual']} takes longer than with the {TITLES['meta']}: the ratio of "
        "times is greater "
        f"than 1. The smallest ratio that matters is {aims.smallest:g}; a ratio is taken to be "
        "equivalent to 1 when its "
        f"90 % interval lies between 1/{aims.smallest:g} and {aims.smallest:g}."
    )


_NAMES = {
    "shown": "",
    "hidden": "Clips have numbers instead of names, in all tasks.",
    "both": "Everybody has the names of clips in one half of the tasks and numbers in the other, the same in "
    "every condition; which half alternates over participants and is crossed with both orders.",
}


def _order(study: Study, secret: str | None) -> str:
    return " ".join(filter(None, (_drawn(study, secret), _NAMES[study.plan.names])))


def _drawn(study: Study, secret: str | None) -> str:
    plan = study.plan
    if plan.order == "concealed":
        return (
            "Everybody does every condition. Which of the counterbalanced orders (Williams' squares) a "
            "participant "
            "gets is drawn when they begin, in permuted blocks of one or two rounds, from a secret "
            "that nobody who "
            f"leads a sitting reads. SHA-256 of the secret: {secret or 'not made yet'}. It is "
            "published afterwards."
        )
    if plan.order == "latin":
        return (
            f"Everybody does every condition. Orders of conditions and tasks go by Williams' squares, "
            f"seed {plan.seed}, "
            "by the participant's number; whoever leads a sitting could know them."
        )
    return "The study file gives everybody's order of conditions and tasks."


def _outcomes(study: Study) -> list[str]:
    sheets = [q.title or q.id for q in study.plan.questions()]
    return [
        f"Primary: active time of each task in seconds, without pauses and gaps of more than {AWAY:g} s.",
        "Secondary: F1 of connections beside the task's reference"
        + (f"; {', '.join(sheets)}." if sheets else "."),
    ]


ANALYSIS = (
    "Each participant counts once, by the geometric mean of the tasks done in both conditions. Times "
    "are compared on "
    "logs: the ratio of geometric means with Student's 95 % interval, and a paired t test. F1 and the "
    "questionnaires' "
    "totals by paired t tests. Holm's correction over all of these tests; nothing else is tested. "
    "Reported beside it, "
    "whatever it says: the Hodges-Lehmann estimate, the ratio without each participant, with gaps of "
    "30 s, 120 s and "
    "none taken off, both orders weighing the same, a mixed model with sitting, practice and task "
    "(people and their "
    "ratios random, REML), times cut short by the limit as censored, and time to a machine without mistakes."
)
EXCLUDED = (
    "Nobody is left out for being slow, fast or mistaken. Left out: who withdraws, who finished no "
    "task in one of the "
    "conditions or no task in both, and tasks that were broken off. Odd values (more than 3.5 robust "
    "deviations from "
    "the median, times beyond the limit) are told and stay in."
)


def write_osf_form(study: Study, aims: Aims, secret: str | None, sealed: str) -> str:
    """Return the form of OSF's preregistration."""
    return _form(
        f"{study.plan.title}: OSF Preregistration",
        (
            ("Study information", ""),
            ("Hypotheses", _hypothesis(study, aims)),
            ("Design plan", ""),
            ("Study type", "Experiment: a researcher assigns orders of treatments to participants."),
            (
                "Blinding",
                "Participants know which editor they use. Mistakes are counted by the program. "
                + (
                    "Whoever leads a sitting does not know the order beforehand."
                    if study.plan.order == "concealed"
                    else "Whoever leads a sitting is not blind to the order."
                ),
            ),
            ("Study design", f"Within participants: {_conditions(study)}. Tasks: {_tasks(study)}."),
            ("Randomization", _order(study, secret)),
            ("Sampling plan", ""),
            ("Existing data", _existing(study)),
            (
                "Data collection procedures",
                f"By the program, version {__version__}, from the study file; one log a participant.",
            ),
            ("Sample size", f"{len(study.plan.ids)} participants."),
            ("Sample size rationale", _people(study, aims)),
            (
                "Stopping rule",
                "All participants named in the study file; nothing is looked at before the last.",
            ),
            ("Variables", ""),
            ("Manipulated variables", f"The editor: {_conditions(study)}."),
            ("Measured variables", " ".join(_outcomes(study))),
            (
                "Indices",
                "SUS and raw NASA-TLX as published; F1 the harmonic mean of precision and recall of "
                "connections.",
            ),
            ("Analysis plan", ""),
            ("Statistical models", ANALYSIS),
            ("Transformations", "Natural logarithms of seconds."),
            (
                "Inference criteria",
                f"Two-sided alpha {aims.alpha:g} after Holm's correction; equivalence at "
                f"{aims.alpha:g}, one-sided twice.",
            ),
            ("Data exclusion", EXCLUDED),
            ("Missing data", "What is missing is told, with whose it is, and left out; nothing is imputed."),
            (
                "Exploratory analysis",
                "Practice, order, what the time went into, the keystroke-level model: intervals only.",
            ),
            ("Other", f"SHA-256 over references, clips, consent and questions: {sealed}."),
        ),
    )


def as_predicted(study: Study, aims: Aims, secret: str | None, sealed: str) -> str:
    """Return the form of AsPredicted."""
    return _form(
        f"{study.plan.title}: AsPredicted",
        (
            ("1) Data collection. Have any data been collected for this study already?", _existing(study)),
            (
                "2) Hypothesis. What's the main question being asked or hypothesis being tested in "
                "this study?",
                _hypothesis(study, aims),
            ),
            (
                "3) Dependent variable. Describe the key dependent variable(s) specifying how they "
                "will be measured.",
                " ".join(_outcomes(study)),
            ),
            (
                "4) Conditions. How many and which conditions will participants be assigned to?",
                f"{len(study.plan.conditions)}, within participants: {_conditions(study)}. "
                f"{_order(study, secret)}",
            ),
            (
                "5) Analyses. Specify exactly which analyses you will conduct to examine the main "
                "question/hypothesis.",
                ANALYSIS,
            ),
            (
                "6) Outliers and exclusions. Describe exactly how outliers will be defined and "
                "handled, and your precise rule(s) for excluding observations.",
                EXCLUDED,
            ),
            (
                "7) Sample size. How many observations will be collected or what will determine sample size?",
                _people(study, aims),
            ),
            (
                "8) Other. Anything else you would like to pre-register?",
                f"Practice, order and what the time went into are explored, with intervals only. "
                f"SHA-256 over references, clips, consent and questions: {sealed}.",
            ),
            ("9) Name. Give a title for this AsPredicted pre-registration.", study.plan.title),
        ),
    )


def _form(title: str, parts: Sequence[tuple[str, str]]) -> str:
    out = [f"# {title}"]
    for heading, text in parts:
        out.append(f"## {heading}" if not text else f"### {heading}\n\n{text}")
    return "\n\n".join(out) + "\n"
