"""Pages in a real browser, which is started once for the tests of a file."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import pytest

from tests.processes import PATIENCE, Answering, started

TESTS = Path(__file__).parent
MODULES = TESTS / "node_modules"
CHROMIUM = os.environ.get("CHROMIUM") or next(
    (c for c in ("chromium", "chromium-browser", "google-chrome") if shutil.which(c)), None
)
LONGEST = 150.0  # seconds that steps may take


class Browser:
    """Chromium without a window, started when it is first needed."""

    def __init__(self) -> None:
        self._open = ExitStack()
        self._host: Answering | None = None

    def __call__(
        self, folder: Path, *steps: dict[str, Any], scheme: str = "dark"
    ) -> tuple[list[Any], list[str]]:
        """Run steps in a new page of a folder (`engines/run/browser.mjs` says which there are), which knows
        nothing of those before; return the values its `run` steps gave, and the errors the browser told.
        """
        if CHROMIUM is None or shutil.which("node") is None or not (MODULES / "playwright-core").is_dir():
            pytest.skip("needs Chromium, Node and playwright-core (python3 run.py test fetches what it can)")
        if self._host is None:
            environ = {**os.environ, "CHROMIUM": shutil.which(CHROMIUM) or CHROMIUM}
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
            program = TESTS / "engines" / "run" / "browser.mjs"
            process = self._open.enter_context(started("node", program, env=environ, **pipes))
            self._open.callback(_left_alone, process)
            self._host = Answering(process, LONGEST)
        asked = {"folder": str(folder), "steps": steps, "scheme": scheme}
        answer = json.loads(self._host.ask(json.dumps(asked)))
        assert "failed" not in answer, answer["failed"]
        return answer["values"], answer["errors"]

    def close(self) -> None:
        self._open.close()


def _left_alone(process: subprocess.Popen[str]) -> None:
    """Let a program go that ends when nobody asks any more."""
    if process.stdin is not None:
        process.stdin.close()
    with suppress(subprocess.TimeoutExpired):
        process.wait(PATIENCE)


@pytest.fixture(scope="module")
def browse() -> Iterator[Browser]:
    browser = Browser()
    yield browser
    browser.close()
