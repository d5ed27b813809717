"""Answers: read whatever they are, kept once, never mixed with somebody else's."""

from __future__ import annotations

import threading
from pathlib import Path

import msgspec
import pytest

from metagraph.errors import FileError
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.perceive.answers import (
    PageEvent,
    Sheet,
    SheetError,
    decode_sheet,
    is_answer,
    keep_sheet,
    read_answers,
)
from metagraph.research.study.perceive.folder import Perceived
from tests.research.study.perceive.perceive_makers import CHOICE, RATING, sheet, study, text

pytestmark = pytest.mark.usefixtures("quick_codes")


@pytest.fixture
def made(tmp_path: Path) -> Perceived:
    return study(tmp_path / "s", text(asked=CHOICE + RATING))


def part(whole: Sheet, first: int, last: int) -> Sheet:
    return msgspec.structs.replace(whole, events=whole.events[first:last])


def test_answers_are_appended_once_however_often_they_are_sent(made: Perceived) -> None:
    whole = sheet(made)
    assert keep_sheet(made, part(whole, 0, 3)).kept == 3
    again = keep_sheet(made, part(whole, 0, 5))
    assert (again.kept, again.new) == (5, 2)
    assert keep_sheet(made, part(whole, 1, 3)).new == 0
    assert keep_sheet(made, whole).kept == len(whole.events)
    log = read_log(made.log("P01"))
    assert log.standing == "done" and not log.problems and not log.torn
    assert [e["page_n"] for e in log.events] == list(range(len(whole.events)))
    assert log.events[1]["seconds"] == 1.5 and log.events[0]["design"] == made.key.design


def test_a_gap_is_refused_and_nothing_of_it_kept(made: Perceived) -> None:
    whole = sheet(made)
    keep_sheet(made, part(whole, 0, 2))
    with pytest.raises(SheetError, match="missing between 2 and 4"):
        keep_sheet(made, part(whole, 4, 6))
    assert len(read_log(made.log("P01")).events) == 2


def test_who_begins_with_somebody_s_code_is_told_so(made: Perceived) -> None:
    keep_sheet(made, part(sheet(made), 0, 2))
    with pytest.raises(SheetError, match="another browser") as told:
        keep_sheet(made, sheet(made, run="0123456789"))
    assert told.value.taken and len(read_log(made.log("P01")).events) == 2


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"design": "0" * 64}, "another study"),
        ({"code": "P99"}, "does not take part"),
        ({"events": (PageEvent(0, "answer", trial="nowhere", value="left"),)}, "does not have"),
    ],
)
def test_what_belongs_elsewhere_is_refused(made: Perceived, fields: dict[str, object], words: str) -> None:
    with pytest.raises(SheetError, match=words):
        keep_sheet(made, msgspec.structs.replace(sheet(made), **fields))
    assert not made.log("P01").exists()


def test_a_code_cannot_lead_out_of_the_folder(made: Perceived) -> None:
    for code in ("../P01", "P01/..", "", ".", "a b", "P01\n"):
        with pytest.raises(SheetError):
            keep_sheet(
                made, decode_sheet(msgspec.json.encode({**msgspec.to_builtins(sheet(made)), "code": code}))
            )
    assert not (made.folder / "answers").exists()


@pytest.mark.parametrize("value", ["left", "middle", {"natural": 8}, {"natural": 0}, {"other": 3}, {}, None])
def test_an_answer_that_the_page_cannot_give_is_none(made: Perceived, value: object) -> None:
    assert is_answer(made, False, value) is False
    assert is_answer(made, True, value) is (value == "left")
    assert is_answer(made, False, {"natural": 7})


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"[]", b"null", b'{"perceive":1}', b"\xff\xfe", b"[" * 100_000, b'{"perceive":1e999}'],
)
def test_a_file_that_holds_no_answers_is_told_with_a_remedy(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.json").write_bytes(content)
    with pytest.raises(FileError) as told:
        read_answers(tmp_path / "a.json")
    assert told.value.cause and told.value.remedy


def test_a_saved_file_is_what_was_sent(made: Perceived, tmp_path: Path) -> None:
    whole = sheet(made)
    (tmp_path / "a.json").write_bytes(msgspec.json.encode(whole))
    assert read_answers(tmp_path / "a.json") == whole


def test_many_who_send_at_once_lose_nothing(made: Perceived) -> None:
    whole = sheet(made)

    def send() -> None:
        for n in range(1, len(whole.events) + 1):
            keep_sheet(made, part(whole, 0, n))

    threads = [threading.Thread(target=send) for _ in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    log = read_log(made.log("P01"))
    assert [e["page_n"] for e in log.events] == list(range(len(whole.events))) and not log.problems


def test_a_torn_last_line_is_put_aside_and_what_was_in_it_sent_again(made: Perceived) -> None:
    whole = sheet(made)
    keep_sheet(made, part(whole, 0, 3))
    path = made.log("P01")
    path.write_bytes(path.read_bytes()[:-9])
    assert keep_sheet(made, part(whole, 0, 4)).kept == 4
    assert read_log(path).standing == "broken off" and [e["page_n"] for e in read_log(path).events] == [
        0,
        1,
        2,
        3,
    ]
