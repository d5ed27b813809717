# One layer while it is planned: what it may draw on, and what it has played so far.
#
# Translated from metagraph/playback/planning/layer_state.py; change that, and translate anew.

const MetaPlan = preload("meta_plan.gd")
const Director = preload("director.gd")
const Remembering = preload("remembering.gd")
const Util = preload("util.gd")


# One layer being planned, cue after cue. It changes while planning, and never leaves the planner.
#
# moods: the mood over time. track: what lasts, such as the mode. free: when the next action may begin. acted: when the last
# action ended. uses: how often each action was used. recent: the last draws of each `node`. ended: when each action ended. begun:
# keys of meta actions whose chain of transitions already plays. served: keys of those that the action of another one serves, too.
# candidates: the actions of each `node` that may be drawn, for the nodes needed so far. prominences: of actions, as far as
# needed. model: the one that wrote what was not requested, None if there is none. beats: seconds after which a gesture that
# hardly shows may be done again.
class LayerState:
	var project
	var graph
	var seed_
	var stance
	var moods
	var track
	var free_
	var acted
	var uses
	var recent
	var ended
	var cues
	var rests
	var reports
	var begun
	var served
	var candidates
	var prominences
	var model
	var beats

	func _init(
		project_,
		graph_,
		seed_,
		stance_,
		moods_,
		track_,
		free_ = 0.0,
		acted_ = 0.0,
		uses_ = null,
		recent_ = null,
		ended_ = null,
		cues_ = null,
		rests_ = null,
		reports_ = null,
		begun_ = null,
		served_ = null,
		candidates_ = null,
		prominences_ = null,
		model_ = null,
		beats_ = Director.LEAST_BEATS
	):
		self.project = project_
		self.graph = graph_
		self.seed_ = seed_
		self.stance = stance_
		self.moods = moods_
		self.track = track_
		self.free_ = free_
		self.acted = acted_
		self.uses = uses_ if uses_ != null else {}
		self.recent = recent_ if recent_ != null else {}
		self.ended = ended_ if ended_ != null else {}
		self.cues = cues_ if cues_ != null else []
		self.rests = rests_ if rests_ != null else []
		self.reports = reports_ if reports_ != null else []
		self.begun = begun_ if begun_ != null else {}
		self.served = served_ if served_ != null else {}
		self.candidates = candidates_ if candidates_ != null else {}
		self.prominences = prominences_ if prominences_ != null else {}
		self.model = model_
		self.beats = beats_

	# Note that a cue is played.
	func note(cue, then):
		self.cues.append(cue)
		self.free_ = cue.end
		self.acted = cue.end
		self.stance = then
		Remembering.remember(cue, self.uses, self.recent, self.ended)

	# The earliest time at which the next action may begin.
	func ready():
		return self.free_ + (self.project.settings.rest if self.ended.size() > 0 else 0.0)

	# Return when the stance was last changed; minus infinity for never.
	func moved():
		var latest = -INF
		for ident in self.ended:
			var end = self.ended[ident]
			var action = self.graph.actions.get(ident)
			if action != null and action.kind == "transition":
				latest = Util.most(latest, end)
		return latest

	func tell(meta, outcome, message, played = false, late = 0.0, by = ""):
		var layer = self.graph.layer
		self.reports.append(MetaPlan.Report.new(
			meta.request.id,
			outcome,
			message,
			layer,
			meta.start,
			played,
			meta.written,
			late,
			by
		))
