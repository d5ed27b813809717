# Break off, pause, resume and finish utterances. An utterance is everything that is said under one id, piece by piece, until it
# is over. Times are seconds.
#
# A paused utterance is moved to a time that never comes (`PAUSED`), each to a slot of its own.
#
# Translated from metagraph/playback/life/utterances.py; change that, and translate anew.

const Graphemes = preload("graphemes.gd")
const Items = preload("items.gd")
const LineTiming = preload("line_timing.gd")
const Track = preload("track.gd")
const Mood = preload("mood.gd")
const Util = preload("util.gd")
const PAUSED = 1000000000.0  # seconds from which on lies what is paused
const VOICE = 0.04  # seconds in which a voice can begin; more than lips look ahead
const EARLIER = 0.03  # seconds by which it can stop sooner, since a mouth takes its time to close
const FORGOTTEN = 60.0  # seconds of silence after which nothing more is awaited of what was promised to go on
const TOGETHER = 0.001  # seconds between two pieces of one utterance, at most


# Return when a voice can begin: sooner than gestures, which blend. At the very beginning it can begin at once, because nothing
# has been shown.
static func find_soon(now, lookahead):
	return now + Util.least(lookahead, VOICE) if now > 0 else 0.0


# Return whether an item with this start is paused.
static func is_paused(start):
	return start >= PAUSED


# Return whether more can be added to a piece that is not being said: more was announced, or it is paused.
static func takes_more(speech):
	return speech.more or speech.start >= PAUSED


# Return whether an utterance is not over at `now`: it is being said, will be said, is paused, or expects more.
static func goes_on(speeches, ident, now):
	var first = null
	for s in Util.backwards(speeches):
		if s.id == ident:
			first = s
			break
	var last = first
	return last != null and (last.end > now or last.more)


# Return the ids of the utterances that are not over at `now`; what: of one, "" for all.
static func find_utterances(track, what, now):
	if what != "":
		return [what] if goes_on(track.speeches, what, now) else []
	var last = {}
	for s in track.speeches:
		last[s.id] = s
	var lasting = {}
	for s in track.speeches:
		if (s.end > now or s.more) and last[s.id] == s:
			Util.add_to(lasting, s.id)
	var out = []
	for speech in track.speeches:
		if lasting.has(speech.id) and not out.has(speech.id):
			out.append(speech.id)
	return out


# Return the ids of the utterances of which more was promised, and nothing has come for `FORGOTTEN`.
static func find_forgotten(track, now):
	var silent = []
	for s in track.speeches:
		if s.more and s.end < now - FORGOTTEN:
			silent.append(s)
	var found = []
	for s in silent:
		if track.last_speech(s.id) == s:
			found.append(s.id)
	return found


# Return when the voice of an utterance stops: at the end of the current sound, at `soon` at the latest; at once if its sounds are
# unknown or it is in a pause; at its start if it has not begun. now: when gestures can stop.
static func find_stop(alphabet, track, ident, soon, now):
	var first = soon - EARLIER if now > soon else soon
	var first2 = null
	for s in track.speeches:
		if s.id == ident and s.start < first and first < s.end:
			first2 = s
			break
	var running = first2
	if running == null:
		var coming = []
		for s in track.speeches:
			if s.id == ident and s.start >= first:
				coming.append(s.start)
		return Util.least_of(coming + [PAUSED]) if coming.size() > 0 else soon
	if running.line != null and running.timing == null:
		return first
	var begin = Items.find_line_start(running)
	var said = Graphemes.spelled(alphabet, running.text, Items.measure_line(running)) if running.timing == null else LineTiming.timed_sounds(
		alphabet,
		running.timing
	)
	var ends = []
	for p in said.pieces:
		if begin + p.start < first and first < begin + p.end:
			ends.append(begin + p.end)
	return Util.least_of([soon] + [running.end] + ends) if ends.size() > 0 else first


# Return a free slot among the times that never come.
static func find_slot(track):
	var found = []
	for s in track.speeches:
		if s.start >= PAUSED:
			found.append(s.end + 1.0)
	return Util.most_of([PAUSED] + found)


# Return the track with an utterance ended at `stop`: its later pieces are not said.
static func break_off(track, ident, stop):
	var last = track.last_speech(ident)
	var speeches = []
	for speech in track.speeches:
		if speech.id != ident or speech.end <= stop:
			speeches.append(speech)
		elif speech.start < stop:
			speeches.append(Items.cut(speech, stop))
	return track if last == null else _closed(track, speeches, last, stop, true)


# Return the track with an utterance that is over once all its known pieces are said.
static func finish_speech(track, ident, soon):
	var last = track.last_speech(ident)
	return track if last == null else _closed(track, Util.list(track.speeches), last, soon, false)


# Return the track with these speeches, in which an utterance expects no more pieces. of: its last piece before. cuts: whether it
# was broken off.
static func _closed(track, speeches, of, now, cuts):
	var out = Util.list(speeches)
	var end = now
	for n in Util.backwards(range(out.size())):
		var last = out[n]
		if last.id != of.id or last.asked != of.asked:
			continue
		var held = cuts and last.length != null  # it was paused
		var silent = last.end < now and (last.more or held)
		var length = Items.measure_line(last) if (cuts and last.more) else last.length
		out[n] = Items.Speech.new(
			last.id,
			last.start,
			last.end,
			last.line,
			last.text,
			last.priority,
			length,
			last.timing,
			last.skip,
			false,
			now if silent else last.over,
			last.asked
		)
		end = Util.most(last.end, now)
		break
	var moods = []
	for m in track.moods:
		moods.append(_until(m, end) if (m.id == of.id and m.end == PAUSED) else m)
	return Track.Track.new(track.looks, Util.list(out), track.modes, track.places, track.blinks, track.stays, Util.list(moods))


