"""Names of the roles of joints, as the window shows them."""

from __future__ import annotations

from app.translation import make_lazy_texts, tr

_BODY = make_lazy_texts(
    lambda: {
        "root": tr("root"),
        "hips": tr("hips"),
        "spine": tr("spine"),
        "chest": tr("chest"),
        "upper_chest": tr("upper chest"),
        "neck": tr("neck"),
        "head": tr("head"),
        "jaw": tr("jaw"),
        "eye": tr("eye"),
        "upper_lid": tr("upper lid"),
        "lower_lid": tr("lower lid"),
        "shoulder": tr("shoulder"),
        "upper_arm": tr("upper arm"),
        "lower_arm": tr("lower arm"),
        "hand": tr("hand"),
        "thumb": tr("thumb"),
        "index": tr("index finger"),
        "middle": tr("middle finger"),
        "ring": tr("ring finger"),
        "little": tr("little finger"),
        "upper_leg": tr("upper leg"),
        "lower_leg": tr("lower leg"),
        "foot": tr("foot"),
        "toes": tr("toes"),
    }
)


def describe_joint_role(role: str) -> str:
    """Return a role, such as "left_index_2", in words: "left index finger 2"."""
    side, _, rest = role.partition("_")
    name = rest if side in ("left", "right") else role
    base, _, last = name.rpartition("_")
    number = last if last.isdecimal() else ""
    name = base if number else name
    name, twist = name.removesuffix("_twist"), name.endswith("_twist")
    words = _BODY.get(name, name.replace("_", " "))
    if twist:
        words = tr("{part}, twist", part=words)
    if number:
        words = f"{words} {number}"
    if side == "left":
        return tr("left {part}", part=words)
    return tr("right {part}", part=words) if side == "right" else words
