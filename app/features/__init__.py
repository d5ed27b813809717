"""The features: each a folder that exports `contribute(shell)`, and none knows another.

A feature is taken out by deleting its folder and its line here. The order is that of panels in a dock and of
commands in a group.
"""

from metagraph.common.studio import Studio
from metagraph.common.wording import phrase

FEATURES = (
    "files",
    "library",
    "graph",
    "character",
    "editing",
    "twins",
    "taking",
    "repairs",
    "properties",
    "notes",
    "table",
    "manual",
    "labelling",
    "motion_graph",
    "generation",
    "life",
    "timeline",
    "mimic",
    "conversation",
    "models",
    "lines",
    "timing_editor",
    "problems",
    "agents",
    "machine",
    "behaviour",
    "compatibility",
    "skeleton",
    "retargeting",
    "export",
    "render",
    "props",
    "parameters",
    "study",
    "guide",
    "welcome",
    "help",
)
NEEDED = ("files", "help")  # without these nobody could work


def check_studio_features(studio: Studio) -> Studio:
    """Return a studio's defaults without the features that are unknown or needed; each is a problem."""
    for name in studio.hidden_features:
        if name in NEEDED or name not in FEATURES:
            cause = phrase("the feature '{name}' cannot be hidden", name=name)
            names = ", ".join(each for each in FEATURES if each not in NEEDED)
            studio = studio.with_problem(
                f"hide/features/{name}", cause, phrase("Known are {names}.", names=names)
            )
    return studio
