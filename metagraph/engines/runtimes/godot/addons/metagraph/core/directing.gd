# What the character does of its own accord: when it acts, rests and thinks, and what it does not repeat. The times are those of
# `director`.
#
# Translated from metagraph/playback/planning/directing.py; change that, and translate anew.

const Wanted = preload("wanted.gd")
const Choice = preload("choice.gd")
const Director = preload("director.gd")
const Markov = preload("markov.gd")
const Mood = preload("mood.gd")
const Prominence = preload("prominence.gd")
const Routes = preload("routes.gd")
const Util = preload("util.gd")


# Return whether what a model wrote is performed at a time: not out of a stance that a request holds, and as often as mode and
# mood say. Anything may begin a long thought, or end it.
static func performs_written(state, meta, now):
	if not Mood.stirs(Mood.mood_at(state.moods, now), state.seed_, meta.request.id):
		return false
	if meta.request.kind == "transition" and state.track.stays_at(state.graph.layer, now):
		return false
	if state.model == null or muses(state, now) or has_mused(state, now):
		return true
	return Markov.performs(state.model, state.seed_, meta, Wanted.mode_at(state.track, now))


# Return whether what a model wrote begins at a time, which may be later than it was written for: not soon after an interruption,
# and nothing that would end a thought.
static func may_begin(state, meta, now):
	if state.track.hushed_at(now) or not performs_written(state, meta, now):
		return false
	if state.model == null or find_lead(state, now) != "":
		return true
	if lulls(state, now):
		return false
	var there = state.stance == Director.musing(state.graph.stances)
	if there and meta.request.kind == "transition" and muses(state, now):
		return false
	return Markov.performs(state.model, state.seed_, meta, Wanted.mode_at(state.track, now))


# Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a thought acts are rare anyway.
static func lulls(state, now):
	var variety = state.project.settings.variety
	if state.graph.layer != "arms" or variety <= 0 or state.cues.size() == 0 or has_mused(state, now):
		return false
	var last = state.cues[-1]
	var mode = Wanted.mode_at(state.track, now)
	if now >= last.end + Director.MOST_LULL or mode == "thinking":
		return false
	var talks = mode == "talking"
	if talks and last.action.kind == "transition":  # it opens a burst
		return false
	return now < last.end + Director.find_lull(state.seed_, last.meta, talks, variety)


# Return whether the arms take or keep the stance in which the character thinks.
static func muses(state, now):
	if Wanted.mode_at(state.track, now) != "thinking" or Wanted.mode_at(state.track, now + Director.MUSES) != "thinking":
		return false
	if state.graph.layer != "arms" or state.project.settings.variety <= 0:
		return false
	return not state.track.stays_at("arms", now) and Director.musing(state.graph.stances) != ""


# Return whether a thought of the character has ended just now.
static func has_mused(state, now):
	if state.graph.layer != "arms" or Wanted.mode_at(state.track, now) == "thinking":
		return false
	return state.project.settings.variety > 0 and Wanted.mode_at(state.track, now - Director.MUSED) == "thinking"


# Return the stance that the arms go to whatever a model wrote: the one in which the character thinks, and from there home as soon
# as the thought is over; "" for none.
static func find_lead(state, now):
	if state.graph.layer != "arms" or state.project.settings.variety <= 0:
		return ""
	var thoughtful = Director.musing(state.graph.stances)
	if thoughtful == "" or state.track.stays_at("arms", now):
		return ""
	var home = state.graph.start
	var goal = ""
	if muses(state, now):
		goal = thoughtful
	elif state.stance == thoughtful and home != null and Wanted.mode_at(state.track, now) != "thinking":
		var came = state.moved()
		if came >= 0 and Wanted.mode_at(state.track, came) == "thinking":
			goal = home
	if goal == state.stance or goal == "" or Routes.find_hops(state, goal).size() == 0:
		return ""
	return goal


