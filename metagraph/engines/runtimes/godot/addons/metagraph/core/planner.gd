# The planner: requests at any level in, a plan of specific actions out. Meta actions -> temporal replanning -> sampling, layer by
# layer. Planning from nothing and extending a running plan are the same function.
#
# A plan is {seed32, end, layers {layer: layer plan}, reports, requests, track: what was asked of the life layers, life: what they
# do}; a layer plan {layer, metas, cues, rests, past, cursor, written}, with past: what planning on needs of cues that were forgotten,
# and written: what the model wrote for later, as it wrote it. Seconds throughout.

const Util = preload("util.gd")
const Markov = preload("markov.gd")
const MetaPlan = preload("meta_plan.gd")
const Replan = preload("replan.gd")
const Pick = preload("pick.gd")
const Track = preload("track.gd")
const Schedule = preload("schedule.gd")
const TEMPORAL = ["late", "cut", "resumed", "past"]  # outcomes told by temporal replanning, once


# Returns the plan of nothing yet.
static func empty_plan(seed32):
	var layers = {}
	for layer in Util.LAYERS:
		var past = {free = 0.0, stance = "", uses = {}, recent = {}, ended = {}}
		layers[layer] = {layer = layer, metas = [], cues = [], rests = [], past = past, cursor = Markov.BEGIN(), written = []}
	return {
		seed32 = seed32, end = 0.0, layers = layers, reports = [], requests = [], track = Track.empty_track(), life = Schedule.empty_life()
	}


# Returns the plan with new requests worked in, others withdrawn {id: true}, and the horizon moved to `end`. What starts before
# `now` stays exactly as it was. leave: layers that are planned to `end` already and that nothing new concerns.
static func extend_plan(graph, plan, now, requests, end, stances, idle, withdrawn, leave):
	var latest = {}  # of two with one id the later counts, in the place of the first
	for request in requests:
		latest[request.id] = request
	var fresh = latest.values()
	var again = withdrawn.duplicate()
	for request in fresh:
		again[request.id] = true
	var layers = {}
	var reports = []
	for layer in Util.LAYERS:
		if leave.has(layer):
			layers[layer] = plan.layers[layer]
			for report in plan.reports:
				if report.layer == layer and not again.has(report.request):
					reports.append(report)
			continue
		var asked = []
		for request in fresh:
			if request.layer == layer:
				asked.append(_meta(request, graph.settings))
		var begin = _begin(graph, plan.layers[layer], layer, stances.get(layer))
		var found = _extend_layer(graph, plan, layer, now, asked, again, end, begin, idle)
		layers[layer] = found[0]
		reports += found[1]
	var kept = []
	for request in plan.requests:
		if not again.has(request.id):
			kept.append(request)
	return {
		seed32 = plan.seed32, end = end, layers = layers, reports = Util.by(reports, "at"), requests = kept + fresh, track = plan.track,
		life = Schedule.schedule(graph, plan.track, plan.seed32, end, plan.life, now)
	}


static func _meta(request, settings):
	var length = settings.window if request.duration == null else Util.most(0.0, request.duration)
	if request.stroke != null:
		length = Util.most(length, request.stroke - request.start + Pick.FITS)
	return MetaPlan.MetaAction.new(request, request.start, request.start + length)


