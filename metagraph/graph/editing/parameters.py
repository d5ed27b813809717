"""Edits of parameters, and what new ones may be bound to. Pure functions: a project in, a project out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from metagraph.common.wording import phrase
from metagraph.graph.checks.parameters import list_parameter_faults
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.graph.parameter import (
    CharacterParameter,
    ChoiceValue,
    is_word,
    make_parameter_choices,
    make_word,
)
from metagraph.graph.requests import (
    AnyRequest,
    Behave,
    Blink,
    Feel,
    Fidget,
    Gesture,
    Go,
    Interrupt,
    Look,
    Nod,
    Place,
    Play,
    Say,
    Shake,
)
from metagraph.graph.words import FEELINGS, MODES

MOST = 200  # parameters of a project
PARTNER = (0.0, 1.6, 1.2)  # metres: where a partner stands until a game says otherwise


@dataclass(frozen=True)
class OfferedParameter:
    """A parameter that can be added. group: "state" for what lasts, "gesture", "action" or "line" for
    triggers. words: what it sets, in words; of an action or a line its own name. name: what it is called at
    first. under: of an action, the layer and the stance that it is in.
    """

    group: str
    words: str
    name: str
    parameter: CharacterParameter
    under: tuple[str, str] = ("", "")


def add_parameter(project: Project, name: str, parameter: CharacterParameter) -> tuple[Project, str]:
    """Return the project with another parameter, and its name, which gets a number if it is taken. Raises
    EditError for one that cannot work.
    """
    if len(project.parameters) >= MOST:
        raise EditError(phrase("A project has at most {most} parameters. Remove one first.", most=MOST))
    found = make_word(name, project.parameters)
    return set_parameter(project, found, parameter), found


def set_parameter(project: Project, name: str, parameter: CharacterParameter) -> Project:
    """Return the project with a parameter as given. Raises EditError for one that cannot work."""
    for fault in list_parameter_faults(project, name, parameter):
        raise EditError(phrase("{message}. {remedy}", message=fault.message, remedy=fault.remedy))
    return replace(project, parameters={**project.parameters, name: parameter})


def rename_parameter(project: Project, name: str, new: str) -> Project:
    """Return the project with another name for a parameter, at the same place. Raises EditError if it is
    taken or cannot be a name in game code.
    """
    if new == name:
        return project
    if not is_word(new):
        raise EditError(
            phrase(
                "'{name}' cannot be a name in game code. Use small letters a to z and digits, and "
                "underscores between words that begin with a letter: walk_speed.",
                name=new,
            )
        )
    if new in project.parameters:
        raise EditError(phrase("There is a parameter '{name}' already.", name=new))
    renamed = {new if key == name else key: value for key, value in project.parameters.items()}
    return replace(project, parameters=renamed)


def remove_parameter(project: Project, name: str) -> Project:
    """Return the project without a parameter."""
    return replace(project, parameters={k: x for k, x in project.parameters.items() if k != name})


def list_offered_parameters(project: Project) -> list[OfferedParameter]:
    """Return what new parameters can be bound to in a project, with names and values to begin with."""
    out = [*_list_states(project)]
    plain: tuple[tuple[str, str, AnyRequest], ...] = (
        ("gesture", phrase("Any gesture"), Gesture()),
        ("fidget", phrase("Any fidget"), Fidget()),
    )
    for word, any_words, request in plain:
        if any(x.kind == word and x.layer == "arms" for x in project.actions()):
            out.append(_make_trigger("gesture", any_words, word, request))
    tags = {tag: None for x in _list_gestures(project, "arms") for tag in x.tags}
    out += [_make_trigger("gesture", phrase("Gesture: {tag}", tag=t), t, Gesture(tags=(t,))) for t in tags]
    for word, head, words in (("nod", Nod(), phrase("Nod")), ("shake", Shake(), phrase("Shake the head"))):
        if any(word in x.tags or word in x.name.lower() for x in _list_gestures(project, "head")):
            out.append(_make_trigger("gesture", words, word, head))
    out.append(_make_trigger("gesture", phrase("Blink"), "blink", Blink()))
    if project.lines:
        out.append(_make_trigger("line", phrase("Break off what is said"), "interrupt", Interrupt()))
    for action in project.actions():
        if action.kind in ("gesture", "fidget"):
            play = Play(action=action.id, layer=action.layer)
            stance = project.stance(action.stance)
            under = (action.layer, stance.name if stance is not None else "")
            out.append(replace(_make_trigger("action", action.name, action.name, play), under=under))
    for ident, line in project.lines.items():
        text = line.text or ident
        short = text if len(text) <= 60 else f"{text[:57]}…"
        out.append(_make_trigger("line", short, f"say_{' '.join(text.split()[:4])}", Say(line=ident)))
    return out


def _make_trigger(group: str, words: str, name: str, request: AnyRequest) -> OfferedParameter:
    return OfferedParameter(
        group, words, make_word(name, (), "play"), CharacterParameter(type="trigger", request=request)
    )


def _list_states(project: Project) -> Iterable[OfferedParameter]:
    """Return what lasts until a game sets it again."""
    moods: list[tuple[str, ChoiceValue]] = [(mood, mood) for mood in FEELINGS]
    yield _make_enum(phrase("Mood"), "mood", Feel(mood="neutral"), "mood", moods)
    energy = Feel(intensity=project.life.intensity)
    yield OfferedParameter(
        "state",
        phrase("Energy: how large gestures are"),
        "energy",
        CharacterParameter(type="number", request=energy, field="intensity", most=2.0),
    )
    names = dict.fromkeys(("user", "ahead", *project.points))
    partner: list[tuple[str, ChoiceValue]] = [("partner" if x == "user" else x, x) for x in names]
    yield _make_enum(phrase("What it looks at"), "looks_at", Look(), "to", partner)
    yield OfferedParameter(
        "state",
        phrase("Attention: how far it turns to what it looks at"),
        "attention",
        CharacterParameter(type="number", request=Look(), field="amount"),
    )
    yield OfferedParameter(
        "state",
        phrase("Where its partner is"),
        "partner",
        CharacterParameter(type="point", request=Place(name="user", point=PARTNER), field="point"),
    )
    modes: list[tuple[str, ChoiceValue]] = [("automatic", None), *((mode, mode) for mode in MODES)]
    yield _make_enum(phrase("What it does: idle, listening, talking"), "mode", Behave(), "mode", modes)
    for name, mode in (("speaking", "talking"), ("listening", "listening")):
        switch = make_parameter_choices([("off", None), ("on", mode)])
        words = phrase("Whether it speaks") if name == "speaking" else phrase("Whether it listens")
        yield OfferedParameter(
            "state",
            words,
            name,
            CharacterParameter(type="boolean", request=Behave(), field="mode", choices=switch),
        )
    for layer in LAYERS:
        yield from _list_stances(project, layer)
    tags = dict.fromkeys(tag for x in _list_gestures(project, "arms") for tag in x.tags)
    if tags:
        yield OfferedParameter(
            "gesture",
            phrase("A gesture with these tags"),
            "gesture_with",
            CharacterParameter(
                type="list",
                request=Gesture(),
                field="tags",
                choices=make_parameter_choices((t, t) for t in tags),
            ),
        )


_STANCES: Mapping[Layer, str] = {
    "body": phrase("Stance of the body"),
    "arms": phrase("Stance of the arms"),
    "head": phrase("Stance of the head"),
}


def _list_stances(project: Project, layer: Layer) -> Iterable[OfferedParameter]:
    graph = project.graphs[layer]
    if graph.stances:
        start = graph.start if graph.start in graph.stances else next(iter(graph.stances))
        found: list[tuple[str, ChoiceValue]] = [(s.name, s.id) for s in graph.stances.values()]
        request = Go(stance=str(start), layer=layer, stay=True)
        yield _make_enum(_STANCES[layer], f"{layer}_stance", request, "stance", found)


def _make_enum(
    words: str, name: str, request: AnyRequest, field: str, pairs: Iterable[tuple[str, ChoiceValue]]
) -> OfferedParameter:
    return OfferedParameter(
        "state",
        words,
        name,
        CharacterParameter(type="enum", request=request, field=field, choices=make_parameter_choices(pairs)),
    )


def _list_gestures(project: Project, layer: Layer) -> Iterable[Action]:
    return (x for x in project.graphs[layer].actions.values() if x.kind == "gesture")
