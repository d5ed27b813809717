"""What agents do with what is said: break off, pause, go on, or say that no more comes."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, TypeGuard

from metagraph.graph import requests as a
from metagraph.graph.model import Project
from metagraph.live.answers import FoundAnswer
from metagraph.live.happenings import Happenings
from metagraph.live.ledger import Ledger, plan_key
from metagraph.live.limits import BUSY
from metagraph.live.messages import Reply, round_seconds
from metagraph.live.tick_work import Client, TickWork
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.items import find_line_start
from metagraph.playback.life.utterances import (
    find_forgotten,
    find_soon,
    find_stop,
    find_utterances,
    is_paused,
)
from metagraph.playback.plan import Plan
from metagraph.playback.planning.hearing import makers
from metagraph.speech.spoken_so_far import spoken_until

INTERRUPTED = "it was interrupted by a request"
SteeringRequest = a.Interrupt | a.Pause | a.Resume | a.Finish


def is_steering(ask: Any) -> TypeGuard[SteeringRequest]:
    """Whether a request does something to what is said."""
    return isinstance(ask, SteeringRequest)


class Steering:
    """Answers these requests, and notes what they end. Arguments: of the session."""

    def __init__(self, project: Project, ledger: Ledger, happenings: Happenings) -> None:
        self.project, self.ledger, self.happenings = project, ledger, happenings
        self._forgotten: list[str] = []

    def is_open(self, plan: Plan, key: str, work: TickWork) -> bool:
        """Whether more was promised under a key, or what is said there is paused."""
        ask, last = work.asks.get(key), plan.track.last_speech(key)
        if isinstance(ask, a.Say):
            return ask.more
        return last is not None and (last.more or is_paused(last.start))

    def find_open(self, plan: Plan, now: float) -> set[str]:
        """Return the keys of what is said and not over at `now`; note those that nothing came of for long."""
        self._forgotten = find_forgotten(plan.track, now)
        return set(find_utterances(plan.track, "", now))

    def close_forgotten(self, now: float) -> list[SteeringRequest]:
        """Return requests that finish those of which nothing came for long."""
        keys, self._forgotten = self._forgotten, []
        return [a.Finish(id=f"{key}.0", what=key, told=now) for key in keys]

    def answer(
        self, client: Client, ident: str, ask: SteeringRequest, plan: Plan, now: float, work: TickWork
    ) -> Reply:
        """Return the reply to a request, and note in `work` what it does."""
        word = str(ask.__struct_config__.tag)
        if self.ledger.limits.refusal(word, now, 0.0, 0, now, client.number):
            return Reply(id=ident, state="refused", why=BUSY)
        owner, soon = client.owner, find_soon(now, self.project.settings.lookahead)
        mine, target = plan_key(owner, ""), plan_key(owner, ask.what)
        keys = [x for x in find_utterances(plan.track, "", soon) if x.startswith(mine)]
        keys += [x for x, y in work.asks.items() if isinstance(y, a.Say) and x.startswith(mine)]
        keys = [x for x in dict.fromkeys(keys) if not ask.what or x == target]
        known = plan_key(owner, ident)
        if isinstance(ask, a.Interrupt):
            if ask.what and not keys:  # it was said, and its gestures go on
                running = [x for x in self.happenings.list_lasting() if target in makers(x)]
                keys = [target] if running or self.ledger.belonging(target) else []
            return self._interrupt(known, ident, ask, keys, plan, now, work)
        if isinstance(ask, a.Finish):
            keys = [key for key in keys if self.is_open(plan, key, work)]
            return self._turn(known, ident, ask, keys, now, work, "nothing said there is still open")
        held = {key for key in keys if self._is_held(plan, key, work)}
        if isinstance(ask, a.Resume):
            keys = [key for key in keys if key in held]
            work.paused -= set(keys)
            reply = self._turn(known, ident, ask, keys, now, work, "nothing is paused")
            first = next((s for s in plan.track.speeches if s.id in keys and is_paused(s.start)), None)
            if first is None:
                return reply
            at, skip = round_seconds(soon), round_seconds(first.skip)
            return Reply(id=reply.id, state=reply.state, at=at, why=reply.why, skip=skip)
        free = [key for key in keys if key not in held]
        why = "it is paused already" if held else "nothing is said"
        reply = self._turn(known, ident, ask, free, now, work, why)
        work.paused |= set(free)
        return self._with_spoken(reply, free, plan, soon, now)

    def _is_held(self, plan: Plan, key: str, work: TickWork) -> bool:
        last = plan.track.last_speech(key)
        done = [x for x in work.steered if isinstance(x, a.Pause | a.Resume) and x.what == key]
        if done:
            return isinstance(done[-1], a.Pause)
        return last is not None and is_paused(last.start)

    def _turn(
        self,
        known: str,
        ident: str,
        ask: SteeringRequest,
        keys: Collection[str],
        now: float,
        work: TickWork,
        why: str,
    ) -> Reply:
        """Let a request act on what is said under some keys; return the reply. why: if there are none."""
        for n, key in enumerate(keys):
            work.steered.append(type(ask)(id=f"{known}.{n}", what=key, told=now, priority=ask.priority))
            if not isinstance(ask, a.Finish):
                work.turned.update(self.ledger.belonging(key))
        return Reply(id=ident, state="done", why="" if keys else why)

    def _interrupt(
        self,
        known: str,
        ident: str,
        ask: a.Interrupt,
        keys: list[str],
        plan: Plan,
        now: float,
        work: TickWork,
    ) -> Reply:
        soon = find_soon(now, self.project.settings.lookahead)
        reply = self._turn(known, ident, ask, keys, now, work, "nothing is said")
        reply = self._with_spoken(reply, keys, plan, soon, now)
        for key in keys:
            made = [x for x in self.happenings.list_lasting() if key in makers(x)]
            for each in dict.fromkeys([key, *self.ledger.belonging(key), *made]):
                before = work.close(each, INTERRUPTED)
                work.asks.pop(each, None)
                self.happenings.stop(each, "interrupted", INTERRUPTED)
                dropped = self.ledger.drop(each)
                for name, one in dropped if before is None else [(each, before), *dropped]:
                    fixed = now + self.project.settings.lookahead
                    self.happenings.end_waiting(name, one, "interrupted", INTERRUPTED, now, plan, fixed)
        return reply

    def _with_spoken(self, reply: Reply, keys: Collection[str], plan: Plan, soon: float, now: float) -> Reply:
        """Return a reply with what was spoken of what stops first."""
        latest, speeches = now + self.project.settings.lookahead, plan.track.speeches
        running = (s for s in speeches if s.id in keys and s.start < soon < s.end)
        began = (s for s in reversed(speeches) if s.id in keys and s.start < soon)
        piece = next(running, None) or next(began, None)
        if piece is None:
            return reply
        stop = find_stop(ALPHABET, plan.track, piece.id, soon, max(latest, soon))
        stop = piece.end if is_paused(stop) else min(stop, piece.end)
        spoken, word = spoken_until(ALPHABET, speeches, piece.id, stop)
        skip = round_seconds(stop - find_line_start(piece))
        return Reply(
            id=reply.id,
            state=reply.state,
            at=round_seconds(stop),
            why=reply.why,
            spoken=spoken,
            last_word=word or None,
            skip=skip,
        )

    def stop_paused(self, work: TickWork, found: Mapping[str, FoundAnswer]) -> None:
        """Note why gestures end that had their moment when what they were made for was paused."""
        for request in self.happenings.list_lasting() if work.paused else ():
            made = [x for x in makers(request) if x in work.paused and x != request]
            if made and not (request in found and found[request].paused):
                self.happenings.stop(request, "interrupted", "what it was made for is paused")
