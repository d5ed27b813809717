# The meaning of asks: requests of the layers, and lasting items (Borer et al., section 6 and figure 5).
#
# Translated from metagraph/playback/planning/meaning.py; change that, and translate anew.

const Repeating = preload("repeating.gd")
const Graphemes = preload("graphemes.gd")
const Items = preload("items.gd")
const LineTiming = preload("line_timing.gd")
const Spots = preload("spots.gd")
const Track = preload("track.gd")
const MetaPlan = preload("meta_plan.gd")
const Finding = preload("finding.gd")
const Mood = preload("mood.gd")
const Phases = preload("phases.gd")
const Util = preload("util.gd")
const FOREVER = 1000000000.0  # seconds; a look that lasts until the next


# An ask with the fields of all kinds of asks; `do` says which of them count. line: id; said: that line, None if there is none.
# text: the words, or a block of BML. timing: the times of its words and shapes.
class PlainAsk:
	var do
	var id
	var at
	var priority
	var layer
	var tags
	var limb
	var duration
	var stroke
	var hold
	var late
	var valence
	var arousal
	var intensity
	var prepare
	var resume
	var stay
	var action
	var stance
	var to
	var amount
	var strict
	var line
	var said
	var text
	var gestures
	var timing
	var mode
	var name
	var point
	var what
	var more

	func _init(
		do_,
		id_ = "",
		at_ = null,
		priority_ = MetaPlan.ASKED,
		layer_ = null,
		tags_ = null,
		limb_ = null,
		duration_ = null,
		stroke_ = null,
		hold_ = null,
		late_ = null,
		valence_ = null,
		arousal_ = null,
		intensity_ = null,
		prepare_ = true,
		resume_ = false,
		stay_ = false,
		action_ = "",
		stance_ = "",
		to_ = null,
		amount_ = 1.0,
		strict_ = false,
		line_ = null,
		said_ = null,
		text_ = "",
		gestures_ = true,
		timing_ = null,
		mode_ = null,
		name_ = "",
		point_ = null,
		what_ = "",
		more_ = false
	):
		self.do = do_
		self.id = id_
		self.at = at_
		self.priority = priority_
		self.layer = layer_
		self.tags = tags_ if tags_ != null else []
		self.limb = limb_
		self.duration = duration_
		self.stroke = stroke_
		self.hold = hold_
		self.late = late_
		self.valence = valence_
		self.arousal = arousal_
		self.intensity = intensity_
		self.prepare = prepare_
		self.resume = resume_
		self.stay = stay_
		self.action = action_
		self.stance = stance_
		self.to = to_
		self.amount = amount_
		self.strict = strict_
		self.line = line_
		self.said = said_
		self.text = text_
		self.gestures = gestures_
		self.timing = timing_
		self.mode = mode_
		self.name = name_
		self.point = point_ if point_ != null else []
		self.what = what_
		self.more = more_


# A line of dialogue. seconds: its length, None if unknown. asks: its own requests, in seconds from its start. valence, arousal,
# intensity: of the mood it is said in.
class SaidLine:
	var text
	var seconds
	var asks
	var valence
	var arousal
	var intensity

	func _init(text_ = "", seconds_ = null, asks_ = null, valence_ = null, arousal_ = null, intensity_ = null):
		self.text = text_
		self.seconds = seconds_
		self.asks = asks_ if asks_ != null else []
		self.valence = valence_
		self.arousal = arousal_
		self.intensity = intensity_


# A requested block of BML: its behaviours become asks `<id>.1`, `<id>.2`, ...
class AskedBlock:
	var id
	var at
	var priority
	var text

	func _init(id_, at_, priority_, text_):
		self.id = id_
		self.at = at_
		self.priority = priority_
		self.text = text_


