# What is known of letters: their plain forms and what kind of character they are, as Unicode has it below 65536.

const Table = preload("letters_table.gd")
const BLANKS = [
	9, 10, 11, 12, 13, 28, 29, 30, 31, 32, 0x85, 0xA0, 0x1680, 0x2000, 0x2001, 0x2002, 0x2003, 0x2004, 0x2005, 0x2006, 0x2007, 0x2008,
	0x2009, 0x200A, 0x2028, 0x2029, 0x202F, 0x205F, 0x3000
]

var shim
var _plain = {}
var _runs = {}


func _init(engine_shim):
	shim = engine_shim
	for base in Table.PLAIN:
		var accented = Table.PLAIN[base]
		for n in range(accented.length()):
			_plain[accented[n]] = base
	for n in range(0, Table.PAIRS.length(), 2):
		_plain[Table.PAIRS[n]] = Table.PAIRS[n + 1]
	for word in Table.SPELLED.split(" ", false):
		_plain[word[0]] = word.substr(1, word.length() - 1)
	for sort in [["letter", Table.LETTERS], ["digit", Table.DIGITS], ["syllable", Table.SYLLABLES], ["mark", Table.MARKS]]:
		var edges = []
		var at = 0
		for number in sort[1].split(" ", false):
			at += int(number)
			edges.append(at)
		_runs[sort[0]] = edges


# Returns a text without blanks at its ends.
func stripped(text):
	var first = 0
	var last = text.length()
	while first < last and BLANKS.has(shim.code_at(text, first)):
		first += 1
	while last > first and BLANKS.has(shim.code_at(text, last - 1)):
		last -= 1
	return text.substr(first, last - first)


# Returns a text's code points, a text each.
func letters(text):
	var out = []
	for n in range(text.length()):
		out.append(text[n])
	return out


# Returns "syllable" for a digit and for a letter of a script without small ones, "letter" for others, "mark" for what combines with
# the letter before it; "" for all else.
func kind(letter):
	var number = code(letter)
	if _is("letter", number):
		return "syllable" if _is("digit", number) or _is("syllable", number) else "letter"
	return "mark" if _is("mark", number) else ""


# Returns a letter's code point.
func code(letter):
	return shim.code_at(letter, 0)


# Returns 0..99, the same for the same word.
func scatter(word):
	return _crc32(shim.utf8(word)) % 100


# Returns a word in small letters without accents, a letter each.
func plain(word):
	var out = []
	for n in range(word.length()):
		var number = shim.code_at(word, n)
		if number >= 0xAC00 and number <= 0xD7A3:  # Hangul: its syllables are taken apart
			var tail = (number - 0xAC00) % 28
			var rest = (number - 0xAC00 - tail) / 28
			out.append(shim.letter(0x1100 + rest / 21))
			out.append(shim.letter(0x1161 + rest % 21))
			if tail > 0:
				out.append(shim.letter(0x11A7 + tail))
		elif not _is("mark", number):
			out += letters(_plain.get(word[n], word[n]))
	return out


# Returns whether a character is of a kind: letter (or digit), digit, syllable, mark.
func _is(which, number):
	if number >= 0x10000:  # beyond are rare Han characters, and pictures
		return (which == "letter" or which == "syllable") and number >= 0x20000 and number < 0x32000
	var edges = _runs[which]
	var low = 0
	var high = edges.size()
	while low < high:
		var middle = (low + high) >> 1
		if number < edges[middle]:
			high = middle
		else:
			low = middle + 1
	return low % 2 == 1


# Returns the checksum of bytes that ZIP files use.
static func _crc32(bytes):
	var out = 0xFFFFFFFF
	for byte in bytes:
		out ^= byte
		for _bit in range(8):
			out = (out >> 1) ^ (0xEDB88320 if out & 1 else 0)
	return out ^ 0xFFFFFFFF
