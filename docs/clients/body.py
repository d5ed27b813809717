"""The body of an agent: a connection to `metagraph live` whose replies and events come together.

    async with Body("ws://127.0.0.1:8765") as body:
        print(await body.ask(do="nod"))

`python body.py` starts a line, interrupts it and prints the events. It needs `pip install websockets`.
"""

import asyncio
import base64
import json
import sys
from collections import deque

from websockets.asyncio.client import connect


class Body:
    """Ask for motion, and hear what becomes of it. on_event: called with each event, and with the reply to
    each request that the session could not read.
    """

    def __init__(self, address="ws://127.0.0.1:8765", name="agent", on_event=lambda event: None):
        self.address, self.name, self.on_event = address, name, on_event
        self.waiting = deque()  # replies come in the order of the requests

    async def __aenter__(self):
        self.line = await connect(self.address)
        self.reading = asyncio.create_task(self.read())
        await self.ask(do="hello", name=self.name, events=True)
        return self

    async def __aexit__(self, *_):
        await self.line.close()
        await self.reading

    async def read(self):
        async for text in self.line:
            message = json.loads(text)
            if "event" in message or "error" in message:
                self.on_event(message)
            if "event" not in message:
                reply = self.waiting.popleft()
                if not reply.done():  # whoever asked may have been cancelled
                    reply.set_result(message)
        for reply in self.waiting:
            reply.cancel()

    async def send(self, **request):
        """Send a request; return a future with its reply."""
        reply = asyncio.get_running_loop().create_future()
        self.waiting.append(reply)
        await self.line.send(json.dumps(request))
        return reply

    async def ask(self, **request):
        """Send a request; return its reply. Raises ValueError if the session cannot read it."""
        told = await (await self.send(**request))
        if "error" in told:
            raise ValueError(told["error"])
        return told

    async def hear(self, said, samples, rate):
        """Say sound under an id, of which more may come; return a future with the reply. samples: 16 bits
        each, of one channel, as bytes.
        """
        sound = base64.b64encode(samples).decode()
        return await self.send(do="say", id=said, audio=sound, rate=rate, more=True)


async def main(address):
    over = asyncio.Event()

    def heard(event):
        print(event["event"], event["id"], event.get("reason", ""))
        if event["event"] == "ended" and event["id"] == "answer":
            over.set()

    async with Body(address, on_event=heard) as body:
        await body.ask(do="say", id="answer", text="It rains all day, so take a coat with you.")
        await asyncio.sleep(1.0)
        print(await body.ask(do="interrupt", what="answer"))
        await over.wait()


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:2] or ["ws://127.0.0.1:8765"]))
