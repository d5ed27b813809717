# What may be asked of a character, as plain data.

const Util = preload("util.gd")
const Asks = preload("asks.gd")
const Words = preload("words.gd")
const Repeating = preload("repeating.gd")
const Parameters = preload("parameters.gd")


# Returns {project, words: what `do` may be, modes, joints [{name, parent, part}], layers {layer: {start, stances [{id, name}], actions but
# loops of stances, tags {tag: number of actions}}}, lines [{id, text}], points {name: [x, y, z] metres},
# and, where there are any, parameters {name: {type, about, initial, least, most, choices}}}.
static func describe(graph):
	var words = []
	for word in Asks.FIELDS:
		if word != "bml":  # read by the desktop alone
			words.append(str(word))  # Godot 4 has names for keys, which are no texts
	var joints = []
	for n in range(graph.names.size()):
		var parent = null if graph.parents[n] < 0 else graph.names[graph.parents[n]]
		joints.append({name = graph.names[n], parent = parent, part = graph.parts[n]})
	var layers = {}
	for layer in Util.LAYERS:
		layers[layer] = _layer(graph.layers[layer])
	var lines = []
	var ids = graph.lines.keys()
	ids.sort()
	for id in ids:
		lines.append({id = id, text = graph.lines[id].get("text", "")})
	var out = {
		project = graph.name, words = words, modes = Words.MODES.duplicate(), joints = joints, layers = layers, lines = lines,
		points = graph.spots
	}
	if graph.parameters.size() > 0:
		out.parameters = Parameters.describe(graph.parameters)
	return out


static func _layer(of):
	var stances = []
	for id in of.stances:
		stances.append({id = id, name = of.stances[id].name})
	var actions = []
	var tags = {}
	for action in of.actions.values():
		for tag in action.tags:
			tags[tag] = tags.get(tag, 0) + 1
		if action.kind != "stance":
			actions.append(_action(action))
	return {start = of.start, stances = stances, actions = actions, tags = tags}


static func _action(action):
	var out = {
		id = action.id, name = action.name, kind = action.kind, stance = action.stance,
		seconds = Repeating.seconds_played(action.kind, action.timing, action.start, action.end)
	}
	if action.kind == "transition":
		out.to = action.end_stance
	if action.limb != "both":
		out.limb = action.limb
	if action.tags.size() > 0:
		out.tags = action.tags
	return out
