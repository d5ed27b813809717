"""The renderer: golden pictures, and the cases in which a renderer goes black."""

from __future__ import annotations

import math
from dataclasses import replace

import moderngl
import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_character
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from preview import renderer
from preview.camera import Camera, close_up, make_whole_figure_camera
from preview.figure import SkinnedFigure, StickFigure
from preview.gpu import KEEP_MESHES
from preview.offscreen import Offscreen
from preview.scene import DARK, LIGHT, Actor, Scene
from sample_clips.make.mannequin_skeleton import mannequin_skeleton
from tests.preview.conftest import chain
from tests.preview.test_figure import character

pytestmark = pytest.mark.gl
SIZE = (160, 120)


def resting(figure, **options):
    return Actor(figure, *figure.skeleton.globals(figure.skeleton.rest), **options)


def posed(figure, turns, **options):
    skeleton = figure.skeleton
    rotations = skeleton.rest_rotations.copy()
    for joint, axis, degrees in turns:
        rotations[skeleton.index(joint)] = rotation.from_axis_angle(
            np.array(axis, float), np.radians(degrees)
        )
    return Actor(figure, *skeleton.globals(Pose(rotations, skeleton.rest_translations)), **options)


def whole(scene, size=SIZE):
    return make_whole_figure_camera(scene.bounds(), size[0] / size[1])


def test_the_mannequin_looks_as_it_did(offscreen, mannequin, golden):
    scene = Scene((resting(SkinnedFigure(mannequin)),))
    golden("mannequin_dark", offscreen.render(scene, whole(scene), DARK, SIZE))
    golden("mannequin_light", offscreen.render(scene, whole(scene), LIGHT, SIZE))


def test_the_mannequins_face_looks_as_it_did_awake_and_asleep(offscreen, mannequin, golden):
    from sample_clips.make.mannequin import LOWER_LID_CLOSED, UPPER_LID_CLOSED

    figure = SkinnedFigure(mannequin)
    awake = resting(figure)
    camera = close_up(figure.head(awake.rotations, awake.positions), figure.height, 4 / 3)
    asleep = posed(
        figure,
        [(s + "UpperLid", (1, 0, 0), UPPER_LID_CLOSED) for s in ("Left", "Right")]
        + [(s + "LowerLid", (1, 0, 0), LOWER_LID_CLOSED) for s in ("Left", "Right")],
    )
    golden("face_awake", offscreen.render(Scene((awake,)), camera, DARK, SIZE))
    golden("face_asleep", offscreen.render(Scene((asleep,)), camera, DARK, SIZE))


def test_a_stick_figure_with_its_skeleton_and_a_mask_looks_as_it_did(offscreen, golden):
    figure = StickFigure(mannequin_skeleton())
    arm = {figure.skeleton.index(n): (0.94, 0.65, 0.24) for n in ("LeftUpperArm", "LeftLowerArm", "LeftHand")}
    scene = Scene((posed(figure, [("LeftUpperArm", (0, 0, 1), 60)], bones=True, marks=arm),))
    golden("sticks", offscreen.render(scene, whole(scene), DARK, SIZE))


def test_an_empty_scene_is_sky_and_ground(offscreen, golden):
    golden("empty", offscreen.render(Scene(), Camera(), LIGHT, SIZE))


def test_one_joint_is_drawn(offscreen):
    scene = Scene((resting(StickFigure(chain("only"))),))
    picture = offscreen.render(scene, whole(scene), DARK, SIZE)
    assert np.abs(picture.astype(int) - offscreen.render(Scene(), whole(scene), DARK, SIZE)).max() > 60


def test_an_actor_that_is_not_a_number_is_left_out(offscreen):
    figure = StickFigure(mannequin_skeleton())
    broken = resting(figure)
    broken = Actor(figure, broken.rotations, np.full_like(broken.positions, np.nan))
    assert np.array_equal(
        offscreen.render(Scene((broken,)), Camera(), DARK, SIZE),
        offscreen.render(Scene(), Camera(), DARK, SIZE),
    )


def test_no_instances_are_no_picture_but_no_error(offscreen):
    figure = StickFigure(mannequin_skeleton())
    count = len(figure.skeleton)
    scene = Scene((Actor(figure, np.zeros((0, count, 4)), np.zeros((0, count, 3))),))
    assert offscreen.render(scene, Camera(), DARK, SIZE).shape == (120, 160, 4)


