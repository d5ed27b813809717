"""Parameters as an export has them, and back."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from metagraph.engines import contract as c
from metagraph.graph.model import Project
from metagraph.graph.parameter import CharacterParameter, get_first_value, is_beside, is_replaced
from metagraph.graph.requests import make_request


def export_parameters(project: Project) -> dict[str, c.ExportedParameter]:
    """Return the parameters of a project, as runtimes read them."""
    return {
        name: c.ExportedParameter(
            parameter.type,
            msgspec.to_builtins(parameter.request),
            parameter.field,
            get_first_value(parameter),
            [c.ExportedChoice(choice.name, choice.value) for choice in parameter.choices],
            parameter.least,
            parameter.most,
            parameter.about,
            [key for key, other in project.parameters.items() if is_beside(parameter, other)],
            [
                key
                for key, other in project.parameters.items()
                if key != name and is_replaced(parameter, other)
            ],
        )
        for name, parameter in project.parameters.items()
    }


def read_parameters(exported: Mapping[str, c.ExportedParameter]) -> dict[str, CharacterParameter]:
    """Return the parameters of an export, as a project has them. Raises RequestError for a request that
    cannot be read.
    """
    return {
        name: msgspec.convert(
            {
                "type": one.type,
                "request": msgspec.to_builtins(make_request(one.request)),
                "field": one.field,
                "choices": [msgspec.structs.asdict(choice) for choice in one.choices],
                "least": one.least,
                "most": one.most,
                "about": one.about,
            },
            CharacterParameter,
        )
        for name, one in exported.items()
    }
