# What becomes of what was asked.

const Hearing = preload("hearing.gd")
const Meaning = preload("meaning.gd")
const Utterances = preload("utterances.gd")
const WORDS = {looks = "look", speeches = "speech", modes = "mode", places = "place", blinks = "blink", moods = "mood"}


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
	for lane in WORDS:
		for item in plan.track[lane]:
			if lane == "speeches" and plan.track.last_speech(item.id) != item:
				continue  # an earlier one of the id is over
			for each in _of(found, item.id):
				if Utterances.is_paused(item.start):
					each.waiting.append(item.start)
				else:
					_plays(each, item.start, _end_of(item, lane), WORDS[lane])
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
	for owner in Hearing.owners(made):
		if found.has(owner):
			out.append(found[owner])
	return out


# Returns when something that lasts ends: a mode or a place when another one comes, a blink at once.
static func _end_of(item, lane):
	if lane == "modes" or lane == "places":
		return Meaning.FOREVER
	return item.start if lane == "blinks" else item.end


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
	elif found.waiting.size() > 0 and Utterances.is_paused(found.waiting[0]):
		out.state = "planned"
		out.why = "it is paused"
	elif found.waiting.size() > 0 and found.all_played:
		out.state = "late" if told else "planned"
		out.at = found.waiting[0]
		out.why = why if told else "chosen when its time is nearer"
	elif not told:
		out.why = "nothing came of it"
	return out
