"""`python -m sample_clips.make.props`: make the props of the samples again, the same to the byte.

All sizes are metres: of furniture as shops sell it, of a cup and a telephone as they lie on a desk.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import trimesh
from trimesh.visual.material import PBRMaterial
from trimesh.visual.texture import TextureVisuals

PROPS = Path(__file__).resolve().parents[1] / "props"
# Linear colours, all quiet: the character is what is looked at.
WOOD, DARK_WOOD = (0.30, 0.19, 0.11), (0.13, 0.08, 0.05)
METAL, BLACK = (0.20, 0.21, 0.23), (0.02, 0.02, 0.025)
CLOTH, WALL = (0.16, 0.20, 0.25), (0.46, 0.45, 0.43)
WHITE, CLAY, LEAF, EARTH = (0.72, 0.71, 0.68), (0.35, 0.14, 0.08), (0.08, 0.20, 0.06), (0.05, 0.035, 0.025)

Three = Sequence[float]


def block(size: Three, at: Three, colour: Three) -> trimesh.Trimesh:
    """Return a box. size: `[3]`; at: the middle of its bottom, `[3]`."""
    mesh = trimesh.creation.box(size)
    mesh.apply_translation([at[0], at[1] + size[1] / 2, at[2]])
    return paint(mesh, colour)


def turned(
    profile: Sequence[tuple[float, float]], at: Three, colour: Three, sides: int = 24
) -> trimesh.Trimesh:
    """Return a profile of (radius, height) turned round the vertical. at: where its axis meets height 0."""
    mesh = trimesh.creation.revolve(np.array(profile, float), sections=sides)
    mesh.apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, [1, 0, 0]))
    mesh.apply_translation(at)
    return paint(mesh, colour)


def paint(mesh: trimesh.Trimesh, colour: Three) -> trimesh.Trimesh:
    """Give a mesh a colour, linear 0..1."""
    material = PBRMaterial(
        baseColorFactor=[round(255 * x) for x in colour] + [255], metallicFactor=0.0, roughnessFactor=0.8
    )
    mesh.visual = TextureVisuals(material=material)
    return mesh


def legs(wide: float, deep: float, high: float, thick: float, colour: Three) -> list[trimesh.Trimesh]:
    """Return four legs below the corners of a top."""
    x, z = wide / 2 - thick, deep / 2 - thick
    return [block((thick, high, thick), (sx * x, 0, sz * z), colour) for sx in (-1, 1) for sz in (-1, 1)]


def desk() -> list[trimesh.Trimesh]:
    return [
        block((1.4, 0.03, 0.7), (0, 0.71, 0), WOOD),
        block((1.3, 0.25, 0.02), (0, 0.44, -0.28), DARK_WOOD),
        *legs(1.4, 0.7, 0.71, 0.05, METAL),
    ]


def chair() -> list[trimesh.Trimesh]:
    back = block((0.42, 0.30, 0.02), (0, 0.60, -0.21), WOOD)
    posts = [block((0.035, 0.45, 0.03), (side * 0.19, 0.45, -0.21), DARK_WOOD) for side in (-1, 1)]
    return [
        block((0.44, 0.03, 0.44), (0, 0.42, 0), WOOD),
        back,
        *posts,
        *legs(0.44, 0.44, 0.42, 0.035, DARK_WOOD),
    ]


def bench() -> list[trimesh.Trimesh]:
    slats = [block((1.5, 0.03, 0.09), (0, 0.42, z), WOOD) for z in (-0.15, -0.05, 0.05, 0.15)]
    feet = [block((0.05, 0.42, 0.38), (side * 0.6, 0, 0), METAL) for side in (-1, 1)]
    return [*slats, *feet]


def lectern() -> list[trimesh.Trimesh]:
    top = block((0.6, 0.025, 0.45), (0, 0, 0), WOOD)
    top.apply_transform(trimesh.transformations.rotation_matrix(np.radians(15), [1, 0, 0]))
    top.apply_translation([0, 1.12, 0])
    return [
        top,
        block((0.34, 1.08, 0.28), (0, 0.03, 0), DARK_WOOD),
        block((0.5, 0.03, 0.42), (0, 0, 0), DARK_WOOD),
        block((0.58, 0.03, 0.02), (0, 1.07, 0.22), DARK_WOOD),
    ]


def wall() -> list[trimesh.Trimesh]:
    return [block((4.0, 2.6, 0.1), (0, 0, 0), WALL), block((4.0, 0.08, 0.02), (0, 0, 0.06), WHITE)]


def plant() -> list[trimesh.Trimesh]:
    pot = turned([(0, 0), (0.13, 0), (0.17, 0.30), (0.15, 0.30), (0.14, 0.26), (0, 0.26)], (0, 0, 0), CLAY)
    earth = turned([(0, 0.262), (0.139, 0.262)], (0, 0, 0), EARTH)
    leaves = []
    for n in range(14):
        leaf = trimesh.creation.icosphere(subdivisions=1)
        leaf.apply_scale([0.045, 0.26 + 0.03 * (n % 3), 0.012])
        leaf.apply_translation([0, 0.26, 0])
        lean = np.radians(16 + 13 * (n % 4))
        leaf.apply_transform(trimesh.transformations.rotation_matrix(lean, [1, 0, 0]))
        leaf.apply_transform(trimesh.transformations.rotation_matrix(n * 2.4, [0, 1, 0]))
        leaf.apply_translation([0, 0.25, 0])
        leaves.append(paint(leaf, [c * (0.8 + 0.1 * (n % 4)) for c in LEAF]))
    return [pot, earth, *leaves]


def cup() -> list[trimesh.Trimesh]:
    body = turned(
        [(0, 0), (0.028, 0), (0.04, 0.02), (0.041, 0.095), (0.037, 0.095), (0.036, 0.02), (0, 0.008)],
        (0, 0, 0),
        WHITE,
    )
    handle = trimesh.creation.torus(0.024, 0.005, major_sections=20, minor_sections=8)
    handle.apply_translation([0.046, 0.05, 0])
    return [body, paint(handle, WHITE)]


def phone() -> list[trimesh.Trimesh]:
    return [
        block((0.072, 0.15, 0.008), (0, 0, 0), BLACK),
        block((0.066, 0.138, 0.001), (0, 0.006, 0.0045), METAL),
    ]


def microphone() -> list[trimesh.Trimesh]:
    handle = turned([(0, 0), (0.011, 0), (0.017, 0.15), (0, 0.15)], (0, 0, 0), BLACK)
    head = trimesh.creation.icosphere(subdivisions=2, radius=0.026)
    head.apply_translation([0, 0.168, 0])
    return [handle, paint(head, METAL)]


MADE: dict[str, Callable[[], list[trimesh.Trimesh]]] = {
    made.__name__: made for made in (desk, chair, bench, lectern, wall, plant, cup, phone, microphone)
}


def make_props(folder: Path) -> list[Path]:
    """Write all props into a folder; return their files."""
    folder.mkdir(parents=True, exist_ok=True)
    out = []
    for name, make in MADE.items():
        scene = trimesh.Scene()
        for n, part in enumerate(make()):
            scene.add_geometry(part, geom_name=f"{name} {n}", node_name=f"{name} {n}")
        path = folder / f"{name}.glb"
        path.write_bytes(scene.export(file_type="glb"))
        out.append(path)
    return out


if __name__ == "__main__":
    for written in make_props(PROPS):
        print(f"{written.name}: {written.stat().st_size / 1e3:.0f} kB")
