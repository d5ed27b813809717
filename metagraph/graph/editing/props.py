"""Edits of props. Pure functions: a project in, a project out."""

from __future__ import annotations

from dataclasses import replace

from metagraph.common.wording import phrase
from metagraph.graph.edit_error import EditError
from metagraph.graph.ids import derive_id
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop

MOST = 100  # props of a project


def add_prop(project: Project, prop: Prop) -> tuple[Project, str]:
    """Return the project with another prop, and the prop's id. Raises EditError if it has `MOST` already."""
    if len(project.props) >= MOST:
        raise EditError(phrase("A project has at most {most} props. Remove one first.", most=MOST))
    ident, number = derive_id("o", prop.path), 1
    while ident in project.props:  # the same file once more
        ident, number = derive_id("o", prop.path, number), number + 1
    return replace(project, props={**project.props, ident: prop}), ident


def set_prop(project: Project, ident: str, prop: Prop) -> Project:
    """Return the project with a changed prop. Raises EditError if it is not there, or for a joint that the
    skeleton has not.
    """
    if ident not in project.props:
        raise EditError(phrase("This prop is no longer in the project."))
    if prop.joint and (project.skeleton is None or prop.joint not in project.skeleton):
        raise EditError(phrase("The character has no joint '{joint}'.", joint=prop.joint))
    return replace(project, props={**project.props, ident: prop})


def remove_prop(project: Project, ident: str) -> Project:
    """Return the project without a prop; its file stays."""
    return replace(project, props={key: prop for key, prop in project.props.items() if key != ident})


def find_palm(project: Project, joint: str) -> tuple[float, float, float]:
    """Return where in a joint's space a prop is carried, metres: the middle of what is below it, which is the
    palm of a hand; the joint itself if nothing is below it.
    """
    skeleton = project.skeleton
    if skeleton is None or joint not in skeleton:
        return 0.0, 0.0, 0.0
    below = [skeleton.rest_translations[child] for child in skeleton.children[skeleton.names.index(joint)]]
    if not below:
        return 0.0, 0.0, 0.0
    x, y, z = (round(float(value), 4) for value in sum(below) / len(below))
    return x, y, z
