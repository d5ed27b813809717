# A lane of events in time, drawn one after another: {starts [n] ascending, seconds; rows [n]: what each event is; first: the number
# of the first event that is still kept}. Lanes are never changed: extended at the end, forgotten at the front, always as a copy.

const Util = preload("util.gd")


static func empty_lane():
	return {starts = [], rows = [], first = 0}


# Returns the number of the event to be drawn next.
static func next_number(lane):
	return lane.first + lane.starts.size()


# Returns the lane with only what begins before a time.
static func until(lane, seconds):
	var count = Util.left_of(lane.starts, seconds)
	return {starts = Util.part(lane.starts, 0, count), rows = Util.part(lane.rows, 0, count), first = lane.first}


# Returns the lane with later events.
static func plus(lane, starts, rows):
	return {starts = lane.starts + starts, rows = lane.rows + rows, first = lane.first}


# Returns the lane without what neither goes on at `seconds` nor comes later; `before`: how many more are kept.
static func since(lane, seconds, before):
	var gone = Util.most(0, Util.right_of(lane.starts, seconds) - 1 - before)
	var count = lane.starts.size()
	return {starts = Util.part(lane.starts, gone, count), rows = Util.part(lane.rows, gone, count), first = lane.first + gone}
