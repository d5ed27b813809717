# What an export must have for this runtime to read it. More than this it may have; what is not known is passed over.

const Util = preload("util.gd")
# Field -> what it is: a text, a number, a switch, a record, a list, or so many numbers; "?": null, or not there, which is made null.
const EXPORT = {joints = "list", base = "record", clips = "list", layers = "record", planner = "record"}
const OPTIONAL = {
	life = "record?", face = "record?", points = "record?", lines = "record?", voices = "record?", rig = "record?", contact_rig = "record?",
	weight_rig = "record?", parameters = "record?"
}
const EMPTY = ["life", "face", "points", "lines", "voices", "parameters"]  # where these are not there
const BASE = {rotations = "list", translations = "list"}
const JOINT = {name = "text", parent = "text?", part = "text", side = "text", translation = "3", rotation = "4", scales = "text?"}
const CLIP = {id = "text", name = "text", animation = "number", fps = "number", frames = "number", arms = "list?", feet = "list?"}
const LAYER = {start = "text?", weights = "record", stances = "list", actions = "list", markov = "record"}
const STANCE = {id = "text", name = "text"}
const ACTION = {
	id = "text", name = "text", clip = "text", kind = "text", stance = "text", end_stance = "text?", start = "number", end = "number",
	blend_in = "number", blend_out = "number", earliest_exit = "number?", stroke = "number?", limb = "text", joints = "list", tags = "list",
	likelihood = "number", phases = "list?", cooldown = "number?", spacing = "number?", contacts = "list?", vigour = "number?", prominence = "number?", own_prominence = "number?",
	joint_weights = "record?", repeat = "number?"
}
const MARKOV = {
	states = "list", matrix = "list", gap = "number", positive = "number", negative = "number", tags = "list?", lengths = "list?", modes = "list?"
}
const PLANNER = {
	"seed": "number", "alpha": "number", "never_twice": "switch", "shortest": "number", "wait": "number", "window": "number",
	"loop_fade": "number"
}
const RIG = {
	left = "3", up = "3", ahead = "3", chain = "list", breath = "list", shoulders = "list", lookers = "list", trunk = "number",
	trunk_ahead = "3", head_ahead = "3", eyes = "list", partner = "3", eyes_at_rest = "3", face = "record", bowed = "list?", thrust = "list?"
}
const EYE = {at = "3", left = "3", up = "3", ahead = "3", joint = "number", turn_left = "3", turn_up = "3", down = "4"}
const SHOULDER = {joint = "number", turn = "3", tense = "3?", closed = "3?"}
const LOOKER = {place = "number", share = "number"}
const FACE = {joints = "list", turns = "list", shifts = "list", follows = "4", lid_joints = "4", shut_by = "list", morphs = "record"}
const CONTACT_RIG = {contacts = "switch", guard = "switch", joints = "list", parents = "list", arms = "list", capsules = "list"}
const CAPSULE = {joint = "number", a = "3", to = "number", b = "3", radius = "number", arm = "number", kind = "number"}
const WEIGHT_RIG = {
	joints = "list", parents = "list", legs = "list", hands = "list", bends = "list", collars = "list", knees = "list", levers = "list",
	up = "3", height = "number", strength = "number", feet_layer = "text?"
}
const BEND = {place = "number", left = "3", up = "3", ahead = "3", share = "number"}
const COLLAR = {place = "number", upper = "number", axis = "3", side = "number"}
const CONTACT = {
	hand = "text", place = "text", to = "text", start = "number", end = "number", ease_in = "number", ease_out = "number", keys = "list"
}
const PARAMETER = {
	type = "text", request = "record", field = "text?", about = "text?", choices = "list?", least = "number?", most = "number?", beside = "list?",
	replaces = "list?"
}
const CHOICE = {name = "text"}
const PARAMETER_TYPES = ["number", "boolean", "enum", "list", "point", "trigger"]
const VOICE = {duration = "number", accents = "list", weights = "list"}


