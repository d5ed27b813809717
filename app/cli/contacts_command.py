"""`metagraph contacts`: find where hands touch the body in a project's actions, and write it down."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.command_output import open_for_command, say
from app.cli.outputs import ProjectOutput, with_project_ending
from metagraph.formats.outputs import claim, note_written

if TYPE_CHECKING:
    pass


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "-o", "--out", type=Path, help="the project to write (default: the project that is read)"
    )
    parser.add_argument("--list", action="store_true", help="list the contacts without writing anything")
    parser.add_argument("--clear", action="store_true", help="remove the contacts of all actions")
    parser.add_argument(
        "--action",
        action="append",
        default=[],
        metavar="NAME",
        help="only this action, by name or id; repeat for more",
    )
    parser.add_argument(
        "--contacts", choices=("on", "off"), help="keep contacts while the character plays, or not"
    )
    parser.add_argument(
        "--guard",
        choices=("on", "off"),
        help="keep hands out of the body while the character plays, or not",
    )


def run(options: Namespace) -> int:
    """Find contacts, measure the body, and write the project."""
    if options.list:
        return _found(options, None)
    out = options.project if options.out is None else with_project_ending(options.out)
    if not (out.exists() and out.samefile(options.project)):
        claim(out)
        with ProjectOutput(out) as output:
            code = _found(options, output)
        note_written(out)
        return code
    with ProjectOutput(out) as output:
        return _found(options, output)


def _found(options: Namespace, output: ProjectOutput | None) -> int:
    """output: the path at which the project is saved, or None."""
    import msgspec

    from metagraph.formats.gltf.reader import read_character
    from metagraph.graph import edits
    from metagraph.suggest.find_contacts import list_contact_actions, with_contacts, with_measured_body

    project = open_for_command(options.project)
    chosen = [a for a in project.actions() if not options.action or {a.id, a.name} & set(options.action)]
    if options.action and not chosen:
        raise ValueError(f"there is no action {' or '.join(map(repr, options.action))}")
    idents = [a.id for a in chosen]
    if options.clear:
        project = edits.update_actions(project, idents, contacts=())
    else:
        mesh = options.project.parent / project.character if project.character is not None else None
        project = with_measured_body(
            project, read_character(mesh) if mesh is not None and mesh.exists() else None
        )
        moving = set(list_contact_actions(project))
        project = with_contacts(project, [ident for ident in idents if ident in moving])
    changes = {n: getattr(options, n) == "on" for n in ("contacts", "guard") if getattr(options, n)}
    project = replace(project, touch=msgspec.structs.replace(project.touch, **changes))
    found = [(a, s) for i in idents if (a := project.action(i)) is not None for s in a.contacts]
    rows = [
        {"action": a.id, "name": a.name, "hand": s.hand, "place": s.place, "to": s.to}
        | {"start": s.start, "end": s.end}
        for a, s in found
    ]
    lines = [f"{a.name}: {s.hand} {s.place} on {s.to} from {s.start:.2f} to {s.end:.2f} s" for a, s in found]
    if output is not None:
        output.save(project, options.project)
    count = len({a.id for a, _ in found})
    say(options, "\n".join([*lines, f"{len(found)} contacts in {count} actions"]), {"contacts": rows})
    return 0
