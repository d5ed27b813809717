"""Keep the statistics of visible jumps up to date with the project, on a thread, recomputing only what an
edit changed.

Findings about an action become problems that one press can fix. Curves and matrices are made on demand.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.stage.fixes import Fix
from app.stage.remedies import fix_gap, move_to, set_end_stance
from app.translation import tr, tr_plural
from metagraph.graph import edits
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.graph.problem import Problem

if TYPE_CHECKING:  # their imports wait for the first job
    from metagraph.suggest.jumps.compatibility import Matrix, ProposedTimes
    from metagraph.suggest.jumps.found import Curves, Jump, Measured

AFTER = 400  # milliseconds without edits
EDGES = {
    "far-start": "begins",
    "far-end": "ends",
    "open-loop": "loops",
}  # the codes of `check_project` for the same places, in less precise words
REASONS = {"begins": "jump-start", "ends": "jump-end", "loops": "jump-loop"}


@dataclass(frozen=True, eq=False)
class JudgedJumps:
    """The jumps of a project. `measured` has its layers' statistics, `known` the findings for each action,
    `jumps` all of them.
    """

    measured: Mapping[Layer, Measured]
    known: Mapping[Layer, dict[Any, tuple[Jump, ...]]]
    jumps: tuple[Jump, ...]


def judge_jumps(
    project: Project, before: JudgedJumps | None = None, cancelled: Callable[[], bool] | None = None
) -> JudgedJumps:
    """Return all jumps of a project, reusing what still holds from an earlier judgement."""
    from metagraph.suggest.jumps.found import Measured, find_jumps

    measured: dict[Layer, Measured] = {}
    known: dict[Layer, dict[Any, tuple[Jump, ...]]] = {}
    found: list[Jump] = []
    for layer in LAYERS:
        old = before.measured[layer] if before is not None else None
        new = Measured(project, layer, old)
        kept: dict[Any, tuple[Jump, ...]] = {}
        if before is not None and old is not None and new.same_as(old):
            new = old
            kept = {
                a: before.known[layer][a]
                for a in project.graphs[layer].actions.values()
                if a in before.known[layer]
            }
        measured[layer], known[layer] = new, kept
        found += find_jumps(project, new, kept, cancelled)
    return JudgedJumps(measured, known, tuple(found))


def describe_jumps(project: Project, judged: JudgedJumps) -> dict[Problem, Fix | None]:
    """Return jumps as problems, each with its fix. Layers with too little data have a problem that
    says so.
    """
    out: dict[Problem, Fix | None] = {}
    for jump in judged.jumps:
        action, stance = project.action(jump.action), project.stance(jump.stance)
        if action is None or stance is None:
            continue  # it was removed in the meantime
        if jump.edge == "loops":
            words = tr(
                "'{name}' has a visible jump at its loop seam: {cost:.1f} times the limit",
                name=action.name,
                cost=jump.cost,
            )
        else:
            name, far, of = action.name, jump.cost, stance.name
            words = (
                tr(
                    "'{name}' begins with a visible jump from '{of}': {far:.1f} times the limit",
                    name=name,
                    far=far,
                    of=of,
                )
                if jump.edge == "begins"
                else tr(
                    "'{name}' ends with a visible jump to '{of}': {far:.1f} times the limit",
                    name=name,
                    far=far,
                    of=of,
                )
            )
        remedy, fix = _remedy(project, action, jump)
        problem = Problem(
            "warning", REASONS[jump.edge], words, remedy, action.layer, action.stance, action.id, action.clip
        )
        out[problem] = fix
    for layer, measured in judged.measured.items():
        graph = project.graphs[layer]
        if not measured.reliable and any(a.kind != "stance" for a in graph.actions.values()):
            out[_few(layer, measured)] = None
    return out


def _few(layer: Layer, measured: Measured) -> Problem:
    from metagraph.suggest.jumps.found import FEWEST_CLIPS
    from metagraph.suggest.tracks import RATE

    much = tr_plural("{count:,} clip", "{count:,} clips", measured.labelled)
    if measured.labelled >= FEWEST_CLIPS:
        much += tr(" ({seconds:.0f} s in total)", seconds=measured.stats.count / RATE)
    words = tr(
        "jumps in the {layer} layer are not checked: {much} are too few to learn what normal "
        "motion looks like",
        layer=tr(layer),
        much=much,
    )
    return Problem(
        "hint",
        "few-clips",
        words,
        tr(
            "Place at least {count} clips with ten seconds in total on this layer.",
            count=FEWEST_CLIPS,
        ),
        layer,
    )


def _remedy(project: Project, action: Action, jump: Jump) -> tuple[str, Fix | None]:
    fits = project.stance(jump.fits)
    if jump.better is not None:
        return tr("At {seconds:.2f} s it would not jump.", seconds=jump.better), Fix(
            tr("Use {seconds:.2f} s", seconds=jump.better), action.id, {"timing": dict(jump.change)}
        )
    if fits is not None and action.kind == "transition" and jump.edge == "ends" and fits.id != action.stance:
        return tr("It looks like '{name}' there. End it in that stance.", name=fits.name), Fix(
            tr("End in '{name}'", name=fits.name), action.id, does=set_end_stance, args=(action.id, fits.id)
        )
    if jump.change:
        seconds = next(iter(jump.change.values()))
        return tr("With a blend of {seconds:.2f} s it would not jump.", seconds=seconds), Fix(
            tr("Blend {seconds:.2f} s", seconds=seconds), action.id, {"timing": dict(jump.change)}
        )
    if fits is not None:
        words = tr("It looks like '{name}' there. Move it to that stance.", name=fits.name)
        return words, move_to(action, fits.id, fits.name)
    words = tr("Trim it, lengthen its blend, or move it to a stance that it fits.")
    return words, None if jump.edge == "loops" else fix_gap(project, action, jump.edge)


def merge_problems(problems: Iterable[Problem], flags: Iterable[Problem]) -> tuple[Problem, ...]:
    """Return both, errors first. Each place of an action is reported once, in the words of the statistics."""
    flags = tuple(flags)
    told_of = {(p.action, p.code) for p in flags}
    rest = [p for p in problems if p.code not in EDGES or (p.action, REASONS[EDGES[p.code]]) not in told_of]
    order = {"error": 0, "warning": 1, "hint": 2}
    return tuple(sorted([*rest, *flags], key=lambda p: order[p.severity]))


def compare_proposed_timing(action: Action, times: ProposedTimes, duration: float) -> dict[str, Any]:
    """Return the Timing fields that proposed times change. `duration` is the clip's, in seconds."""
    end = None if times.end >= duration - 1e-3 else round(times.end, 3)
    out: dict[str, Any] = {"start": round(times.start, 3), "end": end, "blend_in": round(times.blend_in, 3)}
    if action.kind != "stance":
        leave = times.earliest_exit
        out |= {
            "blend_out": round(times.blend_out, 3),
            "earliest_exit": None if leave is None else round(leave, 3),
        }
    return out


