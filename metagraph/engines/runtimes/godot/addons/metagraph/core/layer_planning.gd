# Extend the plan of one layer: the later part of the plan is turned back into its meta actions, merged with new requests, placed
# and performed again (Borer et al., section 6).
#
# Translated from metagraph/playback/planning/layer_planning.py; change that, and translate anew.

const MetaPlan = preload("meta_plan.gd")
const CueShapes = preload("cue_shapes.gd")
const Leaving = preload("leaving.gd")
const Markov = preload("markov.gd")
const Mood = preload("mood.gd")
const Replan = preload("replan.gd")
const Sampling = preload("sampling.gd")
const Util = preload("util.gd")
const WINDOW = 1.0  # seconds a request may use when it does not say how long


# A layer placed in time, not yet performed.
#
# able: whether the layer can perform at all. done: meta actions that were performed before. placed: those to perform, in order;
# those that a model wrote are performed as the mode says. reports: the reports so far.
class LayerDraft:
	var layer
	var state
	var able
	var done
	var placed
	var reports
	var past
	var cursor
	var written

	func _init(layer_, state_, able_, done_, placed_, reports_, past_, cursor_, written_):
		self.layer = layer_
		self.state = state_
		self.able = able_
		self.done = done_
		self.placed = placed_
		self.reports = reports_
		self.past = past_
		self.cursor = cursor_
		self.written = written_

	# Return the layer's plan with the given meta actions performed; `reports` is then complete.
	func performed(metas, end):
		var cues = []
		var rests = []
		if self.able:
			Sampling.perform_metas(self.state, metas, end)
			Sampling.vary_rests(self.state, end)
			cues = self.state.cues
			rests = self.state.rests
			Util.extend(self.reports, self.state.reports)
		var every = self.done + self.placed
		return MetaPlan.LayerPlan.new(
			self.layer,
			every,
			Util.list(cues),
			Util.list(rests),
			self.past,
			self.cursor,
			Util.list(self.written)
		)


# Return a layer's plan cut at `now`, with the requests placed again.
#
# chain: the model that writes when there are no requests, or None. kinds: the kinds of actions that the layer has. told: reports
# of the plan so far. fresh: new requests, of all layers. replaced: ids of requests that are replaced or withdrawn; stopped: those
# withdrawn, whose running action is left. stance: the stance in which the layer would begin. moods: the mood over time. track:
# what lasts, such as the mode.
static func draft(project, graph, chain, kinds, old, told, seed_, now, fresh, replaced, stopped, end, stance, moods, track):
	var layer = graph.layer
	var asked = []
	for request in fresh:
		if request.layer == layer:
			asked.append(meta_of(in_time(request, moods)))
	var kept = []
	for cue in old.cues:
		if cue.start < now:
			kept.append(cue)
	var played = {}
	for cue in kept:
		Util.add_to(played, cue.meta)
	var waiting = {}
	for cue in Util.part(old.cues, kept.size(), old.cues.size()):
		Util.add_to(waiting, cue.meta)
	# Who lies ahead may be called as what was played long ago: a request that is asked for again and again.
	var playing = {}
	for cue in kept:
		if cue.end > now:
			Util.add_to(playing, cue.meta)
	var written = []
	var cursor = old.cursor
	# What another's action has served since it began is played as that is.
	var served = {}
	for report in told:
		if report.outcome == "shared" and played.has(report.by):
			Util.add_to(served, report.request)
	var again = Util.set_of(replaced)
	if chain != null:
		var more
		var both = Markov.write(chain, seed_, end, kinds, old.cursor)
		more = both[0]
		cursor = both[1]
		for meta in old.written + more:
			if meta.start >= now:
				written.append(meta)
				Util.add_to(again, meta.request.id)
	var future = []
	var planned = {}  # again: when those of a request start
	var judged = {}  # those whose lateness is known once they are performed
	for meta in old.metas:
		if again.has(meta.request.id) or served.has(meta.request.id):
			continue
		if waiting.has(meta.key) or (meta.start >= now and not playing.has(meta.key)):
			future.append(meta)
			if meta.request.late != null:
				Util.add_to(judged, meta.request.id)
			planned[meta.request.id] = planned.get(meta.request.id, []) + [meta.start]
	# Reports about time still hold; those that are planned again report the rest.
	var done = []
	for meta2 in old.metas:
		if (not again.has(meta2.request.id)
			and not planned.get(meta2.request.id, []).has(meta2.start)
			and (playing.has(meta2.key) or meta2.start < now or served.has(meta2.request.id))):
			done.append(meta2)
	var reports = []
	for report in told:
		if (report.layer == layer
			and not again.has(report.request)
			and ((MetaPlan.TEMPORAL.has(report.outcome) and not judged.has(report.request))
				or not planned.get(report.request, []).has(report.at))):
			reports.append(report)
	var begin = _begin(graph, old, stance)
	var state = Sampling.resume_layer(project, graph, seed_, begin, old.past, kept, moods, track)
	state.model = chain
	if begin == "" or not Sampling.begin_layer(state, begin):
		var why = "the %s layer has no stance with a loop to begin in" % [layer]
		var waits = future + asked
		for meta in waits:
			if not meta.written:
				reports.append(MetaPlan.Report.new(meta.request.id, "no-stance", why, layer, meta.start))
		return LayerDraft.new(layer, state, false, done, waits, reports, old.past, cursor, written)
	state.begun = _begun(old, kept.size())
	if kept.size() > 0 and kept[-1].end > now:
		var first = null
		for meta3 in old.metas:
			if meta3.key == kept[-1].meta:
				first = meta3
				break
		var running = first
		var leaves = _leaves(running, stopped, track, now)
		Leaving.make_way(state, running, asked, now, leaves)
	if old.rests.size() > 0 and now > 0:
		var begun = {}
		for cue in state.cues:
			Util.add_to(begun, cue.end - cue.blend_out)
		var found = []
		for rest in old.rests:
			if rest.fade_start < now or begun.has(rest.start):
				found.append(rest)
		state.rests = found
	state.free_ = Util.most(now - (state.ready() - state.free_), state.free_)
	var delayed
	var both2 = Replan.delay(asked, state.ready(), project.settings)
	asked = both2[0]
	delayed = both2[1]
	var busy = -INF  # what runs keeps the time it was wanted for, from the models
	for meta in done:
		if not meta.written:
			busy = Util.most(busy, meta.end)
	var both3 = Replan.replan(future + written + asked, project.settings, busy)
	var placed = both3[0]
	var moved = both3[1]
	var every = reports + delayed + moved
	return LayerDraft.new(layer, state, true, done, placed, every, old.past, cursor, written)


