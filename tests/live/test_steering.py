"""What is said under one id is one utterance: it is appended to, paused, resumed, finished, interrupted."""

from __future__ import annotations

import json
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.live.steering import INTERRUPTED
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.lips import compute_mouth_shapes
from metagraph.playback.life.utterances import FORGOTTEN
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.speech.spoken_so_far import spoken_until

TICK = 1 / 60
RAIN = "It rains all day, so take a coat with you."


class Talk:
    """A session, and what clients hear of it."""

    def __init__(self, project: Project) -> None:
        self.session = LiveSession(project, idle=False)
        self.heard: list[dict[str, Any]] = []
        self.ask(do="hello", name="agent", events=True)

    def ask(self, client: int = 1, **request: Any) -> dict[str, Any]:
        """Return the reply to a request."""
        request = {"in" if name == "after" else name: value for name, value in request.items()}
        self.session.receive(client, json.dumps(request))
        replies = self.go(self.session.now + TICK / 2)
        assert len(replies) == 1
        return replies[0]

    def go(self, until: float) -> list[dict[str, Any]]:
        """Go on until a time; return the replies of the first tick."""
        replies: list[Any] = []
        while self.session.now < until:
            out = self.session.tick(self.session.now + TICK)
            replies = replies or out.replies
            self.heard += [msgspec.to_builtins(e) for client, e in out.events if client == 1]
        return [msgspec.json.decode(r) if isinstance(r, bytes) else msgspec.to_builtins(r) for r in replies]

    def wait(self, seconds: float) -> None:
        self.go(self.session.now + seconds)

    def ends(self, ident: str) -> list[str]:
        """Return the reasons with which an utterance ended."""
        return [e["reason"] for e in self.heard if e["event"] == "ended" and e["id"] == ident]

    def opens(self, start: float, end: float) -> float:
        """Return how far the mouth is open at most between two times, 0..1."""
        track, project = self.session.plan.track, self.session.project
        times = np.linspace(start, end, 40)
        shapes = compute_mouth_shapes(track, project.voices, project.life.lip_smoothing, times)
        return 0.0 if shapes is None else float(shapes.sum(1).max())


@pytest.fixture
def talk(sample: Project) -> Talk:
    return Talk(sample)


def test_an_interrupt_stops_the_voice_at_a_sound_and_says_what_was_spoken(talk: Talk) -> None:
    said = talk.ask(do="say", id="a", text=RAIN)
    talk.ask(do="gesture", id="a/0", tags=["emphasis"], after=0.2)
    talk.ask(do="gesture", id="a/1", after=3.0)
    talk.wait(1.0)
    now = talk.session.now
    reply = talk.ask(do="interrupt", what="a")
    assert reply["state"] == "done" and now < reply["at"] <= now + TICK + 0.1
    assert reply["spoken"] == "It rains all day," and reply["last_word"] == "day"
    assert reply["skip"] == pytest.approx(reply["at"] - said["at"], abs=1e-3)
    talk.wait(0.6)
    assert talk.opens(reply["at"] + 0.2, reply["at"] + 3.0) == 0
    assert talk.ends("a") == talk.ends("a/0") == talk.ends("a/1") == ["interrupted"]
    (end,) = [e for e in talk.heard if e["event"] == "ended" and e["id"] == "a"]
    assert end["spoken"] == reply["spoken"] and end["why"] == INTERRUPTED
    assert talk.session.plan.layers["arms"].cues[-1].end <= now + TICK + 0.1 + 0.41


def test_who_is_interrupted_looks_at_the_partner(talk: Talk) -> None:
    talk.ask(do="look", to=[0.5, 1.5, 1.0])
    talk.ask(do="say", id="a", text=RAIN)
    talk.wait(0.5)
    talk.ask(do="interrupt")
    look = talk.session.plan.track.looks[-1]
    assert look.to == "user" and look.strict and look.end - look.start == pytest.approx(2.0)


def test_an_interrupt_without_an_id_stops_what_this_client_says_alone(talk: Talk) -> None:
    talk.ask(do="say", id="a", text=RAIN)
    talk.session.join(2)
    assert talk.ask(client=2, do="interrupt")["why"] == "nothing is said"
    assert talk.ends("a") == []
    assert talk.ask(do="interrupt")["state"] == "done"
    talk.wait(0.3)
    assert talk.ends("a") == ["interrupted"]