# An ask that steers speech. do: "interrupt", "pause", "resume" or "finish". what: the id of the speech, "" for all speech.
class SteeringAsk:
	var do
	var id
	var what
	var priority

	func _init(do_, id_, what_, priority_):
		self.do = do_
		self.id = id_
		self.what = what_
		self.priority = priority_


# The meaning of asks, so far. graphs: of the layers, in their order. withdrawn: ids taken back; "" stands for all. steered: the
# asks that steer speech, in order. unknown: the kind of thing that an ask names and that does not exist: "action", "stance" or
# "line". Speeches may overlap. fixed: the earliest second at which a gesture of a line can begin; the line itself may begin
# earlier.
class Meaning:
	var project
	var graphs
	var alphabet
	var requests
	var looks
	var speeches
	var modes
	var places
	var blinks
	var stays
	var moods
	var blocks
	var withdrawn
	var steered
	var refused
	var unknown
	var fixed

	func _init(
		project_,
		graphs_,
		alphabet_,
		requests_ = null,
		looks_ = null,
		speeches_ = null,
		modes_ = null,
		places_ = null,
		blinks_ = null,
		stays_ = null,
		moods_ = null,
		blocks_ = null,
		withdrawn_ = null,
		steered_ = null,
		refused_ = null,
		unknown_ = "",
		fixed_ = 0.0
	):
		self.project = project_
		self.graphs = graphs_
		self.alphabet = alphabet_
		self.requests = requests_ if requests_ != null else []
		self.looks = looks_ if looks_ != null else []
		self.speeches = speeches_ if speeches_ != null else []
		self.modes = modes_ if modes_ != null else []
		self.places = places_ if places_ != null else []
		self.blinks = blinks_ if blinks_ != null else []
		self.stays = stays_ if stays_ != null else []
		self.moods = moods_ if moods_ != null else []
		self.blocks = blocks_ if blocks_ != null else []
		self.withdrawn = withdrawn_ if withdrawn_ != null else {}
		self.steered = steered_ if steered_ != null else []
		self.refused = refused_ if refused_ != null else []
		self.unknown = unknown_
		self.fixed = fixed_

	# Return the track of lasting items.
	func track():
		return Track.Track.new(
			Util.list(self.looks),
			Util.list(self.speeches),
			Util.list(self.modes),
			Util.list(self.places),
			Util.list(self.blinks),
			Util.list(self.stays),
			Util.list(self.moods)
		)

	# Add the meaning of other asks.
	func take(other):
		Util.extend(self.requests, other.requests)
		Util.extend(self.looks, other.looks)
		Util.extend(self.speeches, other.speeches)
		Util.extend(self.modes, other.modes)
		Util.extend(self.places, other.places)
		Util.extend(self.blinks, other.blinks)
		Util.extend(self.stays, other.stays)
		Util.extend(self.moods, other.moods)
		Util.extend(self.blocks, other.blocks)
		Util.extend(self.steered, other.steered)
		for ident in other.withdrawn:
			Util.add_to(self.withdrawn, ident)

	# Report that an ask was not understood.
	func refuse(ident, why, layer, at):
		self.refused.append(MetaPlan.Report.new(ident, "not-understood", why, "arms" if layer == null else layer, at))

	# Return a layer's graph.
	func graph_of(layer):
		var first = null
		for graph in self.graphs:
			if graph.layer == layer:
				first = graph
				break
		return first

	# Add the meaning of an ask; return why it has none, "" if it has one. ident, at, priority: its own, or as the line changed
	# them that it belongs to. shift: the second at which that line begins, else 0.
	func add(ask, ident, at, priority, shift):
		var where = "" if ask.layer == null else " in the %s layer" % [ask.layer]
		var stroke = null if ask.stroke == null else ask.stroke + shift
		var start = at
		if ask.do == "gesture" or ask.do == "fidget":
			var kind = "gesture" if ask.do == "gesture" else "fidget"
			var layer = "arms" if ask.layer == null else ask.layer
			if stroke != null:
				start = Util.most(0.0, stroke - Phases.find_longest_lead(self.project, self.graph_of(layer), ask.tags))
			var request = MetaPlan.MetaRequest.new(
				ident,
				layer,
				kind,
				start,
				ask.duration,
				null,
				ask.tags,
				ask.limb,
				null,
				priority,
				ask.resume,
				stroke,
				ask.hold,
				ask.prepare,
				[],
				ask.late,
				ask.valence,
				ask.arousal,
				ask.intensity
			)
			self.requests.append(request)
		elif ask.do == "action":
			var action = Finding.action_called(self.graphs, ask.action, ask.layer)
			if action == null:
				self.unknown = "action"
				return "there is no action '%s'%s" % [ask.action, where]
			if stroke != null:
				start = Util.most(0.0, stroke - Phases.lead(self.project, action))
			var both = self.project.span(action)
			var begins = both[0]
			var ends = both[1]
			var repeats = Repeating.cycle_of(action.kind, action.timing, begins, ends) > 0
			var duration = ask.duration if repeats else null
			var request = MetaPlan.MetaRequest.new(
				ident,
				action.layer,
				action.kind,
				start,
				duration,
				action.id,
				[],
				null,
				null,
				priority,
				false,
				stroke,
				ask.hold,
				ask.prepare,
				[],
				ask.late,
				ask.valence,
				ask.arousal,
				ask.intensity
			)
			self.requests.append(request)
		elif ask.do == "stance":
			var stance = Finding.stance_called(self.graphs, ask.stance, ask.layer)
			if stance == null:
				self.unknown = "stance"
				return "there is no stance '%s'%s" % [ask.stance, where]
			self.requests.append(MetaPlan.MetaRequest.new(
				ident,
				stance.layer,
				"transition",
				at,
				null,
				null,
				[],
				null,
				stance.id,
				priority,
				false,
				null,
				null,
				true,
				[],
				ask.late
			))
			self.stays.append(Items.StayFrom.new(ident, at, stance.layer, ask.stay))
		elif ask.do == "change":
			# Whichever arm was seen to move: stances are joined by few transitions, and mostly of both.
			var layer = "arms" if ask.layer == null else ask.layer
			self.requests.append(MetaPlan.MetaRequest.new(
				ident,
				layer,
				"transition",
				at,
				null,
				null,
				[],
				null,
				null,
				priority,
				false,
				null,
				null,
				true,
				[],
				ask.late
			))
		elif ask.do == "nod" or ask.do == "shake":
			return self.head(ask, ident, at, priority)
		elif ask.do == "look":
			var end = FOREVER if ask.duration == null else at + ask.duration
			var to = Spots.named("user") if ask.to == null else ask.to
			self.looks.append(Items.LookAt.new(ident, at, end, to, ask.amount, ask.strict, priority))
		elif ask.do == "blink":
			self.blinks.append(Items.BlinkAt.new(ident, at))
		elif ask.do == "mood":
			var until = INF if ask.duration == null else at + ask.duration
			self.moods.append(Mood.MoodFrom.new(ident, at, ask.valence, ask.arousal, ask.intensity, until))
		elif ask.do == "mode":
			self.modes.append(Items.ModeFrom.new(ident, at, ask.mode))
		elif ask.do == "place":
			self.places.append(Items.PlaceFrom.new(ident, at, ask.name, ask.point))
		elif ask.do == "withdraw":
			Util.add_to(self.withdrawn, ask.what)
		elif ask.do == "interrupt" or ask.do == "pause" or ask.do == "resume" or ask.do == "finish":
			self.steered.append(SteeringAsk.new(ask.do, ident, ask.what, priority))
		elif ask.do == "say":
			return self.say(ask, ident, at, priority)
		elif ask.do == "bml":
			self.blocks.append(AskedBlock.new(ident, at, priority, ask.text))
		else:
			return "nothing is known of '%s'" % [ask.do]
		return ""

	# Nods are gestures with that tag; if there is none, the likeliest one with that name, whatever stance it needs.
	func head(ask, ident, at, priority):
		var gestures = []
		for x in self.graph_of("head").actions.values():
			var holds = x.kind == "gesture"
			if holds:
				var are_all = true
				for tag in ask.tags:
					if not x.tags.has(tag):
						are_all = false
						break
				holds = are_all
			if holds:
				gestures.append(x)
		var tags = []
		var called = []
		var is_any = false
		for x in gestures:
			if x.tags.has(ask.do):
				is_any = true
				break
		if is_any:
			tags = [ask.do] + ask.tags
		else:
			var found = []
			for x in gestures:
				if x.name.to_lower().find(ask.do) >= 0:
					found.append(x.id)
			called = found
			if called.size() == 0:
				var told = " with the tags %s" % [Util.joined(ask.tags, ", ")] if ask.tags.size() > 0 else ""
				return "the head layer has no gesture tagged or called '%s'%s" % [ask.do, told]
		self.requests.append(MetaPlan.MetaRequest.new(
			ident,
			"head",
			"gesture",
			at,
			null,
			null,
			tags,
			null,
			null,
			priority,
			false,
			null,
			null,
			true,
			Util.list(called),
			ask.late,
			ask.valence,
			ask.arousal,
			ask.intensity
		))
		return ""

	# Say a line, with its own requests, or other words.
	func say(ask, ident, at, priority):
		var line = ask.said
		if ask.line != null and line == null:
			self.unknown = "line"
			return "there is no line '%s'" % [ask.line]
		var text = ask.text
		if text == "" and line != null:
			text = line.text
		if text == "" and line == null and ask.timing != null:
			text = LineTiming.told_text(ask.timing)
		if line == null and text == "" and ask.timing == null:
			return "say what: a line's id, text, or words with their times"
		var timing = ask.timing
		if timing == null and line == null and ask.more and ask.duration != null:
			timing = LineTiming.pace_text(self.alphabet, text, ask.duration)
		var length
		if timing != null:
			length = LineTiming.timed_seconds(timing, ask.duration)
		elif ask.duration != null:
			length = Util.most(ask.duration, 0.0)
		elif line != null and line.seconds != null:
			length = line.seconds
		else:
			length = Graphemes.read_aloud(self.alphabet, text)
		self.speeches.append(Items.Speech.new(ident, at, at + length, ask.line, text, priority, null, timing, 0.0, ask.more))
		var told = ask.valence != null or line == null
		var valence = ask.valence if (told or line == null) else line.valence
		var arousal = ask.arousal if (told or line == null) else line.arousal
		var intensity = line.intensity if (ask.intensity == null and line != null) else ask.intensity
		if valence != null or intensity != null:
			self.moods.append(Mood.MoodFrom.new(ident, at, valence, arousal, intensity, at + length))
		if line == null or not ask.gestures:
			return ""
		for n in range(line.asks.size()):
			var inner = line.asks[n]
			if inner.do == "say":
				return "a line would say another line; its asks may not"
			var begins = at if inner.at == null else at + inner.at
			if ask.at == null:
				begins = Util.most(begins, self.fixed)
			var why = self.add(inner, "%s.%d" % [ident, n + 1], begins, Util.most(inner.priority, priority), at)
			if why != "":
				return why
		return ""


# Add the meaning of an ask, or refuse all of it. now: when it begins if it does not say; soon: the same for speech.
static func understood(whole, ask, now, soon):
	var one = Meaning.new(whole.project, whole.graphs, whole.alphabet, [], [], [], [], [], [], [], [], [], {}, [], [], "", now)
	var at = (soon if ask.do == "say" else now) if ask.at == null else ask.at
	var why = one.add(ask, ask.id, at, ask.priority, 0.0)
	if why == "":
		whole.take(one)
	else:
		whole.refuse(ask.id, why, ask.layer, at)
