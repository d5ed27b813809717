"""Settle what becomes of requests once they are planned: the replies to them, and events for earlier ones
that change or end because of them.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import msgspec

from metagraph.common.wording import phrase
from metagraph.graph.model import LAYERS, Project
from metagraph.live.answers import FoundAnswer, find
from metagraph.live.happenings import SAID, UNSAID, Happenings
from metagraph.live.ledger import Ledger, OpenAsk, reword_for_client
from metagraph.live.messages import Event, Part, Reason, Reply, round_seconds
from metagraph.live.steering import Steering
from metagraph.live.tick_work import Client, Open, Out, TickWork
from metagraph.playback.life.items import find_line_start
from metagraph.playback.life.utterances import goes_on, is_paused
from metagraph.playback.plan import Plan
from metagraph.playback.planning.hearing import makers

AGAIN = 0.25  # seconds for which a layer without room is not tried again


@dataclass(frozen=True, slots=True)
class Settling:
    """Settles requests at `now`, seconds. plan: with the requests of the tick. The other fields are the
    session's.
    """

    plan: Plan
    now: float
    project: Project
    ledger: Ledger
    happenings: Happenings

    def settle(self, work: TickWork, steering: Steering, clients: Collection[Client], out: Out) -> None:
        """Answer a tick's requests, which were planned, and report others that changed because of them."""
        for open_ in work.open.values():
            self._end_replaced(open_)
        watched = {
            key: ask
            for key, ask in self.ledger.known.items()
            if not ask.settled or ask.at > self.now or key in work.turned
        }
        found = find(self.plan, watched, self.now - 1.0)
        steering.stop_paused(work, found)
        for key, ask in watched.items():
            if ask.settled and ask.differs(found.get(key)):
                self._tell_changed(key, ask, found.get(key, FoundAnswer()), clients, out)
        for open_ in work.open.values():
            if open_.parts is None:
                answer = FoundAnswer() if self._is_unsaid(open_) else found.get(open_.key, FoundAnswer())
                reply = self._settle(open_.key, answer)
                for each in (open_, *open_.also):
                    out.replies[each.place] = self._tell_added(each, reply)
            else:
                out.replies[open_.place] = self._settle_block(open_, found)

    def end_waiting(self, key: str, ask: OpenAsk, reason: Reason, why: str) -> None:
        """Report that something has ended which was promised and has not begun."""
        fixed = self.now + self.project.settings.lookahead
        self.happenings.end_waiting(key, ask, reason, why, self.now, self.plan, fixed)

    def _settle(self, key: str, found: FoundAnswer) -> Reply:
        """Return the reply to a request that was planned, or was not."""
        ask = self.ledger.known[key]
        if found.state in ("refused", "done"):
            full = ask.lane in LAYERS and any(r.outcome in ("covered", "no-room") for r in found.reports)
            if full and ask.at <= self.now + self.project.settings.wait:
                self.ledger.limits.full[ask.lane, ask.client] = (self.now + AGAIN, ask.priority)
                self.ledger.limits.turned_away(ask.lane, ask.client, ask.priority, self.now)
            self.ledger.drop(key)
        else:
            self.ledger.settle(key, found)
            if ask.lane in SAID:
                self.happenings.promise(key, ask.client, ask.ident, self.plan)
        why = f"too late by {ask.missed:.2f} s" if ask.missed > 0 and not found.why else found.why
        if found.state == "refused" and not found.reports and ask.lane in SAID:
            why = UNSAID
        return Reply(
            id=ask.ident,
            state=found.said(ask.missed),  # type: ignore[arg-type]
            layer=found.layer,
            at=round_seconds(found.at),
            until=round_seconds(found.until),
            actions=tuple(found.what),
            why=reword_for_client(why, ask.client),
        )

    def _is_unsaid(self, open_: Open) -> bool:
        """Return whether nothing of a line is said, so that the plan only has what was said before under its
        id.
        """
        before, speeches = open_.adds, self.plan.track.speeches
        same = before is not None and self.plan.track.last_speech(open_.key) is before
        return (
            same and self.ledger.known[open_.key].lane in SAID and not goes_on(speeches, open_.key, self.now)
        )

    def _goes_on_from(self, open_: Open) -> bool:
        """Return whether what is said goes on from what was said last under its id."""
        speech, before = self.plan.track.last_speech(open_.key), open_.adds
        if speech is None or before is None or speech is before:
            return False
        told = speech.timing is not None and before.timing is not None
        # Words that come when all was said go on with it, as an utterance of their own.
        return speech.asked == before.asked or (told and speech.start == before.start)

    def _end_replaced(self, open_: Open) -> None:
        """Report that what waited under an id has ended, if something else has taken its place; so have the
        gestures that were made for what was said.
        """
        if self._goes_on_from(open_):
            return
        gone = [] if open_.replaces is None else [(open_.key, open_.replaces)]
        if open_.adds is not None:
            made = [key for key in self.ledger.belonging(open_.key) if makers(key)[-1] == open_.key != key]
            made = [key for key in made if self.ledger.known[key].settled]
            gone += [one for key in made for one in self.ledger.drop(key)]
        for key, ask in gone:
            if key != open_.key:
                self.happenings.stop(key, "replaced")
            self.end_waiting(key, ask, "replaced", "asked again under the same id")

    def _tell_added(self, open_: Open, reply: Reply) -> Reply:
        """Return a reply with what has become of what was added to a line."""
        speech, before, notes, at = (
            self.plan.track.last_speech(open_.key),
            open_.adds,
            open_.notes,
            reply.at,
        )
        if speech is None or before is None or not self._goes_on_from(open_):
            return msgspec.structs.replace(reply, notes=notes)
        if speech.timing is not None and before.timing is not None:
            words = {(w.start, w.text) for w in speech.timing.words}
            marks = {(m.at, m.viseme) for m in speech.timing.marks}
            words -= {(w.start, w.text) for w in before.timing.words}
            marks -= {(m.at, m.viseme) for m in before.timing.marks}
            if words or marks:
                at = round_seconds(find_line_start(speech) + min(words | marks)[0])
            elif speech.text != before.text:  # a mark behind what was said
                at = round_seconds(before.end)
            else:
                notes = (*notes, str(phrase("nothing new is said: it was said before, or its time is over")))
        began = self.happenings.find_beginning(before)
        if began is None and not is_paused(before.start):
            began = find_line_start(before)
        since = round_seconds(began)
        if is_paused(before.start):
            at = reply.at
        cut = speech.length is not None and before.end > self.now  # something else cuts short what runs
        if cut and at is not None and at >= speech.end:
            return Reply(id=reply.id, state="refused", why=UNSAID, notes=notes)
        return msgspec.structs.replace(reply, at=at, since=since, notes=notes)

    def _settle_block(self, open_: Open, found: Mapping[str, FoundAnswer]) -> Reply:
        """Return the reply to a block of BML: for each behaviour, and for all of them."""
        parts: list[Part] = []
        for key, called, word, why in open_.parts or ():
            if why or key not in self.ledger.known:
                parts.append(Part(id=called, do=word, state="refused", why=why or "taken back"))
                continue
            r = self._settle(key, found.get(key, FoundAnswer()))
            parts.append(
                Part(
                    id=called,
                    do=word,
                    state=r.state or "refused",
                    at=r.at,
                    until=r.until,
                    actions=r.actions,
                    why=r.why,
                )
            )
        states = {part.state for part in parts}
        state = next((s for s in ("late", "planned", "done", "refused") if s in states), "done")
        starts = [p.at for p in parts if p.at is not None]
        ends = [p.until for p in parts if p.until is not None]
        return Reply(
            id=open_.ident or None,
            state=state,  # type: ignore[arg-type]
            at=min(starts, default=None),
            until=max(ends, default=None),
            notes=open_.notes,
            actions=tuple(x for p in parts for x in p.actions),
            parts=tuple(parts),
            why="" if parts else "nothing in it was understood",
            seen=open_.seen,
        )

    def _tell_changed(
        self, key: str, ask: OpenAsk, found: FoundAnswer, clients: Collection[Client], out: Out
    ) -> None:
        """Report to the client that an earlier answer to its request has changed."""
        if found.state in ("refused", "done"):
            self.ledger.drop(key)
        else:
            self.ledger.settle(key, found)
        for client in [c for c in clients if c.owner == ask.client and c.events]:
            event = Event(
                event="changed",
                t=round_seconds(self.now),
                id=ask.ident,
                state=found.said(ask.missed),  # type: ignore[arg-type]
                layer=found.layer,
                at=round_seconds(found.at),
                until=round_seconds(found.until),
                actions=tuple(found.what),
                why=reword_for_client(found.why, ask.client),
            )
            out.events.append((client.number, event))
        if found.state in ("refused", "done"):
            why = reword_for_client(found.why, ask.client)
            if ask.lane in SAID:
                self.happenings.stop(key, "dropped", why)
            self.end_waiting(key, ask, "dropped", why)
