# Say how long actions play that repeat a part of their clip, such as one cycle of a wave.
#
# Translated from metagraph/graph/repeating.py; change that, and translate anew.

const Util = preload("util.gd")
const LEAST_CYCLE = 0.1  # seconds of a part that can repeat
const MOST_TIMES = 1000000.0  # that a cycle plays in a row
const LONGEST_REPEAT = 60.0  # most seconds that an action repeats if no request says how long


# Return the length in seconds of the part from `start` to `end` that an action repeats, 0 if it plays once.
static func cycle_of(kind, timing, start, end):
	var repeats = timing.repeat > 0 and ["gesture", "fidget"].has(kind)
	return end - start if (repeats and end - start >= LEAST_CYCLE) else 0.0


# Return how many whole times, at least one, a cycle must play to last as close to `seconds` as possible.
static func times_played(cycle, seconds):
	return Util.most(1.0, float(int(floor(Util.least(seconds / cycle, MOST_TIMES) + 0.5))))


# Return how many seconds an action plays at its own speed if no request says how long.
static func seconds_played(kind, timing, start, end):
	var cycle = cycle_of(kind, timing, start, end)
	if cycle <= 0:
		return end - start
	return cycle * times_played(cycle, Util.least(timing.repeat, LONGEST_REPEAT))
