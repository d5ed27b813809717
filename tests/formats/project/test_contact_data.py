from __future__ import annotations

import pytest

from metagraph.formats.project.contact_data import decode_contacts, encode_contacts
from metagraph.formats.project.fields import DataError
from metagraph.motion.contact_spans import ContactKey, ContactSpan

SPAN = ContactSpan(
    "left", "fingertips", "Chest", 0.25, 1.5,
    (
        ContactKey(0.25, (0.1, 0.2, 0.3), (0.0, 0.6, 0.0, 0.8)),
        ContactKey(1.0, (0.1, 0.2, 0.4), (0.0, 0.0, 0.0, 1.0)),
    ),
    0.2,
)  # fmt: skip


def test_contacts_come_back_as_they_were() -> None:
    data = encode_contacts([SPAN])
    assert decode_contacts({"contacts": data}, "a") == (SPAN,)
    assert "ease_out" not in data[0], "defaults are left out"


@pytest.mark.parametrize(
    "change",
    [
        {"hand": "third"},
        {"place": "knee"},
        {"start": 2.0},
        {"ease_in": -1.0},
        {"keys": []},
        {"keys": [[0.0, 0, 0, 0, 0, 0, 0, 0]]},
        {"keys": [[0.0, 0, 0, 0, 0, 0, 1]]},
        {"keys": ["x"]},
        {"keys": [[1.0, 0, 0, 0, 0, 0, 0, 1], [1.0, 0, 0, 0, 0, 0, 0, 1]]},
        {"more": 1},
    ],
)
def test_what_is_wrong_is_told_with_its_place(change: dict[str, object]) -> None:
    data = {**encode_contacts([SPAN])[0], **change}
    with pytest.raises(DataError) as error:
        decode_contacts({"contacts": [data]}, "actions[0]")
    assert error.value.where.startswith("actions[0].contacts[0]")