def test_a_flat_background_is_kept_to_the_value_and_a_clear_one_is_transparent(offscreen):
    scene = Scene((resting(StickFigure(mannequin_skeleton())),), background=(0.2, 0.4, 0.6, 1.0))
    picture = offscreen.render(scene, whole(scene), DARK, SIZE)
    assert picture[0, 0].tolist() == [51, 102, 153, 255]
    clear = offscreen.render(Scene(scene.actors, background=(0, 0, 0, 0)), whole(scene), DARK, SIZE)
    assert clear[0, 0].tolist() == [0, 0, 0, 0]
    assert clear[..., 3].max() == 255


def test_a_crowd_in_one_actor_looks_like_as_many_actors(offscreen):
    figure = StickFigure(mannequin_skeleton())
    rotations, positions = figure.skeleton.globals(figure.skeleton.rest)
    places = np.array([[-0.8, 0, 0], [0.0, 0, 0], [0.8, 0, 0]])
    crowd = Scene((Actor(figure, np.tile(rotations, (3, 1, 1)), positions + places[:, None]),))
    single = Scene(tuple(Actor(figure, rotations, positions + p) for p in places))
    camera = whole(crowd)
    apart = np.abs(
        offscreen.render(crowd, camera, DARK, SIZE).astype(int) - offscreen.render(single, camera, DARK, SIZE)
    )
    assert apart.mean() < 0.5


def test_a_ghost_is_between_nothing_and_the_figure(offscreen):
    figure = StickFigure(mannequin_skeleton())
    solid = Scene((resting(figure),), shadow=False)
    camera = whole(solid)
    empty, ghost, full = (
        offscreen.render(scene, camera, DARK, SIZE).astype(float)
        for scene in (Scene(), Scene((resting(figure, opacity=0.5),)), solid)
    )
    where = np.abs(full - empty).max(-1) > 80
    share = (ghost - empty)[where].sum() / (full - empty)[where].sum()
    assert 0.35 < share < 0.65


def test_a_morph_moves_the_mesh_and_back(offscreen):
    skeleton = chain("a", "b", "c")
    positions = np.array([[-0.3, 0.0, 0], [0.3, 0.0, 0], [0, 0.6, 0]])
    made = character(
        skeleton, positions=positions, morphs=("far",), morph_positions=np.full((1, 3, 3), [5.0, 0, 0])
    )
    figure = SkinnedFigure(made)
    camera = Camera(yaw=0, pitch=0).frame((np.array([-0.4, 0, -0.1]), np.array([0.4, 0.7, 0.1])), 4 / 3)
    plain = Scene((resting(figure),), background=(0, 0, 0, 1))
    gone = Scene((resting(figure, morphs=np.array([1.0])),), background=(0, 0, 0, 1))
    back = Scene((resting(figure, morphs=np.array([0.0])),), background=(0, 0, 0, 1))
    first = offscreen.render(plain, camera, DARK, SIZE)
    assert first[..., :3].max() > 100
    assert offscreen.render(gone, camera, DARK, SIZE)[..., :3].max() == 0
    assert np.array_equal(offscreen.render(back, camera, DARK, SIZE), first)


def test_two_of_one_mesh_have_faces_of_their_own_and_none_is_kept(offscreen):
    skeleton = chain("a", "b", "c")
    positions = np.array([[-0.3, 0.0, 0], [0.3, 0.0, 0], [0, 0.6, 0]])
    figure = SkinnedFigure(
        character(
            skeleton, positions=positions, morphs=("far",), morph_positions=np.full((1, 3, 3), [5.0, 0, 0])
        )
    )
    camera = Camera(yaw=0, pitch=0).frame((np.array([-0.4, 0, -0.1]), np.array([0.4, 0.7, 0.1])), 4 / 3)

    def drawn(*weights):
        faces = [None if w is None else np.array([w]) for w in weights]
        actors = tuple(resting(figure, morphs=face) for face in faces)
        return offscreen.render(Scene(actors, background=(0, 0, 0, 1)), camera, DARK, SIZE)[..., :3].max()

    assert drawn(1.0) == 0 and drawn(None) > 100, "who has no face says nothing of the one before"
    assert drawn(0.0, 1.0) > 100 and drawn(1.0, 0.0) > 100 and drawn(1.0, 1.0) == 0


