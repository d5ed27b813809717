# All that Godot 3 says differently from Godot 4 and the core needs; shim4.gd is its twin.


# Returns the quaternion of four numbers.
static func quat(x, y, z, w):
	return Quat(x, y, z, w)


# Returns a text's UTF-8 bytes.
static func utf8(text):
	return text.to_utf8()


# Returns the code point of a text's letter at a place.
static func code_at(text, place):
	return ord(text[place])


# Returns the letter of a code point.
static func letter(code):
	return char(code)


# Returns what a JSON text says, null where it is none.
static func parse(text):
	var found = JSON.parse(text)
	return found.result if found.error == OK else null


# Returns a file's bytes, null where it cannot be read.
static func read_bytes(path):
	var file = File.new()
	if file.open(path, File.READ) != OK:
		return null
	var bytes = file.get_buffer(file.get_len())
	file.close()
	return bytes


# Returns whether a value is an array of bytes.
static func are_bytes(value):
	return typeof(value) == TYPE_RAW_ARRAY


# Returns the text of UTF-8 bytes; none of what could not be read.
static func text_of(bytes):
	return "" if bytes == null else bytes.get_string_from_utf8()


# Returns microseconds of a clock.
static func micros():
	return OS.get_ticks_usec()
