"""Tools that find what is wrong, also as it plays, and mend it as the buttons of the window do."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Annotated

from msgspec import Meta, Struct

from app.authoring.finding import name_stance
from app.authoring.tool import AuthorError, AuthorTool, EditReport, ToolOutcome, ToolWork
from app.stage.fixes import Fix, fix_unreachable
from app.stage.remedies import fix_clips
from app.translation import tr_noop
from metagraph.graph.check import check_project
from metagraph.graph.model import Project
from metagraph.graph.problem import Problem, Severity

LONGEST = 3600.0  # seconds that are played
MOST = 200  # problems of one call
ROUNDS = 4  # times that what is mended is looked at again
_ORDER: tuple[Severity, ...] = ("error", "warning", "hint")


class FindProblems(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """play: also let the character perform for so many seconds, and each action once, and report what a
    viewer would see go wrong; 0 does not. least: the mildest to report.
    """

    play: Annotated[float, Meta(ge=0, le=LONGEST)] = 0.0
    least: Severity = "hint"


class ProblemRow(Struct, omit_defaults=True):
    """A problem. id: for fix_problem, the same until it is solved. fix: what fix_problem does about it, and
    instead: what it does with `instead`; "" for nothing. takes_away: whether the fix removes something. at:
    seconds of the performance.
    """

    id: str
    severity: Severity
    code: str
    message: str
    remedy: str
    fix: str = ""
    instead: str = ""
    takes_away: bool = False
    layer: str = ""
    stance: str = ""
    action: str = ""
    clip: str = ""
    at: float | None = None


class ProblemList(Struct, omit_defaults=True):
    """Errors first. counts: of each severity. exportable: whether no error is in the way of an export. total:
    how many there are, of which these are the first.
    """

    counts: dict[str, int]
    exportable: bool
    total: int
    problems: list[ProblemRow]


class FixProblem(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """problems: ids that find_problems told; if there are none, all that can be mended without taking
    anything away. play: as for find_problems, if they were found so. instead: do what `instead` says.
    """

    problems: list[str] = []
    play: Annotated[float, Meta(ge=0, le=LONGEST)] = 0.0
    instead: bool = False


Found = tuple[Sequence[Problem], Mapping[Problem, Fix]]


def _find_problems(work: ToolWork, given: FindProblems) -> ToolOutcome:
    """Return what is wrong, and what can be done about it."""
    problems, fixes = _find(work, work.project, given.play)
    counts: dict[str, int] = {one: sum(p.severity == one for p in problems) for one in _ORDER}
    wanted = [p for p in problems if _ORDER.index(p.severity) <= _ORDER.index(given.least)]
    rows = [_make_row(work.project, p, fixes.get(p)) for p in wanted[:MOST]]
    return ToolOutcome(ProblemList(counts, counts["error"] == 0, len(wanted), rows))


def _fix_problem(work: ToolWork, given: FixProblem) -> ToolOutcome:
    """Mend problems as told, or all that can be mended without taking anything away."""
    if not given.problems:
        return _fix_all(work, given.play)
    problems, fixes = _find(work, work.project, given.play)
    known = {_make_problem_id(p): p for p in problems}
    lost = [ident for ident in given.problems if ident not in known]
    if lost:
        hint = "" if given.play else " One that was seen as it played needs `play` here, too."
        raise AuthorError(f"there is no problem '{lost[0]}' now; find_problems tells those there are.{hint}")
    project, notes = work.project, list[str]()
    for ident in dict.fromkeys(given.problems):
        problem = known[ident]
        fix = fixes.get(problem)
        fix = fix.instead if fix is not None and given.instead else fix
        if fix is None:
            raise AuthorError(f"{ident}: nothing mends it by itself. {problem.message}: {problem.remedy}")
        after = fix(project)
        if after is not project:
            notes.append(f"{problem.message}: {fix.words}")
        project = after
    return ToolOutcome(EditReport(notes=notes), project)


def _make_problem_id(problem: Problem) -> str:
    """Return what a problem is called as long as it is there, whatever else is edited."""
    p = problem
    about = (p.code, p.layer, p.stance, p.action, p.clip, p.state, p.link)
    return f"p-{hashlib.sha256(repr(about).encode()).hexdigest()[:8]}"


def _fix_all(work: ToolWork, play: float) -> ToolOutcome:
    """Mend what can be mended; what that leaves, again, since one mended thing may show the next."""
    project, notes = work.project, list[str]()
    for _ in range(ROUNDS):
        problems, fixes = _find(work, project, play)
        before = project
        for problem in problems:
            fix = fixes.get(problem)
            if fix is not None and not fix.alone:
                after = fix(project)
                if after is not project and after != project:
                    notes.append(f"{problem.message}: {fix.words}")
                    project = after
        if project is before or play:  # playing again takes as long as before
            break
    if not notes:
        raise AuthorError("nothing can be mended without taking something away; find_problems tells the rest")
    return ToolOutcome(EditReport(notes=list(dict.fromkeys(notes))), project)


def _find(work: ToolWork, project: Project, play: float) -> Found:
    problems = check_project(project)
    if play > 0:
        problems += work.rehearsal.see(project, play, work.watch("playing part"))
        problems.sort(key=lambda p: _ORDER.index(p.severity))
    return problems, {**fix_unreachable(project, problems), **fix_clips(project, problems)}


def _make_row(project: Project, p: Problem, fix: Fix | None) -> ProblemRow:
    entry, action = project.clips.get(p.clip or ""), project.action(p.action or "")
    return ProblemRow(
        _make_problem_id(p),
        p.severity,
        p.code,
        str(p.message),
        str(p.remedy),
        str(fix.words) if fix is not None else "",
        str(fix.instead.words) if fix is not None and fix.instead is not None else "",
        fix is not None and fix.alone,
        p.layer or "",
        name_stance(project, p.stance),
        action.id if action is not None else "",
        entry.name if entry is not None else "",
        p.moment,
    )


TOOLS = (
    AuthorTool(
        "find_problems",
        "Find what is wrong with the project, and with `play` what a viewer would see; each problem says "
        "what fix_problem does about it.",
        FindProblems,
        ProblemList,
        _find_problems,
        long=True,
    ),
    AuthorTool(
        "fix_problem",
        "Mend problems that find_problems told, or all that can be mended without taking anything away.",
        FixProblem,
        EditReport,
        _fix_problem,
        "edits",
        tr_noop("Fix problems"),
        True,
    ),
)
