# A gesture's phases, as the export tells them.

const Util = preload("util.gd")


# Returns an action's phases, clip seconds; see phase_times.gd.
static func find_phases(_project, action):
	return action.phases


# Returns the seconds from an action's start to its stroke; its middle where the export says nothing.
static func lead(_project, action):
	return action.phases.stroke - action.start


# Returns how long before its stroke any gesture of a layer with these tags begins.
static func find_longest_lead(project, graph, tags):
	var out = 0.0
	for action in graph.actions.values():
		if action.kind == "gesture" and Util.has_all(action.tags, tags):
			out = Util.most(out, lead(project, action))
	return out
