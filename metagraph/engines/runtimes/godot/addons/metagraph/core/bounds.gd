# The times by which the meta actions of a plan have to be over.
#
# Translated from metagraph/playback/planning/bounds.py; change that, and translate anew.

const Util = preload("util.gd")
const LOOKED_AT = 6  # how many of those that follow a meta action are listed


# A meta action and its bounds. limit: when the next more important one begins; wish: when the next equally important request
# begins; infinity if there is none. after: equally important requests that say how late they may be, the next one first.
class Bound:
	var meta
	var limit
	var wish
	var after

	func _init(meta_, limit_, wish_, after_ = null):
		self.meta = meta_
		self.limit = limit_
		self.wish = wish_
		self.after = after_ if after_ != null else []


# The first of some meta actions of a rank, written or requested, and when it starts.
class _First:
	var rank
	var written
	var start

	func _init(rank_, written_, start_):
		self.rank = rank_
		self.written = written_
		self.start = start_


# Return each meta action with its bounds.
static func bounds(metas):
	var out = []
	var first = []
	var pressing = []  # what says how late it may be, the last first
	for meta in Util.backwards(metas):
		var limit = INF
		var wish = INF
		var own = null
		var start = begins(meta)
		var rank = meta.rank
		for one in first:
			if one.rank > rank:
				limit = Util.least(limit, one.start)
			if one.rank >= rank and not one.written:
				wish = Util.least(wish, one.start)
			if one.rank == rank and one.written == meta.written:
				own = one
		var after = []
		if pressing.size() > 0:
			var found = []
			for one2 in Util.backwards(Util.part(pressing, -LOOKED_AT, pressing.size())):
				if one2.rank >= rank:
					found.append(one2)
			after = found
		out.append(Bound.new(meta, limit, wish, after))
		if meta.request.late != null:
			pressing.append(meta)
		if own == null:
			first.append(_First.new(rank, meta.written, start))
		else:
			own.start = start
	return Util.list(Util.backwards(out))


# Return the earliest time at which a meta action may begin. One whose stroke is judged is placed where its stroke comes.
static func begins(meta):
	if meta.request.late != null and meta.request.stroke != null:
		return Util.least(meta.start, meta.request.start)
	return meta.start
