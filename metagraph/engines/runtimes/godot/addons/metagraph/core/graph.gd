# An export, read: skeleton, base pose, clips, layers, constants, the life layers' body and voices. What is wrong is said in `error`;
# what is merely lacking, in `problems`. Nothing here changes once it is read, so many characters share one graph.

const Util = preload("util.gd")
const Choice = preload("choice.gd")
const Clip = preload("clip.gd")
const Glb = preload("glb.gd")
const Life = preload("life.gd")
const Rig = preload("rig.gd")
const Text = preload("text.gd")
const FORMAT = 1  # the newest version of exports that is understood
const CORE = "res://addons/metagraph/core/"
# What an export must have: field -> what it is; "x?" may be null, and [] means a list of such.
const EXPORT = {joints = "[]", base = "{}", clips = "[]", layers = "{}", planner = "{}"}
const JOINT = {name = "text", parent = "text?", part = "text", side = "text", translation = "3", rotation = "4"}
const CLIP = {id = "text", name = "text", animation = "number", fps = "number", frames = "number"}
const LAYER = {start = "text?", weights = "{}", stances = "[]", actions = "[]", markov = "{}"}
const STANCE = {id = "text", name = "text"}
const ACTION = {
	id = "text", name = "text", clip = "text", kind = "text", stance = "text", end_stance = "text?", start = "number", end = "number",
	blend_in = "number", blend_out = "number", earliest_exit = "number?", stroke = "number?", limb = "text", joints = "[]", tags = "[]",
	likelihood = "number"
}
const MARKOV = {states = "[]", matrix = "[]", gap = "number", positive = "number", negative = "number"}
const PLANNER = {
	"seed": "number", "alpha": "number", "never_twice": "switch", "shortest": "number", "wait": "number", "window": "number",
	"loop_fade": "number"
}
const PLANNER_USUAL = {memory = 0.0, rest = 0.0, lookahead = 0.1, hurry = 2.0, least_blend = 0.25}

var error = ""
var problems = []
var shim
var choice
var text
var names = []  # [J] joints, parents before children
var parents = []  # [J], -1 for a root
var parts = []
var sides = []
var rest_rotations = []
var rest_translations = []
var base_rotations = []
var base_translations = []
var clips = {}  # id -> Clip, for those whose motion is there
var layers = {}  # layer -> {layer, start, stances {id: name}, actions {id: action}, kinds {kind: true}, markov, reach}
var settings = {}
var life = {}
var rig = null  # see rig.gd; null where nothing lives
var points = {}  # name -> Vector3
var lines = {}
var voices = {}  # line -> voice, see voice.gd
var said = {}  # voices made from letters, by text and length
var face_morphs = false
var still_frame = {turns = [], shifts = {}}  # the base pose, as a clip's frame
var frames = {}  # those of clips that were made so far, see clip.gd
var _index = {}  # layer/kind/stance -> actions, in the order they were placed


# json: the export's text. bytes: its GLB's.
func _init(json, bytes):
	shim = load(CORE + "shim%d.gd" % Engine.get_version_info()["major"])
	choice = Choice.new(shim)
	text = Text.new(shim)
	error = _read(json, bytes)


