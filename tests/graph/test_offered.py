"""What may be asked: all that is offered is understood, and nothing else passes as a tool's input."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import jsonschema
import pytest

from metagraph.engines.character import Character
from metagraph.graph.model import Project
from metagraph.graph.offered import CHOICES, ENGINES, list_offered_requests, list_tools
from metagraph.graph.requests import WORDS, Line, make_request


def tool(project: Project, word: str) -> dict[str, Any]:
    return next(one for one in list_tools(project) if one["name"] == word)


def takes(schema: dict[str, Any], given: Any) -> bool:
    return jsonschema.Draft202012Validator(schema["input_schema"]).is_valid(given)


def test_a_project_with_nothing_offers_words_and_tools_all_the_same() -> None:
    told = list_offered_requests(Project())
    assert told["joints"] == told["lines"] == told["layers"]["arms"]["actions"] == []
    assert told["words"] == list(ENGINES) and "bml" not in ENGINES and {*ENGINES, "bml"} == set(WORDS)
    assert takes(tool(Project(), "gesture"), {"tags": ["whatever"]}), (
        "where no tags are known any may be said"
    )
    assert takes(tool(Project(), "say"), {"text": "Hello."})


def test_tools_are_schemas_that_take_what_this_character_has_and_nothing_else(sample: Project) -> None:
    for one in list_tools(sample):
        jsonschema.Draft202012Validator.check_schema(one["input_schema"])
        assert one["description"] and not {"do", "told"} & set(one["input_schema"]["properties"])
    gesture = tool(sample, "gesture")
    assert takes(gesture, {"tags": ["greeting"], "layer": "arms", "after": 1.5}) and takes(gesture, {})
    assert not takes(gesture, {"tags": ["somersault"]}) and not takes(gesture, {"speed": 2})
    assert takes(tool(sample, "stance"), {"stance": "on hips"})
    assert not takes(tool(sample, "stance"), {}) and not takes(tool(sample, "stance"), {"stance": "on ice"})
    line = next(iter(sample.lines))
    assert takes(tool(sample, "say"), {"line": line}) and not takes(
        tool(sample, "say"), {"line": "none of it"}
    )
    assert sample.lines[line].text in tool(sample, "say")["input_schema"]["properties"]["line"]["description"]


def test_whatever_a_tool_lists_is_understood_when_it_is_asked_for(sample: Project) -> None:
    character = Character(sample, idle=False)
    asked = []
    for one in list_tools(sample):
        fields = one["input_schema"]["properties"]
        for name, field in fields.items():
            for value in field.get("items", field).get("enum", ())[:6]:
                if name in ("tags", "stance", "action", "line") and value is not None:
                    given = {name: [value] if name == "tags" else value}
                    assert takes(one, given)
                    make_request({"do": one["name"], **given})
                    asked.append(character.ask({"do": one["name"], **given, "after": 1.0 + 30 * len(asked)}))
    assert len(asked) > 20
    character.update(0.1)
    assert not [character.answer(x).why for x in asked if "is known" in character.answer(x).why]


def test_lines_are_told_by_id_and_only_so_many_where_that_is_asked() -> None:
    project = replace(Project(), lines={x: Line(text=x) for x in ("b", "10", "é", "a")})
    assert [line["id"] for line in list_offered_requests(project)["lines"]] == ["10", "a", "b", "é"]
    assert len(list_offered_requests(project, most={"lines": 2})["lines"]) == 2


@pytest.mark.parametrize("count", [CHOICES, CHOICES + 1])
def test_a_tool_with_too_many_choices_takes_any_text(count: int) -> None:
    project = replace(Project(), lines={str(n): Line(text="x") for n in range(count)})
    assert takes(tool(project, "say"), {"line": "other"}) == (count > CHOICES)


def test_a_character_describes_what_its_export_offers(sample: Project) -> None:
    character = Character(sample)
    assert character.tools() == list_tools(sample)
    assert character.describe() == {**list_offered_requests(sample), "words": list(WORDS)}, (
        "this one reads BML too"
    )
