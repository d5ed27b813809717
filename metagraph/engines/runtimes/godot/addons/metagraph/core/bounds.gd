# By when each meta action of a plan has to be over.
#
# Translated from metagraph/playback/bounds.py; change that, and translate anew.

const Util = preload("util.gd")


# A meta action with when the next more important one begins (limit), and the next as important that was asked for (wish);
# infinity where there is none.
class Bound:
	var meta
	var limit
	var wish

	func _init(meta_, limit_, wish_):
		self.meta = meta_
		self.limit = limit_
		self.wish = wish_


# The first of some meta actions of a rank, written or asked for, and when it starts.
class _First:
	var rank
	var written
	var start

	func _init(rank_, written_, start_):
		self.rank = rank_
		self.written = written_
		self.start = start_


# Return each meta action with what bounds it.
static func bounds(metas):
	var out = []
	var first = []
	for meta in Util.backwards(metas):
		var limit = INF
		var wish = INF
		var own = null
		for one in first:
			if one.rank > meta.rank:
				limit = Util.least(limit, one.start)
			if one.rank >= meta.rank and not one.written:
				wish = Util.least(wish, one.start)
			if one.rank == meta.rank and one.written == meta.written:
				own = one
		out.append(Bound.new(meta, limit, wish))
		if own == null:
			first.append(_First.new(meta.rank, meta.written, meta.start))
		else:
			own.start = meta.start
	return Util.list(Util.backwards(out))