func _read(json, bytes):
	if typeof(json) != TYPE_STRING or json == "":
		return "the export's JSON cannot be read; check that it is there"
	var data = shim.parse(json)
	if typeof(data) != TYPE_DICTIONARY:
		return "the export is not JSON; export it again"
	var version = data.get("metagraph")
	if not Util.is_number(version):
		return "$.metagraph: this is no Metagraph export; choose the JSON that Metagraph wrote"
	if version > FORMAT:
		return "$.metagraph: the export is of version %s, this reads up to %d; update the runtime" % [str(version), FORMAT]
	var wrong = _wrong(data)
	if wrong != "":
		return wrong + "; export it again"
	for name in PLANNER_USUAL:
		settings[name] = float(data.planner.get(name, PLANNER_USUAL[name]))
	for name in PLANNER:
		settings[name] = data.planner[name]
	settings.seed32 = int(data.planner["seed"])
	_read_skeleton(data)
	life = Life.life_of(data.get("life", {}))
	lines = data.get("lines", {})
	for name in data.get("points", {}):
		points[name] = Util.vector(data.points[name])
	for line in data.get("voices", {}):
		voices[line] = data.voices[line]
	face_morphs = data.get("face", {}).get("morphs", []).size() > 0
	for layer in Util.LAYERS:
		_read_layer(layer, data.layers[layer])
	if data.get("rig") != null:
		rig = Rig.rig_of(data.rig, shim)
	if not shim.are_bytes(bytes):
		return "the GLB cannot be read; check that '%s' is beside the JSON" % str(data.get("glb", "it"))
	var glb = Glb.new(bytes, shim)
	if glb.error != "":
		return "the GLB: %s; export it again" % glb.error
	return _read_clips(data, glb)


# Returns what is missing or of the wrong kind, as a path and words; "" when nothing is.
static func _wrong(data):
	var out = _lacks(data, EXPORT, "$")
	if out == "":
		out = _lacks(data.planner, PLANNER, "$.planner")
	if out == "":
		out = _lacks(data.base, {rotations = "[]", translations = "[]"}, "$.base")
	if out == "":
		out = _all_lack(data.joints, JOINT, "$.joints")
	if out == "":
		out = _all_lack(data.clips, CLIP, "$.clips")
	if out != "":
		return out
	if data.base.rotations.size() != data.joints.size() or data.base.translations.size() != data.joints.size():
		return "$.base: should have a rotation and a translation for each joint"
	for layer in Util.LAYERS:
		var where = "$.layers." + layer
		if typeof(data.layers.get(layer)) != TYPE_DICTIONARY:
			return where + ": it is missing"
		var of = data.layers[layer]
		out = _lacks(of, LAYER, where)
		if out == "":
			out = _all_lack(of.stances, STANCE, where + ".stances")
		if out == "":
			out = _all_lack(of.actions, ACTION, where + ".actions")
		if out == "":
			out = _lacks(of.markov, MARKOV, where + ".markov")
		if out != "":
			return out
	return ""


static func _all_lack(items, fields, where):
	for n in range(items.size()):
		var out = _lacks(items[n], fields, "%s[%d]" % [where, n])
		if out != "":
			return out
	return ""


static func _lacks(record, fields, where):
	if typeof(record) != TYPE_DICTIONARY:
		return where + ": should be a record"
	for name in fields:
		var kind = fields[name]
		var value = record.get(name)
		if value == null and kind.ends_with("?"):
			continue
		if not _is(value, kind.trim_suffix("?")):
			return "%s.%s: %s" % [where, name, "it is missing" if value == null else "is of the wrong kind"]
	return ""


static func _is(value, kind):
	match kind:
		"text":
			return typeof(value) == TYPE_STRING
		"number":
			return Util.is_number(value)
		"switch":
			return typeof(value) == TYPE_BOOL
		"{}":
			return typeof(value) == TYPE_DICTIONARY
		"[]":
			return typeof(value) == TYPE_ARRAY
	if typeof(value) != TYPE_ARRAY or value.size() != int(kind):
		return false
	for number in value:
		if not Util.is_number(number):
			return false
	return true


func _read_skeleton(data):
	for joint in data.joints:
		parents.append(names.find(joint.parent) if joint.parent != null else -1)
		names.append(joint.name)
		parts.append(joint.part)
		sides.append(joint.side)
		rest_rotations.append(Util.quaternion(joint.rotation, shim))
		rest_translations.append(Util.vector(joint.translation))
	for n in range(names.size()):
		base_rotations.append(Util.quaternion(data.base.rotations[n], shim))
		base_translations.append(Util.vector(data.base.translations[n]))
		still_frame.turns.append(shim.quat(0.0, 0.0, 0.0, 1.0))


