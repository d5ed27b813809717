"""What generated mutants are made of, and that vectors notice one where it matters and none where it does not."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.engines import generated_mutants
from tests.engines.generated_mutants import LANGUAGES, RUNTIMES, Edit, apply, edits, runner

JS = LANGUAGES["javascript"]


def _made(tmp_path: Path, source: str) -> list[tuple[str, str]]:
    (tmp_path / "rule.js").write_text(source, encoding="utf-8")
    return [(e.old, e.new) for e in edits(JS, tmp_path)]


def test_operators_numbers_and_words_are_changed_and_texts_and_comments_are_not(tmp_path: Path) -> None:
    source = 'const small = new Float64Array(3);\nconst a = b <= 0.5 && c; // 3 < 4\nif (!d) return "x < 1" + min(e, 1e-6);\n'
    assert _made(tmp_path, source) == [("<=", "<"), ("0.5", "0.55"), ("&&", "||"), ("min", "max")]


def test_what_only_tells_of_errors_is_left_alone(tmp_path: Path) -> None:
    assert _made(tmp_path, "import { a } from './b.js';\nif (n > 3) throw new Error(n - 1);\n") == []


def test_a_change_is_made_in_its_place_alone(tmp_path: Path) -> None:
    (tmp_path / "rule.js").write_text("a < b; c < d;\n", encoding="utf-8")
    second = edits(JS, tmp_path)[1]
    apply(second, tmp_path)
    assert (tmp_path / "rule.js").read_text(encoding="utf-8") == "a < b; c <= d;\n"


@pytest.mark.nightly
def test_every_runtime_has_hundreds_of_places_to_change() -> None:
    for language in LANGUAGES.values():
        assert len(edits(language, RUNTIMES / language.folder)) > 400


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node")
def test_vectors_notice_a_rule_that_is_changed_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sparse = [f for f in generated_mutants.vector_folders() if f.name == "sparse"]
    monkeypatch.setattr(generated_mutants, "vector_folders", lambda: sparse)
    found = [e for e in edits(JS, RUNTIMES / "javascript") if e.path == "replan.js" and e.old == "<="]
    running = runner("javascript", tmp_path)
    try:
        assert running.notices(None) == ""
        assert any(running.notices(edit) for edit in found)
        broken = Edit("replan.js", found[0].at, "<=", "<=<=")
        assert "SyntaxError" in running.notices(broken)
    finally:
        running.close()
