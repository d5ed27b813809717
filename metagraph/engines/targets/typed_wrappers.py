"""Typed classes for game code, made of a project's parameters: a property for each value, a method for each
trigger.

They only call `set_parameter` and `get_parameter` of the runtime, by name. So they stay the same however the
graph is reorganised, and a parameter that was removed is an error of the game's compiler.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from metagraph.common.xml_text import escape
from metagraph.engines.targets.target import ExportOrder
from metagraph.formats.atomic import write_atomically
from metagraph.graph.model import Project
from metagraph.graph.parameter import CharacterParameter, get_first_value, make_word

MADE = "Made by Metagraph from the parameters of '{name}'. Export again to change it."
METRES = "Metres in the character's space: X to its left, Y up, Z ahead."

# Words that a member cannot have, apart from those that the language's way of writing names rules out.
_OF_CPP = frozenset(
    """alignas alignof and and_eq asm auto bitand bitor bool break case catch char class compl concept const
    consteval constexpr constinit const_cast continue co_await co_return co_yield decltype default delete do
    double dynamic_cast else enum explicit export extern false float for friend goto if inline int long
    mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public register
    reinterpret_cast requires return short signed sizeof static static_assert static_cast struct switch
    template this thread_local throw true try typedef typeid typename union unsigned using virtual void
    volatile wchar_t while xor xor_eq linux unix errno assert stdin stdout stderr metagraph std""".split()  # noqa: SIM905
)
_OF_CSHARP = frozenset("Equals Finalize GetHashCode GetType MemberwiseClone ReferenceEquals ToString".split())  # noqa: SIM905
_OF_JAVASCRIPT = frozenset(("constructor", "prototype"))
_OF_GODOT = frozenset(
    """and as assert await break breakpoint class class_name const continue elif else enum extends false for
    func if in is match namespace not null or pass preload return self signal static super trait true var void
    while when yield abs acos asin atan ceil clamp cos deg_to_rad ease exp floor fmod hash is_equal_approx
    lerp load log max min pow print push_error push_warning rad_to_deg rand_from_seed randf randi range round
    seed sign sin snapped sqrt str tan tan typeof weakref wrap call callv connect disconnect free get
    get_class get_meta get_script has_meta has_method has_signal init_ref is_blocking_signals is_class
    is_connected notification property_can_revert reference remove_meta script set set_meta set_script
    to_string tr unreference bool int float character""".split()  # noqa: SIM905
)


@dataclass(frozen=True)
class TypedMember:
    """A parameter with its names in one language. choices: those of its constants, in order."""

    word: str
    parameter: CharacterParameter
    name: str
    enum: str
    choices: tuple[str, ...]

    @property
    def words(self) -> list[str]:
        """Return the words of its choices, as the runtime knows them."""
        return [choice.name for choice in self.parameter.choices]

    @property
    def first(self) -> Any:
        """Return the value that it has until it is set."""
        return get_first_value(self.parameter)

    @property
    def about(self) -> str:
        """Return what it is for, on one line."""
        return " ".join(self.parameter.about.split()) or self.word.replace("_", " ").capitalize() + "."


def write_wrapper(order: ExportOrder, language: str) -> list[Path]:
    """Write the class of an export's character for "javascript", "csharp", "gdscript" or "cpp"; return its
    files, none if the project has no parameters.
    """
    made = {
        name: text.encode()
        for name, text in make_wrapper(order.project, order.stem, language).items()
        if order.project.parameters
    }
    for name, content in made.items():
        write_atomically(order.folder / name, content)
    return [order.folder / name for name in made]


def make_wrapper(project: Project, stem: str, language: str) -> Mapping[str, str]:
    """Return the files of the class for a language: their names and texts. stem: of the export's files."""
    return _LANGUAGES[language](project, stem)


def make_class_name(project: Project) -> str:
    """Return the name of the class: the project's name and "Character"."""
    word = make_word(project.name, (), "exported").removesuffix("_character")
    own = "exported" if word in ("character", "metagraph") else word  # others have these names
    return f"{_write_pascal(own)}Character"


def _write_pascal(word: str) -> str:
    return "".join(part.capitalize() for part in word.split("_"))


def _write_camel(word: str) -> str:
    first, *rest = word.split("_")
    return first + "".join(part.capitalize() for part in rest)