class Compatibility(QObject):
    """Judges the project's jumps.

    `changed` is emitted after a new judgement, `seen` when the curves of an action (id) are ready, `compared`
    when a layer's matrix is ready.
    """

    changed = Signal()
    seen = Signal(str)
    compared = Signal(str)
    failed = Signal(str)

    def __init__(self, document: Document, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self.judged: JudgedJumps | None = None
        self.flags: dict[Problem, Fix | None] = {}
        self.on = False  # until the window has opened
        self._judging = self._again = self._looking = False  # `_again`: more changed during the judgement
        self._wanted: Action | None = None
        self._curves: dict[str, tuple[Action, Measured, Curves | None]] = {}
        self._matrices: dict[Layer, tuple[Measured, Matrix]] = {}
        self._comparing: set[Layer] = set()
        self._timer = QTimer(self, singleShot=True, interval=AFTER)
        self._timer.timeout.connect(self._judge)
        document.changed.connect(self._follow)

    def start(self) -> None:
        """Judge from now on."""
        if not self.on:
            self.on = True
            self._timer.start()

    def stop(self) -> None:
        self.on = False
        self._timer.stop()

    def forget(self) -> None:
        """Stop judging, and discard the findings."""
        self.stop()
        self.judged, self.flags = None, {}
        self.changed.emit()

    def _follow(self, before: Project, after: Project) -> None:
        same = ("graphs", "clips", "roles", "parts", "skeleton")
        if self.on and any(getattr(before, name) is not getattr(after, name) for name in same):
            self._timer.start()

    # --- judging

    def _judge(self) -> None:
        if self._judging:
            self._again = True
            return
        self._judging, self._again = True, False
        project, before = self.document.project, self.judged

        def work(job: WindowJob) -> tuple[JudgedJumps, dict[Problem, Fix | None]]:
            found = judge_jumps(project, before, lambda: job.cancelled)
            return found, describe_jumps(project, found)

        self.jobs.start("jumps", work, self._done, self._gave_up, quick=True)

    def _over(self) -> None:
        self._judging = False
        if self._again and self.on:
            self._timer.start()

    def _gave_up(self, error: Exception) -> None:
        self._over()
        self.failed.emit(tr("Jumps could not be checked: {error}", error=error))

    def _done(self, result: tuple[JudgedJumps, dict[Problem, Fix | None]]) -> None:
        self._over()
        before, (self.judged, self.flags) = self.judged, result
        self._curves = {
            i: (a, m, c) for i, (a, m, c) in self._curves.items() if self.judged.measured[a.layer] is m
        }
        if before is None or before.measured != self.judged.measured or before.jumps != self.judged.jumps:
            self.changed.emit()

    # --- one action's curves

    def curves(self, action: Action) -> Curves | None:
        """Return what is known of an action's clip beside its stances. Unknown curves are computed, and then
        `seen` is emitted.
        """
        if self.judged is None:
            return None
        known = self._curves.get(action.id)
        if known is None or known[0] != action or known[1] is not self.judged.measured[action.layer]:
            self._wanted = action
            QTimer.singleShot(0, self._look)  # once the edit is painted
        return known[2] if known is not None and _alike(known[0], action) else None

    def _look(self) -> None:
        if self._looking or self._wanted is None or self.judged is None:
            return
        action, self._wanted, self._looking = self._wanted, None, True
        project, measured = self.document.project, self.judged.measured[action.layer]

        def work(_: WindowJob) -> Curves | None:
            from metagraph.suggest.jumps.found import compute_stance_curves

            return compute_stance_curves(project, measured, action)

        def done(found: Curves | None) -> None:
            self._looking = False
            self._curves[action.id] = action, measured, found
            self.seen.emit(action.id)
            self._look()

        def gave_up(_: Exception) -> None:
            done(None)

        self.jobs.start("curves", work, done, gave_up, quick=True)

    def use_proposed(self, actions: Iterable[str]) -> None:
        """Give actions their proposed times, in one step."""
        project, judged = self.document.project, self.judged
        chosen = [a for i in actions if (a := project.action(i)) is not None]
        if judged is None:
            return

        def work(job: WindowJob) -> dict[str, dict[str, Any]]:
            from metagraph.suggest.jumps.found import compute_stance_curves

            out = {}
            for n, action in enumerate(chosen):
                if job.cancelled:
                    break
                job.tell(n, len(chosen))
                found = compute_stance_curves(project, judged.measured[action.layer], action)
                if found is not None:
                    fields = compare_proposed_timing(
                        action, found.proposed, project.clips[action.clip].duration
                    )
                    out[action.id] = {"timing": fields}
            return out

        def done(changes: dict[str, dict[str, Any]]) -> None:
            if changes:
                self.document.edit(tr("Use proposed times"), lambda p: edits.update_each(p, changes))

        self.jobs.start(
            tr("Finding better times"), work, done, lambda e: self.failed.emit(str(e)), quick=len(chosen) < 20
        )

    def mend(self, fixes: Iterable[Fix]) -> None:
        """Fix problems, in one step."""
        todo = list(fixes)

        def all_of(project: Project) -> Project:
            for fix in todo:
                project = fix(project)
            return project

        if todo:
            text = (
                todo[0].words
                if len(todo) == 1
                else tr_plural("Fix {count:,} problem", "Fix {count:,} problems", len(todo))
            )
            self.document.edit(text, all_of)

    # --- matrices

    def matrix(self, layer: Layer) -> Matrix | None:
        """Return the latest comparison of clips with the stances of a layer. What changed is compared again,
        and then `compared` is emitted.
        """
        known = self._matrices.get(layer)
        if self.judged is not None and layer not in self._comparing:
            project, measured = self.document.project, self.judged.measured[layer]
            whole = known is not None and known[0] is measured and known[1].clips == tuple(project.clips)
            if not whole:
                self._compare(
                    project, layer, measured, known[1] if known is not None and known[0] is measured else None
                )
        return known[1] if known is not None else None

    def _compare(self, project: Project, layer: Layer, measured: Measured, before: Matrix | None) -> None:
        self._comparing.add(layer)

        def work(job: WindowJob) -> Matrix:
            return extend_matrix(project, layer, before, lambda: job.cancelled, job.tell)

        def done(found: Matrix) -> None:
            self._matrices[layer] = measured, found
            self._comparing.discard(layer)
            self.compared.emit(layer)

        def gave_up(error: Exception) -> None:
            self._comparing.discard(layer)
            self.failed.emit(tr("Clips could not be compared: {error}", error=error))

        job = self.jobs.start(tr("Comparing clips with stances"), work, done, gave_up)
        job.ended.connect(lambda: self._comparing.discard(layer))


def extend_matrix(
    project: Project,
    layer: Layer,
    before: Matrix | None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Matrix:
    """Return a layer's matrix. Rows of clips that an earlier matrix of the same stances has are taken from
    there.
    """
    import numpy as np

    from metagraph.suggest.jumps.compatibility import Matrix, make_compatibility_matrix

    clips = tuple(project.clips)
    old = (
        {}
        if before is None or before.stances != tuple(project.graphs[layer].stances)
        else {c: n for n, c in enumerate(before.clips)}
    )
    fresh = [c for c in clips if c not in old]
    new = make_compatibility_matrix(project, layer, clips=fresh, cancelled=cancelled, progress=progress)
    if before is None or not old:
        return new
    place = {c: len(before.clips) + n for n, c in enumerate(fresh)}
    rows = [old[c] if c in old else place[c] for c in clips]
    parts = [
        np.concatenate([getattr(before, n), getattr(new, n)])[rows]
        for n in ("enter_cost", "leave_cost", "enter_at", "leave_at")
    ]
    return Matrix(layer, clips, new.stances, *parts)


def _alike(a: Action, b: Action) -> bool:
    """Return whether curves of one action hold for the other: its timing only moves where it is blended."""
    return (a.clip, a.stance, a.end_stance, a.limb, a.joints, a.joint_weights, a.kind) == (
        b.clip,
        b.stance,
        b.end_stance,
        b.limb,
        b.joints,
        b.joint_weights,
        b.kind,
    ) and (a.kind != "stance" or a.timing.start == b.timing.start)
