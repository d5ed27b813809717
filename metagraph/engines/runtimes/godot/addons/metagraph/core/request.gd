# A request: what is asked of a layer, by an agent or by a model.

const MetaPlan = preload("meta_plan.gd")


# Returns one. more {field: value}: action, stance: ids; stroke, hold, duration: seconds or null.
static func make(ident, layer, kind, start, more):
	var out = MetaPlan.MetaRequest.new(ident, layer, kind, float(start))
	for name in more:
		out.set(name, more[name])
	return out