# Return the actions that the character may do by itself; see `director`.
static func keep_fresh(state, meta, candidates, now):
	var variety = state.project.settings.variety
	var layer = state.graph.layer
	if meta.request.kind == "transition":
		if now < state.moved() + Director.posture(layer) * variety:
			return []
		if layer == "arms" and now < state.acted + Director.LEAST_LULL * variety:
			return []
		if layer != "head":
			return Util.list(candidates)
		if state.stance == state.graph.start:
			var leaves = Choice.uniform(state.seed_, [meta.key, "leaves"]) < Director.LEAVES_HOME
			return Util.list(candidates) if leaves else []
		var home = []
		for a in candidates:
			if a.end_stance == state.graph.start:
				home.append(a)
		var returns = home.size() > 0 and Choice.uniform(state.seed_, [meta.key, "home"]) < Director.GOES_HOME
		return home if returns else Util.list(candidates)
	var share = variety if now < state.acted + Director.LONG_REST * variety else variety * Director.SHORTER
	var reminded = has_shown(state, now - Director.APART * variety)
	var converses = meta.request.kind == "fidget" and Wanted.mode_at(state.track, now) != "idle"
	var out = []
	for action in candidates:
		var shows = measure_showing(state, action)
		if (reminded or converses) and shows >= Director.STANDS_OUT:
			continue
		var needed = Director.repeat_interval(action.kind, shows, state.beats) * share
		if not state.ended.has(action.id) or now >= state.ended[action.id] + needed:
			out.append(action)
	return out


# Return the candidates for a requested fidget in a conversation without those that stand out, if others are left and no tags are
# requested; else all.
static func keep_modest(state, meta, candidates, now):
	var request = meta.request
	var every = Util.list(candidates)
	if request.kind != "fidget" or request.tags.size() > 0 or state.project.settings.variety <= 0:
		return every
	if meta.written or Wanted.mode_at(state.track, now) == "idle":
		return every
	var left = []
	for a in every:
		if measure_showing(state, a) < Director.STANDS_OUT:
			left.append(a)
	return left if left.size() > 0 else every


# Return the transitions of the arms that may play for a gesture where all gestures of the stance have played too recently, and
# others of another stance have not.
static func find_moves(state, meta, now):
	var out = []
	if state.graph.layer != "arms" or meta.request.kind != "gesture" or state.track.stays_at("arms", now):
		return out
	var variety = state.project.settings.variety
	if now < state.moved() + Director.posture("arms") * variety or now < state.acted + Director.LEAST_LULL * variety:
		return out
	for action in state.graph.of(state.stance, "transition"):
		if Routes.may_play(state, action) and count_fresh(state, action.end_stance, now) > 0:
			out.append(action)
	return out


# Return how many gestures of a stance have not played for long enough.
static func count_fresh(state, stance, now):
	if stance == null:
		return 0
	var variety = state.project.settings.variety
	var count = state.graph.of(stance, "gesture").size()
	for ident in state.ended:
		var end = state.ended[ident]
		var action = state.graph.actions.get(ident)
		if action == null or action.kind != "gesture" or action.stance != stance:
			continue
		var shows = measure_showing(state, action)
		if now < end + Director.repeat_interval("gesture", shows, state.beats) * variety:
			count -= 1
	return count


# Return whether an act that stands out was done since a time.
static func has_shown(state, since):
	for ident in state.ended:
		var end = state.ended[ident]
		var action = state.graph.actions.get(ident)
		if action == null or action.kind == "transition" or end < since:
			continue
		if measure_showing(state, action) >= Director.STANDS_OUT:
			return true
	return false


# Return how much an action stands out.
static func measure_showing(state, action):
	if not state.prominences.has(action.id):
		state.prominences[action.id] = Prominence.measure_prominence(state.project, action)
	return state.prominences[action.id]


# Return the factor by which variety changes an action's likelihood.
static func weigh_variety(state, action, now):
	var variety = state.project.settings.variety
	if variety <= 0:
		return 1.0
	if action.kind == "transition":
		var talks = state.graph.layer == "arms" and Wanted.mode_at(state.track, now) == "talking"
		return 1.0 + count_fresh(state, action.end_stance, now) if talks else 1.0
	if not state.ended.has(action.id):
		return 1.0
	var shows = measure_showing(state, action)
	var needed = Director.repeat_interval(action.kind, shows, state.beats) * variety
	return Director.freshness(now - state.ended[action.id], needed)
