# How an action would play, and the cue it then is.
#
# A shape is {start, entry: clip second it begins with, length, shortest: seconds, hold_from, hold_to, hold: as in a cue}.

const Util = preload("util.gd")


# Returns how an action would play for a request from `now` on, or (null) as a step on the way to it.
static func shape_of(action, request, now, settings):
	var begin = now
	var entry = action.start
	var hold_from = 0.0
	var hold_to = 0.0
	var hold = 0.0
	var special = request != null and (request.hold != null or request.stroke != null or not request.prepare)
	if special and action.kind == "gesture":
		var phases = action.phases  # ready, stroke, stroke end, relax
		var latest = Util.most(action.start, phases[0] - Util.most(action.blend_in, settings.least_blend))
		entry = action.start if request.prepare else latest
		if request.stroke != null:  # wait for the stroke, or catch up with it by cutting the preparation
			begin = Util.most(now, request.stroke - (phases[1] - entry))
			entry = Util.least(Util.most(entry, phases[1] - Util.most(0.0, request.stroke - begin)), Util.most(entry, latest))
		if request.hold != null:
			hold_from = phases[2]
			hold_to = phases[3]
			hold = Util.most(request.hold, (hold_to - hold_from) / settings.hurry)
			if hold <= 0:
				hold_from = 0.0
				hold_to = 0.0
	var length = action.end - entry + hold - (hold_to - hold_from)
	var shortest = length
	if action.earliest_exit != null:
		var left = action.earliest_exit - entry + (hold - (hold_to - hold_from) if action.earliest_exit >= hold_to else 0.0)
		shortest = Util.least(length, Util.most(0.0, left) + action.blend_out)
	return {
		start = begin, entry = entry, length = length, shortest = shortest, hold_from = hold_from, hold_to = hold_to, hold = hold
	}


# Returns the cue of an action and its shape. limit, wish: when the next more important one begins, and the next as important that was
# asked for; an action that may be left early is left for them. before: the stance it begins in.
static func cue_of(action, shape, limit, wish, before, meta, settings):
	var length = shape.length
	if action.earliest_exit != null:
		length = Util.least(length, Util.most(shape.shortest, Util.least(limit, wish) - shape.start))
	var into = action.blend_in
	if shape.entry > action.start:
		into = Util.most(into, settings.least_blend)
	var whole = into + action.blend_out
	var squeeze = Util.least(1.0, length / whole) if whole > 0 else 1.0
	var then = action.end_stance if action.kind == "transition" and action.end_stance != null else before
	return {
		action = action, start = shape.start, end = shape.start + length, entry = shape.entry, blend_in = into * squeeze,
		blend_out = action.blend_out * squeeze, stance = before, then = then, meta = meta,
		hold_from = shape.hold_from, hold_to = shape.hold_to, hold = shape.hold
	}
