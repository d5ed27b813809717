"""From a meta plan to specific actions: candidates, the three temporal cases, the draw (Borer et al., section
6.2).
"""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace

from metagraph.graph.model import Action, Markov, MetaGraph, Project
from metagraph.graph.repeating import cycle_of
from metagraph.playback.life.track import Track
from metagraph.playback.life.wanted import mode_at
from metagraph.playback.plan import Cue, MetaAction, MetaRequest, Outcome, Past, Report, Rest
from metagraph.playback.planning.bounds import Bound, begins, bounds
from metagraph.playback.planning.choice import pick, uniform
from metagraph.playback.planning.cue_shapes import (
    FITS,
    RETRACTION,
    STOPPED,
    CueShape,
    fits_before,
    hurried,
    lateness,
    may_share,
    meets,
    remaining,
    shape_of,
    slack_of,
)
from metagraph.playback.planning.director import (
    APART,
    GOES_HOME,
    LEAST_BEATS,
    LEAST_LULL,
    LEAVES_HOME,
    LONG_REST,
    MOST_LULL,
    MUSED,
    MUSES,
    SHORTER,
    STANDS_OUT,
    beat_interval,
    find_lull,
    freshness,
    musing,
    posture,
    repeat_interval,
)
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.markov import performs
from metagraph.playback.planning.mood import (
    HELD,
    Mood,
    Moods,
    changed,
    drag,
    extent,
    favour,
    made_for,
    mood_at,
    stirs,
    tempo,
)
from metagraph.playback.planning.prominence import measure_prominence
from metagraph.playback.planning.remembering import node, remember, rested
from metagraph.playback.planning.vigour import measure_vigour
from metagraph.playback.timing.phase_times import LEAST_BLEND
from metagraph.playback.timing.phases import find_phases

ON_TIME = 0.1  # seconds by which a request may begin later and still be on time
LOOP_FADE = 0.6  # seconds of crossfade when a long rest changes from one loop of its stance to another


@dataclass(frozen=True, slots=True)
class SamplingStep:
    """One action of a chain: the candidates for it and, for a transition on the way, the stance
    it leads to.
    """

    candidates: Sequence[Action]
    hop: str = ""


