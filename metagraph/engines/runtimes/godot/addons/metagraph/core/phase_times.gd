# When a gesture prepares, strikes, holds and retracts (Kendon; BML's ready, stroke-end and relax).
#
# Translated from metagraph/playback/timing/phase_times.py; change that, and translate anew.

const Util = preload("util.gd")
const LEAST_BLEND = 0.25  # seconds in which a gesture that skips its preparation comes in


# Clip seconds, ascending: start, ready (preparation ends), stroke (its peak), stroke_end (the hold begins), relax (the hold
# ends), end.
class Phases:
	var start
	var ready
	var stroke
	var stroke_end
	var relax
	var end

	func _init(start_, ready_, stroke_, stroke_end_, relax_, end_):
		self.start = start_
		self.ready = ready_
		self.stroke = stroke_
		self.stroke_end = stroke_end_
		self.relax = relax_
		self.end = end_

	# Return where a gesture begins if it skips its preparation: as late as it can blend in and be ready.
	func skip(blend_in):
		return Util.most(self.start, self.ready - Util.most(blend_in, LEAST_BLEND))
