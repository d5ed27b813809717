"""The web page in a real browser: it plays what the preview shows, takes requests, shows the plan, and says
what is wrong.
"""

from __future__ import annotations

import base64
import io
import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from metagraph.engines.reading import read_export
from metagraph.engines.targets import registry, web
from metagraph.graph.model import Project
from metagraph.playback.extend_performance import hear
from metagraph.playback.plan import Plan
from metagraph.playback.player import pose_at

HERE = Path(__file__).parent
MODULES = HERE.parent / "node_modules"
SAMPLES = HERE.parents[1] / "sample_clips"
CONFORMANCE = HERE.parents[1] / "metagraph" / "engines" / "conformance"
CHROMIUM = os.environ.get("CHROMIUM") or next(
    (c for c in ("chromium", "chromium-browser", "google-chrome") if shutil.which(c)), None
)
SEED, TIME = 7, 12.3


def browse(folder: Path, *steps: dict[str, Any]) -> tuple[list[Any], list[str]]:
    """Run steps in a page of a folder; return the values its `run` steps gave, and the errors the browser
    told.
    """
    if CHROMIUM is None or shutil.which("node") is None or not (MODULES / "playwright-core").is_dir():
        pytest.skip("needs Chromium, Node and playwright-core (python3 run.py test fetches what it can)")
    script = folder / "steps.json"
    script.write_text(json.dumps(steps))
    environ = {**os.environ, "CHROMIUM": shutil.which(CHROMIUM) or CHROMIUM}
    done = subprocess.run(
        ["node", str(HERE / "run" / "browser.mjs"), str(folder), str(script)],
        capture_output=True,
        text=True,
        timeout=180,
        env=environ,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    return [row["value"] for row in rows if "value" in row], rows[-1]["errors"]


@pytest.fixture(scope="module")
def page(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    if not (MODULES / "three").is_dir():
        pytest.skip("needs three.js (python3 run.py test fetches it where npm is)")
    folder = tmp_path_factory.mktemp("web")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(web, "three_js", lambda place: MODULES / "three")
        report = registry.write(sample, "web", folder, SAMPLES / "ada.glb", base=SAMPLES)
    assert report.files[0] == folder / "index.html"
    return folder


OPEN = {"url": f"?seed={SEED}&paused", "until": "window.metagraph"}
SEEK = {"run": f"metagraph.seek({TIME})"}
JOINTS = """(() => { const out = {}; metagraph.object.scene.updateMatrixWorld(true);
  for (const { bone, joint } of metagraph.object.joints) {
    const e = bone.matrixWorld.elements;
    out[metagraph.object.character.graph.joints[joint]] = [e[12], e[13], e[14]];
  }
  return out; })()"""
PICTURE = """(() => { const { stage } = metagraph; stage.scene.background.set("#ff00ff");
  stage.scene.traverse((o) => { if (o.isMesh && !o.isSkinnedMesh) o.visible = false; });
  stage.draw(); return [stage.canvas.clientWidth, stage.canvas.clientHeight, stage.canvas.toDataURL("image/png")]; })()"""


def test_the_page_poses_the_character_as_the_preview_does_and_its_picture_matches(
    sample: Project, page: Path
) -> None:
    (_, joints, picture), errors = browse(page, OPEN, SEEK, {"run": JOINTS}, {"run": PICTURE})
    assert not errors
    project = read_export(page / "sample.json", resolved=True)
    assert project.skeleton is not None
    pose = pose_at(hear(project, Plan(SEED, 0.0), 0.0, [], 20.0), project, TIME)
    rotations, positions = project.skeleton.globals(pose)
    for place, joint in enumerate(project.skeleton.names):
        assert np.linalg.norm(np.array(joints[joint]) - positions[place]) < 1e-4, joint

    from app.cli.render_command import figure_of
    from preview.camera import Camera
    from preview.offscreen import Offscreen
    from preview.scene import Actor, Scene

    width, height, data = picture
    shown = np.asarray(Image.open(io.BytesIO(base64.b64decode(data.split(",")[1]))).convert("RGB"), int)
    theirs = np.abs(shown - [255, 0, 255]).sum(-1) > 40
    with Offscreen(width, height) as stage:
        actor = Actor(figure_of(sample, SAMPLES), rotations, positions)
        ours = (
            stage.render(
                Scene((actor,), ground=False, shadow=False, background=(0.0, 0.0, 0.0, 0.0)), Camera()
            )[..., 3]
            > 40
        )
    overlap = (ours & theirs).sum() / (ours | theirs).sum()
    assert overlap > 0.96, overlap


def test_buttons_ask_and_the_answers_and_the_plan_show_it(page: Path) -> None:
    state = """[metagraph.object.character.plan.layers.arms.cues.map((c) => [c.action.name, c.meta]),
      document.getElementById('answers').textContent]"""
    lanes = "(() => { const c = document.getElementById('lanes'); return c.toDataURL().length; })()"
    (before, _, after, pressed), errors = browse(
        page,
        {"url": f"?seed={SEED}&idle=0", "until": "window.metagraph"},
        {"run": lanes},
        {"click": "#panel button:text-is('greeting') >> nth=0"},
        {"click": "#panel button:text-is('arms crossed')"},
        {"wait": 400},
        {"run": lanes},
        {"run": state},
        {
            "until": "[...document.querySelectorAll('button[aria-pressed=true]')].some((b) => b.textContent "
            "=== 'arms crossed')"
        },
        {"run": "[...document.querySelectorAll('button[aria-pressed=true]')].map((b) => b.textContent)"},
    )
    assert not errors
    cues, answers = after
    assert [name for name, _ in cues][:2] == ["wave_hello_rt_01", "to arms crossed"]
    assert "greeting: planned" in answers and "arms crossed: late" in answers
    assert "arms crossed" in pressed
    assert before


def test_speech_moves_the_jaw_and_a_look_the_eyes(page: Path) -> None:
    turns = """Object.fromEntries(metagraph.object.joints.filter(({ bone }) => /Jaw|LeftEye/.test(bone.name))
      .map(({ bone }) => [bone.name, bone.quaternion.toArray()]))"""
    (rest, _, _, _, _, talking), errors = browse(
        page, {"url": f"?seed={SEED}&idle=0&paused", "until": "window.metagraph"}, {"run": turns},
        {"run": "metagraph.object.ask({ do: 'say', text: 'aaaaaaaaaaaaaa' })"},
        {"run": "metagraph.object.ask({ do: 'look', to: [2, 1.5, 1] })"},
        {"run": "metagraph.seek(0.4)"}, {"run": "metagraph.seek(0.6)"}, {"run": turns},
    )  # fmt: skip
    assert not errors
    for joint in ("Jaw", "LeftEye"):
        assert abs(np.dot(rest[joint], talking[joint])) < 0.9995


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_the_page_takes_the_systems_colours(page: Path, scheme: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SCHEME", scheme)
    (color,), errors = browse(page, OPEN, {"run": "getComputedStyle(document.body).backgroundColor"})
    assert not errors and color == {"dark": "rgb(23, 24, 27)", "light": "rgb(233, 235, 238)"}[scheme]


def test_what_is_missing_newer_or_cut_short_is_told_in_the_page(page: Path, tmp_path: Path) -> None:
    shutil.copytree(page, tmp_path / "page")
    data = json.loads((page / "sample.json").read_bytes())
    (tmp_path / "page" / "newer.json").write_text(json.dumps({**data, "metagraph": 99}))
    (tmp_path / "page" / "cut.json").write_text(json.dumps({**data, "glb": "cut.glb"}))
    (tmp_path / "page" / "cut.glb").write_bytes((page / "sample.glb").read_bytes()[:5000])
    wrong = "document.querySelector('#message.wrong')?.textContent"
    told, _ = browse(
        tmp_path / "page",
        *(
            step
            for name in ("nothing.json", "newer.json", "cut.json")
            for step in ({"url": f"?export={name}", "until": wrong}, {"run": wrong})
        ),
    )
    assert "not there (404)" in told[0] and "xport again" in told[0]
    assert "99" in told[1] and "pdate" in told[1]
    assert "cut.glb" in told[2] or "GLB" in told[2]


def test_the_vectors_hold_in_the_browser(page: Path, sample_export: Path, tmp_path: Path) -> None:
    shutil.copytree(page, tmp_path / "page")
    shutil.copy(
        HERE.parents[1] / "metagraph" / "engines" / "runtimes" / "javascript" / "conformance.mjs",
        tmp_path / "page" / "metagraph",
    )
    shutil.copytree(CONFORMANCE, tmp_path / "page" / "conformance")
    shutil.copytree(sample_export, tmp_path / "page" / "conformance" / "sample")
    (tmp_path / "page" / "vectors.html").write_text("<!doctype html><title>vectors</title>")
    run = """(async () => { const { runVectors } = await import("/metagraph/conformance.mjs"); const out = {};
      for (const name of ["stick", "varied", "sparse", "sample"]) {
        const at = `/conformance/${name}/`, vectors = await (await fetch(at + "vectors.json")).json();
        const glb = await (await fetch(at + vectors.export.replace(".json", ".glb"))).arrayBuffer();
        const found = runVectors(vectors, await (await fetch(at + vectors.export)).text(), new Uint8Array(glb));
        out[name] = [found.passed, found.failures.slice(0, 3)];
      } return out; })()"""
    (found,), errors = browse(tmp_path / "page", {"url": "vectors.html"}, {"run": run})
    assert [e for e in errors if "favicon" not in e and "404" not in e] == []
    for name, (passed, failures) in found.items():
        assert passed > 30 and not failures, name


# --- where three.js comes from


def test_three_js_is_found_above_the_folder_else_kept_else_named_on_the_net(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sample: Project
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "cache"))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(shutil, "which", lambda name: None)
    monkeypatch.chdir(tmp_path)
    assert web.three_js(tmp_path / "out") is None
    report = registry.write(sample, "web", tmp_path / "out")
    assert web.NET in (tmp_path / "out" / "index.html").read_text()
    assert any("three.js is not at hand" in words for words in report.warnings)
    for place in (web.kept(), tmp_path / "node_modules" / "three"):
        for name in web.NEEDED:
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_text("// three")
        assert web.three_js(tmp_path / "out") == place
    again = registry.write(sample, "web", tmp_path / "out")
    assert web.NET not in (tmp_path / "out" / "index.html").read_text()
    assert not any("three.js" in words for words in again.warnings)


def test_an_npm_that_fails_is_as_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: "/bin/false")
    assert web._fetched(tmp_path / "kept") is None


def test_lines_that_cannot_be_read_are_left_out_and_told(sample: Project, tmp_path: Path) -> None:
    report = registry.write(sample, "metagraph", tmp_path, base=tmp_path)
    assert sum("the sound of line" in words for words in report.warnings) == len(
        [x for x in sample.lines.values() if x.audio]
    )
    report = registry.write(sample, "metagraph", tmp_path, base=SAMPLES)
    lines = json.loads((tmp_path / "sample.json").read_bytes())["lines"]
    assert all((tmp_path / line["audio"]).is_file() for line in lines.values())
