"""What a web page needs that is not ours: three.js, and esbuild, which puts modules into one small file.

Both are MIT-licensed. npm fetches them once into a folder of Metagraph's own, and each use compares them with
the digests below, so that nothing else is run or shown, whatever lies around the project, the export or the
working folder. Without them a page is whole, too: it loads the same three.js from the net, and the browser
compares that with the same digests.
"""

from __future__ import annotations

import base64
import hashlib
import json
import platform
import sys
import tempfile
from pathlib import Path

from metagraph.common import programs
from metagraph.common.disk_cache import cache_folder

THREE, ESBUILD = "0.187.0", "0.25.12"  # the versions the player was tested with
NET = f"https://cdn.jsdelivr.net/npm/three@{THREE}/"  # where a page finds three.js that has none of its own
# SHA-384 of three's files, and of esbuild's program for each system, as pages say it.
NEEDED = {
    "LICENSE": "dZIEXnc8kDiJUEWlKdsN+V7yvZT/HbLEL7IFgYWNSRkA0ErUhU5jIL71XpYCHvDY",
    "build/three.core.js": "drH6BueSlcvoXCwAqWkNJvXwu2Ax3mnGOmZnIXaomedIw+uXSP9Bf/XIUINgLUW+",
    "build/three.module.js": "T/E3B9AvPtLn5PKD7aTSFqizQcA4kHDfU0lub7u0fvM4w9BMGcSb3yI7r5LqMAMn",
    "examples/jsm/controls/OrbitControls.js": "ZVBN/wmVxgX0mUGjFJXakzzdZrAF4g4aHfKyusbjoF0WsVXSoGpeM/qRaVnXtaFo",  # noqa: E501
    "examples/jsm/loaders/GLTFLoader.js": "WH6tljjFikpYMGa2JMqlbJlM1lEMkd/Y6Sqnuog1rX87eShphltUQI5NKByEo4CP",
    "examples/jsm/utils/BufferGeometryUtils.js": "NArny884Zj3HwjLRjeY1kbfLZnAHIElzho3N71FW0eMGxxBT+QuLEiSnSgpSaBXh",  # noqa: E501
    "examples/jsm/utils/SkeletonUtils.js": "Pozn8j5+YFr3ak8Pm90ayqDrGYn/DV7vVs/YIIqzJhzeJT0LQksoS1fZQ5lfsYlw",
}
PROGRAMS = {
    "linux-x64": "0GkCjwY+vbc0c0lc0QlT1qYb+Z0BkKm9IRzTaBGgaqE7umwL6yvPC53YX6ODe/0x",
    "linux-arm64": "KrWmkGpsTed2LrWmFMYM4wWasCPNB1QBgj4cwZl8aICwuSszNZiTe9DM9EEzRA+M",
    "darwin-x64": "Xuz+A8Lc6YnDF6PIKi56tXsEYHR2Plwja5e/ZU5+6LcnMeSz9TLB+unVD7VtfhfW",
    "darwin-arm64": "AhpVNCTLpccB8mZ6Z3pQjFQe9f+WoeTe481Qx3wucxTwNa1M0HW+m+TmAGvE1W32",
    "win32-x64": "/4xfSaIO6Ft1MkrjbtPV9PHee+R/9R/1xRyui5ubzahbF+rfsdx5FFOy3Bxqs+nV",
    "win32-arm64": "EB1Dbb9F7WjJ7nq8lEvTv1pG0cvdyqqfDBevg1RsnKbHJOyNvlEpv8HMOQuSqgg9",
}
LONGEST = 120.0  # seconds that fetching, and bundling, may take
LARGEST = 64 << 20  # bytes of one of their files


def find_web_tools_folder() -> Path | None:
    """Return the folder they are kept in between exports; None if nobody's home is known."""
    return cache_folder(f"web-{THREE}-{ESBUILD}")


def is_three_at_hand() -> bool:
    """Return whether three.js is kept here, or npm has fetched it now."""
    return read_three() is not None or (_fetch() and read_three() is not None)


