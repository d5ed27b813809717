"""Clips of other skeletons: asked about when they are imported, and their joint maps changed later."""

from __future__ import annotations

from app.features.retargeting.import_retargeting import Retargeting
from app.project.files import Files
from app.project.importing import Importing
from app.shell.actions import Command
from app.shell.context import Contribution, Shell
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    document, session = shell.document, shell.stage.session
    retargeting = shell.services.add(Retargeting(document, shell.jobs, shell.widget))
    retargeting.told.connect(shell.tell)
    retargeting.failed.connect(shell.services[Files].show_failure)
    shell.services[Importing].retarget = retargeting.ask
    shell.services[Importing].bring = retargeting.bring
    return Contribution(
        commands=(
            Command(
                "joint_maps",
                "&Graph",
                "skeleton",
                tr("&Joint maps…"),
                lambda: retargeting.change_maps(session.selection.clips),
                tip=tr("Show and change how clips of other skeletons were retargeted"),
                enabled=lambda: bool(document.project.joint_maps),
            ),
        ),
    )