def _list_members(
    project: Project,
    reserved: Collection[str],
    write_name: Callable[[str], str],
    write_choice: Callable[[str], str],
) -> list[TypedMember]:
    """Return the parameters with names that differ from each other and from what is reserved."""
    taken = set(reserved)

    def claim(name: str) -> str:
        while name in taken:
            name += "_"
        taken.add(name)
        return name

    names = {word: claim(write_name(word)) for word in project.parameters}
    return [
        TypedMember(
            word,
            parameter,
            names[word],
            claim(f"{_write_pascal(word)}Choice") if parameter.type in ("enum", "list") else "",
            tuple(write_choice(choice.name) for choice in parameter.choices),
        )
        for word, parameter in project.parameters.items()
    ]


def _plain(number: float) -> str:
    """Return a number that every language reads as one with a fraction."""
    return repr(float(number))


# --- JavaScript and TypeScript


def _make_javascript(project: Project, stem: str) -> Mapping[str, str]:
    name = make_class_name(project)
    members = _list_members(project, _OF_JAVASCRIPT, _write_camel, lambda word: word)
    code = [f"// {MADE.format(name=project.name)}", "", f"export class {name} {{"]
    code += ["  #character;", "", "  constructor(character) {", "    this.#character = character;", "  }"]
    types = [f"// {MADE.format(name=project.name)}", ""]
    types += ["/** What has parameters: a Character, a MetagraphObject or a `<metagraph-character>`. */"]
    types += ["export interface Settable {", "  setParameter(name: string, value?: any): string;"]
    types += ["  getParameter(name: string): unknown;", "}", ""]
    for member in members:
        if member.enum:
            types += [f"export type {member.enum} = {' | '.join(map(_quote, member.words))};"]
    types += ["", f"/** The parameters of '{_in_comment(project.name)}'. */", f"export class {name} {{"]
    types += ["  constructor(character: Settable);"]
    for member in members:
        kind = {
            "number": "number",
            "boolean": "boolean",
            "enum": member.enum,
            "list": f"readonly {member.enum}[]",
            "point": "readonly [number, number, number]",
        }.get(member.parameter.type, "")
        types += [f"  /** {_in_comment(_tell_range(member))} */"]
        code += [""]
        if not kind:
            types += [f"  {member.name}(): string;"]
            code += [
                f"  {member.name}() {{",
                f"    return this.#character.setParameter({_quote(member.word)});",
            ]
            code += ["  }"]
            continue
        types += [f"  get {member.name}(): {kind};", f"  set {member.name}(value: {kind});"]
        code += [f"  get {member.name}() {{"]
        first = _write_in_javascript(member.first)
        code += [f"    return this.#character.getParameter({_quote(member.word)}) ?? {first};", "  }", ""]
        code += [f"  set {member.name}(value) {{"]
        code += [f"    this.#character.setParameter({_quote(member.word)}, value);", "  }"]
    return {
        f"{stem}.parameters.js": "\n".join([*code, "}", ""]),
        f"{stem}.parameters.d.ts": "\n".join([*types, "}", ""]),
    }


def _quote(text: str) -> str:
    return f'"{text}"'  # words have no letters that need more


