"""Decide what becomes of each request of a live session: it waits for the plan, is answered at once, or is
refused; and take back what is withdrawn.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import msgspec

from metagraph.common.wording import phrase
from metagraph.graph import requests as a
from metagraph.graph.model import Project
from metagraph.live.camera_mimicry import see
from metagraph.live.generating import Generating
from metagraph.live.happenings import Happenings
from metagraph.live.ledger import Ledger, OpenAsk, plan_key
from metagraph.live.limits import (
    ADDED,
    BML_PER_TICK,
    BUSY,
    NAMES,
    PENDING,
    SPEECH,
    TAG,
    RequestWords,
    explain_too_far,
    explain_unknown,
    set_start_now,
)
from metagraph.live.messages import Generate, Hear, HeardMessage, Keypoints, OwnMessage, Partner, Reply
from metagraph.live.partner_mood import LAUGH, MOOD, find_partner_feel
from metagraph.live.said_sound import SaidSounds, join_asks
from metagraph.live.said_text import SaidTexts, is_told
from metagraph.live.settling import Settling
from metagraph.live.steering import Steering, SteeringRequest, is_steering
from metagraph.live.tick_work import Client, Open, TickWork
from metagraph.playback.bml.reader import BmlBlock, read_block
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.items import LookAt, Speech, StayFrom, find_line_start
from metagraph.playback.life.utterances import find_soon, goes_on
from metagraph.playback.plan import Plan
from metagraph.playback.planning.hearing import makers
from metagraph.playback.planning.mood import MoodFrom
from metagraph.playback.planning.running_plan import RunningPlan
from metagraph.speech.spoken_so_far import spoken_until
from metagraph.speech.word_gestures import telling


class Admission:
    """What a session accepts. The arguments are the session's own; `now` is the time of the current tick.

    It keeps the names that points were given, and the sounds and texts of what is being said.
    """

    def __init__(
        self,
        running: RunningPlan,
        ledger: Ledger,
        happenings: Happenings,
        generating: Generating,
        clients: Mapping[int, Client],
    ) -> None:
        self.running, self.ledger, self.happenings = running, ledger, happenings
        self.generating, self.clients = generating, clients
        self.steering = Steering(running.project, ledger, happenings)
        self.now = 0.0
        self._words = RequestWords(running.project)
        self._names: set[str] = set()
        self._sounds = SaidSounds()
        self._texts = SaidTexts()

    @property
    def project(self) -> Project:
        """Return the project as it is edited now."""
        return self.running.project

    @property
    def plan(self) -> Plan:
        """Return the current plan."""
        return self.running.plan

    def change(self, project: Project) -> None:
        """Continue with an edited project."""
        self.steering.project, self._words = project, RequestWords(project)

    def take(self, client: Client, heard: HeardMessage, work: TickWork, place: int) -> Reply | None:
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
        assert not isinstance(message, OwnMessage), "the session answers what is about itself"
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
            reply = self.steering.answer(client, ident, ask, self.plan, self.now, work)
            return self._note_left(client, ask, reply)
        notes = self._note_unknown_point(ask)
        if isinstance(ask, a.Say) and (ask.text or self.steering.is_open(self.plan, key, work)):
            opened = self.steering.is_open(self.plan, key, work)
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
            return self.steering.answer(client, ident, over, self.plan, self.now, work)
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

    def _partner(self, client: Client, message: Partner, work: TickWork, place: int) -> Reply | None:
        """Take up what the partner feels, or laugh along."""
        ident = message.id or (MOOD if message.laughs is None else LAUGH)
        key = plan_key(client.owner, ident)
        feel = find_partner_feel(message, ident, key, self.project, self.plan.track, self.now)
        if feel is None:
            return Reply(id=message.id or None, state="done", why="it does not laugh along")
        return self.take(client, HeardMessage(feel), work, place)

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
                self.settling().end_waiting(each, ask, "withdrawn", "taken back")
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

    def settling(self) -> Settling:
        """Return what answers the requests that the plan has settled."""
        return Settling(self.plan, self.now, self.project, self.ledger, self.happenings)
