"""The JavaScript runtime as a package of npm: what its own checkers say, servers, React and React Three Fiber."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from metagraph import __version__, engines
from metagraph.engines.targets import registry
from metagraph.engines.targets.target import Contents
from metagraph.graph.model import Project
from tests.browsing import MODULES, Browser

RUNTIME = Path(engines.__file__).with_name("runtimes") / "javascript"
PACKAGES = Path(os.environ.get("NPM_PACKAGES", MODULES))  # where the checkers and React are
ADA = Path(__file__).parents[2] / "sample_clips" / "ada.glb"
PACKAGE: dict[str, Any] = json.loads((RUNTIME / "package.json").read_bytes())


def needs(*names: str) -> pytest.MarkDecorator:
    there = shutil.which("node") is not None and all((PACKAGES / name).is_dir() for name in names)
    return pytest.mark.skipif(not there, reason=f"needs Node and npm's {', '.join(names)}")


def node(*words: object, cwd: Path) -> str:
    done = subprocess.run(
        ["node", *map(str, words)], cwd=cwd, capture_output=True, text=True, timeout=240, check=False
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A copy of the package, with its neighbours."""
    (tmp_path / "node_modules").symlink_to(PACKAGES)
    return Path(shutil.copytree(RUNTIME, tmp_path / "package"))


def test_what_it_names_is_there_and_the_version_is_everywhere_the_same() -> None:
    assert PACKAGE["version"] == __version__
    named = [
        path
        for entry in PACKAGE["exports"].values()
        for path in (entry.values() if isinstance(entry, dict) else [entry])
    ]
    assert all(
        (RUNTIME / path).is_file() for path in [*named, PACKAGE["customElements"], "LICENSE", "README.md"]
    )
    unreal = json.loads((RUNTIME.with_name("unreal") / "Metagraph.uplugin").read_bytes())
    assert unreal["VersionName"] == __version__
    godot = (RUNTIME.with_name("godot") / "addons" / "metagraph" / "plugin.cfg").read_text(encoding="utf-8")
    assert f'version="{__version__}"' in godot


def test_the_elements_manifest_says_what_the_element_has() -> None:
    manifest = json.loads((RUNTIME / PACKAGE["customElements"]).read_bytes())
    (element,) = manifest["modules"][0]["declarations"]
    source, types = ((RUNTIME / name).read_text(encoding="utf-8") for name in ("element.js", "element.d.ts"))
    read = {*re.findall(r'(?:get|has)Attribute\("([a-z]+)"\)', source)} - {"hidden"}
    assert {each["name"] for each in element["attributes"]} == read
    taken = types[types.index("interface MetagraphCharacterAttributes") : types.index("type InJsx")]
    assert {*re.findall(r"^  (\w+)\?:", taken, re.MULTILINE)} == read
    shown = types[
        types.index("class MetagraphCharacter ") : types.index("interface MetagraphCharacterAttributes")
    ]
    methods = {*re.findall(r"^  (\w+)\(", shown, re.MULTILINE)} - {"addEventListener"}
    assert {each["name"] for each in element["members"]} == methods
    assert {each["name"] for each in element["events"]} == {"load", "error", "begin", "end", "avatar"}


@pytest.mark.nightly
@needs("publint", "@arethetypeswrong/cli")
def test_npms_own_checkers_find_nothing(package: Path) -> None:
    """`publint` reads the package, `attw` its types as each kind of importer sees them. It has modules alone."""
    told = node(PACKAGES / "publint" / "src" / "cli.js", ".", "--strict", cwd=package)
    assert "All good!" in told
    attw = PACKAGES / "@arethetypeswrong" / "cli" / "dist" / "index.js"
    told = node(attw, "--pack", ".", "--profile", "esm-only", "--no-emoji", cwd=package)
    assert (
        told.count("OK (ESM)") >= len(PACKAGE["exports"]) - 1
    )  # it ends with an error where one has a problem


@needs("react", "react-dom")
def test_a_server_renders_the_component_as_the_empty_element(package: Path) -> None:
    script = package / "server.mjs"
    script.write_text(
        'import { createElement } from "react"; import { renderToString } from "react-dom/server";\n'
        'import { Character } from "./react.js"; import { load } from "./index.js";\n'
        "const props = { src: 'a.json', controls: true, paused: false, className: 'x', onBegin() {} };\n"
        "console.log(renderToString(createElement(Character, props)), typeof load);\n"
    )
    said = node("--preserve-symlinks", "--preserve-symlinks-main", script, cwd=package)
    assert (
        said.strip()
        == '<metagraph-character src="a.json" controls="" class="x"></metagraph-character> function'
    )


APP = """
import { createElement as h, useRef } from "react";
import { createRoot } from "react-dom/client";
import { Canvas } from "@react-three/fiber";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { load } from "./metagraph/index.js";
import { useCharacter } from "./metagraph/fiber.js";
import { Character } from "./metagraph/react.js";

const [json, glb] = [await (await fetch("sample.json")).text(), await (await fetch("sample.glb")).arrayBuffer()];
const { scene } = await new GLTFLoader().parseAsync(glb.slice(0), "");
const graph = load(json, glb);
window.told = { begun: [], turned: new Set() };
function Ada() {
  const object = useCharacter(graph, scene, { seed: 7 });
  window.told.missing = object.missing.length;
  window.object ??= object;
  return h("primitive", { object: scene });
}
function Page() {
  const element = useRef(null);
  const onLoad = () => element.current.say("Nice to meet you.");
  const onBegin = ({ layer, action }) => window.told.begun.push(`${layer} ${action}`);
  return h("div", null, h(Canvas, { style: { width: 90, height: 90 } }, h(Ada)),
    h(Character, { ref: element, src: "sample.json", idle: "off", style: { width: 90, height: 90 }, onLoad, onBegin }));
}
createRoot(document.getElementById("root")).render(h(Page));
window.done = (async () => {
  while (!(window.object?.time > 1 && window.told.begun.length && window.told.turned.size > 3)) {
    await new Promise((next) => setTimeout(next, 100));
    if (window.object) window.told.turned.add(scene.getObjectByName("Head").quaternion.x);
  }
  return { ...window.told, turned: window.told.turned.size };
})();
"""


@pytest.mark.nightly
@needs("react", "react-dom", "@react-three/fiber", "esbuild", "three")
def test_react_and_react_three_fiber_show_the_character(
    sample: Project, tmp_path: Path, browse: Browser
) -> None:
    registry.write_for_target(sample, "javascript", tmp_path, Contents(ADA))
    (tmp_path / "node_modules").symlink_to(PACKAGES)
    (tmp_path / "app.js").write_text(APP)
    bundle = [
        PACKAGES / "esbuild" / "bin" / "esbuild",
        "app.js",
        "--bundle",
        "--format=esm",
        "--outfile=bundle.js",
    ]
    done = subprocess.run(
        [*map(str, bundle), "--preserve-symlinks"], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    (tmp_path / "node_modules").unlink()
    (tmp_path / "index.html").write_text(
        '<!doctype html><link rel="icon" href="data:,"><div id="root"></div><script type="module" src="bundle.js"></script>'
    )
    ((found,), errors) = browse(tmp_path, {"url": "", "until": "window.done", "run": "window.done"})
    assert errors == []
    assert found["missing"] == 0 and found["turned"] > 3
    assert found["begun"][0] == "speech Nice to meet you."