# Returns what is missing or of the wrong kind, as a path and words; "" when nothing is.
static func wrong(data):
	var checks = [
		[[data], EXPORT, "$"], [[data], OPTIONAL, "$"], [[data.get("planner")], PLANNER, "$.planner"], [[data.get("base")], BASE, "$.base"],
		[data.get("joints"), JOINT, "$.joints"], [data.get("clips"), CLIP, "$.clips"]
	]
	for layer in Util.LAYERS:
		var where = "$.layers." + layer
		var of = data.layers.get(layer) if typeof(data.get("layers")) == TYPE_DICTIONARY else null
		checks.append([[of], LAYER, where])
		if typeof(of) == TYPE_DICTIONARY:
			checks.append([of.get("stances"), STANCE, where + ".stances"])
			checks.append([of.get("actions"), ACTION, where + ".actions"])
			checks.append([[of.get("markov")], MARKOV, where + ".markov"])
	for name in EMPTY:
		if data.get(name) == null:
			data[name] = {}
	var rig = data.get("rig")
	if typeof(rig) == TYPE_DICTIONARY:
		checks.append([[rig], RIG, "$.rig"])
		checks.append([rig.get("eyes"), EYE, "$.rig.eyes"])
		checks.append([rig.get("shoulders"), SHOULDER, "$.rig.shoulders"])
		checks.append([rig.get("lookers"), LOOKER, "$.rig.lookers"])
		checks.append([[rig.get("face")], FACE, "$.rig.face"])
	var touching = data.get("contact_rig")
	if typeof(touching) == TYPE_DICTIONARY:
		checks.append([[touching], CONTACT_RIG, "$.contact_rig"])
		checks.append([touching.get("capsules"), CAPSULE, "$.contact_rig.capsules"])
	var weighing = data.get("weight_rig")
	if typeof(weighing) == TYPE_DICTIONARY:
		checks.append([[weighing], WEIGHT_RIG, "$.weight_rig"])
		checks.append([weighing.get("bends"), BEND, "$.weight_rig.bends"])
		checks.append([weighing.get("collars"), COLLAR, "$.weight_rig.collars"])
	if typeof(data.voices) == TYPE_DICTIONARY:
		checks.append([data.voices.values(), VOICE, "$.voices"])
	if typeof(data.parameters) == TYPE_DICTIONARY:
		checks.append([data.parameters.values(), PARAMETER, "$.parameters"])
		for name in data.parameters:
			if typeof(data.parameters[name]) == TYPE_DICTIONARY and data.parameters[name].get("choices") != null:
				checks.append([data.parameters[name].choices, CHOICE, "$.parameters.%s.choices" % name])
	for check in checks:
		var out = _lack(check[0], check[1], check[2])
		if out != "":
			return out
	return _unlike(data)


# Returns what does not fit together.
static func _unlike(data):
	for name in data.parameters:
		var one = data.parameters[name]
		one.field = "" if one.field == null else one.field
		one.about = "" if one.about == null else one.about
		one.choices = [] if one.choices == null else one.choices
		one.beside = [] if one.beside == null else one.beside
		one.replaces = [] if one.replaces == null else one.replaces
		one.initial = one.get("initial")
		one.least = 0.0 if one.least == null else float(one.least)
		one.most = 1.0 if one.most == null else float(one.most)
		if not PARAMETER_TYPES.has(one.type):
			return "$.parameters.%s.type: should be one of %s" % [name, Util.joined(PARAMETER_TYPES, ", ")]
		if one.type == "boolean" and one.choices.size() != 2:
			return "$.parameters.%s: should have two choices" % name
	var joints = {}
	for joint in data.joints:
		if joint.parent != null and not joints.has(joint.parent):
			return "$.joints: '%s' should come after its parent '%s'" % [joint.name, joint.parent]
		joints[joint.name] = true
	for name in BASE:
		if data.base[name].size() != data.joints.size():
			return "$.base.%s: should be one for each joint" % name
		for each in data.base[name]:
			if not _is(each, "4" if name == "rotations" else "3"):
				return "$.base.%s: should be lists of numbers" % name
	for layer in Util.LAYERS:
		var markov = data.layers[layer].markov
		if markov.matrix.size() != markov.states.size():
			return "$.layers.%s.markov.matrix: should have a row for each state" % layer
		for action in data.layers[layer].actions:
			if action.contacts != null:
				var out = _stray_contacts(action.contacts, "$.layers.%s.actions.contacts" % layer)
				if out != "":
					return out
	if data.contact_rig != null:
		var out = _stray_places(data.contact_rig, data.joints.size())
		if out != "":
			return out
	if data.weight_rig != null:
		var out = _stray_weights(data.weight_rig, data.joints.size())
		if out != "":
			return out
	for clip in data.clips:
		for row in clip.arms if clip.arms != null else []:
			if not _is(row, "8"):
				return "$.clips.arms: should be rows of eight numbers"
		for row in clip.feet if clip.feet != null else []:
			if not _is(row, "16"):
				return "$.clips.feet: should be rows of sixteen numbers"
	return "" if data.rig == null else _strays(data.rig, data.joints.size())


# Returns what is wrong with an action's contacts.
static func _stray_contacts(contacts, where):
	var out = _lack(contacts, CONTACT, where)
	if out != "":
		return out
	for each in contacts:
		for key in each.keys:
			if not _is(key, "8"):
				return where + ".keys: should be rows of eight numbers"
	return ""


