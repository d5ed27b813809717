# How a running action is left early: for a request that can then be in time, or because it was stopped.
#
# Translated from metagraph/playback/planning/leaving.py; change that, and translate anew.

const MetaPlan = preload("meta_plan.gd")
const Bounds = preload("bounds.gd")
const CueShapes = preload("cue_shapes.gd")
const Punctuality = preload("punctuality.gd")
const Util = preload("util.gd")


# Leave the running action early for the first request that can then be in time, or if it was `stopped`. An action that a model
# wrote, or that is less important, is left at once; others are left where their retraction begins.
static func make_way(state, running, asked, now, stopped):
	if stopped:
		retract(state, now)
		return
	var cue = state.cues[-1]
	if running == null or cue.action.kind == "transition" or cue.end - cue.blend_out <= now:
		return
	var at_once = now + Util.most(cue.blend_out, CueShapes.RETRACTION)
	var retracts = at_once
	if not running.written:
		var once = cue.end - cue.start
		if cue.repeats:
			once = Util.least(once, (cue.cycle_to - cue.entry) / cue.tempo + Util.most(cue.blend_out, CueShapes.RETRACTION))
		var shape = CueShapes.CueShape.new(
			cue.start,
			cue.entry,
			cue.end - cue.start,
			once,
			cue.hold_from,
			cue.hold_to,
			cue.hold,
			cue.tempo
		)
		retracts = Util.most(at_once, cue.start + CueShapes.hurried(state.project, cue.action, shape))
	var rest = state.project.settings.rest
	for meta in asked:
		var request = meta.request
		var in_time = Punctuality.find_latest(state, request) + CueShapes.slack_of(request)
		var soonest = at_once if meta.rank > running.rank else retracts
		if request.late == null or meta.rank < running.rank or in_time < soonest + rest - CueShapes.FITS:
			continue
		var end = Util.most(soonest, Bounds.begins(meta) - rest)
		if end < cue.end:
			var out = Util.most(cue.blend_out, CueShapes.RETRACTION)
			var into = Util.least(cue.blend_in, Util.most(0.0, end - out - cue.start))
			state.cues[-1] = MetaPlan.Cue.new(
				cue.action,
				cue.start,
				end,
				cue.entry,
				into,
				out,
				cue.stance,
				cue.then,
				cue.meta,
				cue.hold_from,
				cue.hold_to,
				cue.hold,
				cue.extent,
				cue.tempo,
				cue.cycle_from,
				cue.cycle_to
			)
			state.free_ = end
			state.ended[cue.action.id] = end
		return


# Leave the running action: it returns to its stance from where it is. A transition ends in the stance it leads to.
static func retract(state, now):
	var cue = state.cues[-1]
	var end = now + CueShapes.STOPPED
	if cue.action.kind == "transition" or cue.end - cue.blend_out <= now or cue.end <= end:
		return
	state.cues[-1] = MetaPlan.Cue.new(
		cue.action,
		cue.start,
		end,
		cue.entry,
		cue.blend_in,
		CueShapes.STOPPED,
		cue.stance,
		cue.then,
		cue.meta,
		cue.hold_from,
		cue.hold_to,
		cue.hold,
		cue.extent,
		cue.tempo,
		cue.cycle_from,
		cue.cycle_to
	)
	state.free_ = end
	state.ended[cue.action.id] = end