def test_what_is_paused_goes_on_where_it_stopped(talk: Talk) -> None:
    said = talk.ask(do="say", id="a", text=RAIN, mood="happy")
    talk.ask(do="gesture", id="a/0", after=2.0)
    talk.wait(1.0)
    held = talk.ask(do="pause", what="a")
    assert held["spoken"] == "It rains all day," and talk.ask(do="pause")["why"] == "it is paused already"
    talk.wait(2.0)
    assert talk.opens(held["at"] + 0.2, talk.session.now + 5.0) == 0 and talk.ends("a") == []
    changed = [e for e in talk.heard if e["event"] == "changed"]
    assert {(e["id"], e["why"]) for e in changed} == {("a", "it is paused"), ("a/0", "it is paused")}
    assert [m.end > 1e8 for m in talk.session.plan.track.moods] == [True]
    on = talk.ask(do="resume", what="a")
    assert on["skip"] == held["skip"] and on["at"] == pytest.approx(talk.session.now + 0.04, abs=1e-3)
    rest = said["until"] - held["at"]
    talk.wait(rest + 0.2)
    started = [e for e in talk.heard if e["event"] == "started" and e["id"] == "a"]
    assert [e.get("skip") for e in started] == [None, held["skip"]]
    (end,) = [e for e in talk.heard if e["event"] == "ended" and e["id"] == "a"]
    assert end["reason"] == "finished" and end["until"] == pytest.approx(on["at"] + rest, abs=1e-3)
    assert [m.end for m in talk.session.plan.track.moods] == [pytest.approx(end["until"], abs=1e-3)]
    talk.wait(3.0)
    assert talk.ends("a/0") == ["finished"]


def test_what_is_appended_to_something_paused_waits(talk: Talk) -> None:
    talk.ask(do="say", id="a", words=[["one", 0.0, 0.4], ["two", 0.5, 0.9]])
    talk.wait(0.3)
    talk.ask(do="pause")
    reply = talk.ask(do="say", id="a", words=[["three", 0.0, 0.4]])
    assert (reply["state"], reply["why"], reply.get("at")) == ("planned", "it is paused", None)
    talk.wait(1.0)
    talk.ask(do="resume")
    talk.wait(2.0)
    assert talk.ends("a") == ["finished"]
    assert talk.session.plan.track.speeches[-1].text == "one two three"


def test_tokens_are_said_as_they_come_until_no_more_do(talk: Talk) -> None:
    for token in ("It", " rai", "ns", ",", " you", " know"):
        assert talk.ask(do="say", id="a", text=token, more=True)["state"] == "planned"
    talk.wait(3.0)
    assert talk.ends("a") == []
    talk.ask(do="say", id="a", text=", all day.", more=True)
    talk.wait(2.0)
    assert talk.ends("a") == []
    assert talk.ask(do="finish", what="a")["state"] == "done"
    talk.wait(0.2)
    assert talk.ends("a") == ["finished"]
    assert "".join(s.text for s in talk.session.plan.track.speeches) == "It rains, you know, all day."


def test_an_interrupt_knows_all_that_was_said_in_pieces(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="It rai", more=True)
    talk.ask(do="say", id="a", text="ns,", more=True)
    talk.wait(2.0)
    talk.ask(do="say", id="a", text=" so take a coat with you", more=True)
    talk.wait(0.4)
    reply = talk.ask(do="interrupt", what="a")
    assert (reply["spoken"], reply["last_word"]) == ("It rains, so take", "take")


def test_nothing_that_is_open_is_awaited_for_ever(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="Well", more=True)
    talk.wait(FORGOTTEN - 2)
    assert talk.ends("a") == []
    talk.wait(5.0)
    assert talk.ends("a") == ["finished"]


def test_letters_with_times_are_words(talk: Talk) -> None:
    letters = [
        ["H", 0, 0.1],
        ["i", 0.1, 0.2],
        [" ", 0.2, 0.3],
        ["y", 0.3, 0.4],
        ["o", 0.4, 0.5],
        ["u", 0.5, 0.7],
    ]
    talk.ask(do="say", id="a", characters=letters)
    (speech,) = talk.session.plan.track.speeches
    assert speech.timing is not None
    assert [(w.text, w.start, w.end) for w in speech.timing.words] == [("Hi", 0, 0.2), ("you", 0.3, 0.7)]


def test_an_agent_that_comes_back_pauses_and_interrupts_what_it_said(talk: Talk) -> None:
    talk.ask(do="say", id="a", text=RAIN)
    talk.wait(0.5)
    talk.session.leave(1)
    talk.session.join(7)
    talk.ask(client=7, do="hello", name="agent", events=True)
    assert talk.ask(client=7, do="pause", what="a")["spoken"].startswith("It rains")
    assert talk.ask(client=7, do="interrupt", what="a")["last_word"] == "rains"


