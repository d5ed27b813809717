class_name MetagraphCharacter
extends Node
## Plays a Metagraph export on a Skeleton3D: gestures, stances, gaze, breathing and speech, by requests.
##
## Every request returns an id; answer(id) says what became of it. Nothing here fails while the game runs: what cannot be read
## when the node gets ready is pushed as an error, and the skeleton stays as it is.

## An action began to play. layer: body, arms or head, or "speech": then action is the line's id, or the words; meta: the request it
## belongs to, or what a model wrote.
signal began(action: String, layer: String, meta: String)
## An action has ended.
signal ended(action: String, layer: String, meta: String)

const Graph = preload("core/graph.gd")
const Performer = preload("core/character.gd")
const Talk = preload("core/talk.gd")
const Bones = preload("core/bones.gd")
const Shim = preload("core/shim4.gd")

## The exported JSON. A path without res:// leads from the folder of the scene.
@export_file("*.json") var json_path: String = ""
## The export's file .motion: its GLB under a name that Godot does not import, so that it is there in an exported game. Empty: the one
## beside the JSON.
@export_file("*.motion") var glb_path: String = ""
## Empty: the first Skeleton3D below this node's parent.
@export var skeleton_path: NodePath
## Chance: the same seed and requests give the same performance. -1: the project's.
@export var chance: int = -1
## Whether the models fill the time nobody asks for.
@export var idle: bool = true
## Whether breathing, gaze, blinks and lips come on top.
@export var alive: bool = true
## Whether gestures go with the words it says.
@export var gestures: bool = true
## Of the words that gestures go with: en, de, es, fr.
@export var language: String = "en"

var graph: Graph  ## may be given before the node gets ready, so that characters share one
var character: Performer
var talk: Talk  ## what it says, with gestures

var _skeleton: Skeleton3D
var _bones: Dictionary = {}
var _faces: Array[MeshInstance3D] = []
var _shapes: Array[PackedStringArray] = []  # names of the blend shapes of each face
var _seconds: float = 0.0


func _ready() -> void:
	_skeleton = _find_skeleton()
	if graph == null:
		var json: String = _place(json_path)
		var motion: String = json.get_basename() + ".motion" if glb_path.is_empty() else _place(glb_path)
		graph = Graph.new(Shim.text_of(Shim.read_bytes(json)), Shim.read_bytes(motion))
	if graph.error != "":
		push_error("Metagraph: %s: %s" % [json_path, graph.error])
		return
	for problem: String in graph.problems:
		push_warning("Metagraph: %s: %s" % [json_path, problem])
	var options: Dictionary = {"idle": idle}
	if chance >= 0:
		options["seed"] = chance
	character = Performer.new(graph, options)
	talk = Talk.new(character, {"language": language, "seed": chance if chance >= 0 else 1, "name": "said#"})
	if _skeleton == null:
		push_error("Metagraph: there is no Skeleton3D (skeleton_path); only requests and events are worked out")
		return
	var names: Array = []
	for bone: int in _skeleton.get_bone_count():
		names.append(_skeleton.get_bone_name(bone))
	_bones = Bones.places(graph.names, names)
	if _bones.size() < graph.names.size():
		push_warning("Metagraph: %d of %d joints are bones of the skeleton" % [_bones.size(), graph.names.size()])
	for node: Node in _skeleton.find_children("*", "MeshInstance3D", true, false):
		var face: MeshInstance3D = node as MeshInstance3D
		var mesh: ArrayMesh = face.mesh as ArrayMesh
		if mesh != null and mesh.get_blend_shape_count() > 0:
			var targets: PackedStringArray = []
			for shape: int in mesh.get_blend_shape_count():
				targets.append(mesh.get_blend_shape_name(shape))
			_faces.append(face)
			_shapes.append(targets)


func _find_skeleton() -> Skeleton3D:
	if not skeleton_path.is_empty():
		return get_node_or_null(skeleton_path) as Skeleton3D
	var found: Array[Node] = get_parent().find_children("*", "Skeleton3D", true, false)
	return found[0] as Skeleton3D if not found.is_empty() else null


func _place(path: String) -> String:
	if path.is_empty() or path.is_absolute_path():
		return path
	var folder: String = owner.scene_file_path.get_base_dir() if owner != null else ""
	return (folder if not folder.is_empty() else "res://").path_join(path)


