# Notice when what is said begins and ends, from one moment to the next.
#
# Translated from metagraph/playback/life/speech_watch.py; change that, and translate anew.

const Utterances = preload("utterances.gd")
const Util = preload("util.gd")


# A piece of something said that begins or ends. kind: "begin" or "end". at: seconds. said: the line's id, or the text. reason:
# why the whole utterance is over; "" at a beginning, and where more of it comes.
class SpeechEvent:
	var kind
	var at
	var id
	var said
	var reason

	func _init(kind_, at_, id_, said_, reason_):
		self.kind = kind_
		self.at = at_
		self.id = id_
		self.said = said_
		self.reason = reason_


# Notices what is said, and the end of each utterance once. lasting: the last known piece of each utterance that has begun and is
# not over.
class SpeechWatch:
	var lasting

	func _init(lasting_ = null):
		self.lasting = lasting_ if lasting_ != null else []

	# Return what began and ended after `seen`, until `now`, seconds. speeches: all that are said, by start.
	func watch(speeches, seen, now):
		var out = []
		for speech in speeches:
			if speech.end <= seen or speech.start > now:
				continue
			self._follow(speech)
			if speech.start > seen:
				out.append(self._note("begin", speech, speech.start, ""))
			if speech.end <= now and (speech.over != null or Utterances.explain_end(speeches, speech) == ""):
				out.append(self._note("end", speech, speech.end, ""))
		var lasting = []
		for one in self.lasting:
			var last = self._find_last(speeches, one)
			if last == null:  # something else took its place before it could go on
				out.append(self._note("end", one, now, "replaced"))
				continue
			var reason = Utterances.explain_end(speeches, last)
			var until = last.end if last.over == null else Util.most(last.end, last.over)
			if reason == "" or until > now:
				lasting.append(last)
			else:
				out.append(self._note("end", last, until if until > seen else now, reason))
		self.lasting = lasting
		return out

	# Take note that an utterance has begun, or goes on.
	func _follow(speech):
		for one in self.lasting:
			if one.id == speech.id and one.asked == speech.asked:
				return
		self.lasting.append(speech)

	func _note(kind, speech, at, reason):
		var said = speech.text if speech.line == null else speech.line
		return SpeechEvent.new(kind, at, speech.id, said, reason)

	# Return the last piece of the utterance that a piece belongs to; None if none is left.
	func _find_last(speeches, one):
		var last = null
		for speech in speeches:
			if speech.id == one.id and speech.asked == one.asked:
				last = speech
		return last