@pytest.mark.parametrize("word", ["interrupt", "pause", "resume", "finish"])
def test_nothing_to_do_is_said_so(talk: Talk, word: str) -> None:
    reply = talk.ask(do=word)
    assert reply["state"] == "done" and reply["why"]


def test_a_kept_session_pauses_and_interrupts_again(talk: Talk, sample: Project) -> None:
    talk.ask(do="say", id="a", text=RAIN)
    talk.wait(0.7)
    talk.ask(do="pause")
    talk.wait(0.7)
    talk.ask(do="resume")
    talk.wait(0.7)
    talk.ask(do="interrupt")
    talk.wait(1.0)
    kept = talk.session.performance("kept")
    plan = plan_performance(sample, kept.asks, kept.length, kept.seed, kept.stances, kept.idle)
    ours, theirs = talk.session.plan.track.speeches, plan.track.speeches
    assert len(ours) == len(theirs) == 2
    for mine, other in zip(ours, theirs, strict=True):
        found = [other.start, other.end, other.skip, other.length]
        assert found == pytest.approx([mine.start, mine.end, mine.skip, mine.length])


def test_a_pause_does_not_move_when_an_utterance_began(talk: Talk) -> None:
    first = talk.ask(do="say", id="a", words=[["one", 0.0, 0.4], ["two", 0.5, 0.9], ["three", 1.0, 1.4]])
    talk.wait(0.7)
    talk.ask(do="pause", what="a")
    talk.wait(2.0)
    waits = talk.ask(do="say", id="a", words=[["four", 1.5, 1.9]])
    assert waits["since"] == first["at"] and "at" not in waits, "it is paused, and began before"
    talk.ask(do="resume", what="a")
    talk.wait(0.2)
    more = talk.ask(do="say", id="a", words=[["five", 2.0, 2.4]])
    assert more["since"] == first["at"] and more["at"] > first["at"] + 2.0
    talk.wait(4.0)
    (end,) = [e for e in talk.heard if e["event"] == "ended" and e["id"] == "a"]
    assert end["reason"] == "finished" and end["at"] == first["at"]
    started = [e["at"] for e in talk.heard if e["event"] == "started" and e["id"] == "a"]
    assert started[0] == first["at"] < started[-1]


def test_an_utterance_that_is_paused_twice_began_when_it_began(talk: Talk) -> None:
    first = talk.ask(do="say", id="a", text=RAIN)
    for _ in range(2):
        talk.wait(0.5)
        talk.ask(do="pause", what="a")
        talk.wait(1.0)
        talk.ask(do="resume", what="a")
    talk.wait(0.2)
    more = talk.ask(do="say", id="a", text=" And boots.")
    assert more["since"] == first["at"]
    talk.wait(8.0)
    (end,) = [e for e in talk.heard if e["event"] == "ended" and e["id"] == "a"]
    assert end["at"] == first["at"]


def test_what_is_said_anew_under_an_id_begins_anew(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="It rains.")
    talk.wait(3.0)
    second = talk.ask(do="say", id="a", text="It snows.")
    talk.wait(3.0)
    ends = [e["at"] for e in talk.heard if e["event"] == "ended" and e["id"] == "a"]
    assert len(ends) == 2 and ends[1] == second["at"] > ends[0]


def test_a_line_of_which_nothing_is_said_is_refused_also_where_its_id_was_said_before(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="Well")
    talk.wait(1.0)
    for client, ident in ((2, "b"), (1, "a"), (2, "c")):
        ask = {"do": "say", "id": ident, "text": "Well", "more": True}
        talk.session.receive(client, json.dumps(ask))
    replies = talk.go(talk.session.now + TICK / 2)
    said = {s.id: s for s in talk.session.plan.track.speeches if s.start > talk.session.now}
    assert [r["state"] for r in replies] == [
        "planned" if x in said else "refused" for x in ("c2/b", "c1/a", "c2/c")
    ]
    assert [r["why"] for r in replies if r["state"] == "refused"] == ["something else is said then"] * 2
    assert talk.ask(do="say", id="a", text="Yes")["at"] > talk.session.now
    talk.wait(2.0)
    assert talk.ends("a") == ["finished", "finished"]


def test_what_takes_the_place_of_a_line_that_waits_is_heard_and_ends_for_itself(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="Later", after=5.0)
    talk.wait(0.5)
    talk.ask(do="say", id="a", text="Now")
    talk.wait(3.0)
    told = [(e["event"], e.get("text"), e.get("reason")) for e in talk.heard if e["id"] == "a"]
    assert told == [("ended", None, "replaced"), ("started", "Now", None), ("ended", "Now", "finished")]


