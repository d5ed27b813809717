"""The label report in a browser, from a file, and the command it gives to open a clip."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from app.cli.label_report import format_label_report, list_open_commands
from app.cli.parser import main
from metagraph.formats.store import read_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.suggest.accept import AcceptedProposals
from metagraph.suggest.proposal import Proposals
from tests.projects import clip

ROOT = Path(__file__).resolve().parents[3]
CLIPS = ROOT / "sample_clips" / "clips"
CHROMIUM = os.environ.get("CHROMIUM") or next(
    (c for c in ("chromium", "chromium-browser", "google-chrome") if shutil.which(c)), None
)
HANDS = """
const seen = () => [...document.querySelectorAll('.card:not([hidden])')].map(c => c.querySelector('b').textContent);
const put = (id, value) => { const f = document.getElementById(id); f.value = value; f.dispatchEvent(new Event('input')); };
const out = {all: seen()};
put('find', 'SHRUG'); out.found = seen(); out.sections = document.querySelectorAll('section:not([hidden])').length;
put('find', ''); put('kind', 'transition'); out.transitions = seen();
document.getElementById('all').click(); out.again = seen().length;
put('sort', 'name'); out.sorted = [...document.querySelectorAll('section')].map(s => [...s.querySelectorAll('.card b')].map(b => b.textContent));
put('sort', ''); out.unsorted = seen();
const stance = document.querySelectorAll('.stances button');
out.stances = [...stance].map(b => b.textContent);
stance[0].click(); out.first = seen(); out.pressed = stance[0].getAttribute('aria-pressed'); stance[0].click(); out.off = seen().length;
const open = document.querySelector('.open'); open.click();
out.command = open.nextElementSibling.textContent; out.shown = !open.nextElementSibling.hidden; out.words = open.textContent;
document.body.innerHTML = ''; const pre = document.createElement('pre'); pre.id = 'out'; pre.textContent = JSON.stringify(out); document.body.append(pre);
"""


@pytest.fixture(scope="module")
def labelled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of two stances' clips with a blank in its name, labelled; return the project file."""
    folder = tmp_path_factory.mktemp("re port") / "talk"
    folder.mkdir()
    for path in CLIPS.glob("*.glb"):
        if path.name.startswith(("hands_at_sides__", "on_hips__")) and not any(
            other in path.name for other in ("crossed", "chin", "clasped")
        ):
            shutil.copy(path, folder)
    assert main(["label", str(folder), "--no-pictures", "--play", "0", "--json"]) == 0
    return folder.with_name("talk.metagraph.yaml")


@pytest.mark.nightly
def test_the_page_filters_sorts_and_tells_of_each_stance(labelled: Path, tmp_path: Path) -> None:
    if CHROMIUM is None:
        pytest.skip("needs Chromium")
    text = labelled.with_name("talk.labels.html").read_text()
    page = tmp_path / "page.html"
    page.write_text(text.replace("</body>", f"<script>{{{HANDS}}}</script></body>"))
    done = subprocess.run(
        [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'home'}",
         "--dump-dom", page.as_uri()],
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    found = re.search(r"<pre id=\"out\">(.*?)</pre>", done.stdout, re.S)
    assert found, done.stderr[-2000:]
    import html

    out: dict[str, Any] = json.loads(html.unescape(found[1]))
    project = read_project(labelled)
    names = [e.name for e in project.clips.values()]
    assert sorted(out["all"]) == sorted(names) == sorted(out["unsorted"])
    assert out["unsorted"] == out["all"]
    assert out["found"] and all("shrug" in name for name in out["found"]) and out["sections"] <= 2
    assert sorted(out["transitions"]) == sorted(n for n in names if "__to__" in n)
    assert out["again"] == out["off"] == len(names)
    assert all(group == sorted(group, key=str.lower) for group in out["sorted"])
    assert len(out["stances"]) == sum(len(g.stances) for g in project.graphs.values())
    assert any(re.search(r"hands at sides.*▲ \d+ gestures.*➜ 1 out, 1 in", s) for s in out["stances"])
    assert out["first"] and len(out["first"]) < len(names) and out["pressed"] == "true"
    words = shlex.split(out["command"])
    assert words[:3] == ["metagraph", "window", str(labelled)] and words[3] == "--clip"
    assert words[4] in names and out["shown"] and "terminal" in out["words"]


