"""The command that shows what a problem is about."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Any

from app.cli.parser import _parser
from app.cli.showing_command import name_showing_command
from metagraph.graph.problem import Problem

PATH = Path("my film.metagraph.yaml")


def test_a_moment_is_a_second_before_it_in_a_video_that_the_parser_knows(toy: Any) -> None:
    project = toy.project()
    seen = Problem("warning", "play-jump", "", "", "arms", moment=30.2)
    words = shlex.split(name_showing_command(project, seen, PATH))
    options = _parser(words[1]).parse_args(words[1:])
    assert words[0] == "metagraph" and options.start == 29.2 and options.seconds == 3.0
    early = Problem("warning", "play-jump", "", "", "arms", moment=0.4)
    assert " --start 0.0 " in name_showing_command(project, early, PATH)


def test_what_only_an_actions_own_turn_shows_opens_the_window_on_its_clip(toy: Any) -> None:
    project = toy.project()
    seen = Problem("warning", "play-fast", "", "", "arms", action=toy.id(project, "rest long"))
    words = shlex.split(name_showing_command(project, seen, PATH))
    options = _parser(words[1]).parse_args(words[1:])
    assert (words[1], options.clip, list(map(str, options.paths))) == ("window", "rest long", [str(PATH)])


def test_what_was_not_seen_playing_names_no_command(toy: Any) -> None:
    project = toy.project()
    action = toy.id(project, "rest long")
    assert name_showing_command(project, Problem("warning", "far-start", "", "", action=action), PATH) == ""
    assert name_showing_command(project, Problem("warning", "play-fast", "", "", action="gone"), PATH) == ""
