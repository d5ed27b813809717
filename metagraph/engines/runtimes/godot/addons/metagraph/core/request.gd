# A request: what is asked of a layer, by an agent or by a model.


# Returns one. action, stance: ids; stroke, hold, duration: seconds or null.
static func make(ident, layer, kind, start, more):
	var out = {
		id = ident, layer = layer, kind = kind, start = float(start), duration = null, action = null, tags = [], limb = null,
		stance = null, priority = 1, resume = false, stroke = null, hold = null, prepare = true, among = []
	}
	for name in more:
		out[name] = more[name]
	return out
