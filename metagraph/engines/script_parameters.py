"""Parameters that are set one after another, and the requests that come of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import msgspec

from metagraph.engines.export_parameters import export_parameters
from metagraph.graph.model import Project
from metagraph.graph.parameter import ParameterValues, fill_in
from metagraph.graph.requests import RequestError


def list_settings(project: Project) -> list[dict[str, Any]]:
    """Return values that parameters are set to, and what becomes of it: what they may be, just what they may
    not, and twice the same.
    """
    out: list[tuple[str, Any]] = []
    for name, one in project.parameters.items():
        names = [choice.name for choice in one.choices]
        match one.type:
            case "number":
                values: list[Any] = [
                    one.least,
                    one.least,
                    0.5 * (one.least + one.most),
                    one.most + 1.0,
                    one.least - 1.0,
                ]
                values += ["1", None, True]
            case "boolean":
                values = [True, True, False, 1, None, "true"]
            case "enum":
                values = [*names, names[-1], "no such word", 0, None]
            case "list":
                values = [
                    names[:1],
                    names[:1],
                    names[::-1],
                    [],
                    [*names, "no such word"],
                    names[0],
                    [0],
                    None,
                ]
            case "point":
                values = [
                    [0.5, 1.5, 1.0],
                    [0.5, 1.5, 1.0],
                    [0.5, 1.5, 2.0],
                    [1e6, -1e6, 0.0],
                    [1e6 + 1, 0.0, 0.0],
                ]
                values += [[0.0, 1.0], [0.0, 1.0, 2.0, 3.0], [0.0, 1.0, "2"], "here", None]
            case _:
                values = [None, None, 1.0, False]
        out += [(name, value) for value in values]
    for (
        name,
        one,
    ) in project.parameters.items():  # once more, so that others are set beside them, or were replaced
        if one.type != "trigger":
            out += [(name, value) for before, value in out if before == name][:1]
    return run_settings(project, [*out, ("no_such_parameter", 1.0)]) if out else []


def run_settings(project: Project, pairs: Sequence[tuple[str, Any]]) -> list[dict[str, Any]]:
    """Return what becomes of each name and value: `request`, null where there is none; `wrong`, why; `now`,
    the values of all parameters then.
    """
    exported = {name: msgspec.to_builtins(one) for name, one in export_parameters(project).items()}
    values = ParameterValues()
    out: list[dict[str, Any]] = []
    for name, value in pairs:
        request: dict[str, Any] | None = None
        wrong = ""
        if not values.has(project.parameters, name, value):
            try:
                values.take(project.parameters, name, value)
                values.made[name] = name
                shown = [x for x in (name, *exported[name].get("beside", ())) if x in values.values]
                fields = {
                    exported[x]["field"]: fill_in(project.parameters[x], values.values[x]) for x in shown
                }
                request = {**exported[name]["request"], **msgspec.to_builtins(fields)}
            except RequestError as error:
                wrong = str(error)
        now = {each: values.get(project.parameters, each) for each in project.parameters}
        out.append({"name": name, "value": value, "request": request, "wrong": wrong, "now": now})
    return out
