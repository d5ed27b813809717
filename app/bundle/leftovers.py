"""What a bundle does without, as patterns. Each must match something."""

from __future__ import annotations

# What no program needs of the standard library, or only one with Tk or in a terminal.
PYTHON = (
    "test", "idlelib", "tkinter", "turtledemo", "lib2to3", "ensurepip", "site-packages", "pydoc_data",
    "__pycache__", "*.a", "lib-dynload/_test*", "lib-dynload/_tkinter*", "lib-dynload/_curses*",
    "lib-dynload/readline*", "lib-dynload/_dbm*", "lib-dynload/_gdbm*",
)  # fmt: skip

# Packages whose binaries have parts that only debuggers read: 25 MB of PyAV's 32, 10 MB of the others'.
STRIPPED = ("av", "PIL", "ufbx", "yaml")
# Packages that are not compiled beforehand, since only an extra's installation runs them.
UNCOMPILED = r"[/\\]pip[/\\]"

_QT = "PySide6/Qt"
SITE = (
    "bin",
    # Qt Quick and all that belongs to it, Qt's own tools, and what only who compiles against Qt reads.
    f"{_QT}/qml", f"{_QT}/metatypes", f"{_QT}/libexec",
    *(f"{_QT}/lib/libQt6{name}*" for name in (
        "Qml", "Quick", "Labs", "Designer", "Lottie", "Help", "Sql", "Test", "UiTools", "PrintSupport",
        "EglFS", "EglFs", "WaylandCompositor", "WaylandEglCompositor",
    )),
    *(f"{_QT}/plugins/{name}" for name in (
        "designer", "egldeviceintegrations", "generic", "networkinformation", "printsupport", "qmllint",
        "qmltooling", "sqldrivers", "vectorimageformats", "wayland-graphics-integration-server",
        "platforms/libqeglfs.so", "platforms/libqlinuxfb.so", "platforms/libqminimal*.so",
        "platforms/libqvkkhrdisplay.so", "platforms/libqvnc.so", "imageformats/libqpdf.so",
        "platformthemes/libqgtk3.so", "platforminputcontexts/libqtvirtualkeyboardplugin.so",
    )),
    *(f"PySide6/Qt{name}.abi3.so" for name in (
        "Qml", "Quick", "QuickControls2", "QuickWidgets", "QuickTest", "Designer", "Help", "Sql", "Test",
        "UiTools", "PrintSupport", "Concurrent",
    )),
    *(f"PySide6/{name}" for name in (
        "assistant", "designer", "linguist", "lupdate", "lrelease", "qml*", "svgtoqml", "include", "scripts",
        "typesystems", "glue", "doc", "*.pyi", "libpyside6qml*",
    )),
    # Texts of Qt's own tools and of modules that are not there; the window's are `qtbase`.
    *(f"{_QT}/translations/{name}_*.qm" for name in (
        "assistant", "designer", "linguist", "qt", "qtdeclarative",
    )),
    "numpy/**/tests", "numpy/f2py", "numpy/distutils", "pyqtgraph/examples", "PIL/*.pyi",
)  # fmt: skip
