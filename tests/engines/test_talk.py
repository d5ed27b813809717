"""Text with gestures in JavaScript: the same gestures as in Python, asked for and performed, and in a page."""

from __future__ import annotations

import json
import shutil
import subprocess
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

from metagraph.engines.targets import registry
from metagraph.engines.translation.gesture_word_lists import make_gesture_word_modules
from metagraph.graph.model import Project
from metagraph.speech.text_gestures import TextStream, load_gesture_words, propose_gestures, timed_words
from tests.browsing import Browser
from tests.engines.web_tools_kept import kept_web_tools
from tests.speech.test_text_gestures import SPOKEN, TEXTS, tags_of

ROOT = Path(__file__).resolve().parents[2]
RUNTIME = ROOT / "metagraph" / "engines" / "runtimes" / "javascript"
ODD = (
    "",
    "…",
    "3.5 times? No! “Well”, she said; 'tis 𝒷ig — and so-called ﬁne, isn’t it?",
    "i i i i you you you. NO NO NO! hello hello hello hello",
    "Ümläute ß ẞ İ ı 日本語 그리고 हिन्दी: yes, really, a very long clause without much in it",
    "a\nb\n\nno\n",
)
SCRIPT = """
import { readFileSync } from "node:fs";
import { Character, Talk, load } from "%(runtime)s/index.js";
import { ALPHABET } from "%(runtime)s/alphabet.js";
import { ToldWord, wordsOf } from "%(runtime)s/word_gestures.js";
const asked = JSON.parse(readFileSync(0, "utf8"));
const json = readFileSync(asked.json), glb = readFileSync(asked.glb);
const graph = load(json.toString(), glb.buffer.slice(glb.byteOffset, glb.byteOffset + glb.length));
const cases = asked.cases.map(([language, text, told, seconds, seed]) => {
  const talk = new Talk(new Character(graph, { seed: 3 }), { language, seed });
  const times = told.map(([, start, end]) => new ToldWord(start, end));
  const words = wordsOf(ALPHABET, text, times, seconds);
  return [words, talk.proposed(words)];
});
const streams = asked.texts.map((text) => {
  const character = new Character(graph, { seed: 3 });
  const talk = new Talk(character, { seed: 0, name: "text" });
  const asks = [];
  const ask = character.ask.bind(character);
  character.ask = (request) => (asks.push(request), ask(request));
  const said = [];
  for (const letter of text) said.push(...talk.take(letter));
  said.push(...talk.take("", true));
  const first = said.flatMap(({ id, gestures }) => [id, ...gestures]);
  const states = {};
  for (let t = 0; t < talk.free + 2; t += 0.1) {
    character.update(t);
    for (const id of first) states[id] = character.answer(id).state;
  }
  return { asks, states };
});
console.log(JSON.stringify({ cases, streams }));
"""


Case = tuple[str, str, list[tuple[str, float, float]], float | None, int]


def cases() -> list[Case]:
    """Texts, each with times that lips take, that a synthesiser told, and stretched to a length."""
    every = [("en", text) for text in (*TEXTS, *ODD)] + [(code, text) for code, (text, _) in SPOKEN.items()]
    out: list[Case] = []
    for n, (language, text) in enumerate(every):
        told = [(w.text, 0.3 * k, 0.3 * k + 0.2) for k, w in enumerate(timed_words(text))][:-1]
        out += [(language, text, [], None, n), (language, text, told, None, n), (language, text, [], 7.5, n)]
    return out