# Returns what of a contact rig names a joint, or a place among its joints, that is not there.
static func _stray_places(rig, count):
	var places = []
	for arm in rig.arms:
		if not _is(arm, "3"):
			return "$.contact_rig.arms: should be places of three joints each"
		places += arm
	for capsule in rig.capsules:
		places += [capsule.joint, capsule.to]
	for joint in rig.joints:
		if not Util.is_number(joint) or joint < 0 or joint >= count:
			return "$.contact_rig: there is no joint %s" % str(joint)
	for place in places:
		if place < 0 or place >= rig.joints.size():
			return "$.contact_rig: there is no place %s" % str(place)
	if rig.arms.size() != 2 or rig.parents.size() != rig.joints.size():
		return "$.contact_rig: should have two arms, and a parent for each joint"
	for n in range(rig.parents.size()):
		if not Util.is_number(rig.parents[n]) or rig.parents[n] >= n or rig.parents[n] < -1:
			return "$.contact_rig: parents should come before their children"
	return ""


# Returns what of a weight rig names a joint, or a place among its joints, that is not there, and what it lacks.
static func _stray_weights(rig, count):
	for each in [[rig.legs, "3"], [rig.knees, "3"], [rig.levers, "2"]]:
		if each[0].size() != 2 or not _is(each[0][0], each[1]) or not _is(each[0][1], each[1]):
			return "$.weight_rig: legs, knees and levers should be two each, of numbers"
	if rig.hands.size() != 2 or rig.bends.size() == 0 or rig.parents.size() != rig.joints.size():
		return "$.weight_rig: should have two hands, hips, and a parent for each joint"
	var places = rig.legs[0] + rig.legs[1]
	for bend in rig.bends:
		places.append(bend.place)
	for collar in rig.collars:
		places += [collar.place, collar.upper]
	for joint in rig.joints:
		if not Util.is_number(joint) or joint < 0 or joint >= count:
			return "$.weight_rig: there is no joint %s" % str(joint)
	for place in places:
		if place < 0 or place >= rig.joints.size():
			return "$.weight_rig: there is no place %s" % str(place)
	for n in range(rig.parents.size()):
		if not Util.is_number(rig.parents[n]) or rig.parents[n] >= n or rig.parents[n] < -1:
			return "$.weight_rig: parents should come before their children"
	return ""


# Returns what of a rig names a joint, or a place in the chain, that is not there.
static func _strays(rig, count):
	var joints = rig.chain + rig.face.joints + rig.face.lid_joints
	for each in rig.eyes + rig.shoulders:
		joints.append(each.joint)
	for joint in joints:
		if not Util.is_number(joint) or joint < -1 or joint >= count:
			return "$.rig: there is no joint %s" % str(joint)
	var places = [rig.trunk]
	for looker in rig.lookers:
		places.append(looker.place)
	for place in places:
		if place < 0 or place >= rig.chain.size():
			return "$.rig: there is no place %s in the chain" % str(place)
	if rig.breath.size() != rig.chain.size() or rig.eyes.size() != 2:
		return "$.rig: should have a breath for each joint of the chain, and two eyes"
	for angle in rig.bowed if rig.bowed != null else []:
		if not Util.is_number(angle):
			return "$.rig.bowed: should be numbers"
	for angle in rig.thrust if rig.thrust != null else []:
		if not Util.is_number(angle):
			return "$.rig.thrust: should be numbers"
	return ""


static func _lack(items, fields, where):
	if typeof(items) != TYPE_ARRAY:
		return where + ": should be a list"
	for n in range(items.size()):
		var place = where if items.size() == 1 else "%s[%d]" % [where, n]
		if typeof(items[n]) != TYPE_DICTIONARY:
			return place + ": it is missing or of the wrong kind"
		for name in fields:
			var kind = fields[name]
			var value = items[n].get(name)
			if value == null and kind.ends_with("?"):
				items[n][name] = null
				continue
			if not _is(value, kind.trim_suffix("?")):
				return "%s.%s: %s" % [place, name, "it is missing" if value == null else "is of the wrong kind"]
	return ""


static func _is(value, kind):
	match kind:
		"text":
			return typeof(value) == TYPE_STRING
		"number":
			return Util.is_number(value)
		"switch":
			return typeof(value) == TYPE_BOOL
		"record":
			return typeof(value) == TYPE_DICTIONARY
		"list":
			return typeof(value) == TYPE_ARRAY
	if typeof(value) != TYPE_ARRAY or value.size() != int(kind):
		return false
	for number in value:
		if not Util.is_number(number):
			return false
	return true