def _write_in_javascript(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_write_in_javascript, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return _quote(value) if isinstance(value, str) else _plain(value)


def _in_comment(text: str) -> str:
    return text.replace("*/", "* /").replace("\\", "/")


def _tell_range(member: TypedMember) -> str:
    """Return what a parameter is for, with the range of a number."""
    parameter = member.parameter
    if parameter.type == "number":
        return f"{member.about} From {parameter.least:g} to {parameter.most:g}."
    if parameter.type == "point":
        return f"{member.about} {METRES}"
    return f"{member.about} Returns the request's id." if parameter.type == "trigger" else member.about


# --- C#


def _make_csharp(project: Project, stem: str) -> Mapping[str, str]:
    name = make_class_name(project)
    members = _list_members(project, {*_OF_CSHARP, name}, _write_pascal, _write_pascal)
    lines = [f"// {MADE.format(name=' '.join(project.name.split()))}", "using System;"]
    lines += ["using System.Collections.Generic;", "using System.Linq;", "", "namespace Metagraph", "{"]
    lines += [f"    /// <summary>The parameters of '{_in_xml(project.name)}'.</summary>"]
    lines += [f"    public sealed class {name}", "    {"]
    lines += ["        private readonly Character character;", ""]
    lines += [f"        public {name}(Character character)", "        {"]
    lines += ["            this.character = character;", "        }"]
    for member in members:
        if member.enum:
            lines += ["", f"        public enum {member.enum}", "        {"]
            lines += [f"            {choice}," for choice in member.choices]
            lines += ["        }", ""]
            words = ", ".join(map(_quote, member.words))
            lines += [f"        private static readonly string[] words{_write_pascal(member.word)} ="]
            lines += ["        {", f"            {words}", "        };"]
        lines += ["", f"        /// <summary>{_in_xml(_tell_range(member))}</summary>"]
        lines += [f"        {line}" for line in _make_csharp_member(member)]
    return {f"{name}.cs": "\n".join([*lines, "    }", "}", ""])}


def _make_csharp_member(member: TypedMember) -> list[str]:
    word, words = _quote(member.word), f"words{_write_pascal(member.word)}"
    get = f"character.GetParameter({word})"
    if member.parameter.type == "trigger":
        return [f"public string {member.name}()", "{", f"    return character.SetParameter({word});", "}"]
    kind, getter, given = {
        "number": ("double", [f"return (double){get};"], "value"),
        "boolean": ("bool", [f"return (bool){get};"], "value"),
        "enum": (
            member.enum,
            [f"return ({member.enum})Array.IndexOf({words}, (string){get});"],
            f"{words}[(int)value]",
        ),
        "list": (
            f"IEnumerable<{member.enum}>",
            [
                f"return ((List<object>){get})",
                f"    .Select(one => ({member.enum})Array.IndexOf({words}, (string)one)).ToList();",
            ],
            f"value.Select(one => {words}[(int)one]).ToArray()",
        ),
        "point": (
            "(double X, double Y, double Z)",
            [
                f"var point = (List<object>){get};",
                "return ((double)point[0], (double)point[1], (double)point[2]);",
            ],
            "new[] { value.X, value.Y, value.Z }",
        ),
    }[member.parameter.type]
    body = [f"public {kind} {member.name}", "{", "    get", "    {"]
    body += [f"        {line}" for line in getter]
    body += ["    }", "    set", "    {", f"        character.SetParameter({word}, {given});", "    }", "}"]
    return body


def _in_xml(text: str) -> str:
    return escape(" ".join(text.split()), quote=False)


# --- GDScript


def _make_gdscript(project: Project, stem: str) -> Mapping[str, str]:
    name = make_class_name(project)
    members = _list_members(project, _OF_GODOT, lambda word: word, str.upper)
    lines = [f"class_name {name}", "extends RefCounted"]
    lines += [f"## The parameters of '{' '.join(project.name.split())}'.", "##"]
    lines += [f"## {MADE.format(name=' '.join(project.name.split()))}", ""]
    for member in members:
        if member.enum:
            lines += [f"enum {member.enum} {{ {', '.join(member.choices)} }}"]
    lines += [""]
    for member in members:
        if member.enum:
            lines += [f"const _WORDS_{member.word.upper()} := [{', '.join(map(_quote, member.words))}]"]
    lines += ["", "var _performer"]
    for member in members:
        if member.parameter.type != "trigger":
            lines += ["", f"## {_tell_range(member)}", *_make_gdscript_property(member)]
    lines += ["", "", "## performer: a MetagraphCharacter."]
    lines += ["func _init(performer) -> void:", "\t_performer = performer"]
    for member in members:
        if member.parameter.type == "trigger":
            lines += ["", "", f"## {_tell_range(member)}", f"func {member.name}() -> String:"]
            lines += [f"\treturn _performer.set_parameter({_quote(member.word)})"]
    lines += ["", "", "func _value_of(parameter: String, first):"]
    lines += [
        "\tvar value = _performer.get_parameter(parameter)",
        "\treturn first if value == null else value",
    ]
    return {f"{stem}_parameters.gd": "\n".join([*lines, ""])}


def _make_gdscript_property(member: TypedMember) -> list[str]:
    word, words = _quote(member.word), f"_WORDS_{member.word.upper()}"
    get = f"_value_of({word}, {_write_in_javascript(member.first)})"
    send = f"_performer.set_parameter({word}"
    kind, getter, setter = {
        "number": ("float", [f"return {get}"], [f"{send}, value)"]),
        "boolean": ("bool", [f"return {get}"], [f"{send}, value)"]),
        "enum": (
            member.enum,
            [f"return {words}.find({get}) as {member.enum}"],
            [f"{send}, {words}[value])"],
        ),
        "list": (
            f"Array[{member.enum}]",
            [
                f"var out: Array[{member.enum}] = []",
                f"for word in {get}:",
                f"\tout.append({words}.find(word) as {member.enum})",
                "return out",
            ],
            ["var chosen := []", "for one in value:", f"\tchosen.append({words}[one])", f"{send}, chosen)"],
        ),
        "point": (
            "Vector3",
            [f"var point = {get}", "return Vector3(point[0], point[1], point[2])"],
            [f"{send}, value)"],
        ),
    }[member.parameter.type]
    return [
        f"var {member.name}: {kind}:",
        "\tget:",
        *(f"\t\t{line}" for line in getter),
        "\tset(value):",
        *(f"\t\t{line}" for line in setter),
    ]


# --- C++


def _make_cpp(project: Project, stem: str) -> Mapping[str, str]:
    name = make_class_name(project)

    def write_plain(word: str) -> str:
        return f"{word}_" if word in _OF_CPP else word

    members = _list_members(project, {name, *_OF_CPP}, lambda word: word, write_plain)
    lines = [f"// {MADE.format(name=' '.join(project.name.split()))}", "#pragma once", ""]
    lines += ['#include "metagraph/metagraph.hpp"', ""]
    lines += [f"/// The parameters of '{' '.join(project.name.split())}'.", f"class {name} {{", "public:"]
    lines += [f"    explicit {name}(metagraph::Character& character) : character_(character) {{}}"]
    for member in members:
        if member.enum:
            lines += ["", f"    enum class {member.enum} {{ {', '.join(member.choices)} }};"]
        lines += ["", f"    /// {_tell_range(member)}".replace("\\", "/"), *_make_cpp_member(member)]
    lines += ["", "private:", "    metagraph::Character& character_;"]
    for member in members:
        if member.enum:
            words = ", ".join(map(_quote, member.words))
            lines += ["", f"    static const metagraph::List<std::string>& {member.word}_words_() {{"]
            lines += [f"        static const metagraph::List<std::string> words = {{{words}}};"]
            lines += ["        return words;", "    }"]
            lines += [f"    static std::string {member.word}_word_({member.enum} value) {{"]
            lines += [f"        return {member.word}_words_()[static_cast<std::size_t>(value)];", "    }"]
            lines += [f"    static {member.enum} {member.word}_choice_(const std::string& word) {{"]
            index = f"metagraph::lang::index({member.word}_words_(), word)"
            lines += [f"        return static_cast<{member.enum}>({index});", "    }"]
    return {f"{stem}_parameters.hpp": "\n".join([*lines, "};", ""])}


def _make_cpp_member(member: TypedMember) -> list[str]:
    word, name = _quote(member.word), member.name
    get, setter = f"character_.get_parameter({word})", f"character_.set_parameter({word}"
    if member.parameter.type == "trigger":
        return [f"    std::string {name}() {{ return {setter}); }}"]
    kind, found, given = {
        "number": ("double", f"{get}.number", "value"),
        "boolean": ("bool", f"{get}.flag", "value"),
        "enum": (member.enum, f"{member.word}_choice_({get}.text)", f"{member.word}_word_(value)"),
        "list": (f"std::vector<{member.enum}>", "", ""),
        "point": ("metagraph::Vec", "", "metagraph::Json::list({value.x, value.y, value.z})"),
    }[member.parameter.type]
    passed = f"const {kind}&" if member.parameter.type in ("list", "point") else kind
    if member.parameter.type == "list":
        return [
            f"    {kind} {name}() const {{",
            f"        {kind} out;",
            f"        for (const metagraph::Json& one : {get}.items) {{",
            f"            out.push_back({member.word}_choice_(one.text));",
            "        }",
            "        return out;",
            "    }",
            f"    std::string set_{name}({passed} value) {{",
            "        metagraph::Json out = metagraph::Json::list();",
            f"        for ({member.enum} one : value) out.items.push_back({member.word}_word_(one));",
            f"        return {setter}, out);",
            "    }",
        ]
    if member.parameter.type == "point":
        return [
            f"    {kind} {name}() const {{",
            f"        const metagraph::Json point = {get};",
            "        return {point.items[0].number, point.items[1].number, point.items[2].number};",
            "    }",
            f"    std::string set_{name}({passed} value) {{ return {setter}, {given}); }}",
        ]
    return [
        f"    {kind} {name}() const {{ return {found}; }}",
        f"    std::string set_{name}({passed} value) {{ return {setter}, {given}); }}",
    ]


_LANGUAGES: Mapping[str, Callable[[Project, str], Mapping[str, str]]] = {
    "javascript": _make_javascript,
    "csharp": _make_csharp,
    "gdscript": _make_gdscript,
    "cpp": _make_cpp,
}
