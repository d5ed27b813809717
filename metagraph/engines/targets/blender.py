"""Blender: the export, and the add-on that reads it, as the archive that Blender installs."""

from __future__ import annotations

import io
import zipfile

from metagraph.common.wording import phrase
from metagraph.engines.targets.runtimes import RUNTIMES, write_with_sounds
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.formats.atomic import write_atomically

ADDON = "metagraph_blender"


def write(order: ExportOrder) -> ExportedFiles:
    """Write the export and the archive, each time the same."""
    made = write_with_sounds(order)
    page, archive = order.folder / "README.md", order.folder / f"{ADDON}.zip"
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as out:
        for path in sorted((RUNTIMES / "blender" / ADDON).glob("*.*")):
            out.writestr(zipfile.ZipInfo(f"{ADDON}/{path.name}"), path.read_bytes(), zipfile.ZIP_DEFLATED)
    write_atomically(archive, content.getvalue())
    write_atomically(page, (RUNTIMES / "blender" / "README.md").read_bytes())
    return ExportedFiles((archive, page, *made.files), made.notes)


TARGETS = (
    ExportTarget(
        "blender",
        phrase("Blender add-on"),
        phrase(
            "JSON, GLB and the add-on, which reads them, labels actions, sends them back and "
            "follows a live session"
        ),
        write,
        (
            Loss(
                phrase(
                    "no planner: Blender shows single actions; it shows a whole performance only live or "
                    "from a bake"
                )
            ),
        ),
    ),
)
