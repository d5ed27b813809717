"""No two modules import each other, not even through others, inside functions or for types alone."""

import ast
from collections.abc import Iterator
from importlib.util import resolve_name
from pathlib import Path

ROOT = Path(__file__).parent.parent


def test_no_modules_import_each_other_in_a_circle() -> None:
    imports = imports_of_all(ROOT, ["app", "preview", "metagraph"])
    found = [" -> ".join(a_circle(imports, group)) for group in circles(imports)]
    assert not found, "\n".join(found)


def test_a_circle_through_a_function_is_named(tmp_path: Path) -> None:
    package = tmp_path / "house"
    package.mkdir()
    (package / "__init__.py").write_text("from house import door\n")
    (package / "door.py").write_text("def open():\n    from house.key import turn\n")
    (package / "key.py").write_text("from . import lock\n")
    (package / "lock.py").write_text("import house.door\n")
    imports = imports_of_all(tmp_path, ["house"])
    assert imports["house"] == {"house.door"}, "a package may import what is in it"
    (group,) = circles(imports)
    assert a_circle(imports, group) == ["house.door", "house.key", "house.lock", "house.door"]


def test_a_circle_for_types_alone_is_named(tmp_path: Path) -> None:
    package = tmp_path / "house"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "door.py").write_text("from house.key import Key\n")
    (package / "key.py").write_text(
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from house.door import Door\n"
    )
    imports = imports_of_all(tmp_path, ["house"])
    assert circles(imports) == [["house.door", "house.key"]]


def imports_of_all(root: Path, packages: list[str]) -> dict[str, set[str]]:
    """Map each module of the packages to those it imports."""
    paths = {module_name(root, path): path for package in packages for path in (root / package).rglob("*.py")}
    known = set(paths)
    return {name: {*imported(path, name, known)} - {name} for name, path in paths.items()}


def module_name(root: Path, path: Path) -> str:
    return ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")


def imported(path: Path, name: str, known: set[str]) -> Iterator[str]:
    """Yield the known modules that a module imports; `from package import module` names the module alone."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in statements(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)
        elif isinstance(node, ast.ImportFrom):
            source = resolve_name("." * node.level + (node.module or ""), package)
            for alias in node.names:
                inside = f"{source}.{alias.name}"
                if inside in known or source in known:
                    yield inside if inside in known else source


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the statements below a node."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, ast.expr):
            yield child
            yield from statements(child)


def circles(imports: dict[str, set[str]]) -> list[list[str]]:
    """Give the groups of modules in which each reaches all others."""
    reached = {name: reachable(imports, name) for name in imports}
    groups = {
        tuple(sorted(other for other in reached[name] if name in reached[other]))
        for name in imports
        if name in reached[name]
    }
    return sorted(list(group) for group in groups)


def reachable(imports: dict[str, set[str]], start: str) -> set[str]:
    found: set[str] = set()
    waiting = [start]
    while waiting:
        for name in imports[waiting.pop()] - found:
            found.add(name)
            waiting.append(name)
    return found


def a_circle(imports: dict[str, set[str]], group: list[str]) -> list[str]:
    """Give a shortest way from the group's first module back to it."""
    ways = [[group[0]]]
    for way in ways:
        for name in sorted(imports[way[-1]] & set(group)):
            if name == group[0]:
                return [*way, name]
            if all(name not in other for other in ways):
                ways.append([*way, name])
    raise AssertionError("the group has no circle")
