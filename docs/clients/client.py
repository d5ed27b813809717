import json

from websockets.sync.client import connect

with connect("ws://127.0.0.1:8765") as line:
    for request in ({"do": "gesture", "tags": ["greeting"]}, {"do": "nod", "in": 2}):
        line.send(json.dumps(request))
        print(json.loads(line.recv()))
