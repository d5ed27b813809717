"""Talk with a character: each line you type is answered by voice, lips and gestures.

Start `metagraph live sample.metagraph.yaml`, then `python talking_agent.py sample.metagraph.yaml`.
"""

import base64
import json
import subprocess
import sys
import wave

from websockets.sync.client import connect

from metagraph.formats.store import open_project
from metagraph.speech.text_gestures import make_gesture_requests, propose_gestures, timed_words

project = open_project(sys.argv[1]).project
tags = {layer: {t for x in graph.actions.values() for t in x.tags} for layer, graph in project.graphs.items()}


def answer(text: str) -> str:
    """Your language model goes here."""
    return f"Hello! You said: {text}. That is a really big idea, but maybe we should think about it first."


with connect("ws://127.0.0.1:8765") as line:

    def ask(**request) -> dict:
        line.send(json.dumps(request))
        return json.loads(line.recv())

    for number, heard in enumerate(sys.stdin):
        said, text = f"said{number}", answer(heard.strip())
        subprocess.run(["espeak-ng", "-w", "said.wav", text], check=True)  # or any other voice
        with wave.open("said.wav") as sound:
            rate, samples = sound.getframerate(), sound.readframes(sound.getnframes())
        pieces = [base64.b64encode(samples[n : n + 40_000]).decode() for n in range(0, len(samples), 40_000)]
        told = [ask(do="say", id=said, audio=piece, rate=rate) for piece in pieces]
        words = timed_words(text, seconds=len(samples) / 2 / rate)
        made = [
            ask(**request)
            for request in make_gesture_requests(propose_gestures(words, tags), told[0]["at"], said)
        ]
        print(text, *(x.get("actions", x.get("why")) for x in made), sep="\n  ", flush=True)
