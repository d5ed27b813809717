"""Tasks done in an engine itself are a third condition beside the two of this program."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.research.study import engine_logs
from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.analysis.results import analyse_study
from metagraph.research.study.logs.engine_import import import_engine
from metagraph.research.study.report import format_study_page
from metagraph.research.study.simulation.files import write_study
from metagraph.research.study.simulation.people import Truth
from metagraph.research.study.study_plan import Study

SCRIPTS = Path(engine_logs.__file__).parent


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return write_study(tmp_path_factory.mktemp("made") / "study", Truth(participants=4, ratio=2.0))


def written(path: Path, who: str, seconds: float, engine: str = "unity", task: str = "small") -> Path:
    """A log as the scripts write it."""
    about = {"name": "task", "condition": engine, "task": task, "index": 0, "why": "done"}
    told = [
        (0.0, {"type": "begin", "participant": who, "engine": engine, "version": "6"}),
        (1.0, {"type": "phase", "state": "begin", **about}),
    ]
    told += [
        (1.0 + seconds * k / 40, {"type": "edit", "what": "settings", "words": "Edit"}) for k in range(1, 41)
    ]
    told.append((1.0 + seconds, {"type": "phase", "state": "end", **about}))
    lines = [
        json.dumps(
            {
                "n": n,
                "run": "a",
                "mono": at,
                "wall": f"2026-03-01T09:{int(at) // 60:02}:{at % 60:06.3f}Z",
                **e,
            }
        )
        for n, (at, e) in enumerate(told)
    ]
    path.write_text("\n".join(lines) + "\n")
    return path


def test_what_is_no_engines_log_is_refused(study: Study, tmp_path: Path) -> None:
    with pytest.raises(FileError, match="Unreal, Unity, Godot or Blender"):
        import_engine(study, "P01", study.log("P01"))
    with pytest.raises(FileError, match=r"'P02'.*'P01'"):
        import_engine(study, "P01", written(tmp_path / "a.jsonl", "P02", 100))
    with pytest.raises(ValueError, match="does not take part"):
        import_engine(study, "nobody", tmp_path / "a.jsonl")


def test_an_engine_is_told_beside_the_meta_graph(study: Study, tmp_path: Path) -> None:
    before = analyse_study(collect_study(study.folder, jumps=False))
    for n, who in enumerate(study.plan.ids):
        log, odd = import_engine(study, who, written(tmp_path / "log.jsonl", who, 900 + 100 * n))
        assert odd == [] and log.tasks()[0].edits == 40
    with pytest.raises(FileError, match="is there already"):
        import_engine(study, "P01", written(tmp_path / "log.jsonl", "P01", 900))
    data = collect_study(study.folder, jumps=False)
    found = analyse_study(data)
    assert (
        data.conditions == ("meta", "manual", "unity") and before.time is not None and found.time is not None
    )
    assert found.time.ratio == before.time.ratio, "the two conditions here stay as they were"
    (other,) = found.others
    assert other.pair == ("unity", "meta") and other.ratio.n == 4 and other.ratio.value > 1
    assert "Unity" in format_study_page(found) and "Other conditions" in format_study_page(found)


def test_scripts_say_where_they_were_not_run_and_write_what_is_read() -> None:
    scripts = [p for p in SCRIPTS.rglob("*") if p.suffix in (".gd", ".cs", ".txt")]
    assert len(scripts) == 4
    for path in scripts:
        text = path.read_text(encoding="utf-8")
        assert "NOT RUN in" in text, path.name
        for word in ("mono", "wall", "phase", "participant", "condition", "index", "engine"):
            assert word in text, (path.name, word)


def test_the_script_for_godot_is_one() -> None:
    parser = pytest.importorskip("gdtoolkit.parser", reason="gdtoolkit is not installed").parser
    parser.parse((SCRIPTS / "godot" / "metagraph_study_log.gd").read_text(encoding="utf-8"))


@pytest.mark.parametrize("engine", ["unreal", "blender"])
def test_the_scripts_in_python_are_python(engine: str) -> None:
    compile((SCRIPTS / engine / "metagraph_study_log.py.txt").read_text(encoding="utf-8"), engine, "exec")
