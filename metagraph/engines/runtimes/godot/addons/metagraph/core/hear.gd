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
	var leave = []
	if asks.size() > 0 and now > 0 and end == plan.end:
		for layer in Util.LAYERS:
			if not touched.has(layer):
				leave.append(layer)
	var track = Track.plus(Track.without(plan.track, withdrawn, fixed), items)
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


# Says what a plan does about an ask: {state: planned, late, done or refused, at, until: seconds or null, what: words, why}.
static func answer(plan, ident):
	var starts = []
	var ends = []
	var what = []
	var waiting = []
	for layer in plan.layers:
		for cue in plan.layers[layer].cues:
			if owners(cue.meta.split("+")[0]).has(ident):
				starts.append(cue.start)
				ends.append(cue.end)
				what.append(cue.action.name)
		for meta in plan.layers[layer].metas:
			if meta.start >= plan.end and owners(meta.request.id).has(ident):
				waiting.append(meta.start)
	for item in Track.items(plan.track):
		if item.list != "stays" and owners(item.id).has(ident):
			starts.append(item.start)
			ends.append(item.get("end", item.start))
			what.append(WORDS[item.list])
	var why = []
	var late = false
	var there = false
	var all_played = true
	for report in plan.reports:
		if owners(report.request).has(ident):
			if not why.has(report.message):
				why.append(report.message)
			late = late or ["late", "queued", "resumed"].has(report.outcome)
			there = there or report.outcome == "already-there"
			all_played = all_played and report.played
	var told = why.size() > 0
	var words = ""
	for message in why:
		words += message if words == "" else "; " + message
	if starts.size() > 0:
		return {state = "late" if late else "planned", at = starts.min(), until = ends.max(), what = what, why = words}
	if there:
		return {state = "done", at = null, until = null, what = [], why = words}
	if waiting.size() > 0 and all_played:
		var state = "late" if told else "planned"
		return {state = state, at = waiting[0], until = null, what = [], why = words if told else "chosen when its time is nearer"}
	return {state = "refused", at = null, until = null, what = [], why = words if told else "nothing came of it"}
