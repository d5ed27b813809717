"""XML read without what makes it dangerous: no document types, so no entities of one's own, no other files,
no endless trees.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from metagraph.graph.requests import RequestError

DEEPEST = 40  # elements within elements
MOST = 4000  # elements of one text
OURS = "metagraph:"  # the prefix of what BML has no word for


@dataclass
class Element:
    """name: local name as written; only our own prefix is kept. attributes: lower case. parts: texts and
    elements in order.
    """

    name: str
    attributes: dict[str, str]
    line: int
    parts: list[str | Element] = field(default_factory=list)

    def __iter__(self) -> Iterator[Element]:
        return (part for part in self.parts if isinstance(part, Element))

    def get(self, *names: str) -> str:
        """Return the first of these attributes that is there and not empty, else ""."""
        return next((value for name in names if (value := self.attributes.get(name, "").strip())), "")

    @property
    def place(self) -> str:
        """Where it stands, for messages."""
        return f"line {self.line}, <{self.name}>"


def parse_bml(text: str) -> Element:
    """Return the root element. Raises RequestError with line, cause and remedy."""
    parser = expat.ParserCreate("utf-8")
    stack: list[Element] = []
    roots: list[Element] = []
    count = 0

    def begin(name: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        line = parser.CurrentLineNumber
        if len(stack) >= DEEPEST:
            raise RequestError(f"line {line}: elements lie more than {DEEPEST} deep; make the block flatter")
        if count > MOST:
            raise RequestError(f"line {line}: there are more than {MOST} elements; send several blocks")
        element = Element(_local(name), {_local(k).lower(): v for k, v in attributes.items()}, line)
        (stack[-1].parts if stack else roots).append(element)
        stack.append(element)

    def words(data: str) -> None:
        if stack:
            stack[-1].parts.append(data)

    def doctype(*_: object) -> None:
        raise RequestError(
            f"line {parser.CurrentLineNumber}: a block has no <!DOCTYPE ...> and no entities of its own; "
            "leave them out"
        )

    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda _: stack.pop()
    parser.CharacterDataHandler = words
    parser.StartDoctypeDeclHandler = doctype
    parser.buffer_text = True
    try:
        parser.Parse(text.encode("utf-8", "replace"), True)
    except expat.ExpatError as error:
        raise RequestError(f"line {error.lineno}: not XML: {expat.ErrorString(error.code)}") from None
    except ValueError as error:
        raise RequestError(f"not XML: {error}") from None
    return roots[0]


def _local(name: str) -> str:
    return name if name.startswith(OURS) else name.rpartition(":")[2]