def read_three() -> dict[str, bytes] | None:
    """Return three.js's files by their names; None if they are not kept, or are not those they should be."""
    modules = _modules()
    if modules is None:
        return None
    out = {name: _checked(modules / "three" / name, digest) for name, digest in NEEDED.items()}
    return (
        None
        if None in out.values()
        else {name: content for name, content in out.items() if content is not None}
    )


def bundle_module(entry: Path, beside: tuple[str, ...] = ()) -> bytes | None:
    """Return a module with all it imports, three.js too, as one minified file; None if that cannot be.
    beside: modules that stay files of their own, as they are imported ("./avatar.js").
    """
    modules, program, files = _modules(), _esbuild(), read_three()
    if modules is None or program is None or files is None:
        return None
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch).resolve()
        for name, content in files.items():  # those whose digests were right
            (folder / "three" / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / "three" / name).write_bytes(content)
        out = folder / "out.js"
        command = [
            str(program), str(entry), "--bundle", "--minify", "--format=esm", "--target=es2022",
            "--charset=utf8", "--legal-comments=inline", "--log-level=error", "--tsconfig-raw={}",
            f"--alias:three/addons={(folder / 'three' / 'examples' / 'jsm').as_posix()}",
            f"--alias:three={(folder / 'three' / 'build' / 'three.module.js').as_posix()}",
            f"--outfile={out}", *(f"--external:{module}" for module in beside),
        ]  # fmt: skip
        try:
            code, _ = programs.run_program(command, LONGEST)
            return out.read_bytes() if code == 0 else None
        except (OSError, TimeoutError):
            return None


def import_map(at: str, *, checked: bool) -> str:
    """Return what tells a page where three.js is. at: the address of its folder. checked: have the browser
    compare each file with its digest.
    """
    found: dict[str, dict[str, str]] = {
        "imports": {"three": f"{at}build/three.module.js", "three/addons/": f"{at}examples/jsm/"}
    }
    lines = []
    if checked:
        digests = {
            f"{at}{name}": f"sha384-{digest}" for name, digest in NEEDED.items() if name.endswith(".js")
        }
        found["integrity"] = digests
        # Browsers that do not know the map's digests yet know these.
        lines = [
            f'<link rel="modulepreload" href="{address}" integrity="{digest}" crossorigin="anonymous">'
            for address, digest in digests.items()
        ]
    return "\n    ".join([f'<script type="importmap">{json.dumps(found)}</script>', *lines])


def _modules() -> Path | None:
    place = find_web_tools_folder()
    return place / "node_modules" if place is not None and programs.is_own(place) else None


def _checked(path: Path, digest: str) -> bytes | None:
    """Return a file's content if it is the one with a digest, and nobody else could have written it."""
    content = programs.read_own(path, LARGEST)
    if content is None or base64.b64encode(hashlib.sha384(content).digest()).decode() != digest:
        return None
    return content


def _esbuild() -> Path | None:
    """Return esbuild's program for this system, if it is the one it should be."""
    machine = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64", "arm64": "arm64"}
    system = f"{sys.platform}-{machine.get(platform.machine().lower(), '')}"
    modules = _modules()
    if modules is None or system not in PROGRAMS:
        return None
    path = modules / "@esbuild" / system / ("esbuild.exe" if sys.platform == "win32" else "bin/esbuild")
    return path.resolve() if _checked(path, PROGRAMS[system]) is not None else None


def _fetch() -> bool:
    """Let npm fetch both; return whether it said that it did. Their own scripts are not run."""
    npm, place = programs.find_system_program("npm"), find_web_tools_folder()
    if npm is None or place is None or not programs.make_own(place):
        return False
    command = [
        npm, "install", "--prefix", str(place), "--no-audit", "--no-fund", "--no-package-lock", "--silent",
        "--ignore-scripts", "--fetch-retries=1", "--fetch-timeout=20000",
        f"three@{THREE}", f"esbuild@{ESBUILD}",
    ]  # fmt: skip
    try:
        return programs.run_program(command, LONGEST, cwd=place, umask=0o077)[0] == 0
    except (OSError, TimeoutError):
        return False
