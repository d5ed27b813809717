# Performing what is asked while it comes in, and saying what became of it.

const Util = preload("util.gd")
const Planner = preload("planner.gd")
const Track = preload("track.gd")
const Understand = preload("understand.gd")
const WORDS = {looks = "look", speeches = "speech", modes = "mode", places = "place", blinks = "blink"}


# Returns the plan with asks worked in that became known at `now`, and the horizon moved to `end`. What begins before now + the
# settings' lookahead stays as it was, but at the very beginning, when nothing has been shown. Asks are as Asks.read returns them
# and have ids; of two with one id the later counts.
static func hear(graph, plan, now, asks, end, stances, idle):
	var fixed = now + graph.settings.lookahead if now > 0 else 0.0
	var meant = Understand.understand(graph, asks, fixed)
	var gone = meant.withdrawn.duplicate()
	for each in meant.requests + meant.items:
		gone[each.id] = true
	for report in meant.refused:
		gone[report.request] = true
	var withdrawn = {}
	for each in plan.requests + Track.items(plan.track):
		if meant.withdrawn.has(""):
			withdrawn[each.id] = true
			continue
		for owner in owners(each.id):
			if gone.has(owner):
				withdrawn[each.id] = true
	var staying = {}
	for stay in plan.track.stays + meant.items:
		if stay.list == "stays" and stay.on:
			staying[stay.layer] = true
	var items = []
	for item in meant.items:
		if item.list != "stays" or staying.has(item.layer):
			items.append(item)
	var touched = {}
	for request in meant.requests:
		touched[request.layer] = true
	for request in plan.requests:
		if withdrawn.has(request.id):
			touched[request.layer] = true
	for stay in plan.track.stays + items:
		if stay.list == "stays" and (gone.has(stay.id) or withdrawn.has(stay.id)):
			touched[stay.layer] = true
	for item in items + Track.items(plan.track):
		if (item.list == "modes" or item.list == "speeches") and (gone.has(item.id) or withdrawn.has(item.id)):
			for layer in Util.LAYERS:  # who talks moves otherwise than who listens
				if graph.layers[layer].markov.modes.size() > 0:
					touched[layer] = true
	var leave = []
	if asks.size() > 0 and now > 0 and end == plan.end:
		for layer in Util.LAYERS:
			if not touched.has(layer):
				leave.append(layer)
	var going_on = []
	var begun = {}  # of which more is said
	var ended = withdrawn.duplicate()
	for item in items:
		var on = Track.going_on(plan.track, item, fixed)
		going_on.append(on)
		if on != item:
			begun[item.id] = true
			ended.erase(item.id)
	var track = Track.plus(Track.without(Track.without(plan.track, ended, fixed), begun, -INF), going_on)
	plan = Util.but(plan, {track = track})
	var after = Planner.extend_plan(graph, plan, fixed, meant.requests, end, stances, idle, withdrawn, leave)
	after.reports += meant.refused
	return after


# Returns the asks a request may have been made by: that of its own id, and those of which it would be a part.
static func owners(ident):
	var out = [ident]
	while true:
		var dot = ident.rfind(".")
		if dot < 0 or dot == ident.length() - 1:
			return out
		for n in range(dot + 1, ident.length()):
			if "0123456789".find(ident[n]) < 0:
				return out
		ident = ident.substr(0, dot)
		out.append(ident)


# Says what a plan does about an ask: {id, state: planned, late, done or refused, at, until: seconds or null, what: words, why}.
static func answer(plan, ident):
	return answers(plan, [ident])[ident]


# Says what a plan does about each of many asks, {id: answer}, in time that grows with the plan alone.
static func answers(plan, idents):
	var found = {}
	for ident in idents:
		found[ident] = {starts = [], ends = [], what = [], waiting = [], why = [], late = false, there = false, all_played = true}
	var served = {}  # by the key of what serves them
	for report in plan.reports:
		if report.by != "":
			served[report.by] = served.get(report.by, []) + [report.request]
	for layer in plan.layers:
		for cue in plan.layers[layer].cues:
			for made in [cue.meta.split("+")[0]] + served.get(cue.meta, []):
				for each in _of(found, made):
					_plays(each, cue.start, cue.end, cue.action.name)
		for meta in plan.layers[layer].metas:
			if meta.start >= plan.end:
				for each in _of(found, meta.request.id):
					each.waiting.append(meta.start)
	for item in Track.items(plan.track):
		if item.list != "stays":
			for each in _of(found, item.id):
				_plays(each, item.start, item.get("end", item.start), WORDS[item.list])
	for report in plan.reports:
		for each in _of(found, report.request):
			if not each.why.has(report.message):
				each.why.append(report.message)
			each.late = each.late or ["late", "queued", "resumed"].has(report.outcome)
			each.there = each.there or report.outcome == "already-there"
			each.all_played = each.all_played and report.played
	var out = {}
	for ident in found:
		out[ident] = _answer(ident, found[ident])
	return out


# Returns what was found so far of the asks that something in the plan belongs to.
static func _of(found, made):
	var out = []
	for owner in owners(made):
		if found.has(owner):
			out.append(found[owner])
	return out


static func _plays(each, start, end, word):
	each.starts.append(start)
	each.ends.append(end)
	each.what.append(word)


static func _answer(ident, found):
	var told = found.why.size() > 0
	var why = ""
	for message in found.why:
		why += message if why == "" else "; " + message
	var out = {id = ident, state = "refused", at = null, until = null, what = found.what, why = why}
	if found.starts.size() > 0:
		out.state = "late" if found.late else "planned"
		out.at = found.starts.min()
		out.until = found.ends.max()
	elif found.there:
		out.state = "done"
	elif found.waiting.size() > 0 and found.all_played:
		out.state = "late" if told else "planned"
		out.at = found.waiting[0]
		out.why = why if told else "chosen when its time is nearer"
	elif not told:
		out.why = "nothing came of it"
	return out
