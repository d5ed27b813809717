"""Speaks a scene of three minutes with eSpeak NG, and has the sample's Ben and Ada perform it, filmed.

    python -m sample_clips.make.film FOLDER

Writes `bakery.wav`, a channel each, `bakery.json`, their words, and `bakery.mp4`, cut and with sound: what to
watch whole after a change of how characters behave in a conversation. Nothing of it is kept among the
samples.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from sample_clips.make.talk import Turn, speak, write_sound, write_words

HERE = Path(__file__).resolve().parents[1]
NAME = "Bakery"
BEN, ADA = 0, 1
SCENE = (
    Turn(ADA, 0.8, ("Ben do you have a *minute*",)),
    Turn(BEN, 0.3, ("for you *always*", "what is going *on*")),
    Turn(ADA, 0.9, ("hesitation: um",)),
    Turn(ADA, 0.7, ("I have been *thinking* about this for weeks", "and I have to tell *somebody*")),
    Turn(BEN, 0.3, ("that sounds *serious*",)),
    Turn(ADA, 0.4, ("I am going to *leave* the company", "at the end of the *month*")),
    Turn(BEN, 0.5, ("response: really",)),
    Turn(BEN, 0.8, ("but you have been here for *nine* years", "you *built* half of this place")),
    Turn(ADA, 0.2, ("response: I know",)),
    Turn(ADA, 0.6, ("and I *loved* it", "but every morning I walk past that *little* shop")),
    Turn(
        ADA, 0.4, ("the one on the *corner* with the blue door", "and it has been *empty* since the winter")
    ),
    Turn(BEN, -0.6, ("response: right",)),
    Turn(ADA, 0.5, ("so last week I just *called* the owner", "and we *talked* for an hour")),
    Turn(ADA, 0.3, ("and she is going to *give* it to me",)),
    Turn(BEN, 0.6, ("hesitation: uh",)),
    Turn(BEN, 0.8, ("give you *what*", "the *shop*")),
    Turn(ADA, 0.3, ("response: yes",)),
    Turn(ADA, 0.5, ("I am opening a *bakery*",)),
    Turn(BEN, 1.0, ("response: wow",)),
    Turn(BEN, 0.7, ("I did *not* see that coming", "can you even *bake*")),
    Turn(ADA, 0.2, ("response: haha",)),
    Turn(ADA, 0.6, ("my grandmother had the *biggest* oven in the village", "I learned it when I was *six*")),
    Turn(BEN, -0.5, ("response: oh",)),
    Turn(ADA, 0.6, ("she let me make the *small* ones for the children", "and we *sold* them at the gate")),
    Turn(BEN, 0.4, ("you never *told* me that",)),
    Turn(ADA, 0.3, ("you never *asked*",)),
    Turn(BEN, 0.3, ("response: haha",)),
    Turn(BEN, 0.7, ("*fair* enough",)),
    Turn(BEN, 1.1, ("hesitation: hmm",)),
    Turn(BEN, 1.2, ("what about the *money*", "the rent over *there* must be high")),
    Turn(ADA, 0.5, ("hesitation: well",)),
    Turn(ADA, 0.8, ("that is the part that *scares* me", "I saved *enough* for one year")),
    Turn(ADA, 0.4, ("and if it does not *work* by then", "I will *have* to stop")),
    Turn(BEN, 0.4, ("response: I see",)),
    Turn(BEN, 0.8, ("one year is *not* long", "but it is not *nothing* either")),
    Turn(ADA, 0.3, ("response: exactly",)),
    Turn(BEN, 0.9, ("who *else* knows about this",)),
    Turn(ADA, 0.4, ("only my *sister*", "she was *here* on Sunday and saw the plans")),
    Turn(BEN, 0.5, ("and what did *she* say",)),
    Turn(ADA, 0.4, ("nothing at *first*", "she walked *round* the table", "and looked at *every* page")),
    Turn(BEN, 0.2, ("response: uh-huh",)),
    Turn(ADA, 0.5, ("and then she *laughed*", "and said that our *mother* would have cried")),
    Turn(BEN, 0.5, ("for *joy* I hope",)),
    Turn(ADA, 0.3, ("response: haha",)),
    Turn(ADA, 0.5, ("with her you never *knew*",)),
    Turn(BEN, 1.0, ("hesitation: hmm",)),
    Turn(BEN, 1.0, ("and if *nobody* comes", "I mean in the *beginning*")),
    Turn(ADA, 0.8, ("there is the *school* on one side", "and the *station* on the other")),
    Turn(ADA, 0.4, ("a *thousand* people walk past that door", "between *seven* and eight")),
    Turn(BEN, -0.4, ("response: okay",)),
    Turn(ADA, 0.6, ("and *all* of them are hungry",)),
    Turn(BEN, 0.5, ("you have *really* thought about it",)),
    Turn(ADA, 0.4, ("I have *counted* them Ben", "I stood there with a *pencil* in the rain")),
    Turn(BEN, 0.4, ("response: haha",)),
    Turn(BEN, 0.6, ("*that* is the Ada I know",)),
    Turn(ADA, 1.2, ("so do you think I am *mad*",)),
    Turn(BEN, 1.6, ("*no*",)),
    Turn(BEN, 0.6, ("I think you are the *bravest* person in this building",)),
    Turn(BEN, 0.4, ("I have wanted to *leave* since the spring", "and I *never* even called anybody")),
    Turn(ADA, 0.4, ("response: really",)),
    Turn(ADA, 0.5, ("where would you *go*",)),
    Turn(BEN, 0.8, ("hesitation: er",)),
    Turn(BEN, 0.9, ("I do not *know*", "somewhere *far* away where it is quiet")),
    Turn(BEN, 0.5, ("or maybe just *across* the street",)),
    Turn(ADA, 0.6, ("what do you *mean*",)),
    Turn(BEN, 0.4, ("well a bakery needs somebody who can *count*", "and I get up at *five* anyway")),
    Turn(ADA, 0.5, ("response: no way",)),
    Turn(ADA, 0.7, ("are you *serious*",)),
    Turn(BEN, 0.4, ("I could look at your *numbers* this weekend", "and then we *see*")),
    Turn(ADA, -0.3, ("response: yes",)),
    Turn(ADA, 0.5, ("*please*", "I have three *boxes* full of paper")),
    Turn(BEN, 0.3, ("response: okay",)),
    Turn(BEN, 0.5, ("bring *all* of them to my place", "and bring some of those *small* ones")),
    Turn(ADA, 0.3, ("response: haha",)),
    Turn(ADA, 0.6, ("I will make you the *big* ones", "*thank* you Ben")),
    Turn(BEN, 0.4, ("do not *thank* me yet", "I have not seen the *boxes*")),
    Turn(ADA, 0.6, ("then I see you on *Saturday*", "and do not *tell* anybody")),
    Turn(BEN, 0.3, ("response: of course",)),
)


def main() -> None:
    """Speak it, keep it in a copy of the sample, and film it."""
    import msgspec

    from app.cli.parser import main as run
    from metagraph.formats.conversations.files import read_conversation
    from metagraph.formats.store import open_project, save_project
    from metagraph.speech.automatic_cuts import keep_filmed_conversation

    folder = Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    talk = speak(SCENE)
    write_sound(folder / "bakery.wav", talk.samples, talk.rate)
    write_words(folder / "bakery.json", talk)
    copied = folder / "samples"
    shutil.copytree(
        HERE, copied, dirs_exist_ok=True, ignore=shutil.ignore_patterns("make", "study", "__pycache__")
    )
    path = copied / "sample.metagraph.yaml"
    project = open_project(path).project
    made = read_conversation([folder / "bakery.wav"], [folder / "bakery.json"], copied, NAME).conversation
    sides = tuple(
        msgspec.structs.replace(side, name=name, character=body)
        for side, name, body in zip(made.sides, ("Ben", "Ada"), ("ben.glb", None), strict=True)
    )
    project = keep_filmed_conversation(project, msgspec.structs.replace(made, sides=sides))[0]
    save_project(project, path)
    sys.exit(
        run(["render", str(path), "--conversation", NAME, "-o", str(folder / "bakery.mp4"), "--overwrite"])
    )


if __name__ == "__main__":
    main()
