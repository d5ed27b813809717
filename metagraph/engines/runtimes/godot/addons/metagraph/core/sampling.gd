# From a meta plan to specific actions: candidates, the three temporal cases, cues and rests (Borer et al., section 6.2).
#
# Translated from metagraph/playback/planning/sampling.py; change that, and translate anew.

const Repeating = preload("repeating.gd")
const MetaPlan = preload("meta_plan.gd")
const Bounds = preload("bounds.gd")
const CueShapes = preload("cue_shapes.gd")
const Directing = preload("directing.gd")
const Director = preload("director.gd")
const Drawing = preload("drawing.gd")
const LayerState = preload("layer_state.gd")
const Manner = preload("manner.gd")
const Punctuality = preload("punctuality.gd")
const Routes = preload("routes.gd")
const Steps = preload("steps.gd")
const PhaseTimes = preload("phase_times.gd")
const Util = preload("util.gd")
const ON_TIME = 0.1  # seconds by which a request may begin later and still be on time
const LOOP_FADE = 0.6  # seconds of crossfade when a long rest changes from one loop of its stance to another


# Return the layer as it is after a past and the cues that played since.
static func resume_layer(project, graph, seed_, begin, past, cues, moods, track):
	var stance = past.stance if graph.stances.has(past.stance) else begin
	var out = LayerState.LayerState.new(
		project,
		graph,
		seed_,
		stance,
		moods,
		track,
		past.free_,
		past.free_,
		past.uses.duplicate(),
		past.recent.duplicate(),
		past.ended.duplicate()
	)
	var found = []
	for a in graph.actions.values():
		if a.kind == "gesture":
			found.append(a)
	out.beats = Director.beat_interval(graph.layer, found.size())
	for cue in cues:
		out.note(cue, cue.then if graph.stances.has(cue.then) else begin)
	return out


# Lay the first loop down; return whether the layer can perform at all.
static func begin_layer(state, stance):
	var loop = Routes.draw_loop(state, stance, "rest/%s" % [state.graph.layer])
	if loop == null:
		return false
	state.rests.append(MetaPlan.Rest.new(stance, loop, 0.0, 0.0, 0.0))
	return true


# Realise in order those meta actions of a conflict-free meta plan that start before `end`.
static func perform_metas(state, metas, end):
	var performed = []
	for m in metas:
		if not m.written or Directing.performs_written(state, m, m.start):
			performed.append(m)
	for bound in Bounds.bounds(performed):
		var meta = bound.meta
		if Bounds.begins(meta) >= end:
			continue
		if state.served.size() > 0 and state.served.has(meta.key):
			continue
		if meta.request.late != null:
			_realise(state, bound, Util.most(state.ready(), Bounds.begins(meta)))
			continue
		var ready = state.ready()
		if meta.start < ready and not state.begun.has(meta.key):
			var running = "the running action"
			if state.cues.size() > 0:
				running = "'%s'" % [state.cues[-1].action.name]
			var waits = ready - meta.start
			if meta.end <= ready + CueShapes.FITS:
				waits = ready - meta.request.start
				# What is wanted for a certain time is over; what is wanted once may come late.
				var wanted = meta.written or meta.request.duration != null
				if wanted or waits > state.project.settings.wait:
					var why = "wholly covered by %s, which plays until %.2f s" % [running, state.free_]
					state.tell(meta, "covered", why)
					continue
			# What a model wrote is wanted at no certain time.
			if not meta.written and waits > ON_TIME:
				state.tell(meta, "queued", "waits %.2f s for %s" % [waits, running], true)
		_realise(state, bound, Util.most(ready, meta.start))


static func _realise(state, bound, now):
	var meta = bound.meta
	if meta.written and not state.begun.has(meta.key) and not Directing.may_begin(state, meta, now):
		return
	var steps = Steps.choose_steps(state, meta, now)
	if steps == null:
		return
	var cues = []
	var stance = state.stance
	for step in steps:
		var hops = step.hop != ""
		var asked = null if hops else CueShapes.remaining(meta, now)
		var mood = Manner.find_mood(state, asked, now)
		var fitting = _fit(state, bound, step, asked, now, mood)
		if fitting.size() == 0:
			return
		# On the way to a stance it counts when that begins.
		if meta.request.late != null and (not hops or (cues.size() == 0 and steps[steps.size() - 1].hop != "")):
			fitting = Punctuality.keep_timely(state, bound, fitting, now)
			if fitting.size() == 0:
				return
		var action = Drawing.draw_action(state, fitting, "%s/%s" % [meta.key, step.hop] if hops else meta.key, now, mood)
		var shape = Manner.shape_in_mood(state, action, asked, now, mood)
		var cue = _cue(state, action, shape, bound, hops, stance, mood)
		cues.append(cue)
		now = cue.end
		stance = cue.then
	for one in cues:
		_keep(state, one)


