"""What a project says of hands that touch the body: whether contacts hold, whether hands stay out of it."""

from __future__ import annotations

from msgspec import Struct

from metagraph.motion.body_capsules import BodyPart


class Touch(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """contacts: whether hands are kept where actions' contacts say. guard: whether hands and forearms are
    kept out of the body and of each other. parts: the body's, as measured; found from the skeleton if there
    are none.
    """

    contacts: bool = True
    guard: bool = False
    parts: tuple[BodyPart, ...] = ()