static func _until(mood, end):
	return Mood.MoodFrom.new(mood.id, mood.start, mood.valence, mood.arousal, mood.intensity, end)


# Return the track with an utterance paused from `stop` on, in `slot` (`find_slot`). made: ids of requests that belong to it; they
# wait, too, if they have not begun.
static func pause(track, ident, made, stop, slot):
	var by = slot - stop
	var kept = []
	var held = []
	for speech in track.speeches:
		if speech.id != ident or speech.start >= PAUSED or speech.end <= stop:
			kept.append(speech)
		elif speech.start < stop:
			kept.append(Items.Speech.new(
				Items.cut(speech, stop).id,
				Items.cut(speech, stop).start,
				Items.cut(speech, stop).end,
				Items.cut(speech, stop).line,
				Items.cut(speech, stop).text,
				Items.cut(speech, stop).priority,
				Items.cut(speech, stop).length,
				Items.cut(speech, stop).timing,
				Items.cut(speech, stop).skip,
				false,
				Items.cut(speech, stop).over,
				Items.cut(speech, stop).asked
			))
			var skip = stop - Items.find_line_start(speech)
			held.append(Items.Speech.new(
				speech.id,
				slot,
				speech.end + by,
				speech.line,
				speech.text,
				speech.priority,
				speech.length,
				speech.timing,
				skip,
				speech.more,
				speech.over,
				speech.asked
			))
		else:
			held.append(Items.Speech.new(
				speech.id,
				speech.start + by,
				speech.end + by,
				speech.line,
				speech.text,
				speech.priority,
				speech.length,
				speech.timing,
				speech.skip,
				speech.more,
				speech.over,
				speech.asked
			))
	var last = track.last_speech(ident)
	if held.size() == 0 and last != null and last.more and last.start < PAUSED:
		held.append(Items.Speech.new(ident, slot, slot, null, "", last.priority, null, null, 0.0, true, null, last.asked))
	if held.size() == 0:
		return track
	var moods = []
	for m in track.moods:
		moods.append(_until(m, PAUSED) if (m.id == ident and m.start < stop and m.end > stop) else m)
	var left = Track.Track.new(
		track.looks,
		Util.list(kept),
		track.modes,
		track.places,
		track.blinks,
		track.stays,
		Util.list(moods)
	)
	return _moved(left, held, made, stop, PAUSED, by)


# Return the track with an utterance that continues at `soon`. made: as for `pause`.
static func resume(track, ident, made, soon):
	var held = []
	for s in track.speeches:
		if s.id == ident and s.start >= PAUSED:
			held.append(s)
	if held.size() == 0:
		return track
	var by = soon - held[0].start
	var kept = []
	for s in track.speeches:
		if s.id != ident or s.start < PAUSED:
			kept.append(s)
	var on = []
	for s in held:
		if s.end > s.start:
			on.append(Items.Speech.new(
				s.id,
				s.start + by,
				s.end + by,
				s.line,
				s.text,
				s.priority,
				s.length,
				s.timing,
				s.skip,
				s.more,
				s.over,
				s.asked
			))
	var end = PAUSED if held[-1].more else held[-1].end + by
	var moods = []
	for m in track.moods:
		moods.append(_until(m, end) if (m.id == ident and m.end == PAUSED) else m)
	var left = Track.Track.new(
		track.looks,
		Util.list(kept),
		track.modes,
		track.places,
		track.blinks,
		track.stays,
		Util.list(moods)
	)
	if on.size() == 0:  # it had fallen silent when it was paused
		left = left if held[-1].more else finish_speech(left, ident, soon)
	return _moved(left, on, made, PAUSED, INF, by)


# Return the track with more speeches, and with the looks and moods of `made` that begin from `low` to before `high` moved by a
# number of seconds.
static func _moved(track, speeches, made, low, high, by):
	var looks = []
	for x in track.looks:
		if made.has(x.id) and low <= x.start and x.start < high:
			looks.append(Items.LookAt.new(x.id, x.start + by, x.end + by, x.to, x.amount, x.strict, x.priority))
	var moods = []
	for m in track.moods:
		if made.has(m.id) and low <= m.start and m.start < high:
			moods.append(Mood.MoodFrom.new(m.id, m.start + by, m.valence, m.arousal, m.intensity, m.end + by))
	var gone = {}
	for x2 in looks:
		Util.add_to(gone, x2.id)
	var over = {}
	for m2 in moods:
		Util.add_to(over, m2.id)
	var found = []
	for x3 in track.looks:
		if not gone.has(x3.id) or x3.start < low or x3.start >= high:
			found.append(x3)
	var found2 = []
	for m3 in track.moods:
		if not over.has(m3.id) or m3.start < low or m3.start >= high:
			found2.append(m3)
	var left = Track.Track.new(found, track.speeches, track.modes, track.places, track.blinks, track.stays, found2)
	return left.joined(Track.Track.new(Util.list(looks), Util.list(speeches), [], [], [], [], Util.list(moods)))


# Return why an utterance is over at the end of a piece: "finished", "interrupted" or "replaced"; "" if it is not over there.
static func explain_end(speeches, speech):
	var first = null
	for s in speeches:
		if s.id == speech.id and s.start > speech.start:
			first = s
			break
	var coming = first
	if coming != null and coming.asked == speech.asked:
		return ""
	if speech.more:
		return "" if coming == null else "replaced"
	if speech.length == null:
		return "finished"
	return "interrupted" if (coming == null or coming.start > speech.end + TOGETHER) else "replaced"
