"""A process that speaks as `metagraph.formats.filmed.estimator_child` does, without MediaPipe: in bright
pictures it sees the person of the sample keypoints at that time, in black ones nobody.

What its folder, the word it is started with, holds says how it fails: a file `broken` lets it refuse to
begin, `dies` lets it end at the second picture, `babbles` lets it answer with no JSON. A file `from` says how
many seconds of the person to pass over.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from metagraph.common.child_channel import connect_to_parent
from metagraph.formats.filmed.estimator_child import HEAD

RECORDED = Path(__file__).resolve().parents[3] / "sample_clips" / "keypoints" / "conversation.mediapipe.jsonl"


def main() -> None:
    channel, folder = connect_to_parent(), Path(sys.argv[1])
    if (folder / "broken").exists():
        channel.send(b'{"error": "libEGL.so.1: cannot open shared object file"}')
        return
    channel.send(b"nonsense" if (folder / "babbles").exists() else b'{"estimator": "Stand-in 1"}')
    frames = [json.loads(line) for line in RECORDED.read_text(encoding="utf-8").splitlines()[1:]]
    begin = float((folder / "from").read_text()) if (folder / "from").exists() else 0.0
    count = 0
    while True:
        try:
            content = channel.receive()
        except EOFError:
            return
        count += 1
        if count == 2 and (folder / "dies").exists():
            return
        seconds, height, width = HEAD.unpack_from(content)
        assert len(content) == HEAD.size + height * width * 3
        answer = {"time": seconds}
        if max(content[HEAD.size :]) > 100:
            marks = frames[min(round((begin + seconds) * 10), len(frames) - 1)]["worldLandmarks"]
            space = [[m["x"], m["y"], m["z"], m["visibility"]] for m in marks]
            answer["worldLandmarks"] = space
            answer["landmarks"] = [[500 + 200 * x, 500 + 200 * y, 200 * z, sure] for x, y, z, sure in space]
        channel.send(json.dumps(answer).encode())


if __name__ == "__main__":
    main()
