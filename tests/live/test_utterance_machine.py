"""Random sequences of say, append, interrupt, pause, resume, finish, withdraw and coming back, beside a model
of what must be heard: every request is answered once, every utterance ends once, nothing is lost silently.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, ClassVar

import msgspec
import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule, run_state_machine_as_test

from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.utterances import PAUSED, goes_on
from metagraph.speech.spoken_so_far import spoken_until
from tests.thorough import many

TICK = 1 / 60
AGENTS = ("ann", "bob")
IDS = ("x", "y")
WORDS = ("Well", " I", " think", " it", " rains", ",", " all day", ".", "Yes")
UTTERANCES = [(agent, ident) for agent in AGENTS for ident in IDS]


@dataclass
class Model:
    """What is known of the utterances of one id. lives: whether one is promised and has not ended. owed: how
    many at most; the latest may be promised while the one before ends. ends: the reasons of all that have.
    """

    lives: bool = False
    owed: int = 0
    ends: list[str] = field(default_factory=list)


class Utterances(RuleBasedStateMachine):
    project: ClassVar[Project]

    def __init__(self) -> None:
        super().__init__()
        self.session = LiveSession(self.project, idle=False)
        self.models = {key: Model() for key in UTTERANCES}
        self.clients: dict[str, int] = {}
        self.count = 0
        self.asked: list[tuple[str, dict[str, Any]]] = []
        for agent in AGENTS:
            self.join(agent)
        self.go(1)

    @rule(agent=st.sampled_from(AGENTS))
    def come_back(self, agent: str) -> None:
        self.go(1)
        self.session.leave(self.clients[agent])
        self.join(agent)
        self.go(1)

    def join(self, agent: str) -> None:
        self.count += 1
        self.clients[agent] = self.count
        self.session.join(self.count)
        self.send(agent, {"do": "hello", "name": agent, "events": True})

    @rule(key=st.sampled_from(UTTERANCES), words=st.lists(st.sampled_from(WORDS), min_size=1, max_size=6))
    def say(self, key: tuple[str, str], words: list[str]) -> None:
        self.send(key[0], {"do": "say", "id": key[1], "text": "".join(words)})

    @rule(key=st.sampled_from(UTTERANCES), word=st.sampled_from(WORDS))
    def append(self, key: tuple[str, str], word: str) -> None:
        self.send(key[0], {"do": "say", "id": key[1], "text": word, "more": True})

    @rule(key=st.sampled_from(UTTERANCES), count=st.integers(1, 4))
    def append_words(self, key: tuple[str, str], count: int) -> None:
        words = [[f"word{n}", 0.4 * n, 0.4 * n + 0.3] for n in range(count)]
        self.send(key[0], {"do": "say", "id": key[1], "words": words, "more": bool(count % 2)})

    @rule(
        key=st.sampled_from(UTTERANCES),
        do=st.sampled_from(("interrupt", "pause", "resume", "finish", "withdraw")),
        every=st.booleans(),
    )
    def steer(self, key: tuple[str, str], do: str, every: bool) -> None:
        self.send(key[0], {"do": do} if every else {"do": do, "what": key[1]})

    @rule(ticks=st.integers(1, 90))
    def wait(self, ticks: int) -> None:
        self.go(ticks)

    def send(self, agent: str, request: dict[str, Any]) -> None:
        self.asked.append((agent, request))
        self.session.receive(self.clients[agent], json.dumps(request))

    def key_of(self, agent: str, ident: str) -> str:
        return f"c{self.session.clients[self.clients[agent]].owner}/{ident}"

    def lives(self, key: tuple[str, str]) -> bool:
        """Whether the session has an utterance under an id that it still owes an end."""
        named = self.key_of(*key)
        known = self.session.ledger.known.get(named)
        return self.session.happenings.owes_end(named) or (known is not None and not known.ended)

    def go(self, ticks: int, step: float = TICK) -> None:
        for _ in range(ticks):
            asked, self.asked = self.asked, []
            out = self.session.tick(self.session.now + step)
            assert len(out.replies) == len(asked), "each request has one reply"
            said: set[tuple[str, str]] = set()
            begun: set[tuple[str, str]] = set()  # what does not go on with one that is owed an end
            for (agent, request), reply in zip(asked, out.replies, strict=True):
                told = msgspec.json.decode(reply) if isinstance(reply, bytes) else msgspec.to_builtins(reply)
                assert told.get("state") and (told["state"] != "refused" or told.get("why")), told
                if request["do"] == "say" and told["state"] in ("planned", "late"):
                    said.add((agent, request["id"]))
                    if told.get("since") is None or not self.models[agent, request["id"]].owed:
                        begun.add((agent, request["id"]))
            owners = {number: agent for agent, number in self.clients.items()}
            events = [(owners.get(client), msgspec.to_builtins(event)) for client, event in out.events]
            ended = [(str(agent), e["id"]) for agent, e in events if e["event"] == "ended"]
            for key, model in self.models.items():
                ends = ended.count(key)
                model.owed += key in begun
                assert ends <= model.owed, (key, "ends once")
                model.ends += [
                    str(e["reason"])
                    for a, e in events
                    if e["event"] == "ended" and e["id"] == key[1] and a == key[0]
                ]
                model.lives = self.lives(key)
                model.owed = model.owed - ends if model.lives else 0
                assert ends or model.lives or key not in said, (key, "what was promised is heard, or it ends")

    @invariant()
    def what_is_over_owes_nothing(self) -> None:
        speeches = self.session.plan.track.speeches
        for key in UTTERANCES:
            named = self.key_of(*key)
            if goes_on(speeches, named, self.session.now) and not self.asked:
                assert self.lives(key), (key, "what is heard will end")

    def teardown(self) -> None:
        """Let all be said: every utterance has ended once, and nothing is paused or open any more."""
        for agent in AGENTS:
            self.send(agent, {"do": "resume"})
            self.go(1)
            self.send(agent, {"do": "finish"})
            self.go(1)
        before = {key: len(model.ends) for key, model in self.models.items()}
        owed = {key: (1, model.owed) if model.lives else (0, 0) for key, model in self.models.items()}
        self.go(60)
        self.go(290, 0.1)
        for key, model in self.models.items():
            assert not self.lives(key), (key, "has ended")
            least, most = owed[key]
            assert least <= len(model.ends) - before[key] <= most, (key, "once")
        assert not [s for s in self.session.plan.track.speeches if s.start >= PAUSED]


@pytest.fixture(autouse=True, scope="module")
def _project(sample: Project) -> Iterator[None]:
    Utterances.project = sample
    yield


def run(examples: int, steps: int) -> None:
    run_state_machine_as_test(
        Utterances,
        settings=settings(
            max_examples=examples,
            stateful_step_count=steps,
            deadline=None,
            suppress_health_check=list(HealthCheck),
            print_blob=True,
        ),
    )


def test_utterances_end_once_and_nothing_is_silent() -> None:
    run(many(6, 100), 15)


@pytest.mark.nightly
def test_thousands_of_utterances_end_once_and_nothing_is_silent() -> None:
    run(many(250, 10_000), 20)


def test_what_is_finished_was_spoken_whole(sample: Project) -> None:
    Utterances.project = sample
    machine = Utterances()
    key = ("ann", "x")
    for n, word in enumerate((*WORDS, *WORDS)):
        machine.append(key, word)
        machine.go(7 + 40 * (n % 5 == 4))
        if n % 6 == 5:
            machine.steer(key, "pause", False)
            machine.go(20)
            machine.steer(key, "resume", False)
    machine.go(600)
    machine.steer(key, "finish", False)
    machine.go(3)
    session = machine.session
    text, _ = spoken_until(ALPHABET, session.plan.track.speeches, machine.key_of(*key), session.now)
    assert text == "".join((*WORDS, *WORDS))
    assert machine.models[key].ends == ["finished"]