def test_a_command_survives_any_name(tmp_path: Path) -> None:
    names = ['it\'s a; rm "x" $HOME', "-dash", "twin", "twin"]
    project = edits.add_clips(Project(), [(f"{n}.glb", 0, "", clip(name)) for n, name in enumerate(names)])
    entries = list(project.clips.values())
    project = edits.rename_clip(project, entries[3].id, "twin")
    commands = list_open_commands(project, project.clips, tmp_path / "a b.yaml")
    asked = [shlex.split(commands[e.id])[-1] for e in entries]
    assert asked[0] == entries[0].name
    assert asked[1:] == [e.id for e in entries[1:]]


def test_what_was_left_aside_stands_at_the_end_by_reason_with_a_count() -> None:
    project = edits.add_clips(
        Project("p"), [(f"{n}.glb", 0, "", clip(name)) for n, name in enumerate(("a<b>", "run", "jog"))]
    )
    one, two, three = project.clips
    aside = {one: "name says 'x<y'", two: "goes 2.0 m away", three: "goes 3.5 m away"}
    taken = AcceptedProposals(project, (), {})
    page = format_label_report(project, Proposals({}, {}, aside), taken, {})
    assert "<h2 id='aside'>Skipped (3)</h2>" in page
    assert "2 clips: goes 2.0 to 3.5 m away" in page and "(run, jog)" in page
    assert "1 clip: name says &#x27;x&lt;y&#x27;" in page and "a&lt;b&gt;" in page and "a<b>" not in page
    assert page.index("2 clips: goes") < page.index("1 clip: name")
    assert "Left aside" not in format_label_report(project, Proposals({}, {}), taken, {})


def test_what_else_happened_is_listed_by_title_and_empty_lists_are_left_out() -> None:
    taken = AcceptedProposals(Project("p"), (), {})
    lists = {"Seen when it was played": ["a < b", "c"], "Not joined": []}
    page = format_label_report(Project("p"), Proposals({}, {}), taken, {}, lists)
    assert "<h2>Seen when it was played</h2><ul><li>a &lt; b</li><li>c</li></ul>" in page
    assert "Not joined" not in page


def test_times_are_those_of_the_labelled_project_and_what_repeats_does_not_play_once(toy: Any) -> None:
    from metagraph.suggest.propose import accept, propose

    rest, wave = toy.clip("idle", 4.0, 0.0, swing=0.02), toy.clip("wave", 0.6, 1.4, 1.4, swing=0.5)
    project = edits.add_clips(Project("p"), [(f"{c.name}.glb", 0, "", c) for c in (rest, wave)])
    found = propose(project)
    taken = accept(project, found)
    ident = next(i for i, e in project.clips.items() if e.name == "wave")
    (action,) = taken.project.uses[ident]
    assert action.timing.repeat > 0 and action.timing.blend_in != found.proposals[ident].timing["blend_in"]
    page = format_label_report(project, found, taken, {})
    card = page[page.index("data-name='wave'") :].split("<div class='card'")[0]
    assert f"blend in {action.timing.blend_in:.2f} s" in card
    assert f"repeat {action.timing.repeat:.2f} s" in card
    assert "plays once" not in card and "longer, to come from its stance" in card


WINDOW = """
import sys
from pathlib import Path
from PySide6.QtCore import QTimer
from app.main import open_window, prepare_application
app = prepare_application()
window = open_window(Path(sys.argv[1]), clip=sys.argv[2])
session = window.shell.stage.session

def watch():
    project = window.shell.document.project
    if project.clips and not window.shell.jobs.running and window.places.ready:
        chosen = [project.clips[i].name for i in session.selection.clips]
        print(chosen, session.transport.show, window.statusBar().currentMessage(), flush=True)
        window.close()
        app.quit()

timer = QTimer(interval=50)
timer.timeout.connect(watch)
timer.start()
QTimer.singleShot(60000, lambda: app.exit(9))
sys.exit(app.exec())
"""


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("hands_at_sides__shrug_bt_01", "['hands_at_sides__shrug_bt_01'] clip"),
        ("nobody", "There is no clip 'nobody' in talk."),
    ],
)
def test_the_window_opens_on_a_clip(
    labelled: Path, tmp_path: Path, qapp: object, name: str, wanted: str
) -> None:
    done = subprocess.run(
        [sys.executable, "-c", WINDOW, str(labelled), name],
        cwd=ROOT,
        env={**os.environ, "XDG_DATA_HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=90,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert wanted in done.stdout and "Traceback" not in done.stderr
