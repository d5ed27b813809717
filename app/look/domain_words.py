"""The domain's own names - layers, kinds, colours - as the window says them."""

from __future__ import annotations

from app.translation import tr

KIND_TITLES = {
    "stance": tr("Stance"),
    "gesture": tr("Gesture"),
    "fidget": tr("Fidget"),
    "transition": tr("Transition"),
}
MANY_OF_KIND = {
    "stance": tr("Stances"),
    "gesture": tr("Gestures"),
    "fidget": tr("Fidgets"),
    "transition": tr("Transitions"),
}
LAYER_TITLES = {"body": tr("Body"), "arms": tr("Arms"), "head": tr("Head")}
LAYER_LONG_TITLES = {"body": tr("Body layer"), "arms": tr("Arms layer"), "head": tr("Head layer")}
COLOR_TITLES = {
    "": "",
    "red": tr("Red"),
    "orange": tr("Orange"),
    "yellow": tr("Yellow"),
    "green": tr("Green"),
    "blue": tr("Blue"),
    "purple": tr("Purple"),
}
COLOR_LABELS = {
    "red": tr("Red label"),
    "orange": tr("Orange label"),
    "yellow": tr("Yellow label"),
    "green": tr("Green label"),
    "blue": tr("Blue label"),
    "purple": tr("Purple label"),
}
