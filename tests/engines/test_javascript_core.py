"""The core of the JavaScript runtime: it is small, fetches what an export needs, and plays the same."""

from __future__ import annotations

import gzip
import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from metagraph.engines.targets import registry
from metagraph.engines.targets.next_steps import STEPS
from metagraph.graph.model import Project
from tests.browsing import MODULES
from tests.engines.javascript_runtime import RUNTIME, VECTORS, needs_node, run

ESBUILD = MODULES / ".bin" / "esbuild"
PARTS = ("./life/part.js", "./contacts.js", "./weight.js", "./meshopt.js")
MOST = 45_000  # bytes, compressed

needs_esbuild = pytest.mark.skipif(not ESBUILD.exists(), reason="needs npm's esbuild")
pytestmark = needs_node


def bundle(*options: str) -> None:
    command = [str(ESBUILD), "core.js", "--bundle", "--minify", "--format=esm", "--target=es2022", *options]
    subprocess.run(command, cwd=RUNTIME, capture_output=True, timeout=60, check=True)


def size(*paths: Path) -> int:
    return sum(len(gzip.compress(path.read_bytes(), 9)) for path in paths)


@needs_esbuild
def test_the_core_is_small(tmp_path: Path) -> None:
    """As one module, and as a bundler splits it."""
    bundle(f"--outfile={tmp_path / 'core.js'}", *(f"--external:{part}" for part in PARTS))
    assert size(tmp_path / "core.js") < MOST
    bundle("--splitting", f"--outdir={tmp_path / 'split'}", f"--metafile={tmp_path / 'meta.json'}")
    outputs: dict[str, Any] = json.loads((tmp_path / "meta.json").read_bytes())["outputs"]
    todo, first = [next(name for name in outputs if name.endswith("core.js"))], set[str]()
    while todo:
        name = todo.pop()
        if name not in first:
            first.add(name)
            todo += [x["path"] for x in outputs[name]["imports"] if x["kind"] == "import-statement"]
    assert size(*(tmp_path / "split" / Path(name).name for name in first)) < MOST


PLAY = """
const core = await of("core.js");
const script = async (load) => {
  const graph = await load(text, glb);
  const character = new Character(graph, { seed: 5 });
  const out = [];
  character.ask({ do: "say", id: "said", text: "Hello, how are you?" });
  character.ask({ do: "mood", mood: "happy" });
  character.ask({ do: "look", to: "user", after: 1 });
  character.ask({ do: "gesture", after: 2 });
  for (let now = 0; now < 6; now += 0.25) {
    character.update(now);
    out.push([...character.pose().rotations, ...character.morphs()], character.events(), character.spoken("said"));
  }
  character.saySound("sound", new Float32Array(1600).fill(0.2), 16000);
  character.update(7);
  out.push([...character.pose().rotations], character.answer("sound"), character.describe());
  return JSON.stringify(out);
};
const same = (await script(load)) === (await script((json, glb) => core.load(json, glb, "the export", ["life"])));
say(same);
"""


@pytest.mark.parametrize("folder", VECTORS, ids=lambda folder: folder.name)
def test_it_plays_the_same(folder: Path) -> None:
    assert run(PLAY, folder) is True


def test_it_fetches_only_what_an_export_needs() -> None:
    needed = run(
        """
        const { neededParts } = await of("parts.js");
        const data = JSON.parse(text);
        const packed = { extensionsUsed: ["EXT_meshopt_compression"] };
        const bare = { ...data, rig: null, weight_rig: null, contact_rig: null };
        say([neededParts(bare, {}), neededParts(bare, packed), neededParts({ ...bare, weight_rig: {} }, {}), neededParts(data, {})]);
        """
    )
    assert needed[:3] == [[], ["packing"], ["life", "weighing"]]
    assert set(needed[3]) <= {"life", "touching", "weighing"}


def test_what_needs_a_part_says_so_and_errors_are_those_of_loading() -> None:
    said = run(
        """
        const core = await of("core.js");
        const data = JSON.parse(text);
        Object.assign(data, { rig: null, weight_rig: null, contact_rig: null });
        const character = new core.Character(await core.load(JSON.stringify(data), glb));
        const why = character.answer(character.saySound("a", [0, 0], 16000)).why;
        character.update(1);
        const errors = [];
        for (const [json, bytes] of [["{", glb], ["{}", glb], [text, glb.subarray(0, 20)]]) {
          await core.load(json, bytes).catch((error) => errors.push(error instanceof core.MetagraphError));
        }
        say([why, character.spoken("a"), [...character.pose().rotations].every(Number.isFinite), errors]);
        """
    )
    assert 'load(json, glb, file, ["life"])' in said[0]
    assert said[1:] == [{"text": "", "lastWord": ""}, True, [True, True, True]]


def test_the_first_lines_in_an_exports_readme_show_something(sample: Project, tmp_path: Path) -> None:
    registry.write_for_target(sample, "javascript", tmp_path)
    text = (tmp_path / "README.md").read_text(encoding="utf-8")
    code = text.split("```js\n")[1].split("```")[0]
    (tmp_path / "play.mjs").write_text(code)
    done = subprocess.run(
        ["node", "play.mjs"], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "begin" in done.stdout and "end" in done.stdout


def test_the_first_lines_in_python_show_something(
    sample: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    registry.write_for_target(sample, "metagraph", tmp_path)
    monkeypatch.chdir(tmp_path)
    exec(STEPS["metagraph"].code.replace("{stem}", "sample"), {"__name__": "page"})
    assert "begin" in capsys.readouterr().out


def test_the_package_offers_it() -> None:
    package = json.loads((RUNTIME / "package.json").read_bytes())
    assert package["exports"]["./core.js"] == {"types": "./core.d.ts", "default": "./core.js"}
