"""The program that tests of C++ keep is the one that its sources give."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.engines import cpp_program
from tests.engines.cpp_program import compiled_from, needs_compiler

pytestmark = needs_compiler


def test_what_is_compiled_from_other_sources_or_with_other_options_is_not_what_was_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "core").mkdir()
    header = tmp_path / "core" / "a.hpp"
    header.write_text("inline int a() { return 1; }\n")
    first = compiled_from(tmp_path)
    assert compiled_from(tmp_path) == first
    header.write_text("inline int a() { return 2; }\n")
    second = compiled_from(tmp_path)
    header.rename(tmp_path / "core" / "b.hpp")
    third = compiled_from(tmp_path)
    monkeypatch.setattr(cpp_program, "FLAGS", ("-O2",))
    assert len({first, second, third, compiled_from(tmp_path)}) == 4
