"""Give a speech-to-speech model a body: it sends sound without words, and says when the user speaks.

Pass each event that comes over the model's connection to `RealtimeBody.take`; send the events that it returns
back over that connection. The names are those of OpenAI's Realtime API, which others share.
"""

import base64

from body import Body

RATE = 24_000  # of the sound that comes


class RealtimeBody:
    """body: a connection to `metagraph live`."""

    def __init__(self, body: Body):
        self.body = body
        self.item = ""  # what is said now: the model's item, and our utterance

    async def take(self, event):
        """Carry out an event of the model; return the events to answer with."""
        kind = event["type"]
        if kind in ("response.output_audio.delta", "response.audio.delta"):
            self.item = event["item_id"]
            await self.body.hear(self.item, base64.b64decode(event["delta"]), RATE)
        elif kind in ("response.output_audio.done", "response.audio.done"):
            await self.body.ask(do="finish", what=event["item_id"])
        elif kind == "response.output_audio_transcript.delta" and event["delta"].rstrip().endswith(
            (".", "!")
        ):
            await self.body.ask(do="gesture", id=f"{event['item_id']}/0", tags=["beat"], late=1)
        elif kind == "input_audio_buffer.speech_started":
            return await self.interrupt([{"type": "response.cancel"}])
        elif kind == "output_audio_buffer.cleared":
            return await self.interrupt([])
        return []

    async def interrupt(self, answers):
        """Break off what is said, and have the model forget what nobody heard."""
        if not self.item:
            return []
        said, self.item = self.item, ""
        told = await self.body.ask(do="interrupt", what=said)
        if "skip" in told:
            end = round(1000 * told["skip"])
            cut = {
                "type": "conversation.item.truncate",
                "item_id": said,
                "content_index": 0,
                "audio_end_ms": end,
            }
            answers.append(cut)
        return answers
