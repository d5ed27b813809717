"""The web player: a folder that any static server can serve, with the character, the runtime, three.js and a
page.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
from collections.abc import Iterator
from pathlib import Path

from metagraph.engines.targets.runtimes import BML, RUNTIMES, copied, written
from metagraph.engines.targets.target import ExportOrder, ExportTarget, Loss, Made
from metagraph.formats.atomic import write_atomically

THREE = "0.187.0"  # the version the player was tested with
NET = f"https://cdn.jsdelivr.net/npm/three@{THREE}/"  # where a page finds three.js that has none of its own
NEEDED = (
    "LICENSE",
    "build/three.core.js",
    "build/three.module.js",
    "examples/jsm/controls/OrbitControls.js",
    "examples/jsm/loaders/GLTFLoader.js",
    "examples/jsm/utils/BufferGeometryUtils.js",
    "examples/jsm/utils/SkeletonUtils.js",
)


def write(order: ExportOrder) -> Made:
    """Write export, page, player, runtime and, where it can be had, three.js."""
    made = written(order)
    page = (
        (RUNTIMES / "web" / "index.html")
        .read_text(encoding="utf-8")
        .replace("EXPORT.json", f"{order.stem}.json")
    )
    files = [*copied(RUNTIMES / "web" / "player", order.folder / "player")]
    files += copied(
        RUNTIMES / "javascript", order.folder / "metagraph", leave=("conformance.mjs", "conformance.d.mts")
    )
    notes = list(made.notes)
    found = three_js(order.folder)
    if found is None:
        page = page.replace('"./three/', f'"{NET}')
        notes.append(
            "three.js is not at hand: the page loads it from the net. With npm installed, exporting again "
            "puts it beside the page"
        )
    else:
        for name in NEEDED:
            files.append(order.folder / "three" / name)
            write_atomically(files[-1], (found / name).read_bytes())
    early = [
        f'<link rel="preload" href="{order.stem}.{kind}" as="fetch" crossorigin>' for kind in ("json", "glb")
    ]
    early += [
        f'<link rel="modulepreload" href="{path.relative_to(order.folder).as_posix()}">'
        for path in files
        if path.suffix == ".js"
    ]
    page = page.replace(
        "<!-- fetch early -->", "\n    ".join(early)
    )  # else each module waits for the one that names it
    index = order.folder / "index.html"
    write_atomically(index, page.encode())
    return Made((index, *made.files, *files), tuple(notes))


def three_js(folder: Path) -> Path | None:
    """Return a folder with three.js: of a package installed above the export's or the working folder, or kept
    from before, or fetched by npm now; None where there is none.
    """
    for place in (*_installed(folder), kept()):
        if all((place / name).is_file() for name in NEEDED):
            return place
    return _fetched(kept())


def _installed(folder: Path) -> Iterator[Path]:
    for start in (folder.resolve(), Path.cwd()):
        for place in (start, *start.parents):
            yield place / "node_modules" / "three"


def kept() -> Path:
    """Return where three.js is kept between exports."""
    if sys.platform == "win32":
        home = Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local"))
    elif sys.platform == "darwin":
        home = Path.home() / "Library" / "Caches"
    else:
        home = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return home / "metagraph" / f"three-{THREE}"


def _fetched(place: Path) -> Path | None:
    """Let npm fetch three.js, and keep it; None where that cannot be."""
    npm = shutil.which("npm")
    if npm is None:
        return None
    archive = place / f"three-{THREE}.tgz"
    try:
        place.mkdir(parents=True, exist_ok=True)
        command = [npm, "pack", f"three@{THREE}", "--silent", "--fetch-retries=1", "--fetch-timeout=20000"]
        subprocess.run(command, cwd=place, check=True, capture_output=True, timeout=120)
        with tarfile.open(archive) as packed:
            for name in NEEDED:
                member = packed.extractfile(f"package/{name}")
                if member is not None:
                    write_atomically(place / name, member.read())
        archive.unlink()
    except (OSError, subprocess.SubprocessError, tarfile.TarError, KeyError):
        return None
    return place if all((place / name).is_file() for name in NEEDED) else None


TARGETS = (
    ExportTarget(
        "web",
        "Web page",
        "a folder for any static server: page, player, runtime, three.js, JSON and GLB",
        write,
        (BML, Loss("the picture: light and floor are the page's own, the motion is the same")),
        group="Played as the preview does",
    ),
)
