"""Looks for a newer Metagraph, if the user allowed it and the build has an address to ask.

One request for a small JSON is sent, once a day at most, and nothing of the user or the computer with it.
Metagraph never installs anything by itself.
"""

from __future__ import annotations

import re
import time
import urllib.request
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import msgspec
from PySide6.QtCore import QSettings

from metagraph.common.programs import ROOT
from metagraph.common.wording import phrase

ADDRESS = "update_address"  # the file in which a build keeps it
ALLOWED, ASKED, SEEN = "updates/allowed", "updates/asked", "updates/seen"
DAY = 86400.0  # seconds between two requests
PATIENCE = 10.0  # seconds
MOST = 100_000  # bytes of an answer
_VERSION = re.compile(r"\d+(\.\d+){0,3}$")


class UpdateError(RuntimeError):
    """It could not be asked; the message says why."""


class Release(msgspec.Struct, frozen=True):
    """What the address answers. notes: what is new, as text. url: a page to load it from, https."""

    version: str
    notes: str = ""
    url: str = ""


def find_update_address() -> str | None:
    """Return the address that the build set; None if there is none, as in an installation from source."""
    try:
        words = (ROOT / ADDRESS).read_text(encoding="utf-8").strip()
    except (OSError, ValueError):
        return None
    return words if is_safe(words) else None


def is_safe(address: str) -> bool:
    """Return whether an address is asked at all: by https, or on this computer."""
    try:
        parts = urlsplit(address)
        return parts.scheme == "https" or (parts.scheme == "http" and parts.hostname in ("127.0.0.1", "::1"))
    except ValueError:
        return False


def is_asking_allowed(settings: QSettings) -> bool:
    """Return whether the user allowed to ask."""
    return str(settings.value(ALLOWED, "false")) == "true"


def is_due(settings: QSettings, now: float) -> bool:
    """Return whether to ask now: it is allowed, there is an address, and a day has passed. now: seconds since
    1970.
    """
    if not is_asking_allowed(settings) or find_update_address() is None:
        return False
    try:
        asked = float(str(settings.value(ASKED, 0)))
    except ValueError:
        asked = 0.0
    return not 0 <= now - asked < DAY


def find_update(version: str, settings: QSettings) -> Release | None:
    """Ask, and return the release if it is newer than `version`; None if there is none. Raises UpdateError,
    also if it is not allowed.
    """
    address = find_update_address()
    if address is None or not is_asking_allowed(settings):
        raise UpdateError(phrase("This copy of Metagraph does not look for updates."))
    settings.setValue(ASKED, time.time())
    release = _ask(address)
    return release if _numbers(release.version) > _numbers(version) else None


def _ask(address: str) -> Release:
    request = urllib.request.Request(
        address, headers={"User-Agent": "metagraph", "Accept": "application/json"}
    )
    opener = urllib.request.build_opener(_NoRedirects)
    try:
        with opener.open(request, timeout=PATIENCE) as answer:
            data = answer.read(MOST + 1)
    except (OSError, ValueError) as error:
        raise UpdateError(
            phrase("Metagraph could not reach the server ({why}). Try again later.", why=str(error))
        ) from None
    try:
        if len(data) > MOST:
            raise msgspec.DecodeError("too large")
        release = msgspec.json.decode(data, type=Release)
    except msgspec.DecodeError:
        release = Release("")
    if not _VERSION.match(release.version):
        raise UpdateError(
            phrase("The server's answer does not describe a release. Tell the people who gave you Metagraph.")
        )
    if not is_safe(release.url):
        release = Release(release.version, release.notes)
    return release


class _NoRedirects(urllib.request.HTTPRedirectHandler):
    """Asks no other place than the one that the build set."""

    def redirect_request(self, *words: Any, **more: Any) -> None:
        return None


def _numbers(version: str) -> tuple[int, ...]:
    """Return a version's numbers, without the zeros at its end; whatever follows them does not count."""
    found = re.match(r"\d+(\.\d+)*", version)
    out = [int(part) for part in found[0].split(".")] if found else []
    while out and not out[-1]:
        out.pop()
    return tuple(out)


def read_notes(version: str, place: Path = ROOT / "CHANGELOG.md") -> str:
    """Return the changelog's part about a version, else about what is not released yet, as Markdown; "" if
    there is no changelog.
    """
    try:
        text = place.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return ""
    parts = re.split(r"^## \[?([^\]\s]+)\]?.*$", text, flags=re.MULTILINE)
    found = dict(zip(parts[1::2], parts[2::2], strict=False))
    return (found.get(version) or found.get("Unreleased") or "").strip()


def note_version(settings: QSettings, version: str) -> bool:
    """Remember which version runs; return whether another one ran last time."""
    before = str(settings.value(SEEN, ""))
    if before != version:
        settings.setValue(SEEN, version)
    return before not in ("", version)
