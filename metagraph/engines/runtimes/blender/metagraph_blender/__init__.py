# SPDX-License-Identifier: GPL-3.0-or-later
# This add-on uses Blender's Python interface (bpy), so it is under the GPL; Metagraph itself is under the
# MIT licence.
"""Metagraph in Blender: an export with its labels in, edited and new actions out, poses of a live session."""

bl_info = {
    "name": "Metagraph",
    "author": "Metagraph",
    "version": (0, 1, 0),
    "blender": (4, 2, 0),
    "location": "3D View and Dope Sheet > Sidebar > Metagraph",
    "description": "Conversational characters: actions with labels, sent back and live",
    "category": "Animation",
}


def register() -> None:
    """Called by Blender."""
    from . import panel

    panel.register()


def unregister() -> None:
    """Called by Blender."""
    from . import panel

    panel.unregister()
