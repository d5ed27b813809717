"""Draw characters with OpenGL: numbers in, pixels out; no Qt.

    figure = SkinnedFigure(character, skeleton)          # or StickFigure(skeleton)
    rotations, positions = skeleton.globals(clip.pose_at(seconds))
    scene = Scene((Actor(figure, rotations, positions),))
    camera = make_whole_figure_camera(scene.bounds(), width / height)

    with Offscreen(width, height) as offscreen:           # without a display
        picture = offscreen.render(scene, camera)         # uint8 [H, W, 4]
    Renderer(ctx).draw(scene, camera, size, fbo, DARK)    # in a window

Modules: `camera` (Camera, make_whole_figure_camera, make_upper_body_camera, close_up), `figure`
(SkinnedFigure, StickFigure), `scene` (Actor, Scene, SceneTheme, DARK, LIGHT), `renderer` (Renderer),
`offscreen` (Offscreen, OpenGLError), `video` (write_video), `sheet` (make_contact_sheet, write_png),
`thumbnail` (render_thumbnail, find_telling_frame). Import from them; this package loads nothing itself.
"""
