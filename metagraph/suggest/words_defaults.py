"""The words animators name clips with, in English, and what they say. Data only; `words_patterns` lets users
change it. Words of other languages stand for English ones: `synonyms`, from `words_languages`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Final, Literal, get_args

Field = Literal["kinds", "layers", "limbs", "tags", "postures", "joins", "junk", "synonyms"]
Meanings = Mapping[str, str]


def _table(meanings: Mapping[str, str]) -> Meanings:
    """Turn meaning -> "phrase, phrase, ..." around."""
    return MappingProxyType(
        {p.strip(): meaning for meaning, phrases in meanings.items() for p in phrases.split(",") if p.strip()}
    )


KINDS: Final = _table(
    {
        "stance": "idle, idling, stance, rest, resting, base, loop, pose, hold, neutral, default, relaxed",
        "transition": "trans, transition, enter, exit, sit down, stand up, get up, lie down, lay down, kneel "
        "down, crouch down, rise",
        "gesture": """
            shrug, point, pointing, wave, waving, beat, nod, nodding, shake, head shake, shake head, no, yes, emphasize, emphasise,
            emphasis, emphatic, bow, clap, clapping, applaud, applause, cheer, cheering, thumbs up, thumb up, thumbs down, stop, refuse,
            offer, dismiss, count, explain, explaining, open palm, open palms, palm up, palms up, air quotes, quote, precision, size,
            heart, so so, on the other hand, on one hand, salute, greet, greeting, hello, hi, bye, bye bye, byebye, goodbye, beckon,
            come here, call, guide, respond, present, presenting, show, agree, agreeing, disagree, disagreeing, acknowledge, question,
            ask, asking, answer, think up, thinking, think, ponder, double take, look aside, recoil, straighten, lean in, lean back,
            ease back, press in, turn away, dip, surprise, surprised, shocked, angry, happy, sad, laugh, laughing, cry, crying,
            celebrate, victory, fist pump, facepalm, face palm, blow kiss, give, giving, receive, take item, hand over, gesture,
            gesticulate, gestic, talk, talking, me, you, self, many, few, big, small, none, generic, wide, chop, push away, plead,
            pleading, beg, argue, arguing, insult, taunt, encourage, thank, thankful, thanks, welcome, introduce, warn, warning, scold,
            raise, raising, raise hand, hand raise, hand raising, raise arm, excited, head turn, turn head, head tilt, tilt head, indicate,
            indicating, direct, directing, assert, insist, deny, denial, hesitate, negative, affirmative, affirm, confirm, contrast,
            compare, comparing, measure, weigh, reach, reaching, apologise, apologize, sorry, comfort, congratulate, hug, embrace, knock,
            finger wag, wag, wagging, relief, relieved, disgust, disgusted, scared, afraid, fear, fearful, confused, annoyed, frustrated,
            embarrassed, ashamed, shy, proud, enthusiastic, desperate, hysterical, enumerate, deictic, metaphoric, iconic, container,
            sweep, shoo, hush, ok, request, demand, suggest, doubt, accept, accuse, plea, toss, clench, snap, blame, mock, curtsy,
            whisper, yell, shout, high five, handshake, shake hands, kiss, reject, dont know, unsure, maybe, whatever, cut throat, count
            fingers, listing, list, describe, describing, pray, praying, interact, use item, throw, invite""",
        "fidget": """
            fidget, fidgeting, scratch, scratching, scratch head, check watch, look watch, look at watch, check phone, look around, look
            about, looking around, look down, glance, glancing, shift, shift feet, shift weight, weight shift, knee bounce, bounce knee,
            leg bounce, adjust, adjusting, readjust, adjust sleeve, fix, fix hair, fix tie, yawn, yawning, sway, swaying, settle,
            resettle, regrip, rub, rubbing, rub hands, rub arm, tap, tapping, tap foot, tap fingers, foot tap, finger tap, tap cheek,
            twiddle, twiddle thumbs, stretch, stretching, neck stretch, roll shoulders, shoulder roll, neck roll, roll neck, heel lift,
            swing arms, arm swing, flick fingers, touch neck, touch face, touch hair, touch, stroke chin, drop arm, crack knuckles,
            knuckles, sniff, sneeze, cough, coughing, sigh, breathe, breath, wipe, wipe nose, wipe brow, dust off, bored, impatient,
            tug, pick, crack neck, play hair, hair twirl, roll head, head roll, shake arms, shake leg, shake legs, stretch arms, move,
            nervous, dust, wiggle, rock, rocking, twitch, blink""",
        "other": """
            walk, walking, run, running, jog, jogging, sprint, sprinting, jump, jumping, strafe, dash, climb, climbing, swim, swimming,
            crawl, crawling, fly, flying, fall, falling, land, landing, death, die, dying, dead, attack, punch, kick, melee, ranged,
            shoot, shooting, aim, aiming, reload, block, blocking, dodge, roll, hit, stab, slice, spell, spellcast, spellcasting, cast,
            dance, dancing, sneak, t pose, a pose, tpose, apose, bind pose, bind, reference pose, ref pose, turn in place, pick up,
            pickup, locomotion""",
    }
)
LAYERS: Final = _table(
    {
        "head": """
            head, face, facial, eyes, eye, eyebrow, brow, brows, neck, nod, nodding, shake, shake head, head shake, blink, gaze, glance,
            glancing, look, looking, look down, tilt, yes, no, mouth, jaw, lip, lips, viseme, chin, cheek, smile, frown, double take,
            head turn, turn head, head tilt, tilt head, look up, look left, look right, look away, look around, nose, ear, hair,
            question, yawn, agree, agreeing, disagree, disagreeing, acknowledge, listen, listening, sniff, sneeze, roll head, head roll""",
        "arms": """
            arm, arms, hand, hands, finger, fingers, thumb, thumbs, palm, palms, fist, fists, elbow, elbows, wrist, on hips, hips,
            akimbo, pocket, pockets, crossed, folded, clasped, clasp, shrug, point, pointing, wave, waving, beat, clap, clapping,
            applaud, applause, offer, dismiss, stop, refuse, count, air quotes, quote, salute, beckon, facepalm, gesture, gesticulate,
            gestic, scratch, check watch, watch, sleeve, rub, twiddle, knuckles, precision, explain, explaining, present, presenting,
            thumbs up, thumbs down, hand over, bye, bye bye, byebye, goodbye, greet, greeting, hello, call, guide, heart, so so, cheer,
            fist pump, beg, pray, praying, generic, me, you, self, many, few, give, giving, receive, high five, handshake, shake hands,
            raise hand, hand raise, hand raising, raise arm, indicate, indicating, measure, weigh, reach, reaching, hug, embrace, knock,
            finger wag, wag, wagging, enumerate, deictic, metaphoric, iconic, container, sweep, shoo, hush, ok, plea, plead, pleading,
            toss, clench, snap, accuse, listing, take, clench fist, push, pull, grab, hold, show, tap, crack knuckles, fist,
            adjust sleeve, touch, interact, use item, throw, cut throat, chop, come here, invite, dust, shake arms, stretch arms, arms
            stretch, blow kiss, stroke chin, tap cheek, tap fingers, hand to chin""",
        "body": """
            body, full body, fullbody, leg, legs, knee, knees, foot, feet, heel, toe, stand, standing, sit, sitting, seated, seat, lie,
            lying, lay, kneel, kneeling, crouch, crouching, squat, weight, lean, leaning, lean in, lean back, torso, spine, posture,
            bow, recoil, straighten, sway, swaying, sway body, shift, shift feet, shift weight, knee bounce, heel lift, tap foot, foot
            tap, stand up, sit down, get up, lie down, dip, turn away, chair, floor, walk, walking, run, running, jump, dance, death,
            rock, idle, stretch, shake leg, shake legs, move leg""",
    }
)
LIMBS: Final = _table(
    {
        "left": "l, lf, lt, left, lh, left hand, left arm",
        "right": "r, rt, rgt, right, rh, right hand, right arm",
        "both": """
            bt, both, lr, 2h, two hands, both hands, both arms, bi, palms, hands, arms, shrug, clap, clapping, applause, applaud, air
            quotes, twiddle thumbs""",
    }
)
TAGS: Final = _table(
    {
        "positive": """
            happy, cheer, cheering, clap, clapping, applause, applaud, celebrate, victory, laugh, laughing, smile, positive, thank,
            thanks, love""",
        "negative": "sad, angry, negative, bored, cry, crying, disgust, insult, bad, recoil",
        "positive agree": "nod, nodding, yes, agree, agreeing, thumbs up, thumb up, acknowledge",
        "negative disagree": "no, head shake, shake head, disagree, disagreeing, thumbs down, reject, shake",
        "negative dismissive": "dismiss, whatever",
        "negative refuse": "refuse, push away",
        "negative stop": "stop",
        "greeting": "greet, greeting, hello, hi, wave, waving, bow, salute, welcome, wave hello",
        "greeting bye": "bye, bye bye, byebye, goodbye",
        "question": "question, ask, asking",
        "unsure": "shrug, unsure, dont know, maybe, so so, doubt",
        "thinking": "think, thinking, think up, ponder, stroke chin, tap cheek, look aside",
        "you": "you, point you",
        "me": "me, self, heart, point me",
        "explain open": "open palm, open palms",
        "you open positive": "offer",
        "explain": "explain, explaining, describe, describing, precision, on the other hand",
        "beat": "beat",
        "emphasis": "emphasis, emphatic, emphasize, emphasise, large, press in, lean in",
        "impatient": "check watch, tap foot, foot tap, tap fingers, impatient, knee bounce",
        "enumerate": "count, listing",
        "surprise": "surprise, surprised, shocked, double take",
        "irony": "air quotes",
        "stretch": "stretch, neck stretch, roll shoulders",
        "polite": "bow",
    }
)
# What stances are called by. A stance's own body part ("arms crossed") counts only beside one of these.
POSTURES: Final = _table(
    {
        "stance": """
            idle, stance, stand, standing, sit, sitting, seated, lie, lying, kneel, kneeling, crouch, crouching, squat, lean, leaning,
            lean forward, crossed, cross, folded, clasped, akimbo, on hips, at sides, tilt, tilted, straight, upright, weight, slouch,
            slouched, neutral, relaxed, forward, back, behind back, pockets, in pockets, hands down, arms down, hand on chin, sat"""
    }
)
JOINS: Final = _table({"to": "to, into, 2, towards", "from": "from"})
JUNK: Final = _table(
    {
        "junk": """
            armature, skeleton, rig, root, mixamo, mixamo com, com, base layer, layer, baselayer, anim, anims, animation, animations,
            clip, action, take, mocap, retarget, retargeted, export, exported, fbx, bvh, glb, final, unreal take, stack, animstack,
            scene, mesh, character, char"""
    }
)
_ENGLISH: Final[Mapping[str, Meanings]] = {
    "kinds": KINDS,
    "layers": LAYERS,
    "limbs": LIMBS,
    "tags": TAGS,
    "postures": POSTURES,
    "joins": JOINS,
    "junk": JUNK,
}


class _Defaults(Mapping[Field, Meanings]):
    """What is built in; words of other languages are read when they are first asked for."""

    def __getitem__(self, name: Field) -> Meanings:
        if name == "synonyms":
            from metagraph.suggest.words_languages import synonyms

            return synonyms()
        return _ENGLISH[name]

    def __iter__(self) -> Iterator[Field]:
        return iter(get_args(Field))

    def __len__(self) -> int:
        return len(get_args(Field))


DEFAULTS: Final[Mapping[Field, Meanings]] = _Defaults()
