"""What clip an action was made of, by name and content, beside the clip's id.

Whoever merges two copies of a project by hand may keep one copy's clip and the other copy's action; the
action then plays a clip that nobody meant. So a project file stores with each action what its clip was when
the project was saved: `clip_name`, left out where the action has that name itself, and `clip_sha256`, the
first digits of the file's SHA-256. They are kept in memory only where they contradict the clip that the
action's id leads to; `check` reports that.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from metagraph.formats.project.fields import Data

DIGITS = 12  # of a SHA-256 in hex that tell one file of a project from another


def with_clip_identity(data: Data) -> Data:
    """Return a project's data, with the name and digest of its clip added to each action."""
    clips = {clip["id"]: clip for clip in data["clips"]}
    layers = {
        layer: {**graph, "actions": [_with_identity(action, clips) for action in graph["actions"]]}
        for layer, graph in data["layers"].items()
    }
    return {**data, "layers": layers}


def _with_identity(action: Data, clips: Mapping[str, Data]) -> Data:
    clip = clips.get(action["clip"])
    if clip is None or "clip_name" in action or "clip_sha256" in action:
        return action  # what it contradicts stays until a person decides
    known: Data = {}
    sha256 = clip.get("sha256", "")
    if clip["name"] != action["name"] or not sha256:
        known["clip_name"] = clip["name"]
    if sha256:
        known["clip_sha256"] = sha256[:DIGITS]
    return {"id": action["id"], "clip": action["clip"], **known, **action}


class _Clip(NamedTuple):
    name: str
    digest: str


def remove_clip_identities(data: Data) -> Data:
    """Return the data of a project file as it was before `with_clip_identity`."""
    clips = {clip["id"]: _Clip(clip["name"], clip.get("sha256", "")) for clip in data["clips"]}
    layers = {
        layer: {**graph, "actions": [remove_clip_identity(action, clips) for action in graph["actions"]]}
        for layer, graph in data["layers"].items()
    }
    return {**data, "layers": layers}


def remove_clip_identity(action: Data, clips: Mapping[str, Any]) -> Data:
    """Return an action's data without the name and the digest of its clip, unless they contradict the clip
    its id leads to.

    clips: id -> ClipEntry. A clip that was renamed, or whose file was replaced by another version, is the
    same clip; one of another name and another content is not.
    """
    if "clip_name" not in action and "clip_sha256" not in action:
        return action
    clip = clips.get(action.get("clip", ""))
    sha256, name = action.get("clip_sha256", ""), action.get("clip_name", action.get("name"))
    if clip is None or not isinstance(sha256, str):
        return action
    if clip.name == name or (sha256 and clip.digest.startswith(sha256)):
        return {key: value for key, value in action.items() if key not in ("clip_name", "clip_sha256")}
    return {**action, "clip_name": name}
