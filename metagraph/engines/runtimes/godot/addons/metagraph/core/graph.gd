# An export, read: skeleton, base pose, clips, layers, constants, the life layers' body and voices. What is wrong is said in `error`;
# what is merely lacking, in `problems`. Nothing here changes once it is read, so many characters share one graph.

const Util = preload("util.gd")
const Check = preload("check.gd")
const LayerGraph = preload("layer_graph.gd")
const Model = preload("model.gd")
const PhaseTimes = preload("phase_times.gd")
const Clip = preload("clip.gd")
const Glb = preload("glb.gd")
const Life = preload("life.gd")
const Rig = preload("rig.gd")
const Contacts = preload("contacts.gd")
const Weight = preload("weight.gd")
const Alphabet = preload("alphabet.gd")
const FORMAT = 1  # the newest version of exports that is understood
const CORE = "res://addons/metagraph/core/"
const PLANNER_USUAL = {memory = 0.0, rest = 0.0, lookahead = 0.1, variety = 0.0}

var error = ""
var problems = []
var shim
var alphabet
var names = []  # [J] joints, parents before children
var parents = []  # [J], -1 for a root
var parts = []
var sides = []
var larger = []  # which turn farther, and which less far, where a cue is played larger or smaller than made
var smaller = []
var rest_rotations = []
var rest_translations = []
var base_rotations = []
var base_translations = []
var clips = {}  # id -> Clip, for those whose motion is there
var layers = {}  # layer -> see layer_graph.gd
var settings = {}
var life = {}
var rig = null  # see rig.gd; null where nothing lives
var contact_rig = null  # see contacts.gd; null where the export has none
var weight_rig = null  # see weight.gd; null where the export has none
var arm_tracks = {}  # action -> what it weighs
var feet_layer = "body"  # it moves the legs
var foot_tracks = {}  # action of that layer -> where its feet are
var name = ""  # of the project
var points = {}  # name -> Vector3
var spots = {}  # name -> [x, y, z], as the export has them
var lines = {}
var parameters = {}  # what games set, by name, see parameters.gd
var voices = {}  # line -> voice, see voice.gd
var said = {}  # voices made from letters, by text and length
var still_frame = {turns = [], shifts = {}}  # the base pose, as a clip's frame
var frames = {}  # those of clips that were made so far, see clip.gd


# json: the export's text. bytes: its GLB's.
func _init(json, bytes):
	shim = load(CORE + "shim%d.gd" % Engine.get_version_info()["major"])
	alphabet = Alphabet.new(shim)
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
	var wrong = Check.wrong(data)
	if wrong != "":
		return wrong + "; export it again"
	for field in PLANNER_USUAL:
		settings[field] = float(data.planner.get(field, PLANNER_USUAL[field]))
	for field in Check.PLANNER:
		settings[field] = data.planner[field]
	settings.seed32 = int(data.planner["seed"])
	_read_skeleton(data)
	life = Life.life_of(data.life)
	name = str(data.get("name", ""))
	lines = data.lines
	parameters = data.parameters
	spots = data.points
	for point in data.points:
		points[point] = Util.vector(data.points[point])
	for line in data.voices:
		voices[line] = data.voices[line]
	for layer in Util.LAYERS:
		_read_layer(layer, data.layers[layer])
	if data.rig != null:
		rig = Rig.rig_of(data.rig, shim)
	if data.contact_rig != null:
		contact_rig = Contacts.rig_of(data.contact_rig, names)
	if data.weight_rig != null:
		weight_rig = Weight.rig_of(data.weight_rig)
		arm_tracks = Weight.tracks_of(layers, data.clips)
		feet_layer = data.weight_rig.feet_layer if layers.has(data.weight_rig.feet_layer) else "body"
		foot_tracks = Weight.feet_of(layers[feet_layer], data.clips)
	if not shim.are_bytes(bytes):
		return "the GLB cannot be read; check that '%s' is beside the JSON" % str(data.get("glb", "it"))
	var glb = Glb.new(bytes, shim)
	if glb.error != "":
		return "the GLB: %s; export it again" % glb.error
	var length = data.get("glb_bytes")
	if Util.is_number(length) and int(length) != bytes.size():
		problems.append("'%s' is not the GLB that this JSON was written with (%d bytes, not %d): export again, and copy both files" % [str(data.get("glb", "it")), bytes.size(), int(length)])
	return _read_clips(data, glb)


func _read_skeleton(data):
	for joint in data.joints:
		parents.append(names.find(joint.parent) if joint.parent != null else -1)
		names.append(joint.name)
		parts.append(joint.part)
		sides.append(joint.side)
		larger.append(joint.scales == null or joint.scales == "both")
		smaller.append(joint.scales != "neither")
		rest_rotations.append(Util.quaternion(joint.rotation, shim))
		rest_translations.append(Util.vector(joint.translation))
	for n in range(names.size()):
		base_rotations.append(Util.quaternion(data.base.rotations[n], shim))
		base_translations.append(Util.vector(data.base.translations[n]))
		still_frame.turns.append(shim.quat(0.0, 0.0, 0.0, 1.0))


func _read_layer(layer, data):
	var found = LayerGraph.new(layer, data.start)
	for stance in data.stances:
		found.stances[stance.id] = Model.Stance.new(stance.id, layer, stance.name)
	for each in data.actions:
		var action = each.duplicate()
		action.layer = layer
		var loops = action.kind == "stance"
		var repeat = 0.0 if each.repeat == null else each.repeat
		action.timing = Model.Timing.new(
			each.start, each.end, each.blend_in, each.blend_out, loops, each.earliest_exit, each.stroke, null, null, null, repeat
		)
		var told = each.phases  # ready, stroke, stroke end, relax
		if told == null or told.size() != 4:
			var stroke = (each.start + each.end) / 2.0 if each.stroke == null else Util.within(each.stroke, each.start, each.end)
			told = [stroke, stroke, stroke, stroke]
		action.phases = PhaseTimes.Phases.new(each.start, told[0], told[1], told[2], told[3], each.end)
		action.cooldown = 0.0 if each.cooldown == null else each.cooldown
		action.vigour = 0.0 if each.vigour == null else each.vigour
		action.prominence = 0.0 if each.prominence == null else each.prominence
		action.contacts = Contacts.read(each.contacts)
		action.joint_weights = {} if each.joint_weights == null else each.joint_weights
		action.partly = _partly(action)
		found.add(action)
	var own = data.markov
	found.markov = Model.Markov.new(
		layer, own.states, own.matrix, own.gap, own.positive, own.negative, own.get("tags"), own.get("lengths"), own.get("modes")
	)
	found.strength = Util.least(1.0, data.weights.get("arms", 0.0))
	for joint in range(names.size()):
		var weight = data.weights.get(parts[joint], 0.0)
		if weight > 0:
			found.reach.append([joint, weight])
	layers[layer] = found


# Returns {joint: how far it moves} of the joints that an action does not move wholly; null where it moves all of all.
func _partly(action):
	if action.limb == "both" and action.joints.size() == 0 and action.joint_weights.size() == 0:
		return null
	var other = "right" if action.limb == "left" else "left"
	var out = {}
	for joint in range(names.size()):
		var far = action.limb != "both" and parts[joint] == "arms" and sides[joint] == other
		if far or (action.joints.size() > 0 and not action.joints.has(names[joint])):
			out[joint] = 0.0
		elif action.joint_weights.has(names[joint]):
			out[joint] = Util.within(action.joint_weights[names[joint]], 0.0, 1.0)
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


# Returns the seconds of its clip between which an action plays.
func span(action):
	return [action.start, action.end]
