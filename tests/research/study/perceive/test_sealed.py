"""Sessions are sealed with codes that cannot be tried by the million, and opened with them."""

from __future__ import annotations

import base64
import hashlib
import json

from metagraph.research.study.perceive.sealed import derive, make_sealed_name, seal_content, seal_sessions

SESSIONS = {"Ab3": {"trials": [1, 2]}, "zz9": {"trials": "é" * 100}}
ROUNDS = 100_000


def test_a_key_is_derived_as_slowly_as_the_page_is_told() -> None:
    expected = hashlib.pbkdf2_hmac("sha256", b"ab3", b"salt", ROUNDS)
    assert derive("Ab3", "salt") == derive(" aB3 ", "salt") == expected
    assert seal_sessions({}, "salt") == {"salt": "salt", "rounds": ROUNDS, "sealed": {}}


def test_each_session_opens_with_its_code_and_no_other() -> None:
    told = seal_sessions(SESSIONS, "salt")["sealed"]
    keys = {code: derive(code, "salt") for code in SESSIONS}
    assert list(told) == sorted(make_sealed_name(key) for key in keys.values())
    for code, key in keys.items():
        content = base64.b64decode(told[make_sealed_name(key)])
        assert json.loads(seal_content(content, key)) == [code, SESSIONS[code]]
        assert b"trials" not in content
        assert all(
            seal_content(content, other) != seal_content(content, key)
            for other in keys.values()
            if other != key
        )