func _read_layer(layer, data):
	var stances = {}
	for stance in data.stances:
		stances[stance.id] = stance.name
	var actions = {}
	var kinds = {}
	for each in data.actions:
		var action = each.duplicate()
		action.layer = layer
		action.phases = each.get("phases", [])
		action.cooldown = each.get("cooldown", 0.0)
		action.spacing = each.get("spacing")
		action.still = _still(action)
		actions[action.id] = action
		kinds[action.kind] = true
		var node = "%s/%s/%s" % [layer, action.kind, action.stance]
		_index[node] = _index.get(node, []) + [action]
	var markov = data.markov.duplicate()
	markov.tags = data.markov.get("tags", [])
	markov.lengths = data.markov.get("lengths", [])
	var reach = []  # [joint, weight] of those it moves
	for joint in range(names.size()):
		var weight = data.weights.get(parts[joint], 0.0)
		if weight > 0:
			reach.append([joint, weight])
	layers[layer] = {
		layer = layer, start = data.start, stances = stances, actions = actions, kinds = kinds, markov = markov, reach = reach
	}


# Returns {joint: true} of the joints an action leaves to its stance; null where it moves all.
func _still(action):
	if action.limb == "both" and action.joints.size() == 0:
		return null
	var other = "right" if action.limb == "left" else "left"
	var out = {}
	for joint in range(names.size()):
		var far = action.limb != "both" and parts[joint] == "arms" and sides[joint] == other
		if far or (action.joints.size() > 0 and not action.joints.has(names[joint])):
			out[joint] = true
	return out


func _read_clips(data, glb):
	var nodes = {}
	for n in range(glb.nodes.size()):
		var joint = names.find(glb.nodes[n].get("name", ""))
		if joint >= 0 and not nodes.values().has(joint):
			nodes[n] = joint
	for joint in range(names.size()):
		if not nodes.values().has(joint):
			return "the GLB has no joint '%s'; export it again, and keep JSON and GLB together" % names[joint]
	for n in nodes:
		# The skin's pose is the nodes' own, which the channels that are missing leave as it is.
		rest_rotations[nodes[n]] = Util.quaternion(glb.nodes[n].get("rotation", [0.0, 0.0, 0.0, 1.0]), shim)
		rest_translations[nodes[n]] = Util.vector(glb.nodes[n].get("translation", [0.0, 0.0, 0.0]))
	for clip in data.clips:
		var place = int(clip.animation)
		if place < 0 or place >= glb.animations.size() or glb.animations[place].name != clip.name:
			place = -1
			for n in range(glb.animations.size()):
				if glb.animations[n].name == clip.name:
					place = n
		if place < 0:
			problems.append("the GLB has no animation '%s': its actions show their stance" % clip.name)
		else:
			var pose = [rest_rotations, rest_translations, base_rotations, base_translations]
			clips[clip.id] = Clip.new(glb, glb.animations[place].channels, nodes, clip, pose, frames, shim)
	return ""


# Returns the actions of a kind placed on a stance; `layer` is one of `layers`.
func of(layer, stance, kind):
	return _index.get("%s/%s/%s" % [layer.layer, kind, stance], [])


# Returns the action of an id or, failing that, a name; of several of one name the likeliest; null for none. layer: null for any.
func find_action(word, layer):
	for each in Util.LAYERS:
		var found = layers[each].actions.get(word)
		if found != null:
			if layer == null or layer == each:
				return found
			break
	var best = null
	for each in Util.LAYERS:
		if layer == null or layer == each:
			for action in layers[each].actions.values():
				if action.name == word and (best == null or action.likelihood > best.likelihood):
					best = action
	return best


# Returns [layer, stance id] of an id or name; null for none. layer: null for any.
func find_stance(word, layer):
	for each in Util.LAYERS:
		if layer == null or layer == each:
			if layers[each].stances.has(word):
				return [each, word]
			for stance in layers[each].stances:
				if layers[each].stances[stance] == word:
					return [each, stance]
	return null
