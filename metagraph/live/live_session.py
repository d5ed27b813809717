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
from typing import Any

import msgspec

from metagraph.common.wording import phrase
from metagraph.graph import requests as a
from metagraph.graph.model import Layer, Project
from metagraph.live import describe
from metagraph.live.camera_mimicry import see
from metagraph.live.generating import Generating
from metagraph.live.graph_motion import LiveGraph
from metagraph.live.happenings import Happenings
from metagraph.live.ledger import Ledger, OpenAsk, plan_key, reword_for_client
from metagraph.live.limits import (
    ADDED,
    BML_PER_TICK,
    BUSY,
    NAMES,
    PENDING,
    PER_TICK,
    SPEECH,
    TAG,
    RequestWords,
    explain_too_far,
    explain_unknown,
    set_start_now,
)
from metagraph.live.messages import (
    Describe,
    Generate,
    Hear,
    HeardMessage,
    Hello,
    Keypoints,
    OwnMessage,
    Partner,
    Reply,
    Status,
    read_live_request,
    split_message,
)
from metagraph.live.partner_mood import LAUGH, MOOD, find_partner_feel
from metagraph.live.pose_stream import Stream, collect_due_frames
from metagraph.live.said_sound import SaidSounds, join_asks
from metagraph.live.said_text import SaidTexts, is_told
from metagraph.live.settling import Settling
from metagraph.live.steering import Steering, SteeringRequest, is_steering
from metagraph.live.tape import Tape
from metagraph.live.tick_work import Agent, Client, Open, Out, TickWork, order_requests, thin_track
from metagraph.motion.skeleton import Pose
from metagraph.playback.bml.reader import BmlBlock, read_block
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.items import LookAt, Speech, StayFrom, find_line_start
from metagraph.playback.life.utterances import (
    find_soon,
    goes_on,
)
from metagraph.playback.plan import Plan
from metagraph.playback.planning.hearing import makers
from metagraph.playback.planning.mood import MoodFrom
from metagraph.playback.planning.plan_head import RECENT
from metagraph.playback.planning.running_plan import CUT, RunningPlan
from metagraph.playback.posing.overlay import Overlay
from metagraph.playback.posing.weight import LOOKS_BACK
from metagraph.playback.timing.phases import find_phases
from metagraph.speech.spoken_so_far import spoken_until
from metagraph.speech.word_gestures import telling

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
        self.project, self.history = project, history
        self.running = RunningPlan(project, seed, stances, idle, ahead)
        self.now = 0.0
        self.clients: dict[int, Client] = {}
        self.ledger = Ledger()
        self.happenings = Happenings()
        self._agents: dict[str, Agent] = {}
        self.generating = Generating(models, graphs)
        self._words = RequestWords(project)
        self._names: set[str] = set()
        self._queue: list[tuple[int, HeardMessage | Reply]] = []
        self.tape = Tape()
        self._sounds = SaidSounds()
        self._texts = SaidTexts()
        self._steering = Steering(project, self.ledger, self.happenings)
        self._tidied = self._begin = 0.0
        self._past: deque[tuple[float, Plan]] = deque()
        self._edited = False
        self._cold = [x for x in project.actions() if x.kind == "gesture"]
        self._told: dict[str, bytes] = {}
        self._evaluator: Evaluator | None = None

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
        self.project = self.running.project = self._steering.project = project
        self._words, self._edited = RequestWords(project), True
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
        queue, self._queue = [*self._queue, *heard], []
        self.ledger.limits.tick(self.now)
        self._told.pop("status", None)
        out, work = Out(), TickWork(steered=self._steering.close_forgotten(self.now))
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
        """Return the reply to a request; None if it has to be planned first."""
        message = heard.message
        if isinstance(message, Keypoints):
            return self._keypoints(client, message, work, place)
        if isinstance(message, Generate | Hear):
            if self.ledger.limits.refusal(
                str(message.__struct_config__.tag), self.now, 0.0, 0, self.now, client.number
            ):
                return Reply(id=message.id or None, state="refused", why=BUSY)
            return self.generating.answer(client.number, message, self.project, self.now)
        if isinstance(message, Partner):
            return self._partner(client, message, work, place)
        if isinstance(message, OwnMessage):
            return self._own(client, message)
        ident = message.id
        if not ident:
            client.agent.count += 1
            ident = f"#{client.agent.count}"
        key = plan_key(client.owner, ident)
        ask: Any = msgspec.structs.replace(
            message, at=message.at if heard.after is None else self.now + heard.after, told=self.now
        )
        if isinstance(ask, a.Withdraw):
            return self._withdraw(client, ident, ask, work)
        if isinstance(ask, a.Bml):
            return self._block(client, Open(place, ident, key), ask, work)
        if is_steering(ask):
            reply = self._steering.answer(client, ident, ask, self.plan, self.now, work)
            return self._note_left(client, ask, reply)
        notes = self._note_unknown_point(ask)
        if isinstance(ask, a.Say) and (ask.text or self._steering.is_open(self.plan, key, work)):
            opened = self._steering.is_open(self.plan, key, work)
            ask, left_out = self._texts.read(key, ask, opened)
            notes = tuple(str(phrase("left out: {what}", what=what)) for what in left_out)
            silent = self._answer_silence(client, ident, ask, opened, work)
            if silent is not None:
                return msgspec.structs.replace(silent, notes=notes)
        before = work.open.get(key)
        adds = self.plan.track.last_speech(key) if isinstance(ask, a.Say) else None
        waits = self.ledger.known.get(key)
        why = self._admit(client, ident, key, ask, work)
        if why:
            return Reply(id=ident, state="refused", why=why, notes=notes)
        if before is not None and before.replaces is not None and before.replaces.settled:
            waits = before.replaces
        also = [before, *before.also] if before is not None and before not in work.over else []
        work.open[key] = Open(place, ident, key, notes=notes, adds=adds, replaces=waits, also=also)
        return None

    def _answer_silence(
        self, client: Client, ident: str, ask: a.Say, opened: bool, work: TickWork
    ) -> Reply | None:
        """Return the reply to a text of which nothing is said; None for others. opened: whether it is added
        to an utterance, whose last mark it may be.
        """
        if is_told(ask) or telling(ALPHABET, ask.text) or (opened and ask.text.strip()):
            return None
        if opened and not ask.more:  # nothing more comes
            over = a.Finish(id=ask.id, what=ident, told=self.now, priority=ask.priority)
            return self._steering.answer(client, ident, over, self.plan, self.now, work)
        why = str(phrase("the text contains no words to say"))
        return Reply(id=ident, state="done" if ask.more else "refused", why=why)

    def _note_left(self, client: Client, ask: SteeringRequest, reply: Reply) -> Reply:
        """Return the reply to a request that may end utterances, with what of those that are finished still
        waited to be said.
        """
        if not isinstance(ask, a.Interrupt | a.Finish):
            return reply
        left = self._texts.close(plan_key(client.owner, ask.what), not ask.what)
        if not left or isinstance(ask, a.Interrupt):
            return reply
        return msgspec.structs.replace(reply, notes=(str(phrase("left out: {what}", what=left[:200])),))

    def _note_unknown_point(self, ask: Any) -> tuple[str, ...]:
        """Return a note where a request is a look at a name that nothing has."""
        known = {"user", "ahead", "partner", *self.project.points, *self._names}
        if not isinstance(ask, a.Look) or not isinstance(ask.to, str) or ask.to in known:
            return ()
        text = phrase(
            "nothing is called '{name}', so the gaze stays ahead; there are {known}, and 'place' adds one",
            name=ask.to[:60],
            known=", ".join(sorted(known)[:10]),
        )
        return (str(text),)

    def _partner(self, client: Client, message: Partner, work: TickWork, place: int) -> Reply | bytes | None:
        """Take up what the partner feels, or laugh along."""
        ident = message.id or (MOOD if message.laughs is None else LAUGH)
        key = plan_key(client.owner, ident)
        feel = find_partner_feel(message, ident, key, self.project, self.plan.track, self.now)
        if feel is None:
            return Reply(id=message.id or None, state="done", why="it does not laugh along")
        return self._take(client, HeardMessage(feel), work, place)

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

    # --- what becomes of a request

    def _admit(self, client: Client, ident: str, key: str, ask: Any, work: TickWork) -> str:
        """Accept a request; return the reason if it is refused."""
        wait = self.project.settings.wait
        why = explain_too_far(ask, self.now)
        if why:
            return why
        goes_on = isinstance(ask, a.Say) and self._goes_on(key, work)
        if isinstance(ask, a.Say):
            try:
                ask = self._said(key, ask, goes_on)
            except a.RequestError as error:
                return str(error)
        in_time = set_start_now(ask, self.now, wait)
        if in_time.why:
            return in_time.why
        ask = in_time.ask
        lane = self._words.lane(ask)
        if lane is None:
            return explain_unknown(self.project, ask, self.ledger.limits)
        lane = ADDED if goes_on else lane
        why = self._without_name(ask) or self._without_room(client, key)
        if why:
            return why
        ledger, stroke = self.ledger, getattr(ask, "stroke", None)
        wanted = stroke if stroke is not None else self.now if ask.at is None else ask.at
        why = ledger.limits.refusal(lane, wanted, wait, ask.priority, self.now, client.number)
        if why:
            return why
        if key in ledger.blocks:
            self._take_back([key], work)
        before = work.asks.get(key)
        both = join_asks(before, ask) if isinstance(ask, a.Say) and isinstance(before, a.Say) else None
        if both is None:
            work.close(key, "asked again under the same id")
        ask = both or ask
        ledger.limits.planned[client.number] += 1
        if not isinstance(ask, a.Say):
            self.happenings.stop(key, "replaced")
        waits = OpenAsk(client.owner, ident, lane, ask.priority, wanted, missed=in_time.missed, told=self.now)
        ledger.add(key, waits)
        work.asks[key] = msgspec.structs.replace(ask, id=key)
        return ""

    def _said(self, key: str, ask: a.Say, goes_on: bool) -> a.Say:
        """Return a line with the sound that streams in for it. Raises RequestError for sound that cannot be
        read, or text that is too long.
        """
        if ask.audio is not None:
            begun = self._speech(key)
            soon = find_soon(self.now, self.project.settings.lookahead)
            said = 0.0 if begun is None else soon - find_line_start(begun)
            ask = self._sounds.told(key, ask, goes_on, said)
        if len(ask.text) > SPEECH:
            raise a.RequestError(f"at most {SPEECH} characters can be said at once; say it in pieces")
        return ask

    def _without_name(self, ask: Any) -> str:
        """Note the name that a request gives a point; return the reason if there are too many."""
        if isinstance(ask, a.Place) and ask.name not in self._names:
            if len(self._names) >= NAMES:
                return f"there are {NAMES} named points already; use one of these names"
            self._names.add(ask.name)
        return ""

    def _without_room(self, client: Client, key: str) -> str:
        """Return the reason if so many requests wait that a client has used up its share."""
        ledger = self.ledger
        if key not in ledger.known and len(ledger.known) >= PENDING and ledger.pending(self.now) >= PENDING:
            own = sum(1 for _ in ledger.of(client.owner))
            if own >= PENDING // max(1, len(self.clients)):
                return f"{PENDING} requests wait already; try again when some of them have played"
        return ""

    def _speech(self, key: str) -> Speech | None:
        """Return the speech under a key, with the times of its words or shapes."""
        return next(
            (s for s in reversed(self.plan.track.speeches) if s.id == key and s.timing is not None), None
        )

    def _goes_on(self, key: str, work: TickWork) -> bool:
        """Return whether speech under a key is added to a line."""
        return self._speech(key) is not None or isinstance(work.asks.get(key), a.Say)

    def _withdraw(self, client: Client, ident: str, ask: a.Withdraw, work: TickWork) -> Reply:
        """Withdraw what an agent requested: what waits does not play, what has begun stops or goes back."""
        if self.ledger.limits.refusal("withdraw", self.now, 0.0, 0, self.now, client.number):
            return Reply(id=ident, state="refused", why=BUSY)
        owner, until = client.owner, self.now + self.project.settings.lookahead
        target, mine = plan_key(owner, ask.what), plan_key(owner, "")
        # Who takes everything back still looks at whom it talks with.
        stays = {x.id for x in self.plan.track.looks if x.to == "user" and x.start <= until}
        known = self.ledger.known
        keys = self.ledger.belonging(target) if ask.what else [x for x in known if known[x].client == owner]
        keys = [x for x in keys if not known[x].ended and (ask.what or x not in stays)]
        # What has begun and lasts is no longer in the ledger, but can still be ended.
        track = self.plan.track
        last: list[LookAt | Speech | StayFrom | MoodFrom] = [
            *track.looks,
            *track.speeches,
            *track.stays,
            *track.moods,
        ]
        lasting = [x.id for x in last if x.end > until]
        lasting += self.happenings.list_lasting()
        lasting = [x for x in dict.fromkeys(lasting) if x not in known or known[x].ended]
        keys += [
            x
            for x in lasting
            if (
                x.startswith(target) and target in makers(x)
                if ask.what
                else x.startswith(mine) and x not in stays
            )
        ]
        if not keys:
            return Reply(id=ident, state="done", why=self._why_nothing(target, ask.what))
        speeches = track.speeches
        said = next((s.id for s in speeches if s.id in keys and goes_on(speeches, s.id, until)), None)
        spoken, word = None, None
        if said is not None:
            spoken, word = spoken_until(ALPHABET, speeches, said, until)
        self._take_back([target, *keys] if ask.what else keys, work)
        why = f"{len(keys)} taken back; what has begun stops or goes back to its stance"
        return Reply(id=ident, state="done", why=why, spoken=spoken, last_word=word or None)

    def _why_nothing(self, key: str, what: str) -> str:
        """Return why there is nothing to take back under an id."""
        if any(mode.id == key for mode in self.plan.track.modes[-1:]):
            return "a mode lasts until another one: ask for 'mode' without a mode"
        ended = key in self.ledger.known and self.ledger.known[key].ended
        return "it has ended" if ended else "nothing waits under that id" if what else "nothing waits"

    def _take_back(self, keys: Iterable[str], work: TickWork) -> None:
        for key in keys:
            before = work.close(key, "taken back")
            self.happenings.stop(key, "withdrawn")
            dropped = self.ledger.drop(key)
            for each, ask in dropped if before is None else [(key, before), *dropped]:
                self.happenings.stop(each, "withdrawn")
                self._settling().end_waiting(each, ask, "withdrawn", "taken back")
                work.close(each, "taken back")
                work.asks.pop(each, None)
            work.asks.pop(key, None)
            self._texts.close(key)
            work.gone[key] = a.Withdraw(id=key, what=key, told=self.now)

    def _block(self, client: Client, open_: Open, ask: a.Bml, work: TickWork) -> Reply | None:
        """Accept the behaviours of a block, each separately."""
        limits = self.ledger.limits
        cost = len(ask.bml) + TAG * ask.bml.count("<")
        if limits.characters + cost > BML_PER_TICK and limits.characters > 0:
            return Reply(id=open_.ident, state="refused", why=BUSY)
        limits.characters += cost
        begin = self.now + self.project.settings.lookahead if ask.at is None else ask.at
        try:
            block = read_block(ask.bml, begin, ask.priority, self.project)
            if block.composition == "append":
                last = [k.until or k.at for k in self.ledger.known.values() if k.client == client.owner]
                block = read_block(ask.bml, max(begin, *last, begin), ask.priority, self.project)
        except a.RequestError as error:
            return Reply(id=open_.ident, error=str(error))
        self._take_back(
            [open_.key] if open_.key in self.ledger.blocks or open_.key in self.ledger.known else [], work
        )
        open_.notes, open_.parts = (
            block.notes,
            self._parts(client, open_, block, begin if ask.at is not None else None, work),
        )
        self.ledger.blocks[open_.key] = tuple(key for key, _, _, why in open_.parts if not why)
        work.open[open_.key] = open_
        return None

    def _parts(
        self, client: Client, open_: Open, block: BmlBlock, at: float | None, work: TickWork
    ) -> list[tuple[str, str, str, str]]:
        """Accept what a block asks for; return for each its key, its name, the kind of request, and why it
        was refused already.
        """
        out = []
        for n, ask in enumerate(block.asks):
            key, called = f"{open_.key}.{n + 1}", ask.id or f"{open_.ident}.{n + 1}"
            word = str(ask.__struct_config__.tag)
            if isinstance(ask, a.Withdraw):
                self._take_back(
                    [plan_key(client.owner, ask.what)] if ask.what else [*self.ledger.of(client.owner)],
                    work,
                )
                continue
            timed: Any = msgspec.structs.replace(ask, at=at if ask.at is None else ask.at, told=self.now)
            out.append((key, called, word, self._admit(client, called, key, timed, work)))
        return out

    def _keypoints(self, client: Client, message: Keypoints, work: TickWork, place: int) -> Reply | None:
        """Look at the person before a client's camera; accept the requests that follow from it."""
        ident = message.id or None
        if self.ledger.limits.refusal("keypoints", self.now, 0.0, 0, self.now, client.number):
            return Reply(id=ident, state="refused", why=BUSY)
        try:
            client.camera, asks, seen = see(
                client.camera, message, self.project, self.plan, self.now, plan_key(client.owner, "mimic")
            )
        except ValueError as error:
            return Reply(id=ident, error=str(error))
        if not asks:
            return Reply(id=ident, state="done", seen=seen)
        key = f"{plan_key(client.owner, 'keypoints')}.{place}"
        parts = [(plan_key(client.owner, x.id), x.id, str(x.__struct_config__.tag), x) for x in asks]
        taken = [(k, called, word, self._admit(client, called, k, x, work)) for k, called, word, x in parts]
        work.open[key] = Open(place, message.id, key, taken, seen=seen)
        return None

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
        self._settling().settle(work, self._steering, self.clients.values(), out)

    def _settling(self) -> Settling:
        return Settling(self.plan, self.now, self.project, self.ledger, self.happenings)

    # --- the past

    def _tidy(self) -> None:
        """Forget what is over, so that a session can last for days."""
        if self.now < self._tidied + TIDY:
            return
        now = self._tidied = self.now
        open_ = self._steering.find_open(self.plan, now)
        for key, ask in self.ledger.forget(now, open_):
            why = reword_for_client(
                "; ".join(r.message for r in self.plan.reports if r.request == key), ask.client
            )
            self._settling().end_waiting(key, ask, "dropped", why or "something else plays")
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
