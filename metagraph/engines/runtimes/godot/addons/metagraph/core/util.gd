# Small things that lists and records need everywhere. Records are dictionaries and are never changed once made: `but` copies.

const LAYERS = ["body", "arms", "head"]


# Returns the smaller of two numbers. Godot 3's own min and max round to 32 bits.
static func least(a, b):
	return a if a < b else b


# Returns the larger of two numbers.
static func most(a, b):
	return b if a < b else a


# Returns a number kept between two.
static func within(x, low, high):
	return low if x < low else (high if x > high else x)


# Returns a copy of a record with fields changed.
static func but(record, changes):
	var out = record.duplicate()
	for name in changes:
		out[name] = changes[name]
	return out


# Returns items from place `first` to before `last`; negative places count from the end, those beyond are the ends.
static func part(items, first, last):
	var count = items.size()
	var out = []
	for n in range(within(first + count if first < 0 else first, 0, count), within(last + count if last < 0 else last, 0, count)):
		out.append(items[n])
	return out


# Returns the place behind all items whose field is at most `value`; items ascend by it.
static func after(items, field, value):
	var low = 0
	var high = items.size()
	while low < high:
		var middle = (low + high) >> 1
		if value < items[middle][field]:
			high = middle
		else:
			low = middle + 1
	return low


# Returns the place behind all numbers that are at most `value`.
static func right_of(numbers, value):
	var low = 0
	var high = numbers.size()
	while low < high:
		var middle = (low + high) >> 1
		if value < numbers[middle]:
			high = middle
		else:
			low = middle + 1
	return low


# Returns the place of the first number that is at least `value`.
static func left_of(numbers, value):
	var low = 0
	var high = numbers.size()
	while low < high:
		var middle = (low + high) >> 1
		if numbers[middle] < value:
			low = middle + 1
		else:
			high = middle
	return low


# Returns items by their keys, each a list of numbers or texts; equal ones keep their order, which the engine's own sort does not.
static func ordered(items, keys):
	var out = []
	var taken = []
	for n in range(items.size()):
		var low = 0
		var high = taken.size()
		while low < high:
			var middle = (low + high) >> 1
			if less(keys[n], taken[middle]):
				high = middle
			else:
				low = middle + 1
		taken.insert(low, keys[n])
		out.insert(low, items[n])
	return out


# Returns items by one or two of their fields.
static func by(items, field, second = null):
	var keys = []
	for item in items:
		keys.append([item[field]] if second == null else [item[field], item[second]])
	return ordered(items, keys)


# Returns whether key `a` comes before key `b`, place by place where they are lists.
static func less(a, b):
	if typeof(a) != TYPE_ARRAY:
		return a < b
	for n in range(a.size()):
		if a[n] < b[n]:
			return true
		if b[n] < a[n]:
			return false
	return false


# Returns whether a value is a number.
static func is_number(value):
	return typeof(value) == TYPE_INT or typeof(value) == typeof(0.5)


# Returns whether a value is a number, and a finite one.
static func is_finite_number(value):
	return is_number(value) and not is_nan(value) and not is_inf(value)


# Returns whether a list holds all of others.
static func has_all(items, others):
	for other in others:
		if not items.has(other):
			return false
	return true


# Returns 3x^2 - 2x^3 of x clamped to 0..1: the curve of every blend.
static func smooth(x):
	if x <= 0:
		return 0.0
	return 1.0 if x >= 1 else x * x * (3.0 - 2.0 * x)


# Returns seconds with three decimals, rounding the exact binary value, halves to even, as other languages print it.
static func thousandths(seconds):
	var whole = floor(seconds)
	var rest = seconds - whole
	# Halves of 26 bits times 1000 are exact, so what decides the rounding is.
	var high = floor(rest * 67108864.0) / 67108864.0
	var low = (rest - high) * 1000.0
	var count = floor(high * 1000.0)
	var over = high * 1000.0 - count - 0.5
	if over > -low or (over == -low and int(count) % 2 == 1):
		count += 1.0
	if count >= 1000.0:
		whole += 1.0
		count -= 1000.0
	return "%d.%03d" % [int(whole), int(count)]


# Returns the vector of three numbers.
static func vector(numbers):
	return Vector3(numbers[0], numbers[1], numbers[2])


# Returns the unit quaternion of four numbers, xyzw.
static func quaternion(numbers, shim):
	return shim.quat(numbers[0], numbers[1], numbers[2], numbers[3]).normalized()


# Returns a list of its own with the same items.
static func list(items):
	return items.duplicate() if typeof(items) == TYPE_ARRAY else Array(items)


# Returns the words of a text.
static func words(text):
	return Array(text.split(" ", false))


# Returns [a text before the last of another, that, what is behind it]; nothing of the first two where it has none.
static func parted_last(text, between):
	var place = text.rfind(between)
	return ["", "", text] if place < 0 else [text.substr(0, place), between, text.substr(place + between.length())]


# Returns whether a text is digits alone.
static func is_digits(text):
	for n in range(text.length()):
		if "0123456789".find(text[n]) < 0:
			return false
	return text.length() > 0


# Returns ln(1 + x), near 0 too.
static func log1p(x):
	var u = 1.0 + x
	return x if u == 1.0 else log(u) * x / (u - 1.0)


# Returns the largest of some numbers, or `other` of none.
static func most_of(items, other = null):
	for n in range(items.size()):
		other = items[n] if n == 0 else most(other, items[n])
	return other


# Returns the smallest of some numbers, or `other` of none.
static func least_of(items, other = null):
	for n in range(items.size()):
		other = items[n] if n == 0 else least(other, items[n])
	return other


# Returns the sum of some numbers.
static func sum(items):
	var out = 0
	for item in items:
		out += item
	return out


# Returns a number without its sign.
static func absolute(x):
	return -x if x < 0 else x


# Appends items to a list.
static func extend(items, more):
	for item in more:
		items.append(item)


# Returns the set of some items, or of another set's.
static func set_of(items):
	var out = {}
	for item in items:
		out[item] = true
	return out


# Puts something into a set, which is a record of what is in it.
static func add_to(items, item):
	items[item] = true


# Returns texts as one, with another between them.
static func joined(items, between):
	var out = ""
	for n in range(items.size()):
		out += items[n] if n == 0 else between + items[n]
	return out


# Returns a list from its end to its beginning.
static func backwards(items):
	var out = []
	for item in items:
		out.push_front(item)
	return out


# Returns [key, value] of each entry of a record.
static func entries(record):
	var out = []
	for key in record:
		out.append([key, record[key]])
	return out


# Returns numbers or texts in order.
static func in_order(items):
	return ordered(items, items)
