"""Which of the window's commands are offered while a task is worked on: what edits and shows, the same in both conditions."""

from __future__ import annotations

from app.features.manual.manual_place import META_ONLY
from app.shell.commands import CONVERSATION

# Other clips, other projects, other files: everybody works on the same. Twins and motion graphs make clips, conversations bring sounds
# and other characters. What changes how the window works stays.
FILES = frozenset({
    "new", "open", "sample", "practice", "save", "save_as", "import", "import_files", "annotate", "watch", "find_missing", "character",
    "no_character", "export", "render", "twins", "repairs", "skeleton", "joint_maps", "live", "mimic", "study", "count_operators", "manual",
    "motion_graph", *CONVERSATION, "other_side", "graph_again", "keep_conversation",
})  # fmt: skip
PROPOSALS = frozenset({"propose", "use_times", "patterns", "compatibility"})  # made by the program, for neither condition or both


def offered(command: str, mode: str, labels: bool) -> bool:
    """Return whether a command is offered. mode: what is edited; labels: proposals are allowed."""
    if command in FILES or (command in PROPOSALS and not labels):
        return False
    return mode == "meta" or command not in META_ONLY
