extends Node
# Plays a Metagraph export on a Godot 3 Skeleton: the small counterpart of the node for Godot 4.

signal began(action, layer, meta)
signal ended(action, layer, meta)

const Graph = preload("core/graph.gd")
const Performer = preload("core/character.gd")
const Talk = preload("core/talk.gd")
const Bones = preload("core/bones.gd")
const Shim = preload("core/shim3.gd")

export(String, FILE, "*.json") var json_path = ""
export(String, FILE) var glb_path = ""
export(NodePath) var skeleton_path
export(int) var chance = -1  # the project's seed
export(bool) var idle = true
export(bool) var alive = true
export(bool) var gestures = true  # go with the words it says
export(String) var language = "en"  # of those words

var graph  # may be given before the node gets ready, so that characters share one
var character
var talk  # what it says, with gestures
var _skeleton = null
var _bones = {}
var _faces = []
var _seconds = 0.0


func _ready():
	if skeleton_path != null and has_node(skeleton_path):
		_skeleton = get_node(skeleton_path)
	if graph == null:
		graph = Graph.new(Shim.text_of(Shim.read_bytes(json_path)), Shim.read_bytes(glb_path))
	if graph.error != "":
		push_error("Metagraph: %s: %s" % [json_path, graph.error])
		return
	for problem in graph.problems:
		push_warning("Metagraph: %s: %s" % [json_path, problem])
	var options = {"idle": idle}
	if chance >= 0:
		options["seed"] = chance
	character = Performer.new(graph, options)
	talk = Talk.new(character, {"language": language, "seed": chance if chance >= 0 else 1, "name": "said#"})
	if not _skeleton is Skeleton:
		push_error("Metagraph: skeleton_path leads to no Skeleton; only requests and events are worked out")
		_skeleton = null
		return
	var names = []
	for bone in range(_skeleton.get_bone_count()):
		names.append(_skeleton.get_bone_name(bone))
	_bones = Bones.places(graph.names, names)
	for node in _skeleton.get_children():
		if node is MeshInstance and node.mesh is ArrayMesh and node.mesh.get_blend_shape_count() > 0:
			_faces.append(node)


func _process(delta):
	if character == null:
		return
	_seconds += delta
	character.alive = alive
	character.update(_seconds)
	for event in character.events():
		emit_signal("began" if event.kind == "begin" else "ended", event.action, event.layer, event.meta)
	if _skeleton == null:
		return
	var pose = character.pose()
	for joint in _bones:
		# A bone's pose is relative to its rest here.
		var local = Transform(Basis(pose.rotations[joint]), pose.translations[joint])
		_skeleton.set_bone_pose(_bones[joint], _skeleton.get_bone_rest(_bones[joint]).affine_inverse() * local)
	for face in _faces:
		for place in range(face.mesh.get_blend_shape_count()):
			var target = face.mesh.get_blend_shape_name(place)
			face.set("blend_shapes/" + target, pose.morphs.get(target, 0.0))


# Asks for anything, a Dictionary with "do"; "after" is seconds from now. Returns its id.
func ask(request):
	return character.ask(request) if character != null else ""


# Returns what became of a request: a Dictionary with state ("planned", "late", "done", "refused"), at, until, what, why.
func answer(id):
	return character.answer(id) if character != null else {"state": "refused", "why": "the export was not read"}


# Returns what may be asked for: layers with stances, actions and tags, lines, points, what "do" may be; empty while nothing is read.
func describe():
	return character.describe() if character != null else {}


# Sets a parameter of the project; returns the id of the request that this makes.
func set_parameter(parameter, value = null):
	return character.set_parameter(parameter, value) if character != null else ""


func get_parameter(parameter):
	return character.get_parameter(parameter) if character != null else null


func gesture(tags = [], more = {}):
	return _ask("gesture", "tags", tags, more)


func go(stance, more = {}):
	return _ask("stance", "stance", stance, more)


func look(to, more = {}):
	return _ask("look", "to", [to.x, to.y, to.z] if to is Vector3 else to, more)


func say(words, more = {}):
	var known = graph != null and graph.error == "" and graph.lines.has(words)
	if talk != null and not known and gestures and more.get("gestures", true):
		return talk.say(words, more).id
	return _ask("say", "line" if known else "text", words, more)


# Says what comes in piece by piece: each sentence, with its gestures, when it is whole. Returns the ids of what it says by it.
func say_piece(piece, over = false):
	var ids = []
	if talk != null:
		for said in talk.take(piece, over):
			ids.append(said.id)
	return ids


# Breaks off all that is said, because the other speaks. What is said next begins at once.
func interrupt():
	return talk.interrupt() if talk != null else ""


func say_sound(ident, samples, rate):
	return character.say_sound(ident, samples, rate) if character != null else ""


func _ask(what, field, value, more):
	var request = {"do": what}
	request[field] = value
	for name in more:
		request[name] = more[name]
	return ask(request)
