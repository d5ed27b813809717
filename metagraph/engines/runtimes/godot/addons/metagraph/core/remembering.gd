# What is remembered of what was played: how often an action was, lately, and until when.
#
# Translated from metagraph/playback/planning/remembering.py; change that, and translate anew.

const Util = preload("util.gd")
const REMEMBERED = 32  # draws of a stance and kind that spacing can look back on


# Return what draws of a stance and kind are remembered under.
static func node(stance, kind):
	return "%s %s" % [kind, stance]


# Whether so many other draws came after an action's last one.
static func rested(recent, ident, needed):
	if needed <= 0:
		return true
	return needed <= REMEMBERED and not Util.part(recent, Util.most(0, recent.size() - needed), recent.size()).has(ident)


# Note that a cue was played: how often its action was, lately, and until when.
static func remember(cue, uses, recent, ended):
	var ident = cue.action.id
	var place = node(cue.stance, cue.action.kind)
	uses[ident] = uses.get(ident, 0) + 1
	recent[place] = Util.part(recent.get(place, []), 1 - REMEMBERED, recent.get(place, []).size()) + [ident]
	ended[ident] = cue.end
