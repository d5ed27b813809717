"""Parameters are added, renamed, removed, merged, saved and checked."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.fields import DataError
from metagraph.formats.project.merging import merge_projects
from metagraph.formats.store import read_project, save_project
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.differences import describe_differences
from metagraph.graph.editing.parameters import (
    MOST,
    add_parameter,
    list_offered_parameters,
    remove_parameter,
    rename_parameter,
    set_parameter,
)
from metagraph.graph.model import Project
from metagraph.graph.parameter import CharacterParameter, ParameterChoice
from metagraph.graph.requests import Blink, Feel, Gesture, Go, Line, Look, Play, Say
from tests.conftest import Toy


def fill(project: Project) -> Project:
    """Return a project with everything that can be added to it."""
    for offered in list_offered_parameters(project):
        project, _ = add_parameter(project, offered.name, offered.parameter)
    return project


@pytest.fixture(scope="module")
def project() -> Project:
    plain = replace(
        Toy().project(), points={"door": (1.0, 1.0, 1.0)}, lines={"hello": Line(text="Hello you")}
    )
    return fill(plain)


def faults(project: Project) -> list[str]:
    return [f"{p.message}. {p.remedy}" for p in check_project(project) if p.code == "parameter"]


def test_all_that_is_offered_works(project: Project) -> None:
    assert len(project.parameters) > 15 and faults(project) == []
    assert {p.type for p in project.parameters.values()} >= {"number", "boolean", "enum", "point", "trigger"}
    assert "say_hello_you" in project.parameters


def test_names_are_made_unique_renamed_and_refused(project: Project) -> None:
    again, name = add_parameter(project, "mood", project.parameters["mood"])
    assert name == "mood2" and list(again.parameters)[-1] == "mood2"
    renamed = rename_parameter(project, "mood", "feeling")
    assert next(iter(renamed.parameters)) == "feeling", "it keeps its place"
    assert rename_parameter(project, "mood", "mood") is project
    with pytest.raises(EditError, match="already"):
        rename_parameter(project, "mood", "energy")
    with pytest.raises(EditError, match="walk_speed"):
        rename_parameter(project, "mood", "My mood")
    assert "mood" not in remove_parameter(project, "mood").parameters


def test_there_are_not_too_many(project: Project) -> None:
    full = replace(project, parameters={f"p{n}": project.parameters["mood"] for n in range(MOST)})
    with pytest.raises(EditError, match="at most 200"):
        add_parameter(full, "mood", project.parameters["mood"])


BROKEN: dict[str, CharacterParameter] = {
    "a trigger with a field": CharacterParameter(type="trigger", request=Blink(), field="id"),
    "a trigger of what lasts": CharacterParameter(type="trigger", request=Feel(mood="happy")),
    "a number of nothing": CharacterParameter(type="number", request=Feel(), field="mood"),
    "no range": CharacterParameter(type="number", request=Feel(), field="intensity", least=1, most=1),
    "beyond the range": CharacterParameter(type="number", request=Look(), field="amount", most=3),
    "no choice": CharacterParameter(type="enum", request=Feel(), field="mood"),
    "an unknown mood": CharacterParameter(
        type="enum", request=Feel(), field="mood", choices=(ParameterChoice("odd", "odd"),)
    ),
    "one half of a switch": CharacterParameter(
        type="boolean", request=Feel(), field="mood", choices=(ParameterChoice("on", "happy"),)
    ),
    "twice the same": CharacterParameter(
        type="enum",
        request=Feel(),
        field="mood",
        choices=(ParameterChoice("a", "happy"), ParameterChoice("a", "sad")),
    ),
    "no name": CharacterParameter(
        type="enum", request=Feel(), field="mood", choices=(ParameterChoice("A b", "happy"),)
    ),
    "no such stance": CharacterParameter(
        type="enum", request=Go(stance="s1"), field="stance", choices=(ParameterChoice("a", "nowhere"),)
    ),
    "no such point": CharacterParameter(
        type="enum", request=Look(), field="to", choices=(ParameterChoice("a", "nowhere"),)
    ),
    "no such action": CharacterParameter(type="trigger", request=Play(action="nothing")),
    "no such line": CharacterParameter(type="trigger", request=Say(line="nothing")),
    "no such tag": CharacterParameter(type="trigger", request=Gesture(tags=("nothing",))),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_cannot_work_is_refused_and_in_a_file_an_error(project: Project, name: str) -> None:
    with pytest.raises(EditError):
        set_parameter(project, "broken", BROKEN[name])
    written = replace(project, parameters={"broken": BROKEN[name]})
    assert from_data(to_data(written)).parameters == written.parameters, "the file is read, to be mended"
    assert faults(written)


def test_what_is_removed_is_an_error_with_a_remedy(project: Project) -> None:
    stance = next(iter(project.graphs["arms"].stances))
    left = edits.remove_stance(project, stance)
    found = [text for text in faults(left) if "'arms_stance'" in text]
    assert len(found) == 1 and "its stance is no longer in the project. Remove the choice" in found[0]
    trigger = next(p.request for p in project.parameters.values() if isinstance(p.request, Play))
    assert isinstance(trigger, Play)
    left = edits.remove_actions(project, [trigger.action])
    assert any("its action is no longer in the project" in text for text in faults(left))
    assert any("its line is no longer" in text for text in faults(replace(project, lines={})))
    assert any("no point 'door'" in text for text in faults(replace(project, points={})))


def test_they_are_saved_read_and_told_apart(project: Project, tmp_path: Path) -> None:
    path = tmp_path / "toy.metagraph.yaml"
    save_project(project, path)
    read = read_project(path)
    assert read.parameters == project.parameters and list(read.parameters) == list(project.parameters)
    text = path.read_text(encoding="utf-8")
    assert "  blink: {type: trigger, request: {do: blink}}" in text, "one line for each"
    louder = msgspec.structs.replace(project.parameters["energy"], most=1.5)
    words = describe_differences(project, set_parameter(project, "energy", louder))
    assert words == ["Parameter 'energy' changed: most 2 → 1.5"]


def test_two_peoples_parameters_are_merged(project: Project) -> None:
    base = replace(project, parameters={})
    mine, _ = add_parameter(base, "mood", project.parameters["mood"])
    theirs, _ = add_parameter(base, "energy", project.parameters["energy"])
    assert merge_projects(base, mine, theirs).project.parameters == {
        "energy": project.parameters["energy"],
        "mood": project.parameters["mood"],
    }
    about = [
        set_parameter(mine, "mood", msgspec.structs.replace(project.parameters["mood"], about=x))
        for x in "ab"
    ]
    merged = merge_projects(mine, *about)
    assert merged.project.parameters["mood"].about == "a" and "parameter 'mood'" in merged.kept[0]
    both = [
        add_parameter(base, "wave2", p)[0] for p in (project.parameters["mood"], project.parameters["energy"])
    ]
    merged = merge_projects(base, *both)
    assert list(merged.project.parameters) == ["wave2"] and merged.kept, "a name is one thing"


def test_broken_files_are_read_or_refused_with_their_place(project: Project) -> None:
    """Values of any kind anywhere in a parameter: an error names the place, and nothing else is raised."""
    draw, data = random.Random(11), to_data(project)
    rows = dict(list(data["parameters"].items())[:6])
    odd: tuple[Any, ...] = (None, 1, -1.5, 1e300, "", "x", [], [1], {}, {"do": "nod"}, True, ["a", {}])
    for _ in range(1500):
        broken = msgspec.json.decode(msgspec.json.encode(rows))
        row = broken[draw.choice([*broken])]
        place = draw.choice([*row, "unknown"])
        if place == "request" and draw.random() < 0.7:
            row["request"][draw.choice([*row["request"], "intensity", "tags", "layer"])] = draw.choice(odd)
        else:
            row[place] = draw.choice(odd)
        try:
            read = from_data({**data, "parameters": broken})
        except DataError as error:
            assert error.where.startswith("parameters")
        else:
            check_project(read)