def test_a_piece_behind_which_another_line_is_said_first_is_refused(talk: Talk) -> None:
    talk.ask(do="say", id="a", words=[["word", 0.0, 0.3]], more=True)
    talk.wait(0.2)
    talk.session.receive(
        1, json.dumps({"do": "say", "id": "a", "words": [["behind", 0.6, 0.9]], "more": True})
    )
    talk.session.receive(2, json.dumps({"do": "say", "id": "b", "text": "Well"}))
    first, second = talk.go(talk.session.now + TICK / 2)
    assert second["state"] == "planned"
    assert first["state"] == "refused" and first["why"] == "something else is said then"


def test_what_is_added_to_a_line_that_is_paused_at_the_same_moment_goes_on_with_it(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="It rains all day")
    talk.session.receive(1, json.dumps({"do": "say", "id": "a", "text": ". Well", "more": True}))
    talk.session.receive(1, json.dumps({"do": "pause", "what": "a"}))
    added, _ = talk.go(talk.session.now + TICK / 2)
    assert added["state"] == "planned"
    talk.wait(1.0)
    assert talk.ends("a") == []
    talk.ask(do="resume")
    talk.ask(do="finish", what="a")
    talk.wait(4.0)
    assert talk.ends("a") == ["finished"]


def test_tokens_behind_a_text_that_was_said_whole_follow_it(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="It rains all day.")
    added = talk.ask(do="say", id="a", text=" So take a", more=True)
    talk.ask(do="say", id="a", text=" coat.")
    assert added["at"] > 1.0
    talk.wait(6.0)
    assert [e["text"] for e in talk.heard if e["event"] == "started"] == [
        "It rains all day.",
        " So take a coat.",
    ]
    assert talk.ends("a") == ["finished"]


@pytest.mark.parametrize("order", [("pause", "withdraw"), ("withdraw", "pause")])
def test_what_is_taken_back_and_paused_at_once_is_not_said_when_others_resume(
    talk: Talk, order: tuple[str, str]
) -> None:
    talk.ask(do="say", id="a", text="It rains all day.")
    talk.wait(0.2)
    for do in order:
        talk.session.receive(1, json.dumps({"do": do, "what": "a"}))
    talk.wait(0.5)
    assert talk.ends("a") == ["withdrawn"]
    talk.ask(do="resume")
    talk.wait(0.5)
    assert [e["event"] for e in talk.heard] == ["started", "ended"]


def test_a_piece_that_begins_as_it_is_interrupted_is_heard_before_its_end_is_reported(talk: Talk) -> None:
    talk.ask(do="say", id="a", words=[["one", 0.0, 0.3]], more=True)
    talk.wait(2.0)
    talk.ask(do="say", id="a", words=[["two", 0.0, 0.3], ["three", 0.4, 0.7]])
    talk.ask(do="interrupt", what="a")
    talk.wait(1.0)
    last = [s for s in talk.session.plan.track.speeches if s.id == "c1/a"][-1]
    (end,) = [e for e in talk.heard if e["event"] == "ended"]
    assert end["reason"] == "interrupted" and end["t"] >= last.end - 1e-3


@pytest.mark.parametrize("pause", [TICK, 0.05, 0.1, 0.3])
def test_what_is_said_again_just_after_it_was_taken_back_ends_for_itself(talk: Talk, pause: float) -> None:
    talk.ask(do="say", id="a", text="It rains all day.")
    talk.wait(0.5)
    talk.ask(do="withdraw", what="a")
    talk.wait(pause)
    talk.ask(do="say", id="a", text="It snows.")
    talk.wait(5.0)
    assert talk.ends("a") == ["withdrawn", "finished"]


def test_a_piece_that_is_added_in_a_pause_ends_with_its_utterance(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="Well")
    talk.ask(do="pause", what="a")
    talk.ask(do="say", id="a", text=" so", more=True)
    talk.ask(do="say", id="a", words=[["then", 0.0, 0.3]], more=True)
    talk.wait(1.0)
    assert talk.ends("a") == []
    talk.ask(do="resume", what="a")
    talk.ask(do="finish", what="a")
    talk.wait(4.0)
    assert talk.ends("a") == ["finished"]


def test_an_open_utterance_ends_when_its_id_says_something_later_instead(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="Well", more=True)
    talk.wait(1.0)
    talk.ask(do="say", id="a", text="Later.", after=5.0)
    talk.wait(1.0)
    assert talk.ends("a") == ["finished"]
    talk.wait(6.0)
    assert talk.ends("a") == ["finished", "finished"]


