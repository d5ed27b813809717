"""The page in a real browser: from a file and served, with keyboard alone, resumed, withdrawn."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from metagraph.research.study.logs.log import read_log
from metagraph.research.study.perceive.answers import keep_sheet, read_answers
from metagraph.research.study.perceive.folder import Perceived
from metagraph.research.study.perceive.perceive_data import collect_answers
from metagraph.research.study.perceive.serving import serve_page
from tests.browsing import Browser
from tests.research.study.perceive.perceive_makers import CHOICE, RATING, shown, text

MORE = "checks: {told: 1}\nconsent: You take part of your own free will.\ninstructions: Watch, then choose.\n"

BUTTONS = "[...document.querySelectorAll('button')]"
READY = {"until": f"{BUTTONS}.some((b) => ['Play', 'Watch again'].includes(b.textContent) && !b.disabled)"}
OPEN = {"until": "document.querySelector('.answers button, fieldset input')?.disabled === false"}
EVENTS = {"run": "kept.events"}
BEGIN = [
    {"click": "button:text-is('Begin')"},
    {"click": "button:text-is('I agree')"},
    {"click": "button:text-is('Go on')"},
]


def answer(made: Perceived, who: str = "P01") -> list[dict[str, Any]]:
    """Go through all trials with the keyboard alone: play, then an arrow, or each question's fourth point."""
    steps: list[dict[str, Any]] = []
    for trial in made.key.sessions[who].trials:
        steps += [READY, {"press": "Space"}, OPEN]
        if trial.right:
            steps.append({"press": "ArrowRight" if trial.told == "right" else "ArrowLeft"})
        else:
            number = trial.told if trial.kind == "told" else 4
            steps += [{"press": "Tab"}, {"press": "Space"}]
            steps += [{"press": "ArrowRight"}] * (int(str(number)) - 1)
            steps += [{"press": "Tab"}, {"press": "Enter"}]
    return steps


@pytest.fixture
def made(tmp_path: Path) -> Perceived:
    return shown(
        tmp_path / "s", text(people=3, items=2, asked=CHOICE + RATING + "  each: 1\n", more=MORE), 0.8
    )


@pytest.mark.nightly
def test_from_a_file_everything_is_answered_by_keyboard_saved_and_read(
    made: Perceived, tmp_path: Path, browse: Browser
) -> None:
    page = (made.show / "index.html").as_uri() + "#P01"
    steps = [{"url": page, "until": "document.querySelector('#code').value === 'P01'"}, *BEGIN, READY]
    steps += [{"run": "document.querySelector('.answers button').disabled"}, {"press": "ArrowLeft"}, EVENTS]
    steps += answer(made)
    steps += [{"until": "document.querySelector('h1').textContent === 'Thank you'"}]
    saved, table = tmp_path / "answers.json", tmp_path / "answers.csv"
    steps += [
        {"download": ["button:text-is('Save the answers')", str(saved)]},
        {"download": ["button:text-is('Save as a table (CSV)')", str(table)]},
    ]
    (disabled, before), errors = browse(made.folder, *steps)
    assert not errors and disabled is True
    assert [e["type"] for e in before] == ["begin"]  # nothing counts that was not watched
    sheet = read_answers(saved)
    assert keep_sheet(made, sheet).new == len(sheet.events)
    (person, *_) = collect_answers(made).people
    trials = made.key.sessions["P01"].trials
    assert (person.why, person.answered, person.missed) == ("", len(trials), 0)
    for event, trial in zip(sheet.events[1:-1], trials, strict=True):
        assert len(event.watched) == (2 if trial.right else 1) and min(event.watched) > 0.5
        assert 0 < event.seconds < 60 and event.replays == 0
    rows = table.read_text().splitlines()
    assert len(rows) == len(trials) + 1 and rows[1].split(",")[2] == "training"


@pytest.mark.nightly
def test_served_answers_arrive_replays_are_counted_and_a_reload_goes_on(
    made: Perceived, browse: Browser
) -> None:
    served = serve_page(made)
    try:
        first, second = answer(made, "P02")[:4], answer(made, "P02")[4:8]
        steps = [{"url": served.url + "#P02", "until": "document.querySelector('#code')"}, *BEGIN]
        steps += [*first[:3], {"press": "Space"}, {"wait": 200}, READY, first[3]]
        steps += [
            *second[:2],
            {"wait": 100},
            {"url": served.url + "?again#P02", "until": "window.study || true"},
        ]
        steps += [
            {"click": "button:text-is('Begin')"},
            READY,
            {"run": "document.querySelector('#state').textContent"},
        ]
        steps += [*second, {"until": "kept.sent === kept.events.length"}, EVENTS]
        (state, events), errors = browse(made.folder, *steps)
    finally:
        served.close()
    assert not errors
    assert [e["type"] for e in events] == ["begin", "answer", "resumed", "answer"] and state.startswith(
        "2 of "
    )
    assert [e.get("replays") for e in events] == [None, 1, None, 0]
    log = read_log(made.log("P02"))
    assert [e["type"] for e in log.events] == [e["type"] for e in events] and not log.problems


@pytest.mark.nightly
def test_who_withdraws_leaves_nothing_in_the_browser_and_is_not_counted(
    made: Perceived, browse: Browser
) -> None:
    served = serve_page(made)
    try:
        steps = [{"url": served.url + "#P03", "until": "document.querySelector('#code')"}, *BEGIN]
        steps += [*answer(made, "P03")[:4], {"click": "#withdraw"}, {"click": "#yes"}]
        steps += [
            {"until": "kept.sent === kept.events.length"},
            {"run": "document.querySelector('h1').textContent"},
        ]
        steps += [{"run": "Object.values(localStorage).join()"}]
        (title, left), errors = browse(made.folder, *steps)
    finally:
        served.close()
    assert not errors and title == "You withdrew" and "value" not in left and "withdrawn" in left
    assert read_log(made.log("P03")).standing == "withdrawn"
    assert next(p for p in collect_answers(made).people if p.participant == "P03").why == "withdrawn"


@pytest.mark.nightly
def test_who_does_not_agree_leaves_no_trace_but_that(made: Perceived, browse: Browser) -> None:
    page = (made.show / "index.html").as_uri()
    steps = [{"url": page, "until": "document.querySelector('#code')"}, {"fill": ["#code", " p01 "]}]
    steps += [{"click": "button:text-is('Begin')"}, {"click": "button:text-is('I do not agree')"}, EVENTS]
    (events,), errors = browse(made.folder, *steps)
    assert not errors and [e["type"] for e in events] == ["declined"]


@pytest.mark.nightly
def test_a_video_that_is_missing_is_told(made: Perceived, browse: Browser) -> None:
    for path in (made.show / "videos").iterdir():
        path.unlink()
    page = (made.show / "index.html").as_uri() + "#P01"
    steps = [{"url": page, "until": "document.querySelector('#code')"}, *BEGIN]
    steps += [
        {"until": "document.querySelector('[role=status].dim')?.textContent.includes('cannot be played')"}
    ]
    browse(made.folder, *steps)
