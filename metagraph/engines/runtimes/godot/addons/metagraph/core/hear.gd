# Performing what is asked while it comes in.

const Util = preload("util.gd")
const Hearing = preload("hearing.gd")
const Planner = preload("planner.gd")
const Understand = preload("understand.gd")
const Utterances = preload("utterances.gd")


# Returns the plan with asks worked in that became known at `now`, and the horizon moved to `end`. What begins before now + the
# settings' lookahead stays as it was, but at the very beginning, when nothing has been shown; voices begin and stop
# sooner. Asks are as Asks.read returns them and have ids; of two with one id the later counts.
static func hear(graph, plan, now, asks, end, stances, idle):
	var fixed = now + graph.settings.lookahead if now > 0 else 0.0
	var soon = Utterances.find_soon(now, graph.settings.lookahead)
	var meant = Understand.understand(graph, asks, fixed, soon)
	var turning = []
	for layer in Util.LAYERS:
		if graph.layers[layer].markov.modes.size() > 0:
			turning.append(layer)
	var heard = Hearing.heard(plan.requests, plan.track, meant, now, fixed, soon, turning)
	var leave = []
	if asks.size() > 0 and now > 0 and end == plan.end:
		for layer in Util.LAYERS:
			if not heard.touched.has(layer):
				leave.append(layer)
	plan = Util.but(plan, {track = heard.track})
	var after = Planner.extend_plan(graph, plan, fixed, heard.fresh, end, stances, idle, heard.withdrawn, leave, heard.stopped)
	after.reports += meant.refused
	return after
