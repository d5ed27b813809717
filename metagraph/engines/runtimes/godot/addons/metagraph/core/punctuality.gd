# Which actions meet the moment that a request names, and when an action has to be over for the next one.
#
# Translated from metagraph/playback/planning/punctuality.py; change that, and translate anew.

const Bounds = preload("bounds.gd")
const CueShapes = preload("cue_shapes.gd")
const Manner = preload("manner.gd")
const Mood = preload("mood.gd")
const Routes = preload("routes.gd")
const Phases = preload("phases.gd")
const Util = preload("util.gd")


# Return the candidates that come least late, if that is not too late; among them those that leave the following requests the most
# time and serve the most of them.
static func keep_timely(state, bound, fitting, now):
	var meta = bound.meta
	var request = meta.request
	var allowed = CueShapes.slack_of(request)
	var mood = Manner.find_mood(state, request, now)
	var late = {}
	for a in fitting:
		late[a.id] = CueShapes.lateness(state.project, a, request, Manner.shape_in_mood(state, a, request, now, mood))
	var found = []
	for a in fitting:
		found.append(late[a.id])
	var least = Util.least_of(found)
	var waits
	if least > allowed + CueShapes.FITS:
		waits = tell_cause(state, request, now)
		state.tell(
			meta,
			"too-late",
			"would come %.2f s late, %.2f s are allowed; it waits for %s" % [least, allowed, waits],
			false,
			least
		)
		return []
	if least > CueShapes.FITS:
		waits = tell_cause(state, request, now)
		state.tell(meta, "late", "comes %.2f s late; it waits for %s" % [least, waits], true, least)
	var timely = []
	for a in fitting:
		if late[a.id] <= Util.most(least, 0.0) + CueShapes.FITS:
			timely.append(a)
	for other in bound.after:
		if not CueShapes.may_share(request, other.request):
			continue
		var both = []
		for a in timely:
			if CueShapes.meets(a, other.request):
				both.append(a)
		var behind = 0.0
		if request.stroke != null and other.request.stroke != null:
			behind = Util.most(0.0, request.stroke + Util.most(least, 0.0) - other.request.stroke)
		if both.size() > 0 and other.request.late != null and behind <= other.request.late + CueShapes.FITS:
			timely = both
			Util.add_to(state.served, other.key)
			var message = "shares the stroke of '%s'" % [request.id]
			state.tell(other, "shared", message, true, behind, meta.key)
	var following = []
	for other2 in bound.after:
		if not state.served.has(other2.key):
			following.append(other2)
	for other in following:
		for slack in [0.0, CueShapes.slack_of(other.request)]:
			var by = find_latest(state, other.request) + slack
			var over = []
			for a in timely:
				if find_over(state, a, request, now) <= by:
					over.append(a)
			if over.size() > 0:
				return over
	return timely


# Return the reason why a request comes late.
static func tell_cause(state, request, now):
	if now <= request.start + CueShapes.FITS:
		return "its own preparation"
	if (state.cues.size() > 0 and state.ready() >= now - CueShapes.FITS and state.cues[-1].end >= state.free_ - CueShapes.FITS):
		return "'%s', which plays until %.2f s" % [state.cues[-1].action.name, state.free_]
	return "what comes before it" if state.cues.size() > 0 else "the time it became known at"


# Return the latest time at which a requested action has to begin to be on time; never in the past.
static func find_latest(state, request):
	if request.stroke == null:
		return request.start
	var least = INF
	for action in state.graph.of(state.stance, request.kind):
		var fits = CueShapes.meets(action, request)
		if request.action != null:
			fits = action.id == request.action
		if not fits or not Routes.may_play(state, action):
			continue
		if action.kind != "gesture":  # it has no stroke: it should begin when its request does
			least = Util.least(least, request.stroke - request.start)
		else:
			var found = Phases.find_phases(state.project, action)
			var lead = found.stroke - found.skip(action.timing.blend_in)
			var speed = Manner.find_tempo(action, Manner.find_mood(state, request, request.stroke))
			least = Util.least(least, lead + Mood.drag(lead, speed))
	return request.stroke - least


# Return the earliest time at which the next action could begin after this one.
static func find_over(state, action, request, now):
	var shape = Manner.shape_in_mood(state, action, request, now, Manner.find_mood(state, request, now))
	return shape.start + CueShapes.hurried(state.project, action, shape) + state.project.settings.rest - CueShapes.FITS


# Return when an action that should play to its end is left early all the same: early enough for the first following request that
# can then be in time, late enough for its own stroke; infinity for never.
static func find_until(state, action, shape, bound):
	if bound.after.size() == 0:
		return INF
	var rest = state.project.settings.rest
	var soonest = shape.start + CueShapes.hurried(state.project, action, shape)
	for other in bound.after:
		var in_time = find_latest(state, other.request) + CueShapes.slack_of(other.request)
		if not state.served.has(other.key) and soonest + rest <= in_time + CueShapes.FITS:
			return Util.most(soonest, Bounds.begins(other) - rest)
	return INF
