"""Assembles the folder of a bundle: a Python of its own, Metagraph and what it depends on, and a launcher."""

from __future__ import annotations

import compileall
import os
import py_compile
import re
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from app.bundle.leftovers import PYTHON, SITE, STRIPPED, UNCOMPILED
from app.bundle.libraries import add_libraries, set_search_path
from app.project.menu_entry import DESKTOP
from app.shell.update_check import ADDRESS, is_safe
from metagraph.common.studio import ADDRESS as STUDIO

ROOT = Path(__file__).resolve().parents[2]
LAUNCHER = Path(__file__).parent / "launcher"
EXTRAS = "fbx"  # small, and what animators have most
PARTS = ("app", "metagraph", "preview", "sample_clips", "pyproject.toml", "README.md", "LICENSE")

Tell = Callable[[str], object]


def make_folder(out: Path, tell: Tell = print, updates: str = "", studio: str = "") -> Path:
    """Make the folder `metagraph` inside `out`, replacing an older one; return it. updates: the address that
    it may ask for a newer version, studio: the path of the studio's defaults; "" for none. Raises OSError,
    ValueError for an address that it would not ask, and subprocess.CalledProcessError if the packages cannot
    be installed.
    """
    if updates and not is_safe(updates):
        raise ValueError(f"'{updates}' does not begin with https://")
    # What ldd reports is compared with whole paths.
    folder = out.resolve() / "metagraph"
    if folder.exists():
        shutil.rmtree(folder)
    tell("Copying Python")
    python = copy_python(folder / "python")
    tell("Installing Metagraph and what it depends on")
    site = find_site(folder)
    install_packages(site)
    tell("Leaving out what is not used")
    remove_matches(site, SITE)
    strip([binary for name in STRIPPED for binary in (site / name).rglob("*.so")])
    shutil.copytree(ROOT / "docs", site / "docs", ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    shutil.copy(LAUNCHER / "sitecustomize.py", site)
    (site / "bundled").write_text("This Metagraph brings its own Python.\n")
    shutil.copy(ROOT / "CHANGELOG.md", site)
    if updates:
        (site / ADDRESS).write_text(updates, encoding="utf-8")
    if studio:
        (site / STUDIO).write_text(studio, encoding="utf-8")
    tell("Adding libraries of the system that a bare one lacks")
    add_libraries(folder, site)
    tell("Compiling")
    compileall.compile_dir(
        str(folder / "python" / "lib"),
        quiet=2,
        workers=0,
        # The folder may be read-only, or a copy with other times.
        invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH,
        stripdir=str(folder),
        rx=re.compile(UNCOMPILED),
    )
    add_desktop_files(folder / DESKTOP)
    shutil.copy(LAUNCHER / "README.txt", folder)
    shutil.copy(ROOT / "LICENSE", folder)
    make_launcher(folder / "metagraph")
    set_rights(folder)
    # What was stripped must still load.
    subprocess.run([python, "-I", "-c", f"import app.cli.parser, {', '.join(STRIPPED)}"], check=True)
    return folder


def add_desktop_files(place: Path) -> None:
    """Copy what a desktop's menu needs; in a folder below, where nobody takes it for the program."""
    place.mkdir(parents=True)
    for name in ("metagraph.desktop", "metagraph.xml"):
        shutil.copy(LAUNCHER / name, place)
    shutil.copy(ROOT / "app" / "look" / "metagraph.svg", place)


def make_launcher(to: Path) -> None:
    """Compile the program that starts a bundle. File managers take one at a fixed address (no-pie) for a
    program, and others for a library. Raises FileNotFoundError without a C compiler.
    """
    compiler = shutil.which("cc")
    if compiler is None:
        raise FileNotFoundError("making a bundle needs a C compiler, on Debian or Ubuntu: apt install gcc")
    source = LAUNCHER / "metagraph.c"
    subprocess.run([compiler, "-O2", "-s", "-no-pie", "-fno-pie", "-o", str(to), str(source)], check=True)


def find_site(folder: Path) -> Path:
    """Return where a bundle's packages are."""
    return folder / "python" / "lib" / f"python{sys.version_info[0]}.{sys.version_info[1]}" / "site-packages"


def copy_python(to: Path) -> Path:
    """Copy the Python that runs this, without what a program never uses; return its executable."""
    base, version = Path(sys.base_prefix), f"python{sys.version_info[0]}.{sys.version_info[1]}"
    lib = base / "lib" / version

    def ignore(folder: str, names: list[str]) -> set[str]:
        return {n for n in names if any((Path(folder) / n).relative_to(lib).match(p) for p in PYTHON)}

    shutil.copytree(lib, to / "lib" / version, symlinks=True, ignore=ignore)
    (to / "lib" / version / "site-packages").mkdir()
    (to / "bin").mkdir()
    executable = to / "bin" / "python3"
    shutil.copy(Path(sys.base_prefix) / "bin" / version, executable)
    shared = sysconfig.get_config_var("INSTSONAME") or ""
    if ".so" in shared:
        shutil.copy(base / "lib" / shared, to / "lib" / shared)
    strip([executable, *to.rglob("*.so*")])
    if ".so" in shared:
        set_search_path(executable, "$ORIGIN/../lib")
    return executable


def strip(binaries: Iterable[Path]) -> None:
    """Leave out what only debuggers read, where binutils are installed."""
    program = shutil.which("strip")
    for binary in binaries if program is not None else ():
        subprocess.run([str(program), "--strip-unneeded", str(binary)], check=False)


def install_packages(site: Path) -> None:
    """Install Metagraph, its dependencies and pip, which extras are installed with, into a folder."""
    with TemporaryDirectory() as place:
        # What setuptools leaves in a checkout would come into the next package.
        source = Path(place) / "source"
        source.mkdir()
        for name in PARTS:
            whole = ROOT / name
            (shutil.copytree if whole.is_dir() else shutil.copy)(whole, source / name)
        subprocess.run(
            [sys.executable, "-m", "pip", "install", "--quiet", "--no-compile", "--target", str(site)]
            + [f"{source}[{EXTRAS}]", "pip"],
            check=True,
            env={**os.environ, "PIP_ROOT_USER_ACTION": "ignore"},
        )
    remove_source(site)


def remove_source(site: Path) -> None:
    """Remove where pip found Metagraph: a folder for the moment, which differs in each bundle."""
    for path in site.glob("metagraph_studio-*.dist-info/direct_url.json"):
        path.unlink()
        record = path.with_name("RECORD")
        lines = record.read_text("utf-8").splitlines(keepends=True)
        kept = [line for line in lines if f"/{path.name}," not in line]
        record.write_text("".join(kept), "utf-8")


def set_rights(folder: Path) -> None:
    """Give all files of a folder the rights that they have for anybody, whatever its maker's umask."""
    for path in (folder, *folder.rglob("*")):
        if not path.is_symlink():
            runs = path.is_dir() or path.stat().st_mode & 0o100
            path.chmod(0o755 if runs else 0o644)


def remove_matches(folder: Path, patterns: tuple[str, ...]) -> None:
    """Remove files and folders by patterns relative to a folder."""
    for path in find_matches(folder, patterns):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)


def find_matches(folder: Path, patterns: tuple[str, ...]) -> Iterator[Path]:
    """Yield what patterns relative to a folder match. Raises ValueError for one that matches nothing."""
    for pattern in patterns:
        found = list(folder.glob(pattern))
        if not found:
            raise ValueError(f"nothing in {folder} is called '{pattern}'; remove it from leftovers.py")
        yield from found
