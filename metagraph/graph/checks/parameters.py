"""Problems of parameters: what they are bound to is no longer there, or can never have been."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from metagraph.common.wording import phrase
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.parameter import FIELDS, TRIGGERS, CharacterParameter, ChoiceValue, is_word
from metagraph.graph.problem import Problem
from metagraph.graph.requests import (
    AnyRequest,
    Fidget,
    Gesture,
    Go,
    Look,
    Nod,
    Play,
    RequestError,
    Say,
    Shake,
    make_request,
)

REBIND = phrase("Remove the parameter in the panel 'Parameters', or add it again.")


def check_parameters(project: Project) -> Iterator[Problem]:
    """Yield an error for each parameter that a game could not set."""
    for name, parameter in project.parameters.items():
        yield from list_parameter_faults(project, name, parameter)


def list_parameter_faults(project: Project, name: str, parameter: CharacterParameter) -> list[Problem]:
    """Return what is wrong with a parameter: first what its own fields say, else what it is bound to."""
    own = list(_list_own(name, parameter))
    return own or list(_list_missing(project, name, parameter))


def _make_fault(message: str, remedy: str = REBIND) -> Problem:
    return Problem("error", "parameter", message, remedy)


def _list_own(name: str, parameter: CharacterParameter) -> Iterator[Problem]:
    """Yield what is wrong with the fields themselves, as in a file that was edited by hand."""
    words = [choice.name for choice in parameter.choices]
    for word in (name, *words):
        if not is_word(word):
            yield _make_fault(
                phrase("parameter '{name}': '{word}' cannot be a name in game code", name=name, word=word),
                phrase("Rename it: small letters a to z, digits, and underscores between words."),
            )
    if len(set(words)) < len(words):
        yield _make_fault(
            phrase("parameter '{name}': two choices have the same name", name=name),
            phrase("Rename one of them in the panel 'Parameters'."),
        )
    bound = (parameter.does, parameter.field)
    fits = (
        parameter.does in TRIGGERS and not parameter.field
        if parameter.type == "trigger"
        else bound in FIELDS[parameter.type]
    )
    needed = {"boolean": 2, "enum": 1, "list": 1}.get(parameter.type, 0)
    enough = len(words) == needed if parameter.type == "boolean" else len(words) >= needed
    if not fits or not enough or (parameter.type == "number" and not parameter.least < parameter.most):
        yield _make_fault(
            phrase(
                "parameter '{name}': its type does not fit its request, field, range or choices", name=name
            )
        )
        return
    for value in _list_values(parameter):
        try:
            _fill(parameter, value)
        except RequestError as error:
            yield _make_fault(phrase("parameter '{name}': {error}", name=name, error=str(error)))


def _list_values(parameter: CharacterParameter) -> list[ChoiceValue | list[ChoiceValue]]:
    """Return what may be put into the request's field: each choice, or both ends of a range."""
    if parameter.type == "number":
        return [parameter.least, parameter.most]
    if parameter.type == "list":
        return [[choice.value] for choice in parameter.choices]
    return [choice.value for choice in parameter.choices]


def _fill(parameter: CharacterParameter, value: ChoiceValue | list[ChoiceValue]) -> AnyRequest:
    return make_request(msgspec.to_builtins(parameter.request) | {parameter.field: value})


def _list_missing(project: Project, name: str, parameter: CharacterParameter) -> Iterator[Problem]:
    """Yield what a parameter is bound to that the project does not have."""
    if parameter.type not in ("enum", "boolean", "list"):
        if (missing := _find_missing(project, parameter.request)) is not None:
            yield _make_fault(phrase("parameter '{name}': {missing}", name=name, missing=missing))
        return
    values = _list_values(parameter)
    for choice, value in zip(parameter.choices, values, strict=True):
        missing = _find_missing(project, _fill(parameter, value))
        if missing is not None:
            yield _make_fault(
                phrase(
                    "parameter '{name}', choice '{choice}': {missing}",
                    name=name,
                    choice=choice.name,
                    missing=missing,
                ),
                phrase("Remove the choice in the panel 'Parameters', or choose what it stands for again."),
            )


def _find_missing(project: Project, request: AnyRequest) -> str | None:
    """Return in words what a request needs and the project does not have, or None."""
    if isinstance(request, Go):
        layers = LAYERS if request.layer is None else (request.layer,)
        stances = [s for layer in layers for s in project.graphs[layer].stances.values()]
        if not any(request.stance in (s.id, s.name) for s in stances):
            return phrase("its stance is no longer in the project")
    if isinstance(request, Play):
        layers = LAYERS if request.layer is None else (request.layer,)
        actions = [x for layer in layers for x in project.graphs[layer].actions.values()]
        if not any(request.action in (x.id, x.name) for x in actions):
            return phrase("its action is no longer in the project")
    if isinstance(request, Say) and request.line is not None and str(request.line) not in project.lines:
        return phrase("its line is no longer in the project")
    if isinstance(request, Look) and isinstance(request.to, str):
        known = ("user", "ahead", *project.points)
        if request.to not in known:
            return phrase("the project has no point '{point}'", point=request.to)
    if isinstance(request, Gesture | Fidget):
        kind = "gesture" if isinstance(request, Gesture) else "fidget"
        found = [x for x in project.graphs[request.layer].actions.values() if x.kind == kind]
        if not any(set(request.tags) <= set(x.tags) for x in found):
            tags = ", ".join(request.tags)
            return (
                phrase("no action has the tag '{tag}' any more", tag=tags)
                if tags
                else phrase("the layer {layer} has no such action", layer=phrase(request.layer))
            )
    if isinstance(request, Nod | Shake):
        word = "nod" if isinstance(request, Nod) else "shake"
        head = [x for x in project.graphs["head"].actions.values() if x.kind == "gesture"]
        if not any(word in x.tags or word in x.name.lower() for x in head):
            return phrase("no gesture of the head has the tag '{tag}'", tag=word)
    return None
