# Requests, meta actions and plans: what the planner takes and returns. All are values; times are seconds.
#
# Translated from metagraph/playback/plan.py; change that, and translate anew.

const ASKED = 1  # default priority of a request
const WRITTEN = 0  # priority of what the Markov model writes


# A request of an agent or animator, at any level of abstraction.
#
# id: unique; it keys the random draws. start: seconds. duration: how long the activity should last, None for one action. action:
# id of a specific action. tags: all of them must be on the action. limb: which arm. stance: id of the stance to go to (kind
# "transition"). priority: higher wins. resume: whether the remainder plays afterwards if a more important request cuts it.
# stroke: when a gesture's stroke should come; `start` is then the earliest it may begin. hold: seconds that its hold should last,
# None for its length in the clip. prepare: whether its preparation plays. among: ids of the only actions it may be; empty for
# any. late: by how many seconds its stroke may come late, or its start if it has no stroke; 0 for on time or not at all, None for
# as late as the settings allow. valence, arousal, intensity: the mood it is played in, as in `mood.Mood`; None for the mood at
# that time.
class MetaRequest:
	var id
	var layer
	var kind
	var start
	var duration
	var action
	var tags
	var limb
	var stance
	var priority
	var resume
	var stroke
	var hold
	var prepare
	var among
	var late
	var valence
	var arousal
	var intensity

	func _init(
		id_,
		layer_,
		kind_,
		start_,
		duration_ = null,
		action_ = null,
		tags_ = null,
		limb_ = null,
		stance_ = null,
		priority_ = ASKED,
		resume_ = false,
		stroke_ = null,
		hold_ = null,
		prepare_ = true,
		among_ = null,
		late_ = null,
		valence_ = null,
		arousal_ = null,
		intensity_ = null
	):
		self.id = id_
		self.layer = layer_
		self.kind = kind_
		self.start = start_
		self.duration = duration_
		self.action = action_
		self.tags = tags_ if tags_ != null else []
		self.limb = limb_
		self.stance = stance_
		self.priority = priority_
		self.resume = resume_
		self.stroke = stroke_
		self.hold = hold_
		self.prepare = prepare_
		self.among = among_ if among_ != null else []
		self.late = late_
		self.valence = valence_
		self.arousal = arousal_
		self.intensity = intensity_


# Where writing continues: before meta action `number`, after state number `state` (-1: none yet), which ended at `time` seconds.
class Cursor:
	var number
	var state
	var time

	func _init(number_ = 0, state_ = -1, time_ = 0.0):
		self.number = number_
		self.state = state_
		self.time = time_


# A request placed in time: `start`..`end` is the window it may use. written: whether the Markov model wrote it, instead of a
# request. part: 0 for the request itself, n for its n-th remainder after a cut.
class MetaAction:
	var request
	var start
	var end
	var part
	var written
	var rank  # Its importance: its request's priority. What a model wrote gives way to all requests.
	var key  # The key of this meta action's random draws.

	func _init(request_, start_, end_, part_ = 0, written_ = false):
		self.request = request_
		self.start = start_
		self.end = end_
		self.part = part_
		self.written = written_
		self.rank = -INF if self.written else float(self.request.priority)
		self.key = self.request.id if self.part == 0 else "%s+%d" % [self.request.id, self.part]


# One action in the plan. It plays its clip from `entry` on during `start`..`end`, at `tempo` times its own speed but for its
# hold.
#
# hold_from, hold_to: clip seconds of the hold, which takes `hold` seconds; 0, 0, 0 if it is not stretched. blend_in, blend_out:
# seconds, fitting inside the cue. stance: before it; then: the stance it leaves the layer in. meta: key of the meta action it
# realises. extent: how large it is played, a factor of its turns away from the stance. cycle_from, cycle_to: clip seconds between
# which it repeats; 0, 0 if it plays once.
class Cue:
	var action
	var start
	var end
	var entry
	var blend_in
	var blend_out
	var stance
	var then
	var meta
	var hold_from
	var hold_to
	var hold
	var extent
	var tempo
	var cycle_from
	var cycle_to
	var repeats  # Whether it repeats a cycle.

	func _init(
		action_,
		start_,
		end_,
		entry_,
		blend_in_,
		blend_out_,
		stance_,
		then_,
		meta_,
		hold_from_ = 0.0,
		hold_to_ = 0.0,
		hold_ = 0.0,
		extent_ = 1.0,
		tempo_ = 1.0,
		cycle_from_ = 0.0,
		cycle_to_ = 0.0
	):
		self.action = action_
		self.start = start_
		self.end = end_
		self.entry = entry_
		self.blend_in = blend_in_
		self.blend_out = blend_out_
		self.stance = stance_
		self.then = then_
		self.meta = meta_
		self.hold_from = hold_from_
		self.hold_to = hold_to_
		self.hold = hold_
		self.extent = extent_
		self.tempo = tempo_
		self.cycle_from = cycle_from_
		self.cycle_to = cycle_to_
		self.repeats = self.cycle_to > self.cycle_from


# The stance loop that lies under the cues from `start` on: loop seconds are `time - start`, wrapped.
#
# fade_start, fade: when and for how many seconds it takes over from the loop before.
class Rest:
	var stance
	var action
	var start
	var fade_start
	var fade

	func _init(stance_, action_, start_, fade_start_, fade_):
		self.stance = stance_
		self.action = action_
		self.start = start_
		self.fade_start = fade_start_
		self.fade = fade_
const TEMPORAL = {"late": true, "cut": true, "resumed": true, "past": true}  # told by temporal replanning, once


# The result of a meta action that does not play exactly as requested. played: whether a part of it still plays. late: by how many
# seconds it comes late, or would have come, if it said how late it may. by: key of the meta action whose action serves it, too.
class Report:
	var request
	var outcome
	var message
	var layer
	var at
	var played
	var written
	var late
	var by

	func _init(request_, outcome_, message_, layer_, at_, played_ = false, written_ = false, late_ = 0.0, by_ = ""):
		self.request = request_
		self.outcome = outcome_
		self.message = message_
		self.layer = layer_
		self.at = at_
		self.played = played_
		self.written = written_
		self.late = late_
		self.by = by_


# What further planning needs from forgotten cues. free: when the last one ended; stance: in which stance. uses: how often each
# action was used. recent: the actions used last, by `remembering.node`, the latest at the end. ended: when each ended last.
class Past:
	var free_
	var stance
	var uses
	var recent
	var ended

	func _init(free_ = 0.0, stance_ = "", uses_ = null, recent_ = null, ended_ = null):
		self.free_ = free_
		self.stance = stance_
		self.uses = uses_ if uses_ != null else {}
		self.recent = recent_ if recent_ != null else {}
		self.ended = ended_ if ended_ != null else {}


# cues never overlap and ascend; rests ascend by fade_start, the first covering everything before.
#
# past: what came before the first cue, if that was forgotten. cursor: where the Markov model continues to write. written: what it
# wrote for later, unchanged: each extension fits it in again, so that it does not matter when it was written.
class LayerPlan:
	var layer
	var metas
	var cues
	var rests
	var past
	var cursor
	var written

	func _init(layer_, metas_ = null, cues_ = null, rests_ = null, past_ = null, cursor_ = null, written_ = null):
		self.layer = layer_
		self.metas = metas_ if metas_ != null else []
		self.cues = cues_ if cues_ != null else []
		self.rests = rests_ if rests_ != null else []
		self.past = past_ if past_ != null else Past.new()
		self.cursor = cursor_ if cursor_ != null else Cursor.new()
		self.written = written_ if written_ != null else []
