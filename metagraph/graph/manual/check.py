"""Problems of manual state machines: what cannot be reached or left, and numbers that do not fit their
clips.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from metagraph.common.wording import phrase
from metagraph.graph import anatomy
from metagraph.graph.manual.machine import ANY, Alias, Link, Manual, State
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.problem import Problem, Severity


def check_manual(project: Project) -> list[Problem]:
    """Return the problems of every layer's machine, in the order of the project."""
    out: list[Problem] = []
    for layer in LAYERS:
        if layer in project.manual:
            out += _machine(project, project.manual[layer])
    return out


def _machine(project: Project, manual: Manual) -> Iterator[Problem]:
    layer = manual.layer
    if manual.states and manual.start not in manual.states:
        yield Problem(
            "error",
            "no-start",
            phrase("the {layer} layer has no start state", layer=phrase(layer)),
            phrase("Right-click a state and choose 'Start here'."),
            layer,
        )
    reached = manual.reachable()
    for state in manual.states.values():

        def at(severity: Severity, code: str, message: str, remedy: str, of: State = state) -> Problem:
            return Problem(
                severity,
                code,
                phrase("state '{name}' {message}", name=of.name, message=message),
                remedy,
                layer,
                clip=of.clip,
                state=of.id,
            )

        yield from _state(project, state, at)
        if reached and state.id not in reached:
            yield at(
                "warning",
                "unreachable",
                phrase("cannot be reached"),
                phrase("Draw a link to it from a state that can be reached."),
            )
        ways = [x for x in manual.leaving(state.id) if x.target != state.id]
        if not ways and len(manual.states) > 1:
            if state.loop:
                yield at(
                    "warning",
                    "no-exit",
                    phrase("loops forever: no link leads out of it"),
                    phrase("Draw a link from it to another state."),
                )
            else:
                yield at(
                    "warning",
                    "dead-end",
                    phrase("has no way out: it holds its last frame"),
                    phrase("Draw a link from it to another state."),
                )
        elif ways and not state.loop and not any(x.condition.when == "finished" for x in ways):
            message = phrase("holds its last frame until something is requested")
            yield at(
                "hint", "waits", message, phrase("Set one of its links to fire when the state has finished.")
            )
    for alias in manual.aliases.values():
        yield from _alias(manual, alias)
    seen: set[tuple[str, str, str, str]] = set()
    for link in manual.links.values():
        yield from _link(project, manual, link)
        same = (link.source, link.target, link.condition.when, link.condition.trigger)
        if same in seen:
            yield _about(
                manual, link, "warning", "twice", phrase("is drawn twice"), phrase("Remove one of them.")
            )
        seen.add(same)


def _state(
    project: Project, state: State, at: Callable[[Severity, str, str, str], Problem]
) -> Iterator[Problem]:
    entry = project.clips.get(state.clip)
    if entry is None:
        yield at(
            "error",
            "lost-clip",
            phrase("uses a clip that is not in the project"),
            phrase("Remove it, or import the clip again."),
        )
        return
    end = entry.duration if state.end is None else state.end
    latest = entry.duration + 0.5 / entry.fps
    if not (0 <= state.start <= latest and end <= latest):  # also where one of them is not a number
        message = phrase(
            "plays {start:.2f} to {end:.2f} s, but its clip is {duration:.2f} s long",
            start=state.start,
            end=end,
            duration=entry.duration,
        )
        yield at("error", "trim", message, phrase("Move start and end inside the clip."))
    elif end <= state.start and entry.frames > 1:
        message = phrase(
            "ends at {end:.2f} s, which is not after its start at {start:.2f} s", end=end, start=state.start
        )
        yield at("error", "empty", message, phrase("Move its end after its start."))
    if unknown := anatomy.list_unknown_joints(project.skeleton, state):
        message = phrase("moves joint '{unknown}', which the skeleton does not have", unknown=unknown[0])
        yield at("error", "mask", message, phrase("Choose its joints again."))


def _alias(manual: Manual, alias: Alias) -> Iterator[Problem]:
    def at(severity: Severity, code: str, message: str, remedy: str) -> Problem:
        return Problem(
            severity,
            code,
            phrase("alias '{name}' {message}", name=alias.name, message=message),
            remedy,
            manual.layer,
            state=alias.id,
        )

    used = alias.id in manual.out or alias.id in manual.into
    if not manual.members(alias):
        yield at(
            "warning" if used else "hint",
            "alias-empty",
            phrase("contains no states"),
            phrase("Choose its states."),
        )
    elif not used:
        yield at("hint", "alias-unused", phrase("has no links"), phrase("Draw a link from it, or remove it."))
    if alias.entry is not None and alias.entry not in manual.members(alias):
        name = manual.states[alias.entry].name if alias.entry in manual.states else phrase("a missing state")
        yield at(
            "warning",
            "alias-entry",
            phrase("is entered at '{name}', which is not one of its states", name=name),
            phrase("Choose another entry state."),
        )


def _about(manual: Manual, link: Link, severity: Severity, code: str, message: str, remedy: str) -> Problem:
    source, target = manual.states.get(link.source), manual.states.get(link.target)
    aliases = manual.aliases
    names = " → ".join(
        found.name if found is not None else aliases[ident].name if ident in aliases else otherwise
        for found, ident, otherwise in (
            (source, link.source, phrase("any state")),
            (target, link.target, "?"),
        )
    )
    return Problem(
        severity,
        code,
        phrase("link {names} {message}", names=names, message=message),
        remedy,
        manual.layer,
        link=link.id,
    )


def _link(project: Project, manual: Manual, link: Link) -> Iterator[Problem]:
    def at(severity: Severity, code: str, message: str, remedy: str) -> Problem:
        return _about(manual, link, severity, code, message, remedy)

    if link.condition.when == "request" and not link.condition.trigger.strip():
        yield at(
            "error", "no-trigger", phrase("waits for a request without a name"), phrase("Name its trigger.")
        )
    if not link.condition.weight > 0:
        yield at(
            "error",
            "weight",
            phrase("has weight {weight:g} and is never taken", weight=link.condition.weight),
            phrase("Set it to more than 0."),
        )
    if not link.blend >= 0:
        yield at(
            "error",
            "blend",
            phrase("has a blend of {blend:g} s", blend=link.blend),
            phrase("Set its blend to 0 or more."),
        )
    if manual.end(link) is None:
        yield at(
            "error",
            "no-entry",
            phrase("leads to an alias without an entry state"),
            phrase("Choose the alias's entry state."),
        )
    if link.source == ANY and link.condition.when == "finished":
        yield at(
            "warning",
            "any-finished",
            phrase("is taken every time any state finishes"),
            phrase("Make it wait for a request."),
        )
    source = manual.states.get(link.source)
    entry = project.clips.get(source.clip) if source is not None else None
    if source is None or entry is None:
        return
    start, end = (
        max(0.0, source.start),
        entry.duration if source.end is None else min(source.end, entry.duration),
    )
    if link.exit_time is not None and not start <= link.exit_time <= end + 0.5 / entry.fps:
        message = phrase(
            "can be taken from {exit_time:.2f} s, outside the part that '{name}' plays",
            exit_time=link.exit_time,
            name=source.name,
        )
        yield at(
            "warning",
            "exit",
            message,
            phrase("Move it between {start:.2f} and {end:.2f} s.", start=start, end=end),
        )
    elif link.blend > end - start > 0 and not source.loop:
        yield at(
            "warning",
            "blend",
            phrase(
                "blends for {blend:.2f} s, but only {plays:.2f} s play", blend=link.blend, plays=end - start
            ),
            phrase("Shorten its blend."),
        )