def test_the_ground_hides_what_is_below_it(offscreen):
    figure = StickFigure(chain("only"))
    rotations, positions = figure.skeleton.globals(figure.skeleton.rest)
    camera = Camera(target=(0, 0, 0), pitch=0.6)
    under = Scene((Actor(figure, rotations, positions - [0, 0.5, 0]),), shadow=False)
    assert np.array_equal(
        offscreen.render(under, camera, DARK, SIZE), offscreen.render(Scene(), camera, DARK, SIZE)
    )


@pytest.mark.parametrize("pitch", [-1.5, -0.4, 0.0, 0.4, 1.55])
def test_every_point_is_painted_from_any_side(offscreen, pitch):
    for theme in (DARK, LIGHT):
        picture = offscreen.render(Scene(), Camera(pitch=pitch, target=(3, 0.9, 1)), theme, SIZE)
        assert (picture[..., 3] == 255).all()
        assert picture[..., :3].min() > 15


@pytest.mark.parametrize("size", [(1680, 400), (1600, 160), (120, 900)])
@pytest.mark.parametrize("pitch", [2.0, 6.0, 30.0])
def test_every_point_is_painted_however_wide_or_high_a_picture_is(offscreen, size, pitch):
    for distance in (1.5, 6.0, 60.0):
        camera = Camera(distance=distance).facing(0.3, math.radians(pitch))
        picture = offscreen.render(Scene(), camera, size=size)
        assert (picture[..., 3] == 255).all(), (distance, size, pitch)


def test_size_can_change_between_frames(offscreen):
    scene = Scene((resting(StickFigure(mannequin_skeleton())),))
    for size in ((64, 64), (1, 1), (200, 50), SIZE):
        assert offscreen.render(scene, whole(scene, size), DARK, size).shape == (size[1], size[0], 4)


@pytest.mark.parametrize("pitch", [-0.4, 0.0, 0.5, 1.5])
def test_while_the_camera_stands_pictures_are_as_if_it_had_just_come(offscreen, pitch):
    figure = StickFigure(chain("a", "b", "c"))
    still = Scene((resting(figure),))
    moved = Scene((posed(figure, [(figure.skeleton.names[1], (0, 0, 1), 50)]),))
    camera = Camera((0.0, 0.6, 0.0), 0.3, pitch, 4.0)
    other = Camera((0.4, 0.6, 0.0), 0.3, pitch, 3.0)
    first = [offscreen.render(scene, camera, DARK, SIZE) for scene in (moved, still, still, moved)]
    afresh = []
    for scene in (moved, still):
        offscreen.render(scene, other, DARK, SIZE)
        afresh.append(offscreen.render(scene, camera, DARK, SIZE))
    for picture, of in zip(first, (0, 1, 1, 0), strict=True):
        np.testing.assert_array_equal(picture, afresh[of])
    empty = [
        offscreen.render(Scene(ground=g), camera, theme, SIZE) for theme in (DARK, LIGHT) for g in (0, 1)
    ]
    again = [
        offscreen.render(Scene(ground=g), camera, theme, SIZE) for theme in (DARK, LIGHT) for g in (0, 1)
    ]
    for before, after in zip(empty, again, strict=True):
        np.testing.assert_array_equal(before, after)
    assert not np.array_equal(empty[0], empty[2])


def test_nothing_of_a_figure_is_left_out_when_only_parts_of_a_picture_are_smoothed(
    offscreen, mannequin, monkeypatch
):
    random = np.random.default_rng(5)
    for figure in (StickFigure(mannequin_skeleton()), SkinnedFigure(mannequin)):
        check_parts(offscreen, monkeypatch, figure, random)


@pytest.mark.parametrize("name", ["kaykit-rogue", "robot-expressive", "sumerian-hosts/glTF/characters"])
def test_nothing_is_left_out_of_figures_nobody_made_here(offscreen, monkeypatch, shared_data, name):
    models = [p for p in sorted((shared_data / name).rglob("*.gl[bt]*")) if p.suffix in (".glb", ".gltf")]
    assert models
    random = np.random.default_rng(6)
    for model in models[:2]:
        check_parts(offscreen, monkeypatch, SkinnedFigure(read_character(model)), random)