# Return whether the running action is left: it was stopped, or it is a gesture of the character's own and what it said was broken
# off.
static func _leaves(running, stopped, track, now):
	if running == null:
		return false
	var own = running.written and running.request.kind == "gesture"
	return stopped.has(running.request.id) or (own and track.hushed_at(now))


# Return the key of the meta action whose chain of transitions plays where the first cues are kept; none if none does. An earlier
# action may have had the same key, so that only the last cue can be of a chain.
static func _begun(old, kept):
	var out = {}
	if 0 < kept and kept < old.cues.size():
		var last = old.cues[kept - 1]
		var following = old.cues[kept]
		if last.meta == following.meta and following.start <= last.end:
			Util.add_to(out, last.meta)
	return out


# Return a request that may begin earlier, by the extra time that its preparation takes in its mood.
static func in_time(request, moods):
	if request.stroke == null:
		return request
	var mood = Mood.mood_at(moods, request.stroke)
	var speed = Mood.tempo(Mood.changed(mood, request.valence, request.arousal, request.intensity))
	if speed >= 1:
		return request
	return MetaPlan.MetaRequest.new(
		request.id,
		request.layer,
		request.kind,
		Util.most(0.0, request.stroke - (request.stroke - request.start) / speed),
		request.duration,
		request.action,
		request.tags,
		request.limb,
		request.stance,
		request.priority,
		request.resume,
		request.stroke,
		request.hold,
		request.prepare,
		request.among,
		request.late,
		request.valence,
		request.arousal,
		request.intensity
	)


# Return a request as a meta action with the window it may use; if its stroke is judged, with the moment of the stroke.
static func meta_of(request):
	if request.late != null and request.stroke != null:
		return MetaPlan.MetaAction.new(request, request.stroke, request.stroke + CueShapes.FITS)
	var length = WINDOW if request.duration == null else Util.most(0.0, request.duration)
	if request.stroke != null:
		length = Util.most(length, request.stroke - request.start + CueShapes.FITS)
	return MetaPlan.MetaAction.new(request, request.start, request.start + length)


# Return the stance in which a layer begins: that of the plan before, the given one, the graph's start, or the first that has a
# loop; "" for none.
static func _begin(graph, old, stance):
	var wishes = [old.past.stance]
	if old.rests.size() > 0:
		wishes.append(old.rests[0].stance)
	if stance != null:
		wishes.append(stance)
	if graph.start != null:
		wishes.append(graph.start)
	Util.extend(wishes, graph.stances.keys())
	for wish in wishes:
		if graph.stances.has(wish) and graph.of(wish, "stance").size() > 0:
			return wish
	return ""
