"""Pictures without a display."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from preview.camera import Camera
from preview.offscreen import Offscreen, OpenGLError, make_standalone_context
from preview.scene import Scene


def test_without_opengl_the_message_says_what_to_install(monkeypatch):
    def fail(**_):
        raise Exception("cannot load libEGL")

    monkeypatch.setattr(moderngl, "create_context", fail)
    monkeypatch.setattr("sys.platform", "linux")
    with pytest.raises(OpenGLError, match=r"libEGL.*apt install libegl1"):
        make_standalone_context()


@pytest.mark.gl
def test_releasing_twice_is_fine():
    with Offscreen(8, 8) as offscreen:
        assert offscreen.render(Scene(), Camera()).shape == (8, 8, 4)
        assert offscreen.description
        offscreen.release()


@pytest.mark.gl
def test_the_first_row_is_the_top():
    with Offscreen(32, 32) as offscreen:
        picture = offscreen.render(Scene(), Camera(pitch=0.3)).astype(int)
    top, bottom = picture[:8, :, :3].std(), picture[-16:, :, :3].std()
    assert bottom > top  # the grid's lines are below, the sky above


@pytest.mark.gl
def test_a_picture_can_be_drawn_into_the_memory_of_the_last():
    scene, camera = Scene(), Camera(pitch=0.3)
    with Offscreen(32, 24) as offscreen:
        kept = offscreen.render(scene, camera)
        into = np.empty_like(kept)
        assert offscreen.render(scene, camera, into=into) is into
        offscreen.render(scene, Camera(pitch=0.9))
    assert (into == kept).all()
