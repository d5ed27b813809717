"""Roles of joints in words: sides, numbers and twists, in each language."""

from __future__ import annotations

import pytest

from app import translation
from app.look.joint_roles import describe_joint_role
from metagraph.motion.roles import ROLES


@pytest.mark.parametrize(
    ("role", "words"),
    [
        ("hips", "hips"),
        ("upper_chest", "upper chest"),
        ("left_upper_arm", "left upper arm"),
        ("right_index_2", "right index finger 2"),
        ("left_lower_arm_twist_1", "left lower arm, twist 1"),
        ("left_tail", "left tail"),
        ("", ""),
    ],
)
def test_a_role_is_told_with_its_side_and_number(role: str, words: str) -> None:
    assert describe_joint_role(role) == words


def test_every_role_has_words_in_german(request: pytest.FixtureRequest) -> None:
    english = [describe_joint_role(role) for role in ROLES]
    request.addfinalizer(lambda: translation.choose("en"))
    translation.choose("de")
    assert describe_joint_role("left_lower_arm") == "Unterarm links"
    assert [describe_joint_role(r) for r in ROLES if describe_joint_role(r) in english] == []
