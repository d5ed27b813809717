"""The web player: a folder that any static server can serve, with a page and the character it shows."""

from __future__ import annotations

from metagraph.engines.targets.runtimes import BML, RUNTIMES, copied, written
from metagraph.engines.targets.target import ExportOrder, ExportTarget, Loss, Made
from metagraph.engines.targets.web_tools import NEEDED, NET, THREE, bundled, tools
from metagraph.formats.atomic import write_atomically
from metagraph.wording import told

CHARACTER = "metagraph-character.js"  # the element, and with it all that it needs
_WHOSE = f"/*! Metagraph's player with three.js {THREE}, MIT, threejs.org */\n".encode()
_MODULES = f'export * from "./metagraph/element.js"; // which imports three.js {THREE}\n'.encode()


def write(order: ExportOrder) -> Made:
    """Write export, page and player: the character's element as one file where three.js and esbuild can be
    had, else as modules, which without three.js load it from the net.
    """
    made = written(order)
    page = (RUNTIMES / "web" / "index.html").read_text(encoding="utf-8")
    page = page.replace("EXPORT.json", f"{order.stem}.json")
    files = [*copied(RUNTIMES / "web" / "player", order.folder / "player")]
    notes = list(made.notes)
    modules = tools(order.folder)
    whole = bundled(modules, RUNTIMES / "javascript" / "element.js") if modules is not None else None
    element = order.folder / CHARACTER
    files.append(element)
    where = ""
    if whole is not None:
        write_atomically(element, _WHOSE + whole)
    else:
        write_atomically(element, _MODULES)
        leave = ("conformance.mjs", "conformance.d.mts")
        files += copied(RUNTIMES / "javascript", order.folder / "metagraph", leave)
        at = "./three/"
        if modules is None:
            at = NET
            notes.append(
                told(
                    "three.js is not at hand: the page loads it from the net. With npm installed, "
                    "exporting again puts it beside the page"
                )
            )
        else:
            for name in NEEDED:
                files.append(order.folder / "three" / name)
                write_atomically(files[-1], (modules / "three" / name).read_bytes())
        where = (
            f'<script type="importmap">{{ "imports": {{ "three": "{at}build/three.module.js", '
            f'"three/addons/": "{at}examples/jsm/" }} }}</script>'
        )
    page = page.replace("<!-- three.js -->", where)
    early = [
        f'<link rel="preload" href="{order.stem}.{kind}" as="fetch" crossorigin>' for kind in ("json", "glb")
    ]
    early += [
        f'<link rel="modulepreload" href="{path.relative_to(order.folder).as_posix()}">'
        for path in files
        if path.suffix == ".js"
    ]
    page = page.replace(
        "<!-- fetch early -->", "\n    ".join(early)
    )  # else each module waits for the one that names it
    index = order.folder / "index.html"
    write_atomically(index, page.encode())
    return Made((index, *made.files, *files), tuple(notes))


TARGETS = (
    ExportTarget(
        "web",
        told("Web page"),
        told(
            "a folder for any static server: a page, the character as an element for any other, JSON and GLB"
        ),
        write,
        (BML, Loss(told("the picture: light and floor are the page's own, the motion is the same"))),
        group=told("Played as the preview does"),
        unpacks=True,
    ),
)
