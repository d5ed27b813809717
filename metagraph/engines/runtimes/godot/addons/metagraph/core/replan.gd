# Temporal replanning: meta actions that may clash become a meta plan that does not. Greedy, by start time and then priority.
#
# A meta action is {request, start, end: the window it may use, part: n for the n-th remainder after a cut, written: by a
# model, key: what keys its draws}.

const Util = preload("util.gd")


# Returns how important a meta action is; what a model wrote gives way to all that is asked for.
static func rank(meta):
	return -INF if meta.written else float(meta.request.priority)


# Returns [metas, reports]: new requests wait until `free` seconds, the end of the running action; what would wait too long is past.
static func delay(asked, free, settings):
	var metas = []
	var reports = []
	for meta in asked:
		var late = free - meta.start
		if late <= 0:
			metas.append(meta)
		elif late > settings.wait:
			reports.append(_told(meta, "past", "asked for %.1f s before anything could start" % late))
		else:
			metas.append(Util.but(meta, {start = free, end = free + (meta.end - meta.start)}))
			reports.append(_told(meta, "late", "waits %.2f s for the running action" % late, true))
	return [metas, reports]


# Returns [the meta plan, ascending and without overlaps; what became of the rest]. What is asked for is placed first; what a
# model wrote fits into the gaps, from `busy` seconds on.
static func replan(metas, settings, busy):
	var asked = []
	var written = []
	for meta in metas:
		if meta.written:
			written.append(meta)
		else:
			asked.append(meta)
	var placed = _placed(asked, settings)
	var fitted = _fitted(written, placed[0], settings.shortest, busy)
	return [Util.by(placed[0] + fitted[0], "start", "end"), placed[1] + fitted[1]]


# Returns [what is left of what a model wrote beside what is placed: the first stretch of each that is long enough; reports].
static func _fitted(written, placed, shortest, busy):
	var out = []
	var reports = []
	var keys = []
	for meta in written:
		keys.append([meta.start, meta.request.id])
	for meta in Util.ordered(written, keys):
		var start = Util.most(meta.start, Util.most(busy, out[-1].end if out.size() > 0 else busy))
		var end = meta.end
		var beside = null
		for n in range(Util.most(0, Util.after(placed, "start", start) - 1), placed.size()):
			var other = placed[n]
			if other.start >= end:
				break
			if other.end <= start:
				continue
			beside = other
			if other.start - start >= shortest:
				end = other.start
				break
			start = other.end
		if start == meta.start and end == meta.end:
			out.append(meta)
		elif end - start >= shortest:
			out.append(Util.but(meta, {start = start, end = end}))
			if end < meta.end and beside != null:
				reports.append(_told(meta, "cut", "is cut at %.2f s for '%s', which is asked for" % [end, beside.request.id], true))
		else:
			reports.append(_told(meta, "covered", _no_time(beside) if beside != null else "no time left beside what plays"))
	return [out, reports]


static func _placed(metas, settings):
	var queue = []
	var keys = []
	for meta in metas:
		_push(queue, keys, meta)
	var reports = []
	var placed = []
	while queue.size() > 0:
		var meta = queue.pop_front()
		keys.pop_front()
		var last = placed[-1] if placed.size() > 0 else null
		if last == null or last.end <= meta.start:
			placed.append(meta)
			continue
		if meta.request.priority > last.request.priority:
			placed.pop_back()
			var kept = meta.start - last.start >= settings.shortest
			if kept:
				placed.append(Util.but(last, {end = meta.start}))
			# What was never begun goes on as itself, so that its draws stay the same.
			var part = last.part + 1 if kept else last.part
			var key = last.request.id if part == 0 else "%s+%d" % [last.request.id, part]
			var rest = Util.but(last, {start = meta.end, part = part, key = key})
			var resumes = last.request.resume and rest.end - rest.start >= settings.shortest
			if resumes:
				_push(queue, keys, rest)
			var words = "is cut" if kept else "gives way"
			words += " at %.2f s for '%s', which is more important" % [meta.start, meta.request.id]
			if resumes:
				words += " and goes on at %.2f s" % meta.end
			var outcome = "resumed" if resumes else ("cut" if kept else "covered")
			reports.append(_told(last, outcome, words, kept or resumes))
			_push(queue, keys, meta)  # it may reach back over what was placed before, too
		elif last.end - meta.request.start > settings.wait:
			reports.append(_told(meta, "covered", _no_time(last)))
		else:
			_push(queue, keys, Util.but(meta, {start = last.end, end = last.end + (meta.end - meta.start)}))
			var waits = last.end - meta.request.start
			reports.append(_told(meta, "late", "waits %.2f s for '%s'" % [waits, last.request.id], true))
	return [placed, reports]


# Puts a meta action into the queue, behind those that come as early.
static func _push(queue, keys, meta):
	var key = [meta.start, -meta.request.priority, meta.request.id, meta.part]
	var place = queue.size()
	while place > 0 and Util.less(key, keys[place - 1]):
		place -= 1
	queue.insert(place, meta)
	keys.insert(place, key)


static func _no_time(other):
	return "no time left beside '%s' (%.2f-%.2f s)" % [other.request.id, other.start, other.end]


static func _told(meta, outcome, message, played = false):
	return {
		request = meta.request.id, outcome = outcome, message = message, layer = meta.request.layer, at = meta.start, played = played,
		written = meta.written
	}
