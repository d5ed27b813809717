# What the planner remembers of played actions: how often each played lately, and until when.
#
# Translated from metagraph/playback/planning/remembering.py; change that, and translate anew.

const Util = preload("util.gd")
const REMEMBERED = 32  # draws of a stance and kind that spacing can look back on


# Return the key under which draws of a stance and kind are remembered.
static func node(stance, kind):
	return "%s %s" % [kind, stance]


# Return whether at least this many other draws came after an action's last one.
static func rested(recent, ident, needed):
	if needed <= 0:
		return true
	return needed <= REMEMBERED and not Util.part(recent, Util.most(0, recent.size() - needed), recent.size()).has(ident)


# Note that a cue was played: count its action, and note when it ended.
static func remember(cue, uses, recent, ended):
	var ident = cue.action.id
	var place = node(cue.stance, cue.action.kind)
	uses[ident] = uses.get(ident, 0) + 1
	recent[place] = Util.part(recent.get(place, []), 1 - REMEMBERED, recent.get(place, []).size()) + [ident]
	ended[ident] = cue.end
