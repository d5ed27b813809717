# A lane of events in time, drawn one after another. It never changes: it is extended at the end and forgotten at the front.
#
# Translated from metagraph/playback/life/lane.py; change that, and translate anew.

const Util = preload("util.gd")


# times: when events begin, ascending, seconds. rows: the values of each event. first: number of the first event that is still
# kept. width: how many numbers a row has.
class Lane:
	var times
	var rows
	var first
	var width
	var next  # The number of the event to be drawn next.

	func _init(times_ = null, rows_ = null, first_ = 0, width_ = 1):
		self.times = times_ if times_ != null else []
		self.rows = rows_ if rows_ != null else []
		self.first = first_
		self.width = width_
		self.next = self.first + self.times.size()

	# Return the lane with only the events that begin before a time.
	func until(seconds):
		var count = Util.left_of(self.times, seconds)
		if count == self.times.size():
			return self
		return Lane.new(Util.part(self.times, 0, count), Util.part(self.rows, 0, count), self.first, self.width)

	# Return the lane with later events.
	func plus(times, rows):
		if times.size() == 0:
			return self
		return Lane.new(self.times + times, self.rows + rows, self.first, self.width)

	# Return the lane without events that are over at `seconds`; `before`: how many of those to keep.
	func since(seconds, before = 1):
		var gone = Util.most(0, Util.right_of(self.times, seconds) - 1 - before)
		if gone == 0:
			return self
		return Lane.new(
			Util.part(self.times, gone, self.times.size()),
			Util.part(self.rows, gone, self.rows.size()),
			self.first + gone,
			self.width
		)
