"""Sound files of kinds nobody but other programs writes, or that take a recipe, for the fuzzers to begin from."""

from __future__ import annotations

import io
import json
import random
import tempfile
import zipfile
from pathlib import Path

from tests.fuzz.spoiling import spoilt

_CURVES = ("X", "Y", "Z")


def ascii_fbx() -> bytes:
    """Return an FBX 7.4 text: three limbs in a row, of which the second turns for half a second."""
    limbs = {1: ("Hips", 0.0), 2: ("Spine", 40.0), 3: ("Head", 30.0)}
    objects, links = [], []
    for number, (name, up) in limbs.items():
        objects.append(
            f'Model: {number}, "Model::{name}", "LimbNode" {{\n Version: 232\n Properties70: {{\n'
            f'  P: "Lcl Translation", "Lcl Translation", "", "A",0,{up},0\n }}\n}}\n'
            f'NodeAttribute: {number + 10}, "NodeAttribute::{name}", "LimbNode" {{\n TypeFlags: "Skeleton"\n}}'
        )
        links += [f'C: "OO",{number + 10},{number}', f'C: "OO",{number},{number - 1}']
    objects += [
        'AnimationStack: 20, "AnimStack::nod", "" {\n Properties70: {\n  P: "LocalStart", "KTime", "Time", "",0\n  P: "LocalStop", "KTime", "Time", "",23093079000\n }\n}',
        'AnimationLayer: 21, "AnimLayer::Base", "" {\n}',
        'AnimationCurveNode: 22, "AnimCurveNode::R", "" {\n Properties70: {\n  P: "d|X", "Number", "", "A",0\n }\n}',
    ]
    links += ['C: "OO",21,20', 'C: "OO",22,21', 'C: "OP",22,2, "Lcl Rotation"']
    for n, axis in enumerate(_CURVES):
        objects.append(
            f'AnimationCurve: {23 + n}, "AnimCurve::", "" {{\n Default: 0\n KeyVer: 4008\n KeyTime: *3 {{\n  a: 0,11546539500,23093079000\n }}\n'
            f" KeyValueFloat: *3 {{\n  a: 0,{10 * (n + 1)},0\n }}\n KeyAttrFlags: *1 {{\n  a: 24836\n }}\n"
            " KeyAttrDataFloat: *4 {\n  a: 0,0,0,0\n }\n KeyAttrRefCount: *1 {\n  a: 3\n }\n}"
        )
        links.append(f'C: "OP",{23 + n},22, "d|{axis}"')
    return "\n".join(
        (
            "; FBX 7.4.0 project file",
            "FBXHeaderExtension:  {\n FBXHeaderVersion: 1003\n FBXVersion: 7400\n}",
            'GlobalSettings:  {\n Version: 1000\n Properties70:  {\n  P: "UnitScaleFactor", "double", "Number", "",1\n }\n}',
            "Objects:  {",
            *objects,
            "}",
            "Connections:  {",
            *links,
            "}\n",
        )
    ).encode()  # fmt: skip


def model_file() -> dict[str, bytes]:
    """Return a small learned model's file."""
    from metagraph.generation.stored import write_model
    from tests.generation.makers import untrained

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "m.mgmodel"
        write_model(untrained("matching"), path)
        return {path.name: path.read_bytes()}


def spoilt_archive(chance: random.Random, data: bytes) -> bytes:
    """Return an archive whose members were spoilt, dropped, doubled or renamed, and packed again."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    for _ in range(chance.choice((1, 1, 2))):
        name = chance.choice(list(members))
        match chance.randrange(5):
            case 0:
                del members[name]
                members = members or {"model.json": b"{}"}
            case 1:
                members[f"{name}{chance.choice(('', '/../x', '.npy'))}x"] = members[name]
            case 2:
                members[name] = members[chance.choice(list(members))]
            case _ if name.endswith(".json"):
                try:
                    members[name] = json.dumps(spoilt(chance, json.loads(members[name]))).encode()
                except ValueError:
                    members[name] += b"}"
            case _:
                content = bytearray(members[name])
                at = chance.randrange(max(1, min(len(content), 128)))
                content[at : at + 1] = chance.randbytes(chance.choice((0, 1, 4)))
                members[name] = bytes(content)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", chance.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))) as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return out.getvalue()


BML = b"""<bml id="b1" xmlns="http://www.bml-initiative.org/bml/bml-1.0">
 <speech id="s1" start="0.5"><text>So <sync id="t1"/>we go.</text></speech>
 <gesture id="g1" lexeme="beat" stroke="s1:t1" end="s1:end+1"/>
 <head id="h1" lexeme="nod" start="s1:start"/><wait id="w" duration="1"/>
</bml>"""
