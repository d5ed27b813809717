"""An export whose GLB is packed plays the same in the runtimes that read it, and is refused by what does not."""

from __future__ import annotations

import json
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any

import pytest

from metagraph.engines.export import export_project
from metagraph.engines.export_error import ExportError
from metagraph.engines.reading import read_export
from metagraph.engines.targets import registry, web
from metagraph.engines.targets.target import Contents
from metagraph.engines.vectors import check_vectors, list_cases, write_vectors
from metagraph.graph.model import Project
from tests.browsing import MODULES, Browser
from tests.engines import cpp_program, csharp_runtime, godot_runtime
from tests.engines.godot_runtime import needs_godot
from tests.engines.web_tools_kept import kept_web_tools
from tests.formats.gltf.test_gltf_packed import BODY, parts, rewritten
from tests.thorough import many

ROOT = Path(__file__).resolve().parents[2]
RUNTIMES = ROOT / "metagraph" / "engines" / "runtimes"
JAVASCRIPT = RUNTIMES / "javascript"
needs_node = pytest.mark.skipif(shutil.which("node") is None, reason="needs Node")


@pytest.fixture(scope="module")
def packed(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample's export, packed, with every 24th of its vectors' cases, or every eighth."""
    folder = tmp_path_factory.mktemp("packed") / "sample"
    path = export_project(sample, folder, character=BODY, compress=True).json
    write_vectors(path, list(list_cases(read_export(path, resolved=True)))[:: many(24, 8)])
    return folder


@pytest.fixture(scope="module")
def damaged(packed: Path, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Copies whose packed turns are cut short, longer than said, or of a filter they cannot have."""
    out: list[Path] = []
    changes: list[dict[str, Any]] = [
        {"byteLength": 999},
        {"count": 9},
        {"filter": "WAVELET"},
        {"byteOffset": 1 << 28},
    ]
    for change in changes:
        folder = shutil.copytree(packed, tmp_path_factory.mktemp("damaged") / "sample")
        document, binary = parts(folder / "sample.glb")
        turns = document["accessors"][document["animations"][0]["samplers"][0]["output"]]
        document["bufferViews"][turns["bufferView"]]["extensions"]["EXT_meshopt_compression"] |= change
        rewritten(folder / "sample.glb", document, binary)
        out.append(folder)
    return out


@pytest.mark.nightly
def test_it_plays_the_same_in_python(packed: Path) -> None:
    outcome = check_vectors(packed)
    assert outcome.passed > many(5, 15) and not outcome.failures


@pytest.mark.nightly
@needs_node
def test_it_plays_the_same_in_javascript(packed: Path) -> None:
    done = subprocess.run(
        ["node", JAVASCRIPT / "conformance.mjs", packed], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]


LOAD = """
import { readFileSync } from "node:fs";
import { load } from "%s/index.js";
for (const folder of process.argv.slice(1)) {
  try {
    load(readFileSync(folder + "/sample.json", "utf8"), readFileSync(folder + "/sample.glb"));
    console.log("loaded");
  } catch (error) {
    console.log(`${error.name}: ${error.message}`);
  }
}
"""


@pytest.mark.nightly
@needs_node
def test_a_damaged_one_is_refused_by_javascript_when_it_is_loaded(damaged: list[Path]) -> None:
    """Not when its clips first play, which is when they are made."""
    script = LOAD % JAVASCRIPT.as_uri()
    done = subprocess.run(
        ["node", "--input-type=module", "-e", script, *damaged], capture_output=True, text=True, timeout=60
    )
    lines = done.stdout.splitlines()
    assert len(lines) == len(damaged) and all(
        line.startswith("MetagraphError: sample.glb") for line in lines
    ), lines


DECODE = """
import { readFileSync } from "node:fs";
import { MeshoptDecoder as ours } from "%s/index.js";
import { MeshoptDecoder as theirs } from "%s/three/examples/jsm/libs/meshopt_decoder.module.js";
await theirs.ready;
await ours.ready;
const reference = JSON.parse(readFileSync(process.argv[1])), glb = readFileSync(process.argv[2]);
const document = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12))), binary = glb.subarray(28 + glb.readUInt32LE(12));
const rows = Object.values(reference.triangles).map(({ packed, indices }) => [packed, indices.length, 4, "TRIANGLES"]);
rows.push([reference.indices.packed, reference.indices.indices.length, 4, "INDICES"]);
rows.push([reference.attributes.packed, 40, 8, "ATTRIBUTES"]);
const cases = rows.map(([packed, ...rest]) => [Buffer.from(packed, "base64"), ...rest]);
for (const view of document.bufferViews) {
  const packed = view.extensions?.EXT_meshopt_compression;
  if (!packed) continue;
  const { byteOffset, byteLength, count, byteStride, mode, filter = "NONE" } = packed;
  cases.push([binary.subarray(byteOffset, byteOffset + byteLength), count, byteStride, mode, filter]);
}
console.log(JSON.stringify(cases.map(([data, count, size, mode, filter]) => {
  const [a, b] = [ours, theirs].map((decoder) => {
    const out = new Uint8Array(count * size);
    decoder.decodeGltfBuffer(out, count, size, data, mode, filter);
    return filter === "QUATERNION" ? new Int16Array(out.buffer) : out;
  });
  return [mode, filter ?? "NONE", a.reduce((most, x, n) => Math.max(most, Math.abs(x - b[n])), 0)];
})));
"""


@pytest.mark.nightly
@needs_node
def test_views_are_unpacked_as_the_extensions_own_library_does(packed: Path) -> None:
    """Which three.js comes with: packed by it and packed by us. Turns may differ in the last digit."""
    if not (MODULES / "three").is_dir():
        pytest.skip("needs three.js (python3 run.py test fetches it where npm is)")
    reference = ROOT / "tests" / "formats" / "gltf" / "meshopt_reference.json"
    script = DECODE % (JAVASCRIPT.as_uri(), MODULES.resolve().as_uri())
    done = subprocess.run(
        ["node", "--input-type=module", "-e", script, reference, packed / "sample.glb"],
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert {"TRIANGLES", "INDICES", "ATTRIBUTES"} == {mode for mode, _, _ in found}
    assert {kind for _, kind, _ in found} == {"NONE", "EXPONENTIAL", "QUATERNION", "OCTAHEDRAL"}
    assert all(off <= (kind == "QUATERNION") for _, kind, off in found), found


@pytest.mark.nightly
@csharp_runtime.needs_mono
def test_it_plays_the_same_in_c_sharp_and_a_damaged_one_is_refused(
    packed: Path, damaged: list[Path], core: Path
) -> None:
    runner = csharp_runtime.RUNTIME / "Tests" / "Conformance.cs"
    program = csharp_runtime.compiled(core.with_name("packed.exe"), runner, references=(core,))
    done = csharp_runtime.mono(program, packed)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]
    done = csharp_runtime.mono(program, *damaged)
    lines = done.stdout.splitlines()
    assert done.returncode == 1 and len(lines) == len(damaged) + 1, done.stdout + done.stderr
    assert all("sample.glb" in line for line in lines[:-1]), lines


@pytest.mark.nightly
@cpp_program.needs_compiler
def test_it_plays_the_same_in_cpp_and_a_damaged_one_is_refused(
    packed: Path, damaged: list[Path], cpp_probe: Path
) -> None:
    done = cpp_program.ran(cpp_probe, "conformance", packed)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]
    done = cpp_program.ran(cpp_probe, "conformance", *damaged)
    told = [line for line in done.stdout.splitlines() if "loading" in line]
    assert done.returncode == 1 and len(told) == len(damaged), done.stdout
    assert all("sample.glb" in line for line in told)


