"""Import an export into the open project: its JSON as a Metagraph asset, its GLB as a skeletal mesh.

In the editor's Python console, with the plugin PythonScriptPlugin on:

    import import_metagraph
    import_metagraph.run("C:/exports/sample.json", "/Game/Characters/Sample")
"""

from __future__ import annotations

from pathlib import Path


def run(json_path: str, folder: str = "/Game/Metagraph") -> list[str]:
    """Import `json_path` and the GLB beside it into a content folder; return the paths of what was made.

    Raises FileNotFoundError where one of the two is missing, RuntimeError where the editor made nothing.
    """
    import unreal  # type: ignore[import-not-found]  # the editor has it

    source = Path(json_path)
    made: list[str] = []
    for path, factory in ((source, unreal.MetagraphFactory()), (source.with_suffix(".glb"), None)):
        if not path.is_file():
            raise FileNotFoundError(
                f"{path} is not there. Give the JSON that Metagraph exported, with its GLB beside it."
            )
        task = unreal.AssetImportTask()
        task.set_editor_property("filename", str(path))
        task.set_editor_property("destination_path", folder)
        # Both are named after the project: the asset is told apart from the mesh.
        if factory is not None:
            task.set_editor_property("destination_name", f"{path.stem}_Metagraph")
            task.set_editor_property("factory", factory)
        task.set_editor_property("automated", True)
        task.set_editor_property("replace_existing", True)
        task.set_editor_property("save", True)
        unreal.AssetToolsHelpers.get_asset_tools().import_asset_tasks([task])
        paths = list(task.get_editor_property("imported_object_paths"))
        if not paths:
            raise RuntimeError(f"nothing came of {path}; the editor's log says why")
        made += paths
    return made
