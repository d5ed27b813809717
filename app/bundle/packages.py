"""Packs the folder of a bundle: as .tar.xz for any Linux, as .deb for Debian and Ubuntu."""

from __future__ import annotations

import os
import shutil
import subprocess
import tarfile
from pathlib import Path

from app.project.menu_entry import DESKTOP
from metagraph import __version__

# What a desktop has and the bundle leaves to it; Debian's names.
DEPENDS = (
    "libc6 (>= {glibc}), libgl1, libegl1, libfontconfig1, libfreetype6, libx11-6, libx11-xcb1, libxcb1, "
    "libdbus-1-3, libgssapi-krb5-2, libglib2.0-0 | libglib2.0-0t64, libasound2 | libasound2t64"
)
WHEN = 946684800  # 2000-01-01: a package made again is the same to the byte


def pack_tar(folder: Path, to: Path) -> Path:
    """Pack a folder as .tar.xz; return the file, which does not tell who packed it when."""
    path = to / f"metagraph-{__version__}-linux-{os.uname().machine}.tar.xz"

    def plain(entry: tarfile.TarInfo) -> tarfile.TarInfo:
        entry.uid = entry.gid = 0
        entry.uname = entry.gname = "root"
        entry.mtime = WHEN
        return entry

    with tarfile.open(path, "w:xz", preset=6) as tar:
        for each in [folder, *sorted(folder.rglob("*"))]:
            tar.add(each, arcname=each.relative_to(folder.parent), recursive=False, filter=plain)
    return path


def pack_deb(folder: Path, to: Path, glibc: str) -> Path:
    """Pack a folder as a package of Debian: under /opt/metagraph, with a menu entry, a type for projects and
    the command `metagraph`. glibc: the oldest that it runs with. Needs dpkg-deb.
    """
    machine = {"x86_64": "amd64", "aarch64": "arm64"}.get(os.uname().machine, os.uname().machine)
    tree = to / "deb"
    if tree.exists():
        shutil.rmtree(tree)
    shutil.copytree(folder, tree / "opt" / "metagraph", symlinks=True)
    for source, place in (
        ("metagraph.desktop", "usr/share/applications"),
        ("metagraph.xml", "usr/share/mime/packages"),
        ("metagraph.svg", "usr/share/icons/hicolor/scalable/apps"),
    ):
        (tree / place).mkdir(parents=True)
        shutil.move(tree / "opt" / "metagraph" / DESKTOP / source, tree / place / source)
    (tree / "opt" / "metagraph" / "README.txt").unlink()  # how a folder that was unpacked is started
    (tree / "usr" / "bin").mkdir(parents=True)
    (tree / "usr" / "bin" / "metagraph").symlink_to("/opt/metagraph/metagraph")
    size = sum(path.lstat().st_size for path in tree.rglob("*")) // 1024
    (tree / "DEBIAN").mkdir()
    (tree / "DEBIAN" / "control").write_text(
        f"Package: metagraph-studio\nVersion: {__version__}\nArchitecture: {machine}\n"
        f"Maintainer: Metagraph <metagraph@localhost>\nInstalled-Size: {size}\n"
        f"Depends: {DEPENDS.format(glibc=glibc)}\nSection: graphics\nPriority: optional\n"
        "Description: Author conversational characters from motion clips\n"
        " An animator drops clips onto stances, gestures, fidgets and transitions. All connections follow,\n"
        " a preview plays the character, and engines get it as JSON and GLB.\n"
    )
    goodbye = tree / "DEBIAN" / "postrm"
    shutil.copy(Path(__file__).parent / "launcher" / "postrm", goodbye)
    goodbye.chmod(0o755)
    path = to / f"metagraph-studio_{__version__}_{machine}.deb"
    environment = {**os.environ, "SOURCE_DATE_EPOCH": str(WHEN)}
    subprocess.run(
        ["dpkg-deb", "--root-owner-group", "-Zxz", "--build", str(tree), str(path)],
        check=True,
        env=environment,
        stdout=subprocess.DEVNULL,
    )
    shutil.rmtree(tree)
    return path
