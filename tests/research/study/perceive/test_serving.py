"""Serving a study: what is sent is kept, what is too much or from elsewhere is refused."""

from __future__ import annotations

import http.client
import json
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest

from metagraph.engines.serve import Served
from metagraph.errors import FileError
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.perceive.folder import Perceived
from metagraph.research.study.perceive.serving import MOST_POSTED, find_page, serve_page
from tests.research.study.perceive.perceive_makers import sheet, study, text

pytestmark = pytest.mark.usefixtures("quick_codes")


@pytest.fixture
def made(tmp_path: Path) -> Perceived:
    return study(tmp_path / "s", text())


@pytest.fixture
def served(made: Perceived) -> Iterator[Served]:
    found = serve_page(made)
    yield found
    found.close()


def asked(
    served: Served, method: str, path: str, body: bytes | None = None, **headers: str
) -> tuple[int, bytes, dict[str, str]]:
    port = int(served.url.rstrip("/").rpartition(":")[2])
    line = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    try:
        line.request(method, path, body, {k.replace("_", "-"): v for k, v in headers.items()})
        answer = line.getresponse()
        return answer.status, answer.read(), dict(answer.getheaders())
    finally:
        line.close()


JSON = {"Content_Type": "application/json"}


def test_answers_are_on_the_disk_before_they_are_acknowledged(served: Served, made: Perceived) -> None:
    whole = msgspec.json.encode(sheet(made))
    status, body, _ = asked(served, "POST", "/answers", whole, **JSON)
    assert status == 200 and json.loads(body)["kept"] == len(sheet(made).events)
    assert read_log(made.log("P01")).standing == "done"
    assert json.loads(asked(served, "POST", "/answers", whole, **JSON)[1])["new"] == 0


def test_the_page_is_shown_and_nothing_beside_it(served: Served) -> None:
    status, body, headers = asked(served, "GET", "/")
    assert (
        status == 200 and b'id="study"' in body and "default-src 'self'" in headers["Content-Security-Policy"]
    )
    for path in (
        "/key.json",
        "/../key.json",
        "/%2e%2e/key.json",
        "/..%2fallocation.secret",
        "/videos/",
        "/answers",
    ):
        assert asked(served, "GET", path)[0] == 404, path


@pytest.mark.parametrize(
    ("path", "body", "headers", "status"),
    [
        ("/elsewhere", b"{}", JSON, 404),
        ("/answers/..", b"{}", JSON, 404),
        ("/answers", b"{}", {"Content_Type": "text/plain"}, 415),
        ("/answers", b"{}", {}, 415),
        ("/answers", b"{}", JSON, 400),
        ("/answers", b"x" * (MOST_POSTED + 1), JSON, 413),
        ("/answers", b"{}", {**JSON, "Content_Length": "-1"}, 411),
        ("/answers", b"{}", {**JSON, "Content_Length": "9" * 30}, 413),
        ("/answers", b"{}", {**JSON, "Host": "evil.example"}, 403),
    ],
)
def test_what_is_no_answer_is_refused(
    served: Served, made: Perceived, path: str, body: bytes, headers: dict[str, str], status: int
) -> None:
    try:
        found, said, _ = asked(served, "POST", path, body, **headers)
    except ConnectionError:  # hung up on, in the middle of too much
        assert status == 413
        return
    assert found == status and json.loads(said)["error"]
    assert not (made.folder / "answers").exists()


def test_somebody_else_s_code_is_a_conflict(served: Served, made: Perceived) -> None:
    asked(served, "POST", "/answers", msgspec.json.encode(sheet(made)), **JSON)
    other = msgspec.json.encode(sheet(made, run="ffffffffff"))
    status, body, _ = asked(served, "POST", "/answers", other, **JSON)
    assert status == 409 and b"another browser" in body


def test_a_page_whose_videos_are_missing_is_not_served(made: Perceived) -> None:
    with pytest.raises(FileError, match="6 videos are not there"):
        find_page(made)


def test_an_address_that_is_none_is_told(made: Perceived) -> None:
    with pytest.raises(OSError):
        serve_page(made, address="203.0.113.7")
