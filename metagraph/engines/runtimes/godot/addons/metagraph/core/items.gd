# Requests that last: where to look, what to say, which mode to be in, which stance to stay in. Values; times are seconds.
#
# Translated from metagraph/playback/life/items.py; change that, and translate anew.

const LineTiming = preload("line_timing.gd")
const Spots = preload("spots.gd")
const Util = preload("util.gd")


# Look at a point or a named point from `start` until `end`, or until the next look. strict: without looking away.
class LookAt:
	var id
	var start
	var end
	var to
	var amount
	var strict
	var priority

	func _init(id_, start_, end_, to_, amount_ = 1.0, strict_ = false, priority_ = 1):
		self.id = id_
		self.start = start_
		self.end = end_
		self.to = to_
		self.amount = amount_
		self.strict = strict_
		self.priority = priority_


# Something said. line: id of the project's line, None for `text` alone. priority: a higher one interrupts a lower one. length:
# seconds that all of it would have taken, if it was cut short. timing: the times of its words and mouth shapes, if known. skip:
# seconds of it that were said before a pause. more: whether more of it may come, so that it is not over when it falls silent.
# over: when it was finished, if it had fallen silent before. asked: when the first piece of its utterance was asked for, which
# all its pieces share and no other utterance of its id has.
class Speech:
	var id
	var start
	var end
	var line
	var text
	var priority
	var length
	var timing
	var skip
	var more
	var over
	var asked

	func _init(
		id_,
		start_,
		end_,
		line_ = null,
		text_ = "",
		priority_ = 1,
		length_ = null,
		timing_ = null,
		skip_ = 0.0,
		more_ = false,
		over_ = null,
		asked_ = 0.0
	):
		self.id = id_
		self.start = start_
		self.end = end_
		self.line = line_
		self.text = text_
		self.priority = priority_
		self.length = length_
		self.timing = timing_
		self.skip = skip_
		self.more = more_
		self.over = over_
		self.asked = asked_


# The mode from `start` on; None for talking while something is said and idling otherwise.
class ModeFrom:
	var id
	var start
	var mode

	func _init(id_, start_, mode_):
		self.id = id_
		self.start = start_
		self.mode = mode_


# Where a named point is from `start` on.
class PlaceFrom:
	var id
	var start
	var name
	var point

	func _init(id_, start_, name_, point_):
		self.id = id_
		self.start = start_
		self.name = name_
		self.point = point_


# A requested blink.
class BlinkAt:
	var id
	var start

	func _init(id_, start_):
		self.id = id_
		self.start = start_


# From `start` on, the models change no stance of a layer, or may do so again with `on` false, until `end` or the next item of
# this kind.
class StayFrom:
	var id
	var start
	var layer
	var on
	var end

	func _init(id_, start_, layer_, on_ = true, end_ = INF):
		self.id = id_
		self.start = start_
		self.layer = layer_
		self.on = on_
		self.end = end_


# Return the second from which the times of a speech count: before its start if it continues after a pause.
static func find_line_start(speech):
	return speech.start - speech.skip


# Return how many seconds all of a speech takes, with the part before a pause and the part that was cut off.
static func measure_line(speech):
	return speech.end - find_line_start(speech) if speech.length == null else speech.length


# Return the speech, ending no later than `at`; it remembers its full length.
static func cut(speech, at):
	return speech if speech.end <= at else Speech.new(
		speech.id,
		speech.start,
		at,
		speech.line,
		speech.text,
		speech.priority,
		measure_line(speech),
		speech.timing,
		speech.skip,
		speech.more,
		speech.over,
		speech.asked
	)


# Return speeches, given in order, without overlaps: one of equal or higher importance cuts the running one, with its later
# pieces; a less important one is dropped.
static func apart(speeches):
	var out = []
	var ends = {}  # when what was cut would have ended
	for speech in speeches:
		if ends.has(speech.id) and speech.start == ends[speech.id]:
			ends[speech.id] = speech.end
			continue
		if out.size() > 0 and out[-1].end > speech.start:
			var last = out[-1]
			if speech.priority < last.priority:
				continue
			out.pop_back()
			if last.id != speech.id:
				ends[last.id] = last.end
			if last.start < speech.start:
				out.append(Speech.new(
					cut(last, speech.start).id,
					cut(last, speech.start).start,
					cut(last, speech.start).end,
					cut(last, speech.start).line,
					cut(last, speech.start).text,
					cut(last, speech.start).priority,
					cut(last, speech.start).length,
					cut(last, speech.start).timing,
					cut(last, speech.start).skip,
					false,
					cut(last, speech.start).over,
					cut(last, speech.start).asked
				))
		out.append(speech)
	return out


# Return a text moved to after another one of its id that is being said, also if more of it may come. said: in order.
static func behind(said, new, now):
	if (new.timing != null and not new.timing.paced) or new.line != null or new.start > now:
		return new
	var end = new.start
	for speech in said:
		var paced = speech.timing == null or speech.timing.paced
		var plain = paced and speech.line == null and speech.length == null
		if speech.id == new.id and plain and speech.start <= end and end < speech.end:
			end = speech.end
	return new if end == new.start else Speech.new(
		new.id,
		end,
		end + (new.end - new.start),
		new.line,
		new.text,
		new.priority,
		new.length,
		new.timing,
		new.skip,
		new.more,
		new.over,
		new.asked
	)


