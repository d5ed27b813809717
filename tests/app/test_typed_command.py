"""Commands for the user to type."""

from __future__ import annotations

import pytest

from app.typed_command import list_program_words


def test_the_command_begins_with_what_started_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    assert list_program_words() == ["metagraph"]
    monkeypatch.setenv("METAGRAPH_COMMAND", "python3 '/a b/run.py'")
    assert list_program_words() == ["python3", "/a b/run.py"]
