"""Take a folder of clips without labels to a checked export, as an agent does it: through `metagraph author`.

    python author_folder.py CLIPS_FOLDER NEW.metagraph.yaml [COMMAND ...]

COMMAND starts the server, `metagraph author` unless it is given. Needs nothing but Python. What is written
here as rules is what a language model decides by looking.
"""

from __future__ import annotations

import base64
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

META = {
    "io.modelcontextprotocol/protocolVersion": "2026-07-28",
    "io.modelcontextprotocol/clientCapabilities": {},
    "io.modelcontextprotocol/clientInfo": {"name": "author_folder", "version": "1"},
}


class Author:
    """A connection to the server."""

    def __init__(self, command: list[str]) -> None:
        self.server = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.number = 0

    def ask(self, method: str, **params: Any) -> dict[str, Any]:
        """Send a request and return its result. Raises RuntimeError for an error of the protocol."""
        self.number += 1
        message = {"jsonrpc": "2.0", "id": self.number, "method": method, "params": {**params, "_meta": META}}
        self.server.stdin.write(json.dumps(message) + "\n")
        self.server.stdin.flush()
        while True:
            line = self.server.stdout.readline()
            if not line:
                raise RuntimeError("the server has ended")
            told = json.loads(line)
            if told.get("id") == self.number:
                break
        if "error" in told:
            raise RuntimeError(told["error"]["message"])
        return told["result"]

    def call(self, tool: str, **arguments: Any) -> tuple[dict[str, Any], list[bytes]]:
        """Call a tool; return what it told and its pictures. Raises RuntimeError with the reason if it cannot
        be done.
        """
        result = self.ask("tools/call", name=tool, arguments=arguments)
        if result["isError"]:
            raise RuntimeError(f"{tool}: {result['content'][0]['text']}")
        images = [base64.b64decode(x["data"]) for x in result["content"] if x["type"] == "image"]
        return result["structuredContent"], images

    def close(self) -> None:
        self.server.stdin.close()
        self.server.wait(60)


def main(folder: Path, project: Path, command: list[str]) -> None:
    author = Author([*command, str(project), "--folder", str(folder)])
    told, _ = author.call("import_clips", paths=[str(folder)])
    print("imported:", told["notes"][0])
    told, _ = author.call("list_clips", only="unlabelled", count=500)
    print("clips:", told["total"], "with measures, of", round(sum(x["seconds"] for x in told["clips"])), "s")
    told, _ = author.call("propose_labels")
    likely = sum(x["sure"] >= 0.5 for x in told["proposals"])
    print(
        "proposals:",
        len(told["proposals"]),
        "of them likely:",
        likely,
        "skipped:",
        len(told.get("skipped", ())),
    )

    # One step for all of it, tried without keeping anything first.
    calls = [{"tool": "accept_proposals"}, {"tool": "find_problems", "arguments": {"least": "warning"}}]
    told, _ = author.call("run_script", calls=calls, dry_run=True)
    print("dry run:", told["results"][0]["notes"][0], "and then", told["results"][1]["counts"])
    author.call("run_script", calls=calls[:1], name="Label the folder")

    # Play it; mend what a viewer would see, as long as that takes nothing away.
    for _ in range(3):
        found, _ = author.call("find_problems", play=60, least="warning")
        print("problems:", found["counts"])
        mendable = [x["id"] for x in found["problems"] if x.get("fix") and not x.get("takes_away")]
        if not mendable:
            break
        told, _ = author.call("fix_problem", problems=mendable, play=60)
        print("mended:", "; ".join(told["notes"]))

    try:
        told, (picture,) = author.call("look", seconds=6, pictures=12, width=160)
        project.with_name("seen.png").write_bytes(picture)
        print("looked:", len(told["moments"]), "moments, in seen.png")
    except RuntimeError as no_pictures:
        print(no_pictures)
    told, _ = author.call("count_rates", seconds=600)
    print("rates:", ", ".join(f"{x['name']} {x['value']} {x['unit']}" for x in told["rates"][:4]))
    told, _ = author.call("export", folder="game")
    print("exported:", told["clips"], "clips;", "; ".join(told["verified"]))
    told, _ = author.call("history")
    print("steps:", "; ".join(told["done"]))
    author.close()


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]), sys.argv[3:] or ["metagraph", "author"])
