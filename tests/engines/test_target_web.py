"""The web page in a real browser: it plays what the preview shows, takes requests, shows the plan, and says
what is wrong.
"""

from __future__ import annotations

import base64
import io
import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from metagraph.engines.reading import read_export
from metagraph.engines.targets import registry, web
from metagraph.engines.targets.target import Contents
from metagraph.graph.model import Project
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import hear_asks
from tests.browsing import Browser
from tests.engines.avatars import make_avatar, without_legs
from tests.engines.web_tools_kept import kept_web_tools
from tests.posing import pose_at

HERE = Path(__file__).parent
SAMPLES = HERE.parents[1] / "sample_clips"
CONFORMANCE = HERE.parents[1] / "metagraph" / "engines" / "conformance"
SEED, TIME = 7, 12.3


@pytest.fixture(scope="module")
def page(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("web")
    with kept_web_tools(tmp_path_factory.mktemp("kept")):
        report = registry.write_for_target(sample, "web", folder, Contents(SAMPLES / "ada.glb", base=SAMPLES))
    assert report.files[0] == folder / "index.html"
    return folder


OPEN = {"url": f"?seed={SEED}&mode=&paused", "until": "window.metagraph"}
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


@pytest.mark.nightly
def test_the_page_poses_the_character_as_the_preview_does_and_its_picture_matches(
    sample: Project, page: Path, browse: Browser
) -> None:
    (_, joints, picture), errors = browse(page, OPEN, SEEK, {"run": JOINTS}, {"run": PICTURE})
    assert not errors
    project = read_export(page / "sample.json", resolved=True)
    assert project.skeleton is not None
    pose = pose_at(hear_asks(project, Plan(SEED, 0.0), 0.0, [], 20.0), project, TIME)
    rotations, positions = project.skeleton.globals(pose)
    for place, joint in enumerate(project.skeleton.names):
        assert np.linalg.norm(np.array(joints[joint]) - positions[place]) < 1e-4, joint

    from app.cli.render_command import load_figure
    from preview.camera import Camera
    from preview.offscreen import Offscreen
    from preview.scene import Actor, Scene

    width, height, data = picture
    shown = np.asarray(Image.open(io.BytesIO(base64.b64decode(data.split(",")[1]))).convert("RGB"), int)
    theirs = np.abs(shown - [255, 0, 255]).sum(-1) > 40
    with Offscreen(width, height) as stage:
        actor = Actor(load_figure(sample, SAMPLES), rotations, positions)
        ours = (
            stage.render(
                Scene((actor,), ground=False, shadow=False, background=(0.0, 0.0, 0.0, 0.0)), Camera()
            )[..., 3]
            > 40
        )
    overlap = (ours & theirs).sum() / (ours | theirs).sum()
    assert overlap > 0.96, overlap


@pytest.mark.nightly
def test_buttons_ask_and_the_answers_and_the_plan_show_it(page: Path, browse: Browser) -> None:
    state = """[metagraph.object.character.plan.layers.arms.cues.map((c) => [c.action.name, c.meta]),
      document.getElementById('answers').textContent]"""
    lanes = "(() => { const c = document.getElementById('lanes'); return c.toDataURL().length; })()"
    (before, _, after, pressed), errors = browse(
        page,
        {"url": f"?seed={SEED}&idle=0&panel", "until": "window.metagraph"},
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


@pytest.mark.nightly
def test_speech_moves_the_jaw_and_a_look_the_eyes(page: Path, browse: Browser) -> None:
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


@pytest.mark.nightly
@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_the_page_takes_the_systems_colours(browse: Browser, page: Path, scheme: str) -> None:
    (color,), errors = browse(
        page, OPEN, {"run": "getComputedStyle(document.body).backgroundColor"}, scheme=scheme
    )
    assert not errors and color == {"dark": "rgb(23, 24, 27)", "light": "rgb(233, 235, 238)"}[scheme]


@pytest.mark.nightly
def test_what_is_missing_newer_or_cut_short_is_told_in_the_page(
    page: Path, tmp_path: Path, browse: Browser
) -> None:
    shutil.copytree(page, tmp_path / "page")
    data = json.loads((page / "sample.json").read_bytes())
    (tmp_path / "page" / "newer.json").write_text(json.dumps({**data, "metagraph": 99}))
    (tmp_path / "page" / "cut.json").write_text(json.dumps({**data, "glb": "cut.glb"}))
    (tmp_path / "page" / "cut.glb").write_bytes((page / "sample.glb").read_bytes()[:5000])
    wrong = "document.querySelector('metagraph-character[broken]')?.message.textContent"
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


@pytest.mark.nightly
def test_the_vectors_hold_in_the_browser(
    page: Path, sample_export: Path, tmp_path: Path, browse: Browser
) -> None:
    shutil.copytree(page, tmp_path / "page")
    shutil.copytree(
        HERE.parents[1] / "metagraph" / "engines" / "runtimes" / "javascript", tmp_path / "page" / "metagraph"
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


README = (HERE.parents[1] / "metagraph" / "engines" / "runtimes" / "javascript" / "README.md").read_text()
FIVE_LINES = README.partition("```html\n")[2].partition("```")[0]


@pytest.mark.nightly
def test_a_character_is_in_any_page_in_five_lines(page: Path, tmp_path: Path, browse: Browser) -> None:
    """Offline, from files of the export alone; then in another page three of them."""
    shutil.copytree(page, tmp_path / "page")
    shutil.rmtree(tmp_path / "page" / "player")  # which only its own page needs
    (tmp_path / "page" / "talk.html").write_text(FIVE_LINES.replace('id="ada"', 'id="ada" idle="off"'))
    assert len(FIVE_LINES.splitlines()) == 5
    three = "".join(
        f'<metagraph-character id="{name}" src="{src}" camera="{camera}" style="width: 200px"></metagraph-character>'
        for name, src, camera in (
            ("a", "sample.json", "face front"),
            ("b", "sample.json", ""),
            ("c", "none.json", ""),
        )
    )
    (tmp_path / "page" / "three.html").write_text(
        f'{three}<script type="module" src="{web.CHARACTER}"></script>'
    )
    heard = """(() => { window.told = []; for (const kind of ["begin", "end"]) ada.addEventListener(kind, (e) => told.push(`${kind} ${e.detail.action}`)); })()"""
    sound = """(async () => { const rate = 16000, one = new AudioBuffer({ length: rate, sampleRate: rate, numberOfChannels: 1 });
      one.getChannelData(0).forEach((_, n, all) => (all[n] = n < rate / 2 ? 0 : 0.5 * Math.sin(n / 3)));
      const id = await ada.say("ah", { audio: one }); let speech;
      while (!(speech = ada.character.plan.track.speeches.find((s) => s.id === id))) await new Promise(requestAnimationFrame);
      return [ada.answer(id).state, speech.end - speech.start, Boolean(speech.timing)]; })()"""
    (_, early, said, told, spoken, asked, one, both, views, row), errors = browse(
        tmp_path / "page",
        {"url": "talk.html", "until": "window.customElements.get('metagraph-character')"},
        {"run": heard},
        {"run": "ada.ask({ do: 'gesture', tags: ['greeting'] })"},
        {"until": "ada.object"},
        {"click": "button"},
        {"wait": 500},
        {"run": "ada.answer('say#1').state"},
        {"until": "told.includes('begin Hello! How are you?') && told.some((words) => words.startsWith('begin wave'))"},
        {"run": "told.length > 1"},
        {"run": sound},
        {"run": "ada.describe().words.includes('say') && !ada.paused"},
        {"run": "(async () => { const one = ada; for (let n = 0; n < 3; n++) one.setAttribute('src', 'sample.json?' + n); "
         "one.remove(); document.body.append(one); await one.ready; return one.object.scene.parent === one.stage.scene; })()"},
        {"url": "three.html", "until": "a.object && b.object && c.hasAttribute('broken')"},
        {"run": "[a.character.graph === b.character.graph, c.message.textContent, a.getAttribute('camera')]"},
        {"run": "[a, b].map(({ stage }) => stage.camera.position.distanceTo(stage.target))"},
        {"run": "(() => { document.body.style.cssText = 'display: flex; margin: 0; height: 100vh'; "
         "for (const one of [a, b, c]) one.style.cssText = 'flex: 1'; return [c.getBoundingClientRect().right, innerWidth]; })()"},
    )  # fmt: skip
    assert [e for e in errors if "404" not in e and "none.json" not in e] == []
    assert early.startswith(("early#", "#")) and said == "planned" and told and asked
    state, seconds, timed = spoken
    assert state in ("planned", "late") and timed and abs(seconds - 1.0) < 0.1
    assert one and both[0] and "none.json is not there (404)" in both[1]
    assert views[0] < views[1] / 2  # the face from near
    assert row[0] <= row[1] + 0.5  # a row that shares its width is no wider than the window


@pytest.mark.nightly
def test_a_page_shows_another_look_changes_it_and_tells_what_cannot_be_used(
    page: Path, tmp_path: Path, browse: Browser
) -> None:
    """Ben, as Mixamo and as both versions of VRM write him, stands upright where Ada would, and moves as she
    does.
    """
    folder = tmp_path / "page"
    shutil.copytree(page, folder)
    make_avatar(folder / "mixamo.glb", "mixamo", unit=100)
    make_avatar(folder / "one.vrm", vrm=1)
    make_avatar(folder / "old.vrm", vrm=0, turned=True)
    without_legs(folder / "legless.glb")
    (folder / "junk.glb").write_bytes(b"no model at all")
    (folder / "look.html").write_text(
        '<metagraph-character id="a" src="sample.json" seed="7" paused camera="front" background="#ff00ff" '
        f'style="width: 500px"></metagraph-character><script type="module" src="{web.CHARACTER}"></script>'
    )
    heard = """(() => { window.told = []; a.addEventListener("error", (e) => told.push(e.detail.message));
      a.addEventListener("avatar", (e) => told.push(e.detail.avatar ? e.detail.missing.length : "own")); })()"""
    state = """[told.splice(0), a.object.scene.visible, a.object.avatar?.scene.visible ?? null, a.stage.scene.children.length,
      a.time, a.message.textContent, performance.getEntriesByType("resource").some((one) => one.name.endsWith("/avatar.js"))]"""
    picture = "(() => { a.stage.draw(); return a.stage.canvas.toDataURL('image/png'); })()"
    steps: list[dict[str, str]] = [{"url": "look.html", "until": "a.object"}, {"run": heard}]
    steps += [{"run": "a.seek(12.3)"}, {"run": picture}, {"run": state}]
    for look in ("mixamo.glb", "old.vrm", "one.vrm", "legless.glb", "junk.glb", "none.glb", ""):
        steps += [
            {"run": f"a.avatar = '{look}'"}, {"until": "told.length"}, {"run": picture}, {"run": state},
        ]  # fmt: skip
    values, errors = browse(folder, *steps)
    pictures = [value for value in values if isinstance(value, str) and value.startswith("data:")]
    own, mixamo, old, one, *failed, last = [
        value for value in values if isinstance(value, list) and len(value) == 7
    ]
    assert (
        own[1:4] == [True, None, own[3]] and not own[6]
    )  # nothing of avatars is fetched before there is one
    for said, own_seen, seen, objects, time, message, fetched in (mixamo, old, one):
        assert (own_seen, seen, objects, message, fetched) == (False, True, own[3] + 1, "", True)
        assert said == [7] and abs(time - 12.3) < 1e-6
    told = [state[0][0] for state in failed]
    assert "no humanoid" in told[0] and "cannot be used" in told[1] and "not there (404)" in told[2]
    for state_then in failed:
        assert state_then[1:4] == one[1:4] and state_then[5] == state_then[0][0]  # it stays as it was
    assert last[0] == ["own"] and last[1] and last[3] == own[3] and last[5] == ""
    seen = [
        np.asarray(Image.open(io.BytesIO(base64.b64decode(p.split(",")[1]))).convert("RGB"), int)
        for p in pictures
    ]
    ada, first, second, third, *_, again = [np.abs(p - [255, 0, 255]).sum(-1) > 60 for p in seen]
    assert (ada != again).mean() < 1e-3
    assert (first != second).mean() < 0.002 and (second != third).mean() < 0.002
    both = (ada & first).sum() / (ada | first).sum()
    assert 0.6 < both < 0.95, both  # he stands where she does, in other clothes
    assert [e for e in errors if "404" not in e and "cannot be used" not in e and "none.glb" not in e] == []


@pytest.mark.nightly
def test_lines_that_cannot_be_read_are_left_out_and_told(sample: Project, tmp_path: Path) -> None:
    report = registry.write_for_target(sample, "metagraph", tmp_path, Contents(base=tmp_path))
    assert sum("the sound of line" in words for words in report.warnings) == len(
        [x for x in sample.lines.values() if x.audio]
    )
    report = registry.write_for_target(sample, "metagraph", tmp_path, Contents(base=SAMPLES))
    lines = json.loads((tmp_path / "sample.json").read_bytes())["lines"]
    assert all((tmp_path / line["audio"]).is_file() for line in lines.values())
