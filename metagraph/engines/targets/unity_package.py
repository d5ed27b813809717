"""Packages for Unity: the runtime's files, each with the `.meta` Unity would make, and `.unitypackage`."""

from __future__ import annotations

import gzip
import io
import tarfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from metagraph.engines.targets.unity_yaml import make_guid
from metagraph.formats.atomic import write_atomically

PACKAGE = "com.metagraph.runtime"
_IMPORTERS = {
    ".cs": "MonoImporter:\n  externalObjects: {}\n  serializedVersion: 2\n  defaultReferences: []\n"
    "  executionOrder: 0\n  icon: {instanceID: 0}\n",
    ".asmdef": "AssemblyDefinitionImporter:\n  externalObjects: {}\n",
    ".md": "TextScriptImporter:\n  externalObjects: {}\n",
    ".json": "PackageManifestImporter:\n  externalObjects: {}\n",
}
_REST = "  userData: \n  assetBundleName: \n  assetBundleVariant: \n"


def write_package_metas(package: Path, files: Iterable[Path]) -> list[Path]:
    """Write the `.meta` of each of a package's files and of the folders they are in; return these. The same
    file has the same id in every export, so that scenes keep their components. Unity passes over folders
    whose names end with "~".
    """
    seen: dict[PurePosixPath, bool] = {}
    for file in files:
        inside = PurePosixPath(file.relative_to(package).as_posix())
        if not any(part.endswith("~") for part in inside.parts):
            seen |= {folder: True for folder in inside.parents if folder.parts} | {inside: False}
    out = []
    for inside, is_folder in sorted(seen.items()):
        place = package / f"{inside}.meta"
        write_atomically(place, _meta(inside, is_folder).encode())
        out.append(place)
    return out


def _meta(inside: PurePosixPath, is_folder: bool) -> str:
    importer = "DefaultImporter:\n  externalObjects: {}\n"
    kind = "folderAsset: yes\n" + importer if is_folder else _IMPORTERS.get(inside.suffix, importer)
    return f"fileFormatVersion: 2\nguid: {make_guid(PACKAGE, str(inside))}\n{kind}{_REST}"


@dataclass(frozen=True)
class PackedAsset:
    """An asset of a `.unitypackage`: its id, its bytes and its `.meta`."""

    guid: str
    content: bytes
    meta: bytes


def pack_assets(assets: Mapping[str, PackedAsset]) -> bytes:
    """Return a `.unitypackage`, which Unity imports when it is opened. assets: by their paths."""
    out = io.BytesIO()
    with (
        gzip.GzipFile(fileobj=out, mode="wb", mtime=0) as packed,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.USTAR_FORMAT) as archive,
    ):
        for path, asset in assets.items():
            parts = (("asset", asset.content), ("asset.meta", asset.meta), ("pathname", path.encode()))
            for name, data in parts:
                entry = tarfile.TarInfo(f"{asset.guid}/{name}")
                entry.size = len(data)
                archive.addfile(entry, io.BytesIO(data))
    return out.getvalue()