def check_parts(offscreen, monkeypatch, figure, random):
    """Compare with what smoothing the whole picture gives, in odd poses, near, far and from all sides."""
    skeleton = figure.skeleton
    for distance in (0.5, 1.0, 4.0):
        turns = rotation.from_axis_angle(random.normal(size=(len(skeleton), 3)), 0.6 * random.random())
        pose = Pose(rotation.multiply(skeleton.rest_rotations, turns), skeleton.rest_translations)
        scene = Scene((Actor(figure, *skeleton.globals(pose)),), shadow=False)
        camera = Camera().frame(scene.bounds(), SIZE[0] / SIZE[1]).facing(float(random.uniform(-3, 3)), 0.2)
        camera = replace(camera, distance=camera.distance * distance)
        seen = offscreen.render(scene, camera, DARK, SIZE)
        with monkeypatch.context() as patch:
            patch.setattr(renderer, "find_covered", lambda frame: np.array([[0, 0, *frame.size]]))
            whole_picture = offscreen.render(scene, camera, DARK, SIZE)
        apart = np.abs(seen.astype(int) - whole_picture)
        assert apart.max() <= 1, f"{distance}: {(apart > 1).sum()} points"  # places in a picture are rounded


def test_state_others_leave_behind_does_not_matter(offscreen):
    scene = Scene((resting(StickFigure(mannequin_skeleton())),))
    first = offscreen.render(scene, whole(scene), DARK, SIZE)
    ctx = offscreen.renderer.ctx
    with ctx:
        ctx.enable_only(moderngl.BLEND | moderngl.CULL_FACE)
        ctx.blend_func = moderngl.ZERO, moderngl.ZERO
        ctx.blend_equation = moderngl.FUNC_SUBTRACT
        ctx.depth_func, ctx.front_face, ctx.cull_face = ">", "cw", "front"
        ctx.polygon_offset = 5.0, 5.0
        offscreen._fbo.scissor = (0, 0, 5, 5)
        offscreen._fbo.color_mask = (False, False, False, False)
    assert np.array_equal(offscreen.render(scene, whole(scene), DARK, SIZE), first)


def test_a_second_context_draws_the_same(offscreen):
    figure = StickFigure(mannequin_skeleton())
    scene = Scene((resting(figure),))
    first = offscreen.render(scene, whole(scene), DARK, SIZE)
    with Offscreen(*SIZE) as other:
        assert np.array_equal(other.render(scene, whole(scene)), first)
    assert np.array_equal(offscreen.render(scene, whole(scene), DARK, SIZE), first)


def test_multisampling_draws_nearly_the_same(offscreen):
    scene = Scene((resting(StickFigure(mannequin_skeleton())),))
    first = offscreen.render(scene, whole(scene), DARK, SIZE).astype(int)
    with Offscreen(*SIZE, samples=4) as other:
        assert other.renderer.samples == 4
        assert np.abs(other.render(scene, whole(scene)) - first).mean() < 3


def test_a_broken_texture_is_drawn_white(offscreen):
    from metagraph.motion.character_mesh import MeshMaterial

    positions = np.array([[-0.3, 0.0, 0], [0.3, 0.0, 0], [0, 0.6, 0]])
    figure = SkinnedFigure(
        character(
            chain("a", "b", "c"),
            positions=positions,
            materials=(MeshMaterial("m", (1, 1, 1, 1), b"no picture"),),
        )
    )
    scene = Scene((resting(figure),), background=(0, 0, 0, 1))
    camera = Camera(yaw=0, pitch=0).frame((np.array([-0.4, 0, -0.1]), np.array([0.4, 0.7, 0.1])), 4 / 3)
    assert offscreen.render(scene, camera, DARK, SIZE)[..., :3].max() > 120


@pytest.mark.nightly
def test_meshes_no_longer_drawn_are_let_go(offscreen):
    for _ in range(KEEP_MESHES + 3):
        scene = Scene((resting(StickFigure(mannequin_skeleton())),))
        offscreen.render(scene, whole(scene), DARK, SIZE)
    assert len(offscreen.renderer.store) <= KEEP_MESHES + 2


def test_scenes_are_the_same_to_the_last_bit_or_not():
    figure = StickFigure(mannequin_skeleton())
    actor = resting(figure)
    scene = Scene((actor,))
    copy = replace(actor, rotations=actor.rotations.copy(), positions=actor.positions.copy())
    assert scene.same(Scene((copy,)))
    copy.positions[..., 0, 1] += 1e-12
    assert not scene.same(Scene((copy,)))
    for other in (
        Scene((actor, actor)),
        Scene((actor,), shadow=False),
        Scene((replace(actor, bones=True),)),
        Scene((replace(actor, morphs=np.zeros(1)),)),
        Scene((replace(actor, marks={1: (1.0, 0.0, 0.0)}),)),
        Scene((replace(actor, figure=StickFigure(mannequin_skeleton())),)),
    ):
        assert not scene.same(other)
