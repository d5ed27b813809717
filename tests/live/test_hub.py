"""Clients of every line: answers in order, busy and slow ones, tokens."""

from __future__ import annotations

import json

import msgspec
import pytest

from metagraph.graph import requests as a
from metagraph.live import hub as hubs
from metagraph.live.hub import Hub, is_right_token
from metagraph.live.messages import Hello
from metagraph.live.wire import (
    BatchResult,
    PosePicture,
    RequestBatch,
    join_batches,
    pack,
    unpack_batch,
    unpack_result,
)


class Wire:
    """A line that keeps what it is given. unread: bytes it pretends the other side has not read."""

    def __init__(self, formats: tuple[str, ...] = ("json", "binary")) -> None:
        self.formats, self.sent, self.unread, self.closed, self.done = (
            formats,
            list[tuple[bytes, bool]](),
            0,
            tuple[int, str](),
            0,
        )

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        self.sent += messages

    def answered(self, messages: int) -> None:
        self.done += messages

    def backlog(self) -> int:
        return self.unread

    def close(self, code: int, reason: str) -> None:
        self.closed = code, reason

    @property
    def texts(self) -> list[str]:
        return [data.decode() for data, _ in self.sent]


def answered(batch: RequestBatch | None) -> BatchResult:
    """Say of each request who asked what."""
    assert batch is not None
    words = (f"{client}:{type(heard.message).__name__}".encode() for client, heard in batch.asked)
    return BatchResult(batch.number, tuple(b'"' + w + b'"' for w in words))


@pytest.fixture
def wire() -> Wire:
    return Wire()


def test_nothing_is_passed_on_when_nothing_came() -> None:
    assert Hub().take() is None


def test_answers_go_back_in_the_order_of_the_requests(wire: Wire) -> None:
    hub = Hub()
    number = hub.open(wire, 0.0)
    for text in ('{"do":"nod"}', "bad", '[{"do":"blink"},7,{"do":"shake"}]', '{"do":"status"}', "[]"):
        hub.message(number, text)
    assert wire.sent == []
    batch = hub.take()
    assert batch is not None and batch.joined == (1,) and len(batch.asked) == 4
    hub.give(answered(batch))
    assert (
        wire.texts[0] == '"1:Nod"' and "not JSON" in wire.texts[1] and wire.texts[3:] == ['"1:Status"', "[]"]
    )
    assert wire.done == 5
    assert json.loads(wire.texts[2])[0] == "1:Blink" and "an object" in json.loads(wire.texts[2])[1]["error"]
    assert hub.idle


def test_what_comes_while_a_batch_is_unanswered_is_passed_on_at_once(wire: Wire) -> None:
    hub = Hub()
    number = hub.open(wire, 0.0)
    hub.message(number, '{"do":"nod"}')
    first = hub.take()
    hub.message(number, '[{"do":"shake"},7]')
    second = hub.take()
    assert first is not None and second is not None and second.number == 2
    hub.message(number, '{"do":"blink"}')
    hub.give(answered(join_batches([first, second])))
    assert wire.texts[0] == '"1:Nod"' and json.loads(wire.texts[1])[0] == "1:Shake" and len(wire.sent) == 2
    assert not hub.idle
    hub.give(answered(hub.take()))
    assert wire.texts[2:] == ['"1:Blink"'] and hub.idle


def test_no_more_is_passed_on_while_too_much_is_unanswered() -> None:
    hub = Hub()
    numbers = [hub.open(Wire(), 0.0) for _ in range(4)]
    for number in numbers[:3]:
        hub.message(number, "[" + ",".join(['{"do":"nod"}'] * 500) + "]")
    first = hub.take()
    assert first is not None and len(first.asked) == 1500
    hub.message(numbers[3], "[" + ",".join(['{"do":"nod"}'] * 500) + "]")
    second = hub.take()
    assert second is not None and len(second.asked) == 500
    hub.message(hub.open(Wire(), 0.0), '{"do":"status"}')
    assert hub.take() is None, "2000 are unanswered"
    hub.give(answered(first))
    third = hub.take()
    assert third is not None and third.number == 3 and len(third.asked) == 1
    hub.give(answered(join_batches([second, third])))
    assert hub.idle


def test_the_first_message_after_a_batch_wakes_who_takes_the_next(wire: Wire) -> None:
    woken: list[int] = []
    hub = Hub(wake=lambda: woken.append(1))
    number = hub.open(wire, 0.0)
    for text in ('{"do":"nod"}', "bad", '{"do":"nod"}'):
        hub.message(number, text)
    assert len(woken) == 1
    hub.take()
    hub.message(number, "bad")
    assert len(woken) == 2


def test_events_and_poses_need_no_batch(wire: Wire) -> None:
    hub = Hub()
    number = hub.open(wire, 0.0)
    hub.give(
        BatchResult(events=((number, b"{}"), (99, b"{}")), poses=(PosePicture((number, 98), b"\1\2", True),))
    )
    assert wire.sent == [(b"{}", False), (b"\1\2", True)]


def test_who_left_is_told_of_and_gets_nothing_more(wire: Wire) -> None:
    hub = Hub()
    number = hub.open(wire, 0.0)
    hub.message(number, '{"do":"nod"}')
    batch = hub.take()
    hub.gone(number)
    hub.gone(number)
    hub.give(answered(batch))
    assert wire.sent == []
    after = hub.take()
    assert after is not None and after.left == (number,)


