"""Planted studies whose truth is known: what is put in comes out, and whatever is done to the data is
reported.

Sixteen people, ratio 2.3, a second sitting 0.8 of a first, practice -0.20.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.analysis.results import analyse_study
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.report import format_study_page
from metagraph.research.study.reports.cells import gather_missing
from metagraph.research.study.reports.tables import tabulate_people
from metagraph.research.study.simulation.files import write_study
from metagraph.research.study.simulation.people import Truth
from metagraph.research.study.statistics.sensitivity import PRACTICE, SECOND

TRUTH = Truth(participants=16, ratio=2.3, order=0.8, learning=-0.20)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_study(tmp_path_factory.mktemp("planted") / "study", TRUTH).folder


@pytest.fixture
def study(made: Path, tmp_path: Path) -> Path:
    shutil.copytree(made, tmp_path / "study")
    return tmp_path / "study"


def rewrite(log: Path, change: Callable[[list[dict[str, Any]]], None]) -> None:
    events = [json.loads(line) for line in log.read_text().splitlines()]
    change(events)
    log.write_text("".join(json.dumps(e) + "\n" for e in events))


@pytest.mark.nightly
def test_every_way_of_reckoning_recovers_what_was_put_in(made: Path) -> None:
    found = analyse_study(collect_study(made, jumps=False))
    assert found.time is not None and found.sensitivity is not None and found.sensitivity.mixed is not None
    assert found.time.ratio.holds(2.3)
    ways = {w.name: w.ratio for w in found.sensitivity.ways}
    assert {
        "by ranks", "both orders alike", "mixed model", "no gap taken off", "gaps of more than 30 s off",
        "gaps of more than 120 s off",
    } <= ways.keys()  # fmt: skip
    assert all(e.holds(2.3) for name, e in ways.items()), ways
    model = found.sensitivity.mixed
    assert model.effects[SECOND].exp().holds(0.8) and model.effects[PRACTICE].holds(-0.20)
    assert found.sensitivity.odd == ()


@pytest.mark.nightly
def test_one_person_with_other_sizes_is_left_out_and_the_unit_stays(study: Path) -> None:
    """The larger task in the one condition, the smaller in the other: nothing can be compared within them."""
    before = analyse_study(collect_study(study, jumps=False))

    def unfinish(events: list[dict[str, Any]]) -> None:
        for e in events:
            ends = e["type"] == "phase" and e["state"] == "end" and e["name"] == "task"
            if ends and (e["condition"], e["task"]) in (("meta", "large"), ("manual", "small")):
                e["why"] = "broken off"

    rewrite(study / "data" / "P05" / "log.jsonl", unfinish)
    found = analyse_study(collect_study(study, jumps=False))
    assert before.time is not None and found.time is not None
    assert (found.time.unit, found.time.ratio.n, found.time.left_out) == ("task", 15, ("P05",))
    assert any("P05" in words for words in found.time.cautions)
    assert found.time.means["meta"].value == pytest.approx(before.time.means["meta"].value, rel=0.1)
    columns, rows = tabulate_people(found)
    assert "meta_seconds" in columns and rows[4][columns.index("meta_seconds")] is None


@pytest.mark.nightly
def test_a_sitting_of_63_minutes_under_a_limit_of_40_is_told(study: Path) -> None:
    path = study / "study.yaml"
    path.write_text(path.read_text().replace("  instructions:", "  minutes: 40\n  instructions:"))

    def stretch(events: list[dict[str, Any]]) -> None:
        begin = next(n for n, e in enumerate(events) if e.get("task") == "large" and e.get("name") == "task")
        end = next(n for n, e in enumerate(events[begin + 1 :], begin + 1) if e["type"] == "phase")
        inner = events[begin + 1 : end + 1]
        took = events[end]["mono"] - events[begin]["mono"]
        more = (63 * 60 - took) / len(inner)
        stretched(events, {e["n"]: more * k for k, e in enumerate(inner, 1)})

    rewrite(study / "data" / "P03" / "log.jsonl", stretch)
    found = analyse_study(collect_study(study, jumps=False))
    assert found.sensitivity is not None
    odd = " ".join(found.sensitivity.odd)
    assert "P03, large (" in odd and "limit of 40" in odd and "others" in odd
    assert "limit of 40" in format_study_page(found)


def stretched(events: list[dict[str, Any]], later: dict[int, float]) -> None:
    """Let events be later by seconds, and all after them by as much as the last."""
    from datetime import datetime, timedelta

    shift = 0.0
    for e in events:
        shift = later.get(e["n"], shift)
        e["mono"] = round(e["mono"] + shift, 6)
        wall = datetime.fromisoformat(e["wall"]) + timedelta(seconds=shift)
        e["wall"] = wall.isoformat(timespec="milliseconds").replace("+00:00", "Z")


@pytest.mark.nightly
def test_a_swapped_reference_and_a_changed_clip_are_told(study: Path) -> None:
    before = collect_study(study, jumps=False)
    assert before.missing == ()
    shutil.copy(study / "small.metagraph.yaml", study / "large.metagraph.yaml")
    clip = next((study / "clips").iterdir())
    clip.write_bytes(clip.read_bytes() + b"\n")
    told = collect_study(study, jumps=False).missing
    for name in ("large.metagraph.yaml", f"clips/{clip.name}"):
        assert any(f"'{name}'" in words for words in told), name


def test_another_consent_and_other_questions_are_told(study: Path) -> None:
    path = study / "study.yaml"
    path.write_text(
        path.read_text().replace("questionnaires: [sus, tlx]", "questionnaires: [sus]\nconsent: Else.")
    )
    told = collect_study(study, jumps=False).missing
    for what in ("consent", "questions"):
        assert any(words.startswith("everybody: ") and what in words for words in told), what


def test_halved_seconds_of_the_program_are_told(study: Path) -> None:
    def halve(events: list[dict[str, Any]]) -> None:
        for e in events:
            e["mono"] /= 2

    rewrite(study / "data" / "P02" / "log.jsonl", halve)
    told = collect_study(study, jumps=False).missing
    assert [w for w in told if w.startswith("P02: the clocks disagree all along events 0 to")]


def test_an_old_log_says_that_nothing_was_frozen(study: Path) -> None:
    rewrite(study / "data" / "P01" / "log.jsonl", lambda events: events.pop(1))
    told = collect_study(study, jumps=False).missing
    assert any(words.startswith("P01: the log does not say which references and clips") for words in told)


@pytest.mark.nightly
def test_what_vanished_is_told_by_condition(study: Path) -> None:
    def wait(events: list[dict[str, Any]]) -> None:
        at = next(n for n, e in enumerate(events) if e["type"] == "edit" and e["mono"] > 0)
        stretched(events, {events[at]["n"]: 400.0})

    rewrite(study / "data" / "P01" / "log.jsonl", wait)
    first = read_log(study / "data" / "P01" / "log.jsonl").tasks()[0]
    found = analyse_study(collect_study(study, jumps=False))
    lost = found.vanished[first.condition]
    assert (lost.count, round(lost.longest, -2)) == (1, 400) and lost.seconds == pytest.approx(
        400 / 32, rel=0.1
    )
    ways = {w.name: w.ratio.value for w in found.sensitivity.ways} if found.sensitivity else {}
    assert ways["no gap taken off"] != pytest.approx(ways["gaps of more than 120 s off"], rel=1e-3)
    assert "Time that is not counted" in format_study_page(found) and "a task, mean" in format_study_page(
        found
    )


@pytest.mark.nightly
def test_time_outs_count_as_bounds_and_wrong_machines_as_not_yet_right(study: Path) -> None:
    def cut(events: list[dict[str, Any]]) -> None:
        for e in events:
            if (
                e["type"] == "phase"
                and e["state"] == "end"
                and (e.get("condition"), e.get("task")) == ("manual", "large")
            ):
                e["why"] = "time"

    for who in ("P02", "P04", "P06"):
        rewrite(study / "data" / who / "log.jsonl", cut)
    found = analyse_study(collect_study(study, jumps=False))
    assert found.time is not None and found.sensitivity is not None
    ways = {w.name: w.ratio for w in found.sensitivity.ways}
    assert ways["time-outs as censored"].value > found.time.ratio.value
    (right, counted) = found.sensitivity.correct["manual"]
    assert counted == 32 and right < 32


def test_what_is_missing_of_many_is_said_once(study: Path) -> None:
    for n in range(3, 17):
        shutil.rmtree(study / "data" / f"P{n:02}")
    found = collect_study(study, jumps=False)
    assert len(found.missing) == 14
    lines = gather_missing(found.missing)
    assert len(lines) == 1 and lines[0].startswith("14 times: has not begun (P03, P04,")
    assert "did not begin: 14" in format_study_page(analyse_study(found))
