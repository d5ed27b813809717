"""Find what hands touch, in all actions that move the arms: on a thread, and added in one step."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import msgspec

from app.project.jobs import WindowJob
from app.translation import tr, tr_error, tr_plural
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project
from metagraph.graph.touch import Touch
from metagraph.motion.contact_spans import ContactSpan

if TYPE_CHECKING:
    from app.shell.context import Shell

Found = tuple[Touch, dict[str, tuple[ContactSpan, ...]]]


def find_hand_contacts(shell: Shell) -> None:
    """Find the contacts of all actions that move the arms, and keep them. A body that was measured before
    keeps its measures.
    """
    document = shell.document
    project, folder = document.project, document.folder

    def work(job: WindowJob) -> Found | None:
        from metagraph.formats.gltf.reader import read_character
        from metagraph.suggest.find_contacts import find_contacts, list_contact_actions, with_measured_body

        measured = project
        if not project.touch.parts:
            path = (
                folder / project.character if folder is not None and project.character is not None else None
            )
            measured = with_measured_body(
                project, read_character(path) if path is not None and path.is_file() else None
            )
        found: dict[str, tuple[ContactSpan, ...]] = {}
        wanted = list_contact_actions(measured)
        for n, ident in enumerate(wanted):
            action = measured.action(ident)
            if job.cancelled or action is None:
                return None
            job.tell(n, len(wanted), action.name)
            found[ident] = find_contacts(measured, action)
        return measured.touch, found

    def done(found: Found | None) -> None:
        if found is None:
            return
        try:
            document.edit(tr("Find hand contacts"), lambda p: _with_found(p, found))
        except EditError as error:
            shell.tell(tr_error(error))
            return
        spans = [len(some) for some in found[1].values() if some]
        shell.tell(
            tr(
                "{contacts} in {actions}. Shift+J marks them in the view.",
                contacts=tr_plural("{count:,} contact", "{count:,} contacts", sum(spans)),
                actions=tr_plural("{count:,} action", "{count:,} actions", len(spans)),
            )
            if spans
            else tr("No hand touches the body in any action.")
        )

    shell.jobs.start(tr("Finding hand contacts"), work, done, lambda error: shell.tell(tr_error(error)))


def _with_found(project: Project, found: Found) -> Project:
    """Return the project with contacts, but of actions that were removed in the meantime."""
    touch, spans = found
    changes = {i: {"contacts": some} for i, some in spans.items() if project.action(i) is not None}
    now = msgspec.structs.replace(project.touch, parts=touch.parts)
    return edits.update_each(replace(project, touch=now), changes)