func _process(delta: float) -> void:
	if character == null:
		return
	_seconds += delta
	character.alive = alive
	character.update(_seconds)
	for event: Dictionary in character.events():
		var happened: Signal = began if event.kind == "begin" else ended
		happened.emit(event.action, event.layer, event.meta)
	if _skeleton == null:
		return
	var pose: Dictionary = character.pose()
	var turns: Array = pose.rotations
	var places: Array = pose.translations
	var morphs: Dictionary = pose.morphs
	for joint: int in _bones:
		_skeleton.set_bone_pose_rotation(_bones[joint], turns[joint])
		_skeleton.set_bone_pose_position(_bones[joint], places[joint])
	for face: int in _faces.size():
		var targets: PackedStringArray = _shapes[face]
		for shape: int in targets.size():
			_faces[face].set_blend_shape_value(shape, morphs.get(targets[shape], 0.0))


## Asks for anything, a Dictionary with "do"; "after" is seconds from now. Returns its id.
func ask(request: Dictionary) -> String:
	return character.ask(request) if character != null else ""


## Returns what became of a request: a Dictionary with state ("planned", "late", "done", "refused"), at, until, what, why.
func answer(id: String) -> Dictionary:
	return character.answer(id) if character != null else {"state": "refused", "why": "the export was not read"}


## Returns what may be asked for: layers with stances, actions and tags, lines, points, what "do" may be; empty while nothing is read.
func describe() -> Dictionary:
	return character.describe() if character != null else {}


## Sets a parameter of the project to a number, a bool, a String, an Array of Strings, a Vector3, or nothing for a trigger. Returns the id
## of the request that this makes.
func set_parameter(parameter: String, value: Variant = null) -> String:
	return character.set_parameter(parameter, value) if character != null else ""


## Returns the value that a parameter was set to, else its first one; null where there is none of that name.
func get_parameter(parameter: String) -> Variant:
	return character.get_parameter(parameter) if character != null else null


## Asks for a gesture with all of these tags.
func gesture(tags: Array = [], more: Dictionary = {}) -> String:
	return _ask("gesture", {"tags": tags}, more)


## Goes to a stance, by id or name.
func go(stance: String, more: Dictionary = {}) -> String:
	return _ask("stance", {"stance": stance}, more)


## Looks at a point of the character's space (Vector3), or at a name: "user", "ahead", a point of the project.
func look(to: Variant, more: Dictionary = {}) -> String:
	return _ask("look", {"to": [to.x, to.y, to.z] if to is Vector3 else to}, more)


## Says a line of the project, by id, or else the text itself, with gestures that go with its words unless `gestures` is off, of this
## node or in `more`.
func say(words: String, more: Dictionary = {}) -> String:
	var known: bool = graph != null and graph.error == "" and graph.lines.has(words)
	if talk != null and not known and gestures and more.get("gestures", true):
		return talk.say(words, more).id
	return _ask("say", {"line" if known else "text": words}, more)


## Says what comes in piece by piece, as a language model writes it: each sentence, with its gestures, when it is whole, after the one
## before. over: whether the text ends here. Returns the ids of what it says by it.
func say_piece(piece: String, over: bool = false) -> Array[String]:
	var ids: Array[String] = []
	if talk != null:
		for said: Dictionary in talk.take(piece, over):
			ids.append(said.id)
	return ids


## Breaks off all that is said, because the other speaks: the voice stops at its next sound, gestures go back, and the character looks
## at the other. What is said next begins at once.
func interrupt() -> String:
	return talk.interrupt() if talk != null else ""


## Takes a request back, by its id; all of them without one.
func withdraw(id: String = "") -> String:
	return _ask("withdraw", {"what": id}, {})


## Is in a mood from now on: "happy", "sad" and others; "neutral" ends it. intensity: 0 to 1.
func mood(name_of_mood: String, intensity: float = 1.0, more: Dictionary = {}) -> String:
	return _ask("mood", {"mood": name_of_mood, "intensity": intensity}, more)


## From now on is "idle", "listening", "talking", "thinking" or "reacting"; null leaves it to what is said.
func mode(what: Variant, more: Dictionary = {}) -> String:
	return _ask("mode", {"mode": what}, more)


## Puts a named point somewhere in the character's space; who looks at it follows it.
func place(point: String, at: Vector3, more: Dictionary = {}) -> String:
	return _ask("place", {"name": point, "point": [at.x, at.y, at.z]}, more)


## Says a line whose sound comes in while it is said: with each call its next samples, -1..1; the lips do what is heard. An id is one
## line's. rate: samples a second, 8000 to 48000.
func say_sound(ident: String, samples: Variant, rate: float) -> String:
	return character.say_sound(ident, samples, rate) if character != null else ""


func _ask(what: String, fields: Dictionary, more: Dictionary) -> String:
	var request: Dictionary = {"do": what}
	request.merge(fields)
	request.merge(more, true)
	return ask(request)
