# Which actions a meta action may become: the transitions on the way, then the candidates.
#
# Translated from metagraph/playback/planning/steps.py; change that, and translate anew.

const Directing = preload("directing.gd")
const Remembering = preload("remembering.gd")
const Routes = preload("routes.gd")
const Util = preload("util.gd")


# Return each action in turn: the transitions to get there, then the action itself; None if it is impossible or not needed, or if
# the model wrote it and every candidate played too recently.
static func choose_steps(state, meta, now):
	var request = meta.request
	var graph = state.graph
	if request.action != null:
		var action = graph.actions.get(request.action)
		if action == null or not graph.stances.has(action.stance):
			state.tell(meta, "unknown-action", "there is no action '%s' in the %s layer" % [request.action, graph.layer])
			return null
		if action.kind == "stance":
			return Routes.find_route(state, meta, action.stance)
		if not Routes.arrives(state, action):
			state.tell(meta, "no-stance", "'%s' ends in a stance that has no loop" % [action.name])
			return null
		if action.stance == state.stance:
			return [Routes.SamplingStep.new([action])]
		var way = Routes.find_route(state, meta, action.stance)
		return null if way == null else way + [Routes.SamplingStep.new([action])]
	if request.stance != null and ["transition", "stance"].has(request.kind):
		if not graph.stances.has(request.stance):
			state.tell(meta, "no-stance", "there is no stance '%s' in the %s layer" % [request.stance, graph.layer])
			return null
		return Routes.find_route(state, meta, request.stance)
	var leads = Directing.find_lead(state, now) if meta.written else ""
	if leads != "":
		return Routes.find_route(state, meta, leads)
	var found = _find_candidates(state, meta, now)
	return null if found.size() == 0 else [Routes.SamplingStep.new(found)]


# Return the actions of the current stance that fit, none if every one played too recently for what the model wrote.
static func _find_candidates(state, meta, now):
	var request = meta.request
	var graph = state.graph
	var here = Remembering.node(state.stance, request.kind)
	if not state.candidates.has(here):
		var found2 = []
		for a in graph.of(state.stance, request.kind):
			if Routes.may_play(state, a):
				found2.append(a)
		state.candidates[here] = found2
	var every = state.candidates[here]
	if request.among.size() > 0:
		var found3 = []
		for a in every:
			if request.among.has(a.id):
				found3.append(a)
		every = found3
	var found = every
	if request.tags.size() > 0:
		var found4 = []
		for a in every:
			var are_all = true
			for tag in request.tags:
				if not a.tags.has(tag):
					are_all = false
					break
			if are_all:
				found4.append(a)
		found = found4
	var exact = found
	if request.limb != null:
		var found5 = []
		for a in found:
			if a.limb == request.limb:
				found5.append(a)
		exact = found5
	var directed = meta.written and state.project.settings.variety > 0
	if directed:  # the model's limb and tags are wishes, not orders
		every = Directing.keep_fresh(state, meta, every, now)
		var fresh = {}
		for a in every:
			Util.add_to(fresh, a.id)
		var found6 = []
		for a in found:
			if fresh.has(a.id):
				found6.append(a)
		found = found6
		var found7 = []
		for a in exact:
			if fresh.has(a.id):
				found7.append(a)
		exact = found7
		if every.size() == 0:
			return Directing.find_moves(state, meta, now)
		if exact.size() == 0:
			exact = found if found.size() > 0 else every
	elif meta.written:  # nor worth playing the same again
		var again = Util.part(state.recent.get(here, []), -1, state.recent.get(here, []).size())
		var is_any = false
		for a in exact:
			if not again.has(a.id):
				is_any = true
				break
		if not is_any:
			var is_any2 = false
			for a in found:
				if not again.has(a.id):
					is_any2 = true
					break
			exact = found if is_any2 else every
	exact = Directing.keep_modest(state, meta, exact, now)
	if exact.size() == 0:
		var name = graph.stances[state.stance].name
		var asked = Util.joined(request.tags + [request.kind], " ")
		if request.limb != null:
			asked = "%s %s" % [request.limb, asked]
		if found.size() > 0:  # whose limb is a wish, too
			state.tell(meta, "other-limb", "stance '%s' has no %s; another will do" % [name, asked], true)
			return found
		var hint = "" if meta.written else Routes.name_elsewhere(state, request)
		state.tell(meta, "no-candidate", "stance '%s' has no %s%s" % [name, asked, hint])
	return exact