@dataclass
class Performer:
    """One layer being planned, cue after cue. It changes while planning, and never leaves the planner.

    uses: how often each action was used. recent: the last draws of each `node`. ended: when each action
    ended. begun: keys of meta actions whose chain of transitions already plays. served: keys of those that
    the action of another one serves, too. moods: the mood over time. candidates: the actions of each `node`
    that may be drawn, for the nodes needed so far. prominences: of actions, as far as needed. acted: when the
    last action ended. track: what lasts. model: the one that wrote what was not requested, None if there is
    none. beats: seconds after which a gesture that hardly shows may be done again.
    """

    project: Project
    graph: MetaGraph
    seed: Bits
    stance: str
    moods: Moods
    track: Track
    free: float = 0.0
    acted: float = 0.0
    uses: dict[str, int] = field(default_factory=dict)
    recent: dict[str, tuple[str, ...]] = field(default_factory=dict)
    ended: dict[str, float] = field(default_factory=dict)
    cues: list[Cue] = field(default_factory=list)
    rests: list[Rest] = field(default_factory=list)
    reports: list[Report] = field(default_factory=list)
    begun: AbstractSet[str] = frozenset()
    served: set[str] = field(default_factory=set)
    candidates: dict[str, list[Action]] = field(default_factory=dict)
    prominences: dict[str, float] = field(default_factory=dict)
    model: Markov | None = None
    beats: float = LEAST_BEATS

    def note(self, cue: Cue, then: str) -> None:
        """Note that a cue is played."""
        self.cues.append(cue)
        self.free, self.acted, self.stance = cue.end, cue.end, then
        remember(cue, self.uses, self.recent, self.ended)

    @property
    def ready(self) -> float:
        """The earliest time at which the next action may begin."""
        return self.free + (self.project.settings.rest if self.ended else 0.0)

    def begin(self, stance: str) -> bool:
        """Lay the first loop down; return whether the layer can perform at all."""
        loop = self.loop(stance, f"rest/{self.graph.layer}")
        if loop is None:
            return False
        self.rests.append(Rest(stance, loop, 0.0, 0.0, 0.0))
        return True

    def perform(self, metas: Sequence[MetaAction], end: float) -> None:
        """Realise in order those meta actions of a conflict-free meta plan that start before `end`."""
        performed = [m for m in metas if not m.written or self._performs(m, m.start)]
        for bound in bounds(performed):
            meta = bound.meta
            if begins(meta) >= end:
                continue
            if len(self.served) > 0 and meta.key in self.served:
                continue
            if meta.request.late is not None:
                self._realise(bound, max(self.ready, begins(meta)))
                continue
            ready = self.ready
            if meta.start < ready and meta.key not in self.begun:
                running = "the running action"
                if len(self.cues) > 0:
                    running = f"'{self.cues[-1].action.name}'"
                waits = ready - meta.start
                if meta.end <= ready + FITS:
                    waits = ready - meta.request.start
                    # What is wanted for a certain time is over; what is wanted once may come late.
                    wanted = meta.written or meta.request.duration is not None
                    if wanted or waits > self.project.settings.wait:
                        why = f"wholly covered by {running}, which plays until {self.free:.2f} s"
                        self._tell(meta, "covered", why)
                        continue
                # What a model wrote is wanted at no certain time.
                if not meta.written and waits > ON_TIME:
                    self._tell(meta, "queued", f"waits {waits:.2f} s for {running}", True)
            self._realise(bound, max(ready, meta.start))

    def _realise(self, bound: Bound, now: float) -> None:
        meta = bound.meta
        limit = bound.limit
        if meta.written and meta.key not in self.begun and not self._may_begin(meta, now):
            return
        steps = self._steps(meta, now)
        if steps is None:
            return
        cues: list[Cue] = []
        stance = self.stance
        for step in steps:
            hops = step.hop != ""
            asked = None if hops else remaining(meta, now)
            mood = self._mood(asked, now)
            fitting = list(step.candidates)
            if limit < float("inf"):  # else all fit
                fitting = [a for a in step.candidates if fits_before(self._shape(a, asked, now, mood), limit)]
            if len(fitting) == 0:
                before = "" if meta.written else " before something more important"
                self._tell(meta, "no-room", f"nothing fits into the {max(0.0, limit - now):.2f} s{before}")
                return
            if not hops and meta.request.action is None:
                warm = [
                    a
                    for a in fitting
                    if a.cooldown <= 0 or self._cooled(a) <= self._shape(a, asked, now, mood).start + FITS
                ]
                if len(warm) == 0:
                    soonest = min([self._cooled(a) for a in fitting])
                    self._tell(
                        meta,
                        "cooling",
                        f"all that fit are cooling down; the first may play again at {soonest:.2f} s",
                    )
                    return
                fitting = warm
            # On the way to a stance it counts when that begins.
            if meta.request.late is not None and (
                not hops or (len(cues) == 0 and steps[len(steps) - 1].hop != "")
            ):
                fitting = self._timely(bound, fitting, now)
                if len(fitting) == 0:
                    return
            action = self._draw(fitting, f"{meta.key}/{step.hop}" if hops else meta.key, now, mood)
            shape = self._shape(action, asked, now, mood)
            cue = self._cue(action, shape, bound, hops, stance, mood)
            cues.append(cue)
            now, stance = cue.end, cue.then
        for one in cues:
            self._keep(one)

    def _performs(self, meta: MetaAction, now: float) -> bool:
        """Return whether what a model wrote is performed at a time: not out of a stance that a request holds,
        and as often as mode and mood say. Anything may begin a long thought, or end it.
        """
        if not stirs(mood_at(self.moods, now), self.seed, meta.request.id):
            return False
        if meta.request.kind == "transition" and self.track.stays_at(self.graph.layer, now):
            return False
        if self.model is None or self._muses(now) or self._has_mused(now):
            return True
        return performs(self.model, self.seed, meta, mode_at(self.track, now))

    def _may_begin(self, meta: MetaAction, now: float) -> bool:
        """Return whether what a model wrote begins at a time, which may be later than it was written for: not
        soon after an interruption, and nothing that would end a thought.
        """
        if self.track.hushed_at(now) or not self._performs(meta, now):
            return False
        if self.model is None or self._leads(now) != "":
            return True
        if self._lulls(now):
            return False
        there = self.stance == musing(self.graph.stances)
        if there and meta.request.kind == "transition" and self._muses(now):
            return False
        return performs(self.model, self.seed, meta, mode_at(self.track, now))

    def _lulls(self, now: float) -> bool:
        """Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a
        thought acts are rare anyway.
        """
        variety = self.project.settings.variety
        if self.graph.layer != "arms" or variety <= 0 or len(self.cues) == 0 or self._has_mused(now):
            return False
        last = self.cues[-1]
        mode = mode_at(self.track, now)
        if now >= last.end + MOST_LULL or mode == "thinking":
            return False
        talks = mode == "talking"
        if talks and last.action.kind == "transition":  # it opens a burst
            return False
        return now < last.end + find_lull(self.seed, last.meta, talks, variety)

    def _muses(self, now: float) -> bool:
        """Return whether the arms take or keep the stance in which the character thinks."""
        if mode_at(self.track, now) != "thinking" or mode_at(self.track, now + MUSES) != "thinking":
            return False
        if self.graph.layer != "arms" or self.project.settings.variety <= 0:
            return False
        return not self.track.stays_at("arms", now) and musing(self.graph.stances) != ""

    def _has_mused(self, now: float) -> bool:
        """Return whether a thought of the character has ended just now."""
        if self.graph.layer != "arms" or mode_at(self.track, now) == "thinking":
            return False
        return self.project.settings.variety > 0 and mode_at(self.track, now - MUSED) == "thinking"

    def _leads(self, now: float) -> str:
        """Return the stance that the arms go to whatever a model wrote: the one in which the character
        thinks, and from there home as soon as the thought is over; "" for none.
        """
        if self.graph.layer != "arms" or self.project.settings.variety <= 0:
            return ""
        muses = musing(self.graph.stances)
        if muses == "" or self.track.stays_at("arms", now):
            return ""
        home = self.graph.start
        goal = ""
        if self._muses(now):
            goal = muses
        elif self.stance == muses and home is not None and mode_at(self.track, now) != "thinking":
            came = self._moved()
            if came >= 0 and mode_at(self.track, came) == "thinking":
                goal = home
        if goal == self.stance or goal == "" or len(self._chain(goal)) == 0:
            return ""
        return goal

    def _timely(self, bound: Bound, fitting: Sequence[Action], now: float) -> list[Action]:
        """Return the candidates that come least late, if that is not too late; among them those that leave
        the following requests the most time and serve the most of them.
        """
        meta = bound.meta
        request = meta.request
        allowed = slack_of(request)
        mood = self._mood(request, now)
        late = {a.id: lateness(self.project, a, request, self._shape(a, request, now, mood)) for a in fitting}
        least = min([late[a.id] for a in fitting])
        if least > allowed + FITS:
            waits = self._cause(request, now)
            self._tell(
                meta,
                "too-late",
                f"would come {least:.2f} s late, {allowed:.2f} s are allowed; it waits for {waits}",
                False,
                least,
            )
            return []
        if least > FITS:
            waits = self._cause(request, now)
            self._tell(meta, "late", f"comes {least:.2f} s late; it waits for {waits}", True, least)
        timely = [a for a in fitting if late[a.id] <= max(least, 0.0) + FITS]
        for other in bound.after:
            if not may_share(request, other.request):
                continue
            both = [a for a in timely if meets(a, other.request)]
            behind = 0.0
            if request.stroke is not None and other.request.stroke is not None:
                behind = max(0.0, request.stroke + max(least, 0.0) - other.request.stroke)
            if len(both) > 0 and other.request.late is not None and behind <= other.request.late + FITS:
                timely = both
                self.served.add(other.key)
                message = f"shares the stroke of '{request.id}'"
                self._tell(other, "shared", message, True, behind, meta.key)
        following = [other for other in bound.after if other.key not in self.served]
        for other in following:
            for slack in (0.0, slack_of(other.request)):
                by = self._latest(other.request) + slack
                over = [a for a in timely if self._over(a, request, now) <= by]
                if len(over) > 0:
                    return over
        return timely

    def _cause(self, request: MetaRequest, now: float) -> str:
        """Return the reason why a request comes late."""
        if now <= request.start + FITS:
            return "its own preparation"
        if len(self.cues) > 0 and self.ready >= now - FITS and self.cues[-1].end >= self.free - FITS:
            return f"'{self.cues[-1].action.name}', which plays until {self.free:.2f} s"
        return "what comes before it" if len(self.cues) > 0 else "the time it became known at"

    def _latest(self, request: MetaRequest) -> float:
        """Return the latest time at which a requested action has to begin to be on time; never in
        the past.
        """
        if request.stroke is None:
            return request.start
        least = float("inf")
        for action in self.graph.of(self.stance, request.kind):
            fits = meets(action, request)
            if request.action is not None:
                fits = action.id == request.action
            if fits and self._usable(action):
                found = find_phases(self.project, action)
                lead = found.stroke - found.skip(action.timing.blend_in)
                speed = self._tempo(action, self._mood(request, request.stroke))
                least = min(least, lead + drag(lead, speed))
        return request.stroke - least

    def _over(self, action: Action, request: MetaRequest, now: float) -> float:
        """Return the earliest time at which the next action could begin after this one."""
        shape = self._shape(action, request, now, self._mood(request, now))
        return shape.start + hurried(self.project, action, shape) + self.project.settings.rest - FITS

    def _until(self, action: Action, shape: CueShape, bound: Bound) -> float:
        """Return when an action that should play to its end is left early all the same: early enough for the
        first following request that can then be in time, late enough for its own stroke; infinity for never.
        """
        if len(bound.after) == 0:
            return float("inf")
        rest = self.project.settings.rest
        soonest = shape.start + hurried(self.project, action, shape)
        for other in bound.after:
            in_time = self._latest(other.request) + slack_of(other.request)
            if other.key not in self.served and soonest + rest <= in_time + FITS:
                return max(soonest, begins(other) - rest)
        return float("inf")

    def make_way(
        self, running: MetaAction | None, asked: Sequence[MetaAction], now: float, stopped: bool
    ) -> None:
        """Leave the running action early for the first request that can then be in time, or if it was
        `stopped`. An action that a model wrote, or that is less important, is left at once; others are left
        where their retraction begins.
        """
        if stopped:
            self.retract(now)
            return
        cue = self.cues[-1]
        if running is None or cue.action.kind == "transition" or cue.end - cue.blend_out <= now:
            return
        at_once = now + max(cue.blend_out, RETRACTION)
        retracts = at_once
        if not running.written:
            once = cue.end - cue.start
            if cue.repeats:
                once = min(once, (cue.cycle_to - cue.entry) / cue.tempo + max(cue.blend_out, RETRACTION))
            shape = CueShape(
                cue.start, cue.entry, cue.end - cue.start, once,
                cue.hold_from, cue.hold_to, cue.hold, cue.tempo,
            )  # fmt: skip
            retracts = max(at_once, cue.start + hurried(self.project, cue.action, shape))
        rest = self.project.settings.rest
        for meta in asked:
            request = meta.request
            in_time = self._latest(request) + slack_of(request)
            soonest = at_once if meta.rank > running.rank else retracts
            if request.late is None or meta.rank < running.rank or in_time < soonest + rest - FITS:
                continue
            end = max(soonest, begins(meta) - rest)
            if end < cue.end:
                out = max(cue.blend_out, RETRACTION)
                into = min(cue.blend_in, max(0.0, end - out - cue.start))
                self.cues[-1] = replace(cue, end=end, blend_in=into, blend_out=out)
                self.free = end
                self.ended[cue.action.id] = end
            return

    def retract(self, now: float) -> None:
        """Leave the running action: it returns to its stance from where it is. A transition ends in the
        stance it leads to.
        """
        cue = self.cues[-1]
        end = now + STOPPED
        if cue.action.kind == "transition" or cue.end - cue.blend_out <= now or cue.end <= end:
            return
        self.cues[-1] = replace(cue, end=end, blend_out=STOPPED)
        self.free = end
        self.ended[cue.action.id] = end

    def _cooled(self, action: Action) -> float:
        """Return the time from which an action may be drawn again."""
        if action.cooldown > 0 and action.id in self.ended:
            return self.ended[action.id] + action.cooldown
        return float("-inf")

    def _steps(self, meta: MetaAction, now: float) -> list[SamplingStep] | None:
        """Return each action in turn: the transitions to get there, then the action itself; None if it is
        impossible or not needed, or if the model wrote it and every candidate played too recently.
        """
        request = meta.request
        graph = self.graph
        if request.action is not None:
            action = graph.actions.get(request.action)
            if action is None or action.stance not in graph.stances:
                self._tell(
                    meta,
                    "unknown-action",
                    f"there is no action '{request.action}' in the {graph.layer} layer",
                )
                return None
            if action.kind == "stance":
                return self._way(meta, action.stance)
            if not self._arrives(action):
                self._tell(meta, "no-stance", f"'{action.name}' ends in a stance that has no loop")
                return None
            if action.stance == self.stance:
                return [SamplingStep([action])]
            way = self._way(meta, action.stance)
            return None if way is None else [*way, SamplingStep([action])]
        if request.stance is not None and request.kind in ("transition", "stance"):
            if request.stance not in graph.stances:
                self._tell(
                    meta, "no-stance", f"there is no stance '{request.stance}' in the {graph.layer} layer"
                )
                return None
            return self._way(meta, request.stance)
        leads = self._leads(now) if meta.written else ""
        if leads != "":
            return self._way(meta, leads)
        here = node(self.stance, request.kind)
        if here not in self.candidates:
            self.candidates[here] = [a for a in graph.of(self.stance, request.kind) if self._usable(a)]
        every = self.candidates[here]
        if len(request.among) > 0:
            every = [a for a in every if a.id in request.among]
        found = every
        if len(request.tags) > 0:
            found = [a for a in every if all(tag in a.tags for tag in request.tags)]
        exact = found
        if request.limb is not None:
            exact = [a for a in found if a.limb == request.limb]
        directed = meta.written and self.project.settings.variety > 0
        if directed:  # the model's limb and tags are wishes, not orders
            every = self._fresh(meta, every, now)
            fresh = {a.id for a in every}
            found = [a for a in found if a.id in fresh]
            exact = [a for a in exact if a.id in fresh]
            if len(every) == 0:
                moves = self._moves_on(meta, now)
                return [SamplingStep(moves)] if len(moves) > 0 else None
            if len(exact) == 0:
                exact = found if len(found) > 0 else every
        elif meta.written:  # nor worth playing the same again
            again = self.recent.get(here, ())[-1:]
            if not any(a.id not in again for a in exact):
                exact = found if any(a.id not in again for a in found) else every
        exact = self._modest(meta, exact, now)
        if len(exact) == 0:
            name = graph.stances[self.stance].name
            asked = " ".join([*request.tags, request.kind])
            if request.limb is not None:
                asked = f"{request.limb} {asked}"
            if len(found) > 0:  # whose limb is a wish, too
                self._tell(meta, "other-limb", f"stance '{name}' has no {asked}; another will do", True)
                return [SamplingStep(found)]
            hint = "" if meta.written else self._elsewhere(request)
            self._tell(meta, "no-candidate", f"stance '{name}' has no {asked}{hint}")
            return None
        return [SamplingStep(exact)]

    def _elsewhere(self, request: MetaRequest) -> str:
        for action in self.graph.actions.values():
            fits = (
                action.kind == request.kind
                and all(tag in action.tags for tag in request.tags)
                and (request.limb is None or request.limb == action.limb)
            )
            if fits and action.stance in self.graph.stances:
                return f"; there is one in '{self.graph.stances[action.stance].name}'"
        return ""

    def _way(self, meta: MetaAction, goal: str) -> list[SamplingStep] | None:
        """Return the transitions hop by hop from the current stance to `goal`."""
        if goal == self.stance:
            name = self.graph.stances[goal].name
            self._tell(meta, "already-there", f"the layer is in '{name}' already", True)
            return None
        stances = self._chain(goal)
        if len(stances) == 0:
            a = self.graph.stances[self.stance].name
            b = self.graph.stances[goal].name
            self._tell(meta, "no-way", f"no chain of transitions leads from '{a}' to '{b}'")
            return None
        steps: list[SamplingStep] = []
        at = self.stance
        for following in stances:
            hops = [
                a for a in self.graph.of(at, "transition") if a.end_stance == following and self._usable(a)
            ]
            steps.append(SamplingStep(hops, following))
            at = following
        return steps

    def _chain(self, goal: str) -> list[str]:
        """Return the stances after the current one on the shortest way of transitions that can play, the goal
        last; empty if there is no way. Among equally short ways, the one whose transitions were placed first.
        """
        before = {self.stance: ""}
        queue = [self.stance]
        at = 0  # what is before it was looked at
        while at < len(queue) and goal not in before:
            stance = queue[at]
            at += 1
            for action in self.graph.of(stance, "transition"):
                end = action.end_stance
                if end is None or end in before or end not in self.graph.stances:
                    continue
                if self._usable(action):
                    before[end] = stance
                    queue.append(end)
        way: list[str] = []
        if goal not in before:
            return way
        step = goal
        while step != self.stance:
            way.append(step)
            step = before[step]
        return list(reversed(way))

    def _arrives(self, action: Action) -> bool:
        """Return whether an action leaves the layer in a stance that has a loop."""
        end = action.end_stance
        if action.kind != "transition":
            return True
        return end is not None and end in self.graph.stances and len(self.graph.of(end, "stance")) > 0

    def _usable(self, action: Action) -> bool:
        return action.likelihood > 0 and self._arrives(action)

    def _shape(self, action: Action, request: MetaRequest | None, now: float, mood: Mood) -> CueShape:
        """Return how an action would play for a request from `now` on, or as a step on the way to it."""
        return shape_of(self.project, action, request, now, self._tempo(action, mood))

    def _mood(self, request: MetaRequest | None, at: float) -> Mood:
        """Return the mood in which a request is played from `at` on, or at its stroke."""
        if request is None:
            return mood_at(self.moods, at)
        mood = mood_at(self.moods, at if request.stroke is None else request.stroke)
        if request.valence is None and request.arousal is None and request.intensity is None:
            return mood
        return changed(mood, request.valence, request.arousal, request.intensity)

    def _tempo(self, action: Action, mood: Mood) -> float:
        """Return the speed of an action in a mood, 1 if it was made for the mood."""
        return 1.0 if mood.neutral or made_for(mood, action.tags) else tempo(mood)

    def _extent(self, action: Action, mood: Mood) -> float:
        """Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch
        something or were made for the mood keep their extent.
        """
        if self.graph.layer == "body" or action.kind == "transition" or mood.neutral:
            return 1.0
        return (
            1.0
            if len(action.contacts) > 0 or HELD in action.tags or made_for(mood, action.tags)
            else extent(mood)
        )

    def _draw(self, candidates: list[Action], key: str, now: float, mood: Mood) -> Action:
        """Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too
        recently are left out as long as others are left.
        """
        left = self._spaced(candidates)
        if len(left) == 1:
            return left[0]
        neutral = mood.neutral
        weights: dict[str, float] = {}
        for a in left:
            favoured = 1.0 if neutral else favour(mood, a.tags, measure_vigour(self.project, a))
            weight = a.likelihood / max(self._count(a.id, now), 1.0) * favoured
            weights[a.id] = weight * self._variety(a, now)
        if not any(w > 0 for w in weights.values()):
            return left[0]
        chosen = pick(self.seed, key, "action", weights)
        return next(a for a in left if a.id == chosen)

    def _variety(self, action: Action, now: float) -> float:
        """Return the factor by which variety changes an action's likelihood."""
        variety = self.project.settings.variety
        if variety <= 0:
            return 1.0
        if action.kind == "transition":
            talks = self.graph.layer == "arms" and mode_at(self.track, now) == "talking"
            return 1.0 + self._count_fresh(action.end_stance, now) if talks else 1.0
        if action.id not in self.ended:
            return 1.0
        shows = self._shows(action)
        needed = repeat_interval(action.kind, shows, self.beats) * variety
        return freshness(now - self.ended[action.id], needed)

    def _shows(self, action: Action) -> float:
        """Return how much an action stands out."""
        if action.id not in self.prominences:
            self.prominences[action.id] = measure_prominence(self.project, action)
        return self.prominences[action.id]

    def _fresh(self, meta: MetaAction, candidates: Sequence[Action], now: float) -> list[Action]:
        """Return the actions that the character may do by itself; see `director`."""
        variety = self.project.settings.variety
        layer = self.graph.layer
        if meta.request.kind == "transition":
            if now < self._moved() + posture(layer) * variety:
                return []
            if layer == "arms" and now < self.acted + LEAST_LULL * variety:
                return []
            if layer != "head":
                return list(candidates)
            if self.stance == self.graph.start:
                leaves = uniform(self.seed, meta.key, "leaves") < LEAVES_HOME
                return list(candidates) if leaves else []
            home = [a for a in candidates if a.end_stance == self.graph.start]
            returns = len(home) > 0 and uniform(self.seed, meta.key, "home") < GOES_HOME
            return home if returns else list(candidates)
        share = variety if now < self.acted + LONG_REST * variety else variety * SHORTER
        reminded = self._shown(now - APART * variety)
        converses = meta.request.kind == "fidget" and mode_at(self.track, now) != "idle"
        out: list[Action] = []
        for action in candidates:
            shows = self._shows(action)
            if (reminded or converses) and shows >= STANDS_OUT:
                continue
            needed = repeat_interval(action.kind, shows, self.beats) * share
            if action.id not in self.ended or now >= self.ended[action.id] + needed:
                out.append(action)
        return out

    def _modest(self, meta: MetaAction, candidates: Sequence[Action], now: float) -> list[Action]:
        """Return the candidates for a requested fidget in a conversation without those that stand out, if
        others are left and no tags are requested; else all.
        """
        request = meta.request
        every = list(candidates)
        if request.kind != "fidget" or len(request.tags) > 0 or self.project.settings.variety <= 0:
            return every
        if meta.written or mode_at(self.track, now) == "idle":
            return every
        left = [a for a in every if self._shows(a) < STANDS_OUT]
        return left if len(left) > 0 else every

    def _moves_on(self, meta: MetaAction, now: float) -> list[Action]:
        """Return the transitions of the arms that may play for a gesture where all gestures of the stance
        have played too recently, and others of another stance have not.
        """
        out: list[Action] = []
        if self.graph.layer != "arms" or meta.request.kind != "gesture" or self.track.stays_at("arms", now):
            return out
        variety = self.project.settings.variety
        if now < self._moved() + posture("arms") * variety or now < self.acted + LEAST_LULL * variety:
            return out
        for action in self.graph.of(self.stance, "transition"):
            if self._usable(action) and self._count_fresh(action.end_stance, now) > 0:
                out.append(action)
        return out

    def _count_fresh(self, stance: str | None, now: float) -> int:
        """Return how many gestures of a stance have not played for long enough."""
        if stance is None:
            return 0
        variety = self.project.settings.variety
        count = len(self.graph.of(stance, "gesture"))
        for ident, end in self.ended.items():
            action = self.graph.actions.get(ident)
            if action is None or action.kind != "gesture" or action.stance != stance:
                continue
            shows = self._shows(action)
            if now < end + repeat_interval("gesture", shows, self.beats) * variety:
                count -= 1
        return count

    def _moved(self) -> float:
        """Return when the stance was last changed; minus infinity for never."""
        latest = float("-inf")
        for ident, end in self.ended.items():
            action = self.graph.actions.get(ident)
            if action is not None and action.kind == "transition":
                latest = max(latest, end)
        return latest

    def _shown(self, since: float) -> bool:
        """Return whether an act that stands out was done since a time."""
        for ident, end in self.ended.items():
            action = self.graph.actions.get(ident)
            if action is None or action.kind == "transition" or end < since:
                continue
            if self._shows(action) >= STANDS_OUT:
                return True
        return False

    def _spaced(self, candidates: list[Action]) -> list[Action]:
        """Leave out actions that need more other actions before they play again. If nothing is left, all need
        one less, and so on.
        """
        default = 1 if self.project.settings.never_twice else 0
        first = candidates[0]
        before = self.recent.get(node(first.stance, first.kind), ())
        if len(candidates) < 2 or len(before) == 0:
            return candidates
        needs = {a.id: default if a.spacing is None else a.spacing for a in candidates}
        for less in range(max([needs[a.id] for a in candidates]) + 1):
            left = [a for a in candidates if rested(before, a.id, needs[a.id] - less)]
            if len(left) > 0:
                return left
        return candidates

    def _count(self, ident: str, now: float) -> float:
        """Return c_k of section 6.2, alpha times the uses, over the settings' memory."""
        memory = self.project.settings.memory
        alpha = self.project.settings.alpha
        if memory <= 0:
            return alpha * self.uses.get(ident, 0)
        used = 0
        for cue in reversed(self.cues):
            if cue.start < now - memory:
                break
            if cue.action.id == ident:
                used += 1
        return alpha * used

    def _cue(self, action: Action, shape: CueShape, bound: Bound, hops: bool, stance: str, mood: Mood) -> Cue:
        """hops: whether it is a transition on the way to the requested action."""
        length = shape.length
        into = max(0.0, action.timing.blend_in)
        out = max(0.0, action.timing.blend_out)
        begin, until = self.project.span(action)
        cycle = cycle_of(action.kind, action.timing, begin, until)
        if action.timing.earliest_exit is not None or cycle > 0:
            wish = float("inf") if hops else bound.wish
            length = min(length, max(shape.shortest, min(bound.limit, wish) - shape.start))
        elif not hops:
            length = min(length, self._until(action, shape, bound) - shape.start)
            if length < shape.length:
                out = max(out, RETRACTION)
        if shape.entry > begin:
            into = max(into, LEAST_BLEND)
        squeeze = min(1.0, length / (into + out)) if into + out > 0 else 1.0
        then = stance
        if action.kind == "transition" and action.end_stance is not None:
            then = action.end_stance
        end = shape.start + length
        return Cue(
            action, shape.start, end, shape.entry, into * squeeze, out * squeeze, stance, then,
            bound.meta.key,
            shape.hold_from, shape.hold_to, shape.hold, self._extent(action, mood), shape.tempo,
            begin if cycle > 0 else 0.0, begin + cycle if cycle > 0 else 0.0,
        )  # fmt: skip

    def _keep(self, cue: Cue) -> None:
        self.note(cue, cue.then)
        loop = self.loop(cue.then, cue.meta)
        if loop is not None:
            # The loop begins again under the action, so that the action's last pose meets the loop's first.
            # On joints that the action does not move, the change shows. It takes its time there, like a
            # transition.
            partial = (
                cue.action.limb != "both" or len(cue.action.joints) > 0 or len(cue.action.joint_weights) > 0
            )
            begin = cue.start + cue.blend_in
            until = cue.end - cue.blend_out
            fade = max(0.0, until - begin)
            if partial:
                fade = cue.end - cue.start if cue.then != cue.stance else min(LOOP_FADE, cue.end - cue.start)
                begin = max(cue.start, until - fade)
            self.rests.append(Rest(cue.then, loop, until, begin, fade))

    def loop(self, stance: str, key: str) -> Action | None:
        """Return one of a stance's loops, drawn by likelihood; None if it has none."""
        loops = self.graph.of(stance, "stance")
        if len(loops) == 1:
            return loops[0]
        weights = {a.id: a.likelihood for a in loops if a.likelihood > 0}
        if len(weights) == 0:
            return loops[0] if len(loops) > 0 else None
        chosen = pick(self.seed, key, "loop", weights)
        return next(a for a in loops if a.id == chosen)

    def vary_rests(self, end: float) -> None:
        """Change between the loops of a stance in long rests, at the end of a loop."""
        out: list[Rest] = []
        for place, rest in enumerate(self.rests):
            out.append(rest)
            loops = self.graph.of(rest.stance, "stance")
            if len(loops) < 2:
                continue
            until = self.rests[place + 1].fade_start if place + 1 < len(self.rests) else end
            current, change = rest, rest.start
            while True:
                start, stop = self.project.span(current.action)
                change += max(1.0, stop - start - current.action.timing.blend_in)
                if not change <= until:  # nor when it is no number
                    break
                loop = self.loop(rest.stance, f"{self.graph.layer}/{change:.3f}")
                if loop is not None and loop.id != current.action.id:
                    current = Rest(rest.stance, loop, change, change - LOOP_FADE, LOOP_FADE)
                    out.append(current)
        self.rests = out

    def _tell(
        self,
        meta: MetaAction,
        outcome: Outcome,
        message: str,
        played: bool = False,
        late: float = 0.0,
        by: str = "",
    ) -> None:
        layer = self.graph.layer
        self.reports.append(
            Report(meta.request.id, outcome, message, layer, meta.start, played, meta.written, late, by)
        )


def performer_after(
    project: Project,
    graph: MetaGraph,
    seed: Bits,
    begin: str,
    past: Past,
    cues: Sequence[Cue],
    moods: Moods,
    track: Track,
) -> Performer:
    """Return the performer as it is after a past and the cues that played since."""
    stance = past.stance if past.stance in graph.stances else begin
    out = Performer(
        project, graph, seed, stance, moods, track, past.free, past.free,
        dict(past.uses), dict(past.recent), dict(past.ended),
    )  # fmt: skip
    out.beats = beat_interval(graph.layer, len([a for a in graph.actions.values() if a.kind == "gesture"]))
    for cue in cues:
        out.note(cue, cue.then if cue.then in graph.stances else begin)
    return out
