"""Reading what clients send."""

from __future__ import annotations

import json

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import requests as a
from metagraph.live.messages import (
    LONGEST,
    LONGEST_BML,
    LONGEST_MESSAGE,
    MOST,
    WORDS,
    Describe,
    HeardMessage,
    Hello,
    Poses,
    Reply,
    Status,
    encode,
    make_live_schema,
    read_live_request,
    split_message,
)  # fmt: skip


def error(text: str | bytes) -> str:
    reply = read_live_request(text)
    assert isinstance(reply, Reply) and reply.error
    return reply.error


def test_an_ask_is_read_as_it_is() -> None:
    assert read_live_request('{"do":"gesture","tags":["beat"],"at":2.1}') == HeardMessage(
        a.Gesture(tags=("beat",), at=2.1)
    )
    assert read_live_request(b'{"do":"nod"}') == HeardMessage(a.Nod())
    assert read_live_request(msgspec.Raw(b'{"do":"blink"}')) == HeardMessage(a.Blink())


def test_seconds_from_now_are_kept_beside_the_ask() -> None:
    assert read_live_request('{"do":"nod","in":2}') == HeardMessage(a.Nod(), 2.0)
    assert read_live_request('{"in":0,"do":"nod","id":"n"}') == HeardMessage(a.Nod(id="n"), 0.0)


def test_the_sessions_own_questions_are_read() -> None:
    assert read_live_request('{"do":"status","id":"s"}') == HeardMessage(Status(id="s"))
    assert read_live_request('{"do":"describe"}') == HeardMessage(Describe())
    hello = read_live_request(
        '{"do":"hello","token":"t","poses":{"rate":60,"format":"binary"},"events":true}'
    )
    assert hello == HeardMessage(Hello(token="t", poses=Poses(rate=60, format="binary"), events=True))
    off = read_live_request('{"do":"hello","poses":null}')
    assert (
        isinstance(off, HeardMessage)
        and isinstance(off.message, Hello)
        and off.message.poses is None
        and off.message.events is msgspec.UNSET
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "not JSON"),
        ("nod", "not JSON"),
        ("{", "not JSON"),
        ("7", "a request is an object"),
        ('"nod"', "a request is an object"),
        ("[]", "a request is an object"),
        ("{}", "required field `do`; it is one of gesture, "),
        ('{"do":"dance"}', "Invalid value 'dance'; known are gesture, "),
        ('{"do":5}', "do: Expected `str`"),
        ('{"do":"nod","speed":2}', "unknown field `speed`"),
        ('{"do":"gesture","layer":"tail"}', "layer: Invalid enum value 'tail'"),
        ('{"do":"gesture","tags":"beat"}', "tags: Expected `array`"),
        ('{"do":"nod","at":-1}', "at: Expected `float` >= 0"),
        ('{"do":"nod","at":NaN}', "not JSON"),
        ('{"do":"nod","at":Infinity}', "not JSON"),
        ('{"do":"nod","at":1e400}', "out of range"),
        ('{"do":"nod","in":"soon"}', "in: give seconds from now"),
        ('{"do":"nod","in":-1}', "in: give seconds from now"),
        ('{"do":"nod","in":true}', "in: give seconds from now"),
        ('{"do":"nod","in":1,"at":2}', "not both"),
        ('{"do":"nod","in":1,"speed":2}', "unknown field `speed`"),
        ('{"do":"status","in":1}', "only what the character does"),
        ('{"do":"hello","poses":{"rate":1e9}}', "poses.rate: Expected `float` <= 120"),
        ('{"do":"look","to":[1,2]}', "to: Expected `array` of length"),
        (b'{"do":"nod","id":"\xff"}', ""),
        ("[" * 5000, "not JSON"),
        ('{"a":' * 5000, "not JSON"),
        ("x" * (LONGEST + 1), "at most 64 KiB"),
        ('{"do":"bml","bml":"' + "x" * LONGEST_BML + '"}', "at most 64 KiB, a block of BML 256"),
    ],
)
def test_what_is_wrong_is_told_by_field_and_remedy(text: str | bytes, words: str) -> None:
    assert words in error(text)


def test_what_is_wrong_is_told_with_the_id_it_came_with() -> None:
    reply = read_live_request('{"id":"q7","do":"dance"}')
    assert isinstance(reply, Reply) and reply.id == "q7"
    other = read_live_request('{"id":7,"do":"nod"}')
    assert isinstance(other, Reply) and other.id is None


def test_blocks_of_bml_may_be_longer() -> None:
    assert isinstance(read_live_request(json.dumps({"do": "bml", "bml": "x" * 190_000})), HeardMessage)


def test_a_list_is_several_requests_in_order() -> None:
    requests, listed = split_message(' [{"do":"nod"}, 7, {"do":"blink"}]')
    assert listed and [type(read_live_request(r)) for r in requests] == [HeardMessage, Reply, HeardMessage]
    assert split_message('{"do":"nod"}') == (['{"do":"nod"}'], False)
    assert split_message("[]") == ([], True)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ("[1,", "not JSON"),
        ("[" + "1," * MOST + "1]", "at most 1000 requests"),
        ("[" + " " * LONGEST_MESSAGE, "at most 1024 KiB"),
    ],
)
def test_lists_that_cannot_be_taken_apart_are_refused_whole(data: str, words: str) -> None:
    with pytest.raises(a.RequestError, match=words):
        split_message(data)


@given(st.one_of(st.text(max_size=300), st.binary(max_size=300)))
def test_any_bytes_get_an_answer(data: str | bytes) -> None:
    try:
        requests, _ = split_message(data)
    except a.RequestError as refused:
        assert str(refused)
        return
    for request in requests:
        found = read_live_request(request)
        assert isinstance(found, HeardMessage) or (found.error and encode(found))


values = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**70), 2**70) | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


@pytest.mark.nightly
@given(
    st.sampled_from(WORDS),
    st.dictionaries(
        st.sampled_from(["id", "at", "in", "tags", "layer", "to", "what", "poses", "point"]), values
    ),
)
def test_any_fields_get_an_answer(word: str, fields: dict[str, object]) -> None:
    found = read_live_request(json.dumps(fields | {"do": word}))
    assert isinstance(found, HeardMessage) or found.error


def test_the_schema_says_what_is_read() -> None:
    import jsonschema

    validator = jsonschema.Draft202012Validator(make_live_schema())
    validator.check_schema(make_live_schema())
    for text in (
        '{"do":"nod"}',
        '{"do":"nod","in":2}',
        '{"do":"hello","poses":null,"events":"all"}',
        '[{"do":"status"},{"do":"look","to":[1,2,3]}]',
        '{"do":"dance"}',
        '{"do":"gesture","layer":"tail"}',
        '{"do":"nod","at":-1}',
        '{"do":"nod","in":-1}',
        '{"do":"look","to":[1,2]}',
        '{"do":"hello","poses":{"rate":500}}',
        '{"do":"place","name":"","point":[0,0,0]}',
        "7",
        '{"do":"say","speed":1}',
    ):
        requests, _ = split_message(text)
        assert validator.is_valid(json.loads(text)) == all(
            isinstance(read_live_request(r), HeardMessage) for r in requests
        ), text
