# The planner: requests at any level in, a plan of specific actions out. Meta actions -> temporal replanning -> sampling, layer by
# layer. Planning from nothing and extending a running plan are the same function.
#
# A plan is {seed32, end, layers {layer: layer plan}, reports, requests, track: what was asked of the life layers, life: what they
# do, gaze: of that, made when first looked at}; layer plans are those of meta_plan.gd. Seconds throughout.

const Util = preload("util.gd")
const Wanted = preload("wanted.gd")
const MetaPlan = preload("meta_plan.gd")
const LayerPlanning = preload("layer_planning.gd")
const Remembering = preload("remembering.gd")
const Track = preload("track.gd")
const Schedule = preload("schedule.gd")


# Returns the plan of nothing yet.
static func empty_plan(seed32):
	var layers = {}
	for layer in Util.LAYERS:
		layers[layer] = MetaPlan.LayerPlan.new(layer)
	return {
		seed32 = seed32, end = 0.0, layers = layers, reports = [], requests = [], track = Track.Track.new(),
		life = Schedule.Schedule.new(), gaze = {}
	}


# Returns the plan with new requests worked in, others withdrawn {id: true}, and the horizon moved to `end`. What starts before
# `now` stays exactly as it was. leave: layers that are planned to `end` already and that nothing new concerns. stopped: those
# withdrawn whose running action is left, too.
static func extend_plan(graph, plan, now, requests, end, stances, idle, withdrawn, leave, stopped = {}):
	var latest = {}  # of two with one id the later counts, in the place of the first
	for request in requests:
		latest[request.id] = request
	var fresh = latest.values()
	var again = withdrawn.duplicate()
	for request in fresh:
		again[request.id] = true
	var layers = {}
	var reports = []
	var moods = Wanted.moods_of(graph.life, plan.track)
	for layer in Util.LAYERS:
		if leave.has(layer):
			layers[layer] = plan.layers[layer]
			for report in plan.reports:
				if report.layer == layer and not again.has(report.request):
					reports.append(report)
			continue
		var of = graph.layers[layer]
		var drafted = LayerPlanning.draft(
			graph, of, of.markov if idle else null, of.kinds, plan.layers[layer], plan.reports, plan.seed32, now, fresh, again, stopped, end,
			stances.get(layer), moods, plan.track
		)
		layers[layer] = drafted.performed(drafted.placed, end)
		reports += drafted.reports
	var kept = []
	for request in plan.requests:
		if not again.has(request.id):
			kept.append(request)
	return {
		seed32 = plan.seed32, end = end, layers = layers, reports = Util.by(reports, "at"), requests = kept + fresh, track = plan.track,
		gaze = plan.gaze, life = Schedule.schedule(graph.life, plan.track, graph, plan.seed32, end, plan.life, now)
	}


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
	changes.track = plan.track.since(seconds)
	changes.life = plan.life.since(seconds)
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
		var last = plan.cues[gone - 1]
		past = MetaPlan.Past.new(last.end, last.then, past.uses.duplicate(), past.recent.duplicate(), past.ended.duplicate())
		for n in range(gone):
			Remembering.remember(plan.cues[n], past.uses, past.recent, past.ended)
	var rests = Util.part(plan.rests, first, plan.rests.size())
	return MetaPlan.LayerPlan.new(plan.layer, metas, cues, rests, past, plan.cursor, plan.written)