# Returns [a layer's plan, its reports, old and new]. again {id: true}: requests that replace what was asked before.
static func _extend_layer(graph, plan, layer, now, asked, again, end, begin, idle):
	var old = plan.layers[layer]
	var kept = []
	var played = {}
	var waiting = {}  # also those whose chain of transitions has begun
	for cue in old.cues:
		if cue.start < now:
			kept.append(cue)
			played[cue.meta] = true
		else:
			waiting[cue.meta] = true
	var written = []
	var cursor = old.cursor
	again = again.duplicate()
	if idle:
		var more = Markov.write(graph.layers[layer].markov, plan.seed32, end, graph.layers[layer].kinds, old.cursor)
		cursor = more[1]
		for meta in old.written + more[0]:
			if meta.start >= now:
				written.append(meta)
				again[meta.request.id] = true
	var future = []
	var planned_again = {}  # request -> starts
	for meta in old.metas:
		if again.has(meta.request.id):
			continue
		if waiting.has(meta.key) or (meta.start >= now and not played.has(meta.key)):
			future.append(meta)
			planned_again[meta.request.id] = planned_again.get(meta.request.id, []) + [meta.start]
	# What was told about time still holds; the rest will be told again by those that are planned again.
	var done = []
	for meta in old.metas:
		if again.has(meta.request.id) or planned_again.get(meta.request.id, []).has(meta.start):
			continue
		if played.has(meta.key) or meta.start < now:
			done.append(meta)
	var reports = []
	for report in plan.reports:
		if report.layer == layer and not again.has(report.request):
			if TEMPORAL.has(report.outcome) or not planned_again.get(report.request, []).has(report.at):
				reports.append(report)
	var performer = Pick.new(graph, layer, plan.seed32, "" if begin == null else begin, old.past, kept)
	if begin == null or not performer.begin_in(begin):
		for meta in future + asked:
			if not meta.written:
				var why = "the %s layer has no stance with a loop to begin in" % layer
				reports.append(MetaPlan.Report.new(meta.request.id, "no-stance", why, layer, meta.start))
		return [{
			layer = layer, metas = done + future + asked, cues = [], rests = [], past = old.past, cursor = cursor, written = written
		}, reports]
	if old.rests.size() > 0 and now > 0:
		var ends = {}
		for cue in kept:
			ends[cue.end - cue.blend_out] = true
		performer.rests = []
		for rest in old.rests:
			if rest.fade_start < now or ends.has(rest.start):
				performer.rests.append(rest)
	for key in played:
		if waiting.has(key):
			performer.begun[key] = true
	performer.clear_from = Util.most(now - (performer.ready() - performer.clear_from), performer.clear_from)
	var delayed = Replan.delay(asked, performer.ready(), graph.settings)
	var busy = -INF  # what runs keeps the time it was wanted for, from the models
	for meta in done:
		if not meta.written:
			busy = Util.most(busy, meta.end)
	var placed = Replan.replan(future + written + delayed[0], graph.settings, busy)
	var metas = []
	for meta in placed[0]:
		var leaves = meta.request.kind == "transition" and Track.stays_at(plan.track, layer, meta.start)
		var mode = Track.told_mode(plan.track, meta.start)
		if not meta.written or (not leaves and Markov.performs(graph.layers[layer].markov, plan.seed32, meta, mode)):
			metas.append(meta)
	performer.perform(metas, end)
	performer.vary_rests(end)
	return [{
		layer = layer, metas = done + placed[0], cues = performer.cues, rests = performer.rests, past = old.past, cursor = cursor,
		written = written
	}, reports + delayed[1] + placed[1] + performer.reports]


# Returns the stance a layer begins in: as it did before, as asked, the graph's start, or the first that has a loop; null for none.
static func _begin(graph, old, layer, stance):
	var of = graph.layers[layer]
	var wishes = [old.past.stance, old.rests[0].stance if old.rests.size() > 0 else null, stance, of.start] + of.stances.keys()
	for wish in wishes:
		if wish != null and of.stances.has(wish) and graph.of(of, wish, "stance").size() > 0:
			return wish
	return null


# Returns a running plan without what ended before `seconds`; what is planned on from it stays as it would have been.
static func since(plan, seconds):
	var layers = {}
	var known = {}
	for layer in plan.layers:
		layers[layer] = _since(plan.layers[layer], seconds)
		for meta in layers[layer].metas:
			known[meta.request.id] = true
	var reports = []
	for report in plan.reports:
		if report.at >= seconds:
			reports.append(report)
	var requests = []
	for request in plan.requests:
		if request.start >= seconds or known.has(request.id):
			requests.append(request)
	var changes = {layers = layers, reports = reports, requests = requests}
	changes.track = Track.since(plan.track, seconds)
	changes.life = Schedule.since(plan.life, seconds)
	return Util.but(plan, changes)


static func _since(plan, seconds):
	var gone = plan.cues.size()
	for n in range(plan.cues.size()):
		if plan.cues[n].end >= seconds:
			gone = n
			break
	var cues = Util.part(plan.cues, gone, plan.cues.size())
	var played = {}
	for cue in cues:
		played[cue.meta] = true
	var metas = []
	for meta in plan.metas:
		if meta.end >= seconds or played.has(meta.key):
			metas.append(meta)
	var first = 0
	for n in range(plan.rests.size()):
		if plan.rests[n].fade_start + plan.rests[n].fade <= seconds:
			first = n
	var past = plan.past
	if gone > 0:
		past = {
			free = plan.cues[gone - 1].end, stance = plan.cues[gone - 1].then, uses = past.uses.duplicate(),
			recent = past.recent.duplicate(), ended = past.ended.duplicate()
		}
		for n in range(gone):
			Pick.remember(plan.cues[n], past.uses, past.recent, past.ended)
	return Util.but(plan, {metas = metas, cues = cues, rests = Util.part(plan.rests, first, plan.rests.size()), past = past})