def test_an_utterance_that_waits_for_more_stays_open_when_it_is_paused_and_resumed_in_silence(
    talk: Talk,
) -> None:
    talk.ask(do="say", id="a", text="Well", more=True)
    talk.wait(2.0)
    talk.ask(do="pause", what="a")
    talk.wait(1.0)
    talk.ask(do="resume", what="a")
    talk.wait(1.0)
    assert talk.ends("a") == []
    more = talk.ask(do="say", id="a", text=" then.", more=True)
    assert more["state"] == "planned" and more["since"] < 1.0
    talk.ask(do="finish", what="a")
    talk.wait(2.0)
    assert talk.ends("a") == ["finished"]


def stream(talk: Talk, tokens: list[str], ident: str = "a") -> list[dict[str, Any]]:
    """Send tokens, the last as the last one; return the replies."""
    replies = []
    for n, token in enumerate(tokens):
        replies.append(talk.ask(do="say", id=ident, text=token, more=n < len(tokens) - 1))
        talk.wait(0.05)
    return replies


@pytest.mark.parametrize(
    ("tokens", "said"),
    [
        (["<th", "ink>The us", "er wants it</th", "ink>Sure", ", yes."], "Sure, yes."),
        (["<think>", "Secret.", "</think>", "Open."], "Open."),
        (["This is ", "**", "bold", "**", " text."], "This is bold text."),
        (["Look at ", "htt", "ps://a.b/c?", "d now."], "Look at now."),
        (["Call ", "`open", "_it`", " now", ""], "Call open_it now"),
        (["One", " ", "two", ".", " ", "**"], "One two."),
        (["One thing first.", '<break time="2s"/>', " Two."], "One thing first. Two."),
    ],
)
def test_tokens_with_marks_of_a_model_are_one_utterance_without_them(
    talk: Talk, tokens: list[str], said: str
) -> None:
    replies = stream(talk, tokens)
    assert all(r["state"] in ("planned", "done") for r in replies), replies
    talk.wait(6.0)
    assert talk.ends("a") == ["finished"]
    text, _ = spoken_until(ALPHABET, talk.session.plan.track.speeches, "c1/a", talk.session.now)
    assert " ".join(text.split()) == said


def test_a_break_in_a_text_is_a_pause(talk: Talk) -> None:
    said = talk.ask(do="say", id="a", text='One.<break time="2s"/> Two.')
    assert said["until"] - said["at"] > 2.5
    assert talk.opens(said["at"] + 0.8, said["until"] - 0.8) < 0.05
    assert talk.opens(said["until"] - 0.6, said["until"]) > 0.1


def test_an_id_that_is_used_again_is_answered_with_what_it_asks_for_now(talk: Talk) -> None:
    for request in (
        {"do": "look", "to": "user"},
        {"do": "mood", "mood": "happy"},
        {"do": "mode", "mode": "listening"},
    ):
        ident = request["do"]
        talk.ask(id=ident, **request)
        talk.wait(2.0)
        again = talk.ask(id=ident, **request)
        assert again["at"] > talk.session.now - 0.1 and len(again["actions"]) == 1, again
    talk.wait(1.0)
    assert "lasts until another" in talk.ask(do="withdraw", what="mode")["why"]


def test_a_stance_that_is_kept_can_be_given_up_when_it_is_reached(talk: Talk) -> None:
    stance = next(s.name for s in talk.session.project.graphs["body"].stances.values())
    talk.ask(do="stance", id="s", layer="body", stance=stance, stay=True)
    talk.wait(4.0)
    assert [x for x in talk.session.plan.track.stays if x.end > talk.session.now]
    assert "taken back" in talk.ask(do="withdraw", what="s")["why"]
    talk.wait(0.5)
    assert not [x for x in talk.session.plan.track.stays if x.end > talk.session.now]


def test_a_look_at_something_that_nobody_has_placed_says_so(talk: Talk) -> None:
    assert "nothing is called 'usr'" in talk.ask(do="look", to="usr")["notes"][0]
    talk.ask(do="place", name="usr", point=[0.0, 1.5, 2.0])
    assert "notes" not in talk.ask(do="look", to="usr") or not talk.ask(do="look", to="usr")["notes"]


def test_a_token_that_still_waited_when_an_utterance_is_finished_is_named(talk: Talk) -> None:
    talk.ask(do="say", id="a", text="Meet me", more=True)
    assert talk.ask(do="say", id="a", text=" home@ten", more=True)["state"] == "done"
    assert talk.ask(do="finish", what="a")["notes"] == ("left out: home@ten",)
    talk.wait(3.0)
    assert talk.ends("a") == ["finished"]