@pytest.mark.nightly
@needs_godot
def test_gdscript_says_that_it_does_not_read_it(packed: Path, game: Path) -> None:
    code, told = godot_runtime.godot(game, "addons/metagraph/conformance.gd", packed)
    assert code == 1 and "without --compress" in told


@pytest.mark.nightly
@pytest.mark.parametrize("name", sorted(registry.list_targets()))
def test_targets_that_cannot_read_it_refuse_and_the_others_write_it(
    sample: Project, tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(web, "is_three_at_hand", lambda: False)
    if not registry.get_target(name).unpacks:
        with pytest.raises(ExportError, match="without --compress"):
            registry.write_for_target(sample, name, tmp_path / "out", Contents(compress=True))
        assert not (tmp_path / "out").exists()
        return
    made = registry.write_for_target(sample, name, tmp_path / "out", Contents(compress=True))
    (glb,) = (path for path in made.files if path.suffix == ".glb")
    assert "EXT_meshopt_compression" in parts(glb)[0]["extensionsRequired"]


@pytest.mark.nightly
def test_a_page_shows_it(
    sample: Project, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, browse: Browser
) -> None:
    with kept_web_tools(tmp_path_factory.mktemp("kept")):
        registry.write_for_target(sample, "web", tmp_path, Contents(BODY, compress=True))
    seen = """(() => { const { stage, object } = document.querySelector("metagraph-character"); let vertices = 0;
      stage.scene.traverse((one) => (vertices += one.isSkinnedMesh ? one.geometry.attributes.position.count : 0));
      return [vertices, object.missing.length, stage.bounds.max.y]; })()"""
    ((vertices, missing, top),), errors = browse(
        tmp_path, {"url": "", "until": "performance.getEntriesByName('first pose').length"}, {"run": seen}
    )
    assert not errors
    assert vertices > 9000 and missing == 0 and 1.4 < top < 2.1


@pytest.mark.nightly
def test_the_size_that_is_said_is_the_size_there_is(packed: Path, sample_export: Path) -> None:
    plain, small = ((folder / "sample.glb").stat().st_size for folder in (sample_export, packed))
    assert small < 0.75 * plain
    assert struct.unpack_from("<I", (packed / "sample.glb").read_bytes(), 8) == (small,)
