# What keeps a performance from repeating itself and from being restless: how soon an action is done again, how long a posture is
# kept, how far apart acts are that stand out.
#
# Only what the Markov model writes is held back. Requests always play; of the actions that fit a request, those that have not
# played for long enough are likelier. `Settings.variety` multiplies every time here; 0 turns all of it off, as in Borer et al.
# The times are ours, chosen by what an hour of the sample then does (`docs/researchers/behaviour.md`).
#
# Translated from metagraph/playback/planning/director.py; change that, and translate anew.

const Choice = preload("choice.gd")
const Util = preload("util.gd")
const STANDS_OUT = 0.65  # prominence from which on an act is one that a viewer remembers
const APART = 30.0  # seconds between two of those on one layer
const LONG_REST = 30.0  # seconds of rest after which actions need to have rested only `SHORTER` as long
const SHORTER = 0.3
const LEAST_BEATS = 18.0  # seconds after which a gesture that hardly shows is done again, at least
const MOST_BEATS = 180.0  # and at most
const EACH = 7.0  # seconds of those for each gesture of the arms that the character has
const STALE = 0.05  # least factor of the likelihood of what has just been played
const ENDS_BURST = 0.25  # share of the acts of one who talks that end a burst: some 2.5 acts, then a rest
const LEAST_LULL = 5.0  # seconds of that rest at least
const MOST_LULL = 30.0  # and at most
const LULL = 8.0  # its mean before it is clamped
const LULL_SPREAD = 14.0  # and its standard deviation
const LEAVES_HOME = 0.2  # share of the written tilts of the head that leave the stance it begins in
const GOES_HOME = 0.7  # share of the written moves of a tilted head that go back there
const MUSES = 2.0  # seconds that a thought goes on at least for which a hand goes to the chin
const MUSED = 10.0  # seconds after a thought in which anything that is written takes the hand away again
const THOUGHTFUL = ["chin", "thinking", "pondering", "musing"]  # words of such a stance's name


# Return the first stance of the arms whose name says that one thinks in it; "" for none.
static func musing(stances):
	for ident in stances:
		var stance = stances[ident]
		for word in Util.words(stance.name.to_lower()):
			if THOUGHTFUL.has(word) or THOUGHTFUL.has(Util.parted_last(word, "_")[2]):
				return ident
	return ""


# Return after how many seconds a gesture that hardly shows may be done again: with many gestures of the arms, not for minutes;
# with few, soon. gestures: how many the layer has.
static func beat_interval(layer, gestures):
	if layer != "arms":
		return LEAST_BEATS
	return Util.least(MOST_BEATS, Util.most(LEAST_BEATS, EACH * gestures))


# Return after how many seconds an action may be done again.
#
# That is from `beats` (`beat_interval`) to six minutes for gestures, the longer the more they stand out, and 5 to 10 minutes for
# fidgets, which only time calls for. prominence: 0..1.
static func repeat_interval(kind, prominence, beats):
	if kind == "gesture":
		return beats * exp(log(360.0 / beats) * prominence)
	return 300.0 * exp(log(2.0) * prominence)


# Return how many seconds a stance is kept at least before the model changes it.
static func posture(layer):
	if layer == "body":
		return 25.0
	return 10.0 if layer == "arms" else 8.0


# Return how many seconds the arms rest at least after an act of theirs: nothing within a burst of one who talks, else from
# `LEAST_LULL` to `MOST_LULL`. key: of the act's meta action.
static func find_lull(seed_, key, talks, variety):
	if talks and Choice.uniform(seed_, [key, "burst"]) >= ENDS_BURST:
		return 0.0
	var drawn = Choice.log_normal(LULL, LULL_SPREAD, Choice.uniform(seed_, [key, "lull"]), Choice.uniform(seed_, [key, "lull2"]))
	return Util.least(MOST_LULL, Util.most(LEAST_LULL, drawn) * variety)


# Return the factor of an action's likelihood. since: seconds since it ended; needed: its interval.
static func freshness(since, needed):
	if since >= needed:
		return 1.0
	return Util.most(STALE, since / needed)
