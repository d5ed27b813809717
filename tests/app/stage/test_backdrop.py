"""What is behind the character of a project: read, drawn, chosen in the window, told when it is not there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from app.cli.parser import main
from app.cli.render_command import make_render_look
from app.stage.backdrop import SIDE, read_back_picture, read_backdrop, set_backdrop
from metagraph.common.network_paths import close_path
from metagraph.errors import FileError
from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.journal import find_changes
from metagraph.formats.project.paths import list_project_files, move_project
from metagraph.formats.store import open_project, save_project
from metagraph.graph.backdrop import Backdrop
from metagraph.graph.editing.differences import describe_differences
from metagraph.graph.editing.props import add_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop
from preview.camera import Camera
from preview.looks import look_of
from preview.offscreen import Offscreen
from preview.scene import LIGHT, Scene


@pytest.fixture
def photo(tmp_path: Path) -> Path:
    pixels = np.zeros((40, 80, 3), np.uint8)
    pixels[:20], pixels[20:] = (200, 40, 40), (40, 40, 200)
    path = tmp_path / "photo.png"
    Image.fromarray(pixels).save(path)
    return path


@pytest.mark.parametrize(
    "backdrop",
    [
        Backdrop(),
        Backdrop(kind="room"),
        Backdrop(kind="color", color=(16, 32, 48)),
        Backdrop(kind="picture", path="a/photo.png"),
    ],
)
def test_a_background_is_saved_with_the_project_and_a_step_of_its_own(backdrop: Backdrop) -> None:
    project = Project(backdrop=backdrop)
    data = to_data(project)
    assert ("backdrop" in data) == (backdrop != Backdrop())
    assert from_data(data).backdrop == backdrop
    assert find_changes(Project(), project).get("backdrop", {}) == data.get("backdrop", {})
    assert bool(describe_differences(Project(), project)) == (backdrop != Backdrop())


def test_the_picture_goes_where_the_project_goes_and_to_no_other_computer(tmp_path: Path) -> None:
    project = Project(backdrop=Backdrop(kind="picture", path="photo.png"))
    assert list_project_files(project, tmp_path) == (tmp_path / "photo.png",)
    moved = move_project(project, tmp_path / "a.metagraph.yaml", tmp_path / "in" / "a.metagraph.yaml")
    assert moved.backdrop.path == "../photo.png"
    away = from_data(to_data(Project(backdrop=Backdrop(kind="picture", path="//server/photo.png"))))
    assert away.backdrop.path == close_path("//server/photo.png") != "//server/photo.png"
    with pytest.raises(FileError, match="another computer"):
        read_back_picture(Path(away.backdrop.path))


def test_a_missing_picture_is_told_when_the_project_is_opened(tmp_path: Path) -> None:
    path = tmp_path / "a.metagraph.yaml"
    save_project(Project(backdrop=Backdrop(kind="picture", path="gone.png")), path)
    assert any("gone.png" in note and "background" in note for note in open_project(path).notes)


def test_a_picture_is_upright_not_too_large_and_read_again_when_it_changes(tmp_path: Path) -> None:
    path = tmp_path / "wide.jpg"
    exif = Image.Exif()
    exif[0x0112] = 6  # turned by a quarter
    Image.new("RGB", (2 * SIDE, 100), (10, 20, 30)).save(path, exif=exif)
    found = read_back_picture(path)
    assert found.pixels.shape[0] == SIDE and found is read_back_picture(path)
    Image.new("RGB", (30, 20)).save(path)
    assert read_back_picture(path).pixels.shape == (20, 30, 3)
    path.write_text("no picture")
    with pytest.raises(FileError, match="could not be read"):
        read_back_picture(path)


def test_names_on_the_command_line(photo: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert read_backdrop("room", tmp_path) == Backdrop(kind="room")
    assert read_backdrop("#AABBcc", tmp_path) == Backdrop(kind="color", color=(0xAA, 0xBB, 0xCC))
    assert read_backdrop("photo.png", tmp_path) == Backdrop(kind="picture", path="photo.png")
    assert read_backdrop("beach", tmp_path) is None and read_backdrop("#12345z", tmp_path) is None
    project = Project(backdrop=Backdrop(kind="color", color=(255, 0, 0)))
    assert make_render_look(project, tmp_path, "dark", "studio", None).top == (1, 0, 0)
    assert make_render_look(project, tmp_path, "dark", "studio", "white").top == (1, 1, 1)
    assert make_render_look(project, tmp_path, "dark", "studio", "room").walls is not None
    sample = Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml"
    out = str(tmp_path / "a.png")
    assert main(["render", str(sample), "-o", out, "--background", "beach"]) == 1
    assert "no background 'beach'" in capsys.readouterr().err


def test_walls_stand_behind_what_stands_farther_away() -> None:
    plain = set_backdrop(LIGHT, Project(backdrop=Backdrop(kind="room")), None)
    desk = Prop(name="desk", path="desk.glb", at=(0, 0, -4))
    project, _ = add_prop(Project(backdrop=Backdrop(kind="room")), desk)
    larger = set_backdrop(LIGHT, project, None)
    assert plain.walls is not None and larger.walls is not None
    assert larger.walls.low[2] < -4 < plain.walls.low[2] and larger.walls.high == plain.walls.high
    carried, _ = add_prop(Project(backdrop=Backdrop(kind="room")), replace_joint(desk))
    assert set_backdrop(LIGHT, carried, None).walls == plain.walls


def replace_joint(prop: Prop) -> Prop:
    return Prop(name=prop.name, path=prop.path, at=prop.at, joint="Hand")


@pytest.mark.gl
def test_room_studio_and_picture_are_drawn(photo: Path) -> None:
    project = Project(backdrop=Backdrop(kind="picture", path=photo.name))
    with Offscreen(160, 90) as offscreen:

        def drawn(look: object, camera: Camera | None = None) -> np.ndarray:
            return offscreen.render(Scene(), camera or Camera(), look)[..., :3].astype(int)  # type: ignore[arg-type]

        picture = drawn(set_backdrop(LIGHT, project, photo.parent))
        assert picture[10, 80].tolist() == [200, 40, 40] and picture[80, 80].tolist() == [40, 40, 200]
        assert picture[40, 1].tolist() == [200, 40, 40], "it fills the view"
        kinds = {
            kind: set_backdrop(LIGHT, replace(project, backdrop=Backdrop(kind=kind)), None)
            for kind in ("room", "studio")
        }
        room, studio = drawn(kinds["room"]), drawn(kinds["studio"])
        assert room[-2, 80, 0] > room[-2, 80, 2] + 30, "boards of wood"
        assert np.ptp(studio[..., :], axis=-1).max() < 12, "grey"
        column = studio[:, 80].sum(-1)
        assert np.abs(np.diff(column)).max() < 30, "no edge between floor and wall"
        for yaw in range(0, 360, 45):  # also from beyond a wall
            seen = drawn(kinds["room"], replace(Camera(distance=6.0), yaw=np.radians(yaw)))
            assert seen.std() > 8 and seen.min() > 20
        warm = set_backdrop(look_of("light", "evening"), Project(backdrop=Backdrop(kind="studio")), None)
        evening = drawn(warm)
        assert evening[20, 80, 0] - evening[20, 80, 2] > 10, "the light colours it"


@pytest.mark.gl
def test_a_transparent_picture_has_alpha_that_is_not_premultiplied(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sample = str(Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml")
    out = tmp_path / "a.png"
    words = ["render", sample, "-s", "1", "--frames", "1", "--size", "80x120", "--transparent"]
    assert main([*words, "-o", str(out)]) == 0
    pixels = np.asarray(Image.open(out)).astype(int)
    assert pixels.shape == (120, 80, 4) and pixels[0, 0, 3] == 0 and pixels[60, 40, 3] == 255
    edge = (pixels[..., 3] > 60) & (pixels[..., 3] < 200)
    assert edge.any() and pixels[edge][:, :3].max(1).mean() > 60, "edges are not darkened"
    assert main([*words, "-o", str(tmp_path / "a.mp4")]) == 1
    assert "no transparency" in capsys.readouterr().err