# Return the candidates of a step that are over in time and have cooled down. If none, tell why.
static func _fit(state, bound, step, asked, now, mood):
	var meta = bound.meta
	var fitting = Util.list(step.candidates)
	if bound.limit < INF:  # else all fit
		var found = []
		for a in step.candidates:
			if CueShapes.fits_before(Manner.shape_in_mood(state, a, asked, now, mood), bound.limit):
				found.append(a)
		fitting = found
	if fitting.size() == 0:
		var before = "" if meta.written else " before something more important"
		var left = Util.most(0.0, bound.limit - now)
		state.tell(meta, "no-room", "nothing fits into the %.2f s%s" % [left, before])
		return fitting
	if step.hop != "" or meta.request.action != null:
		return fitting
	var warm = []
	for a in fitting:
		if (a.cooldown <= 0
			or Drawing.find_cooled(state, a) <= Manner.shape_in_mood(state, a, asked, now, mood).start + CueShapes.FITS):
			warm.append(a)
	if warm.size() == 0:
		var found2 = []
		for a in fitting:
			found2.append(Drawing.find_cooled(state, a))
		var soonest = Util.least_of(found2)
		var why = "all that fit are cooling down; the first may play again at %.2f s" % [soonest]
		state.tell(meta, "cooling", why)
	return warm


# hops: whether it is a transition on the way to the requested action.
static func _cue(state, action, shape, bound, hops, stance, mood):
	var length = shape.length
	var into = Util.most(0.0, action.timing.blend_in)
	var out = Util.most(0.0, action.timing.blend_out)
	var both = state.project.span(action)
	var begin = both[0]
	var until = both[1]
	var cycle = Repeating.cycle_of(action.kind, action.timing, begin, until)
	if action.timing.earliest_exit != null or cycle > 0:
		var wish = INF if hops else bound.wish
		length = Util.least(length, Util.most(shape.shortest, Util.least(bound.limit, wish) - shape.start))
	elif not hops:
		length = Util.least(length, Punctuality.find_until(state, action, shape, bound) - shape.start)
		if length < shape.length:
			out = Util.most(out, CueShapes.RETRACTION)
	if shape.entry > begin:
		into = Util.most(into, PhaseTimes.LEAST_BLEND)
	var squeeze = Util.least(1.0, length / (into + out)) if into + out > 0 else 1.0
	var then = stance
	if action.kind == "transition" and action.end_stance != null:
		then = action.end_stance
	var end = shape.start + length
	return MetaPlan.Cue.new(
		action,
		shape.start,
		end,
		shape.entry,
		into * squeeze,
		out * squeeze,
		stance,
		then,
		bound.meta.key,
		shape.hold_from,
		shape.hold_to,
		shape.hold,
		Manner.find_extent(state, action, mood),
		shape.tempo,
		begin if cycle > 0 else 0.0,
		begin + cycle if cycle > 0 else 0.0
	)


static func _keep(state, cue):
	state.note(cue, cue.then)
	var loop = Routes.draw_loop(state, cue.then, cue.meta)
	if loop != null:
		# The loop begins again under the action, so that the action's last pose meets the loop's first.
		# On joints that the action does not move, the change shows. It takes its time there, like a
		# transition.
		var partial = cue.action.limb != "both" or cue.action.joints.size() > 0 or cue.action.joint_weights.size() > 0
		var begin = cue.start + cue.blend_in
		var until = cue.end - cue.blend_out
		var fade = Util.most(0.0, until - begin)
		if partial:
			fade = cue.end - cue.start if cue.then != cue.stance else Util.least(LOOP_FADE, cue.end - cue.start)
			begin = Util.most(cue.start, until - fade)
		state.rests.append(MetaPlan.Rest.new(cue.then, loop, until, begin, fade))


# Change between the loops of a stance in long rests, at the end of a loop.
static func vary_rests(state, end):
	var out = []
	for place in range(state.rests.size()):
		var rest = state.rests[place]
		out.append(rest)
		var loops = state.graph.of(rest.stance, "stance")
		if loops.size() < 2:
			continue
		var until = state.rests[place + 1].fade_start if place + 1 < state.rests.size() else end
		var current = rest
		var change = rest.start
		while true:
			var both = state.project.span(current.action)
			var start = both[0]
			var stop = both[1]
			change += Util.most(1.0, stop - start - current.action.timing.blend_in)
			if not (change <= until):  # nor when it is no number
				break
			var loop = Routes.draw_loop(state, rest.stance, "%s/%s" % [state.graph.layer, Util.thousandths(change)])
			if loop != null and loop.id != current.action.id:
				current = MetaPlan.Rest.new(rest.stance, loop, change, change - LOOP_FADE, LOOP_FADE)
				out.append(current)
	state.rests = out
