"""What each participant goes through, sealed with their code: the page that all are given tells nobody who
else takes part, nor what others see.

The key is derived slowly (PBKDF2, HMAC of SHA-256), so that codes cannot be tried by the million. A session
is JSON, each byte XORed with SHA-256 of the key and a counter; `page.html` opens it in the same way.
"""

from __future__ import annotations

import hashlib
import json
from base64 import b64encode
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any

ROUNDS = 100_000  # half a second in a browser
NAME = 32  # hexadecimal digits that name a session


def seal_sessions(sessions: Mapping[str, Any], salt: str) -> dict[str, Any]:
    """Return what the page is given about the sessions, given by code: salt, rounds, and name -> sealed
    session. Their order tells nothing either.
    """
    with ThreadPoolExecutor() as pool:  # deriving lets other threads run
        derived = pool.map(lambda code: derive(code, salt), sessions)
        rows = zip(sessions.items(), derived, strict=True)
        found = {make_sealed_name(key): _sealed([code, session], key) for (code, session), key in rows}
    return {"salt": salt, "rounds": ROUNDS, "sealed": dict(sorted(found.items()))}


def derive(code: str, salt: str) -> bytes:
    """Return the key of a code, whatever its letters' case: 32 bytes."""
    return hashlib.pbkdf2_hmac("sha256", code.strip().lower().encode(), salt.encode(), ROUNDS)


def make_sealed_name(key: bytes) -> str:
    """Return what a session is called in the page, which tells nothing of its key."""
    return hashlib.sha256(key + b"name").hexdigest()[:NAME]


def seal_content(content: bytes, key: bytes) -> bytes:
    """Return a content sealed, or opened."""
    out = bytearray()
    for n in range(0, len(content), 32):
        stream = hashlib.sha256(key + (n // 32).to_bytes(4, "big")).digest()
        out += bytes(a ^ b for a, b in zip(content[n : n + 32], stream, strict=False))
    return bytes(out)


def _sealed(content: Any, key: bytes) -> str:
    return b64encode(seal_content(json.dumps(content, separators=(",", ":")).encode(), key)).decode()