@pytest.fixture(scope="module")
def told(sample_export: Path) -> Any:
    """What Node says."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("needs Node")
    files = {kind: str(sample_export / f"sample.{kind}") for kind in ("json", "glb")}
    done = subprocess.run(
        [node, "--input-type=module", "-e", SCRIPT % {"runtime": RUNTIME.as_uri()}],
        input=json.dumps({**files, "cases": cases(), "texts": TEXTS}),
        capture_output=True,
        text=True,
        timeout=60,
        encoding="utf-8",
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def rounded(value: Any) -> Any:
    return json.loads(json.dumps(value), parse_float=lambda x: round(float(x), 9), parse_int=float)


@pytest.mark.nightly
def test_words_and_their_gestures_are_those_of_python(told: Any, sample: Project) -> None:
    some = 0
    for (language, text, times, seconds, seed), (words, gestures) in zip(cases(), told["cases"], strict=True):
        mine = timed_words(text, times, seconds)
        assert rounded([asdict(w) for w in mine]) == rounded(words), text
        made = propose_gestures(mine, tags_of(sample), load_gesture_words(language), seed)
        assert rounded([asdict(g) for g in made]) == rounded(gestures), text
        some += len(made)
    assert some > 60


@pytest.mark.nightly
def test_text_that_comes_in_letter_by_letter_asks_for_what_python_asks_and_most_is_performed(
    told: Any, sample: Project
) -> None:
    states: list[str] = []
    for text, found in zip(TEXTS, told["streams"], strict=True):
        stream = TextStream(tags_of(sample), load_gesture_words("en"))
        wanted = [r for letter in text for r in stream.take(letter, 0.0)] + stream.take("", 0.0, over=True)
        got = [{k: v for k, v in ask.items() if k in wanted[n]} for n, ask in enumerate(found["asks"])]
        assert [r["id"] for r in wanted] == [ask["id"] for ask in found["asks"]]
        for mine, theirs in zip(wanted, got, strict=True):
            assert mine.keys() == theirs.keys()
            for key, value in mine.items():
                close = isinstance(value, float) and abs(value - theirs[key]) < 1e-3
                assert close or value == theirs[key], (text, key)
        states += found["states"].values()
    assert len(states) > 20 and states.count("refused") < 0.2 * len(states), states


def test_the_lists_of_words_are_made_of_the_files() -> None:
    for place, text in make_gesture_word_modules().items():
        assert place.read_text(encoding="utf-8") == text, (
            "make them anew (docs/contributing/translating-the-runtimes.md)"
        )


@pytest.mark.nightly
def test_an_agent_in_a_page_talks_with_gestures(
    sample: Project, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, browse: Browser
) -> None:
    """The page of the docs beside an export: told something, it answers sentence by sentence."""
    with kept_web_tools(tmp_path_factory.mktemp("kept")):
        registry.write_for_target(sample, "web", tmp_path)
    page = ROOT / "docs" / "clients" / "talking_agent.html"
    assert len(page.read_text(encoding="utf-8").splitlines()) <= 60
    shutil.copy(page, tmp_path / "talking_agent.html")
    say = """(async () => { const ada = document.querySelector("#ada"); await ada.ready; ada.paused = true;
      document.querySelector("input").value = "let us build a boat";
      document.querySelector("form").requestSubmit();
      await new Promise((done) => { const look = () => ada.talk.count === 3 ? done() : setTimeout(look, 20); look(); });
      return ada.talk.free; })()"""
    play = """(() => { const ada = document.querySelector("#ada"); const seen = [];
      for (let t = 0; t < 12; t += 0.1) { ada.object.update(0.1); seen.push(...ada.object.events()); }
      return seen.filter((one) => one.kind === "begin").map((one) => [one.layer, one.action, one.meta]); })()"""
    (free, begun), errors = browse(
        tmp_path,
        {"url": "talking_agent.html", "until": "window.customElements.get('metagraph-character')"},
        {"run": say},
        {"run": play},
    )
    assert not errors
    said = [action for layer, action, _ in begun if layer == "speech"]
    assert len(said) == 3 and "let us build a boat" in said[1] and 6 < free < 12
    gestures = [meta for layer, _, meta in begun if layer != "speech" and meta.startswith("said#")]
    assert len(gestures) >= 2, begun  # the arms may be at something else when a sentence comes


@pytest.mark.nightly
def test_an_agent_in_a_page_stops_when_the_microphone_hears_somebody(
    sample: Project, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, browse: Browser
) -> None:
    """The microphone is an oscillator, first as quiet as a room, then as loud as a voice."""
    with kept_web_tools(tmp_path_factory.mktemp("kept")):
        registry.write_for_target(sample, "web", tmp_path)
    shutil.copy(ROOT / "docs" / "clients" / "barge_in.html", tmp_path)
    microphone = """navigator.mediaDevices.getUserMedia = async () => {
      const context = new AudioContext(), gain = new GainNode(context, { gain: 0.005 });
      const hum = new OscillatorNode(context, { frequency: 180 }), out = new MediaStreamAudioDestinationNode(context);
      hum.connect(gain).connect(out);
      hum.start();
      window.voice = gain.gain;
      return out.stream;
    }; 1"""
    ada = "document.querySelector('#ada')"
    speeches = f"{ada}.character.plan.track.speeches"
    (_, before, _, after), errors = browse(
        tmp_path,
        {"url": "barge_in.html", "until": f"{ada}.talk"},
        {"run": microphone},
        {"click": "button"},
        {"until": f"window.voice && {speeches}.some((one) => one.start + 0.5 < {ada}.time)"},
        {"run": f"[{ada}.time, {speeches}.at(-1).end]"},
        {"run": "window.voice.value = 0.3; 1"},
        {"until": "document.querySelector('output').value.startsWith('You have')"},
        {"wait": 500},
        {"run": f"[{ada}.time, {speeches}.at(-1)?.end ?? 0, {ada}.talk.free, {ada}.talk.text]"},
    )
    assert not errors
    assert before[1] > before[0] + 2, "she had more to say"
    assert after[1] < after[0], "and says it no longer"
    assert after[2:] == [0, ""], "what is said next begins at once"
