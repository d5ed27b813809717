# A gesture's phases, as the export tells them.


# Returns an action's phases, clip seconds; see phase_times.gd.
static func phases(_project, action):
	return action.phases
