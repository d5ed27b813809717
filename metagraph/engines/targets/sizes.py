"""How large an export becomes: it is written into a folder of its own, which is removed again."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

from metagraph.engines.targets.registry import write_for_target
from metagraph.engines.targets.target import Contents, Tell
from metagraph.engines.targets.web_tools import read_three
from metagraph.graph.model import Project


@dataclass(frozen=True)
class ExportSize:
    """What an export is made of. bytes: of all files. glb: of its largest GLB, 0 without one."""

    files: int
    bytes: int
    glb: int


def measure_export(
    project: Project, name: str, contents: Contents, tell: Tell | None = None
) -> ExportSize | None:
    """Return the size of a project's export for a target; None for a page whose tools would have to be
    fetched first. Raises what `write_for_target` raises.
    """
    if name == "web" and read_three() is None:
        return None
    with tempfile.TemporaryDirectory(prefix="metagraph-size-") as scratch:
        report = write_for_target(project, name, Path(scratch) / "export", contents, tell)
        sizes = [path.stat().st_size for path in report.files]
        glbs = [path.stat().st_size for path in report.files if path.suffix == ".glb"]
    return ExportSize(len(sizes), sum(sizes), max(glbs, default=0))
