@tool
extends EditorPlugin
## Writes the log of a timing study while people work in Godot's editor (4.2 or later): addons/metagraph_study_log.
## Run in Godot 4.6 with a class that stands in for EditorPlugin; NOT RUN in the editor. Nothing that is typed is written.

var _dock: VBoxContainer
var _participant: LineEdit
var _task: LineEdit
var _file: FileAccess
var _n := 0
var _index := 0
var _run := ""
var _working := false
var _paused := false


func _enter_tree() -> void:
	_dock = VBoxContainer.new()
	_dock.name = "Study"
	_participant = _line("Participant, as P01")
	_task = _line("Task, as in the study file")
	_button("Begin", _begin)
	_button("Pause, go on", _pause)
	_button("Done", _done)
	add_control_to_dock(DOCK_SLOT_RIGHT_UL, _dock)
	get_undo_redo().version_changed.connect(_edited)


func _exit_tree() -> void:
	get_undo_redo().version_changed.disconnect(_edited)
	_done()
	remove_control_from_docks(_dock)
	_dock.free()


func _line(words: String) -> LineEdit:
	var out := LineEdit.new()
	out.placeholder_text = words
	_dock.add_child(out)
	return out


func _button(words: String, run: Callable) -> void:
	var out := Button.new()
	out.text = words
	out.pressed.connect(run)
	_dock.add_child(out)


func _tell(kind: String, fields: Dictionary = {}) -> void:
	if _file == null:
		return
	var milliseconds := int(fmod(Time.get_unix_time_from_system(), 1.0) * 1000.0)
	var wall := "%s.%03dZ" % [Time.get_datetime_string_from_system(true), milliseconds]
	var event := {"n": _n, "run": _run, "mono": Time.get_ticks_usec() / 1e6, "wall": wall, "type": kind}
	event.merge(fields)
	_n += 1
	_file.store_line(JSON.stringify(event))
	_file.flush()


func _phase(state: String) -> void:
	var about := {"name": "task", "state": state, "condition": "godot", "task": _task.text, "index": _index}
	if state == "end":
		about["why"] = "done"
	_tell("phase", about)


func _begin() -> void:
	if _working or _participant.text.is_empty() or _task.text.is_empty():
		return
	if _file == null:
		_run = str(Time.get_unix_time_from_system()).sha256_text().left(12)
		var path := "user://study-%s-godot-%s.jsonl" % [_participant.text.validate_filename(), _run]
		_file = FileAccess.open(path, FileAccess.WRITE)
		if _file == null:
			push_error("The study's log cannot be written: %s" % path)
			return
		print("Study log: ", ProjectSettings.globalize_path(path))
		var version: String = Engine.get_version_info()["string"]
		_tell("begin", {"participant": _participant.text, "engine": "godot", "version": version})
	_working = true
	_phase("begin")


func _pause() -> void:
	if _working:
		_paused = not _paused
		_tell("pause", {"state": "begin" if _paused else "end"})


func _done() -> void:
	if _working:
		if _paused:
			_pause()
		_working = false
		_phase("end")
		_index += 1


func _edited() -> void:
	if _working and not _paused:
		_tell("edit", {"what": "settings", "words": "Edit", "clips": []})
