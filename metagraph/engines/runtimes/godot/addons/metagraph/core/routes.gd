# Which actions can play on a layer, and the way from stance to stance.
#
# Translated from metagraph/playback/planning/routes.py; change that, and translate anew.

const Choice = preload("choice.gd")
const Util = preload("util.gd")


# One action of a chain: the candidates for it and, for a transition on the way, the stance it leads to.
class SamplingStep:
	var candidates
	var hop

	func _init(candidates_, hop_ = ""):
		self.candidates = candidates_
		self.hop = hop_


static func may_play(state, action):
	return action.likelihood > 0 and arrives(state, action)


# Return whether an action leaves the layer in a stance that has a loop.
static func arrives(state, action):
	var end = action.end_stance
	if action.kind != "transition":
		return true
	return end != null and state.graph.stances.has(end) and state.graph.of(end, "stance").size() > 0


# Return the stances after the current one on the shortest way of transitions that can play, the goal last; empty if there is no
# way. Among equally short ways, the one whose transitions were placed first.
static func find_hops(state, goal):
	var before = {state.stance: ""}
	var queue = [state.stance]
	var at = 0  # what is before it was looked at
	while at < queue.size() and not before.has(goal):
		var stance = queue[at]
		at += 1
		for action in state.graph.of(stance, "transition"):
			var end = action.end_stance
			if end == null or before.has(end) or not state.graph.stances.has(end):
				continue
			if may_play(state, action):
				before[end] = stance
				queue.append(end)
	var way = []
	if not before.has(goal):
		return way
	var step = goal
	while step != state.stance:
		way.append(step)
		step = before[step]
	return Util.list(Util.backwards(way))


static func name_elsewhere(state, request):
	for action in state.graph.actions.values():
		var holds = action.kind == request.kind
		if holds:
			var are_all = true
			for tag in request.tags:
				if not action.tags.has(tag):
					are_all = false
					break
			holds = are_all
		if holds:
			holds = request.limb == null or request.limb == action.limb
		var fits = holds
		if fits and state.graph.stances.has(action.stance):
			return "; there is one in '%s'" % [state.graph.stances[action.stance].name]
	return ""


# Return one of a stance's loops, drawn by likelihood; None if it has none.
static func draw_loop(state, stance, key):
	var loops = state.graph.of(stance, "stance")
	if loops.size() == 1:
		return loops[0]
	var weights = {}
	for a in loops:
		if a.likelihood > 0:
			weights[a.id] = a.likelihood
	if weights.size() == 0:
		return loops[0] if loops.size() > 0 else null
	var chosen = Choice.pick(state.seed_, key, "loop", weights)
	var first = null
	for a in loops:
		if a.id == chosen:
			first = a
			break
	return first


# Return the transitions hop by hop from the current stance to `goal`.
static func find_route(state, meta, goal):
	if goal == state.stance:
		var name = state.graph.stances[goal].name
		state.tell(meta, "already-there", "the layer is in '%s' already" % [name], true)
		return null
	var stances = find_hops(state, goal)
	if stances.size() == 0:
		var a = state.graph.stances[state.stance].name
		var b = state.graph.stances[goal].name
		state.tell(meta, "no-way", "no chain of transitions leads from '%s' to '%s'" % [a, b])
		return null
	var steps = []
	var at = state.stance
	for following in stances:
		var hops = []
		for a2 in state.graph.of(at, "transition"):
			if a2.end_stance == following and may_play(state, a2):
				hops.append(a2)
		steps.append(SamplingStep.new(hops, following))
		at = following
	return steps
