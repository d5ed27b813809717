"""Run a live session: requests arrive between two ticks, are planned at once, and each is answered with what
becomes of it.

There are no threads and no clock: time is passed in, in seconds since the session began. A session's plan is
that of a performance (`playback.planning.extend_performance`). The requests are kept with the time at which
they became known, so a performance of them plays the session again.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

import msgspec

from metagraph.graph import requests as a
from metagraph.graph.model import Layer, Project
from metagraph.graph.parameter import ParameterValues
from metagraph.live import describe
from metagraph.live.admission import Admission
from metagraph.live.generating import Generating
from metagraph.live.graph_motion import LiveGraph
from metagraph.live.happenings import Happenings
from metagraph.live.ledger import Ledger, reword_for_client
from metagraph.live.limits import (
    BML_PER_TICK,
    BUSY,
    PER_TICK,
)
from metagraph.live.messages import (
    Describe,
    HeardMessage,
    Hello,
    Reply,
    SetParameter,
    Status,
    read_live_request,
    split_message,
)
from metagraph.live.pose_stream import Stream, collect_due_frames
from metagraph.live.tape import Tape
from metagraph.live.tick_work import Agent, Client, Out, TickWork, order_requests, thin_track
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import Plan
from metagraph.playback.planning.plan_head import RECENT
from metagraph.playback.planning.running_plan import CUT, RunningPlan
from metagraph.playback.posing.overlay import Overlay
from metagraph.playback.posing.weight import LOOKS_BACK
from metagraph.playback.timing.phases import find_phases

TIDY = 0.25  # seconds between two clean-ups of what is over
KEPT = 10.0  # seconds for which reports and requests of the plan are kept after they are over
TOLD = 100  # latest reports that are kept in any case
AGENTS = 1000  # names of clients that are remembered


class LiveSession:
    """One character, played live.

    The arguments are as for `perform`. `history` is the number of seconds of past that are kept, `ahead` of
    plan. `models` and `graphs` are those that clients may ask to generate motion, by name.
    """

    def __init__(
        self,
        project: Project,
        seed: int | None = None,
        idle: bool = True,
        history: float = 600.0,
        ahead: float = 20.0,
        stances: Mapping[Layer, str] | None = None,
        models: Mapping[str, Path] | None = None,
        graphs: Mapping[str, LiveGraph] | None = None,
    ) -> None:
        self.history = history
        self.running = RunningPlan(project, seed, stances, idle, ahead)
        self.now = 0.0
        self.clients: dict[int, Client] = {}
        self.ledger = Ledger()
        self.happenings = Happenings()
        self._agents: dict[str, Agent] = {}
        self.generating = Generating(models, graphs)
        self._queue: list[tuple[int, HeardMessage | Reply]] = []
        self.tape = Tape()
        self.admission = Admission(self.running, self.ledger, self.happenings, self.generating, self.clients)
        self._tidied = self._begin = 0.0
        self._past: deque[tuple[float, Plan]] = deque()
        self._edited = False
        self._cold = [x for x in project.actions() if x.kind == "gesture"]
        self._told: dict[str, bytes] = {}
        self.parameters = ParameterValues()
        self._evaluator: Evaluator | None = None

    @property
    def project(self) -> Project:
        """Return the project as it is edited now."""
        return self.running.project

    @property
    def plan(self) -> Plan:
        """Return the current plan."""
        return self.running.plan

    @property
    def evaluator(self) -> Evaluator | None:
        """Return the evaluator of the current plan; None for a project without a skeleton."""
        if self.project.skeleton is None:
            return None
        known = self._evaluator
        self._evaluator = (
            known.follow(self.plan, self.project) if known else Evaluator(self.plan, self.project)
        )
        return self._evaluator

    # --- clients

    def join(self, client: int) -> None:
        """Add a client. Its number is the caller's and must not be used twice."""
        self.clients[client] = Client(client, Agent(client))

    def leave(self, client: int) -> None:
        """Remove a client. Its requests are still played; who says its name next can take them back."""
        self.clients.pop(client, None)

    def receive(self, client: int, data: bytes | str) -> None:
        """Take a message, to be answered at the next tick, with one reply to each request in it."""
        try:
            requests, _ = split_message(data)
        except a.RequestError as error:
            self._queue.append((client, Reply(error=str(error))))
            return
        self._queue += [(client, read_live_request(request)) for request in requests]

    def warm(self, most: int | None = None) -> None:
        """Prepare what requests with a stroke or a hold need to know of gestures, a millisecond each. `most`
        limits how many; None prepares all. Each tick prepares one.
        """
        while self._cold and most != 0:
            find_phases(self.project, self._cold.pop())
            most = None if most is None else most - 1

    def change(self, project: Project) -> None:
        """Continue with an edited project. What has not begun is planned again at the next tick."""
        self.running.project = project
        self.admission.change(project)
        self._edited = True
        self._cold = [x for x in project.actions() if x.kind == "gesture"]
        self._told.clear()

    def offer(self, name: str, graph: LiveGraph | None) -> None:
        """Let clients ask for a motion graph by name from now on; None while it is being made."""
        self.generating.graphs[name] = graph
        self._told.clear()

    # --- ticks

    def tick(self, now: float, heard: Iterable[tuple[int, HeardMessage | Reply]] = ()) -> Out:
        """Answer what was received, then `heard`, and advance to `now`, in seconds that never decrease."""
        before, self.now = self.now, max(now, self.now)
        self.admission.now = self.now
        queue, self._queue = [*self._queue, *heard], []
        self.ledger.limits.tick(self.now)
        self._told.pop("status", None)
        out, work = Out(), TickWork(steered=self.admission.steering.close_forgotten(self.now))
        out.replies = [Reply()] * len(queue)
        self.ledger.limits.several = len(self.clients) > 1
        self.ledger.limits.around = {client for client, _ in queue}
        for done, place in enumerate(order_requests([client for client, _ in queue])):
            client, item = queue[place]
            if isinstance(item, Reply):
                out.replies[place] = item
            elif done >= PER_TICK:
                out.replies[place] = Reply(id=item.message.id or None, state="refused", why=BUSY)
            else:
                if client not in self.clients:
                    self.join(client)
                found = self._take(self.clients[client], item, work, place)
                out.replies[place] = Reply() if found is None else found
        self._plan(work, out)
        self.generating.reach(self.now, self.plan, self.project, self.clients)
        self._tidy()
        told = self.happenings.list_happenings(
            self.plan, self.ledger, before, self.now, self.clients.values()
        )
        out.events += ((client.number, event) for client, event in told)
        self.warm(1)
        out.frames = collect_due_frames(
            self.now,
            self.evaluator,
            [(c.number, c.stream) for c in self.clients.values() if c.stream],
            self.overlay,
        )
        return out

    def _take(self, client: Client, heard: HeardMessage, work: TickWork, place: int) -> Reply | bytes | None:
        """Return the reply to a message; None if it has to be planned first."""
        message = heard.message
        if isinstance(message, Hello | Status | Describe):
            return self._own(client, message)
        if isinstance(message, SetParameter):
            try:
                request = self.parameters.take(self.project.parameters, message.name, message.value)
            except a.RequestError as error:
                return Reply(id=message.id or None, error=str(error))
            heard = HeardMessage(msgspec.structs.replace(request, id=message.id))
        return self.admission.take(client, heard, work, place)

    def _own(self, client: Client, message: Hello | Status | Describe) -> Reply | bytes:
        """Answer requests about the session itself."""
        if isinstance(message, Status):
            if "status" not in self._told:
                self._told["status"] = describe.describe_status(self)
            return describe.with_id(self._told["status"], message.id)
        if isinstance(message, Describe):
            if self.ledger.limits.characters >= BML_PER_TICK:
                return Reply(id=message.id or None, state="refused", why=BUSY)
            if "project" not in self._told:
                self._told["project"] = describe.describe(
                    self.project, tuple(self.generating.models), tuple(self.generating.graphs)
                )
            self.ledger.limits.characters += len(self._told["project"])
            return describe.with_id(self._told["project"], message.id)
        self._name(client, message.name)
        if message.events is not msgspec.UNSET:
            client.events = "all" if message.events == "all" else "own" if message.events else ""
        if message.poses is not msgspec.UNSET:
            try:
                client.stream = (
                    None if message.poses is None else Stream.of(message.poses, self.project, self.now)
                )
            except a.RequestError as error:
                return Reply(id=message.id or None, error=str(error))
        return describe.make_greeting(self, client.stream, message.id)

    def _name(self, client: Client, name: str) -> None:
        """Take note of a client's name: what was asked for under it is that client's from now on."""
        if not name or name == client.name:
            return
        client.name = name
        client.agent = self._agents.setdefault(name, client.agent)
        while len(self._agents) > AGENTS:
            del self._agents[next(iter(self._agents))]

    # --- the plan

    def _plan(self, work: TickWork, out: Out) -> None:
        """Plan a tick's requests, answer them, and report others that changed because of them."""
        now = self.now
        self.running.reach(now, self._edited)
        # What is taken back is not held until it is resumed.
        work.steered = [x for x in work.steered if x.what not in work.gone or x.what in work.asks]
        if work.asks or work.gone or work.steered:
            asks = [*work.gone.values(), *work.asks.values(), *work.steered]
            self.tape.keep(asks, now)
            self.running.hear(now, asks)
        for done in work.over:
            out.replies[done.place] = Reply(id=done.ident, state="refused", why=done.why)
        if not (work.asks or work.gone or work.steered or work.open or self._edited):
            return
        self._edited = False
        self.admission.settling().settle(work, self.admission.steering, self.clients.values(), out)

    # --- the past

    def _tidy(self) -> None:
        """Forget what is over, so that a session can last for days."""
        if self.now < self._tidied + TIDY:
            return
        now = self._tidied = self.now
        open_ = self.admission.steering.find_open(self.plan, now)
        for key, ask in self.ledger.forget(now, open_):
            why = reword_for_client(
                "; ".join(r.message for r in self.plan.reports if r.request == key), ask.client
            )
            self.admission.settling().end_waiting(key, ask, "dropped", why or "something else plays")
        recent = max(RECENT, self.project.settings.memory)
        if now > self._begin + recent + CUT:
            begin, self._begin = self._begin, now - recent
            self._past.append((begin, self.running.forget(self._begin)))
            while self._past and self._past[0][0] < now - self.history - recent - CUT:
                self._past.popleft()
        plan = self.plan
        near = {m.request.id for layer in plan.layers.values() for m in layer.metas if m.end > now - KEPT}
        owner = self.ledger.owner
        last = len(plan.reports) - TOLD
        reports = tuple(
            r for n, r in enumerate(plan.reports) if n >= last or (r.at > now - KEPT and owner(r.request))
        )
        requests = tuple(r for r in plan.requests if r.id in near or owner(r.id))
        self.running.plan = replace(plan, reports=reports, requests=requests, track=thin_track(plan, now))

    def overlay(self, seconds: float) -> Overlay | None:
        """Return the generated motion over the plan at a time near now, None if there is none."""
        return self.generating.overlay(self.plan, self.project, seconds)

    def pose(self, seconds: float) -> Pose:
        """Return the pose at a time near now, with generated motion."""
        if self.evaluator is None:
            raise ValueError("a project without clips cannot be posed")
        return self.evaluator.at(seconds, overlay=self.overlay(seconds))

    def plan_at(self, seconds: float) -> Plan:
        """Return the plan that knows what was shown at a time: the running plan, or an earlier one for the
        past.
        """
        whole = seconds - LOOKS_BACK  # the body still answers what the arms did then
        if whole >= self._begin or not self._past:
            return self.plan
        return next((plan for begin, plan in reversed(self._past) if begin <= whole), self._past[0][1])

    def performance(self, name: str) -> a.Performance:
        """Return the session so far as a performance to keep, which `perform` plays in the same way. It ends
        before now if the session is longer than what is kept (`kept_words`).
        """
        length = max(0.1, min(self.now, self.tape.until, a.LONGEST_PERFORMANCE))
        asks = tuple(ask for ask in self.tape.asks() if (ask.told or 0.0) <= length)
        return a.Performance(
            name=name,
            asks=asks,
            seed=self.plan.seed,
            length=length,
            idle=self.running.idle,
            stances=self.running.stances,
        )

    def kept_words(self) -> str:
        """Return what a performance of the session lacks, "" if it is complete."""
        if self.now <= min(self.tape.until, a.LONGEST_PERFORMANCE):
            return ""
        if self.tape.until < a.LONGEST_PERFORMANCE:
            why = f"the session has more requests than fit into {self.tape.most / 1024 / 1024:g} MiB"
        else:
            why = "a performance cannot be longer"
        kept = min(self.tape.until, a.LONGEST_PERFORMANCE)
        return f"only the first {kept / 60:.0f} of {self.now / 60:.0f} minutes are saved: {why}"
