"""The web player: a folder that any static server can serve, with a page and the character it shows."""

from __future__ import annotations

from metagraph.common.wording import phrase
from metagraph.engines.targets.runtimes import BML, RUNTIMES, copy_runtime, write_with_sounds
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.engines.targets.typed_wrappers import write_wrapper
from metagraph.engines.targets.web_tools import (
    NET,
    THREE,
    bundle_module,
    import_map,
    is_three_at_hand,
    read_three,
)
from metagraph.formats.atomic import write_atomically

CHARACTER = "metagraph-character.js"  # the element, and with it all that it needs
AVATAR = "avatar.js"  # what other looks need, which the element imports for the first of them
_WHOSE = f"/*! Metagraph's player with three.js {THREE}, MIT, threejs.org */\n".encode()
_HOST = NET.split("/")[2]
_FROM_THE_NET = f"""<p id="net">
        This page loads three.js {THREE} from {_HOST}; the browser checks its digest.
      </p>
      <script>
        addEventListener("error", ({{ target }}) => {{
          if (target.tagName !== "SCRIPT") return;
          const said = document.getElementById("net");
          said.setAttribute("role", "alert");
          said.textContent = "The character cannot be shown: three.js {THREE} could not be loaded " +
            "from {_HOST}, or what came is not that version. Connect to the net and load the page again; " +
            "exported with npm installed, it has three.js with it.";
        }}, true);
      </script>"""
_MODULES = f'export * from "./metagraph/element.js"; // which imports three.js {THREE}\n'.encode()


def write(order: ExportOrder) -> ExportedFiles:
    """Write export, page and player: the character's element as one file where three.js and esbuild can be
    had, else as modules, which without three.js load it from the net.
    """
    made = write_with_sounds(order)
    page = (RUNTIMES / "web" / "index.html").read_text(encoding="utf-8")
    page = page.replace("EXPORT.json", f"{order.stem}.json")
    files = [*copy_runtime(RUNTIMES / "web" / "player", order.folder / "player")]
    files += write_wrapper(order, "javascript")
    notes = list(made.notes)
    runtime = RUNTIMES / "javascript"
    whole = bundle_module(runtime / "element.js", (f"./{AVATAR}",)) if is_three_at_hand() else None
    looks = bundle_module(runtime / AVATAR) if whole is not None else None
    element = order.folder / CHARACTER
    files.append(element)
    where = said = ""
    if whole is not None and looks is not None:
        write_atomically(element, _WHOSE + whole)
        files.append(order.folder / AVATAR)
        write_atomically(files[-1], looks)
    else:
        write_atomically(element, _MODULES)
        leave = ("conformance.mjs", "conformance.d.mts")
        files += copy_runtime(runtime, order.folder / "metagraph", leave)
        theirs = read_three()
        for name, content in (theirs or {}).items():
            files.append(order.folder / "three" / name)
            write_atomically(files[-1], content)
        where = import_map("./three/" if theirs is not None else NET, checked=theirs is None)
        if theirs is None:
            said = _FROM_THE_NET
            notes.append(
                phrase(
                    "three.js was not found: the page loads version {version} from the internet, and the "
                    "browser checks its digest. To include three.js, install npm and export again",
                    version=THREE,
                )
            )
    page = page.replace("<!-- three.js -->", where).replace("<!-- from the net -->", said)
    early = [
        f'<link rel="preload" href="{order.stem}.{kind}" as="fetch" crossorigin>' for kind in ("json", "glb")
    ]
    early += [
        f'<link rel="modulepreload" href="{path.relative_to(order.folder).as_posix()}">'
        for path in files
        # avatars' modules only pages with an avatar need
        if path.suffix == ".js" and "avatar" not in (path.stem, path.parent.name)
    ]
    page = page.replace(
        "<!-- fetch early -->", "\n    ".join(early)
    )  # else each module waits for the one that names it
    index = order.folder / "index.html"
    write_atomically(index, page.encode())
    return ExportedFiles((index, *made.files, *files), tuple(notes))


TARGETS = (
    ExportTarget(
        "web",
        phrase("Web page"),
        phrase(
            "a folder for any static server: a page, the character as an element for other pages, "
            "JSON and GLB"
        ),
        write,
        (
            BML,
            Loss(
                phrase("not the same picture: the page has its own light and floor; the motion is the same")
            ),
        ),
        group=phrase("Same playback as the preview"),
        unpacks=True,
        packs=True,
    ),
)