def test_one_client_cannot_use_up_the_batch_of_others() -> None:
    hub, loud, quiet = Hub(), Wire(), Wire()
    first, second = hub.open(loud, 0.0), hub.open(quiet, 0.0)
    for _ in range(3):
        hub.message(first, "[" + ",".join(['{"do":"nod","id":"x"}'] * 1000) + "]")
    hub.message(second, '{"do":"nod"}')
    batch = hub.take()
    assert batch is not None and len(batch.asked) == hubs.PER_BATCH // 2 + 1
    hub.give(answered(batch))
    assert quiet.texts == ['"2:Nod"']
    assert [len(json.loads(x)) for x in loud.texts] == [1000, 1000, 1000]
    assert json.loads(loud.texts[2])[0] == {"id": "x", "state": "refused", "why": hubs.BUSY_WORDS}


def test_who_asks_on_while_nothing_is_answered_is_hung_up_on(wire: Wire) -> None:
    hub = Hub()
    number = hub.open(wire, 0.0)
    for _ in range(hubs.UNANSWERED // 1000 + 1):
        hub.message(number, "[" + ",".join(["7"] * 1000) + "]")
    assert wire.closed == (hubs.POLICY, hubs.TOO_FAST) and not hub.clients
    hub.message(number, '{"do":"nod"}')  # what was still on its way


def test_who_does_not_read_is_hung_up_on_and_others_go_on() -> None:
    hub, slow, quick = Hub(), Wire(), Wire()
    numbers = hub.open(slow, 0.0), hub.open(quick, 0.0)
    slow.unread = hubs.POSES_BACKLOG + 1
    poses = BatchResult(poses=(PosePicture(numbers, b"pose", True),))
    hub.give(poses)
    assert slow.sent == [] and quick.sent == [(b"pose", True)]  # poses are left out first
    slow.unread = hubs.BACKLOG + 1
    hub.message(numbers[0], '{"do":"nod"}')
    hub.give(answered(hub.take()))
    assert slow.closed == (hubs.POLICY, hubs.SLOW)
    hub.give(poses)
    assert quick.closed == () and len(quick.sent) == 2


def test_only_so_many_clients_are_let_in() -> None:
    hub = Hub()
    assert all(hub.open(Wire(), 0.0) for _ in range(hubs.CLIENTS))
    late = Wire()
    assert hub.open(late, 0.0) == 0 and late.closed[0] == hubs.TRY_LATER


def test_poses_a_line_cannot_carry_are_refused() -> None:
    hub, wire = Hub(), Wire(("json",))
    number = hub.open(wire, 0.0)
    hub.message(number, '{"do":"hello","id":"h","poses":{"format":"binary"}}')
    hub.give(answered(hub.take()))
    answer = json.loads(wire.texts[0])
    assert answer["id"] == "h" and answer["error"].startswith("poses: ")


# --- tokens


def test_without_the_token_nothing_is_heard(wire: Wire) -> None:
    hub = Hub("secret")
    number = hub.open(wire, 0.0)
    hub.message(number, '{"do":"nod"}')
    assert "needs a token" in wire.texts[0] and wire.closed[0] == hubs.POLICY
    batch = hub.take()
    assert batch is not None and not batch.asked


@pytest.mark.parametrize("token", ["", "Secret", "secret ", "sécret", "\x00"])
def test_a_wrong_token_is_as_good_as_none(wire: Wire, token: str) -> None:
    hub = Hub("secret")
    hub.message(hub.open(wire, 0.0), json.dumps({"do": "hello", "token": token}))
    assert wire.closed[0] == hubs.POLICY


def test_with_the_token_a_client_is_heard_and_the_token_goes_no_further(wire: Wire) -> None:
    hub = Hub("secret")
    number = hub.open(wire, 0.0)
    hub.message(number, '[{"do":"hello","token":"secret"},{"do":"nod"}]')
    batch = hub.take()
    assert batch is not None and len(batch.asked) == 2
    hello = batch.asked[0][1].message
    assert isinstance(hello, Hello) and hello.token == ""
    hub.check(100.0)
    assert wire.closed == ()


def test_what_comes_before_the_token_is_not_heard_either(wire: Wire) -> None:
    hub = Hub("secret")
    hub.message(hub.open(wire, 0.0), '[{"do":"nod"},{"do":"hello","token":"secret"}]')
    assert wire.closed[0] == hubs.POLICY


def test_who_shows_no_token_in_time_is_hung_up_on(wire: Wire) -> None:
    hub = Hub("secret")
    hub.open(wire, 10.0)
    hub.check(10.0 + hubs.PROVE - 0.1)
    assert wire.closed == ()
    hub.check(10.0 + hubs.PROVE + 0.1)
    assert wire.closed[0] == hubs.POLICY


def test_tokens_of_any_text_are_compared() -> None:
    assert is_right_token("ä", "ä") and not is_right_token("a", "b") and not is_right_token("\ud800", "a")


# --- the pipe


def test_batches_and_results_survive_the_pipe() -> None:
    hub = Hub()
    number = hub.open(Wire(), 0.0)
    hub.message(
        number,
        '[{"do":"look","to":[1,2,3],"in":2},{"do":"hello","poses":null},{"do":"bml","bml":"<bml/>"},{"do":"describe"}]',
    )
    batch = hub.take()
    assert batch is not None
    again = unpack_batch(pack(batch))
    assert again == batch and isinstance(again.asked[0][1].message, a.Look) and again.asked[0][1].after == 2.0
    hello = again.asked[1][1].message
    assert isinstance(hello, Hello) and hello.poses is None and hello.events is msgspec.UNSET
    result = BatchResult(3, (b"{}",), ((1, b"[]"),), (PosePicture((1, 2), b"\0", True),))
    assert unpack_result(pack(result)) == result
