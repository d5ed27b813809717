# Temporal replanning: meta actions that may clash become a meta plan that does not (Borer et al., section 6.1).
#
# Greedy, by start time and then priority. The running action is never touched. If two overlap, the more important one keeps its
# time. The other is delayed past it, or cut where it begins; its remainder then plays afterwards if the request says so.
#
# Translated from metagraph/playback/planning/replan.py; change that, and translate anew.

const MetaPlan = preload("meta_plan.gd")
const Util = preload("util.gd")


# Let new requests wait until `free` seconds, the end of the running action, and drop those that would wait too long. Requests
# that say how late they may be are judged later, when their lateness is known.
static func delay(asked, free_, settings):
	var metas = []
	var reports = []
	for meta in asked:
		var late = free_ - meta.start
		if late <= 0:
			metas.append(meta)
		elif meta.request.late != null:
			metas.append(_after(meta, free_))
		elif late > settings.wait:
			reports.append(_told(meta, "past", "asked for at %.2f s, %.1f s before anything could start" % [meta.start, late]))
		else:
			metas.append(_after(meta, free_))
			reports.append(_told(meta, "late", "waits %.2f s for the running action" % [late], true))
	return [metas, reports]


# Return the meta plan, ascending and without overlaps, and what became of the rest.
#
# Requests are placed first; what a model wrote fits into the gaps, from `busy` seconds on. Meta actions that do not overlap stay
# as they are, so a plan that is placed again does not change. If start and priority are equal, the id that sorts first goes
# first.
static func replan(metas, settings, busy = -INF):
	var every = Util.list(metas)
	var found = []
	for m in every:
		if not m.written:
			found.append(m)
	var both = _placed(found, settings)
	var placed = both[0]
	var reports = both[1]
	var found2 = []
	for m in every:
		if m.written:
			found2.append(m)
	var both2 = _fitted(found2, placed, settings.shortest, busy)
	var written = both2[0]
	var told = both2[1]
	var keys = []
	for m in placed + written:
		keys.append([m.start, m.end])
	return [Util.ordered(placed + written, keys), reports + told]


# Return the parts of written meta actions that fit beside the placed ones: the first stretch of each that is long enough.
static func _fitted(written, placed, shortest, busy):
	var out = []
	var reports = []
	var starts = []
	for m in placed:
		starts.append(m.start)
	var keys = []
	for m in written:
		keys.append([m.start, m.request.id])
	for meta in Util.ordered(written, keys):
		var start = Util.most(meta.start, Util.most(busy, out[-1].end if out.size() > 0 else busy))
		var end = meta.end
		var beside = null
		for other in Util.part(placed, Util.most(0, Util.right_of(starts, start) - 1), placed.size()):
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
			out.append(MetaPlan.MetaAction.new(meta.request, start, end, meta.part, meta.written))
			if end < meta.end and beside != null:
				reports.append(_told(
					meta,
					"cut",
					"is cut at %.2f s for '%s', which is asked for" % [end, beside.request.id],
					true
				))
		else:
			var words = _no_time(beside) if beside != null else "no time left beside what plays"
			reports.append(_told(meta, "covered", words))
	return [out, reports]


# Return the sort key that decides which is placed first.
static func _order(meta):
	return [meta.start, -meta.request.priority, meta.request.id, meta.part]


static func _placed(metas, settings):
	var keys = []
	for item in metas:
		keys.append(_order(item))
	var queue = Util.ordered(metas, keys)
	var at = 0  # what is before it was looked at
	var placed = []
	var reports = []
	while at < queue.size():
		var meta = queue[at]
		at += 1
		var last = placed[-1] if placed.size() > 0 else null
		if last == null or last.end <= meta.start:
			placed.append(meta)
			continue
		if meta.request.priority > last.request.priority:
			placed.pop_back()
			var kept = meta.start - last.start >= settings.shortest
			if kept:
				placed.append(MetaPlan.MetaAction.new(last.request, last.start, meta.start, last.part, last.written))
			# What was never begun goes on as itself, so that its draws stay the same.
			var rest = MetaPlan.MetaAction.new(
				last.request,
				meta.end,
				last.end,
				last.part + 1 if kept else last.part,
				last.written
			)
			var resumes = last.request.resume and rest.end - rest.start >= settings.shortest
			if resumes:
				var own = _order(rest)
				var place = queue.size()
				while place > at and Util.less(own, _order(queue[place - 1])):
					place -= 1
				queue.insert(place, rest)
			var word = "is cut" if kept else "gives way"
			var after = " and goes on at %.2f s" % [meta.end] if resumes else ""
			var outcome = "resumed" if resumes else ("cut" if kept else "covered")
			var message = "%s at %.2f s for '%s', which is more important%s" % [word, meta.start, meta.request.id, after]
			reports.append(_told(last, outcome, message, kept or resumes))
			var own2 = _order(meta)
			var place2 = queue.size()
			while place2 > at and Util.less(own2, _order(queue[place2 - 1])):
				place2 -= 1
			queue.insert(place2, meta)
		elif meta.request.late != null:
			var own3 = _order(_after(meta, last.end))
			var place3 = queue.size()
			while place3 > at and Util.less(own3, _order(queue[place3 - 1])):
				place3 -= 1
			queue.insert(place3, _after(meta, last.end))
		elif last.end - meta.request.start > settings.wait:
			reports.append(_told(meta, "covered", _no_time(last)))
		else:
			var own4 = _order(_after(meta, last.end))
			var place4 = queue.size()
			while place4 > at and Util.less(own4, _order(queue[place4 - 1])):
				place4 -= 1
			queue.insert(place4, _after(meta, last.end))
			reports.append(_told(meta, "late", "waits %.2f s for '%s'" % [last.end - meta.request.start, last.request.id], true))
	return [placed, reports]


# Return a meta action that begins at `free` instead.
static func _after(meta, free_):
	return MetaPlan.MetaAction.new(meta.request, free_, free_ + (meta.end - meta.start), meta.part, meta.written)


static func _no_time(other):
	return "no time left beside '%s' (%.2f-%.2f s)" % [other.request.id, other.start, other.end]


static func _told(meta, outcome, message, played = false):
	return MetaPlan.Report.new(meta.request.id, outcome, message, meta.request.layer, meta.start, played, meta.written)
