"""Behaviour Markup Language in and out."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph import requests as a
from metagraph.graph.model import Project
from metagraph.graph.words import LAYERS, LIMBS, MODES
from metagraph.playback.bml.reader import BmlBlock, read_block, read_bml, write_bml
from metagraph.playback.bml.words import GUESSED, SPOKEN


def block(inner: str, at: float = 0.0, project: Project | None = None, head: str = "<bml>") -> BmlBlock:
    return read_block(f"{head}\n{inner}\n</bml>", at, 1, project)


def one(inner: str, at: float = 0.0, project: Project | None = None) -> a.AnyRequest:
    asks = block(inner, at, project).asks
    assert len(asks) == 1
    return asks[0]


# --- what is not read


def test_an_empty_block_asks_for_nothing() -> None:
    assert read_bml("<bml/>") == ()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "not XML"),
        ("nod", "line 1: not XML"),
        ("<bml>\n<gesture>\n</bml>", "line 3: not XML"),
        ("<bml>&nbsp;</bml>", "not XML: undefined entity"),
        ("<speech/>", "line 1, <speech>: the first element must be <bml>"),
        ('<bml composition="MIX"/>', "MERGE, APPEND or REPLACE"),
        (
            '<bml>\n<gesture id="g" lexeme="beat" start="soon"/></bml>',
            'line 2, <gesture>: start="soon" is neither seconds nor',
        ),
        (
            '<bml><gesture id="g" stroke="s1:tm1"/></bml>',
            "there is no behaviour 's1' in this block; there are g",
        ),
        ('<bml><gesture id="g" start="other:g1:end"/></bml>', "no behaviour 'other:g1'"),
        ('<bml><gesture id="g" start="h:end"/><gesture id="h" start="g:end"/></bml>', "waits for itself"),
        ('<bml><gesture id="g" start="this:start"/></bml>', "waits for itself"),
        ('<bml><gesture id="g"/><head id="g"/></bml>', "two behaviours 'g'"),
        (
            '<bml><speech id="s"><text>a<sync id="t1"/>b</text></speech><head start="s:t9"/></bml>',
            "no sync point 't9'; its marks are t1",
        ),
        (
            '<bml><gesture metagraph:layer="legs" xmlns:metagraph="x"/></bml>',
            "layer: Invalid enum value 'legs'",
        ),
        ('<bml><gesture start="1e300"/></bml>', "<= 1000000"),
        ('<bml><gesture start="1e999"/></bml>', "neither seconds nor"),
        ('<bml><gesture metagraph:tags="[1]"/></bml>', "JSON list of texts"),
        ('<bml><wait duration="long"/></bml>', "duration is a number"),
        (
            '<bml><constraint><synchronize ref="g:end"><sync ref="x"/></synchronize></constraint></bml>',
            "no sync point of a behaviour",
        ),
        ("<bml>" + "<required>" * 50 + "</required>" * 50 + "</bml>", "more than 40 deep"),
        ("<bml>" + "<head/>" * 501 + "</bml>", "at most 500 behaviours"),
        ("<bml><speech><text>" + "<b/>" * 4001 + "</text></speech></bml>", "more than 4000 elements"),
    ],
)
def test_what_cannot_be_read_is_told_with_its_line_and_remedy(text: str, words: str) -> None:
    with pytest.raises(a.RequestError) as caught:
        read_bml(text)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        '<!DOCTYPE bml [<!ENTITY a "aaaaaaaaaa"><!ENTITY b '
        '"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]><bml><speech>&b;</speech></bml>',
        '<!DOCTYPE bml [<!ENTITY f SYSTEM "file:///etc/hostname">]><bml><speech>&f;</speech></bml>',
        '<!DOCTYPE bml SYSTEM "http://localhost/bml.dtd"><bml/>',
        "<!DOCTYPE bml><bml/>",
    ],
)
def test_document_types_and_their_entities_are_refused_unread(text: str) -> None:
    with pytest.raises(a.RequestError, match="no <!DOCTYPE"):
        read_bml(text)


def test_a_long_chain_of_behaviours_is_read_or_refused_in_words() -> None:
    chain = "".join(f'<gesture id="g{n}" start="g{n + 1}:end"/>' for n in range(499)) + '<gesture id="g499"/>'
    try:
        asks = block(chain).asks
    except a.RequestError as error:
        assert "wait for one another" in str(error)
    else:
        assert len(asks) == 500


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_with_an_ask_error(text: str) -> None:
    for whole in (text, f"<bml>{text}</bml>", f'<bml><gesture id="g" start="{text}" lexeme="{text}"/></bml>'):
        try:
            read_bml(whole)
        except a.RequestError as error:
            assert str(error)


# --- what is read


def test_the_first_element_may_be_smartbodys_act() -> None:
    text = '<act><participant id="brad"/><bml><head type="NOD"/></bml></act>'
    assert read_bml(text) == (a.Nod(),)


def test_namespaces_do_not_matter() -> None:
    assert read_bml(
        '<b:bml xmlns:b="http://www.bml-initiative.org/bml/bml-1.0"><b:head lexeme="NOD"/></b:bml>'
    ) == (a.Nod(),)


@pytest.mark.parametrize(
    ("inner", "ask"),
    [
        ('<gesture lexeme="beat"/>', a.Gesture(tags=("beat",))),
        ('<gesture id="g1" type="BEAT" hand="LEFT"/>', a.Gesture(id="g1", tags=("BEAT",), limb="left")),
        ('<gesture type="LEXEME" lexeme="wave" mode="RIGHT_HAND"/>', a.Gesture(tags=("wave",), limb="right")),
        ('<gesture lexeme="open,you" mode="BOTH_HANDS"/>', a.Gesture(tags=("open", "you"), limb="both")),
        ('<gesture lexeme="beat" start="1.5"/>', a.Gesture(tags=("beat",), at=1.5)),
        ('<gesture lexeme="beat" start="500ms"/>', a.Gesture(tags=("beat",), at=0.5)),
        ('<gesture lexeme="beat" stroke="2"/>', a.Gesture(tags=("beat",), stroke=2.0)),
        ('<gesture lexeme="beat" start="1" end="3"/>', a.Gesture(tags=("beat",), at=1.0, duration=2.0)),
        ('<gesture lexeme="beat" strokeEnd="2" '
         'relax="3.5"/>', a.Gesture(tags=("beat",), at=2 - GUESSED["strokeend"], hold=1.5)),
        ('<gesture lexeme="beat" stroke="1" stroke-end="1.25" '
         'relax="2.5"/>', a.Gesture(tags=("beat",), stroke=1.0, hold=1.25)),
        ('<gesture lexeme="beat" stroke="1" '
         'relax="this:strokeEnd+0.75"/>', a.Gesture(tags=("beat",), stroke=1.0, hold=0.75)),
        ('<gesture id="g" lexeme="beat" start="g:ready" '
         'stroke="1"/>', a.Gesture(id="g", tags=("beat",), stroke=1.0, prepare=False)),
        ('<gesture lexeme="beat" start="this:ready" '
         'ready="4"/>', a.Gesture(tags=("beat",), at=4.0, prepare=False)),
        ('<gesture name="shrug_bt_01"/>', a.Play(action="shrug_bt_01")),
        ('<animation name="bow" start="1"/>', a.Play(action="bow", at=1.0)),
        ('<head lexeme="NOD" start="2"/>', a.Nod(at=2.0)),
        ('<head type="SHAKE"/>', a.Shake()),
        ('<head lexeme="TILT"/>', a.Gesture(layer="head", tags=("TILT",))),
        ('<headDirectionShift target="door"/>', a.Look(to="door")),
        ('<posture stance="AtEase"/>', a.Go(stance="AtEase")),
        ('<postureShift start="3"><stance type="SITTING"/></postureShift>', a.Go(stance="SITTING", at=3.0)),
        ('<body posture="ChrIdle01"/>', a.Go(stance="ChrIdle01")),
        ('<gaze target="user" influence="EYES" start="1" '
         'end="3"/>', a.Look(to="user", amount=0.25, at=1.0, duration=2.0)),
        ('<gazeShift target="0 1.6 2"/>', a.Look(to=(0.0, 1.6, 2.0))),
        ('<speech ref="279" start="1"/>', a.Say(line="279", at=1.0)),
        ("<speech><text>Hello <sync id='t'/> there,\n you</text></speech>", a.Say(text="Hello there, you")),
        ("<speech>Hi <mark name='T1'/>you<description>not said</description></speech>", a.Say(text="Hi you")),
        ('<faceLexeme lexeme="BLINK" start="1"/>', a.Blink(at=1.0)),
        ('<face type="LEXEME" lexeme="blink"/>', a.Blink()),
        ('<required><head lexeme="NOD"/></required>', a.Nod()),
    ],
)  # fmt: skip
def test_a_behaviour_becomes_an_ask(inner: str, ask: a.AnyRequest) -> None:
    found = one(inner)
    assert found == ask


@pytest.mark.parametrize(
    ("inner", "words"),
    [
        ('<locomotion target="door"/>', "the character stays where it is"),
        ('<event message="x"/>', "line 2, <event> is left out"),
        ('<faceFacs au="1"/>', "none of the behaviours that are understood"),
        ('<face type="SMILE"/>', "only BLINK"),
        ("<speech/>", "says neither words"),
        ("<posture/>", "names no stance"),
        (
            '<constraint><before ref="bml:start"/></constraint>',
            "of constraints <synchronize> and <after> are kept",
        ),
    ],
)
def test_what_is_not_understood_is_left_out_with_a_note(inner: str, words: str) -> None:
    found = block(inner)
    assert found.asks == ()
    assert any(words in note for note in found.notes)


def test_what_is_read_only_in_part_is_noted() -> None:
    assert "does not aim" in block('<pointing target="door" mode="LEFT_HAND"/>').notes[0]
    assert "repetition" in block('<head lexeme="NOD" repetition="3"/>').notes[0]
    assert "until its end" in block('<posture stance="x" end="3"/>').notes[0]


def test_a_block_may_replace_all_that_was_asked_before() -> None:
    found = block('<head lexeme="NOD"/>', head='<bml id="b2" composition="REPLACE">')
    assert found.asks == (a.Withdraw(), a.Nod())
    assert (found.ident, found.composition) == ("b2", "replace")


def test_times_count_from_where_the_block_begins() -> None:
    assert one('<head lexeme="NOD" start="2"/>', at=10.0) == a.Nod(at=12.0)
    assert one('<gesture lexeme="x" stroke="bml:start+1"/>', at=10.0) == a.Gesture(tags=("x",), stroke=11.0)
    assert one('<head lexeme="NOD"/>', at=10.0) == a.Nod()


def test_nothing_begins_before_the_performance() -> None:
    assert one('<head lexeme="NOD" start="-3"/>') == a.Nod(at=0.0)


def test_sync_points_of_other_behaviours_are_followed_with_offsets() -> None:
    text = (
        "<speech id='s1' start='1'><text>0123456 <sync id='tm1'/>89</text></speech>"
        "<gesture id='g1' lexeme='beat' stroke='s1:tm1+0.3'/><head lexeme='NOD' start='g1:stroke-0.2'/>"
        "<gazeShift target='user' start='s1:end'/><wait id='w' start='s1:start' duration='2'/><gesture "
        "lexeme='open' start='w:end'/>"
    )
    speech, beat, nod, look, after = block(text).asks
    mark = 1 + 8 / 11 * len("0123456 89") / SPOKEN
    assert speech == a.Say(id="s1", text="0123456 89", at=1.0)
    assert isinstance(beat, a.Gesture) and beat.stroke == pytest.approx(mark + 0.3) and beat.at is None
    assert nod.at == pytest.approx(mark + 0.1)
    assert look.at == pytest.approx(1 + 10 / SPOKEN)
    assert after.at == pytest.approx(3.0)


def test_a_gesture_others_wait_for_aims_at_the_stroke_they_were_told() -> None:
    first, nod = block("<gesture id='g' lexeme='beat' start='1'/><head lexeme='NOD' start='g:stroke'/>").asks
    assert isinstance(first, a.Gesture)
    assert first.stroke == nod.at == pytest.approx(1 + GUESSED["stroke"])


def test_references_may_point_forwards_and_to_the_blocks_own_name() -> None:
    nod, beat = block(
        "<head lexeme='NOD' start='b:g:start + 1'/><gesture id='b:g' lexeme='beat' start='2'/>"
    ).asks
    assert (nod.at, beat.at) == (3.0, 2.0)


def test_constraints_bring_sync_points_together() -> None:
    text = (
        "<gesture id='g' lexeme='beat'/><speech id='s'><text><sync id='a'/>Yes</text></speech><head id='h' "
        "lexeme='NOD'/>"
        "<constraint><synchronize><sync ref='g:stroke+0.1'/><sync ref='s:start'/></synchronize>"
        "<after ref='s:end'><sync ref='h:start'/></after></constraint>"
    )
    beat, _, nod = block(text).asks
    assert isinstance(beat, a.Gesture) and beat.stroke == 0.0  # it should come 0.1 s before the block begins
    assert nod.at == pytest.approx(3 / SPOKEN)


# --- the words of a project


@pytest.mark.parametrize(
    ("inner", "expected"),
    [
        ('<gesture lexeme="BEAT"/>', a.Gesture(tags=("beat",))),
        ('<gesture lexeme="Positive,OPEN"/>', a.Gesture(tags=("positive", "open"))),
        ('<gesture lexeme="POLITE"/>', a.Gesture(layer="body", tags=("polite",))),
        ('<gesture lexeme="juggle"/>', a.Gesture(tags=("juggle",))),
        ('<head lexeme="disagree"/>', a.Gesture(layer="head", tags=("disagree",))),
        (
            '<posture><pose part="ARMS" lexeme="CROSSED"/></posture>',
            a.Go(layer="arms", stance="arms crossed"),
        ),
        ('<posture stance="LeanForward"/>', a.Go(layer="body", stance="lean forward")),
        ('<animation name="SHRUG-BT-01"/>', a.Play(action="shrug_bt_01")),
    ],
)
def test_lexemes_find_tags_names_and_stances_however_they_are_spelled(
    inner: str, expected: a.AnyRequest, sample: Project
) -> None:
    assert one(inner, project=sample) == expected


def test_a_lexeme_that_is_no_tag_finds_an_action_called_so(sample: Project) -> None:
    ask = one('<gesture lexeme="SHRUG" start="1"/>', project=sample)
    assert isinstance(ask, a.Play)
    action = sample.action(ask.action)
    assert (
        action is not None and action.name == "shrug_bt_01" and action.stance == sample.graphs["arms"].start
    )


def test_a_lexeme_prefers_the_hand_that_is_asked_for(sample: Project) -> None:
    ask = one('<gesture lexeme="dismiss" mode="RIGHT_HAND"/>', project=sample)
    assert isinstance(ask, a.Play)
    action = sample.action(ask.action)
    assert action is not None and action.limb == "right"


def test_lengths_come_from_the_projects_clips(sample: Project) -> None:
    wave, nod = block(
        "<animation id='w' name='wave_hello_rt_01'/><head lexeme='NOD' start='w:end'/>", project=sample
    ).asks
    action = next(x for x in sample.actions() if x.name == "wave_hello_rt_01")
    start, end = sample.span(action)
    assert wave == a.Play(id="w", action="wave_hello_rt_01")
    assert nod.at == pytest.approx(end - start)


def test_how_late_is_too_late_is_read_and_means_nothing_for_a_look() -> None:
    assert one('<gesture lexeme="beat" stroke="2" metagraph:late="0"/>') == a.Gesture(
        tags=("beat",), stroke=2.0, late=0.0
    )
    found = block('<gaze target="user" metagraph:late="0.3"/>')
    assert found.asks == (a.Look(to="user"),)
    assert "metagraph:late" in found.notes[0]


@pytest.mark.parametrize("text", ["soon", "-1", "1e9"])
def test_a_lateness_that_is_no_time_is_refused_with_its_place(text: str) -> None:
    with pytest.raises(a.RequestError, match=r"line 2, <gesture>.*late"):
        block(f'<gesture lexeme="beat" metagraph:late="{text}"/>')


# --- out, and in again

words = (
    st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc", "Cn")), min_size=1, max_size=12)
    .map(str.strip)
    .filter(bool)
)
seconds = st.none() | st.floats(0, 1e5)
tags = st.lists(
    st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc", "Cn")), max_size=8), max_size=3
).map(tuple)
common = {"at": seconds, "priority": st.integers(-1000, 1000)}
late = {"late": st.none() | st.floats(0, 600)}
phased = {"stroke": seconds, "hold": st.none() | st.floats(0, 600), "prepare": st.booleans()}
timed = {"duration": seconds, "resume": st.booleans()}
layers, limbs = st.sampled_from(LAYERS), st.none() | st.sampled_from(LIMBS)
points = st.tuples(*[st.floats(-1e6, 1e6)] * 3)
plain = st.one_of(
    st.builds(a.Gesture, layer=layers, tags=tags, limb=limbs, **phased, **timed, **late, **common),
    st.builds(a.Fidget, layer=layers, tags=tags, limb=limbs, **timed, **late, **common),
    st.builds(a.Play, action=words, layer=st.none() | layers, **phased, **late, **common),
    st.builds(a.Go, stance=words, layer=st.none() | layers, stay=st.booleans(), **late, **common),
    st.builds(a.Change, layer=layers, limb=limbs, duration=seconds, **late, **common),
    st.builds(a.Nod, tags=tags, **late, **common),
    st.builds(a.Shake, tags=tags, **late, **common),
    st.builds(
        a.Look, to=words | points, duration=seconds, amount=st.floats(0, 1), strict=st.booleans(), **common
    ),
    st.builds(a.Blink, **common),
    st.builds(a.Say, line=words, duration=seconds, gestures=st.booleans(), **common),
    st.builds(a.Say, text=words | st.just("two  spaces\n"), duration=seconds, **common),
    st.builds(a.Behave, mode=st.none() | st.sampled_from(MODES), **common),
    st.builds(a.Place, name=words, point=points, **common),
    st.builds(a.Withdraw, what=st.just("") | words, **common),
)


@given(st.lists(plain, max_size=6))
def test_what_is_written_reads_back_to_the_same_asks(asks: list[a.AnyRequest]) -> None:
    named = tuple(msgspec.structs.replace(ask, id=f"b{n}" if n % 2 else "") for n, ask in enumerate(asks))
    assert read_bml(write_bml(named)) == named


def test_what_no_block_can_hold_is_refused_in_words() -> None:
    with pytest.raises(a.RequestError, match="'x'"):
        write_bml([a.Nod(id="x"), a.Nod(id="x")])
    with pytest.raises(a.RequestError, match="cannot hold another"):
        write_bml([a.Bml(bml="<bml/>")])


def test_a_lines_number_comes_back_as_text() -> None:
    assert read_bml(write_bml([a.Say(line=279)])) == (a.Say(line="279"),)


def test_moods_are_read_from_attributes_and_written_as_such() -> None:
    block = (
        '<bml><gesture id="g" lexeme="beat" metagraph:mood="sad" metagraph:intensity="0.5"/>'
        '<metagraph:mood id="m" metagraph:mood="0.25 -0.5" duration="3"/></bml>'
    )
    gesture, mood = read_bml(block, 0.0)
    assert isinstance(gesture, a.Gesture) and (gesture.mood, gesture.intensity) == ("sad", 0.5)
    assert isinstance(mood, a.Feel) and (mood.mood, mood.duration) == ((0.25, -0.5), 3.0)
    again = read_bml(write_bml([gesture, mood]), 0.0)
    assert [(x.mood, x.intensity) for x in again] == [("sad", 0.5), ((0.25, -0.5), None)]
    with pytest.raises(a.RequestError, match="mood"):
        read_bml('<bml><gesture lexeme="beat" metagraph:mood="blue"/></bml>', 0.0)


def test_characters_that_xml_cannot_hold_are_replaced_and_the_block_stays_whole() -> None:
    asks = [a.Say(id="x\x01", text="a\0b\ufffe\x1b[31m"), a.Nod()]
    block = write_bml(asks)
    assert read_bml(block) == (a.Say(id="x\ufffd", text="a\ufffdb\ufffd\ufffd[31m"), a.Nod())
    with pytest.raises(a.RequestError, match="two asks are called"):
        write_bml([a.Nod(id="x\x01"), a.Nod(id="x\x02")])
