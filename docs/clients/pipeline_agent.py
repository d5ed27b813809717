"""Give an agent that is a pipeline of frames (pipecat, and others like it) a body: frames in, the same out.

Put it behind the voice, before the output. Frames are known by pipecat's names, see `PipelineBody.take`.
"""

import array

from body import Body

from metagraph.speech.text_gestures import make_gesture_requests, propose_gestures, timed_words


class PipelineBody:
    """body: a connection to `metagraph live`. tags: layer -> the tags of the character's gestures."""

    def __init__(self, body: Body, tags):
        self.body, self.tags = body, tags
        self.count = 0
        self.begin()

    def begin(self):
        """Begin an utterance."""
        self.count += 1
        self.said, self.start, self.text, self.gestures = f"said{self.count}", None, "", 0
        self.heard = self.told = 0.0  # seconds of sound that came, and of those whose text came, too

    async def take(self, frame):
        """Do what a frame means for the body."""
        kind = type(frame).__name__
        if kind == "TTSAudioRawFrame":
            samples = array.array("h", frame.audio)[:: frame.num_channels].tobytes()
            reply = await self.body.hear(self.said, samples, frame.sample_rate)
            if self.start is None:  # only the first reply is waited for: frames must not queue up here
                self.start = (await reply)["at"]
            self.heard += len(samples) / 2 / frame.sample_rate
        elif kind == "TTSTextFrame":
            self.text = f"{self.text} {frame.text}".strip()
            if self.text.endswith((".", "!", "?", "…")):
                await self.gesture()
        elif kind == "TTSStoppedFrame" and self.start is not None:
            await self.gesture()
            await self.body.ask(do="finish", what=self.said)
            self.begin()
        elif kind in ("InterruptionFrame", "StartInterruptionFrame"):
            await self.body.ask(do="interrupt")  # all: sound comes faster than it plays
            self.begin()

    async def gesture(self):
        """Ask for gestures on the words that came last, as long as their sound."""
        text, self.text = self.text, ""
        if not text or self.start is None or self.heard <= self.told:
            return
        words = timed_words(text, seconds=self.heard - self.told)
        made = propose_gestures(words, self.tags, seed=self.count)
        asks = make_gesture_requests(made, self.start + self.told, self.said, self.gestures)
        self.told, self.gestures = self.heard, self.gestures + len(asks)
        for request in asks:
            await self.body.ask(**request)
