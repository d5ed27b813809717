"""What a web page needs that is not ours: three.js, and esbuild, which puts modules into one small file.

Both are MIT-licensed and come from the npm registry: installed above the export's or the working folder, or
kept from an earlier export, or fetched by npm now. Without them a page is whole, too: it loads three.js from
the net.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from metagraph.disk_cache import cache_folder

THREE, ESBUILD = "0.187.0", "0.25.12"  # the versions the player was tested with
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
LONGEST = 120.0  # seconds that fetching, and bundling, may take


def tools(folder: Path) -> Path | None:
    """Return a `node_modules` that has three.js, and esbuild if any has; None where there is none and npm
    does not fetch it.
    """
    place = kept()
    places = [*_installed(folder), *([place / "node_modules"] if place is not None else [])]
    known = [place for place in places if has_three(place)]
    whole = [place for place in known if esbuild(place) is not None]
    if whole:
        return whole[0]
    return (_fetched(place) if place is not None else None) or (known[0] if known else None)


def has_three(modules: Path) -> bool:
    return all((modules / "three" / name).is_file() for name in NEEDED)


def esbuild(modules: Path) -> Path | None:
    """Return esbuild's program, which is one of several packages, by system."""
    name = "esbuild.exe" if sys.platform == "win32" else "bin/esbuild"
    return next((found for found in sorted(modules.glob(f"@esbuild/*/{name}")) if found.is_file()), None)


def bundled(modules: Path, entry: Path) -> bytes | None:
    """Return a module with all it imports, three.js too, as one minified file; None where that cannot be."""
    modules = modules.resolve()
    program = esbuild(modules)
    if program is None:
        return None
    command = [
        str(program), str(entry), "--bundle", "--minify", "--format=esm", "--target=es2022", "--charset=utf8",
        "--legal-comments=inline", "--log-level=error",
        f"--alias:three/addons={(modules / 'three' / 'examples' / 'jsm').as_posix()}",
        f"--alias:three={(modules / 'three' / 'build' / 'three.module.js').as_posix()}",
    ]  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.js"
        try:
            subprocess.run([*command, f"--outfile={out}"], check=True, capture_output=True, timeout=LONGEST)
            return out.read_bytes()
        except (OSError, subprocess.SubprocessError):
            return None


def kept() -> Path | None:
    """Return where they are kept between exports; None where nobody's home is known."""
    return cache_folder(f"web-{THREE}-{ESBUILD}")


def _installed(folder: Path) -> Iterator[Path]:
    for start in (folder.resolve(), Path.cwd()):
        for place in (start, *start.parents):
            yield place / "node_modules"


def _fetched(place: Path) -> Path | None:
    """Let npm fetch both, and keep them; None where that cannot be."""
    npm = shutil.which("npm")
    if npm is None:
        return None
    options = ("--no-audit", "--no-fund", "--no-package-lock", "--silent", "--ignore-scripts")
    wait = ("--fetch-retries=1", "--fetch-timeout=20000")
    try:
        place.mkdir(parents=True, exist_ok=True)
        command = [
            npm,
            "install",
            "--prefix",
            str(place),
            *options,
            *wait,
            f"three@{THREE}",
            f"esbuild@{ESBUILD}",
        ]
        subprocess.run(command, cwd=place, check=True, capture_output=True, timeout=LONGEST)
    except (OSError, subprocess.SubprocessError):
        return None
    return place / "node_modules" if has_three(place / "node_modules") else None
