"""Remember the user's joint maps between projects, in a JSON file beside the recent projects."""

from __future__ import annotations

import json
from pathlib import Path

from app.project.autosave import state_folder
from metagraph.formats.atomic import write_atomically
from metagraph.motion.joint_map import JointMap, RetargetError

MOST = 100  # maps; the oldest are removed first


def _place() -> Path:
    return state_folder() / "joint_maps.json"


def read_joint_maps() -> dict[tuple[str, str], JointMap]:
    """Return the maps by the fingerprints of source and target, the latest last; damaged ones are skipped."""
    try:
        rows = json.loads(_place().read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    out: dict[tuple[str, str], JointMap] = {}
    for row in rows if isinstance(rows, list) else []:
        try:
            found = JointMap.from_json(row)
        except RetargetError:
            continue  # one of another version does not affect the others
        out[found.source, found.target] = found
    return out


def keep_map(joint_map: JointMap) -> None:
    """Remember a map. Raises FileError."""
    maps = read_joint_maps()
    maps.pop((joint_map.source, joint_map.target), None)
    rows = [found.to_json() for found in [*maps.values(), joint_map][-MOST:]]
    write_atomically(_place(), json.dumps(rows).encode())
