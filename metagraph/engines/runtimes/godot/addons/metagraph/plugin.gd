@tool
extends EditorPlugin
## Puts the motions into an exported game. The node MetagraphCharacter is known by its class name, also while this plugin is off.

var _motions: EditorExportPlugin


func _enter_tree() -> void:
	_motions = Motions.new()
	add_export_plugin(_motions)


func _exit_tree() -> void:
	remove_export_plugin(_motions)


## Exports each *.motion, and the JSON beside it, which Godot would leave out.
class Motions:
	extends EditorExportPlugin

	func _get_name() -> String:
		return "Metagraph"

	func _export_begin(_features: PackedStringArray, _is_debug: bool, _path: String, _flags: int) -> void:
		_add_from("res://")

	func _export_file(path: String, _type: String, _features: PackedStringArray) -> void:
		if path.get_extension() == "json" and FileAccess.file_exists(path.get_basename() + ".motion"):
			skip()  # it is there already

	func _add_from(folder: String) -> void:
		for file: String in DirAccess.get_files_at(folder):
			var path: String = folder.path_join(file)
			if path.get_extension() == "motion":
				for each: String in [path, path.get_basename() + ".json"]:
					if FileAccess.file_exists(each):
						add_file(each, FileAccess.get_file_as_bytes(each), false)
		for inside: String in DirAccess.get_directories_at(folder):
			if not inside.begins_with("."):
				_add_from(folder.path_join(inside))
