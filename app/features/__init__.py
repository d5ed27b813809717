"""The features: each a folder that exports `contribute(shell)`, and none knows another.

A feature is taken out by deleting its folder and its line here. The order is that of panels in a dock and of
commands in a group.
"""

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
    "study",
    "guide",
    "welcome",
    "help",
)
