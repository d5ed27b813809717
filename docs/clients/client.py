import json
from websockets.sync.client import connect

with connect("ws://127.0.0.1:8765") as line:
    def ask(**request):
        line.send(json.dumps(request))
        return json.loads(line.recv())

    print(ask(do="gesture", tags=["greeting"]))
    print(ask(do="nod", **{"in": 2}))