# Return a line as the continuation of the last one with the same id, if that has begun by `now` or begins with it: it keeps the
# start and what has been said. Only lines whose words or shapes have times continue.
static func going_on(old, new, now):
	if old == null or old.timing == null or new.timing == null or old.length != null:
		return new
	if new.timing.paced:
		return new if old.end <= now else _behind_words(old, old.timing, new, new.timing, now)
	if Util.most(old.start, new.start) > now and old.start != new.start:
		return new
	var said = Util.most(now - find_line_start(old), old.skip)
	if old.end <= now and not LineTiming.tells_on(old.timing, LineTiming.shifted(new.timing, old.timing.later)):
		return new
	var told = new.timing if (old.start > now and old.skip == 0) else LineTiming.place_told(old.timing, new.timing, said)
	var timing = LineTiming.extended(old.timing, told, said)
	var length = Util.most(LineTiming.timed_seconds(timing, null), new.end - new.start)
	var more = new.text == "" or new.text == LineTiming.told_text(new.timing)
	return Speech.new(
		new.id,
		old.start,
		find_line_start(old) + length,
		new.line,
		LineTiming.told_text(timing) if more else new.text,
		new.priority,
		new.length,
		timing,
		old.skip,
		new.more,
		new.over,
		new.asked
	)


# Return a text with times estimated from its letters, so that later pieces can be added.
static func pace_speech(alphabet, new):
	var timing = LineTiming.pace_text(alphabet, new.text, null)
	var length = LineTiming.timed_seconds(timing, LineTiming.measure_text(alphabet, new.text))
	return Speech.new(
		new.id,
		new.start,
		new.start + length,
		new.line,
		new.text,
		new.priority,
		new.length,
		timing,
		new.skip,
		new.more,
		new.over,
		new.asked
	)


# Return a line with a text after its known words. told, more: the words of both.
static func _behind_words(old, told, new, more, now):
	var begin = find_line_start(old)
	var at = Util.most(now - begin, Util.most(old.skip, old.end - begin))
	var timing = LineTiming.LineTiming.new(told.words + LineTiming.shifted(more, at).words, told.marks, told.later, true)
	var length = LineTiming.timed_seconds(timing, at + new.end - new.start)
	return Speech.new(
		new.id,
		old.start,
		begin + length,
		new.line,
		old.text + new.text,
		new.priority,
		new.length,
		timing,
		old.skip,
		new.more,
		new.over,
		new.asked
	)


# Return whether the looks of two tracks are the same. The functions below compare other items.
static func alike_looks(one, other):
	var holds = one.size() == other.size()
	if holds:
		var are_all = true
		for n in range(one.size()):
			var a = one[n]
			var b = other[n]
			if not (a == b or _same_look(a, b)):
				are_all = false
				break
		holds = are_all
	return holds


static func _same_look(a, b):
	if not Spots.is_same_spot(a.to, b.to) or a.amount != b.amount or a.strict != b.strict:
		return false
	return a.id == b.id and a.start == b.start and a.end == b.end and a.priority == b.priority


static func alike_speeches(one, other):
	var holds = one.size() == other.size()
	if holds:
		var are_all = true
		for n in range(one.size()):
			var a = one[n]
			var b = other[n]
			if not (a == b or _same_speech(a, b)):
				are_all = false
				break
		holds = are_all
	return holds


static func _same_speech(a, b):
	if a.line != b.line or a.text != b.text or a.length != b.length or a.priority != b.priority:
		return false
	if a.skip != b.skip or a.more != b.more or a.over != b.over or a.asked != b.asked:
		return false
	return a.id == b.id and a.start == b.start and a.end == b.end and LineTiming.alike_timings(a.timing, b.timing)


static func alike_modes(one, other):
	var holds = one.size() == other.size()
	if holds:
		var are_all = true
		for n in range(one.size()):
			var a = one[n]
			var b = other[n]
			if not (a == b or (a.id == b.id and a.start == b.start and a.mode == b.mode)):
				are_all = false
				break
		holds = are_all
	return holds


static func alike_places(one, other):
	var holds = one.size() == other.size()
	if holds:
		var are_all = true
		for n in range(one.size()):
			var a = one[n]
			var b = other[n]
			if not (a == b or _same_place(a, b)):
				are_all = false
				break
		holds = are_all
	return holds


static func _same_place(a, b):
	if a.id != b.id or a.start != b.start or a.name != b.name:
		return false
	var are_all = true
	for n in range(a.point.size()):
		var x = a.point[n]
		var y = b.point[n]
		if not (x == y):
			are_all = false
			break
	return are_all


static func alike_blinks(one, other):
	var holds = one.size() == other.size()
	if holds:
		var are_all = true
		for n in range(one.size()):
			var a = one[n]
			var b = other[n]
			if not (a == b or (a.id == b.id and a.start == b.start)):
				are_all = false
				break
		holds = are_all
	return holds


static func alike_stays(one, other):
	var holds = one.size() == other.size()
	if holds:
		var are_all = true
		for n in range(one.size()):
			var a = one[n]
			var b = other[n]
			if not (a == b or _same_stay(a, b)):
				are_all = false
				break
		holds = are_all
	return holds


static func _same_stay(a, b):
	if a.layer != b.layer or a.on != b.on or a.end != b.end:
		return false
	return a.id == b.id and a.start == b.start


static func alike_felt(one, other):
	var holds = one.size() == other.size()
	if holds:
		var are_all = true
		for n in range(one.size()):
			var a = one[n]
			var b = other[n]
			if not (a == b or _same_felt(a, b)):
				are_all = false
				break
		holds = are_all
	return holds


static func _same_felt(a, b):
	if a.valence != b.valence or a.arousal != b.arousal or a.intensity != b.intensity:
		return false
	return a.id == b.id and a.start == b.start and a.end == b.end
